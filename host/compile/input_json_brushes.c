// The brushes of a JSON scene into the draft, in the order of the files: an included file's before those of what includes it.
// SPDX-License-Identifier: MIT
// Invariant: a brush of an entity lies next to its others; nameless brushes that follow each other are one entity.
#include "input_json.h"

#include "../import/map_texture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WHERE_BYTES = 64 };
static const double BOUND_METRES = 1, STEEP = 0.5; // half spaces reach so far beyond all else; a face steeper than 45 degrees is a wall

static json_input *input_of(const json_entry *e)
{
    return e->scene->user;
}

// ---- Bounds ----

static result take_bounds(const json_entry *e)
{
    json_input *j = input_of(e);
    json_brush brush;
    primitive solid;
    const result done = json_brush_read(e, j->draft.in->steps_per_metre, &brush, &solid);
    for (int k = 0; k < 3 && done == RESULT_OK; ++k) {
        j->low[k] = fmin(j->low[k], solid.low[k]);
        j->high[k] = fmax(j->high[k], solid.high[k]);
    }
    primitive_free(&solid);
    return done;
}

// ---- Faces ----

// Rows in metres of the scene: upright on walls, along x and z on floors. Of the plane alone, so that faces of several
// brushes in one plane go on in each other.
static void texture_rows(const json_brush *b, const cull_wide_plane *plane, double rows[2][4])
{
    double n[3], u[3] = {1, 0, 0}, v[3] = {0, 0, 1};
    for (int k = 0; k < 3; ++k) n[k] = (double)plane->normal[k];
    const double level = n[0] * n[0] + n[2] * n[2], all = level + n[1] * n[1];
    if (level > STEEP * all) {
        const double along = sqrt(level), length = sqrt(all);
        u[0] = n[2] / along;
        u[2] = -n[0] / along;
        for (int k = 0; k < 3; ++k) v[k] = n[1] * n[k] / (length * along); // down the wall
        v[1] -= length / along;
    }
    for (int k = 0; k < 3; ++k) {
        rows[0][k] = u[k] / b->texture_scale + 0.0;
        rows[1][k] = v[k] / b->texture_scale + 0.0;
    }
    rows[0][3] = b->texture_offset[0];
    rows[1][3] = b->texture_offset[1];
}

static result make_faces(const json_entry *e, const json_brush *b, const primitive *solid, uint32_t line)
{
    json_input *j = input_of(e);
    const map_word name = {b->material, strlen(b->material)};
    const texture_kind kind = texture_kind_of(name);
    const int makes_nothing = kind == TEXTURE_TOOL || b->operation == OPERATION_PORTAL;
    const cull_wide_plane *planes = solid->planes.items;
    uint32_t material = COMPILE_NOTHING;
    if (!makes_nothing) {
        material = input_draft_material(&j->draft, name.text, name.length, texture_material_flags(kind));
        if (material == UINT32_MAX) return entry_no_memory(e);
    }
    j->faces.count = 0;
    compile_face *faces = buffer_push(&j->faces, solid->planes.count);
    if (!faces) return entry_no_memory(e);
    for (size_t i = 0; i < solid->planes.count; ++i) {
        faces[i] = (compile_face){.plane = plane_table_add(j->draft.in->planes, &planes[i]), .material = material, .line = line};
        if (faces[i].plane == PLANE_NONE) return entry_no_memory(e);
        texture_rows(b, &planes[i], faces[i].texture);
    }
    return RESULT_OK;
}

// ---- Entities ----

static const char *copied(json_input *j, const char *text)
{
    return arena_text(&j->draft.in->memory, text, strlen(text));
}

static result open_entity(const json_entry *e, const json_brush *b, uint32_t line, uint32_t *out)
{
    json_input *j = input_of(e);
    const int is_portal = b->operation == OPERATION_PORTAL, is_run = !b->name && !is_portal;
    if (is_run && j->run != UINT32_MAX) {
        *out = j->run;
        return RESULT_OK;
    }
    compile_entity made = {.class_name = is_portal ? "zone_portal" : j->draft.entities.count ? "func_group" : "worldspawn",
                           .first_brush = (uint32_t)j->draft.brushes.count,
                           .line = line};
    if (b->name && !(made.name = copied(j, b->name))) return entry_no_memory(e);
    const result done = json_entity_add(j, &made, b->door, out);
    j->run = is_run ? *out : UINT32_MAX;
    return done == RESULT_NO_MEMORY ? entry_no_memory(e) : done;
}

// ---- One brush ----

static uint32_t line_of(const json_entry *e)
{
    json_input *j = input_of(e);
    const json_file *file = &e->document->file;
    if (e->node.index == 0) j->lines = json_item_lines_of(file->text, file->size, "brushes");
    return (uint32_t)json_item_lines_next(&j->lines);
}

static brush_role role_of(const json_brush *b)
{
    const map_word name = {b->material, strlen(b->material)};
    if (b->operation == OPERATION_PORTAL) return BRUSH_PORTAL;
    return b->operation == OPERATION_ADD && texture_kind_of(name) == TEXTURE_LIQUID ? BRUSH_LIQUID : BRUSH_STRUCTURE;
}

static result bound(const json_entry *e, primitive *solid)
{
    const json_input *j = input_of(e);
    const double margin = BOUND_METRES * solid->steps_per_metre;
    double low[3], high[3];
    for (int k = 0; k < 3; ++k) {
        low[k] = j->low[k] - margin;
        high[k] = j->high[k] + margin;
    }
    return primitive_bound(solid, low, high) == PRIMITIVE_SOUND ? RESULT_OK : entry_no_memory(e);
}

static result add_brush(const json_entry *e, const json_brush *b, const primitive *solid, uint32_t line)
{
    json_input *j = input_of(e);
    uint32_t entity = 0;
    char where[WHERE_BYTES];
    snprintf(where, sizeof where, "/brushes/%zu", e->node.index);
    result done = make_faces(e, b, solid, line);
    if (done == RESULT_OK && b->operation != OPERATION_PORTAL && ((const compile_face *)j->faces.items)->material == COMPILE_NOTHING) {
        j->draft.in->brushes_dropped++;
        return RESULT_OK;
    }
    if (done == RESULT_OK) done = open_entity(e, b, line, &entity);
    if (done != RESULT_OK) return done;
    const compile_brush made = {.entity = entity, .kind = b->operation == OPERATION_SUBTRACT ? BRUSH_SUBTRACT : BRUSH_ADD, .role = role_of(b)};
    brush_verdict verdict;
    j->draft.path = e->document->file.path;
    done = input_draft_brush(&j->draft, &made, j->faces.items, (uint32_t)j->faces.count, where, line, &verdict);
    j->draft.path = j->scene->job->path;
    if (done == RESULT_OK && verdict == BRUSH_TAKEN) ((compile_entity *)j->draft.entities.items)[entity].brush_count++;
    return done;
}

static result take_brush(const json_entry *e)
{
    json_input *j = input_of(e);
    json_brush brush;
    primitive solid;
    const uint32_t line = line_of(e);
    result done = json_brush_read(e, j->draft.in->steps_per_metre, &brush, &solid);
    if (done == RESULT_OK && brush.is_open) done = bound(e, &solid);
    if (done == RESULT_OK) done = add_brush(e, &brush, &solid, line);
    j->draft.in->max_rounding = fmax(j->draft.in->max_rounding, solid.moved / j->draft.grid);
    j->draft.in->points_rounded += solid.moved > 0;
    primitive_free(&solid);
    return done;
}

result json_brushes_read(json_input *j)
{
    for (int k = 0; k < 3; ++k) {
        j->low[k] = INFINITY;
        j->high[k] = -INFINITY;
    }
    j->run = UINT32_MAX;
    const result done = entries_read(j->scene, "brushes", take_bounds);
    return done == RESULT_OK ? entries_read(j->scene, "brushes", take_brush) : done;
}
