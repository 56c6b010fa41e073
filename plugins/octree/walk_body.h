// The walk down the tree, included by one source file per instruction set.
// SPDX-License-Identifier: MIT
// That file includes <portcullis/block.h> in its own lanes, and defines before:
//   void bottom_split(const index_bottom *b, const cull_block_plane *planes, uint32_t which, cull_block_split *out): as cull_block_split_by, for
//     boxes around the children's; a sum that is no number touches and is cut
//   uint32_t *put_places(uint32_t bits, uint32_t base, uint32_t *out): base + b of each set bit b
//   uint32_t *put_firsts(uint32_t bits, const uint32_t *firsts, uint32_t *out): firsts[b] of each set bit b
//   uint32_t reorder(uint32_t bits, uint64_t order): bit i is bit (order >> 4 i & 15) of bits
// All sums are taken in one order, unfused: the sets are equal bit for bit.
//
// Invariant: what is written is the places where visibility changes. Inside a bottom node these ascend; taken in pairs they are runs as
// (first, end). A run goes on from one node into the next where the next begins at `at`, and is closed there where it doesn't.

typedef struct found { // in registers while a node is walked: what is written could otherwise be any of these
    uint32_t *out;
    uint32_t open; // 1: the item before `at` is visible, its run not yet closed
    uint32_t at;
} found;

typedef struct walk {
    const octree_index *index;
    const cull_block_plane *planes;
    const float *eye;
    found found;
    uint32_t nodes;
    walk_order order;
} walk;

static inline const float *leaf_at(const octree_index *index, uint32_t leaf)
{
    return index->leaves + (size_t)leaf * CULL_BLOCK_FLOATS;
}

// ---- What is found ----

// Items from `first` on come next.
static inline found go_to(found f, uint32_t first)
{
    const uint32_t goes_on = f.at == first;
    *f.out = f.at;
    f.out += f.open & (goes_on ^ 1);
    f.open &= goes_on;
    return f;
}

static inline found put_whole(found f, uint32_t first, uint32_t end)
{
    f = go_to(f, first);
    *f.out = first;
    f.out += f.open ^ 1;
    f.open = 1;
    f.at = end;
    return f;
}

// Children from .. to-1 of a bottom node, none of them cut.
static inline found put_children(found f, const uint32_t *firsts, uint32_t visible, uint32_t from, uint32_t to)
{
    const uint32_t range = (1u << to) - (1u << from);
    const uint32_t before = (visible & range) << 1 | f.open << from; // bit c: the child before c is visible
    f.out = put_firsts((visible ^ before) & range, firsts, f.out);
    f.open = before >> to & 1;
    return f;
}

// Items base .. base + count-1; further bits of visible are 0.
static inline found put_leaf(found f, uint32_t visible, uint32_t base, uint32_t count)
{
    const uint32_t before = visible << 1 | f.open;
    f.out = put_places((visible ^ before) & ((1u << count) - 1), base, f.out);
    f.open = before >> count & 1;
    return f;
}

// Closes the last run and makes counts of ends.
static uint32_t changes_to_runs(found f, uint32_t *changes)
{
    if (f.open) *f.out++ = f.at;
    const uint32_t run_count = (uint32_t)(f.out - changes) / 2;
    for (uint32_t i = 0; i < run_count; i++) changes[2 * i + 1] -= changes[2 * i];
    return run_count;
}

// ---- One volume ----

static inline void walk_split_node(walk *w, const index_node *node, uint32_t which, cull_block_split *out)
{
    cull_block_split_by(node->boxes, w->planes, which, out);
    out->touching &= (1u << node->child_count) - 1;
    out->cut &= out->touching;
    w->nodes++;
}

static inline void walk_split_bottom(walk *w, const index_bottom *node, uint32_t which, cull_block_split *out)
{
    bottom_split(node, w->planes, which, out);
    out->touching &= UINT32_MAX >> (32 - bottom_child_count(node));
    out->cut &= out->touching;
    w->nodes++;
}

static inline void walk_bottom(walk *w, const index_bottom *node, const cull_block_split *split)
{
    const uint32_t visible = split->touching & ~split->cut, *const firsts = node->firsts;
    const float *const leaves = leaf_at(w->index, bottom_first_leaf(node));
    const cull_block_plane *const planes = w->planes;
    uint32_t from = 0;
    found f = go_to(w->found, firsts[0]);
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest), base = firsts[c], count = firsts[c + 1] - base;
        const uint32_t touching = cull_block_touch(leaves + (size_t)c * CULL_BLOCK_FLOATS, planes, split->planes[c]) & ((1u << count) - 1);
        if (from != c) f = put_children(f, firsts, visible, from, c);
        f = put_leaf(f, touching, base, count);
        from = c + 1;
    }
    f = put_children(f, firsts, visible, from, bottom_child_count(node));
    f.at = firsts[CULL_BLOCK_WIDTH];
    w->found = f;
    w->nodes += (uint32_t)__builtin_popcount(split->cut);
}

#define AS_THEY_STAND UINT64_C(0xfedcba9876543210) // child i is the i-th

// Children near to far: which child is the i-th stands in bits 4 i ...
static inline uint64_t near_order(const walk *w, const index_node *node)
{
    if (w->order == WALK_ASCENDING) return AS_THEY_STAND;
    const index_order *order = &w->index->orders[node - w->index->nodes];
    uint32_t octant = 0, is_outside = w->eye[3] == 0;
    for (uint32_t axis = 0; axis < 3; axis++) {
        const float off = w->eye[axis] - order->centre[axis] * w->eye[3];
        octant |= (uint32_t)(off > 0) << axis;
        is_outside |= (uint32_t)(off > order->half[axis]) | (uint32_t)(off < -order->half[axis]);
    }
    return order->children[is_outside][octant]; // no branch: nothing foretells it
}

// Always inlined: gcc 12 takes a function that only asks for memory for one without effect, and drops the call.
__attribute__((always_inline)) static inline void prefetch_bytes(const void *from, size_t size)
{
    for (size_t at = 0; at < size; at += 64) __builtin_prefetch((const char *)from + at);
}

// Of the leaves that will be looked at, the rows that the first of the node's planes reads: most nodes are cut by one.
__attribute__((always_inline)) static inline void prefetch_leaves(const walk *w, const index_bottom *node, uint32_t planes, uint32_t cut)
{
    const cull_block_plane *p = &w->planes[cull_lowest_bit(planes)];
    const float *const leaves = leaf_at(w->index, bottom_first_leaf(node)), *const x = leaves + p->inner_x, *const y = leaves + p->inner_y,
                *const z = leaves + p->inner_z;
    for (; cut; cut &= cut - 1) {
        const size_t at = (size_t)cull_lowest_bit(cut) * CULL_BLOCK_FLOATS;
        __builtin_prefetch(x + at);
        __builtin_prefetch(y + at);
        __builtin_prefetch(z + at);
    }
}

// The children that will be looked at.
__attribute__((always_inline)) static inline void prefetch_children(const walk *w, const index_node *node, uint32_t level, const cull_block_split *split)
{
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t child = node->first_child + cull_lowest_bit(rest);
        if (level > 2) prefetch_bytes(&w->index->nodes[child], sizeof(index_node));
        else prefetch_bytes(&w->index->bottoms[child], sizeof(index_bottom));
    }
}

// A node over bottom nodes, walked as its items stand: near to far, child by child, breaks runs that would go on.
static inline void walk_bottoms(walk *w, const index_node *node, const cull_block_split *split)
{
    const uint32_t visible = split->touching & ~split->cut, *const firsts = node->firsts;
    const index_bottom *const children = w->index->bottoms + node->first_child;
    cull_block_split below[CULL_BLOCK_WIDTH];
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest);
        walk_split_bottom(w, &children[c], split->planes[c], &below[c]);
        if (w->index->bytes > WALK_NEAR_BYTES) prefetch_leaves(w, &children[c], split->planes[c], below[c].cut);
    }
    uint32_t from = 0;
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest);
        found f = go_to(w->found, firsts[from]);
        if (from != c) f = put_children(f, firsts, visible, from, c);
        f.at = firsts[c];
        w->found = f;
        walk_bottom(w, &children[c], &below[c]);
        from = c + 1;
    }
    w->found = put_children(go_to(w->found, firsts[from]), firsts, visible, from, node->child_count);
    w->found.at = firsts[CULL_BLOCK_WIDTH];
}

// All cut children are judged before the first is entered, so that their memory is on its way while others are worked
// on. At most INDEX_LEVELS_MOST deep.
static void walk_upper(walk *w, const index_node *node, uint32_t level, const cull_block_split *split)
{
    if (level == 2) {
        walk_bottoms(w, node, split);
        return;
    }
    cull_block_split below[CULL_BLOCK_WIDTH];
    const index_node *const children = w->index->nodes + node->first_child;
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest);
        walk_split_node(w, &children[c], split->planes[c], &below[c]);
        if (w->index->bytes > WALK_NEAR_BYTES) prefetch_children(w, &children[c], level - 1, &below[c]);
    }
    const uint64_t order = near_order(w, node);
    for (uint32_t rest = reorder(split->touching, order); rest; rest &= rest - 1) {
        const uint32_t c = (uint32_t)(order >> 4 * cull_lowest_bit(rest)) & 15;
        if (!(split->cut >> c & 1)) w->found = put_whole(w->found, node->firsts[c], node->firsts[c + 1]);
        else walk_upper(w, &children[c], level - 1, &below[c]);
    }
}

// A root over bottom nodes has nothing above to be ordered by: its children come near to far. Apart from walk_upper, which inlined copies
// of walk_bottom make slower.
__attribute__((noinline)) static void walk_small(walk *w, const index_node *root, const cull_block_split *split)
{
    const uint64_t order = near_order(w, root);
    for (uint32_t rest = reorder(split->touching, order); rest; rest &= rest - 1) {
        const uint32_t c = (uint32_t)(order >> 4 * cull_lowest_bit(rest)) & 15;
        cull_block_split one;
        if (!(split->cut >> c & 1)) {
            w->found = put_whole(w->found, root->firsts[c], root->firsts[c + 1]);
            continue;
        }
        const index_bottom *child = &w->index->bottoms[root->first_child + c];
        walk_split_bottom(w, child, split->planes[c], &one);
        walk_bottom(w, child, &one);
    }
}

static uint32_t walk_one(const walk_query *q, cull_run *runs, uint32_t *nodes_visited)
{
    uint32_t *const changes = &runs[0].first;
    const octree_index *index = q->index;
    cull_block_plane planes[CULL_MAX_PLANES];
    cull_block_split split;
    if (q->volumes->plane_count == 0) {
        runs[0] = (cull_run){0, index->item_count};
        return 1;
    }
    cull_block_planes(q->volumes, planes);
    walk w = {.index = index, .planes = planes, .eye = q->eye, .found = {changes, 0, 0}, .order = q->order};
    if (index->level_count == 1) {
        walk_split_bottom(&w, index->bottoms, cull_block_all_planes(q->volumes), &split);
        walk_bottom(&w, index->bottoms, &split);
    } else {
        const index_node *root = &index->nodes[index->node_count - 1];
        walk_split_node(&w, root, cull_block_all_planes(q->volumes), &split);
        if (index->level_count == 2 && w.order == WALK_NEAR_FIRST) walk_small(&w, root, &split);
        else walk_upper(&w, root, index->level_count, &split);
    }
    *nodes_visited += w.nodes;
    return changes_to_runs(w.found, changes);
}
