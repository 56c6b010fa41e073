// The triangles round one point, and what pulling it into a neighbour does to the surface: see simplify.h for the bound.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_RENDER_SIMPLIFY_STAR_H
#define PORTCULLIS_RENDER_SIMPLIFY_STAR_H

#include "simplify.h"

enum { STAR_MOST = 24 }; // triangles round a point; one with more stays
#define STAR_ENDS UINT32_MAX // in the place of a wedge: the triangle goes

typedef struct star_point {
    uint32_t place;
    double at[3];
} star_point;

typedef struct star_triangle {
    uint32_t corner, group;
    uint32_t wedge, vertices[2]; // at the centre; the other two, in the triangle's sense
    star_point points[2];        // of these two
    double normals[3][3];        // of these two, then of the wedge
    double error;
} star_triangle;

typedef struct star {
    star_point centre;
    star_triangle triangles[STAR_MOST];
    uint32_t count;
    uint32_t border_count, borders[2]; // triangles whose first edge from the centre parts groups or looks
} star;

typedef struct star_limits { double sum, once; } star_limits; // metres: of all collapses, of one

typedef struct star_collapse {
    uint32_t target;            // place
    uint32_t wedges[STAR_MOST]; // by triangle: the vertex that its corner becomes, or STAR_ENDS
    double cost, error;         // error: of the triangles that stay, metres
} star_collapse;

// Sorts the triangles round the centre and finds its borders. 0: not a closed disc, or borders meet or end here.
int star_open(star *s);
int star_has(const star *s, uint32_t place); // on the rim
// Into the first point of triangle i. 0: it may not be.
int star_try(const star *s, uint32_t i, const star_limits *limits, star_collapse *out);

#endif
