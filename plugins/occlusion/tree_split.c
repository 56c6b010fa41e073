// A tree of occlusion's own: items parted at the median of the axis that their centres spread most along, eight ways a node.
// Invariant: places of a subtree lie together, a node's own first; O(n log n) whatever the boxes are, equal centres too.
// SPDX-License-Identifier: MIT
#include "median.h"
#include "tree.h"

#include <string.h>

enum { OWN_MOST = 16, OWN_FROM = 64 }; // large items stay with a node of at least OWN_FROM items, if they are few

typedef struct split_range { uint32_t first, count, node; } split_range;

typedef struct splitter {
    const cull_zone *zone;
    uint32_t *order;
    sort_key *keys;
    tree_node *nodes;
    split_range *todo; // room for a range a node
    uint32_t node_count, node_most, todo_count, seed;
} splitter;

// ---- Medians ----

static int widest_axis(const splitter *s, uint32_t first, uint32_t count)
{
    float widest = -1;
    int axis = 0;
    for (int a = 0; a < 3; a++) {
        float low = FLT_MAX, high = -FLT_MAX;
        for (uint32_t i = first; i < first + count; i++) {
            const float c = centre_of(s->zone, s->order[i], a);
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

static void halve(splitter *s, uint32_t first, uint32_t count, uint32_t left)
{
    const int axis = widest_axis(s, first, count);
    for (uint32_t i = 0; i < count; i++) s->keys[i] = (sort_key){centre_of(s->zone, s->order[first + i], axis), s->order[first + i]};
    keys_part(s->keys, count, left, &s->seed);
    for (uint32_t i = 0; i < count; i++) s->order[first + i] = s->keys[i].item;
}

// ---- Nodes ----

static float longest_side(cull_box b)
{
    const float x = b.max.x - b.min.x, y = b.max.y - b.min.y, z = b.max.z - b.min.z;
    const float xy = x > y ? x : y;
    return xy > z ? xy : z;
}

// Items over half as long as all of them together would spoil whichever child has them: brought to the front.
static uint32_t take_large(splitter *s, split_range r)
{
    cull_box all = cull_box_none();
    if (r.count < OWN_FROM) return 0;
    for (uint32_t i = r.first; i < r.first + r.count; i++) all = cull_box_union(all, cull_box_at(&s->zone->boxes, s->order[i]));
    const float limit = longest_side(all) * 0.5f;
    uint32_t large = 0;
    for (uint32_t i = r.first; i < r.first + r.count && large <= OWN_MOST; i++) large += longest_side(cull_box_at(&s->zone->boxes, s->order[i])) > limit;
    if (large > OWN_MOST) return 0;
    uint32_t front = r.first;
    for (uint32_t i = r.first; i < r.first + r.count && large; i++) {
        const uint32_t item = s->order[i];
        if (!(longest_side(cull_box_at(&s->zone->boxes, item)) > limit)) continue;
        s->order[i] = s->order[front];
        s->order[front++] = item;
    }
    return large;
}

// Into up to eight parts of nearly the same count: halved three times.
static uint32_t split_range_in_parts(splitter *s, uint32_t first, uint32_t count, split_range *parts)
{
    uint32_t part_count = 1;
    parts[0] = (split_range){first, count, 0};
    for (int level = 0; level < 3; level++) {
        uint32_t made = 0;
        split_range next[TREE_WIDTH];
        for (uint32_t p = 0; p < part_count; p++) {
            const split_range r = parts[p];
            if (r.count <= TREE_LEAF_ITEMS) {
                next[made++] = r;
                continue;
            }
            const uint32_t left = r.count / 2;
            halve(s, r.first, r.count, left);
            next[made++] = (split_range){r.first, left, 0};
            next[made++] = (split_range){r.first + left, r.count - left, 0};
        }
        memcpy(parts, next, made * sizeof *parts);
        part_count = made;
    }
    return part_count;
}

static void node_split(splitter *s, split_range r)
{
    tree_node *node = &s->nodes[r.node];
    node->first_item = r.first;
    node->item_count = r.count;
    if (r.count <= TREE_LEAF_ITEMS) return;
    split_range parts[TREE_WIDTH];
    const uint32_t own = take_large(s, r), count = split_range_in_parts(s, r.first + own, r.count - own, parts);
    node->item_count = own;
    node->first_child = s->node_count;
    node->child_count = count;
    s->node_count += count;
    for (uint32_t p = 0; p < count; p++) {
        parts[p].node = node->first_child + p;
        s->todo[s->todo_count++] = parts[p];
    }
}

// Halving what has over 8 leaves at least 4 in each leaf, and each node that is none has two children at least.
static uint64_t nodes_most(uint32_t items)
{
    return (uint64_t)items / 2 + TREE_WIDTH + 1;
}

cull_result tree_split(const cull_host *host, const cull_zone *zone, occlusion_tree *out)
{
    const uint64_t most = nodes_most(zone->item_count);
    const size_t keys = zone->item_count ? zone->item_count : 1;
    splitter s = {.zone = zone, .order = out->ids, .node_most = (uint32_t)most, .node_count = 1, .seed = 1};
    s.keys = host->alloc(host, keys * sizeof *s.keys, _Alignof(sort_key));
    s.todo = host->alloc(host, most * sizeof *s.todo, _Alignof(split_range));
    s.nodes = host->alloc(host, most * sizeof *s.nodes, 64);
    cull_result result = s.keys && s.todo && s.nodes ? CULL_OK : CULL_ERR_MEMORY;
    if (result == CULL_OK) {
        memset(s.nodes, 0, most * sizeof *s.nodes);
        for (uint32_t i = 0; i < zone->item_count; i++) s.order[i] = i;
        s.todo[s.todo_count++] = (split_range){0, zone->item_count, 0};
        while (s.todo_count) node_split(&s, s.todo[--s.todo_count]);
        out->node_count = s.node_count;
        out->nodes = host->alloc(host, s.node_count * sizeof *s.nodes, 64);
        if (out->nodes) memcpy(out->nodes, s.nodes, s.node_count * sizeof *s.nodes);
        else result = CULL_ERR_MEMORY;
    }
    if (s.keys) host->free(host, s.keys, keys * sizeof *s.keys);
    if (s.todo) host->free(host, s.todo, most * sizeof *s.todo);
    if (s.nodes) host->free(host, s.nodes, most * sizeof *s.nodes);
    return result;
}
