// A brush's planes to the closed convex body that they bound: a box cut down plane by plane, in double.
// SPDX-License-Identifier: MIT
// Invariant: the body is closed. Faces that meet share their vertices bit for bit: every directed edge has its reverse.
#ifndef PORTCULLIS_HOST_MAP_BRUSH_H
#define PORTCULLIS_HOST_MAP_BRUSH_H

#include "../core/memory.h"

// Outside where dot(normal, p) > distance. Not of unit length: integer points give an exact integer plane, reduced by
// its common divisor, so that brushes whose faces lie in one plane get the same numbers.
typedef struct brush_plane {
    double normal[3], distance;
    double length; // of the normal
} brush_plane;

// Three points, clockwise seen from outside. 0 when they lie on a line.
int brush_plane_from_points(const double points[3][3], brush_plane *out);
// A plane of unit normal.
brush_plane brush_plane_from_unit(const double normal[3], double distance);

typedef struct brush_vertex {
    double position[3];
    double distance;          // to the plane that cuts now
    uint32_t planes[12];      // the first planes that meet here
    uint32_t plane_count;
    uint32_t seen, linked;    // cuts in which `distance` and `next` were set
    uint32_t next;            // round the new face
    int side;                 // of the plane that cuts now: -1 inside, 0 on it, 1 outside
} brush_vertex;

typedef struct brush_loop { // counterclockwise seen from outside
    uint32_t plane; // place in the planes given
    uint32_t first, count; // in the corners
} brush_loop;

typedef struct brush_body { // the answer, and memory that is used again for the next brush
    buffer vertices, loops, corners;           // brush_vertex, brush_loop, uint32_t (vertex)
    buffer other_loops, other_corners, order, edges;
    uint32_t cut;
} brush_body;

typedef enum brush_fault {
    BRUSH_SOUND,
    BRUSH_OPEN,  // the planes bound no finite body
    BRUSH_EMPTY, // the planes leave nothing
    BRUSH_BROKEN, // too degenerate to be closed at any tolerance
    BRUSH_NO_MEMORY,
} brush_fault;

brush_body brush_body_make(const allocator *memory);
void brush_body_free(brush_body *b);
// The body within the planes. Their order plays no part in its shape. Coordinates up to reach; tolerance: vertices
// nearer to a plane than this count as on it, same unit as the points. [one thread a body]
brush_fault brush_body_cut(brush_body *b, const brush_plane *planes, uint32_t plane_count, double reach, double tolerance);

// Corners that bend by less than `flat` from the line between their neighbours are dropped from corners[0 .. count), and the loop is
// turned to start where its fan has no thin triangle. The count left; below 3 the loop has no area.
uint32_t brush_loop_for_fan(const brush_vertex *vertices, uint32_t *corners, uint32_t count, double flat);

#endif
