// misc_model entities: meshes of files beside the map, placed, in the clusters that their reader makes of them.
// SPDX-License-Identifier: MIT
// Invariant: a file is read once, however often it stands. Its numbers are map units in the scene's axes, Y up, so that it
// comes out as large as map editors show it; "modelscale" makes it larger.
#include "items.h"

#include "../import/map_entity.h"
#include "../import/name_table.h"
#include "../import/reader.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PATH_BYTES = 1024, LINE_BYTES = 512 };
static const uint64_t SIZE_MOST = (uint64_t)1 << 26; // of all placed models together: triangles, vertices, ...
static const double SCALE_MOST = 1e6;

typedef struct model_shelf {
    item_job *job;
    const compile_entity *entity; // that is being placed
    arena names;
    name_table paths;
    buffer models; // scene_builder *
    uint64_t placed;
} model_shelf;

static result fault(const model_shelf *s, const char *model, const char *what)
{
    return report_error(s->job->report, s->job->in->path, s->entity->line, "the model \"%s\" %s", model, what);
}

static result no_memory(const model_shelf *s)
{
    return report_no_memory(s->job->report, s->job->in->path);
}

// ---- Where it stands ----

// Numbers of a key, or what `out` holds where it is not there.
static result numbers_of(const model_shelf *s, const char *key, int count, double *out)
{
    const char *text = item_key(s->entity, key);
    int good = !text || map_word_numbers((map_word){text, strlen(text)}, out, count);
    for (int i = 0; good && i < count; ++i) good = isfinite(out[i]) && fabs(out[i]) <= SCALE_MOST;
    if (good) return RESULT_OK;
    return report_error(s->job->report, s->job->in->path, s->entity->line, "misc_model: \"%s\" takes %d number%s up to 1e6; repair its value", key,
                        count, count > 1 ? "s" : "");
}

static void turn_of(double angle_deg, double *cosine, double *sine) // quarters exactly
{
    static const double quarters[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const double turn = fmod(angle_deg, 360), quarter = floor(turn / 90);
    const int exact = quarter * 90 == turn;
    *cosine = exact ? quarters[((int)quarter + 4) % 4][0] : cos(turn * (3.14159265358979323846 / 180));
    *sine = exact ? quarters[((int)quarter + 4) % 4][1] : sin(turn * (3.14159265358979323846 / 180));
}

// In the map's axes: roll about x, then pitch about y (nose down), then yaw about z.
static void rotation_of(const double pitch_yaw_roll[3], double r[3][3])
{
    double cp, sp, cy, sy, cr, sr;
    turn_of(pitch_yaw_roll[0], &cp, &sp);
    turn_of(pitch_yaw_roll[1], &cy, &sy);
    turn_of(pitch_yaw_roll[2], &cr, &sr);
    const double rows[3][3] = {{cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr},
                               {sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr},
                               {-sp, cp * sr, cp * cr}};
    memcpy(r, rows, sizeof rows);
}

static result transform_of(const model_shelf *s, builder_transform *out)
{
    static const struct { int axis; double sign; } scene[3] = {{0, 1}, {2, 1}, {1, -1}}; // a scene axis in the map's
    double angles[3] = {0}, scale = 1, r[3][3];
    result done = numbers_of(s, "angles", 3, angles);
    if (done == RESULT_OK) done = numbers_of(s, "angle", 1, &angles[1]);
    if (done == RESULT_OK) done = numbers_of(s, "modelscale", 1, &scale);
    if (done != RESULT_OK) return done;
    if (!(scale >= 1 / SCALE_MOST))
        return report_error(s->job->report, s->job->in->path, s->entity->line,
                            "misc_model: \"modelscale\" takes a number from 1e-6 on; repair its value");
    rotation_of(angles, r);
    for (int a = 0; a < 3; ++a) {
        for (int c = 0; c < 3; ++c)
            out->rows[a][c] = scale / ITEM_UNITS_PER_METRE * (scene[a].sign * scene[c].sign * r[scene[a].axis][scene[c].axis]) + 0.0;
        out->rows[a][3] = s->entity->origin[a];
    }
    return RESULT_OK;
}

// ---- Its file ----

static reader mesh_reader_of(const char *path)
{
    const reader read = reader_of_file(path);
    return read == obj_into || read == ply_into || read == off_into || read == stl_into ? read : NULL;
}

static void keep_line(void *user, report_level level, const char *text)
{
    if (level == REPORT_ERROR) snprintf(user, LINE_BYTES, "%s", text);
}

// What is wrong with a file that cannot be read is told at the entity that names it.
static result read_text(const model_shelf *s, const char *path, char **text, size_t *size)
{
    static const char before[] = ": error: ";
    char line[LINE_BYTES] = "", what[LINE_BYTES];
    report kept = {.line = keep_line, .user = line};
    const result done = reader_text(NULL, path, s->job->memory, &kept, text, size);
    if (done == RESULT_OK) return done;
    if (done == RESULT_NO_MEMORY) return no_memory(s);
    const char *why = strstr(line, before);
    snprintf(what, sizeof what, "does not come: %s", why ? why + sizeof before - 1 : "it cannot be read; check the name");
    return fault(s, path, what);
}

static result read_model(const model_shelf *s, const char *path, scene_builder *into)
{
    static const import_options as_it_is = {DOORS_OPEN};
    char *text = NULL;
    reader_job job = {.path = path, .options = &as_it_is, .memory = s->job->memory, .report = s->job->report, .builder = into};
    result done = read_text(s, path, &text, &job.size);
    if (done != RESULT_OK) return done;
    job.text = text;
    done = mesh_reader_of(path)(&job);
    memory_free(s->job->memory, text, job.size + 1, 1);
    return done;
}

static result open_model(model_shelf *s, const char *path, scene_builder **out)
{
    scene_builder *fresh;
    if (scene_builder_open(s->job->memory, &fresh) != RESULT_OK) return no_memory(s);
    const result done = read_model(s, path, fresh);
    const char *name = done == RESULT_OK ? arena_text(&s->names, path, strlen(path)) : NULL;
    if (!name || !buffer_append(&s->models, &fresh, 1)) {
        scene_builder_close(fresh);
        return done == RESULT_OK ? no_memory(s) : done;
    }
    *out = fresh;
    return name_table_add(&s->paths, name, (uint32_t)s->models.count - 1) == RESULT_OK ? RESULT_OK : no_memory(s);
}

static result find_model(model_shelf *s, const char *model, scene_builder **out)
{
    char path[PATH_BYTES];
    const char *map = s->job->in->path, *slash = strrchr(map, '/');
    const int length = snprintf(path, sizeof path, "%.*s%s", slash && *model != '/' ? (int)(slash - map) + 1 : 0, map, model);
    if (length < 0 || length >= PATH_BYTES) return fault(s, "", "has a path of over 1023 bytes; shorten it");
    if (!mesh_reader_of(path)) return fault(s, model, "is of no kind that is read here; its name must end in .obj, .ply, .off or .stl");
    const named *known = name_table_find(&s->paths, path);
    if (!known) return open_model(s, path, out);
    *out = ((scene_builder *const *)s->models.items)[known->number];
    return RESULT_OK;
}

// ---- Placing ----

static result place_model(model_shelf *s)
{
    const char *model = item_key(s->entity, "model");
    scene_builder *from = NULL;
    builder_transform place;
    if (!model || !*model) return fault(s, "", "is not named; give the misc_model a key \"model\", a file relative to the map's folder");
    if (!s->entity->has_origin) return fault(s, model, "has no place; give the misc_model an \"origin\"");
    result done = transform_of(s, &place);
    if (done == RESULT_OK) done = find_model(s, model, &from);
    if (done != RESULT_OK) return done;
    s->placed += scene_builder_size(from);
    if (s->placed > SIZE_MOST) return fault(s, model, "is one too many: all together have over 2^26 triangles or vertices; place fewer");
    done = scene_builder_transform(s->job->builder, &place);
    if (done == RESULT_OK) done = scene_builder_append(s->job->builder, from);
    scene_builder_transform_end(s->job->builder);
    if (done == RESULT_NO_MEMORY) return no_memory(s);
    return done == RESULT_OK ? done : fault(s, model, "makes over 65,535 materials or 2^32 of anything; use fewer models");
}

result items_models(item_job *j)
{
    model_shelf s = {
        .job = j, .names = arena_make(j->memory), .paths = name_table_make(j->memory), .models = buffer_make(j->memory, sizeof(scene_builder *))};
    result done = RESULT_OK;
    for (uint32_t e = 0; e < j->in->entity_count && done == RESULT_OK; ++e) {
        s.entity = &j->in->entities[e];
        if (map_word_is((map_word){s.entity->class_name, strlen(s.entity->class_name)}, "misc_model") && s.entity->brush_count == 0)
            done = place_model(&s);
    }
    scene_builder *const *models = s.models.items;
    for (size_t i = 0; i < s.models.count; ++i) scene_builder_close(models[i]);
    buffer_free(&s.models);
    name_table_free(&s.paths);
    arena_free(&s.names);
    return done;
}
