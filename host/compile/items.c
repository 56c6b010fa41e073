// The last stage: the zones' polygons triangulated, with all else that the map holds, into a builder and out as a scene.
// SPDX-License-Identifier: MIT
// Invariant: items of one object lie together; what looks into the void round the map, and what makes nothing, is no item.
#include "items.h"

#include <math.h>
#include <string.h>

enum { NAME_BYTES = 96 };
#define VERTEX_NONE UINT32_MAX

// ---- Planes, texture coordinates, loops ----

void item_plane(const item_job *j, plane_ref ref, double out[4])
{
    const cull_wide_plane p = plane_table_get(j->in->planes, ref);
    const double n[3] = {(double)p.normal[0], (double)p.normal[1], (double)p.normal[2]}, length = sqrt((n[0] * n[0] + n[1] * n[1]) + n[2] * n[2]);
    for (int k = 0; k < 3; ++k) out[k] = n[k] / length + 0.0;
    out[3] = cull_wide_to_double(p.offset) / length / j->in->steps_per_metre + 0.0;
}

int item_exact_plane(const item_job *j, plane_ref ref, cull_exact_plane *out)
{
    const cull_wide_plane p = plane_table_get(j->in->planes, ref);
    if (!cull_wide_fits_int64(p.offset)) return 0;
    *out = (cull_exact_plane){{p.normal[0], p.normal[1], p.normal[2]}, cull_wide_to_int64(p.offset)};
    return 1;
}

void item_texcoord(const compile_face *face, const double metres[3], float out[2])
{
    for (int i = 0; i < 2; ++i) {
        const double *row = face->texture[i];
        out[i] = (float)(((row[0] * metres[0] + row[1] * metres[1]) + row[2] * metres[2]) + row[3]);
    }
}

int item_goes_straight(const item_job *j, const compile_polygon *p, uint32_t place)
{
    const compile_mesh *m = j->zones->mesh;
    const plane_ref *edges = m->edge_planes + p->first_vertex;
    const uint32_t before = place ? place - 1 : p->vertex_count - 1, after = place + 1 < p->vertex_count ? place + 1 : 0;
    if (edges[before] == edges[place]) return 1;
    const compile_vertex *v = &m->vertices[m->loop[p->first_vertex + after]];
    return plane_table_side_at(j->in->planes, v->planes, v->position, edges[before]) == 0;
}

const char *item_key(const compile_entity *e, const char *name)
{
    const char *found = NULL;
    for (uint32_t i = 0; i < e->key_count; ++i)
        if (strcmp(e->keys[2 * i], name) == 0) found = e->keys[2 * i + 1];
    return found;
}

// ---- Structure ----

typedef struct structure {
    item_job *job;
    rounded_mesh rounded;
    wall_lists lists;
    loop_triangulator triangulator;
    uint32_t *first_vertex; // by polygon: in the builder; VERTEX_NONE: no item
    uint32_t *order;        // polygons by entity
    uint8_t *is_item;       // by polygon
    buffer loop, triangles; // uint32_t: places in one loop, then vertices in the builder
    buffer walls;           // wall_triangle: of all polygons, in `order`
    buffer loops;           // uint32_t: true corners of all polygons, in the builder
    uint32_t *first_loop, *first_wall; // by polygon: of its corners in `loops`, and one more; of its triangles in `walls`, when sorted
    buffer all;             // uint32_t: of the mesh, three a triangle, liquids left out
    uint32_t triangle_count, object, entity;
} structure;

static uint32_t entity_of(const item_job *j, const compile_polygon *p)
{
    return j->in->brushes[p->brush].entity;
}

// By counting: stable, so polygons of an entity keep their order.
static result sort_polygons(structure *s)
{
    const compile_mesh *m = s->job->zones->mesh;
    const uint32_t entities = s->job->in->entity_count;
    uint32_t *starts = memory_alloc_zeroed(s->job->memory, (size_t)entities + 1, sizeof *starts);
    if (!starts) return RESULT_NO_MEMORY;
    for (uint32_t p = 0; p < m->polygon_count; ++p) starts[entity_of(s->job, &m->polygons[p]) + 1]++;
    for (uint32_t e = 0; e < entities; ++e) starts[e + 1] += starts[e];
    for (uint32_t p = 0; p < m->polygon_count; ++p) s->order[starts[entity_of(s->job, &m->polygons[p])]++] = p;
    memory_free(s->job->memory, starts, (size_t)entities + 1, sizeof *starts);
    return RESULT_OK;
}

static int is_seen(const item_job *j, uint32_t polygon)
{
    return j->zones->mesh->polygons[polygon].material != COMPILE_NOTHING && j->zones->polygon_zone[polygon] != UINT32_MAX;
}

static result add_vertices(structure *s, uint32_t polygon)
{
    item_job *j = s->job;
    const compile_mesh *m = j->zones->mesh;
    const compile_polygon *p = &m->polygons[polygon];
    j->points.count = 0;
    builder_vertex *points = buffer_push(&j->points, p->vertex_count);
    if (!points) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < p->vertex_count; ++i) {
        points[i] = (builder_vertex){.normal = {0, 0, 0}};
        for (int k = 0; k < 3; ++k) points[i].position[k] = m->vertices[m->loop[p->first_vertex + i]].position[k] / j->in->steps_per_metre;
        item_texcoord(&j->in->faces[p->face], points[i].position, points[i].texcoord);
    }
    return scene_builder_vertices(j->builder, points, p->vertex_count, j->material_of[p->material], &s->first_vertex[polygon]);
}

static result all_vertices(structure *s)
{
    result done = RESULT_OK;
    const compile_mesh *m = s->job->zones->mesh;
    for (uint32_t i = 0; i < m->polygon_count && done == RESULT_OK; ++i) {
        const uint32_t polygon = s->order[i];
        s->first_vertex[polygon] = VERTEX_NONE;
        if (is_seen(s->job, polygon)) done = add_vertices(s, polygon);
    }
    return done;
}

static result keep_for_checks(structure *s, const compile_polygon *p, const wall_triangle *walls, uint32_t count)
{
    if (s->job->in->brushes[p->brush].role == BRUSH_LIQUID) return RESULT_OK;
    for (uint32_t i = 0; i < count; ++i)
        if (!buffer_append(&s->all, walls[i].vertices, 3)) return RESULT_NO_MEMORY;
    return RESULT_OK;
}

static result object_of(structure *s, const compile_polygon *p)
{
    const uint32_t entity = entity_of(s->job, p);
    if (s->entity == entity) return RESULT_OK;
    char name[NAME_BYTES];
    s->entity = entity;
    return scene_builder_object(s->job->builder, name, (size_t)item_object_name(s->job, entity, name, sizeof name), &s->object);
}

// Its corners in the builder to `loops`, its triangles to `walls`.
static result triangulate(structure *s, uint32_t polygon)
{
    const compile_mesh *m = s->job->zones->mesh;
    const compile_polygon *p = &m->polygons[polygon];
    const uint32_t first = s->first_vertex[polygon];
    s->first_loop[2 * (size_t)polygon] = s->first_loop[2 * (size_t)polygon + 1] = (uint32_t)s->loops.count;
    if (first == VERTEX_NONE) return RESULT_OK;
    const result done = loop_triangulate(&s->triangulator, p, &s->loop, &s->triangles);
    if (done != RESULT_OK || s->triangles.count == 0 || s->loop.count < 3) return done;
    uint32_t *loop = buffer_push(&s->loops, s->loop.count);
    wall_triangle *walls = buffer_push(&s->walls, s->triangles.count / 3);
    if (!loop || !walls) return RESULT_NO_MEMORY;
    const uint32_t *corners = s->loop.items, *places = s->triangles.items;
    for (size_t i = 0; i < s->loop.count; ++i) loop[i] = first + corners[i];
    for (size_t i = 0; i < s->triangles.count; ++i) {
        walls[i / 3].vertices[i % 3] = m->loop[p->first_vertex + places[i]];
        walls[i / 3].corners[i % 3] = first + places[i];
        walls[i / 3].polygon = polygon;
    }
    s->first_loop[2 * (size_t)polygon + 1] = (uint32_t)s->loops.count;
    return RESULT_OK;
}

// By counting: stable. Those that are gone are left out.
static result sort_walls(structure *s)
{
    const uint32_t count = s->job->zones->mesh->polygon_count;
    buffer sorted = buffer_make(s->job->memory, sizeof(wall_triangle));
    const wall_triangle *from = s->walls.items;
    wall_triangle *to = buffer_push(&sorted, s->walls.count + 1);
    if (!to) return RESULT_NO_MEMORY;
    uint32_t *first = s->first_wall;
    memset(first, 0, ((size_t)count + 2) * sizeof *first);
    for (size_t i = 0; i < s->walls.count; ++i)
        if (from[i].polygon != SCENE_NONE) first[from[i].polygon + 2]++;
    for (uint32_t p = 2; p < count + 2; ++p) first[p] += first[p - 1];
    for (size_t i = 0; i < s->walls.count; ++i)
        if (from[i].polygon != SCENE_NONE) to[first[from[i].polygon + 1]++] = from[i];
    buffer_free(&s->walls);
    s->walls = sorted;
    return RESULT_OK;
}

static result take_triangles(structure *s, const wall_triangle *walls, uint32_t count)
{
    s->triangles.count = 0;
    for (uint32_t i = 0; i < count; ++i)
        if (!buffer_append(&s->triangles, walls[i].corners, 3)) return RESULT_NO_MEMORY;
    return RESULT_OK;
}

static result add_item(structure *s, uint32_t polygon)
{
    item_job *j = s->job;
    const compile_polygon *p = &j->zones->mesh->polygons[polygon];
    const uint32_t triangle_count = s->first_wall[polygon + 1] - s->first_wall[polygon], *loop = s->first_loop + 2 * (size_t)polygon;
    const wall_triangle *walls = (const wall_triangle *)s->walls.items + s->first_wall[polygon];
    if (triangle_count == 0) return RESULT_OK;
    result done = take_triangles(s, walls, triangle_count);
    if (done == RESULT_OK) done = keep_for_checks(s, p, walls, triangle_count);
    if (done == RESULT_OK) done = object_of(s, p);
    if (done != RESULT_OK) return done;
    builder_item item = {.indices = s->triangles.items,
                         .polygon_triangles = &triangle_count,
                         .loop = (const uint32_t *)s->loops.items + loop[0],
                         .index_count = (uint32_t)s->triangles.count,
                         .polygon_count = 1,
                         .loop_count = loop[1] - loop[0],
                         .material = j->material_of[p->material],
                         .object = s->object,
                         .flags = CULL_ITEM_WALL};
    cull_exact_plane exact;
    item_plane(j, p->plane, item.plane);
    item.exact = item_exact_plane(j, p->plane, &exact) ? &exact : NULL;
    s->is_item[polygon] = 1;
    s->triangle_count += triangle_count;
    done = scene_builder_item(j->builder, &item);
    return done == RESULT_OK ? wall_lists_tell(&s->lists, polygon) : done;
}

static result structure_open(structure *s, item_job *j)
{
    const size_t count = j->zones->mesh->polygon_count;
    *s = (structure){.job = j, .entity = UINT32_MAX};
    s->loop = buffer_make(j->memory, sizeof(uint32_t));
    s->triangles = buffer_make(j->memory, sizeof(uint32_t));
    s->all = buffer_make(j->memory, sizeof(uint32_t));
    s->walls = buffer_make(j->memory, sizeof(wall_triangle));
    s->loops = buffer_make(j->memory, sizeof(uint32_t));
    s->first_loop = memory_alloc(j->memory, count, 2 * sizeof *s->first_loop);
    s->first_wall = memory_alloc(j->memory, count + 2, sizeof *s->first_wall);
    s->triangulator = loop_triangulator_make(j, &s->rounded);
    s->first_vertex = memory_alloc(j->memory, count, sizeof *s->first_vertex);
    s->order = memory_alloc(j->memory, count, sizeof *s->order);
    s->is_item = memory_alloc_zeroed(j->memory, count, 1);
    return s->first_vertex && s->order && s->is_item && s->first_loop && s->first_wall ? sort_polygons(s) : RESULT_NO_MEMORY;
}

static void structure_close(structure *s)
{
    const size_t count = s->job->zones->mesh->polygon_count;
    buffer_free(&s->loop);
    buffer_free(&s->triangles);
    buffer_free(&s->all);
    buffer_free(&s->walls);
    buffer_free(&s->loops);
    memory_free(s->job->memory, s->first_loop, count, 2 * sizeof *s->first_loop);
    memory_free(s->job->memory, s->first_wall, count + 2, sizeof *s->first_wall);
    loop_triangulator_free(&s->triangulator);
    wall_lists_free(&s->lists);
    rounded_mesh_free(&s->rounded);
    memory_free(s->job->memory, s->first_vertex, count, sizeof *s->first_vertex);
    memory_free(s->job->memory, s->order, count, sizeof *s->order);
    memory_free(s->job->memory, s->is_item, count, 1);
}

static result structure_items(structure *s)
{
    const compile_mesh *m = s->job->zones->mesh;
    result done = rounded_mesh_make(s->job, &s->rounded);
    if (done == RESULT_OK) done = wall_lists_make(s->job, &s->rounded, &s->lists);
    for (uint32_t i = 0; i < m->polygon_count && done == RESULT_OK; ++i) done = triangulate(s, s->order[i]);
    if (done == RESULT_OK) done = items_mend_flat(s->job, &s->rounded, s->first_vertex, &s->walls, s->is_item);
    if (done == RESULT_OK) done = sort_walls(s);
    for (uint32_t i = 0; i < m->polygon_count && done == RESULT_OK; ++i) done = add_item(s, s->order[i]);
    return done;
}

// ---- All of it ----

static result add_materials(item_job *j)
{
    result done = RESULT_OK;
    for (uint32_t m = 0; m < j->in->material_count && done == RESULT_OK; ++m) {
        const compile_material *from = &j->in->materials[m];
        done = scene_builder_material(j->builder, from->name, strlen(from->name), from->flags, &j->material_of[m]);
    }
    return done;
}

static result fill(item_job *j, scene **out, compile_checks *checks)
{
    structure s;
    scene_builder_map(j->builder);
    scene_builder_grid(j->builder, j->in->steps_per_metre);
    result done = structure_open(&s, j);
    if (done == RESULT_OK) done = add_materials(j);
    if (done == RESULT_OK) done = all_vertices(&s);
    if (done == RESULT_OK) done = items_entities(j);
    if (done == RESULT_OK) done = items_models(j);
    if (done == RESULT_OK) items_normal_maps(j);
    if (done == RESULT_OK && !j->in->beside) done = items_starts(j); // a JSON scene has paths of its own
    if (done == RESULT_OK) done = items_zones(j);
    if (done == RESULT_OK) done = structure_items(&s);
    const check_input check = {j, &s.rounded, s.all.items, s.all.count / 3, s.is_item};
    if (done == RESULT_OK) done = items_check(&check, checks);
    checks->triangles = s.triangle_count;
    checks->items = scene_builder_item_count(j->builder);
    structure_close(&s);
    if (done == RESULT_OK) done = scene_builder_finish(j->builder, j->in->path, j->report, out);
    if (done == RESULT_OK) checks->degenerate_triangles = items_flat_triangles(j, *out);
    return done;
}

static result tell(const item_job *j, result done, uint32_t errors_before)
{
    if (done == RESULT_OK || j->report->errors != errors_before) return done; // the builder says no words of its own
    if (done == RESULT_NO_MEMORY) return report_no_memory(j->report, j->in->path);
    return report_error(j->report, j->in->path, 0, "over 65,535 textures or 2^32 points; split the map");
}

result compile_items(const compile_input *in, const compiled_zones *z, report *r, const allocator *memory, scene **out, compile_checks *checks)
{
    const uint32_t errors = r->errors;
    item_job j = {.in = in, .zones = z, .memory = memory, .report = r};
    *checks = (compile_checks){0};
    j.points = buffer_make(memory, sizeof(builder_vertex));
    j.triangles = buffer_make(memory, sizeof(uint32_t));
    j.counts = buffer_make(memory, sizeof(uint32_t));
    j.loop = buffer_make(memory, sizeof(uint32_t));
    j.material_of = memory_alloc(memory, in->material_count, sizeof *j.material_of);
    j.mover_of = memory_alloc(memory, in->entity_count, sizeof *j.mover_of);
    j.door_of = memory_alloc(memory, in->entity_count, sizeof *j.door_of);
    result done = j.material_of && j.mover_of && j.door_of ? RESULT_OK : RESULT_NO_MEMORY;
    j.builder = in->beside;
    if (done == RESULT_OK && !in->beside) done = scene_builder_open(memory, &j.builder);
    for (uint32_t e = 0; e < in->entity_count && done == RESULT_OK; ++e) j.mover_of[e] = j.door_of[e] = SCENE_NONE;
    if (done == RESULT_OK) done = fill(&j, out, checks);
    if (!in->beside) scene_builder_close(j.builder);
    brush_bodies_free(&j.bodies);
    buffer *const all[] = {&j.points, &j.triangles, &j.counts, &j.loop};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    memory_free(memory, j.material_of, in->material_count, sizeof *j.material_of);
    memory_free(memory, j.mover_of, in->entity_count, sizeof *j.mover_of);
    memory_free(memory, j.door_of, in->entity_count, sizeof *j.door_of);
    return tell(&j, done, errors);
}
