// The choice of chains, with costs that are made up: the rule, the walk over groups, the budget.
// SPDX-License-Identifier: MIT
#include "bench/choose.h"
#include "tests/common/test.h"

#include <string.h>

enum { CANDIDATES = 3, GROUPS = 3, SIMPLE = 0, MIDDLE = 1, COMPLEX = 2, NOBODY = -1 };
static const choose_candidate candidates[CANDIDATES] = {{1, 0}, {2, 0}, {2, 1}};

static choose_pick pick(const double ms[CANDIDATES], const uint32_t is_exact[CANDIDATES], double noise)
{
    choose_cost costs[CANDIDATES];
    for (int i = 0; i < CANDIDATES; ++i) costs[i] = (choose_cost){ms[i], is_exact[i]};
    return choose_one(candidates, costs, CANDIDATES, noise);
}

static void the_fastest_exact_chain_is_taken(void **state)
{
    (void)state;
    const choose_pick p = pick((const double[]){10, 5, 1}, (const uint32_t[]){1, 1, 0}, 0);
    assert_int_equal(p.candidate, MIDDLE);
    assert_int_equal(p.next, SIMPLE);
    assert_int_equal(p.reason, CHOOSE_FASTEST);
    assert_true(p.ms == 5 && p.next_ms == 10);
}

static void of_chains_within_the_margin_the_simpler_is_taken(void **state)
{
    (void)state;
    choose_pick p = pick((const double[]){10.2, 10.1, 10}, (const uint32_t[]){1, 1, 1}, 0);
    assert_int_equal(p.candidate, SIMPLE);
    assert_int_equal(p.reason, CHOOSE_SIMPLER);
    p = pick((const double[]){11, 10.1, 10}, (const uint32_t[]){1, 1, 1}, 0);
    assert_int_equal(p.candidate, MIDDLE); // as many stages, fewer options
    p = pick((const double[]){11, 10.1, 10}, (const uint32_t[]){1, 1, 1}, 0.06);
    assert_int_equal(p.candidate, SIMPLE); // a noisy run cannot tell them apart
    assert_true(p.margin == 0.12);
}

static void one_that_is_exact_alone_is_taken_and_of_none_nobody(void **state)
{
    (void)state;
    assert_int_equal(pick((const double[]){1, 2, 30}, (const uint32_t[]){0, 0, 1}, 0).reason, CHOOSE_ONLY);
    assert_int_equal((int32_t)pick((const double[]){1, 2, 30}, (const uint32_t[]){0, 0, 0}, 0).candidate, NOBODY);
}

// ---- The walk over groups ----

typedef struct fake {
    double ms[GROUPS][CANDIDATES]; // a whole costs the sum of its groups
    uint32_t inexact[GROUPS];      // bit: this candidate misses something there
    uint32_t runs, runs_most, failing_run;
} fake;

static result measure(void *user, const uint32_t *assignments, uint32_t count, choose_cost *out)
{
    fake *f = user;
    if (f->runs++ == f->failing_run) return RESULT_NO_GL;
    for (uint32_t i = 0; i < count; ++i) {
        out[i] = (choose_cost){0, 1};
        for (uint32_t g = 0; g < GROUPS; ++g) {
            const uint32_t c = assignments[i * GROUPS + g];
            out[i].ms += f->ms[g][c];
            out[i].is_exact &= !(f->inexact[g] >> c & 1);
        }
    }
    return RESULT_OK;
}

static int is_over(void *user)
{
    const fake *f = user;
    return f->runs >= f->runs_most;
}

static result run(fake *f, const double weights[GROUPS], choose_pick *uniform, choose_pick picks[GROUPS])
{
    const choose_request q = {candidates, CANDIDATES, GROUPS, weights, {f, measure, is_over}};
    return choose_all(&q, allocator_heap(), uniform, picks);
}

static fake mixed(void)
{
    return (fake){.ms = {{30, 10, 12}, {5, 6, 1}, {2, 9, 9}}, .runs_most = 100, .failing_run = 100};
}

static void each_group_gets_what_is_cheapest_there(void **state)
{
    (void)state;
    fake f = mixed();
    choose_pick uniform, picks[GROUPS];
    assert_int_equal(run(&f, (const double[]){0.7, 0.2, 0.1}, &uniform, picks), RESULT_OK);
    assert_int_equal(uniform.candidate, COMPLEX); // 22 of 37, 25, 22
    assert_int_equal(picks[0].candidate, MIDDLE);
    assert_int_equal(picks[1].candidate, COMPLEX);
    assert_int_equal(picks[2].candidate, SIMPLE);
    assert_int_equal(f.runs, 1 + GROUPS);
    assert_true(picks[2].ms == 13);
}

static void one_that_misses_anything_is_never_taken(void **state)
{
    (void)state;
    fake f = mixed();
    choose_pick uniform, picks[GROUPS];
    f.inexact[0] = 1u << COMPLEX;
    assert_int_equal(run(&f, (const double[]){0.7, 0.2, 0.1}, &uniform, picks), RESULT_OK);
    assert_int_equal(uniform.candidate, MIDDLE);
    for (int g = 0; g < GROUPS; ++g) assert_int_not_equal(picks[g].candidate, COMPLEX);
    for (int g = 0; g < GROUPS; ++g) f.inexact[g] = 7;
    assert_int_equal(run(&f, (const double[]){0.7, 0.2, 0.1}, &uniform, picks), RESULT_BAD_INPUT);
}

static void a_spent_budget_and_what_is_never_drawn_leave_the_choice_for_all(void **state)
{
    (void)state;
    fake f = mixed();
    choose_pick uniform, picks[GROUPS];
    f.runs_most = 2;
    assert_int_equal(run(&f, (const double[]){0.7, 0.2, 0.1}, &uniform, picks), RESULT_OK);
    assert_int_equal(f.runs, 2);
    assert_int_equal(picks[0].candidate, MIDDLE);
    assert_int_equal(picks[1].candidate, uniform.candidate);
    assert_int_equal(picks[1].reason, CHOOSE_UNTRIED);
    f = mixed();
    assert_int_equal(run(&f, (const double[]){1, 0, 0}, &uniform, picks), RESULT_OK);
    assert_int_equal(f.runs, 2);
    assert_int_equal(picks[2].reason, CHOOSE_UNTRIED);
}

static void equal_costs_choose_the_same_each_time_and_the_simplest(void **state)
{
    (void)state;
    for (int i = 0; i < 2; ++i) {
        fake f = {.ms = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, .runs_most = 100, .failing_run = 100};
        choose_pick uniform, picks[GROUPS];
        assert_int_equal(run(&f, (const double[]){0.5, 0.3, 0.2}, &uniform, picks), RESULT_OK);
        for (int g = 0; g < GROUPS; ++g) assert_int_equal(picks[g].candidate, SIMPLE);
    }
}

static void a_measurement_that_fails_ends_it(void **state)
{
    (void)state;
    for (uint32_t at = 0; at < 2; ++at) {
        fake f = mixed();
        choose_pick uniform, picks[GROUPS];
        f.failing_run = at;
        assert_int_equal(run(&f, (const double[]){0.7, 0.2, 0.1}, &uniform, picks), RESULT_NO_GL);
        assert_int_equal(f.runs, at + 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fastest_exact_chain_is_taken),
        cmocka_unit_test(of_chains_within_the_margin_the_simpler_is_taken),
        cmocka_unit_test(one_that_is_exact_alone_is_taken_and_of_none_nobody),
        cmocka_unit_test(each_group_gets_what_is_cheapest_there),
        cmocka_unit_test(one_that_misses_anything_is_never_taken),
        cmocka_unit_test(a_spent_budget_and_what_is_never_drawn_leave_the_choice_for_all),
        cmocka_unit_test(equal_costs_choose_the_same_each_time_and_the_simplest),
        cmocka_unit_test(a_measurement_that_fails_ends_it),
    };
    return cmocka_run_group_tests_name("bench auto", tests, NULL, NULL);
}
