// What `portcullis compile` tells at its end.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_APP_COMPILE_REPORT_H
#define PORTCULLIS_HOST_APP_COMPILE_REPORT_H

#include "../compile/stages.h"

typedef struct compile_facts {
    const compile_input *input;
    const compiled_zones *zones;
    const csg_counts *counts;
    const compile_checks *checks;
    const scene *scene;     // as written
    const double *stage_ms; // STAGE_COUNT of them
    size_t peak_bytes;
    uint64_t bake_bytes;
    uint32_t bakes;
} compile_facts;

typedef enum report_form { REPORT_TEXT, REPORT_JSON } report_form;
void compile_report_print(const compile_facts *f, report_form form); // to stdout

#endif
