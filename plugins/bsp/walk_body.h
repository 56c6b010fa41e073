// The walk, included by one source file per instruction set, which names WALK_KERNEL: node boxes against all volumes of a visit, planes
// that have a whole subtree inside left out below it (Assarsson and Moeller, Optimized View Frustum Culling Algorithms, 2000), front to
// back from the eye; items side by side against what is left, and each wall that planes cut by its polygon.
// SPDX-License-Identifier: MIT
#include "walk_parts.h"

#include <string.h>

typedef struct walker {
    const walk_request *q;
    walk_memory *m;
    const float *eye;
    float reach;
    uint32_t nodes;
    cull_run *run, *end; // the last run, and where the next one goes; the same while there is none
    uint8_t *wanted; // by place; NULL: everything
} walker;

// ---- Runs ----

static inline void put(walker *w, uint32_t first, uint32_t count)
{
    if (w->run < w->end) {
        if (first == w->run->first + w->run->count) {
            w->run->count += count;
            return;
        }
    }
    w->run = w->end++;
    *w->run = (cull_run){first, count};
}

// ---- Items, LANES at a time: those of a block from `lane` on ----

typedef struct group { const walk_block *block; uint32_t lane; } group;

// Most items of a block stand side by side in the zone's order too.
static inline void put_bits(walker *w, group at, uint32_t bits)
{
    const uint32_t *places = at.block->place + at.lane;
    const uint32_t joined = at.block->joined >> at.lane;
    while (bits) {
        const uint32_t first = lowest_bit(bits), count = 1 + lowest_bit(~(bits >> (first + 1) & joined >> first));
        put(w, places[first], count);
        bits &= ~(((1u << count) - 1) << first);
    }
}

static inline uint32_t facing(const walker *w, group at)
{
    const walk_block *b = at.block;
    const lanes x = lanes_mul(lanes_load(b->normal[0] + at.lane), lanes_of(w->eye[0]));
    const lanes y = lanes_mul(lanes_load(b->normal[1] + at.lane), lanes_of(w->eye[1]));
    const lanes z = lanes_mul(lanes_load(b->normal[2] + at.lane), lanes_of(w->eye[2]));
    const lanes offset = lanes_mul(lanes_load(b->offset + at.lane), lanes_of(w->eye[3]));
    const lanes doubt = lanes_mul(lanes_load(b->doubt + at.lane), lanes_of(w->reach));
    return ~lanes_negative(lanes_add(lanes_add(lanes_add(x, y), z), lanes_add(offset, doubt)));
}

// Of the boxes in `todo`, those that no plane has outside; *out_cut: of these, those that a plane cuts.
static inline uint32_t touching(group at, uint32_t todo, const bsp_volume *v, uint32_t which, uint32_t *out_cut)
{
    const walk_block *b = at.block;
    uint32_t cut = 0;
    for (; which && todo; which &= which - 1) {
        const uint32_t k = lowest_bit(which);
        const lanes nx = lanes_of(v->x[k]), ny = lanes_of(v->y[k]), nz = lanes_of(v->z[k]), offset = lanes_of(v->offset[k]);
        const lanes ax = lanes_mul(lanes_load(b->min[0] + at.lane), nx), bx = lanes_mul(lanes_load(b->max[0] + at.lane), nx);
        const lanes ay = lanes_mul(lanes_load(b->min[1] + at.lane), ny), by = lanes_mul(lanes_load(b->max[1] + at.lane), ny);
        const lanes az = lanes_mul(lanes_load(b->min[2] + at.lane), nz), bz = lanes_mul(lanes_load(b->max[2] + at.lane), nz);
        todo &= ~lanes_negative(lanes_height(lanes_max(ax, bx), lanes_max(ay, by), lanes_max(az, bz), offset));
        cut |= lanes_negative(lanes_height(lanes_min(ax, bx), lanes_min(ay, by), lanes_min(az, bz), offset));
    }
    *out_cut = cut & todo;
    return todo;
}

// Boxes inside all planes, or whose polygon has a part inside.
static inline uint32_t found_in(const walker *w, group at, uint32_t todo, walk_cut cut)
{
    const clip_request clip = {&w->m->volumes[cut.volume], cut.which, w->m->room};
    uint32_t doubtful, found = touching(at, todo, clip.volume, cut.which, &doubtful);
    for (; doubtful; doubtful &= doubtful - 1) {
        const uint32_t i = lowest_bit(doubtful);
        uint32_t plane;
        if (clip_shape(&clip, shape_of_unit(w->q->shapes, at.block->unit[at.lane + i]), &plane) != CLIP_KEPT) found &= ~(1u << i);
    }
    return found;
}

static uint32_t wanted_of(const walker *w, group at, uint32_t todo)
{
    uint32_t wanted = 0;
    for (; todo; todo &= todo - 1)
        if (w->wanted[at.block->place[at.lane + lowest_bit(todo)]]) wanted |= todo & (0u - todo);
    return wanted;
}

static void unwant(walker *w, group at, uint32_t found) // what is drawn need not be found again
{
    for (; found; found &= found - 1) w->wanted[at.block->place[at.lane + lowest_bit(found)]] = 0;
}

static inline uint32_t seen(const walker *w, group at, uint32_t todo, const walk_step *own)
{
    uint32_t found = 0;
    if (w->wanted) todo = wanted_of(w, at, todo);
    if (w->q->backface && todo) todo &= facing(w, at);
    if (own->how & STEP_INSIDE) return todo;
    for (uint32_t i = own->first; i < own->first + own->count && todo; i++) {
        const uint32_t here = found_in(w, at, todo, w->m->cuts[i]);
        found |= here;
        todo &= ~here;
    }
    return found;
}

static void take_items(walker *w, const bsp_walk_node *node, const walk_step *own)
{
    const walk_block *block = &w->q->walk->blocks[node->first];
    for (uint32_t i = 0; i < node->count; i += LANES) {
        const group at = {block + i / WALK_WIDTH, i % WALK_WIDTH};
        const uint32_t there = node->count - i < LANES ? (1u << (node->count - i)) - 1 : LANES_ALL;
        const uint32_t found = seen(w, at, there, own);
        if (w->wanted) unwant(w, at, found);
        put_bits(w, at, found);
    }
}

// ---- Nodes ----

// What is left of the parent's volumes. Returns 0 where nothing is.
static int narrow(const walker *w, const bsp_walk_node *node, walk_step *at)
{
    const walk_cut *from = w->m->cuts + at->first;
    walk_cut *to = w->m->cuts + at->first + at->count;
    uint32_t count = 0;
    for (uint32_t i = 0; i < at->count; i++) {
        uint32_t which;
        if (volume_cuts(&w->m->volumes[from[i].volume], from[i].which, node->min, node->max, &which) == VOLUME_OUTSIDE) continue;
        if (!which) {
            at->how |= STEP_INSIDE;
            return 1;
        }
        to[count++] = (walk_cut){from[i].volume, which};
    }
    at->first += at->count;
    at->count = count;
    return count != 0;
}

static int is_behind(const walker *w, const bsp_walk_node *node)
{
    const float *p = node->plane, *eye = w->eye;
    return ((p[0] * eye[0] + p[1] * eye[1]) + p[2] * eye[2]) + p[3] * eye[3] < 0;
}

// The near child is next: returned; the node's own items and the far child follow.
static walk_step push_children(const walker *w, const walk_step *own, uint32_t *top)
{
    const bsp_walk_node *node = &w->q->walk->nodes[own->node];
    const int two = node->back != WALK_ONE_CHILD, behind = two && is_behind(w, node);
    walk_step *const steps = w->m->steps;
    if (two) steps[(*top)++] = (walk_step){behind ? own->node + 1 : node->back, own->how, own->first, own->count};
    if (node->count) steps[(*top)++] = (walk_step){own->node, own->how | STEP_ITEMS, own->first, own->count};
    return (walk_step){behind ? node->back : own->node + 1, own->how, own->first, own->count};
}

static void walk_pass(walker *w, walk_step at)
{
    uint32_t top = 0;
    for (;;) {
        const bsp_walk_node *node = &w->q->walk->nodes[at.node];
        if (at.how & STEP_ITEMS) {
            take_items(w, node, &at);
        } else {
            w->nodes++;
            if (at.how & STEP_INSIDE || narrow(w, node, &at)) {
                if (node->back != WALK_NO_CHILD) {
                    at = push_children(w, &at, &top);
                    continue;
                }
                take_items(w, node, &at);
            }
        }
        if (!top) return;
        at = w->m->steps[--top];
    }
}

static void walk_volumes(walker *w, const cull_volume *volumes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        volume_ready(&volumes[i], &w->m->volumes[i]);
        w->m->cuts[i] = (walk_cut){i, w->m->volumes[i].all};
    }
    walk_pass(w, (walk_step){0, 0, 0, count});
}

uint32_t WALK_KERNEL(const walk_request *q, uint32_t *nodes_visited)
{
    const uint32_t volumes = q->visit->volume_count;
    if (!q->walk->node_count || !volumes) return 0;
    walker w = {.q = q, .m = walk_memory_of(q), .eye = q->visit->view->eye, .reach = eye_reach(q->visit->view->eye), .run = q->runs, .end = q->runs};
    w.wanted = q->wanted;
    if (volumes > WALK_VOLUMES && !w.wanted) {
        w.wanted = w.m->wanted;
        memset(w.wanted, 1, q->shapes->item_count);
    }
    for (uint32_t first = 0; first < volumes; first += WALK_VOLUMES) {
        walk_volumes(&w, q->visit->volumes + first, volumes - first < WALK_VOLUMES ? volumes - first : WALK_VOLUMES);
    }
    *nodes_visited += w.nodes;
    return (uint32_t)(w.end - q->runs);
}
