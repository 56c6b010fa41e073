// The exact order of a tree's pieces: the side away from the eye, the node's own, the eye's side (Fuchs, Kedem and Naylor, On
// Visible Surface Generation by A Priori Tree Structures, 1980). No recursion, no allocation: marks in the caller's scratch.
// SPDX-License-Identifier: MIT
//
// Why it is exact. A ray from the eye crosses a node's plane once at most, from the eye's side to the other: what lies behind
// the plane is met later. Pieces in the plane itself are met at one depth. In a leaf any two pieces P, Q lie each in front of
// the other's plane. If P faces the eye, a ray that meets P goes from P's front to its back there, so it met Q, which is in
// front, before. If P shows its back, the ray meets Q after P. So of two that face the eye no ray meets both, and of two that
// show their backs neither; and one that shows its back is nearer than one that faces the eye. This holds wherever the eye
// is, in the leaf or out of it. An eye in a plane meets pieces of that plane in no area, and either side may come first.
// The eye's height above a plane is rounded: where its sign is wrong, the eye is within that rounding of the plane, and a ray
// passes from one side to the other only nearer to the eye than anything is drawn.
#include "pieces_order.h"

#include <string.h>

enum { ALIGN = 64 };

static size_t scratch_bytes(const bsp_tree *tree, uint32_t piece_count)
{
    const size_t bytes = (size_t)piece_count + tree->node_count + tree->leaf_count;
    return (bytes + ALIGN - 1) / ALIGN * ALIGN;
}

// ---- Making ----

static uint32_t loops_in(const bsp_tree *tree, uint32_t first, uint32_t count)
{
    uint32_t loops = 0;
    for (uint32_t i = 0; i < count; i++) loops += tree->entries[first + i].point_count != 0;
    return loops;
}

// None of a tree with a leaf that a limit left as it was: its pieces have no order.
static uint32_t count_pieces(const bsp_tree *tree)
{
    uint32_t count = 0;
    if (tree->bent_leaves) return 0;
    for (uint32_t n = 0; n < tree->node_count; n++) count += loops_in(tree, tree->nodes[n].first_entry, tree->nodes[n].entry_count);
    for (uint32_t l = 0; l < tree->leaf_count; l++) count += loops_in(tree, tree->leaves[l].first_entry, tree->leaves[l].entry_count);
    return count;
}

static bsp_span take(bsp_pieces *p, const bsp_entry *entries, uint32_t count, uint32_t owner)
{
    const uint32_t first = p->piece_count;
    for (uint32_t i = 0; i < count; i++) {
        const bsp_entry *e = &entries[i];
        if (!e->point_count) continue; // no wall
        const cull_piece piece = {e->item, e->first_point, e->point_count, 0};
        p->pieces[p->piece_count] = piece;
        p->planes[p->piece_count] = e->plane;
        p->owners[p->piece_count++] = owner;
    }
    const bsp_span span = {first, p->piece_count - first};
    return span;
}

static void fill(bsp_pieces *p)
{
    const bsp_tree *tree = p->tree;
    for (uint32_t n = 0; n < tree->node_count; n++)
        p->nodes[n] = take(p, tree->entries + tree->nodes[n].first_entry, tree->nodes[n].entry_count, n);
    for (uint32_t l = 0; l < tree->leaf_count; l++)
        p->leaves[l] = take(p, tree->entries + tree->leaves[l].first_entry, tree->leaves[l].entry_count, l | BSP_LEAF);
}

static void order_pieces(const cull_pieces *lent, const cull_piece_request *q);

cull_result bsp_pieces_make(const cull_host *host, const bsp_tree *tree, bsp_pieces *out)
{
    const uint32_t count = count_pieces(tree);
    bsp_pieces p = {{0}, tree, NULL, NULL, NULL, NULL, NULL, count}; // the count for bsp_pieces_free
    p.pieces = host->alloc(host, ((size_t)count + 1) * sizeof *p.pieces, ALIGN);
    p.planes = host->alloc(host, ((size_t)count + 1) * sizeof *p.planes, ALIGN);
    p.owners = host->alloc(host, ((size_t)count + 1) * sizeof *p.owners, ALIGN);
    p.nodes = host->alloc(host, ((size_t)tree->node_count + 1) * sizeof *p.nodes, ALIGN);
    p.leaves = host->alloc(host, ((size_t)tree->leaf_count + 1) * sizeof *p.leaves, ALIGN);
    if (!p.pieces || !p.planes || !p.owners || !p.nodes || !p.leaves) {
        bsp_pieces_free(host, &p);
        return CULL_ERR_MEMORY;
    }
    p.piece_count = 0;
    if (count) fill(&p);
    p.lent.pieces = p.pieces;
    p.lent.points = (const double (*)[3])(const void *)tree->points; // a cull_point is three doubles
    p.lent.scratch_size = scratch_bytes(tree, count);
    p.lent.piece_count = count;
    p.lent.point_count = tree->point_count;
    p.lent.order = order_pieces;
    *out = p;
    return CULL_OK;
}

void bsp_pieces_free(const cull_host *host, bsp_pieces *p)
{
    if (!p->tree) return;
    const size_t count = (size_t)p->piece_count + 1;
    if (p->pieces) host->free(host, p->pieces, count * sizeof *p->pieces);
    if (p->planes) host->free(host, p->planes, count * sizeof *p->planes);
    if (p->owners) host->free(host, p->owners, count * sizeof *p->owners);
    if (p->nodes) host->free(host, p->nodes, ((size_t)p->tree->node_count + 1) * sizeof *p->nodes);
    if (p->leaves) host->free(host, p->leaves, ((size_t)p->tree->leaf_count + 1) * sizeof *p->leaves);
    memset(p, 0, sizeof *p);
}

size_t bsp_pieces_bytes(const bsp_pieces *p)
{
    if (!p->tree) return 0;
    const size_t spans = (size_t)p->tree->node_count + p->tree->leaf_count;
    return p->piece_count * (sizeof *p->pieces + 2 * sizeof(uint32_t)) + spans * sizeof(bsp_span);
}

// ---- The order ----

enum { WANTED = 1, FIRST_IS_BEHIND = 2 }; // marks; FIRST_IS_BEHIND: of a node, child 1 is walked first

typedef struct order_walk {
    const bsp_pieces *p;
    const cull_piece_request *q;
    uint8_t *pieces, *nodes, *leaves; // marks
    uint32_t written;
} order_walk;

static double height_of(const order_walk *w, uint32_t plane)
{
    const bsp_plane *at = &w->p->tree->planes[plane];
    const double *eye = w->q->eye;
    return ((at->normal[0] * eye[0] + at->normal[1] * eye[1]) + at->normal[2] * eye[2]) + at->offset * eye[3];
}

// The pieces, and the way from each to the root until it meets one that is marked.
static void mark_wanted(order_walk *w)
{
    const bsp_tree *tree = w->p->tree;
    for (uint32_t i = 0; i < w->q->count; i++) {
        const uint32_t number = w->q->numbers[i], owner = w->p->owners[number];
        uint32_t node = owner;
        w->pieces[number] = WANTED;
        if (owner & BSP_LEAF) {
            const uint32_t leaf = owner & ~BSP_LEAF;
            if (w->leaves[leaf]) continue;
            w->leaves[leaf] = WANTED;
            node = tree->leaves[leaf].parent;
        }
        for (; node != BSP_NONE && !w->nodes[node]; node = tree->nodes[node].parent) {
            const int is_behind = height_of(w, tree->nodes[node].plane) < 0;
            const int far_first = w->q->depth_order == CULL_FAR_FIRST;
            w->nodes[node] = (uint8_t)(WANTED | (is_behind != far_first ? FIRST_IS_BEHIND : 0));
        }
    }
}

static void write_span(order_walk *w, bsp_span span)
{
    for (uint32_t i = span.first; i < span.first + span.count; i++)
        if (w->pieces[i]) w->q->numbers[w->written++] = i;
}

// Those that face the eye are the farther ones.
static void write_leaf(order_walk *w, uint32_t leaf)
{
    const bsp_span span = w->p->leaves[leaf];
    const int first_faces = w->q->depth_order == CULL_FAR_FIRST;
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = span.first; i < span.first + span.count; i++)
            if (w->pieces[i] && (height_of(w, w->p->planes[i]) > 0) == (pass == 0 ? first_faces : !first_faces)) w->q->numbers[w->written++] = i;
}

static uint8_t mark_of(const order_walk *w, uint32_t ref)
{
    return ref & BSP_LEAF ? w->leaves[ref & ~BSP_LEAF] : w->nodes[ref];
}

// In the order of the marks, by the parents' numbers back up: `from` is the child that the walk came back from.
static void walk(order_walk *w)
{
    const bsp_tree *tree = w->p->tree;
    uint32_t at = tree->node_count ? 0 : BSP_LEAF, from = BSP_NONE;
    if (!tree->node_count) write_leaf(w, 0);
    while (tree->node_count && at != BSP_NONE) {
        if (at & BSP_LEAF) {
            write_leaf(w, at & ~BSP_LEAF);
            from = at;
            at = tree->leaves[at & ~BSP_LEAF].parent;
            continue;
        }
        const bsp_node *node = &tree->nodes[at];
        const uint32_t first = node->child[w->nodes[at] & FIRST_IS_BEHIND ? 1 : 0], second = node->child[w->nodes[at] & FIRST_IS_BEHIND ? 0 : 1];
        uint32_t next = BSP_NONE;
        if (from == BSP_NONE && mark_of(w, first)) next = first;
        else if (from == BSP_NONE || from == first) {
            write_span(w, w->p->nodes[at]);
            if (mark_of(w, second)) next = second;
        }
        from = next == BSP_NONE ? at : BSP_NONE;
        at = next == BSP_NONE ? node->parent : next;
    }
}

static void order_pieces(const cull_pieces *lent, const cull_piece_request *q)
{
    const bsp_pieces *p = (const bsp_pieces *)(const void *)lent;
    if (!q->count) return;
    memset(q->scratch, 0, lent->scratch_size);
    order_walk w = {p, q, q->scratch, NULL, NULL, 0};
    w.nodes = w.pieces + p->piece_count;
    w.leaves = w.nodes + p->tree->node_count;
    mark_wanted(&w);
    walk(&w);
}
