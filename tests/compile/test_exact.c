// exact.h and the plane table: every sign agrees with GMP, on planes that rounding gets wrong.
// SPDX-License-Identifier: MIT
#include "exact_oracle.h"
#include "host/compile/plane_table.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>

static uint32_t calls_in_all(void)
{
    const char *is_long = getenv("PORTCULLIS_LONG");
    return is_long && *is_long && *is_long != '0' ? 10000000 : 1000000;
}

static uint32_t calls_a_family(void)
{
    return calls_in_all() / FAMILY_COUNT + 1;
}

static void four_planes_have_the_sign_that_gmp_gives(void **state)
{
    (void)state;
    uint64_t seed = 1;
    uint32_t tiers[4] = {0}, wrong = 0, zeros = 0;
    for (int f = 0; f < FAMILY_COUNT; ++f)
        for (uint32_t i = 0; i < calls_a_family(); ++i) {
            cull_wide_plane p[4];
            cull_tier tier;
            family_planes((plane_family)f, &seed, p);
            const int sign = cull_four_sign_tier(&p[0], &p[1], &p[2], &p[3], &tier);
            tiers[tier]++;
            zeros += sign == 0;
            wrong += sign != gmp_four_sign(p);
        }
    assert_int_equal(wrong, 0);
    assert_int_equal(tiers[0] + tiers[1] + tiers[2] + tiers[3], calls_a_family() * FAMILY_COUNT);
    for (int t = 0; t < 4; ++t) assert_true(tiers[t] > 0);
    assert_true(zeros >= 2 * calls_a_family()); // two families are all zeros
    printf("four planes: double %u, 64 bits %u, 128 bits %u, 256 bits %u; zeros %u\n", tiers[0], tiers[1], tiers[2], tiers[3], zeros);
}

static void planes_through_one_point_never_stop_at_the_filter(void **state)
{
    (void)state;
    uint64_t seed = 2;
    for (uint32_t i = 0; i < 20000; ++i) {
        cull_wide_plane p[4];
        cull_tier tier;
        family_planes(i % 2 ? FAMILY_ONE_POINT : FAMILY_COMBINATION, &seed, p);
        assert_int_equal(cull_four_sign_tier(&p[0], &p[1], &p[2], &p[3], &tier), 0);
        assert_int_not_equal(tier, CULL_TIER_DOUBLE);
    }
}

static void three_normals_have_the_sign_that_gmp_gives(void **state)
{
    (void)state;
    uint64_t seed = 3;
    uint32_t tiers[4] = {0}, wrong = 0;
    for (int f = 0; f < FAMILY_COUNT; ++f)
        for (uint32_t i = 0; i < calls_a_family() / 4; ++i) {
            cull_wide_plane p[4];
            cull_tier tier;
            family_planes((plane_family)f, &seed, p);
            if (i % 2) // the third in the plane of the others, or off it by one
                for (int k = 0; k < 3; ++k) p[2].normal[k] = (p[0].normal[k] - p[1].normal[k]) / 2 + (k == 1 && i % 4 == 1);
            wrong += cull_normals_sign_tier(&p[0], &p[1], &p[2], &tier) != gmp_normals_sign(p);
            tiers[tier]++;
        }
    assert_int_equal(wrong, 0);
    for (int t = 0; t < 4; ++t) assert_true(tiers[t] > 0);
}

static void a_vertex_lies_where_gmp_puts_it(void **state)
{
    (void)state;
    uint64_t seed = 4;
    uint32_t far = 0, wrong_side = 0, wrong_order = 0, met = 0;
    for (int f = 0; f < FAMILY_COUNT; ++f)
        for (uint32_t i = 0; i < calls_a_family() / 16; ++i) {
            cull_wide_plane p[4];
            double position[3];
            family_planes((plane_family)f, &seed, p);
            const int meets = cull_meet_position(&p[0], &p[1], &p[2], position);
            assert_int_equal(meets, gmp_normals_sign(p) != 0);
            if (!meets) continue;
            met++;
            far += !gmp_position_is_near(p, position, CULL_MEET_ERROR);
            const int side = cull_side_of_meet(&p[0], &p[1], &p[2], &p[3]);
            wrong_side += side != gmp_four_sign(p) * gmp_normals_sign(p);
            const cull_row row = cull_row_of(&p[3]);
            const int quick = cull_side_of_position(&row, position);
            wrong_side += quick != 0 && quick != side;
            if (cull_normals_sign(&p[0], &p[1], &p[3])) wrong_order += cull_order_along(&p[0], &p[1], &p[2], &p[3]) != gmp_order_along(p);
        }
    assert_true(met > calls_a_family() / 4);
    assert_int_equal(far, 0);
    assert_int_equal(wrong_side, 0);
    assert_int_equal(wrong_order, 0);
}

static void a_grid_point_keeps_its_side(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (uint32_t i = 0; i < 100000; ++i) {
        cull_wide_plane p[4];
        int32_t a[3], b[3], c[3];
        random_point(&seed, CULL_GRID_MOST, a);
        random_point(&seed, CULL_GRID_MOST, b);
        random_point(&seed, CULL_GRID_MOST, c);
        if (!cull_wide_plane_through(a, b, c, p)) continue;
        assert_int_equal(cull_side_of_point(p, a) | cull_side_of_point(p, b) | cull_side_of_point(p, c), 0);
        family_planes((plane_family)(i % FAMILY_COUNT), &seed, p);
        assert_int_equal(cull_side_of_point(&p[3], a), gmp_side_of_point(&p[3], a));
        const cull_wide_plane back = cull_wide_plane_flipped(p[3]), moved = cull_wide_plane_from_origin(p[3], a);
        assert_int_equal(cull_side_of_point(&back, b), -cull_side_of_point(&p[3], b));
        static const int32_t origin[3] = {0};
        assert_int_equal(cull_side_of_point(&moved, origin), cull_side_of_point(&p[3], a));
    }
}

static void crosses_of_normals_and_turns_round_a_line_agree_with_gmp(void **state)
{
    (void)state;
    uint64_t seed = 6;
    for (uint32_t i = 0; i < 60000; ++i) {
        cull_wide_plane p[4];
        family_planes((plane_family)(i % FAMILY_COUNT), &seed, p);
        if (i % 3 == 0) p[2] = p[0]; // the two crosses at a right angle or nearly so
        const cull_wide_vector one = cull_normals_cross(&p[0], &p[1]), two = cull_normals_cross(&p[2], &p[3]);
        assert_int_equal(cull_wide_vector_dot_sign(&one, &two), gmp_crosses_dot_sign(p));
        const cull_wide_plane pair[4] = {p[0], p[1], p[0], p[1]};
        assert_int_equal(cull_normals_turn(&p[0], &p[1], &one), gmp_crosses_dot_sign(pair));
        assert_int_equal(cull_normals_turn(&p[1], &p[0], &one), -gmp_crosses_dot_sign(pair));
        assert_int_equal(cull_normals_dot_sign(&p[0], &p[0]), 1);
    }
}

static void six_planes_round_a_line_sort_by_turn(void **state)
{
    (void)state;
    static const int64_t normals[6][3] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, -1, 0}, {1, -2, 0}};
    cull_wide_plane p[6];
    for (int i = 0; i < 6; ++i) p[i] = (cull_wide_plane){{normals[i][0], normals[i][1], normals[i][2]}, {0, 0}};
    const cull_wide_vector up = cull_normals_cross(&p[0], &p[2]);
    for (int i = 0; i < 6; ++i) {
        const int next = (i + 1) % 6;
        assert_int_equal(cull_normals_turn(&p[i], &p[next], &up), 1);
    }
    assert_int_equal(cull_normals_turn(&p[0], &p[3], &up), 0);
    assert_int_equal(cull_normals_dot_sign(&p[0], &p[3]), -1);
    assert_int_equal(cull_normals_dot_sign(&p[0], &p[2]), 0);
}

static void a_plane_loses_its_common_divisor_and_nothing_else(void **state)
{
    (void)state;
    uint64_t seed = 7;
    for (uint32_t i = 0; i < 20000; ++i) {
        cull_wide_plane p[4], more;
        family_planes(FAMILY_SMALL, &seed, p);
        const int64_t times = 1 + (int64_t)random_below(&seed, 1u << 30);
        for (int k = 0; k < 3; ++k) more.normal[k] = p[0].normal[k] * times;
        more.offset = cull_wide_scale(p[0].offset, times);
        const cull_wide_plane reduced = cull_wide_plane_reduced(more);
        assert_true(cull_wide_plane_equal(&reduced, &p[0]));
        more.offset = cull_wide_add(more.offset, cull_wide_from(times > 1));
        const cull_wide_plane kept = cull_wide_plane_reduced(more);
        assert_true(cull_wide_plane_equal(&kept, &more) == (times > 1) || times == 1);
    }
}

static void points_on_one_line_make_no_plane(void **state)
{
    (void)state;
    static const int32_t a[3] = {-CULL_GRID_MOST, 5, 1}, b[3] = {0, 6, 2}, c[3] = {CULL_GRID_MOST, 7, 3};
    cull_wide_plane p;
    assert_false(cull_wide_plane_through(a, b, c, &p));
    assert_false(cull_wide_plane_through(a, a, c, &p));
}

static void a_plane_that_fits_63_bits_converts_and_a_larger_one_is_refused(void **state)
{
    (void)state;
    cull_wide_plane p = {{1, 2, 3}, cull_wide_from(INT64_MIN)};
    cull_exact_plane e = {{0, 0, 0}, 7};
    assert_true(cull_exact_plane_from_wide(&p, &e));
    assert_true(e.offset == INT64_MIN && e.normal[2] == 3);
    const cull_wide_plane back = cull_wide_plane_from_exact(&e);
    assert_true(cull_wide_plane_equal(&back, &p));
    p.offset = cull_wide_subtract(p.offset, cull_wide_from(1));
    e.offset = 7;
    assert_false(cull_exact_plane_from_wide(&p, &e));
    assert_int_equal(e.offset, 7);
}

static void the_plane_table_keeps_each_plane_once_and_answers_as_seen(void **state)
{
    (void)state;
    uint64_t seed = 8;
    plane_table *t = plane_table_make(allocator_heap());
    for (uint32_t i = 0; i < 6000; ++i) {
        cull_wide_plane p[4];
        plane_ref r[4];
        family_planes((plane_family)(i % FAMILY_COUNT), &seed, p);
        for (int k = 0; k < 4; ++k) {
            const cull_wide_plane flipped = cull_wide_plane_flipped(p[k]), reduced = cull_wide_plane_reduced(p[k]);
            r[k] = plane_table_add(t, &p[k]);
            const uint32_t count = plane_table_count(t);
            assert_int_equal(plane_table_add(t, &flipped), plane_ref_flipped(r[k]));
            assert_int_equal(plane_table_add(t, &p[k]), r[k]);
            assert_int_equal(plane_table_count(t), count);
            const cull_wide_plane seen = plane_table_get(t, r[k]);
            assert_true(cull_wide_plane_equal(&seen, &reduced));
        }
        assert_int_equal(plane_table_normals_sign(t, r[0], r[1], r[2]), cull_normals_sign(&p[0], &p[1], &p[2]));
        double position[3];
        if (!plane_table_position(t, r, position)) continue;
        const int side = cull_side_of_meet(&p[0], &p[1], &p[2], &p[3]);
        assert_int_equal(plane_table_side(t, r, r[3]), side);
        assert_int_equal(plane_table_side_at(t, r, position, r[3]), side);
        assert_int_equal(plane_table_side_at(t, r, position, plane_ref_flipped(r[3])), -side);
        if (cull_normals_sign(&p[0], &p[1], &p[3])) assert_int_equal(plane_table_order_along(t, r[0], r[1], r[2], r[3]), gmp_order_along(p));
    }
    plane_table_free(t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(four_planes_have_the_sign_that_gmp_gives),
        cmocka_unit_test(planes_through_one_point_never_stop_at_the_filter),
        cmocka_unit_test(three_normals_have_the_sign_that_gmp_gives),
        cmocka_unit_test(a_vertex_lies_where_gmp_puts_it),
        cmocka_unit_test(a_grid_point_keeps_its_side),
        cmocka_unit_test(crosses_of_normals_and_turns_round_a_line_agree_with_gmp),
        cmocka_unit_test(six_planes_round_a_line_sort_by_turn),
        cmocka_unit_test(a_plane_loses_its_common_divisor_and_nothing_else),
        cmocka_unit_test(points_on_one_line_make_no_plane),
        cmocka_unit_test(a_plane_that_fits_63_bits_converts_and_a_larger_one_is_refused),
        cmocka_unit_test(the_plane_table_keeps_each_plane_once_and_answers_as_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
