// Cracks: holes where geometry has a hit, what spills over a silhouette, and which of a picture's borders tell nothing.
// SPDX-License-Identifier: MIT
#include "bench/cracks.h"
#include "tests/common/test.h"

#include <stdlib.h>
#include <string.h>

enum { WIDE = 12, HIGH = 9 };
static float geometry[HIGH][WIDE], shown[HIGH][WIDE];
static uint8_t marks[HIGH][WIDE];

static void fill(float picture[HIGH][WIDE], int left, int right)
{
    for (int y = 0; y < HIGH; ++y)
        for (int x = 0; x < WIDE; ++x) picture[y][x] = x >= left && x < right && y >= 2 && y < 7 ? 0.25f : 0;
}

static crack_counts count(void)
{
    return cracks_count(&(crack_pictures){geometry[0], geometry[0], shown[0], WIDE, HIGH}, marks[0]);
}

static void equal_coverage_has_no_cracks(void **state)
{
    (void)state;
    fill(geometry, 3, 9);
    fill(shown, 3, 9);
    shown[4][4] = 1e-30f; // however far
    const crack_counts c = count();
    assert_int_equal(c.holes + c.spills + c.inner, 0);
}

static void a_hole_counts_and_is_inner_away_from_silhouettes(void **state)
{
    (void)state;
    fill(geometry, 3, 9);
    fill(shown, 3, 9);
    shown[4][5] = 0;
    shown[2][3] = 0; // at the corner
    const crack_counts c = count();
    assert_int_equal(c.holes, 2);
    assert_int_equal(c.inner, 1);
    assert_int_equal(c.spills, 0);
    assert_int_equal(marks[4][5] + marks[2][3], 2);
    assert_int_equal(marks[4][6], 0);
}

static void what_spills_counts_beyond_one_pixel_of_a_silhouette(void **state)
{
    (void)state;
    fill(geometry, 3, 7);
    fill(shown, 2, 8);
    assert_int_equal(count().spills, 0);
    fill(shown, 3, 9); // a column two pixels away, but for its ends
    assert_int_equal(count().spills, 5);
    fill(geometry, 5, 7);
    fill(shown, 6, 8);
    const crack_counts c = count();
    assert_int_equal(c.holes, 5); // moved by one: the background shows on one side
    assert_int_equal(c.spills, 0);
}

static void the_picture_s_border_tells_of_no_spills(void **state)
{
    (void)state;
    memset(geometry, 0, sizeof geometry);
    memset(shown, 0, sizeof shown);
    for (int x = 0; x < WIDE; ++x) shown[0][x] = shown[HIGH - 1][x] = 1;
    for (int y = 0; y < HIGH; ++y) shown[y][0] = shown[y][WIDE - 1] = 1;
    assert_int_equal(count().spills, 0);
    shown[1][1] = 1;
    assert_int_equal(count().spills, 1);
}

static void what_need_not_be_shown_leaves_no_hole_and_is_no_spill(void **state)
{
    (void)state;
    static float must[HIGH][WIDE];
    fill(geometry, 3, 9);
    fill(must, 3, 5);
    fill(shown, 3, 5);
    crack_counts c = cracks_count(&(crack_pictures){geometry[0], must[0], shown[0], WIDE, HIGH}, NULL);
    assert_int_equal(c.holes + c.spills, 0);
    fill(shown, 3, 9);
    c = cracks_count(&(crack_pictures){geometry[0], must[0], shown[0], WIDE, HIGH}, NULL);
    assert_int_equal(c.holes + c.spills, 0);
}

static void movers_are_right_where_they_show_in_both_or_in_neither(void **state)
{
    (void)state;
    static const float movers[] = {0, 0.5f, 0.5f, 0.5f, 0.5f, 0.25f}, truth[] = {0.5f, 0.5f, 0.75f, 0.5f, 0.75f, 0.25f};
    static const float picture[] = {0.1f, 0.5f, 0.5f, 0.625f, 0.875f, 0};
    const mover_order c = movers_count(&(mover_pictures){movers, truth, picture, 6, 1});
    assert_int_equal(c.pixels, 4); // shown in both; only in the picture; hidden by it; lost in it. In neither: does not count
    assert_int_equal(c.wrong, 3);
    assert_int_equal(movers_count(&(mover_pictures){movers, truth, truth, 6, 1}).wrong, 0);
}

// A mover stands over columns 4 to 11, and is hidden by what is nearer to the left of a column; in the picture that column is another.
static mover_order order_where(int hidden_to, int hidden_in_picture_to)
{
    static float movers[HIGH][WIDE];
    for (int y = 0; y < HIGH; ++y)
        for (int x = 0; x < WIDE; ++x) {
            movers[y][x] = x >= 4 && x < 12 ? 0.5f : 0;
            geometry[y][x] = x < hidden_to ? 0.75f : movers[y][x] > 0 ? movers[y][x] : 0.25f;
            shown[y][x] = x < hidden_in_picture_to ? 0.75f : movers[y][x] > 0 ? movers[y][x] : 0.25f;
        }
    return movers_count(&(mover_pictures){movers[0], geometry[0], shown[0], WIDE, HIGH});
}

static void a_pixel_s_displacement_of_what_hides_a_mover_is_wrong_and_not_far(void **state)
{
    (void)state;
    for (int moved = -3; moved <= 3; ++moved) {
        const mover_order c = order_where(8, 8 + moved);
        assert_int_equal(c.wrong, abs(moved) * HIGH);
        assert_int_equal(c.wrong_far, moved ? (abs(moved) - 1) * HIGH : 0);
    }
}

static void a_mover_lost_before_what_is_farther_is_wrong_far(void **state)
{
    (void)state;
    const mover_order c = order_where(4, 12); // hidden by nothing: what stands beside it at the left is nearer, what at the right farther
    assert_int_equal(c.wrong, 8 * HIGH);
    assert_int_equal(c.wrong_far, 7 * HIGH);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_coverage_has_no_cracks),
        cmocka_unit_test(a_hole_counts_and_is_inner_away_from_silhouettes),
        cmocka_unit_test(what_spills_counts_beyond_one_pixel_of_a_silhouette),
        cmocka_unit_test(the_picture_s_border_tells_of_no_spills),
        cmocka_unit_test(movers_are_right_where_they_show_in_both_or_in_neither),
        cmocka_unit_test(a_pixel_s_displacement_of_what_hides_a_mover_is_wrong_and_not_far),
        cmocka_unit_test(a_mover_lost_before_what_is_farther_is_wrong_far),
        cmocka_unit_test(what_need_not_be_shown_leaves_no_hole_and_is_no_spill),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
