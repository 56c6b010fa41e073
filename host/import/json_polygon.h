// Shapes that a JSON scene gives by points: flat convex polygons, and convex bodies as the hull of their corners.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMPORT_JSON_POLYGON_H
#define PORTCULLIS_IMPORT_JSON_POLYGON_H

#include "../core/scene.h"

enum { POLYGON_POINTS_MOST = 256, HULL_POINTS_LEAST = 4, HULL_POINTS_MOST = 64, HULL_POINT_PLANES_MOST = 2 * HULL_POINTS_MOST };

// NULL: flat, convex, counterclockwise about the unit normal of `plane` (normal . p + offset = 0). Else what is wrong.
const char *polygon_plane(const double (*points)[3], size_t count, double plane[4]);
// The vertex from which a fan has the widest smallest triangle: loops may have corners of 180 degrees.
size_t polygon_fan_start(const double (*points)[3], size_t count);

// The planes of the points' convex hull, each once. NULL: done; else what is wrong. planes: HULL_POINT_PLANES_MOST.
const char *hull_planes_of_points(const double (*points)[3], size_t count, scene_solid_plane *planes, uint32_t *out_count);
void hull_planes_of_box(const double min[3], const double max[3], scene_solid_plane planes[6]);

#endif
