// The walk for several volumes and for faces, all in one pass. Included behind walk_body.h.
// SPDX-License-Identifier: MIT
// Invariant: an item is met once, with what every volume and its face say of it together. A node is entered with the volumes that cut it,
// each with the planes that do; one volume that has all of a node inside ends the asking below it.

typedef struct many_walk {
    walk w;
    float reach; // of the eye
    walk_plane planes[WALK_VOLUMES][CULL_MAX_PLANES];
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
    if (index->faces && visible) visible &= block_facing(index->faces + (size_t)leaf * INDEX_FACE_FLOATS, m->w.eye, m->reach);
    m->w.found = put_leaf(go_to(m->w.found, base), visible, base, end - base);
    m->w.found.at = end;
}

// Child c of a node of the level, all of it inside a volume.
static inline void many_whole(many_walk *m, const index_node *node, uint32_t level, uint32_t c)
{
    const octree_index *index = m->w.index;
    const uint32_t end = node->firsts[c + 1];
    if (!index->faces) {
        m->w.found = put_whole(m->w.found, node->firsts[c], end);
        return;
    }
    uint32_t leaf = node->first_child + c;
    for (; level > 1; level--) leaf = index->nodes[leaf].first_child;
    for (; leaf < index->leaf_count && index->leaf_firsts[leaf] < end; leaf++) many_leaf(m, leaf, 0xffff);
}

static inline void many_cut_leaf(many_walk *m, uint32_t leaf, const part_list *list)
{
    uint32_t visible = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        visible |= block_touch(leaf_at(m->w.index, leaf), m->planes[list->parts[i].volume], list->parts[i].planes);
        m->w.nodes++;
    }
    many_leaf(m, leaf, visible);
}

// At most INDEX_LEVELS_MOST deep.
static void many_node(many_walk *m, const index_node *node, uint32_t level, const part_list *list)
{
    walk_split splits[WALK_VOLUMES];
    uint32_t touching = 0, whole = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        m->w.planes = m->planes[list->parts[i].volume];
        walk_split_node(&m->w, node, list->parts[i].planes, &splits[i]);
        touching |= splits[i].touching;
        whole |= splits[i].touching & ~splits[i].cut;
    }
    const int is_small = level < 2 || (level == 2 && m->w.index->level_count > 2);
    const uint64_t order = is_small ? AS_THEY_STAND : near_order(&m->w, node);
    for (uint32_t rest = reorder(touching, order); rest; rest &= rest - 1) {
        const uint32_t c = (uint32_t)(order >> 4 * lowest_bit(rest)) & 15;
        part_list below;
        if (whole >> c & 1) {
            many_whole(m, node, level, c);
            continue;
        }
        below.count = 0;
        for (uint32_t i = 0; i < list->count; i++)
            if (splits[i].cut >> c & 1) below.parts[below.count++] = (volume_part){list->parts[i].volume, splits[i].planes[c]};
        if (level > 1) many_node(m, m->w.index->nodes + node->first_child + c, level - 1, &below);
        else many_cut_leaf(m, node->first_child + c, &below);
    }
}

static float largest(const float v[4])
{
    float most = 0;
    for (int i = 0; i < 3; i++) {
        const float size = v[i] < 0 ? -v[i] : v[i];
        if (size > most) most = size;
    }
    return most;
}

static uint32_t walk_many(const walk_query *q, cull_run *runs, uint32_t *nodes_visited)
{
    const octree_index *index = q->index;
    const index_node *root = &index->nodes[index->node_count - 1];
    uint32_t *const changes = &runs[0].first;
    many_walk m;
    part_list list = {.count = 0};
    m.w = (walk){.index = index, .eye = q->eye, .found = {changes, 0, 0}, .order = q->order};
    m.reach = largest(q->eye);
    for (uint32_t v = 0; v < q->volume_count; v++) {
        planes_ready(&q->volumes[v], m.planes[v]);
        list.parts[list.count++] = (volume_part){v, all_planes(&q->volumes[v])};
    }
    many_node(&m, root, index->level_count, &list);
    *nodes_visited += m.w.nodes;
    return changes_to_runs(m.w.found, changes);
}

static uint32_t walk_any(const walk_query *q, cull_run *runs, uint32_t *nodes_visited)
{
    if (q->index->item_count == 0 || q->volume_count == 0) return 0;
    return q->volume_count == 1 && !q->index->faces ? walk_one(q, runs, nodes_visited) : walk_many(q, runs, nodes_visited);
}
