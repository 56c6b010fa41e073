// What of each item hides: its box where that is its surface, else the flat convex polygons that its triangles make.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_HIZ_SHAPES_H
#define OCCLUSION_HIZ_SHAPES_H

#include "hiz_setup.h"

typedef enum hiz_shape_kind { HIZ_HIDES_NOTHING, HIZ_HIDES_AS_BOX, HIZ_HIDES_AS_LOOPS } hiz_shape_kind;

typedef struct hiz_face { // a loop of the zone's positions
    float normal[3];
    uint32_t first, count; // in hiz_shapes.vertices
} hiz_face;

typedef struct hiz_shape {
    uint32_t first_face, face_count;
    uint16_t kind, is_one_sided; // one-sided: a chain may leave its back out
} hiz_shape;

typedef struct hiz_shapes {
    hiz_shape *shapes; // by slot
    hiz_face *faces;
    uint32_t *vertices;
    const cull_vec3 *positions; // the zone's
    size_t shape_most, face_most, vertex_most; // as allocated
    uint32_t face_count, vertex_count;
} hiz_shapes;

// [build] items: by slot. On failure nothing is left behind.
cull_result hiz_shapes_make(const cull_host *host, const cull_zone *zone, const uint32_t *items, hiz_shapes *out);
void hiz_shapes_free(const cull_host *host, hiz_shapes *s);
size_t hiz_shapes_bytes(const hiz_shapes *s);

// The face as seen from the eye.
void hiz_face_loop(const hiz_shapes *s, const hiz_face *face, const double eye[3], hiz_loop *out);

#endif
