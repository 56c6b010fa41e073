// Files of movers, each read once, as a scene of its own.
// SPDX-License-Identifier: MIT
#include "json_scene.h"

#include <string.h>

typedef struct model { const char *path; scene *scene; } model;

buffer models_make(const allocator *memory)
{
    return buffer_make(memory, sizeof(model));
}

void models_free(json_scene *s)
{
    const model *models = s->models.items;
    for (size_t i = 0; i < s->models.count; ++i) scene_free(models[i].scene, s->job->memory);
    buffer_free(&s->models);
}

static result read_model(const json_entry *e, const json_node *file, model *m)
{
    const reader read = reader_of_file(m->path);
    if (read == json_into) return node_fault(file, "a scene cannot move as one; name a mesh or a .map");
    if (!read) return node_fault(file, "unknown kind of mesh; the name must end in .obj, .ply, .off, .stl, .boxes or .map");
    reader_job job = *e->scene->job;
    char *text;
    result done = entry_count_piece(e);
    if (done == RESULT_OK) done = entry_text(e, file, m->path, &text, &job.size);
    if (done != RESULT_OK) return done;
    job.path = m->path;
    job.text = text;
    done = reader_make_scene(read, &job, &m->scene);
    memory_free(job.memory, text, job.size + 1, 1);
    return done;
}

result model_find(const json_entry *e, const json_node *file, const scene **out)
{
    model fresh = {0};
    result done = entry_file(e, file, &fresh.path);
    if (done != RESULT_OK) return done;
    const model *models = e->scene->models.items;
    for (size_t i = 0; i < e->scene->models.count; ++i)
        if (strcmp(models[i].path, fresh.path) == 0) {
            *out = models[i].scene;
            return RESULT_OK;
        }
    done = read_model(e, file, &fresh);
    if (done != RESULT_OK) return done;
    *out = fresh.scene;
    if (buffer_append(&e->scene->models, &fresh, 1)) return RESULT_OK;
    scene_free(fresh.scene, e->scene->job->memory);
    return entry_no_memory(e);
}
