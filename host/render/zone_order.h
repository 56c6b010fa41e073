// Which zones' see-through things lie before which, for one eye.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_RENDER_ZONE_ORDER_H
#define PORTCULLIS_RENDER_ZONE_ORDER_H

#include "../core/scene.h"

typedef struct zone_order {
    double *keys;     // by zone: squared distance of its nearest see-through thing; INFINITY: it has none
    uint32_t *ranks;  // by zone: 0 is nearest; SCENE_NONE: not ranked
    uint32_t *degrees, *ready;
    uint32_t count;   // of zones
} zone_order;

result zone_order_open(uint32_t zone_count, const allocator *memory, zone_order *out); // as many as the scene has, or more
void zone_order_close(zone_order *o, const allocator *memory); // zeroed is fine
// keys are set, eye is in the world. Ranks all zones whose key is finite.
void zone_order_run(zone_order *o, const scene *s, const double eye[3]);

#endif
