// See sight.h.
// SPDX-License-Identifier: MIT
#include "sight.h"
#include "flow.h"

#include <string.h>

cull_result sight_open(const cull_host *host, const bsp_flow_request *how, size_t drawn_bytes, bsp_sight *out)
{
    bsp_sight s;
    memset(&s, 0, sizeof s);
    s.flow = *how;
    s.drawn_bytes = drawn_bytes;
    s.scratch_bytes = bsp_flow_scratch(how->cells, how->how);
    s.flow.drawn = host->alloc(host, drawn_bytes, 64);
    s.flow.scratch = host->alloc(host, s.scratch_bytes, 64);
    s.current = SIGHT_VOLUMES;
    *out = s;
    if (s.flow.drawn && s.flow.scratch) return CULL_OK;
    sight_close(host, out);
    return CULL_ERR_MEMORY;
}

void sight_close(const cull_host *host, bsp_sight *s)
{
    if (s->flow.drawn) host->free(host, s->flow.drawn, s->drawn_bytes);
    if (s->flow.scratch) host->free(host, s->flow.scratch, s->scratch_bytes);
    memset(s, 0, sizeof *s);
}

// ---- What is kept ----

static sight_view view_of(const cull_view *v)
{
    sight_view out;
    memset(&out, 0, sizeof out);
    memcpy(out.eye, v->eye_exact, sizeof out.eye);
    memcpy(out.forward, v->forward, sizeof out.forward);
    out.pixel_tangent = v->pixel_tangent;
    out.reach = v->reach;
    out.near_distance = (double)v->near_distance;
    for (int k = 0; k < 3; k++) out.right[k] = v->clip_from_zone[4 * k];
    out.eye_w = v->eye[3];
    out.frame = v->frame;
    out.purpose = v->purpose;
    return out;
}

static const bsp_flow_figures no_figures = {0, 0, 0, 0};

static void forget(bsp_sight *s)
{
    s->volume_count = 0;
    s->current = SIGHT_VOLUMES;
    s->is_spoilt = 0;
    memset(s->flow.drawn, 0, s->drawn_bytes);
}

static void look_at(bsp_sight *s, const cull_view *view)
{
    const sight_view now = view_of(view);
    if (memcmp(&now, &s->view, sizeof now) == 0) return;
    s->view = now;
    s->untold = no_figures;
    forget(s);
}

static int is_same(const sight_volume *kept, const cull_volume *v)
{
    return kept->plane_count == v->plane_count && kept->entry == v->entry && (!v->plane_count || memcmp(kept->planes, v->planes, v->plane_count * sizeof *v->planes) == 0);
}

static uint32_t volume_find(const bsp_sight *s, const cull_volume *v)
{
    for (uint32_t i = 0; i < s->volume_count; i++)
        if (is_same(&s->volumes[i], v)) return i;
    return SIGHT_VOLUMES;
}

// Adds what the volume sees to `drawn`; its exits stand in the scratch afterwards. 0: it can't be.
static int volume_run(bsp_sight *s, const cull_view *view, const cull_volume *v)
{
    const cull_visit visit = {.view = view, .volumes = v, .volume_count = 1};
    bsp_flow_figures one;
    s->flow.visit = &visit;
    s->current = SIGHT_VOLUMES;
    const int done = bsp_flow(&s->flow, &one);
    s->flow.visit = NULL;
    s->untold.cells_visited += one.cells_visited;
    s->untold.openings_tried += one.openings_tried;
    s->untold.merges += one.merges;
    s->untold.limits_hit += one.limits_hit;
    return done;
}

static void volume_keep(bsp_sight *s, const cull_volume *v)
{
    if (s->volume_count == SIGHT_VOLUMES || v->plane_count > CULL_MAX_PLANES) {
        s->is_spoilt = 1; // `drawn` holds more than the list says
        return;
    }
    sight_volume *kept = &s->volumes[s->volume_count];
    kept->plane_count = v->plane_count;
    kept->entry = v->entry;
    if (v->plane_count) memcpy(kept->planes, v->planes, v->plane_count * sizeof *v->planes);
    s->current = s->volume_count++;
}

// ---- A frame ----

// 1: every volume that was run for this view is one of the visit's.
static int is_all_wanted(const bsp_sight *s, const cull_visit *visit)
{
    for (uint32_t i = 0; i < s->volume_count; i++) {
        uint32_t at = 0;
        while (at < visit->volume_count && !is_same(&s->volumes[i], &visit->volumes[at])) at++;
        if (at == visit->volume_count) return 0;
    }
    return 1;
}

static int volumes_run(bsp_sight *s, const cull_visit *visit)
{
    if (s->is_spoilt || !is_all_wanted(s, visit)) forget(s);
    for (uint32_t v = 0; v < visit->volume_count; v++) {
        const cull_volume *volume = &visit->volumes[v];
        if (volume_find(s, volume) != SIGHT_VOLUMES) continue;
        if (!volume_run(s, visit->view, volume)) {
            s->is_spoilt = 1;
            return 0;
        }
        volume_keep(s, volume);
    }
    return 1;
}

int sight_select(bsp_sight *s, const cull_visit *visit, bsp_flow_figures *figures)
{
    look_at(s, visit->view);
    const int done = volumes_run(s, visit);
    *figures = s->untold;
    s->untold = no_figures;
    s->is_spoilt = 1; // the walk writes over `drawn`
    return done;
}

// ---- At a portal ----

// Planes of the volume that the window does not stand for: those that the eye is well on one side of.
static uint32_t planes_beside_eye(const bsp_sight *s, const sight_question *q, cull_plane *out)
{
    const double *eye = q->view->eye_exact, radius = (double)s->flow.zone->radius;
    uint32_t count = 0;
    for (uint32_t i = 0; i < q->in->plane_count; i++) {
        const cull_plane p = q->in->planes[i];
        const double n[3] = {(double)p.normal.x, (double)p.normal.y, (double)p.normal.z};
        const double height = ((n[0] * eye[0] + n[1] * eye[1]) + n[2] * eye[2]) + (double)p.offset;
        const double through = 4 * CULL_GUARD_ROUNDING * (fabs(n[0]) + fabs(n[1]) + fabs(n[2])) * radius; // such a plane is a side of the window
        if (fabs(height) > through && count < CULL_MAX_PLANES) out[count++] = p;
    }
    return count;
}

// The window's edges as planes through the eye. They are moved out for rounding alone: the guard band is in the window.
static uint32_t planes_of_window(const bsp_sight *s, const cull_view *view, const window *w, cull_plane *out)
{
    window_line lines[WINDOW_POINTS];
    double axes[3][3];
    if (!flow_axes(view, axes)) return 0;
    window_edges(w, lines);
    uint32_t count = 0;
    for (uint32_t i = 0; i < w->count; i++) {
        double normal[3];
        if (lines[i].a == 0 && lines[i].b == 0) continue; // two corners in one place
        for (int k = 0; k < 3; k++) normal[k] = (lines[i].a * axes[0][k] + lines[i].b * axes[1][k]) + lines[i].c * axes[2][k];
        const double *eye = view->eye_exact, offset = -((normal[0] * eye[0] + normal[1] * eye[1]) + normal[2] * eye[2]);
        out[count++] = cull_plane_outward(normal, offset, (double)s->flow.zone->radius);
    }
    return count;
}

static cull_crossing window_give(const bsp_sight *s, const sight_question *q, const window *w, cull_plane *planes, uint32_t *plane_count)
{
    window rectangle;
    const uint32_t beside = planes_beside_eye(s, q, planes);
    if (beside + w->count > CULL_MAX_PLANES) {
        window_set_rectangle(w->bounds, &rectangle);
        w = &rectangle;
    }
    if (beside + w->count > CULL_MAX_PLANES) return CULL_CROSS_SAME;
    const uint32_t sides = planes_of_window(s, q->view, w, planes + beside);
    *plane_count = beside + sides;
    return sides ? CULL_CROSS_NARROW : CULL_CROSS_SAME;
}

cull_crossing sight_part(bsp_sight *s, const sight_question *q, cull_plane *planes, uint32_t *plane_count)
{
    const uint32_t *stands = s->flow.cells->portal_offsets + q->portal;
    window rectangle;
    const window *windows[FLOW_WINDOWS];
    if (stands[0] == stands[1]) return CULL_CROSS_SAME; // no cell knows of it
    look_at(s, q->view);
    const uint32_t known = volume_find(s, q->in);
    if (known == SIGHT_VOLUMES || known != s->current) {
        if (!volume_run(s, q->view, q->in)) {
            s->is_spoilt = 1;
            return q->part ? CULL_CROSS_NONE : CULL_CROSS_SAME;
        }
        if (known == SIGHT_VOLUMES) volume_keep(s, q->in);
        else s->current = known;
    }
    const uint32_t count = bsp_flow_exit(&s->flow, q->portal, &rectangle, windows);
    return q->part < count ? window_give(s, q, windows[q->part], planes, plane_count) : CULL_CROSS_NONE;
}
