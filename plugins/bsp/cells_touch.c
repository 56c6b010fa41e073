// Pieces in cells that they do not face but touch: along an edge, or from behind.
// SPDX-License-Identifier: MIT
//
// Invariant: such a piece shares the pixels of its edge, and ties in depth, with the walls of the cells that it touches, so it shows there
// where its edge does, up to the guard band. One that shows its front is seen past the edge anyhow, unless no open way leads around the
// place where they touch to the cell that it faces: solids that touch along an edge (steps), faces buried between brushes, zero-thick
// walls. One that shows its back may lie in the shadow of what its edge belongs to, so all those are listed too, behind the others.
#include "cells_build.h"

typedef struct part { uint32_t at, first_point, point_count; } part; // at: a node or cell that the polygon touches

typedef struct touch { uint32_t cell; int is_apart; bsp_entry entry; } touch; // is_apart: no open way leads around

typedef struct touching {
    cells_build *b;
    bsp_vector stack, found;      // part, touch
    bsp_vector starts, ways;      // uint32_t: ways[starts[c] .. starts[c + 1]) are the cell's interfaces
    bsp_vector seen, fan;         // uint32_t: by cell, the turn that it was come to; cells around a point
    uint64_t bytes;               // that the found ones take, here and in the flow's index
    uint32_t turn;
} touching;

// A polygon cut to what lies within 2 slack of the side: what touches keeps an area.
static cells_status side_add(touching *t, const part *p, const bsp_node *node, int side)
{
    cells_build *b = t->b;
    const bsp_plane *by = cells_plane(b, node->plane);
    const double sign = side ? -1 : 1;
    const uint32_t room = 2 * p->point_count; // see cull_polygon_clip
    cull_point *to = vector_reserve(&b->points, room);
    if (!to) return CELLS_NO_MEMORY;
    const cull_cut cut = {sign * by->normal[0], sign * by->normal[1], sign * by->normal[2], sign * by->offset + 2 * b->slack};
    const part made = {node->child[side], b->points.count,
                       cull_polygon_clip((const cull_point *)b->points.items + p->first_point, p->point_count, cut, to, room)};
    if (made.point_count < 3) return CELLS_FINE;
    b->points.count += made.point_count;
    return vector_add(&t->stack, &made) ? CELLS_FINE : CELLS_NO_MEMORY;
}

static cells_status node_pass(touching *t, const part *p)
{
    const cells_build *b = t->b;
    const bsp_node *node = (const bsp_node *)b->nodes.items + p->at;
    const cull_point *points = (const cull_point *)b->points.items + p->first_point;
    double low = cells_height(cells_plane(b, node->plane), points[0]), high = low;
    for (uint32_t i = 1; i < p->point_count; i++) {
        const double height = cells_height(cells_plane(b, node->plane), points[i]);
        low = height < low ? height : low;
        high = height > high ? height : high;
    }
    t->b->work++;
    cells_status status = high >= -b->slack ? side_add(t, p, node, 0) : CELLS_FINE;
    if (status == CELLS_FINE && low <= b->slack) status = side_add(t, p, node, 1);
    return status;
}

static int lists(const cells_build *b, uint32_t cell, uint32_t item)
{
    const bsp_cell *c = (const bsp_cell *)b->cells.items + cell;
    const bsp_entry *e = (const bsp_entry *)b->entries.items + c->first_entry;
    for (uint32_t i = 0; i < c->entry_count; i++)
        if (e[i].item == item) return 1;
    return 0;
}

// ---- Around the place where they touch ----

static cells_status ways_make(touching *t)
{
    const cells_build *b = t->b;
    const cells_interface *found = b->interfaces.items;
    const uint32_t cells = b->cells.count, count = b->interfaces.count;
    uint32_t *starts = vector_push(&t->starts, cells + 1), *ways = vector_push(&t->ways, 2 * count), *seen = vector_push(&t->seen, cells);
    if (!starts || !seen || (!ways && count)) return CELLS_NO_MEMORY;
    memset(starts, 0, (cells + (size_t)1) * sizeof *starts);
    memset(seen, 0, cells * sizeof *seen);
    for (uint32_t i = 0; i < 2 * count; i++) starts[found[i / 2].cells[i % 2]]++;
    for (uint32_t c = 0, total = 0; c <= cells; c++) {
        total += starts[c];
        starts[c] = total;
    }
    for (uint32_t i = 2 * count; i-- > 0;) ways[--starts[found[i / 2].cells[i % 2]]] = i / 2;
    return CELLS_FINE;
}

// Within 3 slack: the place lies within 2 of the piece, and what touches may be a slack apart.
static int holds(const cells_build *b, const cells_interface *way, cull_point at)
{
    const bsp_plane *plane = cells_plane(b, way->plane);
    const cull_point *p = (const cull_point *)b->opening_points.items + way->first_point;
    const double *n = plane->normal, most = 3 * b->slack, height = cells_height(plane, at);
    if (height > most || height < -most) return 0;
    for (uint32_t i = 0; i < way->point_count; i++) { // counterclockwise seen from the front: n x edge looks inside
        const cull_point q = p[i + 1 < way->point_count ? i + 1 : 0];
        const double e[3] = {q.x - p[i].x, q.y - p[i].y, q.z - p[i].z}, d[3] = {at.x - p[i].x, at.y - p[i].y, at.z - p[i].z};
        double in = 0, square = (e[0] * e[0] + e[1] * e[1]) + e[2] * e[2];
        for (int k = 0; k < 3; k++) in += (n[(k + 1) % 3] * e[(k + 2) % 3] - n[(k + 2) % 3] * e[(k + 1) % 3]) * d[k];
        if (in < 0 && in * in > most * most * square) return 0;
    }
    return 1;
}

static cells_status fan_grow(touching *t, uint32_t from, cull_point at)
{
    cells_build *b = t->b;
    const uint32_t *starts = t->starts.items, *ways = t->ways.items;
    uint32_t *seen = t->seen.items;
    for (uint32_t i = starts[from]; i < starts[from + 1]; i++) {
        const cells_interface *way = (const cells_interface *)b->interfaces.items + ways[i];
        const uint32_t side = way->cells[1] == from, to = way->cells[!side];
        if (!(way->open >> side & 1) || seen[to] == t->turn || !holds(b, way, at)) continue;
        seen[to] = t->turn;
        if (!vector_add(&t->fan, &to)) return CELLS_NO_MEMORY;
    }
    b->work += (starts[from + 1] - starts[from]) / 8; // in doubles
    return CELLS_FINE;
}

// Whether open ways through `at` lead from the cell to `own`.
static cells_status is_joined(touching *t, uint32_t cell, uint32_t own, cull_point at, int *out)
{
    cells_status status = CELLS_FINE;
    uint32_t *seen = t->seen.items;
    t->turn++;
    t->fan.count = 0;
    seen[cell] = t->turn;
    *out = 0;
    if (cells_root(t->b, cell) != cells_root(t->b, own)) return CELLS_FINE;
    if (!vector_add(&t->fan, &cell)) return CELLS_NO_MEMORY;
    for (uint32_t i = 0; i < t->fan.count && seen[own] != t->turn && status == CELLS_FINE; i++) status = fan_grow(t, ((const uint32_t *)t->fan.items)[i], at);
    *out = seen[own] == t->turn;
    return status;
}

static cells_status cell_reach(touching *t, const part *p, uint32_t own, const bsp_entry *e)
{
    const uint32_t cell = p->at & ~BSP_LEAF;
    const cull_point *points = (const cull_point *)t->b->points.items + p->first_point;
    cull_point middle = {0, 0, 0};
    int joined;
    if (cell == own || cells_is_rock(t->b, cell) || lists(t->b, cell, e->item)) return CELLS_FINE;
    for (uint32_t i = 0; i < p->point_count; i++) {
        middle.x += points[i].x / p->point_count;
        middle.y += points[i].y / p->point_count;
        middle.z += points[i].z / p->point_count;
    }
    const cells_status status = is_joined(t, cell, own, middle, &joined);
    const touch made = {cell, !joined, *e};
    t->bytes += sizeof made + sizeof *e + 4 * (16 + 3 * (uint64_t)e->point_count);
    return status != CELLS_FINE ? status : vector_add(&t->found, &made) ? CELLS_FINE : CELLS_NO_MEMORY;
}

// ---- Pieces ----

static cells_status piece_sink(touching *t, uint32_t own, const bsp_entry *e)
{
    cells_build *b = t->b;
    const uint32_t mark = b->points.count;
    cull_point *to = vector_push(&b->points, e->point_count);
    if (!to) return CELLS_NO_MEMORY;
    memcpy(to, (const cull_point *)b->entry_points.items + e->first_point, e->point_count * sizeof *to);
    const part whole = {b->nodes.count ? 0 : BSP_LEAF, mark, e->point_count};
    cells_status status = vector_add(&t->stack, &whole) ? CELLS_FINE : CELLS_NO_MEMORY;
    while (t->stack.count > 0 && status == CELLS_FINE) {
        const part p = ((const part *)t->stack.items)[--t->stack.count];
        b->points.count = p.first_point + p.point_count; // those behind it belong to parts that are done
        status = p.at & BSP_LEAF ? cell_reach(t, &p, own, e) : node_pass(t, &p);
    }
    t->stack.count = 0;
    b->points.count = mark;
    return status;
}

static cells_status pieces_sink(touching *t)
{
    const cells_build *b = t->b;
    cells_status status = CELLS_FINE;
    for (uint32_t cell = 0; cell < b->cells.count && status == CELLS_FINE; cell++) {
        const bsp_cell c = ((const bsp_cell *)b->cells.items)[cell];
        for (uint32_t i = 0; i < c.entry_count && status == CELLS_FINE; i++) {
            const bsp_entry e = ((const bsp_entry *)b->entries.items)[c.first_entry + i];
            if (e.point_count) status = piece_sink(t, cell, &e);
            if (status == CELLS_FINE && (b->work > CELLS_WORK_MOST || t->bytes > CELLS_BYTES_MOST)) status = CELLS_TOO_MANY;
        }
    }
    return status;
}

static cells_status found_file(touching *t)
{
    cells_build *b = t->b;
    const touch *found = t->found.items;
    bsp_cell *cells = b->cells.items;
    const uint32_t first = b->entries.count;
    bsp_entry *to = vector_push(&b->entries, t->found.count);
    if (!to) return t->found.count ? CELLS_NO_MEMORY : CELLS_FINE;
    for (uint32_t i = 0; i < t->found.count; i++) cells[found[i].cell].touching_count++;
    for (uint32_t i = 0, total = 0; i < b->cells.count; i++) {
        cells[i].first_touching = first + total;
        total += cells[i].touching_count;
        cells[i].touching_count = 0;
    }
    for (int apart = 1; apart >= 0; apart--)
        for (uint32_t i = 0; i < t->found.count; i++) {
            bsp_cell *cell = &cells[found[i].cell];
            if (found[i].is_apart != apart) continue;
            to[cell->first_touching - first + cell->touching_count++] = found[i].entry;
            cell->apart_count += (uint32_t)apart;
        }
    return CELLS_FINE;
}

cells_status cells_find_touching(cells_build *b)
{
    touching t = {.b = b, .stack = vector_make(b->host, sizeof(part)), .found = vector_make(b->host, sizeof(touch)), .turn = 0};
    bsp_vector *const numbers[] = {&t.starts, &t.ways, &t.seen, &t.fan};
    for (int i = 0; i < 4; i++) *numbers[i] = vector_make(b->host, sizeof(uint32_t));
    cells_status status = ways_make(&t);
    if (status == CELLS_FINE) status = pieces_sink(&t);
    if (status == CELLS_FINE) status = found_file(&t);
    vector_free(&t.stack);
    vector_free(&t.found);
    for (int i = 0; i < 4; i++) vector_free(numbers[i]);
    return status;
}
