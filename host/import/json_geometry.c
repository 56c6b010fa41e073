// Static geometry of a JSON scene: included files of other kinds, meshes, boxes, walls.
// SPDX-License-Identifier: MIT
#include "json_polygon.h"
#include "json_scene.h"

#include <string.h>

enum { COPIES_MOST = 65536 };

// ---- Files ----

typedef struct repeat { uint32_t count; double step[3]; } repeat;

static result read_repeat(const json_node *entry, repeat *out)
{
    static const char *const keys[] = {"count", "step", NULL};
    json_node n, count, step;
    *out = (repeat){.count = 1};
    if (!node_find(entry, "repeat", &n)) return RESULT_OK;
    result done = node_object(&n, keys);
    if (done == RESULT_OK) done = node_need(&n, "count", &count);
    if (done == RESULT_OK) done = node_count(&count, 1, COPIES_MOST, &out->count);
    if (done == RESULT_OK) done = node_need(&n, "step", &step);
    return done == RESULT_OK ? node_numbers(&step, 3, out->step) : done;
}

static result add_copies(const json_entry *e, const scene_builder *mesh)
{
    repeat copies;
    builder_transform place;
    result done = placement_read(&e->node, &place);
    if (done == RESULT_OK) done = read_repeat(&e->node, &copies);
    if (done == RESULT_OK) done = entry_room(e, scene_builder_size(mesh), copies.count);
    for (uint32_t i = 0; done == RESULT_OK && i < copies.count; ++i) {
        const double offset[3] = {i * copies.step[0], i * copies.step[1], i * copies.step[2]};
        const builder_transform move = placement_move(offset), all = placement_within(&move, &place);
        done = entry_count_piece(e);
        if (done == RESULT_OK) done = entry_place(e, &all);
        if (done == RESULT_OK) done = entry_told(e, scene_builder_append(e->scene->job->builder, mesh), "file", NULL);
    }
    return done;
}

static result add_file(const json_entry *e, const json_node *file, const char *path)
{
    const scene_builder *mesh;
    const result found = mesh_find(e, file, path, &mesh);
    const result done = found == RESULT_OK ? add_copies(e, mesh) : found;
    e->scene->object = SCENE_NONE;
    return done;
}

static result read_include(const json_entry *e)
{
    json_node file;
    const char *path;
    result done = node_need(&e->node, "file", &file); // its keys are checked already
    if (done == RESULT_OK) done = entry_file(e, &file, &path);
    if (done != RESULT_OK) return done;
    const reader read = reader_of_file(path);
    json_node name;
    if (read == json_into) return RESULT_OK; // its parts come as a document of its own
    if (node_find(&e->node, "name", &name)) return node_fault(&name, "only a .json include has names to put this before; take it out");
    return add_file(e, &file, path);
}

static result read_mesh(const json_entry *e)
{
    static const char *const keys[] = {"file", "name", PLACEMENT_KEYS, "repeat", NULL};
    json_node file;
    const char *path, *label;
    result done = node_object(&e->node, keys);
    if (done == RESULT_OK) done = node_need(&e->node, "file", &file);
    if (done == RESULT_OK) done = node_maybe_text(&e->node, "name", &label);
    if (done == RESULT_OK) done = entry_file(e, &file, &path);
    if (done != RESULT_OK) return done;
    const reader read = reader_of_file(path);
    if (read == json_into) return node_fault(&file, "a scene is no mesh; put it under \"include\"");
    if (!read) return node_fault(&file, "unknown kind of mesh; the name must end in .obj, .ply, .off, .stl, .boxes or .map");
    return add_file(e, &file, path);
}

// ---- Polygons ----

typedef struct wall_polygon {
    const double (*points)[3];
    uint32_t count, material, object;
    double plane[4];
} wall_polygon;

static result add_wall(scene_builder *b, const wall_polygon *w)
{
    builder_vertex vertices[POLYGON_POINTS_MOST] = {{{0}, {0}, {0}}};
    uint32_t indices[3 * POLYGON_POINTS_MOST], loop[POLYGON_POINTS_MOST], first = 0;
    const uint32_t triangles = w->count - 2, start = (uint32_t)polygon_fan_start(w->points, w->count);
    for (uint32_t i = 0; i < w->count; ++i) memcpy(vertices[i].position, w->points[(start + i) % w->count], sizeof vertices[i].position);
    const result done = scene_builder_vertices(b, vertices, w->count, w->material, &first);
    if (done != RESULT_OK) return done;
    for (uint32_t i = 0; i < w->count; ++i) loop[i] = first + i;
    for (uint32_t t = 0; t < triangles; ++t) {
        indices[3 * t] = first;
        indices[3 * t + 1] = first + t + 1;
        indices[3 * t + 2] = first + t + 2;
    }
    builder_item item = {.indices = indices,
                         .polygon_triangles = &triangles,
                         .loop = loop,
                         .index_count = 3 * triangles,
                         .polygon_count = 1,
                         .loop_count = w->count,
                         .material = w->material,
                         .object = w->object,
                         .flags = CULL_ITEM_WALL};
    memcpy(item.plane, w->plane, sizeof item.plane);
    return scene_builder_item(b, &item);
}

// One with a name is an object of its own; the others between two of these are one together.
static result object_of(const json_entry *e, const char *kind, uint32_t *out)
{
    scene_builder *b = e->scene->job->builder;
    const char *name = NULL;
    result done = node_maybe_text(&e->node, "name", &name);
    if (done != RESULT_OK) return done;
    if (name) {
        const char *full;
        e->scene->object = SCENE_NONE;
        done = entry_name(e, name, &full);
        return done == RESULT_OK ? scene_builder_object(b, full, strlen(full), out) : done;
    }
    if (e->scene->object == SCENE_NONE) done = scene_builder_object(b, kind, strlen(kind), &e->scene->object);
    *out = e->scene->object;
    return done;
}

static result read_box(const json_entry *e)
{
    static const char *const keys[] = {"min", "max", "material", "side", "omit", "name", NULL};
    scene_builder *b = e->scene->job->builder;
    json_box box;
    double points[4][3];
    wall_polygon w = {.points = (const double(*)[3])points, .count = 4};
    result done = box_read(&e->node, keys, &box);
    if (done != RESULT_OK) return done;
    done = object_of(e, "boxes", &w.object);
    if (done == RESULT_OK) done = scene_builder_material(b, box.material, strlen(box.material), material_flags_of_name(box.material), &w.material);
    for (int f = 0; f < BOX_FACES && done == RESULT_OK; ++f) {
        if (!box_has_face(&box, f)) continue;
        box_face(&box, f, points);
        const int axis = f / 2;
        const double outward = (f % 2 == 1) == (box.side == BOX_OUT) ? 1 : -1;
        memset(w.plane, 0, sizeof w.plane);
        w.plane[axis] = outward;
        w.plane[3] = -outward * points[0][axis] + 0.0;
        done = add_wall(b, &w);
    }
    return entry_told(e, done, "box", NULL);
}

static result read_wall(const json_entry *e)
{
    static const char *const keys[] = {"points", "material", "name", NULL};
    scene_builder *b = e->scene->job->builder;
    double points[POLYGON_POINTS_MOST][3];
    const char *material = "default", *fault = NULL;
    json_node list;
    size_t count = 0;
    wall_polygon w = {.points = (const double(*)[3])points};
    result done = node_object(&e->node, keys);
    if (done == RESULT_OK) done = node_need(&e->node, "points", &list);
    if (done == RESULT_OK) done = entry_points(&list, 3, POLYGON_POINTS_MOST, points, &count);
    if (done == RESULT_OK) done = node_maybe_text(&e->node, "material", &material);
    if (done != RESULT_OK) return done;
    w.count = (uint32_t)count;
    fault = polygon_plane(w.points, count, w.plane);
    if (fault) return node_fault(&list, "the wall %s", fault);
    done = object_of(e, "walls", &w.object);
    if (done == RESULT_OK) done = scene_builder_material(b, material, strlen(material), material_flags_of_name(material), &w.material);
    if (done == RESULT_OK) done = add_wall(b, &w);
    return entry_told(e, done, "wall", NULL);
}

result geometry_read(json_scene *s)
{
    result done = entries_read(s, "include", read_include);
    if (done == RESULT_OK) done = entries_read(s, "meshes", read_mesh);
    if (done == RESULT_OK) done = entries_read(s, "boxes", read_box);
    s->object = SCENE_NONE;
    if (done == RESULT_OK) done = entries_read(s, "walls", read_wall);
    return done;
}
