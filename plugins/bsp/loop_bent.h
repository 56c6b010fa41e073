// Whether rounding has bent a polygon so that its edges' lines no longer hold it.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BSP_LOOP_BENT_H
#define PORTCULLIS_BSP_LOOP_BENT_H

#include <portcullis/culler.h>

// Counterclockwise seen from where the normal, a unit vector, points to. 0: from any eye in front, a line through two neighbours, moved out by
// `most` metres, has all corners inside. An edge is turned the more the shorter it is: one of the length of the rounding looks anywhere, also
// out of the plane, and seen at a grazing angle that is worst.
int loop_is_bent(const cull_vec3 *points, uint32_t count, const double normal[3], double most);

#endif
