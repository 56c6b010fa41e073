// Views of the checks: see views.h.
// SPDX-License-Identifier: MIT
#include "views.h"

#include <math.h>
#include <string.h>

static const char *const names[VIEW_HOWS] = {"free", "eye on a plane", "windows", "slabs", "narrow", "wide", "far off"};

const char *view_name(view_how how)
{
    return names[how];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void place_eye(check_run *r, const made_scene *s, view_how how, double eye[3])
{
    for (int i = 0; i < 3; ++i) eye[i] = s->middle[i] + run_between(r, -1, 1) * s->size * (i == 1 ? 0.3 : 1);
    if (how == VIEW_TOUCHES && s->zone.item_count && s->size > 0) {
        const cull_box *b = &s->boxes[run_below(r, s->zone.item_count)];
        const uint32_t axes = 1 + run_below(r, 7); // which coordinates are the box's
        for (int i = 0; i < 3; ++i)
            if (axes >> i & 1) eye[i] = (double)(run_below(r, 2) ? &b->min.x : &b->max.x)[i];
    }
    if (how == VIEW_FAR_OFF && s->size > 0) eye[0] += s->size * 60;
    for (int i = 0; i < 3; ++i) eye[i] = (double)(float)eye[i]; // so that float and double eye are one
}

static void place_camera(check_run *r, const made_scene *s, view_how how, const double *eye, camera *c)
{
    *c = (camera){.up = {0, 1, 0}, .aspect = (double)VIEW_WIDTH_PX / VIEW_HEIGHT_PX, .near_m = 0.05, .far_m = INFINITY};
    if (eye) memcpy(c->eye, eye, sizeof c->eye);
    else place_eye(r, s, how, c->eye);
    c->fovy_deg = how == VIEW_NARROW ? 2 : how == VIEW_WIDE ? 150 : run_between(r, 40, 90);
    if (run_below(r, 5) == 0) c->far_m = run_between(r, 10, 80);
    if (how == VIEW_FAR_OFF || s->kind == SCENE_PANES) c->far_m = INFINITY;
    for (int i = 0; i < 3; ++i) c->forward[i] = run_between(r, -1, 1) * (i == 1 ? 0.5 : 1);
    if (run_below(r, 4) == 0) { // along an axis
        memset(c->forward, 0, sizeof c->forward);
        c->forward[run_below(r, 2) * 2] = run_below(r, 2) ? 1 : -1;
    } else if ((how == VIEW_NARROW || how == VIEW_FAR_OFF || run_below(r, 2)) && s->zone.item_count) { // at something
        const cull_box *b = &s->boxes[run_below(r, s->zone.item_count)];
        for (int i = 0; i < 3; ++i) c->forward[i] = ((double)(&b->min.x)[i] + (double)(&b->max.x)[i]) / 2 - c->eye[i];
    }
    const double length = sqrt(dot(c->forward, c->forward));
    if (!(length > 1e-3) || fabs(c->forward[1]) > 0.999 * length) memcpy(c->forward, (double[3]){1, 0.25, 0.5}, sizeof c->forward);
}

static void wanted_add(view_wanted *w, const double normal[3], const double through[3])
{
    double *p = w->planes[w->plane_count++];
    memcpy(p, normal, 3 * sizeof *p);
    p[3] = -dot(normal, through);
}

// A window's edges from the picture's points a to b: inside is to the left. Through the eye, guarded as a portal's edges are.
static void window_add(check_run *r, const made_scene *s, made_view *v)
{
    const uint32_t n = v->volume_count++, sides = 3 + run_below(r, 4);
    const double x = run_between(r, -0.6, 0.6) * v->wide, y = run_between(r, -0.6, 0.6) * v->tall;
    const double size = run_between(r, 0.05, 0.7) * v->tall, turn = run_between(r, 0, 6.28);
    cull_guard guard = {.pixel_tangent = v->view.pixel_tangent, .reach = v->view.reach, .radius = (double)s->zone.radius};
    memcpy(guard.eye, v->view.eye_exact, sizeof guard.eye);
    memcpy(guard.forward, v->view.forward, sizeof guard.forward);
    v->wanted[n].plane_count = 0;
    for (uint32_t i = 0; i < sides; ++i) {
        const double angle = turn + 6.283185307179586 * i / sides, nx = -cos(angle), ny = -sin(angle), away = size - (nx * x + ny * y);
        double normal[3]; // nx X + ny Y + away Z >= 0
        for (int k = 0; k < 3; ++k) normal[k] = nx * v->axes[0][k] + ny * v->axes[1][k] + away * v->axes[2][k];
        const double length = sqrt(dot(normal, normal));
        for (int k = 0; k < 3; ++k) normal[k] /= length;
        v->planes[n][i] = cull_guard_plane(&guard, normal, 0);
        wanted_add(&v->wanted[n], normal, v->camera.eye);
    }
    v->volumes[n] = (cull_volume){v->planes[n], sides, 0};
}

// Planes along axes that end exactly at a box's side: not guarded, as plain arithmetic on them is exact.
static void slab_add(check_run *r, const made_scene *s, made_view *v)
{
    const uint32_t n = v->volume_count++, sides = 1 + run_below(r, 4);
    v->wanted[n].plane_count = 0;
    for (uint32_t i = 0; i < sides; ++i) {
        const cull_box *b = &s->boxes[run_below(r, s->zone.item_count)];
        const uint32_t axis = run_below(r, 3);
        const double at = (double)(run_below(r, 2) ? &b->min.x : &b->max.x)[axis], eye = v->camera.eye[axis];
        const float sign = eye >= at ? 1.0f : -1.0f; // the eye's side: what is seen through a volume is seen from the eye
        double normal[3] = {0, 0, 0}, through[3] = {0, 0, 0};
        cull_plane plane = {{0, 0, 0}, -sign * (float)at};
        (&plane.normal.x)[axis] = sign;
        normal[axis] = (double)sign;
        through[axis] = at;
        v->planes[n][i] = plane;
        wanted_add(&v->wanted[n], normal, through);
    }
    v->volumes[n] = (cull_volume){v->planes[n], sides, 0};
}

void view_make(check_run *r, const made_scene *s, view_how how, made_view *v)
{
    view_make_from(r, s, how, NULL, v);
}

void view_make_from(check_run *r, const made_scene *s, view_how how, const double *eye, made_view *v)
{
    const double origin[3] = {0, 0, 0};
    view_volume whole;
    *v = (made_view){.volume_count = 0};
    place_camera(r, s, how, eye, &v->camera);
    const view_frame frame = {VIEW_WIDTH_PX, VIEW_HEIGHT_PX, 1, 0, CULL_VIEW_MAIN};
    double back[3];
    camera_axes(&v->camera, v->axes[0], v->axes[1], back);
    for (int i = 0; i < 3; ++i) v->axes[2][i] = -back[i];
    v->tall = tan(v->camera.fovy_deg * (3.14159265358979323846 / 360));
    v->wide = v->tall * v->camera.aspect;
    view_derive(&v->camera, &frame, origin, &s->zone.box, &v->view, &whole);
    if (how == VIEW_WINDOWS)
        for (uint32_t i = 1 + run_below(r, VIEW_VOLUMES_MOST); i-- > 0;) window_add(r, s, v);
    else if (how == VIEW_SLABS && s->zone.item_count)
        for (uint32_t i = 1 + run_below(r, 3); i-- > 0;) slab_add(r, s, v);
    else { // its wanted planes are the picture's, see view_wants
        v->volume_count = 1;
        memcpy(v->planes[0], whole.planes, whole.plane_count * sizeof *whole.planes);
        v->volumes[0] = (cull_volume){v->planes[0], whole.plane_count, 0};
    }
}

static int is_within(const view_wanted *w, const double p[3])
{
    for (uint32_t i = 0; i < w->plane_count; ++i)
        if (!(dot(w->planes[i], p) + w->planes[i][3] > 0)) return 0;
    return 1;
}

int view_wants(const made_view *v, const double p[3])
{
    double to[3];
    for (int i = 0; i < 3; ++i) to[i] = p[i] - v->camera.eye[i];
    const double x = dot(to, v->axes[0]), y = dot(to, v->axes[1]), z = dot(to, v->axes[2]);
    if (!(z > v->camera.near_m * (1 + 1e-6) && z < v->camera.far_m) || !(fabs(x) < v->wide * z && fabs(y) < v->tall * z)) return 0;
    for (uint32_t i = 0; i < v->volume_count; ++i)
        if (is_within(&v->wanted[i], p)) return 1;
    return 0;
}

view_rect view_rect_of(const made_view *v, const cull_box *box)
{
    view_rect rect = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    int behind = 0;
    for (int corner = 0; corner < 8; ++corner) {
        double to[3];
        for (int i = 0; i < 3; ++i) to[i] = (double)(corner >> i & 1 ? &box->max.x : &box->min.x)[i] - v->camera.eye[i];
        const double z = dot(to, v->axes[2]), x = dot(to, v->axes[0]) / (v->wide * z), y = dot(to, v->axes[1]) / (v->tall * z);
        behind += z < v->camera.near_m;
        rect.low[0] = fmin(rect.low[0], x), rect.high[0] = fmax(rect.high[0], x);
        rect.low[1] = fmin(rect.low[1], y), rect.high[1] = fmax(rect.high[1], y);
    }
    if (behind == 8) return (view_rect){{1, 1}, {-1, -1}};
    if (behind) return (view_rect){{-1, -1}, {1, 1}};
    const double wide = 2.0 / VIEW_HEIGHT_PX; // a pixel
    for (int i = 0; i < 2; ++i) rect.low[i] = fmax(rect.low[i] - wide, -1), rect.high[i] = fmin(rect.high[i] + wide, 1);
    return rect;
}
