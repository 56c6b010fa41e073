// Axes that turn with the surface, for boxes: those of a slanted map are then as tight as those of an upright one.
// SPDX-License-Identifier: MIT
// Invariant: of unit length and at right angles but for rounding; a turned point is within 2^-24 steps.
#ifndef PORTCULLIS_HOST_SURFACE_FRAME_H
#define PORTCULLIS_HOST_SURFACE_FRAME_H

#include "surface.h"

#include "../core/box_tree.h"

typedef struct surface_frame { double axes[3][3]; } surface_frame;

surface_frame surface_frame_of(const surface *s); // along the largest polygon's normal, and that of the largest one at right angles to it
tree_box surface_frame_vertex(const surface_frame *f, const surface *s, uint32_t vertex, double margin);
tree_box surface_frame_edge(const surface_frame *f, const surface *s, const uint32_t ends[2], double margin);
tree_box surface_frame_polygon(const surface_frame *f, const surface *s, uint32_t polygon, double margin);

#endif
