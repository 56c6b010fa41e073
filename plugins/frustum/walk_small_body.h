// The walk of small indices: all volumes and the faces in one pass, block by block. Included behind walk_body.h.
// SPDX-License-Identifier: MIT
// Invariant: an item is met once, with what every volume and its face say of it together: no lists of runs are merged. The set is
// that of walk_volume for each volume, united, and of walk_facing on that.

typedef struct small_volume {
    cull_block_plane planes[CULL_MAX_PLANES];
    cull_block_split root, node; // of the block on top, and of the one below it that is being walked
} small_volume;

typedef struct small_walk {
    walk w;
    const small_query *query;
    float reach; // of the eye
    small_volume volumes[WALK_SMALL_VOLUMES];
} small_walk;

// Of the item block's places: those that the faces let pass.
static inline uint32_t small_facing(const small_walk *s, uint32_t block)
{
    const frustum_index *index = s->w.index;
    const uint32_t there = block_entries(index, 0, block);
    if (!index->faces) return there;
    return there & cull_block_facing(index->faces + (size_t)block * CULL_BLOCK_FACE_FLOATS, s->query->eye, s->reach);
}

// Places from the block's first on, all that come before having been met.
static inline void small_put(small_walk *s, uint32_t visible, uint32_t block)
{
    walk_put(&s->w, visible, 0, CULL_BLOCK_WIDTH, block * CULL_BLOCK_WIDTH, 0);
}

// Blocks that no volume touches: what was open ends.
static inline void small_skip(small_walk *s, uint32_t block)
{
    if (s->w.open) *s->w.out++ = block * CULL_BLOCK_WIDTH;
    s->w.open = 0;
}

// The item blocks below one node. Each volume's split of it stands in volumes[].node.
static inline void small_blocks(small_walk *s, uint32_t node)
{
    const uint32_t volume_count = s->query->volume_count;
    uint32_t touching = 0, whole = 0;
    for (uint32_t v = 0; v < volume_count; v++) {
        const cull_block_split *split = &s->volumes[v].node;
        touching |= split->touching;
        whole |= split->touching & ~split->cut;
    }
    uint32_t next = node * CULL_BLOCK_WIDTH;
    for (uint32_t rest = touching; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest), block = node * CULL_BLOCK_WIDTH + c;
        uint32_t visible = whole >> c & 1 ? 0xffffu : 0;
        for (uint32_t v = 0; v < volume_count && visible != 0xffffu; v++) {
            const small_volume *volume = &s->volumes[v];
            if (!(volume->node.cut >> c & 1)) continue;
            visible |= cull_block_touch(block_at(s->w.index, 0, block), volume->planes, volume->node.planes[c]);
            s->w.nodes++;
        }
        if (block != next) small_skip(s, next);
        if (visible) visible &= small_facing(s, block);
        small_put(s, visible, block);
        next = block + 1;
    }
    if (next != (node + 1) * CULL_BLOCK_WIDTH) small_skip(s, next);
}

// A volume's split of child c of the top block, as if it were walked down to.
static inline void small_enter(small_walk *s, small_volume *volume, uint32_t c)
{
    const uint32_t there = block_entries(s->w.index, 1, c);
    volume->node.touching = volume->node.cut = 0;
    if (!(volume->root.touching >> c & 1)) return;
    if (volume->root.cut >> c & 1) walk_split_node(&s->w, 1, c, volume->planes, volume->root.planes[c], &volume->node);
    else volume->node.touching = there;
}

static inline void small_start(small_walk *s)
{
    const frustum_index *index = s->w.index;
    for (uint32_t v = 0; v < s->query->volume_count; v++) {
        const cull_volume *from = &s->query->volumes[v];
        small_volume *volume = &s->volumes[v];
        const uint32_t all = from->plane_count ? UINT32_MAX >> (CULL_MAX_PLANES - from->plane_count) : 0;
        cull_block_planes(from, volume->planes);
        cull_block_split *top = index->level_count == 3 ? &volume->root : &volume->node;
        if (index->level_count > 1) {
            walk_split_node(&s->w, index->level_count - 1, 0, volume->planes, all, top);
            continue;
        }
        top->touching = 1; // one block, under no other
        top->cut = all != 0;
        top->planes[0] = all;
    }
}

static uint32_t walk_small(const frustum_index *index, const small_query *q, cull_run *runs, uint32_t *nodes_visited)
{
    uint32_t *const changes = &runs[0].first;
    if (index->item_count == 0) return 0;
    small_walk s;
    s.w = (walk){.index = index, .out = changes};
    s.query = q;
    s.reach = cull_block_reach(q->eye);
    small_start(&s);
    if (index->level_count < 3) small_blocks(&s, 0);
    else
        for (uint32_t c = 0; c < index->entry_counts[2]; c++) {
            for (uint32_t v = 0; v < q->volume_count; v++) small_enter(&s, &s.volumes[v], c);
            small_blocks(&s, c);
        }
    *nodes_visited += s.w.nodes;
    return changes_to_runs(changes, s.w.out, index->item_count);
}
