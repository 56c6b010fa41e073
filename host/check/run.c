// What a check says, and how it gets at its culler: see run.h.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "run.h"

#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void run_at(check_run *r, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(r->place, sizeof r->place, format, list);
    va_end(list);
}

static void say(check_run *r, const char *format, va_list list)
{
    vsnprintf(r->message, sizeof r->message, format, list);
}

check_verdict run_fail(check_run *r, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    say(r, format, list);
    va_end(list);
    const size_t used = strlen(r->message);
    if (*r->place) snprintf(r->message + used, sizeof r->message - used, "; in %s", r->place);
    return CHECK_FAIL;
}

check_verdict run_skip(check_run *r, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    say(r, format, list);
    va_end(list);
    return CHECK_SKIP;
}

const char *run_open(check_run *r, const char *id)
{
    char path[4096];
    if (!r->file) return r->plugin ? NULL : "no culler was named";
    snprintf(path, sizeof path, "%s%s", strchr(r->file, '/') ? "" : "./", r->file); // a bare name is a file here, not the system's to find
    r->library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!r->library) return dlerror();
    const cull_exports *entry = dlsym(r->library, CULL_ENTRY_SYMBOL);
    if (!entry) return "it has no symbol " CULL_ENTRY_SYMBOL "; declare it with CULL_ENTRY";
    if (entry->abi != CULL_ABI) return "it is of another ABI number than this host; build it against this host's culler.h";
    if (entry->plugin_count == 0 || entry->plugin_count > 64 || !entry->plugins) return "it lists no plugin, or over 64";
    for (uint32_t i = 0; i < entry->plugin_count; ++i) {
        const cull_plugin *p = entry->plugins[i];
        if (!p || !p->descriptor || !p->descriptor->id) return "its table holds a NULL plugin, or one without descriptor or id";
        if (!id || strcmp(p->descriptor->id, id) == 0) {
            r->plugin = p;
            return NULL;
        }
    }
    return "it has no culler of that id";
}

void run_ids(const check_run *r, char *ids, size_t size)
{
    const cull_exports *entry = dlsym(r->library, CULL_ENTRY_SYMBOL);
    size_t used = 0;
    for (uint32_t i = 0; entry && i < entry->plugin_count; ++i) {
        const cull_plugin *p = entry->plugins[i];
        if (!p || !p->descriptor || !p->descriptor->id || used + strlen(p->descriptor->id) + 2 > size) continue;
        used += (size_t)snprintf(ids + used, size - used, "%s%s", used ? " " : "", p->descriptor->id);
    }
}
