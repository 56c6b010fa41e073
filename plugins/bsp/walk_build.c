// The walk's nodes made from the tree: see walk.h. Subtrees without items of their own are left out, small ones become one leaf, and
// long lists are halved further.
// SPDX-License-Identifier: MIT
// Invariant: nothing recurses: a tree may be as deep as it has nodes.
#include "walk.h"
#include "walk_sort.h"

#include <string.h>

typedef enum pending_what { TREE_CHILD, TREE_CHILDREN, ITEMS } pending_what;
typedef struct pending {
    pending_what what;     // CHILDREN: without the node's own items. ITEMS: that many, from the next position on
    uint32_t child, count; // child: as in bsp_node.child
    uint32_t parent;       // whose back child it is; BSP_NONE: nobody's to be told
    uint32_t depth;
} pending;

typedef struct builder {
    const cull_host *host;
    const bsp_tree *tree;
    uint32_t *own, *under; // by tree node, then by leaf: items that stand there; at and under it
    uint32_t *homes;       // by item: the owner that it stands at, numbered as own
    uint32_t *places;      // by position, the order in which items are met
    uint32_t item_count;   // met
    uint32_t position;     // of the next node's items
    const cull_zone *zone;
    pending *stack;
    uint32_t top;
    bsp_walk_node *nodes; // room for all
    bsp_walk *out;
} builder;

static uint32_t number_of(const builder *b, uint32_t child)
{
    return child & BSP_LEAF ? b->tree->node_count + (child & ~BSP_LEAF) : child;
}

static uint32_t root_of(const bsp_tree *tree)
{
    return tree->node_count ? 0 : BSP_LEAF;
}

// ---- Positions ----

typedef struct entries { uint32_t first, count; } entries;

static entries entries_of(const bsp_tree *t, uint32_t child)
{
    if (child & BSP_LEAF) return (entries){t->leaves[child & ~BSP_LEAF].first_entry, t->leaves[child & ~BSP_LEAF].entry_count};
    return (entries){t->nodes[child].first_entry, t->nodes[child].entry_count};
}

typedef void (*owner_visit)(builder *b, uint32_t owner, const bsp_entry *list, uint32_t count);

static void each_owner(builder *b, owner_visit visit) // in preorder
{
    const bsp_tree *t = b->tree;
    b->stack[b->top++].child = root_of(t);
    while (b->top) {
        const uint32_t child = b->stack[--b->top].child;
        const entries e = entries_of(t, child);
        visit(b, number_of(b, child), t->entries + e.first, e.count);
        if (child & BSP_LEAF) continue;
        b->stack[b->top++].child = t->nodes[child].child[1];
        b->stack[b->top++].child = t->nodes[child].child[0];
    }
}

// The zone's order has the walls as the tree meets them where they are at home: the next one is at home where it is listed.
static void find_home(builder *b, uint32_t owner, const bsp_entry *list, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (list[i].item == b->position) b->homes[b->position++] = owner;
}

static void take_in(builder *b, uint32_t owner, const bsp_entry *list, uint32_t count) // what is left: at the first that lists it
{
    for (uint32_t i = 0; i < count; i++)
        if (b->homes[list[i].item] == BSP_NONE) b->homes[list[i].item] = owner;
}

static void meet(builder *b, uint32_t owner, const bsp_entry *list, uint32_t count)
{
    const uint32_t before = b->item_count;
    for (uint32_t i = 0; i < count; i++)
        if (b->homes[list[i].item] == owner) b->places[b->item_count++] = list[i].item;
    b->own[owner] = b->under[owner] = b->item_count - before;
}

static void give_positions(builder *b)
{
    const bsp_tree *t = b->tree;
    for (uint32_t i = 0; i < t->item_count; i++) b->homes[i] = BSP_NONE;
    each_owner(b, find_home);
    each_owner(b, take_in);
    each_owner(b, meet);
    b->position = 0;
    for (uint32_t n = t->node_count; n-- > 0;)
        b->under[n] += b->under[number_of(b, t->nodes[n].child[0])] + b->under[number_of(b, t->nodes[n].child[1])];
}

// ---- Nodes ----

static uint32_t blocks_for(uint32_t items)
{
    return items / WALK_WIDTH + (items % WALK_WIDTH != 0);
}

// A node without items of its own and with all else on one side tells nothing.
static uint32_t skip_single(const builder *b, uint32_t child)
{
    while (!(child & BSP_LEAF) && !b->own[child]) {
        const uint32_t *to = b->tree->nodes[child].child;
        const uint32_t front = b->under[number_of(b, to[0])], back = b->under[number_of(b, to[1])];
        if (front && back) break;
        child = to[front ? 0 : 1];
    }
    return child;
}

static void push(builder *b, pending p)
{
    b->stack[b->top++] = p;
}

static void push_sides(builder *b, uint32_t node, uint32_t depth, const bsp_node *from)
{
    const bsp_plane *plane = &b->tree->planes[from->plane];
    bsp_walk_node *out = &b->nodes[node];
    for (int i = 0; i < 3; i++) out->plane[i] = (float)plane->normal[i];
    out->plane[3] = (float)plane->offset;
    const uint32_t front = b->under[number_of(b, from->child[0])], back = b->under[number_of(b, from->child[1])];
    if (back) push(b, (pending){TREE_CHILD, from->child[1], 0, front ? node : BSP_NONE, depth + 1});
    if (front) push(b, (pending){TREE_CHILD, from->child[0], 0, BSP_NONE, depth + 1});
    out->back = WALK_ONE_CHILD; // the back child of two tells its own number
}

// The node's own items: the next so many.
static void take_items(builder *b, uint32_t node, uint32_t count)
{
    walk_sort(b->places + b->position, count);
    b->nodes[node].count = count;
    b->position += count;
    b->out->block_count += blocks_for(count);
}

static void make_list(builder *b, uint32_t node, const pending *p)
{
    const walk_range range = {b->zone, b->tree->order, b->places + b->position, p->count};
    const uint32_t front = p->count > WALK_LEAF_ITEMS ? walk_halve(&range, WALK_WIDTH, b->nodes[node].plane) : 0;
    if (!front) {
        take_items(b, node, p->count);
        return;
    }
    push(b, (pending){ITEMS, 0, p->count - front, node, p->depth + 1});
    push(b, (pending){ITEMS, 0, front, BSP_NONE, p->depth + 1});
    b->nodes[node].back = WALK_ONE_CHILD;
}

static void make_child(builder *b, uint32_t node, const pending *p)
{
    const uint32_t child = skip_single(b, p->child), number = number_of(b, child), own = b->own[number], under = b->under[number];
    if (child & BSP_LEAF || under <= WALK_LEAF_ITEMS || under == own) {
        const pending items = {ITEMS, 0, under, BSP_NONE, p->depth};
        make_list(b, node, &items);
    } else if (own > WALK_LEAF_ITEMS) { // no plane: they lie in the node's own
        push(b, (pending){TREE_CHILDREN, child, 0, node, p->depth + 1});
        push(b, (pending){ITEMS, 0, own, BSP_NONE, p->depth + 1});
        b->nodes[node].back = WALK_ONE_CHILD;
    } else {
        take_items(b, node, own);
        push_sides(b, node, p->depth, &b->tree->nodes[child]);
    }
}

static void make_nodes(builder *b)
{
    if (b->item_count) push(b, (pending){TREE_CHILD, root_of(b->tree), 0, BSP_NONE, 1});
    while (b->top) {
        const pending p = b->stack[--b->top];
        const uint32_t node = b->out->node_count++;
        b->nodes[node] = (bsp_walk_node){.back = WALK_NO_CHILD, .first = b->out->block_count};
        if (p.parent != BSP_NONE) b->nodes[p.parent].back = node;
        if (p.depth > b->out->depth) b->out->depth = p.depth;
        if (p.what == ITEMS) make_list(b, node, &p);
        else if (p.what == TREE_CHILDREN) push_sides(b, node, p.depth, &b->tree->nodes[p.child]);
        else make_child(b, node, &p);
    }
}

static cull_box node_box(const bsp_walk_node *n)
{
    const cull_box box = {{n->min[0], n->min[1], n->min[2]}, {n->max[0], n->max[1], n->max[2]}};
    return box;
}

// Children stand behind their parent, so one backward loop bounds all.
static void bound_nodes(const builder *b)
{
    const cull_zone *zone = b->zone;
    bsp_walk_node *nodes = b->nodes;
    uint32_t position = b->item_count;
    for (uint32_t i = b->out->node_count; i-- > 0;) {
        bsp_walk_node *n = &nodes[i];
        cull_box box = cull_box_none();
        position -= n->count;
        for (uint32_t k = 0; k < n->count; k++) box = cull_box_union(box, cull_box_at(&zone->boxes, b->tree->order[b->places[position + k]]));
        n->end = n->back == WALK_NO_CHILD ? i + 1 : n->back == WALK_ONE_CHILD ? nodes[i + 1].end : nodes[n->back].end;
        if (n->back != WALK_NO_CHILD) box = cull_box_union(box, node_box(&nodes[i + 1]));
        if (n->back != WALK_NO_CHILD && n->back != WALK_ONE_CHILD) box = cull_box_union(box, node_box(&nodes[n->back]));
        n->min[0] = box.min.x, n->min[1] = box.min.y, n->min[2] = box.min.z;
        n->max[0] = box.max.x, n->max[1] = box.max.y, n->max[2] = box.max.z;
    }
}

// ---- Blocks ----

static void fill_lane(const builder *b, const bsp_shapes *shapes, uint32_t place, walk_block *out, uint32_t lane)
{
    const cull_box box = cull_box_at(&b->zone->boxes, b->tree->order[place]);
    const float min[3] = {box.min.x, box.min.y, box.min.z}, max[3] = {box.max.x, box.max.y, box.max.z};
    const cull_face *face = &shapes->faces[place];
    for (int axis = 0; axis < 3; axis++) {
        out->min[axis][lane] = min[axis];
        out->max[axis][lane] = max[axis];
        out->normal[axis][lane] = face->normal[axis];
    }
    out->offset[lane] = face->offset;
    out->doubt[lane] = face->doubt;
    out->place[lane] = place;
    out->unit[lane] = shapes->firsts[place];
}

static void fill_blocks(const builder *b, const bsp_shapes *shapes)
{
    uint32_t position = 0;
    memset(b->out->blocks, 0, b->out->block_count * sizeof *b->out->blocks);
    for (uint32_t i = 0; i < b->out->node_count; i++)
        for (uint32_t k = 0; k < b->nodes[i].count; k++, position++) {
            walk_block *block = &b->out->blocks[b->nodes[i].first + k / WALK_WIDTH];
            const uint32_t lane = k % WALK_WIDTH;
            fill_lane(b, shapes, b->places[position], block, lane);
            if (lane && block->place[lane] == block->place[lane - 1] + 1) block->joined |= 1u << (lane - 1);
        }
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

// A list is halved into lists of WALK_LEAF_ITEMS / 2 and more, so halving makes fewer nodes than there are items; and a node whose own
// items become a list is two.
static size_t nodes_most(const bsp_tree *t)
{
    return 2 * owners_of(t) + t->item_count;
}

static void close_builder(builder *b)
{
    const size_t owners = owners_of(b->tree), most = nodes_most(b->tree);
    if (b->own) b->host->free(b->host, b->own, owners * sizeof *b->own);
    if (b->under) b->host->free(b->host, b->under, owners * sizeof *b->under);
    if (b->homes) b->host->free(b->host, b->homes, at_least_one(b->tree->item_count) * sizeof *b->homes);
    if (b->stack) b->host->free(b->host, b->stack, (most + 1) * sizeof *b->stack);
    if (b->nodes) b->host->free(b->host, b->nodes, most * sizeof *b->nodes);
    if (b->places) b->host->free(b->host, b->places, at_least_one(b->tree->item_count) * sizeof *b->places);
}

static int open_builder(builder *b)
{
    const size_t owners = owners_of(b->tree), most = nodes_most(b->tree), items = at_least_one(b->tree->item_count);
    b->own = b->host->alloc(b->host, owners * sizeof *b->own, _Alignof(uint32_t));
    b->under = b->host->alloc(b->host, owners * sizeof *b->under, _Alignof(uint32_t));
    b->homes = b->host->alloc(b->host, items * sizeof *b->homes, _Alignof(uint32_t));
    b->stack = b->host->alloc(b->host, (most + 1) * sizeof *b->stack, _Alignof(pending));
    b->nodes = b->host->alloc(b->host, most * sizeof *b->nodes, 64);
    b->places = b->host->alloc(b->host, items * sizeof *b->places, _Alignof(uint32_t));
    if (!b->own || !b->under || !b->homes || !b->stack || !b->nodes || !b->places) return 0;
    return 1;
}

static cull_result build(builder *b, const bsp_shapes *shapes)
{
    bsp_walk *out = b->out;
    if (!open_builder(b)) return CULL_ERR_MEMORY;
    give_positions(b);
    if (b->item_count != b->tree->item_count) {
        b->host->log(b->host, CULL_LOG_ERROR, "bsp: the tree lacks an item of the zone");
        return CULL_ERR_ZONE;
    }
    make_nodes(b);
    bound_nodes(b);
    out->nodes = b->host->alloc(b->host, at_least_one(out->node_count) * sizeof *out->nodes, 64);
    out->blocks = b->host->alloc(b->host, at_least_one(out->block_count) * sizeof *out->blocks, 64);
    if (!out->nodes || !out->blocks) return CULL_ERR_MEMORY;
    if (out->node_count) memcpy(out->nodes, b->nodes, out->node_count * sizeof *out->nodes);
    fill_blocks(b, shapes);
    return CULL_OK;
}

cull_result walk_build(const cull_host *host, const cull_zone *zone, const bsp_tree *tree, const bsp_shapes *shapes, bsp_walk *out)
{
    builder b = {.host = host, .tree = tree, .zone = zone, .out = out};
    memset(out, 0, sizeof *out);
    const cull_result result = build(&b, shapes);
    close_builder(&b);
    if (result != CULL_OK) walk_free(host, out);
    return result;
}

void walk_free(const cull_host *host, bsp_walk *walk)
{
    if (walk->nodes) host->free(host, walk->nodes, at_least_one(walk->node_count) * sizeof *walk->nodes);
    if (walk->blocks) host->free(host, walk->blocks, at_least_one(walk->block_count) * sizeof *walk->blocks);
    memset(walk, 0, sizeof *walk);
}

size_t walk_bytes(const bsp_walk *walk)
{
    return walk->node_count * sizeof *walk->nodes + walk->block_count * sizeof *walk->blocks;
}
