// The compiler's mesh from a soup of numbered polygons.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_COMPILE_MESH_H
#define PORTCULLIS_HOST_COMPILE_MESH_H

#include "csg.h"

// Copies; vertices that no polygon uses are left out, the others keep their order.
result compile_mesh_make(const compile_input *in, const polygon_soup *soup, const buffer *vertices, const allocator *memory, compile_mesh **out);

#endif
