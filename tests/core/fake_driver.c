// A frame driver without a renderer: see fake_driver.h.
// SPDX-License-Identifier: MIT
#include "fake_driver.h"

#include "tests/common/test.h"

static void note(fake_driver *f, fake_event e)
{
    assert_true(f->event_count < FAKE_EVENTS_MOST);
    f->events[f->event_count++] = e;
}

static void count_runs(uint32_t *times, const cull_run *runs, uint32_t run_count)
{
    for (uint32_t r = 0; r < run_count; ++r) {
        assert_true(runs[r].first < FAKE_PLACES_MOST && runs[r].count <= FAKE_PLACES_MOST - runs[r].first);
        for (uint32_t i = 0; i < runs[r].count; ++i) times[runs[r].first + i]++;
    }
}

static void fake_draw(void *user, uint32_t zone, const cull_run *runs, uint32_t run_count)
{
    fake_driver *f = user;
    (void)zone;
    note(f, FAKE_DRAW);
    count_runs(f->drawn, runs, run_count);
}

static void fake_draw_movers(void *user, const uint32_t *movers, uint32_t count)
{
    fake_driver *f = user;
    note(f, FAKE_DRAW_MOVERS);
    for (uint32_t i = 0; i < count; ++i) count_runs(f->drawn, &(cull_run){f->mover_base + movers[i], 1}, 1);
}

static void fake_capture(void *user, uint32_t zone, const cull_capture *captures, uint32_t count)
{
    fake_driver *f = user;
    (void)zone;
    note(f, FAKE_CAPTURE);
    f->captures += count;
    f->last_slot = captures[count - 1].slot;
}

static void fake_show(void *user, uint32_t zone, const cull_picture *pictures, uint32_t count)
{
    fake_driver *f = user;
    (void)zone;
    note(f, FAKE_SHOW);
    f->shows += count;
    for (uint32_t i = 0; i < count; ++i) count_runs(f->shown, pictures[i].runs, pictures[i].run_count);
}

static void fake_test(void *user, uint32_t zone, const cull_test *tests, uint32_t count, uint32_t frame)
{
    fake_driver *f = user;
    (void)zone;
    note(f, FAKE_TEST);
    f->tests += count;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t pixels = f->pixels_of ? f->pixels_of(&tests[i]) : 1;
        assert_true(f->pending_count < FAKE_TESTS_MOST);
        if (pixels != FAKE_NO_ANSWER) f->pending[f->pending_count++] = (fake_pending){tests[i].tag, pixels, frame, f->latency};
    }
}

static uint32_t fake_collect(void *user, uint32_t zone, collect_how how, uint32_t frame, cull_answer *answers, uint32_t capacity,
                             uint32_t *stalled)
{
    fake_driver *f = user;
    (void)zone;
    uint32_t got = 0, left = 0;
    note(f, how == COLLECT_EVERYTHING ? FAKE_COLLECT_ALL : FAKE_COLLECT_READY);
    for (uint32_t i = 0; i < f->pending_count; ++i) {
        fake_pending *p = &f->pending[i];
        const int ready = p->collects_left == 0;
        if (how == COLLECT_EVERYTHING && !ready) *stalled = 1;
        if (got < capacity && (ready || how == COLLECT_EVERYTHING)) answers[got++] = (cull_answer){p->tag, p->pixels, frame - p->frame};
        else {
            p->collects_left -= !ready;
            f->pending[left++] = *p;
        }
    }
    f->pending_count = left;
    return got;
}

static void fake_draw_clipped(void *user, uint32_t zone, const cull_clipped *clipped, uint32_t count)
{
    fake_driver *f = user;
    (void)zone;
    note(f, FAKE_DRAW_CLIPPED);
    f->clips += count;
    for (uint32_t i = 0; i < count; ++i) count_runs(f->clipped, clipped[i].runs, clipped[i].run_count);
}

static void fake_check_slots(void *user, uint32_t zone, uint8_t *slots, uint32_t count)
{
    fake_driver *f = user;
    (void)zone;
    for (uint32_t i = 0; i < count && f->loses_slots; ++i) slots[i] = 0;
}

void fake_driver_init(fake_driver *f)
{
    *f = (fake_driver){0};
}

void fake_driver_new_frame(fake_driver *f)
{
    f->event_count = f->captures = f->shows = f->tests = f->clips = 0;
    for (uint32_t i = 0; i < FAKE_PLACES_MOST; ++i) f->drawn[i] = f->shown[i] = f->clipped[i] = 0;
}

frame_driver fake_driver_of(fake_driver *f)
{
    return (frame_driver){f, fake_draw, fake_draw_movers, fake_capture, fake_show, fake_test, fake_collect, fake_draw_clipped, fake_check_slots, NULL};
}
