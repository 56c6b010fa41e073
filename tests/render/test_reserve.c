// Room taken ahead: frames with tests, captures and many translucent items allocate nothing, and sort the same way whatever
// order a culler names them in.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <string.h>

enum { SIDE = 64, QUADS = 200, TESTS = 300, SLOTS = 200, LATENCY = 3, FRAMES = 12, STEPS = 4 };

static void translucent_quads(bed *b, uint32_t seed)
{
    static quad quads[QUADS];
    static const char *const names[4] = {"*red", "*green", "*blue", "*white"};
    static const uint32_t colours[4] = {0xff0000ffu, 0xff00ff00u, 0xffff0000u, 0xffffffffu};
    for (uint32_t i = 0; i < QUADS; ++i) {
        const double half = 1 + (double)(random_next(&seed) % 4), z = -4 - (double)(random_next(&seed) % 20); // many at one distance
        quads[i] = quad_at(z, -half, -half, half, half);
        quads[i].material = names[i % 4];
        quads[i].colour = colours[i % 4];
        quads[i].material_flags = MATERIAL_TRANSLUCENT;
    }
    quads[0] = quad_at(-26, -30, -30, 30, 30);
    bed_scene(b, quads, QUADS, NULL);
}

static void tests_at(cull_test *tests, uint32_t count, uint32_t seed)
{
    for (uint32_t i = 0; i < count; ++i) {
        const float x = (float)(20 * random_unit(&seed) - 10), z = (float)(30 * random_unit(&seed) - 15);
        tests[i] = (cull_test){.box = {{x, -1, z}, {x + 1, 1, z + 1}}, .tag = i};
    }
}

// Each step tests and reads; each frame takes every slot's picture, one as large as another frame's.
static void run_frame(bed *b, const cull_test *tests, uint32_t frame)
{
    const camera eye = camera_at(0, 0, 0);
    const frame_request q = {.camera = &eye, .width_px = SIDE, .height_px = SIDE};
    const cull_run all = {0, QUADS}, one = {0, 1};
    cull_answer answers[TESTS];
    uint32_t stalled = 0;
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    bed_draw(b, b->l, &all, 1);
    for (uint32_t step = 0; step < STEPS; ++step) {
        renderer_test(b->g, b->l, 0, tests, TESTS - step, frame);
        const uint32_t got = bed_collect(b, COLLECT_READY, frame, answers, TESTS, &stalled);
        assert_int_equal(got > 0, frame > 0 || step >= LATENCY);
    }
    for (uint32_t slot = frame % 3; slot < SLOTS; slot += 7) {
        const cull_capture capture = {.runs = &one, .run_count = 1, .corner = {-1, -1, -3}, .right = {2, 0, 0}, .up = {0, 2, 0}, .slot = slot, .width_px = 8, .height_px = 8};
        const cull_picture picture = {.runs = &one, .run_count = 1, .slot = slot};
        renderer_capture(b->g, b->l, 0, &capture);
        renderer_show(b->g, b->l, 0, &picture);
    }
    renderer_end(b->g);
}

static void frames_allocate_nothing_after_room_was_taken(void **state)
{
    bed *b = *state;
    cull_test tests[TESTS];
    translucent_quads(b, 1);
    tests_at(tests, TESTS, 2);
    renderer_query_latency(b->g, LATENCY);
    assert_int_equal(renderer_reserve(b->g, TESTS, &b->r), RESULT_OK);
    assert_int_equal(render_layout_slots(b->l, &(uint32_t){SLOTS}, &b->r), RESULT_OK);
    const uint64_t before = b->memory.calls;
    for (uint32_t frame = 0; frame < FRAMES; ++frame) run_frame(b, tests, frame);
    assert_int_equal(b->memory.calls, before);
    assert_int_equal(renderer_reserve(b->g, TESTS, &b->r), RESULT_OK); // there already
    assert_int_equal(b->memory.calls, before);
}

static void room_taken_while_tests_wait_loses_no_answer(void **state)
{
    bed *b = *state;
    const camera eye = camera_at(0, 0, 0);
    const frame_request q = {.camera = &eye, .width_px = SIDE, .height_px = SIDE};
    cull_test tests[TESTS];
    cull_answer answers[2 * TESTS];
    uint32_t stalled = 0;
    translucent_quads(b, 1);
    tests_at(tests, TESTS, 2);
    renderer_query_latency(b->g, 0);
    assert_int_equal(renderer_reserve(b->g, 10, &b->r), RESULT_OK);
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    renderer_test(b->g, b->l, 0, tests, 10, 1);
    renderer_query_latency(b->g, 40);
    assert_int_equal(renderer_reserve(b->g, TESTS, &b->r), RESULT_OK);
    renderer_test(b->g, b->l, 0, tests, TESTS, 1);
    assert_int_equal(bed_collect(b, COLLECT_ALL, 1, answers, 2 * TESTS, &stalled), 10 + TESTS);
    renderer_end(b->g);
    for (uint32_t i = 0; i < 10 + TESTS; ++i) assert_int_equal(answers[i].tag, i < 10 ? i : i - 10);
}

static void no_memory_for_the_room_is_told_once_and_leaks_nothing(void **state)
{
    bed *b = *state;
    translucent_quads(b, 1);
    b->r.line = NULL;
    for (uint64_t fail = 1;; ++fail) {
        const uint32_t errors = b->r.errors;
        b->memory.fail_at = b->memory.calls + fail;
        const result done = renderer_reserve(b->g, (uint32_t)fail * TESTS, &b->r); // more each time, so that there is always something to take
        b->memory.fail_at = 0;
        if (done == RESULT_OK) {
            assert_true(fail > 5);
            break;
        }
        assert_int_equal(done, RESULT_NO_MEMORY);
        assert_int_equal(b->r.errors, errors + 1);
    }
}

static void translucent_items_mix_the_same_in_every_order(void **state)
{
    bed *b = *state;
    const camera eye = camera_at(0, 0, 0);
    const frame_request q = {.camera = &eye, .width_px = SIDE, .height_px = SIDE};
    uint32_t order[QUADS], seed = 5;
    cull_run runs[QUADS];
    translucent_quads(b, 3);
    uint8_t *wanted = bed_frame(b, &q, b->l, &(cull_run){0, QUADS}, 1);
    for (uint32_t i = 0; i < QUADS; ++i) order[i] = i;
    for (int round = 0; round < 4; ++round) {
        render_layout *l = NULL;
        for (uint32_t i = QUADS; i-- > 1;) {
            const uint32_t k = random_next(&seed) % (i + 1), kept = order[i];
            order[i] = order[k];
            order[k] = kept;
        }
        for (uint32_t i = 0; i < QUADS; ++i) runs[i] = (cull_run){QUADS - 1 - i, 1};
        assert_int_equal(bed_layout(b, order, &l), RESULT_OK);
        uint8_t *got = bed_frame(b, &q, l, runs, QUADS);
        assert_memory_equal(got, wanted, (size_t)SIDE * SIDE * 4);
        memory_free(allocator_heap(), got, (size_t)SIDE * SIDE, 4);
        render_layout_close(l);
    }
    memory_free(allocator_heap(), wanted, (size_t)SIDE * SIDE, 4);
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest reserve[] = {
        T(frames_allocate_nothing_after_room_was_taken),
        T(room_taken_while_tests_wait_loses_no_answer),
        T(no_memory_for_the_room_is_told_once_and_leaks_nothing),
        T(translucent_items_mix_the_same_in_every_order),
    };
    return RUN_WITH_GL(reserve);
}
