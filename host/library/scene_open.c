// The application's API, opening: a file, the cullers that it names, and the world of them. See api/portcullis/scene.h.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "library.h"

#include "../core/search_path.h"
#include "../import/import.h"

#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

cull_result library_result(result done)
{
    return done == RESULT_OK ? CULL_OK : done == RESULT_NO_MEMORY ? CULL_ERR_MEMORY : CULL_ERR_ZONE;
}

cull_result library_refuse(const cull_scene *s, cull_result code, const char *format, ...)
{
    char text[512];
    va_list rest;
    va_start(rest, format);
    vsnprintf(text, sizeof text, format, rest);
    va_end(rest);
    report r = s ? (report){.line = s->report.line, .user = s->report.user} : report_to_stderr(); // a copy: counters are one thread's
    report_error(&r, s && s->scene ? s->scene->path : NULL, 0, "%s", text);
    return code;
}

// ---- Where the report's lines go ----

static void tell_log(void *user, report_level level, const char *text)
{
    const cull_scene *s = user;
    const cull_log_level as = level == REPORT_ERROR ? CULL_LOG_ERROR : level == REPORT_WARNING ? CULL_LOG_WARN : CULL_LOG_INFO;
    s->options.log(s->options.user, as, text);
}

// ---- Where plugins are looked for ----

// Beside this library, as installed and as built; where it is linked into the executable, beside that.
static void add_beside_library(cull_scene *s, search_path *p)
{
    static const char here = 0; // an object of this library, to ask where it was loaded from
    Dl_info info;
    if (dladdr(&here, &info) && info.dli_fname) search_path_add_beside(p, SEARCH_BESIDE_LIBRARY, info.dli_fname, &s->texts);
}

static result open_plugins(cull_scene *s, const cull_scene_options *o)
{
    search_path p = {0};
    for (uint32_t i = 0; i < o->plugin_folder_count; ++i) search_path_add(&p, o->plugin_folders[i], SEARCH_APPLICATION);
    search_path_add_environment(&p, &s->texts);
    add_beside_library(s, &p);
    const loader_options options = {.folders = p.folders, .folder_count = p.count};
    return loader_open(&options, s->memory, &s->report, &s->plugins);
}

// ---- Chains: as the file names them ----

static result parse_chain(cull_scene *s, const char *text, const chain_spec **out)
{
    chain_spec *spec = arena_push(&s->texts, 1, sizeof *spec);
    if (!spec) return report_no_memory(&s->report, s->scene->path);
    *out = spec;
    return chain_parse(text, &s->texts, &s->report, spec);
}

static result open_world(cull_scene *s, const cull_scene_options *o, cull_result *code)
{
    const uint32_t zones = s->scene->zone_count;
    const chain_spec **chains = arena_push(&s->texts, zones, sizeof *chains), *usual = NULL;
    if (!chains) return report_no_memory(&s->report, s->scene->path);
    *code = CULL_ERR_OPTION; // from here on it is chains that are wrong
    result done = parse_chain(s, o->chain ? o->chain : "frustum", &usual);
    for (uint32_t z = 0; z < zones && done == RESULT_OK; ++z) {
        chains[z] = NULL;
        if (s->scene->zones[z].chain) done = parse_chain(s, s->scene->zones[z].chain, &chains[z]);
    }
    if (done != RESULT_OK) return done;
    const world_request q = {
        .scene = s->scene, .plugins = s->plugins, .services = &s->services, .chains = chains, .chain = usual, .more_movers = o->more_movers};
    return world_open(&q, &s->report, &s->world);
}

static result open_all(cull_scene *s, const char *path, const cull_scene_options *o, cull_result *code)
{
    const import_options import = {.doors = DOORS_OPEN};
    result done = open_plugins(s, o);
    if (done == RESULT_OK) done = import_scene(path, &import, s->memory, &s->report, &s->scene);
    return done == RESULT_OK ? open_world(s, o, code) : done;
}

cull_result cull_scene_open(const char *path, const cull_scene_options *options, cull_scene **out)
{
    static const cull_scene_options usual = {.struct_size = sizeof usual};
    const allocator *memory = allocator_heap();
    const cull_scene_options *o = options ? options : &usual;
    if (!path || !out) return library_refuse(NULL, CULL_ERR_OPTION, "cull_scene_open takes a path and a place for the scene");
    if (o->struct_size != sizeof usual || o->reserved)
        return library_refuse(NULL, CULL_ERR_OPTION,
                              "cull_scene_options: struct_size %u is not %zu, or reserved is not 0; build against this library's scene.h",
                              o->struct_size, sizeof usual);
    cull_scene *s = memory_alloc_zeroed(memory, 1, sizeof *s);
    if (!s) return library_refuse(NULL, CULL_ERR_MEMORY, "out of memory");
    s->memory = memory;
    s->options = *o;
    s->report = o->log ? (report){.line = tell_log, .user = s} : report_to_stderr();
    s->texts = arena_make(memory);
    host_services_fill(&s->services, memory, &s->report);
    cull_result code = CULL_ERR_ZONE;
    const result done = open_all(s, path, o, &code);
    if (done != RESULT_OK) {
        cull_scene_close(s);
        return done == RESULT_NO_MEMORY ? CULL_ERR_MEMORY : code;
    }
    *out = s;
    return CULL_OK;
}

void cull_scene_close(cull_scene *s)
{
    if (!s) return;
    while (s->views) cull_scene_view_close(s->views);
    world_close(s->world);
    scene_free(s->scene, s->memory);
    loader_close(s->plugins);
    arena_free(&s->texts);
    memory_free(s->memory, s, 1, sizeof *s);
}
