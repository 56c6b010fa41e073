// Convex bodies of planes: whether there is one, and its bounds.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_HULL_H
#define PORTCULLIS_HOST_HULL_H

#include "scene.h"

enum { HULL_CUTS_MOST = 512 }; // planes that hull_fault takes

// The box of the body's corners, to a billionth of its size and the rounding of the planes. NULL, or what is wrong: a
// constant text that goes on after "the zone ".
const char *hull_fault(const scene_solid_plane *planes, uint32_t plane_count, double min[3], double max[3]);

#endif
