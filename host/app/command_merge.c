// portcullis merge: the parts of a sharded bench, as one result.
// SPDX-License-Identifier: MIT
#include "../../bench/merge.h"
#include "bench_results.h"

#include <argp.h>
#include <stdlib.h>
#include <string.h>

enum { KEY_JSON = 256, KEY_CSV, KEY_FRAMES, KEY_TIMES };

typedef struct arguments {
    const char *json, *csv, *frames;
    const char **files; // as many as there are arguments
    uint32_t file_count;
    bench_times times;
} arguments;

static const struct argp_option options[] = {
    {"json", KEY_JSON, "FILE|-", 0, "results in Google Benchmark's shape", 0},
    {"csv", KEY_CSV, "FILE|-", 0, "results as CSV, a line a strategy", 0},
    {"frames", KEY_FRAMES, "FILE|-", 0, "a line a strategy and view as CSV", 0},
    {"times", KEY_TIMES, NULL, 0, "the JSON has each view's least times too", 0},
    {0},
};

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case KEY_JSON: a->json = text; break;
    case KEY_CSV: a->csv = text; break;
    case KEY_FRAMES: a->frames = text; break;
    case KEY_TIMES: a->times = BENCH_TIMES_OF_VIEWS; break;
    case ARGP_KEY_ARG: a->files[a->file_count++] = text; break;
    case ARGP_KEY_END:
        if (!a->file_count) argp_error(state, "PART is missing: name all parts, such as out.json.*-of-8");
        if (is_stdout(a->json) + is_stdout(a->csv) + is_stdout(a->frames) > 1) argp_error(state, "--json, --csv and --frames can't share stdout: name a file");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static int merge(const arguments *a)
{
    report r = report_to_stderr();
    merged m = {0};
    uint32_t failed = 0;
    bench_output output = {NULL, NULL, a->json, a->csv, a->frames};
    result done = bench_results_check(&r, &output);
    if (done == RESULT_OK) done = merge_open(a->files, a->file_count, allocator_heap(), &r, &m);
    if (done == RESULT_OK) {
        m.request.times = a->times;
        output.bench = &m.request;
        output.labels = &m.labels;
        done = bench_results_write(allocator_heap(), &r, &output, &m.result);
        failed = bench_results_tell_failures(&r, &m.request, &m.result);
    }
    merge_close(&m);
    return done == RESULT_OK && failed ? EXIT_CHECK_FAILED : app_exit_code(done);
}

int command_merge(int argc, char **argv)
{
    static const struct argp parser = {options, parse, "PART...", "Puts the parts of a sharded bench together: the same counters as one process's.",
                                       NULL,    NULL,  NULL};
    arguments a = {.files = calloc((size_t)argc, sizeof *a.files)};
    if (!a.files) return EXIT_USAGE;
    int code = EXIT_USAGE;
    if (argp_parse(&parser, argc, argv, 0, NULL, &a) == 0) code = merge(&a);
    free(a.files);
    return code;
}
