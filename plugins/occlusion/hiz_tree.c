// The tree that method=hiz walks: see hiz_tree.h. Items are parted at medians of the axis that their centres spread most along, at places
// such that every child but the last is full. O(n log n) whatever the boxes are.
// SPDX-License-Identifier: MIT
#include "hiz_tree.h"
#include "median.h"

#include <math.h>
#include <string.h>

typedef struct split_range { uint32_t first, count; } split_range;
enum { RANGES_MOST = 64 }; // waiting at once: the larger part is put off, so there are at most log2 of the items

typedef struct splitter {
    const cull_zone *zone;
    uint32_t *items;
    sort_key *keys;
    uint32_t seed;
} splitter;

// ---- Medians ----

static int widest_axis(const splitter *s, uint32_t first, uint32_t count)
{
    float widest = -1;
    int axis = 0;
    for (int a = 0; a < 3; a++) {
        float low = FLT_MAX, high = -FLT_MAX;
        for (uint32_t i = first; i < first + count; i++) {
            const float c = centre_of(s->zone, s->items[i], a);
            low = c < low ? c : low;
            high = c > high ? c : high;
        }
        if (high - low > widest) {
            widest = high - low;
            axis = a;
        }
    }
    return axis;
}

static uint32_t child_items(uint32_t count) // of a node that has so many: the greatest power of 16 below
{
    uint32_t items = HIZ_WIDTH;
    while ((uint64_t)items * HIZ_WIDTH < count) items *= HIZ_WIDTH;
    return items;
}

static void range_part(splitter *s, split_range r, uint32_t middle)
{
    const int axis = widest_axis(s, r.first, r.count);
    for (uint32_t i = 0; i < r.count; i++) s->keys[i] = (sort_key){centre_of(s->zone, s->items[r.first + i], axis), s->items[r.first + i]};
    keys_part(s->keys, r.count, middle, &s->seed);
    for (uint32_t i = 0; i < r.count; i++) s->items[r.first + i] = s->keys[i].item;
}

static void order_make(splitter *s, uint32_t count)
{
    split_range waiting[RANGES_MOST] = {{0, count}};
    uint32_t depth = count > HIZ_WIDTH;
    while (depth) {
        const split_range r = waiting[--depth];
        const uint32_t child = child_items(r.count), children = (r.count - 1) / child + 1, left = children / 2 * child;
        range_part(s, r, left);
        const split_range parts[2] = {{r.first, left}, {r.first + left, r.count - left}};
        const int larger = parts[1].count > parts[0].count;
        if (parts[larger].count > HIZ_WIDTH) waiting[depth++] = parts[larger];
        if (parts[!larger].count > HIZ_WIDTH) waiting[depth++] = parts[!larger];
    }
}

// ---- Boxes ----

// Of what is no number nothing is known: such a box is everywhere, and so are the nodes above it.
static cull_box box_known(cull_box box)
{
    const cull_box everywhere = {{-FLT_MAX, -FLT_MAX, -FLT_MAX}, {FLT_MAX, FLT_MAX, FLT_MAX}};
    return isnan(box.min.x + box.min.y + box.min.z) || isnan(box.max.x + box.max.y + box.max.z) ? everywhere : box;
}

static void box_put(float *blocks, uint32_t entry, const cull_box *box)
{
    const float values[6] = {box->min.x, box->min.y, box->min.z, box->max.x, box->max.y, box->max.z};
    float *block = blocks + (size_t)(entry / HIZ_WIDTH) * HIZ_BLOCK_FLOATS + entry % HIZ_WIDTH;
    for (int i = 0; i < 6; i++) block[i * HIZ_WIDTH] = values[i];
}

static cull_box block_box(const float *block)
{
    cull_box box = cull_box_none();
    for (int i = 0; i < HIZ_WIDTH; i++) {
        const cull_box one = {{block[i], block[16 + i], block[32 + i]}, {block[48 + i], block[64 + i], block[80 + i]}};
        box = cull_box_union(box, one);
    }
    return box;
}

static void levels_fill(const cull_zone *zone, hiz_tree *t)
{
    const cull_box none = cull_box_none();
    float *at = t->memory;
    for (uint32_t level = 0; level < t->level_count; level++) {
        const uint32_t blocks = hiz_block_count(t->counts[level]);
        t->blocks[level] = at;
        at += (size_t)blocks * HIZ_BLOCK_FLOATS;
        for (uint32_t i = 0; i < blocks * HIZ_WIDTH; i++) {
            cull_box box = none;
            if (i < t->counts[level]) box = level ? block_box(t->blocks[level - 1] + (size_t)i * HIZ_BLOCK_FLOATS) : box_known(cull_box_at(&zone->boxes, t->items[i]));
            box_put(t->blocks[level], i, &box);
        }
    }
}

static size_t levels_count(hiz_tree *t)
{
    size_t blocks = 0;
    uint32_t entries = t->item_count;
    do {
        t->counts[t->level_count++] = entries;
        entries = hiz_block_count(entries);
        blocks += entries;
    } while (entries > 1);
    return blocks;
}

// ---- Life ----

static void *array_alloc(const cull_host *host, size_t count, size_t size)
{
    return count > SIZE_MAX / size ? NULL : host->alloc(host, (count + !count) * size, 64);
}

static void array_free(const cull_host *host, void *array, size_t count, size_t size)
{
    if (array) host->free(host, array, (count + !count) * size);
}

cull_result hiz_tree_make(const cull_host *host, const cull_zone *zone, hiz_tree *out)
{
    hiz_tree t = {.item_count = zone->item_count};
    t.float_count = levels_count(&t) * HIZ_BLOCK_FLOATS;
    t.memory = array_alloc(host, t.float_count, sizeof *t.memory);
    t.items = array_alloc(host, t.item_count, sizeof *t.items);
    t.slots = array_alloc(host, t.item_count, sizeof *t.slots);
    sort_key *keys = array_alloc(host, t.item_count, sizeof *keys);
    const int is_there = t.memory && t.items && t.slots && keys;
    if (is_there) {
        splitter s = {.zone = zone, .items = t.items, .keys = keys, .seed = 1};
        for (uint32_t i = 0; i < t.item_count; i++) t.items[i] = i;
        order_make(&s, t.item_count);
        for (uint32_t i = 0; i < t.item_count; i++) t.slots[t.items[i]] = i;
        levels_fill(zone, &t);
    }
    array_free(host, keys, t.item_count, sizeof *keys);
    if (!is_there) {
        hiz_tree_free(host, &t);
        return CULL_ERR_MEMORY;
    }
    *out = t;
    return CULL_OK;
}

void hiz_tree_free(const cull_host *host, hiz_tree *t)
{
    array_free(host, t->memory, t->float_count, sizeof *t->memory);
    array_free(host, t->items, t->item_count, sizeof *t->items);
    array_free(host, t->slots, t->item_count, sizeof *t->slots);
    *t = (hiz_tree){.memory = NULL};
}

size_t hiz_tree_bytes(const hiz_tree *t)
{
    return t->float_count * sizeof(float) + 2 * (size_t)t->item_count * sizeof(uint32_t);
}
