// The CSG against cells: random boxes that touch, overlap and share planes, added and subtracted in any order.
// SPDX-License-Identifier: MIT
#include "tests/common/failing_allocator.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include "csg_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = 12, CELL = 2 }; // cells along an axis, and steps in a cell: its centre is a whole step

typedef struct box { int32_t min[3], max[3]; brush_kind kind; uint32_t material; } box;

typedef struct case_boxes { box boxes[40]; uint32_t count; } case_boxes;

static case_boxes random_boxes(uint64_t *seed, uint32_t count, uint32_t subtracts_of_8)
{
    case_boxes c = {.count = count};
    for (uint32_t b = 0; b < count; ++b) {
        box *x = &c.boxes[b];
        x->kind = random_below(seed, 8) < subtracts_of_8 ? BRUSH_SUBTRACT : BRUSH_ADD;
        x->material = x->kind == BRUSH_SUBTRACT ? 2 : random_below(seed, 2); // merges stay within one kind
        for (int k = 0; k < 3; ++k) {
            const int32_t low = (int32_t)random_below(seed, SIDE - 2), size = 1 + (int32_t)random_below(seed, (uint32_t)(SIDE - 1 - low));
            x->min[k] = CELL * low;
            x->max[k] = CELL * (low + (size > 6 ? size / 2 : size));
        }
    }
    return c;
}

// The last of the first `count` boxes that holds the cell; UINT32_MAX: none.
static uint32_t owner_of(const case_boxes *c, const int cell[3], uint32_t count)
{
    for (uint32_t b = count; b-- > 0;) {
        int inside = 1;
        for (int k = 0; k < 3; ++k) inside &= CELL * cell[k] >= c->boxes[b].min[k] && CELL * (cell[k] + 1) <= c->boxes[b].max[k];
        if (inside) return b;
    }
    return UINT32_MAX;
}

static int is_solid(const case_boxes *c, uint32_t owner)
{
    return owner != UINT32_MAX && c->boxes[owner].kind == BRUSH_ADD;
}

// The box that last made the border between the two cells, box by box.
static uint32_t maker_of(const case_boxes *c, const int solid[3], const int air[3])
{
    uint32_t maker = 0;
    int before = 0;
    for (uint32_t b = 0; b < c->count; ++b) {
        const int border = is_solid(c, owner_of(c, solid, b + 1)) && !is_solid(c, owner_of(c, air, b + 1));
        if (border && !before) maker = b;
        before = border;
    }
    return maker;
}

// Axis-aligned loops: does the polygon's box, and a rectangle's is itself, hold the centre of the cell's face?
static int covers(const compile_mesh *m, const compile_polygon *p, const double at[3])
{
    for (int k = 0; k < 3; ++k) {
        double low = 1e30, high = -1e30;
        for (uint32_t i = 0; i < p->vertex_count; ++i) {
            const double x = m->vertices[m->loop[p->first_vertex + i]].position[k];
            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        if (at[k] < low || at[k] > high) return 0;
    }
    return 1;
}

// Polygons whose front is towards +axis (way 1) or -axis and that hold the point; the last one's brush into *brush.
static int count_covering(const compile_input *in, const compile_mesh *m, int axis, int way, const double at[3], uint32_t *brush)
{
    int count = 0;
    for (uint32_t p = 0; p < m->polygon_count; ++p) {
        const cull_wide_plane plane = plane_table_get(in->planes, m->polygons[p].plane);
        if (plane.normal[axis] * way <= 0 || !covers(m, &m->polygons[p], at)) continue;
        *brush = m->polygons[p].brush;
        ++count;
    }
    return count;
}

static void check_border(const compile_input *in, const compile_mesh *m, const case_boxes *c, const int cell[3], int axis)
{
    int next[3] = {cell[0], cell[1], cell[2]};
    next[axis]++;
    const int low = is_solid(c, owner_of(c, cell, c->count)), high = is_solid(c, owner_of(c, next, c->count));
    double at[3];
    for (int k = 0; k < 3; ++k) at[k] = CELL * (cell[k] + (k == axis ? 1 : 0.5));
    for (int way = -1; way <= 1; way += 2) {
        const int border = way > 0 ? low && !high : high && !low;
        uint32_t brush = 0;
        assert_int_equal(count_covering(in, m, axis, way, at, &brush), border);
        if (!border) continue;
        assert_int_equal(c->boxes[brush].kind, c->boxes[maker_of(c, way > 0 ? cell : next, way > 0 ? next : cell)].kind);
    }
}

static void check_cells(const case_boxes *c)
{
    scene_draft d = draft_make();
    for (uint32_t b = 0; b < c->count; ++b) draft_box(&d, c->boxes[b].kind, c->boxes[b].min, c->boxes[b].max, c->boxes[b].material);
    const compile_input in = draft_input(&d);
    csg_counts counts;
    compile_mesh *m = surface_of(&in, &counts);
    long cells = 0;
    int cell[3];
    for (cell[0] = -1; cell[0] < SIDE; ++cell[0])
        for (cell[1] = -1; cell[1] < SIDE; ++cell[1])
            for (cell[2] = -1; cell[2] < SIDE; ++cell[2]) {
                cells += is_solid(c, owner_of(c, cell, c->count));
                for (int axis = 0; axis < 3; ++axis) check_border(&in, m, c, cell, axis);
            }
    mpq_t volume, area[3];
    mpq_init(volume);
    for (int k = 0; k < 3; ++k) mpq_init(area[k]);
    mesh_measures(&in, m, volume, area);
    assert_int_equal(mpq_cmp_si(volume, 6L * CELL * CELL * CELL * cells, 1), 0);
    for (int k = 0; k < 3; ++k) assert_int_equal(mpq_sgn(area[k]), 0);
    for (int k = 0; k < 3; ++k) mpq_clear(area[k]);
    mpq_clear(volume);
    compile_mesh_free(m);
    draft_free(&d);
}

static void test_each_face_between_solid_and_air_is_covered_once_by_adds(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int round = 0; round < 40; ++round) {
        const case_boxes c = random_boxes(&seed, 2 + random_below(&seed, 24), 0);
        check_cells(&c);
    }
}

static void test_each_face_between_solid_and_air_is_covered_once_by_adds_and_subtracts(void **state)
{
    (void)state;
    uint64_t seed = 2;
    for (int round = 0; round < 80; ++round) {
        const case_boxes c = random_boxes(&seed, 2 + random_below(&seed, 36), 1 + random_below(&seed, 4));
        check_cells(&c);
    }
}

static void test_nested_subtracts_and_adds_leave_shells(void **state)
{
    (void)state;
    case_boxes c = {.count = 5};
    for (int b = 0; b < 5; ++b) { // add, subtract, add, subtract, add: each in the one before
        c.boxes[b].kind = b & 1 ? BRUSH_SUBTRACT : BRUSH_ADD;
        for (int k = 0; k < 3; ++k) {
            c.boxes[b].min[k] = CELL * b;
            c.boxes[b].max[k] = CELL * (SIDE - 1 - b);
        }
    }
    check_cells(&c);
    scene_draft d = draft_make();
    for (uint32_t b = 0; b < c.count; ++b) draft_box(&d, c.boxes[b].kind, c.boxes[b].min, c.boxes[b].max, b % 3);
    const compile_input in = draft_input(&d);
    csg_counts counts;
    compile_mesh *m = surface_of(&in, &counts);
    assert_int_equal(counts.polygons_merged, 30);
    for (uint32_t p = 0; p < m->polygon_count; ++p) assert_int_equal(m->polygons[p].material, m->polygons[p].brush % 3);
    compile_mesh_free(m);
    draft_free(&d);
}

// What the loops promise the later stages.
static void check_loops(const compile_input *in, const compile_mesh *m)
{
    for (uint32_t p = 0; p < m->polygon_count; ++p) {
        const compile_polygon *q = &m->polygons[p];
        assert_true(q->vertex_count >= 3);
        for (uint32_t i = 0; i < q->vertex_count; ++i) {
            const plane_ref edge = m->edge_planes[q->first_vertex + i];
            for (uint32_t j = 0; j < q->vertex_count; ++j) {
                const compile_vertex *v = &m->vertices[m->loop[q->first_vertex + j]];
                assert_int_equal(plane_table_side(in->planes, v->planes, q->plane), 0);
                const int on = j == i || j == (i + 1) % q->vertex_count;
                assert_int_equal(plane_table_side(in->planes, v->planes, edge), on ? 0 : -1);
            }
        }
    }
}

static void test_loops_are_strictly_convex_with_edge_planes_that_hold_the_edges(void **state)
{
    (void)state;
    for (int map = 0; map < 8; ++map) {
        compile_input *in = real_map(real_maps[map], 256);
        if (!in) skip();
        csg_counts counts;
        compile_mesh *m = surface_of(in, &counts);
        check_loops(in, m);
        compile_mesh_free(m);
        compile_input_free(in);
    }
}

static void test_loops_go_counterclockwise_seen_from_the_front(void **state)
{
    (void)state;
    uint64_t seed = 5;
    const case_boxes c = random_boxes(&seed, 20, 2);
    scene_draft d = draft_make();
    for (uint32_t b = 0; b < c.count; ++b) draft_box(&d, c.boxes[b].kind, c.boxes[b].min, c.boxes[b].max, c.boxes[b].material);
    const compile_input in = draft_input(&d);
    csg_counts counts;
    compile_mesh *m = surface_of(&in, &counts);
    for (uint32_t p = 0; p < m->polygon_count; ++p) {
        const compile_polygon *q = &m->polygons[p];
        const cull_wide_plane plane = plane_table_get(in.planes, q->plane);
        double along = 0;
        for (uint32_t i = 0; i < q->vertex_count; ++i) {
            const double *a = m->vertices[m->loop[q->first_vertex + i]].position;
            const double *b = m->vertices[m->loop[q->first_vertex + (i + 1) % q->vertex_count]].position;
            for (int k = 0; k < 3; ++k) along += (double)plane.normal[k] * (a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
        }
        assert_true(along > 0);
    }
    compile_mesh_free(m);
    draft_free(&d);
}

static void test_every_failing_allocation_is_told_and_leaks_nothing(void **state)
{
    (void)state;
    uint64_t seed = 6;
    const case_boxes c = random_boxes(&seed, 40, 2);
    scene_draft d = draft_make();
    for (uint32_t b = 0; b < c.count; ++b) draft_box(&d, c.boxes[b].kind, c.boxes[b].min, c.boxes[b].max, c.boxes[b].material);
    const compile_input in = draft_input(&d);
    result done = RESULT_NO_MEMORY;
    uint64_t failed = 0;
    for (uint64_t at = 1; done != RESULT_OK; ++at) {
        failing_allocator memory;
        failing_allocator_init(&memory, at);
        report quiet = {0};
        csg_counts counts;
        compile_mesh *m = NULL;
        done = compile_csg(&in, &quiet, &memory.memory, &m, &counts);
        assert_true(done == RESULT_OK || (done == RESULT_NO_MEMORY && !m && quiet.errors == 1));
        compile_mesh_free(m);
        assert_true(failing_allocator_is_clean(&memory));
        failed += done != RESULT_OK;
    }
    assert_true(failed > 20);
    draft_free(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_face_between_solid_and_air_is_covered_once_by_adds),
        cmocka_unit_test(test_each_face_between_solid_and_air_is_covered_once_by_adds_and_subtracts),
        cmocka_unit_test(test_nested_subtracts_and_adds_leave_shells),
        cmocka_unit_test(test_loops_are_strictly_convex_with_edge_planes_that_hold_the_edges),
        cmocka_unit_test(test_loops_go_counterclockwise_seen_from_the_front),
        cmocka_unit_test(test_every_failing_allocation_is_told_and_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
