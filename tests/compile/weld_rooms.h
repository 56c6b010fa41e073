// Buildings of rooms as map text, turned and with every brush point moved a little by itself, as editors write them.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_WELD_ROOMS_H
#define PORTCULLIS_TESTS_WELD_ROOMS_H

#include <stddef.h>
#include <stdint.h>

typedef struct rooms_options {
    uint64_t seed;
    double turn_deg; // about the vertical
    double jitter;   // units, of each coordinate of each point, either way
} rooms_options;

typedef struct rooms_map {
    char *text; // on the heap
    size_t size;
    uint32_t rooms, zones; // zones: rooms joined by open doorways
} rooms_map;

rooms_map rooms_write(const rooms_options *o);

// Each number between brackets of a map moved by itself by up to `jitter`; on the heap.
char *map_jittered(const char *text, double jitter, uint64_t seed, size_t *out_size);

#endif
