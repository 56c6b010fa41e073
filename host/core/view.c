// Cameras to views and volumes: see view.h. All in double from the camera; floats only at the very end.
// SPDX-License-Identifier: MIT
#include "view.h"

#include <portcullis/plane.h>

#include <assert.h>
#include <math.h>
#include <string.h>

// A turn of `up` by rounding is 2^-52 over this: far below the guard band's 2^-20.
static const double LEAST_SINE_UP_FORWARD = 1.0 / 1048576;
static const double MOST_EYE_M = 1e18;                       // products of coordinates stay finite with room
static const double LEAST_NEAR_M = 1e-30, MOST_NEAR_M = 1e30; // near_distance and the matrix are floats
static const double LEAST_ASPECT = 1.0 / 1024, MOST_ASPECT = 1024;
static const double PI = 3.14159265358979323846;

static double dot(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

// Not fmax: that is a call.
static double larger(double a, double b)
{
    return a > b ? a : b;
}

// Returns 0 for no direction. Squares of denormal or huge components would be lost: those are scaled first, by a power of
// two, which changes no other bit.
static int unit(const double v[3], double out[3])
{
    const double largest = larger(fabs(v[0]), larger(fabs(v[1]), fabs(v[2])));
    if (!(largest > 0) || !isfinite(largest)) return 0;
    double scaled[3] = {v[0], v[1], v[2]};
    if (largest < 1e-100 || largest > 1e100) {
        int exponent;
        (void)frexp(largest, &exponent);
        for (int i = 0; i < 3; i++) scaled[i] = ldexp(v[i], -exponent);
    }
    const double inverse = 1 / sqrt(dot(scaled, scaled));
    for (int i = 0; i < 3; i++) out[i] = scaled[i] * inverse;
    return 1;
}

static int is_finite3(const double v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

const char *camera_fault(const camera *c)
{
    if (!is_finite3(c->eye)) return "the eye is not finite";
    for (int i = 0; i < 3; i++)
        if (fabs(c->eye[i]) > MOST_EYE_M) return "the eye is more than 1e18 m away";
    if (!is_finite3(c->forward) || !is_finite3(c->up)) return "forward or up is not finite";
    if (!(c->fovy_deg >= 1 && c->fovy_deg <= 170)) return "the vertical field of view is not within 1 to 170 degrees";
    if (!(c->aspect >= LEAST_ASPECT && c->aspect <= MOST_ASPECT)) return "the aspect is not within 1/1024 to 1024";
    if (!(c->near_m >= LEAST_NEAR_M && c->near_m <= MOST_NEAR_M)) return "near is not within 1e-30 to 1e30 m";
    if (!(c->far_m > c->near_m)) return "far is not beyond near";
    double forward[3], up[3], right[3];
    if (!unit(c->forward, forward)) return "forward is zero";
    if (!unit(c->up, up)) return "up is zero";
    cross(forward, up, right);
    if (!(dot(right, right) > LEAST_SINE_UP_FORWARD * LEAST_SINE_UP_FORWARD)) return "up is parallel to forward";
    return NULL;
}

void camera_axes(const camera *c, double right[3], double up[3], double back[3])
{
    double forward[3], wanted_up[3], side[3];
    const int is_usable = unit(c->forward, forward) && unit(c->up, wanted_up);
    assert(is_usable);
    (void)is_usable;
    cross(forward, wanted_up, side);
    (void)unit(side, right);
    for (int i = 0; i < 3; i++) back[i] = 0.0 - forward[i]; // not -0: bits of a matrix are compared
    cross(back, right, side);
    for (int i = 0; i < 3; i++) up[i] = side[i]; // of unit length as those two are at right angles
}

// Half the picture's height at distance 1.
static double half_tangent(const camera *c)
{
    return tan(c->fovy_deg * (PI / 360));
}

static void clip_from_eye(const camera *c, const view_base *s, double out[16])
{
    const double share = c->near_m / c->far_m; // 0 for an infinite far; below 1 as near < far, even of neighbours
    const double slope = share / (1 - share), at_zero = c->near_m / (1 - share);
    for (int i = 0; i < 3; i++) {
        out[4 * i + 0] = s->right[i] / s->wide;
        out[4 * i + 1] = s->up[i] / s->tall;
        out[4 * i + 2] = slope * s->back[i];
        out[4 * i + 3] = 0.0 - s->back[i];
    }
    out[12] = out[13] = out[15] = 0;
    out[14] = at_zero;
}

static void shape_make(const camera *c, view_base *s)
{
    camera_axes(c, s->right, s->up, s->back);
    s->tall = half_tangent(c);
    s->wide = s->tall * c->aspect;
}

void camera_clip_from_eye(const camera *c, double out[16])
{
    view_base s;
    shape_make(c, &s);
    clip_from_eye(c, &s, out);
}

// The side of the picture where `axis`, turned by `sign`, reaches `tangent`: through the eye, the picture inside.
static void side_make(view_base *b, const cull_guard *guard, const double axis[3], double sign, double tangent)
{
    const double inverse = 1 / sqrt(1 + tangent * tangent);
    double normal[3];
    for (int i = 0; i < 3; i++) normal[i] = (sign * axis[i] + tangent * guard->forward[i]) * inverse;
    b->sides[b->side_count++] = cull_guard_direction(guard, normal, 0);
}

static void sides_make(view_base *b)
{
    const cull_guard guard = {.forward = {-b->back[0], -b->back[1], -b->back[2]}, .pixel_tangent = b->pixel_tangent, .reach = b->reach};
    for (int sign = -1; sign <= 1; sign += 2) {
        side_make(b, &guard, b->right, sign, b->wide);
        side_make(b, &guard, b->up, sign, b->tall);
    }
    if (isfinite(b->camera->far_m)) b->sides[b->side_count++] = cull_guard_direction(&guard, b->back, b->camera->far_m);
}

void view_base_make(const camera *c, const view_frame *f, view_base *out)
{
    assert(!camera_fault(c) && f->width_px > 0 && f->height_px > 0);
    *out = (view_base){.camera = c, .frame = *f};
    shape_make(c, out);
    out->pixel_tangent = larger(2 * out->tall / f->height_px, 2 * out->wide / f->width_px);
    const double tall = out->tall + out->pixel_tangent, wide = out->wide + out->pixel_tangent;
    out->reach = sqrt((tall * tall + wide * wide) + 1);
    clip_from_eye(c, out, out->clip_from_eye);
    sides_make(out);
}

double view_plane_height(const cull_plane *p, const cull_box *b)
{
    const double n[3] = {(double)p->normal.x, (double)p->normal.y, (double)p->normal.z};
    const double low[3] = {(double)b->min.x, (double)b->min.y, (double)b->min.z};
    const double high[3] = {(double)b->max.x, (double)b->max.y, (double)b->max.z};
    double height = (double)p->offset;
    for (int i = 0; i < 3; i++) height += n[i] * (n[i] >= 0 ? low[i] : high[i]);
    return height;
}

static void matrix_derive(const view_base *b, const double eye[3], float out[16])
{
    double m[16];
    memcpy(m, b->clip_from_eye, sizeof m);
    for (int row = 0; row < 4; row++) {
        const double line[3] = {m[row], m[4 + row], m[8 + row]};
        m[12 + row] -= dot(line, eye);
    }
    for (int i = 0; i < 16; i++) out[i] = (float)m[i];
}

void view_eye_in_zone(const view_base *b, const view_place *z, double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = (b->camera->eye[i] - z->origin[i]) + 0.0; // never -0
}

void view_in_zone(const view_base *b, const view_place *z, cull_view *view)
{
    memset(view, 0, sizeof *view);
    view_eye_in_zone(b, z, view->eye_exact);
    for (int i = 0; i < 3; i++) {
        view->eye[i] = (float)view->eye_exact[i];
        view->forward[i] = -b->back[i];
    }
    view->eye[3] = 1;
    view->eye_exact[3] = 1;
    view->pixel_tangent = b->pixel_tangent;
    view->reach = b->reach;
    matrix_derive(b, view->eye_exact, view->clip_from_zone);
    view->pixels_per_tangent = (float)(b->frame.height_px / (2 * b->tall));
    view->near_distance = (float)b->camera->near_m;
    view->width_px = b->frame.width_px;
    view->height_px = b->frame.height_px;
    view->purpose = b->frame.purpose;
    view->frame = b->frame.frame;
    view->flags = b->frame.flags;
}

void view_volume_in_zone(const view_base *b, const view_place *z, view_volume *volume)
{
    double eye[3];
    view_eye_in_zone(b, z, eye);
    volume->plane_count = 0;
    for (uint32_t i = 0; i < b->side_count; i++) {
        const cull_plane plane = cull_guarded_at(&b->sides[i], eye, (double)z->radius);
        if (view_plane_height(&plane, &z->box) >= 0) continue; // the whole zone is inside
        volume->sides[volume->plane_count] = i;
        volume->planes[volume->plane_count++] = plane;
    }
}

void view_derive(const camera *c, const view_frame *f, const double zone_origin[3], const cull_box *zone_box, cull_view *view,
                 view_volume *volume)
{
    view_base base;
    view_place place = {.box = *zone_box, .radius = cull_box_radius(*zone_box)};
    memcpy(place.origin, zone_origin, sizeof place.origin);
    view_base_make(c, f, &base);
    view_in_zone(&base, &place, view);
    view_volume_in_zone(&base, &place, volume);
}
