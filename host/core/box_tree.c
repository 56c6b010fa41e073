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

// Of the boxes from `first` on, `count` of them.
typedef struct tree_range { uint32_t first, count; } tree_range;

static void swap_boxes(box_tree *t, uint32_t a, uint32_t b)
{
    const uint32_t number = t->order[a];
    t->order[a] = t->order[b];
    t->order[b] = number;
    const tree_box box = t->sorted[a];
    t->sorted[a] = t->sorted[b];
    t->sorted[b] = box;
}

// The `middle` least by key come first. Both scans stop at equal keys, so many equal ones split evenly.
static void select_half(tree_build *t, tree_range r, uint32_t middle, int axis)
{
    const tree_box *boxes = t->tree->sorted + r.first;
    uint32_t low = 0, high = r.count;
    while (high - low > 1) {
        const double pivot = key(&boxes[low + random_below(&t->seed, high - low)], axis);
        int64_t i = (int64_t)low - 1, j = high;
        for (;;) {
            while (key(&boxes[++i], axis) < pivot) {}
            while (key(&boxes[--j], axis) > pivot) {}
            if (i >= j) break;
            swap_boxes(t->tree, r.first + (uint32_t)i, r.first + (uint32_t)j);
        }
        const uint32_t split = (uint32_t)(j + 1) < high ? (uint32_t)(j + 1) : (uint32_t)j;
        if (middle < split) high = split;
        else low = split;
    }
}

static void widen(tree_box *all, const tree_box *b)
{
    for (int k = 0; k < 3; ++k) {
        all->min[k] = b->min[k] < all->min[k] ? b->min[k] : all->min[k];
        all->max[k] = b->max[k] > all->max[k] ? b->max[k] : all->max[k];
    }
}

static int longest_axis(const tree_build *t, tree_range r)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < r.count; ++i)
        for (int k = 0; k < 3; ++k) {
            const double at = key(&t->tree->sorted[r.first + i], k);
            low[k] = at < low[k] ? at : low[k];
            high[k] = at > high[k] ? at : high[k];
        }
    int best = 0;
    for (int k = 1; k < 3; ++k)
        if (high[k] - low[k] > high[best] - low[best]) best = k;
    return best;
}

// Depth is bounded by the halving: 32 at most.
static void build(tree_build *t, tree_range r)
{
    const uint32_t at = t->node_count++;
    box_tree_node *node = &t->tree->nodes[at];
    *node = (box_tree_node){.box = t->tree->sorted[r.first], .first = r.first, .count = r.count};
    if (r.count <= LEAF_MOST) {
        for (uint32_t i = 1; i < r.count; ++i) widen(&node->box, &t->tree->sorted[r.first + i]);
        return;
    }
    const uint32_t half = r.count / 2;
    select_half(t, r, half, longest_axis(t, r));
    build(t, (tree_range){r.first, half});
    node->first = t->node_count;
    node->count = 0;
    build(t, (tree_range){r.first + half, r.count - half});
    node->box = t->tree->nodes[at + 1].box;
    widen(&node->box, &t->tree->nodes[node->first].box);
}

result box_tree_open(const tree_box *boxes, uint32_t count, const allocator *memory, box_tree *out)
{
    *out = (box_tree){.boxes = boxes, .count = count, .node_capacity = count};
    if (!count) return RESULT_OK;
    out->nodes = memory_alloc(memory, out->node_capacity, sizeof *out->nodes);
    out->order = memory_alloc(memory, count, sizeof *out->order);
    out->sorted = memory_alloc(memory, count, sizeof *out->sorted);
    if (!out->nodes || !out->order || !out->sorted) {
        box_tree_close(out, memory);
        return RESULT_NO_MEMORY;
    }
    for (uint32_t i = 0; i < count; ++i) {
        out->order[i] = i;
        out->sorted[i] = boxes[i];
    }
    tree_build t = {.tree = out, .seed = count};
    build(&t, (tree_range){0, count});
    return RESULT_OK;
}

void box_tree_close(box_tree *t, const allocator *memory)
{
    memory_free(memory, t->nodes, t->node_capacity, sizeof *t->nodes);
    memory_free(memory, t->order, t->count, sizeof *t->order);
    memory_free(memory, t->sorted, t->count, sizeof *t->sorted);
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
            const uint32_t at = w->at++;
            if (!touch(&t->sorted[at], &w->box)) continue;
            *out = t->order[at];
            return 1;
        }
        if (!w->depth) return 0;
        const uint32_t at = w->stack[--w->depth];
        const box_tree_node *node = &t->nodes[at];
        if (node->count) {
            w->at = node->first;
            w->end = node->first + node->count;
            continue;
        }
        w->stack[w->depth] = node->first; // written anyway, kept or not
        w->depth += (uint32_t)touch(&t->nodes[node->first].box, &w->box);
        w->stack[w->depth] = at + 1;
        w->depth += (uint32_t)touch(&t->nodes[at + 1].box, &w->box);
    }
}
