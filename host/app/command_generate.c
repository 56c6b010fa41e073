// portcullis generate: seeded scenes, and camera paths through scenes.
// SPDX-License-Identifier: MIT
#include "../../bench/generate.h"
#include "../core/file.h"
#include "../import/views.h"
#include "app.h"

#include <argp.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

typedef struct arguments {
    const char *kind, *out, *scene, *views;
    uint64_t size, seed;
} arguments;

enum { KEY_SCENE = 256, KEY_VIEWS };
static const struct argp_option options[] = {
    {"size", 'n', "N", 0, "boxes for city and swarm, rooms for rooms and maze", 0},
    {"seed", 's', "S", 0, "another seed, another scene: 0 to 18446744073709551614 (default 1)", 0},
    {"output", 'o', "FILE", 0, "where to; needed", 0},
    {"scene", KEY_SCENE, "SCENE", 0, "views: of this scene", 0},
    {"views", KEY_VIEWS, APP_VIEWS, 0, "views: which", 0},
    {0},
};

static const uint64_t NUMBER_MOST = UINT64_MAX - 1; // the last means that none was said

static int parse_u64(const char *text, uint64_t *out)
{
    char *end;
    if (*text < '0' || *text > '9') return 0;
    errno = 0;
    *out = strtoull(text, &end, 10);
    return *end == 0 && errno == 0 && *out <= NUMBER_MOST;
}

static int is_views(const arguments *a)
{
    return strcmp(a->kind, "views") == 0;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    if (key == 'n') {
        if (!parse_u64(text, &a->size)) argp_error(state, "--size takes a whole number, not '%s'", text);
    } else if (key == 's') {
        if (!parse_u64(text, &a->seed))
            argp_error(state, "--seed takes a whole number from 0 to %llu, not '%s'", (unsigned long long)NUMBER_MOST, text);
    } else if (key == 'o') a->out = text;
    else if (key == KEY_SCENE) a->scene = text;
    else if (key == KEY_VIEWS) a->views = text;
    else if (key == ARGP_KEY_ARG && !a->kind) a->kind = text;
    else if (key == ARGP_KEY_ARG) argp_error(state, "one KIND, not also '%s'", text);
    else if (key == ARGP_KEY_END && (!a->kind || !a->out)) argp_error(state, "KIND and -o are needed");
    else if (key == ARGP_KEY_END && (is_views(a) ? !a->scene || !a->views : a->scene || a->views)) argp_error(state, "KIND views takes --scene and --views, no other does");
    else return ARGP_ERR_UNKNOWN;
    return 0;
}

static result write_views(const camera_path *path, const char *out, report *r)
{
    char *text;
    size_t size;
    if (camera_path_text(path, allocator_heap(), &text, &size) != RESULT_OK) return report_no_memory(r, out);
    const result done = file_write(out, text, size, r);
    memory_free(allocator_heap(), text, size + 1, 1);
    return done;
}

static int generate_views(const arguments *q)
{
    static const double aspect = 16.0 / 9;
    const import_options import = {.doors = DOORS_OPEN};
    report r = report_to_stderr();
    scene *loaded = NULL;
    camera_path path = {0};
    result done = import_scene(q->scene, &import, allocator_heap(), &r, &loaded);
    if (done == RESULT_OK) done = camera_path_load(q->views, loaded, aspect, allocator_heap(), &r, &path);
    if (done == RESULT_OK) done = write_views(&path, q->out, &r);
    if (path.cameras) camera_path_free(&path, allocator_heap());
    scene_free(loaded, allocator_heap());
    return app_exit_code(done);
}

int command_generate(int argc, char **argv)
{
    static const char about[] = "Writes a seeded scene. KIND: " GENERATE_KINDS ". maze, house and flagship, and rooms with -o FILE.json, "
                                "have zones: they write FILE.json and FILE.obj beside it; demo writes FILE.obj and FILE.views. "
                                "views writes a camera path of a scene as FILE.views, for pictures of 16:9. Files of these names are replaced.";
    static const struct argp parser = {options, parse, "KIND", about, NULL, NULL, NULL};
    arguments q = {.size = GENERATE_SIZE_OF_KIND, .seed = GENERATE_SEED_OF_KIND};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    if (is_views(&q)) return generate_views(&q);
    report r = report_to_stderr();
    return app_exit_code(generate_scene(q.kind, q.size, q.seed, q.out, allocator_heap(), &r));
}
