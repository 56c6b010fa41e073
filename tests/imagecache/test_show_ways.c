// Tests of imagecache's other ways: the report's centre alignment, memory that is never exceeded, frames whose time is spent.
// SPDX-License-Identifier: MIT
#include "tests/imagecache/show_field.h"

#include <stdlib.h>

static void centre_alignment_says_what_it_is_off_too(void **state)
{
    (void)state;
    const show_values values = {"5", "rings", "rings", "centre", "on", "2", "shown", "bounded", "256"};
    uint64_t r = 6401, samples = 0, pictures = 0, captures = 0;
    double most = 0;
    field f;
    field_open(&f, &values, 20000);
    for (uint32_t frame = 1; frame < 160; frame++) {
        cull_plane planes[4];
        cull_view view;
        field_look(&f, field_eye(frame), frame, ANSWERS_SEEN, planes, &view);
        for (uint32_t i = 0; i < f.s.batch.picture_count; i++) assert_true(f.s.batch.pictures[i].place_is_said && f.s.batch.pictures[i].error_px <= 2);
        const double off = field_off_most(&f, &view, planes, &r, &samples);
        most = off > most ? off : most;
        pictures += f.s.batch.picture_count;
        captures += f.s.batch.capture_count;
    }
    assert_true(samples > 2000 && most > 0.5);
    assert_true(captures < pictures);
    field_close(&f);
}

// Fewer rows at a larger tolerance: boxes guarded by wider seams, beside the view's axis, were too wide across it, and all was geometry in each frame.
static void centre_alignment_has_pictures_in_small_views_too(void **state)
{
    (void)state;
    static const char *const tolerances[] = {"1", "2", "4"};
    for (int t = 0; t < 3; t++) {
        const show_values values = {"5", "rings", "rings", "centre", "on", tolerances[t], "shown", "bounded", "256"};
        uint32_t shown = 0;
        field f;
        field_open(&f, &values, 20000);
        for (uint32_t frame = 1; frame < 120; frame++) {
            cull_plane planes[4];
            cull_view view;
            show_look(field_eye(frame), frame, &view, planes);
            view.width_px /= 2, view.height_px /= 2, view.pixels_per_tangent /= 2, view.pixel_tangent *= 2;
            const cull_volume volume = {planes, 4, 0};
            show_frame(&f.s, &view, &volume, ANSWERS_SEEN);
            assert_int_equal(f.s.batch.limits_hit, 0);
            shown += f.s.batch.picture_count > 0;
        }
        assert_true(shown > 60);
        field_close(&f);
    }
}

// Turning on the spot: the parallelogram in the world needs no new picture, the report's way does.
static void turning_costs_the_centre_alignment_pictures_and_the_parallelogram_none(void **state)
{
    (void)state;
    static const char *const ways[] = {"quad", "centre"};
    uint32_t captures[2] = {0, 0};
    for (int way = 0; way < 2; way++) {
        const show_values values = {"5", "rings", "rings", ways[way], "off", "1", "shown", "bounded", "256"};
        field f;
        field_open(&f, &values, 1e7); // whatever is seen is worth its picture, so that the same cells stay pictures
        uint8_t *const was_taken = calloc(f.s.base.built.slot_count, 1);
        assert_non_null(was_taken);
        for (uint32_t frame = 1; frame < 200; frame++) {
            const double turned = frame < 150 ? 0 : 0.002 * (frame - 150);
            const show_eye eye = {{300, 2, 300}, turned, 0};
            cull_plane planes[4];
            cull_view view;
            field_look(&f, eye, frame, ANSWERS_SEEN, planes, &view);
            for (uint32_t i = 0; i < f.s.batch.capture_count; i++) {
                uint8_t *const before = &was_taken[f.s.batch.captures[i].slot];
                if (frame >= 150) captures[way] += *before; // what comes into view has to be taken once
                *before = 1;
            }
        }
        free(was_taken);
        field_close(&f);
    }
    assert_int_equal(captures[0], 0);
    assert_true(captures[1] > 20);
}

static void pictures_never_take_more_than_they_may(void **state)
{
    (void)state;
    const show_values values = {"5", "rings", "rings", "quad", "on", "1", "shown", "bounded", "16"};
    field f;
    uint64_t shown = 0, evicted = 0;
    field_open(&f, &values, 20000);
    uint32_t *const bytes = calloc(f.s.base.built.slot_count, sizeof *bytes);
    assert_non_null(bytes);
    uint64_t held = 0;
    for (uint32_t frame = 1; frame < 300; frame++) {
        const show_eye eye = {{400, 2, 400}, frame * 0.05, 0}; // all the way round, some views at a time
        cull_plane planes[4];
        cull_view view;
        field_look(&f, eye, frame, ANSWERS_SEEN, planes, &view);
        for (uint32_t i = 0; i < f.s.batch.capture_count; i++) {
            const cull_capture *c = &f.s.batch.captures[i];
            const uint32_t taken = c->width_px * c->height_px * f.host.costs.pixel_bytes;
            evicted += c->run_count == 0;
            held = held - bytes[c->slot] + taken;
            bytes[c->slot] = taken;
            assert_true(held <= 16u << 20);
        }
        shown += f.s.batch.picture_count;
    }
    assert_true(shown > 100 && evicted > 10);
    free(bytes);
    field_close(&f);
}

static void with_steady_frames_stale_pictures_say_what_they_are_off(void **state)
{
    (void)state;
    const show_values values = {"5", "rings", "rings", "quad", "on", "0.5", "shown", "steady", "256"};
    uint64_t r = 6402, samples = 0, stale = 0;
    field f;
    field_open(&f, &values, 20000);
    f.host.costs.frame_ns = 1000; // next to nothing
    for (uint32_t frame = 1; frame < 160; frame++) {
        cull_plane planes[4];
        cull_view view;
        field_look(&f, field_eye(frame), frame, ANSWERS_SEEN, planes, &view);
        field_off_most(&f, &view, planes, &r, &samples);
        for (uint32_t i = 0; i < f.s.batch.picture_count; i++) stale += (double)f.s.batch.pictures[i].error_px > 0.5;
    }
    assert_true(stale > 100 && samples > 2000);
    field_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(centre_alignment_says_what_it_is_off_too),
        cmocka_unit_test(centre_alignment_has_pictures_in_small_views_too),
        cmocka_unit_test(turning_costs_the_centre_alignment_pictures_and_the_parallelogram_none),
        cmocka_unit_test(pictures_never_take_more_than_they_may),
        cmocka_unit_test(with_steady_frames_stale_pictures_say_what_they_are_off),
    };
    return cmocka_run_group_tests_name("image cache: ways to show", tests, NULL, NULL);
}
