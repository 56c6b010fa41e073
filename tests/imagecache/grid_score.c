// What ways to find and order the cells in view come to: see grid_score.h.
// SPDX-License-Identifier: MIT
#include "grid_score.h"

#include <stdlib.h>
#include <string.h>

static void *take(size_t bytes)
{
    void *memory = calloc(1, bytes);
    if (!memory) abort();
    return memory;
}

void grid_bench_open(grid_bench *b, uint32_t level)
{
    const cull_box box = {{-311.7f, -3.5f, 77.25f}, {688.1f, 40.25f, 1001.5f}};
    memset(b, 0, sizeof *b);
    b->ground = ground_of(box, level);
    const size_t cells = ground_cell_count(&b->ground), nodes = nodes_count(&b->ground);
    b->cells = take(cells * sizeof *b->cells);
    b->ranks = take(cells * sizeof *b->ranks);
    b->marks = take(nodes * sizeof *b->marks);
    b->nodes = take(nodes * sizeof *b->nodes);
    b->ray = take(GRID_RAY_CELLS * sizeof *b->ray);
}

void grid_bench_close(grid_bench *b)
{
    free(b->cells);
    free(b->ranks);
    free(b->marks);
    free(b->nodes);
    free(b->ray);
}

static ground_cell eye_of(const grid_bench *b, const grid_view *v)
{
    const double eye[4] = {v->eye[0], v->eye[1], v->eye[2], 1};
    return ground_eye(&b->ground, eye);
}

static void take_cell(grid_bench *b, ground_cell c)
{
    const uint32_t cell = ground_number(&b->ground, c);
    b->cells[b->count++] = cell;
    b->ranks[cell] = b->count;
}

static void walk(grid_bench *b, ground_cell eye, rings_direction direction, grid_way way)
{
    rings_ring ring;
    b->count = 0;
    rings_start(&b->print, eye, direction, &b->rings);
    while (rings_next(&b->rings, &ring))
        for (uint32_t s = 0; s < ring.span_count; s++) {
            ground_cell at = ring.spans[s].first;
            for (uint32_t k = 0; k < ring.spans[s].count; k++, at.i += ring.spans[s].di, at.j += ring.spans[s].dj)
                if (way == GRID_RINGS || forms_border_keeps(&b->border, at)) take_cell(b, at);
        }
}

void grid_find(grid_bench *b, const grid_view *v, grid_way way)
{
    memset(b->ranks, 0, ground_cell_count(&b->ground) * sizeof *b->ranks);
    footprint_of(&b->ground, &v->volume, &b->print);
    if (way == GRID_RINGS) {
        walk(b, eye_of(b, v), RINGS_NEAR_FIRST, way);
        return;
    }
    b->count = 0;
    if (b->print.point_count == 0) return;
    forms_border_of(&b->ground, &b->print, &b->border);
    b->print.edge_count = 0;
    walk(b, forms_slope_eye(&b->ground, v->forward), RINGS_NEAR_FIRST, way);
}

void grid_score_cells(const grid_bench *b, const grid_view *v, grid_score *s)
{
    const uint64_t lost = s->lost;
    grid_oracle oracle;
    grid_oracle_of(&b->ground, v, &oracle);
    for (int32_t j = 0; j < (int32_t)b->ground.rows; j++)
        for (int32_t i = 0; i < (int32_t)b->ground.columns; i++) {
            const ground_cell at = {i, j};
            const uint32_t is_kept = b->ranks[ground_number(&b->ground, at)] != 0;
            const double gap = grid_gap(&oracle, &b->ground, at);
            s->kept += is_kept;
            s->touched += gap < -oracle.margin;
            s->lost += gap < -oracle.margin && !is_kept;
            s->extra += gap > oracle.margin && is_kept;
        }
    s->views++;
    s->views_lost += s->lost > lost;
}

void grid_score_rings(grid_bench *b, const grid_view *v, grid_score *s)
{
    const uint32_t all = ground_cell_count(&b->ground);
    uint32_t near_count, kept = 0;
    grid_find(b, v, GRID_RINGS);
    near_count = b->count;
    for (uint32_t c = 0; c < all; c++) {
        const ground_cell at = {(int32_t)(c % b->ground.columns), (int32_t)(c / b->ground.columns)};
        const int keeps = footprint_keeps(&b->print, at);
        kept += keeps != 0;
        s->disorder += keeps != (b->ranks[c] != 0);
    }
    s->disorder += kept != near_count;
    walk(b, eye_of(b, v), RINGS_FAR_FIRST, GRID_RINGS);
    s->disorder += b->count != near_count;
    int32_t last = INT32_MAX;
    const ground_cell eye = eye_of(b, v);
    for (uint32_t k = 0; k < b->count; k++) { // far first: distances fall
        const int32_t i = (int32_t)(b->cells[k] % b->ground.columns), j = (int32_t)(b->cells[k] / b->ground.columns);
        const int32_t d = abs(i - eye.i) + abs(j - eye.j);
        s->disorder += d > last || b->ranks[b->cells[k]] != k + 1; // a cell that came twice has a later rank
        last = d;
    }
}

void grid_score_rays(grid_bench *b, const grid_view *v, uint32_t rays, uint64_t *r, grid_score *s)
{
    const uint64_t inversions = s->inversions;
    for (uint32_t k = 0; k < rays; k++) {
        const uint32_t count = grid_ray(r, &b->ground, v, b->ray);
        uint32_t last = 0;
        for (uint32_t c = 0; c < count; c++) {
            const uint32_t rank = b->ranks[ground_number(&b->ground, b->ray[c])];
            if (rank == 0) continue;
            s->inversions += rank <= last;
            last = rank;
        }
        s->rays++;
    }
    s->views_inverted += s->inversions > inversions;
}

// Some nodes over a few cells take all that is under them.
static void merge_nodes(grid_bench *b, uint64_t *r)
{
    const uint32_t count = nodes_count(&b->ground);
    memset(b->marks, NODES_SKIP, count);
    for (uint32_t c = 0; c < ground_cell_count(&b->ground); c++) {
        const ground_cell at = {(int32_t)(c % b->ground.columns), (int32_t)(c / b->ground.columns)};
        nodes_take_cell(&b->ground, b->marks, at);
    }
    const uint32_t leaves = nodes_first(b->ground.level);
    for (uint32_t n = 0; n < leaves; n++)
        if (b->marks[n] == NODES_OPEN && random_unit(r) < 0.2) b->marks[n] = NODES_TAKE;
}

static uint32_t node_over(const grid_bench *b, ground_cell c) // the taken one
{
    uint32_t node = nodes_of_cell(&b->ground, c), taken = node;
    for (;;) {
        if (b->marks[node] == NODES_TAKE) taken = node;
        if (node == 0) return taken;
        node = nodes_parent(node);
    }
}

void grid_score_nodes(grid_bench *b, const grid_view *v, uint64_t *r, grid_score *s)
{
    merge_nodes(b, r);
    const uint32_t taken = nodes_in_order(&b->ground, b->marks, eye_of(b, v), b->nodes), count = grid_ray(r, &b->ground, v, b->ray);
    uint32_t last = 0, cells = 0;
    for (uint32_t k = 0; k < taken; k++) {
        const nodes_square q = nodes_square_of(&b->ground, b->nodes[k]);
        const int32_t right = (int32_t)b->ground.columns - q.first.i, up = (int32_t)b->ground.rows - q.first.j;
        cells += (uint32_t)(right < q.side ? right : q.side) * (uint32_t)(up < q.side ? up : q.side);
    }
    s->disorder += cells != ground_cell_count(&b->ground); // the nodes part the ground
    for (uint32_t c = 0; c < count; c++) {
        const uint32_t node = node_over(b, b->ray[c]);
        uint32_t rank = 0;
        while (rank < taken && b->nodes[rank] != node) rank++;
        s->inversions += rank < last;
        s->disorder += rank == taken;
        last = rank;
    }
    s->rays++;
}
