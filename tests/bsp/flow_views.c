// See flow_views.h.
// SPDX-License-Identifier: MIT
#include "flow_views.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void cross_of(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void unit_make(double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) v[i] /= length;
}

void flow_view_make(const grid_cells *g, const flow_aim *aim, flow_view *v)
{
    memset(v, 0, sizeof *v);
    cull_view *view = &v->view;
    double up[3] = {0, 1, 0};
    memcpy(v->eye_unposed, aim->eye, sizeof v->eye_unposed);
    grid_pose(g, aim->eye, view->eye_exact);
    grid_pose_way(g, aim->forward, view->forward);
    unit_make(view->forward);
    if (fabs(view->forward[1]) > 0.75) up[0] = 1, up[1] = 0;
    cross_of(view->forward, up, v->right);
    unit_make(v->right);
    cross_of(v->right, view->forward, v->up);
    memcpy(v->tangents, aim->tangents, sizeof v->tangents);
    for (int i = 0; i < 3; i++) view->eye[i] = (float)view->eye_exact[i];
    view->eye_exact[3] = 1;
    view->eye[3] = 1;
    view->width_px = 1280;
    view->height_px = 720;
    view->pixel_tangent = fmax(2 * aim->tangents[0] / view->width_px, 2 * aim->tangents[1] / view->height_px);
    view->reach = sqrt(1 + aim->tangents[0] * aim->tangents[0] + aim->tangents[1] * aim->tangents[1]);
    view->near_distance = (float)aim->near_distance;
    view->purpose = CULL_VIEW_MAIN;
    cull_guard guard = {.pixel_tangent = view->pixel_tangent, .reach = view->reach, .radius = (double)g->zone.radius};
    memcpy(guard.eye, view->eye_exact, sizeof guard.eye);
    memcpy(guard.forward, view->forward, sizeof guard.forward);
    for (int k = 0; k < 4; k++) {
        const double *axis = k < 2 ? v->right : v->up, sign = k % 2 ? -1 : 1;
        double n[3];
        for (int i = 0; i < 3; i++) n[i] = sign * axis[i] + aim->tangents[k / 2] * view->forward[i];
        unit_make(n);
        v->planes[k] = cull_guard_plane(&guard, n, 0);
    }
    v->volume = (cull_volume){v->planes, 4, 0};
    v->visit.view = view;
    v->visit.volumes = &v->volume;
    v->visit.volume_count = 1;
}

void flow_view_ray(const grid_cells *g, const flow_view *v, double u, double w, double way[3])
{
    double posed[3];
    for (int i = 0; i < 3; i++) posed[i] = v->view.forward[i] + u * v->tangents[0] * v->right[i] + w * v->tangents[1] * v->up[i];
    grid_unpose_way(g, posed, way);
}

void flow_run_make(const grid_cells *g, flow_run *r)
{
    size_t bytes = 0;
    for (int how = BSP_CELLS_RECT; how <= BSP_CELLS_EXACT; how++) {
        const size_t here = bsp_flow_scratch(&g->data, (bsp_cells)how);
        bytes = here > bytes ? here : bytes;
    }
    r->scratch = aligned_alloc(64, (bytes + 63) / 64 * 64);
    memset(r->scratch, 0xa5, bytes); // undefined content
    r->drawn = malloc(g->item_count);
}

void flow_run_free(flow_run *r)
{
    free(r->drawn);
    free(r->scratch);
}

void flow_run_step(const grid_cells *g, const flow_view *v, bsp_cells how, uint32_t backface, flow_run *r)
{
    memset(r->drawn, 0, g->item_count);
    const bsp_flow_request q = {&g->data, &g->index, &g->zone, &v->visit, how, backface, r->scratch, r->drawn, BSP_EXITS_LOST};
    r->result = bsp_flow(&q, &r->figures);
}
