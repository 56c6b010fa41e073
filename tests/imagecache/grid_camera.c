// Random views of a ground and oracles: see grid_camera.h.
// SPDX-License-Identifier: MIT
#include "grid_camera.h"

#include <portcullis/plane.h>

#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

// ---- Views ----

grid_turn grid_turn_level(uint64_t *r, double fov)
{
    const grid_turn t = {random_between(r, -PI, PI), 0, 0, fov};
    return t;
}

grid_turn grid_turn_random(uint64_t *r)
{
    grid_turn t = grid_turn_level(r, random_between(r, 20, 120) * PI / 180);
    const double kind = random_unit(r);
    t.pitch = kind < 0.1 ? 0 : kind < 0.5 ? random_between(r, -0.4, 0.4) : kind < 0.55 ? -PI / 2 : kind < 0.6 ? PI / 2 : random_between(r, -PI / 2, PI / 2);
    t.roll = random_unit(r) < 0.4 ? 0 : random_between(r, -PI, PI);
    if (random_unit(r) < 0.1) t.heading = PI / 4 * (double)random_below(r, 8);
    return t;
}

static void axes_of(grid_turn t, grid_view *v)
{
    const double ch = cos(t.heading), sh = sin(t.heading), cp = cos(t.pitch), sp = sin(t.pitch);
    const double flat[3] = {-sh, 0, ch}, forward[3] = {ch * cp, sp, sh * cp};
    double up[3];
    cross(flat, forward, up);
    for (int k = 0; k < 3; k++) {
        v->forward[k] = forward[k];
        v->right[k] = cos(t.roll) * flat[k] + sin(t.roll) * up[k];
        v->up[k] = cos(t.roll) * up[k] - sin(t.roll) * flat[k];
    }
}

static void planes_of(const ground *g, grid_view *v)
{
    enum { WIDE = 1280 };
    const double side = g->size * (double)(g->columns > g->rows ? g->columns : g->rows);
    cull_guard guard = {.pixel_tangent = 2 * v->tan_wide / WIDE, .reach = sqrt(1 + v->tan_wide * v->tan_wide + v->tan_tall * v->tan_tall)};
    guard.radius = fmax(fmax(fabs(g->x), fabs(g->z)) + side, fmax(fabs(g->low), fabs(g->high)));
    memcpy(guard.eye, v->eye, sizeof guard.eye);
    memcpy(guard.forward, v->forward, sizeof guard.forward);
    for (int k = 0; k < 4; k++) {
        const double *across = k < 2 ? v->right : v->up, tangent = k < 2 ? v->tan_wide : v->tan_tall, length = sqrt(1 + tangent * tangent);
        double n[3];
        for (int i = 0; i < 3; i++) n[i] = (tangent * v->forward[i] + (k % 2 ? -1 : 1) * across[i]) / length;
        v->planes[k] = cull_guard_plane(&guard, n, 0);
    }
    const double back[3] = {-v->forward[0], -v->forward[1], -v->forward[2]};
    v->planes[4] = cull_guard_plane(&guard, back, v->far_m);
    v->volume = (cull_volume){v->planes, GRID_SIDES, 0};
}

void grid_view_random(uint64_t *r, const ground *g, grid_turn turn, grid_eyes eyes, grid_view *out)
{
    const double wide = g->size * g->columns, deep = g->size * g->rows, tall = g->high - g->low, whole = wide + deep + tall;
    const double out_by = eyes == GRID_EYES_INSIDE || random_unit(r) < 0.6 ? 0 : random_unit(r) < 0.5 ? 0.5 : 5;
    out->eye[0] = g->x + wide * random_between(r, -out_by, 1 + out_by);
    out->eye[1] = g->low + tall * random_between(r, -out_by, 1 + out_by);
    out->eye[2] = g->z + deep * random_between(r, -out_by, 1 + out_by);
    if (eyes == GRID_EYES_ANYWHERE && random_unit(r) < 0.05) out->eye[0] = g->x + g->size * random_below(r, g->columns + 1); // on a border
    axes_of(turn, out);
    out->tan_wide = tan(turn.fov / 2);
    out->tan_tall = out->tan_wide * (eyes == GRID_EYES_INSIDE ? 9.0 / 16 : random_between(r, 0.3, 1.2));
    // The report's view is a triangle with its far edge within the ground; else as far as anything, or somewhere within.
    out->far_m = random_unit(r) < 0.5 ? 16 * whole : whole * random_between(r, 0.02, 1);
    if (eyes == GRID_EYES_INSIDE) out->far_m = fmax(wide, deep) / 2;
    for (int c = 0; c < 4; c++)
        for (int k = 0; k < 3; k++)
            out->corners[c][k] = out->eye[k] + out->far_m * (out->forward[k] + (c & 1 ? 1 : -1) * out->tan_wide * out->right[k] +
                                                             (c & 2 ? 1 : -1) * out->tan_tall * out->up[k]);
    planes_of(g, out);
}

// ---- The oracle of touching ----

static void axis_add(grid_oracle *o, const grid_view *v, const double axis[3])
{
    const double length = sqrt(dot(axis, axis));
    if (length < 1e-9) return; // nearly parallel edges: the other axes tell
    double *to = o->axes[o->count];
    for (int k = 0; k < 3; k++) to[k] = axis[k] / length;
    o->low[o->count] = o->high[o->count] = dot(to, v->eye);
    for (int c = 0; c < 4; c++) {
        const double at = dot(to, v->corners[c]);
        o->low[o->count] = fmin(o->low[o->count], at);
        o->high[o->count] = fmax(o->high[o->count], at);
    }
    o->count++;
}

void grid_oracle_of(const ground *g, const grid_view *v, grid_oracle *out)
{
    static const double UNITS[3][3] = {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
    double edges[6][3];
    out->count = 0;
    out->margin = 1e-6 * g->size + 1e-12 * (fabs(g->x) + fabs(g->z) + v->far_m * 4);
    for (int c = 0; c < 4; c++)
        for (int k = 0; k < 3; k++) edges[c][k] = (v->corners[c][k] - v->eye[k]) / v->far_m;
    memcpy(edges[4], v->right, sizeof edges[4]);
    memcpy(edges[5], v->up, sizeof edges[5]);
    for (int u = 0; u < 3; u++) axis_add(out, v, UNITS[u]);
    for (int u = 0; u < 3; u++)
        for (int e = 0; e < 6; e++) {
            double axis[3];
            cross(UNITS[u], edges[e], axis);
            axis_add(out, v, axis);
        }
    static const int FACES[5][2] = {{0, 1}, {1, 3}, {3, 2}, {2, 0}, {4, 5}};
    for (int f = 0; f < 5; f++) {
        double axis[3];
        cross(edges[FACES[f][0]], edges[FACES[f][1]], axis);
        axis_add(out, v, axis);
    }
}

double grid_gap(const grid_oracle *o, const ground *g, ground_cell c)
{
    const double half[3] = {g->size / 2, (g->high - g->low) / 2, g->size / 2};
    const double middle[3] = {g->x + (c.i + 0.5) * g->size, (g->low + g->high) / 2, g->z + (c.j + 0.5) * g->size};
    double gap = -INFINITY;
    for (uint32_t a = 0; a < o->count; a++) {
        const double *axis = o->axes[a], at = dot(axis, middle);
        const double reach = fabs(axis[0]) * half[0] + fabs(axis[1]) * half[1] + fabs(axis[2]) * half[2];
        gap = fmax(gap, fmax(o->low[a] - (at + reach), (at - reach) - o->high[a]));
        if (gap > o->margin) return gap;
    }
    return gap;
}

// ---- The oracle of order ----

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

uint32_t grid_ray(uint64_t *r, const ground *g, const grid_view *v, ground_cell *cells)
{
    static double times[GRID_RAY_CELLS];
    double way[3];
    const double s = random_between(r, -1, 1) * v->tan_wide, t = random_between(r, -1, 1) * v->tan_tall;
    for (int k = 0; k < 3; k++) way[k] = v->forward[k] + s * v->right[k] + t * v->up[k];
    uint32_t count = 0, found = 0;
    times[count++] = 0;
    for (uint32_t i = 0; i <= g->columns; i++) {
        const double at = (g->x + i * g->size - v->eye[0]) / way[0];
        if (at > 0 && at < 1e12) times[count++] = at;
    }
    for (uint32_t j = 0; j <= g->rows; j++) {
        const double at = (g->z + j * g->size - v->eye[2]) / way[2];
        if (at > 0 && at < 1e12) times[count++] = at;
    }
    qsort(times, count, sizeof *times, compare);
    for (uint32_t k = 0; k + 1 < count; k++) {
        const double middle = (times[k] + times[k + 1]) / 2, length = (times[k + 1] - times[k]) * sqrt(way[0] * way[0] + way[2] * way[2]);
        const double i = floor((v->eye[0] + middle * way[0] - g->x) / g->size), j = floor((v->eye[2] + middle * way[2] - g->z) / g->size);
        if (length < 1e-6 * g->size || i < 0 || j < 0 || i >= g->columns || j >= g->rows) continue;
        cells[found++] = (ground_cell){(int32_t)i, (int32_t)j};
    }
    return found;
}
