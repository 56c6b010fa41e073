// The walk for one volume without wide vectors: what is found is written at once, as lists of segments cost more than they save where each of
// their numbers is stored alone. Included behind walk_body.h.
// SPDX-License-Identifier: MIT
// Invariant: items are met in the order of walk_segments_body.h, and as many nodes.

// Children from .. to-1 of a node, none of them cut; the item before the first has been met.
static inline found put_children(found f, uint32_t visible, uint32_t from, uint32_t to, const uint32_t *firsts)
{
    const uint32_t range = (1u << to) - (1u << from), here = visible & range;
    const uint32_t before = here << 1 | f.open << from; // bit c: what stands before child c is visible
    for (uint32_t changes = (here ^ before) & range; changes; changes &= changes - 1) *f.out++ = firsts[cull_lowest_bit(changes)];
    f.open = before >> to & 1;
    return f;
}

// Of a leaf's memory what the first plane will read, three of six rows: seldom do more planes cut a leaf.
__attribute__((always_inline)) static inline void prefetch_leaf(const walk *w, uint32_t leaf, uint32_t which)
{
    const float *const block = leaf_at(w->index, leaf);
    const cull_block_plane *p = &w->planes[cull_lowest_bit(which)];
    __builtin_prefetch(block + p->inner_x);
    __builtin_prefetch(block + p->inner_y);
    __builtin_prefetch(block + p->inner_z);
}

// Judges the leaves of a bottom node as boxes, and asks for the memory of those that are cut.
static inline void split_bottom(walk *w, const index_node *node, uint32_t which, cull_block_split *out)
{
    walk_split(w, node, which, out);
    for (uint32_t rest = out->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest);
        prefetch_leaf(w, node->first_child + c, out->planes[c]);
    }
}

static inline found direct_leaves(walk *w, found f, const index_node *node, const cull_block_split *split)
{
    const uint32_t whole = split->touching & ~split->cut;
    uint32_t from = 0, visible[CULL_BLOCK_WIDTH]; // all judged first: no wrong guess of how many changes a leaf has waits for its sums
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest);
        visible[c] = judge_touch(leaf_at(w->index, node->first_child + c), w->planes, split->planes[c]);
        w->nodes++;
    }
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest), first = node->firsts[c];
        if (from != c) f = put_children(f, whole, from, c, node->firsts);
        f = put_leaf(f, visible[c], first, node->firsts[c + 1] - first);
        from = c + 1;
    }
    return put_children(f, whole, from, node->child_count, node->firsts);
}

// A node over bottom nodes, walked as its items stand. All cut children are judged before the first is entered, so that their leaves'
// memory is on its way while others are worked on.
static found direct_bottoms(walk *w, found f, const index_node *node, const cull_block_split *split)
{
    cull_block_split below[CULL_BLOCK_WIDTH];
    const index_node *const children = w->index->bottoms + node->first_child;
    const uint32_t whole = split->touching & ~split->cut;
    uint32_t from = 0;
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest);
        split_bottom(w, &children[c], split->planes[c], &below[c]);
    }
    f = found_to(f, node->firsts[0]);
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest);
        if (from != c) f = put_children(f, whole, from, c, node->firsts);
        f = direct_leaves(w, f, &children[c], &below[c]);
        from = c + 1;
    }
    f = put_children(f, whole, from, node->child_count, node->firsts);
    f.at = node->firsts[CULL_BLOCK_WIDTH];
    return f;
}

// At most INDEX_LEVELS_MOST deep.
static found direct_upper(walk *w, found f, const index_node *node, uint32_t level, const cull_block_split *split)
{
    if (level == 2) return direct_bottoms(w, f, node, split);
    cull_block_split below[CULL_BLOCK_WIDTH];
    const index_node *const children = w->index->nodes + node->first_child;
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest);
        walk_split(w, &children[c], split->planes[c], &below[c]);
        prefetch_children(w, &children[c], level - 1, &below[c]);
    }
    const uint64_t order = near_order(w, node);
    for (uint32_t rest = reorder(split->touching, order); rest; rest &= rest - 1) {
        const uint32_t c = (uint32_t)(order >> 4 * cull_lowest_bit(rest)) & 15;
        if (!(split->cut >> c & 1)) f = put_whole(f, node->firsts[c], node->firsts[c + 1]);
        else f = direct_upper(w, f, &children[c], level - 1, &below[c]);
    }
    return f;
}

// A root over bottom nodes has nothing above to be ordered by: its children come near to far.
static found direct_small(walk *w, found f, const index_node *root, const cull_block_split *split)
{
    cull_block_split below[CULL_BLOCK_WIDTH];
    const index_node *const children = w->index->bottoms + root->first_child;
    for (uint32_t rest = split->cut; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest);
        split_bottom(w, &children[c], split->planes[c], &below[c]);
    }
    const uint64_t order = near_order(w, root);
    for (uint32_t rest = reorder(split->touching, order); rest; rest &= rest - 1) {
        const uint32_t c = (uint32_t)(order >> 4 * cull_lowest_bit(rest)) & 15;
        if (!(split->cut >> c & 1)) {
            f = put_whole(f, root->firsts[c], root->firsts[c + 1]);
            continue;
        }
        f = direct_leaves(w, found_to(f, root->firsts[c]), &children[c], &below[c]);
        f.at = root->firsts[c + 1];
    }
    return f;
}

// One volume, and no faces.
static uint32_t walk_one(const walk_query *q, cull_run *runs, uint32_t *nodes_visited)
{
    uint32_t *const changes = &runs[0].first;
    const octree_index *index = q->index;
    const uint32_t all = cull_block_all_planes(q->volumes);
    cull_block_plane planes[CULL_MAX_PLANES];
    cull_block_split split;
    found f = {changes, 0, 0};
    if (!all) {
        runs[0] = (cull_run){0, index->item_count};
        return 1;
    }
    cull_block_planes(q->volumes, planes);
    walk w = {.index = index, .planes = planes, .eye = q->eye, .order = q->order};
    if (index->level_count == 1) {
        split_bottom(&w, index->bottoms, all, &split);
        f = direct_leaves(&w, f, index->bottoms, &split);
        f.at = index->item_count;
    } else {
        const index_node *root = &index->nodes[index->node_count - 1];
        walk_split(&w, root, all, &split);
        if (index->level_count == 2 && q->order == WALK_NEAR_FIRST) f = direct_small(&w, f, root, &split);
        else f = direct_upper(&w, f, root, index->level_count, &split);
    }
    *nodes_visited += w.nodes;
    if (f.open) *f.out++ = f.at;
    return changes_to_runs(changes, f.out);
}
