// The compiler's input from a JSON scene: brushes, points that name zones, starts; all else into a builder beside them.
// SPDX-License-Identifier: MIT
#include "input_json.h"

#include <string.h>

// ---- Entities ----

result json_entity_add(json_input *j, const compile_entity *like, uint32_t door, uint32_t *out)
{
    *out = (uint32_t)j->draft.entities.count;
    return buffer_append(&j->draft.entities, like, 1) && buffer_append(&j->doors, &door, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static result add_point(const json_entry *e, compile_entity *made, const double at[3])
{
    json_input *j = e->scene->user;
    const builder_transform *place = &e->document->place;
    uint32_t number;
    made->has_origin = 1;
    made->first_brush = (uint32_t)j->draft.brushes.count;
    for (int k = 0; k < 3; ++k) {
        const double *row = place->rows[k];
        made->origin[k] = ((row[0] * at[0] + row[1] * at[1]) + row[2] * at[2]) + row[3];
    }
    return json_entity_add(j, made, SCENE_NONE, &number) == RESULT_OK ? RESULT_OK : entry_no_memory(e);
}

// Keys and values, as a map's entity would have them.
static result give_keys(const json_entry *e, compile_entity *made, const char *const *keys, uint32_t pairs)
{
    json_input *j = e->scene->user;
    const char **to = arena_push(&j->draft.in->memory, 2 * (size_t)pairs + 1, sizeof *to);
    if (!to) return entry_no_memory(e);
    for (uint32_t i = 0; i < 2 * pairs; ++i) {
        to[i] = arena_text(&j->draft.in->memory, keys[i], strlen(keys[i]));
        if (!to[i]) return entry_no_memory(e);
    }
    made->keys = to;
    made->key_count = pairs;
    return RESULT_OK;
}

static result read_zone_info(const json_entry *e)
{
    static const char *const known[] = {"name", "at", "chain", NULL};
    json_node at_node;
    double at[3];
    const char *name = NULL, *chain = NULL;
    compile_entity made = {.class_name = "zone_info"};
    result done = node_object(&e->node, known);
    if (done == RESULT_OK) done = entry_new_name(e, &e->scene->zones, "zone", 0, &name);
    if (done == RESULT_OK) done = node_need(&e->node, "at", &at_node);
    if (done == RESULT_OK) done = node_numbers(&at_node, 3, at);
    if (done == RESULT_OK) done = entry_chain(e, &chain);
    if (done != RESULT_OK) return done;
    const char *const keys[] = {"name", name, "chain", chain};
    done = give_keys(e, &made, keys, chain ? 2 : 1);
    return done == RESULT_OK ? add_point(e, &made, at) : done;
}

static result read_start(const json_entry *e)
{
    static const char *const known[] = {"name", "at", NULL};
    json_node at_node;
    double at[3];
    const char *name;
    compile_entity made = {.class_name = "info_player_start"};
    result done = node_object(&e->node, known);
    if (done == RESULT_OK) done = node_maybe_text(&e->node, "name", &name);
    if (done == RESULT_OK) done = node_need(&e->node, "at", &at_node);
    if (done == RESULT_OK) done = node_numbers(&at_node, 3, at);
    return done == RESULT_OK ? add_point(e, &made, at) : done;
}

// ---- All of it ----

static result read_all(json_scene *s)
{
    json_input *j = s->user;
    j->scene = s;
    result done = json_brushes_read(j);
    if (done == RESULT_OK) done = entries_read(s, "zone_info", read_zone_info);
    if (done == RESULT_OK) done = entries_read(s, "starts", read_start);
    return done;
}

static result finish(json_input *j, scene_builder *beside, compile_input **out)
{
    compile_input *in = j->draft.in;
    in->portal_doors = arena_push(&in->memory, j->doors.count + 1, sizeof *in->portal_doors);
    if (!in->portal_doors) return report_no_memory(j->draft.report, j->draft.path);
    if (j->doors.count) memcpy(in->portal_doors, j->doors.items, j->doors.count * sizeof *in->portal_doors);
    const result done = input_draft_finish(&j->draft, out);
    if (done == RESULT_OK) (*out)->beside = beside;
    return done;
}

result compile_input_json(const char *path, const char *text, size_t size, const input_options *o, const import_files *files, const allocator *memory,
                          report *r, compile_input **out)
{
    static const import_options as_the_file_says = {DOORS_OPEN};
    json_input j = {.doors = buffer_make(memory, sizeof(uint32_t)), .faces = buffer_make(memory, sizeof(compile_face))};
    reader_job job = {.path = path, .text = text, .size = size, .options = &as_the_file_says, .files = files, .memory = memory, .report = r};
    const json_more more = {read_all, &j};
    result done = input_draft_open(path, o, memory, r, &j.draft);
    if (done == RESULT_OK && scene_builder_open(memory, &job.builder) != RESULT_OK) done = report_no_memory(r, path);
    if (done == RESULT_OK) done = json_beside(&job, &more);
    if (done == RESULT_OK) done = finish(&j, job.builder, out);
    if (done != RESULT_OK) scene_builder_close(job.builder);
    input_draft_close(&j.draft);
    buffer_free(&j.doors);
    buffer_free(&j.faces);
    return done;
}
