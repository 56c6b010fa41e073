// Inputs of the CSG made by hand or turned from real maps, and exact measures of its surface in rational numbers (GMP).
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_CSG_FIXTURE_H
#define PORTCULLIS_TESTS_CSG_FIXTURE_H

#include "host/compile/compile.h"
#include "host/compile/plane_table.h"

#include <gmp.h>

typedef struct scene_draft { // brushes of one entity, in file order
    plane_table *planes;
    buffer brushes, faces, materials; // compile_brush, compile_face, compile_material
} scene_draft;

scene_draft draft_make(void);
void draft_free(scene_draft *d);
// A brush of material `material` on all faces; then its faces by draft_plane, or all at once by draft_box.
void draft_brush(scene_draft *d, brush_kind kind, brush_role role, uint32_t material);
void draft_plane(scene_draft *d, const cull_wide_plane *plane);
void draft_box(scene_draft *d, brush_kind kind, const int32_t min[3], const int32_t max[3], uint32_t material);
compile_input draft_input(scene_draft *d); // borrows; nothing to free

// A real map, read at so many steps a unit; NULL with a loud line when there is none.
compile_input *real_map(const char *name, double grid);
extern const char *const real_maps[8];

// p -> turn p + move, in whole steps; turn is `scale` times a rotation or mirror.
typedef struct map_turn {
    int turn[3][3], scale;
    int32_t move[3];
} map_turn;
map_turn turn_number(int number); // 0 to 47: 24 rotations, then the mirrored
// The input as if its file had been turned, with its brushes in `order` (NULL: as they are). Owned by the draft.
compile_input turned_input(const compile_input *in, const map_turn *by, const uint32_t *order, scene_draft *d);

compile_mesh *surface_of(const compile_input *in, csg_counts *counts); // asserts that it works

// ---- Exact measures ----

void point_of(const compile_input *in, const compile_vertex *v, mpq_t out[3]);
// Six times the volume that the polygons enclose, liquids left out; and twice the sum of directed areas.
void mesh_measures(const compile_input *in, const compile_mesh *m, mpq_t volume, mpq_t area[3]);

// A number for each polygon that doesn't depend on where its loop begins nor on numbers of vertices; sorted. `back` undoes a turn, but not its scale.
uint64_t *polygon_prints(const compile_mesh *m, const map_turn *back);
#endif
