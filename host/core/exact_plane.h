// Exact planes about other origins.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_EXACT_PLANE_H
#define PORTCULLIS_HOST_EXACT_PLANE_H

#include <portcullis/culler.h>

// The same plane, about an origin that lies `by` whole metres from the old one. 0: not a whole number of steps a metre, or
// over 63 bits; *out is then untouched.
int exact_plane_move(const cull_exact_plane *from, const double by[3], double steps_per_metre, cull_exact_plane *out);

#endif
