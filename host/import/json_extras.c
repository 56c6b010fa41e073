// Lights and camera paths of a JSON scene.
// SPDX-License-Identifier: MIT
#include "json_scene.h"

#include "views.h"

#include <math.h>
#include <string.h>

enum { VIEWS_MOST = 100000 };
static const double REACH_MOST = 1e9, COLOUR_MOST = 1e6; // metres; of a colour only that it stays finite

// ---- Lights ----

static result read_light(const json_entry *e)
{
    static const char *const keys[] = {"name", "kind", "at", "direction", "reach", "colour", NULL}, *const kinds[] = {"point", "sun", NULL};
    json_node kind, n;
    size_t chosen = 0;
    double colour[3] = {1, 1, 1};
    const char *name = "light";
    scene_light light = {.reach = 10, .direction = {0, -1, 0}};
    result done = node_object(&e->node, keys);
    if (done == RESULT_OK) done = node_maybe_text(&e->node, "name", &name);
    if (done == RESULT_OK) done = entry_name(e, name, &light.name);
    if (done == RESULT_OK) done = node_need(&e->node, "kind", &kind);
    if (done == RESULT_OK) done = node_choice(&kind, kinds, &chosen);
    light.kind = chosen ? LIGHT_SUN : LIGHT_POINT;
    if (done == RESULT_OK) done = node_need(&e->node, light.kind == LIGHT_SUN ? "direction" : "at", &n);
    if (done == RESULT_OK) done = node_maybe_vector(&e->node, "at", light.position);
    if (done == RESULT_OK) done = node_maybe_vector(&e->node, "direction", light.direction);
    if (done == RESULT_OK) done = node_maybe_number(&e->node, "reach", 0, REACH_MOST, &light.reach);
    if (done == RESULT_OK) done = node_maybe_vector(&e->node, "colour", colour);
    if (done != RESULT_OK) return done;
    for (int k = 0; k < 3; ++k) {
        if (!(colour[k] >= 0 && colour[k] <= COLOUR_MOST)) return node_fault(&e->node, "a colour is three numbers from 0 to 1e6; correct it");
        light.colour[k] = (float)colour[k];
    }
    const double *d = light.direction;
    if (d[0] == 0 && d[1] == 0 && d[2] == 0) return node_fault(&n, "a direction of no length; write where the light goes");
    return entry_told(e, scene_builder_light(e->scene->job->builder, &light), "light", NULL);
}

result lights_read(json_scene *s)
{
    return entries_read(s, "lights", read_light);
}

// ---- Camera paths ----

static result read_far(const json_node *view, double *out)
{
    json_node n;
    if (!node_find(view, "far", &n)) return RESULT_OK;
    if (!json_is_string(n.value)) return node_number(&n, 0, 1e30, out);
    if (strcmp(json_string_value(n.value), "inf") != 0) return node_fault(&n, "far is a number of metres or \"inf\"; correct it");
    *out = INFINITY;
    return RESULT_OK;
}

static result read_view(const json_node *n, camera *out)
{
    static const char *const keys[] = {"eye", "forward", "up", "fovy", "aspect", "near", "far", NULL};
    json_node eye, forward;
    *out = (camera){.up = {0, 1, 0}, .fovy_deg = 60, .aspect = 16.0 / 9.0, .near_m = 1.0 / 16, .far_m = 1000};
    result done = node_object(n, keys);
    if (done == RESULT_OK) done = node_need(n, "eye", &eye);
    if (done == RESULT_OK) done = node_numbers(&eye, 3, out->eye);
    if (done == RESULT_OK) done = node_need(n, "forward", &forward);
    if (done == RESULT_OK) done = node_numbers(&forward, 3, out->forward);
    if (done == RESULT_OK) done = node_maybe_vector(n, "up", out->up);
    if (done == RESULT_OK) done = node_maybe_number(n, "fovy", 0, 180, &out->fovy_deg);
    if (done == RESULT_OK) done = node_maybe_number(n, "aspect", 0, 1e9, &out->aspect);
    if (done == RESULT_OK) done = node_maybe_number(n, "near", 0, 1e30, &out->near_m);
    if (done == RESULT_OK) done = read_far(n, &out->far_m);
    if (done != RESULT_OK) return done;
    const char *wrong = camera_fault(out);
    return wrong ? node_fault(n, "%s; correct the view", wrong) : RESULT_OK;
}

static result add_path(const json_entry *e, const char *name, const camera *cameras, uint32_t count)
{
    return entry_told(e, scene_builder_camera_path(e->scene->job->builder, name, cameras, count), "path", NULL);
}

static result read_views(const json_entry *e, const json_node *list, const char *name)
{
    size_t count = 0;
    result done = node_array(list, 1, VIEWS_MOST, &count);
    if (done != RESULT_OK) return done;
    camera *cameras = memory_alloc(e->scene->job->memory, count, sizeof *cameras);
    if (!cameras) return entry_no_memory(e);
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) {
        const json_node view = node_item(list, i);
        done = read_view(&view, &cameras[i]);
    }
    if (done == RESULT_OK) done = add_path(e, name, cameras, (uint32_t)count);
    memory_free(e->scene->job->memory, cameras, count, sizeof *cameras);
    return done;
}

static result read_file(const json_entry *e, const json_node *file, const char *name)
{
    const reader_job *job = e->scene->job;
    const char *path;
    char *text;
    size_t size;
    camera_path cameras;
    result done = entry_file(e, file, &path);
    if (done == RESULT_OK) done = entry_count_piece(e);
    if (done == RESULT_OK) done = entry_text(e, file, path, &text, &size);
    if (done != RESULT_OK) return done;
    done = camera_path_parse(path, text, size, job->memory, job->report, &cameras);
    memory_free(job->memory, text, size + 1, 1);
    if (done != RESULT_OK) return done;
    done = add_path(e, name, cameras.cameras, cameras.count);
    camera_path_free(&cameras, job->memory);
    return done;
}

static result read_path(const json_entry *e)
{
    static const char *const keys[] = {"name", "views", "file", NULL};
    json_node views, file;
    const char *name;
    result done = node_object(&e->node, keys);
    if (done == RESULT_OK) done = entry_new_name(e, &e->scene->paths, "path", 0, &name);
    if (done != RESULT_OK) return done;
    const int has_views = node_find(&e->node, "views", &views), has_file = node_find(&e->node, "file", &file);
    if (has_views == has_file) return node_fault(&e->node, "the path needs either \"views\" or \"file\"; write one of them");
    return has_views ? read_views(e, &views, name) : read_file(e, &file, name);
}

result paths_read(json_scene *s)
{
    return entries_read(s, "paths", read_path);
}
