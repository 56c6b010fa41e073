// Scene builder: collects what an importer finds, in doubles, and checks every index on the way in.
// SPDX-License-Identifier: MIT
#include "material_colour.h"
#include "scene_builder.h"

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

enum { MATERIALS_MOST = 65535, MATERIAL_SLOTS_FIRST = 64 };

static void stream_open(builder_stream *s, const allocator *memory)
{
    s->items = buffer_make(memory, sizeof(scene_item));
    s->indices = buffer_make(memory, sizeof(uint32_t));
    s->polygon_triangles = buffer_make(memory, sizeof(uint32_t));
}

static void stream_close(builder_stream *s)
{
    buffer_free(&s->items);
    buffer_free(&s->indices);
    buffer_free(&s->polygon_triangles);
}

result scene_builder_open(const allocator *memory, scene_builder **out)
{
    scene_builder *b = memory_alloc_zeroed(memory, 1, sizeof *b);
    if (!b) return RESULT_NO_MEMORY;
    b->memory = memory;
    b->names = arena_make(memory);
    b->everywhere = SCENE_NONE;
    b->positions = buffer_make(memory, 3 * sizeof(double));
    b->normals = buffer_make(memory, sizeof(uint32_t));
    b->texcoords = buffer_make(memory, 2 * sizeof(float));
    b->vertex_materials = buffer_make(memory, sizeof(uint16_t));
    stream_open(&b->statics, memory);
    stream_open(&b->movers, memory);
    b->walls = buffer_make(memory, sizeof(builder_wall));
    b->wall_vertices = buffer_make(memory, sizeof(uint32_t));
    b->exact_planes = buffer_make(memory, sizeof(cull_exact_plane));
    b->own_zones = buffer_make(memory, sizeof(builder_own_zone));
    b->materials = buffer_make(memory, sizeof(scene_material));
    b->material_slots = buffer_make(memory, sizeof(uint32_t));
    b->objects = buffer_make(memory, sizeof(scene_object));
    b->mover_list = buffer_make(memory, sizeof(scene_mover));
    b->places = buffer_make(memory, sizeof(scene_place));
    b->solids = buffer_make(memory, sizeof(scene_solid));
    b->solid_planes = buffer_make(memory, sizeof(scene_solid_plane));
    b->zones = buffer_make(memory, sizeof(scene_zone));
    b->zone_slots = buffer_make(memory, sizeof(uint32_t));
    b->hulls = buffer_make(memory, sizeof(scene_hull));
    b->hull_planes = buffer_make(memory, sizeof(scene_solid_plane));
    b->gates = buffer_make(memory, sizeof(builder_gate));
    b->gate_points = buffer_make(memory, 3 * sizeof(double));
    b->doors = buffer_make(memory, sizeof(scene_door));
    b->keys = buffer_make(memory, sizeof(scene_key));
    b->lights = buffer_make(memory, sizeof(scene_light));
    b->paths = buffer_make(memory, sizeof(scene_camera_path));
    b->cameras = buffer_make(memory, sizeof(camera));
    *out = b;
    return RESULT_OK;
}

void scene_builder_close(scene_builder *b)
{
    if (!b) return;
    stream_close(&b->statics);
    stream_close(&b->movers);
    buffer *const all[] = {&b->positions,  &b->normals,        &b->texcoords,  &b->vertex_materials, &b->walls,  &b->wall_vertices, &b->materials,
                           &b->material_slots, &b->objects, &b->mover_list, &b->places, &b->solids, &b->solid_planes, &b->zones,
                           &b->zone_slots, &b->hulls, &b->hull_planes, &b->gates, &b->gate_points, &b->doors, &b->keys, &b->lights,
                           &b->paths, &b->cameras, &b->exact_planes, &b->own_zones};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    arena_free(&b->names);
    memory_free(b->memory, b, 1, sizeof *b);
}

void scene_builder_map(scene_builder *b)
{
    b->is_map = 1;
}

static result material_slots_grow(scene_builder *b)
{
    const size_t size = b->material_slots.count ? b->material_slots.count * 2 : MATERIAL_SLOTS_FIRST;
    buffer slots = buffer_make(b->memory, sizeof(uint32_t));
    uint32_t *slot = buffer_push(&slots, size);
    if (!slot) return RESULT_NO_MEMORY;
    memset(slot, 0, size * sizeof *slot);
    const scene_material *materials = b->materials.items;
    for (uint32_t m = 0; m < b->materials.count; ++m) {
        size_t at = XXH3_64bits(materials[m].name, strlen(materials[m].name)) & (size - 1);
        while (slot[at]) at = (at + 1) & (size - 1);
        slot[at] = m + 1;
    }
    buffer_free(&b->material_slots);
    b->material_slots = slots;
    return RESULT_OK;
}

result scene_builder_material(scene_builder *b, const char *name, size_t length, uint32_t flags, uint32_t *out)
{
    if (b->materials.count * 2 >= b->material_slots.count && material_slots_grow(b) != RESULT_OK) return RESULT_NO_MEMORY;
    const size_t size = b->material_slots.count;
    uint32_t *slots = b->material_slots.items;
    const scene_material *materials = b->materials.items;
    size_t at = XXH3_64bits(name, length) & (size - 1);
    for (; slots[at]; at = (at + 1) & (size - 1)) {
        const char *other = materials[slots[at] - 1].name;
        if (strlen(other) == length && memcmp(other, name, length) == 0) {
            *out = slots[at] - 1;
            return RESULT_OK;
        }
    }
    if (b->materials.count >= MATERIALS_MOST) return RESULT_BAD_INPUT;
    const char *copy = arena_text(&b->names, name, length);
    scene_material *m = copy ? buffer_push(&b->materials, 1) : NULL;
    if (!m) return RESULT_NO_MEMORY;
    *m = (scene_material){copy, flags, material_colour(name, length)};
    *out = slots[at] = (uint32_t)b->materials.count;
    --*out;
    return RESULT_OK;
}

result scene_builder_material_colour(scene_builder *b, uint32_t material, uint32_t colour)
{
    if (material >= b->materials.count) return RESULT_BAD_INPUT;
    ((scene_material *)b->materials.items)[material].colour = colour;
    return RESULT_OK;
}

uint32_t scene_builder_material_count(const scene_builder *b)
{
    return (uint32_t)b->materials.count;
}

const scene_material *scene_builder_material_at(const scene_builder *b, uint32_t material)
{
    return (const scene_material *)b->materials.items + material;
}

void scene_builder_material_mark(scene_builder *b, uint32_t material)
{
    ((scene_material *)b->materials.items)[material].flags |= MATERIAL_NORMAL_MAP;
}

result scene_builder_object(scene_builder *b, const char *name, size_t length, uint32_t *out)
{
    const char *copy = arena_text(&b->names, name, length);
    scene_object *o = copy ? buffer_push(&b->objects, 1) : NULL;
    if (!o) return RESULT_NO_MEMORY;
    *o = (scene_object){.name = copy};
    *out = (uint32_t)b->objects.count - 1;
    return RESULT_OK;
}

static uint32_t snorm8x3(const double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 0) || !isfinite(length)) return 0;
    uint32_t packed = 0;
    for (int i = 0; i < 3; ++i) packed |= ((uint32_t)(int32_t)lrint(v[i] / length * 127) & 0xff) << (8 * i);
    return packed;
}

result scene_builder_vertices(scene_builder *b, const builder_vertex *vertices, size_t count, uint32_t material, uint32_t *out_first)
{
    const size_t first = b->positions.count;
    if (material >= b->materials.count || count > UINT32_MAX || first > UINT32_MAX - count) return RESULT_BAD_INPUT;
    for (size_t i = 0; i < count; ++i) {
        double world[3];
        builder_point(b, vertices[i].position, world);
        if (!isfinite(world[0]) || !isfinite(world[1]) || !isfinite(world[2])) return RESULT_BAD_INPUT;
    }
    double(*position)[3] = buffer_push(&b->positions, count);
    uint32_t *normal = position ? buffer_push(&b->normals, count) : NULL;
    float(*texcoord)[2] = normal ? buffer_push(&b->texcoords, count) : NULL;
    uint16_t *owner = texcoord ? buffer_push(&b->vertex_materials, count) : NULL;
    if (!owner) return RESULT_NO_MEMORY;
    for (size_t i = 0; i < count; ++i) {
        const double n[3] = {(double)vertices[i].normal[0], (double)vertices[i].normal[1], (double)vertices[i].normal[2]};
        double turned[3];
        builder_point(b, vertices[i].position, position[i]);
        builder_direction(b, n, turned);
        normal[i] = snorm8x3(turned);
        texcoord[i][0] = vertices[i].texcoord[0];
        texcoord[i][1] = vertices[i].texcoord[1];
        owner[i] = (uint16_t)material;
    }
    *out_first = (uint32_t)first;
    return RESULT_OK;
}

static result item_is_sound(const scene_builder *b, const builder_item *item)
{
    if (item->index_count == 0 || item->index_count % 3 || item->polygon_count == 0) return RESULT_BAD_INPUT;
    if (item->material >= b->materials.count || item->object >= b->objects.count) return RESULT_BAD_INPUT;
    for (uint32_t i = 0; i < item->index_count; ++i)
        if (item->indices[i] >= b->positions.count) return RESULT_BAD_INPUT;
    for (uint32_t i = 0; i < item->loop_count; ++i)
        if (item->loop[i] >= b->positions.count) return RESULT_BAD_INPUT;
    for (int k = 0; k < 4; ++k)
        if (item->flags & CULL_ITEM_WALL && (item->loop_count < 3 || !isfinite(item->plane[k]))) return RESULT_BAD_INPUT;
    uint64_t triangles = 0;
    for (uint32_t i = 0; i < item->polygon_count; ++i) triangles += item->polygon_triangles ? item->polygon_triangles[i] : 1;
    return triangles == item->index_count / 3 ? RESULT_OK : RESULT_BAD_INPUT;
}

static uint32_t flags_of_material(uint32_t material_flags)
{
    if (material_flags & MATERIAL_TRANSLUCENT) return CULL_ITEM_SEE_THROUGH | CULL_ITEM_TWO_SIDED;
    if (material_flags & MATERIAL_CUT_OUT) return CULL_ITEM_CUT_OUT | CULL_ITEM_TWO_SIDED;
    return 0;
}

// An item whose surface is its box is one no longer when the axes are no axes any more.
static uint32_t flags_turned(const scene_builder *b, uint32_t flags)
{
    uint32_t others = 0;
    for (int i = 0; i < 9 && b->map.is_on; ++i) others += b->map.turn[i] != 0;
    return others > 3 ? flags & ~(uint32_t)CULL_ITEM_BOX : flags;
}

static result stream_item(scene_builder *b, builder_stream *s, const builder_item *item)
{
    if (item_is_sound(b, item) != RESULT_OK) return RESULT_BAD_INPUT;
    if (s->indices.count > UINT32_MAX - item->index_count || s->polygon_triangles.count > UINT32_MAX / 2 - item->polygon_count) return RESULT_BAD_INPUT;
    const uint32_t first_index = (uint32_t)s->indices.count, first_polygon = (uint32_t)s->polygon_triangles.count;
    if (!buffer_append(&s->indices, item->indices, item->index_count)) return RESULT_NO_MEMORY;
    uint32_t *triangles = buffer_push(&s->polygon_triangles, item->polygon_count);
    scene_item *out = triangles ? buffer_push(&s->items, 1) : NULL;
    if (!out) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < item->polygon_count; ++i) triangles[i] = item->polygon_triangles ? item->polygon_triangles[i] : 1;
    const scene_material *materials = b->materials.items;
    *out = (scene_item){first_index, item->index_count, first_polygon, item->polygon_count, item->material, item->object,
                        flags_turned(b, item->flags) | flags_of_material(materials[item->material].flags)};
    return RESULT_OK;
}

void scene_builder_grid(scene_builder *b, double steps_per_metre)
{
    b->grid_steps_per_metre = steps_per_metre;
}

// One plane an item, so items that came before the grid have none.
static result keep_exact(scene_builder *b, const builder_item *item, uint32_t loop_count)
{
    const int is_exact = loop_count && b->grid_steps_per_metre > 0 && item->exact && !b->map.is_on;
    const cull_exact_plane none = {{0, 0, 0}, 0};
    b->inexact_walls += loop_count && !is_exact;
    if (!(b->grid_steps_per_metre > 0) || b->inexact_walls) return RESULT_OK;
    const size_t missing = b->walls.count - b->exact_planes.count; // this one is in `walls` already
    cull_exact_plane *planes = buffer_push(&b->exact_planes, missing);
    if (!planes) return RESULT_NO_MEMORY;
    for (size_t i = 0; i < missing; ++i) planes[i] = none;
    if (is_exact) planes[missing - 1] = *item->exact;
    return RESULT_OK;
}

result scene_builder_item(scene_builder *b, const builder_item *item)
{
    const scene_solid_plane plane = builder_plane(b, &(scene_solid_plane){{item->plane[0], item->plane[1], item->plane[2]}, -item->plane[3]});
    if (item->flags & CULL_ITEM_WALL && !isfinite(plane.distance)) return RESULT_BAD_INPUT;
    const result done = stream_item(b, &b->statics, item);
    if (done != RESULT_OK) return done;
    builder_wall *wall = buffer_push(&b->walls, 1);
    if (!wall) return RESULT_NO_MEMORY;
    const uint32_t loop_count = item->flags & CULL_ITEM_WALL ? item->loop_count : 0;
    *wall = (builder_wall){.first_vertex = (uint32_t)b->wall_vertices.count, .vertex_count = loop_count};
    memcpy(wall->plane, plane.normal, sizeof plane.normal);
    wall->plane[3] = -plane.distance;
    b->wall_count += loop_count != 0;
    if (keep_exact(b, item, loop_count) != RESULT_OK) return RESULT_NO_MEMORY;
    return loop_count && !buffer_append(&b->wall_vertices, item->loop, loop_count) ? RESULT_NO_MEMORY : RESULT_OK;
}

result scene_builder_item_zones(scene_builder *b, const uint32_t *zones, uint32_t count)
{
    const builder_own_zone *known = b->own_zones.items;
    const uint32_t item = (uint32_t)b->statics.items.count - 1;
    if (b->statics.items.count == 0 || count == 0) return RESULT_BAD_INPUT;
    if (b->own_zones.count && known[b->own_zones.count - 1].item == item) return RESULT_BAD_INPUT;
    for (uint32_t i = 0; i < count; ++i) {
        if (zones[i] >= b->zones.count) return RESULT_BAD_INPUT;
        for (uint32_t k = 0; k < i; ++k)
            if (zones[k] == zones[i]) return RESULT_BAD_INPUT;
    }
    builder_own_zone *to = buffer_push(&b->own_zones, count);
    for (uint32_t i = 0; i < count && to; ++i) to[i] = (builder_own_zone){item, zones[i]};
    return to ? RESULT_OK : RESULT_NO_MEMORY;
}

// Middle of the item's vertices' box, world.
static void middle_of(const scene_builder *b, const builder_item *item, double out[3])
{
    const double(*positions)[3] = b->positions.items;
    for (int k = 0; k < 3; ++k) {
        double low = positions[item->indices[0]][k], high = low;
        for (uint32_t i = 1; i < item->index_count; ++i) {
            low = fmin(low, positions[item->indices[i]][k]);
            high = fmax(high, positions[item->indices[i]][k]);
        }
        out[k] = low + (high - low) / 2;
    }
}

result scene_builder_mover(scene_builder *b, const char *name, const double open_offset[3], const builder_item *item)
{
    double offset[3];
    builder_offset(b, open_offset, offset);
    if (!isfinite(offset[0]) || !isfinite(offset[1]) || !isfinite(offset[2])) return RESULT_BAD_INPUT;
    const result done = stream_item(b, &b->movers, item);
    if (done != RESULT_OK) return done;
    const char *copy = arena_text(&b->names, name, strlen(name));
    scene_mover *mover = copy ? buffer_push(&b->mover_list, 1) : NULL;
    if (!mover) return RESULT_NO_MEMORY;
    *mover = (scene_mover){.name = copy, .door = SCENE_NONE, .axes = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    memcpy(mover->open_offset, offset, sizeof offset);
    middle_of(b, item, mover->pivot);
    return RESULT_OK;
}

result scene_builder_place(scene_builder *b, const scene_place *place)
{
    scene_place moved = *place;
    builder_point(b, place->position, moved.position);
    if (!isfinite(moved.position[0]) || !isfinite(moved.position[1]) || !isfinite(moved.position[2])) return RESULT_BAD_INPUT;
    return buffer_append(&b->places, &moved, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

// Box of the turned box: as tight as the body only where the turn is by quarters.
static void turn_box(const scene_builder *b, const double min[3], const double max[3], scene_solid *out)
{
    for (int corner = 0; corner < 8; ++corner) {
        double p[3];
        for (int k = 0; k < 3; ++k) p[k] = corner >> k & 1 ? max[k] : min[k];
        builder_point(b, p, p);
        for (int k = 0; k < 3; ++k) {
            out->min[k] = corner ? fmin(out->min[k], p[k]) : p[k];
            out->max[k] = corner ? fmax(out->max[k], p[k]) : p[k];
        }
    }
}

result scene_builder_solid(scene_builder *b, solid_kind kind, const scene_solid_plane *planes, uint32_t plane_count,
                           const double min[3], const double max[3])
{
    scene_solid solid = {.first_plane = (uint32_t)b->solid_planes.count, .plane_count = plane_count, .kind = kind};
    turn_box(b, min, max, &solid);
    scene_solid_plane *to = buffer_push(&b->solid_planes, plane_count);
    if (!to) return RESULT_NO_MEMORY;
    for (uint32_t p = 0; p < plane_count; ++p) to[p] = builder_plane(b, &planes[p]);
    return buffer_append(&b->solids, &solid, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}
