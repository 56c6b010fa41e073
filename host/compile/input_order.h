// Orders for the weld that don't depend on how a map was written or turned: what comes first is told by how far it is from
// the brushes' centre.
// SPDX-License-Identifier: MIT
// Invariant: distances are rounded far coarser than doubles err; what still ties is symmetric and ordered by coordinates.
#ifndef PORTCULLIS_HOST_COMPILE_INPUT_ORDER_H
#define PORTCULLIS_HOST_COMPILE_INPUT_ORDER_H

#include "compile.h"

typedef struct place_order { double centre[3]; } place_order; // grid steps

place_order place_order_of(const compile_brush *brushes, size_t count);
// A value up to the errors of doubles: to 1/1024 step. Half steps and their like stay what they are.
double steady(double steps);
double place_distance(const place_order *o, const double at[3]); // from the centre
int compare_places(const place_order *o, const double a[3], const double b[3]);
// By how far they are from the centre, then their numbers up to order and sign, then as they are.
int compare_plane_places(const place_order *o, const cull_wide_plane *a, const cull_wide_plane *b);

#endif
