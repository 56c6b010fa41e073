// What every walk down the tree starts from, included by one source file per instruction set.
// SPDX-License-Identifier: MIT
// That file includes <portcullis/block.h> in its own lanes, and defines before:
//   uint32_t *put_places(uint32_t bits, uint32_t base, uint32_t *out): base + b of each set bit b; it may write 16 numbers, however few count
//   uint32_t reorder(uint32_t bits, uint64_t order): bit i is bit (order >> 4 i & 15) of bits
//   void ends_to_counts(uint32_t *changes, uint32_t run_count): changes[2 i + 1] -= changes[2 i]; up to 15 numbers behind may change
// All sums are taken in one order, unfused: the sets are equal bit for bit.
//
// Invariant: what is written is the places where visibility changes; taken in pairs they are runs as (first, end). Behind this file comes
// walk_segments_body.h or walk_direct_body.h, which meet the same items in the same order, then walk_many_body.h.

typedef struct walk {
    const octree_index *index;
    const cull_block_plane *planes;
    const float *eye;
    uint32_t nodes;
    walk_order order;
} walk;

static inline const float *leaf_at(const octree_index *index, uint32_t leaf)
{
    return index->leaves + (size_t)leaf * CULL_BLOCK_FLOATS;
}

static inline void walk_split(walk *w, const index_node *node, uint32_t which, cull_block_split *out)
{
    judge_split(node->boxes, w->planes, which, out);
    out->touching &= (1u << node->child_count) - 1;
    out->cut &= out->touching;
    w->nodes++;
}

// Makes counts of ends.
static uint32_t changes_to_runs(uint32_t *changes, const uint32_t *out)
{
    const uint32_t run_count = (uint32_t)(out - changes) / 2;
    ends_to_counts(changes, run_count);
    return run_count;
}

// ---- Which way, and what is asked for ahead ----

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

// The children that will be looked at.
__attribute__((always_inline)) static inline void prefetch_children(const walk *w, const index_node *node, uint32_t level, const cull_block_split *split)
{
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t child = node->first_child + cull_lowest_bit(rest);
        if (level > 2) prefetch_bytes(&w->index->nodes[child], sizeof(index_node));
        else prefetch_bytes(&w->index->bottoms[child], sizeof(index_node));
    }
}

// ---- What is found, item by item ----

typedef struct found { // in registers while a node is walked: what is written could otherwise be any of these
    uint32_t *out;
    uint32_t open; // 1: the item before `at` is visible, its run not yet closed
    uint32_t at;
} found;

// Items from `first` on come next.
static inline found found_to(found f, uint32_t first)
{
    const uint32_t goes_on = f.at == first;
    *f.out = f.at;
    f.out += f.open & (goes_on ^ 1);
    f.open &= goes_on;
    return f;
}

static inline found put_whole(found f, uint32_t first, uint32_t end)
{
    f = found_to(f, first);
    *f.out = first;
    f.out += f.open ^ 1;
    f.open = 1;
    f.at = end;
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
