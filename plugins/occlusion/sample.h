// The first tests of a zone that has not been worth its tests: a sample, that decides about all that would be tested with it.
// Invariant: it decides about tests alone; without them all is drawn.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_SAMPLE_H
#define OCCLUSION_SAMPLE_H

#include "walk.h"

enum { SAMPLE_TESTS = 128, SAMPLE_WAITING = 512 }; // a sample; decides about more than so many

// Once a frame, before most of its tests. waiting: entries to be tested.
int sample_is_due(const occlusion_walk *w, uint32_t waiting);
// The step asks for SAMPLE_TESTS, each entry alone, of places 0, stride, 2 * stride ... of those that wait.
void sample_begin(occlusion_walk *w);
static inline uint32_t sample_stride(uint32_t waiting)
{
    return waiting / SAMPLE_TESTS;
}

// The step after that.
int sample_is_answered(const occlusion_walk *w);
// Of the tests answered in this step: they took away what they cost, and a part of the entries that counts. A round is not counted: it
// is one.
int sample_pays(const occlusion_walk *w, uint32_t tests, uint32_t hidden);
// It does not, and all that waited is drawn. The next frame begins with a sample, too: the view may be another.
void sample_give_up(occlusion_walk *w);
int sample_gave_up(const occlusion_walk *w); // in this frame: it is ended without tests for the next
void sample_draw(occlusion_walk *w, tree_entry e); // a node or an item that waited

#endif
