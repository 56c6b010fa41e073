// The bench's results in Google Benchmark's JSON shape.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "bench.h"
#include "commit.h"
#include "json_entry.h"
#include "json_text.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#ifndef PORTCULLIS_VERSION
#define PORTCULLIS_VERSION "unknown"
#endif

static void cpu_model(char *out, size_t size)
{
    snprintf(out, size, "unknown");
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[256];
    while (file && fgets(line, sizeof line, file)) {
        const char *value = strncmp(line, "model name", 10) == 0 ? strchr(line, ':') : NULL;
        if (!value) continue;
        snprintf(out, size, "%.*s", (int)strcspn(value + 2, "\n"), value + 2);
        break;
    }
    if (file) fclose(file);
}

static json_t *load_average(void)
{
    double load[3] = {0};
    json_t *list = json_array();
    const int got = getloadavg(load, 3);
    for (int i = 0; i < got; ++i) json_array_append_new(list, json_real(load[i]));
    return list;
}

static json_t *context_of(const bench_result *b, const bench_request *q, const bench_labels *labels)
{
    char date[40], host[256] = "", model[160], hash[24];
    const time_t now = time(NULL);
    struct tm local;
    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S%z", localtime_r(&now, &local));
    gethostname(host, sizeof host - 1);
    cpu_model(model, sizeof model);
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)q->scene->hash);
    return json_pack("{s:s, s:o, s:i, s:o, s:o, s:s, s:s, s:s, s:o, s:o, s:s, s:i, s:i, s:i, s:i, s:i, s:s, s:i, s:f, s:i, s:i, s:o, s:i, s:i}", "date", date, "host_name",
                     json_text(host), "num_cpus", (int)sysconf(_SC_NPROCESSORS_ONLN), "cpu_model", json_text(model), "load_avg", load_average(),
                     "library_version", PORTCULLIS_VERSION, "library_build_type",
#ifdef NDEBUG
                     "release",
#else
                     "debug",
#endif
                     "commit", PORTCULLIS_COMMIT, "gl_renderer", json_text(b->gl_used ? b->gl_name : "none"), "scene", json_text(labels->scene),
                     "scene_hash", hash, "width_px", (int)q->width_px, "height_px", (int)q->height_px, "samples", (int)q->samples,
                     "repeat", (int)q->repeat, "query_latency", (int)q->query_latency,
                     "costs", q->costs == BENCH_COSTS_FIXED ? "fixed" : "measured", "shards", (int)b->shards, "frame_ms", q->frame_ms, "zones", (int)b->zones,
                     "portals", (int)b->portals,
                     "path", json_text(labels->path), "warmup_views", (int)bench_warmup_views(q->path), "json_schema_version", 1);
}

typedef struct counter { const char *name; double value; } counter;
typedef enum measured { NOT_MEASURED, MEASURED } measured;

static json_t *number_of(double value)
{
    if (!isfinite(value)) return json_null();
    if (fabs(value) < 1e15 && value == (double)(json_int_t)value) return json_integer((json_int_t)value);
    return json_real(value);
}

static void set_counters(json_t *entry, const counter *counters, size_t count, measured how)
{
    for (size_t i = 0; i < count; ++i)
        json_object_set_new(entry, counters[i].name, how == MEASURED ? number_of(counters[i].value) : json_null());
}

// By nothing, a ratio has no value.
static double ratio_by(double ratio, double by)
{
    return by > 0 ? ratio : NAN;
}

static json_t *head_of(const bench_result *b, const bench_request *q, const bench_labels *labels, const bench_row *row)
{
    char name[8192];
    snprintf(name, sizeof name, "%s/%s/%s", labels->scene, labels->path, row->name);
    return json_pack("{s:o, s:o, s:s, s:i, s:i, s:f, s:f, s:s}", "name", json_text(name), "run_name", json_text(name), "run_type", "iteration",
                     "repetitions", (int)q->repeat, "iterations", (int)(q->repeat * b->views), "real_time", row->cull_ns, "cpu_time", row->cull_ns,
                     "time_unit", "ns");
}

static json_t *figures_of(const bench_figures *figures)
{
    json_t *all = json_object();
    for (uint32_t i = 0; i < figures->count; ++i) json_object_set_new(all, figures->list[i].name, number_of(figures->list[i].value));
    return all;
}

// Whole nanoseconds: no clock tells more.
static json_t *list_of(const double *values, uint32_t count)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < count; ++i) json_array_append_new(list, json_integer((json_int_t)(values[i] + 0.5)));
    return list;
}

static json_t *times_of(const bench_result *b, const bench_row *row)
{
    return json_pack("{s:o, s:o}", "cull_ns", list_of(row->least_cull_ns, b->least_count), "total_ns", list_of(row->least_total_ns, b->least_count));
}

json_t *bench_json_entry(const bench_result *b, const bench_request *q, const bench_labels *labels, const bench_row *row)
{
    json_t *entry = head_of(b, q, labels, row);
    if (!entry) return NULL;
    const counter always[] = {
        {"views", b->views}, {"pixels", (double)b->pixels}, {"polygons_total", (double)b->polygons_total}, {"polygons_drawn", row->polygons_drawn},
        {"triangles_drawn", row->triangles_drawn}, {"items_total", (double)b->items_total}, {"items_drawn", row->items_drawn}, {"runs", row->runs},
        {"cull_ns_mean", row->cull_ns_mean}, {"cull_ns_p95", row->cull_ns_p95}, {"cull_ns_p99", row->cull_ns_p99},
        {"portal_merges", (double)row->portal_merges}, {"limits_hit", (double)row->limits_hit}, {"stalls", (double)row->stalls},
        {"movers_drawn", row->movers_drawn}, {"build_ms", row->build_ms}, {"index_bytes", (double)row->index_bytes}, {"queries", row->queries},
        {"steps", row->steps}, {"refreshes", row->refreshes}, {"picture_bytes", (double)row->picture_bytes}, {"zones", row->zones}, {"volumes", row->volumes}, {"crossings", row->crossings}, {"swaps", (double)row->swaps},
        {"faults", (double)row->faults}, {"plugins_opened", b->plugins_opened}, {"indices_built", row->indices_built}, {"gl_used", b->gl_used}};
    const counter of_gl[] = {
        {"gl_ms", row->gl_ms}, {"total_ms", row->total_ms}, {"total_ms_mean", row->total_ms_mean}, {"total_ms_p95", row->total_ms_p95}, {"total_ms_p99", row->total_ms_p99},
        {"total_ms_p99_to_p50", ratio_by(row->total_ms > 0 ? row->total_ms_p99 / row->total_ms : 0, row->total_ms)},
        {"draw_calls", row->draw_calls}, {"state_changes", row->state_changes}};
    const counter of_truth[] = {
        {"polygons_visible", row->polygons_visible}, {"polygons_items", row->polygons_items}, {"items_visible", row->items_visible},
        {"floor", row->floor},
        {"excess", ratio_by(row->excess, row->polygons_visible)}, {"excess_items", ratio_by(row->excess_items, row->polygons_items)},
        {"hard_views", row->hard_views}, {"hard_excess", ratio_by(row->hard_excess, row->hard_visible)},
        {"missed_pixels", (double)row->missed_pixels},
        {"missed_items", (double)row->missed_items}, {"broken_items", (double)row->broken_items}, {"picture_differs", (double)row->picture_differs},
        {"pictures_compared", row->pictures_compared}, {"missed_pixels_max", (double)row->missed_pixels_max},
        {"movers_visible", row->movers_visible}};
    const counter of_pictures[] = {
        {"psnr", row->psnr}, {"ssim", row->has_ssim ? row->ssim : NAN}, {"flip", row->flip}, {"flip_p99", row->flip_p99}, {"flip_max", row->flip_max},
        {"flip_view", row->flip_view}, {"crack_pixels", (double)row->crack_pixels}, {"crack_inner", (double)row->crack_inner},
        {"crack_spills", (double)row->crack_spills}, {"crack_view", row->crack_view},
        {"popping", ratio_by(row->popping, row->popping_views)}, {"popping_p99", ratio_by(row->popping_p99, row->popping_views)},
        {"popping_max", ratio_by(row->popping_max, row->popping_views)}, {"popping_view", ratio_by(row->popping_view, row->popping_views)},
        {"popping_views", row->popping_views},
        {"mover_pixels", (double)row->mover_pixels}, {"mover_pixels_wrong", (double)row->mover_pixels_wrong},
        {"mover_pixels_wrong_far", (double)row->mover_pixels_wrong_far}, {"pictures_measured", row->pictures_measured}};
    const counter of_movers[] = {{"mover_update_ns", ratio_by(row->mover_update_ns, row->mover_update_ns)}};
    const counter of_swaps[] = {{"swap_ms", ratio_by(row->swap_ms, (double)row->swaps)}};
    const counter last[] = {{"front_walls_only", row->front_walls_only}};
    set_counters(entry, always, sizeof always / sizeof *always, MEASURED);
    set_counters(entry, of_gl, sizeof of_gl / sizeof *of_gl, b->gl_used ? MEASURED : NOT_MEASURED);
    set_counters(entry, of_truth, sizeof of_truth / sizeof *of_truth, q->truth == BENCH_TRUTH ? MEASURED : NOT_MEASURED);
    set_counters(entry, of_pictures, sizeof of_pictures / sizeof *of_pictures, row->pictures_measured ? MEASURED : NOT_MEASURED);
    set_counters(entry, of_movers, 1, MEASURED);
    set_counters(entry, of_swaps, 1, MEASURED);
    set_counters(entry, last, sizeof last / sizeof *last, MEASURED);
    if (q->times == BENCH_TIMES_OF_VIEWS) json_object_set_new(entry, "times", times_of(b, row));
    if (row->figures.count) json_object_set_new(entry, "figures", figures_of(&row->figures));
    return entry;
}

result bench_json(const bench_result *b, const bench_request *q, const bench_labels *labels, bench_text *out)
{
    json_t *benchmarks = json_array(), *context = context_of(b, q, labels);
    json_t *root = benchmarks && context ? json_pack("{s:O, s:O}", "context", context, "benchmarks", benchmarks) : NULL;
    int good = root != NULL;
    for (uint32_t i = 0; good && i < b->row_count; ++i) good = json_array_append_new(benchmarks, bench_json_entry(b, q, labels, &b->rows[i])) == 0;
    char *text = good ? json_dumps(root, JSON_INDENT(2)) : NULL;
    json_decref(context);
    json_decref(benchmarks);
    json_decref(root);
    if (!text) return RESULT_NO_MEMORY;
    const allocator *memory = q->services->memory;
    const size_t size = strlen(text);
    char *copy = memory_alloc(memory, size + 1, 1);
    if (copy) {
        memcpy(copy, text, size + 1);
        *out = (bench_text){copy, size};
    }
    free(text);
    return copy ? RESULT_OK : RESULT_NO_MEMORY;
}
