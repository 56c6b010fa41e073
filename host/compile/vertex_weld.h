// Topological weld: corners that are one point, whichever planes meet in them, become one vertex.
// SPDX-License-Identifier: MIT
// Invariant: two corners get one number if and only if they are exactly the same point; nothing moves.
#ifndef PORTCULLIS_HOST_VERTEX_WELD_H
#define PORTCULLIS_HOST_VERTEX_WELD_H

#include "csg.h"

// Numbers the corners in `soup` (polygon_edge.vertex) by first use; `vertices` takes compile_vertex.
result vertex_weld(const plane_table *planes, polygon_soup *soup, const allocator *memory, buffer *vertices);

#endif
