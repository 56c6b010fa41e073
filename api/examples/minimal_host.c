// The least host: opens a scene, looks from a corner of it in turn, opens a door, swaps a culler, and prints what is seen.
// SPDX-License-Identifier: MIT
// Build: cc minimal_host.c $(pkg-config --cflags --libs portcullis). Run: ./a.out scene.json
#include <portcullis/scene.h>

#include <stdio.h>
#include <stdlib.h>

static cull_camera camera_at(const cull_scene_info *info, uint32_t turn)
{
    static const double ways[4][3] = {{1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}};
    cull_camera c = {.struct_size = sizeof c, .up = {0, 1, 0}, .fovy_deg = 60, .aspect = 16.0 / 9, .near_m = 0.0625, .far_m = 1000};
    c.width_px = 1280;
    c.height_px = 720;
    c.purpose = CULL_VIEW_MAIN;
    for (int k = 0; k < 3; ++k) {
        c.eye[k] = (info->min[k] + info->max[k]) / 2;
        c.forward[k] = ways[turn][k];
    }
    return c;
}

static void print_seen(const cull_scene *scene, const cull_visible *seen)
{
    printf("%llu items of %u zones, %u movers, %.1f us\n", (unsigned long long)seen->items, seen->zone_count, seen->mover_count, seen->cull_ns / 1000);
    for (uint32_t z = 0; z < seen->zone_count; ++z) { // a renderer draws these runs: item = order[place], first .. first + count - 1
        uint32_t items = 0;
        for (uint32_t i = 0; i < seen->zones[z].run_count; ++i) items += seen->zones[z].runs[i].count;
        printf("  %-20s %6u items in %u runs\n", cull_scene_zone_name(scene, seen->zones[z].zone), items, seen->zones[z].run_count);
    }
}

int main(int argc, char **argv)
{
    const cull_scene_options options = {.struct_size = sizeof options, .more_movers = 1};
    cull_scene_info info = {.struct_size = sizeof info};
    cull_scene *scene;
    cull_scene_view *view;
    uint32_t mover;
    if (argc < 2 || cull_scene_open(argv[1], &options, &scene) != CULL_OK) return EXIT_FAILURE; // a line on stderr says why
    cull_scene_describe(scene, &info);
    const cull_camera first = camera_at(&info, 0);
    if (cull_scene_view_open(scene, &view) != CULL_OK || cull_scene_mover_add(scene, first.eye, first.eye, &mover) != CULL_OK) return EXIT_FAILURE;
    for (uint32_t frame = 0; frame < 8; ++frame) {
        cull_visible seen = {.struct_size = sizeof seen};
        const cull_camera camera = camera_at(&info, frame % 4);
        if (frame == 4) { // between two frames anything may change
            for (uint32_t d = 0; d < info.door_count; ++d) cull_scene_set_door(scene, d, 1);
            if (cull_scene_set_chain(scene, 0, "brute") != CULL_OK) return EXIT_FAILURE;
        }
        if (cull_scene_cull(view, &camera, &seen) != CULL_OK) return EXIT_FAILURE;
        print_seen(scene, &seen);
    }
    cull_scene_close(scene); // its views too
    return EXIT_SUCCESS;
}
