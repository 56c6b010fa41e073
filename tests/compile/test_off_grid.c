// Maps whose points are not on the grid compile the same in any order and by every turn of the axes: what the weld chooses among
// equal planes and points depends on neither. PORTCULLIS_LONG=1: every turn.
// SPDX-License-Identifier: MIT
#include "input_fixture.h"
#include "map_rewrite.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OFF_GRID_MAPS = 2, COUNTS = 9 };
static const char *const names[OFF_GRID_MAPS] = {"librequake/lqdm7.map", "librequake/lq_e3m4.map"};
static const char *const count_names[COUNTS] = {"rounded", "weld_moves", "polygons_csg", "polygons_merged",
                                               "zones", "sealed", "shells", "portals", "triangles"};

typedef struct outcome {
    uint32_t counts[COUNTS];
    double max_move;
} outcome;

static outcome outcome_of(const char *text, size_t size)
{
    report quiet = {0};
    compile_input *in;
    compile_mesh *mesh;
    compiled_zones *z;
    scene *made;
    csg_counts csg;
    compile_checks checks;
    assert_int_equal(compile_input_map("t.map", text, size, NULL, allocator_heap(), &quiet, &in), RESULT_OK);
    assert_int_equal(compile_csg(in, &quiet, allocator_heap(), &mesh, &csg), RESULT_OK);
    assert_int_equal(compile_zones(in, mesh, PORTALS_DOORS, &quiet, allocator_heap(), &z), RESULT_OK);
    assert_int_equal(compile_items(in, z, &quiet, allocator_heap(), &made, &checks), RESULT_OK);
    const outcome o = {{in->points_rounded, in->weld_moves, csg.polygons_csg, csg.polygons_merged, z->zone_count, z->zones_sealed, z->shells,
                        z->portal_count, checks.triangles},
                       in->max_move};
    assert_int_equal(checks.open_edges + checks.t_junctions_left + checks.degenerate_triangles, 0);
    scene_free(made, allocator_heap());
    compiled_zones_free(z);
    compile_input_free(in);
    return o;
}

static outcome outcome_by(const char *text, size_t size, const map_rewrite *by)
{
    size_t made_size;
    char *made = map_rewritten(text, size, by, &made_size);
    const outcome o = outcome_of(made, made_size);
    free(made);
    return o;
}

static void assert_same(const char *name, const map_rewrite *by, const outcome *a, const outcome *b)
{
    for (int i = 0; i < COUNTS; ++i)
        if (a->counts[i] != b->counts[i])
            fail_msg("%s %s, shuffle %u: %s %u, now %u", name, by->name, by->shuffle, count_names[i], a->counts[i], b->counts[i]);
    assert_true(fabs(a->max_move - b->max_move) < 1e-9); // units: errors of doubles
}

static void the_order_of_brushes_and_faces_off_the_grid_changes_nothing(void **state)
{
    (void)state;
    for (int m = 0; m < OFF_GRID_MAPS; ++m) {
        size_t size;
        char *text = real_map(names[m], &size);
        if (!text) skip();
        map_rewrite by = rewrite_scaled(1);
        const outcome base = outcome_by(text, size, &by);
        assert_true(base.counts[0] > 0 && base.counts[1] > 0);
        static const unsigned shuffles[3] = {SHUFFLE_BRUSHES, SHUFFLE_FACES, SHUFFLE_BRUSHES | SHUFFLE_FACES | SHUFFLE_ENTITIES};
        for (int i = 0; i < 3; ++i) {
            by.shuffle = shuffles[i];
            const outcome other = outcome_by(text, size, &by);
            assert_same(names[m], &by, &base, &other);
        }
        free(text);
    }
}

static void turning_a_map_off_the_grid_by_the_axes_changes_nothing(void **state)
{
    (void)state;
    const int is_long = getenv("PORTCULLIS_LONG") != NULL;
    static const int steps[OFF_GRID_MAPS] = {5, 11};
    for (int m = 0; m < OFF_GRID_MAPS; ++m) {
        size_t size;
        char *text = real_map(names[m], &size);
        if (!text) skip();
        const map_rewrite still = rewrite_scaled(1);
        const outcome base = outcome_by(text, size, &still);
        for (int turn = 1; turn < 48; turn += is_long ? 1 : steps[m]) {
            const map_rewrite by = rewrite_turned(turn);
            const outcome other = outcome_by(text, size, &by);
            assert_same(names[m], &by, &base, &other);
        }
        free(text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_order_of_brushes_and_faces_off_the_grid_changes_nothing),
        cmocka_unit_test(turning_a_map_off_the_grid_by_the_axes_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
