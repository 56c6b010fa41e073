// The zone graph at rest: see graph.h. One tree over the zones' bounds, and one over the hulls of each zone.
// SPDX-License-Identifier: MIT
// Invariant: a tree's nodes stand depth first, and each knows the node behind its last descendant: a walk needs no stack.
// Trees halve their leaves by count, so that equal centres cost no more than others.
#include "graph.h"
#include "zone_seam.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Of a hull's size and of its distance from the origin: its bounds are cut out of its planes, good to a tenth of these.
#define BOUNDS_ERROR_SIZE 1e-8
#define BOUNDS_ERROR_PLACE 1e-14

enum { TREE_STACK = 40 }; // over the depth of a halved tree of 2^32 leaves

typedef struct node {
    double min[3], max[3];
    uint32_t item;  // a leaf's zone or hull; SCENE_NONE: inner, its first child is the next node
    uint32_t after; // the node behind its last descendant, counted from the tree's first
} node;

typedef struct tree {
    uint32_t first, count; // in graph.nodes
} tree;

typedef struct leaf { // of a tree to build
    double min[3], max[3], key;
    uint32_t item;
} leaf;

struct graph {
    const scene *scene;
    node *nodes;
    tree *hulls; // by zone
    tree zones;
    uint32_t *everywhere; // zones, ascending
    uint8_t *is_parent;   // by zone
    zone_seam *seams;     // by zone; touch and hold: what comes on top of a probe's
    uint32_t everywhere_count;
    arena memory;
};

// A point or box to look up. What is within `touch` outside a hull touches it; what is deeper than `hold` is held by it:
// both more by what the zone's portals lie off its hulls.
typedef struct probe {
    double min[3], max[3], touch, hold; // metres
} probe;

typedef struct zone_list {
    uint32_t *zones; // the least `capacity` of all that were added; a heap once there are more
    uint32_t capacity, enough, count; // enough: the search ends at so many
} zone_list;

// ---- Building ----

static int leaf_order(const void *a, const void *b)
{
    const leaf *x = a, *y = b;
    if (x->key != y->key) return x->key < y->key ? -1 : 1;
    return x->item < y->item ? -1 : x->item > y->item;
}

static void leaves_sort(leaf *leaves, uint32_t count)
{
    double low[3], high[3];
    for (int k = 0; k < 3; k++) low[k] = high[k] = leaves[0].min[k] + leaves[0].max[k];
    for (uint32_t i = 1; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            const double twice_centre = leaves[i].min[k] + leaves[i].max[k];
            if (twice_centre < low[k]) low[k] = twice_centre;
            if (twice_centre > high[k]) high[k] = twice_centre;
        }
    }
    int axis = 0;
    for (int k = 1; k < 3; k++) {
        if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
    }
    for (uint32_t i = 0; i < count; i++) leaves[i].key = leaves[i].min[axis] + leaves[i].max[axis];
    qsort(leaves, count, sizeof *leaves, leaf_order);
}

static void tree_bounds(node *nodes, uint32_t count)
{
    for (uint32_t i = count; i-- > 0;) {
        if (nodes[i].item != SCENE_NONE) continue;
        const node *left = &nodes[i + 1], *right = &nodes[left->after];
        for (int k = 0; k < 3; k++) {
            nodes[i].min[k] = left->min[k] < right->min[k] ? left->min[k] : right->min[k];
            nodes[i].max[k] = left->max[k] > right->max[k] ? left->max[k] : right->max[k];
        }
    }
}

// Fills 2 * count - 1 nodes.
static void tree_build(node *nodes, leaf *leaves, uint32_t count)
{
    struct { uint32_t node, first, count; } stack[TREE_STACK];
    uint32_t depth = 0;
    stack[depth].node = stack[depth].first = 0;
    stack[depth++].count = count;
    while (depth > 0) {
        const uint32_t at = stack[--depth].node, first = stack[depth].first, some = stack[depth].count;
        node *n = &nodes[at];
        n->after = at + 2 * some - 1;
        if (some == 1) {
            memcpy(n->min, leaves[first].min, sizeof n->min);
            memcpy(n->max, leaves[first].max, sizeof n->max);
            n->item = leaves[first].item;
            continue;
        }
        n->item = SCENE_NONE;
        leaves_sort(leaves + first, some);
        const uint32_t half = some / 2;
        assert(depth + 2 <= TREE_STACK);
        stack[depth].node = at + 2 * half;
        stack[depth].first = first + half;
        stack[depth++].count = some - half;
        stack[depth].node = at + 1;
        stack[depth].first = first;
        stack[depth++].count = half;
    }
    tree_bounds(nodes, 2 * count - 1);
}

static leaf leaf_make(const double min[3], const double max[3], uint32_t item)
{
    leaf l = {.item = item};
    memcpy(l.min, min, sizeof l.min);
    memcpy(l.max, max, sizeof l.max);
    return l;
}

static void leaf_widen(leaf *l, double by)
{
    for (int k = 0; k < 3; k++) {
        const double size = l->max[k] - l->min[k], farthest = fmax(fabs(l->min[k]), fabs(l->max[k]));
        const double error = by + BOUNDS_ERROR_SIZE * size + BOUNDS_ERROR_PLACE * farthest;
        l->min[k] -= error;
        l->max[k] += error;
    }
}

static int is_found_by_hulls(const scene_zone *z)
{
    return z->hull_count > 0 && !(z->flags & (ZONE_EVERYWHERE | ZONE_STRAY));
}

static void trees_build(graph *g, leaf *leaves)
{
    const scene *s = g->scene;
    uint32_t used = 0;
    for (uint32_t z = 0; z < s->zone_count; z++) {
        const scene_zone *zone = &s->zones[z];
        g->hulls[z] = (tree){used, 0};
        if (!is_found_by_hulls(zone)) continue;
        for (uint32_t i = 0; i < zone->hull_count; i++) {
            const scene_hull *h = &s->hulls[zone->first_hull + i];
            leaves[i] = leaf_make(h->min, h->max, zone->first_hull + i);
            leaf_widen(&leaves[i], g->seams[z].touch);
        }
        g->hulls[z].count = 2 * zone->hull_count - 1;
        tree_build(g->nodes + used, leaves, zone->hull_count);
        used += g->hulls[z].count;
    }
    uint32_t count = 0;
    for (uint32_t z = 0; z < s->zone_count; z++) {
        const node *root = &g->nodes[g->hulls[z].first];
        if (g->hulls[z].count) leaves[count++] = leaf_make(root->min, root->max, z);
    }
    g->zones = (tree){used, count ? 2 * count - 1 : 0};
    if (count) tree_build(g->nodes + used, leaves, count);
}

static int graph_reserve(graph *g)
{
    const scene *s = g->scene;
    const size_t nodes = 2 * ((size_t)s->zone_count + s->hull_count);
    if (nodes > UINT32_MAX) return 0;
    g->nodes = arena_push(&g->memory, nodes, sizeof *g->nodes);
    g->hulls = arena_push(&g->memory, s->zone_count, sizeof *g->hulls);
    g->everywhere = arena_push(&g->memory, s->zone_count, sizeof *g->everywhere);
    g->is_parent = arena_push(&g->memory, s->zone_count, sizeof *g->is_parent);
    g->seams = arena_push(&g->memory, s->zone_count, sizeof *g->seams);
    return g->nodes && g->hulls && g->everywhere && g->is_parent && g->seams;
}

static void seams_note(graph *g)
{
    zone_seams_find(g->scene, g->seams);
    for (uint32_t z = 0; z < g->scene->zone_count; z++) {
        g->seams[z].touch -= seam_touch_least_m(g->scene);
        g->seams[z].hold -= seam_hold_least_m(g->scene);
    }
}

static void zones_note(graph *g)
{
    const scene *s = g->scene;
    memset(g->is_parent, 0, s->zone_count);
    for (uint32_t z = 0; z < s->zone_count; z++) {
        const scene_zone *zone = &s->zones[z];
        if ((zone->flags & ZONE_EVERYWHERE) && !(zone->flags & ZONE_STRAY)) g->everywhere[g->everywhere_count++] = z;
        if (zone->parent != SCENE_NONE) g->is_parent[zone->parent] = 1;
    }
}

result graph_open(const scene *s, const allocator *memory, graph **out)
{
    *out = NULL;
    const uint32_t leaf_count = s->hull_count > s->zone_count ? s->hull_count : s->zone_count;
    graph *g = memory_alloc_zeroed(memory, 1, sizeof *g);
    leaf *leaves = memory_alloc(memory, leaf_count, sizeof *leaves);
    if (g) *g = (graph){.scene = s, .memory = arena_make(memory)};
    if (!g || !leaves || !graph_reserve(g)) {
        memory_free(memory, leaves, leaf_count, sizeof *leaves);
        graph_close(g);
        return RESULT_NO_MEMORY;
    }
    zones_note(g);
    seams_note(g);
    trees_build(g, leaves);
    memory_free(memory, leaves, leaf_count, sizeof *leaves);
    *out = g;
    return RESULT_OK;
}

void graph_close(graph *g)
{
    if (!g) return;
    const allocator *memory = g->memory.memory;
    arena_free(&g->memory);
    memory_free(memory, g, 1, sizeof *g);
}

static uint32_t tree_depth(const node *nodes, uint32_t count)
{
    uint32_t ends[TREE_STACK], depth = 0, most = 0; // ends: of the inner nodes above
    for (uint32_t i = 0; i < count; i++) {
        while (depth > 0 && ends[depth - 1] == i) depth--;
        assert(depth < TREE_STACK);
        ends[depth++] = nodes[i].after;
        if (depth > most) most = depth;
    }
    return most;
}

uint32_t graph_depth(const graph *g)
{
    uint32_t most = tree_depth(g->nodes + g->zones.first, g->zones.count);
    for (uint32_t z = 0; z < g->scene->zone_count; z++) {
        const uint32_t depth = tree_depth(g->nodes + g->hulls[z].first, g->hulls[z].count);
        if (depth > most) most = depth;
    }
    return most;
}

// ---- Looking up ----

// Written so that a NaN touches everything and is held by nothing.
static int bounds_miss(const double min[3], const double max[3], const probe *q)
{
    return min[0] > q->max[0] + q->touch || max[0] < q->min[0] - q->touch || min[1] > q->max[1] + q->touch ||
           max[1] < q->min[1] - q->touch || min[2] > q->max[2] + q->touch || max[2] < q->min[2] - q->touch;
}

static int bounds_hold(const double min[3], const double max[3], const probe *q)
{
    return min[0] < q->min[0] - q->hold && max[0] > q->max[0] + q->hold && min[1] < q->min[1] - q->hold &&
           max[1] > q->max[1] + q->hold && min[2] < q->min[2] - q->hold && max[2] > q->max[2] + q->hold;
}

// Of the box's corner that is farthest against the normal (low) or along it (high).
static double height_low(const scene_solid_plane *plane, const probe *q)
{
    const double *n = plane->normal;
    return n[0] * (n[0] > 0 ? q->min[0] : q->max[0]) + n[1] * (n[1] > 0 ? q->min[1] : q->max[1]) +
           n[2] * (n[2] > 0 ? q->min[2] : q->max[2]) - plane->distance;
}

static double height_high(const scene_solid_plane *plane, const probe *q)
{
    const double *n = plane->normal;
    return n[0] * (n[0] > 0 ? q->max[0] : q->min[0]) + n[1] * (n[1] > 0 ? q->max[1] : q->min[1]) +
           n[2] * (n[2] > 0 ? q->max[2] : q->min[2]) - plane->distance;
}

static int hull_touches(const graph *g, uint32_t hull, const probe *q)
{
    const scene *s = g->scene;
    const scene_hull *h = &s->hulls[hull];
    const double touch = q->touch + g->seams[h->zone].touch;
    for (uint32_t i = 0; i < h->plane_count; i++) {
        if (height_low(&s->hull_planes[h->first_plane + i], q) > touch) return 0;
    }
    return 1;
}

static int hull_holds(const graph *g, uint32_t hull, const probe *q)
{
    const scene *s = g->scene;
    const scene_hull *h = &s->hulls[hull];
    const double hold = q->hold + g->seams[h->zone].hold;
    for (uint32_t i = 0; i < h->plane_count; i++) {
        if (!(height_high(&s->hull_planes[h->first_plane + i], q) < -hold)) return 0;
    }
    return 1;
}

static int zone_touches(const graph *g, uint32_t zone, const probe *q)
{
    const node *nodes = g->nodes + g->hulls[zone].first;
    for (uint32_t i = 0; i < g->hulls[zone].count;) {
        const node *n = &nodes[i];
        if (bounds_miss(n->min, n->max, q)) {
            i = n->after;
            continue;
        }
        if (n->item != SCENE_NONE && hull_touches(g, n->item, q)) return 1;
        i++;
    }
    return 0;
}

static int zone_holds(const graph *g, uint32_t zone, const probe *q)
{
    const node *nodes = g->nodes + g->hulls[zone].first;
    for (uint32_t i = 0; i < g->hulls[zone].count;) {
        const node *n = &nodes[i];
        if (!bounds_hold(n->min, n->max, q)) {
            i = n->after;
            continue;
        }
        if (n->item != SCENE_NONE && hull_holds(g, n->item, q)) return 1;
        i++;
    }
    return 0;
}

// By a zone that lies in it.
static int is_taken(const graph *g, uint32_t zone, const probe *q)
{
    if (!g->is_parent[zone]) return 0;
    const node *nodes = g->nodes + g->zones.first;
    for (uint32_t i = 0; i < g->zones.count;) {
        const node *n = &nodes[i];
        if (!bounds_hold(n->min, n->max, q)) {
            i = n->after;
            continue;
        }
        if (n->item != SCENE_NONE && g->scene->zones[n->item].parent == zone && zone_holds(g, n->item, q)) return 1;
        i++;
    }
    return 0;
}

// The greatest to the top of a heap.
static void heap_sift(uint32_t *zones, uint32_t at, uint32_t count)
{
    for (uint32_t child = 2 * at + 1; child < count; at = child, child = 2 * at + 1) {
        if (child + 1 < count && zones[child + 1] > zones[child]) child++;
        if (zones[at] >= zones[child]) return;
        const uint32_t swapped = zones[at];
        zones[at] = zones[child];
        zones[child] = swapped;
    }
}

static void heap_make(uint32_t *zones, uint32_t count)
{
    for (uint32_t i = count / 2; i-- > 0;) heap_sift(zones, i, count);
}

static void zone_list_add(zone_list *l, uint32_t zone)
{
    if (l->count < l->capacity) l->zones[l->count] = zone;
    else if (l->count == l->capacity) heap_make(l->zones, l->capacity);
    if (l->count >= l->capacity && l->capacity > 0 && zone < l->zones[0]) {
        l->zones[0] = zone;
        heap_sift(l->zones, 0, l->capacity);
    }
    l->count++;
}

static void zone_list_sort(zone_list *l)
{
    const uint32_t count = l->count < l->capacity ? l->count : l->capacity;
    uint32_t i = 1;
    while (i < count && l->zones[i - 1] < l->zones[i]) i++;
    if (i >= count) return;
    heap_make(l->zones, count);
    for (uint32_t end = count; end-- > 1;) {
        const uint32_t greatest = l->zones[0];
        l->zones[0] = l->zones[end];
        l->zones[end] = greatest;
        heap_sift(l->zones, 0, end);
    }
}

static void zones_find(const graph *g, const probe *q, zone_list *l)
{
    for (uint32_t i = 0; i < g->everywhere_count; i++) {
        if (!is_taken(g, g->everywhere[i], q)) zone_list_add(l, g->everywhere[i]);
    }
    const node *nodes = g->nodes + g->zones.first;
    for (uint32_t i = 0; i < g->zones.count && l->count < l->enough;) {
        const node *n = &nodes[i];
        if (bounds_miss(n->min, n->max, q)) {
            i = n->after;
            continue;
        }
        if (n->item != SCENE_NONE && zone_touches(g, n->item, q) && !is_taken(g, n->item, q)) zone_list_add(l, n->item);
        i++;
    }
    zone_list_sort(l);
}

static int hull_reaches(const scene *s, uint32_t hull, const double p[3], double distance)
{
    const scene_hull *h = &s->hulls[hull];
    const scene_solid_plane *planes = &s->hull_planes[h->first_plane];
    for (uint32_t i = 0; i < h->plane_count; i++) { // as hull_height sums, so that both agree to the last bit
        const double *n = planes[i].normal;
        if (((n[0] * p[0] + n[1] * p[1]) + n[2] * p[2]) - planes[i].distance > distance) return 0;
    }
    return 1;
}

// The tree finds a hull that holds the point. That none is near it does not say: a hull's planes may stand that near though
// its bounds are farther, beyond a sharp edge of it.
int graph_zone_reaches(const graph *g, uint32_t zone, const double p[3], double distance)
{
    const scene_zone *z = &g->scene->zones[zone];
    const probe q = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}, distance, distance};
    const node *nodes = g->nodes + g->hulls[zone].first;
    for (uint32_t i = 0; i < g->hulls[zone].count;) {
        const node *n = &nodes[i];
        if (bounds_miss(n->min, n->max, &q)) {
            i = n->after;
            continue;
        }
        if (n->item != SCENE_NONE && hull_reaches(g->scene, n->item, p, distance)) return 1;
        i++;
    }
    for (uint32_t h = z->first_hull; h < z->first_hull + z->hull_count; h++)
        if (hull_reaches(g->scene, h, p, distance)) return 1;
    return z->hull_count == 0;
}

static int is_box(const double min[3], const double max[3]) // not of NaN, not turned inside out
{
    return min[0] <= max[0] && min[1] <= max[1] && min[2] <= max[2];
}

static probe probe_of_box(const graph *g, const double min[3], const double max[3])
{
    return (probe){{min[0], min[1], min[2]}, {max[0], max[1], max[2]}, seam_touch_least_m(g->scene), seam_hold_least_m(g->scene)};
}

uint32_t graph_zones_at(const graph *g, const double p[3], double distance, uint32_t *zones, uint32_t capacity)
{
    const probe q = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}, distance, distance};
    if (!is_box(p, p)) return 0;
    zone_list l = {zones, capacity, UINT32_MAX, 0};
    zones_find(g, &q, &l);
    return l.count;
}

uint32_t graph_zones_of_box(const graph *g, const double min[3], const double max[3], uint32_t *zones, uint32_t capacity)
{
    const probe q = probe_of_box(g, min, max);
    if (!is_box(min, max)) return 0;
    zone_list l = {zones, capacity, UINT32_MAX, 0};
    zones_find(g, &q, &l);
    return l.count;
}

uint32_t graph_few_zones_of_box(const graph *g, const double min[3], const double max[3], uint32_t *zones, uint32_t capacity)
{
    const probe q = probe_of_box(g, min, max);
    zone_list l = {zones, capacity, capacity + 1, 0};
    zones_find(g, &q, &l);
    return l.count;
}
