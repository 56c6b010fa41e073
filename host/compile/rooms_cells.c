// The partition of rooms_cells.h: splitters chosen among the first walls of a node for few cuts and even sides.
// SPDX-License-Identifier: MIT
// Invariant: a node without walls is one kind of matter: what its last splitter has on that side.
#include "rooms_partition.h"

#include <math.h>
#include <string.h>

enum {
    CANDIDATES_MOST = 24, // splitters tried at a node
    SAMPLES_MOST = 192,   // walls that each is tried on
    CUT_COST = 6,         // walls by which the sides may differ to save a cut
};

typedef struct build_task { uint32_t first, count, parent, side, depth; } build_task; // walls: the top of the stack

typedef struct build {
    partition *p;
    buffer stack;    // cell_wall, with shapes in p->edges
    buffer tasks;    // build_task
    buffer parts[2]; // cell_wall: in front, behind
} build;

static int is_portal(const cell_wall *w)
{
    return w->behind != CELL_SOLID;
}

static result place_of(partition *p, const cell_wall *w, plane_ref by, polygon_place *out)
{
    *out = POLYGON_ON;
    if (w->shape.plane >> 1 == by >> 1) return RESULT_OK;
    return partition_place(p, &w->shape, by, out);
}

// ---- Which splitter ----

static result cost_of(build *b, const cell_wall *walls, uint32_t count, plane_ref by, uint32_t *out)
{
    uint32_t sides[2] = {0, 0}, cut = 0;
    const uint32_t stride = count / SAMPLES_MOST + 1;
    for (uint32_t i = 0; i < count; i += stride) {
        polygon_place place;
        const result r = place_of(b->p, &walls[i], by, &place);
        if (r != RESULT_OK) return r;
        cut += place == POLYGON_ACROSS;
        sides[0] += (place & POLYGON_FRONT) != 0;
        sides[1] += (place & POLYGON_BEHIND) != 0;
    }
    *out = CUT_COST * cut + (sides[0] > sides[1] ? sides[0] - sides[1] : sides[1] - sides[0]);
    return RESULT_OK;
}

// Portals before walls: cells never reach across one.
static result choose(build *b, const cell_wall *walls, uint32_t count, uint32_t *out)
{
    uint32_t tried = 0, best = UINT32_MAX;
    plane_ref last = PLANE_NONE;
    int has_portal = 0;
    for (uint32_t i = 0; i < count && !has_portal; ++i) has_portal = is_portal(&walls[i]);
    for (uint32_t i = 0; i < count && tried < CANDIDATES_MOST; ++i) {
        if (has_portal && !is_portal(&walls[i])) continue;
        if (walls[i].shape.plane >> 1 == last >> 1) continue;
        last = walls[i].shape.plane;
        uint32_t cost;
        const result r = cost_of(b, walls, count, last, &cost);
        if (r != RESULT_OK) return r;
        ++tried;
        if (cost >= best) continue;
        best = cost;
        *out = i;
    }
    return RESULT_OK;
}

// ---- Nodes ----

static uint32_t leaf_add(partition *p, uint32_t region)
{
    if (region == CELL_SOLID) return PART_SOLID;
    const cell made = {.region = region};
    return buffer_append(&p->out->cells, &made, 1) ? PART_LEAF | (uint32_t)(p->out->cells.count - 1) : PART_NONE;
}

static void child_set(partition *p, const build_task *t, uint32_t child)
{
    if (t->parent != PART_NONE) partition_node(p, t->parent)->child[t->side] = child;
}

static result part_add(build *b, const cell_wall *w, plane_ref by)
{
    polygon_place place;
    result r = place_of(b->p, w, by, &place);
    if (r != RESULT_OK || place == POLYGON_ON) return r;
    cell_wall parts[2] = {*w, *w};
    if (place == POLYGON_ACROSS) r = partition_cut(b->p, &w->shape, by, &parts[0].shape, &parts[1].shape);
    for (int side = 0; side < 2 && r == RESULT_OK; ++side)
        if ((place & (side ? POLYGON_BEHIND : POLYGON_FRONT)) && !buffer_append(&b->parts[side], &parts[side], 1)) r = RESULT_NO_MEMORY;
    return r;
}

static result split(build *b, const build_task *t)
{
    uint32_t by = 0;
    result r = choose(b, (cell_wall *)b->stack.items + t->first, t->count, &by);
    if (r != RESULT_OK) return r;
    const cell_wall splitter = ((cell_wall *)b->stack.items)[t->first + by];
    const part_node node = {.plane = splitter.shape.plane, .child = {PART_NONE, PART_NONE}, .parent = t->parent, .side = t->side,
                            .regions = {splitter.region, splitter.behind}};
    const uint32_t number = (uint32_t)b->p->nodes.count;
    if (!buffer_append(&b->p->nodes, &node, 1)) return RESULT_NO_MEMORY;
    child_set(b->p, t, number);
    b->parts[0].count = b->parts[1].count = 0;
    for (uint32_t i = 0; i < t->count && r == RESULT_OK; ++i) {
        const cell_wall w = ((cell_wall *)b->stack.items)[t->first + i];
        r = part_add(b, &w, node.plane);
    }
    b->stack.count = t->first;
    for (uint32_t side = 2; side-- > 0 && r == RESULT_OK;) {
        const build_task next = {(uint32_t)b->stack.count, (uint32_t)b->parts[side].count, number, side, t->depth + 1};
        if (!buffer_append(&b->stack, b->parts[side].items, b->parts[side].count) || !buffer_append(&b->tasks, &next, 1)) r = RESULT_NO_MEMORY;
    }
    return r;
}

static result build_all(build *b)
{
    result r = RESULT_OK;
    while (b->tasks.count > 0 && r == RESULT_OK) {
        const build_task t = ((build_task *)b->tasks.items)[--b->tasks.count];
        if (t.depth > b->p->out->depth) b->p->out->depth = t.depth;
        if (t.count > 0) {
            r = split(b, &t);
            continue;
        }
        const part_node *parent = partition_node(b->p, t.parent);
        const uint32_t leaf = leaf_add(b->p, parent->regions[t.side]);
        if (leaf == PART_NONE) r = RESULT_NO_MEMORY;
        else child_set(b->p, &t, leaf);
    }
    return r;
}

void partition_plane(const partition *p, plane_ref plane, double out[4])
{
    const cull_wide_plane wide = plane_table_get(p->planes, plane);
    double square = 0;
    for (int k = 0; k < 3; ++k) square += (double)wide.normal[k] * (double)wide.normal[k];
    for (int k = 0; k < 3; ++k) out[k] = (double)wide.normal[k] / sqrt(square);
    out[3] = cull_wide_to_double(wide.offset) / sqrt(square);
}

static result tree_keep(const partition *p)
{
    cell_node *to = buffer_push(&p->out->tree, p->nodes.count);
    if (!to) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < p->nodes.count; ++i) {
        const part_node *n = partition_node(p, i);
        partition_plane(p, n->plane, to[i].plane);
        for (int k = 0; k < 2; ++k) to[i].child[k] = n->child[k];
    }
    return RESULT_OK;
}

static result walls_take(build *b, const cell_input *from)
{
    const build_task root = {0, from->wall_count, PART_NONE, 0, 0};
    if (!buffer_append(&b->p->edges, from->edges, from->edge_count) || !buffer_append(&b->stack, from->walls, from->wall_count)) return RESULT_NO_MEMORY;
    return from->wall_count == 0 || buffer_append(&b->tasks, &root, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

result partition_build(partition *p, const cell_input *from, const allocator *memory)
{
    build b = {.p = p,
               .stack = buffer_make(memory, sizeof(cell_wall)),
               .tasks = buffer_make(memory, sizeof(build_task)),
               .parts = {buffer_make(memory, sizeof(cell_wall)), buffer_make(memory, sizeof(cell_wall))}};
    result r = walls_take(&b, from);
    if (r == RESULT_OK) r = build_all(&b);
    p->out->nodes = (uint32_t)p->nodes.count;
    buffer_free(&b.stack);
    buffer_free(&b.tasks);
    for (int side = 0; side < 2; ++side) buffer_free(&b.parts[side]);
    return r;
}

// ---- Polygons in the partition ----

result partition_place(partition *p, const plane_polygon *shape, plane_ref by, polygon_place *out)
{
    p->signs.count = 0;
    if (!buffer_push(&p->signs, shape->count)) return RESULT_NO_MEMORY;
    *out = polygon_signs(p->planes, shape->plane, (polygon_edge *)p->edges.items + shape->first, shape->count, by, p->signs.items);
    return RESULT_OK;
}

result partition_cut(partition *p, const plane_polygon *shape, plane_ref by, plane_polygon *front, plane_polygon *behind)
{
    const plane_polygon whole = *shape;
    const polygon_parts parts = {behind, front};
    return polygon_cut(p->planes, &whole, p->signs.items, by, &p->edges, parts) ? RESULT_OK : RESULT_NO_MEMORY;
}

result cell_set_make(const cell_input *from, const allocator *memory, cell_set *out)
{
    *out = (cell_set){.cells = buffer_make(memory, sizeof(cell)),
                      .faces = buffer_make(memory, sizeof(cell_face)),
                      .patches = buffer_make(memory, sizeof(cell_patch)),
                      .tree = buffer_make(memory, sizeof(cell_node)),
                      .edges = buffer_make(memory, sizeof(polygon_edge))};
    partition p = {.planes = from->planes,
                   .out = out,
                   .nodes = buffer_make(memory, sizeof(part_node)),
                   .edges = buffer_make(memory, sizeof(polygon_edge)),
                   .signs = buffer_make(memory, sizeof(int8_t))};
    result r = partition_build(&p, from, memory);
    if (r == RESULT_OK) r = partition_faces(&p, from, memory);
    if (r == RESULT_OK && p.nodes.count) r = tree_keep(&p);
    out->edges = p.edges;
    buffer_free(&p.nodes);
    buffer_free(&p.signs);
    return r;
}

void cell_set_free(cell_set *c)
{
    buffer_free(&c->cells);
    buffer_free(&c->faces);
    buffer_free(&c->patches);
    buffer_free(&c->tree);
    buffer_free(&c->edges);
}
