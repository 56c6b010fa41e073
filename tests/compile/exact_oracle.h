// Planes made to be hard, and the same decisions by GMP. Tests only.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_EXACT_ORACLE_H
#define PORTCULLIS_TESTS_EXACT_ORACLE_H

#include <portcullis/exact.h>

typedef enum plane_family {
    FAMILY_RANDOM,      // through points anywhere on the grid
    FAMILY_SMALL,       // coordinates of a hand-made level
    FAMILY_ONE_POINT,   // all four through one grid point
    FAMILY_COMBINATION, // the fourth a sum of multiples of the others: through their point, which is on no grid
    FAMILY_OFF_BY_ONE,  // the same, its offset one step further
    FAMILY_LARGEST,     // through corners of the grid, or a step within
    FAMILY_COUNT,
} plane_family;

const char *family_name(plane_family f);
void family_planes(plane_family f, uint64_t *seed, cull_wide_plane out[4]);
void random_point(uint64_t *seed, int32_t most, int32_t out[3]);

int gmp_four_sign(const cull_wide_plane p[4]);
int gmp_normals_sign(const cull_wide_plane p[3]);
int gmp_side_of_point(const cull_wide_plane *p, const int32_t point[3]);
int gmp_order_along(const cull_wide_plane p[4]);           // by the parameters of both points along the line, as fractions
int gmp_position_is_near(const cull_wide_plane p[3], const double position[3], double error); // error: of each coordinate's size
int gmp_crosses_dot_sign(const cull_wide_plane p[4]);      // (n0 x n1) . (n2 x n3)

#endif
