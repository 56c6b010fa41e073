// Dividing boxes in a row into blocks: the cheapest division of all, by dynamic programming (Achakeev and Seeger, Sort-based Query-adaptive
// Loading of R-trees, 2012).
// SPDX-License-Identifier: MIT
// Invariant: a block costs what a plane's chance is to cut it, which goes with the sum of its box's edges, and a share of the block above.
#include "index.h"

enum { WINDOW = CULL_BLOCK_WIDTH };

typedef struct choice { double cost; uint32_t length; } choice; // of the best division of all boxes before; length of its last block

static double edges(cull_box b)
{
    return ((double)b.max.x - (double)b.min.x) + ((double)b.max.y - (double)b.min.y) + ((double)b.max.z - (double)b.min.z);
}

// What a block adds to the one above it: a sixteenth of a box that is about four times as wide.
static double share_of(const cull_box *boxes, uint32_t count)
{
    const double quarter = 0.25;
    double sum = 0;
    uint32_t blocks = 0;
    for (uint32_t first = 0; first < count; first += CULL_BLOCK_WIDTH) {
        cull_box all = cull_box_none();
        for (uint32_t i = first; i < count && i - first < CULL_BLOCK_WIDTH; i++) all = cull_box_union(all, boxes[i]);
        sum += edges(all);
        blocks++;
        if (count - first <= CULL_BLOCK_WIDTH) break; // first would pass 2^32
    }
    return quarter * sum / blocks;
}

static choice best_end(const cull_box *boxes, const choice *before, uint32_t end, double share)
{
    choice best = {INFINITY, 0};
    cull_box all = cull_box_none();
    for (uint32_t length = 1; length <= WINDOW && length <= end; length++) {
        all = cull_box_union(all, boxes[end - length]);
        if (length < INDEX_LEAST) continue;
        const double cost = before[end - length].cost + edges(all) + share;
        if (cost <= best.cost && before[end - length].cost < INFINITY) best = (choice){cost, length};
    }
    return best;
}

uint32_t index_pack(const cull_host *host, const cull_box *boxes, uint32_t count, uint32_t *starts)
{
    if (count <= CULL_BLOCK_WIDTH) {
        starts[0] = 0;
        starts[1] = count;
        return 1;
    }
    const size_t bytes = ((size_t)count + 1) * sizeof(choice);
    choice *ends = host->alloc(host, bytes, _Alignof(choice));
    if (!ends) return 0;
    const double share = share_of(boxes, count);
    ends[0] = (choice){0, 0};
    for (uint32_t end = 1; end <= count; end++) ends[end] = best_end(boxes, ends, end, share);
    uint32_t blocks = 0;
    for (uint32_t at = count; at; at -= ends[at].length) blocks++;
    starts[blocks] = count;
    for (uint32_t at = count, b = blocks; b; b--) starts[b - 1] = at -= ends[at].length;
    host->free(host, ends, bytes);
    return blocks;
}
