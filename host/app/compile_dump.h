// What a stage of the compiler made, as text for a person or a diff: one thing a line, in the stage's own order; see
// docs/compile.md. Planes as exact integers, their front's normal then the offset; points as doubles in grid steps.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_APP_COMPILE_DUMP_H
#define PORTCULLIS_HOST_APP_COMPILE_DUMP_H

#include "../compile/stages.h"

#include <stdio.h>

void dump_stage(FILE *to, const compile_view *made); // INPUT .. T_JUNCTIONS
void dump_items(FILE *to, const scene *s);           // ITEMS

// ---- Shared by compile_dump*.c ----
void dump_plane(FILE *to, const compile_input *in, plane_ref ref);
void dump_point(FILE *to, const double at[3]);
const char *dump_material(const compile_input *in, uint32_t material);
void dump_portals(FILE *to, const compile_view *made);     // compile_dump_zones.c
void dump_zones(FILE *to, const compile_view *made);
void dump_t_junctions(FILE *to, const compile_view *made);
void dump_loop(FILE *to, const compile_mesh *m, uint32_t first, uint32_t count);
void dump_polygon(FILE *to, const compile_input *in, const compile_mesh *m, uint32_t polygon);

#endif
