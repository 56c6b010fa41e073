// Tests of the scene builder: what it refuses, how it rounds, and that moving a scene by whole metres changes nothing.
// SPDX-License-Identifier: MIT
#include "box_scene.h"
#include "builder_fixture.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <float.h>
#include <math.h>
#include <string.h>

static void an_item_with_a_wrong_number_is_refused_and_leaves_nothing(void **state)
{
    builder_fixture *f = *state;
    const double at[3] = {0, 0, 0};
    builder_fixture_triangle(f, at, 1);
    static const uint32_t good[3] = {0, 1, 2}, wild[3] = {0, 1, 3}, huge[3] = {0, UINT32_MAX, 2}, two = 2, sums[2] = {UINT32_MAX, 2};
    const builder_item bad[] = {
        {.indices = wild, .index_count = 3, .polygon_count = 1},
        {.indices = huge, .index_count = 3, .polygon_count = 1},
        {.indices = good, .index_count = 0, .polygon_count = 1},
        {.indices = good, .index_count = 2, .polygon_count = 1},
        {.indices = good, .index_count = 3, .polygon_count = 0},
        {.indices = good, .index_count = 3, .polygon_count = 2},
        {.indices = good, .index_count = 3, .polygon_count = 1, .polygon_triangles = &two},
        {.indices = good, .index_count = 3, .polygon_count = 2, .polygon_triangles = sums}, // 1 in 32 bits
        {.indices = good, .index_count = 3, .polygon_count = 1, .material = 1},
        {.indices = good, .index_count = 3, .polygon_count = 1, .object = 1},
        {.indices = good, .index_count = 3, .polygon_count = 1, .flags = CULL_ITEM_WALL, .plane = {0, 0, 1, 0}},
        {.indices = good, .index_count = 3, .polygon_count = 1, .flags = CULL_ITEM_WALL, .loop = wild, .loop_count = 3, .plane = {0, 0, 1, 0}},
        {.indices = good, .index_count = 3, .polygon_count = 1, .flags = CULL_ITEM_WALL, .loop = good, .loop_count = 3, .plane = {0, NAN, 1, 0}},
        {.indices = good, .index_count = 3, .polygon_count = 1, .flags = CULL_ITEM_WALL, .loop = good, .loop_count = 3, .plane = {0, 0, 1, INFINITY}},
    };
    static const double shut[3] = {0, 0, 0};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        assert_int_equal(scene_builder_item(f->builder, &bad[i]), RESULT_BAD_INPUT);
        assert_int_equal(scene_builder_mover(f->builder, "door", shut, &bad[i]), RESULT_BAD_INPUT);
    }
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->scene->item_count, 1);
    assert_int_equal(f->scene->mover_count, 0);
    assert_int_equal(f->scene->index_count, 3);
}

static void vertices_that_are_not_finite_are_refused_and_leave_nothing(void **state)
{
    builder_fixture *f = *state;
    const double bad[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 9; ++k) {
        builder_vertex v[2] = {{.position = {1e6, 1e6, 1e6}}, {.position = {0, 0, 0}}};
        v[1].position[k % 3] = bad[k / 3];
        uint32_t first;
        assert_int_equal(scene_builder_vertices(f->builder, v, 2, 0, &first), RESULT_BAD_INPUT);
    }
    const double at[3] = {0, 0, 0};
    builder_fixture_triangle(f, at, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_int_equal(f->scene->position_count, 3);
    assert_true(f->scene->whole.radius <= 1);
}

static void vertices_of_an_unknown_material_are_refused(void **state)
{
    builder_fixture *f = *state;
    const builder_vertex v = {.position = {0, 0, 0}};
    uint32_t first;
    assert_int_equal(scene_builder_vertices(f->builder, &v, 1, 1, &first), RESULT_BAD_INPUT);
    assert_int_equal(scene_builder_material_colour(f->builder, 1, 0), RESULT_BAD_INPUT);
    assert_int_equal(scene_builder_material_colour(f->builder, 0, 0), RESULT_OK);
    assert_int_equal(scene_builder_vertices(f->builder, &v, 0, 0, &first), RESULT_OK);
}

static void an_empty_scene_is_refused(void **state)
{
    builder_fixture *f = *state;
    builder_fixture_vertex(f, 0, 0, 0);
    assert_int_equal(builder_fixture_finish(f), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "test.scene: error: no polygon to draw"));
    assert_null(f->scene);
}

static void a_scene_wider_than_32768_m_is_refused_and_one_of_it_is_not(void **state)
{
    builder_fixture *f = *state;
    const double low[3] = {-16384, 0, 0}, high[3] = {16383, 0, 0}, over[3] = {16384, 0, 0};
    builder_fixture_triangle(f, low, 1);
    builder_fixture_triangle(f, high, 1);
    assert_int_equal(builder_fixture_finish(f), RESULT_OK);
    assert_true(f->scene->step == 1.0 / 1024); // just under 1 mm, as promised
    assert_true(f->scene->whole.radius == 16384);
    scene_free(f->scene, &f->memory.memory);
    f->scene = NULL;
    builder_fixture_triangle(f, over, 3);
    assert_int_equal(builder_fixture_finish(f), RESULT_BAD_INPUT);
    assert_true(report_lines_is_one_with(&f->lines, "test.scene: error: the scene is 32772 m wide; one zone holds 32,768 m"));
}

static void a_coordinate_beyond_1e9_m_is_refused_on_every_axis_and_side(void **state)
{
    builder_fixture *f = *state;
    for (int k = 0; k < 6; ++k) {
        builder_fixture_restart(f);
        double at[3] = {0, 0, 0};
        at[k / 2] = k % 2 ? 1e300 : -1.1e9;
        builder_fixture_triangle(f, at, 1);
        assert_int_equal(builder_fixture_finish(f), RESULT_BAD_INPUT);
        assert_true(report_lines_is_one_with(&f->lines, "beyond 1e9 m"));
    }
}

static int is_multiple(double value, double step)
{
    return value / step == nearbyint(value / step);
}

static void every_position_is_a_step_s_multiple_within_half_a_step_of_the_true_one(void **state)
{
    builder_fixture *f = *state;
    enum { VERTICES = 3000 };
    static const double sizes[] = {1e-30, 1e-12, 1e-4, 0.3, 1, 50, 1000, 16000};
    static const double places[] = {0, -7.3, 85000.25, 123456789.5};
    static double truth[VERTICES][3];
    for (size_t n = 0; n < sizeof sizes / sizeof *sizes * sizeof places / sizeof *places; ++n) {
        const double size = sizes[n % (sizeof sizes / sizeof *sizes)], place = places[n / (sizeof sizes / sizeof *sizes)];
        builder_fixture_restart(f);
        uint64_t random = n;
        for (uint32_t i = 0; i < VERTICES; i += 3) {
            for (uint32_t c = 0; c < 3; ++c) {
                for (int k = 0; k < 3; ++k) truth[i + c][k] = place + random_between(&random, -size, size);
                builder_fixture_vertex(f, truth[i + c][0], truth[i + c][1], truth[i + c][2]);
            }
            const uint32_t indices[3] = {i, i + 1, i + 2};
            const builder_item item = {.indices = indices, .index_count = 3, .polygon_count = 1};
            assert_int_equal(scene_builder_item(f->builder, &item), RESULT_OK);
        }
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        const scene *s = f->scene;
        int exponent;
        assert_true(frexp(s->step, &exponent) == 0.5);
        for (uint32_t i = 0; i < VERTICES; ++i) {
            const float p[3] = {s->positions[i].x, s->positions[i].y, s->positions[i].z};
            for (int k = 0; k < 3; ++k) {
                assert_true(is_multiple((double)p[k], s->step));
                assert_true(fabs((double)p[k] - (truth[i][k] - s->whole.origin[k])) <= s->step / 2);
                assert_true(fabsf(p[k]) <= s->whole.radius);
            }
        }
        assert_true((double)s->whole.radius <= s->step * 16777216); // exact in float
        if (s->step > 1e-19) assert_true((double)s->whole.radius >= s->step * 8388607); // and no coarser than it must be
    }
}

static void a_scene_of_one_point_or_of_denormals_is_finite(void **state)
{
    builder_fixture *f = *state;
    static const double sizes[] = {0, DBL_MIN, 5e-324, 1e-310, 1e-200, 1e-45};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        builder_fixture_restart(f);
        const double at[3] = {0, 0, 0};
        builder_fixture_triangle(f, at, sizes[i]);
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        for (uint32_t v = 0; v < 3; ++v) assert_true(isfinite(f->scene->positions[v].x) && isfinite(f->scene->positions[v].y));
        assert_true(isfinite(f->scene->step) && f->scene->step > 0);
        assert_int_equal(f->scene->flat_triangles, 1);
    }
}

static void assert_same_arrays(const scene *a, const scene *b)
{
    const size_t items = (size_t)a->item_count + a->mover_count;
    assert_int_equal(a->item_count, b->item_count);
    assert_int_equal(a->mover_count, b->mover_count);
    assert_int_equal(a->position_count, b->position_count);
    assert_true(a->step == b->step);
    assert_memory_equal(a->positions, b->positions, a->position_count * sizeof *a->positions);
    assert_memory_equal(a->indices, b->indices, a->index_count * sizeof *a->indices);
    assert_memory_equal(a->items, b->items, items * sizeof *a->items);
    assert_memory_equal(a->boxes.min_x, b->boxes.min_x, items * sizeof(float));
    assert_memory_equal(a->boxes.max_z, b->boxes.max_z, items * sizeof(float));
    assert_memory_equal(&a->whole.box, &b->whole.box, sizeof a->whole.box);
    assert_true(a->hash == b->hash);
}

static void moving_a_scene_by_whole_metres_changes_nothing_but_its_origin(void **state)
{
    builder_fixture *f = *state;
    static const double moves[][3] = {{85000, 0, 446000}, {1, 1, 1}, {-1, 2, -3}, {1e6 + 1, -1e6, 7}, {99999999, -99999999, 12345677}};
    for (uint64_t seed = 0; seed < 6; ++seed) {
        box_scene boxes = {.items = 200, .movers = 5, .seed = seed};
        scene *still, *moved;
        assert_int_equal(box_scene_make(&boxes, &f->memory.memory, &f->lines.report, &still), RESULT_OK);
        for (size_t m = 0; m < sizeof moves / sizeof *moves; ++m) {
            memcpy(boxes.at, moves[m], sizeof boxes.at);
            assert_int_equal(box_scene_make(&boxes, &f->memory.memory, &f->lines.report, &moved), RESULT_OK);
            for (int k = 0; k < 3; ++k) assert_true(moved->whole.origin[k] - still->whole.origin[k] == moves[m][k]);
            assert_same_arrays(still, moved);
            scene_free(moved, &f->memory.memory);
        }
        scene_free(still, &f->memory.memory);
    }
}

static void a_middle_at_half_a_metre_rounds_alike_wherever_the_scene_lies(void **state)
{
    builder_fixture *f = *state;
    uint64_t hash = 0;
    for (int i = 0; i < 8; ++i) {
        builder_fixture_restart(f);
        const double low[3] = {i - 4, i - 4, i - 4}, high[3] = {i - 3, i - 3, i - 3}; // the middle is at i - 3.5
        assert_int_equal(box_scene_add(f->builder, low, high, NULL), RESULT_OK);
        assert_int_equal(builder_fixture_finish(f), RESULT_OK);
        if (i > 0) assert_true(f->scene->hash == hash);
        hash = f->scene->hash;
    }
}

int main(void)
{
#define TEST(t) cmocka_unit_test_setup_teardown(t, builder_fixture_set_up, builder_fixture_tear_down)
    const struct CMUnitTest tests[] = {
        TEST(an_item_with_a_wrong_number_is_refused_and_leaves_nothing),
        TEST(vertices_that_are_not_finite_are_refused_and_leave_nothing),
        TEST(vertices_of_an_unknown_material_are_refused),
        TEST(an_empty_scene_is_refused),
        TEST(a_scene_wider_than_32768_m_is_refused_and_one_of_it_is_not),
        TEST(a_coordinate_beyond_1e9_m_is_refused_on_every_axis_and_side),
        TEST(every_position_is_a_step_s_multiple_within_half_a_step_of_the_true_one),
        TEST(a_scene_of_one_point_or_of_denormals_is_finite),
        TEST(moving_a_scene_by_whole_metres_changes_nothing_but_its_origin),
        TEST(a_middle_at_half_a_metre_rounds_alike_wherever_the_scene_lies),
    };
    return cmocka_run_group_tests_name("core scene", tests, NULL, NULL);
}
