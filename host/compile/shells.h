// Shells: what is connected of the surface when one walks from polygon to polygon across each edge through the air. The
// thesis's edge tracing (A4): at every elementary segment the neighbour is the next polygon round it through the air.
// SPDX-License-Identifier: MIT
// Invariant: a wall has one face, in front; a portal two. Each face meets exactly one other (or its own back, at a
// portal's free edge) at each segment of its edges, or `open_segments` counts it.
#ifndef PORTCULLIS_HOST_SHELLS_H
#define PORTCULLIS_HOST_SHELLS_H

#include "lines.h"

#define SHELL_NONE UINT32_MAX

typedef struct face_pair { uint32_t a, b, start, end; } face_pair; // faces that meet at a segment, and its two vertices

typedef struct shell_set {
    const allocator *memory;
    uint32_t *shell_of; // of faces 2 * polygon + is back; SHELL_NONE: liquids, the backs of walls
    uint32_t face_count, shell_count, open_segments;
    buffer pairs; // face_pair
} shell_set;

result shell_set_make(const line_set *l, const allocator *memory, shell_set *out);
void shell_set_free(shell_set *s); // zeroed is fine

#endif
