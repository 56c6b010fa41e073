// Reader of .map files, Standard and Valve 220: brushes to convex polygons and bodies by plane clipping, one zone.
// SPDX-License-Identifier: MIT
// Invariant: a map point (x, y, z) is (x, z, -y) / 32 in the scene: a rotation and a power of two, so exact.
#include "map_stage.h"
#include "reader.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { UNITS_PER_METRE = 32, NAME_BYTES = 96 };

typedef struct map_import {
    map_reader reader;
    map_entity entity;
    map_stage stage;
    scene_builder *builder;
    buffer vertices, indices, triangles; // builder_vertex, uint32_t, uint32_t: of one item
    buffer planes;                       // scene_solid_plane: of one body
    door_state doors;
} map_import;

static void to_scene(const double units[3], const double offset[3], double out[3])
{
    const double moved[3] = {units[0] + offset[0], units[1] + offset[1], units[2] + offset[2]};
    out[0] = moved[0] / UNITS_PER_METRE;
    out[1] = moved[2] / UNITS_PER_METRE;
    out[2] = -moved[1] / UNITS_PER_METRE + 0.0;
}

static void turn_to_scene(const double v[3], double out[3])
{
    out[0] = v[0];
    out[1] = v[2];
    out[2] = -v[1] + 0.0;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// ---- Polygons ----

// The polygon's vertices into the builder; its fan into `indices`.
static result add_polygon(map_import *i, const staged_polygon *polygon, const double offset[3], uint32_t *out_material, uint32_t *out_first)
{
    const staged_point *points = (const staged_point *)i->stage.points.items + polygon->first_point;
    i->vertices.count = 0;
    builder_vertex *vertices = buffer_push(&i->vertices, polygon->point_count);
    uint32_t *indices = vertices ? buffer_push(&i->indices, (polygon->point_count - 2) * 3) : NULL;
    if (!indices) return RESULT_NO_MEMORY;
    for (size_t p = 0; p < polygon->point_count; ++p) {
        vertices[p] = (builder_vertex){.texcoord = {points[p].texcoord[0], points[p].texcoord[1]}};
        to_scene(points[p].position, offset, vertices[p].position);
    }
    const map_word texture = polygon->texture;
    result done = scene_builder_material(i->builder, texture.text, texture.length, texture_material_flags(polygon->kind), out_material);
    if (done == RESULT_OK) done = scene_builder_vertices(i->builder, vertices, polygon->point_count, *out_material, out_first);
    if (done != RESULT_OK) return done;
    for (uint32_t t = 0; t + 2 < polygon->point_count; ++t) {
        indices[3 * t] = *out_first;
        indices[3 * t + 1] = *out_first + t + 1;
        indices[3 * t + 2] = *out_first + t + 2;
    }
    return RESULT_OK;
}

static result add_wall(map_import *i, const staged_polygon *polygon, uint32_t object)
{
    static const double nowhere[3] = {0};
    i->indices.count = i->triangles.count = 0;
    const uint32_t count = (uint32_t)polygon->point_count, triangle_count = count - 2;
    builder_item item = {.index_count = triangle_count * 3,
                         .polygon_count = 1,
                         .polygon_triangles = &triangle_count,
                         .loop_count = count,
                         .object = object,
                         .flags = CULL_ITEM_WALL};
    uint32_t first;
    const result done = add_polygon(i, polygon, nowhere, &item.material, &first);
    if (done != RESULT_OK) return done;
    uint32_t *loop = buffer_push(&i->triangles, count);
    if (!loop) return RESULT_NO_MEMORY;
    for (uint32_t p = 0; p < count; ++p) loop[p] = first + p;
    item.indices = i->indices.items;
    item.loop = loop;
    turn_to_scene(polygon->normal, item.plane);
    item.plane[3] = -polygon->distance / UNITS_PER_METRE + 0.0; // inside, for a wall, is its front
    return scene_builder_item(i->builder, &item);
}

// All of a mover is one item, with a door of its own where it opens: of an opaque material where it has one, so that it counts as an occluder's kind.
static result add_mover(map_import *i, const char *name, const double offset[3], uint32_t object)
{
    static const double nowhere[3] = {0};
    const staged_polygon *polygons = i->stage.polygons.items;
    i->indices.count = i->triangles.count = 0;
    builder_item item = {.polygon_count = (uint32_t)i->stage.polygons.count, .object = object};
    int opaque = 0;
    uint32_t *triangles = buffer_push(&i->triangles, i->stage.polygons.count);
    if (!triangles) return RESULT_NO_MEMORY;
    for (size_t p = 0; p < i->stage.polygons.count; ++p) {
        uint32_t material, first;
        const result done = add_polygon(i, &polygons[p], i->doors == DOORS_OPEN ? offset : nowhere, &material, &first);
        if (done != RESULT_OK) return done;
        triangles[p] = (uint32_t)polygons[p].point_count - 2;
        if (p == 0 || (!opaque && polygons[p].kind != TEXTURE_LIQUID)) item.material = material;
        opaque |= polygons[p].kind != TEXTURE_LIQUID;
        if (polygons[p].kind == TEXTURE_CUT_OUT) item.flags |= CULL_ITEM_CUT_OUT | CULL_ITEM_TWO_SIDED;
    }
    item.indices = i->indices.items;
    item.index_count = (uint32_t)i->indices.count;
    item.polygon_triangles = triangles;
    double open_offset[3];
    to_scene(offset, nowhere, open_offset);
    const result done = scene_builder_mover(i->builder, name, open_offset, &item);
    if (done != RESULT_OK || (open_offset[0] == 0 && open_offset[1] == 0 && open_offset[2] == 0)) return done;
    uint32_t door;
    return scene_builder_door(i->builder, name, i->doors, scene_builder_mover_count(i->builder) - 1, &door);
}

// ---- Bodies and places ----

typedef enum solid_use { SOLID_ADDED, SOLID_TAKEN } solid_use;

static result add_solid(map_import *i, const staged_solid *solid, const double offset[3], solid_use use)
{
    staged_plane *planes = (staged_plane *)i->stage.solid_planes.items + solid->first_plane;
    i->planes.count = 0;
    scene_solid_plane *to = buffer_push(&i->planes, solid->plane_count);
    if (!to) return RESULT_NO_MEMORY;
    for (size_t p = 0; p < solid->plane_count; ++p) {
        turn_to_scene(planes[p].normal, to[p].normal);
        to[p].distance = (planes[p].distance + dot(planes[p].normal, offset)) / UNITS_PER_METRE;
    }
    if (use == SOLID_TAKEN) return scene_builder_solid_subtract(i->builder, to, (uint32_t)solid->plane_count);
    double low[3], high[3];
    to_scene(solid->min, offset, low);
    to_scene(solid->max, offset, high);
    const double min[3] = {low[0], low[1], high[2]}, max[3] = {high[0], high[1], low[2]}; // z is turned round
    return scene_builder_solid(i->builder, solid->kind, to, (uint32_t)solid->plane_count, min, max);
}

static result add_place(map_import *i)
{
    static const double nowhere[3] = {0};
    const map_entity *e = &i->entity;
    const map_key *origin = map_entity_key(e, "origin");
    if (!origin) return RESULT_OK;
    double units[3];
    int good = map_word_numbers(origin->value, units, 3);
    for (int k = 0; good && k < 3; ++k) good = fabs(units[k]) <= MAP_COORDINATE_MOST;
    if (!good)
        return report_error(i->reader.report, i->reader.path, origin->line, "entity %u: \"origin\" takes three numbers within 2^20; repair its value",
                            e->number);
    scene_place place = {.kind = entity_place_of(entity_class(e))};
    to_scene(units, nowhere, place.position);
    return scene_builder_place(i->builder, &place);
}

// ---- Entities ----

static void name_entity(const map_entity *e, char name[NAME_BYTES])
{
    const map_word class_name = entity_class(e);
    const int length = class_name.length < NAME_BYTES / 2 ? (int)class_name.length : NAME_BYTES / 2;
    if (map_word_is(class_name, "worldspawn")) snprintf(name, NAME_BYTES, "worldspawn");
    else snprintf(name, NAME_BYTES, "%.*s %u", length, class_name.text, e->number);
}

// Shut, then open where that is elsewhere, whatever the option says: free space, and so the automatic views, are the same.
static result add_bodies(map_import *i, const double offset[3])
{
    static const double nowhere[3] = {0};
    const double *const places[2] = {nowhere, offset};
    const int count = memcmp(offset, nowhere, sizeof nowhere) != 0 ? 2 : 1;
    const solid_use use = entity_body_of(entity_class(&i->entity)) == BODY_HOLLOW ? SOLID_TAKEN : SOLID_ADDED;
    result done = RESULT_OK;
    for (int p = 0; p < count; ++p)
        for (size_t n = 0; n < i->stage.solids.count && done == RESULT_OK; ++n)
            done = add_solid(i, (const staged_solid *)i->stage.solids.items + n, places[p], use);
    return done;
}

static result add_staged(map_import *i, entity_role role)
{
    const map_stage *s = &i->stage;
    double offset[3] = {0};
    result done = RESULT_OK;
    if (role == ENTITY_MOVER) done = entity_open_offset(&i->entity, s->min, s->max, &i->reader, offset);
    if (done == RESULT_OK) done = add_bodies(i, offset);
    if (s->polygons.count == 0 || done != RESULT_OK) return done;
    char name[NAME_BYTES];
    uint32_t object;
    name_entity(&i->entity, name);
    done = scene_builder_object(i->builder, name, strlen(name), &object);
    if (done == RESULT_OK && role == ENTITY_MOVER) return add_mover(i, name, offset, object);
    for (size_t p = 0; p < s->polygons.count && done == RESULT_OK; ++p)
        done = add_wall(i, (const staged_polygon *)s->polygons.items + p, object);
    return done;
}

static result add_entity(map_import *i)
{
    const map_entity *e = &i->entity;
    if (e->brushes.count == 0) return add_place(i);
    const map_word class_name = entity_class(e);
    const entity_role role = entity_role_of(class_name);
    if (role == ENTITY_NOTHING || map_word_is(class_name, "zone_portal")) return RESULT_OK; // the compiler's, nothing to see
    map_stage_clear(&i->stage);
    for (size_t b = 0; b < e->brushes.count; ++b) {
        const result done = map_stage_brush(&i->stage, e, b, entity_body_of(class_name), &i->reader);
        if (done != RESULT_OK) return done;
    }
    return add_staged(i, role);
}

static result read_all(map_import *i)
{
    for (;;) {
        map_more more;
        result done = map_reader_next(&i->reader, &i->entity, &more);
        if (done == RESULT_OK && more == MAP_END) return RESULT_OK;
        const uint32_t errors = i->reader.report->errors;
        if (done == RESULT_OK) done = add_entity(i);
        else return done;
        if (done != RESULT_OK && i->reader.report->errors == errors) { // the builder says no words of its own
            if (done == RESULT_NO_MEMORY) return report_no_memory(i->reader.report, i->reader.path);
            return report_error(i->reader.report, i->reader.path, i->entity.line, "entity %u: over 65,535 textures or 2^32 points; split the map",
                                i->entity.number);
        }
        if (done != RESULT_OK) return done;
    }
}

static result read_map(map_import *i)
{
    report *r = i->reader.report;
    const char *path = i->reader.path;
    scene_builder_map(i->builder);
    const result done = read_all(i);
    if (done != RESULT_OK) return done;
    if (i->reader.entities_read == 0) return report_error(r, path, i->reader.line, "no entity in it; is this a .map file?");
    if (i->stage.polygons_dropped) report_note(r, "%s: %u faces without area are left out", path, i->stage.polygons_dropped);
    return RESULT_OK;
}

static size_t byte_order_mark(const char *text, size_t size) // UTF-8's
{
    return size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

result map_into(const reader_job *j)
{
    const allocator *memory = j->memory;
    map_import i = {.reader = {.path = j->path, .at = j->text + byte_order_mark(j->text, j->size), .end = j->text + j->size, .line = 1, .report = j->report},
                    .entity = map_entity_make(memory),
                    .stage = map_stage_make(memory),
                    .builder = j->builder,
                    .vertices = buffer_make(memory, sizeof(builder_vertex)),
                    .indices = buffer_make(memory, sizeof(uint32_t)),
                    .triangles = buffer_make(memory, sizeof(uint32_t)),
                    .planes = buffer_make(memory, sizeof(scene_solid_plane)),
                    .doors = j->options->doors};
    const result done = read_map(&i);
    buffer_free(&i.vertices);
    buffer_free(&i.indices);
    buffer_free(&i.triangles);
    buffer_free(&i.planes);
    map_stage_free(&i.stage);
    map_entity_free(&i.entity);
    return done;
}
