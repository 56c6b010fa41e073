// The quadtree over the cells and its order: see nodes.h.
// SPDX-License-Identifier: MIT
#include "nodes.h"

uint32_t nodes_level(uint32_t node)
{
    uint32_t level = 0;
    while (node >= nodes_first(level + 1)) level++;
    return level;
}

uint32_t nodes_of_cell(const ground *g, ground_cell c)
{
    return nodes_first(g->level) + ground_morton(c);
}

nodes_square nodes_square_of(const ground *g, uint32_t node)
{
    const uint32_t level = nodes_level(node), above = g->level - level;
    const ground_cell at = ground_of_morton(node - nodes_first(level));
    const nodes_square s = {{at.i << above, at.j << above}, (int32_t)1 << above};
    return s;
}

void nodes_take_cell(const ground *g, nodes_mark *marks, ground_cell c)
{
    uint32_t node = nodes_of_cell(g, c);
    marks[node] = NODES_TAKE;
    while (node > 0) {
        node = nodes_parent(node);
        if (marks[node] != NODES_SKIP) return;
        marks[node] = NODES_OPEN;
    }
}

void nodes_clear_cell(const ground *g, nodes_mark *marks, ground_cell c)
{
    uint32_t node = nodes_of_cell(g, c);
    marks[node] = NODES_SKIP;
    while (node > 0) {
        node = nodes_parent(node);
        if (marks[node] == NODES_SKIP) return;
        marks[node] = NODES_SKIP;
    }
}

typedef struct nodes_at { uint32_t node; nodes_square square; } nodes_at;

uint32_t nodes_in_order(const ground *g, const nodes_mark *marks, ground_cell eye, uint32_t *out)
{
    nodes_at stack[NODES_STACK] = {{0, {{0, 0}, (int32_t)1 << g->level}}};
    uint32_t depth = 1, count = 0;
    while (depth > 0) {
        const nodes_at at = stack[--depth];
        if (marks[at.node] == NODES_TAKE) out[count++] = at.node;
        if (marks[at.node] != NODES_OPEN) continue;
        const int32_t half = at.square.side / 2;
        const uint32_t near = (eye.i >= at.square.first.i + half ? 1u : 0u) | (eye.j >= at.square.first.j + half ? 2u : 0u);
        for (uint32_t k = 4; k-- > 0;) { // the last put on is the next taken: opposite first, near last
            const uint32_t quadrant = near ^ k, child = nodes_child(at.node, quadrant);
            if (marks[child] == NODES_SKIP) continue;
            const nodes_square s = {{at.square.first.i + (quadrant & 1 ? half : 0), at.square.first.j + (quadrant & 2 ? half : 0)}, half};
            stack[depth++] = (nodes_at){child, s};
        }
    }
    return count;
}
