// Faces of the cells: each node's plane, cut to the node, sinks through both of its sides; what arrives bounds two cells.
// SPDX-License-Identifier: MIT
// Invariant: the faces round a cell of air close, so that its volume is the sum of their cones.
#include "brush_shape.h"
#include "rooms_partition.h"

#include <math.h>
#include <string.h>

typedef struct sunk { plane_polygon shape; uint32_t at; } sunk; // at: a node, or where it ended

typedef struct facing {
    partition *p;
    const cell_input *from;
    plane_ref cube[6];
    double origin[3];  // near the cells: cones from there keep volumes precise
    buffer stack;      // sunk
    buffer arrived[2]; // sunk: on the front side, and from there on the other
} facing;

static result whole_plane(facing *f, plane_ref plane, plane_polygon *out)
{
    plane_ref edges[4];
    brush_shape_square(f->p->planes, f->cube, plane, edges);
    *out = (plane_polygon){plane, (uint32_t)f->p->edges.count, 4};
    polygon_edge *to = buffer_push(&f->p->edges, 4);
    if (!to) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < 4; ++i) to[i] = (polygon_edge){.plane = edges[i]};
    for (uint32_t i = 0; i < 4; ++i) {
        plane_ref meet[3];
        polygon_corner(plane, to, 4, i, meet);
        plane_table_position(f->p->planes, meet, to[i].start);
    }
    return RESULT_OK;
}

// count 0: nothing of it is in the node.
static result cut_to_node(facing *f, uint32_t node, plane_polygon *shape)
{
    uint32_t side = partition_node(f->p, node)->side;
    for (uint32_t at = partition_node(f->p, node)->parent; at != PART_NONE; side = partition_node(f->p, at)->side, at = partition_node(f->p, at)->parent) {
        const plane_ref by = partition_node(f->p, at)->plane;
        polygon_place place;
        result r = partition_place(f->p, shape, by, &place);
        if (r == RESULT_OK && place == POLYGON_ACROSS) {
            plane_polygon front, behind;
            r = partition_cut(f->p, shape, by, &front, &behind);
            *shape = side ? behind : front;
        } else if (r == RESULT_OK && !(place & (side ? POLYGON_BEHIND : POLYGON_FRONT))) shape->count = 0;
        if (r != RESULT_OK || shape->count == 0) return r;
    }
    return RESULT_OK;
}

// One step down: into one child or, cut, both.
static result sink_step(facing *f, const sunk *s)
{
    const part_node *node = partition_node(f->p, s->at);
    polygon_place place = s->shape.plane == node->plane ? POLYGON_FRONT : POLYGON_BEHIND; // of one in the plane: where it looks
    plane_polygon parts[2] = {s->shape, s->shape};
    result r = RESULT_OK;
    if (s->shape.plane >> 1 != node->plane >> 1) r = partition_place(f->p, &s->shape, node->plane, &place);
    if (r == RESULT_OK && place == POLYGON_ACROSS) r = partition_cut(f->p, &s->shape, node->plane, &parts[0], &parts[1]);
    for (int side = 0; side < 2 && r == RESULT_OK; ++side) {
        const sunk next = {parts[side], node->child[side]};
        if ((place & (side ? POLYGON_BEHIND : POLYGON_FRONT)) && !buffer_append(&f->stack, &next, 1)) r = RESULT_NO_MEMORY;
    }
    return r;
}

static result sink(facing *f, plane_polygon shape, uint32_t from, buffer *arrived)
{
    const sunk first = {shape, from};
    result r = buffer_append(&f->stack, &first, 1) ? RESULT_OK : RESULT_NO_MEMORY;
    while (f->stack.count > 0 && r == RESULT_OK) {
        const sunk s = ((sunk *)f->stack.items)[--f->stack.count];
        if (partition_is_node(s.at)) r = sink_step(f, &s);
        else if (!buffer_append(arrived, &s, 1)) r = RESULT_NO_MEMORY;
    }
    f->stack.count = 0;
    return r;
}

static cell *cell_at(const facing *f, uint32_t leaf)
{
    return leaf == PART_SOLID ? NULL : (cell *)f->p->out->cells.items + (leaf & ~PART_LEAF);
}

static uint32_t door_at(const cell_input *from, uint32_t plane, uint32_t region, uint32_t other)
{
    const uint32_t low = region < other ? region : other, high = region < other ? other : region;
    for (uint32_t i = 0; i < from->door_count; ++i)
        if (from->doors[i].plane == plane && from->doors[i].regions[0] == low && from->doors[i].regions[1] == high) return i;
    return CELL_NO_DOOR;
}

static result face_add(facing *f, const plane_polygon *shape, uint32_t front, uint32_t behind)
{
    cell *a = cell_at(f, front), *b = cell_at(f, behind);
    if (!a && !b) return RESULT_OK;
    const polygon_edge *edges = (polygon_edge *)f->p->edges.items + shape->first;
    const double area = polygon_area(edges, shape->count);
    const cull_wide_plane p = plane_table_get(f->p->planes, shape->plane);
    double height = 0, square = 0;
    for (int k = 0; k < 3; ++k) {
        const double n = (double)p.normal[k];
        height += n * (edges[0].start[k] - f->origin[k]);
        square += n * n;
    }
    const double cone = area * (height / sqrt(square)) / 3;
    if (a) a->volume -= cone;
    if (b) b->volume += cone;
    if (!a || !b || a == b) return RESULT_OK;
    const uint32_t door = a->region == b->region ? CELL_NO_DOOR : door_at(f->from, shape->plane >> 1, a->region, b->region);
    if (a->region != b->region && door == CELL_NO_DOOR) return RESULT_OK;
    const cell_face made = {*shape, {front & ~PART_LEAF, behind & ~PART_LEAF}, door, area};
    return buffer_append(&f->p->out->faces, &made, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static result node_faces(facing *f, uint32_t node)
{
    plane_polygon shape;
    const part_node n = *partition_node(f->p, node);
    const size_t kept = f->p->out->faces.count, edges = f->p->edges.count;
    result r = whole_plane(f, n.plane, &shape);
    if (r == RESULT_OK) r = cut_to_node(f, node, &shape);
    f->arrived[0].count = 0;
    if (r == RESULT_OK && shape.count > 0) r = sink(f, shape, n.child[0], &f->arrived[0]);
    for (size_t i = 0; i < f->arrived[0].count && r == RESULT_OK; ++i) {
        const sunk front = ((sunk *)f->arrived[0].items)[i];
        f->arrived[1].count = 0;
        r = sink(f, front.shape, n.child[1], &f->arrived[1]);
        for (size_t k = 0; k < f->arrived[1].count && r == RESULT_OK; ++k) {
            const sunk *behind = (sunk *)f->arrived[1].items + k;
            r = face_add(f, &behind->shape, front.at, behind->at);
        }
    }
    if (f->p->out->faces.count == kept) f->p->edges.count = edges; // scratch alone
    return r;
}

static result walls_count(facing *f, const cell_input *from)
{
    result r = RESULT_OK;
    for (uint32_t i = 0; i < from->wall_count && r == RESULT_OK; ++i) {
        const size_t edges = f->p->edges.count, kept = f->p->out->patches.count;
        if (from->walls[i].behind != CELL_SOLID) continue; // a portal is no wall
        f->arrived[0].count = 0;
        r = sink(f, from->walls[i].shape, 0, &f->arrived[0]); // the input's edges stand first in p->edges
        for (size_t k = 0; k < f->arrived[0].count && r == RESULT_OK; ++k) {
            const sunk *s = (sunk *)f->arrived[0].items + k;
            cell *c = cell_at(f, s->at);
            if (!c) continue;
            c->walls++;
            cell_patch made = {.shape = s->shape, .cell = s->at & ~PART_LEAF, .wall = i};
            made.area = polygon_area((polygon_edge *)f->p->edges.items + s->shape.first, s->shape.count);
            partition_plane(f->p, s->shape.plane, made.plane);
            if (!buffer_append(&f->p->out->patches, &made, 1)) r = RESULT_NO_MEMORY;
        }
        if (f->p->out->patches.count == kept) f->p->edges.count = edges;
    }
    return r;
}

result partition_faces(partition *p, const cell_input *from, const allocator *memory)
{
    if (p->nodes.count == 0) return RESULT_OK;
    facing f = {.p = p, .from = from, .stack = buffer_make(memory, sizeof(sunk)), .arrived = {buffer_make(memory, sizeof(sunk)), buffer_make(memory, sizeof(sunk))}};
    memcpy(f.origin, from->edges[0].start, sizeof f.origin);
    result r = brush_shape_cube(p->planes, f.cube) ? RESULT_OK : RESULT_NO_MEMORY;
    if (r == RESULT_OK) r = walls_count(&f, from);
    for (uint32_t n = 0; n < p->nodes.count && r == RESULT_OK; ++n) r = node_faces(&f, n);
    buffer_free(&f.stack);
    for (int side = 0; side < 2; ++side) buffer_free(&f.arrived[side]);
    return r;
}
