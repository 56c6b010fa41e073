// The lent hierarchy: see hierarchy.h.
// SPDX-License-Identifier: MIT
// Invariant: nodes stand level by level, so children are side by side and come after their parent. A node's box covers the pieces that
// it lists, and the boxes of all nodes that list an item cover the whole item: a wall is hidden where all its pieces are.
#include "hierarchy.h"

#include <math.h>
#include <string.h>

typedef struct builder {
    const cull_host *host;
    const cull_zone *zone;
    const bsp_tree *tree;
    uint32_t *listings; // by tree node, then by leaf: entries at and under it
    uint32_t *times;    // by item: nodes that list it
    uint32_t *last;     // by item: the last of them, + 1
    uint32_t *children, *depths; // by node: the tree's child that it is, as in bsp_node.child; nodes on the way
    uint32_t *stack;
    cull_box *covers; // by item: of the nodes that list it, together
    cull_node *nodes; // room for all
    bsp_lent *out;
} builder;

static uint32_t listings_of(const builder *b, uint32_t child)
{
    return b->listings[child & BSP_LEAF ? b->tree->node_count + (child & ~BSP_LEAF) : child];
}

static void count_listings(builder *b)
{
    const bsp_tree *t = b->tree;
    for (uint32_t i = 0; i < t->leaf_count; i++) b->listings[t->node_count + i] = t->leaves[i].entry_count;
    for (uint32_t n = t->node_count; n-- > 0;)
        b->listings[n] = t->nodes[n].entry_count + listings_of(b, t->nodes[n].child[0]) + listings_of(b, t->nodes[n].child[1]);
}

// ---- Boxes ----

static float rounded_down(double x)
{
    const float near = (float)x;
    return (double)near > x ? nextafterf(near, -INFINITY) : near;
}

static float rounded_up(double x)
{
    const float near = (float)x;
    return (double)near < x ? nextafterf(near, INFINITY) : near;
}

static cull_box item_box(const builder *b, uint32_t place)
{
    return cull_box_at(&b->zone->boxes, b->tree->order[place]);
}

static cull_box entry_box(const builder *b, const bsp_entry *entry)
{
    cull_box box = cull_box_none();
    if (!entry->point_count) return item_box(b, entry->item);
    for (uint32_t i = entry->first_point; i < entry->first_point + entry->point_count; i++) {
        const cull_point p = b->tree->points[i];
        const cull_box at = {{rounded_down(p.x), rounded_down(p.y), rounded_down(p.z)}, {rounded_up(p.x), rounded_up(p.y), rounded_up(p.z)}};
        box = cull_box_union(box, at);
    }
    return box;
}

static void fold_boxes(builder *b)
{
    for (uint32_t n = b->out->hierarchy.node_count; n-- > 0;)
        for (uint32_t c = 0; c < b->nodes[n].child_count; c++)
            b->nodes[n].box = cull_box_union(b->nodes[n].box, b->nodes[b->nodes[n].first_child + c].box);
}

// Items that their pieces' boxes do not cover, by rounding: one node that lists such a one takes all of it.
static void cover_items(builder *b)
{
    uint32_t uncovered = 0;
    fold_boxes(b);
    for (uint32_t i = 0; i < b->tree->item_count; i++) b->covers[i] = cull_box_none();
    for (uint32_t n = 0; n < b->out->hierarchy.node_count; n++)
        for (uint32_t i = b->nodes[n].first_item; i < b->nodes[n].first_item + b->nodes[n].item_count; i++)
            b->covers[b->out->items[i]] = cull_box_union(b->covers[b->out->items[i]], b->nodes[n].box);
    for (uint32_t n = 0; n < b->out->hierarchy.node_count; n++)
        for (uint32_t i = b->nodes[n].first_item; i < b->nodes[n].first_item + b->nodes[n].item_count; i++) {
            const uint32_t item = b->out->items[i];
            const cull_box box = item_box(b, item);
            if (cull_box_contains(b->covers[item], box)) continue;
            b->nodes[n].box = cull_box_union(b->nodes[n].box, box);
            b->covers[item] = cull_box_union(b->covers[item], box);
            uncovered++;
        }
    if (uncovered) fold_boxes(b);
}

// ---- Nodes ----

static void list_entries(builder *b, uint32_t node, uint32_t first, uint32_t count)
{
    cull_node *out = &b->nodes[node];
    for (uint32_t i = first; i < first + count; i++) {
        const bsp_entry *entry = &b->tree->entries[i];
        out->box = cull_box_union(out->box, entry_box(b, entry));
        if (b->last[entry->item] == node + 1) continue; // several leaves become one
        b->last[entry->item] = node + 1;
        b->times[entry->item]++;
        b->out->items[b->out->hierarchy.item_count++] = entry->item;
        out->item_count++;
    }
}

// Everything at and under the tree's child goes into the node.
static void list_subtree(builder *b, uint32_t node, uint32_t child)
{
    uint32_t top = 0;
    b->stack[top++] = child;
    while (top) {
        const uint32_t at = b->stack[--top];
        if (at & BSP_LEAF) {
            const bsp_leaf *leaf = &b->tree->leaves[at & ~BSP_LEAF];
            list_entries(b, node, leaf->first_entry, leaf->entry_count);
            continue;
        }
        const bsp_node *n = &b->tree->nodes[at];
        list_entries(b, node, n->first_entry, n->entry_count);
        for (int side = 1; side >= 0; side--)
            if (listings_of(b, n->child[side])) b->stack[top++] = n->child[side];
    }
}

// A node without own entries and with all else on one side tells nothing.
static uint32_t skip_single(const builder *b, uint32_t child)
{
    while (!(child & BSP_LEAF) && !b->tree->nodes[child].entry_count) {
        const uint32_t *to = b->tree->nodes[child].child;
        const uint32_t front = listings_of(b, to[0]), back = listings_of(b, to[1]);
        if (front && back) break;
        child = to[front ? 0 : 1];
    }
    return child;
}

static void add_node(builder *b, uint32_t child, uint32_t depth)
{
    const uint32_t node = b->out->hierarchy.node_count++;
    b->children[node] = skip_single(b, child);
    b->depths[node] = depth;
    b->nodes[node] = (cull_node){.box = cull_box_none()};
    if (depth > b->out->hierarchy.depth) b->out->hierarchy.depth = depth;
}

static void make_nodes(builder *b)
{
    const uint32_t root = b->tree->node_count ? 0 : BSP_LEAF;
    if (listings_of(b, root)) add_node(b, root, 1);
    for (uint32_t node = 0; node < b->out->hierarchy.node_count; node++) {
        const uint32_t child = b->children[node];
        b->nodes[node].first_item = b->out->hierarchy.item_count;
        if (child & BSP_LEAF || listings_of(b, child) <= LENT_LEAF_LISTINGS) {
            list_subtree(b, node, child);
            continue;
        }
        const bsp_node *from = &b->tree->nodes[child];
        list_entries(b, node, from->first_entry, from->entry_count);
        b->nodes[node].first_child = b->out->hierarchy.node_count;
        for (int side = 0; side < 2; side++)
            if (listings_of(b, from->child[side])) add_node(b, from->child[side], b->depths[node] + 1);
        b->nodes[node].child_count = b->out->hierarchy.node_count - b->nodes[node].first_child;
    }
}

// ---- Runs under a node ----

typedef struct span { uint32_t low, high, items, shared; } span; // shared: of the items under a node, listed by several

static span span_of(const builder *b, const cull_node *node, const span *spans)
{
    span s = {UINT32_MAX, 0, node->item_count, 0};
    for (uint32_t i = node->first_item; i < node->first_item + node->item_count; i++) {
        const uint32_t item = b->out->items[i];
        if (item < s.low) s.low = item;
        if (item > s.high) s.high = item;
        s.shared += b->times[item] > 1;
    }
    for (uint32_t c = 0; c < node->child_count; c++) {
        const span *child = &spans[node->first_child + c];
        if (child->low < s.low) s.low = child->low;
        if (child->high > s.high) s.high = child->high;
        s.items += child->items;
        s.shared += child->shared;
    }
    return s;
}

// Where all under a node is listed nowhere else, counting tells whether it lies together; and the root has everything.
static int find_runs(builder *b)
{
    const uint32_t count = b->out->hierarchy.node_count;
    span *spans = count ? b->host->alloc(b->host, count * sizeof *spans, _Alignof(span)) : NULL;
    if (!spans) return !count;
    for (uint32_t n = count; n-- > 0;) {
        spans[n] = span_of(b, &b->nodes[n], spans);
        if (!spans[n].shared && spans[n].high - spans[n].low + 1 == spans[n].items) b->nodes[n].subtree = (cull_run){spans[n].low, spans[n].items};
    }
    b->nodes[0].subtree = (cull_run){0, b->tree->item_count};
    b->host->free(b->host, spans, count * sizeof *spans);
    return 1;
}

// ---- Memory ----

static size_t at_least_one(size_t count)
{
    return count ? count : 1;
}

static size_t owners_of(const bsp_tree *t)
{
    return (size_t)t->node_count + t->leaf_count;
}

static void *numbers_alloc(const cull_host *host, size_t count)
{
    return host->alloc(host, at_least_one(count) * sizeof(uint32_t), _Alignof(uint32_t));
}

static void numbers_free(const cull_host *host, uint32_t *numbers, size_t count)
{
    if (numbers) host->free(host, numbers, at_least_one(count) * sizeof *numbers);
}

static int open_builder(builder *b)
{
    const size_t owners = owners_of(b->tree), items = b->tree->item_count;
    b->listings = numbers_alloc(b->host, owners);
    b->times = numbers_alloc(b->host, items);
    b->last = numbers_alloc(b->host, items);
    b->children = numbers_alloc(b->host, owners);
    b->depths = numbers_alloc(b->host, owners);
    b->stack = numbers_alloc(b->host, owners + 1);
    b->covers = b->host->alloc(b->host, at_least_one(items) * sizeof *b->covers, _Alignof(cull_box));
    b->nodes = b->host->alloc(b->host, owners * sizeof *b->nodes, _Alignof(cull_node));
    b->out->items = numbers_alloc(b->host, b->tree->entry_count);
    if (!b->listings || !b->times || !b->last || !b->children || !b->depths || !b->stack || !b->covers || !b->nodes || !b->out->items) return 0;
    memset(b->times, 0, items * sizeof *b->times);
    memset(b->last, 0, items * sizeof *b->last);
    return 1;
}

static void close_builder(builder *b)
{
    const size_t owners = owners_of(b->tree), items = b->tree->item_count;
    numbers_free(b->host, b->listings, owners);
    numbers_free(b->host, b->times, items);
    numbers_free(b->host, b->last, items);
    numbers_free(b->host, b->children, owners);
    numbers_free(b->host, b->depths, owners);
    numbers_free(b->host, b->stack, owners + 1);
    if (b->covers) b->host->free(b->host, b->covers, at_least_one(items) * sizeof *b->covers);
    if (b->nodes) b->host->free(b->host, b->nodes, owners * sizeof *b->nodes);
}

// Into an array that fits.
static int keep_nodes(builder *b)
{
    const size_t bytes = at_least_one(b->out->hierarchy.node_count) * sizeof *b->nodes;
    b->out->nodes = b->host->alloc(b->host, bytes, 64);
    if (!b->out->nodes) return 0;
    if (b->out->hierarchy.node_count) memcpy(b->out->nodes, b->nodes, bytes);
    b->out->hierarchy.nodes = b->out->nodes;
    b->out->hierarchy.items = b->out->items;
    return 1;
}

cull_result lent_build(const cull_host *host, const cull_zone *zone, const bsp_tree *tree, bsp_lent *out)
{
    builder b = {.host = host, .zone = zone, .tree = tree, .out = out};
    int done = 0;
    memset(out, 0, sizeof *out);
    out->listing_room = tree->entry_count;
    if (open_builder(&b)) {
        count_listings(&b);
        make_nodes(&b);
        cover_items(&b);
        done = find_runs(&b) && keep_nodes(&b);
    }
    close_builder(&b);
    if (!done) lent_free(host, out);
    return done ? CULL_OK : CULL_ERR_MEMORY;
}

void lent_free(const cull_host *host, bsp_lent *lent)
{
    if (lent->nodes) host->free(host, lent->nodes, at_least_one(lent->hierarchy.node_count) * sizeof *lent->nodes);
    numbers_free(host, lent->items, lent->listing_room);
    memset(lent, 0, sizeof *lent);
}

size_t lent_bytes(const bsp_lent *lent)
{
    return lent->hierarchy.node_count * sizeof *lent->nodes + lent->listing_room * sizeof *lent->items;
}
