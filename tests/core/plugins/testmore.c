// The test culler `testmore`: answers MORE or WAIT and asks for box tests. Its first step draws the first half of the
// items and asks about the rest; its second draws those with pixels, or without an answer. With singly=1 it asks about one item a
// step, and waits for each.
// SPDX-License-Identifier: MIT
#define OPTION_COUNT 2
#define QUERY_FIELDS
#include "shell.h"

#include <portcullis/box.h>

static uint32_t half_of(const cull_zone *zone)
{
    return zone->item_count / 2;
}

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent;
    const uint32_t asked = zone->item_count - half_of(zone);
    c->zone = zone;
    out->scratch_size = asked;
    out->index_bytes = sizeof *c;
    out->promises = CULL_SAMPLED;
    out->max_runs = 1 + asked;
    out->max_steps = 2;
    out->max_tests = asked;
    if (asked && c->values[1][0] == '1') {
        out->max_steps = asked + 1;
        out->max_tests = 1;
    }
    return CULL_OK;
}

static void ask(const cull_zone *zone, cull_batch *batch)
{
    for (uint32_t i = half_of(zone); i < zone->item_count; ++i)
        batch->tests[batch->test_count++] = (cull_test){.box = cull_box_at(&zone->boxes, i), .tag = i};
}

// Only age 0 is a fact about this frame; what has no answer is drawn.
static void draw_answered(const cull_zone *zone, const cull_visit *visit, cull_batch *batch)
{
    const uint32_t half = half_of(zone);
    uint8_t *hidden = visit->scratch;
    memset(hidden, 0, zone->item_count - half);
    uint32_t facts = 0;
    for (uint32_t i = 0; i < visit->answer_count; ++i) {
        const cull_answer a = visit->answers[i];
        if (a.age != 0) continue;
        hidden[a.tag - half] = a.pixels == 0;
        facts++;
    }
    if (facts < zone->item_count - half) batch->limits_hit++;
    for (uint32_t i = half; i < zone->item_count; ++i)
        if (!hidden[i - half]) batch->runs[batch->run_count++] = (cull_run){i, 1};
}

// Draws the first half, and of the rest what the step before asked about and found seen; asks about the next.
static cull_progress go_singly(const cull_zone *zone, const cull_visit *visit, cull_batch *batch)
{
    const uint32_t half = half_of(zone), next = half + visit->step;
    if (visit->step == 0 && half) batch->runs[batch->run_count++] = (cull_run){0, half};
    if (visit->step && (visit->answer_count == 0 || visit->answers[0].pixels)) batch->runs[batch->run_count++] = (cull_run){next - 1, 1};
    if (next == zone->item_count) return CULL_DONE;
    batch->tests[batch->test_count++] = (cull_test){.box = cull_box_at(&zone->boxes, next), .tag = next};
    return CULL_WAIT;
}

static cull_progress select_items(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    const cull_culler *c = q->culler;
    if (c->values[1][0] == '1') return go_singly(c->zone, visit, batch);
    if (visit->step > 1) return -1; // never told max_steps 3: the host would call it a fault
    if (visit->step == 1) {
        draw_answered(c->zone, visit, batch);
        return CULL_DONE;
    }
    if (half_of(c->zone)) batch->runs[batch->run_count++] = (cull_run){0, half_of(c->zone)};
    ask(c->zone, batch);
    return c->values[0][0] == '1' ? CULL_WAIT : CULL_MORE;
}

static const void *get_extension(const cull_culler *c, const char *id)
{
    (void)c;
    (void)id;
    return NULL;
}

static const cull_option options[OPTION_COUNT] = {{"wait", "1", "0 1", "1 waits for all answers, 0 takes those that are ready"},
                                                  {"singly", "0", "0 1", "1 asks about one item a step"}};
static const cull_descriptor descriptor = {"testmore", "1", "draws half of the items and asks about the rest", options, OPTION_COUNT, CULL_SAMPLED};
static const cull_plugin plugin = {.descriptor = &descriptor,
                                   .create = shell_create,
                                   .destroy = shell_destroy,
                                   .build = build,
                                   .open = shell_open,
                                   .close = shell_close,
                                   .select = select_items,
                                   .get_extension = get_extension};
static const cull_plugin *const plugins[] = {&plugin};
CULL_ENTRY = {CULL_ABI, 1, plugins};
