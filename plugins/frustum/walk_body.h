// The walk down the tree, included by one source file per instruction set.
// SPDX-License-Identifier: MIT
// That file includes <portcullis/block.h> in its own lanes, and defines before:
//   uint32_t *put16(uint32_t bits, uint32_t base, uint32_t shift, uint32_t *out): base + (b << shift) of each set bit b
// All sums are taken in one order, unfused: the sets are equal bit for bit.
//
// Invariant: items are met in ascending order, and what is written is the places where visibility changes. Taken in
// pairs these are the runs as (first, end), so runs of neighbouring subtrees join by themselves.

typedef struct walk {
    const frustum_index *index;
    const cull_block_plane *planes;
    uint32_t *out;
    uint32_t open; // 1: the last item met is visible
    uint32_t nodes;
} walk;

static inline const float *block_at(const frustum_index *index, uint32_t level, uint32_t block)
{
    return index->levels[level] + (size_t)block * CULL_BLOCK_FLOATS;
}

// Bits of entries that are there: all but in the last block of a level.
static inline uint32_t block_entries(const frustum_index *index, uint32_t level, uint32_t block)
{
    const uint32_t left = index->entry_counts[level] - block * CULL_BLOCK_WIDTH;
    return left < CULL_BLOCK_WIDTH ? (1u << left) - 1 : 0xffffu;
}

// Children from .. to-1 of a node, none of them cut; child c starts at base + (c << shift).
static inline void walk_put(walk *w, uint32_t visible, uint32_t from, uint32_t to, uint32_t base, uint32_t shift)
{
    const uint32_t range = (1u << to) - (1u << from), here = visible & range;
    const uint32_t before = here << 1 | w->open << from; // bit c: the child before c is visible
    w->out = put16((here ^ before) & range, base, shift, w->out);
    w->open = before >> to & 1;
}

static inline void walk_leaf(walk *w, uint32_t block, uint32_t planes)
{
    const uint32_t visible = cull_block_touch(block_at(w->index, 0, block), w->planes, planes) & block_entries(w->index, 0, block);
    walk_put(w, visible, 0, CULL_BLOCK_WIDTH, block * CULL_BLOCK_WIDTH, 0);
    w->nodes++;
}

// Judges the children of a node, and asks for the memory of those that are cut.
static inline void walk_split_node(walk *w, uint32_t level, uint32_t block, const cull_block_plane *planes, uint32_t which, cull_block_split *out)
{
    cull_block_split_by(block_at(w->index, level, block), planes, which, out);
    out->touching &= block_entries(w->index, level, block);
    out->cut &= out->touching;
    w->nodes++;
    for (uint32_t rest = out->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest), child = block * CULL_BLOCK_WIDTH + c;
        for (int line = 0; line < CULL_BLOCK_FLOATS; line += 16) __builtin_prefetch(block_at(w->index, level - 1, child) + line);
    }
}

// All cut children are judged before the first is entered, so that their memory is on its way while others are worked
// on. At most INDEX_MAX_LEVELS deep.
static void walk_node(walk *w, uint32_t level, uint32_t block, const cull_block_split *split)
{
    cull_block_split below[CULL_BLOCK_WIDTH];
    const uint32_t shift = INDEX_SHIFT * level, base = (uint32_t)((uint64_t)block << (shift + INDEX_SHIFT));
    const uint32_t visible = split->touching & ~split->cut;
    if (level > 1)
        for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
            const uint32_t c = cull_lowest_bit(rest);
            walk_split_node(w, level - 1, block * CULL_BLOCK_WIDTH + c, w->planes, split->planes[c], &below[c]);
        }
    uint32_t from = 0;
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest), child = block * CULL_BLOCK_WIDTH + c;
        walk_put(w, visible, from, c, base, shift);
        if (level == 1) walk_leaf(w, child, split->planes[c]);
        else walk_node(w, level - 1, child, &below[c]);
        from = c + 1;
    }
    walk_put(w, visible, from, CULL_BLOCK_WIDTH, base, shift);
}

// Closes the last run at `end` and makes counts of ends. Places may lie beyond `end` where the last subtree is not full.
static uint32_t changes_to_runs(uint32_t *changes, uint32_t *out, uint32_t end)
{
    const uint32_t count = (uint32_t)(out - changes), run_count = (count + 1) / 2;
    if (run_count == 0) return 0;
    if (count % 2) changes[count] = end;
    if (changes[2 * run_count - 1] > end) changes[2 * run_count - 1] = end;
    for (uint32_t i = 0; i < run_count; i++) changes[2 * i + 1] -= changes[2 * i];
    return run_count;
}

static uint32_t walk_volume(const frustum_index *index, const cull_volume *volume, cull_run *runs, uint32_t *nodes_visited)
{
    uint32_t *const changes = &runs[0].first;
    if (index->item_count == 0) return 0;
    if (volume->plane_count == 0) {
        runs[0] = (cull_run){0, index->item_count};
        return 1;
    }
    cull_block_plane planes[CULL_MAX_PLANES];
    cull_block_planes(volume, planes);
    const uint32_t all = UINT32_MAX >> (CULL_MAX_PLANES - volume->plane_count);
    walk w = {.index = index, .planes = planes, .out = changes};
    if (index->level_count == 1) {
        walk_leaf(&w, 0, all);
    } else {
        cull_block_split root;
        walk_split_node(&w, index->level_count - 1, 0, planes, all, &root);
        walk_node(&w, index->level_count - 1, 0, &root);
    }
    *nodes_visited += w.nodes;
    return changes_to_runs(changes, w.out, index->item_count);
}

static uint32_t walk_facing(const frustum_index *index, const float eye[4], const cull_run *in, uint32_t in_count, cull_run *out)
{
    uint32_t *const changes = &out[0].first;
    const float reach = cull_block_reach(eye);
    walk w = {.index = index, .out = changes};
    for (uint32_t r = 0; r < in_count; r++) {
        const uint32_t end = in[r].first + in[r].count - 1; // the last one: first + count may be 2^32
        for (uint32_t block = in[r].first / CULL_BLOCK_WIDTH; block <= end / CULL_BLOCK_WIDTH; block++) {
            const uint32_t base = block * CULL_BLOCK_WIDTH;
            const uint32_t from = in[r].first > base ? in[r].first - base : 0;
            const uint32_t to = end - base < CULL_BLOCK_WIDTH ? end - base + 1 : CULL_BLOCK_WIDTH;
            const uint32_t facing = cull_block_facing(index->faces + (size_t)block * CULL_BLOCK_FACE_FLOATS, eye, reach);
            walk_put(&w, facing, from, to, base, 0);
        }
        if (w.open) *w.out++ = end + 1; // runs never touch, so nothing joins
        w.open = 0;
    }
    return changes_to_runs(changes, w.out, index->item_count);
}
