// Free space: how far a point is from solids, boxes and triangles of a scene, by a uniform grid over them.
// SPDX-License-Identifier: MIT
// Invariant: all points are relative to the origin given at opening, in metres; constant after it. What moves counts only
// as its solids do.
#ifndef PORTCULLIS_HOST_VIEWS_SPACE_H
#define PORTCULLIS_HOST_VIEWS_SPACE_H

#include "../core/scene.h"
#include "views_distance.h"

enum { // what counts
    SPACE_SOLIDS = 1u << 0,    // structure and entities
    SPACE_LIQUIDS = 1u << 1,
    SPACE_BOXES = 1u << 2,     // items that are boxes
    SPACE_TRIANGLES = 1u << 3, // of other opaque items that don't move
    SPACE_ALL = 15u,
};

typedef struct free_space free_space;

// origin: world, whole metres from the zone's, so that nothing is rounded.
result free_space_open(const scene *s, const double origin[3], const allocator *memory, free_space **out); // RESULT_NO_MEMORY, unreported
void free_space_close(free_space *space); // NULL is fine
// Distance in metres from p to the nearest of what counts, exact, and at most `most`; 0 inside of a body. [any thread]
double free_space_clearance(const free_space *space, const double p[3], double most, uint32_t what);
// 1 where more of the six ways along the axes end at the back of a triangle than at a front: inside a closed mesh or
// under the ground.
int free_space_is_enclosed(const free_space *space, const double p[3]);

// How far below p the front of a triangle or a box is the first thing met: ground to stand on. INFINITY where it isn't.
double free_space_ground(const free_space *space, const double p[3]);
// How far along the ray from p the first triangle, of either side, or box is met. INFINITY: none.
double free_space_along(const free_space *space, const double p[3], axis_ray ray);

#endif
