// Tests of views culled on several threads at once, with chains built beside them. Meant for ThreadSanitizer too.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "site.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static const site_grid rooms = {.wide = 4, .deep = 4, .items = 600, .movers = 50, .seed = 81};
enum { ROOMS = 16, THREADS = 2, VIEWS_EACH = 2, FRAMES = 60 };

typedef struct answers { uint64_t sums[FRAMES]; } answers; // of one view, by frame

typedef struct worker {
    pthread_t thread;
    world_view *views[VIEWS_EACH];
    answers out[VIEWS_EACH];
    uint32_t first; // number of its first view
} worker;

static uint64_t mix(uint64_t sum, uint64_t value)
{
    return (sum ^ value) * 0x100000001b3u;
}

static uint64_t sum_of(const visible_set *set)
{
    uint64_t sum = 14695981039346656037u;
    for (uint32_t i = 0; i < set->zone_count; i++) {
        sum = mix(sum, set->zones[i].zone);
        for (uint32_t r = 0; r < set->zones[i].run_count; r++) sum = mix(mix(sum, set->zones[i].runs[r].first), set->zones[i].runs[r].count);
    }
    for (uint32_t i = 0; i < set->mover_count; i++) sum = mix(sum, set->movers[i]);
    return sum;
}

static void cull_once(world_view *v, uint32_t number, uint32_t frame, answers *out)
{
    visible_set set;
    frame_stats stats;
    uint64_t random = number * 1000 + frame;
    const camera c = site_random_camera(&random, &rooms);
    const frame_input q = site_input(&c, frame + 1);
    world_cull(v, &q, &set, &stats);
    out->sums[frame] = sum_of(&set);
}

static void *work(void *argument)
{
    worker *w = argument;
    for (uint32_t frame = 0; frame < FRAMES; frame++)
        for (uint32_t k = 0; k < VIEWS_EACH; k++) cull_once(w->views[k], w->first + k, frame, &w->out[k]);
    return NULL;
}

// The heap's own: the counting allocator is one thread's.
static void open_grid(site *s)
{
    static const char *const some[] = {"brute+portal", "frustum", "testmore", "brute+testfilter[keep=all,movers=1]", "testorder+testfilter[walk=1]", "none"};
    const char *chains[ROOMS + 1];
    for (uint32_t i = 0; i <= ROOMS; i++) chains[i] = some[i % 6];
    site_begin(s, 0);
    host_services_fill(&s->services, allocator_heap(), &s->lines.report);
    assert_int_equal(site_make_grid(s, &rooms), RESULT_OK);
    assert_int_equal(site_open(s, &(site_world){"brute", chains, 0}), RESULT_OK);
}

static void two_threads_of_two_views_give_the_sets_of_one_thread(void **state)
{
    (void)state;
    static site s;
    static worker workers[THREADS];
    static answers alone[THREADS * VIEWS_EACH];
    open_grid(&s);
    for (uint32_t i = 0; i < THREADS * VIEWS_EACH; i++) {
        world_view *v = NULL;
        assert_int_equal(world_view_open(s.world, VIEWER_CHECK_BOUNDS, &s.lines.report, &v), RESULT_OK);
        for (uint32_t frame = 0; frame < FRAMES; frame++) cull_once(v, i, frame, &alone[i]);
        world_view_close(v);
    }
    for (uint32_t t = 0; t < THREADS; t++) {
        workers[t].first = t * VIEWS_EACH;
        for (uint32_t k = 0; k < VIEWS_EACH; k++)
            assert_int_equal(world_view_open(s.world, VIEWER_CHECK_BOUNDS, &s.lines.report, &workers[t].views[k]), RESULT_OK);
    }
    for (uint32_t t = 0; t < THREADS; t++) assert_int_equal(pthread_create(&workers[t].thread, NULL, work, &workers[t]), 0);
    for (uint32_t t = 0; t < THREADS; t++) assert_int_equal(pthread_join(workers[t].thread, NULL), 0);
    for (uint32_t t = 0; t < THREADS; t++)
        for (uint32_t k = 0; k < VIEWS_EACH; k++) assert_memory_equal(&workers[t].out[k], &alone[t * VIEWS_EACH + k], sizeof(answers));
    site_close(&s);
}

// ---- Swaps built beside ----

typedef struct builder {
    pthread_t thread;
    const world *world;
    report *log;
    chain_spec spec;
    uint32_t first;
    world_swap *made[ROOMS];
} builder;

static void *build(void *argument)
{
    builder *b = argument;
    for (uint32_t zone = b->first; zone < ROOMS; zone += 2)
        if (world_swap_build(b->world, zone, &b->spec, b->log, &b->made[zone]) != RESULT_OK) b->made[zone] = NULL;
    return NULL;
}

static void chains_are_built_on_two_threads_while_views_are_culled(void **state)
{
    (void)state;
    static site s;
    static worker w;
    static builder builders[2];
    open_grid(&s);
    for (uint32_t k = 0; k < VIEWS_EACH; k++) assert_int_equal(world_view_open(s.world, VIEWER_CHECK_BOUNDS, &s.lines.report, &w.views[k]), RESULT_OK);
    for (uint32_t i = 0; i < 2; i++) {
        builders[i] = (builder){.world = s.world, .log = &s.lines.report, .first = i};
        site_parse(&s, i ? "testpicture+testfilter[keep=all]" : "testorder+testfilter[keep=all]", &builders[i].spec); // libraries that nobody has opened yet
    }
    assert_int_equal(pthread_create(&w.thread, NULL, work, &w), 0);
    for (int i = 0; i < 2; i++) assert_int_equal(pthread_create(&builders[i].thread, NULL, build, &builders[i]), 0);
    for (int i = 0; i < 2; i++) assert_int_equal(pthread_join(builders[i].thread, NULL), 0);
    assert_int_equal(pthread_join(w.thread, NULL), 0);
    for (uint32_t zone = 0; zone < ROOMS; zone++) {
        world_swap *made = builders[zone % 2].made[zone];
        assert_non_null(made);
        assert_int_equal(world_swap_commit(s.world, made, &s.lines.report), RESULT_OK);
        assert_int_equal(world_chain(s.world, zone)->stage_count, 2);
    }
    site_close(&s);
}

// ---- Nothing changes while a view is culled ----

#ifndef NDEBUG
static void shut_a_door(void *user, uint32_t zone, const cull_run *runs, uint32_t count)
{
    (void)zone;
    (void)runs;
    (void)count;
    world_set_door(user, 0, DOORS_SHUT);
}

static void a_change_while_a_view_is_culled_is_caught(void **state)
{
    (void)state;
    static site s;
    world_view *v = NULL;
    open_grid(&s);
    assert_int_equal(world_view_open(s.world, VIEWER_CHECK_BOUNDS, &s.lines.report, &v), RESULT_OK);
    fflush(NULL);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        const struct rlimit none = {0, 0};
        (void)setrlimit(RLIMIT_CORE, &none);
        (void)signal(SIGABRT, SIG_DFL);
        if (!freopen("/dev/null", "w", stderr)) _exit(1);
        uint64_t random = 1;
        const camera c = site_random_camera(&random, &rooms);
        frame_input q = site_input(&c, 1);
        q.driver = (frame_driver){.user = s.world, .draw = shut_a_door};
        frame_stats stats;
        world_cull(v, &q, NULL, &stats);
        _exit(0);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT);
    site_close(&s);
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_threads_of_two_views_give_the_sets_of_one_thread),
        cmocka_unit_test(chains_are_built_on_two_threads_while_views_are_culled),
#ifndef NDEBUG
        cmocka_unit_test(a_change_while_a_view_is_culled_is_caught),
#endif
    };
    return cmocka_run_group_tests_name("world threads", tests, NULL, NULL);
}
