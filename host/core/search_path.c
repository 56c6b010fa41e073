// Search path of plugins: see search_path.h.
// SPDX-License-Identifier: MIT
#include "search_path.h"

#include <stdlib.h>
#include <string.h>

void search_path_add(search_path *p, const char *folder)
{
    if (folder && *folder && p->count < SEARCH_FOLDERS_MOST) p->folders[p->count++] = folder;
}

// An empty part would mean the current folder to other tools; here it means nothing.
void search_path_add_variable(search_path *p, arena *texts)
{
    const char *at = getenv("PORTCULLIS_PLUGIN_PATH");
    while (at && *at) {
        const size_t length = strcspn(at, ":");
        search_path_add(p, length ? arena_text(texts, at, length) : NULL);
        at += length + (at[length] == ':');
    }
}
