// Checks of answers against answers: the same whatever came before, in the promised order, beside other cullers and threads.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "checks.h"

#include <math.h>
#include <string.h>

enum { VIEWS = 10, THREADS = 4, ROUNDS = 40 };
static const scene_kind kinds[] = {SCENE_SPREAD, SCENE_CITY, SCENE_ROOM, SCENE_MESH, SCENE_PANES, SCENE_GRID};
enum { KINDS = sizeof kinds / sizeof *kinds };

static void views_make(check_run *r, const made_scene *s, made_view views[VIEWS])
{
    for (uint32_t i = 0; i < VIEWS; ++i) view_make(r, s, (view_how)(i % VIEW_HOWS), &views[i]);
}

// ---- STATELESS ----

// First answers, each of a fresh query; then one query in another order; then another build, of tasks run backwards and memory
// that held something else.
static check_verdict compare_orders(check_run *r, bench_seat *b, made_view views[VIEWS])
{
    sitting_answer first[VIEWS];
    for (uint32_t i = 0; i < VIEWS; ++i) {
        const sitting_frame f = {.view = &views[i]};
        answer_open(&first[i], &b->scene);
        sitting_close(&b->sitting);
        if (sitting_open(&b->sitting, &b->stand, LISTS_ROOMY) != CULL_OK) return run_fail(r, "it opens no second query");
        run_at(r, "scene %s, view %u", made_scene_name(b->scene.kind), (unsigned)i);
        sitting_step(&b->sitting, &f, &first[i]);
    }
    for (uint32_t n = 0; n < 3 * VIEWS; ++n) {
        const uint32_t i = run_below(r, VIEWS);
        const sitting_frame f = {.view = &views[i], .flags = run_below(r, 2) ? CULL_VIEW_CUT : 0};
        run_at(r, "scene %s, view %u, after %u others", made_scene_name(b->scene.kind), (unsigned)i, (unsigned)n);
        sitting_step(&b->sitting, &f, &b->answer);
        if (!answers_equal(&b->answer, &first[i])) return run_fail(r, "the same view has another answer after other views");
    }
    stand_values values;
    stand_defaults(r->plugin, &values);
    const stand_request again = {.plugin = r->plugin, .values = &values, .scene = &b->scene, .tasks = TASKS_BACKWARD, .fill = 0x3c};
    static stand other;
    sitting seat;
    if (stand_open(&other, &again) != CULL_OK || sitting_open(&seat, &other, LISTS_ROOMY) != CULL_OK) return run_fail(r, "it builds once and not twice");
    for (uint32_t i = 0; i < VIEWS; ++i) {
        const sitting_frame f = {.view = &views[i]};
        run_at(r, "scene %s, view %u, built again", made_scene_name(b->scene.kind), (unsigned)i);
        sitting_step(&seat, &f, &b->answer);
        if (!answers_equal(&b->answer, &first[i])) return run_fail(r, "the same view has another answer from a second build of the same zone");
        answer_close(&first[i]);
    }
    sitting_close(&seat);
    stand_close(&other);
    lender_close(&other.lender);
    return CHECK_PASS;
}

check_verdict check_stateless(check_run *r)
{
    uint32_t tried = 0;
    for (int k = 0; k < KINDS; ++k) {
        static bench_seat b;
        static made_view views[VIEWS];
        const seat_request q = {.kind = kinds[k]};
        const seat_state state = seat_open(r, &q, &b);
        if (state == SEAT_FAULTY) return CHECK_FAIL;
        if (state == SEAT_GOOD && b.stand.built.promises & CULL_STATELESS) {
            views_make(r, &b.scene, views);
            if (compare_orders(r, &b, views) == CHECK_FAIL) return CHECK_FAIL;
            tried++;
        }
        seat_close(&b);
    }
    return tried ? CHECK_PASS : run_skip(r, "it does not promise STATELESS");
}

// ---- ORDERED ----

static double distance_to(const cull_box *b, const double eye[3])
{
    double square = 0;
    for (int i = 0; i < 3; ++i) {
        const double low = (double)(&b->min.x)[i] - eye[i], high = eye[i] - (double)(&b->max.x)[i], away = low > 0 ? low : high > 0 ? high : 0;
        square += away * away;
    }
    return sqrt(square);
}

static check_verdict order_judge(check_run *r, const bench_seat *b, const made_view *v)
{
    double before = 0;
    const uint32_t items = b->scene.zone.item_count;
    for (uint32_t i = 0; i < b->answer.run_count; ++i) {
        if (b->answer.runs[i].first >= items) continue;
        const double at = distance_to(&b->scene.boxes[stand_item(&b->stand, b->answer.runs[i].first)], v->camera.eye);
        // 2^-20 of the distance: what float arithmetic may turn round; CULL_GUARD_DISTANCE
        if (at < before * (1 - 1.0 / 1048576)) return run_fail(r, "run %u begins %g m away, behind one at %g m", (unsigned)i, at, before);
        before = at;
    }
    return CHECK_PASS;
}

check_verdict check_ordered(check_run *r)
{
    uint32_t tried = 0;
    if (stand_role_of(r->plugin) == ROLE_CROSS) return run_skip(r, "it gives no runs");
    for (int k = 0; k < KINDS; ++k) {
        static bench_seat b;
        const seat_request q = {.kind = kinds[k]};
        const seat_state state = seat_open(r, &q, &b);
        if (state == SEAT_FAULTY) return CHECK_FAIL;
        for (uint32_t i = 0; state == SEAT_GOOD && b.stand.built.promises & CULL_ORDERED && i < VIEWS; ++i) {
            made_view v;
            view_make(r, &b.scene, (view_how)(i % VIEW_HOWS), &v);
            run_at(r, "scene %s, view %u", made_scene_name(kinds[k]), (unsigned)i);
            const sitting_frame f = {.view = &v};
            sitting_step(&b.sitting, &f, &b.answer);
            if (order_judge(r, &b, &v) == CHECK_FAIL) return CHECK_FAIL;
            tried++;
        }
        seat_close(&b);
    }
    return tried ? CHECK_PASS : run_skip(r, "it does not promise ORDERED");
}

// ---- Two cullers ----

// Each alone, then both in turn. Without the promise STATELESS the two are given the same history both times.
check_verdict check_instances(check_run *r)
{
    static bench_seat b[2];
    static made_view views[2][VIEWS];
    sitting_answer alone[2][VIEWS];
    for (int n = 0; n < 2; ++n) {
        const seat_request q = {.kind = kinds[n]};
        const seat_state state = seat_open(r, &q, &b[n]);
        if (state == SEAT_FAULTY) return CHECK_FAIL;
        if (state == SEAT_REFUSED) return run_skip(r, "it refuses the scenes for this");
        views_make(r, &b[n].scene, views[n]);
        for (int i = 0; i < VIEWS; ++i) {
            const sitting_frame f = {.view = &views[n][i]};
            run_at(r, "scene %s, view %d, alone", made_scene_name(kinds[n]), i);
            answer_open(&alone[n][i], &b[n].scene);
            sitting_step(&b[n].sitting, &f, &alone[n][i]);
        }
    }
    for (int n = 0; n < 2; ++n) {
        sitting_close(&b[n].sitting);
        if (sitting_open(&b[n].sitting, &b[n].stand, LISTS_ROOMY) != CULL_OK) return run_fail(r, "it opens no second query");
    }
    for (int i = 0; i < 2 * VIEWS; ++i) {
        const int n = i % 2, view = i / 2;
        const sitting_frame f = {.view = &views[n][view]};
        run_at(r, "scene %s, view %d, in turn with another culler's", made_scene_name(kinds[n]), view);
        sitting_step(&b[n].sitting, &f, &b[n].answer);
        if (!answers_equal(&b[n].answer, &alone[n][view])) return run_fail(r, "its answer is another while a second culler lives");
    }
    return CHECK_PASS;
}

// ---- Threads ----

typedef struct parallel_task {
    sitting sitting;
    sitting_answer answer;
    const sitting_answer *wanted;
    const made_view *views;
    pthread_barrier_t *start;
    uint32_t first, wrong;
} parallel_task;

// All views in turn, some rounds of them; a sitting of its own, so that history is the serial one's.
static void *run_views(void *user)
{
    parallel_task *t = user;
    pthread_barrier_wait(t->start);
    for (uint32_t n = 0; n < ROUNDS; ++n) {
        const uint32_t i = n % VIEWS;
        const sitting_frame f = {.view = &t->views[i]};
        sitting_step(&t->sitting, &f, &t->answer);
        t->wrong += !answers_equal(&t->answer, &t->wanted[n]);
    }
    return NULL;
}

static check_verdict run_threads(check_run *r, bench_seat *b, const made_view *views, const sitting_answer *wanted)
{
    parallel_task tasks[THREADS];
    pthread_t threads[THREADS];
    pthread_barrier_t start;
    uint32_t wrong = 0;
    pthread_barrier_init(&start, NULL, THREADS);
    memset(tasks, 0, sizeof tasks);
    for (uint32_t i = 0; i < THREADS; ++i) {
        if (sitting_open(&tasks[i].sitting, &b->stand, LISTS_ROOMY) != CULL_OK) return run_fail(r, "it does not open several queries");
        answer_open(&tasks[i].answer, &b->scene);
        tasks[i].wanted = wanted;
        tasks[i].views = views;
        tasks[i].start = &start;
    }
    for (uint32_t i = 0; i < THREADS; ++i)
        if (pthread_create(&threads[i], NULL, run_views, &tasks[i]) != 0) return run_skip(r, "no threads can be had here");
    for (uint32_t i = 0; i < THREADS; ++i) pthread_join(threads[i], NULL);
    for (uint32_t i = 0; i < THREADS; ++i) {
        wrong += tasks[i].wrong;
        sitting_close(&tasks[i].sitting);
        answer_close(&tasks[i].answer);
    }
    return wrong ? run_fail(r, "%u of %u answers differ from those of a query alone", (unsigned)wrong, (unsigned)(THREADS * ROUNDS)) : CHECK_PASS;
}

check_verdict check_parallel(check_run *r)
{
    for (int k = 0; k < KINDS; ++k) {
        static bench_seat b;
        static made_view views[VIEWS];
        sitting_answer wanted[ROUNDS];
        const seat_request q = {.kind = kinds[k]};
        const seat_state state = seat_open(r, &q, &b);
        if (state == SEAT_FAULTY) return CHECK_FAIL;
        if (state == SEAT_GOOD) {
            views_make(r, &b.scene, views);
            for (uint32_t i = 0; i < ROUNDS; ++i) {
                const sitting_frame f = {.view = &views[i % VIEWS]};
                answer_open(&wanted[i], &b.scene);
                sitting_step(&b.sitting, &f, &wanted[i]);
            }
            run_at(r, "scene %s, %d threads", made_scene_name(kinds[k]), THREADS);
            const check_verdict verdict = run_threads(r, &b, views, wanted);
            if (verdict != CHECK_PASS) return verdict;
            for (uint32_t i = 0; i < ROUNDS; ++i) answer_close(&wanted[i]);
        }
        seat_close(&b);
    }
    return CHECK_PASS;
}
