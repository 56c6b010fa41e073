// Opening and closing: no driver, no memory, twice at once, one scene after another.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

typedef struct lines {
    uint32_t count;
    char last[512];
} lines;

static void keep_line(void *user, report_level level, const char *text)
{
    (void)level;
    lines *l = user;
    l->count++;
    snprintf(l->last, sizeof l->last, "%s", text);
}

// In a process of its own, before anything of GL is loaded: 0 when opening fails as it should.
static int open_without_driver(void)
{
    counting c;
    lines said = {0};
    report r = {.line = keep_line, .user = &said};
    renderer *g = NULL;
    counting_init(&c);
    setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent/none.json", 1);
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    if (renderer_open(NULL, &c.memory, &r, &g) != RESULT_NO_GL) return 1;
    if (g || said.count != 1 || !strstr(said.last, "libgl1-mesa-dri")) return 2;
    const renderer_options window = {.target = RENDERER_WINDOW, .width_px = 64, .height_px = 64};
    if (renderer_open(&window, &c.memory, &r, &g) != RESULT_NO_GL) return 3;
    if (g || said.count != 2 || !strstr(said.last, "DISPLAY")) return 4;
    return c.live_bytes ? 5 : 0;
}

static int in_a_process(int (*run)(void))
{
    const pid_t child = fork();
    if (child == 0) _exit(run());
    int status = -1;
    assert_true(child > 0);
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 100;
}

static void without_a_driver_opening_fails_with_one_line_that_says_what_to_install(void **state)
{
    (void)state;
    assert_int_equal(in_a_process(open_without_driver), 0); // must come first in this program
}

static void scene_of(bed *b)
{
    quad quads[] = {quad_at(-5, -20, -20, 20, 20), quad_at(-4, -1, -1, 1, 1), quad_at(-6, -1, -1, 1, 1)};
    quads[1].material = "*water";
    quads[1].material_flags = MATERIAL_TRANSLUCENT;
    quads[2].material = "{grate";
    quads[2].material_flags = MATERIAL_CUT_OUT;
    bed_scene(b, quads, 3, NULL);
}

// Everything that allocates, each allocation failing in turn. 1: a failure was met on the way.
static int use_all(counting *c, const scene *s)
{
    static const uint32_t order[3] = {2, 0, 1}, other_order[3] = {1, 2, 0}, slots[1] = {5};
    report r = {0};
    renderer *g = NULL;
    render_layout *l = NULL;
    id_picture p = {0};
    const camera eye = camera_at(0, 0, 0);
    const cull_run all = {0, 3};
    const cull_test test = {.box = {{-1, -1, -1}, {1, 1, 1}}, .tag = 1};
    const cull_capture capture = {.runs = &all, .run_count = 1, .corner = {-1, -1, 0}, .right = {2, 0, 0}, .up = {0, 2, 0}, .slot = 3, .width_px = 8, .height_px = 8};
    const cull_picture picture = {.runs = &all, .run_count = 1, .slot = 3};
    const frame_request q = {.camera = &eye, .width_px = 32, .height_px = 32};
    cull_answer answer;
    uint32_t stalled = 0;
    int failed = renderer_open(NULL, &c->memory, &r, &g) != RESULT_OK || renderer_upload(g, s, &r) != RESULT_OK ||
                 render_layout_open(g, &(render_layout_zone){order, 3}, 1, &r, &l) != RESULT_OK ||
                 render_layout_slots(l, slots, &r) != RESULT_OK || render_layout_reorder(l, 0, other_order, &r) != RESULT_OK || id_picture_open(s, 32, 32, &c->memory, &p) != RESULT_OK ||
                 renderer_id_picture(g, &(id_request){.camera = &eye}, &r, &p) != RESULT_OK || renderer_reserve(g, 1, &r) != RESULT_OK ||
                 renderer_begin(g, &q, &r) != RESULT_OK;
    if (!failed) {
        renderer_draw(g, l, 0, &all, 1);
        renderer_test(g, l, 0, &test, 1, 1);
        renderer_capture(g, l, 0, &capture);
        renderer_show(g, l, 0, &picture);
        renderer_end(g);
        failed = renderer_collect(g, &(collect_request){l, 0, 1, COLLECT_ALL}, &answer, 1, &stalled) != 1;
        assert_int_equal(renderer_errors(g), 0);
    }
    render_layout_close(l);
    id_picture_free(&p, &c->memory);
    renderer_close(g);
    return failed;
}

static void every_failed_allocation_is_survived_without_a_leak(void **state)
{
    bed *b = *state;
    counting c;
    scene_of(b);
    counting_init(&c);
    assert_int_equal(use_all(&c, b->s), 0);
    const uint64_t calls = c.calls;
    assert_int_equal(c.live_bytes, 0);
    assert_true(calls > 20);
    for (uint64_t fail_at = 1; fail_at <= calls; ++fail_at) {
        counting_init(&c);
        c.fail_at = fail_at;
        use_all(&c, b->s);
        assert_int_equal(c.live_bytes, 0);
    }
}

static void a_second_renderer_may_open_and_close_beside_the_first(void **state)
{
    bed *b = *state;
    renderer *other = NULL;
    scene_of(b);
    assert_int_equal(renderer_open(NULL, &b->memory.memory, &b->r, &other), RESULT_OK);
    assert_true(strlen(renderer_name(other)) > 10);
    renderer_close(other);
}

static void scenes_follow_each_other(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    for (int round = 0; round < 3; ++round) {
        scene_of(b);
        id_picture p = bed_ids(b, &(id_request){.camera = &c}, 32, 32);
        assert_int_equal(id_at(&p, 1, 30), 2);
        assert_true(see_through_at(&p, 2));
        id_picture_free(&p, allocator_heap());
        const quad q = quad_at(-5, -20, -20, 20, 20);
        bed_scene(b, &q, 1, NULL);
        p = bed_ids(b, &(id_request){.camera = &c}, 32, 32);
        assert_int_equal(id_at(&p, 30, 1), 1);
        assert_false(see_through_at(&p, 0));
        id_picture_free(&p, allocator_heap());
    }
}

static void calls_without_a_scene_are_refused(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    render_layout *l = NULL;
    id_picture p = {0};
    uint8_t rgba[4];
    b->r.line = NULL;
    assert_int_equal(render_layout_open(b->g, NULL, 0, &b->r, &l), RESULT_BAD_INPUT);
    assert_int_equal(renderer_id_picture(b->g, &(id_request){.camera = &c}, &b->r, &p), RESULT_BAD_INPUT);
    assert_int_equal(renderer_begin(b->g, &(frame_request){.camera = &c, .width_px = 8, .height_px = 8}, &b->r), RESULT_BAD_INPUT);
    assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_BAD_INPUT);
    assert_int_equal(b->r.errors, 4);
    assert_int_equal(renderer_window_is_open(b->g), 0);
    renderer_present(b->g); // nothing to show, nowhere: nothing happens
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest no_driver[] = {cmocka_unit_test(without_a_driver_opening_fails_with_one_line_that_says_what_to_install)};
    const struct CMUnitTest opening[] = {
        T(every_failed_allocation_is_survived_without_a_leak),
        T(a_second_renderer_may_open_and_close_beside_the_first),
        T(scenes_follow_each_other),
        T(calls_without_a_scene_are_refused),
    };
    const int failed = cmocka_run_group_tests(no_driver, NULL, NULL);
    return failed ? failed : RUN_WITH_GL(opening);
}
