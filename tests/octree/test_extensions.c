// Tests of what octree lends beside select: hierarchy, rays, explanations.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "host/core/hierarchy_check.h"
#include "host/core/memory.h"
#include "tests/common/ray_check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const octree_values forms[] = {{"oct", "2", "0", "auto"}, {"quad", "1.5", "0", "auto"}, {"auto", "4", "0", "auto"}};
enum { FORM_COUNT = 3 };

typedef struct stand { // a scene and its session
    cull_box *boxes;
    hand_zone z;
    culler_host h;
    session s;
} stand;

static void stand_open(stand *t, uint64_t *r, scene_kind kind, uint32_t count, const octree_values *values)
{
    t->boxes = scene_make(r, kind, count);
    zone_of_boxes(t->boxes, count, &t->z);
    culler_host_init(&t->h, 0);
    assert_int_equal(octree_open(&t->s, &t->h, &t->z.zone, values), CULL_OK);
}

static void stand_close(stand *t)
{
    session_close(&t->s);
    assert_true(failing_allocator_is_clean(&t->h.memory));
    hand_zone_free(&t->z);
    free(t->boxes);
}

// ---- Hierarchy ----

static int is_same_box(cull_box a, cull_box b)
{
    return cull_box_contains(a, b) && cull_box_contains(b, a);
}

// Every item once, runs right, boxes tight and inside their parents', children fewer than their parent has.
static void must_be_a_tree(const stand *t, const cull_hierarchy *h)
{
    const uint32_t items = t->z.zone.item_count;
    uint8_t *seen = calloc((size_t)items + 1, 1);
    uint32_t nodes = 1, deepest = 1, *depths = calloc(h->node_count, sizeof *depths);
    assert_true(seen && depths && h->node_count > 0 && h->items == NULL);
    assert_int_equal(h->nodes[0].subtree.count, items);
    depths[0] = 1;
    for (uint32_t n = 0; n < h->node_count; n++) {
        const cull_node *node = &h->nodes[n];
        cull_box tight = cull_box_none();
        assert_int_equal(node->first_item, node->subtree.first);
        uint32_t next = node->first_item + node->item_count;
        for (uint32_t i = node->first_item; i < next; i++) {
            tight = cull_box_union(tight, t->boxes[t->s.built.order[i]]);
            assert_int_equal(seen[i]++, 0);
        }
        if (node->child_count) assert_int_equal(node->first_child, nodes); // side by side, none left out
        nodes += node->child_count;
        assert_true(nodes <= h->node_count);
        for (uint32_t c = node->first_child; c < node->first_child + node->child_count; c++) {
            assert_int_equal(h->nodes[c].subtree.first, next);
            assert_in_range(h->nodes[c].subtree.count, 1, node->subtree.count - 1);
            next += h->nodes[c].subtree.count;
            tight = cull_box_union(tight, h->nodes[c].box);
            depths[c] = depths[n] + 1;
            if (depths[c] > deepest) deepest = depths[c];
        }
        assert_int_equal(next, node->subtree.first + node->subtree.count);
        if (items) assert_true(is_same_box(node->box, tight));
    }
    for (uint32_t i = 0; i < items; i++) assert_int_equal(seen[i], 1);
    assert_int_equal(nodes, h->node_count);
    assert_int_equal(h->depth, deepest);
    free(seen);
    free(depths);
}

static void the_hierarchy_holds_every_item_once_in_tight_boxes_of_runs(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 1, 8, 9, 300, 3000};
    uint64_t r = 71;
    for (int kind = 0; kind < SCENE_KINDS; kind++)
        for (int c = 0; c < 6; c++)
            for (int f = 0; f < FORM_COUNT; f++) {
                stand t;
                const char *fault;
                stand_open(&t, &r, (scene_kind)kind, counts[c], &forms[f]);
                const cull_hierarchy *h = octree_extension(&t.s, CULL_EXT_HIERARCHY);
                must_be_a_tree(&t, h);
                if (counts[c] > 1000 && h->node_count > counts[c]) fail_msg("scene %d: %u nodes", kind, h->node_count);
                hand_zone laid;
                zone_in_order(&t.z.zone, t.s.built.order, &laid);
                assert_int_equal(hierarchy_check(h, &laid.zone, allocator_heap(), &fault), RESULT_OK);
                if (fault) fail_msg("scene %d, %u items, form %d: %s", kind, counts[c], f, fault);
                hand_zone_free(&laid);
                stand_close(&t);
            }
}

// ---- Rays ----

static ray_check ray_check_of(const stand *t)
{
    return (ray_check){&t->z.zone, t->s.built.order, t->s.culler, octree_extension(&t->s, CULL_EXT_RAY)};
}

static void a_segment_finds_the_boxes_it_touches_nearest_first(void **state)
{
    (void)state;
    uint64_t r = 72;
    for (int kind = 0; kind < SCENE_HUGE; kind++)
        for (int f = 0; f < FORM_COUNT; f++) {
            stand t;
            stand_open(&t, &r, (scene_kind)kind, 500, &forms[f]);
            const ray_check check = ray_check_of(&t);
            for (int q = 0; q < 60; q++) {
                cull_vec3 a, b;
                for (int k = 0; k < 3; k++) {
                    (&a.x)[k] = (float)random_between(&r, -120, 120);
                    (&b.x)[k] = q % 4 == k ? (&a.x)[k] : (float)random_between(&r, -120, 120); // along an axis' plane now and then
                }
                if (q % 7 == 0) a = t.boxes[random_below(&r, 500)].max;
                if (q % 10 == 9) b = a; // a point
                segment_must_be_right(&check, a, b);
            }
            stand_close(&t);
        }
}

static void a_box_finds_the_boxes_it_touches(void **state)
{
    (void)state;
    uint64_t r = 73;
    for (int kind = 0; kind < SCENE_KINDS; kind++) {
        stand t;
        stand_open(&t, &r, (scene_kind)kind, 500, &forms[kind % FORM_COUNT]);
        const ray_check check = ray_check_of(&t);
        for (int q = 0; q < 60; q++) {
            cull_box box = t.boxes[random_below(&r, 500)];
            for (int k = 0; k < 3; k++) (&box.max.x)[k] += (float)random_between(&r, 0, 30);
            box_must_be_right(&check, box);
        }
        stand_close(&t);
    }
}

// ---- Explanations ----

static void explain_gives_a_true_reason(void **state)
{
    (void)state;
    uint64_t r = 74;
    static uint8_t seen[ITEMS_MOST];
    for (int kind = 0; kind < SCENE_KINDS; kind++) {
        stand t;
        stand_open(&t, &r, (scene_kind)kind, 300, &forms[kind % FORM_COUNT]);
        const cull_explain *explain = octree_extension(&t.s, CULL_EXT_EXPLAIN);
        for (uint32_t q = 0; q < 12; q++) {
            static made_volumes v;
            char text[300], cut[8];
            volumes_make(&r, t.boxes, 300, q % 4, &v);
            session_select(&t.s, &v.view, v.volumes, v.count);
            assert_null(octree_set(&t.s, seen));
            const cull_visit visit = {.view = &v.view, .volumes = v.volumes, .volume_count = v.count, .scratch = t.s.scratch};
            for (uint32_t place = 0; place < 300; place++) {
                const uint32_t item = t.s.built.order[place];
                const size_t length = explain->item(t.s.query, &visit, place, text, sizeof text);
                if (strncmp(text, seen[item] ? "kept: " : "dropped: ", seen[item] ? 6 : 9) != 0) fail_msg("drawn %d: %s", seen[item], text);
                assert_int_equal(length, strlen(text));
                assert_int_equal(explain->item(t.s.query, &visit, place, cut, sizeof cut), length);
                uint32_t plane, volume;
                const char *at = strstr(text, "outside plane ");
                if (!at) continue;
                assert_int_equal(sscanf(at, "outside plane %u of volume %u", &plane, &volume), 2);
                assert_false(cull_plane_touches(v.volumes[volume].planes[plane], t.boxes[item]));
            }
            explain->item(t.s.query, &visit, 300, text, sizeof text);
            assert_string_equal(text, "there is no item 300");
        }
        stand_close(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hierarchy_holds_every_item_once_in_tight_boxes_of_runs),
        cmocka_unit_test(a_segment_finds_the_boxes_it_touches_nearest_first),
        cmocka_unit_test(a_box_finds_the_boxes_it_touches),
        cmocka_unit_test(explain_gives_a_true_reason),
    };
    return cmocka_run_group_tests_name("octree extensions", tests, NULL, NULL);
}
