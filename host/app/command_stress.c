// portcullis stress: cullers on a scene moved, scaled, turned, jittered, doubled, and looked at by extreme cameras.
// SPDX-License-Identifier: MIT
#include "../../bench/stress.h"
#include "../core/file.h"
#include "chains.h"

#include <argp.h>
#include <stdio.h>
#include <string.h>

enum { KEY_VIEWS = 256, KEY_CULLER, KEY_ZONE, KEY_FAMILY, KEY_SEED, KEY_SIZE, KEY_DOORS, KEY_JSON, KEY_SVG, KEY_PLUGIN };
enum { CULLERS_MOST = 64, FAMILIES_MOST = 32 };

typedef struct arguments {
    const char *scene, *views, *json, *svg;
    const char *cullers[CULLERS_MOST];
    const stress_family *families[FAMILIES_MOST];
    uint32_t culler_count, family_count, seed;
    app_size size;
    doors_choice doors;
    zone_options zones;
    app_plugin_files plugins;
} arguments;

static const struct argp_option options[] = {
    {"views", KEY_VIEWS, APP_VIEWS, 0, "the camera path (default auto:8)", 0},
    {"culler", KEY_CULLER, "CHAIN|scene", 0, "what culls (default scene); may stand several times", 0},
    {"zone", KEY_ZONE, "NAME=CHAIN", 0, "in every strategy these zones take this chain; NAME may be a pattern such as cellar*; may stand several times", 0},
    {"family", KEY_FAMILY, "NAME", 0,
     "only this one of move, move-odd, grow, shrink, turn, jitter, near, near-out, far, narrow, wide, copies, tiny, eye; may stand several times", 0},
    {"seed", KEY_SEED, "S", 0, "of the jitter (default 1)", 0},
    {"size", KEY_SIZE, "WxH", 0, "of the picture (default 320x180)", 0},
    {"doors", KEY_DOORS, "open|shut|scene", 0, "how doors stand (default open; scene: as its file says)", 0},
    {"json", KEY_JSON, "FILE|-", 0, "every magnitude's counters", 0},
    {"svg", KEY_SVG, "FILE", 0, "a plot of error against magnitude, a panel a family", 0},
    {"plugin", KEY_PLUGIN, "FILE", 0, "look at this library first; may stand several times", 0},
    {0},
};

static void add_family(arguments *a, const char *name, struct argp_state *state)
{
    uint32_t count;
    const stress_family *all = stress_families(&count);
    for (uint32_t f = 0; f < count; ++f) {
        if (name && strcmp(all[f].name, name) != 0) continue;
        for (uint32_t i = 0; i < a->family_count; ++i)
            if (a->families[i] == &all[f]) argp_error(state, "--family %s stands twice", all[f].name);
        a->families[a->family_count++] = &all[f];
        if (name) return;
    }
    if (name) argp_error(state, "no family '%s'; --help names them", name);
}

static void parse_numbers(int key, const char *text, struct argp_state *state)
{
    arguments *a = state->input;
    if (key == KEY_SEED && !parse_count(text, 0, UINT32_MAX - 1, &a->seed)) argp_error(state, "--seed takes a number from 0, not '%s'", text);
    if (key == KEY_SIZE && !parse_size(text, &a->size)) argp_error(state, "--size takes WxH of 1 to 8192, not '%s'", text);
    if (key == KEY_DOORS && !app_doors_parse(text, &a->doors)) argp_error(state, "--doors takes open, shut or scene, not '%s'", text);
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case KEY_VIEWS: a->views = text; break;
    case KEY_CULLER:
        if (a->culler_count == CULLERS_MOST) argp_error(state, "too many of one option");
        a->cullers[a->culler_count++] = text;
        break;
    case KEY_ZONE:
        if (a->zones.count == ZONE_OPTIONS_MOST) argp_error(state, "too many of one option");
        a->zones.texts[a->zones.count++] = text;
        break;
    case KEY_PLUGIN:
        if (a->plugins.count == APP_PLUGINS_MOST) argp_error(state, "too many of one option");
        a->plugins.files[a->plugins.count++] = text;
        break;
    case KEY_FAMILY: add_family(a, text, state); break;
    case KEY_JSON: a->json = text; break;
    case KEY_SVG: a->svg = text; break;
    case KEY_SEED:
    case KEY_SIZE:
    case KEY_DOORS: parse_numbers(key, text, state); break;
    case ARGP_KEY_ARG:
        if (a->scene) argp_error(state, "one SCENE, not also '%s'", text);
        a->scene = text;
        break;
    case ARGP_KEY_END:
        if (!a->scene) argp_error(state, "SCENE is missing");
        if (!a->family_count) add_family(a, NULL, state);
        if (!a->culler_count) a->cullers[a->culler_count++] = "scene";
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static int is_stdout(const char *file)
{
    return file && strcmp(file, "-") == 0;
}

// Writes what was made to the file, or to the stream where file is NULL, and frees it.
static result write_text(app *a, const char *file, FILE *stream, const bench_text *text)
{
    result done = RESULT_OK;
    if (file) done = file_write(file, text->bytes, text->size, &a->report);
    else fwrite(text->bytes, 1, text->size, stream);
    memory_free(a->memory, text->bytes, text->size + 1, 1);
    return done;
}

static result write_results(app *a, const arguments *q, const stress_request *request, const stress_result *s)
{
    const bench_labels labels = {scene_label(q->scene, &a->texts), request->bench->path->name};
    bench_text text;
    if (!labels.scene || stress_table(request, s, &text) != RESULT_OK) return report_no_memory(&a->report, NULL);
    result done = write_text(a, NULL, is_stdout(q->json) ? stderr : stdout, &text);
    if (done == RESULT_OK && q->json) {
        if (stress_json(request, s, &labels, &text) != RESULT_OK) return report_no_memory(&a->report, NULL);
        done = write_text(a, is_stdout(q->json) ? NULL : q->json, stdout, &text);
    }
    if (done == RESULT_OK && q->svg) {
        if (stress_svg(request, s, &labels, &text) != RESULT_OK) return report_no_memory(&a->report, NULL);
        done = write_text(a, q->svg, stdout, &text);
    }
    return done;
}

static result run_stress(app *a, const arguments *q, const camera_path *path, uint32_t *failed)
{
    bench_strategy_request strategies[CULLERS_MOST];
    chain_book book = {0};
    stress_result results;
    result done = chain_book_open(a, &q->zones, &book);
    for (uint32_t i = 0; i < q->culler_count && done == RESULT_OK; ++i) done = chain_book_strategy(&book, q->cullers[i], &strategies[i]);
    chain_book_close(&book);
    if (done != RESULT_OK) return done;
    const bench_request bench = {.scene = a->scene, .path = path, .strategies = strategies, .strategy_count = q->culler_count,
                                 .doors = app_doors_of(&q->doors), .plugins = a->plugins, .services = &a->services, .repeat = 1,
                                 .width_px = q->size.width_px, .height_px = q->size.height_px, .truth = BENCH_TRUTH};
    const stress_request request = {&bench, q->families, q->family_count, q->seed};
    done = stress_run(&request, &a->report, &results);
    if (done != RESULT_OK) return done;
    done = write_results(a, q, &request, &results);
    *failed = stress_failed(&results);
    if (done == RESULT_OK && *failed)
        report_error(&a->report, NULL, 0, "in %u of %u rows a chain promises to lose nothing, and did; see the column missed", *failed, results.series_count);
    stress_result_free(&results);
    return done;
}

// What can be known before the scene is read is told before it.
static result check_early(app *a, const arguments *q)
{
    result done = chains_check(a, q->cullers, q->culler_count, &q->zones);
    if (done == RESULT_OK && q->json && !is_stdout(q->json)) done = file_can_write(q->json, &a->report);
    if (done == RESULT_OK && q->svg) done = file_can_write(q->svg, &a->report);
    return done;
}

int command_stress(int argc, char **argv)
{
    static const struct argp parser = {options, parse, "SCENE",
                                       "Runs cullers against the truth on the scene moved, scaled, turned, jittered, doubled, and looked at by extreme "
                                       "cameras, and tells the first magnitude at which anything changes. Exit code 1: a chain lost what it promised.",
                                       NULL, NULL, NULL};
    arguments q = {.size = {320, 180}, .views = "auto:8", .seed = 1};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    app a;
    camera_path path = {0};
    uint32_t failed = 0;
    const import_options import = {.doors = app_doors_import(q.doors)};
    result done = app_open(&a, &q.plugins);
    if (done == RESULT_OK) done = check_early(&a, &q);
    if (done == RESULT_OK) done = import_scene(q.scene, &import, a.memory, &a.report, &a.scene);
    if (done == RESULT_OK) done = camera_path_load(q.views, a.scene, (double)q.size.width_px / q.size.height_px, a.memory, &a.report, &path);
    if (done == RESULT_OK) done = run_stress(&a, &q, &path, &failed);
    camera_path_free(&path, a.memory);
    app_close(&a);
    return done == RESULT_OK && failed ? EXIT_CHECK_FAILED : app_exit_code(done);
}
