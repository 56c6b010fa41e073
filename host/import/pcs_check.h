// What the checks of a scene share. Each function gives NULL, or what is wrong: a constant text.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMPORT_PCS_CHECK_H
#define PORTCULLIS_IMPORT_PCS_CHECK_H

#include "../core/scene.h"

static const double CHECK_UNIT = 1e-6; // of a unit vector's squared length: float's rounding, and a person's

int check_finite(const double *v, int count);
int check_unit(const double v[3]);
int check_on_step(const scene *s, double relative); // a whole number of steps, at most 2^24
const char *check_motion(const scene *s);           // doors, movers, keys, paths, lights, places, solids
const char *check_zones(const scene *s);            // zones, hulls, portals; items are there
const char *check_geometry(const scene *s);

#endif
