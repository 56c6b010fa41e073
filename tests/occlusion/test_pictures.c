// Pictures of a select before occlusion: those hidden behind what the frame drew are neither shown nor taken, no other is dropped. By a town on a grid of
// squares: those near the eye are candidates, those beyond pictures.
// SPDX-License-Identifier: MIT
#include "fake_host.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 6, SQUARES = SIDE * SIDE, HOUSES = 8, ITEMS = SQUARES * HOUSES, FRAMES = 10 };
static const float SQUARE_M = 20, NEAR_M = 35;

typedef struct town {
    hand_zone zone;
    cull_box squares[SQUARES];
    cull_run runs[SQUARES];
    cull_picture pictures[SQUARES];
    cull_capture captures[SQUARES];
    uint32_t picture_count, capture_count;
} town;

// Square by square, so that each is a run.
static void town_make(town *t)
{
    static cull_box boxes[ITEMS];
    uint64_t seed = 19;
    for (uint32_t s = 0; s < SQUARES; s++) {
        const float x0 = (float)(s % SIDE) * SQUARE_M, z0 = (float)(s / SIDE) * SQUARE_M;
        t->squares[s] = cull_box_none();
        t->runs[s] = (cull_run){s * HOUSES, HOUSES};
        for (uint32_t i = 0; i < HOUSES; i++) {
            const float x = x0 + (float)random_between(&seed, 0, 12), z = z0 + (float)random_between(&seed, 0, 12);
            const float w = (float)random_between(&seed, 2, 8), h = (float)random_between(&seed, 2, 14);
            boxes[s * HOUSES + i] = (cull_box){{x, 0, z}, {x + w, h, z + w}};
            t->squares[s] = cull_box_union(t->squares[s], boxes[s * HOUSES + i]);
        }
    }
    zone_of_boxes(boxes, ITEMS, &t->zone);
}

static float away(float low, float high, float at)
{
    return at < low ? low - at : at > high ? at - high : 0;
}

// Each third picture is taken anew.
static void part(town *t, cull_vec3 eye, uint32_t frame, fake_viewer *v)
{
    t->picture_count = t->capture_count = 0;
    for (uint32_t s = 0; s < SQUARES; s++) {
        const cull_box b = t->squares[s];
        const float x = away(b.min.x, b.max.x, eye.x), z = away(b.min.z, b.max.z, eye.z);
        const int is_near = x * x + z * z < NEAR_M * NEAR_M;
        memset(v->allowed + s * HOUSES, is_near, HOUSES);
        if (is_near) continue;
        t->pictures[t->picture_count++] = (cull_picture){.runs = &t->runs[s], .box = b, .run_count = 1, .slot = s};
        if ((s + frame) % 3 == 0) t->captures[t->capture_count++] = (cull_capture){.runs = &t->runs[s], .box = b, .run_count = 1, .slot = s, .width_px = 8, .height_px = 8};
    }
    v->pictures = t->pictures;
    v->captures = t->captures;
    v->picture_count = t->picture_count;
    v->capture_count = t->capture_count;
}

static void look(fake_view *view, uint32_t frame, cull_vec3 *eye)
{
    *eye = (cull_vec3){5 + 10.0f * (float)frame, 1.7f, 58};
    fake_view_make(view, *eye, 0.4 + 0.12 * frame, 0);
}

typedef struct totals { uint32_t shown, dropped, captures, captures_dropped, tests; } totals;

// Of everything there is, behind pictures too.
static void must_own_nothing(fake_viewer *v, const fake_view *view, const town *t, uint32_t frame)
{
    static uint8_t visible[ITEMS + FAKE_MOVERS_MOST], allowed[ITEMS];
    memcpy(allowed, v->allowed, ITEMS);
    memset(v->allowed, 1, ITEMS);
    fake_truth(v, view, visible);
    memcpy(v->allowed, allowed, ITEMS);
    for (uint32_t p = 0; p < t->picture_count; p++)
        for (uint32_t i = 0; i < HOUSES; i++)
            if (!v->keep_pictures[p] && visible[t->pictures[p].slot * HOUSES + i]) fail_msg("frame %u: square %u is seen, and was dropped", frame, t->pictures[p].slot);
    for (uint32_t i = 0; i < ITEMS; i++)
        if (visible[i] && v->allowed[i] && !v->drawn[i]) fail_msg("frame %u: item %u is seen, and was dropped", frame, i);
}

static void count(const fake_viewer *v, const town *t, totals *n)
{
    n->tests += v->tests_asked;
    for (uint32_t p = 0; p < t->picture_count; p++) {
        n->shown += v->keep_pictures[p];
        n->dropped += !v->keep_pictures[p];
        for (uint32_t c = 0; c < t->capture_count; c++)
            if (t->captures[c].slot == t->pictures[p].slot) assert_int_equal(v->keep_captures[c], v->keep_pictures[p]);
    }
    for (uint32_t c = 0; c < t->capture_count; c++) {
        n->captures += v->keep_captures[c];
        n->captures_dropped += !v->keep_captures[c];
    }
}

static totals walk(const char *method, fake_answers how)
{
    static town t;
    static fake_view view;
    fake_culler c;
    fake_viewer v;
    totals n = {0};
    town_make(&t);
    assert_int_equal(fake_culler_open(&c, &t.zone, method, CHAIN_CANDIDATES, 0), CULL_OK);
    fake_viewer_open(&v, &c);
    v.how = how;
    for (uint32_t f = 0; f < FRAMES; f++) {
        cull_vec3 eye;
        look(&view, f, &eye);
        part(&t, eye, f, &v);
        const char *fault = fake_frame(&v, &view, 0);
        if (fault) fail_msg("%s: %s in frame %u", method, fault, f);
        must_own_nothing(&v, &view, &t, f);
        count(&v, &t, &n);
    }
    fake_viewer_close(&v);
    fake_culler_close(&c);
    assert_true(failing_allocator_is_clean(&c.host.memory));
    hand_zone_free(&t.zone);
    return n;
}

static const char *const asking[] = {"wait", "twophase", "chc", "chc batch=off"};
enum { ASKING = 4 };

static void what_is_hidden_is_neither_shown_nor_taken_and_nothing_else_is_dropped(void **state)
{
    (void)state;
    for (int m = 0; m < ASKING; m++)
        for (int how = ANSWERS_ALL; how <= ANSWERS_SHUFFLED; how++) {
            const totals n = walk(asking[m], (fake_answers)how);
            if (how == ANSWERS_NONE) assert_int_equal(n.dropped + n.captures_dropped, 0);
            else assert_true(n.dropped > 12 && n.captures_dropped > 4 && n.shown > 12);
        }
}

static void hiz_does_so_without_asking(void **state)
{
    (void)state;
    const totals one = walk("hiz", ANSWERS_ALL), four = walk("hiz threads=4 isa=plain", ANSWERS_ALL);
    assert_int_equal(one.tests, 0);
    assert_true(one.dropped > 12 && one.captures_dropped > 4 && one.shown > 12);
    assert_memory_equal(&one, &four, sizeof one);
}

static void where_all_stand_behind_a_wall_all_go(void **state)
{
    (void)state;
    static town t;
    static fake_view view;
    fake_culler c;
    fake_viewer v;
    for (uint32_t p = 0; p < SQUARES; p++) t.runs[p] = (cull_run){p * HOUSES, HOUSES};
    static cull_box boxes[ITEMS];
    for (uint32_t i = 0; i < ITEMS; i++) boxes[i] = i < HOUSES ? (cull_box){{-200, -50, 10}, {200, 90, 11}} : (cull_box){{(float)i, 0, 100}, {(float)i + 1, 5, 101}};
    zone_of_boxes(boxes, ITEMS, &t.zone);
    for (uint32_t p = 1; p < SQUARES; p++) {
        t.pictures[p - 1] = (cull_picture){.runs = &t.runs[p], .box = {{(float)(p * HOUSES), 0, 100}, {(float)((p + 1) * HOUSES), 5, 101}}, .run_count = 1, .slot = p};
        t.captures[p - 1] = (cull_capture){.runs = &t.runs[p], .box = t.pictures[p - 1].box, .run_count = 1, .slot = p, .width_px = 8, .height_px = 8};
    }
    const char *const all[] = {"wait", "twophase", "chc", "hiz"};
    for (int m = 0; m < 4; m++) {
        assert_int_equal(fake_culler_open(&c, &t.zone, all[m], CHAIN_CANDIDATES, 0), CULL_OK);
        fake_viewer_open(&v, &c);
        memset(v.allowed, 0, ITEMS);
        memset(v.allowed, 1, HOUSES);
        v.pictures = t.pictures;
        v.captures = t.captures;
        v.picture_count = v.capture_count = SQUARES - 1;
        for (uint32_t f = 0; f < 30; f++) {
            fake_view_make(&view, (cull_vec3){100, 2, 0}, 0, 0);
            assert_null(fake_frame(&v, &view, 0));
            for (uint32_t p = 0; p + 1 < SQUARES; p++)
                if (v.keep_pictures[p] || v.keep_captures[p]) fail_msg("%s, frame %u: picture %u is kept", all[m], f, p);
        }
        fake_viewer_close(&v);
        fake_culler_close(&c);
    }
    hand_zone_free(&t.zone);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_hidden_is_neither_shown_nor_taken_and_nothing_else_is_dropped),
        cmocka_unit_test(hiz_does_so_without_asking),
        cmocka_unit_test(where_all_stand_behind_a_wall_all_go),
    };
    return cmocka_run_group_tests_name("occlusion: pictures of a select before", tests, NULL, NULL);
}
