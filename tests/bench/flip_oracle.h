// FLIP once more, as slow and as plain as the paper tells it: whole filters, one pixel at a time, in double.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_FLIP_ORACLE_H
#define PORTCULLIS_TESTS_FLIP_ORACLE_H

#include <stdint.h>

typedef struct oracle_request {
    const uint8_t *reference, *test; // RGBA
    int wide, high;
    double pixels_per_degree;
} oracle_request;

// map: wide * high. Returns the mean.
double flip_oracle(const oracle_request *q, double *map);

#endif
