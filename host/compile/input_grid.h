// Decimals to the grid: a number as written, exactly, times the steps of a unit, rounded once, half to even.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_INPUT_GRID_H
#define PORTCULLIS_HOST_INPUT_GRID_H

#include <stddef.h>
#include <stdint.h>

#define GRID_BEYOND INT64_MAX

typedef enum grid_fit { GRID_ON, GRID_ROUNDED } grid_fit;

// text: [+-] digits with at most one point [e [+-] digits], as number_read takes it. steps: 1 to 65536. *out is GRID_BEYOND
// or its negative where the result has more than 17 digits. No double takes part. [any thread]
grid_fit grid_round(const char *text, size_t length, uint32_t steps, int64_t *out);

#endif
