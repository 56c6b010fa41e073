// The options of `portcullis compile`.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_APP_COMPILE_ARGUMENTS_H
#define PORTCULLIS_HOST_APP_COMPILE_ARGUMENTS_H

#include "../compile/stages.h"

typedef struct compile_arguments {
    const char *input, *out, *prt, *pts, *plan, *bake; // all but the first two may be NULL
    const char *dump_files[STAGES_DUMPED];      // by stage; NULL: no dump; "": to stdout
    input_options options;
    zone_options zones;
    int json;
} compile_arguments;

// Exits on bad usage, as argp does, with EXIT_USAGE.
void compile_arguments_parse(int argc, char **argv, compile_arguments *out);
// Every output can be written, and no two files are one.
result compile_arguments_check(const compile_arguments *a, report *r);

#endif
