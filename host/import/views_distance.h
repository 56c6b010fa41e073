// Distances from a point to a box and a triangle, and along an axis to a triangle, in double.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_VIEWS_DISTANCE_H
#define PORTCULLIS_HOST_VIEWS_DISTANCE_H

typedef struct axis_ray { int axis, sign; } axis_ray; // along x, y or z; sign 1 or -1

double distance_to_box(const double p[3], const double min[3], const double max[3]); // 0 inside
double distance_to_triangle(const double p[3], const double (*triangle)[3]);
// INFINITY where the ray misses. *facing: above 0 where it meets the triangle's back.
double distance_along_axis(const double p[3], axis_ray ray, const double (*triangle)[3], double *facing);

#endif
