// Random cases for the bounds, and the oracle: straight projection in long double.
// SPDX-License-Identifier: MIT
#include "bound_cases.h"

#include "tests/common/random.h"

#include <string.h>

static double log_between(uint64_t *state, double low, double high)
{
    return exp(random_between(state, log(low), log(high)));
}

static long double dot(const long double a[3], const long double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const long double a[3], const long double b[3], long double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void unit(double a[3])
{
    const double length = sqrt(bound_dot(a, a));
    for (int k = 0; k < 3; k++) a[k] /= length;
}

// Two directions at right angles to a unit one, turned about it by chance.
static void across(uint64_t *state, const double axis[3], double first[3], double second[3])
{
    double any[3];
    do {
        random_direction(state, any);
        bound_cross(axis, any, first);
    } while (bound_dot(first, first) < 0.01);
    unit(first);
    bound_cross(axis, first, second);
}

static double border_or_inside(uint64_t *state, double wide)
{
    return random_below(state, 3) == 0 ? (random_below(state, 2) ? wide : -wide) : random_between(state, -wide, wide);
}

void case_look_at(uint64_t *state, const double point[3], const double wide[2], bound_view *view)
{
    double there[3], local[3] = {border_or_inside(state, wide[0]), border_or_inside(state, wide[1]), 1};
    double there_first[3], there_second[3], local_first[3], local_second[3];
    bound_subtract(point, view->eye, there);
    unit(there);
    unit(local);
    across(state, there, there_first, there_second);
    across(state, local, local_first, local_second);
    // The rotation that takes local to there.
    for (int k = 0; k < 3; k++) {
        view->forward[k] = there[k] * local[2] + there_first[k] * local_first[2] + there_second[k] * local_second[2];
        view->right[k] = there[k] * local[0] + there_first[k] * local_first[0] + there_second[k] * local_second[0];
    }
    unit(view->forward);
    const double along = bound_dot(view->right, view->forward);
    for (int k = 0; k < 3; k++) view->right[k] -= along * view->forward[k];
    unit(view->right);
    bound_cross(view->right, view->forward, view->up);
}

static void optics_random(uint64_t *state, bound_optics *optics, double wide[2])
{
    static const uint32_t sizes[3][2] = {{1280, 720}, {1024, 1024}, {640, 1136}};
    const uint32_t *size = sizes[random_below(state, 3)];
    const double fov = random_between(state, 20, 120) * 3.14159265358979 / 180;
    wide[0] = tan(fov / 2);
    wide[1] = wide[0] * size[1] / size[0];
    if (wide[1] > 1.75) { // the taller side has the field of view, then
        wide[0] *= 1.75 / wide[1];
        wide[1] = 1.75;
    }
    optics->pixels_per_tangent = size[0] / 2.0 / wide[0];
    optics->reach = sqrt(1 + wide[0] * wide[0] + wide[1] * wide[1]);
}

static void box_random(uint64_t *state, cull_box *box, double *radius)
{
    float low[3], high[3];
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const double half = log_between(state, 0.5, 20), centre = random_between(state, -500, 500);
        low[k] = (float)(centre - half);
        high[k] = (float)(centre + half);
        square += half * half;
    }
    *radius = sqrt(square);
    box->min = (cull_vec3){low[0], low[1], low[2]};
    box->max = (cull_vec3){high[0], high[1], high[2]};
}

static void middle_of_box(const cull_box *box, double out[3])
{
    out[0] = ((double)box->min.x + box->max.x) / 2;
    out[1] = ((double)box->min.y + box->max.y) / 2;
    out[2] = ((double)box->min.z + box->max.z) / 2;
}

static int is_outside(const cull_box *box, const double eye[3])
{
    const double low[3] = {box->min.x, box->min.y, box->min.z}, high[3] = {box->max.x, box->max.y, box->max.z};
    for (int k = 0; k < 3; k++)
        if (eye[k] < low[k] || eye[k] > high[k]) return 1;
    return 0;
}

// The view of the frame: moved, and turned at will or little.
static void move_view(uint64_t *state, case_motion motion, double distance, bound_case *out)
{
    double way[3], point[3];
    random_direction(state, way);
    const double moved = motion == MOTION_TURNED ? 0 : distance * log_between(state, 1e-5, motion == MOTION_CENTRE ? 0.02 : 0.33);
    out->view = out->taken;
    for (int k = 0; k < 3; k++) out->view.eye[k] += moved * way[k];
    if (motion == MOTION_CENTRE) {
        const double turned = log_between(state, 1e-4, 0.1);
        double axis[3];
        random_direction(state, axis);
        for (int k = 0; k < 3; k++) out->view.forward[k] += turned * axis[k];
        unit(out->view.forward);
        const double along = bound_dot(out->view.right, out->view.forward);
        for (int k = 0; k < 3; k++) out->view.right[k] -= along * out->view.forward[k];
        unit(out->view.right);
        bound_cross(out->view.right, out->view.forward, out->view.up);
        return;
    }
    case_point(state, &out->box, point);
    case_look_at(state, point, out->wide, &out->view);
}

bound_case case_random(uint64_t *state, case_motion motion)
{
    for (;;) {
        bound_case out;
        double radius, way[3], middle[3], point[3];
        memset(&out, 0, sizeof out);
        box_random(state, &out.box, &radius);
        optics_random(state, &out.taken.optics, out.taken_wide);
        memcpy(out.wide, out.taken_wide, sizeof out.wide);
        random_direction(state, way);
        middle_of_box(&out.box, middle);
        const double distance = radius * log_between(state, 1.2, 40);
        for (int k = 0; k < 3; k++) out.taken.eye[k] = middle[k] + distance * way[k];
        case_point(state, &out.box, point);
        case_look_at(state, point, out.taken_wide, &out.taken);
        quad_request request = {.box = out.box, .optics = out.taken.optics, .magnification = 1, .most_texels = 1u << 20};
        memcpy(request.eye, out.taken.eye, sizeof request.eye);
        if (quad_of(&request, &out.quad) != QUAD_OK) continue;
        out.capture = bound_capture_of(out.taken.eye, &out.box);
        move_view(state, motion, distance, &out);
        if (is_outside(&out.box, out.view.eye)) return out;
    }
}

void case_point(uint64_t *state, const cull_box *box, double out[3])
{
    const double low[3] = {box->min.x, box->min.y, box->min.z}, high[3] = {box->max.x, box->max.y, box->max.z};
    const uint32_t fixed = random_below(state, 8) | (random_below(state, 2) ? 1u << random_below(state, 3) : 0);
    for (uint32_t k = 0; k < 3; k++)
        out[k] = fixed >> k & 1 ? (random_below(state, 2) ? low[k] : high[k]) : random_between(state, low[k], high[k]);
}

void case_grid_point(const cull_box *box, uint32_t i, uint32_t side, double out[3])
{
    const double low[3] = {box->min.x, box->min.y, box->min.z}, high[3] = {box->max.x, box->max.y, box->max.z};
    const uint32_t face = i / (side * side), axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3, at = i % (side * side);
    out[axis] = face % 2 ? high[axis] : low[axis];
    out[u] = low[u] + (high[u] - low[u]) * (at % side) / (side - 1);
    out[v] = low[v] + (high[v] - low[v]) * (at / side) / (side - 1);
}

case_place place_of(const bound_view *view, const long double point[3])
{
    long double away[3], axes[3][3];
    for (int k = 0; k < 3; k++) {
        away[k] = point[k] - view->eye[k];
        axes[0][k] = view->right[k];
        axes[1][k] = view->up[k];
        axes[2][k] = view->forward[k];
    }
    const long double depth = dot(axes[2], away);
    if (!(depth > 0)) return (case_place){0, 0, 0};
    return (case_place){(double)(dot(axes[0], away) / depth), (double)(dot(axes[1], away) / depth), 1};
}

int place_inside(case_place place, const double wide[2])
{
    return place.in_front && fabs(place.x) <= wide[0] && fabs(place.y) <= wide[1];
}

static void numbers_of(cull_vec3 v, long double out[3])
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

case_image image_of(const quad *q, const double eye[3], const double point[3])
{
    long double corner[3], right[3], up[3], normal[3], to_corner[3], ray[3], in_plane[3];
    case_image out;
    numbers_of(q->corner, corner);
    numbers_of(q->right, right);
    numbers_of(q->up, up);
    cross(right, up, normal);
    for (int k = 0; k < 3; k++) {
        to_corner[k] = corner[k] - eye[k];
        ray[k] = (long double)point[k] - eye[k];
    }
    const long double t = dot(normal, to_corner) / dot(normal, ray);
    for (int k = 0; k < 3; k++) {
        out.point[k] = eye[k] + t * ray[k];
        in_plane[k] = out.point[k] - corner[k];
    }
    const long double rr = dot(right, right), uu = dot(up, up), ru = dot(right, up), pr = dot(in_plane, right), pu = dot(in_plane, up);
    out.u = (pr * uu - pu * ru) / (rr * uu - ru * ru);
    out.v = (pu * rr - pr * ru) / (rr * uu - ru * ru);
    return out;
}

static double apart_px(const bound_case *c, const double point[3], const long double shown[3])
{
    const long double truth[3] = {point[0], point[1], point[2]};
    const case_place a = place_of(&c->view, truth), b = place_of(&c->view, shown);
    if (!place_inside(a, c->wide) && !place_inside(b, c->wide)) return -1;
    if (!a.in_front || !b.in_front) return INFINITY;
    return hypot(a.x - b.x, a.y - b.y) * c->view.optics.pixels_per_tangent;
}

double shown_off_px(const bound_case *c, const double point[3])
{
    return apart_px(c, point, image_of(&c->quad, c->capture.eye, point).point);
}

double aligned_off_px(const bound_case *c, const quad *taken, const quad *shown, const double point[3])
{
    const case_image image = image_of(taken, c->capture.eye, point);
    long double corner[3], right[3], up[3], at[3];
    numbers_of(shown->corner, corner);
    numbers_of(shown->right, right);
    numbers_of(shown->up, up);
    for (int k = 0; k < 3; k++) at[k] = corner[k] + image.u * right[k] + image.v * up[k];
    return apart_px(c, point, at);
}

double deep_off_px(const bound_case *c, const double point[3], double depth_error)
{
    long double at[3];
    double ray[3];
    bound_subtract(point, c->capture.eye, ray);
    const double depth = bound_dot(ray, c->capture.normal);
    for (int k = 0; k < 3; k++) at[k] = point[k] + (long double)ray[k] * depth_error / depth;
    return apart_px(c, point, at);
}

double shown_off_tangent(const bound_case *c, const double eye[3], const double point[3])
{
    const case_image image = image_of(&c->quad, c->capture.eye, point);
    long double a[3], b[3], off[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (long double)point[k] - eye[k];
        b[k] = image.point[k] - eye[k];
    }
    cross(a, b, off);
    const long double along = dot(a, b);
    return along > 0 ? (double)(sqrtl(dot(off, off)) / along) : INFINITY;
}
