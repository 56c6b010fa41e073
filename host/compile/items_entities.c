// What is no structure: brush entities as walls or movers with their doors, the bodies of all brushes, places, lights.
// SPDX-License-Identifier: MIT
// Invariant: movers, their doors' ways and the places are those that host/import makes of the same map.
#include "items.h"
#include "brush_polygons.h"

#include "../import/map_entity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_BYTES = 96 };
static const double UNITS_PER_METRE = ITEM_UNITS_PER_METRE, LIGHT_UNITS = 300; // a light that names no strength

static map_word word_of(const char *text)
{
    return (map_word){text, strlen(text)};
}

// ---- Doors ----

static result open_offset(const item_job *j, uint32_t entity, const double min[3], const double max[3], double out[3])
{
    const compile_entity *e = &j->in->entities[entity];
    const map_reader reader = {.path = j->in->path, .report = j->report, .line = e->line};
    map_entity made = map_entity_make(j->memory);
    made.line = e->line;
    made.number = entity;
    map_key *keys = buffer_push(&made.keys, e->key_count);
    result done = keys ? RESULT_OK : report_no_memory(j->report, j->in->path);
    for (uint32_t i = 0; i < e->key_count && keys; ++i) keys[i] = (map_key){word_of(e->keys[2 * i]), word_of(e->keys[2 * i + 1]), e->line};
    double units[3] = {0};
    if (done == RESULT_OK) done = entity_open_offset(&made, min, max, &reader, units);
    map_entity_free(&made);
    out[0] = units[0] / UNITS_PER_METRE;
    out[1] = units[2] / UNITS_PER_METRE;
    out[2] = -units[1] / UNITS_PER_METRE + 0.0;
    return done;
}

// Of the entity's bodies, in the map's units and axes.
static void bounds_of(const item_job *j, const brush_bodies *bodies, const compile_entity *e, double min[3], double max[3])
{
    const double steps_per_unit = j->in->steps_per_metre / UNITS_PER_METRE;
    for (int k = 0; k < 3; ++k) min[k] = INFINITY, max[k] = -INFINITY;
    for (uint32_t b = e->first_brush; b < e->first_brush + e->brush_count; ++b) {
        const brush_body *body = &bodies->of[b];
        const body_corner *corners = (const body_corner *)bodies->corners.items + body->first_corner;
        for (uint32_t c = 0; c < body->corner_count; ++c) {
            const double units[3] = {corners[c].position[0] / steps_per_unit, -corners[c].position[2] / steps_per_unit, corners[c].position[1] / steps_per_unit};
            for (int k = 0; k < 3; ++k) {
                min[k] = fmin(min[k], units[k]);
                max[k] = fmax(max[k], units[k]);
            }
        }
    }
}

// ---- Polygons ----

// Its vertices into the builder, its fan into `triangles`.
static result add_polygon(item_job *j, const brush_bodies *bodies, const body_polygon *p, const double offset[3], builder_item *item)
{
    const compile_face *face = &j->in->faces[p->face];
    const polygon_edge *edges = (const polygon_edge *)bodies->edges.items + p->shape.first;
    j->points.count = 0;
    builder_vertex *points = buffer_push(&j->points, p->shape.count);
    uint32_t *triangles = points ? buffer_push(&j->triangles, 3 * (size_t)(p->shape.count - 2)) : NULL, first;
    if (!triangles) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < p->shape.count; ++i) {
        double metres[3];
        for (int k = 0; k < 3; ++k) metres[k] = edges[i].start[k] / j->in->steps_per_metre;
        points[i] = (builder_vertex){.position = {metres[0] + offset[0], metres[1] + offset[1], metres[2] + offset[2]}};
        item_texcoord(face, metres, points[i].texcoord);
    }
    item->material = j->material_of[face->material];
    const result done = scene_builder_vertices(j->builder, points, p->shape.count, item->material, &first);
    if (done != RESULT_OK) return done;
    for (uint32_t i = 0; i + 2 < p->shape.count; ++i) {
        triangles[3 * i] = first;
        triangles[3 * i + 1] = first + i + 1;
        triangles[3 * i + 2] = first + i + 2;
    }
    return RESULT_OK;
}

static result add_wall(item_job *j, const brush_bodies *bodies, const body_polygon *p, uint32_t object)
{
    static const double nowhere[3] = {0};
    const uint32_t triangle_count = p->shape.count - 2;
    builder_item item = {.polygon_count = 1, .polygon_triangles = &triangle_count, .index_count = 3 * triangle_count, .object = object, .flags = CULL_ITEM_WALL};
    cull_exact_plane exact;
    j->triangles.count = j->loop.count = 0;
    const result done = add_polygon(j, bodies, p, nowhere, &item);
    uint32_t *loop = done == RESULT_OK ? buffer_push(&j->loop, p->shape.count) : NULL;
    if (!loop) return done == RESULT_OK ? RESULT_NO_MEMORY : done;
    item.indices = j->triangles.items;
    for (uint32_t i = 0; i < p->shape.count; ++i) loop[i] = item.indices[0] + i;
    item.loop = loop;
    item.loop_count = p->shape.count;
    item_plane(j, p->shape.plane, item.plane);
    item.exact = item_exact_plane(j, p->shape.plane, &exact) ? &exact : NULL;
    return scene_builder_item(j->builder, &item);
}

typedef struct entity_part { // what is walked of an entity
    const brush_bodies *bodies;
    uint32_t entity, object;
} entity_part;

static result add_walls(item_job *j, const entity_part *e)
{
    const compile_entity *entity = &j->in->entities[e->entity];
    result done = RESULT_OK;
    for (uint32_t b = entity->first_brush; b < entity->first_brush + entity->brush_count && done == RESULT_OK; ++b)
        for (uint32_t i = 0; i < e->bodies->of[b].polygon_count && done == RESULT_OK; ++i) {
            const body_polygon *p = (const body_polygon *)e->bodies->polygons.items + e->bodies->of[b].first_polygon + i;
            if (j->in->faces[p->face].material != COMPILE_NOTHING) done = add_wall(j, e->bodies, p, e->object);
        }
    return done;
}

// One item of one material: an opaque one where it has one, as host/import has it.
static result take_mover(item_job *j, const entity_part *e, const double offset[3], builder_item *item)
{
    const compile_entity *entity = &j->in->entities[e->entity];
    uint32_t material = 0;
    int opaque = 0;
    for (uint32_t b = entity->first_brush; b < entity->first_brush + entity->brush_count; ++b)
        for (uint32_t i = 0; i < e->bodies->of[b].polygon_count; ++i) {
            const body_polygon *p = (const body_polygon *)e->bodies->polygons.items + e->bodies->of[b].first_polygon + i;
            const uint32_t from = j->in->faces[p->face].material, triangles = p->shape.count - 2;
            if (from == COMPILE_NOTHING) continue;
            const result done = add_polygon(j, e->bodies, p, offset, item);
            if (done != RESULT_OK) return done;
            const uint32_t flags = j->in->materials[from].flags;
            if (j->counts.count == 0 || (!opaque && !(flags & MATERIAL_TRANSLUCENT))) material = item->material;
            opaque |= !(flags & MATERIAL_TRANSLUCENT);
            if (flags & MATERIAL_CUT_OUT) item->flags |= CULL_ITEM_CUT_OUT | CULL_ITEM_TWO_SIDED;
            if (!buffer_append(&j->counts, &triangles, 1)) return RESULT_NO_MEMORY;
        }
    item->material = material;
    return RESULT_OK;
}

static result add_mover(item_job *j, const entity_part *e, const char *name)
{
    double min[3], max[3], offset[3];
    bounds_of(j, e->bodies, &j->in->entities[e->entity], min, max);
    result done = open_offset(j, e->entity, min, max, offset);
    if (done != RESULT_OK) return done;
    builder_item item = {.object = e->object};
    j->triangles.count = j->counts.count = 0;
    done = take_mover(j, e, offset, &item);
    if (done != RESULT_OK) return done;
    item.indices = j->triangles.items;
    item.index_count = (uint32_t)j->triangles.count;
    item.polygon_triangles = j->counts.items;
    item.polygon_count = (uint32_t)j->counts.count;
    done = scene_builder_mover(j->builder, name, offset, &item);
    if (done != RESULT_OK) return done;
    j->mover_of[e->entity] = scene_builder_mover_count(j->builder) - 1;
    if (offset[0] == 0 && offset[1] == 0 && offset[2] == 0) return RESULT_OK;
    return scene_builder_door(j->builder, name, DOORS_OPEN, j->mover_of[e->entity], &j->door_of[e->entity]);
}

// ---- Bodies ----

static result add_body(item_job *j, uint32_t brush, const double offset[3], solid_kind kind)
{
    const compile_brush *b = &j->in->brushes[brush];
    scene_solid_plane *planes = memory_alloc(j->memory, b->face_count, sizeof *planes);
    if (!planes) return RESULT_NO_MEMORY;
    double min[3], max[3];
    for (int k = 0; k < 3; ++k) {
        min[k] = b->min[k] / j->in->steps_per_metre + offset[k];
        max[k] = b->max[k] / j->in->steps_per_metre + offset[k];
    }
    for (uint32_t f = 0; f < b->face_count; ++f) {
        double plane[4];
        item_plane(j, j->in->faces[b->first_face + f].plane, plane);
        memcpy(planes[f].normal, plane, sizeof planes[f].normal);
        planes[f].distance = -plane[3] + ((plane[0] * offset[0] + plane[1] * offset[1]) + plane[2] * offset[2]);
    }
    const result done = b->kind == BRUSH_SUBTRACT ? scene_builder_solid_subtract(j->builder, planes, b->face_count)
                                                  : scene_builder_solid(j->builder, kind, planes, b->face_count, min, max);
    memory_free(j->memory, planes, b->face_count, sizeof *planes);
    return done;
}

// Shut, and open where that is elsewhere: what is free space does not depend on doors.
static result add_bodies(item_job *j, const brush_bodies *bodies, uint32_t entity)
{
    static const double nowhere[3] = {0};
    const compile_entity *e = &j->in->entities[entity];
    const map_word class_name = word_of(e->class_name);
    const entity_body body = entity_body_of(class_name);
    double offset[3] = {0}, min[3], max[3];
    result done = RESULT_OK;
    if (body == BODY_NONE) return done;
    if (entity_role_of(class_name) == ENTITY_MOVER) {
        bounds_of(j, bodies, e, min, max);
        done = open_offset(j, entity, min, max, offset);
    }
    for (int place = 0; place < (memcmp(offset, nowhere, sizeof offset) != 0 ? 2 : 1); ++place)
        for (uint32_t b = e->first_brush; b < e->first_brush + e->brush_count && done == RESULT_OK; ++b) {
            const compile_brush *brush = &j->in->brushes[b];
            if (brush->role == BRUSH_PORTAL) continue;
            const solid_kind kind = brush->role == BRUSH_LIQUID ? SOLID_LIQUID : body == BODY_STRUCTURE || brush->role == BRUSH_STRUCTURE ? SOLID_STRUCTURE : SOLID_ENTITY;
            done = add_body(j, b, place ? offset : nowhere, kind);
        }
    return done;
}

// ---- Points ----

static result add_light(item_job *j, const compile_entity *e)
{
    const char *strength = item_key(e, "light"), *colour = item_key(e, "_color");
    double units = LIGHT_UNITS, parts[3] = {1, 1, 1};
    if (strength && !(map_word_numbers(word_of(strength), &units, 1) && units > 0 && units < 1e6)) units = LIGHT_UNITS;
    if (colour && !map_word_numbers(word_of(colour), parts, 3)) parts[0] = parts[1] = parts[2] = 1;
    const double most = fmax(fmax(fabs(parts[0]), fabs(parts[1])), fabs(parts[2])), scale = most > 1 ? 1 / fmax(most, 255) : 1; // 0..1 or 0..255
    scene_light light = {.name = e->name ? e->name : e->class_name, .kind = LIGHT_POINT, .reach = units / UNITS_PER_METRE, .direction = {0, -1, 0}};
    memcpy(light.position, e->origin, sizeof light.position);
    for (int k = 0; k < 3; ++k) light.colour[k] = (float)fmin(fmax(parts[k] * scale, 0), 1);
    return scene_builder_light(j->builder, &light);
}

static result add_point(item_job *j, const compile_entity *e)
{
    const map_word class_name = word_of(e->class_name);
    scene_place place = {.kind = entity_place_of(class_name)};
    memcpy(place.position, e->origin, sizeof place.position);
    const result done = scene_builder_place(j->builder, &place);
    return done == RESULT_OK && map_word_starts(class_name, "light") ? add_light(j, e) : done;
}

// ---- All of them ----

int item_object_name(const item_job *j, uint32_t entity, char *out, size_t size)
{
    const char *name = j->in->entities[entity].class_name;
    if (map_word_is(word_of(name), "worldspawn")) return snprintf(out, size, "worldspawn");
    return snprintf(out, size, "%.*s %u", NAME_BYTES / 2, name, entity);
}

static uint32_t visible_faces(const item_job *j, const compile_entity *e)
{
    uint32_t count = 0;
    for (uint32_t b = e->first_brush; b < e->first_brush + e->brush_count; ++b)
        for (uint32_t f = 0; f < j->in->brushes[b].face_count && j->in->brushes[b].role == BRUSH_ENTITY; ++f)
            count += j->in->faces[j->in->brushes[b].first_face + f].material != COMPILE_NOTHING;
    return count;
}

static result add_entity(item_job *j, const brush_bodies *bodies, uint32_t entity)
{
    const compile_entity *e = &j->in->entities[entity];
    if (e->brush_count == 0) return e->has_origin ? add_point(j, e) : RESULT_OK;
    result done = add_bodies(j, bodies, entity);
    if (done != RESULT_OK || !visible_faces(j, e)) return done;
    char name[NAME_BYTES];
    entity_part part = {bodies, entity, 0};
    done = scene_builder_object(j->builder, name, (size_t)item_object_name(j, entity, name, sizeof name), &part.object);
    if (done != RESULT_OK) return done;
    return entity_role_of(word_of(e->class_name)) == ENTITY_MOVER ? add_mover(j, &part, name) : add_walls(j, &part);
}

result items_entities(item_job *j)
{
    brush_bodies made;
    result done = brush_bodies_make(j->in, 1u << BRUSH_ENTITY, j->report, j->memory, &made);
    if (done != RESULT_OK) return done;
    j->bodies = made;
    for (uint32_t e = 0; e < j->in->entity_count && done == RESULT_OK; ++e) done = add_entity(j, &j->bodies, e);
    return done;
}
