// See cells_sight.h.
// SPDX-License-Identifier: MIT
#include "cells_sight.h"

#include "tests/common/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GRID = 32, CORNERS_MOST = 256 };

typedef struct blocker { cull_point points[CORNERS_MOST]; uint32_t count, both; double normal[3], offset; } blocker;

typedef struct sight {
    const cull_zone *zone;
    const bsp_cells_data *cells;
    blocker *blockers;
    uint32_t blocker_count;
    uint32_t *starts, *members; // by grid cell
    uint8_t *inside;            // by cell: to be reached from the zone's portals; all where it has none
    double low[3], size[3], slack;
    uint64_t seed;
    sight_figures *f;
} sight;

// ---- Walls ----

static void blocker_normal(blocker *w)
{
    double n[3] = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < w->count; i++) {
        const cull_point a = w->points[0], b = w->points[i], c = w->points[i + 1];
        const double u[3] = {b.x - a.x, b.y - a.y, b.z - a.z}, v[3] = {c.x - a.x, c.y - a.y, c.z - a.z};
        for (int k = 0; k < 3; k++) n[k] += u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    }
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++) w->normal[k] = length > 0 ? n[k] / length : 0;
    w->offset = -(w->normal[0] * w->points[0].x + w->normal[1] * w->points[0].y + w->normal[2] * w->points[0].z);
}

static void blockers_add(sight *s, const cull_vec3 *loop, const uint32_t *index, uint32_t count, uint32_t both)
{
    blocker *w = &s->blockers[s->blocker_count];
    if (count < 3 || count > CORNERS_MOST) return;
    w->count = count;
    w->both = both;
    for (uint32_t i = 0; i < count; i++) {
        const cull_vec3 p = loop[index ? index[i] : i];
        w->points[i] = (cull_point){(double)p.x, (double)p.y, (double)p.z};
    }
    blocker_normal(w);
    s->blocker_count++;
}

static void blockers_take(sight *s)
{
    const cull_zone *z = s->zone;
    s->blockers = calloc(z->item_count + z->portal_count + 1, sizeof *s->blockers);
    if (!s->blockers) abort();
    for (uint32_t i = 0; i < z->item_count && z->walls; i++) {
        if (z->items[i].flags & (CULL_ITEM_SEE_THROUGH | CULL_ITEM_CUT_OUT) || z->walls[i].vertex_count == 0) continue;
        blockers_add(s, z->positions, z->wall_vertices + z->walls[i].first_vertex, z->walls[i].vertex_count, z->items[i].flags & CULL_ITEM_TWO_SIDED);
    }
    for (uint32_t i = 0; i < z->portal_count; i++) blockers_add(s, z->portals[i].points, NULL, z->portals[i].point_count, 0);
}

static void grid_range(const sight *s, const double low[3], const double high[3], int from[3], int to[3])
{
    for (int k = 0; k < 3; k++) {
        from[k] = (int)floor((low[k] - s->low[k]) / s->size[k] * GRID);
        to[k] = (int)floor((high[k] - s->low[k]) / s->size[k] * GRID);
        from[k] = from[k] < 0 ? 0 : from[k] > GRID - 1 ? GRID - 1 : from[k];
        to[k] = to[k] < 0 ? 0 : to[k] > GRID - 1 ? GRID - 1 : to[k];
    }
}

static void grid_fill(sight *s, int count_only)
{
    for (uint32_t i = 0; i < s->blocker_count; i++) {
        const blocker *w = &s->blockers[i];
        double low[3], high[3];
        int from[3], to[3];
        for (uint32_t p = 0; p < w->count; p++) {
            const double c[3] = {w->points[p].x, w->points[p].y, w->points[p].z};
            for (int k = 0; k < 3; k++) {
                if (p == 0 || c[k] - 4 * s->slack < low[k]) low[k] = c[k] - 4 * s->slack;
                if (p == 0 || c[k] + 4 * s->slack > high[k]) high[k] = c[k] + 4 * s->slack;
            }
        }
        grid_range(s, low, high, from, to);
        for (int x = from[0]; x <= to[0]; x++)
            for (int y = from[1]; y <= to[1]; y++)
                for (int z = from[2]; z <= to[2]; z++) {
                    const int at = (x * GRID + y) * GRID + z;
                    if (count_only) s->starts[at + 1]++;
                    else s->members[s->starts[at]++] = i;
                }
    }
}

static void grid_make(sight *s)
{
    const int cells = GRID * GRID * GRID;
    for (int k = 0; k < 3; k++) {
        s->low[k] = s->cells->box_low[k];
        s->size[k] = s->cells->box_high[k] - s->low[k];
    }
    s->starts = calloc((size_t)cells + 1, sizeof *s->starts);
    if (!s->starts) abort();
    grid_fill(s, 1);
    for (int i = 0; i < cells; i++) s->starts[i + 1] += s->starts[i];
    s->members = calloc(s->starts[cells] + 1, sizeof *s->members);
    if (!s->members) abort();
    grid_fill(s, 0);
    memmove(s->starts + 1, s->starts, (size_t)cells * sizeof *s->starts);
    s->starts[0] = 0;
}

// Whether a wall hides at the point from eyes on the side of n (its direction towards the eye): one no farther off than `off`, of at
// least the cosine `along`, the point at least `depth` from its edges.
typedef struct hiding { double off, along, depth; uint32_t count; } hiding; // count: of blockers, the first; 0: all
static int is_hidden(const sight *s, const double p[3], const double n[3], hiding by)
{
    int from[3], to[3];
    grid_range(s, p, p, from, to);
    const int at = (from[0] * GRID + from[1]) * GRID + from[2];
    for (uint32_t i = s->starts[at]; i < s->starts[at + 1]; i++) {
        const blocker *w = &s->blockers[s->members[i]];
        if (by.count && s->members[i] >= by.count) continue;
        const double height = w->normal[0] * p[0] + w->normal[1] * p[1] + w->normal[2] * p[2] + w->offset;
        const double along = w->normal[0] * n[0] + w->normal[1] * n[1] + w->normal[2] * n[2];
        if (fabs(height) > by.off || (w->both ? fabs(along) : along) < by.along) continue;
        if (polygon_depth(w->points, w->count, w->normal, p) >= by.depth) return 1;
    }
    return 0;
}

// ---- Cells ----

// A portal alone hides.
static int is_beyond_portal(const sight *s, const double p[3], const double n[3])
{
    const uint32_t walls = s->blocker_count - s->zone->portal_count;
    const hiding by_all = {s->slack, 0.999, 0, 0}, by_walls = {s->slack, 0.999, 2 * s->slack, walls};
    return s->zone->portal_count && is_hidden(s, p, n, by_all) && !(walls && is_hidden(s, p, n, by_walls));
}

static int opening_is_beyond_portal(const sight *s, const bsp_opening *o)
{
    const cull_point *points = s->cells->opening_points + o->first_point;
    double p[3] = {0, 0, 0}, n[3];
    for (uint32_t i = 0; i < o->point_count; i++) {
        p[0] += points[i].x / o->point_count;
        p[1] += points[i].y / o->point_count;
        p[2] += points[i].z / o->point_count;
    }
    for (int k = 0; k < 3; k++) n[k] = s->cells->planes[o->plane].normal[k] * (o->side ? -1 : 1);
    return is_beyond_portal(s, p, n);
}

// Behind a portal lies another zone, which this one's cells fill too: nobody comes there, so what is open there is no leak.
static void inside_make(sight *s)
{
    const bsp_cells_data *c = s->cells;
    uint32_t *stack = calloc(c->cell_count + 1, sizeof *stack), count = 0;
    s->inside = calloc(c->cell_count + 1, 1);
    if (!stack || !s->inside) abort();
    for (uint32_t i = 0; i < c->cell_count; i++) s->inside[i] = c->stand_count == 0;
    for (uint32_t i = 0; i < c->stand_count; i++) {
        const uint32_t cell = c->stands[i].cell;
        if (!s->inside[cell]) stack[count++] = cell;
        s->inside[cell] = 1;
    }
    while (count) {
        const bsp_cell *from = &c->cells[stack[--count]];
        for (uint32_t i = 0; i < from->opening_count; i++) {
            const bsp_opening *o = &c->openings[from->first_opening + i];
            const uint32_t to = o->to;
            if (s->inside[to] || opening_is_beyond_portal(s, o)) continue;
            stack[count++] = to;
            s->inside[to] = 1;
        }
    }
    free(stack);
}

// ---- Segments ----

static void point_anywhere(sight *s, double out[3])
{
    const cull_box b = s->zone->box;
    const double low[3] = {(double)b.min.x, (double)b.min.y, (double)b.min.z}, high[3] = {(double)b.max.x, (double)b.max.y, (double)b.max.z};
    for (int k = 0; k < 3; k++) out[k] = random_between(&s->seed, low[k], high[k]);
}

// A point of a wall, moved off it by `off`; the wall.
static const blocker *point_at_wall(sight *s, double off, double out[3])
{
    const blocker *w = &s->blockers[random_below(&s->seed, s->blocker_count)];
    double sum = 0, weights[CORNERS_MOST];
    for (uint32_t i = 0; i < w->count; i++) sum += weights[i] = random_between(&s->seed, 0, 1);
    for (int k = 0; k < 3; k++) out[k] = off * w->normal[k];
    for (uint32_t i = 0; i < w->count; i++) {
        out[0] += w->points[i].x * weights[i] / sum;
        out[1] += w->points[i].y * weights[i] / sum;
        out[2] += w->points[i].z * weights[i] / sum;
    }
    return w;
}

static segment segment_random(sight *s, uint64_t number)
{
    segment out;
    point_anywhere(s, out.from);
    point_anywhere(s, out.to);
    if (s->blocker_count == 0 || number % 3 == 0) return out;
    const blocker *w = point_at_wall(s, number % 3 == 1 ? random_between(&s->seed, 0, 1) : random_between(&s->seed, -1e-6, 1e-6), out.from);
    if (number % 3 == 1) return out;
    const double off = random_between(&s->seed, -1e-6, 1e-6); // along the plane
    const double height = w->normal[0] * out.to[0] + w->normal[1] * out.to[1] + w->normal[2] * out.to[2] + w->offset - off;
    for (int k = 0; k < 3; k++) out.to[k] -= height * w->normal[k];
    return out;
}

static void crossing_judge(sight *s, const segment *g, const crossing *x)
{
    double p[3], n[3];
    for (int k = 0; k < 3; k++) {
        p[k] = g->from[k] + x->at * (g->to[k] - g->from[k]);
        n[k] = s->cells->planes[s->cells->nodes[x->node].plane].normal[k] * (x->side ? -1 : 1);
        if (p[k] < s->cells->box_low[k] || p[k] > s->cells->box_high[k]) {
            s->f->outside++;
            return;
        }
    }
    s->f->crossings++;
    if (opening_of(s->cells, x, p, s->slack)) {
        s->f->open++;
        if (!s->inside[x->from] || !is_hidden(s, p, n, (hiding){s->slack, 0.999, 2 * s->slack, 0})) return;
        if (is_beyond_portal(s, p, n)) s->f->beyond++;
        else s->f->leaky++;
        return;
    }
    s->f->shut++;
    if (is_hidden(s, p, n, (hiding){2 * s->slack, 0.5, 0, 0})) return;
    if (is_hidden(s, p, n, (hiding){3 * s->slack, 0.5, -3 * s->slack, 0})) {
        s->f->grazed++;
        return;
    }
    s->f->lost++;
    s->f->lost_segment = *g;
    memcpy(s->f->lost_at, p, sizeof p);
}

void sight_check(const cull_zone *zone, const bsp_tree *tree, const bsp_cells_data *cells, uint64_t segments, uint64_t seed, sight_figures *out)
{
    static segment_walk walk;
    sight s = {.zone = zone, .cells = cells, .slack = tree->slack, .seed = seed, .f = out};
    blockers_take(&s);
    grid_make(&s);
    inside_make(&s);
    for (uint32_t i = 0; i < cells->cell_count; i++) out->inside += s.inside[i];
    for (uint64_t i = 0; i < segments; i++) {
        const segment g = segment_random(&s, i);
        if (!segment_walk_make(cells, &g, &walk)) abort();
        out->segments++;
        for (uint32_t c = 0; c < walk.count; c++) {
            const crossing *x = &walk.crossings[c], back = {x->at, x->to, x->from, x->node, !x->side};
            crossing_judge(&s, &g, x);
            crossing_judge(&s, &g, &back);
        }
    }
    free(s.blockers);
    free(s.starts);
    free(s.members);
    free(s.inside);
}

void sight_print(const sight_figures *f)
{
    const uint64_t counts[] = {f->segments, f->crossings, f->open, f->shut, f->lost, f->grazed, f->leaky, f->beyond, f->outside, f->inside};
    static const char *const names[] = {"segments", "crossings", "open", "shut", "lost", "grazed", "leaky", "beyond", "outside", "cells inside"};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) printf("%s%llu %s", i ? ", " : "", (unsigned long long)counts[i], names[i]);
    putchar('\n');
    if (f->lost)
        printf("  lost at %.9g %.9g %.9g from %.9g %.9g %.9g to %.9g %.9g %.9g\n", f->lost_at[0], f->lost_at[1], f->lost_at[2], f->lost_segment.from[0],
               f->lost_segment.from[1], f->lost_segment.from[2], f->lost_segment.to[0], f->lost_segment.to[1], f->lost_segment.to[2]);
}
