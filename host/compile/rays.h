// Rays through the surface that are decided exactly: a ray is the meeting line of two integer planes, so each hit is a
// point of three planes. Its direction is skew to everything a map holds; where it still meets an edge, the next is taken.
// SPDX-License-Identifier: MIT
// Invariant: a place is inside a shell when a ray from it crosses that shell an odd number of times. Shells don't cross,
// so those that hold a place are nested, and the innermost is the one that the ray leaves for good first.
#ifndef PORTCULLIS_HOST_RAYS_H
#define PORTCULLIS_HOST_RAYS_H

#include "shells.h"

#include "../core/box_tree.h"

typedef struct ray_count { uint32_t crossings, last_face; } ray_count;

typedef struct ray { // the one shot last
    cull_wide_plane a, b, start; // it starts where the three meet
    double at[3], to[3];         // about: where it starts and leaves the surface's box
    int forward;                 // along n_a x n_b, or against it
    int axis;
    uint32_t nearest;            // face that looks at the start, hit first; RAY_NO_FACE
} ray;
#define RAY_NO_FACE UINT32_MAX

typedef struct ray_space {
    const surface *s;
    const shell_set *shells;
    const allocator *memory;
    tree_box *boxes;
    uint32_t *polygons; // of the tree's boxes: all but liquids
    uint32_t polygon_count;
    box_tree tree;
    ray_count *counts;  // by shell
    buffer touched;     // shells that it crosses
    ray ray;
} ray_space;

result ray_space_make(const surface *s, const shell_set *shells, const allocator *memory, ray_space *out);
void ray_space_free(ray_space *r); // of a made one

typedef enum ray_end {
    RAY_DONE,       // crossings can be asked for
    RAY_UNCLEAR,    // through an edge or along a face: try another
    RAY_ON_SURFACE, // it starts on a polygon
} ray_end;

// A ray from a grid point, or from inside of a face (2 * polygon + is back) into the air before it; `attempt` chooses the
// direction. The polygon's own crossing isn't counted. Only RESULT_NO_MEMORY can go wrong.
result ray_from_point(ray_space *r, const int32_t point[3], uint32_t attempt, ray_end *end);
result ray_from_face(ray_space *r, uint32_t face, uint32_t attempt, ray_end *end);
// The innermost shell with odd crossings, SHELL_NONE without one; only of those that `is_wanted` has 1 for (NULL: all).
uint32_t ray_innermost(const ray_space *r, const uint8_t *is_wanted);
uint32_t ray_crossings(const ray_space *r, uint32_t shell);

enum { RAY_ATTEMPTS = 64 };

#endif
