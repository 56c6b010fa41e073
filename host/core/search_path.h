// The folders that plugin libraries are looked for in, in order, and why each is looked in; never the current one.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_SEARCH_PATH_H
#define PORTCULLIS_HOST_SEARCH_PATH_H

#include "memory.h"

typedef enum search_origin { SEARCH_APPLICATION, SEARCH_VARIABLE, SEARCH_USER, SEARCH_INSTALLED, SEARCH_BUILD } search_origin;
typedef enum search_beside { SEARCH_BESIDE_EXECUTABLE, SEARCH_BESIDE_LIBRARY } search_beside; // bin/portcullis, lib/libportcullis.so

enum { SEARCH_FOLDERS_MOST = 64 };
typedef struct search_path {
    const char *folders[SEARCH_FOLDERS_MOST]; // for loader_options
    search_origin origins[SEARCH_FOLDERS_MOST];
    uint32_t count;
} search_path;

// Borrowed; NULL and empty add nothing, nor does what is over the most.
void search_path_add(search_path *p, const char *folder, search_origin origin);
// The parts of PORTCULLIS_PLUGIN_PATH, then the user's own folder: $XDG_DATA_HOME/portcullis/plugins, by default
// ~/.local/share/portcullis/plugins. A program with more rights than its user heeds neither. Texts live in the arena.
void search_path_add_environment(search_path *p, arena *texts);
// The installed folder and that of a build tree, as seen from the file that this code runs from.
void search_path_add_beside(search_path *p, search_beside what, const char *file, arena *texts);

const char *search_origin_name(search_origin origin);
// Why a library file of a folder on the path was looked at; one of no such folder was named by the caller.
const char *search_path_origin_name(const search_path *p, const char *file);

#endif
