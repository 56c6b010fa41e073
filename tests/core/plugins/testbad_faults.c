// The test culler `testbad`, its faults in a step: each spoils a good answer in one place.
// SPDX-License-Identifier: MIT
#include "testbad.h"

#include <math.h>
#include <string.h>

static const cull_run one_item = {0, 1};
static const uint32_t both_slots[BAD_SLOTS] = {0, 1};

static void last_run(bad_step *s, uint32_t first, uint32_t count)
{
    s->batch->runs[s->batch->run_count - 1] = (cull_run){first, count};
}

static void run_wild(bad_step *s) { last_run(s, s->zone->item_count + s->zone->mover_capacity, 1); }
static void run_of_a_mover(bad_step *s) { last_run(s, s->zone->item_count, 1); }
static void run_past_end(bad_step *s) { last_run(s, s->zone->item_count - 1, 2); }
static void run_huge_first(bad_step *s) { last_run(s, UINT32_MAX, 1); }
static void run_huge_count(bad_step *s) { last_run(s, 1, UINT32_MAX); }
static void run_wraps(bad_step *s) { last_run(s, 2, UINT32_MAX - 1); }
static void run_empty(bad_step *s) { last_run(s, 0, 0); }
static void runs_too_many(bad_step *s) { s->batch->run_count = s->run_capacity + 1; }
static void runs_endless(bad_step *s) { s->batch->run_count = UINT32_MAX; }

static void item_twice(bad_step *s)
{
    s->batch->runs[0] = s->batch->runs[1] = one_item;
    s->batch->run_count = 2;
}

static void zone_twice(bad_step *s)
{
    s->batch->runs[0] = s->batch->runs[1] = (cull_run){0, s->zone->item_count};
    s->batch->run_count = 2;
}

static void all_movers(bad_step *s) { last_run(s, s->zone->item_count, s->zone->mover_capacity); }
static void quarter_often(bad_step *s)
{
    s->batch->run_count = 0;
    for (int i = 0; i < 4; ++i) s->batch->runs[s->batch->run_count++] = (cull_run){0, s->zone->item_count / 4};
}
static void mover_over_edge(bad_step *s) { last_run(s, s->zone->item_count - 1, 2); }

static void mover_twice(bad_step *s)
{
    for (uint32_t i = 0; i < s->run_capacity; ++i) s->batch->runs[i] = (cull_run){s->zone->item_count, 1};
    s->batch->run_count = s->run_capacity;
}

static void takes_back(bad_step *s)
{
    if (s->visit->step == 0) s->progress = CULL_MORE;
    else s->batch->run_count = 1;
}

// Nothing there may be touched.
static void *elsewhere(void) { return (void *)(uintptr_t)0x40; }
static void replaces_runs(bad_step *s) { s->batch->runs = elsewhere(); }
static void replaces_keep_pictures(bad_step *s) { s->batch->keep_pictures = elsewhere(); }
static void replaces_keep_captures(bad_step *s) { s->batch->keep_captures = elsewhere(); }

static void replaces_pictures(bad_step *s)
{
    s->batch->pictures = elsewhere();
    s->batch->picture_count = 1;
}

static void replaces_tests(bad_step *s)
{
    s->batch->tests = elsewhere();
    s->batch->test_count = 1;
}

static void replaces_captures(bad_step *s)
{
    s->batch->captures = elsewhere();
    s->batch->capture_count = 1;
}

// No fault: what was drawn in the first step stands.
static void rewrites_drawn(bad_step *s)
{
    if (s->visit->step == 0) s->progress = CULL_MORE;
    else
        for (uint32_t i = 0; i < s->batch->run_count; ++i) s->batch->runs[i] = (cull_run){UINT32_MAX, UINT32_MAX};
}

// Each step gives what an earlier one gave.
static void item_twice_over_steps(bad_step *s)
{
    if (s->visit->step == 0) {
        s->batch->run_count = 1;
        s->progress = CULL_MORE;
    } else s->batch->runs[s->batch->run_count++] = one_item;
}

static void zone_twice_over_steps(bad_step *s)
{
    if (s->visit->step == 0) s->progress = CULL_MORE;
    else s->batch->runs[s->batch->run_count++] = (cull_run){0, s->zone->item_count};
}

static void logs_and_runs_wild(bad_step *s)
{
    s->host->log(s->host, CULL_LOG_WARN, "testbad: about to run wild");
    s->host->log(s->host, CULL_LOG_ERROR, "testbad: running wild");
    run_wild(s);
}

static void returns_odd(bad_step *s) { s->progress = 17; }
static void returns_negative(bad_step *s) { s->progress = -1; }
static void more_for_ever(bad_step *s) { s->progress = CULL_MORE; }
static void wait_for_ever(bad_step *s) { s->progress = CULL_WAIT; }

static cull_test *add_test(bad_step *s)
{
    cull_test *t = &s->batch->tests[s->batch->test_count++];
    *t = (cull_test){.box = s->zone->box};
    return t;
}

static void test_given(bad_step *s) { (void)add_test(s); }
static void tests_endless(bad_step *s) { s->batch->test_count = UINT32_MAX; }
static void captures_endless(bad_step *s) { s->batch->capture_count = UINT32_MAX; }
static void pictures_endless(bad_step *s) { s->batch->picture_count = UINT32_MAX; }
static void tests_too_many(bad_step *s) { s->batch->test_count = BAD_TESTS + 1; }
static void test_nan(bad_step *s) { add_test(s)->box.max.y = NAN; }
static void test_infinite(bad_step *s) { add_test(s)->box.min.z = -INFINITY; }
static void test_inside_out(bad_step *s) { add_test(s)->box.max.x = nextafterf(s->zone->box.min.x, -INFINITY); }

static cull_capture *add_capture(bad_step *s, uint32_t slot)
{
    cull_capture *c = &s->batch->captures[s->batch->capture_count++];
    *c = (cull_capture){.runs = &one_item, .run_count = 1, .box = s->zone->box, .right = {1, 0, 0}, .up = {0, 1, 0}, .slot = slot, .width_px = 8, .height_px = 8};
    return c;
}

static void capture_given(bad_step *s) { (void)add_capture(s, 0); }
static void captures_too_many(bad_step *s) { s->batch->capture_count = BAD_CAPTURES + 1; }
static void capture_slot(bad_step *s) { (void)add_capture(s, BAD_SLOTS); }
static void capture_nan(bad_step *s) { add_capture(s, 0)->right.z = NAN; }
static void capture_box(bad_step *s) { add_capture(s, 0)->box.min.y = INFINITY; }
static void capture_no_pixels(bad_step *s) { add_capture(s, 0)->width_px = 0; }
static void capture_huge(bad_step *s) { add_capture(s, 0)->height_px = 1u << 30; }
static void capture_clip_count(bad_step *s) { add_capture(s, 0)->clip_plane_count = 5; }

static void capture_clip_nan(bad_step *s)
{
    cull_capture *c = add_capture(s, 0);
    c->clip_plane_count = 1;
    c->clip_planes[0].offset = NAN;
}

static void capture_of_empty_slot(bad_step *s)
{
    cull_capture *c = add_capture(s, 0);
    c->slots = &both_slots[1];
    c->slot_count = 1;
}

// Of a slot that is filled, where the host's driver takes pictures.
static void capture_of_itself(bad_step *s)
{
    cull_capture *c = add_capture(s, 0);
    if (s->visit->step == 0) s->progress = CULL_MORE;
    else {
        c->slots = both_slots;
        c->slot_count = 1;
    }
}

static void capture_null_slots(bad_step *s) { add_capture(s, 0)->slot_count = 1; }

static void capture_wild_run(bad_step *s)
{
    static const cull_run wild = {UINT32_MAX, 1};
    add_capture(s, 0)->runs = &wild;
}

static void capture_null_runs(bad_step *s) { add_capture(s, 0)->runs = NULL; }
static void capture_endless_runs(bad_step *s) { add_capture(s, 0)->run_count = UINT32_MAX; }

static cull_picture *add_picture(bad_step *s, uint32_t slot)
{
    cull_picture *p = &s->batch->pictures[s->batch->picture_count++];
    *p = (cull_picture){.runs = &one_item, .box = s->zone->box, .run_count = 1, .slot = slot};
    return p;
}

static cull_picture *add_captured_picture(bad_step *s)
{
    (void)add_capture(s, 0);
    return add_picture(s, 0);
}

static void pictures_too_many(bad_step *s) { s->batch->picture_count = BAD_PICTURES + 1; }
static void picture_empty_slot(bad_step *s) { (void)add_picture(s, 1); }
static void picture_slot(bad_step *s) { (void)add_picture(s, BAD_SLOTS); }
static void picture_nan_error(bad_step *s) { add_captured_picture(s)->error_px = NAN; }
static void picture_negative_error(bad_step *s) { add_captured_picture(s)->error_px = -1; }
static void picture_infinite_error(bad_step *s) { add_captured_picture(s)->error_px = INFINITY; }
static void picture_box(bad_step *s) { add_captured_picture(s)->box.max.x = NAN; }
static void picture_past_end(bad_step *s)
{
    static const cull_run wild = {1, UINT32_MAX};
    add_captured_picture(s)->runs = &wild;
}
static void picture_null_runs(bad_step *s) { add_captured_picture(s)->runs = NULL; }

static void pictures_taken_back(bad_step *s)
{
    if (s->visit->step == 0) {
        (void)add_captured_picture(s);
        s->progress = CULL_MORE;
    } else s->batch->picture_count = 0;
}

// Slot 1 is composed of slot 0, which an earlier capture fills; the picture shows slot 1. No fault.
static void picture_composed(bad_step *s)
{
    (void)add_capture(s, 0);
    cull_capture *c = add_capture(s, 1);
    c->slots = both_slots;
    c->slot_count = 1;
    (void)add_picture(s, 1);
}

// The same with a second capture that nobody needs. No fault.
static void picture_beside(bad_step *s)
{
    (void)add_capture(s, 0);
    (void)add_capture(s, 1);
    (void)add_picture(s, 0);
}

static void capture_composed_early(bad_step *s)
{
    cull_capture *c = add_capture(s, 1);
    c->slots = both_slots;
    c->slot_count = 1;
    (void)add_capture(s, 0);
}

static cull_clipped *add_clipped(bad_step *s)
{
    cull_clipped *c = &s->batch->clipped[s->batch->clipped_count++];
    *c = (cull_clipped){.runs = &one_item, .box = s->zone->box, .planes = {{{1, 0, 0}, 0}}, .run_count = 1, .plane_count = 1};
    return c;
}

static void clipped_too_many(bad_step *s) { s->batch->clipped_count = BAD_CLIPPED + 1; }
static void clipped_endless(bad_step *s) { s->batch->clipped_count = UINT32_MAX; }
static void clipped_plane_count(bad_step *s) { add_clipped(s)->plane_count = 5; }
static void clipped_plane_nan(bad_step *s) { add_clipped(s)->planes[0].normal.y = NAN; }
static void clipped_plane_infinite(bad_step *s) { add_clipped(s)->planes[0].offset = INFINITY; }
static void clipped_box(bad_step *s) { add_clipped(s)->box.min.x = NAN; }
static void clipped_null_runs(bad_step *s) { add_clipped(s)->runs = NULL; }
static void clipped_endless_runs(bad_step *s) { add_clipped(s)->run_count = UINT32_MAX; }
static void clipped_wild_run(bad_step *s)
{
    static const cull_run wild = {UINT32_MAX, 1};
    add_clipped(s)->runs = &wild;
}
static void clipped_mover(bad_step *s)
{
    static cull_run mover;
    mover = (cull_run){s->zone->item_count, 1};
    add_clipped(s)->runs = &mover;
}

static void clipped_zone_twice(bad_step *s)
{
    static cull_run all[2];
    all[0] = all[1] = (cull_run){0, s->zone->item_count};
    cull_clipped *c = add_clipped(s);
    c->runs = all;
    c->run_count = 2;
}

// Instead of the first run: half of the items clipped.
static void clip_half(bad_step *s)
{
    s->batch->run_count = 1;
    s->batch->runs[0] = (cull_run){s->zone->item_count / 2, s->zone->item_count - s->zone->item_count / 2};
}

static void clipped_given(bad_step *s)
{
    clip_half(s);
    (void)add_clipped(s);
}

static void clipped_item_twice(bad_step *s)
{
    static const cull_run twice[2] = {{0, 1}, {0, 1}};
    clip_half(s);
    cull_clipped *c = add_clipped(s);
    c->runs = twice;
    c->run_count = 2;
}

static void clipped_and_whole(bad_step *s) { (void)add_clipped(s); }

static void clipped_then_whole(bad_step *s)
{
    if (s->visit->step == 0) {
        clip_half(s);
        (void)add_clipped(s);
        s->progress = CULL_MORE;
    } else s->batch->runs[s->batch->run_count++] = one_item;
}

static void clipped_taken_back(bad_step *s)
{
    if (s->visit->step == 0) {
        clip_half(s);
        (void)add_clipped(s);
        s->progress = CULL_MORE;
    } else s->batch->clipped_count = 0;
}

static void replaces_clipped(bad_step *s)
{
    s->batch->clipped = elsewhere();
    s->batch->clipped_count = 1;
}

static void replaces_keep_clipped(bad_step *s) { s->batch->keep_clipped = elsewhere(); }

// Behind the end of what was lent: only for a host whose lists end at guard pages.
static void writes_past_runs(bad_step *s) { s->batch->runs[s->run_capacity] = one_item; }
static void writes_past_tests(bad_step *s) { s->batch->tests[BAD_TESTS].tag = 1; }
static void writes_past_captures(bad_step *s) { s->batch->captures[BAD_CAPTURES].slot = 1; }
static void writes_past_clipped(bad_step *s) { s->batch->clipped[BAD_CLIPPED].run_count = 1; }
static void writes_past_pictures(bad_step *s) { s->batch->pictures[BAD_PICTURES].slot = 1; }

const bad_fault *bad_fault_find(const char *name)
{
#define FAULT(f) {#f, f}
    static const bad_fault faults[] = {
        FAULT(run_wild), FAULT(run_of_a_mover), FAULT(run_past_end), FAULT(run_huge_first), FAULT(run_huge_count), FAULT(run_wraps), FAULT(run_empty),
        FAULT(runs_too_many), FAULT(runs_endless), FAULT(item_twice), FAULT(zone_twice), FAULT(mover_over_edge), FAULT(mover_twice), FAULT(all_movers), FAULT(quarter_often), FAULT(takes_back),
        FAULT(returns_odd), FAULT(returns_negative), FAULT(more_for_ever), FAULT(wait_for_ever),
        FAULT(test_given), FAULT(tests_too_many), FAULT(test_nan), FAULT(test_infinite), FAULT(test_inside_out),
        FAULT(capture_given), FAULT(captures_too_many), FAULT(capture_slot), FAULT(capture_nan), FAULT(capture_box), FAULT(capture_no_pixels),
        FAULT(capture_huge), FAULT(capture_clip_count), FAULT(capture_clip_nan), FAULT(capture_of_empty_slot), FAULT(capture_of_itself),
        FAULT(capture_null_slots), FAULT(capture_wild_run), FAULT(capture_null_runs), FAULT(capture_endless_runs),
        FAULT(pictures_too_many), FAULT(picture_empty_slot), FAULT(picture_slot), FAULT(picture_nan_error), FAULT(picture_negative_error),
        FAULT(picture_infinite_error), FAULT(picture_box), FAULT(picture_past_end), FAULT(picture_null_runs), FAULT(pictures_taken_back),
        FAULT(replaces_runs), FAULT(replaces_pictures), FAULT(replaces_tests), FAULT(replaces_captures), FAULT(replaces_keep_pictures), FAULT(replaces_keep_captures),
        FAULT(rewrites_drawn), FAULT(item_twice_over_steps), FAULT(zone_twice_over_steps), FAULT(logs_and_runs_wild), FAULT(tests_endless),
        FAULT(captures_endless), FAULT(pictures_endless), FAULT(picture_composed), FAULT(picture_beside), FAULT(capture_composed_early),
        FAULT(writes_past_runs), FAULT(writes_past_tests), FAULT(writes_past_captures), FAULT(writes_past_pictures), FAULT(writes_past_clipped),
        FAULT(clipped_given), FAULT(clipped_too_many), FAULT(clipped_endless), FAULT(clipped_plane_count), FAULT(clipped_plane_nan), FAULT(clipped_plane_infinite),
        FAULT(clipped_box), FAULT(clipped_null_runs), FAULT(clipped_endless_runs), FAULT(clipped_wild_run), FAULT(clipped_mover), FAULT(clipped_zone_twice),
        FAULT(clipped_item_twice), FAULT(clipped_and_whole), FAULT(clipped_then_whole), FAULT(clipped_taken_back), FAULT(replaces_clipped),
        FAULT(replaces_keep_clipped),
    };
#undef FAULT
    for (size_t i = 0; i < sizeof faults / sizeof *faults; ++i)
        if (strcmp(faults[i].name, name) == 0) return &faults[i];
    return NULL;
}
