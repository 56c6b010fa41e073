// A bench beside an earlier run: see against.h. Both are read as JSON, so that one and the same code looks at either.
// SPDX-License-Identifier: MIT
#include "against.h"
#include "against_rule.h"

#include <jansson.h>

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double LEVEL = 0.01; // that any strategy of a run is called slower for nothing, by what chance alone does to views

typedef struct against {
    const against_request *q;
    report *r;
    json_t *before, *now; // whole results
    buffer text;
    double *scratch, *times; // 2 * views each
    uint32_t views, tests, failed;
    against_found found;
    double drift[2]; // of cull_ns, of total_ns
} against;

static const char *const KINDS[] = {"cull_ns", "total_ns"};

static void put(against *a, const char *format, ...)
{
    char line[1024];
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(line, sizeof line, format, values);
    va_end(values);
    if (length < 0 || !buffer_append(&a->text, line, (size_t)length < sizeof line ? (size_t)length : sizeof line - 1)) a->failed = 1;
}

// ---- The two runs ----

static result load(const against_request *q, report *r, json_t **out)
{
    json_error_t error;
    *out = json_load_file(q->path, JSON_REJECT_DUPLICATES, &error);
    if (!*out) return report_error(r, q->path, error.line > 0 ? (size_t)error.line : 0, "%s; name the JSON of an earlier bench --times", error.text);
    if (json_is_object(json_object_get(*out, "context")) && json_is_array(json_object_get(*out, "benchmarks"))) return RESULT_OK;
    json_decref(*out);
    *out = NULL;
    return report_error(r, q->path, 0, "is no result of a bench; name the JSON of an earlier bench --times");
}

static json_t *entries(json_t *run)
{
    return json_object_get(run, "benchmarks");
}

result against_check(const against_request *q, report *r)
{
    json_t *before;
    result done = load(q, r, &before);
    if (done != RESULT_OK) return done;
    if (!json_object_get(json_array_get(entries(before), 0), "times"))
        done = report_error(r, q->path, 0, "has no times of views; measure it again with bench --times");
    json_decref(before);
    return done;
}

static int same_of(const against *a, const char *key)
{
    return json_equal(json_object_get(json_object_get(a->before, "context"), key), json_object_get(json_object_get(a->now, "context"), key));
}

static result check_same(const against *a)
{
    static const char *const keys[] = {"scene", "scene_hash", "path", "width_px", "height_px", "samples", "repeat", "query_latency", "frame_ms", "costs"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; ++i)
        if (!same_of(a, keys[i])) return report_error(a->r, a->q->path, 0, "is of another measurement: its %s differs; give this one the same", keys[i]);
    return RESULT_OK;
}

// NULL: times are comparable.
static const char *other_machine(const against *a)
{
    static const char *const keys[] = {"cpu_model", "num_cpus", "gl_renderer", "library_build_type"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; ++i)
        if (!same_of(a, keys[i])) return keys[i];
    return NULL;
}

// The last part of "scene/path/strategy"; scene and path are the same in both runs.
static const char *name_of(const json_t *entry, const against *a)
{
    const json_t *context = json_object_get(a->now, "context");
    const char *name = json_string_value(json_object_get(entry, "name"));
    const size_t skip = json_string_length(json_object_get(context, "scene")) + json_string_length(json_object_get(context, "path")) + 2;
    return name && strlen(name) > skip ? name + skip : "";
}

static json_t *entry_named(const against *a, json_t *run, const char *name)
{
    size_t i;
    json_t *entry;
    json_array_foreach(entries(run), i, entry) if (strcmp(name_of(entry, a), name) == 0) return entry;
    return NULL;
}

// ---- Times ----

static int read_times(const json_t *entry, const char *kind, uint32_t count, double *out)
{
    const json_t *list = json_object_get(json_object_get(entry, "times"), kind);
    if (!list || json_array_size(list) != count) return 0;
    for (uint32_t v = 0; v < count; ++v) out[v] = json_number_value(json_array_get(list, v));
    return 1;
}

static int times_of(const against *a, const char *name, int kind, against_times *out)
{
    const json_t *before = entry_named(a, a->before, name), *now = entry_named(a, a->now, name);
    if (!before || !now || !read_times(before, KINDS[kind], a->views, a->times) || !read_times(now, KINDS[kind], a->views, a->times + a->views)) return 0;
    *out = (against_times){a->times, a->times + a->views, a->views};
    return 1;
}

static const char *reference_of(const against *a)
{
    static const char *const usual[] = {"brute", "none"};
    if (a->q->reference) return a->q->reference;
    for (int i = 0; i < 2; ++i)
        if (entry_named(a, a->before, usual[i]) && entry_named(a, a->now, usual[i])) return usual[i];
    return NULL;
}

static result find_drift(against *a, const char *reference)
{
    for (int kind = 0; kind < 2; ++kind) {
        against_times t;
        a->drift[kind] = 1;
        if (!reference) continue;
        if (!times_of(a, reference, kind, &t)) return report_error(a->r, a->q->path, 0, "times of the reference '%s' are not in both runs; choose another", reference);
        a->drift[kind] = against_drift(&t, a->scratch);
    }
    if (!reference)
        report_warning(a->r, NULL, 0, "neither brute nor none is in both runs: times are compared as they stand, and a slower machine looks like a slower culler");
    else put(a, "beside %s, %s: its views take %.3f times the cull time and %.3f times the whole time of then; others are told less that\n", a->q->path, reference,
             a->drift[0], a->drift[1]);
    return RESULT_OK;
}

static uint32_t judge_times(against *a, const char *name, int kind)
{
    static const char *const words[] = {"same", "SLOWER", "faster", "too few views to tell"};
    const against_rule rule = {1 + a->q->least_percent / 100, LEVEL / a->tests};
    against_times t;
    if (!times_of(a, name, kind, &t)) return 0;
    const against_finding f = against_judge(&t, a->drift[kind], &rule, a->scratch);
    put(a, "%s: %s %.3f of then, %s", name, KINDS[kind], f.ratio, words[f.verdict]);
    if (f.verdict == AGAINST_SLOWER || f.verdict == AGAINST_FASTER) put(a, " by over %g%% (p = %.2g)", a->q->least_percent, f.p);
    put(a, "\n");
    a->found.slower += f.verdict == AGAINST_SLOWER;
    return f.verdict == AGAINST_SLOWER;
}

// ---- Counters ----

static int is_counted(const char *key, const json_t *value)
{
    static const char *const apart[] = {"real_time", "cpu_time", "repetitions", "iterations", "total_ms_p99_to_p50"};
    for (size_t i = 0; i < sizeof apart / sizeof *apart; ++i)
        if (strcmp(key, apart[i]) == 0) return 0;
    return (json_is_number(value) || json_is_null(value)) && !strstr(key, "_ns") && !strstr(key, "_ms");
}

static int is_better_small(const char *key)
{
    static const char *const keys[] = {"missed_pixels", "missed_items", "broken_items", "picture_differs", "faults", "limits_hit", "crack_pixels", "polygons_drawn"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; ++i)
        if (strcmp(key, keys[i]) == 0) return 1;
    return 0;
}

// Cullers that weigh pictures by measured costs draw otherwise in each run.
static int is_repeatable(const against *a, const json_t *entry)
{
    const char *costs = json_string_value(json_object_get(json_object_get(a->now, "context"), "costs"));
    return (costs && strcmp(costs, "fixed") == 0) || json_number_value(json_object_get(entry, "picture_bytes")) <= 0;
}

static uint32_t compare_counters(against *a, const char *name, const json_t *before, json_t *now)
{
    const char *key;
    json_t *value;
    uint32_t worse = 0;
    json_object_foreach(now, key, value) {
        const json_t *old = json_object_get(before, key);
        if (!old || !is_counted(key, value) || json_number_value(old) == json_number_value(value)) continue;
        const int is_worse = is_better_small(key) && json_number_value(value) > json_number_value(old) && is_repeatable(a, now);
        put(a, "%s: %s %.10g, then %.10g%s\n", name, key, json_number_value(value), json_number_value(old), is_worse ? ": WORSE" : "");
        worse |= (uint32_t)is_worse;
    }
    return worse;
}

// ---- Both ----

static void compare_entry(against *a, json_t *now, const char *reference, int judges_times)
{
    const char *name = name_of(now, a);
    const json_t *before = entry_named(a, a->before, name);
    uint32_t worse = 0;
    if (!before) {
        put(a, "%s: not in %s\n", name, a->q->path);
        return;
    }
    const int has_gl = json_number_value(json_object_get(now, "gl_used")) > 0, is_reference = reference && strcmp(name, reference) == 0;
    for (int kind = 0; kind < 1 + has_gl && judges_times && !is_reference; ++kind) worse |= judge_times(a, name, kind);
    worse |= compare_counters(a, name, before, now);
    a->found.regressions += worse;
}

static result compare_all(against *a)
{
    const char *reference = reference_of(a), *other = other_machine(a);
    size_t i;
    json_t *entry;
    result done = check_same(a);
    if (done == RESULT_OK && other) report_warning(a->r, a->q->path, 0, "another %s: times are not compared, only counters", other);
    if (done == RESULT_OK && !other) done = find_drift(a, reference);
    if (done != RESULT_OK) return done;
    json_array_foreach(entries(a->now), i, entry) compare_entry(a, entry, reference, !other);
    json_array_foreach(entries(a->before), i, entry) if (!entry_named(a, a->now, name_of(entry, a))) put(a, "%s: only in %s\n", name_of(entry, a), a->q->path);
    put(a, "%u of %zu strategies are worse than then\n", a->found.regressions, json_array_size(entries(a->now)));
    return a->failed ? report_no_memory(a->r, NULL) : RESULT_OK;
}

static result read_now(const against_run *now, report *r, json_t **out)
{
    const allocator *memory = now->bench->services->memory;
    bench_request q = *now->bench;
    bench_text text;
    q.times = BENCH_TIMES_OF_VIEWS;
    if (bench_json(now->result, &q, now->labels, &text) != RESULT_OK) return report_no_memory(r, NULL);
    *out = json_loadb(text.bytes, text.size, 0, NULL);
    memory_free(memory, text.bytes, text.size + 1, 1);
    return *out ? RESULT_OK : report_no_memory(r, NULL);
}

static result take_text(against *a, const allocator *memory, bench_text *out)
{
    char *copy = memory_alloc(memory, a->text.count + 1, 1);
    if (!copy) return report_no_memory(a->r, NULL);
    memcpy(copy, a->text.items, a->text.count);
    copy[a->text.count] = 0;
    *out = (bench_text){copy, a->text.count};
    return RESULT_OK;
}

result against_tell(const against_request *q, const against_run *now, report *r, bench_text *out, against_found *found)
{
    const allocator *memory = now->bench->services->memory;
    const uint32_t views = now->result->least_count;
    against a = {.q = q, .r = r, .text = buffer_make(memory, 1), .views = views, .tests = now->result->row_count * 2};
    a.scratch = memory_alloc(memory, (size_t)views * 2, sizeof(double));
    a.times = memory_alloc(memory, (size_t)views * 2, sizeof(double));
    result done = a.scratch && a.times ? load(q, r, &a.before) : report_no_memory(r, NULL);
    if (done == RESULT_OK) done = read_now(now, r, &a.now);
    if (done == RESULT_OK) done = compare_all(&a);
    if (done == RESULT_OK) done = take_text(&a, memory, out);
    *found = a.found;
    json_decref(a.before);
    json_decref(a.now);
    memory_free(memory, a.scratch, (size_t)views * 2, sizeof(double));
    memory_free(memory, a.times, (size_t)views * 2, sizeof(double));
    buffer_free(&a.text);
    return done;
}

void against_fold(bench_result *first, const bench_result *again)
{
    const size_t count = (size_t)first->row_count * first->least_count * 2;
    for (size_t i = 0; i < count; ++i)
        if (again->least[i] < first->least[i]) first->least[i] = again->least[i];
}
