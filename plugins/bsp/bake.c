// A tree in bytes and back: see bake.h. A head, then nodes, leaves, entries, order and points as they lie in memory.
// SPDX-License-Identifier: MIT
#include "bake.h"
#include "build.h"

#include <math.h>
#include <string.h>

typedef struct baked_head {
    char magic[8];
    uint32_t byte_order, plane_count, node_count, leaf_count, entry_count, point_count, item_count, depth;
    uint32_t splits, spanning, bent_leaves, split, choose, max_leaf_depth;
    double slack;
    uint64_t check; // of all bytes behind the head
} baked_head;

static const char MAGIC[8] = {'b', 's', 'p', 't', 'r', 'e', 'e', '1'};
enum { BYTE_ORDER_MARK = 0x01020304, PART_COUNT = 5 };

typedef struct baked_part { void *bytes; size_t size; } baked_part;

static uint32_t tree_parts(const bsp_tree *t, baked_part parts[PART_COUNT])
{
    const baked_part all[PART_COUNT] = {{t->nodes, t->node_count * sizeof *t->nodes}, {t->leaves, t->leaf_count * sizeof *t->leaves},
                                        {t->entries, t->entry_count * sizeof *t->entries}, {t->order, t->item_count * sizeof *t->order},
                                        {t->points, t->point_count * sizeof *t->points}};
    memcpy(parts, all, sizeof all);
    return PART_COUNT;
}

// Fowler, Noll and Vo's hash 1a, four bytes at a time: each step can be undone, so no single wrong word goes unseen.
static uint64_t check_add(uint64_t hash, const void *bytes, size_t size)
{
    for (size_t i = 0; i + sizeof(uint32_t) <= size; i += sizeof(uint32_t)) {
        uint32_t word;
        memcpy(&word, (const char *)bytes + i, sizeof word);
        hash = (hash ^ word) * 0x100000001b3u;
    }
    return hash;
}

static const uint64_t CHECK_START = 0xcbf29ce484222325u;

uint64_t bsp_tree_save(const bsp_tree *t, void *blob, uint64_t size)
{
    baked_part parts[PART_COUNT];
    const uint32_t part_count = tree_parts(t, parts);
    uint64_t needed = sizeof(baked_head), check = CHECK_START;
    for (uint32_t i = 0; i < part_count; i++) needed += parts[i].size;
    if (size < needed) return needed;
    char *to = (char *)blob + sizeof(baked_head);
    for (uint32_t i = 0; i < part_count; i++) {
        if (parts[i].size == 0) continue;
        memcpy(to, parts[i].bytes, parts[i].size);
        check = check_add(check, to, parts[i].size);
        to += parts[i].size;
    }
    baked_head head = {{0}, BYTE_ORDER_MARK, t->plane_count, t->node_count, t->leaf_count, t->entry_count, t->point_count, t->item_count,
                       t->depth, t->splits, t->spanning, t->bent_leaves, (uint32_t)t->wish.split, (uint32_t)t->wish.choose,
                       t->wish.max_leaf_depth, t->slack, check};
    memcpy(head.magic, MAGIC, sizeof head.magic);
    memcpy(blob, &head, sizeof head);
    return needed;
}

// ---- Checking ----

static int head_fits(const baked_head *head, const bsp_source *from, const plane_table *table)
{
    return memcmp(head->magic, MAGIC, sizeof head->magic) == 0 && head->byte_order == BYTE_ORDER_MARK && head->item_count == from->zone->item_count &&
           head->plane_count == table->planes.count && head->split == (uint32_t)from->wish.split && head->choose == (uint32_t)from->wish.choose &&
           head->max_leaf_depth == from->wish.max_leaf_depth && head->slack == table->slack && head->node_count < BSP_LEAF &&
           head->leaf_count == head->node_count + 1 && head->entry_count < BSP_LEAF && head->point_count < BSP_LEAF;
}

static int child_fits(const bsp_tree *t, uint32_t child, uint32_t parent)
{
    if (child & BSP_LEAF) return (child & ~BSP_LEAF) < t->leaf_count && t->leaves[child & ~BSP_LEAF].parent == parent;
    return child > parent && child < t->node_count && t->nodes[child].parent == parent;
}

// Two children a node, each of another parent or side, are as many as there are nodes and leaves but the root: each is met once.
static int nodes_fit(const bsp_tree *t, uint32_t *depths)
{
    uint32_t deepest = 0;
    if (t->node_count == 0) return t->leaves[0].parent == BSP_NONE && t->depth == 0;
    if (t->nodes[0].parent != BSP_NONE) return 0;
    for (uint32_t i = 0; i < t->node_count; i++) {
        const bsp_node *n = &t->nodes[i];
        if (n->plane >= t->plane_count || n->child[0] == n->child[1] || !child_fits(t, n->child[0], i) || !child_fits(t, n->child[1], i)) return 0;
        depths[i] = i ? depths[n->parent] + 1 : 1;
        if (depths[i] > deepest) deepest = depths[i];
    }
    return deepest == t->depth && deepest <= BSP_DEPTH_MOST;
}

static int order_fits(const bsp_tree *t, uint32_t *seen)
{
    memset(seen, 0, t->item_count * sizeof *seen);
    for (uint32_t i = 0; i < t->item_count; i++) {
        if (t->order[i] >= t->item_count || seen[t->order[i]]) return 0;
        seen[t->order[i]] = 1;
    }
    return 1;
}

static int points_fit(const bsp_tree *t, const bsp_entry *entry, cull_box box)
{
    const double off = 2 * t->slack;
    for (uint32_t i = entry->first_point; i < entry->first_point + entry->point_count; i++) {
        const cull_point p = t->points[i];
        if (!(p.x >= (double)box.min.x - off && p.x <= (double)box.max.x + off && p.y >= (double)box.min.y - off &&
              p.y <= (double)box.max.y + off && p.z >= (double)box.min.z - off && p.z <= (double)box.max.z + off)) return 0;
    }
    return 1;
}

typedef struct entry_check {
    const cull_zone *zone;
    const plane_table *table;
    const bsp_tree *tree;
    uint32_t *seen;             // times that an item was met
    uint32_t entries, points;   // met so far
} entry_check;

static int entry_fits(entry_check *c, const bsp_entry *e)
{
    const bsp_tree *t = c->tree;
    if (e->item >= t->item_count || e->first_point != c->points || e->point_count > t->point_count - c->points) return 0;
    const uint32_t item = t->order[e->item];
    const int is_piece = e->plane != BSP_NONE;
    if (e->plane != c->table->wall_planes[item] || is_piece != (e->point_count >= 3) || is_piece != (e->point_count > 0)) return 0;
    c->points += e->point_count;
    c->seen[e->item]++;
    return points_fit(t, e, cull_box_at(&c->zone->boxes, item));
}

static int range_fits(entry_check *c, uint32_t first, uint32_t count)
{
    if (first != c->entries || count > c->tree->entry_count - c->entries) return 0;
    for (uint32_t i = first; i < first + count; i++) {
        const bsp_entry *e = &c->tree->entries[i], *before = i > first ? e - 1 : NULL;
        if (!entry_fits(c, e)) return 0;
        if (!before) continue;
        if (before->plane == BSP_NONE && e->plane != BSP_NONE) return 0; // pieces first
        if ((before->plane == BSP_NONE) == (e->plane == BSP_NONE) && before->item >= e->item) return 0;
    }
    c->entries += count;
    return 1;
}

static int entries_fit(entry_check *c)
{
    const bsp_tree *t = c->tree;
    uint32_t spanning = 0;
    memset(c->seen, 0, t->item_count * sizeof *c->seen);
    for (uint32_t i = 0; i < t->node_count; i++) {
        if (t->nodes[i].entry_count && t->wish.split != BSP_SPLIT_NODES) return 0;
        if (!range_fits(c, t->nodes[i].first_entry, t->nodes[i].entry_count)) return 0;
    }
    for (uint32_t i = 0; i < t->leaf_count; i++)
        if (!range_fits(c, t->leaves[i].first_entry, t->leaves[i].entry_count)) return 0;
    for (uint32_t i = 0; i < t->item_count; i++) {
        if (c->seen[i] == 0) return 0;
        spanning += c->seen[i] > 1;
    }
    return c->entries == t->entry_count && c->points == t->point_count && spanning == t->spanning;
}

// ---- Loading ----

static cull_result check_tree(const cull_host *host, const bsp_source *from, const plane_table *table, const bsp_tree *t)
{
    int failed = 0;
    const size_t count = (size_t)t->item_count + t->node_count + 1;
    uint32_t *counts = array_alloc(host, count, sizeof *counts, &failed);
    if (failed) return CULL_ERR_MEMORY;
    entry_check c = {.zone = from->zone, .table = table, .tree = t, .seen = counts};
    const int fits = nodes_fit(t, counts) && order_fits(t, counts) && entries_fit(&c);
    array_free(host, counts, count, sizeof *counts);
    return fits ? CULL_OK : CULL_ERR_BLOB;
}

static cull_result arrays_alloc(const cull_host *host, const plane_table *table, bsp_tree *t)
{
    int failed = 0;
    t->planes = vector_copy(&table->planes, &failed);
    t->nodes = array_alloc(host, t->node_count, sizeof *t->nodes, &failed);
    t->leaves = array_alloc(host, t->leaf_count, sizeof *t->leaves, &failed);
    t->node_boxes = array_alloc(host, t->node_count, sizeof *t->node_boxes, &failed);
    t->leaf_boxes = array_alloc(host, t->leaf_count, sizeof *t->leaf_boxes, &failed);
    t->entries = array_alloc(host, t->entry_count, sizeof *t->entries, &failed);
    t->points = array_alloc(host, t->point_count, sizeof *t->points, &failed);
    t->order = array_alloc(host, t->item_count, sizeof *t->order, &failed);
    return failed ? CULL_ERR_MEMORY : CULL_OK;
}

static cull_result arrays_read(const cull_blob *blob, const baked_head *head, bsp_tree *t)
{
    baked_part parts[PART_COUNT];
    const uint32_t part_count = tree_parts(t, parts);
    const char *at = (const char *)blob->bytes + sizeof *head;
    uint64_t check = CHECK_START;
    for (uint32_t i = 0; i < part_count; i++) {
        if (parts[i].size == 0) continue;
        check = check_add(check, at, parts[i].size);
        memcpy(parts[i].bytes, at, parts[i].size);
        at += parts[i].size;
    }
    return check == head->check ? CULL_OK : CULL_ERR_BLOB;
}

static cull_result load_with(const cull_host *host, const bsp_source *from, const plane_table *table, bsp_tree *t)
{
    baked_head head;
    const cull_blob *blob = from->blob;
    if (!blob->bytes || blob->size < sizeof head) return CULL_ERR_BLOB;
    memcpy(&head, blob->bytes, sizeof head);
    if (!head_fits(&head, from, table)) return CULL_ERR_BLOB;
    const bsp_tree counts = {.plane_count = head.plane_count, .node_count = head.node_count, .leaf_count = head.leaf_count,
                             .entry_count = head.entry_count, .point_count = head.point_count, .item_count = head.item_count,
                             .wish = from->wish, .depth = head.depth, .splits = head.splits, .spanning = head.spanning,
                             .bent_leaves = head.bent_leaves, .boxed_walls = table->boxed_walls, .slack = table->slack,
                             .steps_per_metre = table->steps_per_metre};
    baked_part parts[PART_COUNT];
    const uint32_t part_count = tree_parts(&counts, parts);
    uint64_t size = sizeof head;
    for (uint32_t i = 0; i < part_count; i++) size += parts[i].size;
    if (size != blob->size) return CULL_ERR_BLOB; // before anything is asked for in such sizes
    *t = counts;
    cull_result result = arrays_alloc(host, table, t);
    if (result == CULL_OK) result = arrays_read(blob, &head, t);
    return result == CULL_OK ? check_tree(host, from, table, t) : result;
}

cull_result bsp_tree_load(const cull_host *host, const bsp_source *from, bsp_tree *out)
{
    plane_table table;
    bsp_tree tree = {.item_count = 0};
    cull_result result = bsp_planes_make(host, from->zone, &table);
    if (result != CULL_OK) return result;
    result = load_with(host, from, &table, &tree);
    bsp_planes_free(host, &table);
    if (result != CULL_OK) {
        bsp_tree_free(host, &tree);
        return result;
    }
    tree_measure_boxes(from->zone, &tree);
    *out = tree;
    return CULL_OK;
}
