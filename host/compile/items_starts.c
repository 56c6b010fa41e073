// Player starts as views: the camera path "starts", one camera a start in the file's order, at a player's eye and its angle.
// SPDX-License-Identifier: MIT
#include "items.h"

#include "../import/map_entity.h"

#include <math.h>
#include <string.h>

static const double EYE_M = 0.7;                        // above the origin, as the auto views have it
static const double FOVY_DEG = 60, ASPECT = 16.0 / 9, NEAR_M = 1.0 / 16;

static map_word word_of(const char *text)
{
    return (map_word){text, strlen(text)};
}

// What is no number is 0: a start looks somewhere.
static double yaw_of(const compile_entity *e)
{
    double angles[3] = {0}, yaw = 0;
    const char *one = item_key(e, "angle"), *three = item_key(e, "angles");
    if (three && map_word_numbers(word_of(three), angles, 3)) yaw = angles[1];
    if (one && !map_word_numbers(word_of(one), &yaw, 1)) yaw = 0;
    return isfinite(yaw) && yaw != -1 && yaw != -2 ? fmod(yaw, 360) : 0; // those two: up and down
}

static void camera_at(const compile_entity *e, camera *out)
{
    static const double quarters[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const double yaw = yaw_of(e), quarter = floor(yaw / 90), radians = yaw * (3.14159265358979323846 / 180);
    const double *exact = quarter * 90 == yaw ? quarters[((int)quarter + 4) % 4] : NULL;
    *out = (camera){.eye = {e->origin[0], e->origin[1] + EYE_M, e->origin[2]},
                    .up = {0, 1, 0},
                    .fovy_deg = FOVY_DEG,
                    .aspect = ASPECT,
                    .near_m = NEAR_M,
                    .far_m = INFINITY};
    out->forward[0] = exact ? exact[0] : cos(radians);
    out->forward[2] = -(exact ? exact[1] : sin(radians)) + 0.0;
}

result items_starts(item_job *j)
{
    buffer cameras = buffer_make(j->memory, sizeof(camera));
    result done = RESULT_OK;
    for (uint32_t e = 0; e < j->in->entity_count && done == RESULT_OK; ++e) {
        const compile_entity *entity = &j->in->entities[e];
        if (entity->brush_count || !entity->has_origin || entity_place_of(word_of(entity->class_name)) != PLACE_PLAYER) continue;
        camera made;
        camera_at(entity, &made);
        if (!buffer_append(&cameras, &made, 1)) done = RESULT_NO_MEMORY;
    }
    if (done == RESULT_OK && cameras.count) done = scene_builder_camera_path(j->builder, "starts", cameras.items, (uint32_t)cameras.count);
    buffer_free(&cameras);
    return done;
}
