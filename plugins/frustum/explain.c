// Why an item is kept or dropped: see explain.h.
// SPDX-License-Identifier: MIT
#include "explain.h"

#include <portcullis/plane.h>

#include <stdio.h>

static cull_box item_box(const frustum_index *index, uint32_t place)
{
    const float *b = index->levels[0] + (size_t)(place / CULL_BLOCK_WIDTH) * CULL_BLOCK_FLOATS + place % CULL_BLOCK_WIDTH;
    const cull_box box = {{b[0], b[16], b[32]}, {b[48], b[64], b[80]}};
    return box;
}

static int shows_only_its_back(const frustum_index *index, const cull_view *view, uint32_t place)
{
    if (!index->faces) return 0;
    const float *f = index->faces + (size_t)(place / CULL_BLOCK_WIDTH) * CULL_BLOCK_FACE_FLOATS + place % CULL_BLOCK_WIDTH;
    float reach = 0;
    for (int i = 0; i < 3; i++) reach = fmaxf(reach, fabsf(view->eye[i]));
    const float height = (f[0] * view->eye[0] + f[16] * view->eye[1]) + f[32] * view->eye[2];
    return height + (f[48] * view->eye[3] + f[64] * reach) < 0;
}

size_t explain_item(const frustum_index *index, const cull_visit *visit, uint32_t item, char *text, size_t size)
{
    int length = 0;
    if (item >= index->item_count) {
        length = snprintf(text, size, "there is no item %u", (unsigned)item);
        return length < 0 ? 0 : (size_t)length;
    }
    const cull_standing f = cull_standing_of(visit->volumes, visit->volume_count, item_box(index, item));
    if (!(f.height >= 0))
        length = snprintf(text, size, "dropped: its box lies %g m outside plane %u of volume %u, and outside every other volume",
                          (double)-f.height, (unsigned)f.plane, (unsigned)f.volume);
    else if (shows_only_its_back(index, visit->view, item))
        length = snprintf(text, size, "dropped: the wall shows only its back to the eye (backface=1)");
    else
        length = snprintf(text, size, "kept: no plane of volume %u has its box outside", (unsigned)f.volume);
    return length < 0 ? 0 : (size_t)length;
}
