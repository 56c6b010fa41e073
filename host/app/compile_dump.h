// What a stage of the compiler made, as text for a person or a diff: one thing a line, in the stage's own order.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_APP_COMPILE_DUMP_H
#define PORTCULLIS_HOST_APP_COMPILE_DUMP_H

#include "../compile/compile.h"

#include <stdio.h>

void dump_input(FILE *to, const compile_input *in);
void dump_csg(FILE *to, const compile_input *in, const compile_mesh *m);
void dump_zones(FILE *to, const compile_input *in, const compiled_zones *z);
void dump_items(FILE *to, const scene *s);

#endif
