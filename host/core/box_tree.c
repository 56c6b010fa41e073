// A binary tree over boxes: halves by the middle of the longest side, by quickselect with a seeded pivot.
// SPDX-License-Identifier: MIT
#include "box_tree.h"

#include <math.h>

enum { LEAF_MOST = 4 };

typedef struct tree_build {
    box_tree *tree;
    uint64_t seed; // of pivots: no input is known to be slow
    uint32_t node_count;
} tree_build;

static double key(const tree_box *b, int axis)
{
    return b->min[axis] + b->max[axis];
}

static uint32_t random_below(uint64_t *state, uint32_t count)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((*state >> 33) % count);
}

// The `middle` least by key come first. Both scans stop at equal keys, so many equal ones split evenly.
static void select_half(tree_build *t, uint32_t *order, uint32_t count, uint32_t middle, int axis)
{
    const tree_box *boxes = t->tree->boxes;
    uint32_t low = 0, high = count;
    while (high - low > 1) {
        const double pivot = key(&boxes[order[low + random_below(&t->seed, high - low)]], axis);
        int64_t i = (int64_t)low - 1, j = high;
        for (;;) {
            while (key(&boxes[order[++i]], axis) < pivot) {}
            while (key(&boxes[order[--j]], axis) > pivot) {}
            if (i >= j) break;
            const uint32_t swap = order[i];
            order[i] = order[j];
            order[j] = swap;
        }
        const uint32_t split = (uint32_t)(j + 1) < high ? (uint32_t)(j + 1) : (uint32_t)j;
        if (middle < split) high = split;
        else low = split;
    }
}

static tree_box bounds(const tree_build *t, const uint32_t *order, uint32_t count)
{
    tree_box all = t->tree->boxes[order[0]];
    for (uint32_t i = 1; i < count; ++i) {
        const tree_box *b = &t->tree->boxes[order[i]];
        for (int k = 0; k < 3; ++k) {
            all.min[k] = b->min[k] < all.min[k] ? b->min[k] : all.min[k];
            all.max[k] = b->max[k] > all.max[k] ? b->max[k] : all.max[k];
        }
    }
    return all;
}

static int longest_axis(const tree_build *t, const uint32_t *order, uint32_t count)
{
    int best = 0;
    double most = -1;
    for (int k = 0; k < 3; ++k) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < count; ++i) {
            const double at = key(&t->tree->boxes[order[i]], k);
            low = at < low ? at : low;
            high = at > high ? at : high;
        }
        if (high - low > most) {
            most = high - low;
            best = k;
        }
    }
    return best;
}

// Depth is bounded by the halving: 32 at most.
static void build(tree_build *t, uint32_t first, uint32_t count)
{
    uint32_t *order = t->tree->order + first;
    const uint32_t at = t->node_count++;
    box_tree_node *node = &t->tree->nodes[at];
    *node = (box_tree_node){.box = bounds(t, order, count), .first = first, .count = count};
    if (count <= LEAF_MOST) return;
    const uint32_t half = count / 2;
    select_half(t, order, count, half, longest_axis(t, order, count));
    build(t, first, half);
    node->first = t->node_count;
    node->count = 0;
    build(t, first + half, count - half);
}

result box_tree_open(const tree_box *boxes, uint32_t count, const allocator *memory, box_tree *out)
{
    *out = (box_tree){.boxes = boxes, .count = count, .node_capacity = count};
    if (!count) return RESULT_OK;
    out->nodes = memory_alloc(memory, out->node_capacity, sizeof *out->nodes);
    out->order = memory_alloc(memory, count, sizeof *out->order);
    if (!out->nodes || !out->order) {
        box_tree_close(out, memory);
        return RESULT_NO_MEMORY;
    }
    for (uint32_t i = 0; i < count; ++i) out->order[i] = i;
    tree_build t = {.tree = out, .seed = count};
    build(&t, 0, count);
    return RESULT_OK;
}

void box_tree_close(box_tree *t, const allocator *memory)
{
    memory_free(memory, t->nodes, t->node_capacity, sizeof *t->nodes);
    memory_free(memory, t->order, t->count, sizeof *t->order);
    *t = (box_tree){0};
}

static int touch(const tree_box *a, const tree_box *b)
{
    int touching = 1;
    for (int k = 0; k < 3; ++k) touching &= (a->min[k] <= b->max[k]) & (b->min[k] <= a->max[k]);
    return touching;
}

void box_walk_start(box_walk *w, const box_tree *t, const tree_box *box)
{
    w->tree = t;
    w->box = *box;
    w->depth = w->at = w->end = 0;
    if (t->count) w->stack[w->depth++] = 0;
}

int box_walk_next(box_walk *w, uint32_t *out)
{
    const box_tree *t = w->tree;
    for (;;) {
        while (w->at < w->end) {
            *out = t->order[w->at++];
            if (touch(&t->boxes[*out], &w->box)) return 1;
        }
        if (!w->depth) return 0;
        const uint32_t at = w->stack[--w->depth];
        const box_tree_node *node = &t->nodes[at];
        if (!touch(&node->box, &w->box)) continue;
        w->at = node->first;
        w->end = node->first + node->count;
        if (!node->count) {
            w->at = w->end = 0;
            w->stack[w->depth++] = node->first;
            w->stack[w->depth++] = at + 1;
        }
    }
}
