// Frames of a zone in which nothing is tested before it is drawn: where that cannot pay, or has not of late.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_REST_H
#define OCCLUSION_REST_H

#include "walk.h"

// Step 0, after walk_begin. 1: all that touches the volumes is drawn, movers too, and the frame is complete. Some of it is tested
// afterwards, which nobody waits for: what that would have hidden decides when the zone is tested again.
int rest_frame(occlusion_walk *w);
// The answer to such a test. place: an item's, or item_count: all of the zone.
void rest_hear(occlusion_walk *w, uint32_t place, uint32_t pixels);
// The last step of a frame that was tested: what it drew, beside which the tests' gain is judged.
void rest_count_drawn(occlusion_walk *w);

#endif
