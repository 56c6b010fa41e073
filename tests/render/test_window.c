// The window, on a virtual display where there is one.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void a_frame_is_shown_in_a_window(void **state)
{
    (void)state;
    bed b = {.r = report_to_stderr()};
    const renderer_options o = {.target = RENDERER_WINDOW, .width_px = 200, .height_px = 100, .title = "test"};
    const quad q = quad_at(-5, -20, -20, 20, 20);
    const camera c = camera_at(0, 0, 0);
    const frame_request f = {.camera = &c, .width_px = 200, .height_px = 100, .mode = RENDER_ITEMS};
    counting_init(&b.memory);
    assert_int_equal(renderer_open(&o, &b.memory.memory, &b.r, &b.g), RESULT_OK);
    bed_scene(&b, &q, 1, NULL);
    for (int frame = 0; frame < 3; ++frame) {
        window_input input;
        assert_int_equal(renderer_window_is_open(b.g), 1);
        renderer_window_input(b.g, &input);
        assert_int_equal(input.width_px, 200);
        assert_int_equal(input.height_px, 100);
        assert_int_equal(input.pressed_count, 0);
        uint8_t *rgba = bed_frame(&b, &f, b.l, &(cull_run){0, 1}, 1);
        assert_int_not_equal(rgba[0], 0);
        memory_free(allocator_heap(), rgba, 200 * 100, 4);
        renderer_present(b.g);
    }
    assert_int_equal(renderer_errors(b.g), 0);
    render_layout_close(b.l);
    scene_free(b.s, &b.memory.memory);
    renderer_close(b.g);
    assert_int_equal(b.memory.live_bytes, 0);
}

static int on_path(const char *program)
{
    char path[512];
    for (const char *at = getenv("PATH"); at && *at;) {
        const size_t length = strcspn(at, ":");
        snprintf(path, sizeof path, "%.*s/%s", (int)length, at, program);
        if (access(path, X_OK) == 0) return 1;
        at += length + (at[length] != 0);
    }
    return 0;
}

int main(int argc, char **argv)
{
    const char *display = getenv("DISPLAY");
    if ((!display || !*display) && argc == 1 && on_path("xvfb-run") && on_path("Xvfb") && on_path("xauth"))
        execlp("xvfb-run", "xvfb-run", "-a", argv[0], "virtual", (char *)NULL); // this program again, with a display
    if (!display || !*display) {
        fprintf(stderr, "SKIPPED window: no DISPLAY; install xvfb and xauth to run this test\n");
        return 77;
    }
    const struct CMUnitTest window[] = {cmocka_unit_test(a_frame_is_shown_in_a_window)};
    return cmocka_run_group_tests(window, NULL, NULL);
}
