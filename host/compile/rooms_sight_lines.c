// Which lines of sight are asked: eyes in cells by the root of their size, ends on walls, near ones more often, since those are drawn
// more often; each line is walked through the partition front to back.
// SPDX-License-Identifier: MIT
// Invariant: nothing is chosen by an axis or by an order that a turned map would not have. Places lie askew of all that is regular, so
// that no line runs along an edge, where rounding would decide.
#include "rooms_sight.h"
#include "steady.h"

#include <math.h>
#include <stdlib.h>

enum {
    EYES = 400,
    ENDS_OF_EYE = 200,     // some see the wall, which is then drawn anyway
    LINES_MOST = 65536,
    WALK_STACK = 512,      // planes on the way down; deeper ones are left out: a line is a sample
};
static const double INWARD = 1e-4;     // of the way from a wall to the middle of its cell: where a line ends

typedef struct place { double at[3]; } place;
typedef struct cell_key { int64_t volume, places[STEADY_CENTRES]; uint32_t cell; } cell_key;
typedef struct patch_key { int64_t area, places[STEADY_CENTRES]; uint32_t wall, patch; } patch_key;

typedef struct line_maker {
    const cell_set *cells;
    const uint32_t *room_of;
    sight *out;
    uint64_t seed;
    steady_centres centres;
    cell_key *cell_order;
    patch_key *patch_order;
    place *middles, *ends;           // by cell; by patch
    double *eye_sums, *end_sums;     // running sums of weights, in order
    double *shares;                  // by patch, in order: of its wall
    uint32_t cell_count, patch_count;
    double near_square;              // of the distance from which on ends get rarer by its square: the side of a cube of all air
} line_maker;

// ---- Numbers: Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators, 2014 ----

static double number_next(uint64_t *seed)
{
    uint64_t z = *seed += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ z >> 31) >> 11) / 9007199254740992.0;
}

static uint32_t pick(const double *sums, uint32_t count, double at)
{
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (sums[middle] > at) high = middle;
        else low = middle + 1;
    }
    return low;
}

// ---- Places ----

// Inside the polygon, off its middle by how far its corners are from the centre of all walls.
static place place_in(const line_maker *m, const plane_polygon *shape)
{
    static const double TURNS_A_STEP = 0.01;
    const polygon_edge *e = (const polygon_edge *)m->cells->edges.items + shape->first;
    place out = {{0, 0, 0}};
    double sum = 0;
    for (uint32_t i = 0; i < shape->count; ++i) {
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            const double off = e[i].start[k] - m->centres.sums[0][k] / m->centres.weights[0];
            square += off * off;
        }
        const double weight = 1 + 0.9 * sin(TURNS_A_STEP * sqrt(square));
        for (int k = 0; k < 3; ++k) out.at[k] += weight * e[i].start[k];
        sum += weight;
    }
    for (int k = 0; k < 3; ++k) out.at[k] /= sum;
    return out;
}

static void centres_take(line_maker *m)
{
    const cell_patch *p = m->cells->patches.items;
    for (uint32_t i = 0; i < m->patch_count; ++i) {
        const polygon_edge *e = (const polygon_edge *)m->cells->edges.items + p[i].shape.first;
        double middle[3] = {0, 0, 0};
        for (uint32_t c = 0; c < p[i].shape.count; ++c)
            for (int k = 0; k < 3; ++k) middle[k] += e[c].start[k] / p[i].shape.count;
        steady_centres_add(&m->centres, p[i].area, middle);
    }
}

static void middle_add(place *middle, double *weight, const place *at, double area)
{
    for (int k = 0; k < 3; ++k) middle->at[k] += area * at->at[k];
    *weight += area;
}

// Of a cell, among its walls and openings.
static result middles_take(line_maker *m)
{
    double *weights = memory_alloc_zeroed(m->out->memory, m->cell_count, sizeof *weights);
    if (!weights) return RESULT_NO_MEMORY;
    const cell_patch *p = m->cells->patches.items;
    for (uint32_t i = 0; i < m->patch_count; ++i) {
        m->ends[i] = place_in(m, &p[i].shape);
        middle_add(&m->middles[p[i].cell], &weights[p[i].cell], &m->ends[i], p[i].area);
    }
    for (size_t i = 0; i < m->cells->faces.count; ++i) {
        const cell_face *f = (const cell_face *)m->cells->faces.items + i;
        const place at = place_in(m, &f->shape);
        for (int side = 0; side < 2; ++side) middle_add(&m->middles[f->cells[side]], &weights[f->cells[side]], &at, f->area);
    }
    for (uint32_t c = 0; c < m->cell_count; ++c)
        for (int k = 0; k < 3 && weights[c] > 0; ++k) m->middles[c].at[k] /= weights[c];
    memory_free(m->out->memory, weights, m->cell_count, sizeof *weights);
    return RESULT_OK;
}

// ---- Orders that turned maps share ----

static int by_cell(const void *a, const void *b)
{
    const cell_key *x = a, *y = b;
    if (x->volume != y->volume) return x->volume > y->volume ? -1 : 1;
    const int places = steady_places_compare(x->places, y->places);
    return places ? places : (x->cell > y->cell) - (x->cell < y->cell);
}

static int by_patch(const void *a, const void *b)
{
    const patch_key *x = a, *y = b;
    if (x->wall != y->wall) return x->wall < y->wall ? -1 : 1;
    if (x->area != y->area) return x->area > y->area ? -1 : 1;
    const int places = steady_places_compare(x->places, y->places);
    return places ? places : (x->patch > y->patch) - (x->patch < y->patch);
}

static void cells_order(line_maker *m)
{
    const cell *c = m->cells->cells.items;
    for (uint32_t i = 0; i < m->cell_count; ++i) {
        m->cell_order[i] = (cell_key){.volume = steady_log(c[i].volume), .cell = i};
        steady_places(&m->centres, m->middles[i].at, m->cell_order[i].places);
    }
    qsort(m->cell_order, m->cell_count, sizeof *m->cell_order, by_cell);
    double sum = 0, air = 0;
    for (uint32_t i = 0; i < m->cell_count; ++i) {
        const double volume = c[m->cell_order[i].cell].volume;
        m->eye_sums[i] = sum += volume > 0 ? sqrt(volume) : 0;
        air += volume;
    }
    m->near_square = air > 0 ? pow(air, 2.0 / 3) : 1;
}

static void patches_order(line_maker *m)
{
    const cell_patch *p = m->cells->patches.items;
    for (uint32_t i = 0; i < m->patch_count; ++i) {
        m->patch_order[i] = (patch_key){.area = steady_log(p[i].area), .wall = p[i].wall, .patch = i};
        steady_places(&m->centres, m->ends[i].at, m->patch_order[i].places);
    }
    qsort(m->patch_order, m->patch_count, sizeof *m->patch_order, by_patch);
    for (uint32_t first = 0, end; first < m->patch_count; first = end) {
        double area = 0;
        for (end = first; end < m->patch_count && m->patch_order[end].wall == m->patch_order[first].wall; ++end) area += p[m->patch_order[end].patch].area;
        for (uint32_t i = first; i < end; ++i) m->shares[i] = area > 0 ? p[m->patch_order[i].patch].area / area : 0;
    }
}

// ---- Lines ----

typedef struct walk_task { uint32_t at; double from, to; } walk_task;

static double height(const cell_node *n, const place *p)
{
    return n->plane[0] * p->at[0] + n->plane[1] * p->at[1] + n->plane[2] * p->at[2] + n->plane[3];
}

// Down to the leaf that the stretch begins in; what lies beyond each plane waits on the stack.
static uint32_t leaf_next(const line_maker *m, const place *eye, const place *end, walk_task *stack, uint32_t *depth)
{
    walk_task t = stack[--*depth];
    while (!(t.at & CELL_LEAF)) {
        const cell_node *n = (const cell_node *)m->cells->tree.items + t.at;
        const double first = height(n, eye), rise = height(n, end) - first;
        const int side = first + rise * t.from < 0, other = first + rise * t.to < 0;
        if (side != other && *depth < WALK_STACK) {
            const double cut = -first / rise;
            stack[(*depth)++] = (walk_task){n->child[other], cut, t.to};
            t.to = cut;
        }
        t.at = n->child[side];
    }
    return t.at;
}

static result step_add(line_maker *m, sight_line *line, uint32_t step)
{
    const uint32_t *last = (const uint32_t *)m->out->steps.items + m->out->steps.count;
    if (line->count && (last[-1] & ~SIGHT_GAP) == step) return RESULT_OK;
    if (!buffer_append(&m->out->steps, &step, 1)) return RESULT_NO_MEMORY;
    line->count++;
    return RESULT_OK;
}

// Kept where something solid hides the end.
static result line_add(line_maker *m, const place *eye, const place *end)
{
    walk_task stack[WALK_STACK];
    sight_line line = {(uint32_t)m->out->steps.count, 0};
    uint32_t depth = 1, gap = 0, gaps = 0;
    result r = RESULT_OK;
    stack[0] = (walk_task){0, 0, 1};
    while (depth && r == RESULT_OK) {
        const uint32_t leaf = leaf_next(m, eye, end, stack, &depth);
        if (leaf == CELL_NO_AIR) {
            gap = line.count ? SIGHT_GAP : 0;
            continue;
        }
        r = step_add(m, &line, m->room_of[leaf & ~CELL_LEAF] | gap);
        gaps += gap != 0;
        gap = 0;
    }
    if (r != RESULT_OK || !gaps || gap) {
        m->out->steps.count = line.first;
        return r;
    }
    return buffer_append(&m->out->lines, &line, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static double ends_weigh(line_maker *m, const place *eye)
{
    const cell_patch *p = m->cells->patches.items;
    double sum = 0;
    for (uint32_t i = 0; i < m->patch_count; ++i) {
        const uint32_t patch = m->patch_order[i].patch;
        const double *a = m->ends[patch].at, *n = p[patch].plane;
        double square = 0, above = n[3];
        for (int k = 0; k < 3; ++k) {
            square += (a[k] - eye->at[k]) * (a[k] - eye->at[k]);
            above += n[k] * eye->at[k];
        }
        m->end_sums[i] = sum += above > 0 ? m->shares[i] / (1 + square / m->near_square) : 0;
    }
    return sum;
}

static result eye_do(line_maker *m, const place *eye)
{
    const cell_patch *p = m->cells->patches.items;
    const double all = ends_weigh(m, eye);
    result r = RESULT_OK;
    for (uint32_t i = 0; i < ENDS_OF_EYE && all > 0 && m->out->lines.count < LINES_MOST && r == RESULT_OK; ++i) {
        const double at = (i + number_next(&m->seed)) / ENDS_OF_EYE * all;
        const uint32_t patch = m->patch_order[pick(m->end_sums, m->patch_count, at)].patch;
        const place *middle = &m->middles[p[patch].cell];
        place end = m->ends[patch];
        for (int k = 0; k < 3; ++k) end.at[k] += INWARD * (middle->at[k] - end.at[k]);
        r = line_add(m, eye, &end);
    }
    return r;
}

static result lines_do(line_maker *m)
{
    centres_take(m);
    result r = middles_take(m);
    if (r != RESULT_OK) return r;
    cells_order(m);
    patches_order(m);
    const double all = m->eye_sums[m->cell_count - 1];
    for (uint32_t e = 0; e < EYES && all > 0 && r == RESULT_OK; ++e) {
        const double at = (e + number_next(&m->seed)) / EYES * all;
        r = eye_do(m, &m->middles[m->cell_order[pick(m->eye_sums, m->cell_count, at)].cell]);
    }
    return r;
}

result sight_lines_take(const cell_set *cells, const uint32_t *room_of, const allocator *memory, sight *out)
{
    const uint32_t nc = (uint32_t)cells->cells.count, np = (uint32_t)cells->patches.count;
    line_maker m = {.cells = cells, .room_of = room_of, .out = out, .cell_count = nc, .patch_count = np};
    if (!nc || !np) return RESULT_OK;
    m.cell_order = memory_alloc(memory, nc, sizeof *m.cell_order);
    m.patch_order = memory_alloc(memory, np, sizeof *m.patch_order);
    m.middles = memory_alloc_zeroed(memory, nc, sizeof *m.middles);
    m.ends = memory_alloc(memory, np, sizeof *m.ends);
    m.eye_sums = memory_alloc(memory, nc, sizeof *m.eye_sums);
    m.end_sums = memory_alloc(memory, np, sizeof *m.end_sums);
    m.shares = memory_alloc(memory, np, sizeof *m.shares);
    result r = RESULT_NO_MEMORY;
    if (m.cell_order && m.patch_order && m.middles && m.ends && m.eye_sums && m.end_sums && m.shares) r = lines_do(&m);
    memory_free(memory, m.cell_order, nc, sizeof *m.cell_order);
    memory_free(memory, m.patch_order, np, sizeof *m.patch_order);
    memory_free(memory, m.middles, nc, sizeof *m.middles);
    memory_free(memory, m.ends, np, sizeof *m.ends);
    memory_free(memory, m.eye_sums, nc, sizeof *m.eye_sums);
    memory_free(memory, m.end_sums, np, sizeof *m.end_sums);
    memory_free(memory, m.shares, np, sizeof *m.shares);
    return r;
}
