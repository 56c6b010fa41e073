// Seams: how far a zone's portals lie off the border of its hulls, and the margins that follow for what touches the zone and
// what it holds. One place for those who list items, find zones of boxes and start a flow.
// SPDX-License-Identifier: MIT
// Invariant: what lies between a portal and the border of a zone is never held by one of its two sides alone.
#ifndef PORTCULLIS_HOST_ZONE_SEAM_H
#define PORTCULLIS_HOST_ZONE_SEAM_H

#include "scene.h"

typedef struct zone_seam { // metres
    double out;   // that its portals stick out of its hulls
    double in;    // that they lie in them, of portals to a zone that it lies in
    double touch; // a box that far out of a hull touches the zone still
    double hold;  // a box that is deeper in a hull is held by it: the zone's parent does not have it
} zone_seam;
void zone_seams_find(const scene *s, zone_seam *out); // one a zone

double seam_touch_least_m(const scene *s); // of all zones: what rounding to the scene's step needs
double seam_hold_least_m(const scene *s);

// How far a portal may lie off the hulls that it joins.
double seam_tolerance_m(double portal_size, double zones_size); // sizes: greatest distance from the portal's middle; side of the zones' bounds
double zone_height(const scene *s, uint32_t zone, const double p[3]); // least of its hulls'; -INFINITY: it has none

#endif
