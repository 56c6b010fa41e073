// Tests of octree's select: exactly the set of a loop over all boxes, from any kind of tree, order of items and instruction set.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const isas[] = {"plain", "avx2", "avx512"};
enum { ISA_COUNT = 3 };

// Runs of all instruction sets, which must be the same to the last byte; the first is judged by the loop.
static void must_select(const cull_zone *zone, const cull_box *boxes, const octree_values *how, uint64_t *r, uint32_t queries)
{
    session s[ISA_COUNT];
    culler_host h[ISA_COUNT];
    int has[ISA_COUNT];
    for (int i = 0; i < ISA_COUNT; i++) {
        const octree_values values = {how->kind, how->loose, how->backface, isas[i]};
        culler_host_init(&h[i], 0);
        has[i] = octree_has_isa(isas[i]);
        if (has[i]) assert_int_equal(octree_open(&s[i], &h[i], zone, &values), CULL_OK);
    }
    assert_true(has[0]);
    for (uint32_t q = 0; q < queries; q++) {
        static made_volumes v;
        static const uint32_t counts[] = {1, 1, 1, 2, 5, 0, 16, 17, 40};
        char what[160];
        volumes_make(r, boxes, zone->item_count, counts[q % 9], &v);
        snprintf(what, sizeof what, "%s, loose %s, query %u of %u volumes", how->kind, how->loose, (unsigned)q, (unsigned)v.count);
        for (int i = 0; i < ISA_COUNT; i++) {
            if (!has[i]) continue;
            session_select(&s[i], &v.view, v.volumes, v.count);
            if (i == 0) octree_must_be(&s[0], boxes, &v, what);
            assert_int_equal(s[i].run_count, s[0].run_count);
            if (s[0].run_count) assert_memory_equal(s[i].runs, s[0].runs, s[0].run_count * sizeof *s[0].runs);
            assert_int_equal(s[i].nodes_visited, s[0].nodes_visited);
        }
    }
    for (int i = 0; i < ISA_COUNT; i++) {
        if (!has[i]) continue;
        session_close(&s[i]);
        assert_true(failing_allocator_is_clean(&h[i].memory));
    }
}

static void every_tree_and_instruction_set_finds_exactly_the_boxes_of_a_loop(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 1, 2, 8, 9, 16, 17, 257, 700, 5000};
    static const octree_values forms[] = {{"oct", "2", "0", ""}, {"quad", "1.25", "0", ""}, {"auto", "16", "0", ""}};
    uint64_t r = 61;
    for (int kind = 0; kind < SCENE_KINDS; kind++)
        for (int c = 0; c < 10; c++)
            for (int f = 0; f < 3; f++) {
                cull_box *boxes = scene_make(&r, (scene_kind)kind, counts[c]);
                hand_zone z;
                zone_of_boxes(boxes, counts[c], &z);
                must_select(&z.zone, boxes, &forms[f], &r, counts[c] > 1000 ? 18 : 27);
                hand_zone_free(&z);
                free(boxes);
            }
}

static void a_tree_of_five_levels_finds_them_too(void **state)
{
    (void)state;
    static const octree_values forms[] = {{"oct", "2", "0", ""}, {"quad", "2", "0", ""}};
    uint64_t r = 62;
    for (int f = 0; f < 2; f++) {
        cull_box *boxes = scene_make(&r, f ? SCENE_CITY : SCENE_SPREAD, ITEMS_MOST);
        hand_zone z;
        zone_of_boxes(boxes, ITEMS_MOST, &z);
        must_select(&z.zone, boxes, &forms[f], &r, 60);
        hand_zone_free(&z);
        free(boxes);
    }
}

// One plane through every box's height cuts all leaves: several times as many as a walk lists before it judges them.
static void a_plane_that_cuts_every_leaf_is_answered_item_by_item(void **state)
{
    (void)state;
    enum { SIDE = 150, COUNT = SIDE * SIDE };
    static cull_box boxes[COUNT];
    static uint8_t seen[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        const float x = (float)(i % SIDE), z = (float)(i / SIDE), height = i * 2654435761u >> 31 ? 1.0f : 0.25f;
        boxes[i] = (cull_box){{x, 0, z}, {x + 0.75f, height, z + 0.75f}};
    }
    hand_zone z;
    zone_of_boxes(boxes, COUNT, &z);
    static made_volumes v;
    uint64_t r = 65;
    volumes_make(&r, boxes, COUNT, 1, &v); // for its view
    const cull_plane above = {{0, 1, 0}, -0.5f};
    const cull_volume volume = {&above, 1, 0};
    for (int i = 0; i < ISA_COUNT; i++) {
        if (!octree_has_isa(isas[i])) continue;
        culler_host h;
        session s;
        const octree_values values = {"oct", "2", "0", isas[i]};
        culler_host_init(&h, 0);
        assert_int_equal(octree_open(&s, &h, &z.zone, &values), CULL_OK);
        session_select(&s, &v.view, &volume, 1);
        assert_true(s.run_count <= s.built.max_runs);
        memset(seen, 0, sizeof seen);
        for (uint32_t run = 0; run < s.run_count; run++)
            for (uint32_t p = s.runs[run].first; p < s.runs[run].first + s.runs[run].count; p++) seen[s.built.order[p]]++;
        for (uint32_t item = 0; item < COUNT; item++) assert_int_equal(seen[item], boxes[item].max.y >= 0.5f);
        session_close(&s);
        assert_true(failing_allocator_is_clean(&h.memory));
    }
    hand_zone_free(&z);
}

// The same scene shuffled, moved by whole steps of a coarse grid, and turned by a quarter: the same items, whatever the tree is then.
static void shuffled_moved_and_turned_scenes_show_the_same_items(void **state)
{
    (void)state;
    enum { COUNT = 3000 };
    static uint8_t first[COUNT], seen[COUNT];
    uint64_t r = 63;
    cull_box *boxes = scene_make(&r, SCENE_GRID, COUNT), *other = calloc(COUNT, sizeof *other);
    uint32_t names[COUNT];
    assert_non_null(other);
    for (uint32_t i = 0; i < COUNT; i++) names[i] = i;
    for (uint32_t i = COUNT; i-- > 1;) {
        const uint32_t k = random_below(&r, i + 1), spare = names[i];
        names[i] = names[k];
        names[k] = spare;
    }
    for (int change = 0; change < 3; change++) {
        const float by = change == 1 ? 640 : 0;
        for (uint32_t i = 0; i < COUNT; i++) {
            const cull_box b = boxes[names[i]];
            other[i] = change < 2 ? (cull_box){{b.min.x + by, b.min.y, b.min.z - by}, {b.max.x + by, b.max.y, b.max.z - by}}
                                  : (cull_box){{b.min.z, b.min.y, -b.max.x}, {b.max.z, b.max.y, -b.min.x}};
        }
        hand_zone z[2];
        culler_host h[2];
        session s[2];
        const octree_values values = {"auto", "2", "0", "auto"};
        for (int i = 0; i < 2; i++) {
            zone_of_boxes(i ? other : boxes, COUNT, &z[i]);
            culler_host_init(&h[i], 0);
            assert_int_equal(octree_open(&s[i], &h[i], &z[i].zone, &values), CULL_OK);
        }
        uint32_t found = 0;
        for (int q = 0; q < 50; q++) { // planes along axes, between grid lines: no rounding
            cull_plane p[4], moved[4];
            for (int k = 0; k < 4; k++) {
                const float sign = k % 2 ? 1.0f : -1.0f, at = (float)(10 * (int)random_below(&r, 16) - 80) + 0.5f;
                p[k] = (cull_plane){{k < 2 ? sign : 0, 0, k < 2 ? 0 : sign}, 30 - sign * at};
                moved[k] = p[k];
                if (change == 1) moved[k].offset -= k < 2 ? sign * by : -sign * by;
                if (change == 2) moved[k].normal = (cull_vec3){p[k].normal.z, 0, -p[k].normal.x};
            }
            const cull_volume volume[2] = {{p, 4, 0}, {moved, 4, 0}};
            cull_view view = {.eye = {0, 0, 0, 1}};
            for (int i = 0; i < 2; i++) {
                session_select(&s[i], &view, &volume[i], 1);
                assert_null(octree_set(&s[i], i ? seen : first));
            }
            for (uint32_t i = 0; i < COUNT; i++) {
                assert_int_equal(seen[i], first[names[i]]);
                found += seen[i];
            }
        }
        assert_true(found > 1000);
        for (int i = 0; i < 2; i++) {
            session_close(&s[i]);
            hand_zone_free(&z[i]);
        }
    }
    free(other);
    free(boxes);
}

static void backface_drops_the_walls_that_frustum_drops(void **state)
{
    (void)state;
    enum { HOUSES = 300 };
    uint64_t r = 64;
    hand_zone z;
    hand_zone_init(&z);
    for (uint32_t i = 0; i < HOUSES; i++) {
        cull_box box;
        for (int k = 0; k < 3; k++) {
            (&box.min.x)[k] = (float)random_between(&r, -100, 100);
            (&box.max.x)[k] = (&box.min.x)[k] + (float)random_between(&r, 0.5, 10);
        }
        hand_zone_box(&z, box, i % 2 ? FACE_OUT : FACE_IN, i % 5 ? 0 : CULL_ITEM_TWO_SIDED);
        if (i % 7 == 0) hand_zone_cluster(&z, box);
    }
    hand_zone_end(&z);
    static uint8_t seen[2][10 * HOUSES];
    const char *const frustum_values[] = {"1", "auto"};
    uint32_t dropped = 0;
    for (int isa = 0; isa < ISA_COUNT; isa++) {
        culler_host h[2];
        session s[2];
        const octree_values values = {"auto", "2", "1", isas[isa]};
        if (!octree_has_isa(isas[isa])) continue;
        for (int i = 0; i < 2; i++) culler_host_init(&h[i], 0);
        assert_int_equal(octree_open(&s[0], &h[0], &z.zone, &values), CULL_OK);
        assert_int_equal(session_open(&s[1], &h[1], plugin_named("frustum"), &z.zone, frustum_values), CULL_OK);
        for (uint32_t q = 0; q < 60; q++) {
            static made_volumes v;
            const cull_box at = cull_box_at(&z.zone.boxes, random_below(&r, z.zone.item_count));
            volumes_make(&r, &at, 1, q % 20, &v);
            for (int i = 0; i < 2; i++) session_select(&s[i], &v.view, v.volumes, v.count);
            assert_null(octree_set(&s[0], seen[0]));
            assert_null(session_set(&s[1], seen[1]));
            assert_memory_equal(seen[0], seen[1], z.zone.item_count);
            for (uint32_t i = 0; i < z.zone.item_count && v.count && !v.volumes[0].plane_count; i++) dropped += !seen[0][i];
        }
        for (int i = 0; i < 2; i++) session_close(&s[i]);
    }
    assert_true(dropped > 1000);
    hand_zone_free(&z);
}

static double middle_distance(const session *s, const cull_box *boxes, const float *eye, uint32_t from, uint32_t to)
{
    double sum = 0;
    uint32_t met = 0;
    for (uint32_t i = 0; i < s->run_count; i++)
        for (uint32_t p = s->runs[i].first; p < s->runs[i].first + s->runs[i].count; p++, met++) {
            const cull_box b = boxes[s->built.order[p]];
            const double x = (double)b.min.x - (double)eye[0], z = (double)b.min.z - (double)eye[2];
            if (met >= from && met < to) sum += sqrt(x * x + z * z) / (to - from);
        }
    return sum;
}

static void runs_come_near_to_far(void **state)
{
    (void)state;
    static const uint32_t counts[] = {2000, 10000, ITEMS_MOST};
    uint64_t r = 65;
    for (int c = 0; c < 3; c++) {
        cull_box *boxes = scene_make(&r, SCENE_CITY, counts[c]);
        hand_zone z;
        culler_host h;
        session s;
        zone_of_boxes(boxes, counts[c], &z);
        culler_host_init(&h, 0);
        const octree_values values = {"auto", "2", "0", "auto"};
        assert_int_equal(octree_open(&s, &h, &z.zone, &values), CULL_OK);
        uint32_t nearer = 0;
        double near_sum = 0, far_sum = 0; // of the first third of the items, and of the last
        for (int q = 0; q < 100; q++) { // a wedge of 90 degrees
            const double turn = q * 0.7, half = 0.785398;
            cull_plane p[2];
            cull_view view = {.eye = {(float)random_between(&r, -900, 900), 2, (float)random_between(&r, -900, 900), 1}};
            for (int k = 0; k < 2; k++) {
                const double a = turn + (k ? 1.570796 - half : half - 1.570796);
                p[k].normal = (cull_vec3){(float)cos(a), 0, (float)sin(a)};
                p[k].offset = -(p[k].normal.x * view.eye[0] + p[k].normal.z * view.eye[2]);
            }
            const cull_volume volume = {p, 2, 0};
            session_select(&s, &view, &volume, 1);
            uint32_t items = 0;
            for (uint32_t i = 0; i < s.run_count; i++) items += s.runs[i].count;
            if (items < 30) continue;
            const double first = middle_distance(&s, boxes, view.eye, 0, items / 3), last = middle_distance(&s, boxes, view.eye, items - items / 3, items);
            near_sum += first;
            far_sum += last;
            nearer += first <= last;
        }
        if (nearer < 75 || near_sum > 0.75 * far_sum) // roughly: child by child, no item is sorted
            fail_msg("%u items: %u of 100 views near to far, %g m before %g m", counts[c], nearer, near_sum, far_sum);
        session_close(&s);
        hand_zone_free(&z);
        free(boxes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_tree_and_instruction_set_finds_exactly_the_boxes_of_a_loop),
        cmocka_unit_test(a_tree_of_five_levels_finds_them_too),
        cmocka_unit_test(a_plane_that_cuts_every_leaf_is_answered_item_by_item),
        cmocka_unit_test(shuffled_moved_and_turned_scenes_show_the_same_items),
        cmocka_unit_test(backface_drops_the_walls_that_frustum_drops),
        cmocka_unit_test(runs_come_near_to_far),
    };
    return cmocka_run_group_tests_name("octree select", tests, NULL, NULL);
}
