// What tree.h promises, checked by brute force: see tree_fixture.h.
// SPDX-License-Identifier: MIT
// Sides are taken from the planes' doubles alone, so that nothing of the build is asked about itself.
#include "tree_fixture.h"

#include "tests/common/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double height_of(const bsp_plane *plane, cull_point p)
{
    return plane->normal[0] * p.x + plane->normal[1] * p.y + plane->normal[2] * p.z + plane->offset;
}

static double polygon_area(const cull_point *p, uint32_t count)
{
    double n[3] = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < count; i++) {
        const cull_point b = p[i], c = p[i + 1];
        const double u[3] = {b.x - p[0].x, b.y - p[0].y, b.z - p[0].z}, v[3] = {c.x - p[0].x, c.y - p[0].y, c.z - p[0].z};
        for (int k = 0; k < 3; k++) n[k] += u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    }
    return 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

static cull_point vertex_of(const cull_zone *zone, uint32_t item, uint32_t i)
{
    const cull_vec3 v = zone->positions[zone->wall_vertices[zone->walls[item].first_vertex + i]];
    return (cull_point){(double)v.x, (double)v.y, (double)v.z};
}

double tree_wall_area(const cull_zone *zone, uint32_t item)
{
    const uint32_t count = zone->walls[item].vertex_count;
    cull_point *points = calloc(count, sizeof *points);
    if (!points) abort();
    for (uint32_t i = 0; i < count; i++) points[i] = vertex_of(zone, item, i);
    const double area = polygon_area(points, count);
    free(points);
    return area;
}

static double wall_perimeter(const cull_zone *zone, uint32_t item)
{
    const uint32_t count = zone->walls[item].vertex_count;
    double sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        const cull_point a = vertex_of(zone, item, i), b = vertex_of(zone, item, i + 1 < count ? i + 1 : 0);
        sum += sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
    }
    return sum;
}

uint32_t tree_place(const bsp_tree *tree, uint32_t item)
{
    for (uint32_t p = 0; p < tree->item_count; p++)
        if (tree->order[p] == item) return p;
    abort();
}

uint32_t tree_leaves_of(const bsp_tree *tree, uint32_t item)
{
    const uint32_t place = tree_place(tree, item);
    uint32_t count = 0;
    for (uint32_t l = 0; l < tree->leaf_count; l++)
        for (uint32_t e = 0; e < tree->leaves[l].entry_count; e++) count += tree->entries[tree->leaves[l].first_entry + e].item == place;
    return count;
}

// ---- Structure ----

static const char *structure_fault(const bsp_tree *t)
{
    uint32_t next_node = 0, next_leaf = 0, deepest = 0, used = 0;
    uint32_t *ways = calloc((size_t)t->node_count + 2, 2 * sizeof *ways); // (child, depth)
    if (!ways) abort();
    ways[used++] = t->node_count ? 0 : BSP_LEAF;
    ways[used++] = 0;
    const char *fault = t->leaf_count != t->node_count + 1 ? "leaves are not one more than nodes" : NULL;
    uint32_t parent_of_next = BSP_NONE;
    while (used && !fault) {
        const uint32_t depth = ways[--used], at = ways[--used];
        if (depth > deepest) deepest = depth;
        if (at & BSP_LEAF) {
            if ((at & ~BSP_LEAF) != next_leaf++) fault = "leaves are not in the order of the walk";
            continue;
        }
        if (at != next_node++) fault = "nodes are not in the order of the walk";
        for (int side = 1; side >= 0; side--) {
            const uint32_t child = t->nodes[at].child[side];
            parent_of_next = child & BSP_LEAF ? t->leaves[child & ~BSP_LEAF].parent : t->nodes[child].parent;
            if (parent_of_next != at) fault = "a child has another parent";
            if (!(child & BSP_LEAF) && child <= at) fault = "a child comes before its parent";
            ways[used++] = child;
            ways[used++] = depth + 1;
        }
    }
    free(ways);
    if (fault) return fault;
    if (next_node != t->node_count || next_leaf != t->leaf_count) return "something is not in the walk";
    return deepest != t->depth ? "the depth is wrong" : NULL;
}

static const char *order_fault(const bsp_tree *t)
{
    uint8_t *seen = calloc((size_t)t->item_count + 1, 2), *listed = seen + t->item_count;
    uint32_t more_than_once = 0;
    const char *fault = NULL;
    if (!seen) abort();
    for (uint32_t i = 0; i < t->item_count; i++) {
        if (t->order[i] >= t->item_count || seen[t->order[i]]++) fault = "the order is no permutation";
    }
    for (uint32_t e = 0; e < t->entry_count; e++) listed[t->entries[e].item] = (uint8_t)(listed[t->entries[e].item] ? 2 : 1);
    for (uint32_t i = 0; i < t->item_count; i++) {
        if (!listed[i]) fault = "an item stands nowhere";
        more_than_once += listed[i] == 2;
    }
    free(seen);
    return fault ? fault : more_than_once != t->spanning ? "the figure `spanning` is wrong" : NULL;
}

// What stands in one leaf only is a run there, but for walls between that the leaf lists too.
static const char *runs_fault(const bsp_tree *t)
{
    uint32_t *counts = calloc((size_t)t->item_count + 1, sizeof *counts);
    const char *fault = NULL;
    if (!counts) abort();
    for (uint32_t e = 0; e < t->entry_count; e++) counts[t->entries[e].item]++;
    for (uint32_t l = 0; l < t->leaf_count; l++) {
        const bsp_entry *entries = t->entries + t->leaves[l].first_entry;
        uint32_t before = BSP_NONE;
        for (uint32_t e = 0; e < t->leaves[l].entry_count && entries[e].plane != BSP_NONE; e++) {
            if (counts[entries[e].item] != 1) continue;
            if (before != BSP_NONE && entries[e].item - entries[before].item != e - before) fault = "what stands in one leaf only is no run there";
            before = e;
        }
    }
    free(counts);
    return fault;
}

static const char *ranges_fault(const bsp_tree *t)
{
    uint32_t entries = 0, points = 0;
    for (uint32_t o = 0; o < t->node_count + t->leaf_count; o++) {
        const int is_node = o < t->node_count;
        const uint32_t first = is_node ? t->nodes[o].first_entry : t->leaves[o - t->node_count].first_entry;
        const uint32_t count = is_node ? t->nodes[o].entry_count : t->leaves[o - t->node_count].entry_count;
        if (first != entries) return "entries are not in one piece";
        if (is_node && count && t->wish.split != BSP_SPLIT_NODES) return "a node has entries";
        for (uint32_t e = first; e < first + count; e++) {
            const bsp_entry *at = &t->entries[e];
            if (at->first_point != points) return "points are not in one piece";
            if ((at->point_count == 0) != (at->plane == BSP_NONE)) return "a piece without a plane, or a plane without a piece";
            if (e == first) {
                points += at->point_count;
                continue;
            }
            if (at[-1].plane == BSP_NONE && at->plane != BSP_NONE) return "a piece behind a box";
            if ((at[-1].plane == BSP_NONE) == (at->plane == BSP_NONE) && at[-1].item >= at->item) return "entries do not rise, or one stands twice";
            points += at->point_count;
        }
        entries += count;
    }
    return entries != t->entry_count || points != t->point_count ? "entries or points are left over" : NULL;
}

// ---- Pieces ----

static int lies_in(const bsp_tree *t, const bsp_entry *entry, const bsp_plane *plane)
{
    for (uint32_t i = 0; i < entry->point_count; i++)
        if (!(fabs(height_of(plane, t->points[entry->first_point + i])) <= 2 * t->slack)) return 0;
    return 1;
}

static const char *piece_fault(const cull_zone *zone, const bsp_tree *t, const bsp_entry *entry, uint32_t parent, uint32_t child)
{
    const double off = 2 * t->slack;
    const uint32_t item = t->order[entry->item];
    if (!lies_in(t, entry, &t->planes[entry->plane])) return "a point lies off the wall's plane";
    while (parent != BSP_NONE) {
        const bsp_node *node = &t->nodes[parent];
        const double sign = node->child[0] == child ? 1 : -1;
        for (uint32_t i = 0; i < entry->point_count; i++)
            if (!(sign * height_of(&t->planes[node->plane], t->points[entry->first_point + i]) >= -off)) return "a piece lies outside its leaf";
        child = parent;
        parent = node->parent;
    }
    return zone->walls[item].vertex_count < 3 ? "a piece of no wall" : NULL;
}

static const char *pieces_fault(const cull_zone *zone, const bsp_tree *t)
{
    double *areas = calloc((size_t)t->item_count + 1, sizeof *areas);
    const char *fault = NULL;
    if (!areas) abort();
    for (uint32_t o = 0; o < t->node_count + t->leaf_count && !fault; o++) {
        const int is_node = o < t->node_count;
        const uint32_t number = is_node ? o : o - t->node_count, parent = is_node ? t->nodes[number].parent : t->leaves[number].parent;
        const uint32_t first = is_node ? t->nodes[number].first_entry : t->leaves[number].first_entry;
        const uint32_t count = is_node ? t->nodes[number].entry_count : t->leaves[number].entry_count;
        for (uint32_t e = first; e < first + count && !fault; e++) {
            const bsp_entry *at = &t->entries[e];
            if (at->plane == BSP_NONE) continue;
            fault = piece_fault(zone, t, at, parent, is_node ? number : number | BSP_LEAF);
            if (is_node && !lies_in(t, at, &t->planes[t->nodes[number].plane])) fault = "a node's piece lies off its plane";
            areas[at->item] += polygon_area(t->points + at->first_point, at->point_count);
        }
    }
    for (uint32_t p = 0; p < t->item_count && !fault; p++) {
        const uint32_t item = t->order[p];
        if (!zone->walls || zone->walls[item].vertex_count < 3 || areas[p] == 0) continue;
        const double whole = tree_wall_area(zone, item), off = t->slack * wall_perimeter(zone, item);
        if (fabs(areas[p] - whole) > 1e-9 * whole + off) fault = "the pieces do not cover their wall once";
    }
    free(areas);
    return fault;
}

static int is_in_front(const bsp_tree *t, const bsp_entry *piece, const bsp_entry *of) // or on it, facing as it does
{
    const bsp_plane *plane = &t->planes[of->plane], *own = &t->planes[piece->plane];
    double least = INFINITY, most = -INFINITY;
    for (uint32_t i = 0; i < piece->point_count; i++) {
        const double h = height_of(plane, t->points[piece->first_point + i]);
        least = fmin(least, h);
        most = fmax(most, h);
    }
    if (least < -1.0001 * t->slack) return 0;
    if (most > 0.9999 * t->slack) return 1;
    return own->normal[0] * plane->normal[0] + own->normal[1] * plane->normal[1] + own->normal[2] * plane->normal[2] > -1e-9;
}

static const char *convex_fault(const bsp_tree *t)
{
    uint32_t bent = 0;
    for (uint32_t l = 0; l < t->leaf_count; l++) {
        const bsp_entry *entries = t->entries + t->leaves[l].first_entry;
        uint32_t count = 0, is_bent = 0;
        while (count < t->leaves[l].entry_count && entries[count].plane != BSP_NONE) count++;
        for (uint32_t i = 0; i < count && !is_bent; i++)
            for (uint32_t k = 0; k < count && !is_bent; k++) is_bent = !is_in_front(t, &entries[i], &entries[k]);
        bent += is_bent;
    }
    return bent > t->bent_leaves ? "a leaf is not convex" : NULL;
}

// ---- Boxes ----

static int box_equal(cull_box a, cull_box b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static const char *boxes_fault(const cull_zone *zone, const bsp_tree *t)
{
    cull_box *nodes = calloc((size_t)t->node_count + 1, sizeof *nodes);
    const char *fault = NULL;
    if (!nodes) abort();
    for (uint32_t n = 0; n < t->node_count; n++) nodes[n] = cull_box_none();
    for (uint32_t o = 0; o < t->node_count + t->leaf_count; o++) {
        const int is_node = o < t->node_count;
        const uint32_t number = is_node ? o : o - t->node_count, first = is_node ? t->nodes[number].first_entry : t->leaves[number].first_entry;
        const uint32_t count = is_node ? t->nodes[number].entry_count : t->leaves[number].entry_count;
        cull_box box = cull_box_none();
        for (uint32_t e = first; e < first + count; e++) box = cull_box_union(box, cull_box_at(&zone->boxes, t->order[t->entries[e].item]));
        if (!is_node && !box_equal(box, t->leaf_boxes[number])) fault = "a leaf's box is wrong";
        for (uint32_t n = is_node ? number : t->leaves[number].parent; n != BSP_NONE; n = t->nodes[n].parent) nodes[n] = cull_box_union(nodes[n], box);
    }
    for (uint32_t n = 0; n < t->node_count; n++)
        if (!box_equal(nodes[n], t->node_boxes[n])) fault = "a node's box is wrong";
    free(nodes);
    return fault;
}

// The leaf that a point lies in, or BSP_NONE: too near to a plane to tell.
static uint32_t leaf_at(const bsp_tree *t, cull_point p)
{
    uint32_t at = t->node_count ? 0 : BSP_LEAF;
    while (!(at & BSP_LEAF)) {
        const double h = height_of(&t->planes[t->nodes[at].plane], p);
        if (fabs(h) <= t->slack) return BSP_NONE;
        at = t->nodes[at].child[h < 0];
    }
    return at & ~BSP_LEAF;
}

static int leaf_lists(const bsp_tree *t, uint32_t leaf, uint32_t place)
{
    for (uint32_t e = 0; e < t->leaves[leaf].entry_count; e++)
        if (t->entries[t->leaves[leaf].first_entry + e].item == place) return 1;
    return 0;
}

static const char *boxed_items_fault(const cull_zone *zone, const bsp_tree *t)
{
    uint64_t seed = 7;
    uint8_t *is_piece = calloc((size_t)t->item_count + 1, 1);
    const char *fault = NULL;
    if (!is_piece) abort();
    for (uint32_t e = 0; e < t->entry_count; e++) is_piece[t->entries[e].item] |= t->entries[e].plane != BSP_NONE;
    for (uint32_t p = 0; p < t->item_count; p++) {
        const cull_box b = cull_box_at(&zone->boxes, t->order[p]);
        for (int i = 0; i < 32 && !is_piece[p]; i++) {
            const cull_point at = {random_between(&seed, (double)b.min.x, (double)b.max.x), random_between(&seed, (double)b.min.y, (double)b.max.y),
                                   random_between(&seed, (double)b.min.z, (double)b.max.z)};
            const uint32_t leaf = leaf_at(t, at);
            if (leaf != BSP_NONE && !leaf_lists(t, leaf, p)) fault = "a leaf that a box reaches does not list it";
        }
    }
    free(is_piece);
    return fault;
}

const char *tree_fault(const cull_zone *zone, const bsp_tree *t)
{
    const char *fault = t->item_count != zone->item_count ? "the tree is of other items" : structure_fault(t);
    if (!fault) fault = ranges_fault(t);
    if (!fault) fault = order_fault(t);
    if (!fault) fault = runs_fault(t);
    if (!fault) fault = pieces_fault(zone, t);
    if (!fault) fault = convex_fault(t);
    if (!fault) fault = boxes_fault(zone, t);
    return fault ? fault : boxed_items_fault(zone, t);
}

const char *tree_difference(const bsp_tree *a, const bsp_tree *b)
{
    if (a->node_count != b->node_count || a->leaf_count != b->leaf_count) return "other counts of nodes";
    if (a->entry_count != b->entry_count || a->item_count != b->item_count) return "other counts of entries";
    if (memcmp(a->nodes, b->nodes, a->node_count * sizeof *a->nodes) != 0) return "other nodes";
    if (memcmp(a->leaves, b->leaves, a->leaf_count * sizeof *a->leaves) != 0) return "other leaves";
    if (memcmp(a->order, b->order, a->item_count * sizeof *a->order) != 0) return "another order";
    for (uint32_t e = 0; e < a->entry_count; e++) {
        const bsp_entry *x = &a->entries[e], *y = &b->entries[e];
        if (x->item != y->item || x->point_count != y->point_count || x->plane != y->plane) return "other entries";
    }
    return NULL;
}
