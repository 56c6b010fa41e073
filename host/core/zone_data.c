// Zone data: a zone's items, vertices, walls and portals, numbered and placed as its own.
// SPDX-License-Identifier: MIT
// Invariant: one block as large as the zone, in work that the zone's own size bounds: 10,000 zones cost what they hold.
#include "exact_plane.h"
#include "zone_data.h"

#include <portcullis/box.h>

#include <assert.h>
#include <math.h>
#include <string.h>

// ---- Numbers of the scene to numbers of the zone, in the order of first use ----

typedef struct renumber {
    uint32_t *slots; // 2 a slot: 1 + the scene's number, the zone's; slot_count is a power of two
    size_t slot_count;
    uint32_t count;
} renumber;

static result renumber_open(renumber *n, size_t uses, const allocator *memory)
{
    n->slot_count = 16;
    while (n->slot_count < uses * 2) n->slot_count *= 2;
    n->slots = memory_alloc_zeroed(memory, n->slot_count, 2 * sizeof *n->slots);
    return n->slots ? RESULT_OK : RESULT_NO_MEMORY;
}

static void renumber_close(renumber *n, const allocator *memory)
{
    memory_free(memory, n->slots, n->slot_count, 2 * sizeof *n->slots);
}

static uint32_t renumbered(renumber *n, uint32_t number)
{
    // Neighbours stay neighbours, 16 together: items use vertices in rows.
    size_t at = ((size_t)(((number >> 4) * UINT64_C(0x9e3779b97f4a7c15)) >> 32) * 16 + (number & 15)) & (n->slot_count - 1);
    while (n->slots[2 * at] && n->slots[2 * at] != number + 1) at = (at + 1) & (n->slot_count - 1);
    if (!n->slots[2 * at]) {
        n->slots[2 * at] = number + 1;
        n->slots[2 * at + 1] = n->count++;
    }
    return n->slots[2 * at + 1];
}

// ---- One zone on its way ----

typedef struct zone_arrays { // parts of the block; shared with the scene where the zone is the whole scene
    cull_item *items;
    float *box_axes[6];
    cull_vec3 *positions;
    uint32_t *indices, *wall_vertices, *shared;
    cull_wall *walls;
    cull_plane *planes;
    cull_exact_plane *exact_planes;
    cull_portal *portals;
    cull_vec3 *portal_points;
} zone_arrays;

typedef struct zone_fill {
    const scene *s;
    const scene_zone *zone;
    const uint32_t *items; // global ids
    double shift[3];       // from the scene's origin to the zone's, whole metres
    renumber vertices, planes;
    size_t index_count, wall_vertex_count, point_count;
    uint32_t shared_count, wall_count;
    int is_exact; // all exact planes are there, about the zone's origin too
    int is_whole; // it lists all items, about the scene's origin: arrays are the scene's
    zone_arrays to;
} zone_fill;

static void count_zone(zone_fill *f)
{
    const scene *s = f->s;
    f->is_whole = s->zone_count == 1 && f->zone->item_count == s->item_count;
    for (uint32_t i = 0; i < f->zone->item_count; ++i) {
        const uint32_t item = f->items[i];
        f->index_count += s->items[item].index_count;
        f->shared_count += s->listings[item] > 1;
        if (s->walls) f->wall_vertex_count += s->walls[item].vertex_count;
        if (s->walls) f->wall_count += s->walls[item].vertex_count != 0;
    }
    for (uint32_t p = 0; p < f->zone->portal_count; ++p)
        f->point_count += s->portals[s->zone_portals[f->zone->first_portal + p] / 2].point_count;
}

static void number_vertices(zone_fill *f)
{
    const scene *s = f->s;
    for (uint32_t i = 0; i < f->zone->item_count; ++i) {
        const scene_item *item = &s->items[f->items[i]];
        for (uint32_t k = item->first_index; k < item->first_index + item->index_count; ++k) renumbered(&f->vertices, s->indices[k]);
        if (!f->wall_count) continue;
        const cull_wall *wall = &s->walls[f->items[i]];
        for (uint32_t k = wall->first_vertex; k < wall->first_vertex + wall->vertex_count; ++k) renumbered(&f->vertices, s->wall_vertices[k]);
        if (wall->vertex_count) renumbered(&f->planes, wall->plane);
    }
}

// Places in the block, 64 bytes apart at least; base NULL: only adds up.
typedef struct layout { char *base; size_t used; } layout;

static void *part(layout *l, size_t count, size_t item_size)
{
    void *at = l->base ? l->base + l->used : NULL;
    l->used += (count * item_size + 63) / 64 * 64;
    return at;
}

static size_t lay_out(zone_fill *f, void *block)
{
    layout l = {.base = block};
    zone_arrays *to = &f->to;
    const uint32_t count = f->zone->item_count;
    to->items = part(&l, count, sizeof *to->items);
    to->portals = part(&l, f->zone->portal_count, sizeof *to->portals);
    to->portal_points = part(&l, f->point_count, sizeof *to->portal_points);
    to->shared = part(&l, f->shared_count, sizeof *to->shared);
    if (f->is_whole) return l.used;
    for (int k = 0; k < 6; ++k) to->box_axes[k] = part(&l, (size_t)count + CULL_PADDING, sizeof(float));
    to->positions = part(&l, f->vertices.count, sizeof *to->positions);
    to->indices = part(&l, f->index_count, sizeof *to->indices);
    if (!f->wall_count) return l.used;
    to->walls = part(&l, count, sizeof *to->walls);
    to->wall_vertices = part(&l, f->wall_vertex_count, sizeof *to->wall_vertices);
    to->planes = part(&l, f->planes.count, sizeof *to->planes);
    if (f->s->exact_planes) to->exact_planes = part(&l, f->planes.count, sizeof *to->exact_planes);
    return l.used;
}

static float shifted(float at, double shift)
{
    const double moved = (double)at - shift;
    assert((double)(float)moved == moved);
    return (float)moved + 0.0f; // no -0: a vertex on the origin has one sign
}

static cull_vec3 shifted_point(const zone_fill *f, cull_vec3 p)
{
    return (cull_vec3){shifted(p.x, f->shift[0]), shifted(p.y, f->shift[1]), shifted(p.z, f->shift[2])};
}

static void fill_boxes(zone_fill *f, cull_box *all)
{
    const uint32_t count = f->zone->item_count;
    for (uint32_t i = 0; i < count; ++i) {
        const cull_box box = cull_box_at(&f->s->boxes, f->items[i]);
        const cull_vec3 low = shifted_point(f, box.min), high = shifted_point(f, box.max);
        const float values[6] = {low.x, low.y, low.z, high.x, high.y, high.z};
        for (int k = 0; k < 6; ++k) f->to.box_axes[k][i] = values[k];
        *all = cull_box_union(*all, (cull_box){low, high});
    }
    for (int k = 0; k < 6; ++k) memset(f->to.box_axes[k] + count, 0, CULL_PADDING * sizeof(float));
}

static void fill_item(zone_fill *f, uint32_t place, uint32_t *used)
{
    const scene *s = f->s;
    const scene_item *from = &s->items[f->items[place]];
    cull_item *to = &f->to.items[place];
    *to = (cull_item){from->first_index, from->index_count, from->polygon_count, from->material, from->flags, 0};
    if (f->is_whole) return;
    to->first_index = *used;
    for (uint32_t k = 0; k < from->index_count; ++k) {
        const uint32_t vertex = s->indices[from->first_index + k], mine = renumbered(&f->vertices, vertex);
        f->to.indices[(*used)++] = mine;
        f->to.positions[mine] = shifted_point(f, s->positions[vertex]);
    }
}

// Through the middle of the first polygon that has it: there the float normal costs least.
static cull_plane plane_here(const zone_fill *f, cull_vec3 normal, const cull_wall *wall)
{
    double sum = 0;
    for (uint32_t k = 0; k < wall->vertex_count; ++k) {
        const cull_vec3 p = f->to.positions[f->to.wall_vertices[wall->first_vertex + k]];
        sum += ((double)normal.x * (double)p.x + (double)normal.y * (double)p.y) + (double)normal.z * (double)p.z;
    }
    return (cull_plane){normal, (float)(-sum / wall->vertex_count) + 0.0f};
}

static void fill_walls(zone_fill *f)
{
    const scene *s = f->s;
    uint32_t used = 0, planes = 0;
    for (uint32_t i = 0; i < f->zone->item_count; ++i) {
        const cull_wall *from = &s->walls[f->items[i]];
        cull_wall *to = &f->to.walls[i];
        *to = (cull_wall){.first_vertex = used, .vertex_count = from->vertex_count};
        for (uint32_t k = 0; k < from->vertex_count; ++k) {
            const uint32_t vertex = s->wall_vertices[from->first_vertex + k], mine = renumbered(&f->vertices, vertex);
            f->to.wall_vertices[used++] = mine;
            f->to.positions[mine] = shifted_point(f, s->positions[vertex]);
        }
        if (!from->vertex_count) continue;
        to->plane = renumbered(&f->planes, from->plane);
        if (to->plane < planes) continue;
        f->to.planes[to->plane] = plane_here(f, s->planes[from->plane].normal, to);
        if (f->to.exact_planes) f->is_exact &= exact_plane_move(&s->exact_planes[from->plane], f->shift, s->grid_steps_per_metre, &f->to.exact_planes[to->plane]);
        ++planes; // numbered by first use, so they come in order
    }
}

// ---- Portals ----

static void fill_portal(zone_fill *f, uint32_t place, cull_vec3 *points)
{
    const scene *s = f->s;
    const uint32_t way = s->zone_portals[f->zone->first_portal + place], side = way % 2;
    const scene_portal *from = &s->portals[way / 2];
    double sum = 0;
    for (uint32_t i = 0; i < from->point_count; ++i) {
        const double *p = s->portal_points[from->first_point + (side ? from->point_count - 1 - i : i)];
        double here[3];
        for (int k = 0; k < 3; ++k) { // from the scene's origin first: both differences are exact
            here[k] = (p[k] - s->whole.origin[k]) - f->shift[k] + 0.0;
            sum += from->plane[k] * here[k];
        }
        points[i] = (cull_vec3){(float)here[0], (float)here[1], (float)here[2]};
    }
    const double sign = side ? -1 : 1;
    cull_portal *to = &f->to.portals[place];
    *to = (cull_portal){.points = points, .point_count = from->point_count};
    const double n[3] = {sign * from->plane[0] + 0.0, sign * from->plane[1] + 0.0, sign * from->plane[2] + 0.0};
    to->plane.normal = (cull_vec3){(float)n[0], (float)n[1], (float)n[2]};
    to->plane.offset = (float)(-sign * sum / from->point_count) + 0.0f;
}

static void fill_portals(zone_fill *f, cull_box *all)
{
    cull_vec3 *points = f->to.portal_points;
    for (uint32_t p = 0; p < f->zone->portal_count; ++p) {
        fill_portal(f, p, points);
        for (uint32_t i = 0; i < f->to.portals[p].point_count; ++i) *all = cull_box_with_point(*all, points[i]);
        points += f->to.portals[p].point_count;
    }
}

// ---- Open ----

static void fill_shared(zone_fill *f)
{
    uint32_t used = 0;
    for (uint32_t i = 0; i < f->zone->item_count; ++i)
        if (f->s->listings[f->items[i]] > 1) f->to.shared[used++] = i;
}

static void fill_zone(zone_fill *f, uint32_t mover_capacity, cull_zone *out)
{
    const scene *s = f->s;
    const zone_arrays *to = &f->to;
    const uint32_t count = f->zone->item_count;
    cull_box all = cull_box_none();
    uint32_t used = 0;
    for (uint32_t i = 0; i < count; ++i) fill_item(f, i, &used);
    fill_portals(f, &all);
    fill_shared(f);
    if (!f->is_whole) fill_boxes(f, &all);
    if (!f->is_whole && f->wall_count) fill_walls(f);
    if (all.min.x > all.max.x) all = (cull_box){{0, 0, 0}, {0, 0, 0}};
    *out = (cull_zone){.items = to->items, .portals = to->portals, .item_count = count, .mover_capacity = mover_capacity};
    out->portal_count = f->zone->portal_count;
    if (f->is_whole) {
        out->boxes = s->boxes;
        out->positions = s->positions;
        out->indices = s->indices;
        out->walls = s->walls;
        out->wall_vertices = s->wall_vertices;
        out->planes = s->planes;
        out->exact_planes = s->exact_planes;
        out->grid_steps_per_metre = s->grid_steps_per_metre;
        out->box = s->whole.box;
        out->radius = s->whole.radius;
        out->position_count = s->position_count;
        out->index_count = s->index_count;
        out->wall_vertex_count = s->wall_vertex_count;
        out->plane_count = s->plane_count;
        return;
    }
    out->boxes = (cull_boxes){to->box_axes[0], to->box_axes[1], to->box_axes[2], to->box_axes[3], to->box_axes[4], to->box_axes[5]};
    out->positions = to->positions;
    out->indices = to->indices;
    out->walls = to->walls;
    out->wall_vertices = to->wall_vertices;
    out->planes = to->planes;
    if (to->exact_planes && f->is_exact) {
        out->exact_planes = to->exact_planes;
        out->grid_steps_per_metre = s->grid_steps_per_metre;
    }
    out->box = all;
    out->radius = cull_box_radius(all);
    out->position_count = f->vertices.count;
    out->index_count = (uint32_t)f->index_count;
    out->wall_vertex_count = (uint32_t)f->wall_vertex_count;
    out->plane_count = f->planes.count;
}

static result open_numbers(zone_fill *f, const allocator *memory)
{
    if (f->is_whole) return RESULT_OK;
    if (renumber_open(&f->vertices, f->index_count + f->wall_vertex_count, memory) != RESULT_OK) return RESULT_NO_MEMORY;
    if (renumber_open(&f->planes, f->wall_count, memory) != RESULT_OK) return RESULT_NO_MEMORY;
    number_vertices(f);
    return RESULT_OK;
}

result zone_data_open(const zone_data_request *q, const allocator *memory, zone_data *out)
{
    const scene *s = q->scene;
    const scene_zone *zone = &s->zones[q->zone];
    zone_fill f = {.s = s, .zone = zone, .items = s->zone_items + zone->first_item, .is_exact = 1};
    zone_data made = {.scene = s, .index = q->zone, .memory = memory};
    for (int k = 0; k < 3; ++k) f.shift[k] = zone->origin[k] - s->whole.origin[k];
    count_zone(&f);
    result done = open_numbers(&f, memory);
    if (done == RESULT_OK) {
        made.block_bytes = lay_out(&f, NULL);
        made.block = memory_alloc(memory, made.block_bytes, 1);
        if (!made.block) done = RESULT_NO_MEMORY;
    }
    if (done == RESULT_OK) {
        lay_out(&f, made.block);
        fill_zone(&f, q->mover_capacity, &made.zone);
        made.items = f.is_whole ? NULL : f.items;
        made.shared = f.to.shared;
        made.shared_count = f.shared_count;
        *out = made;
    }
    renumber_close(&f.vertices, memory);
    renumber_close(&f.planes, memory);
    return done;
}

void zone_data_close(zone_data *z)
{
    if (z->block) memory_free(z->memory, z->block, z->block_bytes, 1);
    *z = (zone_data){0};
}
