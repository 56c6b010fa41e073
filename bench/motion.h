// Motion: where movers are in each view of a path, from the scene alone. View i is at time i/30 s.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_MOTION_H
#define PORTCULLIS_BENCH_MOTION_H

#include "../host/render/render.h"

typedef struct motion {
    const scene *scene;
    const allocator *memory;
    const door_state *doors; // of all doors; NULL: at rest
    scene_pose *poses;       // scene.mover_count
} motion;

// [any thread] Everything is borrowed. RESULT_NO_MEMORY leaves nothing.
result motion_open(const scene *s, const door_state *doors, const allocator *memory, motion *out);
void motion_close(motion *m); // zeroed is fine

double motion_time_s(uint32_t view);
door_state motion_door(const motion *m, uint32_t door);
void motion_find(motion *m, uint32_t view); // poses of that view, into m->poses
// [main] The same, and to the renderer.
void motion_show(motion *m, uint32_t view, renderer *g);

#endif
