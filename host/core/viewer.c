// Viewers: opens the queries of a chain and sizes every list of a frame from what the cullers told after build.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "viewer.h"

#include <string.h>
#include <time.h>

static uint32_t max_u32(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static int list_take(list *l, const allocator *memory, size_t count, size_t item_size)
{
    *l = list_open(memory, count, item_size);
    return l->items != NULL;
}

// Which stage starts, which steps: the last filter that walks the hierarchy needs nothing of those before it.
static void choose_stages(viewer *v)
{
    const chain *c = v->chain;
    for (uint32_t i = 1; i < c->stage_count; ++i) {
        if (c->stages[i].role != ROLE_FILTER) continue;
        v->last = i;
        if (c->stages[i].built.walks_hierarchy) v->first = i;
    }
}

static result open_query(viewer *v, uint32_t stage, report *r)
{
    const chain_stage *s = &v->chain->stages[stage];
    cull_query *query = NULL; // not the stage's own: what a failed open leaves there is nothing to close
    const cull_result code = s->plugin->open(s->culler, &query);
    if (code == CULL_ERR_MEMORY) return report_no_memory(r, NULL);
    if (code != CULL_OK || !query)
        return report_error(r, NULL, 0, "culler '%s' could not open a query (result %d); try another chain", s->plugin->descriptor->id, (int)code);
    v->stages[stage].query = query;
    return RESULT_OK;
}

static result open_queries(viewer *v, report *r)
{
    result done = RESULT_OK;
    for (uint32_t i = 0; i < v->chain->stage_count && done == RESULT_OK; ++i) done = open_query(v, i, r);
    return done;
}

static int open_stages(viewer *v)
{
    const chain *c = v->chain;
    for (uint32_t i = 0; i < c->stage_count; ++i) {
        const cull_built *b = &c->stages[i].built;
        const uint32_t movers = i == v->last && b->takes_movers ? c->zone.mover_capacity : 0;
        v->stages[i].run_capacity = b->max_runs + movers;
        if (c->stages[i].role != ROLE_CROSS && !list_take(&v->stages[i].runs, v->memory, v->stages[i].run_capacity, sizeof(cull_run))) return 0;
        v->scratch_size = b->scratch_size > v->scratch_size ? b->scratch_size : v->scratch_size;
        v->slot_count = max_u32(v->slot_count, b->slot_count);
    }
    return 1;
}

// Stages before the last may give no tests, and those that are not first no pictures: they learn it from the check of
// what they wrote, so there has to be room for it.
static int open_early_lists(viewer *v)
{
    uint32_t tests = 0, captures = 0, pictures = 0;
    for (uint32_t i = 0; i < v->last; ++i) {
        const cull_built *b = &v->chain->stages[i].built;
        tests = max_u32(tests, b->max_tests);
        captures = max_u32(captures, b->max_captures);
        pictures = max_u32(pictures, b->max_pictures);
    }
    return list_take(&v->early_tests, v->memory, tests, sizeof(cull_test)) &&
           list_take(&v->early_captures, v->memory, captures, sizeof(cull_capture)) &&
           list_take(&v->early_pictures, v->memory, pictures, sizeof(cull_picture));
}

static int open_lists(viewer *v)
{
    const chain *c = v->chain;
    const cull_built *last = &c->stages[v->last].built, *select = &c->stages[0].built;
    const uint32_t movers = c->zone.mover_capacity;
    v->answer_capacity = last->max_tests ? last->max_tests * 2 + 1 : 0; // one more than is lent: a full list says that there are more
    v->whole = (cull_run){0, c->zone.item_count};
    int good = list_take(&v->tests, v->memory, last->max_tests, sizeof(cull_test));
    good = good && list_take(&v->captures, v->memory, last->max_captures, sizeof(cull_capture));
    good = good && list_take(&v->pictures, v->memory, last->max_pictures, sizeof(cull_picture));
    good = good && list_take(&v->select_captures, v->memory, select->max_captures, sizeof(cull_capture));
    good = good && list_take(&v->select_pictures, v->memory, select->max_pictures, sizeof(cull_picture));
    good = good && list_take(&v->keep_captures, v->memory, select->max_captures, 1);
    good = good && list_take(&v->keep_pictures, v->memory, select->max_pictures, 1);
    good = good && list_take(&v->drawn, v->memory, last->max_steps > 1 ? v->stages[v->last].run_capacity : 0, sizeof(cull_run));
    good = good && list_take(&v->slot_marks, v->memory, v->slot_count, 1);
    good = good && list_take(&v->answers, v->memory, v->answer_capacity, sizeof(cull_answer));
    good = good && list_take(&v->movers, v->memory, movers, sizeof(cull_mover));
    good = good && list_take(&v->mover_runs, v->memory, movers, sizeof(cull_run));
    if (v->checks == VIEWER_CHECK_ALL) good = good && list_take(&v->seen, v->memory, ((size_t)c->zone.item_count + movers + 63) / 64, sizeof(uint64_t));
    v->slots = good ? memory_alloc_zeroed(v->memory, v->slot_count, 1) : NULL;
    v->scratch = v->slots ? memory_alloc(v->memory, v->scratch_size, 1) : NULL;
    return v->scratch != NULL;
}

// The least time between two readings: what a frame of no work would show.
static double clock_overhead_ns(void)
{
    double least = 1e9;
    for (int i = 0; i < 64; ++i) {
        struct timespec a, b;
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &a);
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &b);
        const double ns = (double)(b.tv_sec - a.tv_sec) * 1e9 + (double)(b.tv_nsec - a.tv_nsec);
        if (ns < least) least = ns;
    }
    return least;
}

result viewer_open(const chain *c, const host_services *services, viewer_checks checks, report *r, viewer **out)
{
    viewer *v = memory_alloc_zeroed(services->memory, 1, sizeof *v);
    if (!v) return report_no_memory(r, NULL);
    v->chain = c;
    v->memory = services->memory;
    v->log = services->log;
    v->kernel = runs_kernel_best();
    v->checks = checks;
#ifndef NDEBUG
    v->checks = VIEWER_CHECK_ALL;
#endif
    choose_stages(v);
    result done = open_queries(v, r);
    if (done == RESULT_OK && (!open_stages(v) || !open_early_lists(v) || !open_lists(v))) done = report_no_memory(r, NULL);
    if (done != RESULT_OK) {
        viewer_close(v);
        return done;
    }
    v->clock_overhead_ns = clock_overhead_ns();
    *out = v;
    return RESULT_OK;
}

void viewer_close(viewer *v)
{
    if (!v) return;
    for (uint32_t i = 0; i < v->chain->stage_count; ++i) {
        if (v->stages[i].query) v->chain->stages[i].plugin->close(v->stages[i].query);
        list_close(&v->stages[i].runs, v->memory);
    }
    list *const all[] = {&v->tests, &v->captures, &v->pictures, &v->select_captures, &v->select_pictures, &v->keep_captures,
                         &v->keep_pictures, &v->early_tests, &v->early_captures, &v->early_pictures, &v->drawn, &v->slot_marks,
                         &v->answers, &v->movers, &v->mover_runs, &v->seen};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) list_close(all[i], v->memory);
    memory_free(v->memory, v->slots, v->slot_count, 1);
    memory_free(v->memory, v->scratch, v->scratch_size, 1);
    memory_free(v->memory, v, 1, sizeof *v);
}

double frame_clock_overhead_ns(const viewer *v)
{
    return v->clock_overhead_ns;
}
