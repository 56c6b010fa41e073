// Convex bodies of planes: whether there is one, and its bounds.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_HULL_H
#define PORTCULLIS_HOST_HULL_H

#include "scene.h"

enum { HULL_CUTS_MOST = 512 }; // planes that hull_fault takes

// The box of the body's corners, to a billionth of its size and the rounding of the planes. NULL, or what is wrong: a
// constant text that goes on after "the zone ".
const char *hull_fault(const scene_solid_plane *planes, uint32_t plane_count, double min[3], double max[3]);
// Of a body in the box min to max, which becomes its own: 1 for each plane that it needs; without the others it is the same
// to a billionth of its volume. NULL, or what is wrong.
const char *hull_needed(const scene_solid_plane *planes, uint32_t plane_count, uint8_t *is_needed, double min[3], double max[3]);
// Largest of normal . p - distance: below 0 inside. Of no planes: -INFINITY.
double hull_height(const scene_solid_plane *planes, uint32_t plane_count, const double p[3]);
// Whether some point of the convex polygon, moved by `shift`, lies `depth` or deeper in the body.
typedef struct hull_polygon { const double (*points)[3]; uint32_t point_count; double shift[3], depth; } hull_polygon;
int hull_has_some(const scene_solid_plane *planes, uint32_t plane_count, const hull_polygon *q);

#endif
