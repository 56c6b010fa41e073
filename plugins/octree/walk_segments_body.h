// The walk for one volume where vectors are wide, through lists of segments. Included behind walk_body.h.
// SPDX-License-Identifier: MIT
// The source file defines before:
//   uint32_t *put_firsts(uint32_t bits, const uint32_t *firsts, uint32_t *out): firsts[b] of each set bit b; it may write 16 numbers
//   void put_all_or_none(uint32_t bits, uint32_t *out): 16 numbers: ALL_ITEMS where the bit is set, 0 elsewhere
//   uint32_t pick(uint32_t bits, uint32_t mask): the bits where the mask has one, moved together (Intel's PEXT)
//
// Invariant: the order is cut into segments, each a leaf that a plane cuts or items that are all in or all out, which stand in a list until it is
// full. Then the leaves are judged one behind the other, so that nothing waits for another's memory, and the segments give runs.

enum {
    SEGMENTS_OF_NODE = 1 + CULL_BLOCK_WIDTH + CULL_BLOCK_WIDTH * CULL_BLOCK_WIDTH, // of a node over bottoms, and what closes those before
    LEAVES_OF_NODE = CULL_BLOCK_WIDTH * CULL_BLOCK_WIDTH,
    SEGMENTS_MOST = 3 * SEGMENTS_OF_NODE, // the lists stay in the first cache
    LEAVES_MOST = 2 * LEAVES_OF_NODE,
};

typedef struct one_walk {
    walk w;
    uint32_t *out;
    uint32_t open; // 1: the item before the first segment is visible, its run not yet closed
    uint32_t at;   // behind the last segment
    uint32_t segment_count, leaf_count;
    uint32_t firsts[SEGMENTS_MOST + CULL_BLOCK_WIDTH];  // of each segment; it ends where the next starts, but for where the walk jumps
    uint32_t visible[SEGMENTS_MOST + CULL_BLOCK_WIDTH]; // bits of its items; all or none where they are more than a leaf's
    uint32_t leaves[LEAVES_MOST + CULL_BLOCK_WIDTH];    // that are cut
    uint32_t planes[LEAVES_MOST + CULL_BLOCK_WIDTH];    // that cut each
    uint32_t places[LEAVES_MOST + CULL_BLOCK_WIDTH];    // of each among the segments
} one_walk;

typedef struct counts { uint32_t segments, leaves; } counts; // of a one_walk, in registers while a node is walked

// Judges the leaves and writes what changes, until nothing is listed. A jump is an invisible segment, so it can't start inside a run.
static void walk_flush(one_walk *s)
{
    for (uint32_t i = 0; i < s->leaf_count; i++)
        s->visible[s->places[i]] = judge_touch(leaf_at(s->w.index, s->leaves[i]), s->w.planes, s->planes[i]);
    s->firsts[s->segment_count] = s->at;
    uint32_t *out = s->out, open = s->open, first = s->firsts[0];
    for (uint32_t i = 0; i < s->segment_count; i++) {
        const uint32_t next = s->firsts[i + 1], length = next - first, width = length < CULL_BLOCK_WIDTH ? length : CULL_BLOCK_WIDTH;
        const uint32_t visible = s->visible[i], before = visible << 1 | open; // bit b: the item before item b is visible
        out = put_places((visible ^ before) & ((1u << width) - 1), first, out);
        open = before >> width & 1;
        first = next;
    }
    s->out = out;
    s->open = open;
    s->segment_count = s->leaf_count = 0;
}

// Room for what a node adds, and the counts to add to. Items from `first` on come next.
static inline counts go_to(one_walk *s, uint32_t first)
{
    if (s->segment_count > SEGMENTS_MOST - SEGMENTS_OF_NODE || s->leaf_count > LEAVES_MOST - LEAVES_OF_NODE) walk_flush(s);
    s->firsts[s->segment_count] = s->at;
    s->visible[s->segment_count] = 0;
    return (counts){s->segment_count + (s->at != first), s->leaf_count};
}

static inline void went_to(one_walk *s, counts n, uint32_t end)
{
    s->segment_count = n.segments;
    s->leaf_count = n.leaves;
    s->at = end;
}

// Segments start at the children that `begins` has, visible where `whole` has them.
static inline counts put_segments(one_walk *s, counts n, uint32_t begins, uint32_t whole, const uint32_t *firsts)
{
    put_all_or_none(pick(whole, begins), s->visible + n.segments);
    put_firsts(begins, firsts, s->firsts + n.segments);
    n.segments += (uint32_t)__builtin_popcount(begins);
    return n;
}

// Children where a segment starts: the first one, those that are cut and those behind them, and where visibility changes.
static inline uint32_t segment_begins(const index_node *node, uint32_t whole, uint32_t cut)
{
    return (1u | cut | cut << 1 | (whole ^ whole << 1)) & ((1u << node->child_count) - 1);
}

static inline counts put_bottom(one_walk *s, counts n, const index_node *node, uint32_t which)
{
    cull_block_split split;
    walk_split(&s->w, node, which, &split);
    const uint32_t cut = split.cut, whole = split.touching & ~cut, begins = segment_begins(node, whole, cut);
    put_places(pick(cut, begins), n.segments, s->places + n.leaves);
    put_places(cut, node->first_child, s->leaves + n.leaves);
    put_firsts(cut, split.planes, s->planes + n.leaves);
    n.leaves += (uint32_t)__builtin_popcount(cut);
    s->w.nodes += (uint32_t)__builtin_popcount(cut);
    return put_segments(s, n, begins, whole, node->firsts);
}

static inline void put_run(one_walk *s, uint32_t first, uint32_t end)
{
    counts n = go_to(s, first);
    s->firsts[n.segments] = first;
    s->visible[n.segments++] = ALL_ITEMS;
    went_to(s, n, end);
}

// ---- Nodes ----

// A node over bottom nodes, walked as its items stand: near to far, child by child, breaks runs that would go on.
static inline void walk_bottoms(one_walk *s, const index_node *node, const cull_block_split *split)
{
    const uint32_t cut = split->cut, whole = split->touching & ~cut, begins = segment_begins(node, whole, cut) & ~cut;
    const index_node *const children = s->w.index->bottoms + node->first_child;
    counts n = go_to(s, node->firsts[0]);
    uint32_t met = 0; // children before the one that is entered
    for (uint32_t rest = cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest), before = (1u << c) - 1;
        n = put_segments(s, n, begins & (before ^ met), whole, node->firsts);
        n = put_bottom(s, n, &children[c], split->planes[c]);
        met = before;
    }
    n = put_segments(s, n, begins & ~met, whole, node->firsts);
    went_to(s, n, node->firsts[CULL_BLOCK_WIDTH]);
}

// All cut children are judged before the first is entered, so that their memory is on its way while others are worked
// on. At most INDEX_LEVELS_MOST deep.
static void walk_upper(one_walk *s, const index_node *node, uint32_t level, const cull_block_split *split)
{
    if (level == 2) {
        walk_bottoms(s, node, split);
        return;
    }
    cull_block_split below[CULL_BLOCK_WIDTH];
    const index_node *const children = s->w.index->nodes + node->first_child;
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest);
        walk_split(&s->w, &children[c], split->planes[c], &below[c]);
        prefetch_children(&s->w, &children[c], level - 1, &below[c]);
    }
    const uint64_t order = near_order(&s->w, node);
    for (uint32_t rest = reorder(split->touching, order); rest; rest &= rest - 1) {
        const uint32_t c = (uint32_t)(order >> 4 * cull_lowest_bit(rest)) & 15;
        if (!(split->cut >> c & 1)) put_run(s, node->firsts[c], node->firsts[c + 1]);
        else walk_upper(s, &children[c], level - 1, &below[c]);
    }
}

// A root over bottom nodes has nothing above to be ordered by: its children come near to far. Apart from walk_upper, which inlined copies
// of put_bottom make slower.
__attribute__((noinline)) static void walk_small(one_walk *s, const index_node *root, const cull_block_split *split)
{
    const uint64_t order = near_order(&s->w, root);
    for (uint32_t rest = reorder(split->touching, order); rest; rest &= rest - 1) {
        const uint32_t c = (uint32_t)(order >> 4 * cull_lowest_bit(rest)) & 15;
        if (!(split->cut >> c & 1)) {
            put_run(s, root->firsts[c], root->firsts[c + 1]);
            continue;
        }
        const counts n = go_to(s, root->firsts[c]);
        went_to(s, put_bottom(s, n, &s->w.index->bottoms[root->first_child + c], split->planes[c]), root->firsts[c + 1]);
    }
}

// One volume, and no faces.
static uint32_t walk_one(const walk_query *q, cull_run *runs, uint32_t *nodes_visited)
{
    uint32_t *const changes = &runs[0].first;
    const octree_index *index = q->index;
    const uint32_t all = cull_block_all_planes(q->volumes);
    cull_block_plane planes[CULL_MAX_PLANES];
    cull_block_split split;
    one_walk s;
    if (!all) {
        runs[0] = (cull_run){0, index->item_count};
        return 1;
    }
    cull_block_planes(q->volumes, planes);
    s.w = (walk){.index = index, .planes = planes, .eye = q->eye, .order = q->order};
    s.out = changes;
    s.open = s.at = s.segment_count = s.leaf_count = 0;
    if (index->level_count == 1) {
        went_to(&s, put_bottom(&s, (counts){0, 0}, index->bottoms, all), index->item_count);
    } else {
        const index_node *root = &index->nodes[index->node_count - 1];
        walk_split(&s.w, root, all, &split);
        if (index->level_count == 2 && q->order == WALK_NEAR_FIRST) walk_small(&s, root, &split);
        else walk_upper(&s, root, index->level_count, &split);
    }
    walk_flush(&s);
    if (s.open) *s.out++ = s.at;
    *nodes_visited += s.w.nodes;
    return changes_to_runs(changes, s.out);
}
