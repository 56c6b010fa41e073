// The walk for several volumes and for faces, all in one pass. Included behind the walk for one.
// SPDX-License-Identifier: MIT
// Invariant: an item is met once, with what every volume and its face say of it together. A node is entered with the volumes that cut it,
// each with the planes that do; one volume that has all of a node inside ends the asking below it.

// ---- Several volumes ----

typedef struct many_walk {
    walk w;
    found found;
    float reach; // of the eye
    int is_far;  // the index is larger than the near caches
    cull_block_plane planes[WALK_VOLUMES][CULL_MAX_PLANES];
} many_walk;

typedef struct volume_part { uint32_t volume, planes; } volume_part; // the planes that cut what is looked at

typedef struct part_list {
    uint32_t count;
    volume_part parts[WALK_VOLUMES];
} part_list;

static inline void many_leaf(many_walk *m, uint32_t leaf, uint32_t visible)
{
    const octree_index *index = m->w.index;
    const uint32_t base = index->leaf_firsts[leaf], end = index->leaf_firsts[leaf + 1];
    visible &= (1u << (end - base)) - 1;
    if (index->faces && visible) visible &= cull_block_facing(index->faces + (size_t)leaf * CULL_BLOCK_FACE_FLOATS, m->w.eye, m->reach);
    m->found = put_leaf(found_to(m->found, base), visible, base, end - base);
    m->found.at = end;
}

// Leaves from `leaf` on up to the item `end`, all inside a volume.
static inline void many_whole(many_walk *m, uint32_t leaf, cull_run items)
{
    const octree_index *index = m->w.index;
    const uint32_t end = items.first + items.count;
    if (!index->faces) {
        m->found = put_whole(m->found, items.first, end);
        return;
    }
    for (; leaf < index->leaf_count && index->leaf_firsts[leaf] < end; leaf++) many_leaf(m, leaf, ALL_ITEMS);
}

static inline void many_cut_leaf(many_walk *m, uint32_t leaf, const part_list *list)
{
    uint32_t visible = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        visible |= judge_touch(leaf_at(m->w.index, leaf), m->planes[list->parts[i].volume], list->parts[i].planes);
        m->w.nodes++;
    }
    many_leaf(m, leaf, visible);
}

typedef struct many_split {
    cull_block_split splits[WALK_VOLUMES]; // as in the list
    uint32_t touching, whole;              // some volume's
} many_split;

static inline void many_split_add(many_split *s, uint32_t i)
{
    s->touching |= s->splits[i].touching;
    s->whole |= s->splits[i].touching & ~s->splits[i].cut;
}

static inline void many_below(const many_split *s, const part_list *list, uint32_t c, part_list *below)
{
    below->count = 0;
    for (uint32_t i = 0; i < list->count; i++)
        if (s->splits[i].cut >> c & 1) below->parts[below->count++] = (volume_part){list->parts[i].volume, s->splits[i].planes[c]};
}

static void many_bottom(many_walk *m, const index_node *node, const part_list *list)
{
    many_split s = {.touching = 0};
    for (uint32_t i = 0; i < list->count; i++) {
        m->w.planes = m->planes[list->parts[i].volume];
        walk_split(&m->w, node, list->parts[i].planes, &s.splits[i]);
        many_split_add(&s, i);
    }
    for (uint32_t rest = m->is_far ? s.touching & ~s.whole : 0; rest; rest &= rest - 1)
        prefetch_bytes(leaf_at(m->w.index, node->first_child + cull_lowest_bit(rest)), CULL_BLOCK_FLOATS * sizeof(float));
    for (uint32_t rest = s.touching; rest; rest &= rest - 1) {
        const uint32_t c = cull_lowest_bit(rest);
        part_list below;
        if (s.whole >> c & 1) {
            many_whole(m, node->first_child + c, (cull_run){node->firsts[c], node->firsts[c + 1] - node->firsts[c]});
            continue;
        }
        many_below(&s, list, c, &below);
        many_cut_leaf(m, node->first_child + c, &below);
    }
}

static uint32_t first_leaf(const octree_index *index, uint32_t level, uint32_t entry) // of an entry of the level
{
    for (; level > 1; level--) entry = index->nodes[entry].first_child;
    return index->bottoms[entry].first_child;
}

// At most INDEX_LEVELS_MOST deep.
static void many_node(many_walk *m, const index_node *node, uint32_t level, const part_list *list)
{
    const octree_index *index = m->w.index;
    many_split s = {.touching = 0};
    for (uint32_t i = 0; i < list->count; i++) {
        m->w.planes = m->planes[list->parts[i].volume];
        walk_split(&m->w, node, list->parts[i].planes, &s.splits[i]);
        many_split_add(&s, i);
    }
    for (uint32_t rest = m->is_far ? s.touching & ~s.whole : 0; rest; rest &= rest - 1) {
        const uint32_t child = node->first_child + cull_lowest_bit(rest);
        if (level > 2) prefetch_bytes(&index->nodes[child], sizeof(index_node));
        else prefetch_bytes(&index->bottoms[child], sizeof(index_node));
    }
    const uint64_t order = level == 2 && index->level_count > 2 ? AS_THEY_STAND : near_order(&m->w, node);
    for (uint32_t rest = reorder(s.touching, order); rest; rest &= rest - 1) {
        const uint32_t c = (uint32_t)(order >> 4 * cull_lowest_bit(rest)) & 15, child = node->first_child + c;
        part_list below;
        if (s.whole >> c & 1) {
            many_whole(m, index->faces ? first_leaf(index, level - 1, child) : 0, (cull_run){node->firsts[c], node->firsts[c + 1] - node->firsts[c]});
            continue;
        }
        many_below(&s, list, c, &below);
        if (level > 2) many_node(m, &index->nodes[child], level - 1, &below);
        else many_bottom(m, &index->bottoms[child], &below);
    }
}

static uint32_t walk_many(const walk_query *q, cull_run *runs, uint32_t *nodes_visited)
{
    const octree_index *index = q->index;
    uint32_t *const changes = &runs[0].first;
    many_walk m;
    part_list list = {.count = 0};
    m.w = (walk){.index = index, .eye = q->eye, .order = q->order};
    m.found = (found){changes, 0, 0};
    m.reach = cull_block_reach(q->eye);
    m.is_far = index->bytes > WALK_NEAR_BYTES;
    for (uint32_t v = 0; v < q->volume_count; v++) {
        cull_block_planes(&q->volumes[v], m.planes[v]);
        list.parts[list.count++] = (volume_part){v, cull_block_all_planes(&q->volumes[v])};
    }
    if (index->level_count == 1) many_bottom(&m, index->bottoms, &list);
    else many_node(&m, &index->nodes[index->node_count - 1], index->level_count, &list);
    *nodes_visited += m.w.nodes;
    if (m.found.open) *m.found.out++ = m.found.at;
    return changes_to_runs(changes, m.found.out);
}

static uint32_t walk_any(const walk_query *q, cull_run *runs, uint32_t *nodes_visited)
{
    if (q->index->item_count == 0 || q->volume_count == 0) return 0;
    return q->volume_count == 1 && !q->index->faces ? walk_one(q, runs, nodes_visited) : walk_many(q, runs, nodes_visited);
}
