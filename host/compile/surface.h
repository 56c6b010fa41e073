// The surface that zones are traced on: convex polygons whose corners are numbers of shared vertices and whose edges know a
// plane of theirs, so that a cut makes no number, only new meetings of three planes.
// SPDX-License-Identifier: MIT
// Invariant: one point, one vertex, however it was made; edge planes have their front outside the polygon.
#ifndef PORTCULLIS_HOST_SURFACE_H
#define PORTCULLIS_HOST_SURFACE_H

#include "compile.h"
#include "plane_table.h"

typedef enum surface_kind {
    SURFACE_WALL,   // air in front, solid behind
    SURFACE_LIQUID, // air on both sides, bounds nothing
    SURFACE_PORTAL, // air on both sides, bounds both
    SURFACE_SEAL,   // a liquid's face towards the void: bounds both like a portal
} surface_kind;

typedef struct surface_corner {
    uint32_t vertex;
    plane_ref edge; // from here to the next corner
} surface_corner;

typedef struct surface_polygon {
    plane_ref plane;
    uint32_t first, count; // in corners
    surface_kind kind;
    uint32_t material, brush, face; // SURFACE_PORTAL: the portal's entity in brush
    uint32_t source;                // polygon of the mesh; SURFACE_PORTAL: the piece
    double min[3], max[3];          // grid steps, of the corners' positions
} surface_polygon;

typedef struct surface {
    plane_table *planes; // borrowed
    const allocator *memory;
    buffer vertices; // compile_vertex
    buffer corners;  // surface_corner
    buffer polygons; // surface_polygon
    buffer slots;    // uint32_t: vertex + 1 of a cell, 0 empty; a power of two
    buffer next;     // uint32_t: vertex + 1, of the same slot
} surface;

static inline int surface_is_two_sided(surface_kind kind)
{
    return kind == SURFACE_PORTAL || kind == SURFACE_SEAL;
}

surface surface_make(plane_table *planes, const allocator *memory);
void surface_free(surface *s);

static inline compile_vertex *surface_vertex_at(const surface *s, uint32_t v)
{
    return (compile_vertex *)s->vertices.items + v;
}
static inline surface_corner *surface_corners(const surface *s, const surface_polygon *p)
{
    return (surface_corner *)s->corners.items + p->first;
}
static inline surface_polygon *surface_polygon_at(const surface *s, uint32_t p)
{
    return (surface_polygon *)s->polygons.items + p;
}
static inline uint32_t surface_polygon_count(const surface *s)
{
    return (uint32_t)s->polygons.count;
}

// The vertex where the three meet (they must), found or made. Only RESULT_NO_MEMORY can go wrong here and below.
result surface_vertex(surface *s, const plane_ref meet[3], uint32_t *out);
int surface_side(const surface *s, uint32_t vertex, plane_ref of); // 1 front, 0 on, -1 behind
// A copy of its corners is appended; the box is made. `like` gives kind, material, brush and face.
result surface_add(surface *s, plane_ref plane, const surface_corner *corners, uint32_t count, const surface_polygon *like, uint32_t *out);

typedef enum cut_result { CUT_FRONT, CUT_BACK, CUT_ON, CUT_BOTH } cut_result; // FRONT, BACK: all of it, some may be on
cut_result surface_classify(const surface *s, uint32_t polygon, plane_ref by);
// Of CUT_BOTH: the polygon becomes its front part, the back part is a new one.
result surface_cut(surface *s, uint32_t polygon, plane_ref by, uint32_t *back);

// All polygons of the mesh, walls and liquids (surface_load.c). `seals`: by polygon of the mesh, 1: a liquid that seals; NULL: none.
int compile_polygon_is_liquid(const compile_input *in, const compile_polygon *p);
result surface_load(surface *s, const compile_input *in, const compile_mesh *mesh, const uint8_t *seals);

#endif
