// Dividing the pieces into a tree: see build.h. A list of tasks stands for the recursion.
// SPDX-License-Identifier: MIT
#include "build.h"

#include <string.h>

static uint32_t *list_of(const tree_maker *m, uint32_t first)
{
    return (uint32_t *)m->lists.items + first;
}

static int task_push(tree_maker *m, tree_task task)
{
    return vector_add(&m->tasks, &task);
}

static void child_is(tree_maker *m, const tree_task *task, uint32_t child)
{
    if (task->parent != BSP_NONE) ((bsp_node *)m->nodes.items)[task->parent].child[task->side] = child;
}

static int file_piece(tree_maker *m, uint32_t owner, uint32_t piece)
{
    return vector_add(&m->filings, &(tree_filing){owner, piece_at(&m->set, piece)->item, piece});
}

static int leaf_make(tree_maker *m, const tree_task *task)
{
    const uint32_t number = m->leaves.count;
    bsp_leaf *leaf = vector_push(&m->leaves, 1);
    if (!leaf) return 0;
    *leaf = (bsp_leaf){.parent = task->parent};
    child_is(m, task, number | BSP_LEAF);
    for (uint32_t i = 0; i < task->count; i++)
        if (!file_piece(m, number | BSP_LEAF, list_of(m, task->first)[i])) return 0;
    return 1;
}

// ---- A set divided ----

static int piece_sort(tree_maker *m, uint32_t piece, uint32_t node, uint32_t plane)
{
    uint32_t parts[2];
    const piece_side side = piece_side_of(&m->set, piece, plane);
    if (side == PIECE_SPANS) {
        if (!piece_cut(&m->set, piece, plane, parts)) return 0;
        m->splits++;
        return vector_add(&m->aside[0], &parts[0]) && vector_add(&m->aside[1], &parts[1]);
    }
    if (m->wish.split == BSP_SPLIT_NODES && (side == PIECE_ON_FRONT || side == PIECE_ON_BACK)) return file_piece(m, node, piece);
    return vector_add(&m->aside[side == PIECE_BACK || side == PIECE_ON_BACK], &piece);
}

static int list_append(tree_maker *m, const bsp_vector *from)
{
    uint32_t *to = vector_push(&m->lists, from->count);
    if (to && from->count) memcpy(to, from->items, from->count * sizeof *to);
    return to != NULL;
}

static int node_make(tree_maker *m, const tree_task *task, uint32_t plane)
{
    const uint32_t number = m->nodes.count;
    bsp_node *node = vector_push(&m->nodes, 1);
    if (!node) return 0;
    *node = (bsp_node){.plane = plane, .parent = task->parent};
    child_is(m, task, number);
    m->aside[0].count = m->aside[1].count = 0;
    for (uint32_t i = 0; i < task->count; i++)
        if (!piece_sort(m, list_of(m, task->first)[i], number, plane)) return 0;
    m->lists.count = task->first;
    for (int side = 1; side >= 0; side--) { // the front is on top, and next
        const tree_task next = {m->lists.count, m->aside[side].count, number, (uint32_t)side, task->depth + 1};
        if (!list_append(m, &m->aside[side]) || !task_push(m, next)) return 0;
    }
    return 1;
}

static int task_run(tree_maker *m, const tree_task *task)
{
    uint32_t plane = BSP_NONE;
    if (task->depth > m->depth) m->depth = task->depth;
    const choice made = chooser_choose(&m->chooser, list_of(m, task->first), task->count, &plane);
    if (made == CHOICE_MEMORY) return 0;
    if (made == CHOICE_PLANE && task->depth < m->depth_most && m->set.pieces.count < m->pieces_most) return node_make(m, task, plane);
    m->bent_leaves += made != CHOICE_CONVEX;
    const int is_made = leaf_make(m, task);
    m->lists.count = task->first;
    return is_made;
}

cull_result tree_divide(tree_maker *m)
{
    const uint32_t count = m->set.pieces.count;
    uint32_t *all = vector_push(&m->lists, count);
    int is_good = all && task_push(m, (tree_task){0, count, BSP_NONE, 0, 0});
    for (uint32_t i = 0; i < count && is_good; i++) all[i] = i;
    while (is_good && m->tasks.count) {
        const tree_task task = ((const tree_task *)m->tasks.items)[--m->tasks.count];
        is_good = task_run(m, &task);
    }
    m->piece_filings = m->filings.count;
    return is_good ? CULL_OK : CULL_ERR_MEMORY;
}

void tree_maker_free(tree_maker *m)
{
    bsp_vector *const all[] = {&m->nodes, &m->leaves, &m->filings, &m->tasks, &m->lists, &m->aside[0], &m->aside[1]};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) vector_free(all[i]);
    chooser_free(m->host, &m->chooser);
    piece_set_free(&m->set);
    bsp_planes_free(m->host, &m->table);
}
