// Motion: see motion.h. The world has poses of its own: comparing pictures with its sets compares both.
// SPDX-License-Identifier: MIT
#include "motion.h"

result motion_open(const scene *s, const door_state *doors, const allocator *memory, motion *out)
{
    *out = (motion){.scene = s, .doors = doors, .memory = memory};
    if (s->mover_count) out->poses = memory_alloc_zeroed(memory, s->mover_count, sizeof *out->poses);
    return s->mover_count && !out->poses ? RESULT_NO_MEMORY : RESULT_OK;
}

void motion_close(motion *m)
{
    if (m->poses) memory_free(m->memory, m->poses, m->scene->mover_count, sizeof *m->poses);
    *m = (motion){0};
}

double motion_time_s(uint32_t view)
{
    return view / 30.0;
}

door_state motion_door(const motion *m, uint32_t door)
{
    return m->doors ? *m->doors : m->scene->doors[door].at_rest;
}

void motion_find(motion *m, uint32_t view)
{
    const scene *s = m->scene;
    for (uint32_t i = 0; i < s->mover_count; ++i) {
        const uint32_t door = s->movers[i].door;
        scene_pose_at(s, i, motion_time_s(view), door == SCENE_NONE ? DOORS_OPEN : motion_door(m, door), &m->poses[i]);
    }
}

void motion_show(motion *m, uint32_t view, renderer *g)
{
    motion_find(m, view);
    if (m->scene->mover_count) renderer_poses(g, m->poses);
}
