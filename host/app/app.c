// What the subcommands share: search path, exit codes, small parsers.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "app.h"

#include "../import/number.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_BYTES = 4096 };

static void add_beside_executable(app *a)
{
    char path[PATH_BYTES];
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    if (length <= 0) return;
    path[length] = 0;
    search_path_add_beside(&a->search, SEARCH_BESIDE_EXECUTABLE, path, &a->texts);
}

result app_open(app *a, const app_plugin_files *files)
{
    *a = (app){.memory = allocator_heap(), .report = report_to_stderr()};
    a->texts = arena_make(a->memory);
    host_services_fill(&a->services, a->memory, &a->report);
    search_path_add_environment(&a->search, &a->texts);
    add_beside_executable(a);
    loader_options options = {.folders = a->search.folders, .folder_count = a->search.count};
    if (files) {
        options.files = files->files;
        options.file_count = files->count;
    }
    return loader_open(&options, a->memory, &a->report, &a->plugins);
}

void app_close(app *a)
{
    loader_close(a->plugins);
    scene_free(a->scene, a->memory);
    arena_free(&a->texts);
}

int app_exit_code(result done)
{
    return done == RESULT_OK ? EXIT_GOOD : done == RESULT_NO_GL ? EXIT_NO_GL : EXIT_USAGE;
}

result app_check_gl(app *a, const renderer *g)
{
    const uint32_t errors = g ? renderer_errors(g) : 0;
    if (!errors) return RESULT_OK;
    report_error(&a->report, NULL, 0, "%u OpenGL errors, told above; what was drawn is not to be trusted: try another driver", errors);
    return RESULT_NO_GL;
}

int parse_count(const char *text, uint32_t least, uint32_t most, uint32_t *out)
{
    char *end;
    if (*text < '0' || *text > '9') return 0;
    const unsigned long value = strtoul(text, &end, 10);
    if (*end || end - text > 10 || value < least || value > most) return 0;
    *out = (uint32_t)value;
    return 1;
}

int parse_ms(const char *text, double *out)
{
    const char *end = text + strlen(text);
    return *text && number_read(text, end, out) == end && *out >= 0 && *out <= 100000;
}

int parse_size(const char *text, app_size *out)
{
    char number[2][16];
    const char *cross = strchr(text, 'x');
    if (!cross || cross == text || (size_t)(cross - text) >= sizeof number[0] || strlen(cross + 1) >= sizeof number[1]) return 0;
    snprintf(number[0], sizeof number[0], "%.*s", (int)(cross - text), text);
    snprintf(number[1], sizeof number[1], "%s", cross + 1);
    return parse_count(number[0], 1, APP_SIDE_MOST, &out->width_px) && parse_count(number[1], 1, APP_SIDE_MOST, &out->height_px);
}

int parse_doors(const char *text, door_state *out)
{
    if (strcmp(text, "open") == 0) *out = DOORS_OPEN;
    else if (strcmp(text, "shut") == 0) *out = DOORS_SHUT;
    else return 0;
    return 1;
}

int app_doors_parse(const char *text, doors_choice *out)
{
    static const char *const names[] = {"open", "shut", "scene"};
    for (int i = 0; i < 3; ++i) {
        if (strcmp(text, names[i]) != 0) continue;
        *out = (doors_choice)i;
        return 1;
    }
    return 0;
}

door_state app_doors_import(doors_choice d)
{
    return d == DOORS_ALL_SHUT ? DOORS_SHUT : DOORS_OPEN;
}

const door_state *app_doors_of(const doors_choice *d)
{
    static const door_state states[] = {DOORS_OPEN, DOORS_SHUT};
    return *d == DOORS_OF_SCENE ? NULL : &states[*d];
}

const char *scene_label(const char *path, arena *texts)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    return arena_text(texts, name, dot && dot != name ? (size_t)(dot - name) : strlen(name));
}
