// What the files behind api/portcullis/scene.h share: one opened scene with all that it stands on.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_LIBRARY_H
#define PORTCULLIS_HOST_LIBRARY_H

#include "../core/world.h"

#include <portcullis/scene.h>

struct cull_scene {
    const allocator *memory;
    cull_scene_options options; // pointers in it are not kept, but log and user
    report report;
    host_services services;
    arena texts;
    loader *plugins;
    scene *scene;
    world *world;
    cull_scene_view *views; // open ones, by next
};

struct cull_scene_view {
    cull_scene *owner;
    world_view *view;
    cull_zone_runs *zones; // scene.zone_count
    camera camera;         // of the last frame, for explain
    frame_input input;
    uint32_t frame;
    cull_scene_view *next;
};

cull_result library_result(result done); // what the API returns for it

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
// One line to the scene's log, from any thread; returns `code`. scene NULL: to stderr.
cull_result
library_refuse(const cull_scene *scene, cull_result code, const char *format, ...);

#endif
