// Tests of `generate terrain`: as many tiles as asked for, that meet without cracks, flat beside their width.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "bench/generate.h"
#include "tests/bench/obj_probe.h"
#include "tests/common/scratch_folder.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TILES = 36, ACROSS = 6, CELLS = 8, CORNERS = ACROSS * CELLS + 1 };

static char *terrain_text(uint64_t tiles, uint64_t seed, size_t *size)
{
    scratch_folder folder;
    char path[512];
    report r = report_to_stderr();
    scratch_folder_make(&folder);
    scratch_folder_name(&folder, "terrain.obj", path, sizeof path);
    assert_int_equal(generate_scene("terrain", tiles, seed, path, allocator_heap(), &r), RESULT_OK);
    char *text = bytes_of_file(path, size);
    assert_non_null(text);
    scratch_folder_remove(&folder);
    return text;
}

static void tiles_meet_without_cracks_and_are_flat_beside_their_width(void **state)
{
    (void)state;
    static double heights[CORNERS][CORNERS];
    size_t size;
    char *text = terrain_text(TILES, 3, &size);
    uint32_t tiles = 0, triangles = 0;
    double low = INFINITY, high = -INFINITY;
    for (int z = 0; z < CORNERS; z++)
        for (int x = 0; x < CORNERS; x++) heights[z][x] = INFINITY;
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        double x, y, z;
        tiles += strncmp(line, "o ", 2) == 0;
        triangles += strncmp(line, "f ", 2) == 0;
        if (sscanf(line, "v %lf %lf %lf", &x, &y, &z) != 3) continue;
        double *at = &heights[(int)(z / 6)][(int)(x / 6)];
        assert_true(isinf(*at) || *at == y);
        *at = y;
        low = fmin(low, y);
        high = fmax(high, y);
    }
    assert_int_equal(tiles, TILES);
    assert_int_equal(triangles, 2u * TILES * CELLS * CELLS);
    for (int z = 0; z < CORNERS; z++)
        for (int x = 0; x < CORNERS; x++) assert_true(!isinf(heights[z][x]));
    assert_true(low >= 0 && high - low > 10 && high - low < 150);
    free(text);
}

static void a_seed_says_all_of_it(void **state)
{
    (void)state;
    size_t sizes[3];
    char *texts[3];
    for (int i = 0; i < 3; i++) texts[i] = terrain_text(9, i == 2 ? 5 : 4, &sizes[i]);
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(texts[0], texts[1], sizes[0]);
    assert_true(sizes[2] != sizes[0] || memcmp(texts[0], texts[2], sizes[0]) != 0);
    for (int i = 0; i < 3; i++) free(texts[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_meet_without_cracks_and_are_flat_beside_their_width),
        cmocka_unit_test(a_seed_says_all_of_it),
    };
    return cmocka_run_group_tests_name("terrain", tests, NULL, NULL);
}
