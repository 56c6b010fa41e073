// From what hides in space to what it covers on the picture: see hiz_setup.h; included by each kernel, all in double.
// SPDX-License-Identifier: MIT
#include "hiz_setup.h"

// Of the terms of a depth: floats of it are rounded a few times by 2^-24, the renderer's too.
#define DEPTH_ROUNDING (1.0 / 1048576)
#define DENORMAL_GUARD 1e-30  // what is less counts as none: the far end covers it, and denormal floats take CPUs a hundred cycles
#define LEVEL_EDGE 1e-6 // rise of an edge below which it bounds rows instead of columns

typedef struct polygon_setup {
    const hiz_view *view;
    hiz_polygon *out;
    double low, high; // rows: of centres that may be covered
    int is_sound;
} polygon_setup;

static inline void setup_begin(polygon_setup *s, const int32_t within[4])
{
    hiz_polygon *p = s->out;
    p->left_count = p->right_count = 0;
    p->planes = (hiz_planes){.count = 0}; // compilers compute with planes that are not there: garbage may be denormal, and slow
    p->x0 = within[0];
    p->y0 = within[1];
    p->x1 = within[2];
    p->y1 = within[3];
    s->low = p->y0;
    s->high = p->y1;
    s->is_sound = 1;
}

// Keeps the side where a * x + b * y + c >= 0, less `inset` pixels.
static inline void line_add(polygon_setup *s, double a, double b, double c, double inset)
{
    hiz_polygon *p = s->out;
    const double margin = inset * (fabs(a) + fabs(b));
    const double *const cell = s->view->inset_cell, inwards = margin + (cell[0] * fabs(a) + cell[1] * fabs(b));
    if (a == 0 && b == 0) { // the same everywhere; all 0: an edge without length
        s->is_sound &= c >= 0;
        return;
    }
    if (fabs(a) <= LEVEL_EDGE * fabs(b)) {
        const double row = (inwards + fabs(a) * HIZ_WIDTH_MOST - c) / b;
        if (b > 0 && row > s->low) s->low = row;
        if (b < 0 && row < s->high) s->high = row;
        s->is_sound &= row == row;
        return;
    }
    const double at = (inwards - c) / a, slope = fabs(b) > DENORMAL_GUARD * fabs(a) ? -b / a : 0;
    uint32_t *count = a > 0 ? &p->left_count : &p->right_count;
    s->is_sound &= *count < HIZ_EDGES_MOST && fabs(at) < 1e30 && fabs(slope) < 1e30;
    if (!s->is_sound) return;
    (a > 0 ? p->left_at : p->right_at)[*count] = (float)at;
    (a > 0 ? p->left_slope : p->right_slope)[*count] = (float)slope;
    ++*count;
}

// The plane through the eye, normal e, the polygon on its positive side.
static inline void edge_add(polygon_setup *s, const double e[3], double inset)
{
    const double(*r)[3] = s->view->ray;
    double line[3];
    for (int i = 0; i < 3; i++) line[i] = e[0] * r[0][i] + e[1] * r[1][i] + e[2] * r[2][i];
    line_add(s, line[0], line[1], line[2], inset);
}

static inline void cross3(const double a[3], const double b[3], double sign, double out[3])
{
    out[0] = sign * (a[1] * b[2] - a[2] * b[1]);
    out[1] = sign * (a[2] * b[0] - a[0] * b[2]);
    out[2] = sign * (a[0] * b[1] - a[1] * b[0]);
}

// depth = (n . ray) / height at the pixel's far end. cuts: what is nearer than the near plane is not covered.
typedef enum near_cut { NEAR_CLEAR, NEAR_CUT } near_cut;
static inline void plane_add(polygon_setup *s, const double normal[3], double height, near_cut cut)
{
    const double(*r)[3] = s->view->ray;
    hiz_planes *p = &s->out->planes;
    double d[3], size[3];
    for (int i = 0; i < 3; i++) {
        const double x = normal[0] * r[0][i] / height, y = normal[1] * r[1][i] / height, z = normal[2] * r[2][i] / height;
        d[i] = x + y + z;
        size[i] = fabs(x) + fabs(y) + fabs(z);
    }
    if (cut == NEAR_CUT) line_add(s, -d[0], -d[1], 1 / (s->view->near_w * (1 + 1.0 / 1024)) - d[2], s->view->inset_px);
    const double span = size[0] * s->view->width_px + size[1] * s->view->height_px + size[2];
    const double far_end = (fabs(d[0]) + fabs(d[1])) * 0.5 * (1 + 1.0 / 64) + HIZ_WIDTH_MOST * 2 * DENORMAL_GUARD + DEPTH_ROUNDING * span;
    p->a[p->count] = fabs(d[0]) > DENORMAL_GUARD ? (float)d[0] : 0;
    p->b[p->count] = fabs(d[1]) > DENORMAL_GUARD ? (float)d[1] : 0;
    p->c[p->count] = (float)(d[2] - far_end);
    s->is_sound &= span < 1e30;
    p->count++;
}

static inline int setup_finish(polygon_setup *s)
{
    hiz_polygon *p = s->out;
    if (!s->is_sound || p->planes.count == 0) return 0;
    const double first = ceil(s->low - 0.5), end = floor(s->high - 0.5) + 1; // of row y the centre is y + 1/2
    if (first > p->y0) p->y0 = first < p->y1 ? (int32_t)first : p->y1;
    if (end < p->y1) p->y1 = end > p->y0 ? (int32_t)end : p->y0;
    return p->x0 < p->x1 && p->y0 < p->y1;
}

// ---- Boxes ----

typedef struct box_edge { uint8_t from, to, beside; } box_edge; // corners: bit 0: greater x, 1: y, 2: z; beside: the face behind the edge
// Faces -x, +x, -y, +y, -z, +z, counterclockwise from outside.
static const box_edge box_edges[6][4] = {
    {{0, 4, 2}, {4, 6, 5}, {6, 2, 3}, {2, 0, 4}}, {{1, 3, 4}, {3, 7, 3}, {7, 5, 5}, {5, 1, 2}}, {{0, 1, 4}, {1, 5, 1}, {5, 4, 5}, {4, 0, 0}},
    {{2, 6, 0}, {6, 7, 5}, {7, 3, 1}, {3, 2, 4}}, {{0, 2, 0}, {2, 3, 3}, {3, 1, 1}, {1, 0, 2}}, {{4, 5, 2}, {5, 7, 1}, {7, 6, 3}, {6, 4, 0}},
};

static inline double larger_of(double a, double b)
{
    return a > b ? a : b; // a call of fmax costs more
}

// A corner so far off, of what comes so near: w_least may be behind the eye, what is drawn begins at near_w.
static inline double inset_of(const hiz_view *v, double farthest, double w_least)
{
    return v->inset_px + v->rounding_px * HIZ_ROUNDING * farthest / (w_least > v->near_w ? w_least : v->near_w);
}

// A convex body covers its outline, as deep as the least of its front faces: no edge between two of them can leave a gap.
// within: x0, y0, x1, y1 as of hiz_polygon. 0: it covers nothing for sure.
static inline int setup_box(const hiz_view *v, const cull_box *box, const int32_t within[4], hiz_polygon *out)
{
    polygon_setup s = {.view = v, .out = out};
    const double low[3] = {(double)box->min.x - v->eye_exact[0], (double)box->min.y - v->eye_exact[1], (double)box->min.z - v->eye_exact[2]};
    const double high[3] = {(double)box->max.x - v->eye_exact[0], (double)box->max.y - v->eye_exact[1], (double)box->max.z - v->eye_exact[2]};
    double corners[8][3], w_least = 0;
    uint32_t fronts = 0;
    setup_begin(&s, within);
    for (int k = 0; k < 3; k++) fronts |= (low[k] > 0 ? 1u : high[k] < 0 ? 2u : 0u) << (2 * k);
    for (int k = 0; k < 3; k++) w_least += (double)v->row_w[k] * (v->row_w[k] > 0 ? low[k] : high[k]);
    const near_cut cut = w_least > (double)v->near_up ? NEAR_CLEAR : NEAR_CUT;
    double farthest = 0;
    for (int k = 0; k < 3; k++) farthest += larger_of(fabs(low[k]), fabs(high[k]));
    const double inset = inset_of(v, farthest, w_least);
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++) corners[i][k] = i >> k & 1 ? high[k] : low[k];
    for (int face = 0; face < 6; face++) {
        if (!(fronts >> face & 1)) continue;
        const int axis = face / 2;
        const double normal[3] = {axis == 0, axis == 1, axis == 2};
        plane_add(&s, normal, face & 1 ? high[axis] : low[axis], cut);
        for (int i = 0; i < 4; i++) {
            const box_edge *edge = &box_edges[face][i];
            double e[3];
            if (fronts >> edge->beside & 1) continue;
            cross3(corners[edge->from], corners[edge->to], -1, e);
            edge_add(&s, e, inset);
        }
    }
    return setup_finish(&s);
}

// ---- Polygons ----

// All of it lies before the eye: only pixels whose centres its points stand round.
static void bounds_tighten(const hiz_view *v, const hiz_loop *loop, hiz_polygon *p)
{
    double low[2] = {p->x0, p->y0}, high[2] = {p->x1, p->y1}, least[2] = {HUGE_VAL, HUGE_VAL}, most[2] = {-HUGE_VAL, -HUGE_VAL};
    for (uint32_t i = 0; i < loop->count; i++) {
        const double *q = loop->points[i];
        const double w = (double)v->row_w[0] * q[0] + (double)v->row_w[1] * q[1] + (double)v->row_w[2] * q[2];
        const double at[2] = {((double)v->row_x[0] * q[0] + (double)v->row_x[1] * q[1] + (double)v->row_x[2] * q[2]) / w,
                              ((double)v->row_y[0] * q[0] + (double)v->row_y[1] * q[1] + (double)v->row_y[2] * q[2]) / w};
        for (int k = 0; k < 2; k++) {
            least[k] = at[k] < least[k] ? at[k] : least[k];
            most[k] = at[k] > most[k] ? at[k] : most[k];
        }
    }
    for (int k = 0; k < 2; k++) {
        const double first = ceil(least[k] - 0.5), end = floor(most[k] - 0.5) + 1;
        low[k] = first > low[k] ? first : low[k];
        high[k] = end < high[k] ? end : high[k];
        if (!(low[k] < high[k])) high[k] = low[k] = 0;
    }
    p->x0 = (int32_t)low[0];
    p->x1 = (int32_t)high[0];
    p->y0 = (int32_t)low[1];
    p->y1 = (int32_t)high[1];
}

static int setup_loop(const hiz_view *v, const hiz_loop *loop, const int32_t within[4], hiz_polygon *out)
{
    polygon_setup s = {.view = v, .out = out};
    double nearest = HUGE_VAL, farthest = -HUGE_VAL, w_least = HUGE_VAL, reach = 0;
    setup_begin(&s, within);
    for (uint32_t i = 0; i < loop->count; i++) {
        const double *p = loop->points[i];
        const double height = loop->normal[0] * p[0] + loop->normal[1] * p[1] + loop->normal[2] * p[2];
        const double w = (double)v->row_w[0] * p[0] + (double)v->row_w[1] * p[1] + (double)v->row_w[2] * p[2];
        nearest = height < nearest ? height : nearest;
        farthest = height > farthest ? height : farthest;
        w_least = w < w_least ? w : w_least;
        reach = larger_of(reach, fabs(p[0]) + fabs(p[1]) + fabs(p[2]));
    }
    if (!(nearest > 0 || farthest < 0)) return 0; // seen on edge, or no number
    if (w_least > (double)v->near_up) bounds_tighten(v, loop, out);
    if (out->x0 >= out->x1 || out->y0 >= out->y1) return 0;
    s.low = out->y0;
    s.high = out->y1;
    const int is_front = farthest < 0;
    plane_add(&s, loop->normal, is_front ? nearest : farthest, w_least > (double)v->near_up ? NEAR_CLEAR : NEAR_CUT);
    for (uint32_t i = 0; i < loop->count; i++) {
        const uint32_t next = i + 1 < loop->count ? i + 1 : 0;
        double e[3];
        cross3(loop->points[i], loop->points[next], is_front ? -1 : 1, e);
        edge_add(&s, e, inset_of(v, reach, w_least));
    }
    return setup_finish(&s);
}
