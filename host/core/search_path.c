// Search path of plugins: see search_path.h.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "search_path.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef PORTCULLIS_PLUGINS_FROM_BIN
#define PORTCULLIS_PLUGINS_FROM_BIN "../lib/portcullis" // the build tells the way from the install's bin to its plugins
#endif

enum { PATH_BYTES = 4096 };

void search_path_add(search_path *p, const char *folder, search_origin origin)
{
    if (!folder || !*folder || p->count == SEARCH_FOLDERS_MOST) return;
    p->origins[p->count] = origin;
    p->folders[p->count++] = folder;
}

// An empty part would mean the current folder to other tools; here it means nothing.
static void add_variable(search_path *p, arena *texts)
{
    const char *at = secure_getenv("PORTCULLIS_PLUGIN_PATH");
    while (at && *at) {
        const size_t length = strcspn(at, ":");
        search_path_add(p, length ? arena_text(texts, at, length) : NULL, SEARCH_VARIABLE);
        at += length + (at[length] == ':');
    }
}

static void add_joined(search_path *p, const char *base, int length, const char *rest, arena *texts, search_origin origin)
{
    char path[PATH_BYTES];
    const int size = snprintf(path, sizeof path, "%.*s/%s", length, base, rest);
    if (size > 0 && (size_t)size < sizeof path) search_path_add(p, arena_text(texts, path, (size_t)size), origin);
}

// The XDG Base Directory Specification: a path that is not absolute is as good as none.
static void add_user(search_path *p, arena *texts)
{
    const char *data = secure_getenv("XDG_DATA_HOME"), *home = secure_getenv("HOME");
    if (data && *data == '/') add_joined(p, data, (int)strlen(data), "portcullis/plugins", texts, SEARCH_USER);
    else if (home && *home == '/') add_joined(p, home, (int)strlen(home), ".local/share/portcullis/plugins", texts, SEARCH_USER);
}

void search_path_add_environment(search_path *p, arena *texts)
{
    add_variable(p, texts);
    add_user(p, texts);
}

void search_path_add_beside(search_path *p, search_beside what, const char *file, arena *texts)
{
    const char *slash = strrchr(file, '/');
    if (!slash) return; // found by a bare name: no folder to go by
    const int length = (int)(slash - file);
    if (what == SEARCH_BESIDE_LIBRARY) add_joined(p, file, length, "portcullis", texts, SEARCH_INSTALLED);
    add_joined(p, file, length, PORTCULLIS_PLUGINS_FROM_BIN, texts, SEARCH_INSTALLED); // the library may be linked into a program
    add_joined(p, file, length, "../plugins", texts, SEARCH_BUILD);
}

const char *search_origin_name(search_origin origin)
{
    static const char *const names[] = {"the application", "PORTCULLIS_PLUGIN_PATH", "the user's folder", "installed", "the build tree"};
    return names[origin];
}

const char *search_path_origin_name(const search_path *p, const char *file)
{
    const char *slash = strrchr(file, '/');
    const size_t length = slash ? (size_t)(slash - file) : 0;
    for (uint32_t i = 0; i < p->count && slash; ++i)
        if (strlen(p->folders[i]) == length && memcmp(p->folders[i], file, length) == 0) return search_origin_name(p->origins[i]);
    return "named by the caller";
}
