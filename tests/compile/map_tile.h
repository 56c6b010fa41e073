// A map repeated on a grid of copies that don't meet, as one text: what a compiler's growth is measured on.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_MAP_TILE_H
#define PORTCULLIS_TESTS_MAP_TILE_H

#include <stddef.h>

typedef enum tile_fault { TILE_SOUND, TILE_NO_MAP, TILE_TOO_WIDE, TILE_NO_MEMORY } tile_fault;

// side * side copies in the plane of x and y, whole units apart, numbers as exact as they were. One world holds all brushes
// of the world; other entities come once a copy, origins moved, targets of each copy its own. Beyond 65,536 units:
// TILE_TOO_WIDE. The caller frees *out.
tile_fault map_tile(const char *text, size_t size, unsigned side, char **out, size_t *out_size);

#endif
