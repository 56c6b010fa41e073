// A raw map whose holes are filled: the faces of solid brushes that make nothing (skip, clip ...) beside faces that do.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_COMPILE_HOLES_H
#define PORTCULLIS_TESTS_COMPILE_HOLES_H

#include "host/core/scene.h"

#define HOLE_MATERIAL "hole"

// Through such a face one looks into the solid, whose inside raw brushes show; a compiled scene has a wall there. In *out
// such faces have the material HOLE_MATERIAL. One face a line, as editors write them.
result holes_import(const char *path, const allocator *memory, report *r, scene **out);

#endif
