// Tests of host/core/runs: every kernel against a plain loop in 64 bits.
// SPDX-License-Identifier: MIT
#include "host/core/runs.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <string.h>

typedef struct named_kernel {
    const char *name;
    const runs_kernel *kernel;
    int here; // this CPU has it
} named_kernel;

enum { KERNELS = 3, RUNS = 4000 };

static void kernels_of_this_cpu(named_kernel out[KERNELS])
{
    int avx2 = 0, avx512 = 0;
#if defined(__x86_64__)
    avx2 = __builtin_cpu_supports("avx2") != 0;
    avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
#endif
    out[0] = (named_kernel){"plain", &runs_kernel_plain, 1};
    out[1] = (named_kernel){"avx2", &runs_kernel_avx2, avx2};
    out[2] = (named_kernel){"avx512", &runs_kernel_avx512, avx512};
}

typedef struct verdict {
    uint32_t good;
    uint64_t items;
} verdict;

static verdict naive_check(const cull_run *runs, uint32_t count, uint32_t limit)
{
    verdict v = {1, 0};
    for (uint32_t i = 0; i < count; ++i) {
        if (runs[i].count == 0 || (uint64_t)runs[i].first + runs[i].count > limit) v.good = 0;
        v.items += runs[i].count;
    }
    return v;
}

static void assert_kernels_check(const cull_run *runs, uint32_t count, uint32_t limit)
{
    named_kernel kernels[KERNELS];
    kernels_of_this_cpu(kernels);
    const verdict wanted = naive_check(runs, count, limit);
    for (int k = 0; k < KERNELS; ++k) {
        if (!kernels[k].here) continue;
        uint64_t items = 12345;
        assert_int_equal(kernels[k].kernel->check(runs, count, limit, &items), wanted.good);
        assert_int_equal(items, wanted.items);
    }
}

static void every_kernel_is_tested_here_or_missed_loudly(void **state)
{
    (void)state;
    named_kernel kernels[KERNELS];
    kernels_of_this_cpu(kernels);
    int missed = 0;
    for (int k = 0; k < KERNELS; ++k) {
        if (!kernels[k].here) fprintf(stderr, "core runs: this CPU lacks %s, that kernel is NOT tested\n", kernels[k].name);
        missed += !kernels[k].here;
        if (kernels[k].kernel == runs_kernel_best()) assert_true(kernels[k].here);
    }
    if (missed) skip();
}

static void check_agrees_with_the_plain_loop_at_the_edges_of_32_bits(void **state)
{
    (void)state;
    static const uint32_t edges[] = {0, 1, 2, 99, 100, 101, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff};
    enum { EDGES = sizeof edges / sizeof *edges };
    for (uint32_t first = 0; first < EDGES; ++first)
        for (uint32_t count = 0; count < EDGES; ++count)
            for (uint32_t limit = 0; limit < EDGES; ++limit) {
                const cull_run runs[] = {{edges[first], edges[count]}};
                assert_kernels_check(runs, 1, edges[limit]);
            }
}

static void check_finds_the_one_bad_run_wherever_it_stands(void **state)
{
    (void)state;
    static cull_run runs[RUNS];
    for (uint32_t i = 0; i < RUNS; ++i) runs[i] = (cull_run){i, 1};
    assert_kernels_check(runs, RUNS, RUNS);
    assert_kernels_check(runs, 0, 0);
    static const cull_run bad[] = {{0, 0}, {RUNS, 1}, {RUNS - 1, 2}, {0xffffffff, 1}, {1, 0xffffffff}, {0xffffffff, 0xffffffff}};
    for (uint32_t place = 0; place < RUNS; place += place < 70 ? 1 : 131)
        for (uint32_t b = 0; b < sizeof bad / sizeof *bad; ++b) {
            const cull_run kept = runs[place];
            runs[place] = bad[b];
            assert_int_equal(naive_check(runs, RUNS, RUNS).good, 0);
            assert_kernels_check(runs, RUNS, RUNS);
            runs[place] = kept;
        }
}

static void check_sums_past_32_bits(void **state)
{
    (void)state;
    static cull_run runs[RUNS];
    for (uint32_t i = 0; i < RUNS; ++i) runs[i] = (cull_run){i, 0xffff0000};
    assert_true(naive_check(runs, RUNS, 0xffffffff).items > UINT32_MAX);
    assert_kernels_check(runs, RUNS, 0xffffffff);
    for (uint32_t i = 0; i < RUNS; ++i) runs[i] = (cull_run){0, 0xffffffff};
    assert_kernels_check(runs, RUNS, 0xffffffff);
    assert_kernels_check(runs, RUNS, 0xfffffffe);
}

static void check_agrees_on_random_runs(void **state)
{
    (void)state;
    static cull_run runs[RUNS];
    uint64_t random = 3;
    for (int round = 0; round < 300; ++round) {
        const uint32_t count = random_below(&random, RUNS), limit = 1 + random_below(&random, 100000);
        for (uint32_t i = 0; i < count; ++i) {
            runs[i].first = random_below(&random, limit);
            runs[i].count = 1 + random_below(&random, limit - runs[i].first);
        }
        if (round % 2 && count) runs[random_below(&random, count)].first += limit;
        assert_kernels_check(runs, count, limit);
    }
}

enum { PLACES = 20000, MARK = 0x7a7a7a7a };

static uint32_t random_runs(uint64_t *random, cull_run *runs, uint32_t most, uint32_t longest)
{
    uint32_t count = 0, place = random_below(random, 20);
    while (count < most && place < PLACES) {
        uint32_t length = 1 + random_below(random, longest);
        if (length > PLACES - place) length = PLACES - place;
        runs[count++] = (cull_run){place, length};
        place += length + 1 + random_below(random, longest);
    }
    return count;
}

static void assert_expands(const runs_kernel *kernel, const cull_run *runs, uint32_t count, const uint32_t *order)
{
    static uint32_t ids[PLACES + RUNS_OVERWRITE + 64];
    for (uint32_t i = 0; i < PLACES + RUNS_OVERWRITE + 64; ++i) ids[i] = MARK;
    uint32_t total = 0, at = 0;
    for (uint32_t r = 0; r < count; ++r) total += runs[r].count;
    assert_int_equal(kernel->expand(runs, count, order, ids), total);
    for (uint32_t r = 0; r < count; ++r)
        for (uint32_t i = 0; i < runs[r].count; ++i) {
            const uint32_t place = runs[r].first + i;
            assert_int_equal(ids[at++], order ? order[place] : place);
        }
    for (uint32_t i = total + RUNS_OVERWRITE; i < PLACES + RUNS_OVERWRITE + 64; ++i) assert_int_equal(ids[i], MARK);
}

static void expand_writes_each_place_once_and_at_most_the_overwrite_behind(void **state)
{
    (void)state;
    static cull_run runs[PLACES];
    static uint32_t order[PLACES + RUNS_OVERWRITE];
    static const uint32_t longest[] = {1, 2, 7, 15, 16, 17, 31, 32, 33, 200, 5000};
    named_kernel kernels[KERNELS];
    kernels_of_this_cpu(kernels);
    uint64_t random = 4;
    for (uint32_t i = 0; i < PLACES; ++i) order[i] = PLACES * 3 - i * 2;
    for (uint32_t l = 0; l < sizeof longest / sizeof *longest; ++l) {
        const uint32_t count = random_runs(&random, runs, PLACES, longest[l]);
        for (int k = 0; k < KERNELS; ++k) {
            if (!kernels[k].here) continue;
            assert_expands(kernels[k].kernel, runs, count, NULL);
            assert_expands(kernels[k].kernel, runs, count, order);
            assert_expands(kernels[k].kernel, runs, 0, order);
        }
    }
    const cull_run all = {0, PLACES};
    for (int k = 0; k < KERNELS; ++k)
        if (kernels[k].here) assert_expands(kernels[k].kernel, &all, 1, order);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kernel_is_tested_here_or_missed_loudly),
        cmocka_unit_test(check_agrees_with_the_plain_loop_at_the_edges_of_32_bits),
        cmocka_unit_test(check_finds_the_one_bad_run_wherever_it_stands),
        cmocka_unit_test(check_sums_past_32_bits),
        cmocka_unit_test(check_agrees_on_random_runs),
        cmocka_unit_test(expand_writes_each_place_once_and_at_most_the_overwrite_behind),
    };
    return cmocka_run_group_tests_name("core runs", tests, NULL, NULL);
}
