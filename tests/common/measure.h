// For what measures cullers by hand: boxes and views from files, a clock, the median.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_MEASURE_H
#define PORTCULLIS_TESTS_MEASURE_H

#include "host/core/view.h"

enum { MEASURE_VIEWS = 1000, MEASURE_VOLUMES = 8, MEASURE_IDS_SPARE = 16 };

typedef struct measured_view {
    cull_view view;
    view_volume volume, wedges[MEASURE_VOLUMES]; // the view whole, and cut side by side, as portals side by side would
} measured_view;

double clock_ns(void); // CPU time of this thread

// Both end the program where the file isn't what it should be.
cull_box *boxes_load(const char *path, uint32_t *count); // free it
uint32_t views_load(const char *path, const cull_box *of_all, uint32_t wedges, measured_view views[MEASURE_VIEWS]); // 1280x720

// The ids of runs, 4 bytes each, as a host that draws by id lists would write them; `ids` has room for MEASURE_IDS_SPARE more. Returns how many.
uint64_t ids_write(const cull_run *runs, uint32_t run_count, uint32_t *ids);

double middle_of(double *values, uint32_t count); // sorts them; at least one

#endif
