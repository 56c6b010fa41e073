// The rule of bench --against on times that are made up: noise, drift and lone slow views are nothing, a fifth on every view is something.
// SPDX-License-Identifier: MIT
#include "bench/against_rule.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { VIEWS = 200, RUNS = 200 };

typedef struct run { double of_then[VIEWS], of_now[VIEWS]; } run;

// Seeded, the same on every machine: uniform in 0 to 1.
static double uniform(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) / 9007199254740992.0;
}

// Views of 5 to 50 us; each time up to `noise` over its least.
static run run_of(uint64_t *seed, double noise, double factor)
{
    run r;
    for (int v = 0; v < VIEWS; ++v) {
        const double ns = 5000 + 45000 * uniform(seed);
        r.of_then[v] = ns * (1 + noise * uniform(seed));
        r.of_now[v] = ns * factor * (1 + noise * uniform(seed));
    }
    return r;
}

static against_finding judge(const run *r, uint32_t count, double drift)
{
    double scratch[2 * VIEWS];
    return against_judge(&(against_times){r->of_then, r->of_now, count}, drift, &(against_rule){1.1, 0.01 / 4}, scratch);
}

static void noise_is_no_regression(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int i = 0; i < RUNS; ++i) {
        const run r = run_of(&seed, 0.3, 1);
        assert_int_equal(judge(&r, VIEWS, 1).verdict, AGAINST_SAME);
    }
}

static void less_than_counts_is_no_regression_however_sure(void **state)
{
    (void)state;
    uint64_t seed = 2;
    const run r = run_of(&seed, 0.001, 1.08);
    const against_finding f = judge(&r, VIEWS, 1);
    assert_int_equal(f.verdict, AGAINST_SAME);
    assert_true(fabs(f.ratio - 1.08) < 0.01);
}

static void a_fifth_is_a_regression(void **state)
{
    (void)state;
    uint64_t seed = 3;
    for (int i = 0; i < RUNS; ++i) {
        const run r = run_of(&seed, 0.1, 1.2);
        assert_int_equal(judge(&r, VIEWS, 1).verdict, AGAINST_SLOWER);
    }
}

static void a_fifth_less_is_told_as_faster(void **state)
{
    (void)state;
    uint64_t seed = 4;
    const run r = run_of(&seed, 0.05, 0.8);
    const against_finding f = judge(&r, VIEWS, 1);
    assert_int_equal(f.verdict, AGAINST_FASTER);
    assert_true(f.p < 0.0025);
}

static void a_slower_machine_is_taken_off(void **state)
{
    (void)state;
    uint64_t seed = 5;
    double scratch[VIEWS];
    const run reference = run_of(&seed, 0.05, 1.5), same = run_of(&seed, 0.05, 1.5), slower = run_of(&seed, 0.05, 1.5 * 1.2);
    const double drift = against_drift(&(against_times){reference.of_then, reference.of_now, VIEWS}, scratch);
    assert_true(fabs(drift - 1.5) < 0.03);
    assert_int_equal(judge(&same, VIEWS, drift).verdict, AGAINST_SAME);
    assert_int_equal(judge(&same, VIEWS, 1).verdict, AGAINST_SLOWER);
    assert_int_equal(judge(&slower, VIEWS, drift).verdict, AGAINST_SLOWER);
}

static void a_few_views_that_were_disturbed_are_nothing(void **state)
{
    (void)state;
    uint64_t seed = 6;
    run r = run_of(&seed, 0.05, 1);
    for (int v = 0; v < VIEWS; v += 7) r.of_now[v] *= 50;
    assert_int_equal(judge(&r, VIEWS, 1).verdict, AGAINST_SAME);
}

static void few_views_tell_nothing(void **state)
{
    (void)state;
    uint64_t seed = 7;
    run r = run_of(&seed, 0.01, 3);
    assert_int_equal(judge(&r, AGAINST_VIEWS_LEAST - 1, 1).verdict, AGAINST_TOO_FEW);
    assert_int_equal(judge(&r, AGAINST_VIEWS_LEAST, 1).verdict, AGAINST_SLOWER);
    for (int v = 0; v < VIEWS; ++v) r.of_then[v] = 0; // no time at all
    assert_int_equal(judge(&r, VIEWS, 1).verdict, AGAINST_TOO_FEW);
}

// Exact probabilities of small samples are known: of n values all above 0 it is 2^-n; the approximation with continuity is near.
static void the_signed_rank_test_is_wilcoxons(void **state)
{
    (void)state;
    double all_above[10], balanced[] = {1, -2, 3, -4, 5, -6, 7, -8, -9, 9.5}, zeros[4] = {0};
    for (int i = 0; i < 10; ++i) all_above[i] = i + 1;
    assert_true(fabs(against_signed_rank(all_above, 10) - 0.0029) < 0.0003); // 0.00098 exactly; of the normal curve 0.0029
    assert_true(fabs(against_signed_rank(balanced, 10) - 0.5) < 0.2);
    assert_true(against_signed_rank(zeros, 4) == 1);
    double tied[8] = {1, 1, 1, 1, -1, -1, -1, -1};
    assert_true(fabs(against_signed_rank(tied, 8) - 0.5) < 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_is_no_regression),
        cmocka_unit_test(less_than_counts_is_no_regression_however_sure),
        cmocka_unit_test(a_fifth_is_a_regression),
        cmocka_unit_test(a_fifth_less_is_told_as_faster),
        cmocka_unit_test(a_slower_machine_is_taken_off),
        cmocka_unit_test(a_few_views_that_were_disturbed_are_nothing),
        cmocka_unit_test(few_views_tell_nothing),
        cmocka_unit_test(the_signed_rank_test_is_wilcoxons),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
