// The items as select needs them, by place: what they are clipped by, a wall's loop, its triangles, or a box; and the faces of walls.
// SPDX-License-Identifier: MIT
// Invariant: what an item is judged by holds every point that is drawn of it: a wall's loop only where rounding has bent it, and moved
// its triangles' vertices off it, by no more than leaf_clip.h reckons with; else its triangles. The faces are those of
// `frustum[backface=1]`, so both drop the same walls.
#ifndef PORTCULLIS_BSP_SHAPES_H
#define PORTCULLIS_BSP_SHAPES_H

#include <portcullis/face.h>

typedef struct bsp_lane { float x[4], y[4], z[4]; } bsp_lane; // four vertices
typedef enum shape_kind {
    SHAPE_LOOP,      // lane_count lanes of vertex_count vertices; the last one fills the last lane
    SHAPE_TRIANGLES, // one in each lane, vertex_count 3; the last vertex twice
    SHAPE_BOX,       // in lanes[0]: x[0..2] its min, y[0..2] its max
} shape_kind;
// In units of one cache line, which is what a loop of up to four vertices takes.
typedef struct shape_head { uint32_t kind, vertex_count, lane_count, reserved; } shape_head;
typedef struct bsp_shape {
    shape_head head;
    bsp_lane lanes[];
} bsp_shape;
enum { SHAPE_UNIT = 64 };

typedef struct bsp_shapes {
    char *units;      // readable for one more
    uint32_t *firsts; // by place: the unit that its shape starts at
    cull_face *faces;  // by place
    uint32_t item_count, unit_count, most_vertices;
    uint32_t bent_count; // walls judged by their triangles
} bsp_shapes;

// [build] On failure nothing is left behind. order[place] = item. shapes_free of zeros is fine.
cull_result shapes_build(const cull_host *host, const cull_zone *zone, const uint32_t *order, bsp_shapes *out);
void shapes_free(const cull_host *host, bsp_shapes *shapes);
size_t shapes_bytes(const bsp_shapes *shapes);

static inline const bsp_shape *shape_of_unit(const bsp_shapes *s, uint32_t unit)
{
    return (const bsp_shape *)(const void *)(s->units + (size_t)unit * SHAPE_UNIT);
}

// The largest coordinate of the eye, which doubt is multiplied by.
static inline float eye_reach(const float eye[4])
{
    float most = 0;
    for (int i = 0; i < 3; i++) {
        const float size = eye[i] < 0 ? -eye[i] : eye[i];
        if (size > most) most = size;
    }
    return most;
}

static inline int shows_its_back(const cull_face *f, const float eye[4], float reach)
{
    const float height = (f->normal[0] * eye[0] + f->normal[1] * eye[1]) + f->normal[2] * eye[2];
    return height + (f->offset * eye[3] + f->doubt * reach) < 0;
}

#endif
