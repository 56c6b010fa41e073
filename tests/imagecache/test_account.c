// Tests of imagecache's account: pictures that lose give way to geometry, ever longer; those that pay stay; how soon they wear out is learned.
// SPDX-License-Identifier: MIT
#include "plugins/imagecache/account.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define GEOMETRY_NS 1e8

static account_frame frame_of(double pictures)
{
    const account_frame f = {.geometry_ns = GEOMETRY_NS, .near_ns = 0.2 * pictures * GEOMETRY_NS, .shown_ns = 0.2 * pictures * GEOMETRY_NS,
                             .taken_ns = 0.6 * pictures * GEOMETRY_NS, .foretold_ns = 0.6 * pictures * GEOMETRY_NS};
    return f;
}

// Frames of pictures in so many, each of which costs so many times geometry's.
static uint32_t fly(account *a, double pictures, uint32_t frames)
{
    const account_frame f = frame_of(pictures);
    uint32_t shown = 0;
    for (uint32_t i = 0; i < frames; i++) {
        if (account_rests(a)) continue;
        account_add(a, &f);
        shown++;
    }
    return shown;
}

static void pictures_that_lose_are_handed_back_for_twice_as_long_each_time(void **state)
{
    (void)state;
    account a;
    const account_frame f = frame_of(2);
    account_open(&a);
    for (uint32_t turn = 30; turn <= 480; turn *= 2) {
        uint32_t rests = 0;
        while (a.rest == 0) account_add(&a, &f);
        while (account_rests(&a)) rests++;
        assert_int_equal(rests, turn);
    }
}

static void a_long_flight_loses_less_than_a_twentieth_to_pictures_that_lose(void **state)
{
    (void)state;
    static const double costs[] = {1.1, 1.5, 2, 5};
    for (int k = 0; k < 4; k++) {
        account a;
        account_open(&a);
        const uint32_t shown = fly(&a, costs[k], 1000);
        assert_true(shown > 0 && shown * (costs[k] - 1) < 50);
    }
}

static void pictures_that_pay_stay_after_a_dear_first_frame(void **state)
{
    (void)state;
    account a;
    const account_frame first = frame_of(3);
    account_open(&a);
    account_add(&a, &first);
    assert_int_equal(fly(&a, 0.5, 500), 500);
}

static void after_pictures_paid_the_next_turn_of_geometry_is_short_again(void **state)
{
    (void)state;
    account a;
    account_open(&a);
    fly(&a, 2, 400);
    assert_true(a.next_rest > 100);
    while (account_rests(&a)) continue;
    fly(&a, 0.3, 50);
    assert_int_equal(a.next_rest, 30);
}

static void how_soon_pictures_wear_out_is_learned_but_not_from_the_first_of_a_view(void **state)
{
    (void)state;
    account a;
    account_frame f = {.geometry_ns = GEOMETRY_NS, .taken_ns = 0.4 * GEOMETRY_NS, .foretold_ns = 0.1 * GEOMETRY_NS};
    account_open(&a);
    account_add(&a, &f);
    assert_true(a.taken_ns <= 0 && a.wear >= 1 && a.wear <= 1);
    for (int i = 0; i < 200; i++) account_add(&a, &f);
    assert_true(a.wear > 2.5 && a.wear < 4.5);
    f.taken_ns = f.foretold_ns;
    for (int i = 0; i < 400; i++) account_add(&a, &f);
    assert_true(a.wear < 1.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_that_lose_are_handed_back_for_twice_as_long_each_time),
        cmocka_unit_test(a_long_flight_loses_less_than_a_twentieth_to_pictures_that_lose),
        cmocka_unit_test(pictures_that_pay_stay_after_a_dear_first_frame),
        cmocka_unit_test(after_pictures_paid_the_next_turn_of_geometry_is_short_again),
        cmocka_unit_test(how_soon_pictures_wear_out_is_learned_but_not_from_the_first_of_a_view),
    };
    return cmocka_run_group_tests_name("image cache: the account", tests, NULL, NULL);
}
