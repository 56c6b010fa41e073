// Stress: scenes made anew keep their numbers, and change as they are told; what the host cannot hold it refuses.
// SPDX-License-Identifier: MIT
#include "bench/stress_parts.h"
#include "host/import/import.h"
#include "tests/common/test.h"

#include <math.h>
#include <string.h>

static const stress_family *family(const char *name)
{
    uint32_t count;
    const stress_family *all = stress_families(&count);
    for (uint32_t f = 0; f < count; ++f)
        if (strcmp(all[f].name, name) == 0) return &all[f];
    fail_msg("no family %s", name);
    return NULL;
}

static scene *load(void)
{
    report r = report_to_stderr();
    scene *s = NULL;
    assert_int_equal(import_scene(TWO_ROOMS, &(import_options){DOORS_OPEN}, allocator_heap(), &r, &s), RESULT_OK);
    return s;
}

static result change(const scene *from, const char *name, double magnitude, scene **out)
{
    report quiet = {0};
    const scene_change c = name ? stress_change(family(name), magnitude, from, 7) : stress_home();
    *out = NULL;
    return scene_rebuild(from, &c, allocator_heap(), &quiet, out);
}

static void assert_alike(const scene *a, const scene *b)
{
    assert_int_equal(a->item_count, b->item_count);
    assert_int_equal(a->mover_count, b->mover_count);
    assert_int_equal(a->zone_count, b->zone_count);
    assert_int_equal(a->portal_count, b->portal_count);
    assert_int_equal(a->door_count, b->door_count);
    assert_int_equal(a->zone_item_count, b->zone_item_count);
    assert_memory_equal(a->zone_items, b->zone_items, a->zone_item_count * sizeof *a->zone_items);
    assert_memory_equal(a->items, b->items, (a->item_count + a->mover_count) * sizeof *a->items);
    assert_memory_equal(a->indices, b->indices, a->index_count * sizeof *a->indices);
}

static void a_scene_made_anew_is_the_same(void **state)
{
    (void)state;
    scene *from = load(), *to;
    assert_int_equal(change(from, NULL, 0, &to), RESULT_OK);
    assert_alike(from, to);
    assert_memory_equal(from->positions, to->positions, from->position_count * sizeof *from->positions);
    assert_true(from->hash == to->hash);
    scene_free(to, allocator_heap());
    scene_free(from, allocator_heap());
}

static void whole_metres_change_no_position(void **state)
{
    (void)state;
    scene *from = load(), *to;
    assert_int_equal(change(from, "move", 1e7, &to), RESULT_OK);
    assert_alike(from, to);
    assert_memory_equal(from->positions, to->positions, from->position_count * sizeof *from->positions);
    assert_true(to->whole.origin[0] == from->whole.origin[0] + 1e7 && to->whole.origin[2] == from->whole.origin[2] - 1e7);
    scene_free(to, allocator_heap());
    scene_free(from, allocator_heap());
}

static void jitter_moves_points_by_no_more_than_it_says_and_equal_ones_alike(void **state)
{
    (void)state;
    scene *from = load(), *to;
    assert_int_equal(change(from, "jitter", 4, &to), RESULT_OK);
    assert_alike(from, to);
    uint32_t moved = 0;
    for (uint32_t v = 0; v < from->position_count; ++v) {
        const float *a = &from->positions[v].x, *b = &to->positions[v].x;
        for (int k = 0; k < 3; ++k) {
            const double by = ((double)b[k] + to->whole.origin[k]) - ((double)a[k] + from->whole.origin[k]);
            assert_true(fabs(by) <= 4.5 * to->step + 4 * from->step); // the jitter, and rounding to the new step
            moved += by != 0;
        }
    }
    assert_true(moved > 0);
    for (uint32_t v = 1; v < from->position_count; ++v)
        if (memcmp(&from->positions[v], &from->positions[0], sizeof *from->positions) == 0)
            assert_memory_equal(&to->positions[v], &to->positions[0], sizeof *to->positions);
    scene_free(to, allocator_heap());
    scene_free(from, allocator_heap());
}

static void copies_and_tiny_items_stand_behind_and_are_traced_to_their_item(void **state)
{
    (void)state;
    scene *from = load(), *to;
    assert_int_equal(change(from, "copies", 3, &to), RESULT_OK);
    assert_int_equal(to->item_count, 3 * from->item_count);
    assert_int_equal(to->mover_count, from->mover_count);
    assert_int_equal(scene_rebuilt_from(from, to, from->item_count + 2), 2);
    assert_int_equal(scene_rebuilt_from(from, to, to->item_count), from->item_count); // the first mover
    assert_int_equal(to->zone_item_count, 3 * from->zone_item_count);
    scene_free(to, allocator_heap());
    assert_int_equal(change(from, "tiny", 1e-310, &to), RESULT_OK);
    assert_int_equal(to->item_count, 2 * from->item_count);
    assert_int_equal(scene_rebuilt_from(from, to, from->item_count + 5), 5);
    scene_free(to, allocator_heap());
    scene_free(from, allocator_heap());
}

static void what_is_too_far_too_wide_or_no_camera_is_refused(void **state)
{
    (void)state;
    scene *from = load(), *to;
    assert_int_equal(change(from, "move", 2e9, &to), RESULT_BAD_INPUT);
    assert_int_equal(change(from, "move-odd", 2e9, &to), RESULT_BAD_INPUT);
    assert_int_equal(change(from, "grow", 1e5, &to), RESULT_BAD_INPUT);
    const camera c = {.eye = {0, 1, 0}, .forward = {0, 0, 1}, .up = {0, 1, 0}, .fovy_deg = 60, .aspect = 2, .near_m = 0.1, .far_m = INFINITY};
    const scene_change home = stress_home();
    const camera wide = stress_camera(family("wide"), 175, &home, &c), near = stress_camera(family("near"), 1e-35, &home, &c);
    assert_non_null(camera_fault(&wide));
    assert_non_null(camera_fault(&near));
    scene_free(from, allocator_heap());
}

static void the_first_magnitude_of_each_kind_is_found(void **state)
{
    (void)state;
    stress_point points[4] = {{.magnitude = 1, .pixels = 100000}, {.magnitude = 2, .pixels = 100000, .drawn_differ = 1, .pixels_differ = 10},
                              {.magnitude = 3, .pixels = 100000, .missed_items = 1, .broken_items = 1, .pixels_differ = 11}, {.magnitude = 4, .refused = "too far"}};
    const stress_family f = {.name = "test", .magnitude_count = 4};
    stress_series series = {.family = &f, .points = points};
    const stress_firsts first = stress_first(&series);
    assert_true(first.drawn == 2 && first.pictures == 3 && first.missed == 3 && first.refused == 4 && isnan(first.zones));
    assert_int_equal(stress_failed(&(stress_result){&series, 1, allocator_heap()}), 1);
    points[2].broken_items = 0;
    assert_int_equal(stress_failed(&(stress_result){&series, 1, allocator_heap()}), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scene_made_anew_is_the_same),
        cmocka_unit_test(whole_metres_change_no_position),
        cmocka_unit_test(jitter_moves_points_by_no_more_than_it_says_and_equal_ones_alike),
        cmocka_unit_test(copies_and_tiny_items_stand_behind_and_are_traced_to_their_item),
        cmocka_unit_test(what_is_too_far_too_wide_or_no_camera_is_refused),
        cmocka_unit_test(the_first_magnitude_of_each_kind_is_found),
    };
    return cmocka_run_group_tests_name("bench stress", tests, NULL, NULL);
}
