// What the primitives' files share: points to the grid, planes to the list.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_INPUT_ROUND_H
#define PORTCULLIS_HOST_INPUT_ROUND_H

#include "input_primitive.h"

void primitive_steps(const primitive *p, const double point[3], double out[3]); // placed, not rounded
void primitive_moved(primitive *p, const double written[3], const int32_t taken[3]);
primitive_fault primitive_point(primitive *p, const double point[3], int32_t out[3]);
void primitive_direction(const primitive *p, const double direction[3], int64_t out[3]); // within 2^22; zeros of no direction
primitive_fault primitive_add(primitive *p, const cull_wide_plane *plane); // reduced; one that is there is no second
primitive_fault primitive_add_through(primitive *p, const int64_t normal[3], const int32_t point[3]);

#endif
