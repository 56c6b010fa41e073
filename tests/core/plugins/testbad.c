// The test culler `testbad`: draws everything, and breaks the contract in the one way that its option `fault` names, in
// frames below `until` or when it is created, built or opened.
// SPDX-License-Identifier: MIT
#define OPTION_COUNT 4
#define QUERY_FIELDS
#include "shell.h"

#include "testbad.h"

enum { FAULT_OPTION, UNTIL, MOVERS, SLOTS };

static int has_fault(const cull_culler *c, const char *name)
{
    return strcmp(c->values[FAULT_OPTION], name) == 0;
}

static int is_named(const char *const *names, size_t count, const char *name)
{
    for (size_t i = 0; i < count; ++i)
        if (strcmp(names[i], name) == 0) return 1;
    return 0;
}

static int fault_is_known(const char *name)
{
    static const char *const others[] = {
        "none", "create_option", "create_zone", "create_memory", "create_blob", "create_odd", "create_null", "create_leaves",
        "build_option", "build_zone", "build_memory", "build_blob", "build_odd", "open_memory", "open_zone", "open_odd", "open_null", "open_leaves",
        "steps_none", "steps_over", "promises_more", "order_twice", "order_wild", "scratch_absurd", "runs_absurd", "tests_absurd",
        "captures_absurd", "pictures_absurd", "clipped_absurd", "slots_absurd", "captures_without_slots", "walks_nothing",
    };
    return bad_fault_find(name) || is_named(others, sizeof others / sizeof *others, name);
}

static cull_result create(const cull_host *host, const char *const *values, cull_culler **out)
{
    const char *fault = values[FAULT_OPTION];
    if (!fault_is_known(fault) || strcmp(fault, "create_option") == 0) return CULL_ERR_OPTION;
    if (strcmp(fault, "create_zone") == 0) return CULL_ERR_ZONE;
    if (strcmp(fault, "create_memory") == 0) return CULL_ERR_MEMORY;
    if (strcmp(fault, "create_blob") == 0) return CULL_ERR_BLOB;
    if (strcmp(fault, "create_odd") == 0) return 42;
    if (strcmp(fault, "create_null") == 0) return CULL_OK;
    if (strcmp(fault, "create_leaves") != 0) return shell_create(host, values, out);
    *out = (cull_culler *)(uintptr_t)0x40; // nothing that anyone may touch
    return CULL_ERR_ZONE;
}

static cull_result build_error(const cull_culler *c)
{
    if (has_fault(c, "build_option")) return CULL_ERR_OPTION;
    if (has_fault(c, "build_zone")) return CULL_ERR_ZONE;
    if (has_fault(c, "build_memory")) return CULL_ERR_MEMORY;
    if (has_fault(c, "build_blob")) return CULL_ERR_BLOB;
    return has_fault(c, "build_odd") ? 42 : CULL_OK;
}

static void tell_nonsense(const cull_culler *c, cull_built *out)
{
    static const uint32_t twice[] = {0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14}, wild[16] = {UINT32_MAX};
    const uint32_t absurd = UINT32_MAX;
    if (has_fault(c, "steps_none")) out->max_steps = 0;
    if (has_fault(c, "steps_over")) out->max_steps = CULL_MAX_STEPS + 1;
    if (has_fault(c, "promises_more")) out->promises = CULL_CONSERVATIVE;
    if (has_fault(c, "order_twice")) out->order = twice;
    if (has_fault(c, "order_wild")) out->order = wild;
    if (has_fault(c, "scratch_absurd")) out->scratch_size = SIZE_MAX;
    if (has_fault(c, "runs_absurd")) out->max_runs = absurd;
    if (has_fault(c, "tests_absurd")) out->max_tests = absurd;
    if (has_fault(c, "captures_absurd")) out->max_captures = absurd;
    if (has_fault(c, "pictures_absurd")) out->max_pictures = absurd;
    if (has_fault(c, "slots_absurd")) out->slot_count = absurd;
    if (has_fault(c, "captures_without_slots")) out->slot_count = 0;
    if (has_fault(c, "walks_nothing")) out->walks_hierarchy = 1;
    if (has_fault(c, "clipped_absurd")) out->max_clipped = absurd;
    if (c->values[SLOTS][0] == '0') out->max_captures = out->max_pictures = out->slot_count = 0;
}

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent;
    c->zone = zone;
    *out = (cull_built){.index_bytes = sizeof *c, .promises = CULL_SAMPLED, .max_runs = BAD_RUNS, .max_steps = BAD_STEPS, .max_tests = BAD_TESTS,
                        .max_captures = BAD_CAPTURES, .max_pictures = BAD_PICTURES, .slot_count = BAD_SLOTS, .max_clipped = BAD_CLIPPED,
                        .takes_movers = c->values[MOVERS][0] == '1'};
    tell_nonsense(c, out);
    return build_error(c);
}

static cull_result open_query(const cull_culler *c, cull_query **out)
{
    if (has_fault(c, "open_memory")) return CULL_ERR_MEMORY;
    if (has_fault(c, "open_zone")) return CULL_ERR_ZONE;
    if (has_fault(c, "open_odd")) return 42;
    if (has_fault(c, "open_null")) return CULL_OK;
    if (!has_fault(c, "open_leaves")) return shell_open(c, out);
    *out = (cull_query *)(uintptr_t)0x40;
    return CULL_ERR_ZONE;
}

// The good answer: all items in two runs, all movers that were lent.
static void answer(const cull_culler *c, const cull_visit *visit, cull_batch *batch)
{
    const uint32_t half = c->zone->item_count / 2;
    batch->runs[batch->run_count++] = (cull_run){0, half};
    batch->runs[batch->run_count++] = (cull_run){half, c->zone->item_count - half};
    for (uint32_t i = 0; i < visit->mover_count; ++i) batch->runs[batch->run_count++] = (cull_run){visit->movers[i].id, 1};
}

static cull_progress step(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    const cull_culler *c = q->culler;
    const bad_fault *fault = bad_fault_find(c->values[FAULT_OPTION]);
    bad_step s = {c->host, c->zone, visit, batch, CULL_DONE, BAD_RUNS + (c->values[MOVERS][0] == '1' ? c->zone->mover_capacity : 0)};
    if (visit->step == 0) answer(c, visit, batch);
    if (fault && visit->view->frame < (uint32_t)strtoul(c->values[UNTIL], NULL, 10)) fault->spoil(&s);
    return s.progress;
}

static const void *get_extension(const cull_culler *c, const char *id)
{
    (void)c;
    (void)id;
    return NULL;
}

static const cull_option options[OPTION_COUNT] = {
    {"fault", "none", NULL, "what it does wrong"},
    {"until", "1000000", NULL, "the first frame that it behaves in"},
    {"movers", "0", NULL, "1 takes movers"},
    {"slots", "1", NULL, "0 takes no pictures"},
};
static const cull_descriptor descriptor = {"testbad", "1", "breaks the contract", options, OPTION_COUNT, CULL_SAMPLED};
static const cull_plugin plugin = {.descriptor = &descriptor,
                                   .create = create,
                                   .destroy = shell_destroy,
                                   .build = build,
                                   .open = open_query,
                                   .close = shell_close,
                                   .select = step,
                                   .filter = step,
                                   .get_extension = get_extension};
static const cull_plugin *const plugins[] = {&plugin};
CULL_ENTRY = {CULL_ABI, 1, plugins};
