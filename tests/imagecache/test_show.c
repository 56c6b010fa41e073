// Tests of imagecache's pictures: nothing is lost between geometry and pictures, no point is off by more than is said, what changes is taken anew.
// SPDX-License-Identifier: MIT
#include "tests/imagecache/show_field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const show_values PLAIN = {"5", "rings", "rings", "quad", "on", "1", "shown", "bounded", "256"};

static int is_shown_at(const show_session *s, uint32_t place, const double p[3])
{
    if (show_runs_hold(s->batch.runs, s->batch.run_count, place)) return 1;
    for (uint32_t i = 0; i < s->batch.clipped_count; i++) {
        const cull_clipped *c = &s->batch.clipped[i];
        if (show_runs_hold(c->runs, c->run_count, place) && show_inside(c->planes, c->plane_count, p, 1e-3)) return 1;
    }
    for (uint32_t i = 0; i < s->batch.picture_count; i++) {
        const cull_picture *c = &s->batch.pictures[i];
        const cull_capture *held = &s->held[c->slot];
        if (show_runs_hold(c->runs, c->run_count, place) && show_inside(held->clip_planes, held->clip_plane_count, p, 1e-3)) return 1;
    }
    return 0;
}

static void every_point_in_view_is_geometry_or_in_a_picture(void **state)
{
    (void)state;
    static const show_values forms[] = {{"5", "rings", "rings", "quad", "on", "1", "shown", "bounded", "256"}, {"auto", "rings", "rings", "quad", "off", "2", "tested", "steady", "256"}};
    for (int form = 0; form < 2; form++) {
        field f;
        uint64_t r = 6302, points = 0, pictures = 0;
        field_open(&f, &forms[form], 20000);
        for (uint32_t frame = 1; frame < 300; frame += frame % 7 == 0 ? 23 : 1) {
            cull_plane planes[4];
            cull_view view;
            field_look(&f, field_eye(frame), frame, frame % 2 ? ANSWERS_SEEN : ANSWERS_NONE, planes, &view);
            pictures += f.s.batch.picture_count;
            for (uint32_t place = 0; place < FIELD_ITEMS; place++) {
                double p[3];
                field_point(&r, show_item_box(&f.s, place), p);
                if (!show_sees(planes, p)) continue;
                points++;
                if (!is_shown_at(&f.s, place, p)) fail_msg("form %d, frame %u: place %u is not shown at (%g, %g, %g)", form, frame, place, p[0], p[1], p[2]);
            }
        }
        assert_true(points > 20000 && pictures > 200);
        field_close(&f);
    }
}

static void an_item_is_whole_or_clipped_and_never_both(void **state)
{
    (void)state;
    static uint8_t whole[FIELD_ITEMS], clipped[FIELD_ITEMS];
    field f;
    uint32_t parted = 0;
    field_open(&f, &PLAIN, 20000);
    for (uint32_t frame = 1; frame < 120; frame++) {
        cull_plane planes[4];
        cull_view view;
        field_look(&f, field_eye(frame), frame, ANSWERS_SEEN, planes, &view);
        assert_null(session_set_any_order(&f.s.base, whole));
        memset(clipped, 0, sizeof clipped);
        for (uint32_t i = 0; i < f.s.batch.clipped_count; i++)
            for (uint32_t r = 0; r < f.s.batch.clipped[i].run_count; r++)
                for (uint32_t k = 0; k < f.s.batch.clipped[i].runs[r].count; k++) {
                    const uint32_t item = f.s.base.built.order[f.s.batch.clipped[i].runs[r].first + k];
                    assert_false(whole[item] || clipped[item]++);
                    parted++;
                }
    }
    assert_true(parted > 100);
    field_close(&f);
}

static void no_point_of_a_picture_is_off_by_more_than_it_says_nor_that_than_the_tolerance(void **state)
{
    (void)state;
    static const char *const tolerances[] = {"0.5", "1", "4"};
    for (int t = 0; t < 3; t++) {
        const show_values values = {"5", "rings", "rings", "quad", "on", tolerances[t], "shown", "bounded", "256"};
        const double tolerance = atof(tolerances[t]);
        double most = 0;
        uint64_t r = 6303, samples = 0;
        field f;
        field_open(&f, &values, 20000);
        for (uint32_t frame = 1; frame < 160; frame++) {
            cull_plane planes[4];
            cull_view view;
            field_look(&f, field_eye(frame), frame, ANSWERS_SEEN, planes, &view);
            for (uint32_t i = 0; i < f.s.batch.picture_count; i++) assert_true((double)f.s.batch.pictures[i].error_px <= tolerance);
            const double off = field_off_most(&f, &view, planes, &r, &samples);
            most = off > most ? off : most;
        }
        assert_true(samples > 5000);
        assert_true(most > 0.3 * tolerance); // pictures do get old
        field_close(&f);
    }
}

static void a_still_eye_takes_each_picture_once(void **state)
{
    (void)state;
    field f;
    field_open(&f, &PLAIN, 20000);
    for (uint32_t frame = 1; frame < 200; frame++) {
        cull_plane planes[4];
        cull_view view;
        field_look(&f, field_eye(60), frame, ANSWERS_SEEN, planes, &view);
        assert_true(f.s.batch.picture_count > 0);
        if (frame > 150) assert_int_equal(f.s.batch.capture_count, 0);
    }
    field_close(&f);
}

static void a_slot_that_was_emptied_is_taken_anew(void **state)
{
    (void)state;
    field f;
    cull_plane planes[4];
    cull_view view;
    field_open(&f, &PLAIN, 20000);
    for (uint32_t frame = 1; frame < 200; frame++) field_look(&f, field_eye(60), frame, ANSWERS_SEEN, planes, &view);
    const uint32_t lost = f.s.batch.pictures[f.s.batch.picture_count / 2].slot;
    f.s.slots[lost] = 0;
    field_look(&f, field_eye(60), 200, ANSWERS_SEEN, planes, &view);
    assert_int_equal(f.s.batch.capture_count, 1);
    assert_int_equal(f.s.batch.captures[0].slot, lost);
    field_close(&f);
}

static void what_is_hidden_is_neither_taken_nor_shown_and_only_by_answers_of_the_frame(void **state)
{
    (void)state;
    const show_values values = {"5", "rings", "rings", "quad", "on", "1", "tested", "bounded", "256"};
    static const show_answers answers[] = {ANSWERS_NONE, ANSWERS_OLD, ANSWERS_SEEN, ANSWERS_HIDDEN};
    for (int k = 0; k < 4; k++) {
        field f;
        cull_plane planes[4];
        cull_view view;
        field_open(&f, &values, 20000);
        assert_int_equal(f.s.base.built.promises & CULL_CONSERVATIVE, 0);
        field_look(&f, field_eye(60), 1, answers[k], planes, &view);
        assert_int_equal(f.s.steps, 2);
        if (answers[k] == ANSWERS_HIDDEN) assert_int_equal(f.s.batch.picture_count + f.s.batch.capture_count, 0);
        else assert_true(f.s.batch.picture_count > 0 && f.s.batch.capture_count > 0);
        field_close(&f);
    }
}

static void where_geometry_is_cheap_the_zone_is_handed_back_to_it(void **state)
{
    (void)state;
    field f;
    field_open(&f, &PLAIN, 0.001);
    for (uint32_t frame = 1; frame < 80; frame++) {
        cull_plane planes[4];
        cull_view view;
        field_look(&f, field_eye(frame), frame, ANSWERS_SEEN, planes, &view);
        assert_int_equal(f.s.batch.picture_count + f.s.batch.capture_count + f.s.batch.clipped_count, 0);
        assert_true(f.s.batch.run_count > 0);
    }
    const cull_figures *figures = octree_extension(&f.s.base, CULL_EXT_FIGURES);
    assert_true(figures->count > 5);
    field_close(&f);
}

static int starts_with(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

static void explain_tells_pictures_from_geometry_and_what_is_hidden(void **state)
{
    (void)state;
    const show_values values = {"5", "rings", "rings", "quad", "on", "1", "tested", "bounded", "256"};
    for (int hides = 0; hides < 2; hides++) {
        uint32_t kept = 0, in_pictures = 0, hidden = 0;
        field f;
        cull_plane planes[4];
        cull_view view;
        field_open(&f, &values, 20000);
        const cull_explain *explain = octree_extension(&f.s.base, CULL_EXT_EXPLAIN);
        for (uint32_t frame = 1; frame < 4; frame++) field_look(&f, field_eye(60), frame, hides ? ANSWERS_HIDDEN : ANSWERS_SEEN, planes, &view);
        const cull_volume volume = {planes, 4, 0};
        const cull_visit visit = {.view = &view, .volumes = &volume, .volume_count = 1, .scratch = f.s.base.scratch};
        for (uint32_t place = 0; place < FIELD_ITEMS; place++) {
            char text[300];
            double p[3];
            const cull_box b = show_item_box(&f.s, place);
            for (int k = 0; k < 3; k++) p[k] = ((double)(&b.min.x)[k] + (double)(&b.max.x)[k]) / 2;
            const size_t length = explain->item(f.s.base.query, &visit, place, text, sizeof text);
            assert_int_equal(length, strlen(text));
            kept += (uint32_t)starts_with(text, "kept: listed");
            if (show_sees(planes, p) && is_shown_at(&f.s, place, p)) assert_true(starts_with(text, "kept")); // of a wide one a part may be hidden
            in_pictures += (uint32_t)starts_with(text, "kept: in the picture");
            hidden += (uint32_t)starts_with(text, "dropped: geometry in front");
        }
        assert_true(kept > 10);
        assert_true(hides ? in_pictures == 0 && hidden > 100 : in_pictures > 100 && hidden == 0);
        field_close(&f);
    }
}

static void the_same_path_gives_the_same_frames(void **state)
{
    (void)state;
    field f[2];
    for (int k = 0; k < 2; k++) field_open(&f[k], &PLAIN, 20000);
    for (uint32_t frame = 1; frame < 100; frame++) {
        cull_plane planes[4];
        cull_view view;
        for (int k = 0; k < 2; k++) field_look(&f[k], field_eye(frame), frame, ANSWERS_SEEN, planes, &view);
        const cull_batch *a = &f[0].s.batch, *b = &f[1].s.batch;
        assert_int_equal(a->run_count, b->run_count);
        assert_memory_equal(a->runs, b->runs, a->run_count * sizeof *a->runs);
        assert_int_equal(a->capture_count, b->capture_count);
        assert_int_equal(a->picture_count, b->picture_count);
        for (uint32_t i = 0; i < a->picture_count; i++) assert_int_equal(a->pictures[i].slot, b->pictures[i].slot);
    }
    for (int k = 0; k < 2; k++) field_close(&f[k]);
}

static void every_allocation_may_fail_with_pictures(void **state)
{
    (void)state;
    uint64_t k = 1;
    cull_box *boxes = field_make();
    hand_zone z;
    zone_of_boxes(boxes, FIELD_ITEMS, &z);
    for (;; k++) {
        show_host h;
        show_session s;
        show_host_init(&h, 20000, k);
        const cull_result result = show_open(&s, &h, &z.zone, &PLAIN);
        if (result == CULL_OK) show_close(&s);
        assert_true(failing_allocator_is_clean(&h.base.memory));
        if (result == CULL_OK) break;
        assert_int_equal(result, CULL_ERR_MEMORY);
    }
    assert_true(k > 15);
    hand_zone_free(&z);
    free(boxes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_point_in_view_is_geometry_or_in_a_picture),
        cmocka_unit_test(an_item_is_whole_or_clipped_and_never_both),
        cmocka_unit_test(no_point_of_a_picture_is_off_by_more_than_it_says_nor_that_than_the_tolerance),
        cmocka_unit_test(a_still_eye_takes_each_picture_once),
        cmocka_unit_test(a_slot_that_was_emptied_is_taken_anew),
        cmocka_unit_test(what_is_hidden_is_neither_taken_nor_shown_and_only_by_answers_of_the_frame),
        cmocka_unit_test(where_geometry_is_cheap_the_zone_is_handed_back_to_it),
        cmocka_unit_test(explain_tells_pictures_from_geometry_and_what_is_hidden),
        cmocka_unit_test(the_same_path_gives_the_same_frames),
        cmocka_unit_test(every_allocation_may_fail_with_pictures),
    };
    return cmocka_run_group_tests_name("image cache: pictures", tests, NULL, NULL);
}
