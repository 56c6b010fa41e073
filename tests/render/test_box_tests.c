// Box tests and the floor: what can leave no pixel is told apart from what can, and never the wrong way round.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <math.h>
#include <string.h>

enum { SIDE = 64 };

static cull_box box_at(const bed *b, const double low[3], const double high[3]) // world to the zone
{
    const double *o = b->s->whole.origin;
    return (cull_box){{(float)(low[0] - o[0]), (float)(low[1] - o[1]), (float)(low[2] - o[2])},
                      {(float)(high[0] - o[0]), (float)(high[1] - o[1]), (float)(high[2] - o[2])}};
}

// Five boxes: before the wall, behind it, around the eye, beside the picture, behind the eye.
static void five_tests(const bed *b, cull_test tests[5])
{
    static const double low[5][3] = {{-1, -1, -4}, {-1, -1, -9}, {-1, -1, -1}, {50, -1, -9}, {-1, -1, 2}};
    static const double high[5][3] = {{1, 1, -3}, {1, 1, -6}, {1, 1, 1}, {52, 1, -6}, {1, 1, 3}};
    for (uint32_t i = 0; i < 5; ++i) tests[i] = (cull_test){.box = box_at(b, low[i], high[i]), .tag = 100 + i};
}

static void begin_with_wall(bed *b, const camera *c)
{
    const frame_request q = {.camera = c, .width_px = SIDE, .height_px = SIDE};
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    bed_draw(b, b->l, &(cull_run){0, 1}, 1);
}

static void a_wall(bed *b)
{
    const quad q = quad_at(-5, -20, -20, 20, 20);
    bed_scene(b, &q, 1, NULL);
}

static void a_hidden_box_gets_0_and_a_visible_one_its_pixels(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    cull_test tests[5];
    cull_answer answers[8];
    uint32_t stalled = 0;
    a_wall(b);
    five_tests(b, tests);
    begin_with_wall(b, &c);
    renderer_test(b->g, b->l, 0, tests, 5, 40);
    assert_int_equal(bed_collect(b, COLLECT_ALL, 42, answers, 8, &stalled), 5);
    renderer_end(b->g);
    for (uint32_t i = 0; i < 5; ++i) {
        assert_int_equal(answers[i].tag, 100 + i);
        assert_int_equal(answers[i].age, 2);
    }
    assert_in_range(answers[0].pixels, 20 * 20, 24 * 24); // 2 m at 3 m in a picture of 6 m and 64 pixels
    assert_int_equal(answers[1].pixels, 0);
    assert_int_equal(answers[2].pixels, 1);
    assert_int_equal(answers[3].pixels, 0);
    assert_int_equal(answers[4].pixels, 0);
}

static void tests_see_only_what_was_drawn_before_them(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = {.camera = &c, .width_px = SIDE, .height_px = SIDE};
    cull_test tests[5];
    cull_answer answers[2];
    uint32_t stalled = 0;
    a_wall(b);
    five_tests(b, tests);
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    renderer_test(b->g, b->l, 0, &tests[1], 1, 1);
    bed_draw(b, b->l, &(cull_run){0, 1}, 1);
    renderer_test(b->g, b->l, 0, &tests[1], 1, 1);
    assert_int_equal(bed_collect(b, COLLECT_ALL, 1, answers, 2, &stalled), 2);
    renderer_end(b->g);
    assert_true(answers[0].pixels > 0);
    assert_int_equal(answers[1].pixels, 0);
}

static void a_test_leaves_no_trace_in_the_picture(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = {.camera = &c, .width_px = SIDE, .height_px = SIDE};
    const quad quads[] = {quad_at(-5, -2, -2, 2, 2), quad_at(-8, -20, -20, 20, 20)};
    const cull_run all = {0, 2};
    cull_test tests[5];
    bed_scene(b, quads, 2, NULL);
    five_tests(b, tests);
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1), tested[SIDE * SIDE * 4];
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    renderer_test(b->g, b->l, 0, tests, 5, 1);
    bed_draw(b, b->l, &(cull_run){0, 1}, 1);
    renderer_test(b->g, b->l, 0, tests, 5, 1);
    bed_draw(b, b->l, &(cull_run){1, 1}, 1);
    renderer_end(b->g);
    assert_int_equal(renderer_read(b->g, tested, &b->r), RESULT_OK);
    assert_memory_equal(plain, tested, sizeof tested);
    memory_free(allocator_heap(), plain, (size_t)SIDE * SIDE, 4);
}

static void answers_come_oldest_first_in_parts_of_any_size(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    cull_test tests[5];
    cull_answer answer;
    uint32_t stalled = 0, next = 0;
    a_wall(b);
    five_tests(b, tests);
    begin_with_wall(b, &c);
    for (uint32_t batch = 0; batch < 40; ++batch) { // more than the queue starts with
        for (uint32_t i = 0; i < 5; ++i) tests[i].tag = 5 * batch + i;
        renderer_test(b->g, b->l, 0, tests, 5, batch);
        if (batch % 3 == 0 && bed_collect(b, COLLECT_ALL, 50, &answer, 1, &stalled)) {
            assert_int_equal(answer.tag, next);
            assert_int_equal(answer.age, 50 - next / 5);
            assert_int_equal(answer.pixels > 0, next % 5 == 0 || next % 5 == 2);
            next++;
        }
    }
    while (bed_collect(b, COLLECT_ALL, 50, &answer, 1, &stalled)) assert_int_equal(answer.tag, next++);
    renderer_end(b->g);
    assert_int_equal(next, 200);
}

static void a_latency_of_two_steps_is_two_steps(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    cull_test tests[5];
    cull_answer answers[8];
    uint32_t stalled = 0;
    a_wall(b);
    five_tests(b, tests);
    begin_with_wall(b, &c);
    renderer_query_latency(b->g, 0);
    renderer_test(b->g, b->l, 0, tests, 5, 1);
    assert_int_equal(bed_collect(b, COLLECT_READY, 1, answers, 8, &stalled), 5);
    renderer_query_latency(b->g, 2);
    renderer_test(b->g, b->l, 0, tests, 5, 1);
    assert_int_equal(bed_collect(b, COLLECT_READY, 1, answers, 8, &stalled), 0);
    renderer_test(b->g, b->l, 0, tests, 1, 2);
    assert_int_equal(bed_collect(b, COLLECT_READY, 2, answers, 8, &stalled), 0);
    assert_int_equal(bed_collect(b, COLLECT_READY, 3, answers, 8, &stalled), 5);
    assert_int_equal(stalled, 0);
    assert_int_equal(bed_collect(b, COLLECT_READY, 4, answers, 8, &stalled), 1);
    renderer_test(b->g, b->l, 0, tests, 5, 5);
    assert_int_equal(bed_collect(b, COLLECT_ALL, 5, answers, 8, &stalled), 5); // had to wait
    assert_int_equal(stalled, 1);
    renderer_end(b->g);
}

static void forgotten_tests_are_never_answered(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    cull_test tests[5];
    cull_answer answers[8];
    uint32_t stalled = 0;
    a_wall(b);
    five_tests(b, tests);
    begin_with_wall(b, &c);
    renderer_test(b->g, b->l, 0, tests, 5, 1);
    renderer_forget_tests(b->g);
    assert_int_equal(bed_collect(b, COLLECT_ALL, 1, answers, 8, &stalled), 0);
    renderer_test(b->g, b->l, 0, tests, 2, 1);
    assert_int_equal(bed_collect(b, COLLECT_ALL, 1, answers, 8, &stalled), 2);
    renderer_end(b->g);
}

static void thousands_of_boxes_are_tested_at_once(void **state)
{
    bed *b = *state;
    enum { MANY = 5000 }; // more than a chunk
    const camera c = camera_at(0, 0, 0);
    static cull_test tests[MANY];
    static cull_answer answers[MANY];
    uint32_t stalled = 0;
    a_wall(b);
    for (uint32_t i = 0; i < MANY; ++i) {
        const double x = (i % 71) / 71.0 - 0.5, z = i % 3 ? -4 : -6;
        tests[i] = (cull_test){.box = box_at(b, (double[3]){x, -0.5, z - 0.5}, (double[3]){x + 0.3, 0.5, z + 0.5}), .tag = i};
    }
    begin_with_wall(b, &c);
    renderer_test(b->g, b->l, 0, tests, MANY, 1);
    assert_int_equal(bed_collect(b, COLLECT_ALL, 1, answers, MANY, &stalled), MANY);
    renderer_end(b->g);
    for (uint32_t i = 0; i < MANY; ++i) {
        assert_int_equal(answers[i].tag, i);
        assert_int_equal(answers[i].pixels > 0, i % 3 != 0);
    }
}

// ---- The floor, over random scenes of flat quads, some seen edge on ----

enum { QUADS = 400 };

static void random_quads(bed *b, uint32_t seed)
{
    static quad quads[QUADS];
    for (int i = 0; i < QUADS; ++i) {
        double a[3], u[3] = {0}, v[3] = {0};
        const int axis = (int)(random_next(&seed) % 3);
        for (int k = 0; k < 3; ++k) a[k] = 20 * random_unit(&seed) - 10;
        u[(axis + 1) % 3] = 6 * random_unit(&seed) + 0.01;
        v[(axis + 2) % 3] = 6 * random_unit(&seed) + 0.01;
        if (i % 4 == 0) u[axis] = random_unit(&seed) - 0.5; // not all along the axes
        quads[i] = quad_at(0, 0, 0, 0, 0);
        for (int k = 0; k < 3; ++k) {
            quads[i].corners[0][k] = a[k];
            quads[i].corners[1][k] = a[k] + u[k];
            quads[i].corners[2][k] = a[k] + u[k] + v[k];
            quads[i].corners[3][k] = a[k] + v[k];
        }
        quads[i].is_mover = i % 37 == 0;
    }
    bed_scene(b, quads, QUADS, NULL);
}

static int has_bit(const uint32_t *bits, uint32_t i)
{
    return (int)(bits[i >> 5] >> (i & 31) & 1);
}

static void the_floor_holds_every_item_that_owns_a_pixel_and_few_others(void **state)
{
    bed *b = *state;
    uint32_t kept = 0, owned = 0, views = 0;
    for (uint32_t seed = 1; seed <= 6; ++seed) {
        random_quads(b, seed);
        for (int eye = 0; eye < 6; ++eye, ++views) {
            camera c = camera_at(2.0 * eye - 5, 0.5 * eye - 1, eye % 2 ? 12 : 0.3);
            uint32_t floor_bits[QUADS / 32 + 1];
            c.up[0] = 0.2 * eye; // a rolled head
            id_picture p = bed_ids(b, &(id_request){.camera = &c}, 160, 160);
            assert_int_equal(renderer_floor(b->g, &c, &b->r, floor_bits), RESULT_OK);
            uint32_t owners[QUADS / 32 + 1] = {0};
            for (uint32_t i = 0; i < 160 * 160; ++i)
                if (p.triangles[i]) owners[(p.triangles[i] - 1) / 2 >> 5] |= 1u << ((p.triangles[i] - 1) / 2 & 31);
            for (uint32_t i = 0; i < QUADS; ++i) {
                if (has_bit(owners, i)) assert_true(has_bit(floor_bits, i));
                kept += (uint32_t)has_bit(floor_bits, i);
                owned += (uint32_t)has_bit(owners, i);
            }
            id_picture_free(&p, allocator_heap());
        }
    }
    assert_true(owned > views * 20);
    assert_true(kept < views * QUADS * 3 / 4); // it does cull
}

static void box_tests_after_drawing_all_find_every_owner(void **state)
{
    bed *b = *state;
    static cull_test tests[QUADS];
    static cull_answer answers[QUADS];
    for (uint32_t seed = 1; seed <= 4; ++seed) {
        const camera c = camera_at(0.4 * seed, 0.1, 11);
        const frame_request q = {.camera = &c, .width_px = 160, .height_px = 160};
        uint32_t stalled = 0;
        random_quads(b, seed);
        id_picture p = bed_ids(b, &(id_request){.camera = &c}, 160, 160);
        const cull_boxes *x = &b->s->boxes;
        for (uint32_t i = 0; i < QUADS; ++i)
            tests[i] = (cull_test){.box = {{x->min_x[i], x->min_y[i], x->min_z[i]}, {x->max_x[i], x->max_y[i], x->max_z[i]}}, .tag = i};
        assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
        bed_draw(b, b->l, &(cull_run){0, QUADS}, 1);
        renderer_test(b->g, b->l, 0, tests, QUADS, 1);
        assert_int_equal(bed_collect(b, COLLECT_ALL, 1, answers, QUADS, &stalled), QUADS);
        renderer_end(b->g);
        for (uint32_t i = 0; i < 160 * 160; ++i)
            if (p.triangles[i]) assert_true(answers[(p.triangles[i] - 1) / 2].pixels > 0);
        id_picture_free(&p, allocator_heap());
    }
}

static void the_floor_leaves_out_what_a_wall_hides(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    quad quads[40];
    uint32_t bits[2];
    quads[0] = quad_at(-5, -20, -20, 20, 20);
    for (int i = 1; i < 40; ++i) quads[i] = quad_at(-6 - i, -4, -4, 4, 4);
    quads[39] = quad_at(-2, -1, -1, 1, 1);
    quads[38] = quad_at(-1, -1, -0.5, 1, -0.5); // a floor that reaches under the eye: the near plane's
    quads[38].corners[0][2] = quads[38].corners[1][2] = 1;
    bed_scene(b, quads, 40, NULL);
    id_picture p = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
    assert_int_equal(renderer_floor(b->g, &c, &b->r, bits), RESULT_OK);
    for (uint32_t i = 0; i < 40; ++i) assert_int_equal(has_bit(bits, i), i == 0 || i >= 38);
    id_picture_free(&p, allocator_heap());
}

static void a_floor_without_an_id_picture_is_refused(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    uint32_t bits[1];
    a_wall(b);
    b->r.line = NULL;
    assert_int_equal(renderer_floor(b->g, &c, &b->r, bits), RESULT_BAD_INPUT);
    assert_int_equal(b->r.errors, 1);
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest box_tests[] = {
        T(a_hidden_box_gets_0_and_a_visible_one_its_pixels),
        T(tests_see_only_what_was_drawn_before_them),
        T(a_test_leaves_no_trace_in_the_picture),
        T(answers_come_oldest_first_in_parts_of_any_size),
        T(a_latency_of_two_steps_is_two_steps),
        T(forgotten_tests_are_never_answered),
        T(thousands_of_boxes_are_tested_at_once),
        T(the_floor_holds_every_item_that_owns_a_pixel_and_few_others),
        T(box_tests_after_drawing_all_find_every_owner),
        T(the_floor_leaves_out_what_a_wall_hides),
        T(a_floor_without_an_id_picture_is_refused),
    };
    return RUN_WITH_GL(box_tests);
}
