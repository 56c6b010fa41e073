// Constructive solid geometry on polygons of planes: adds and subtracts in file order, all at once, not pair by pair.
// SPDX-License-Identifier: MIT
// Invariant: a point belongs to the highest-ranked brush that holds it, and is solid if that one adds. The surface is where
// solid meets air; each piece is made by the brush that made that border last, going up the ranks, and faces the air.
#ifndef PORTCULLIS_HOST_CSG_H
#define PORTCULLIS_HOST_CSG_H

#include "canonical.h"

typedef struct polygon_soup {
    buffer polygons; // body_polygon: plane faces the air (of a subtract: turned round); in the order of brushes and faces
    buffer edges;    // polygon_edge
} polygon_soup;

typedef struct csg_stage {
    const compile_input *in;
    const brush_bodies *bodies;
    const relation_table *relations;
    const brush_rank *rank;
    const map_field *field;
} csg_stage;

result csg_surface(const csg_stage *stage, const allocator *memory, polygon_soup *out);
void polygon_soup_free(polygon_soup *s); // of zeros is fine

// ---- One face against the bodies near it (csg_face.c) ----

typedef enum csg_effect { CSG_KEEP, CSG_REMOVE } csg_effect;
enum { CSG_BACK = 1, CSG_FRONT = 2 }; // the two sides of a face, as bits

typedef struct csg_candidate {
    uint32_t brush, sides; // sides of the face's plane that the body covers where it meets the face
    csg_effect effect;     // on the part that it covers, if one of those sides is still open
} csg_candidate;

typedef struct face_cutter {
    const plane_table *planes;
    const brush_bodies *bodies;
    const map_field *field;
    buffer edges, fragments, nodes, signs, cutters, needed; // scratch of one face
    buffer candidates;       // csg_candidate: of this face, first come first decides
    csg_effect rest;         // of what no candidate decides
    uint32_t open_sides;     // at first
    int mixed;               // candidates keep and remove
} face_cutter;

face_cutter face_cutter_make(const compile_input *in, const brush_bodies *bodies, const map_field *field, const allocator *memory);
void face_cutter_free(face_cutter *c);
// Appends what is left of the face; as it was when nothing is lost, whatever was cut on the way.
result face_cutter_run(face_cutter *c, const body_polygon *face, polygon_soup *out);

#endif
