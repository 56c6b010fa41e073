// The plugin loader: finds culler libraries on a search path, opens only those that are named, checks them once.
// SPDX-License-Identifier: MIT
// Invariant: a plugin that loader_find gives out has every slot that the host calls, and an id that no other has.
#ifndef PORTCULLIS_HOST_LOADER_H
#define PORTCULLIS_HOST_LOADER_H

#include "memory.h"
#include "report.h"

#include <portcullis/culler.h>

#define LOADER_SUFFIX ".culler.so"

typedef struct loader_options {
    const char *const *files;   // explicit libraries, looked at first
    const char *const *folders; // in order; a missing one is no error
    uint32_t file_count, folder_count;
} loader_options;

typedef struct loaded_plugin {
    const cull_plugin *plugin;
    const char *path; // NULL: built in
} loaded_plugin;

typedef struct refused_plugin { const char *path, *reason; } refused_plugin;

typedef struct loader loader;

// [main, and all below] The options are copied. Built-in cullers are there at once; no library is opened.
result loader_open(const loader_options *o, const allocator *memory, report *r, loader **out);
void loader_close(loader *l); // NULL is fine; no culler of it may live
// Opens the explicit files, each of which must be good, then `id`.culler.so of the first folder that has a good one, else looks through all libraries. On failure one line
// names what was found and what was refused.
result loader_find(loader *l, const char *id, report *r, const cull_plugin **out);
result loader_scan(loader *l, report *r); // opens everything, for listing
const loaded_plugin *loader_plugins(const loader *l, uint32_t *count);
const refused_plugin *loader_refusals(const loader *l, uint32_t *count);
uint32_t loader_libraries_open(const loader *l);

#endif
