// Shards: what --shard takes, which views each has, and whom of a starter's environment is believed.
// SPDX-License-Identifier: MIT
#include "bench/shard.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

static void a_shard_is_i_of_n(void **state)
{
    (void)state;
    static const char *const none[] = {"", "/", "1", "1/", "/2", "0/2", "3/2", "1/0", "-1/2", "1/2x", "x1/2", "1//2", "1/2/3", " 1/2", "1/99999999999", "99999999999/2"};
    bench_shard s = {.index = 7, .count = 9};
    for (size_t i = 0; i < sizeof none / sizeof *none; ++i) assert_int_equal(shard_parse(none[i], &s), 0);
    assert_true(s.index == 7 && s.count == 9); // as it was
    assert_int_equal(shard_parse("1/1", &s), 1);
    assert_true(s.index == 1 && s.count == 1);
    assert_int_equal(shard_parse("12/1000000", &s), 1);
    assert_true(s.index == 12 && s.count == 1000000);
}

static void shards_are_the_path_and_as_even_as_can_be(void **state)
{
    (void)state;
    static const uint32_t views[] = {1, 2, 7, 100, 1000000, UINT32_MAX}, counts[] = {1, 2, 3, 7, 64, 1000};
    for (size_t i = 0; i < sizeof views / sizeof *views; ++i)
        for (size_t k = 0; k < sizeof counts / sizeof *counts; ++k) {
            uint32_t next = 0;
            for (uint32_t n = 1; n <= counts[k]; ++n) {
                const view_range range = shard_range(&(bench_shard){.index = n, .count = counts[k]}, views[i]);
                assert_int_equal(range.first, next);
                assert_true(range.end - range.first == views[i] / counts[k] || range.end - range.first == views[i] / counts[k] + 1);
                next = range.end;
            }
            assert_int_equal(next, views[i]);
        }
    const view_range all = shard_range(&(bench_shard){0}, 12);
    assert_true(all.first == 0 && all.end == 12);
}

static const char *const *environment; // name, value, ..., NULL: cmocka runs one test at a time

static const char *variable(const char *name)
{
    for (size_t i = 0; environment[i]; i += 2)
        if (strcmp(environment[i], name) == 0) return environment[i + 1];
    return NULL;
}

static int found(const char *const *list, uint32_t index, uint32_t count)
{
    bench_shard s = {0};
    environment = list;
    return shard_of_environment(variable, &s) && s.index == index && s.count == count;
}

static void starters_tell_rank_and_size(void **state)
{
    (void)state;
    assert_true(found((const char *const[]){"SLURM_PROCID", "0", "SLURM_NTASKS", "4", NULL}, 1, 4));
    assert_true(found((const char *const[]){"OMPI_COMM_WORLD_RANK", "3", "OMPI_COMM_WORLD_SIZE", "4", NULL}, 4, 4));
    assert_true(found((const char *const[]){"PMI_RANK", "1", "PMI_SIZE", "2", NULL}, 2, 2));
    // mpirun within one task of Slurm
    assert_true(found((const char *const[]){"SLURM_PROCID", "0", "SLURM_NTASKS", "1", "OMPI_COMM_WORLD_RANK", "2", "OMPI_COMM_WORLD_SIZE", "8", NULL}, 3, 8));
}

static void what_makes_no_sense_is_no_shard(void **state)
{
    (void)state;
    bench_shard s = {0};
    static const char *const lists[][5] = {{NULL}, {"SLURM_PROCID", "1", NULL}, {"SLURM_PROCID", "0", "SLURM_NTASKS", "1", NULL},
                                           {"SLURM_PROCID", "4", "SLURM_NTASKS", "4", NULL}, {"PMI_RANK", "x", "PMI_SIZE", "4", NULL},
                                           {"PMI_RANK", "1", "PMI_SIZE", "4 ", NULL}, {"PMI_RANK", "", "PMI_SIZE", "", NULL}};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; ++i) {
        environment = lists[i];
        assert_int_equal(shard_of_environment(variable, &s), 0);
    }
    assert_int_equal(s.count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_shard_is_i_of_n),
        cmocka_unit_test(shards_are_the_path_and_as_even_as_can_be),
        cmocka_unit_test(starters_tell_rank_and_size),
        cmocka_unit_test(what_makes_no_sense_is_no_shard),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
