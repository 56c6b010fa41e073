// Slabs to polygons: the mid-plane between the sides, clipped by the air, less what an earlier portal of the plane has.
// SPDX-License-Identifier: MIT
#include "input_order.h"
#include "portals.h"

#include "../core/box_tree.h"

#include <stdlib.h>

typedef struct portal_build {
    const compile_input *in;
    portal_set *out;
    buffer near_by, parts, rest; // brushes in the order of `brushes`; polygons
    tree_box *boxes;             // of structure brushes
    uint32_t *brushes, brush_count; // see compare_keys
    box_tree tree;
} portal_build;

// Only a change between adding and subtracting binds brushes to the order of the file; between two of those, place does.
typedef struct brush_key {
    uint32_t brush, phase;
    double at[3], size; // of its box: middle, and the sum of its sides
    const place_order *order;
} brush_key;

static int compare_keys(const void *left, const void *right)
{
    const brush_key *a = left, *b = right;
    if (a->phase != b->phase) return a->phase < b->phase ? -1 : 1;
    if (a->size != b->size) return a->size > b->size ? -1 : 1;
    const int order = compare_places(a->order, a->at, b->at);
    return order ? order : a->brush < b->brush ? -1 : 1;
}

static result order_brushes(portal_build *b, const allocator *memory)
{
    const compile_input *in = b->in;
    const place_order order = place_order_of(in->brushes, in->brush_count);
    brush_key *keys = memory_alloc(memory, in->brush_count, sizeof(*keys));
    if (!keys) return RESULT_NO_MEMORY;
    brush_kind last = BRUSH_ADD;
    uint32_t phase = 0;
    for (uint32_t i = 0; i < in->brush_count; ++i) {
        const compile_brush *brush = &in->brushes[i];
        if (brush->role != BRUSH_STRUCTURE) continue;
        phase += brush->kind != last;
        last = brush->kind;
        brush_key key = {.brush = i, .phase = phase, .order = &order};
        for (int k = 0; k < 3; ++k) {
            key.at[k] = ((double)brush->min[k] + brush->max[k]) / 2;
            key.size += (double)brush->max[k] - brush->min[k];
        }
        keys[b->brush_count++] = key;
    }
    if (b->brush_count > 1) qsort(keys, b->brush_count, sizeof(*keys), compare_keys);
    for (uint32_t i = 0; i < b->brush_count; ++i) b->brushes[i] = keys[i].brush;
    memory_free(memory, keys, in->brush_count, sizeof(*keys));
    return RESULT_OK;
}

static result open_tree(portal_build *b, const allocator *memory)
{
    b->boxes = memory_alloc(memory, b->in->brush_count, sizeof(*b->boxes));
    b->brushes = memory_alloc(memory, b->in->brush_count, sizeof(*b->brushes));
    if (!b->boxes || !b->brushes) return RESULT_NO_MEMORY;
    if (order_brushes(b, memory) != RESULT_OK) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < b->brush_count; ++i) {
        const compile_brush *brush = &b->in->brushes[b->brushes[i]];
        for (int k = 0; k < 3; ++k) {
            b->boxes[i].min[k] = brush->min[k] - 1.0;
            b->boxes[i].max[k] = brush->max[k] + 1.0;
        }
    }
    return b->brush_count ? box_tree_open(b->boxes, b->brush_count, memory, &b->tree) : RESULT_OK;
}

// A parallelogram: the first four sides of the slab on its plane, counterclockwise from the plane's front.
static result add_whole(portal_build *b, const portal_slab *slab, const plane_ref *sides, uint32_t *out)
{
    surface *s = &b->out->s;
    const cull_wide_plane plane = plane_table_get(s->planes, slab->plane);
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (cull_magnitude(plane.normal[k]) > cull_magnitude(plane.normal[axis])) axis = k;
    const plane_ref forward[4] = {sides[3], sides[0], sides[2], sides[1]}, backward[4] = {sides[1], sides[2], sides[0], sides[3]};
    const plane_ref *edges = plane.normal[axis] > 0 ? forward : backward; // low j, high i, high j, low i, or round the other way
    surface_corner corners[4];
    for (int i = 0; i < 4; ++i) {
        const plane_ref meet[3] = {slab->plane, edges[(i + 3) % 4], edges[i]};
        const result r = surface_vertex(s, meet, &corners[i].vertex);
        if (r != RESULT_OK) return r;
        corners[i].edge = edges[i];
    }
    const surface_polygon like = {.kind = SURFACE_PORTAL, .material = COMPILE_NOTHING, .brush = slab->entity};
    return surface_add(s, slab->plane, corners, 4, &like, out);
}

// 0 in `kept`: nothing lies between the sides.
static result cut_to_sides(portal_build *b, const portal_slab *slab, const plane_ref *sides, uint32_t *polygon, int *kept)
{
    surface *s = &b->out->s;
    *kept = 1;
    for (uint32_t i = 4; i < slab->side_count; ++i) {
        const cut_result place = surface_classify(s, *polygon, sides[i]);
        if (place == CUT_FRONT || place == CUT_ON) *kept = 0;
        if (!*kept) break;
        if (place != CUT_BOTH) continue;
        const result r = surface_cut(s, *polygon, sides[i], polygon);
        if (r != RESULT_OK) return r;
    }
    return RESULT_OK;
}

static int ascending(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static result find_brushes(portal_build *b, uint32_t polygon)
{
    b->near_by.count = 0;
    if (!b->brush_count) return RESULT_OK;
    const surface_polygon *p = surface_polygon_at(&b->out->s, polygon);
    tree_box box;
    for (int k = 0; k < 3; ++k) box.min[k] = p->min[k], box.max[k] = p->max[k];
    box_walk walk;
    box_walk_start(&walk, &b->tree, &box);
    for (uint32_t i; box_walk_next(&walk, &i);)
        if (!buffer_append(&b->near_by, &i, 1)) return RESULT_NO_MEMORY;
    if (b->near_by.count) qsort(b->near_by.items, b->near_by.count, sizeof(uint32_t), ascending);
    uint32_t *near_by = b->near_by.items;
    for (size_t i = 0; i < b->near_by.count; ++i) near_by[i] = b->brushes[near_by[i]];
    return RESULT_OK;
}

static int boxes_touch(const surface_polygon *a, const surface_polygon *b)
{
    for (int k = 0; k < 3; ++k)
        if (a->min[k] > b->max[k] || b->min[k] > a->max[k]) return 0;
    return 1;
}

// What earlier pieces in the same plane leave of the parts; parts and rest change places.
static result leave_earlier(portal_build *b, plane_ref plane, size_t earlier)
{
    surface *s = &b->out->s;
    for (size_t i = 0; i < earlier && b->parts.count; ++i) {
        const uint32_t other = ((portal_piece *)b->out->pieces.items)[i].polygon;
        if (surface_polygon_at(s, other)->plane >> 1 != plane >> 1) continue;
        b->rest.count = 0;
        for (size_t k = 0; k < b->parts.count; ++k) {
            const uint32_t part = ((uint32_t *)b->parts.items)[k];
            const surface_polygon *p = surface_polygon_at(s, part), *o = surface_polygon_at(s, other);
            result r = RESULT_OK;
            if (boxes_touch(p, o)) r = portal_without(s, part, other, &b->rest);
            else if (!buffer_append(&b->rest, &part, 1)) r = RESULT_NO_MEMORY;
            if (r != RESULT_OK) return r;
        }
        const buffer swap = b->parts;
        b->parts = b->rest;
        b->rest = swap;
    }
    return RESULT_OK;
}

static result add_slab(portal_build *b, const portal_slab *slab, const plane_ref *sides)
{
    uint32_t whole;
    int kept;
    result r = add_whole(b, slab, sides, &whole);
    if (r == RESULT_OK) r = cut_to_sides(b, slab, sides, &whole, &kept);
    if (r != RESULT_OK || !kept) return r;
    r = find_brushes(b, whole);
    b->parts.count = 0;
    if (r == RESULT_OK) r = portal_air(&b->out->s, b->in, whole, b->near_by.items, (uint32_t)b->near_by.count, &b->parts);
    if (r == RESULT_OK) r = leave_earlier(b, slab->plane, b->out->pieces.count);
    for (size_t i = 0; i < b->parts.count && r == RESULT_OK; ++i) {
        const portal_piece piece = {.polygon = ((uint32_t *)b->parts.items)[i], .entity = slab->entity, .is_door = slab->is_door};
        if (!buffer_append(&b->out->pieces, &piece, 1)) r = RESULT_NO_MEMORY;
    }
    return r;
}

result portal_set_make(const compile_input *in, portal_choice choice, report *r, const allocator *memory, portal_set *out)
{
    portal_set set = {surface_make(in->planes, memory), buffer_make(memory, sizeof(portal_piece))};
    *out = set;
    slab_set slabs;
    result made = slab_set_make(in, choice, r, memory, &slabs);
    if (made != RESULT_OK) return made;
    portal_build b = {.in = in,
                      .out = out,
                      .near_by = buffer_make(memory, sizeof(uint32_t)),
                      .parts = buffer_make(memory, sizeof(uint32_t)),
                      .rest = buffer_make(memory, sizeof(uint32_t))};
    if (slabs.slabs.count) made = open_tree(&b, memory);
    const int has_tree = slabs.slabs.count && made == RESULT_OK && b.brush_count;
    for (size_t i = 0; i < slabs.slabs.count && made == RESULT_OK; ++i) {
        const portal_slab *slab = (portal_slab *)slabs.slabs.items + i;
        made = add_slab(&b, slab, (plane_ref *)slabs.sides.items + slab->first_side);
    }
    if (has_tree) box_tree_close(&b.tree, memory);
    memory_free(memory, b.boxes, in->brush_count, sizeof(*b.boxes));
    memory_free(memory, b.brushes, in->brush_count, sizeof(*b.brushes));
    buffer_free(&b.near_by);
    buffer_free(&b.parts);
    buffer_free(&b.rest);
    slab_set_free(&slabs);
    if (made != RESULT_OK) portal_set_free(out);
    return made;
}

void portal_set_free(portal_set *p)
{
    surface_free(&p->s);
    buffer_free(&p->pieces);
}
