// Tests of imagecache's select: each item with a point in a volume, each once, near first; whatever level, scene, and number of volumes.
// SPDX-License-Identifier: MIT
#include "tests/octree/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct grid_values { const char *level, *walk, *order; } grid_values;

static cull_result grid_open(session *s, culler_host *h, const cull_zone *zone, const grid_values *values)
{
    const char *const list[] = {values->level, values->walk, values->order, "geometry", "on", "1", "tested", "bounded", "256", "coarser"};
    const cull_plugin *plugin = plugin_named("imagecache");
    assert_non_null(plugin);
    assert_int_equal(plugin->descriptor->option_count, 10);
    return session_open(s, h, plugin, zone, list);
}

static int point_is_inside(const cull_volume *v, const double p[3])
{
    for (uint32_t k = 0; k < v->plane_count; k++) {
        const cull_plane q = v->planes[k];
        if ((double)q.normal.x * p[0] + (double)q.normal.y * p[1] + (double)q.normal.z * p[2] + (double)q.offset < 0) return 0;
    }
    return 1;
}

// Some point of the box is seen, by points tried: what it misses may be dropped.
static int is_surely_seen(uint64_t *r, const made_volumes *v, cull_box box)
{
    for (int at = 0; at < 24; at++) {
        double p[3];
        for (int k = 0; k < 3; k++) {
            const double low = (double)(&box.min.x)[k], high = (double)(&box.max.x)[k], t = at < 8 ? at >> k & 1 : random_unit(r);
            p[k] = low + (high - low) * t;
            if (p[k] > high) p[k] = high;
        }
        for (uint32_t k = 0; k < v->count; k++)
            if (point_is_inside(&v->volumes[k], p)) return 1;
    }
    return 0;
}

static void must_show(session *s, const cull_box *boxes, made_volumes *v, uint64_t *r)
{
    static uint8_t seen[ITEMS_MOST], touching[ITEMS_MOST];
    for (int i = 0; i < 3; i++) v->view.eye_exact[i] = (double)v->view.eye[i];
    v->view.eye_exact[3] = (double)v->view.eye[3];
    v->view.forward[0] = 1;
    session_select(s, &v->view, v->volumes, v->count);
    const char *wrong = session_set_any_order(s, seen);
    if (wrong) fail_msg("%s", wrong);
    loop_set(boxes, s->item_count, v, touching);
    for (uint32_t i = 0; i < s->item_count; i++) {
        if (seen[i] && !touching[i]) fail_msg("item %u of %u is drawn, and its box is outside", i, s->item_count);
        if (!seen[i] && touching[i] && is_surely_seen(r, v, boxes[i])) fail_msg("item %u of %u has a point in view, and is not drawn", i, s->item_count);
    }
}

// Exactly the set of a loop over all boxes.
static void the_tree_finds_what_a_loop_over_all_boxes_finds(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 1, 9, 700, 5000}, volumes[] = {1, 1, 2, 5, 0, 31, 32};
    static const grid_values forms[] = {{"auto", "tree", "rings"}, {"0", "tree", "rings"}, {"7", "tree", "rings"}};
    uint64_t r = 6206;
    for (int kind = 0; kind < SCENE_KINDS; kind++)
        for (int c = 0; c < 5; c++)
            for (int f = 0; f < 3; f++) {
                cull_box *boxes = scene_make(&r, (scene_kind)kind, counts[c]);
                hand_zone z;
                culler_host h;
                session s;
                zone_of_boxes(boxes, counts[c], &z);
                culler_host_init(&h, 0);
                assert_int_equal(grid_open(&s, &h, &z.zone, &forms[f]), CULL_OK);
                for (uint32_t q = 0; q < 21; q++) {
                    static made_volumes v;
                    volumes_make(&r, boxes, counts[c], volumes[q % 7], &v);
                    session_select(&s, &v.view, v.volumes, v.count);
                    octree_must_be(&s, boxes, &v, "tree");
                }
                session_close(&s);
                assert_true(failing_allocator_is_clean(&h.memory));
                hand_zone_free(&z);
                free(boxes);
            }
}

static void every_item_with_a_point_in_a_volume_is_drawn_once(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 1, 2, 17, 700, 4000}, volumes[] = {1, 1, 2, 5, 0, 1, 33, 40};
    static const grid_values forms[] = {{"auto", "rings", "rings"}, {"0", "rings", "rings"}, {"7", "rings", "slope"}, {"6", "tree", "rings"}};
    uint64_t r = 6201;
    for (int kind = 0; kind < SCENE_KINDS; kind++)
        for (int c = 0; c < 6; c++)
            for (int f = 0; f < 4; f++) {
                cull_box *boxes = scene_make(&r, (scene_kind)kind, counts[c]);
                hand_zone z;
                culler_host h;
                session s;
                zone_of_boxes(boxes, counts[c], &z);
                culler_host_init(&h, 0);
                assert_int_equal(grid_open(&s, &h, &z.zone, &forms[f]), CULL_OK);
                for (uint32_t q = 0; q < 16; q++) {
                    static made_volumes v;
                    volumes_make(&r, boxes, counts[c], volumes[q % 8], &v);
                    must_show(&s, boxes, &v, &r);
                }
                session_close(&s);
                assert_true(failing_allocator_is_clean(&h.memory));
                hand_zone_free(&z);
                free(boxes);
            }
}

// The first item of each cell comes ring by ring: in a grid of small boxes, one a cell, the rings of drawn items never fall.
static void items_come_near_first(void **state)
{
    (void)state;
    enum { SIDE = 32 };
    cull_box *boxes = calloc(SIDE * SIDE, sizeof *boxes);
    uint64_t r = 6202;
    assert_non_null(boxes);
    for (int k = 0; k < SIDE * SIDE; k++) {
        const float x = (float)(k % SIDE) * 10, z = (float)(k / SIDE) * 10;
        boxes[k] = (cull_box){{x + 4, 0, z + 4}, {x + 6, 3, z + 6}};
    }
    boxes[0].min.x = boxes[0].min.z = 0; // so that cells start at 0 and end at 320
    boxes[SIDE * SIDE - 1].max = (cull_vec3){319.9f, 3, 319.9f};
    hand_zone z;
    culler_host h;
    session s;
    zone_of_boxes(boxes, SIDE * SIDE, &z);
    culler_host_init(&h, 0);
    assert_int_equal(grid_open(&s, &h, &z.zone, &(grid_values){"5", "rings", "rings"}), CULL_OK);
    for (int q = 0; q < 200; q++) {
        const double x = random_between(&r, -100, 420), zz = random_between(&r, -100, 420);
        const int ie = (int)floor(x / 10), je = (int)floor(zz / 10);
        const cull_view view = {.eye = {(float)x, 1, (float)zz, 1}, .eye_exact = {x, 1, zz, 1}, .forward = {1, 0, 0}};
        const cull_volume all = {NULL, 0, 0};
        int last = -1, drawn = 0;
        session_select(&s, &view, &all, 1);
        for (uint32_t k = 0; k < s.run_count; k++)
            for (uint32_t p = s.runs[k].first; p < s.runs[k].first + s.runs[k].count; p++, drawn++) {
                const int item = (int)s.built.order[p], d = abs(item % SIDE - ie) + abs(item / SIDE - je);
                // Cells are 2^-14 larger than a 32nd, so an eye next to a border may stand in the cell beside.
                assert_true(d + 2 >= last);
                if (d > last) last = d;
            }
        assert_int_equal(drawn, SIDE * SIDE);
    }
    session_close(&s);
    hand_zone_free(&z);
    free(boxes);
}

static void the_same_visit_gives_the_same_runs_whatever_was_asked_before(void **state)
{
    (void)state;
    enum { COUNT = 3000 };
    uint64_t r = 6203;
    cull_box *boxes = scene_make(&r, SCENE_CITY, COUNT);
    hand_zone z;
    culler_host h;
    session s[2];
    zone_of_boxes(boxes, COUNT, &z);
    culler_host_init(&h, 0);
    for (int k = 0; k < 2; k++) assert_int_equal(grid_open(&s[k], &h, &z.zone, &(grid_values){"auto", "rings", "rings"}), CULL_OK);
    for (uint32_t q = 0; q < 60; q++) {
        static made_volumes v, other;
        volumes_make(&r, boxes, COUNT, 1 + q % 40, &v);
        volumes_make(&r, boxes, COUNT, 1 + q % 3, &other);
        session_select(&s[0], &other.view, other.volumes, other.count);
        for (int k = 0; k < 2; k++) session_select(&s[k], &v.view, v.volumes, v.count);
        assert_int_equal(s[0].run_count, s[1].run_count);
        if (s[0].run_count) assert_memory_equal(s[0].runs, s[1].runs, s[0].run_count * sizeof *s[0].runs);
        assert_int_equal(s[0].nodes_visited, s[1].nodes_visited);
    }
    for (int k = 0; k < 2; k++) session_close(&s[k]);
    hand_zone_free(&z);
    free(boxes);
}

static void explain_gives_a_true_reason(void **state)
{
    (void)state;
    static uint8_t seen[ITEMS_MOST];
    uint64_t r = 6204;
    for (int kind = 0; kind < 2 * SCENE_KINDS; kind++) {
        const grid_values form = {"4", kind < SCENE_KINDS ? "rings" : "tree", "rings"};
        cull_box *boxes = scene_make(&r, (scene_kind)(kind % SCENE_KINDS), 200);
        hand_zone z;
        culler_host h;
        session s;
        zone_of_boxes(boxes, 200, &z);
        culler_host_init(&h, 0);
        assert_int_equal(grid_open(&s, &h, &z.zone, &form), CULL_OK);
        const cull_explain *explain = octree_extension(&s, CULL_EXT_EXPLAIN);
        for (uint32_t q = 0; q < 8; q++) {
            static made_volumes v;
            char text[300];
            volumes_make(&r, boxes, 200, q % 4, &v);
            session_select(&s, &v.view, v.volumes, v.count);
            assert_null(session_set_any_order(&s, seen));
            const cull_visit visit = {.view = &v.view, .volumes = v.volumes, .volume_count = v.count, .scratch = s.scratch};
            for (uint32_t place = 0; place < 200; place++) {
                const int is_seen = seen[s.built.order[place]];
                const size_t length = explain->item(s.query, &visit, place, text, sizeof text);
                assert_int_equal(length, strlen(text));
                if (strncmp(text, is_seen ? "kept: " : "dropped: ", is_seen ? 6 : 9) != 0) fail_msg("drawn %d: %s", is_seen, text);
            }
            explain->item(s.query, &visit, 200, text, sizeof text);
            assert_string_equal(text, "there is no item 200");
        }
        session_close(&s);
        hand_zone_free(&z);
        free(boxes);
    }
}

static void options_that_mean_nothing_are_refused_and_the_reports_forms_promise_less(void **state)
{
    (void)state;
    static const grid_values wrong[] = {{"11", "rings", "rings"}, {"", "rings", "rings"}, {"-1", "rings", "rings"}, {"4x", "rings", "rings"},
                                        {"auto", "thin", "rings"}, {"auto", "rings", ""},  {"99999999999", "rings", "rings"}};
    hand_zone z;
    zone_of_boxes(NULL, 0, &z);
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        culler_host h;
        session s;
        culler_host_init(&h, 0);
        assert_int_equal(grid_open(&s, &h, &z.zone, &wrong[k]), CULL_ERR_OPTION);
        assert_non_null(strstr(h.last_line, "imagecache: "));
        assert_true(failing_allocator_is_clean(&h.memory));
    }
    for (int is_thin = 0; is_thin < 2; is_thin++) {
        culler_host h;
        session s;
        culler_host_init(&h, 0);
        assert_int_equal(grid_open(&s, &h, &z.zone, &(grid_values){"4", is_thin ? "bresenham" : "rings", "rings"}), CULL_OK);
        assert_int_equal((s.built.promises & CULL_CONSERVATIVE) != 0, !is_thin);
        session_close(&s);
    }
    hand_zone_free(&z);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    uint64_t r = 6205, k = 1;
    cull_box *boxes = scene_make(&r, SCENE_CITY, 1000);
    hand_zone z;
    zone_of_boxes(boxes, 1000, &z);
    const cull_plugin *plugin = plugin_named("imagecache");
    const char *const values[] = {"auto", "tree", "rings", "geometry", "on", "1", "tested", "bounded", "256", "coarser"};
    for (;; k++) {
        culler_host h;
        session s;
        culler_host_init(&h, k);
        const cull_result result = session_open(&s, &h, plugin, &z.zone, values);
        if (result == CULL_OK) session_close(&s);
        assert_true(failing_allocator_is_clean(&h.memory));
        if (result == CULL_OK) break;
        assert_int_equal(result, CULL_ERR_MEMORY);
    }
    assert_true(k > 9);
    hand_zone_free(&z);
    free(boxes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_item_with_a_point_in_a_volume_is_drawn_once),
        cmocka_unit_test(the_tree_finds_what_a_loop_over_all_boxes_finds),
        cmocka_unit_test(items_come_near_first),
        cmocka_unit_test(the_same_visit_gives_the_same_runs_whatever_was_asked_before),
        cmocka_unit_test(explain_gives_a_true_reason),
        cmocka_unit_test(options_that_mean_nothing_are_refused_and_the_reports_forms_promise_less),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("image cache: select", tests, NULL, NULL);
}
