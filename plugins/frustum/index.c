// Building the index: see index.h.
// SPDX-License-Identifier: MIT
#include "index.h"

#include <string.h>

enum { ALIGN = 64, AXIS_ROWS = 6 };

static uint32_t blocks_for(uint32_t entries)
{
    return entries / CULL_BLOCK_WIDTH + (entries % CULL_BLOCK_WIDTH != 0);
}

static void levels_measure(frustum_index *index)
{
    uint32_t entries = index->item_count, level = 0;
    size_t blocks = 0;
    for (;; level++) {
        index->entry_counts[level] = entries;
        const uint32_t here = entries ? blocks_for(entries) : 1;
        blocks += here;
        if (here == 1) break;
        entries = here;
    }
    index->level_count = level + 1;
    index->box_bytes = blocks * CULL_BLOCK_FLOATS * sizeof(float);
}

static void items_fill(const cull_zone *zone, const frustum_index *index, float *level)
{
    const float *rows[AXIS_ROWS] = {zone->boxes.min_x, zone->boxes.min_y, zone->boxes.min_z,
                                    zone->boxes.max_x, zone->boxes.max_y, zone->boxes.max_z};
    for (uint32_t first = 0; first < index->item_count; first += CULL_BLOCK_WIDTH) {
        float *block = level + (size_t)first / CULL_BLOCK_WIDTH * CULL_BLOCK_FLOATS;
        const uint32_t left = index->item_count - first, count = left < CULL_BLOCK_WIDTH ? left : CULL_BLOCK_WIDTH;
        if (count < CULL_BLOCK_WIDTH) cull_block_fill(NULL, 0, block);
        for (int row = 0; row < AXIS_ROWS; row++)
            for (uint32_t i = 0; i < count; i++) block[row * CULL_BLOCK_WIDTH + (int)i] = rows[row][index->order[first + i]];
        if (left <= CULL_BLOCK_WIDTH) break; // first would pass 2^32
    }
}

// The box of a whole block, as entry `place` of the level above.
static void block_union(const float *block, float *above, uint32_t place)
{
    float *out = above + (size_t)(place / CULL_BLOCK_WIDTH) * CULL_BLOCK_FLOATS + place % CULL_BLOCK_WIDTH;
    for (int row = 0; row < AXIS_ROWS; row++) {
        const float *values = block + row * CULL_BLOCK_WIDTH;
        float best = values[0];
        for (int i = 1; i < CULL_BLOCK_WIDTH; i++) {
            const int is_better = row < 3 ? values[i] < best : values[i] > best;
            best = is_better ? values[i] : best;
        }
        out[row * CULL_BLOCK_WIDTH] = best;
    }
}

static void levels_fill(const cull_zone *zone, frustum_index *index)
{
    float *level = index->boxes;
    index->levels[0] = level;
    if (index->item_count == 0) cull_block_fill(NULL, 0, level);
    items_fill(zone, index, level);
    for (uint32_t l = 1; l < index->level_count; l++) {
        const uint32_t entries = index->entry_counts[l];
        float *above = level + (size_t)entries * CULL_BLOCK_FLOATS; // the level below has as many blocks
        cull_block_fill(NULL, 0, above + (size_t)(blocks_for(entries) - 1) * CULL_BLOCK_FLOATS);
        for (uint32_t b = 0; b < entries; b++) block_union(level + (size_t)b * CULL_BLOCK_FLOATS, above, b);
        index->levels[l] = above;
        level = above;
    }
}

static void faces_fill(const cull_zone *zone, frustum_index *index)
{
    for (uint32_t b = 0; b < blocks_for(index->item_count); b++) {
        const uint32_t first = b * CULL_BLOCK_WIDTH, left = index->item_count - first;
        cull_block_fill_faces(zone, index->order + first, left < CULL_BLOCK_WIDTH ? left : CULL_BLOCK_WIDTH,
                              index->faces + (size_t)b * CULL_BLOCK_FACE_FLOATS);
    }
}

cull_result index_build(const cull_host *host, const index_source *from, frustum_index *out)
{
    const cull_zone *zone = from->zone;
    frustum_index index = {.item_count = zone->item_count};
    levels_measure(&index);
    index.order_bytes = (size_t)(zone->item_count ? zone->item_count : 1) * sizeof *index.order;
    index.order = host->alloc(host, index.order_bytes, ALIGN);
    index.boxes = host->alloc(host, index.box_bytes, ALIGN);
    cull_result result = index.order && index.boxes ? CULL_OK : CULL_ERR_MEMORY;
    if (result == CULL_OK && from->faces == INDEX_FACES && zone->walls && zone->item_count) {
        index.face_bytes = (size_t)blocks_for(zone->item_count) * CULL_BLOCK_FACE_FLOATS * sizeof(float);
        index.faces = host->alloc(host, index.face_bytes, ALIGN);
        if (!index.faces) result = CULL_ERR_MEMORY;
    }
    if (result == CULL_OK && from->baked) result = index_load_order(host, from->baked, zone->item_count, index.order);
    else if (result == CULL_OK) result = index_order(host, zone, index.order);
    if (result != CULL_OK) {
        index_free(host, &index);
        return result;
    }
    levels_fill(zone, &index);
    if (index.faces) faces_fill(zone, &index);
    *out = index;
    return CULL_OK;
}

void index_free(const cull_host *host, frustum_index *index)
{
    if (index->order) host->free(host, index->order, index->order_bytes);
    if (index->boxes) host->free(host, index->boxes, index->box_bytes);
    if (index->faces) host->free(host, index->faces, index->face_bytes);
    memset(index, 0, sizeof *index);
}
