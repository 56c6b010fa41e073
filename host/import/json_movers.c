// Movers and doors of a JSON scene. A mover is one item, whatever its file holds.
// SPDX-License-Identifier: MIT
// Invariant: geometry stands as its door does at rest; the builder's transform at a mover's end is the document's.
#include "json_scene.h"

#include <string.h>

enum { KEYS_MOST = 65536 };

// ---- Geometry ----

typedef struct mover_shape {
    buffer indices, triangles; // uint32_t
    builder_item item;
    int has_material;
} mover_shape;

static result find_material(scene_builder *b, const scene_material *m, uint32_t *out)
{
    const result done = scene_builder_material(b, m->name, strlen(m->name), m->flags, out);
    return done == RESULT_OK ? scene_builder_material_colour(b, *out, m->colour) : done;
}

static void vertex_of(const scene *s, uint32_t v, builder_vertex *out)
{
    const float p[3] = {s->positions[v].x, s->positions[v].y, s->positions[v].z};
    for (int k = 0; k < 3; ++k) {
        out->position[k] = s->whole.origin[k] + (double)p[k];
        out->normal[k] = (float)(int8_t)(s->normals[v] >> (8 * k)) / 127;
    }
    for (int k = 0; k < 2; ++k) out->texcoord[k] = s->texcoords ? s->texcoords[2 * v + (uint32_t)k] : 0;
}

// Its vertices follow each other in the builder, so that an index is the model's and a constant.
static result add_vertices(scene_builder *b, const scene *s, uint32_t *out_first)
{
    enum { BATCH = 64 };
    builder_vertex batch[BATCH];
    for (uint32_t v = 0; v < s->position_count;) {
        uint32_t count = 0, material, first;
        const uint16_t owner = s->vertex_materials[v];
        for (; count < BATCH && v + count < s->position_count && s->vertex_materials[v + count] == owner; ++count) vertex_of(s, v + count, &batch[count]);
        result done = find_material(b, &s->materials[owner], &material);
        if (done == RESULT_OK) done = scene_builder_vertices(b, batch, count, material, &first);
        if (done != RESULT_OK) return done;
        if (v == 0) *out_first = first;
        v += count;
    }
    return RESULT_OK;
}

// Of an opaque material where it has one, so that it counts as an occluder's kind.
static result choose_material(scene_builder *b, const scene *s, builder_item *item)
{
    uint32_t chosen = s->items[0].material;
    for (uint32_t i = 0; i < s->item_count + s->mover_count; ++i) {
        const scene_item *from = &s->items[i];
        item->flags |= from->flags & CULL_ITEM_TWO_SIDED;
        if (s->materials[from->material].flags & MATERIAL_CUT_OUT) item->flags |= CULL_ITEM_CUT_OUT | CULL_ITEM_TWO_SIDED;
        if (s->materials[chosen].flags & MATERIAL_TRANSLUCENT) chosen = from->material;
    }
    return find_material(b, &s->materials[chosen], &item->material);
}

static result add_model(const json_entry *e, const scene *s, mover_shape *shape)
{
    scene_builder *b = e->scene->job->builder;
    uint32_t first = 0;
    result done = entry_room(e, s->position_count > s->index_count / 3 ? s->position_count : s->index_count / 3, 1);
    if (done != RESULT_OK) return done;
    done = add_vertices(b, s, &first);
    if (done == RESULT_OK) done = choose_material(b, s, &shape->item);
    if (done != RESULT_OK) return entry_told(e, done, "mover", NULL);
    uint32_t *indices = buffer_push(&shape->indices, s->index_count), *triangles = buffer_push(&shape->triangles, s->polygon_count);
    if (!indices || !triangles) return entry_no_memory(e);
    for (uint32_t i = 0; i < s->index_count; ++i) indices[i] = first + s->indices[i];
    for (uint32_t p = 0; p < s->polygon_count; ++p) triangles[p] = s->polygon_first_triangle[p + 1] - s->polygon_first_triangle[p];
    return RESULT_OK;
}

static result add_box(const json_entry *e, const json_box *box, mover_shape *shape)
{
    scene_builder *b = e->scene->job->builder;
    result done = scene_builder_material(b, box->material, strlen(box->material), material_flags_of_name(box->material), &shape->item.material);
    for (int f = 0; f < BOX_FACES && done == RESULT_OK; ++f) {
        double points[4][3];
        uint32_t first = 0;
        builder_vertex vertices[4] = {{{0}, {0}, {0}}};
        if (!box_has_face(box, f)) continue;
        box_face(box, f, points);
        for (int v = 0; v < 4; ++v) memcpy(vertices[v].position, points[v], sizeof points[v]);
        done = scene_builder_vertices(b, vertices, 4, shape->item.material, &first);
        const uint32_t indices[6] = {first, first + 1, first + 2, first, first + 2, first + 3}, triangles = 2;
        if (done == RESULT_OK && (!buffer_append(&shape->indices, indices, 6) || !buffer_append(&shape->triangles, &triangles, 1))) return entry_no_memory(e);
    }
    return entry_told(e, done, "mover", NULL);
}

static result read_shape(const json_entry *e, mover_shape *shape)
{
    static const char *const box_keys[] = {"min", "max", "material", "side", "omit", NULL};
    json_node file, n;
    json_box box;
    const scene *model;
    const int has_file = node_find(&e->node, "file", &file), has_box = node_find(&e->node, "box", &n);
    if (has_file == has_box) return node_fault(&e->node, "the mover needs either \"file\" or \"box\"; write one of them");
    result done = has_file ? model_find(e, &file, &model) : box_read(&n, box_keys, &box);
    if (done == RESULT_OK) done = has_file ? add_model(e, model, shape) : add_box(e, &box, shape);
    shape->item.indices = shape->indices.items;
    shape->item.polygon_triangles = shape->triangles.items;
    shape->item.index_count = (uint32_t)shape->indices.count;
    shape->item.polygon_count = (uint32_t)shape->triangles.count;
    return done;
}

typedef struct mover_entry {
    const char *name;
    uint32_t number; // in the builder
    double open[3];
    int has_open, loops;
    const door_entry *door; // that moves it, or NULL
} mover_entry;

static int stands_open(const mover_entry *m)
{
    return m->door && m->door->at_rest == DOORS_OPEN;
}

// ---- Paths ----

static result read_key(const json_node *n, const scene_key *before, scene_key *out)
{
    static const char *const keys[] = {"time", "at", "turn", NULL};
    json_node time;
    *out = (scene_key){0};
    result done = node_object(n, keys);
    if (done == RESULT_OK) done = node_need(n, "time", &time);
    if (done == RESULT_OK) done = node_number(&time, 0, 1e9, &out->time_s);
    if (done == RESULT_OK) done = node_maybe_vector(n, "at", out->offset);
    if (done == RESULT_OK) done = node_maybe_vector(n, "turn", out->turn_deg);
    if (done != RESULT_OK || !before || out->time_s > before->time_s) return done;
    return node_fault(&time, "%g s is not later than the key before it, %g s; order the keys by time", out->time_s, before->time_s);
}

static result read_keys(const json_entry *e, const json_node *list, buffer *keys)
{
    size_t count = 0;
    result done = node_array(list, 1, KEYS_MOST, &count);
    if (done != RESULT_OK) return done;
    scene_key *key = buffer_push(keys, count);
    if (!key) return entry_no_memory(e);
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) {
        const json_node n = node_item(list, i);
        done = read_key(&n, i ? &key[i - 1] : NULL, &key[i]);
    }
    return done;
}

// A pivot alone is kept by a path that stays.
static result give_path(const json_entry *e, const mover_entry *m, const double *pivot, buffer *keys)
{
    const scene_key stays = {0};
    builder_path path = {.keys = keys->items, .key_count = (uint32_t)keys->count, .loops = m->loops != 0};
    double moved[3];
    if (!keys->count) {
        path.keys = &stays;
        path.key_count = 1;
    }
    for (int k = 0; pivot && k < 3; ++k) moved[k] = pivot[k] + (stands_open(m) ? m->open[k] : 0);
    if (pivot) path.pivot = moved;
    return entry_told(e, scene_builder_mover_path(e->scene->job->builder, m->number, &path), "mover's path", "leads beyond 1e9 m; keep it nearer to the scene's origin");
}

static result read_path(const json_entry *e, const mover_entry *m)
{
    json_node list, pivot_node, loop;
    double pivot[3];
    result done = RESULT_OK;
    const int has_path = node_find(&e->node, "path", &list), has_pivot = node_find(&e->node, "pivot", &pivot_node);
    if (!has_path && node_find(&e->node, "loop", &loop)) return node_fault(&loop, "there is no \"path\" to go round; add one, or take this out");
    if (has_pivot) done = node_numbers(&pivot_node, 3, pivot);
    if (done != RESULT_OK || (!has_path && !has_pivot)) return done;
    buffer keys = buffer_make(e->scene->job->memory, sizeof(scene_key));
    if (has_path) done = read_keys(e, &list, &keys);
    if (done == RESULT_OK) done = give_path(e, m, has_pivot ? pivot : NULL, &keys);
    buffer_free(&keys);
    return done;
}

// ---- Movers ----

static result read_entry(const json_entry *e, mover_entry *out)
{
    static const char *const keys[] = {"name", "file", "box", PLACEMENT_KEYS, "pivot", "open", "path", "loop", NULL};
    json_node open;
    *out = (mover_entry){.number = scene_builder_mover_count(e->scene->job->builder)};
    result done = node_object(&e->node, keys);
    if (done == RESULT_OK) done = entry_new_name(e, &e->scene->movers, "mover", out->number, &out->name);
    if (done == RESULT_OK) done = node_maybe_truth(&e->node, "loop", &out->loops);
    if (done != RESULT_OK) return done;
    const named *door = name_table_find(&e->scene->moved, out->name);
    if (door) out->door = (const door_entry *)e->scene->door_list.items + door->number;
    out->has_open = node_find(&e->node, "open", &open);
    if (out->has_open) done = node_numbers(&open, 3, out->open);
    if (done == RESULT_OK && out->has_open && !door)
        done = node_fault(&open, "no door has this mover; add {\"name\": ..., \"mover\": \"%s\"} to \"doors\", or take it out", out->name);
    if (done == RESULT_OK && !out->has_open && door)
        done = node_fault(&e->node, "a door has this mover; add \"open\": [dx, dy, dz], how far it moves from shut to open");
    return done;
}

static result place_geometry(const json_entry *e, const mover_entry *m)
{
    builder_transform place;
    const double nowhere[3] = {0};
    const result done = placement_read(&e->node, &place);
    if (done != RESULT_OK) return done;
    const builder_transform move = placement_move(stands_open(m) ? m->open : nowhere), all = placement_within(&move, &place);
    return entry_place(e, &all);
}

static result add_mover(const json_entry *e, const mover_entry *m, mover_shape *shape)
{
    scene_builder *b = e->scene->job->builder;
    const builder_transform nothing = placement_none();
    result done = place_geometry(e, m);
    if (done == RESULT_OK) done = read_shape(e, shape);
    if (done == RESULT_OK) done = entry_place(e, &nothing);
    if (done != RESULT_OK) return done;
    done = scene_builder_object(b, m->name, strlen(m->name), &shape->item.object);
    if (done == RESULT_OK) done = scene_builder_mover(b, m->name, m->open, &shape->item);
    return entry_told(e, done, "mover", NULL);
}

static result read_mover(const json_entry *e)
{
    mover_entry m;
    result done = read_entry(e, &m);
    if (done != RESULT_OK) return done;
    const allocator *memory = e->scene->job->memory;
    mover_shape shape = {.indices = buffer_make(memory, sizeof(uint32_t)), .triangles = buffer_make(memory, sizeof(uint32_t))};
    done = add_mover(e, &m, &shape);
    buffer_free(&shape.indices);
    buffer_free(&shape.triangles);
    return done == RESULT_OK ? read_path(e, &m) : done;
}

result movers_read(json_scene *s)
{
    return entries_read(s, "movers", read_mover);
}

// ---- Doors ----

static result list_door(const json_entry *e)
{
    static const char *const keys[] = {"name", "open", "mover", NULL};
    json_scene *s = e->scene;
    json_node mover;
    const char *name, *mover_name;
    int is_open = 1;
    const uint32_t number = (uint32_t)s->door_list.count;
    result done = node_object(&e->node, keys);
    if (done == RESULT_OK) done = entry_new_name(e, &s->doors, "door", number, &name);
    if (done == RESULT_OK) done = node_maybe_truth(&e->node, "open", &is_open);
    if (done != RESULT_OK) return done;
    const door_entry door = {is_open ? s->job->options->doors : DOORS_SHUT};
    if (!buffer_append(&s->door_list, &door, 1)) return entry_no_memory(e);
    if (!node_find(&e->node, "mover", &mover)) return RESULT_OK;
    done = node_text(&mover, &name);
    if (done == RESULT_OK) done = entry_name(e, name, &mover_name);
    if (done != RESULT_OK) return done;
    done = name_table_add(&s->moved, mover_name, number);
    if (done == RESULT_NO_MEMORY) return entry_no_memory(e);
    return done == RESULT_OK ? done : node_fault(&mover, "another door has the mover '%s' already; give each a mover of its own", mover_name);
}

result doors_list(json_scene *s)
{
    return entries_read(s, "doors", list_door);
}

static result read_door(const json_entry *e)
{
    json_scene *s = e->scene;
    json_node node;
    named *own = NULL;
    uint32_t mover = SCENE_NONE;
    result done = entry_own(e, &s->doors, &own);
    if (done == RESULT_OK && node_find(&e->node, "mover", &node)) done = entry_refer(e, &node, &s->movers, "mover", &mover);
    if (done != RESULT_OK) return done;
    const door_entry *door = (const door_entry *)s->door_list.items + own->number;
    return entry_told(e, scene_builder_door(s->job->builder, own->name, door->at_rest, mover, &own->number), "door",
                      "has a leaf that lies beyond 1e9 m, shut or open; keep it nearer to the scene's origin");
}

result doors_read(json_scene *s)
{
    return entries_read(s, "doors", read_door);
}
