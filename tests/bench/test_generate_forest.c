// Tests of `generate forest` and of the flagship's woods: as many triangles as asked for, a larger one begins as a smaller one, ground without cracks.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "bench/generate.h"
#include "obj_probe.h"
#include "tests/common/scratch_folder.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct wish { const char *kind, *file, *read; uint64_t size, seed; } wish; // read: the file looked at

static char *text_of(const wish *q, size_t *size)
{
    scratch_folder folder;
    char path[512], read[512];
    report r = report_to_stderr();
    scratch_folder_make(&folder);
    scratch_folder_name(&folder, q->file, path, sizeof path);
    scratch_folder_name(&folder, q->read, read, sizeof read);
    assert_int_equal(generate_scene(q->kind, q->size, q->seed, path, allocator_heap(), &r), RESULT_OK);
    char *text = bytes_of_file(read, size);
    assert_non_null(text);
    scratch_folder_remove(&folder);
    return text;
}

static char *forest_text(uint64_t triangles, uint64_t seed, size_t *size)
{
    return text_of(&(wish){"forest", "forest.obj", "forest.obj", triangles, seed}, size);
}

static uint64_t triangle_count(const char *text)
{
    uint64_t count = 0;
    for (const char *line = text; line; line = strchr(line + 1, '\n')) {
        if (strncmp(line, "\nf ", 3) != 0) continue;
        uint64_t corners = 0;
        for (const char *c = line + 2; *c != '\n' && *c; ++c) corners += *c == ' ';
        count += corners - 2;
    }
    return count;
}

static void a_forest_has_as_many_triangles_as_asked_for_and_never_more(void **state)
{
    (void)state;
    static const uint64_t sizes[] = {1000, 4321, 50000, 200000};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i)
        for (uint64_t seed = 1; seed < 4; ++seed) {
            size_t bytes;
            char *text = forest_text(sizes[i], seed, &bytes);
            const uint64_t count = triangle_count(text);
            assert_in_range(count, sizes[i] - 600, sizes[i]);
            free(text);
        }
}

static void a_larger_forest_begins_as_a_smaller_one_and_a_seed_says_all_of_it(void **state)
{
    (void)state;
    size_t small_size, large_size, again_size, other_size;
    char *small = forest_text(40000, 7, &small_size), *large = forest_text(90000, 7, &large_size), *again = forest_text(40000, 7, &again_size),
         *other = forest_text(40000, 8, &other_size);
    assert_int_equal(small_size, again_size);
    assert_memory_equal(small, again, small_size);
    assert_true(other_size != small_size || memcmp(small, other, small_size) != 0);
    size_t same = 0;
    while (same < small_size && small[same] == large[same]) ++same;
    assert_true(same > small_size * 8 / 10); // all but the block where the smaller one ends
    free(small);
    free(large);
    free(again);
    free(other);
}

// Ground corners lie every 8 m: where blocks meet both say the same height.
static void blocks_of_ground_meet_without_cracks(void **state)
{
    (void)state;
    enum { ACROSS = 101, MIDDLE = 50 };
    static double heights[ACROSS][ACROSS];
    size_t size;
    uint32_t met = 0, is_ground = 0;
    char *text = forest_text(100000, 2, &size);
    for (int z = 0; z < ACROSS; ++z)
        for (int x = 0; x < ACROSS; ++x) heights[z][x] = INFINITY;
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        double x, y, z;
        if (strncmp(line, "o ", 2) == 0) is_ground = strcmp(line, "o ground") == 0;
        if (!is_ground || sscanf(line, "v %lf %lf %lf", &x, &y, &z) != 3) continue;
        assert_true(fmod(x, 8) == 0 && fmod(z, 8) == 0);
        double *at = &heights[MIDDLE + (int)(z / 8)][MIDDLE + (int)(x / 8)];
        met += !isinf(*at);
        assert_true(isinf(*at) || *at == y);
        *at = y;
    }
    assert_true(met > 40);
    free(text);
}

static void the_flagship_goes_on_to_the_horizon_that_was_asked_for(void **state)
{
    (void)state;
    size_t usual_size, wide_size;
    char *usual = text_of(&(wish){"flagship", "f.json", "f.obj", GENERATE_SIZE_OF_KIND, 1}, &usual_size), *wide = text_of(&(wish){"flagship", "f.json", "f.obj", 500, 1}, &wide_size);
    assert_null(strstr(usual, "\no wood_0\n"));
    assert_non_null(strstr(wide, "\no wood_0\n"));
    assert_true(triangle_count(wide) > triangle_count(usual) + 50000);
    double most = 0;
    for (char *line = strtok(wide, "\n"); line; line = strtok(NULL, "\n")) {
        double x, y, z;
        if (sscanf(line, "v %lf %lf %lf", &x, &y, &z) == 3) most = fmax(most, fmax(fabs(x), fabs(z)));
    }
    assert_true(most >= 500 && most < 510); // a crown reaches over the edge
    free(usual);
    free(wide);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_forest_has_as_many_triangles_as_asked_for_and_never_more),
        cmocka_unit_test(a_larger_forest_begins_as_a_smaller_one_and_a_seed_says_all_of_it),
        cmocka_unit_test(blocks_of_ground_meet_without_cracks),
        cmocka_unit_test(the_flagship_goes_on_to_the_horizon_that_was_asked_for),
    };
    return cmocka_run_group_tests_name("forest", tests, NULL, NULL);
}
