// Tests of the cells: which items they list, against an exact separating-axis test in whole numbers; their boxes, their order, hard scenes.
// SPDX-License-Identifier: MIT
#include "plugins/imagecache/lists.h"
#include "tests/common/culler_host.h"
#include "tests/common/hand_zone.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <portcullis/box.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { UNITS = 1 << 14 }; // a metre: cell borders at these sizes and corners in eighths are whole

typedef struct whole_point { int64_t x, z; } whole_point;
typedef struct whole_square { int64_t low_x, low_z, high_x, high_z; } whole_square;

static int64_t whole(double at)
{
    const double units = at * UNITS;
    assert_true(units == floor(units));
    return (int64_t)units;
}

static int are_apart(const whole_point t[3], whole_square s, int64_t nx, int64_t nz)
{
    const whole_point corners[4] = {{s.low_x, s.low_z}, {s.low_x, s.high_z}, {s.high_x, s.low_z}, {s.high_x, s.high_z}};
    int64_t low[2] = {INT64_MAX, INT64_MAX}, high[2] = {INT64_MIN, INT64_MIN};
    for (int k = 0; k < 7; k++) {
        const whole_point p = k < 3 ? t[k] : corners[k - 3];
        const int64_t at = nx * p.x + nz * p.z;
        const int which = k < 3 ? 0 : 1;
        if (at < low[which]) low[which] = at;
        if (at > high[which]) high[which] = at;
    }
    return high[0] < low[1] || high[1] < low[0];
}

static int touch_exactly(const whole_point t[3], whole_square s)
{
    if (are_apart(t, s, 1, 0) || are_apart(t, s, 0, 1)) return 0;
    for (int k = 0; k < 3; k++)
        if (are_apart(t, s, t[(k + 1) % 3].z - t[k].z, t[k].x - t[(k + 1) % 3].x)) return 0;
    return 1;
}

static whole_square square_of(const ground *g, ground_cell c, int64_t by)
{
    const whole_square s = {whole(g->x + c.i * g->size) - by, whole(g->z + c.j * g->size) - by, whole(g->x + (c.i + 1) * g->size) + by,
                            whole(g->z + (c.j + 1) * g->size) + by};
    return s;
}

static int lists_place(const cells *c, uint32_t cell, uint32_t place)
{
    for (uint32_t r = c->firsts[cell]; r < c->firsts[cell + 1]; r++)
        if (place - c->runs[r].first < c->runs[r].count) return 1;
    return 0;
}

static cull_vec3 corner_random(uint64_t *r, double wide)
{
    const cull_vec3 p = {(float)(floor(random_between(r, -wide, wide) * 8) / 8), (float)random_between(r, 0, 20),
                         (float)(floor(random_between(r, -wide, wide) * 8) / 8)};
    return p;
}

static const cull_box FIELD = {{-408, 0, -408}, {408, 20, 408}};

// On a border of cells, the nearest from below.
static float on_border(double start, double size, float at)
{
    const float border = (float)(start + floor(((double)at - start) / size) * size);
    return border >= -408 && border <= 408 ? border : at;
}

// All within the field, which the first reaches to both ends of; half of the corners on borders of the field's cells.
static void add_triangles(hand_zone *z, uint64_t *r, uint32_t level, uint32_t count)
{
    const ground g = ground_of(FIELD, level);
    if (count) hand_zone_wall(z, (const cull_vec3[3]){FIELD.min, {-400, 5, -408}, FIELD.max}, 3, 0);
    for (uint32_t i = 1; i < count; i++) {
        const double wide = random_unit(r) < 0.1 ? 200 : random_unit(r) < 0.2 ? 0 : 8;
        const cull_vec3 at = corner_random(r, 200);
        cull_vec3 p[3];
        for (int k = 0; k < 3; k++) {
            const cull_vec3 off = corner_random(r, wide);
            p[k] = (cull_vec3){at.x + off.x, off.y, at.z + off.z};
            if (i % 9 == 8 && k == 2) p[2] = p[1]; // a line
            if (i % 11 == 10) p[k].x = at.x;       // upright
            if (random_unit(r) < 0.5) p[k].x = on_border(g.x, g.size, p[k].x);
            if (random_unit(r) < 0.5) p[k].z = on_border(g.z, g.size, p[k].z);
        }
        hand_zone_wall(z, p, 3, 0);
    }
}

static void a_cell_lists_exactly_the_triangles_that_touch_it(void **state)
{
    (void)state;
    uint64_t r = 6101, listed = 0, spare = 0;
    for (uint32_t level = 0; level <= 7; level++) {
        enum { COUNT = 60 };
        hand_zone z;
        culler_host h;
        cells c;
        hand_zone_open(&z, COUNT, 3 * COUNT);
        add_triangles(&z, &r, level, COUNT);
        hand_zone_end(&z);
        culler_host_init(&h, 0);
        assert_int_equal(cells_build(&h.host, &z.zone, level, &c), CULL_OK);
        for (uint32_t place = 0; place < COUNT; place++) {
            whole_point t[3];
            const cull_item *item = &z.zone.items[c.order[place]];
            for (uint32_t k = 0; k < 3; k++) {
                const cull_vec3 p = z.zone.positions[z.zone.indices[item->first_index + k]];
                t[k] = (whole_point){whole((double)p.x), whole((double)p.z)};
            }
            for (uint32_t cell = 0; cell < c.cell_count; cell++) {
                const ground_cell at = {(int32_t)(cell % c.ground.columns), (int32_t)(cell / c.ground.columns)};
                const int is_listed = lists_place(&c, cell, place), touches = touch_exactly(t, square_of(&c.ground, at, 0));
                if (touches && !is_listed) fail_msg("level %u: triangle %u is not listed in cell (%d, %d)", level, place, at.i, at.j);
                if (is_listed && !touches) assert_true(touch_exactly(t, square_of(&c.ground, at, 1)));
                listed += touches != 0;
                spare += is_listed && !touches;
            }
        }
        cells_free(&h.host, &c);
        assert_true(failing_allocator_is_clean(&h.memory));
        hand_zone_free(&z);
    }
    assert_true(listed > 2000);
    assert_true(spare * 1000 <= listed);
}

// What a culler may rely on: an order that is a permutation, runs that ascend apart, boxes that hold the triangles' corners in the cell.
static void check_form(const cells *c, const cull_zone *zone)
{
    uint8_t *seen = calloc(zone->item_count + 1, 1), *is_listed = calloc(zone->item_count + 1, 1);
    assert_true(seen && is_listed);
    for (uint32_t place = 0; place < zone->item_count; place++) {
        assert_true(c->order[place] < zone->item_count);
        assert_int_equal(seen[c->order[place]]++, 0);
    }
    assert_int_equal(c->firsts[0], 0);
    assert_int_equal(c->firsts[c->cell_count], c->run_count);
    for (uint32_t cell = 0; cell < c->cell_count; cell++)
        for (uint32_t k = c->firsts[cell]; k < c->firsts[cell + 1]; k++) {
            const cells_run run = c->runs[k], before = k > c->firsts[cell] ? c->runs[k - 1] : (cells_run){0, 0, UINT32_MAX};
            assert_true(run.count > 0 && run.first + run.count <= zone->item_count);
            assert_true(run.first >= before.first + before.count);
            if (run.first == before.first + before.count) assert_int_not_equal(run.home, before.home);
            for (uint32_t place = run.first; place < run.first + run.count; place++) {
                if (run.home == cell) is_listed[place]++; // at home once
                assert_true(cull_box_touches(c->boxes[cell], c->items[place]));
            }
        }
    for (uint32_t place = 0; place < zone->item_count; place++) assert_int_equal(is_listed[place], 1);
    free(seen);
    free(is_listed);
}

typedef enum hard_scene { HARD_NOTHING, HARD_POINT, HARD_ONE_PLACE, HARD_LINE, HARD_GIANT, HARD_GIANTS, HARD_FAR, HARD_HUGE, HARD_TINY, HARD_SCENES } hard_scene;

static void add_hard(hand_zone *z, uint64_t *r, hard_scene scene)
{
    const uint32_t count = scene == HARD_NOTHING ? 0 : scene == HARD_POINT ? 1 : 300;
    for (uint32_t i = 0; i < count; i++) {
        double at[3], size[3];
        for (int k = 0; k < 3; k++) {
            at[k] = random_between(r, -100, 100);
            size[k] = random_between(r, 0, 2);
            if (scene == HARD_POINT || scene == HARD_ONE_PLACE) at[k] = 7, size[k] = 0;
            if (scene == HARD_LINE && k == 2) at[k] = -3, size[k] = 0;
            if (scene == HARD_GIANTS || (scene == HARD_GIANT && i == 5)) at[k] = -100, size[k] = 200;
            if (scene == HARD_FAR) at[k] = at[k] / 64 + 3e7;
            if (scene == HARD_HUGE) at[k] *= 1e30, size[k] *= 1e30;
            if (scene == HARD_TINY) at[k] *= 1e-36, size[k] *= 1e-36;
        }
        const cull_box box = {{(float)at[0], (float)at[1], (float)at[2]}, {(float)(at[0] + size[0]), (float)(at[1] + size[1]), (float)(at[2] + size[2])}};
        hand_zone_cluster(z, box);
    }
}

static void hard_scenes_are_listed_whole(void **state)
{
    (void)state;
    static const uint32_t levels[] = {CELLS_LEVEL_AUTO, 0, 5, 10};
    uint64_t r = 6102;
    for (int scene = 0; scene < HARD_SCENES; scene++)
        for (int k = 0; k < 4; k++) {
            hand_zone z;
            culler_host h;
            cells c;
            hand_zone_open(&z, 300, 0);
            add_hard(&z, &r, (hard_scene)scene);
            hand_zone_end(&z);
            culler_host_init(&h, 0);
            assert_int_equal(cells_build(&h.host, &z.zone, levels[k], &c), CULL_OK);
            check_form(&c, &z.zone);
            assert_true(c.listing_count <= (uint64_t)z.zone.item_count * CELLS_COPIES_ASKED + CELLS_LISTINGS_FREE);
            for (uint32_t i = 0; i <= c.ground.columns; i += 1 + c.ground.columns / 7) { // a border is in the cells of both sides
                const double x = c.ground.x + i * c.ground.size;
                const int32_t at = ground_index(c.ground.x, c.ground.size, (int32_t)c.ground.columns, x);
                assert_int_equal(at, i);
                const ground_range both = ground_touched(c.ground.x, c.ground.size, (int32_t)c.ground.columns, x, x);
                assert_int_equal(both.first, i > 0 ? i - 1 : 0);
                assert_int_equal(both.last, i < c.ground.columns ? i : i - 1);
            }
            cells_free(&h.host, &c);
            assert_true(failing_allocator_is_clean(&h.memory));
            hand_zone_free(&z);
        }
}

static void neighbours_stand_together_in_the_order(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    uint64_t r = 6103;
    hand_zone z;
    culler_host h;
    cells c;
    hand_zone_open(&z, COUNT, 0);
    for (uint32_t i = 0; i < COUNT; i++) {
        const float x = (float)random_between(&r, -500, 500), z0 = (float)random_between(&r, -500, 500);
        hand_zone_cluster(&z, (cull_box){{x, 0, z0}, {x + 0.5f, 3, z0 + 0.5f}});
    }
    hand_zone_end(&z);
    culler_host_init(&h, 0);
    assert_int_equal(cells_build(&h.host, &z.zone, CELLS_LEVEL_AUTO, &c), CULL_OK);
    check_form(&c, &z.zone);
    assert_true(c.run_count < 4 * c.used_count); // a cell is a run of its own and one of a few neighbours
    assert_true(c.listing_count < 2 * COUNT);
    cells_free(&h.host, &c);
    hand_zone_free(&z);
}

static void cells_are_built_again_the_same_and_every_allocation_may_fail(void **state)
{
    (void)state;
    uint64_t r = 6104, k = 1;
    hand_zone z;
    culler_host h;
    cells c, again;
    hand_zone_open(&z, 200, 600);
    add_triangles(&z, &r, 6, 200);
    hand_zone_end(&z);
    for (;; k++) {
        culler_host_init(&h, k);
        const cull_result result = cells_build(&h.host, &z.zone, 6, &c);
        if (result == CULL_OK) break;
        assert_int_equal(result, CULL_ERR_MEMORY);
        assert_true(failing_allocator_is_clean(&h.memory));
    }
    assert_true(k > 5);
    h.memory.fail_at = 0;
    assert_int_equal(cells_build(&h.host, &z.zone, 6, &again), CULL_OK);
    assert_int_equal(c.run_count, again.run_count);
    assert_memory_equal(c.runs, again.runs, c.run_count * sizeof *c.runs);
    assert_memory_equal(c.order, again.order, 200 * sizeof *c.order);
    cells_free(&h.host, &again);
    cells_free(&h.host, &c);
    assert_true(failing_allocator_is_clean(&h.memory));
    hand_zone_free(&z);
}

static int node_lists(const lists *l, const lists_node *n, uint32_t place)
{
    for (uint32_t r = n->first_run; r < n->first_run + n->run_count; r++)
        if (place - l->runs[r].first < l->runs[r].count) return 1;
    return 0;
}

// Against the cells under the node, one by one.
static void check_node(const cells *c, const lists *l, const cull_zone *zone, uint32_t node)
{
    const lists_node *n = &l->nodes[node];
    const nodes_square q = nodes_square_of(&c->ground, node);
    uint8_t *wanted = calloc(zone->item_count + 1, 1);
    uint32_t items = 0, polygons = 0;
    assert_non_null(wanted);
    for (int32_t j = q.first.j; j < q.first.j + q.side && j < (int32_t)c->ground.rows; j++)
        for (int32_t i = q.first.i; i < q.first.i + q.side && i < (int32_t)c->ground.columns; i++) {
            const uint32_t cell = ground_number(&c->ground, (ground_cell){i, j});
            for (uint32_t place = 0; place < zone->item_count; place++) wanted[place] |= (uint8_t)lists_place(c, cell, place);
            if (!cells_is_empty(c, cell)) assert_true(cull_box_contains(n->box, c->boxes[cell]));
        }
    for (uint32_t place = 0; place < zone->item_count; place++) {
        assert_int_equal(node_lists(l, n, place), wanted[place]);
        items += wanted[place];
        polygons += wanted[place] ? zone->items[c->order[place]].polygon_count : 0;
    }
    assert_int_equal(n->item_count, items);
    assert_int_equal(n->polygon_count, polygons);
    for (uint32_t r = n->first_run + 1; r < n->first_run + n->run_count; r++) assert_true(l->runs[r].first > l->runs[r - 1].first + l->runs[r - 1].count);
    free(wanted);
}

static void a_node_stands_for_the_items_of_its_cells(void **state)
{
    (void)state;
    uint64_t r = 6105;
    for (uint32_t level = 0; level <= 4; level++) {
        hand_zone z;
        culler_host h;
        cells c;
        lists l;
        hand_zone_open(&z, 150, 450);
        add_triangles(&z, &r, level, level == 3 ? 0 : 150);
        hand_zone_end(&z);
        culler_host_init(&h, 0);
        assert_int_equal(cells_build(&h.host, &z.zone, level, &c), CULL_OK);
        const uint64_t calls = h.memory.calls;
        for (uint64_t k = 1;; k++) {
            h.memory.fail_at = calls + k;
            h.memory.calls = calls;
            const cull_result result = lists_build(&h.host, &z.zone, &c, &l);
            if (result == CULL_OK) break;
            assert_int_equal(result, CULL_ERR_MEMORY);
        }
        for (uint32_t node = 0; node < l.node_count; node++) check_node(&c, &l, &z.zone, node);
        lists_free(&h.host, &l);
        cells_free(&h.host, &c);
        assert_true(failing_allocator_is_clean(&h.memory));
        hand_zone_free(&z);
    }
}

static void marks_are_gone_when_their_cells_are_cleared(void **state)
{
    (void)state;
    static nodes_mark marks[1 + 4 + 16 + 64 + 256];
    const ground g = ground_of((cull_box){{0, 0, 0}, {100, 10, 70}}, 4);
    uint64_t r = 6106;
    for (int round = 0; round < 100; round++) {
        ground_cell cells_taken[40];
        uint32_t out[256];
        for (int k = 0; k < 40; k++) {
            cells_taken[k] = (ground_cell){(int32_t)random_below(&r, g.columns), (int32_t)random_below(&r, g.rows)};
            nodes_take_cell(&g, marks, cells_taken[k]);
        }
        assert_in_range(nodes_in_order(&g, marks, (ground_cell){3, 20}, out), 1, 40);
        marks[nodes_parent(nodes_of_cell(&g, cells_taken[0]))] = NODES_TAKE; // merged
        for (int k = 0; k < 40; k++) nodes_clear_cell(&g, marks, cells_taken[k]);
        for (uint32_t n = 0; n < nodes_count(&g); n++) assert_int_equal(marks[n], NODES_SKIP);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cell_lists_exactly_the_triangles_that_touch_it),
        cmocka_unit_test(hard_scenes_are_listed_whole),
        cmocka_unit_test(neighbours_stand_together_in_the_order),
        cmocka_unit_test(a_node_stands_for_the_items_of_its_cells),
        cmocka_unit_test(marks_are_gone_when_their_cells_are_cleared),
        cmocka_unit_test(cells_are_built_again_the_same_and_every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("image cache: cells", tests, NULL, NULL);
}
