// Planes of walls as whole numbers: see planes.h.
// SPDX-License-Identifier: MIT
//
// Where the zone has exact planes, vertices are their meeting points rounded to float's steps. Else each plane goes through
// three vertices of the walls that share it, spread as far as a pass over them finds: a point of these walls is then their
// affine sum with weights of size 7 at most, so it is off by 8 times what one vertex is off.
#include "planes.h"

#include <math.h>
#include <string.h>

static const double NORMAL_MOST = 1125899906842624.0; // 2^50, the bound of exact.h
static const double STEPS_OVER_RADIUS = 16777216;     // 2^24: a grid as fine as float's steps at the radius
static const double EXACT_SLACK_STEPS = 2;  // half a step a coordinate is 0.87; as much again for points between them
static const double ROUND_SLACK_STEPS = 8;  // see above: 8 * 0.87, up
static const double OFF_SHARE_MOST = 1.0 / 16384; // of the radius: a wall farther off its plane than this has none

typedef struct plane_maker {
    const cull_host *host;
    const cull_zone *zone;
    plane_table *table;
    uint32_t *slots; // of a hash over the planes seen as undirected ones: plane + 1
    uint32_t slot_count;
    uint32_t *firsts, *members; // walls by the zone's plane: members[firsts[p] .. firsts[p + 1])
    uint32_t member_count;
    double radius, off_most; // metres
    int is_exact, failed;
} plane_maker;

static double power_of_two_above(double value) // >= value, at least 2^-100
{
    double power = 1;
    while (power < value) power *= 2;
    while (power * 0.5 >= value && power > 8e-31) power *= 0.5;
    return power;
}

// ---- The table: equal planes once ----

static bsp_plane plane_of(const cull_wide_plane *exact, double steps_per_metre)
{
    const double n[3] = {(double)exact->normal[0], (double)exact->normal[1], (double)exact->normal[2]};
    const double length = sqrt((n[0] * n[0] + n[1] * n[1]) + n[2] * n[2]);
    const bsp_plane out = {*exact, {n[0] / length, n[1] / length, n[2] / length}, cull_wide_to_double(exact->offset) / (length * steps_per_metre)};
    return out;
}

static int is_turned(const cull_wide_plane *p) // the first number of its normal that isn't 0 is negative
{
    for (int i = 0; i < 3; i++)
        if (p->normal[i]) return p->normal[i] < 0;
    return 0;
}

static uint64_t plane_hash(const cull_wide_plane *p) // the same for the twin; Fowler, Noll and Vo's 1a, words mixed down
{
    const cull_wide_plane q = is_turned(p) ? cull_wide_plane_flipped(*p) : *p;
    const uint64_t words[5] = {(uint64_t)q.normal[0], (uint64_t)q.normal[1], (uint64_t)q.normal[2], q.offset.low, q.offset.high};
    uint64_t hash = 0xcbf29ce484222325u;
    for (int i = 0; i < 5; i++) {
        hash = (hash ^ words[i]) * 0x100000001b3u;
        hash ^= hash >> 29;
    }
    return hash * 0x9e3779b97f4a7c15u >> 32;
}

static uint32_t plane_add(plane_maker *m, const cull_wide_plane *exact, uint32_t twin)
{
    bsp_plane *plane = vector_push(&m->table->planes, 1);
    uint32_t *twin_at = plane ? vector_push(&m->table->twins, 1) : NULL;
    if (!twin_at) {
        m->failed = 1;
        return BSP_NONE;
    }
    *plane = plane_of(exact, m->table->steps_per_metre);
    *twin_at = twin;
    const uint32_t number = m->table->planes.count - 1;
    if (twin != BSP_NONE) ((uint32_t *)m->table->twins.items)[twin] = number;
    return number;
}

static uint32_t plane_number(plane_maker *m, const cull_wide_plane *exact)
{
    const cull_wide_plane turned = cull_wide_plane_flipped(*exact);
    uint32_t at = (uint32_t)plane_hash(exact) & (m->slot_count - 1);
    for (; m->slots[at]; at = (at + 1) & (m->slot_count - 1)) {
        const uint32_t known = m->slots[at] - 1;
        const cull_wide_plane *p = &plane_at(m->table, known)->exact;
        if (cull_wide_plane_equal(p, exact)) return known;
        if (!cull_wide_plane_equal(p, &turned)) continue;
        const uint32_t twin = plane_twin(m->table, known);
        return twin != BSP_NONE ? twin : plane_add(m, exact, known);
    }
    const uint32_t number = plane_add(m, exact, BSP_NONE);
    if (number != BSP_NONE) m->slots[at] = number + 1;
    return number;
}

// ---- The zone's vertices ----

static cull_vec3 wall_vertex(const cull_zone *zone, const cull_wall *wall, uint32_t i)
{
    return zone->positions[zone->wall_vertices[wall->first_vertex + i]];
}

static double wall_off(const cull_zone *zone, const cull_wall *wall, const bsp_plane *plane) // the farthest vertex
{
    double most = 0;
    for (uint32_t i = 0; i < wall->vertex_count; i++) {
        const cull_vec3 v = wall_vertex(zone, wall, i);
        const double p[3] = {(double)v.x, (double)v.y, (double)v.z}, off = fabs(plane_height(plane, p));
        if (!(off <= most)) most = off;
    }
    return most;
}

static int32_t to_step(double metres, double steps_per_metre)
{
    const double steps = metres * steps_per_metre;
    if (!(fabs(steps) < CULL_GRID_MOST)) return steps < 0 ? -CULL_GRID_MOST : CULL_GRID_MOST; // a zone that lies about its radius
    return (int32_t)(steps + (steps < 0 ? -0.5 : 0.5));
}

typedef struct grid_point { int32_t v[3]; } grid_point;

static grid_point to_grid(cull_vec3 p, double steps)
{
    const grid_point out = {{to_step((double)p.x, steps), to_step((double)p.y, steps), to_step((double)p.z, steps)}};
    return out;
}

static int64_t square_between(grid_point a, grid_point b) // at most 3 * 2^50
{
    int64_t sum = 0;
    for (int i = 0; i < 3; i++) sum += ((int64_t)a.v[i] - b.v[i]) * ((int64_t)a.v[i] - b.v[i]);
    return sum;
}

static cull_wide cross_square(grid_point a, grid_point b, grid_point c) // of (b - a) x (c - a): at most 2^107
{
    cull_wide sum = cull_wide_from(0);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const int64_t n = ((int64_t)b.v[j] - a.v[j]) * ((int64_t)c.v[k] - a.v[k]) - ((int64_t)b.v[k] - a.v[k]) * ((int64_t)c.v[j] - a.v[j]);
        sum = cull_wide_add(sum, cull_wide_product(n, n));
    }
    return sum;
}

// The point farthest from `from` over all walls of the group; the first of several.
static grid_point farthest(const plane_maker *m, const uint32_t *walls, uint32_t count, grid_point from)
{
    grid_point best = from;
    int64_t most = 0;
    for (uint32_t w = 0; w < count; w++) {
        const cull_wall *wall = &m->zone->walls[walls[w]];
        for (uint32_t i = 0; i < wall->vertex_count; i++) {
            const grid_point p = to_grid(wall_vertex(m->zone, wall, i), m->table->steps_per_metre);
            const int64_t square = square_between(from, p);
            if (square <= most) continue;
            most = square;
            best = p;
        }
    }
    return best;
}

static grid_point farthest_from_line(const plane_maker *m, const uint32_t *walls, uint32_t count, grid_point a, grid_point b)
{
    grid_point best = a;
    cull_wide most = cull_wide_from(0);
    for (uint32_t w = 0; w < count; w++) {
        const cull_wall *wall = &m->zone->walls[walls[w]];
        for (uint32_t i = 0; i < wall->vertex_count; i++) {
            const grid_point p = to_grid(wall_vertex(m->zone, wall, i), m->table->steps_per_metre);
            const cull_wide square = cross_square(a, b, p);
            if (cull_wide_sign(cull_wide_subtract(square, most)) <= 0) continue;
            most = square;
            best = p;
        }
    }
    return best;
}

// Through three spread vertices of the walls, facing as the zone's plane does. 0: they lie on one line.
static int plane_through_walls(const plane_maker *m, const uint32_t *walls, uint32_t count, cull_wide_plane *out)
{
    const cull_zone *zone = m->zone;
    const cull_wall *first = &zone->walls[walls[0]];
    const grid_point start = to_grid(wall_vertex(zone, first, 0), m->table->steps_per_metre);
    const grid_point a = farthest(m, walls, count, start), b = farthest(m, walls, count, a), c = farthest_from_line(m, walls, count, a, b);
    if (!cull_wide_plane_through(a.v, b.v, c.v, out)) return 0;
    const cull_vec3 n = zone->planes[first->plane].normal;
    const double along = ((double)out->normal[0] * (double)n.x + (double)out->normal[1] * (double)n.y) + (double)out->normal[2] * (double)n.z;
    if (along < 0) *out = cull_wide_plane_flipped(*out);
    return 1;
}

// ---- Walls to planes ----

static void wall_takes(plane_maker *m, uint32_t item, const cull_wide_plane *exact)
{
    const bsp_plane plane = plane_of(exact, m->table->steps_per_metre);
    const double off = wall_off(m->zone, &m->zone->walls[item], &plane);
    if (!(off <= m->off_most)) return;
    m->table->wall_planes[item] = plane_number(m, exact);
    if (2 * off > m->table->slack) m->table->slack = 2 * off;
}

static void group_exact(plane_maker *m, uint32_t zone_plane, const uint32_t *walls, uint32_t count)
{
    const cull_wide_plane exact = cull_wide_plane_reduced(cull_wide_plane_from_exact(&m->zone->exact_planes[zone_plane]));
    for (uint32_t w = 0; w < count; w++) wall_takes(m, walls[w], &exact);
}

// A wall that the group's plane does not fit as well as rounding has it takes its own.
static void group_rounded(plane_maker *m, const uint32_t *walls, uint32_t count)
{
    cull_wide_plane common, own;
    const int has_common = plane_through_walls(m, walls, count, &common);
    const bsp_plane plane = has_common ? plane_of(&common, m->table->steps_per_metre) : (bsp_plane){{{0, 0, 0}, {0, 0}}, {0, 0, 0}, 0};
    const double fits = ROUND_SLACK_STEPS / m->table->steps_per_metre;
    for (uint32_t w = 0; w < count; w++) {
        const int is_common = has_common && wall_off(m->zone, &m->zone->walls[walls[w]], &plane) <= fits;
        if (is_common) wall_takes(m, walls[w], &common);
        else if (plane_through_walls(m, walls + w, 1, &own)) wall_takes(m, walls[w], &own);
    }
}

static int is_usable(const cull_zone *zone, const cull_wall *wall)
{
    return wall->vertex_count >= 3 && wall->plane < zone->plane_count;
}

static void group_walls(plane_maker *m) // a counting sort
{
    const cull_zone *zone = m->zone;
    memset(m->firsts, 0, ((size_t)zone->plane_count + 1) * sizeof *m->firsts);
    for (uint32_t i = 0; i < zone->item_count; i++)
        if (is_usable(zone, &zone->walls[i])) m->firsts[zone->walls[i].plane + 1]++;
    for (uint32_t p = 0; p < zone->plane_count; p++) m->firsts[p + 1] += m->firsts[p];
    for (uint32_t i = 0; i < zone->item_count; i++)
        if (is_usable(zone, &zone->walls[i])) m->members[m->firsts[zone->walls[i].plane]++] = i;
    for (uint32_t p = zone->plane_count; p > 0; p--) m->firsts[p] = m->firsts[p - 1];
    m->firsts[0] = 0;
}

static int are_exact(const cull_zone *zone) // all planes are there and within exact.h's bounds
{
    if (!zone->exact_planes || !(zone->grid_steps_per_metre > 0)) return 0;
    for (uint32_t p = 0; p < zone->plane_count; p++) {
        const int64_t *n = zone->exact_planes[p].normal;
        if (!(n[0] | n[1] | n[2])) return 0;
        for (int i = 0; i < 3; i++)
            if (fabs((double)n[i]) > NORMAL_MOST) return 0;
    }
    return 1;
}

// Planes in the order in which the zone's items first need them, so that no number depends on the zone's own numbering.
static void take_planes(plane_maker *m)
{
    const cull_zone *zone = m->zone;
    group_walls(m);
    for (uint32_t i = 0; i < zone->item_count && !m->failed; i++) {
        if (!is_usable(zone, &zone->walls[i])) continue;
        const uint32_t p = zone->walls[i].plane, first = m->firsts[p], count = m->firsts[p + 1] - first;
        if (m->members[first] != i) continue; // done with the first of its plane
        if (m->is_exact) group_exact(m, p, m->members + first, count);
        else group_rounded(m, m->members + first, count);
    }
    for (uint32_t i = 0; i < zone->item_count; i++)
        if (zone->walls[i].vertex_count && m->table->wall_planes[i] == BSP_NONE) m->table->boxed_walls++;
}

static void slots_alloc(plane_maker *m)
{
    m->slot_count = 64;
    while (m->slot_count < 2 * (uint64_t)m->zone->item_count && m->slot_count < 0x80000000u) m->slot_count *= 2;
    m->slots = array_alloc(m->host, m->slot_count, sizeof *m->slots, &m->failed);
    m->firsts = array_alloc(m->host, (size_t)m->zone->plane_count + 1, sizeof *m->firsts, &m->failed);
    m->members = array_alloc(m->host, m->zone->item_count, sizeof *m->members, &m->failed);
    if (m->slots) memset(m->slots, 0, m->slot_count * sizeof *m->slots);
}

cull_result bsp_planes_make(const cull_host *host, const cull_zone *zone, plane_table *out)
{
    plane_table table = {.planes = vector_make(host, sizeof(bsp_plane)), .twins = vector_make(host, sizeof(uint32_t)), .item_count = zone->item_count};
    plane_maker m = {.host = host, .zone = zone, .table = &table, .is_exact = are_exact(zone)};
    m.radius = power_of_two_above((double)zone->radius);
    m.off_most = m.radius * OFF_SHARE_MOST;
    const double step = m.radius / STEPS_OVER_RADIUS;
    table.steps_per_metre = m.is_exact ? zone->grid_steps_per_metre : 1 / step;
    table.slack = (m.is_exact ? EXACT_SLACK_STEPS : ROUND_SLACK_STEPS) * step;
    table.wall_planes = array_alloc(host, zone->item_count, sizeof *table.wall_planes, &m.failed);
    for (uint32_t i = 0; i < zone->item_count && table.wall_planes; i++) table.wall_planes[i] = BSP_NONE;
    if (zone->walls && zone->item_count && !m.failed) {
        slots_alloc(&m);
        if (!m.failed) take_planes(&m);
        array_free(host, m.slots, m.slot_count, sizeof *m.slots);
        array_free(host, m.firsts, (size_t)zone->plane_count + 1, sizeof *m.firsts);
        array_free(host, m.members, zone->item_count, sizeof *m.members);
    }
    if (m.failed) {
        bsp_planes_free(host, &table);
        return CULL_ERR_MEMORY;
    }
    *out = table;
    return CULL_OK;
}

void bsp_planes_free(const cull_host *host, plane_table *table)
{
    vector_free(&table->planes);
    vector_free(&table->twins);
    array_free(host, table->wall_planes, table->item_count, sizeof *table->wall_planes);
    table->wall_planes = NULL;
}
