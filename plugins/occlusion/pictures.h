// Pictures and clipped items of a select that stands before (an image cache): what is hidden behind all that the frame has drawn is neither taken nor
// shown. Their boxes are tested in a round of their own, after the method's last step; who was seen of late and needs no capture every 8th frame only.
// SPDX-License-Identifier: MIT
//
// Invariant: what is dropped was found hidden by an answer of this very frame.
#ifndef OCCLUSION_PICTURES_H
#define OCCLUSION_PICTURES_H

#include "walk.h"

// Room for such tests in a step; what finds none is kept.
static inline uint32_t pictures_tests(uint32_t items)
{
    const uint32_t most = 256;
    return items < most ? items : most;
}

// The method is done. 1: tests were asked, and the frame takes a step more, of pictures_judge alone.
int pictures_ask(occlusion_walk *w);
void pictures_judge(occlusion_walk *w);

#endif
