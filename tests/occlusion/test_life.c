// Options, memory that fails, zones of odd shapes, numbers that are none.
// SPDX-License-Identifier: MIT
#include "fake_host.h"

#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void boxes_of(uint32_t count, hand_zone *z)
{
    cull_box *boxes = calloc(count + 1, sizeof *boxes);
    for (uint32_t i = 0; i < count; i++) {
        const float x = (float)(i % 10) * 3, zz = (float)(i / 10) * 3;
        boxes[i] = (cull_box){{x, 0, zz}, {x + 1, 1, zz + 1}};
    }
    zone_of_boxes(boxes, count, z);
    z->zone.mover_capacity = FAKE_MOVERS_MOST;
    free(boxes);
}

static void refuses_options_it_does_not_have(void **state)
{
    hand_zone z;
    fake_culler c;
    (void)state;
    boxes_of(20, &z);
    assert_int_equal(fake_culler_open(&c, &z, "guess", CHAIN_SELECT, 0), CULL_ERR_OPTION);
    assert_non_null(strstr(c.host.last_line, "method=guess"));
    assert_true(failing_allocator_is_clean(&c.host.memory));
    hand_zone_free(&z);
}

static void every_allocation_may_fail(void **state)
{
    hand_zone z;
    (void)state;
    boxes_of(200, &z);
    for (int chain = CHAIN_SELECT; chain <= CHAIN_LENT; chain++)
        for (uint64_t k = 1;; k++) {
            fake_culler c;
            cull_query *query = NULL;
            const cull_result built = fake_culler_open(&c, &z, "twophase", (fake_chain)chain, k);
            assert_true(built == CULL_OK || built == CULL_ERR_MEMORY);
            if (built != CULL_OK) {
                assert_true(failing_allocator_is_clean(&c.host.memory));
                continue;
            }
            const cull_result opened = c.plugin->open(c.culler, &query);
            assert_true(opened == CULL_OK || opened == CULL_ERR_MEMORY);
            assert_int_equal(opened == CULL_OK, query != NULL);
            if (query) c.plugin->close(query);
            fake_culler_close(&c);
            assert_true(failing_allocator_is_clean(&c.host.memory));
            if (opened == CULL_OK) {
                assert_true(k > 15);
                break;
            }
        }
    hand_zone_free(&z);
}

// All items in sight and none hidden: all are drawn, each once.
static void expect_all(const cull_box *boxes, uint32_t count)
{
    static fake_view view;
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    zone_of_boxes(boxes, count, &z);
    z.zone.mover_capacity = FAKE_MOVERS_MOST;
    fake_view_make(&view, (cull_vec3){0, 0, -30}, 0, 0);
    for (int m = 0; m < 3; m++) {
        static const char *const methods[] = {"wait", "last", "twophase"};
        assert_int_equal(fake_culler_open(&c, &z, methods[m], CHAIN_SELECT, 0), CULL_OK);
        fake_viewer_open(&v, &c);
        for (int f = 0; f < 3; f++) {
            assert_null(fake_frame(&v, &view, 0));
            assert_int_equal(v.drawn_count, count);
        }
        fake_viewer_close(&v);
        fake_culler_close(&c);
    }
    hand_zone_free(&z);
}

static void zones_of_odd_shapes_are_built_and_drawn(void **state)
{
    enum { MANY = 1000 };
    cull_box *boxes = calloc(MANY, sizeof *boxes);
    (void)state;
    expect_all(boxes, 0);
    for (int i = 0; i < MANY; i++) boxes[i] = (cull_box){{-1, -1, 0}, {1, 1, 1}};
    expect_all(boxes, 1);
    expect_all(boxes, MANY); // all the same box
    for (int i = 0; i < MANY; i++) boxes[i] = (cull_box){{-8, -2, 0}, {8, 2, 0}};
    expect_all(boxes, 30); // flat
    for (int i = 0; i < MANY; i++) boxes[i] = (cull_box){{(float)i * 0.02f - 10, -1, 0}, {(float)i * 0.02f - 9, 1, 0}};
    expect_all(boxes, MANY); // centres in a line
    for (int i = 0; i < MANY; i++) boxes[i] = (cull_box){{(float)(i % 10) - 5, (float)(i / 10 % 10) - 5, 0}, {(float)(i % 10) - 4, (float)(i / 10 % 10) - 4, 0}};
    boxes[MANY - 1] = (cull_box){{-500, -500, 0}, {500, 500, 0}};
    expect_all(boxes, MANY); // one giant
    free(boxes);
}

static void what_is_no_number_or_huge_is_drawn(void **state)
{
    const float nan = NAN;
    cull_box boxes[12];
    (void)state;
    for (int i = 0; i < 12; i++) boxes[i] = (cull_box){{(float)i - 6, 0, 20}, {(float)i - 5.5f, 1, 21}};
    boxes[2] = (cull_box){{nan, nan, nan}, {nan, nan, nan}};
    boxes[3] = (cull_box){{-FLT_MAX, -FLT_MAX, -FLT_MAX}, {FLT_MAX, FLT_MAX, FLT_MAX}};
    boxes[4] = (cull_box){{-1e30f, -1e30f, -1e30f}, {1e30f, 1e30f, 1e30f}};
    boxes[5] = (cull_box){{-1, -1, -31}, {1, 1, -29.95f}}; // round the eye
    static fake_view view;
    static const char *const methods[] = {"wait", "twophase"};
    hand_zone z;
    zone_of_boxes(boxes, 12, &z);
    z.zone.mover_capacity = FAKE_MOVERS_MOST;
    fake_view_make(&view, (cull_vec3){0, 0, -30}, 0, 0);
    for (int m = 0; m < 2; m++) {
        fake_culler c;
        fake_viewer v;
        assert_int_equal(fake_culler_open(&c, &z, methods[m], CHAIN_SELECT, 0), CULL_OK);
        fake_viewer_open(&v, &c);
        for (int f = 0; f < 4; f++) {
            assert_null(fake_frame(&v, &view, 0));
            for (int i = 2; i < 6; i++) assert_true(v.drawn[i]);
        }
        fake_viewer_close(&v);
        fake_culler_close(&c);
    }
    hand_zone_free(&z);
}

static void tells_why_and_how_much(void **state)
{
    static fake_view view;
    hand_zone z;
    fake_culler c;
    fake_viewer v;
    char text[200];
    (void)state;
    boxes_of(100, &z);
    fake_view_make(&view, (cull_vec3){0.5f, 0.5f, -10}, 0, 0);
    assert_int_equal(fake_culler_open(&c, &z, "twophase", CHAIN_SELECT, 0), CULL_OK);
    fake_viewer_open(&v, &c);
    for (int f = 0; f < 4; f++) assert_null(fake_frame(&v, &view, 0));
    const cull_explain *explain = c.plugin->get_extension(c.culler, CULL_EXT_EXPLAIN);
    const cull_visit visit = {.view = &view.view, .volumes = view.volumes, .volume_count = 1};
    uint32_t kept = 0, hidden = 0, outside = 0;
    for (uint32_t i = 0; i < 100; i++) {
        explain->item(v.query, &visit, i, text, sizeof text);
        kept += strncmp(text, "kept", 4) == 0;
        hidden += strstr(text, "behind what is drawn") != NULL;
        outside += strstr(text, "outside every volume") != NULL;
    }
    assert_int_equal(kept, v.drawn_count);
    assert_int_equal(kept + hidden + outside, 100);
    assert_true(hidden > 5);
    explain->item(v.query, &visit, 100, text, 8);
    assert_string_equal(text, "there i");
    fake_viewer_close(&v);
    const cull_figures *figures = c.plugin->get_extension(c.culler, CULL_EXT_FIGURES);
    double frames = 0, tests = 0;
    for (uint32_t i = 0; i < figures->count; i++) {
        if (strcmp(figures->figures[i].name, "frames") == 0) frames = figures->figures[i].value;
        if (strcmp(figures->figures[i].name, "tests") == 0) tests = figures->figures[i].value;
    }
    assert_true(frames == 4 && tests > 4);
    fake_culler_close(&c);
    hand_zone_free(&z);
}

static void expect_what_is_visible(fake_viewer *v, const fake_view *view)
{
    static uint8_t visible[100 + FAKE_MOVERS_MOST];
    const char *fault = fake_frame(v, view, 0);
    if (fault) fail_msg("%s", fault);
    fake_truth(v, view, visible);
    for (uint32_t i = 0; i < 100; i++) assert_true(!visible[i] || v->drawn[i]);
}

// Nothing is hidden from above: some of these frames are at rest.
static void what_is_drawn_clipped_is_not_drawn_whole_and_comes_back_when_it_is_not(void **state)
{
    static const char *const methods[] = {"wait", "last", "twophase", "chc", "hiz"};
    static const cull_run runs[] = {{10, 5}, {40, 1}};
    static const cull_clipped clipped[2] = {{.runs = runs, .run_count = 1}, {.runs = runs, .run_count = 2}};
    static fake_view view;
    hand_zone z;
    (void)state;
    boxes_of(100, &z);
    fake_view_make(&view, (cull_vec3){14, 40, -6}, 0, -1.2);
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
        fake_culler c;
        fake_viewer v;
        assert_int_equal(fake_culler_open(&c, &z, methods[m], CHAIN_LENT, 0), CULL_OK);
        fake_viewer_open(&v, &c);
        for (int turn = 0; turn < 2; turn++) {
            v.clipped = clipped;
            v.clipped_count = 2;
            memset(v.allowed + 10, 0, 5);
            v.allowed[40] = 0;
            for (int f = 0; f < 10; f++) expect_what_is_visible(&v, &view);
            assert_true(v.drawn_count > 20);
            const uint32_t without = v.drawn_count;
            v.clipped_count = 0;
            memset(v.allowed, 1, 100);
            for (int f = 0; f < 10; f++) expect_what_is_visible(&v, &view);
            assert_true(v.drawn_count > without);
        }
        fake_viewer_close(&v);
        fake_culler_close(&c);
    }
    hand_zone_free(&z);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refuses_options_it_does_not_have),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(zones_of_odd_shapes_are_built_and_drawn),
        cmocka_unit_test(what_is_no_number_or_huge_is_drawn),
        cmocka_unit_test(tells_why_and_how_much),
        cmocka_unit_test(what_is_drawn_clipped_is_not_drawn_whole_and_comes_back_when_it_is_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
