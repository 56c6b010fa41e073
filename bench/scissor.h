// Screen rectangles of zones: the union of a zone's volumes, and of other zones that list one of its items, since an item
// is drawn by one zone and may be seen through another's portals.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_SCISSOR_H
#define PORTCULLIS_BENCH_SCISSOR_H

#include "../host/core/flow.h"
#include "../host/render/render.h"

// Which zones an item that a zone draws may be seen from too. Where chains step, whoever comes first has it: all of them.
// Chains of one step give it to the nearest that keeps it: those farther.
typedef enum scissor_sharing { SHARED_WITH_ALL, SHARED_WITH_FARTHER } scissor_sharing;

typedef struct scissor {
    const scene *scene;
    const allocator *memory;
    scissor_sharing sharing; // may be set at any time
    float (*of_zone)[4], (*of_item)[4]; // zone_count, item_count; least x, least y, greatest x, greatest y
    uint32_t *shared;                   // items that several zones list, zone after zone
    uint32_t *first_shared;             // of each zone, in shared; one more at the end
} scissor;

result scissor_open(const scene *s, const allocator *memory, scissor *out); // RESULT_NO_MEMORY leaves nothing
void scissor_close(scissor *s);                                             // zeroed is fine
// [main, in a frame] Tells the renderer the rectangle of each zone that the view reached.
void scissor_tell(scissor *s, const flow_result *f, renderer *g);

#endif
