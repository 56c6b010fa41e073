// method=hiz answers the same whatever computes it: instruction sets bit for bit, bands on threads, pruned or not. And what stands in the
// way of an answer counts as seen.
// SPDX-License-Identifier: MIT
#include "hiz_stage.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <threads.h>

#include <cmocka.h>

enum { ITEMS = 900, MOVERS = 160, TASKS_MOST = 8 };

typedef struct town {
    hand_zone zone;
    camera camera;
    hiz_scene_view view;
    cull_mover movers[MOVERS];
    const char *pixels;
} town;

// Boxes of all sizes, some of them as six walls, and see-through ones among them.
static void town_open(town *t, uint64_t seed, uint32_t width_px, uint32_t height_px)
{
    t->pixels = seed % 3 == 0 ? "1" : seed % 3 == 1 ? "2" : "4";
    hand_zone_open(&t->zone, ITEMS * 6, ITEMS * 24);
    for (uint32_t i = 0; i < ITEMS; i++) {
        const float x = (float)random_between(&seed, -80, 80), z = (float)random_between(&seed, -80, 80), size = (float)random_between(&seed, 0.2, i % 4 ? 2 : 18);
        const cull_box box = {{x, 0, z}, {x + size, (float)random_between(&seed, 0.5, 20), z + size}};
        if (i % 5 == 0) hand_zone_box(&t->zone, box, FACE_OUT, i % 10 ? CULL_ITEM_TWO_SIDED : 0);
        else hand_zone_cluster(&t->zone, box);
        if (i % 17 == 0) t->zone.items[t->zone.zone.item_count - 1].flags |= CULL_ITEM_SEE_THROUGH;
    }
    hand_zone_end(&t->zone);
    t->camera = (camera){.eye = {random_between(&seed, -60, 60), 1.7, random_between(&seed, -60, 60)}, .forward = {random_between(&seed, -1, 1), -0.1, 1},
                         .up = {0, 1, 0}, .fovy_deg = 60, .aspect = (double)width_px / height_px, .near_m = 0.1, .far_m = 1000};
    scene_view_make(&t->camera, width_px, height_px, &t->zone.zone, &t->view);
    for (uint32_t i = 0; i < MOVERS; i++) {
        const float x = (float)random_between(&seed, -80, 80), z = (float)random_between(&seed, -80, 80);
        t->movers[i] = (cull_mover){{{x, 0, z}, {x + 1, 2, z + 1}}, t->zone.zone.item_count + i, 0};
    }
}

static void kernels_answer_bit_for_bit_alike(void **state)
{
    static const char *const names[] = {"avx2", "avx512"};
    (void)state;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        static town t;
        hiz_stage plain;
        town_open(&t, seed, seed & 1 ? 640 : 501, seed & 1 ? 360 : 283);
        stage_open(&plain, &t.zone.zone, "on", "1", "plain");
        memset(plain.scratch, 0, plain.scratch_size);
        stage_run(&plain, &t.view, t.movers, MOVERS);
        for (int n = 0; n < 2; n++) {
            hiz_stage s;
            if (!hiz_kernel_of(names[n])) continue;
            stage_open(&s, &t.zone.zone, "on", "1", names[n]);
            memset(s.scratch, 0, s.scratch_size);
            stage_run(&s, &t.view, t.movers, MOVERS);
            assert_int_equal(s.run_count, plain.run_count);
            assert_memory_equal(s.runs, plain.runs, s.run_count * sizeof *s.runs);
            assert_int_equal(s.scratch_size, plain.scratch_size);
            assert_true(memcmp(s.scratch, plain.scratch, s.scratch_size) == 0); // depths, owners, queue: all of it
            stage_close(&s);
        }
        stage_close(&plain);
        hand_zone_free(&t.zone);
    }
}

// ---- Threads ----

typedef struct threaded { void (*task)(void *, uint32_t); void *context; uint32_t i; } threaded;

static int thread_main(void *context)
{
    const threaded *t = context;
    t->task(t->context, t->i);
    return 0;
}

static void parallel_for(const cull_host *host, void (*task)(void *, uint32_t), void *context, uint32_t count)
{
    thrd_t threads[TASKS_MOST];
    threaded tasks[TASKS_MOST];
    (void)host;
    if (count > TASKS_MOST) abort();
    for (uint32_t i = 0; i < count; i++) {
        tasks[i] = (threaded){task, context, i};
        if (thrd_create(&threads[i], thread_main, &tasks[i]) != thrd_success) abort();
    }
    for (uint32_t i = 0; i < count; i++) thrd_join(threads[i], NULL);
}

static void set_of(const town *t, const char *prune, const char *threads, uint8_t *seen)
{
    hiz_stage s;
    stage_open_pixels(&s, &t->zone.zone, prune, threads, "auto", t->pixels);
    s.host.host.parallel_for = parallel_for;
    stage_run(&s, &t->view, t->movers, MOVERS);
    stage_set(&s, seen, t->zone.zone.item_count + MOVERS);
    stage_close(&s);
}

static void threads_find_the_same_set(void **state)
{
    static const char *const counts[] = {"2", "4", "8"};
    static uint8_t alone[ITEMS * 6 + MOVERS], together[ITEMS * 6 + MOVERS];
    (void)state;
    for (uint64_t seed = 11; seed <= 16; seed++)
        for (int n = 0; n < 3; n++) {
            static town t;
            town_open(&t, seed, 640, seed & 1 ? 360 : 77);
            set_of(&t, "on", "1", alone);
            set_of(&t, "on", counts[n], together);
            assert_memory_equal(alone, together, t.zone.zone.item_count + MOVERS);
            hand_zone_free(&t.zone);
        }
}

static void pruning_changes_nothing(void **state)
{
    static uint8_t on[ITEMS * 6 + MOVERS], off[ITEMS * 6 + MOVERS];
    (void)state;
    for (uint64_t seed = 21; seed <= 24; seed++) {
        static town t;
        town_open(&t, seed, 640, 360);
        set_of(&t, "on", "1", on);
        set_of(&t, "off", "1", off);
        assert_memory_equal(on, off, t.zone.zone.item_count + MOVERS);
        hand_zone_free(&t.zone);
    }
}

// ---- Nothing to go by ----

static void a_view_that_is_no_number_sees_all(void **state)
{
    static town t;
    (void)state;
    town_open(&t, 31, 640, 360);
    for (int fault = 0; fault < 4; fault++) {
        hiz_scene_view v = t.view;
        hiz_stage s;
        if (fault == 0) v.view.clip_from_zone[4] = NAN;
        if (fault == 1) v.view.eye_exact[1] = INFINITY;
        if (fault == 2) memset(v.view.clip_from_zone, 0, sizeof v.view.clip_from_zone);
        if (fault == 3) v.view.eye[3] = 0;
        v.sides.plane_count = v.volume.plane_count = 0;
        stage_open(&s, &t.zone.zone, "on", "1", "auto");
        stage_run(&s, &v, t.movers, MOVERS);
        uint32_t seen = 0;
        for (uint32_t i = 0; i < s.run_count; i++) seen += s.runs[i].count;
        assert_int_equal(seen, t.zone.zone.item_count + MOVERS);
        stage_close(&s);
    }
    hand_zone_free(&t.zone);
}

static void what_the_eye_is_in_is_seen(void **state)
{
    const cull_box boxes[] = {{{-1, -1, -1}, {1, 1, 1}}, {{-50, -50, 3}, {50, 50, 4}}, {{-1, -1, 20}, {1, 1, 21}}, {{-2, -2, 0.05f}, {2, 2, 0.2f}}};
    const camera c = {.forward = {0, 0, 1}, .up = {0, 1, 0}, .fovy_deg = 60, .aspect = 1, .near_m = 0.1, .far_m = 100};
    hand_zone zone;
    hiz_scene_view v;
    hiz_stage s;
    uint8_t seen[4];
    (void)state;
    zone_of_boxes(boxes, 4, &zone);
    scene_view_make(&c, 320, 320, &zone.zone, &v);
    stage_open(&s, &zone.zone, "on", "1", "auto");
    stage_run(&s, &v, NULL, 0);
    stage_set(&s, seen, 4);
    assert_int_equal(seen[0], 1);
    assert_int_equal(seen[1], 1);
    assert_int_equal(seen[3], 1);
    assert_int_equal(seen[2], 0); // behind the wall
    stage_close(&s);
    hand_zone_free(&zone);
}

static void a_picture_larger_than_the_buffer_is_all_seen(void **state)
{
    static const uint32_t sizes[][2] = {{9000, 720}, {1280, 4500}, {4097, 4097}};
    static town t;
    (void)state;
    for (int n = 0; n < 3; n++) {
        static uint8_t seen[ITEMS * 6 + MOVERS];
        hiz_stage s;
        town_open(&t, 41, sizes[n][0], sizes[n][1]);
        t.view.sides.plane_count = t.view.volume.plane_count = 0;
        stage_open(&s, &t.zone.zone, "on", "1", "auto");
        stage_run(&s, &t.view, t.movers, MOVERS);
        stage_set(&s, seen, t.zone.zone.item_count + MOVERS);
        assert_null(memchr(seen, 0, t.zone.zone.item_count + MOVERS));
        assert_int_equal(s.limits_hit, 1);
        stage_close(&s);
        hand_zone_free(&t.zone);
    }
}

// At the buffer's edge the picture is as exact as elsewhere.
static void a_picture_as_large_as_the_buffer_has_the_same_set_on_threads(void **state)
{
    static town t;
    static uint8_t alone[ITEMS * 6 + MOVERS], together[ITEMS * 6 + MOVERS];
    (void)state;
    town_open(&t, 43, 4096, 4096);
    set_of(&t, "on", "1", alone);
    set_of(&t, "on", "8", together);
    assert_memory_equal(alone, together, t.zone.zone.item_count + MOVERS);
    assert_non_null(memchr(alone, 0, t.zone.zone.item_count)); // and something is hidden
    hand_zone_free(&t.zone);
}

static void memory_that_runs_out_is_told(void **state)
{
    static town t;
    static const char *const values[] = {"on", "1", "auto", "auto"};
    hiz_options options;
    (void)state;
    town_open(&t, 51, 640, 360);
    for (uint64_t fail_at = 1;; fail_at++) {
        culler_host host;
        hiz h;
        culler_host_init(&host, fail_at);
        assert_int_equal(hiz_options_read(&host.host, values, &options), CULL_OK);
        const cull_result result = hiz_make(&host.host, &t.zone.zone, &options, &h);
        if (result == CULL_OK) hiz_free(&h);
        assert_true(failing_allocator_is_clean(&host.memory));
        if (result == CULL_OK) break;
        assert_int_equal(result, CULL_ERR_MEMORY);
        assert_true(fail_at < 50);
    }
    hand_zone_free(&t.zone);
}

static void options_out_of_range_are_refused(void **state)
{
    static const char *const wrong[][4] = {{"maybe", "1", "auto", "auto"}, {"on", "3", "auto", "auto"}, {"on", "", "auto", "auto"}, {"on", "16", "auto", "auto"},
                                           {"on", "1", "mmx", "auto"}, {"on", "1", "auto", "3"}, {"on", "1", "auto", ""}, {"on", "1", "auto", "22"}};
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        culler_host host;
        hiz_options options;
        culler_host_init(&host, 0);
        assert_int_equal(hiz_options_read(&host.host, wrong[i], &options), CULL_ERR_OPTION);
        assert_int_equal(host.lines, 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kernels_answer_bit_for_bit_alike),
        cmocka_unit_test(threads_find_the_same_set),
        cmocka_unit_test(pruning_changes_nothing),
        cmocka_unit_test(a_view_that_is_no_number_sees_all),
        cmocka_unit_test(what_the_eye_is_in_is_seen),
        cmocka_unit_test(a_picture_larger_than_the_buffer_is_all_seen),
        cmocka_unit_test(a_picture_as_large_as_the_buffer_has_the_same_set_on_threads),
        cmocka_unit_test(memory_that_runs_out_is_told),
        cmocka_unit_test(options_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
