// The land round a scene of houses: a grid of ground with holes for the houses, a street, hills beyond.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_GENERATE_LAND_H
#define PORTCULLIS_BENCH_GENERATE_LAND_H

#include "generate_obj.h"

enum { LAND_NEAR = 150 * METRE, LAND_HOLES = 8 };

typedef struct land {
    block holes[LAND_HOLES]; // no ground there; x and z count
    uint32_t hole_count;
    int32_t half;                    // of its width; a wide grid from LAND_NEAR on; at most 2,000 m
    int32_t flat_x, flat_z;          // half the sizes of what is level, at 0
    int32_t road_half, pavement_half, road_end; // of a street along x, and where it ends; 0: none
} land;

void land_write(obj_writer *w, const land *l);
double land_height(const land *l, double x_m, double z_m); // metres

#endif
