// Quake's maps compile to the same polygons, zones and portals however they are turned, mirrored, moved or ordered. The maps
// are rewritten as text, so all stages from the reader to the scene take part; PORTCULLIS_LONG=1: all maps, every turn.
// SPDX-License-Identifier: MIT
#include "input_fixture.h"
#include "map_print.h"

#include <stdio.h>
#include <stdlib.h>

enum { CHOICES = 3 };
static const portal_choice choices[CHOICES] = {PORTALS_NONE, PORTALS_DOORS, PORTALS_AUTO};
static const char *const choice_names[CHOICES] = {"none", "doors", "auto"};

typedef struct source {
    const char *name;
    char *text;
    size_t size;
} source;

typedef struct compared { // with one rewriting
    const source *map;
    const map_rewrite *base;
    map_print prints[CHOICES];
} compared;

static int is_long(void)
{
    return getenv("PORTCULLIS_LONG") != NULL;
}

static map_print print_of(const source *map, const map_rewrite *by, portal_choice choice)
{
    size_t size;
    char *text = map_rewritten(map->text, map->size, by, &size);
    const map_print p = map_print_of(text, size, by, choice);
    free(text);
    return p;
}

static compared base_of(const source *map, const map_rewrite *by)
{
    compared c = {.map = map, .base = by};
    for (int i = 0; i < CHOICES; ++i) c.prints[i] = print_of(map, by, choices[i]);
    return c;
}

static void free_base(compared *c)
{
    for (int i = 0; i < CHOICES; ++i) map_print_free(&c->prints[i]);
}

static void assert_same(const compared *c, const map_rewrite *by, print_depth depth)
{
    static const double weld_units = 1.0 / 32;
    // Rounded, one that stood in the plane between two automatic rooms stands in one of them.
    const int count = by->points == POINTS_ROUNDED ? CHOICES - 1 : CHOICES;
    for (int i = 0; i < count; ++i) {
        char words[DIFFERENCES_BYTES];
        map_print p = print_of(c->map, by, choices[i]);
        if (map_print_differences(&c->prints[i], &p, depth, words))
            fail_msg("%s %s, portals %s:%s", c->map->name, by->name, choice_names[i], words);
        if (by->points == POINTS_ROUNDED)
            print_message("%s %s: %u faces welded, at most %.4f units\n", c->map->name, by->name, p.counts.weld_moves, p.max_move);
        assert_true(p.max_move <= weld_units);
        map_print_free(&p);
    }
}

// In the short tier the first map alone.
static void for_each_map(void (*check)(const source *map))
{
    for (int i = 0; i < (is_long() ? ID_MAPS : 1); ++i) {
        source map = {.name = real_map_names[i]};
        map.text = real_map(map.name, &map.size);
        if (!map.text) skip();
        check(&map);
        free(map.text);
    }
}

// ---- Checks of one map ----

static void check_turns(const source *map)
{
    const map_rewrite still = rewrite_scaled(1);
    compared base = base_of(map, &still);
    for (int i = 1; i < 48; i += is_long() ? 1 : 6) {
        const map_rewrite by = rewrite_turned(i);
        assert_same(&base, &by, PRINT_ALL);
    }
    free_base(&base);
}

static void check_slanted(const source *map)
{
    for (int i = 0; i < SLANTED_TURNS; ++i) {
        const map_rewrite by = rewrite_slanted(i), larger = rewrite_scaled(by.scale);
        compared base = base_of(map, &larger);
        assert_same(&base, &by, PRINT_ALL);
        free_base(&base);
    }
}

static void check_moves(const source *map)
{
    static const int moves[3][3] = {{1, 0, 0}, {1001, -703, 300}, {-4096, 8191, 12345}};
    const map_rewrite still = rewrite_scaled(1);
    compared base = base_of(map, &still);
    for (int i = 0; i < (is_long() ? 3 : 2); ++i) {
        map_rewrite by = still;
        by.name = "moved";
        for (int k = 0; k < 3; ++k) by.move[k] = moves[i][k];
        assert_same(&base, &by, PRINT_ALL);
    }
    free_base(&base);
}

static void check_orders(const source *map)
{
    const map_rewrite still = rewrite_scaled(1);
    compared base = base_of(map, &still);
    for (unsigned shuffle = 1; shuffle < 8; shuffle += is_long() ? 1 : 3) {
        map_rewrite by = still;
        by.name = "in another order";
        by.shuffle = shuffle;
        assert_same(&base, &by, PRINT_ALL);
    }
    free_base(&base);
}

static void compare_rounded(const source *map, print_depth depth)
{
    map_rewrite still = rewrite_scaled(1);
    still.points = POINTS_ROUNDED;
    compared base = base_of(map, &still);
    for (int i = 0; i < SLANTED_TURNS; ++i) {
        map_rewrite by = rewrite_slanted(i);
        by.points = POINTS_ROUNDED;
        assert_same(&base, &by, depth);
    }
    free_base(&base);
}

static void check_rounded(const source *map)
{
    compare_rounded(map, PRINT_CHECKS);
}

static void check_rounded_zones(const source *map)
{
    compare_rounded(map, PRINT_ZONES);
}

// By a quaternion of up to 1290 squared, for the sum of its turn's products; none of these angles is that of a small triangle.
static map_rewrite rewrite_by(const char *name, const int q[4])
{
    const int w = q[0], *v = q + 1, size = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    map_rewrite r = {.name = name, .scale = w * w + size, .points = POINTS_ROUNDED};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const int turned = i == j ? w * w - size : (j == (i + 2) % 3 ? 1 : -1) * 2 * w * v[3 - i - j];
            r.turn[i][j] = 2 * v[i] * v[j] + turned;
        }
    return r;
}

static void check_any_angle(const source *map)
{
    static const int turns[4][4] = {{29, 0, 0, 8}, {31, 6, 0, 0}, {19, 17, -20, 9}, {34, 1, -1, 0}};
    static const char *const names[4] = {"30.8 degrees about z", "21.9 degrees about x", "111 degrees about no axis", "4.8 degrees about x and y"};
    map_rewrite still = rewrite_scaled(1);
    still.points = POINTS_ROUNDED;
    compared base = base_of(map, &still);
    for (int i = 0; i < 4; ++i) {
        map_rewrite by = rewrite_by(names[i], turns[i]);
        by.move[i % 3] = i * 37;
        assert_same(&base, &by, PRINT_ZONES);
    }
    free_base(&base);
}

// ---- Tests ----

static void the_slanted_turns_are_rotations_of_rational_numbers(void **state)
{
    (void)state;
    for (int number = 0; number < SLANTED_TURNS; ++number) {
        const map_rewrite by = rewrite_slanted(number);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                int product = 0;
                for (int k = 0; k < 3; ++k) product += by.turn[i][k] * by.turn[j][k];
                assert_int_equal(product, i == j ? by.scale * by.scale : 0);
            }
        assert_false(rewrite_is_mirrored(&by));
    }
}

static void turns_by_axes_and_mirrors_are_48_different_ones(void **state)
{
    (void)state;
    for (int i = 0; i < 48; ++i) {
        const map_rewrite a = rewrite_turned(i);
        assert_int_equal(rewrite_is_mirrored(&a), i >= 24);
        for (int j = 0; j < i; ++j) {
            const map_rewrite b = rewrite_turned(j);
            assert_memory_not_equal(a.turn, b.turn, sizeof a.turn);
        }
    }
}

static void turning_by_the_axes_or_mirroring_a_map_changes_nothing(void **state)
{
    (void)state;
    for_each_map(check_turns);
}

static void turning_a_map_by_any_exact_rotation_changes_nothing(void **state)
{
    (void)state;
    for_each_map(check_slanted);
}

static void moving_a_map_changes_nothing(void **state)
{
    (void)state;
    for_each_map(check_moves);
}

static void the_order_of_brushes_faces_and_entities_changes_nothing(void **state)
{
    (void)state;
    for_each_map(check_orders);
}

static void maps_turned_and_rounded_to_the_grid_compile_soundly_within_the_weld(void **state)
{
    (void)state;
    for_each_map(check_rounded);
}

static void maps_turned_and_rounded_to_the_grid_keep_their_zones(void **state)
{
    (void)state;
    for_each_map(check_rounded_zones);
}

static void maps_turned_by_any_angle_and_rounded_keep_their_zones(void **state)
{
    (void)state;
    for_each_map(check_any_angle);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_slanted_turns_are_rotations_of_rational_numbers),
        cmocka_unit_test(turns_by_axes_and_mirrors_are_48_different_ones),
        cmocka_unit_test(turning_by_the_axes_or_mirroring_a_map_changes_nothing),
        cmocka_unit_test(turning_a_map_by_any_exact_rotation_changes_nothing),
        cmocka_unit_test(moving_a_map_changes_nothing),
        cmocka_unit_test(the_order_of_brushes_faces_and_entities_changes_nothing),
        cmocka_unit_test(maps_turned_and_rounded_to_the_grid_compile_soundly_within_the_weld),
        cmocka_unit_test(maps_turned_and_rounded_to_the_grid_keep_their_zones),
        cmocka_unit_test(maps_turned_by_any_angle_and_rounded_keep_their_zones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
