// Scenes with zones: see generate_zoned.h.
// SPDX-License-Identifier: MIT
#include "generate_zoned.h"

#include <stdio.h>
#include <string.h>

static const char *name_in_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static void paths_write(zoned_scene *z, json_writer *j)
{
    json_list(j, "paths");
    json_item(j);
    text_add(j->out, "{\"name\": \"walk\", \"views\": [");
    j->is_first = 1;
    path_write_walk(j, &z->walk, z->walk_views ? z->walk_views : PATH_VIEWS);
    text_add(j->out, "]}");
    j->is_first = 0;
    json_item(j);
    text_add(j->out, "{\"name\": \"tour\", \"views\": [");
    j->is_first = 1;
    path_write_tour(j, &(tour_request){.plan = &z->plan, .seed = z->seed, .low = z->tour_low, .high = z->tour_high});
    if (z->paths) z->paths(z, j);
    text_add(j->out, "]}");
    j->is_first = 0;
    json_list_end(j);
}

static void scene_write(zoned_scene *z, const zoned_request *q, text_file *out)
{
    json_writer j;
    json_open(&j, out, q->kind);
    json_mesh(&j, name_in_folder(q->obj_path));
    json_zones(&j, &z->plan);
    json_portals(&j, &z->plan);
    json_doors(&j, &z->plan);
    json_list(&j, "movers");
    json_leaves(&j, &z->plan);
    if (z->movers) z->movers(z, &j);
    json_list_end(&j);
    json_list(&j, "lights");
    if (z->lights) z->lights(z, &j);
    json_list_end(&j);
    paths_write(z, &j);
    json_close(&j);
}

result zoned_write(const zoned_request *q, const allocator *memory, report *r)
{
    zoned_scene z = {.memory = memory, .size = q->size, .seed = q->seed, .plan = plan_open(memory), .geometry = text_open(memory),
                     .walk = path_open(memory)};
    text_file json = text_open(memory);
    q->fill(&z);
    if (z.plan.failed || z.geometry.failed || z.walk.failed) json.failed = 1;
    else scene_write(&z, q, &json);
    if (json.failed) z.geometry.failed = 1;
    plan_free(&z.plan);
    path_free(&z.walk);
    const result done = text_close(&z.geometry, q->obj_path, r);
    if (done != RESULT_OK) {
        text_free(&json);
        return done;
    }
    const result done_too = text_close(&json, q->json_path, r);
    if (done_too != RESULT_OK) remove(q->obj_path);
    return done_too;
}
