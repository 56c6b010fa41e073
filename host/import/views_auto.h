// Automatic views: where an eye may stand, and the cameras made of such places. Between views_auto.c, views_walk.c,
// views_roofs.c and views_edges.c.
// SPDX-License-Identifier: MIT
// Invariant: nothing but constants and the scene's own data enters, so the same scene gives the same views; and of the
// movers only their solids, which stand both shut and open, so doors change no view.
#ifndef PORTCULLIS_HOST_VIEWS_AUTO_H
#define PORTCULLIS_HOST_VIEWS_AUTO_H

#include "views.h"
#include "views_random.h"
#include "views_space.h"

#define AUTO_CLEARANCE_M 0.125 // 4 units: the near plane's corner at 16:9 is 0.1 m from the eye
#define AUTO_NEAR_M 0.0625       // smaller scenes are looked at from far enough not to be swallowed
#define AUTO_EYE_HEIGHT_M 1.7
#define AUTO_STEP_M 0.3 // of a walk, a frame
#define AUTO_DRIVE_STEP_M 1.0
#define AUTO_CAR_EYE_HEIGHT_M 1.2

typedef struct eye { double at[3]; } eye; // relative to auto_views.origin

typedef struct auto_views {
    const scene *scene;
    const allocator *memory;
    report *report;
    free_space *space;
    double origin[3];       // world: the zone's, but for a scene of movers one that they don't shift
    double low[3], high[3]; // of everything, movers in all their places
    double aspect;
    random_stream random;
    buffer places; // eye: of point entities in air, shuffled
    int has_boxes, has_meshes; // items that are boxes, and others
    int looks_from_afar; // tiny, flat, or without a place to stand: the eyes are set back from it
} auto_views;

result auto_views_open(const scene *s, double aspect, const allocator *memory, report *r, auto_views *out);
void auto_views_close(auto_views *a);
camera auto_camera(const auto_views *a, const double eye[3], double yaw, double pitch);
int auto_is_ground(const auto_views *a); // 1 for a wide low scene, to stand on; 0 for a model
// A place spread over the scene: number i of any count. Never fails: over the scene there is room.
eye auto_spread_eye(auto_views *a, uint32_t i);

int auto_is_in_air(const auto_views *a, const double at[3]); // AUTO_CLEARANCE_M from all that is solid, and not in a liquid
eye auto_place(auto_views *a, uint32_t i);                   // number i of the entities' places, in turns; without any a spread one

result auto_views_make(auto_views *a, uint32_t count, camera *cameras);
result auto_walk_make(auto_views *a, uint32_t count, camera *cameras);
result auto_street_make(auto_views *a, uint32_t count, camera *cameras);
result auto_drive_make(auto_views *a, uint32_t count, camera *cameras);
result auto_turn_make(auto_views *a, uint32_t count, camera *cameras);
result auto_roofs_make(auto_views *a, uint32_t count, camera *cameras);
result auto_edges_make(auto_views *a, uint32_t count, camera *cameras); // BAD_INPUT, reported: no place for one

#endif
