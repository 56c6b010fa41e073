// Openings: each node's plane, cut to the node, sinks through both of its sides; what arrives lies between two cells (Teller, Visibility
// Computations in Densely Occluded Polyhedral Environments, 1992).
// SPDX-License-Identifier: MIT
//
// Invariant: all cuts are exact, so the pieces of a node's plane that arrive overlap nowhere and leave no gap.
#include "cells_build.h"

typedef struct sunk { exact_polygon shape; uint32_t at; } sunk; // at: a node, or a cell where it ended

typedef struct openings {
    cells_build *b;
    exact_pool pool;
    bsp_vector stack;      // sunk
    bsp_vector arrived[2]; // sunk: on the front side, and from there on the other
    bsp_vector scratch;    // cull_point, of cells_cover
} openings;

static const bsp_node *node_at(const openings *o, uint32_t node)
{
    return (const bsp_node *)o->b->nodes.items + node;
}

// Keeps the part on one side; count 0: nothing of it is there.
static cells_status keep_side(openings *o, exact_polygon *shape, uint32_t by, uint32_t side)
{
    exact_place place;
    o->b->work++;
    if (!exact_polygon_place(&o->pool, shape, by, &place)) return CELLS_NO_MEMORY;
    if (place == EXACT_ACROSS) {
        exact_polygon front, behind;
        if (!exact_polygon_cut(&o->pool, shape, by, &front, &behind)) return CELLS_NO_MEMORY;
        *shape = side ? behind : front;
    } else if (!(place & (side ? EXACT_BEHIND : EXACT_FRONT))) shape->count = 0;
    return CELLS_FINE;
}

// A node whose plane an ancestor has too has nothing of it inside: then count is 0.
static cells_status node_shape(openings *o, uint32_t node, exact_polygon *shape)
{
    const cells_build *b = o->b;
    if (!exact_polygon_whole(&o->pool, b->box, node_at(o, node)->plane, shape)) return CELLS_NO_MEMORY;
    cells_status status = CELLS_FINE;
    for (uint32_t i = 0; i < 6 && status == CELLS_FINE && shape->count; i++) status = keep_side(o, shape, b->box[i], 0);
    for (uint32_t at = node; node_at(o, at)->parent != BSP_NONE && status == CELLS_FINE && shape->count;) {
        const uint32_t parent = node_at(o, at)->parent;
        status = keep_side(o, shape, node_at(o, parent)->plane, node_at(o, parent)->child[1] == at);
        at = parent;
    }
    return status;
}

// One step down into one child or, cut, both. side: of the polygon's own plane, where the region lies.
static cells_status sink_step(openings *o, const sunk *s, uint32_t side)
{
    const bsp_node *node = node_at(o, s->at);
    const exact_plane *own = &o->pool.planes[s->shape.plane], *by = &o->pool.planes[node->plane];
    exact_place place = (own->turned == by->turned) == (side == 0) ? EXACT_FRONT : EXACT_BEHIND; // of one in the plane
    exact_polygon parts[2] = {s->shape, s->shape};
    o->b->work++;
    if (own->same != by->same && !exact_polygon_place(&o->pool, &s->shape, node->plane, &place)) return CELLS_NO_MEMORY;
    if (place == EXACT_ACROSS && !exact_polygon_cut(&o->pool, &s->shape, node->plane, &parts[0], &parts[1])) return CELLS_NO_MEMORY;
    for (uint32_t i = 2; i-- > 0;) {
        const sunk next = {parts[i], node->child[i]};
        if (place & (i ? EXACT_BEHIND : EXACT_FRONT) && !vector_add(&o->stack, &next)) return CELLS_NO_MEMORY;
    }
    return CELLS_FINE;
}

static cells_status sink(openings *o, exact_polygon shape, uint32_t node, uint32_t side)
{
    const sunk first = {shape, node_at(o, node)->child[side]};
    bsp_vector *arrived = &o->arrived[side];
    arrived->count = 0;
    cells_status status = vector_add(&o->stack, &first) ? CELLS_FINE : CELLS_NO_MEMORY;
    while (o->stack.count > 0 && status == CELLS_FINE) {
        const sunk s = ((const sunk *)o->stack.items)[--o->stack.count];
        if (!(s.at & BSP_LEAF)) status = sink_step(o, &s, side);
        else if (!vector_add(arrived, &s)) status = CELLS_NO_MEMORY;
    }
    o->stack.count = 0;
    return status;
}

static cells_status interface_add(openings *o, const sunk *found, uint32_t front)
{
    cells_build *b = o->b;
    cells_interface made = {.cells = {front & ~BSP_LEAF, found->at & ~BSP_LEAF}, .plane = found->shape.plane, .first_point = b->opening_points.count,
                            .point_count = found->shape.count};
    cull_point *to = vector_push(&b->opening_points, made.point_count);
    if (!to) return CELLS_NO_MEMORY;
    const exact_edge *edges = exact_edges(&o->pool, &found->shape);
    for (uint32_t i = 0; i < made.point_count; i++)
        to[i] = (cull_point){edges[i].start[0] / b->steps_per_metre, edges[i].start[1] / b->steps_per_metre, edges[i].start[2] / b->steps_per_metre};
    cells_status status = cells_cover(b, &made, &o->scratch);
    if (status == CELLS_FINE && !vector_add(&b->interfaces, &made)) status = CELLS_NO_MEMORY;
    return status;
}

static cells_status node_openings(openings *o, uint32_t node)
{
    exact_polygon shape;
    o->pool.edges.count = 0;
    cells_status status = node_shape(o, node, &shape);
    if (status == CELLS_FINE && shape.count) status = sink(o, shape, node, 0);
    else o->arrived[0].count = 0;
    for (uint32_t i = 0; i < o->arrived[0].count && status == CELLS_FINE; i++) {
        const sunk front = ((const sunk *)o->arrived[0].items)[i];
        status = sink(o, front.shape, node, 1);
        for (uint32_t k = 0; k < o->arrived[1].count && status == CELLS_FINE; k++) status = interface_add(o, (const sunk *)o->arrived[1].items + k, front.at);
    }
    return status;
}

static int is_too_many(const cells_build *b)
{
    const uint64_t bytes = (uint64_t)b->opening_points.capacity * sizeof(cull_point) + (uint64_t)b->interfaces.capacity * sizeof(cells_interface);
    return b->work > CELLS_WORK_MOST || bytes > CELLS_BYTES_MOST;
}

cells_status cells_find_openings(cells_build *b)
{
    openings o = {.b = b, .pool = exact_pool_make(b->host, b->exact.items), .stack = vector_make(b->host, sizeof(sunk)),
                  .scratch = vector_make(b->host, sizeof(cull_point))};
    for (int side = 0; side < 2; side++) o.arrived[side] = vector_make(b->host, sizeof(sunk));
    cells_status status = CELLS_FINE;
    for (uint32_t node = 0; node < b->nodes.count && status == CELLS_FINE; node++) {
        status = node_openings(&o, node);
        if (status == CELLS_FINE && is_too_many(b)) status = CELLS_TOO_MANY;
    }
    exact_pool_free(&o.pool);
    vector_free(&o.stack);
    vector_free(&o.scratch);
    for (int side = 0; side < 2; side++) vector_free(&o.arrived[side]);
    return status;
}
