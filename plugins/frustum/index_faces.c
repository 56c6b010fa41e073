// The faces of walls, for backface=1, as the walk's blocks have them: see api/portcullis/face.h.
// SPDX-License-Identifier: MIT
// Invariant: five rows a block; an item whose back counts too, or no item, has zeros: never dropped.
#include "index.h"

#include <portcullis/face.h>

void index_faces_fill(const cull_zone *zone, const uint32_t *order, uint32_t count, float *faces)
{
    for (uint32_t i = 0; i < INDEX_WIDTH; i++) {
        cull_face face = {{0, 0, 0}, 0, 0};
        if (i < count) face = cull_face_of(zone, order[i]);
        float *out = faces + i;
        for (int row = 0; row < 3; row++) out[row * INDEX_WIDTH] = face.normal[row];
        out[3 * INDEX_WIDTH] = face.offset;
        out[4 * INDEX_WIDTH] = face.doubt;
    }
}
