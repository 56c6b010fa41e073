// The loop of the built-in culler `brute`, compiled once for each instruction set; all give the same runs.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_BUILTIN_BRUTE_H
#define PORTCULLIS_HOST_BUILTIN_BRUTE_H

#include <portcullis/culler.h>

enum { BRUTE_SPARE_RUNS = 8 }; // runs behind the last one that the loops may scribble on

typedef struct brute_job {
    cull_boxes boxes;
    uint32_t item_count;
    const cull_volume *volumes;
    uint32_t volume_count;
} brute_job;

// Writes the runs of boxes that touch a volume; returns how many: at most (item_count + 1) / 2.
typedef uint32_t brute_loop(const brute_job *job, cull_run *runs);
brute_loop brute_plain, brute_avx2, brute_avx512; // the last two exist on x86-64 only

// A plane made ready: for each axis the array whose corner lies farthest along the normal (p-vertex).
typedef struct brute_plane {
    const float *x, *y, *z;
    float normal_x, normal_y, normal_z;
    float limit; // -offset: comparing the sum with it has the sign of the sum with the offset added, exactly
} brute_plane;

#endif
