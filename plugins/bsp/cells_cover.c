// Which ways an opening is shut: what walls in its plane leave of it, fragment by fragment.
// SPDX-License-Identifier: MIT
//
// Invariant: shut from one side only where every point of the opening lies within 1.75 slack of a wall's piece that hides from there
// (a wall is taken with its edges moved out by slack, its sharp corners cut off at slack), or in slivers narrower than slack whose area
// is less than slack times the opening's perimeter (where edges meet at a sharp angle, rounding moves the corner by more); every other
// doubt leaves it open.
#include "cells_build.h"

#include <math.h>

typedef struct fragment { uint32_t first, count; } fragment; // points in the scratch list

enum { WALL_CUTS_MOST = 128 }; // edges and sharp corners; a wall of more hides nothing

typedef struct wall_cuts { cull_cut cuts[WALL_CUTS_MOST]; uint32_t count; } wall_cuts; // inside: not negative

typedef struct bounds { double low[3], high[3]; } bounds;

typedef struct cover {
    cells_build *b;
    bsp_vector *points; // scratch, cull_point
    bounds bounds;      // of the opening
    uint32_t plane;     // that it lies in
    fragment fragments[CELLS_FRAGMENTS_MOST];
    uint32_t count;
} cover;

typedef enum cover_step { COVER_DONE, COVER_GIVEN_UP, COVER_NO_MEMORY } cover_step;

// ---- A wall's piece as cuts ----

static cull_point minus(cull_point a, cull_point b)
{
    const cull_point d = {a.x - b.x, a.y - b.y, a.z - b.z};
    return d;
}

static int unit(cull_point *v)
{
    const double length = sqrt((v->x * v->x + v->y * v->y) + v->z * v->z);
    if (!(length > 0)) return 0;
    v->x /= length;
    v->y /= length;
    v->z /= length;
    return 1;
}

// Inside is against `out`, which is a unit vector; through `at`, moved out by `slack`.
static int cut_add(wall_cuts *w, cull_point out, cull_point at, double slack)
{
    if (w->count == WALL_CUTS_MOST) return 0;
    const cull_cut cut = {-out.x, -out.y, -out.z, (out.x * at.x + out.y * at.y) + out.z * at.z + slack};
    w->cuts[w->count++] = cut;
    return 1;
}

static cull_point cross(const double n[3], cull_point d)
{
    const cull_point c = {n[1] * d.z - n[2] * d.y, n[2] * d.x - n[0] * d.z, n[0] * d.y - n[1] * d.x};
    return c;
}

static double distance_to_segment(cull_point a, cull_point b, cull_point at)
{
    const cull_point way = minus(b, a), d = minus(at, a);
    const double square = (way.x * way.x + way.y * way.y) + way.z * way.z, along = (way.x * d.x + way.y * d.y) + way.z * d.z;
    const double t = !(square > 0) || along < 0 ? 0 : along > square ? 1 : along / square;
    const cull_point off = {d.x - t * way.x, d.y - t * way.y, d.z - t * way.z};
    return sqrt((off.x * off.x + off.y * off.y) + off.z * off.z);
}

// All corners between `from` and `to`, going round.
static int is_straight(const cull_point *p, uint32_t count, uint32_t from, uint32_t to, double most)
{
    for (uint32_t i = from + 1; i < to; i++)
        if (!(distance_to_segment(p[from % count], p[to % count], p[i % count]) <= most)) return 0;
    return 1;
}

// Without the corners that edges run through: an edge between two of them is turned by rounding the more the shorter it is, and its line
// would cut off the rest of the wall. The farthest from any point is a true corner. Returns how many are left.
static uint32_t straightened(const cull_point *p, uint32_t count, double most, cull_point out[WALL_CUTS_MOST])
{
    uint32_t first = 0, kept = 0;
    double farthest = -1;
    for (uint32_t i = 0; i < count; i++) {
        const cull_point d = minus(p[i], p[0]);
        const double square = (d.x * d.x + d.y * d.y) + d.z * d.z;
        if (square > farthest) farthest = square, first = i;
    }
    for (uint32_t at = first, end = first + count; at < end;) {
        uint32_t next = at + 1;
        while (next < end && is_straight(p, count, at, next + 1, most)) next++;
        out[kept++] = p[at % count];
        at = next;
    }
    return kept;
}

// n: the unit normal that the points run counterclockwise about. 0: no cuts can be made of it.
static int wall_cuts_make(wall_cuts *w, const cull_point *points, uint32_t count, const double n[3], double slack)
{
    cull_point last = {0, 0, 0}, first = {0, 0, 0};
    uint32_t edges = 0;
    w->count = 0;
    for (uint32_t i = 0; i < count; i++) {
        cull_point along = minus(points[i + 1 < count ? i + 1 : 0], points[i]), out;
        if (!unit(&along)) continue; // a corner that stands twice
        out = cross(n, along); // to the left: inside
        if (!unit(&out)) return 0;
        out = (cull_point){-out.x, -out.y, -out.z};
        if (!cut_add(w, out, points[i], slack)) return 0;
        cull_point corner = minus(last, along); // out of the corner, along its bisector
        if (edges && last.x * along.x + last.y * along.y + last.z * along.z < 0 && unit(&corner) && !cut_add(w, corner, points[i], slack)) return 0;
        if (!edges) first = along;
        last = along;
        edges++;
    }
    cull_point corner = minus(last, first);
    if (edges >= 3 && last.x * first.x + last.y * first.y + last.z * first.z < 0 && unit(&corner) && !cut_add(w, corner, points[0], slack)) return 0;
    return edges >= 3;
}

// ---- Fragments ----

static const cull_point *fragment_points(const cover *c, fragment f)
{
    return (const cull_point *)c->points->items + f.first;
}

static fragment clipped(cover *c, fragment f, cull_cut cut) // room was reserved
{
    fragment out = {c->points->count, 0};
    out.count = cull_polygon_clip(fragment_points(c, f), f.count, cut, (cull_point *)c->points->items + out.first, 2 * f.count);
    if (out.count < 3) out.count = 0;
    c->points->count += out.count;
    return out;
}

static int reserve_for(cover *c, fragment f)
{
    return f.count < UINT32_MAX / 8 && vector_reserve(c->points, 4 * f.count) != 0;
}

// 1: the fragment and the wall have something in common.
static cover_step meets(cover *c, fragment f, const wall_cuts *w, int *out)
{
    const uint32_t mark = c->points->count;
    for (uint32_t i = 0; i < w->count && f.count; i++) {
        if (!reserve_for(c, f)) return COVER_NO_MEMORY;
        f = clipped(c, f, w->cuts[i]);
    }
    *out = f.count > 0;
    c->points->count = mark;
    return COVER_DONE;
}

// What of fragment `at` lies outside the wall takes its place, the rest behind the last.
static cover_step subtract(cover *c, uint32_t at, const wall_cuts *w)
{
    fragment f = c->fragments[at];
    int common;
    const cover_step step = meets(c, f, w, &common);
    if (step != COVER_DONE || !common) return step;
    c->fragments[at].count = 0;
    for (uint32_t i = 0; i < w->count && f.count; i++) {
        const cull_cut in = w->cuts[i], out = {-in.x, -in.y, -in.z, -in.offset};
        if (!reserve_for(c, f)) return COVER_NO_MEMORY;
        const fragment outside = clipped(c, f, out);
        f = clipped(c, f, in);
        if (outside.count == 0) continue;
        if (c->count == CELLS_FRAGMENTS_MOST) return COVER_GIVEN_UP;
        c->fragments[c->count++] = outside;
    }
    return COVER_DONE;
}

static void drop_empty(cover *c)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < c->count; i++)
        if (c->fragments[i].count) c->fragments[kept++] = c->fragments[i];
    c->count = kept;
}

typedef struct extent { double area, perimeter; } extent;

static extent extent_of(const cull_point *p, uint32_t count)
{
    extent out = {0, 0};
    double sum[3] = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++) {
        const cull_point u = minus(p[i], p[0]), v = minus(p[i + 1 < count ? i + 1 : 0], p[0]), along = minus(v, u);
        sum[0] += u.y * v.z - u.z * v.y;
        sum[1] += u.z * v.x - u.x * v.z;
        sum[2] += u.x * v.y - u.y * v.x;
        out.perimeter += sqrt((along.x * along.x + along.y * along.y) + along.z * along.z);
    }
    out.area = 0.5 * sqrt((sum[0] * sum[0] + sum[1] * sum[1]) + sum[2] * sum[2]);
    return out;
}

static int is_sliver(const cells_build *b, extent e)
{
    return 2 * e.area <= b->slack * e.perimeter;
}

// What is left is slivers alone: each holds no circle of slack, and all of them together are no more than a rim of slack.
static int are_slivers(const cover *c, extent whole)
{
    const double slack = c->b->slack;
    double area = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        const extent e = extent_of(fragment_points(c, c->fragments[i]), c->fragments[i].count);
        if (!is_sliver(c->b, e)) return 0;
        area += e.area;
    }
    return area <= slack * whole.perimeter;
}

// ---- Walls and portals that border the two cells ----

typedef struct shutter { const cull_point *points; uint32_t count; } shutter;

static bounds bounds_of(const cull_point *points, uint32_t count)
{
    bounds out = {{0, 0, 0}, {0, 0, 0}};
    for (uint32_t i = 0; i < count; i++) {
        const double c[3] = {points[i].x, points[i].y, points[i].z};
        for (int k = 0; k < 3; k++) {
            if (i == 0 || c[k] < out.low[k]) out.low[k] = c[k];
            if (i == 0 || c[k] > out.high[k]) out.high[k] = c[k];
        }
    }
    return out;
}

static int bounds_touch(const bounds *a, const bounds *b, double slack)
{
    for (int k = 0; k < 3; k++)
        if (a->low[k] - slack > b->high[k] || a->high[k] + slack < b->low[k]) return 0;
    return 1;
}

// 0: it has no area. plane: that both lie in, to tell which way the points run.
static int shutter_cuts(const cells_build *b, const shutter *s, uint32_t plane, wall_cuts *out)
{
    const double *n = cells_plane(b, plane)->normal;
    double normal[3] = {n[0], n[1], n[2]}, turn = 0;
    for (uint32_t i = 1; i + 1 < s->count; i++) {
        const cull_point u = minus(s->points[i], s->points[0]), v = minus(s->points[i + 1], s->points[0]);
        turn += n[0] * (u.y * v.z - u.z * v.y) + n[1] * (u.z * v.x - u.x * v.z) + n[2] * (u.x * v.y - u.y * v.x);
    }
    for (int i = 0; i < 3 && turn < 0; i++) normal[i] = -n[i];
    cull_point corners[WALL_CUTS_MOST];
    if (s->count > WALL_CUTS_MOST) return 0;
    return wall_cuts_make(out, corners, straightened(s->points, s->count, b->slack / 4, corners), normal, b->slack);
}

static cover_step subtract_all(cover *c, const shutter *s)
{
    wall_cuts w;
    const bounds own = bounds_of(s->points, s->count);
    if (!bounds_touch(&own, &c->bounds, c->b->slack) || !shutter_cuts(c->b, s, c->plane, &w)) return COVER_DONE;
    for (uint32_t i = 0, count = c->count; i < count; i++) {
        const cover_step step = subtract(c, i, &w);
        if (step != COVER_DONE) return step;
    }
    drop_empty(c);
    return COVER_DONE;
}

typedef struct run { uint32_t first, count; } run; // of entries

// Walls in the opening's plane that face the side `of`: the cell there lists them as fronts, the other as backs. The shorter list.
static run walls_of(const cells_build *b, const cells_interface *found, uint32_t of)
{
    const bsp_cell *cells = b->cells.items, *front = &cells[found->cells[of]], *back = &cells[found->cells[!of]];
    const run fronts = {front->first_entry, front->entry_count}, backs = {back->first_back, back->back_count};
    return fronts.count <= backs.count ? fronts : backs;
}

// Those that face the side `of` and hide from eyes on `side`: two-sided ones hide from both.
static cover_step subtract_walls(cover *c, run walls, uint32_t of, uint32_t side)
{
    const cells_build *b = c->b;
    cover_step step = COVER_DONE;
    for (uint32_t i = walls.first; i < walls.first + walls.count && step == COVER_DONE && c->count > 0; i++) {
        const bsp_entry *e = (const bsp_entry *)b->entries.items + i;
        const uint32_t flags = b->zone->items[b->tree->order[e->item]].flags;
        int facing;
        c->b->work++;
        if (e->point_count == 0 || flags & (CULL_ITEM_SEE_THROUGH | CULL_ITEM_CUT_OUT) || (of != side && !(flags & CULL_ITEM_TWO_SIDED))) continue;
        const shutter s = {(const cull_point *)b->entry_points.items + e->first_point, e->point_count};
        if (cells_lie_in(b, s.points, s.count, e->plane, c->plane, &facing) && facing == (of ? -1 : 1)) step = subtract_all(c, &s);
    }
    return step;
}

// A portal ends the zone for who looks out. Who looks in comes from outside: nothing stops him there.
static cover_step subtract_portals(cover *c, uint32_t cell, uint32_t side)
{
    const cells_build *b = c->b;
    const cells_made *own = (const cells_made *)b->made.items + cell;
    cover_step step = COVER_DONE;
    for (uint32_t i = own->first_stand; i < own->first_stand + own->stand_count && step == COVER_DONE && c->count > 0; i++) {
        const cells_stand *stand = (const cells_stand *)b->stands.items + i;
        const shutter s = {(const cull_point *)b->points.items + stand->first_point, stand->point_count};
        int facing;
        if (cells_lie_in(b, s.points, s.count, stand->plane, c->plane, &facing) && facing == (side ? -1 : 1)) step = subtract_all(c, &s);
    }
    return step;
}

// What is left open of an opening that has an area.
static int is_left_open(const cover *c, cover_step step, extent whole)
{
    return c->count > 0 && (step != COVER_DONE || is_sliver(c->b, whole) || !are_slivers(c, whole));
}

static double area_of(const cover *c)
{
    double sum = 0;
    for (uint32_t i = 0; i < c->count; i++) sum += extent_of(fragment_points(c, c->fragments[i]), c->fragments[i].count).area;
    return sum;
}

typedef struct cover_sight { int is_open, is_open_without_portals, is_at_portals; } cover_sight;

static cells_status cover_side(cover *c, const cells_interface *found, const cull_point *points, uint32_t side, cover_sight *out)
{
    bsp_vector *scratch = c->points;
    scratch->count = 0;
    cull_point *own = vector_push(scratch, found->point_count);
    if (!own) return CELLS_NO_MEMORY;
    memcpy(own, points, found->point_count * sizeof *own);
    c->fragments[0] = (fragment){0, found->point_count};
    c->count = 1;
    const extent whole = extent_of(points, found->point_count);
    cover_step step = COVER_DONE;
    for (uint32_t of = 0; of < 2 && step == COVER_DONE; of++) step = subtract_walls(c, walls_of(c->b, found, of), of, side);
    out->is_open_without_portals = is_left_open(c, step, whole);
    const double area = area_of(c);
    if (step == COVER_DONE) step = subtract_portals(c, found->cells[side], side); // one in the cell beyond ends that cell, not the way there
    out->is_open = is_left_open(c, step, whole);
    out->is_at_portals = out->is_open_without_portals && (step != COVER_DONE || area - area_of(c) > c->b->slack * whole.perimeter);
    if (step == COVER_GIVEN_UP) c->b->given_up++;
    return step == COVER_NO_MEMORY ? CELLS_NO_MEMORY : CELLS_FINE;
}

cells_status cells_cover(cells_build *b, cells_interface *found, bsp_vector *scratch)
{
    const cull_point *points = (const cull_point *)b->opening_points.items + found->first_point;
    cover c = {.b = b, .points = scratch, .plane = found->plane, .bounds = bounds_of(points, found->point_count)};
    cells_status status = CELLS_FINE;
    found->open = found->by_portals = found->at_portals = 0;
    found->is_sliver = (uint32_t)is_sliver(b, extent_of(points, found->point_count));
    for (uint32_t side = 0; side < 2 && status == CELLS_FINE; side++) {
        cover_sight sight;
        status = cover_side(&c, found, points, side, &sight);
        if (status != CELLS_FINE) continue;
        if (sight.is_open) found->open |= 1u << side;
        else if (sight.is_open_without_portals) found->by_portals |= 1u << side;
        if (sight.is_at_portals) found->at_portals |= 1u << side;
    }
    return status;
}
