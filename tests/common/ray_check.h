// What cull.ray/1 answers, held against a loop over the boxes.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_RAY_CHECK_H
#define PORTCULLIS_TESTS_RAY_CHECK_H

#include <portcullis/culler.h>

enum { RAY_CHECK_MOST = 2000 }; // items

typedef struct ray_check {
    const cull_zone *zone; // as the culler was built from it
    const uint32_t *order; // of the culler
    const cull_culler *culler;
    const cull_ray *ray;
} ray_check;

// Each fails the test: the set, each item once, nearest first, and the nearest where the list is short.
void segment_must_be_right(const ray_check *c, cull_vec3 from, cull_vec3 to);
void box_must_be_right(const ray_check *c, cull_box box);

#endif
