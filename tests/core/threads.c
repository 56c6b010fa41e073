// Tests of viewers that run at the same time on several threads: one chain, one report. Meant for ThreadSanitizer too.
// SPDX-License-Identifier: MIT
#include "session.h"
#include "tests/common/test.h"

#include <pthread.h>
#include <string.h>

enum { THREADS = 2, FRAMES = 200, ITEMS = 64 };

typedef struct worker {
    pthread_t thread;
    const session *s;
    world_view *view;
    uint32_t faults;
    uint64_t items_drawn;
} worker;

static void count_line(void *user, report_level level, const char *text)
{
    (void)level;
    (void)text;
    (void)__atomic_fetch_add((uint32_t *)user, 1, __ATOMIC_RELAXED);
}

static void *run_frames(void *argument)
{
    worker *w = argument;
    for (uint32_t frame = 1; frame <= FRAMES; ++frame) {
        const camera c = box_scene_camera(&w->s->q.boxes, frame);
        const frame_input input = {.camera = &c, .frame = {.width_px = 64, .height_px = 64, .frame = frame, .purpose = CULL_VIEW_MAIN}};
        frame_stats stats;
        world_cull(w->view, &input, NULL, &stats);
        w->faults += stats.faults;
        w->items_drawn += stats.items_drawn;
    }
    return NULL;
}

static void run_threads(session *s, worker workers[THREADS])
{
    for (int i = 0; i < THREADS; ++i) {
        workers[i] = (worker){.s = s, .view = s->view};
        if (i > 0) assert_int_equal(world_view_open(s->world, s->q.checks, &s->lines.report, &workers[i].view), RESULT_OK);
    }
    for (int i = 0; i < THREADS; ++i) assert_int_equal(pthread_create(&workers[i].thread, NULL, run_frames, &workers[i]), 0);
    for (int i = 0; i < THREADS; ++i) assert_int_equal(pthread_join(workers[i].thread, NULL), 0);
    for (int i = 1; i < THREADS; ++i) world_view_close(workers[i].view);
}

static void two_viewers_of_a_culler_that_logs_and_faults_lose_no_count(void **state)
{
    (void)state;
    static session s;
    worker workers[THREADS];
    uint32_t lines = 0;
    const session_request q = {.chain = "testbad[fault=logs_and_runs_wild]", .boxes = {.items = ITEMS, .movers = 3, .seed = 7}, .checks = VIEWER_CHECK_ALL};
    assert_int_equal(session_open(&s, &q), RESULT_OK);
    s.lines.report.line = count_line;
    s.lines.report.user = &lines;
    run_threads(&s, workers);
    for (int i = 0; i < THREADS; ++i) {
        assert_int_equal(workers[i].faults, FRAMES);
        assert_int_equal(workers[i].items_drawn, (uint64_t)FRAMES * ITEMS);
    }
    assert_int_equal(s.lines.report.warnings, THREADS * FRAMES);
    assert_int_equal(s.lines.report.errors, THREADS * (FRAMES + 1)); // the culler's own, and the host's one a viewer
    assert_int_equal(lines, 20 + THREADS * (FRAMES + 1));
    session_close(&s);
}

static void two_viewers_of_good_chains_run_at_once(void **state)
{
    (void)state;
    static const char *const chains[] = {"brute+testfilter[keep=all]", "testmore", "testorder+testfilter[walk=1,keep=all,movers=1]", "testbad[fault=rewrites_drawn]"};
    for (int n = 0; n < 4; ++n) {
        static session s;
        worker workers[THREADS];
        const session_request q = {.chain = chains[n], .boxes = {.items = ITEMS, .movers = 3, .seed = 7}, .checks = VIEWER_CHECK_ALL};
        assert_int_equal(session_open(&s, &q), RESULT_OK);
        run_threads(&s, workers);
        assert_int_equal(workers[0].faults + workers[1].faults, 0);
        assert_true(workers[0].items_drawn > 0);
        assert_int_equal(workers[0].items_drawn, workers[1].items_drawn);
        session_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_viewers_of_a_culler_that_logs_and_faults_lose_no_count),
        cmocka_unit_test(two_viewers_of_good_chains_run_at_once),
    };
    return cmocka_run_group_tests_name("core threads", tests, NULL, NULL);
}
