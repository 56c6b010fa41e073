// Convex polygons of one plane, joined to larger ones where that adds little: hulls by Andrew (Another Efficient Algorithm for
// Convex Hulls in Two Dimensions, 1979).
// SPDX-License-Identifier: MIT
// Invariant: every polygon given lies in one hull, and no hull is much larger than what it holds; which are joined depends neither
// on their order nor on how the plane lies.
#ifndef PORTCULLIS_HOST_FLAT_HULLS_H
#define PORTCULLIS_HOST_FLAT_HULLS_H

#include "../core/report.h"
#include "plane_table.h"

typedef struct flat_point { double at[2], position[3]; } flat_point; // at: on the plane's main axes; position: grid steps

typedef struct flat_hull {
    uint32_t first, count; // in points: counterclockwise on the main axes
    double area;           // of its polygons, on the main axes
    uint32_t is_gone;      // part of another one
} flat_hull;

typedef struct flat_pair { // two that may be joined
    uint32_t hulls[2];
    int64_t waste, area, place; // of their hull, rounded: see steady.h
} flat_pair;

typedef struct flat_hulls {
    buffer points;   // flat_point
    buffer hulls;    // flat_hull
    buffer scratch;  // flat_point
    buffer pairs;    // flat_pair
    uint32_t axes[2];
    int is_turned;   // counterclockwise on the axes is clockwise from the plane's front
} flat_hulls;

flat_hulls flat_hulls_make(const allocator *memory);
void flat_hulls_free(flat_hulls *h);
// Empties it, for polygons of that plane.
void flat_hulls_start(flat_hulls *h, const plane_table *planes, plane_ref plane);
// A corner of the next polygon; all given, flat_hulls_close ends it.
result flat_hulls_corner(flat_hulls *h, const double position[3]);
result flat_hulls_close(flat_hulls *h);
// Until no two can be joined; the count of those that are left.
result flat_hulls_join(flat_hulls *h, uint32_t *left);

static inline const flat_point *flat_hull_points(const flat_hulls *h, const flat_hull *g)
{
    return (const flat_point *)h->points.items + g->first;
}

#endif
