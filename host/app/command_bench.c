// portcullis bench: strategies over a path, as a table, JSON and pictures.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "../../bench/bench.h"
#include "../core/file.h"
#include "chains.h"

#include <argp.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { STRATEGIES_MOST = 64, SWAP_VIEWS_MOST = 1000000 };
enum {
    KEY_VIEWS = 256,
    KEY_CULLER,
    KEY_ZONE,
    KEY_SWAP,
    KEY_SIZE,
    KEY_REPEAT,
    KEY_NO_TRUTH,
    KEY_IDS,
    KEY_DOORS,
    KEY_IMAGES,
    KEY_LATENCY,
    KEY_SAMPLES,
    KEY_FRAME_MS,
    KEY_JSON,
    KEY_CSV,
    KEY_PICTURES,
    KEY_NO_PICTURES,
    KEY_NO_MOVERS,
    KEY_PLUGIN
};

typedef enum movers_choice { MOVERS_DRAWN, MOVERS_AWAY } movers_choice;

typedef struct arguments {
    const char *scene, *views, *images, *json, *csv;
    const char *cullers[STRATEGIES_MOST];
    zone_options zones;
    uint32_t culler_count, swap, repeat, latency, samples;
    double frame_ms;
    app_size size;
    doors_choice doors;
    bench_truth truth;
    bench_ids ids;
    bench_pictures pictures;
    movers_choice movers;
    app_plugin_files plugins;
} arguments;

static const struct argp_option options[] = {
    {"views", KEY_VIEWS, APP_VIEWS, 0, "the camera path; needed", 0},
    {"culler", KEY_CULLER, "CHAIN|scene", 0,
     "a strategy: this chain in all zones, such as frustum or octree[leaf=64]+occlusion; "
     "scene: what the scene file names per zone, frustum where it names none (default); may stand several times",
     0},
    {"zone", KEY_ZONE, "NAME=CHAIN", 0,
     "in every strategy these zones take this chain; NAME may be a pattern such as cellar*; may stand several times", 0},
    {"swap", KEY_SWAP, "N", 0, "a further strategy swap/N: every N views each zone goes on to its chain of the next --culler, neighbours one apart",
     0},
    {"size", KEY_SIZE, "WxH", 0, "of the picture (default 1280x720)", 0},
    {"repeat", KEY_REPEAT, "N", 0, "passes over the path (default 3)", 0},
    {"samples", KEY_SAMPLES, "N", 0, "each pixel is judged at N x N places, 1 to 8 (default 1): what is seen, and what is missed in samples", 0},
    {"no-truth", KEY_NO_TRUTH, NULL, 0, "time only: no pictures, no GL unless a culler tests", 0},
    {"frame-ms", KEY_FRAME_MS, "X", 0, "cullers are told that a frame may take so long, pictures and all: they spread what they can (default 0: nobody says)", 0},
    {"ids", KEY_IDS, NULL, 0, "writing the id of every drawn item counts as culling", 0},
    {"doors", KEY_DOORS, "open|shut|scene", 0, "how doors stand (default open; scene: as its file says)", 0},
    {"no-movers", KEY_NO_MOVERS, NULL, 0, "doors' leaves and all else that moves taken away: what stands still is not hidden by them", 0},
    {"pictures", KEY_PICTURES, NULL, 0, "PSNR, SSIM, FLIP and crack pixels of every strategy beside full geometry (default: of those that show pictures)", 0},
    {"no-pictures", KEY_NO_PICTURES, NULL, 0, "of none", 0},
    {"images", KEY_IMAGES, "DIR", 0,
     "write a picture of each strategy, and of its worst view; where pictures are compared, of the view with the largest FLIP what is true, what is shown, and the "
     "differences, with cracks in cyan",
     0},
    {"query-latency", KEY_LATENCY, "L", 0, "an answer is readable L steps later (default 0)", 0},
    {"json", KEY_JSON, "FILE|-", 0, "results in Google Benchmark's shape", 0},
    {"csv", KEY_CSV, "FILE|-", 0, "results as CSV, a line a strategy", 0},
    {"plugin", KEY_PLUGIN, "FILE", 0, "look at this library first; may stand several times", 0},
    {0},
};

static void parse_numbers(int key, const char *text, struct argp_state *state)
{
    arguments *a = state->input;
    if (key == KEY_SIZE && !parse_size(text, &a->size)) argp_error(state, "--size takes WxH of 1 to 8192, not '%s'", text);
    if (key == KEY_REPEAT && !parse_count(text, 1, 10000, &a->repeat)) argp_error(state, "--repeat takes 1 to 10000, not '%s'", text);
    if (key == KEY_LATENCY && !parse_count(text, 0, 64, &a->latency)) argp_error(state, "--query-latency takes 0 to 64, not '%s'", text);
    if (key == KEY_SAMPLES && !parse_count(text, 1, BENCH_SAMPLES_MOST, &a->samples)) argp_error(state, "--samples takes 1 to 8, not '%s'", text);
    if (key == KEY_FRAME_MS && !parse_ms(text, &a->frame_ms)) argp_error(state, "--frame-ms takes 0 to 100000 milliseconds, not '%s'", text);
    if (key == KEY_SWAP && !parse_count(text, 1, SWAP_VIEWS_MOST, &a->swap)) argp_error(state, "--swap takes 1 to 1000000 views, not '%s'", text);
    if (key == KEY_DOORS && !app_doors_parse(text, &a->doors)) argp_error(state, "--doors takes open, shut or scene, not '%s'", text);
}

static void add_text(const char **list, uint32_t *count, uint32_t most, const char *text, struct argp_state *state)
{
    if (*count == most) argp_error(state, "too many of one option");
    list[(*count)++] = text;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case KEY_VIEWS: a->views = text; break;
    case KEY_NO_MOVERS: a->movers = MOVERS_AWAY; break;
    case KEY_CULLER: add_text(a->cullers, &a->culler_count, STRATEGIES_MOST, text, state); break;
    case KEY_ZONE: add_text(a->zones.texts, &a->zones.count, ZONE_OPTIONS_MOST, text, state); break;
    case KEY_PLUGIN: add_text(a->plugins.files, &a->plugins.count, APP_PLUGINS_MOST, text, state); break;
    case KEY_NO_TRUTH: a->truth = BENCH_NO_TRUTH; break;
    case KEY_IDS: a->ids = BENCH_IDS; break;
    case KEY_IMAGES: a->images = text; break;
    case KEY_JSON: a->json = text; break;
    case KEY_CSV: a->csv = text; break;
    case KEY_PICTURES: a->pictures = BENCH_PICTURES_ALL; break;
    case KEY_NO_PICTURES: a->pictures = BENCH_PICTURES_NONE; break;
    case KEY_SIZE:
    case KEY_REPEAT:
    case KEY_LATENCY:
    case KEY_SAMPLES:
    case KEY_FRAME_MS:
    case KEY_SWAP:
    case KEY_DOORS: parse_numbers(key, text, state); break;
    case ARGP_KEY_ARG:
        if (a->scene) argp_error(state, "one SCENE, not also '%s'", text);
        a->scene = text;
        break;
    case ARGP_KEY_END:
        if (!a->scene) argp_error(state, "SCENE is missing");
        if (a->truth == BENCH_NO_TRUTH && a->samples > 1) argp_error(state, "--samples is about the truth: leave --no-truth out");
        if (a->images && a->samples > 1) argp_error(state, "--images shows pixels: leave --samples out");
        if (a->size.width_px * a->samples > APP_SIDE_MOST || a->size.height_px * a->samples > APP_SIDE_MOST)
            argp_error(state, "--size times --samples is over %d: a picture of %d x %d samples is the largest", APP_SIDE_MOST, APP_SIDE_MOST, APP_SIDE_MOST);
        if (a->json && a->csv && strcmp(a->json, "-") == 0 && strcmp(a->csv, "-") == 0) argp_error(state, "--json and --csv can't both go to stdout: name a file");
        if (!a->views) argp_error(state, "--views is missing; name a .views file, auto:N, auto:walk:N, auto:edges:N or path:NAME");
        if (a->swap && a->culler_count < 2) argp_error(state, "--swap needs two or more --culler to go through");
        if (a->swap && a->culler_count == STRATEGIES_MOST) argp_error(state, "too many of one option");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static void print_text(const bench_text *text, FILE *to)
{
    fwrite(text->bytes, 1, text->size, to);
}

static result write_text(app *a, const char *file, const bench_text *text)
{
    if (strcmp(file, "-") != 0) return file_write(file, text->bytes, text->size, &a->report);
    print_text(text, stdout);
    if (text->size && text->bytes[text->size - 1] != '\n') printf("\n");
    return RESULT_OK;
}

typedef struct output {
    const bench_request *bench;
    const bench_labels *labels;
    const char *json, *csv; // files, "-" or NULL
} output;

static int is_stdout(const char *file)
{
    return file && strcmp(file, "-") == 0;
}

typedef result (*text_maker)(const bench_result *b, const bench_request *q, const bench_labels *labels, bench_text *out);

static result write_made(app *a, const output *o, const bench_result *b, text_maker make, const char *file)
{
    bench_text text;
    if (!file) return RESULT_OK;
    if (make(b, o->bench, o->labels, &text) != RESULT_OK) return report_no_memory(&a->report, NULL);
    const result done = write_text(a, file, &text);
    memory_free(a->memory, text.bytes, text.size + 1, 1);
    return done;
}

// The table is for people where other results go to stdout.
static result write_results(app *a, const output *o, const bench_result *b)
{
    bench_text text;
    if (bench_table(b, o->bench, o->labels, &text) != RESULT_OK) return report_no_memory(&a->report, NULL);
    print_text(&text, is_stdout(o->json) || is_stdout(o->csv) ? stderr : stdout);
    memory_free(a->memory, text.bytes, text.size + 1, 1);
    const result done = write_made(a, o, b, bench_json, o->json);
    return done == RESULT_OK ? write_made(a, o, b, bench_csv, o->csv) : done;
}

static uint32_t tell_failures(app *a, const arguments *q, const bench_result *b)
{
    uint32_t failed = 0;
    for (uint32_t i = 0; i < b->row_count; ++i) {
        const bench_row *row = &b->rows[i];
        if (row->picture_differs)
            report_error(&a->report, NULL, 0, "%s: %llu pixels of %u views show something else than the items that it says it drew", row->name,
                         (unsigned long long)row->picture_differs, row->pictures_compared);
        else if (bench_check_failed(row))
            report_error(&a->report, NULL, 0, "%s promises to lose nothing, and missed %llu pixels and %llu items; worst is view %u", row->name,
                         (unsigned long long)row->missed_pixels, (unsigned long long)row->missed_items, row->worst_view);
        failed += bench_check_failed(row);
        if (q->truth == BENCH_TRUTH && row->items_visible <= 0 && i == 0)
            report_warning(&a->report, NULL, 0, "no view of this path sees anything; that nothing is missed says nothing");
    }
    return failed;
}

static result make_strategies(app *a, const arguments *q, bench_strategy_request *out, uint32_t *out_count)
{
    chain_book book = {0};
    const uint32_t count = q->culler_count ? q->culler_count : 1;
    result done = chain_book_open(a, &q->zones, &book);
    for (uint32_t i = 0; i < count && done == RESULT_OK; ++i) done = chain_book_strategy(&book, q->culler_count ? q->cullers[i] : NULL, &out[i]);
    if (done == RESULT_OK && q->swap) done = chain_book_swap(&book, out, count, q->swap, &out[count]);
    chain_book_close(&book);
    *out_count = count + (q->swap > 0);
    return done;
}

static result run_bench(app *a, const arguments *q, const camera_path *path, uint32_t *failed)
{
    bench_strategy_request strategies[STRATEGIES_MOST];
    uint32_t count = 0;
    result done = make_strategies(a, q, strategies, &count);
    if (done != RESULT_OK) return done;
    if (q->images && mkdir(q->images, 0777) != 0 && errno != EEXIST)
        return report_error(&a->report, q->images, 0, "cannot make the folder: %s", strerror(errno));
    const bench_request bench = {.scene = a->scene, .path = path, .strategies = strategies, .doors = app_doors_of(&q->doors),
                                 .plugins = a->plugins, .services = &a->services,
                                 .strategy_count = count, .width_px = q->size.width_px, .height_px = q->size.height_px, .repeat = q->repeat,
                                 .query_latency = q->latency, .samples = q->samples, .truth = q->truth, .ids = q->ids, .pictures = q->pictures,
                                 .frame_ms = q->frame_ms, .images = q->images};
    const bench_labels labels = {scene_label(q->scene, &a->texts), path->name};
    if (!labels.scene) return report_no_memory(&a->report, NULL);
    bench_result results;
    done = bench_run(&bench, &a->report, &results);
    if (done != RESULT_OK && q->images) (void)rmdir(q->images); // leaves it where something is in it
    if (done != RESULT_OK) return done;
    done = write_results(a, &(output){&bench, &labels, q->json, q->csv}, &results);
    *failed = tell_failures(a, q, &results);
    bench_result_free(&results);
    return done;
}

// What can be known before the scene is read is told before it.
static result check_early(app *a, const arguments *q)
{
    result done = chains_check(a, q->cullers, q->culler_count, &q->zones);
    if (done == RESULT_OK && q->json && !is_stdout(q->json)) done = file_can_write(q->json, &a->report);
    if (done == RESULT_OK && q->csv && !is_stdout(q->csv)) done = file_can_write(q->csv, &a->report);
    return done;
}

int command_bench(int argc, char **argv)
{
    static const struct argp parser = {options, parse, "SCENE", "Measures strategies on a scene and camera path against the truth.",
                                       NULL,    NULL,  NULL};
    arguments q = {.repeat = 3, .samples = 1, .size = {1280, 720}, .truth = BENCH_TRUTH, .ids = BENCH_RUNS};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    app a;
    camera_path path = {0};
    uint32_t failed = 0;
    const import_options import = {.doors = app_doors_import(q.doors)};
    result done = app_open(&a, &q.plugins);
    if (done == RESULT_OK) done = check_early(&a, &q);
    if (done == RESULT_OK) done = import_scene(q.scene, &import, a.memory, &a.report, &a.scene);
    if (done == RESULT_OK && q.movers == MOVERS_AWAY) scene_movers_drop(a.scene);
    if (done == RESULT_OK) done = camera_path_load(q.views, a.scene, (double)q.size.width_px / q.size.height_px, a.memory, &a.report, &path);
    if (done == RESULT_OK) done = run_bench(&a, &q, &path, &failed);
    camera_path_free(&path, a.memory);
    app_close(&a);
    return done == RESULT_OK && failed ? EXIT_CHECK_FAILED : app_exit_code(done);
}
