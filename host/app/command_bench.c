// portcullis bench: strategies over a path, as a table, JSON and pictures.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "../../bench/bench.h"
#include "../../bench/against.h"
#include "../../bench/shard.h"
#include "../../bench/trace.h"
#include "../core/file.h"
#include "bench_results.h"
#include "chains.h"

#include <argp.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
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
    KEY_PLUGIN,
    KEY_SHARD,
    KEY_COSTS,
    KEY_FRAMES,
    KEY_TRACE,
    KEY_AGAINST,
    KEY_REFERENCE,
    KEY_SLOWER,
    KEY_TIMES
};

typedef enum shard_choice { SHARD_AUTO, SHARD_NONE, SHARD_GIVEN } shard_choice; // AUTO: as the starter's environment says
enum { PART_BYTES = 4096 };

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
    shard_choice sharding;
    bench_shard shard;
    char part[PART_BYTES];
    bench_costs costs;
    bench_times times;
    const char *frames, *trace;
    against_request against; // path NULL: nobody asks
} arguments;

static const struct argp_option options[] = {
    {"views", KEY_VIEWS, APP_VIEWS, 0, "the camera path; needed", 0},
    {"culler", KEY_CULLER, "CHAIN|scene", 0,
     "a strategy: this chain in all zones, such as frustum or octree[leaf=64]+occlusion; "
     "scene: what the scene file names per zone, frustum where it names none (default); "
     "NAME=CHAIN;CHAIN: zones of that name have the first chain, all others the last one, and so on with further names; may stand several times",
     0},
    {"zone", KEY_ZONE, "NAME=CHAIN", 0,
     "in every strategy these zones take this chain, whatever --culler says; NAME may be a pattern such as cellar*; may stand several times", 0},
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
    {"frames", KEY_FRAMES, "FILE|-", 0, "a line a strategy and view as CSV: counters, and medians of times over the passes", 0},
    {"trace", KEY_TRACE, "FILE", 0, "spans of flow, steps, draws, tests and captures of one more pass in Chrome's Trace Event Format, for Perfetto", 0},
    {"against", KEY_AGAINST, "OLD.json", 0,
     "beside an earlier run of bench --times: exit code 1 when a strategy is slower by the rule of docs/bench.md, or a counter is worse", 0},
    {"reference", KEY_REFERENCE, "NAME", 0, "the strategy that tells how fast the machine is today (default brute, else none)", 0},
    {"slower", KEY_SLOWER, "PERCENT", 0, "what counts as slower: so much and more, 1 to 1000 (default 10)", 0},
    {"times", KEY_TIMES, NULL, 0, "the JSON has each view's least times too", 0},
    {"costs", KEY_COSTS, "measured|fixed", 0,
     "what cullers weigh pictures by: of this renderer (default), or fixed numbers, so that another run draws the same; shards take fixed ones", 0},
    {"shard", KEY_SHARD, "I/N|auto|none", 0,
     "only the I-th of N parts of the path, into a part FILE.I-of-N of what --json or --csv names, for portcullis merge; a stopped shard goes on when it is started "
     "again (default auto: I and N from Slurm's, Open MPI's or PMI's environment, none without)",
     0},
    {"plugin", KEY_PLUGIN, "FILE", 0, "look at this library first; may stand several times", 0},
    {0},
};

static int parse_shard(const char *text, arguments *a)
{
    a->sharding = strcmp(text, "auto") == 0 ? SHARD_AUTO : strcmp(text, "none") == 0 ? SHARD_NONE : SHARD_GIVEN;
    return a->sharding != SHARD_GIVEN || shard_parse(text, &a->shard);
}

static int parse_costs(const char *text, bench_costs *out)
{
    *out = strcmp(text, "fixed") == 0 ? BENCH_COSTS_FIXED : BENCH_COSTS_MEASURED;
    return *out == BENCH_COSTS_FIXED || strcmp(text, "measured") == 0;
}

static int parse_slower(const char *text, against_request *out)
{
    uint32_t percent;
    const int good = parse_count(text, 1, 1000, &percent);
    if (good) out->least_percent = percent;
    return good;
}

static void parse_numbers(int key, const char *text, struct argp_state *state)
{
    arguments *a = state->input;
    if (key == KEY_SIZE && !parse_size(text, &a->size)) argp_error(state, "--size takes WxH of 1 to 8192, not '%s'", text);
    if (key == KEY_REPEAT && !parse_count(text, 1, 10000, &a->repeat)) argp_error(state, "--repeat takes 1 to 10000, not '%s'", text);
    if (key == KEY_LATENCY && !parse_count(text, 0, 64, &a->latency)) argp_error(state, "--query-latency takes 0 to 64, not '%s'", text);
    if (key == KEY_SAMPLES && !parse_count(text, 1, BENCH_SAMPLES_MOST, &a->samples)) argp_error(state, "--samples takes 1 to 8, not '%s'", text);
    if (key == KEY_FRAME_MS && !parse_ms(text, &a->frame_ms)) argp_error(state, "--frame-ms takes 0 to 100000 milliseconds, not '%s'", text);
    if (key == KEY_SWAP && !parse_count(text, 1, SWAP_VIEWS_MOST, &a->swap)) argp_error(state, "--swap takes 1 to 1000000 views, not '%s'", text);
    if (key == KEY_SHARD && !parse_shard(text, a)) argp_error(state, "--shard takes I/N with 1 <= I <= N <= 1000000, auto or none, not '%s'", text);
    if (key == KEY_SLOWER && !parse_slower(text, &a->against)) argp_error(state, "--slower takes 1 to 1000 percent, not '%s'", text);
    if (key == KEY_COSTS && !parse_costs(text, &a->costs)) argp_error(state, "--costs takes measured or fixed, not '%s'", text);
    if (key == KEY_DOORS && !app_doors_parse(text, &a->doors)) argp_error(state, "--doors takes open, shut or scene, not '%s'", text);
}

static void add_text(const char **list, uint32_t *count, uint32_t most, const char *text, struct argp_state *state)
{
    if (*count == most) argp_error(state, "too many of one option");
    list[(*count)++] = text;
}

static const char *variable(const char *name)
{
    return getenv(name);
}

// Where this process's part goes, when there is one.
static void check_shard(arguments *a, struct argp_state *state)
{
    const char *base = a->json && !is_stdout(a->json) ? a->json : a->csv && !is_stdout(a->csv) ? a->csv : NULL;
    if (a->sharding == SHARD_AUTO) (void)shard_of_environment(variable, &a->shard);
    if (!a->shard.count) return;
    if (!base) argp_error(state, "a shard's part is named after a file: name one with --json or --csv, or say --shard none");
    if (a->against.path) argp_error(state, "--against compares times of one process: leave it out, or say --shard none");
    if (a->frames || a->trace) argp_error(state, "--frames and --trace are of the whole path: give --frames to portcullis merge, or say --shard none");
    if (a->images) argp_error(state, "--images shows the worst view of the whole path: leave it out, or say --shard none");
    if (snprintf(a->part, sizeof a->part, "%s.%u-of-%u", base, a->shard.index, a->shard.count) >= (int)sizeof a->part - 16)
        argp_error(state, "the name '%s' is too long", base);
    a->shard.part = a->part;
    a->costs = BENCH_COSTS_FIXED;
}

static void check_arguments(arguments *a, struct argp_state *state)
{
    if (!a->scene) argp_error(state, "SCENE is missing");
    if (a->truth == BENCH_NO_TRUTH && a->samples > 1) argp_error(state, "--samples is about the truth: leave --no-truth out");
    if (a->images && a->samples > 1) argp_error(state, "--images shows pixels: leave --samples out");
    if (a->size.width_px * a->samples > APP_SIDE_MOST || a->size.height_px * a->samples > APP_SIDE_MOST)
        argp_error(state, "--size times --samples is over %d: a picture of %d x %d samples is the largest", APP_SIDE_MOST, APP_SIDE_MOST, APP_SIDE_MOST);
    if (is_stdout(a->json) + is_stdout(a->csv) + is_stdout(a->frames) > 1) argp_error(state, "--json, --csv and --frames can't share stdout: name a file");
    if (!a->views) argp_error(state, "--views is missing; name a .views file, auto:N, auto:walk:N, auto:edges:N or path:NAME");
    if (a->swap && a->culler_count < 2) argp_error(state, "--swap needs two or more --culler to go through");
    if (a->swap && a->culler_count == STRATEGIES_MOST) argp_error(state, "too many of one option");
    check_shard(a, state);
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
    case KEY_FRAMES: a->frames = text; break;
    case KEY_TRACE: a->trace = text; break;
    case KEY_AGAINST: a->against.path = text; break;
    case KEY_REFERENCE: a->against.reference = text; break;
    case KEY_TIMES: a->times = BENCH_TIMES_OF_VIEWS; break;
    case KEY_PICTURES: a->pictures = BENCH_PICTURES_ALL; break;
    case KEY_NO_PICTURES: a->pictures = BENCH_PICTURES_NONE; break;
    case KEY_SIZE:
    case KEY_REPEAT:
    case KEY_LATENCY:
    case KEY_SAMPLES:
    case KEY_FRAME_MS:
    case KEY_SWAP:
    case KEY_SHARD:
    case KEY_COSTS:
    case KEY_SLOWER:
    case KEY_DOORS: parse_numbers(key, text, state); break;
    case ARGP_KEY_ARG:
        if (a->scene) argp_error(state, "one SCENE, not also '%s'", text);
        a->scene = text;
        break;
    case ARGP_KEY_END: check_arguments(a, state); break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
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

// Rows of one shard mean nothing alone: where its part is, and what to do with all of them.
static void tell_part(app *a, const bench_request *q)
{
    const view_range range = shard_range(&q->shard, q->path->count);
    const int base = (int)(strrchr(q->shard.part, '.') - q->shard.part);
    report_note(&a->report, "%s: views %u to %u of %u; with all %u parts: portcullis merge %.*s.*-of-%u --json %.*s", q->shard.part, range.first, range.end,
                q->path->count, q->shard.count, base, q->shard.part, q->shard.count, base, q->shard.part);
}

static bench_output output_of(const arguments *q, const bench_request *bench, const bench_labels *labels)
{
    return (bench_output){bench, labels, q->json, q->csv, q->frames};
}

// What seems slower is measured again before it is said: the least of more passes, which what is truly slower does not get under.
enum { AGAINST_RUNS = 3 };

static result compare_again(app *a, const arguments *q, const against_run *now, bench_result *least, bench_text *text, against_found *found)
{
    result done = against_tell(&q->against, now, &a->report, text, found);
    for (int runs = 1; done == RESULT_OK && found->slower && runs < AGAINST_RUNS; ++runs) {
        bench_result again;
        memory_free(a->memory, text->bytes, text->size + 1, 1);
        report_note(&a->report, "%u times seem slower: measured again", found->slower);
        done = bench_run(now->bench, &a->report, &again);
        if (done != RESULT_OK) return done;
        against_fold(least, &again);
        bench_result_free(&again);
        done = against_tell(&q->against, now, &a->report, text, found);
    }
    return done;
}

static result tell_against(app *a, const arguments *q, const against_run *now, bench_result *least, uint32_t *failed)
{
    bench_text text;
    against_found found = {0};
    const result done = compare_again(a, q, now, least, &text, &found);
    if (done != RESULT_OK) return done;
    fwrite(text.bytes, 1, text.size, is_stdout(q->json) || is_stdout(q->csv) || is_stdout(q->frames) ? stderr : stdout);
    memory_free(a->memory, text.bytes, text.size + 1, 1);
    *failed += found.regressions;
    return RESULT_OK;
}

static result run_and_tell(app *a, const arguments *q, const bench_request *bench, const bench_labels *labels, uint32_t *failed)
{
    bench_result results;
    result done = bench_run(bench, &a->report, &results);
    if (done != RESULT_OK && q->images) (void)rmdir(q->images); // leaves it where something is in it
    if (done != RESULT_OK) return done;
    const bench_output output = output_of(q, bench, labels);
    if (bench->shard.count) tell_part(a, bench);
    else {
        done = bench_results_write(a->memory, &a->report, &output, &results);
        *failed = bench_results_tell_failures(&a->report, bench, &results);
        if (done == RESULT_OK && q->against.path) done = tell_against(a, q, &(against_run){bench, labels, &results}, &results, failed);
    }
    bench_result_free(&results);
    return done;
}

static result run_traced(app *a, const arguments *q, bench_request *bench, const bench_labels *labels, uint32_t *failed)
{
    if (!q->trace) return run_and_tell(a, q, bench, labels, failed);
    bench->trace = trace_open(a->memory);
    if (!bench->trace) return report_no_memory(&a->report, NULL);
    result done = run_and_tell(a, q, bench, labels, failed);
    if (done == RESULT_OK) done = trace_write(bench->trace, q->trace, &a->report);
    trace_close(bench->trace);
    return done;
}

static result run_shard(app *a, const arguments *q, bench_request *bench, const bench_labels *labels, uint32_t *failed)
{
    if (!q->shard.count) return run_traced(a, q, bench, labels, failed);
    char *identity = shard_identity(bench, labels);
    if (!identity) return report_no_memory(&a->report, NULL);
    bench->shard.identity = identity;
    const result done = run_traced(a, q, bench, labels, failed);
    memory_free(a->memory, identity, strlen(identity) + 1, 1);
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
    bench_request bench = {.scene = a->scene, .path = path, .strategies = strategies, .doors = app_doors_of(&q->doors),
                           .plugins = a->plugins, .services = &a->services,
                           .strategy_count = count, .width_px = q->size.width_px, .height_px = q->size.height_px, .repeat = q->repeat,
                           .query_latency = q->latency, .samples = q->samples, .truth = q->truth, .ids = q->ids, .pictures = q->pictures,
                           .frame_ms = q->frame_ms, .images = q->images, .costs = q->costs, .times = q->times, .shard = q->shard};
    const bench_labels labels = {scene_label(q->scene, &a->texts), path->name};
    if (!labels.scene) return report_no_memory(&a->report, NULL);
    return run_shard(a, q, &bench, &labels, failed);
}

// What can be known before the scene is read is told before it.
static result check_early(app *a, const arguments *q)
{
    const bench_output output = output_of(q, NULL, NULL);
    result done = chains_check(a, q->cullers, q->culler_count, &q->zones);
    if (done == RESULT_OK) done = q->shard.count ? file_can_write(q->part, &a->report) : bench_results_check(&a->report, &output);
    if (done == RESULT_OK && q->against.path) done = against_check(&q->against, &a->report);
    if (done == RESULT_OK && q->trace) done = file_can_write(q->trace, &a->report);
    return done;
}

int command_bench(int argc, char **argv)
{
    static const struct argp parser = {options, parse, "SCENE", "Measures strategies on a scene and camera path against the truth.",
                                       NULL,    NULL,  NULL};
    arguments q = {.repeat = 3, .samples = 1, .size = {1280, 720}, .truth = BENCH_TRUTH, .ids = BENCH_RUNS, .against = {.least_percent = 10}};
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
