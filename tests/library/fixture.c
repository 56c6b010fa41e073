// A small scene file for the tests of the application's API: see fixture.h.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Two rooms of 8 m x 3 m x 8 m with closed walls, the door's hole in the middle of the wall between them, a crate in each.
static const char scene_text[] =
    "{\"portcullis\": 1, \"name\": \"api\",\n"
    " \"walls\": [\n"
    "  {\"points\": [[0,0,0],[0,0,8],[16,0,8],[16,0,0]], \"material\": \"floor\"},\n"
    "  {\"points\": [[0,3,0],[16,3,0],[16,3,8],[0,3,8]], \"material\": \"ceiling\"},\n"
    "  {\"points\": [[0,0,0],[16,0,0],[16,3,0],[0,3,0]], \"material\": \"wall\"},\n"
    "  {\"points\": [[0,0,8],[0,3,8],[16,3,8],[16,0,8]], \"material\": \"wall\"},\n"
    "  {\"points\": [[0,0,0],[0,3,0],[0,3,8],[0,0,8]], \"material\": \"wall\"},\n"
    "  {\"points\": [[16,0,0],[16,0,8],[16,3,8],[16,3,0]], \"material\": \"wall\"},\n"
    "  {\"points\": [[8,0,0],[8,0,3],[8,3,3],[8,3,0]], \"material\": \"wall\"},\n"
    "  {\"points\": [[8,0,5],[8,0,8],[8,3,8],[8,3,5]], \"material\": \"wall\"},\n"
    "  {\"points\": [[8,2,3],[8,2,5],[8,3,5],[8,3,3]], \"material\": \"wall\"}],\n"
    " \"boxes\": [\n"
    "  {\"min\": [1,0,3.5], \"max\": [2,1,4.5], \"material\": \"crate\"},\n"
    "  {\"min\": [14,0,3.5], \"max\": [15,1,4.5], \"material\": \"crate\"},\n"
    "  {\"min\": [20,0,0], \"max\": [22,2,2], \"material\": \"rock\"}],\n"
    " \"zones\": [\n"
    "  {\"name\": \"open\"},\n"
    "  {\"name\": \"hall\", \"box\": [[0,0,0],[8,3,8]], \"in\": \"open\", \"chain\": \"brute\"},\n"
    "  {\"name\": \"kitchen\", \"box\": [[8,0,0],[16,3,8]], \"in\": \"open\"}],\n"
    " \"movers\": [{\"name\": \"leaf\", \"box\": {\"min\": [7.95,0,3], \"max\": [8.05,2,5], \"material\": \"wood\"}, \"open\": [0,2,0]}],\n"
    " \"doors\": [{\"name\": \"door\", \"open\": false, \"mover\": \"leaf\"}],\n"
    " \"portals\": [{\"name\": \"doorway\", \"zones\": [\"hall\", \"kitchen\"], \"points\": [[8,0,3],[8,2,3],[8,2,5],[8,0,5]], \"door\": \"door\"}]\n"
    "}\n";

static void keep_line(void *user, cull_log_level level, const char *line)
{
    api_bed *b = user;
    const size_t used = strlen(b->log);
    snprintf(b->log + used, sizeof b->log - used, "%d: %s\n", (int)level, line);
}

int api_bed_open(void **state)
{
    static const char *folders[] = {PLUGIN_FOLDER};
    api_bed *b = calloc(1, sizeof *b);
    if (!b) return 1;
    scratch_folder_make(&b->folder);
    scratch_folder_name(&b->folder, "api.json", b->path, sizeof b->path);
    scratch_folder_write(&b->folder, "api.json", scene_text, sizeof scene_text - 1);
    b->options = (cull_scene_options){
        .struct_size = sizeof b->options, .more_movers = 100, .plugin_folders = folders, .plugin_folder_count = 1, .log = keep_line, .user = b};
    *state = b;
    if (cull_scene_open(b->path, &b->options, &b->scene) != CULL_OK || cull_scene_view_open(b->scene, &b->view) != CULL_OK) {
        fprintf(stderr, "%s", b->log);
        return 1;
    }
    return 0;
}

int api_bed_close(void **state)
{
    api_bed *b = *state;
    cull_scene_close(b->scene);
    scratch_folder_remove(&b->folder);
    free(b);
    return 0;
}

cull_camera api_camera(double x, double z, double yaw_deg)
{
    const double yaw = yaw_deg * 3.14159265358979323846 / 180;
    return (cull_camera){.struct_size = sizeof(cull_camera),
                         .eye = {x, 1.6, z},
                         .forward = {sin(yaw), 0, -cos(yaw)},
                         .up = {0, 1, 0},
                         .fovy_deg = 60,
                         .aspect = 1.5,
                         .near_m = 0.0625,
                         .far_m = 1000,
                         .width_px = 600,
                         .height_px = 400,
                         .purpose = CULL_VIEW_MAIN};
}

int api_sees_item_at(const api_bed *b, const cull_visible *seen, const double p[3])
{
    int found = 0;
    for (uint32_t z = 0; z < seen->zone_count; ++z) {
        const cull_zone_runs *zone = &seen->zones[z];
        const uint32_t count = cull_scene_zone_item_count(b->scene, zone->zone);
        uint32_t *order = calloc(count + 1, sizeof *order);
        assert_non_null(order);
        cull_scene_order(b->scene, zone->zone, order);
        for (uint32_t r = 0; r < zone->run_count; ++r)
            for (uint32_t place = zone->runs[r].first; place < zone->runs[r].first + zone->runs[r].count; ++place) {
                cull_scene_item item = {.struct_size = sizeof item};
                assert_true(place < count);
                assert_int_equal(cull_scene_item_get(b->scene, order[place], &item), CULL_OK);
                int inside = 1;
                for (int k = 0; k < 3; ++k) inside &= item.min[k] <= p[k] && p[k] <= item.max[k];
                found |= inside;
            }
        free(order);
    }
    return found;
}
