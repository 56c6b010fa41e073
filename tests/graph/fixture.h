// Scenes of zones alone, made by hand, and a look-up by brute force beside them.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_GRAPH_FIXTURE_H
#define PORTCULLIS_TESTS_GRAPH_FIXTURE_H

#include "host/core/movers.h"

#define FIXTURE_STEP (1.0 / 4096) // metres

typedef struct zone_fixture {
    scene scene; // what the tested code takes
    buffer zones, hulls, planes;
} zone_fixture;

void fixture_make(zone_fixture *f); // no zones yet
void fixture_free(zone_fixture *f);
uint32_t fixture_zone(zone_fixture *f, uint32_t flags, uint32_t parent); // hulls that are added next are its own
void fixture_origin(zone_fixture *f, uint32_t zone, double x, double y, double z);
void fixture_box(zone_fixture *f, const double min[3], const double max[3]);  // a hull of the last zone
// A hull of the last zone: eight tilted sides, a lid and a floor; its bounds are wide of it.
void fixture_gem(zone_fixture *f, const double centre[3], double radius, double turn);
void fixture_rooms(zone_fixture *f, uint32_t side, double size, const double corner[3]); // side x side zones, wall to wall

// Zones that the box touches, ascending, by trying all. Margins in metres, outward to touch and inward to be held; for a
// point both are its distance. Returns how many.
typedef struct oracle_margins { double touch, hold; } oracle_margins;
uint32_t oracle_zones(const zone_fixture *f, const double min[3], const double max[3], oracle_margins margins, uint32_t *zones);
uint32_t oracle_zones_of_box(const zone_fixture *f, const double min[3], const double max[3], uint32_t *zones);

#endif
