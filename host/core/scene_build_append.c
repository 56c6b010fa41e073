// Scene builder, copies: what one builder collected goes into another, so that a file is parsed once however often it stands.
// SPDX-License-Identifier: MIT
// Invariant: a copy has the bits that the reader itself would have given, but for normals that are turned by no quarter.
#include "hull.h"
#include "scene_builder.h"

#include <math.h>
#include <string.h>

typedef struct copy_job {
    const scene_builder *from;
    scene_builder *to;
    uint32_t *materials, *objects;  // of `to`, by number in `from`
    uint32_t *indices, *loops;      // of `to`: the static stream's, then the movers'; of all walls
    size_t index_count;
    uint32_t first_vertex;
} copy_job;

uint64_t scene_builder_size(const scene_builder *b)
{
    const uint64_t counts[] = {(b->statics.indices.count + b->movers.indices.count) / 3, b->positions.count, b->objects.count,
                               b->solid_planes.count, b->solids.count, b->places.count, b->wall_vertices.count};
    uint64_t most = 0;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; ++i) most = counts[i] > most ? counts[i] : most;
    return most;
}

uint32_t scene_builder_item_count(const scene_builder *b)
{
    return (uint32_t)(b->statics.items.count + b->movers.items.count);
}

// ---- Bounds ----

builder_bounds builder_bounds_none(void)
{
    return (builder_bounds){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0, 0};
}

static void bounds_take(builder_bounds *bounds, const buffer *points, size_t first)
{
    const double(*p)[3] = points->items;
    for (size_t i = first; i < points->count; ++i)
        for (int k = 0; k < 3; ++k) {
            bounds->low[k] = fmin(bounds->low[k], p[i][k]);
            bounds->high[k] = fmax(bounds->high[k], p[i][k]);
        }
}

void builder_bounds_more(const scene_builder *b, builder_bounds *bounds)
{
    bounds_take(bounds, &b->positions, bounds->vertices_seen);
    bounds_take(bounds, &b->gate_points, bounds->portal_points_seen);
    bounds->vertices_seen = b->positions.count;
    bounds->portal_points_seen = b->gate_points.count;
}

double scene_builder_outside(const scene_builder *b, uint32_t zone, const double p[3])
{
    const scene_zone *z = (const scene_zone *)b->zones.items + zone;
    const scene_hull *hulls = b->hulls.items;
    const scene_solid_plane *planes = b->hull_planes.items;
    double world[3], least = z->hull_count ? INFINITY : 0;
    builder_point(b, p, world);
    for (uint32_t h = z->first_hull; h < z->first_hull + z->hull_count; ++h)
        least = fmin(least, hull_height(planes + hulls[h].first_plane, hulls[h].plane_count, world));
    return fmax(least, 0);
}

// ---- Copies ----

static result copy_names(const copy_job *j)
{
    const scene_material *materials = j->from->materials.items;
    const scene_object *objects = j->from->objects.items;
    result done = RESULT_OK;
    for (size_t m = 0; m < j->from->materials.count && done == RESULT_OK; ++m) {
        done = scene_builder_material(j->to, materials[m].name, strlen(materials[m].name), materials[m].flags, &j->materials[m]);
        if (done == RESULT_OK) done = scene_builder_material_colour(j->to, j->materials[m], materials[m].colour);
    }
    for (size_t o = 0; o < j->from->objects.count && done == RESULT_OK; ++o)
        done = scene_builder_object(j->to, objects[o].name, strlen(objects[o].name), &j->objects[o]);
    return done;
}

// Not made of unit length anew: by quarters it keeps its bits so.
static uint32_t normal_turned(const scene_builder *to, uint32_t packed)
{
    double v[3];
    uint32_t turned = 0;
    if (!to->map.is_on) return packed;
    for (int k = 0; k < 3; ++k) v[k] = (double)(int8_t)(packed >> (8 * k) & 0xff);
    builder_direction(to, v, v);
    for (int k = 0; k < 3; ++k) turned |= ((uint32_t)(int32_t)lrint(fmin(fmax(v[k], -127), 127)) & 0xff) << (8 * k);
    return turned;
}

static result copy_vertices(copy_job *j)
{
    const scene_builder *from = j->from;
    scene_builder *to = j->to;
    const size_t count = from->positions.count;
    if (to->positions.count > UINT32_MAX - count) return RESULT_BAD_INPUT;
    j->first_vertex = (uint32_t)to->positions.count;
    double(*position)[3] = buffer_push(&to->positions, count);
    uint32_t *normal = position ? buffer_push(&to->normals, count) : NULL;
    float(*texcoord)[2] = normal ? buffer_push(&to->texcoords, count) : NULL;
    uint16_t *owner = texcoord ? buffer_push(&to->vertex_materials, count) : NULL;
    if (!owner) return RESULT_NO_MEMORY;
    const double(*positions)[3] = from->positions.items;
    const uint32_t *normals = from->normals.items;
    const uint16_t *owners = from->vertex_materials.items;
    int finite = 1;
    if (count) memcpy(texcoord, from->texcoords.items, count * sizeof *texcoord);
    for (size_t i = 0; i < count; ++i) {
        builder_point(to, positions[i], position[i]);
        for (int k = 0; k < 3; ++k) finite &= isfinite(position[i][k]) != 0;
        normal[i] = normal_turned(to, normals[i]);
        owner[i] = (uint16_t)j->materials[owners[i]];
    }
    return finite ? RESULT_OK : RESULT_BAD_INPUT;
}

static builder_item item_of(const copy_job *j, const builder_stream *stream, const scene_item *item, const uint32_t *indices)
{
    const uint32_t *triangles = stream->polygon_triangles.items;
    return (builder_item){.indices = indices + item->first_index,
                          .polygon_triangles = triangles + item->first_polygon,
                          .index_count = item->index_count,
                          .polygon_count = item->polygon_count,
                          .material = j->materials[item->material],
                          .object = j->objects[item->object],
                          .flags = item->flags};
}

static result copy_statics(const copy_job *j)
{
    const scene_builder *from = j->from;
    const scene_item *items = from->statics.items.items;
    const builder_wall *walls = from->walls.items;
    const cull_exact_plane *exact = from->exact_planes.items;
    result done = RESULT_OK;
    for (size_t i = 0; i < from->statics.items.count && done == RESULT_OK; ++i) {
        builder_item item = item_of(j, &from->statics, &items[i], j->indices);
        item.loop = j->loops + walls[i].first_vertex;
        item.loop_count = walls[i].vertex_count;
        if (item.loop_count && i < from->exact_planes.count) item.exact = &exact[i];
        memcpy(item.plane, walls[i].plane, sizeof item.plane);
        done = scene_builder_item(j->to, &item);
    }
    return done;
}

static result copy_movers(const copy_job *j, uint32_t *out_first)
{
    const scene_builder *from = j->from;
    const scene_item *items = from->movers.items.items;
    const scene_mover *movers = from->mover_list.items;
    result done = RESULT_OK;
    *out_first = scene_builder_mover_count(j->to);
    for (size_t i = 0; i < from->movers.items.count && done == RESULT_OK; ++i) {
        const builder_item item = item_of(j, &from->movers, &items[i], j->indices + from->statics.indices.count);
        done = scene_builder_mover(j->to, movers[i].name, movers[i].open_offset, &item);
    }
    return done;
}

static result copy_rest(const copy_job *j, uint32_t first_mover)
{
    const scene_builder *from = j->from;
    const scene_door *doors = from->doors.items;
    const scene_place *places = from->places.items;
    const scene_solid *solids = from->solids.items;
    const scene_solid_plane *planes = from->solid_planes.items;
    uint32_t door;
    result done = RESULT_OK;
    for (size_t i = 0; i < from->doors.count && done == RESULT_OK; ++i) {
        const uint32_t mover = doors[i].mover == SCENE_NONE ? SCENE_NONE : first_mover + doors[i].mover;
        done = scene_builder_door(j->to, doors[i].name, doors[i].at_rest, mover, &door);
    }
    for (size_t i = 0; i < from->places.count && done == RESULT_OK; ++i) done = scene_builder_place(j->to, &places[i]);
    for (size_t i = 0; i < from->solids.count && done == RESULT_OK; ++i) {
        const scene_solid *s = &solids[i];
        done = scene_builder_solid(j->to, s->kind, planes + s->first_plane, s->plane_count, s->min, s->max);
    }
    if (from->is_map) scene_builder_map(j->to);
    return done;
}

static result copy_all(copy_job *j)
{
    uint32_t first_mover = 0;
    result done = copy_names(j);
    if (done == RESULT_OK) done = copy_vertices(j);
    if (done != RESULT_OK) return done;
    const buffer *const lists[] = {&j->from->statics.indices, &j->from->movers.indices};
    uint32_t *to = j->indices;
    for (int l = 0; l < 2; ++l)
        for (size_t i = 0; i < lists[l]->count; ++i) *to++ = j->first_vertex + ((const uint32_t *)lists[l]->items)[i];
    for (size_t i = 0; i < j->from->wall_vertices.count; ++i) j->loops[i] = j->first_vertex + ((const uint32_t *)j->from->wall_vertices.items)[i];
    if (j->from->grid_steps_per_metre > 0) scene_builder_grid(j->to, j->from->grid_steps_per_metre);
    done = copy_statics(j);
    if (done == RESULT_OK) done = copy_movers(j, &first_mover);
    return done == RESULT_OK ? copy_rest(j, first_mover) : done;
}

result scene_builder_append(scene_builder *b, const scene_builder *from)
{
    const allocator *memory = b->memory;
    copy_job j = {.from = from, .to = b, .index_count = from->statics.indices.count + from->movers.indices.count};
    if (from->zones.count || from->gates.count || from->keys.count || from->lights.count || from->paths.count || from->map.is_on)
        return RESULT_BAD_INPUT;
    j.materials = memory_alloc(memory, from->materials.count, sizeof *j.materials);
    j.objects = memory_alloc(memory, from->objects.count, sizeof *j.objects);
    j.indices = memory_alloc(memory, j.index_count, sizeof *j.indices);
    j.loops = memory_alloc(memory, from->wall_vertices.count, sizeof *j.loops);
    const result done = j.materials && j.objects && j.indices && j.loops ? copy_all(&j) : RESULT_NO_MEMORY;
    memory_free(memory, j.materials, from->materials.count, sizeof *j.materials);
    memory_free(memory, j.objects, from->objects.count, sizeof *j.objects);
    memory_free(memory, j.indices, j.index_count, sizeof *j.indices);
    memory_free(memory, j.loops, from->wall_vertices.count, sizeof *j.loops);
    return done;
}
