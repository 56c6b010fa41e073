// Pictures that a filter drops, with the captures that are for them alone.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_DROP_H
#define OCCLUSION_DROP_H

#include <portcullis/culler.h>

// What a picture and a capture left out save, in polygons not drawn: pixels looked up; a pass of its own and all its items. Rough.
enum { DROP_PICTURE_POLYGONS = 128, DROP_CAPTURE_POLYGONS = 512 };

typedef struct drop_counters {
    uint64_t tested, pictures, captures; // tested: pictures; dropped
    uint64_t polygons;                   // saved
} drop_counters;

// A capture that another picture shows, or another capture is composed of, the host takes all the same.
static inline void drop_picture(const cull_visit *visit, cull_batch *batch, uint32_t picture, drop_counters *n)
{
    batch->keep_pictures[picture] = 0;
    n->pictures++;
    n->polygons += DROP_PICTURE_POLYGONS;
    for (uint32_t i = 0; i < visit->capture_count; i++) {
        if (visit->captures[i].slot != visit->pictures[picture].slot || !batch->keep_captures[i]) continue;
        batch->keep_captures[i] = 0;
        n->captures++;
        n->polygons += DROP_CAPTURE_POLYGONS;
    }
}

#endif
