// A trace of frames: see trace.h. One thread of the trace is one strategy; a span is a complete event ("X"), its times in microseconds.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "trace.h"
#include "json_text.h"

#include "../host/core/file.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct trace {
    buffer text; // events, a line each
    const allocator *memory;
    double start_us;
    uint32_t thread, failed; // failed: no memory since
    // Of the frame that runs:
    strategy *s;
    frame_driver driver; // what the frame is carried out by
    double since_us;     // of the step or flow that runs
};

static double now_us(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e6 + (double)t.tv_nsec * 1e-3;
}

trace *trace_open(const allocator *memory)
{
    trace *t = memory_alloc_zeroed(memory, 1, sizeof *t);
    if (!t) return NULL;
    t->memory = memory;
    t->text = buffer_make(memory, 1);
    t->start_us = now_us();
    return t;
}

void trace_close(trace *t)
{
    if (!t) return;
    buffer_free(&t->text);
    memory_free(t->memory, t, 1, sizeof *t);
}

// ---- Events ----

static void put(trace *t, const char *format, ...)
{
    char line[512];
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(line, sizeof line, format, values);
    va_end(values);
    if (length < 0 || (size_t)length >= sizeof line) return; // no name of ours is as long
    if (t->text.count && !buffer_append(&t->text, ",\n", 2)) t->failed = 1;
    if (!buffer_append(&t->text, line, (size_t)length)) t->failed = 1;
}

static void put_span(trace *t, const char *what, double from_us, const char *arguments)
{
    put(t, "{\"name\":\"%s\",\"ph\":\"X\",\"pid\":1,\"tid\":%u,\"ts\":%.3f,\"dur\":%.3f,\"args\":{%s}}", what, t->thread, from_us - t->start_us, now_us() - from_us,
        arguments);
}

static void put_work(trace *t, const char *what, double from_us, uint32_t zone, uint32_t count)
{
    char arguments[64];
    snprintf(arguments, sizeof arguments, "\"zone\":%u,\"count\":%u", zone, count);
    put_span(t, what, from_us, arguments);
}

static void put_counter(trace *t, const char *name, double at_us, double value)
{
    put(t, "{\"name\":\"%s\",\"ph\":\"C\",\"pid\":1,\"tid\":%u,\"id\":%u,\"ts\":%.3f,\"args\":{\"%s\":%.17g}}", name, t->thread, t->thread, at_us - t->start_us, name,
        value);
}

// ---- The driver between the frame and the renderer ----

static void trace_draw(void *user, uint32_t zone, const cull_run *runs, uint32_t count)
{
    trace *t = user;
    const double from = now_us();
    t->driver.draw(t->driver.user, zone, runs, count);
    put_work(t, "draw", from, zone, count);
}

static void trace_draw_movers(void *user, const uint32_t *movers, uint32_t count)
{
    trace *t = user;
    const double from = now_us();
    t->driver.draw_movers(t->driver.user, movers, count);
    put_work(t, "draw movers", from, 0, count);
}

static void trace_draw_clipped(void *user, uint32_t zone, const cull_clipped *clipped, uint32_t count)
{
    trace *t = user;
    const double from = now_us();
    t->driver.draw_clipped(t->driver.user, zone, clipped, count);
    put_work(t, "draw clipped", from, zone, count);
}

static void trace_capture(void *user, uint32_t zone, const cull_capture *captures, uint32_t count)
{
    trace *t = user;
    const double from = now_us();
    t->driver.capture(t->driver.user, zone, captures, count);
    put_work(t, "capture", from, zone, count);
}

static void trace_show(void *user, uint32_t zone, const cull_picture *pictures, uint32_t count)
{
    trace *t = user;
    const double from = now_us();
    t->driver.show(t->driver.user, zone, pictures, count);
    put_work(t, "show pictures", from, zone, count);
}

static void trace_test(void *user, uint32_t zone, const cull_test *tests, uint32_t count, uint32_t frame)
{
    trace *t = user;
    const double from = now_us();
    t->driver.test(t->driver.user, zone, tests, count, frame);
    put_work(t, "test", from, zone, count);
}

static uint32_t trace_collect(void *user, uint32_t zone, collect_how how, uint32_t frame, cull_answer *answers, uint32_t capacity, uint32_t *stalled)
{
    trace *t = user;
    const double from = now_us();
    const uint32_t got = t->driver.collect(t->driver.user, zone, how, frame, answers, capacity, stalled);
    put_work(t, how == COLLECT_EVERYTHING ? "wait for answers" : "collect answers", from, zone, got);
    return got;
}

static void trace_check_slots(void *user, uint32_t zone, uint8_t *slots, uint32_t count)
{
    trace *t = user;
    t->driver.check_slots(t->driver.user, zone, slots, count);
}

static void trace_mark(void *user, frame_mark mark, uint32_t zone)
{
    trace *t = user;
    if (mark == FRAME_FLOW_BEGINS || mark == FRAME_STEP_BEGINS) t->since_us = now_us();
    else if (mark == FRAME_FLOW_ENDED) put_work(t, "flow", t->since_us, 0, zone);
    else put_work(t, "step", t->since_us, zone, 1);
}

// Only what the frame is carried out by: who does not capture must not seem to.
static frame_driver between(trace *t, frame_driver real)
{
    t->driver = real;
    return (frame_driver){.user = t, .draw = real.draw ? trace_draw : NULL, .draw_movers = real.draw_movers ? trace_draw_movers : NULL,
                          .capture = real.capture ? trace_capture : NULL, .show = real.show ? trace_show : NULL, .test = real.test ? trace_test : NULL,
                          .collect = real.collect ? trace_collect : NULL, .draw_clipped = real.draw_clipped ? trace_draw_clipped : NULL,
                          .check_slots = real.check_slots ? trace_check_slots : NULL, .mark = trace_mark};
}

static frame_driver trace_between(void *user, frame_driver real)
{
    return between(user, real);
}

// ---- A pass ----

static void put_counters(trace *t, const strategy_view *v, const view_counts *c)
{
    const double at = now_us();
    put_counter(t, "polygons drawn", at, (double)c->polygons);
    put_counter(t, "items drawn", at, (double)c->items);
    put_counter(t, "zones", at, v->stats.zones);
    put_counter(t, "steps", at, v->stats.steps);
    put_counter(t, "tests", at, v->stats.queries);
    put_counter(t, "captures", at, v->stats.captures);
    put_counter(t, "cull_ns", at, v->stats.cull_ns);
}

static void put_name(trace *t, const char *name)
{
    json_t *text = json_text(name);
    char *quoted = text ? json_dumps(text, JSON_ENCODE_ANY | JSON_ENSURE_ASCII) : NULL;
    json_decref(text);
    if (quoted && strlen(quoted) < 400) // an event is a line of 512
        put(t, "{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":%u,\"args\":{\"name\":%s}}", t->thread, quoted);
    else put(t, "{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":%u,\"args\":{\"name\":\"strategy %u\"}}", t->thread, t->thread);
    free(quoted);
}

result trace_strategy(trace *t, strategy *s, report *r)
{
    t->thread++;
    put_name(t, s->chains->name);
    s->between = (strategy_between){trace_between, t};
    result done = strategy_turn(s, s->q->path->count - 1, r);
    if (done == RESULT_OK) done = strategy_restart(s, r);
    for (uint32_t v = 0; v < s->q->path->count && done == RESULT_OK; ++v) {
        char arguments[32];
        strategy_view view;
        const strategy_request request = {.view = v, .mode = RENDER_SHADED, .marks = MARK_DRAWN};
        const double from = now_us();
        done = strategy_run_view(s, &request, r, &view);
        if (done != RESULT_OK) break;
        snprintf(arguments, sizeof arguments, "\"view\":%u", v);
        put_span(t, "frame", from, arguments);
        const view_counts counts = strategy_count(s, &view.set);
        put_counters(t, &view, &counts);
    }
    s->between = (strategy_between){0};
    if (done == RESULT_OK && t->failed) done = report_no_memory(r, NULL);
    return done;
}

result trace_write(trace *t, const char *path, report *r)
{
    static const char head[] = "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n", tail[] = "\n]}\n";
    buffer text = buffer_make(t->memory, 1);
    const int good = buffer_append(&text, head, sizeof head - 1) && buffer_append(&text, t->text.items, t->text.count) && buffer_append(&text, tail, sizeof tail - 1);
    const result done = good ? file_write(path, text.items, text.count, r) : report_no_memory(r, path);
    buffer_free(&text);
    return done;
}
