// Writes .obj: objects, materials and polygons from places on a fine integer grid, and the shapes that scenes are made of.
// SPDX-License-Identifier: MIT
// Invariant: polygons are counterclockwise from the side that is meant to be seen; inside an object equal places are one
// vertex, and shapes that touch along an edge share its ends, so closed shapes are closed in the file too.
#ifndef PORTCULLIS_BENCH_GENERATE_OBJ_H
#define PORTCULLIS_BENCH_GENERATE_OBJ_H

#include "generate_kinds.h"

typedef struct place { int32_t x, y, z; } place; // tenths of a millimetre, Y up

typedef struct obj_slot { place at; uint32_t vertex, object; } obj_slot; // object 0: empty
typedef struct obj_writer {
    text_file *out;
    const allocator *memory;
    obj_slot *slots; // places of the current object, open addressing
    uint32_t slot_count, used, vertex_count, object_count;
    uint64_t triangle_count; // written; a polygon of n corners is n - 2 of them
    const char *material;
} obj_writer;

obj_writer obj_open(text_file *out, const allocator *memory);
void obj_close(obj_writer *w);
void obj_object(obj_writer *w, const char *name);                    // `o name`
void obj_numbered_object(obj_writer *w, const char *name, uint32_t number); // `o name_number`
void obj_material(obj_writer *w, const char *name);                  // a constant text; written when it changes
// Equal neighbours are dropped, and with them a polygon of fewer than three corners. At most 8 corners.
void obj_polygon(obj_writer *w, const place *corners, uint32_t count);

typedef struct block { place min, max; } block;
block block_at(double x, double z, double y, double wide, double deep, double high); // metres; x, z its middle, y its foot
void obj_block(obj_writer *w, const block *b); // all six sides, seen from outside

// ---- Walls with openings ----

typedef enum side { SIDE_MIN_X, SIDE_MAX_X, SIDE_MIN_Y, SIDE_MAX_Y, SIDE_MIN_Z, SIDE_MAX_Z } side;
typedef enum facing { FACING_OUT, FACING_IN } facing; // a house is seen from outside, a room from inside

// A rectangle of a block's side. u runs along x (along z on the x sides), v along y (along z on the y sides).
typedef struct rectangle { int32_t u0, v0, u1, v1; } rectangle;

enum { CUTS_MOST = 40 };
typedef struct cuts { int32_t at[CUTS_MOST]; uint32_t count; } cuts; // ascending, without repeats
void cuts_add(cuts *c, int32_t at); // drops it when full: a debug build asserts

typedef struct panel {
    const block *body;
    side side;
    facing facing;
    const cuts *u, *v; // from edge to edge; every opening's edges are among them
    const rectangle *openings;
    uint32_t opening_count;
} panel;

void obj_panel(obj_writer *w, const panel *p); // the side, cut into rectangles, without those that lie in an opening
// The four sides of opening i, `depth` into the solid behind the panel, seen from within the opening.
void obj_reveal(obj_writer *w, const panel *p, uint32_t i, int32_t depth);
void obj_pane(obj_writer *w, const panel *p, uint32_t i, int32_t depth); // closes opening i at that depth

// ---- Smooth shapes ----

typedef struct spot { double x, y, z; } spot; // metres

// A grid of points round a shape: u in [0, 1) round it, v in [0, 1] from foot to top, or round too when it is a ring.
// Seen from outside when v rises where u turns from +x to +z. The poles of a closed shape are single points.
typedef struct surface {
    spot (*point)(const void *shape, double u, double v);
    const void *shape;
    uint32_t around, along; // rectangles
    int is_ring;
} surface;

void obj_surface(obj_writer *w, const surface *s, spot at); // triangles

double turn_sine(double turns); // to 1e-12, the same bits everywhere
double turn_cosine(double turns);

#endif
