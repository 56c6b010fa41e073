// The folders that plugin libraries are looked for in, in order; never the current one.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_SEARCH_PATH_H
#define PORTCULLIS_HOST_SEARCH_PATH_H

#include "memory.h"

enum { SEARCH_FOLDERS_MOST = 64 };
typedef struct search_path {
    const char *folders[SEARCH_FOLDERS_MOST]; // for loader_options
    uint32_t count;
} search_path;

void search_path_add(search_path *p, const char *folder);     // borrowed; NULL and empty add nothing, nor does what is over the most
void search_path_add_variable(search_path *p, arena *texts); // the parts of PORTCULLIS_PLUGIN_PATH; texts live in the arena

#endif
