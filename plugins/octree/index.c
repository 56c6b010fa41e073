// Building the wide nodes: see index.h.
// SPDX-License-Identifier: MIT
#include "index.h"

#include <string.h>

enum { ALIGN = 64 };

typedef struct level { // entries of the level above
    cull_box *boxes;
    uint32_t *starts; // of each, in the level below; and the end
    uint32_t count;
} level;

typedef struct builder {
    const cull_host *host;
    const cull_zone *zone;
    const uint32_t *order;
    level levels[INDEX_LEVELS_MOST + 1]; // [0]: items, without starts
    uint32_t level_count;
} builder;

// ---- Levels ----

static uint32_t most_blocks(uint32_t entries)
{
    return entries / INDEX_LEAST + 1;
}

static int level_alloc(builder *b, uint32_t l, uint32_t room)
{
    level *v = &b->levels[l];
    v->boxes = b->host->alloc(b->host, ((size_t)room + 1) * sizeof *v->boxes, _Alignof(cull_box));
    v->starts = b->host->alloc(b->host, ((size_t)room + 1) * sizeof *v->starts, _Alignof(uint32_t));
    return v->boxes && v->starts;
}

static void levels_free(builder *b)
{
    for (uint32_t l = 0, room = b->zone->item_count; l <= INDEX_LEVELS_MOST; l++) {
        level *v = &b->levels[l];
        if (v->boxes) b->host->free(b->host, v->boxes, ((size_t)room + 1) * sizeof *v->boxes);
        if (v->starts) b->host->free(b->host, v->starts, ((size_t)room + 1) * sizeof *v->starts);
        room = most_blocks(v->count);
    }
}

static int level_pack(builder *b, uint32_t l)
{
    const level *below = &b->levels[l - 1];
    level *v = &b->levels[l];
    if (!level_alloc(b, l, most_blocks(below->count))) return 0;
    v->count = index_pack(b->host, below->boxes, below->count, v->starts);
    for (uint32_t i = 0; i < v->count; i++) {
        v->boxes[i] = cull_box_none();
        for (uint32_t e = v->starts[i]; e < v->starts[i + 1]; e++) v->boxes[i] = cull_box_union(v->boxes[i], below->boxes[e]);
    }
    return v->count != 0;
}

// Items, leaves, and nodes up to a single one.
static int levels_make(builder *b)
{
    if (!level_alloc(b, 0, b->zone->item_count)) return 0;
    b->levels[0].count = b->zone->item_count;
    for (uint32_t i = 0; i < b->zone->item_count; i++) b->levels[0].boxes[i] = cull_box_at(&b->zone->boxes, b->order[i]);
    do {
        b->level_count++;
        if (!level_pack(b, b->level_count)) return 0;
    } while (b->level_count < 2 || b->levels[b->level_count].count > 1);
    return 1;
}

// ---- Nodes ----

typedef struct towards { const index_order *order; uint32_t octant; int is_inside; } towards;

// What grows with the distance from the eye to the middle of a box.
static double distance_to(const towards *t, cull_box box)
{
    double sum = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double side = t->octant >> axis & 1 ? 1 : -1, middle = ((double)(&box.min.x)[axis] + (double)(&box.max.x)[axis]) / 2;
        const double eye = (double)t->order->centre[axis] + side * (double)t->order->half[axis] / 2;
        sum += t->is_inside ? (middle - eye) * (middle - eye) : -side * middle;
    }
    return sum;
}

static uint64_t sorted_by(const towards *t, const cull_box *boxes, uint32_t count)
{
    uint32_t sorted[CULL_BLOCK_WIDTH];
    uint64_t order = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = i;
        for (; at && distance_to(t, boxes[sorted[at - 1]]) > distance_to(t, boxes[i]); at--) sorted[at] = sorted[at - 1];
        sorted[at] = i;
    }
    for (uint32_t i = 0; i < CULL_BLOCK_WIDTH; i++) order |= (uint64_t)(i < count ? sorted[i] : i) << 4 * i;
    return order;
}

static void order_fill(const builder *b, uint32_t l, uint32_t n, index_order *out)
{
    const uint32_t first = b->levels[l].starts[n], count = b->levels[l].starts[n + 1] - first;
    const cull_box box = b->levels[l].boxes[n];
    for (int axis = 0; axis < 3; axis++) {
        out->centre[axis] = (&box.min.x)[axis] * 0.5f + (&box.max.x)[axis] * 0.5f;
        out->half[axis] = (&box.max.x)[axis] * 0.5f - (&box.min.x)[axis] * 0.5f;
    }
    for (uint32_t o = 0; o < INDEX_OCTANTS; o++) {
        out->children[0][o] = sorted_by(&(towards){out, o, 1}, b->levels[l - 1].boxes + first, count);
        out->children[1][o] = sorted_by(&(towards){out, o, 0}, b->levels[l - 1].boxes + first, count);
    }
}

// ---- Nodes by items ----

// The first item below an entry of level l.
static uint32_t first_item(const builder *b, uint32_t l, uint32_t entry)
{
    for (; l; l--) entry = b->levels[l].starts[entry];
    return entry;
}

static void firsts_fill(const builder *b, uint32_t l, cull_run children, uint32_t *firsts)
{
    for (uint32_t i = 0; i <= CULL_BLOCK_WIDTH; i++) firsts[i] = first_item(b, l - 1, children.first + (i < children.count ? i : children.count));
}

static cull_run children_of(const builder *b, uint32_t l, uint32_t n)
{
    const uint32_t *starts = b->levels[l].starts;
    return (cull_run){starts[n], starts[n + 1] - starts[n]};
}

static void node_fill(const builder *b, uint32_t l, uint32_t n, index_node *out)
{
    const cull_run children = children_of(b, l, n);
    memset(out, 0, sizeof *out);
    cull_block_fill(b->levels[l - 1].boxes + children.first, children.count, out->boxes);
    firsts_fill(b, l, children, out->firsts);
    out->child_count = children.count;
}

static size_t lines(size_t bytes)
{
    return (bytes + ALIGN - 1) / ALIGN * ALIGN;
}

typedef struct parts { // of the one block of memory
    index_node *nodes;
    index_node *bottoms;
    float *leaves, *faces;
    index_order *orders;
    uint32_t *leaf_firsts;
} parts;

static int parts_alloc(const builder *b, index_faces faces, octree_index *out, parts *p)
{
    const size_t leaves = b->levels[1].count, nodes = out->node_count, bottoms = b->levels[2].count;
    const int has_faces = faces == INDEX_FACES && b->zone->walls && b->zone->item_count;
    const size_t bottoms_at = nodes * sizeof(index_node), leaves_at = bottoms_at + bottoms * sizeof(index_node);
    const size_t faces_at = leaves_at + leaves * CULL_BLOCK_FLOATS * sizeof(float);
    const size_t orders_at = faces_at + (has_faces ? leaves * CULL_BLOCK_FACE_FLOATS * sizeof(float) : 0);
    const size_t firsts_at = orders_at + lines(nodes * sizeof(index_order)), bytes = firsts_at + lines((leaves + 1) * sizeof(uint32_t));
    char *memory = b->host->alloc(b->host, bytes, ALIGN);
    if (!memory) return 0;
    *p = (parts){(index_node *)(void *)memory, (index_node *)(void *)(memory + bottoms_at), (float *)(void *)(memory + leaves_at),
                 has_faces ? (float *)(void *)(memory + faces_at) : NULL, (index_order *)(void *)(memory + orders_at),
                 (uint32_t *)(void *)(memory + firsts_at)};
    *out = (octree_index){.item_count = b->zone->item_count, .leaf_count = (uint32_t)leaves, .bottom_count = (uint32_t)bottoms,
                          .node_count = out->node_count, .level_count = b->level_count - 1, .leaves = p->leaves, .leaf_firsts = p->leaf_firsts,
                          .bottoms = p->bottoms, .nodes = p->nodes, .orders = p->orders, .faces = p->faces, .memory = memory, .bytes = bytes};
    return 1;
}

static int index_fill(const builder *b, index_faces faces, octree_index *out)
{
    parts p;
    for (uint32_t l = 3; l <= b->level_count; l++) out->node_count += b->levels[l].count;
    if (!parts_alloc(b, faces, out, &p)) return 0;
    const uint32_t *const starts = b->levels[1].starts;
    memcpy(p.leaf_firsts, starts, ((size_t)out->leaf_count + 1) * sizeof *starts);
    for (uint32_t i = 0; i < out->leaf_count; i++) {
        cull_block_fill(b->levels[0].boxes + starts[i], starts[i + 1] - starts[i], p.leaves + (size_t)i * CULL_BLOCK_FLOATS);
        if (p.faces) cull_block_fill_faces(b->zone, b->order + starts[i], starts[i + 1] - starts[i], p.faces + (size_t)i * CULL_BLOCK_FACE_FLOATS);
    }
    for (uint32_t i = 0; i < out->bottom_count; i++) {
        node_fill(b, 2, i, &p.bottoms[i]);
        p.bottoms[i].first_child = b->levels[2].starts[i];
    }
    uint32_t n = 0, below = 0; // below: the first node of the level below
    for (uint32_t l = 3; l <= b->level_count; l++) {
        const uint32_t here = n;
        for (uint32_t i = 0; i < b->levels[l].count; i++, n++) {
            node_fill(b, l, i, &p.nodes[n]);
            p.nodes[n].first_child = below + b->levels[l].starts[i];
            order_fill(b, l, i, &p.orders[n]);
        }
        below = here;
    }
    return 1;
}

cull_result index_build(const cull_host *host, const cull_zone *zone, const uint32_t *order, index_faces faces, octree_index *out)
{
    builder b = {.host = host, .zone = zone, .order = order};
    memset(out, 0, sizeof *out);
    const int done = levels_make(&b) && index_fill(&b, faces, out);
    levels_free(&b);
    if (!done) memset(out, 0, sizeof *out);
    return done ? CULL_OK : CULL_ERR_MEMORY;
}

void index_free(const cull_host *host, octree_index *index)
{
    if (index->memory) host->free(host, index->memory, index->bytes);
    memset(index, 0, sizeof *index);
}
