// Files of movers and of static geometry, each read once: a mover's as a scene of its own, the others as a builder to append.
// SPDX-License-Identifier: MIT
#include "json_scene.h"

#include <string.h>

void models_open(json_scene *s)
{
    const allocator *memory = s->job->memory;
    s->models = buffer_make(memory, sizeof(scene *));
    s->meshes = buffer_make(memory, sizeof(scene_builder *));
    s->model_names = name_table_make(memory);
    s->mesh_names = name_table_make(memory);
}

void models_free(json_scene *s)
{
    scene *const *models = s->models.items;
    scene_builder *const *meshes = s->meshes.items;
    for (size_t i = 0; i < s->models.count; ++i) scene_free(models[i], s->job->memory);
    for (size_t i = 0; i < s->meshes.count; ++i) scene_builder_close(meshes[i]);
    buffer_free(&s->models);
    buffer_free(&s->meshes);
    name_table_free(&s->model_names);
    name_table_free(&s->mesh_names);
}

// ---- Reading ----

typedef struct file_text { reader read; reader_job job; char *text; } file_text;

static result open_text(const json_entry *e, const json_node *file, const char *path, file_text *out)
{
    *out = (file_text){.read = reader_of_file(path), .job = *e->scene->job};
    const result done = entry_text(e, file, path, &out->text, &out->job.size);
    if (done != RESULT_OK) return done;
    out->job.path = path;
    out->job.text = out->text;
    return RESULT_OK;
}

static void close_text(const file_text *t)
{
    memory_free(t->job.memory, t->text, t->job.size + 1, 1);
}

// ---- Movers' ----

static result read_model(const json_entry *e, const json_node *file, const char *path, scene **out)
{
    const reader read = reader_of_file(path);
    if (read == json_into) return node_fault(file, "a scene cannot move as one; name a mesh or a .map");
    if (!read) return node_fault(file, "unknown kind of mesh; the name must end in .obj, .ply, .off, .stl, .boxes or .map");
    file_text text;
    result done = entry_count_piece(e);
    if (done == RESULT_OK) done = open_text(e, file, path, &text);
    if (done != RESULT_OK) return done;
    done = reader_make_scene(read, &text.job, out);
    close_text(&text);
    return done;
}

result model_find(const json_entry *e, const json_node *file, const scene **out)
{
    json_scene *s = e->scene;
    const char *path;
    scene *fresh;
    result done = entry_file(e, file, &path);
    if (done != RESULT_OK) return done;
    const named *known = name_table_find(&s->model_names, path);
    if (known) {
        *out = ((scene *const *)s->models.items)[known->number];
        return RESULT_OK;
    }
    done = read_model(e, file, path, &fresh);
    if (done != RESULT_OK) return done;
    if (!buffer_append(&s->models, &fresh, 1)) {
        scene_free(fresh, s->job->memory);
        return entry_no_memory(e);
    }
    *out = fresh;
    done = name_table_add(&s->model_names, path, (uint32_t)s->models.count - 1);
    return done == RESULT_OK ? done : entry_no_memory(e);
}

// ---- Static ----

static result read_mesh(const json_entry *e, const json_node *file, const char *path, scene_builder *into)
{
    file_text text;
    result done = open_text(e, file, path, &text);
    if (done != RESULT_OK) return done;
    text.job.builder = into;
    done = text.read(&text.job);
    close_text(&text);
    return done;
}

result mesh_find(const json_entry *e, const json_node *file, const char *path, const scene_builder **out)
{
    json_scene *s = e->scene;
    scene_builder *fresh;
    const named *known = name_table_find(&s->mesh_names, path);
    if (known) {
        *out = ((scene_builder *const *)s->meshes.items)[known->number];
        return RESULT_OK;
    }
    if (scene_builder_open(s->job->memory, &fresh) != RESULT_OK) return entry_no_memory(e);
    const result done = read_mesh(e, file, path, fresh);
    if (done != RESULT_OK || !buffer_append(&s->meshes, &fresh, 1)) {
        scene_builder_close(fresh);
        return done == RESULT_OK ? entry_no_memory(e) : done;
    }
    *out = fresh;
    return name_table_add(&s->mesh_names, path, (uint32_t)s->meshes.count - 1) == RESULT_OK ? RESULT_OK : entry_no_memory(e);
}
