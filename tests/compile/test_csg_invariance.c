// The surface of real maps does not depend on how they are turned, moved or ordered, and it is closed.
// SPDX-License-Identifier: MIT
#include "tests/common/random.h"
#include "tests/common/test.h"

#include "csg_fixture.h"

#include <stdlib.h>
#include <string.h>

typedef struct base_surface {
    compile_input *in;
    compile_mesh *mesh;
    csg_counts counts;
    uint64_t *prints;
} base_surface;

static const map_turn still = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1, {0, 0, 0}};

static int open_base(base_surface *b, const char *name)
{
    b->in = real_map(name, 256);
    if (!b->in) return 0;
    b->mesh = surface_of(b->in, &b->counts);
    b->prints = polygon_prints(b->mesh, &still);
    return 1;
}

static void close_base(base_surface *b)
{
    free(b->prints);
    compile_mesh_free(b->mesh);
    compile_input_free(b->in);
}

static void assert_turned_same(const base_surface *base, const compile_input *from, const map_turn *by, const uint32_t *order)
{
    scene_draft draft;
    const compile_input in = turned_input(from, by, order, &draft);
    csg_counts counts;
    compile_mesh *mesh = surface_of(&in, &counts);
    uint64_t *prints = polygon_prints(mesh, by);
    assert_int_equal(counts.polygons_in, base->counts.polygons_in);
    assert_int_equal(counts.polygons_csg, base->counts.polygons_csg);
    assert_int_equal(counts.polygons_merged, base->counts.polygons_merged);
    assert_memory_equal(prints, base->prints, mesh->polygon_count * sizeof *prints);
    free(prints);
    compile_mesh_free(mesh);
    draft_free(&draft);
}

static void assert_same_surface(const base_surface *base, const map_turn *by, const uint32_t *order)
{
    assert_turned_same(base, base->in, by, order);
}

static void test_rotations_and_mirrors_keep_every_polygon(void **state)
{
    (void)state;
    for (int map = 0; map < 8; ++map) {
        base_surface base;
        if (!open_base(&base, real_maps[map])) skip();
        const int step = map == 0 || map == 4 ? 1 : 5; // all 48 of the small ones
        for (int turn = 1; turn < 48; turn += step) {
            const map_turn by = turn_number(turn);
            assert_same_surface(&base, &by, NULL);
        }
        close_base(&base);
    }
}

// Rotations of rational numbers, of maps on whole units made 5 or 25 times larger so that every point stays whole.
static void test_slanted_rotations_keep_every_polygon(void **state)
{
    (void)state;
    static const map_turn turns[2] = {{{{3, -4, 0}, {4, 3, 0}, {0, 0, 5}}, 5, {0}}, {{{-15, 0, 20}, {12, 20, 9}, {-16, 15, -12}}, 25, {0}}};
    for (int map = 0; map < 4; ++map)
        for (int t = 0; t < 2; ++t) {
            compile_input *whole = real_map(real_maps[map], 1);
            if (!whole) skip();
            const int s = turns[t].scale;
            const map_turn larger = {{{s, 0, 0}, {0, s, 0}, {0, 0, s}}, s, {0}};
            scene_draft draft;
            compile_input in = turned_input(whole, &larger, NULL, &draft);
            base_surface base = {.in = &in};
            base.mesh = surface_of(&in, &base.counts);
            base.prints = polygon_prints(base.mesh, &larger);
            assert_turned_same(&base, whole, &turns[t], NULL);
            free(base.prints);
            compile_mesh_free(base.mesh);
            draft_free(&draft);
            compile_input_free(whole);
        }
}

static void test_moves_keep_every_polygon(void **state)
{
    (void)state;
    for (int map = 0; map < 8; map += 3) {
        base_surface base;
        if (!open_base(&base, real_maps[map])) skip();
        map_turn by = still;
        by.move[0] = 1001;
        by.move[1] = -700003;
        by.move[2] = 300 * 256;
        assert_same_surface(&base, &by, NULL);
        close_base(&base);
    }
}

static void test_any_order_of_brushes_keeps_every_polygon(void **state)
{
    (void)state;
    uint64_t seed = 4;
    for (int map = 0; map < 8; ++map) {
        base_surface base;
        if (!open_base(&base, real_maps[map])) skip();
        uint32_t *order = malloc(base.in->brush_count * sizeof *order);
        assert_non_null(order);
        for (int round = 0; round < 3; ++round) {
            for (uint32_t i = 0; i < base.in->brush_count; ++i) order[i] = i;
            for (uint32_t i = base.in->brush_count; i > 1; --i) {
                const uint32_t j = random_below(&seed, i), t = order[i - 1];
                order[i - 1] = order[j];
                order[j] = t;
            }
            assert_same_surface(&base, &still, order);
        }
        free(order);
        close_base(&base);
    }
}

static void test_the_surface_of_every_real_map_is_closed(void **state)
{
    (void)state;
    for (int map = 0; map < 8; ++map) {
        base_surface base;
        if (!open_base(&base, real_maps[map])) skip();
        mpq_t volume, area[3];
        mpq_init(volume);
        for (int k = 0; k < 3; ++k) mpq_init(area[k]);
        mesh_measures(base.in, base.mesh, volume, area);
        for (int k = 0; k < 3; ++k) assert_int_equal(mpq_sgn(area[k]), 0);
        assert_true(mpq_sgn(volume) > 0);
        for (int k = 0; k < 3; ++k) mpq_clear(area[k]);
        mpq_clear(volume);
        close_base(&base);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rotations_and_mirrors_keep_every_polygon),
        cmocka_unit_test(test_slanted_rotations_keep_every_polygon),
        cmocka_unit_test(test_moves_keep_every_polygon),
        cmocka_unit_test(test_any_order_of_brushes_keeps_every_polygon),
        cmocka_unit_test(test_the_surface_of_every_real_map_is_closed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
