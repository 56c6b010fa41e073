// Random points in a map's air: outside of all solid brushes, and not in the void round the map.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_COMPILE_AIR_POINTS_H
#define PORTCULLIS_TESTS_COMPILE_AIR_POINTS_H

#include "host/core/scene.h"

typedef enum point_place { POINT_AIR, POINT_SOLID, POINT_VOID } point_place;

typedef struct air_points air_points;

// raw: says what is solid (its bodies). compiled: whose walls face the air alone, so that rays from the void meet backs or
// nothing. clearance: metres from anything solid. NULL: no memory.
air_points *air_points_open(const scene *raw, const scene *compiled, double clearance);
void air_points_close(air_points *a);
point_place air_points_place(const air_points *a, const double world[3]);

#endif
