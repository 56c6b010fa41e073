// Rays against every triangle: see sight.h. Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
// SPDX-License-Identifier: MIT
#include "sight.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Of the triangle's own measures, without unit: coordinates are floats, computed on in double, so rounding is 2^-50 of them; a
// renderer may move a vertex by 2^-24 of its place, and 1e-4 is far beyond both.
static const double EDGE = 1e-4;
static const double SAME = 1e-5; // of the distance: two surfaces nearer than this hide one another by chance

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

typedef enum meeting { MEETS_NOT, MEETS_MAYBE, MEETS } meeting;

static meeting meet(const sight_ray *ray, const scene_triangle *t, double *at, int *shows_front)
{
    double e1[3], e2[3], p[3], q[3], s[3];
    for (int i = 0; i < 3; ++i) {
        e1[i] = t->p[1][i] - t->p[0][i];
        e2[i] = t->p[2][i] - t->p[0][i];
        s[i] = ray->from[i] - t->p[0][i];
    }
    cross(ray->along, e2, p);
    const double det = dot(e1, p), scale = sqrt(dot(e1, e1) * dot(e2, e2));
    if (!(fabs(det) > 1e-12 * scale)) return MEETS_NOT; // without area, or seen edge-on: shows nothing
    const double u = dot(s, p) / det;
    cross(s, e1, q);
    const double v = dot(ray->along, q) / det;
    if (u < -EDGE || v < -EDGE || u + v > 1 + EDGE) return MEETS_NOT;
    *at = dot(e2, q) / det;
    *shows_front = det > 0;
    const int is_sure = fabs(det) > 1e-5 * scale && u > EDGE && v > EDGE && u + v < 1 - EDGE;
    return is_sure ? MEETS : MEETS_MAYBE;
}

static int box_is_missed(const sight_ray *ray, const made_scene *s, uint32_t item)
{
    const cull_box *b = &s->boxes[item];
    const view_rect *at = ray->rects ? &ray->rects[item] : NULL;
    if (at && (ray->x < at->low[0] || ray->x > at->high[0] || ray->y < at->low[1] || ray->y > at->high[1])) return 1;
    double low = 0, high = INFINITY;
    for (int i = 0; i < 3; ++i) {
        const double wide = 1e-3 * (1 + (double)((&b->max.x)[i] - (&b->min.x)[i])); // metres: EDGE of any triangle within
        const double from = (double)(&b->min.x)[i] - wide - ray->from[i], to = (double)(&b->max.x)[i] + wide - ray->from[i];
        if (ray->along[i] == 0) {
            if (from > 0 || to < 0) return 1;
            continue;
        }
        const double a = from / ray->along[i], c = to / ray->along[i];
        low = fmax(low, fmin(a, c));
        high = fmin(high, fmax(a, c));
    }
    return low > high;
}

static int shows_back_only(const made_scene *s, uint32_t item, int shows_front)
{
    return !shows_front && (s->flags[item] & (CULL_ITEM_WALL | CULL_ITEM_TWO_SIDED)) == CULL_ITEM_WALL;
}

typedef struct cast { double wall, sure_wall; uint32_t wall_item; sight_hit veils[SIGHT_HITS_MOST]; uint32_t veil_count; } cast;

static void cast_item(const made_scene *s, const sight_ray *ray, uint32_t item, cast *c)
{
    const int hides = !(s->flags[item] & (CULL_ITEM_SEE_THROUGH | CULL_ITEM_CUT_OUT));
    for (uint32_t t = s->first_triangle[item]; t < s->first_triangle[item + 1]; ++t) {
        double at;
        int front;
        const meeting m = meet(ray, &s->triangles[t], &at, &front);
        if (m == MEETS_NOT || at < ray->near_m || at > ray->far_m) continue;
        if (ray->backs == SIGHT_BACKS_LEFT_OUT && shows_back_only(s, item, front)) continue;
        if (!hides) {
            if (m == MEETS && c->veil_count < SIGHT_HITS_MOST - 1) c->veils[c->veil_count++] = (sight_hit){item, at};
            continue;
        }
        if (item == c->wall_item ? at < c->wall : at < c->wall * (1 + SAME)) { // another's as near takes the certainty away
            const int is_near = item != c->wall_item && at > c->wall * (1 - SAME);
            if (at < c->wall) c->wall = at, c->wall_item = item;
            c->sure_wall = m == MEETS && !is_near ? at : INFINITY;
        }
    }
}

uint32_t sight_cast(const made_scene *s, const sight_ray *ray, sight_hit hits[SIGHT_HITS_MOST])
{
    cast c = {.wall = INFINITY, .sure_wall = INFINITY, .wall_item = UINT32_MAX};
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->zone.item_count; ++i)
        if (!box_is_missed(ray, s, i)) cast_item(s, ray, i, &c);
    for (uint32_t k = 0; k < c.veil_count; ++k)
        if (c.veils[k].at < c.wall * (1 - SAME)) hits[count++] = c.veils[k];
    if (c.wall < INFINITY && c.sure_wall == c.wall) hits[count++] = (sight_hit){c.wall_item, c.wall};
    return count;
}

double sight_depth_of(const made_scene *s, const sight_ray *ray, uint32_t item)
{
    double depth = INFINITY;
    for (uint32_t t = s->first_triangle[item]; t < s->first_triangle[item + 1]; ++t) {
        double at;
        int front;
        if (meet(ray, &s->triangles[t], &at, &front) != MEETS || at < ray->near_m || at > ray->far_m || at >= depth) continue;
        if (ray->backs == SIGHT_BACKS_LEFT_OUT && shows_back_only(s, item, front)) continue;
        depth = at;
    }
    return depth;
}

int sight_meets(const made_scene *s, const sight_ray *ray)
{
    cast c = {.wall = INFINITY, .sure_wall = INFINITY, .wall_item = UINT32_MAX};
    for (uint32_t i = 0; i < s->zone.item_count && c.wall == INFINITY; ++i)
        if (!box_is_missed(ray, s, i)) cast_item(s, ray, i, &c);
    return c.wall < INFINITY;
}

static void mark_ray(const made_scene *s, const made_view *v, const sight_ray *ray, uint8_t *must)
{
    sight_hit hits[SIGHT_HITS_MOST];
    const uint32_t count = sight_cast(s, ray, hits);
    for (uint32_t i = 0; i < count; ++i) {
        double p[3];
        for (int k = 0; k < 3; ++k) p[k] = ray->from[k] + hits[i].at * ray->along[k];
        if (view_wants(v, p)) must[hits[i].item] = 1;
    }
}

typedef struct sight_look { sight_backs backs; const view_rect *rects; } sight_look;

// x, y: in the picture, -1 to 1. along has the length 1 along forward, so that distances are depths.
static sight_ray ray_through(const made_view *v, const sight_look *look, double x, double y)
{
    sight_ray ray = {.near_m = v->camera.near_m, .far_m = v->camera.far_m, .backs = look->backs, .rects = look->rects, .x = x, .y = y};
    for (int i = 0; i < 3; ++i) {
        ray.from[i] = v->camera.eye[i];
        ray.along[i] = v->axes[2][i] + x * v->wide * v->axes[0][i] + y * v->tall * v->axes[1][i];
    }
    return ray;
}

// At a point of a triangle of the item.
static void mark_aimed(check_run *r, const made_scene *s, const made_view *v, const sight_look *look, uint32_t item, uint8_t *must)
{
    const uint32_t first = s->first_triangle[item], count = s->first_triangle[item + 1] - first;
    if (!count) return;
    const scene_triangle *t = &s->triangles[first + run_below(r, count)];
    double a = run_between(r, 0.05, 0.9), b = run_between(r, 0.05, 0.9), to[3];
    if (a + b > 0.95) a = 0.95 - a, b = 0.95 - b;
    if (a < 0.01 || b < 0.01) a = b = 1.0 / 3;
    for (int i = 0; i < 3; ++i) to[i] = t->p[0][i] + a * (t->p[1][i] - t->p[0][i]) + b * (t->p[2][i] - t->p[0][i]) - v->camera.eye[i];
    const double depth = dot(to, v->axes[2]);
    if (!(depth > v->camera.near_m)) return;
    sight_ray ray = ray_through(v, look, dot(to, v->axes[0]) / (depth * v->wide), dot(to, v->axes[1]) / (depth * v->tall));
    for (int i = 0; i < 3; ++i) ray.along[i] = to[i] / depth; // exactly there, not by the picture's place
    if (view_wants(v, (double[3]){ray.from[0] + to[0], ray.from[1] + to[1], ray.from[2] + to[2]})) mark_ray(s, v, &ray, must);
}

// From the middle nothing stands behind another: a corner within is a point to be seen.
static void mark_panes(const made_scene *s, const made_view *v, uint8_t *must)
{
    for (uint32_t t = 0; t < s->triangle_count; ++t)
        for (int k = 0; k < 3; ++k)
            if (view_wants(v, s->triangles[t].p[k])) must[s->triangles[t].item] = 1;
}

static void mark_samples(const made_scene *s, const made_view *v, const sight_look *look, uint8_t *must)
{
    for (uint32_t i = 0; i < VIEW_WIDTH_PX * VIEW_HEIGHT_PX; ++i) {
        const double x = (i % VIEW_WIDTH_PX + 0.5) * 2 / VIEW_WIDTH_PX - 1, y = (i / VIEW_WIDTH_PX + 0.5) * 2 / VIEW_HEIGHT_PX - 1;
        const sight_ray ray = ray_through(v, look, x, y);
        mark_ray(s, v, &ray, must);
    }
}

void sight_mark(check_run *r, const made_scene *s, const made_view *v, sight_backs backs, sight_rays how, uint32_t count, uint8_t *must)
{
    if (how == SIGHT_ANYWHERE && s->kind == SCENE_PANES) {
        mark_panes(s, v, must);
        return;
    }
    view_rect *rects = calloc(s->zone.item_count + 1u, sizeof *rects);
    if (!rects) abort();
    for (uint32_t i = 0; i < s->zone.item_count; ++i) rects[i] = view_rect_of(v, &s->boxes[i]);
    const sight_look look = {backs, rects};
    if (how == SIGHT_SAMPLES) mark_samples(s, v, &look, must);
    for (uint32_t i = 0; how == SIGHT_ANYWHERE && i < count; ++i) {
        const sight_ray ray = ray_through(v, &look, run_between(r, -1, 1), run_between(r, -1, 1));
        mark_ray(s, v, &ray, must);
    }
    for (uint32_t item = 0; how == SIGHT_ANYWHERE && item < s->zone.item_count; ++item) mark_aimed(r, s, v, &look, item, must);
    free(rects);
}
