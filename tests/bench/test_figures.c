// Tests of what the bench takes from cull.figures/1: sums and maxima over zones, and nothing that is no word or no number.
// SPDX-License-Identifier: MIT
#include "bench/figures.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct cull_culler { cull_figures told; };

static const void *get_extension(const cull_culler *c, const char *id)
{
    return strcmp(id, CULL_EXT_FIGURES) == 0 ? &c->told : NULL;
}

static const cull_descriptor descriptor = {.id = "teller"};
static const cull_plugin teller = {.descriptor = &descriptor, .get_extension = get_extension}, silent = {.descriptor = &descriptor};

static void add(bench_figures *figures, const cull_figure *list, uint32_t count)
{
    cull_culler culler = {{list, count, 0}};
    chain *c = calloc(1, sizeof *c + 2 * sizeof *c->stages);
    assert_non_null(c);
    c->stage_count = 2;
    c->stages[0] = (chain_stage){.plugin = &teller, .culler = &culler};
    c->stages[1] = (chain_stage){.plugin = &silent};
    figures_add_chain(figures, c);
    free(c);
}

static void zones_are_summed_or_the_largest_counts(void **state)
{
    (void)state;
    static bench_figures all;
    const cull_figure first[] = {{"nodes", 10, CULL_FIGURE_SUM, 0}, {"depth", 7, CULL_FIGURE_MAX, 0}};
    const cull_figure second[] = {{"depth", 5, CULL_FIGURE_MAX, 0}, {"nodes", 32, CULL_FIGURE_SUM, 0}, {"cells", 0, CULL_FIGURE_SUM, 0}};
    add(&all, first, 2);
    add(&all, second, 3);
    assert_int_equal(all.count, 3);
    assert_string_equal(all.list[0].name, "teller.nodes");
    assert_true(all.list[0].value == 42);
    assert_string_equal(all.list[1].name, "teller.depth");
    assert_true(all.list[1].value == 7);
    assert_string_equal(all.list[2].name, "teller.cells");
    assert_true(all.list[2].value == 0);
}

static void what_is_no_word_or_no_number_is_left_out(void **state)
{
    (void)state;
    static bench_figures all;
    const cull_figure bad[] = {{NULL, 1, 0, 0}, {"", 1, 0, 0}, {"two words", 1, 0, 0}, {"quote\"", 1, 0, 0}, {"Large", 1, 0, 0}, {"nan", NAN, 0, 0},
                               {"endless", INFINITY, 0, 0}, {"a_name_that_is_far_too_long_to_be_kept_by_the_bench", 1, 0, 0}, {"good", 1, 0, 0}};
    add(&all, bad, sizeof bad / sizeof *bad);
    assert_int_equal(all.count, 1);
    assert_string_equal(all.list[0].name, "teller.good");
}

static void more_than_there_is_room_for_are_left_out(void **state)
{
    (void)state;
    static bench_figures all;
    static char names[2 * FIGURES_MOST][8];
    cull_figure many[2 * FIGURES_MOST];
    for (uint32_t i = 0; i < 2 * FIGURES_MOST; ++i) {
        snprintf(names[i], sizeof names[i], "n%u", i);
        many[i] = (cull_figure){names[i], i, CULL_FIGURE_SUM, 0};
    }
    add(&all, many, 2 * FIGURES_MOST);
    add(&all, many, 2 * FIGURES_MOST);
    assert_int_equal(all.count, FIGURES_MOST);
    for (uint32_t i = 0; i < FIGURES_MOST; ++i) assert_true(all.list[i].value == 2.0 * i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(zones_are_summed_or_the_largest_counts),
        cmocka_unit_test(what_is_no_word_or_no_number_is_left_out),
        cmocka_unit_test(more_than_there_is_room_for_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
