// Frames in which method=hiz draws nothing into its pyramid, because that costs more than what it hides.
// SPDX-License-Identifier: MIT
//
// Costs are counted in polygons that the host would draw, not timed, from the set that was found: the same on every machine and for any count of
// threads. A polygon drawn into the pyramid takes a third to nine tenths of the time of one that a software renderer draws, by its size: it counts
// half; a box is an outline with up to three planes: two; a frame's own work sixteen. In the first frames of a time and every eighth
// it is looked what was hidden. Where that is less than what it cost, all that touches the volumes is drawn for 8 frames, then 16, 32, 64;
// then one frame is tried. That is tried earlier, after a quarter of the pause, where a quarter more or fewer items stand in the view.
#ifndef OCCLUSION_HIZ_REST_H
#define OCCLUSION_HIZ_REST_H

#include "hiz.h"
#include "walk.h"

// Before the frame. 1: it rests: all is said to the host, and the frame is complete.
int hiz_rest_frame(occlusion_walk *w, hiz_rest *r);
// After a frame that did not: what it drew is in the batch from h->first_run on. saved: polygons, by pictures dropped in it.
void hiz_rest_judge(occlusion_walk *w, const hiz *h, uint64_t saved, hiz_rest *r);

#endif
