// The options of `imagecache`: their table, and what their values mean.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMAGECACHE_OPTIONS_H
#define PORTCULLIS_IMAGECACHE_OPTIONS_H

#include "inview.h"
#include "show.h"

enum { OPTION_LEVEL, OPTION_WALK, OPTION_ORDER, OPTION_SHOW, OPTION_TREE, OPTION_TOLERANCE, OPTION_HIDDEN, OPTION_BUDGET, OPTION_MEMORY, OPTION_DETAIL, OPTION_COUNT }; // places in options_table
extern const cull_option options_table[OPTION_COUNT];

typedef struct options {
    uint32_t level; // or CELLS_LEVEL_AUTO
    inview_ways ways;
    show_options show;
} options;

// CULL_ERR_OPTION: it said why.
cull_result options_read(const cull_host *host, const char *const *values, options *out);

#endif
