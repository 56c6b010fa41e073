// Tests of imagecache's cut: what is seen is geometry or in one picture, no geometry behind a picture, and what costs less is chosen.
// SPDX-License-Identifier: MIT
#include "plugins/imagecache/cut.h"
#include "tests/imagecache/show_field.h"

#include <stdlib.h>
#include <string.h>

typedef struct town {
    cull_box *boxes;
    hand_zone zone;
    show_host host;
    cells cells;
    lists lists;
    inview inview;
    cut cut;
} town;

static void town_open(town *t, uint32_t level, double polygon_ns)
{
    memset(t, 0, sizeof *t);
    t->boxes = field_make();
    zone_of_boxes(t->boxes, FIELD_ITEMS, &t->zone);
    show_host_init(&t->host, polygon_ns, 0);
    const cull_host *h = &t->host.base.host;
    assert_int_equal(cells_build(h, &t->zone.zone, level, &t->cells), CULL_OK);
    assert_int_equal(lists_build(h, &t->zone.zone, &t->cells, &t->lists), CULL_OK);
    assert_true(inview_open(h, &t->cells, &t->inview) && cut_open(h, &t->cells, &t->lists, &t->cut));
}

static void town_close(town *t)
{
    const cull_host *h = &t->host.base.host;
    cut_close(h, &t->cut);
    inview_close(h, &t->inview);
    lists_free(h, &t->lists);
    cells_free(h, &t->cells);
    assert_true(failing_allocator_is_clean(&t->host.base.memory));
    hand_zone_free(&t->zone);
    free(t->boxes);
}

static cut_request look(town *t, show_eye eye, double speed)
{
    cull_view view;
    cull_plane planes[4];
    show_look(eye, 1, &view, planes);
    const cull_volume volume = {planes, 4, 0};
    const cull_visit visit = {.view = &view, .volumes = &volume, .volume_count = 1};
    inview_gather(&t->inview, &visit, 0, (inview_ways){INVIEW_RINGS, INVIEW_BY_RINGS});
    cut_request q = {.inview = &t->inview, .costs = &t->host.costs, .eye = {eye.at[0], eye.at[1], eye.at[2]}, .step = {speed, 0, 0}, .speed = speed,
                     .radius = FIELD_M, .optics = {(double)view.pixels_per_tangent, 0.0625, 1280.0 * 720}, .tolerance_px = 1, .picture_pixel_ns = 6,
                     .eye_cell = inview_eye(&t->cells.ground, &view)};
    return q;
}

static show_eye anywhere(uint64_t *r)
{
    const show_eye e = {{random_between(r, -300, FIELD_M + 300), random_between(r, 1, 60), random_between(r, -300, FIELD_M + 300)},
                        random_between(r, -3.2, 3.2), random_between(r, -0.6, 0.3)};
    return e;
}

static ground_cell cell_at(const town *t, uint32_t cell)
{
    const ground_cell c = {(int32_t)(cell % t->cells.ground.columns), (int32_t)(cell / t->cells.ground.columns)};
    return c;
}

static uint32_t times_taken(const town *t, uint32_t cell)
{
    uint32_t times = 0;
    for (uint32_t node = nodes_of_cell(&t->cells.ground, cell_at(t, cell));; node = nodes_parent(node)) {
        for (uint32_t k = 0; k < t->cut.taken_count; k++) if (t->cut.taken[k] == node) times++;
        if (node == 0) return times;
    }
}

static void each_cell_in_view_is_geometry_or_in_one_picture(void **state)
{
    (void)state;
    uint64_t r = 6501, geometry = 0, pictures = 0;
    for (uint32_t level = 0; level <= 6; level += 2) {
        town t;
        town_open(&t, level, 3000);
        for (int k = 0; k < 60; k++) {
            cut_request q = look(&t, anywhere(&r), random_between(&r, 0.01, 3));
            q.history = k % 3 ? CUT_GOES_ON : CUT_ANEW;
            q.nodes = k % 4 ? CUT_TREE : CUT_CELLS;
            cut_make(&t.cut, &q);
            for (uint32_t i = 0; i < t.inview.count; i++) {
                const ground_cell at = cell_at(&t, t.inview.list[i]);
                const int is_geometry = cut_ring(q.eye_cell, at.i, at.j) <= t.cut.ring;
                assert_int_equal(times_taken(&t, t.inview.list[i]), !is_geometry);
                if (is_geometry) geometry++;
                else pictures++;
            }
        }
        town_close(&t);
    }
    assert_true(geometry > 1000 && pictures > 1000);
}

// Points along rays: once beyond the square, always beyond it; and no picture reaches into it.
static void no_geometry_lies_behind_a_picture(void **state)
{
    (void)state;
    enum { POINTS = 4000 };
    uint64_t r = 6502, left = 0;
    town t;
    town_open(&t, 5, 3000);
    for (int k = 0; k < 200; k++) {
        const show_eye eye = anywhere(&r);
        const cut_request q = look(&t, eye, 0.3);
        const ground *g = &t.cells.ground;
        const double turned = random_between(&r, 0, 6.28318);
        int is_beyond = 0;
        cut_make(&t.cut, &q);
        for (int p = 0; p < POINTS; p++) {
            const double x = eye.at[0] + cos(turned) * p * 0.5, z = eye.at[2] + sin(turned) * p * 0.5;
            const ground_cell at = {ground_index(g->x, g->size, (int32_t)g->columns, x), ground_index(g->z, g->size, (int32_t)g->rows, z)};
            if (at.i < 0 || at.j < 0 || at.i >= (int32_t)g->columns || at.j >= (int32_t)g->rows) continue; // nothing is there
            const int is_geometry = cut_ring(q.eye_cell, at.i, at.j) <= t.cut.ring;
            assert_false(is_beyond && is_geometry);
            if (!is_beyond && !is_geometry) left++;
    
            if (!is_geometry) is_beyond = 1;
        }
        for (uint32_t n = 0; n < t.cut.taken_count; n++) {
            const nodes_square s = nodes_square_of(g, t.cut.taken[n]);
            for (int32_t j = s.first.j; j < s.first.j + s.side; j++)
                for (int32_t i = s.first.i; i < s.first.i + s.side; i++) assert_true(cut_ring(q.eye_cell, i, j) > t.cut.ring);
        }
    }
    assert_true(left > 50);
    town_close(&t);
}

static void what_costs_less_is_chosen(void **state)
{
    (void)state;
    uint64_t r = 6503;
    town t;
    town_open(&t, 5, 3000);
    for (int k = 0; k < 60; k++) {
        const show_eye eye = {{random_between(&r, 100, 700), 2, random_between(&r, 100, 700)}, random_between(&r, -3, 3), 0};
        const cut_request slow = look(&t, eye, 0.05);
        cut_make(&t.cut, &slow);
        const int32_t ring = t.cut.ring;
        const double price = t.cut.picture_ns;
        cut_request fast = slow;
        fast.speed = 5;
        cut_make(&t.cut, &fast);
        assert_true(t.cut.ring >= ring); // pictures last less long
        assert_true(t.cut.picture_ns >= price);
        cut_request loose = fast;
        loose.tolerance_px = 4;
        cut_make(&t.cut, &loose);
        t.host.costs.polygon_ns = 0.001;
        cut_make(&t.cut, &slow);
        assert_int_equal(t.cut.taken_count, 0); // geometry costs nothing
        t.host.costs.polygon_ns = 1e9;
        cut_make(&t.cut, &slow);
        for (uint32_t i = 0; i < t.inview.count; i++) { // geometry costs everything: only what can't be taken is drawn
            const ground_cell at = cell_at(&t, t.inview.list[i]);
            const cull_box *box = &t.lists.nodes[nodes_of_cell(&t.cells.ground, at)].box;
            if (cut_can_be_taken(&slow, box)) continue;
            assert_true(cut_ring(slow.eye_cell, at.i, at.j) <= t.cut.ring);
        }
        t.host.costs.polygon_ns = 3000;
    }
    town_close(&t);
}

static void a_cells_picture_costs_more_where_pictures_wore_out_sooner_than_foretold(void **state)
{
    (void)state;
    uint64_t r = 6505, dearer = 0;
    town t;
    town_open(&t, 5, 3000);
    float *const before = calloc(t.lists.node_count, sizeof *before);
    assert_non_null(before);
    for (int k = 0; k < 40; k++) {
        cut_request q = look(&t, anywhere(&r), 0.2);
        cut_make(&t.cut, &q);
        memcpy(before, t.cut.prices, t.lists.node_count * sizeof *before);
        q.wear = 6;
        cut_make(&t.cut, &q);
        for (uint32_t i = 0; i < t.inview.count; i++) {
            const uint32_t node = nodes_of_cell(&t.cells.ground, cell_at(&t, t.inview.list[i]));
            assert_true(t.cut.prices[node] >= before[node]);
            dearer += t.cut.prices[node] > before[node];
        }
    }
    assert_true(dearer > 1000);
    free(before);
    town_close(&t);
}

static void pictures_come_near_first(void **state)
{
    (void)state;
    uint64_t r = 6504, pairs = 0;
    town t;
    town_open(&t, 5, 3000);
    for (int k = 0; k < 100; k++) {
        const cut_request q = look(&t, anywhere(&r), 0.1);
        cut_make(&t.cut, &q);
        // Apart along both axes, on one side of the eye: the one that is nearer along both comes first.
        for (uint32_t a = 0; a < t.cut.taken_count; a++)
            for (uint32_t b = a + 1; b < t.cut.taken_count; b++) {
                const nodes_square s = nodes_square_of(&t.cells.ground, t.cut.taken[a]), u = nodes_square_of(&t.cells.ground, t.cut.taken[b]);
                const int behind_i = u.first.i > q.eye_cell.i && u.first.i + u.side <= s.first.i, behind_j = u.first.j > q.eye_cell.j && u.first.j + u.side <= s.first.j;
                assert_false(behind_i && behind_j);
                pairs++;
            }
    }
    assert_true(pairs > 1000);
    town_close(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_cell_in_view_is_geometry_or_in_one_picture),
        cmocka_unit_test(no_geometry_lies_behind_a_picture),
        cmocka_unit_test(what_costs_less_is_chosen),
        cmocka_unit_test(a_cells_picture_costs_more_where_pictures_wore_out_sooner_than_foretold),
        cmocka_unit_test(pictures_come_near_first),
    };
    return cmocka_run_group_tests_name("image cache: the cut", tests, NULL, NULL);
}
