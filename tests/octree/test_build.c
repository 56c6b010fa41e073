// Tests of octree's build: options, hard input in bounded time, a baked index, memory that runs out, the same bytes everywhere.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "host/core/hierarchy_check.h"
#include "host/core/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const octree_values usual = {"auto", "2", "0", "auto"};

static void options_that_mean_nothing_are_refused_by_name(void **state)
{
    (void)state;
    static const octree_values bad[] = {{"cube", "2", "0", "auto"}, {"auto", "1", "0", "auto"},   {"auto", "17", "0", "auto"},  {"auto", "2,5", "0", "auto"},
                                        {"auto", "", "0", "auto"},  {"auto", "1e1", "0", "auto"}, {"auto", "1.2.3", "0", "auto"}, {"auto", "-2", "0", "auto"},
                                        {"auto", "2", "2", "auto"}, {"auto", "2", "0", "mmx"},    {"auto", "nan", "0", "auto"}};
    static const char *const keys[] = {"kind=", "loose=", "loose=", "loose=", "loose=", "loose=", "loose=", "loose=", "backface=", "isa=", "loose="};
    hand_zone z;
    zone_of_boxes(NULL, 0, &z);
    for (int i = 0; i < 11; i++) {
        culler_host h;
        session s;
        culler_host_init(&h, 0);
        assert_int_equal(octree_open(&s, &h, &z.zone, &bad[i]), CULL_ERR_OPTION);
        assert_non_null(strstr(h.last_line, keys[i]));
        assert_true(failing_allocator_is_clean(&h.memory));
    }
    hand_zone_free(&z);
}

// A small volume in a scene that is hard for a tree still costs little: the tree divides, whatever lies in it.
static void hard_scenes_are_still_divided(void **state)
{
    (void)state;
    static const scene_kind kinds[] = {SCENE_OUTLIER, SCENE_GIANT, SCENE_LINE, SCENE_PLANE, SCENE_CITY, SCENE_HUGE, SCENE_SPREAD};
    uint64_t r = 81;
    for (int k = 0; k < 7; k++) {
        cull_box *boxes = scene_make(&r, kinds[k], ITEMS_MOST);
        hand_zone z;
        culler_host h;
        session s;
        zone_of_boxes(boxes, ITEMS_MOST, &z);
        culler_host_init(&h, 0);
        assert_int_equal(octree_open(&s, &h, &z.zone, &usual), CULL_OK);
        const cull_box b = boxes[7];
        cull_plane p[6];
        for (int i = 0; i < 3; i++) {
            cull_vec3 n = {0, 0, 0};
            (&n.x)[i] = 1;
            p[2 * i] = (cull_plane){n, -(&b.min.x)[i]};
            (&n.x)[i] = -1;
            p[2 * i + 1] = (cull_plane){n, (&b.max.x)[i]};
        }
        const cull_volume volume = {p, 6, 0};
        cull_view view = {.eye = {b.min.x, b.min.y, b.min.z, 1}};
        session_select(&s, &view, &volume, 1);
        if (s.run_count < 1 || s.nodes_visited > 150) fail_msg("scene %d: %u runs, %u blocks of 1,900 looked at", kinds[k], s.run_count, s.nodes_visited);
        session_close(&s);
        hand_zone_free(&z);
        free(boxes);
    }
}

// OGRE's trap: an octree fitted to the box of a flat scene has cells as flat as it, and nothing fits them.
static void a_flat_scene_costs_no_more_than_the_same_scene_in_a_cube(void **state)
{
    (void)state;
    uint32_t nodes[2];
    for (int is_cube = 0; is_cube < 2; is_cube++) {
        uint64_t r = 82;
        cull_box *boxes = scene_make(&r, SCENE_CITY, ITEMS_MOST);
        if (is_cube) { // two that make the scene's box one
            boxes[0] = (cull_box){{-1000, 1990, -1000}, {-999, 1991, -999}};
            boxes[1] = (cull_box){{-1000, 1995, -1000}, {-999, 1996, -999}};
        }
        hand_zone z;
        culler_host h;
        session s;
        const octree_values values = {"oct", "2", "0", "auto"};
        zone_of_boxes(boxes, ITEMS_MOST, &z);
        culler_host_init(&h, 0);
        assert_int_equal(octree_open(&s, &h, &z.zone, &values), CULL_OK);
        nodes[is_cube] = 0;
        for (int q = 0; q < 50; q++) {
            static made_volumes v;
            volumes_make(&r, boxes + 2, ITEMS_MOST - 2, 1, &v);
            session_select(&s, &v.view, v.volumes, 1);
            nodes[is_cube] += s.nodes_visited;
        }
        session_close(&s);
        hand_zone_free(&z);
        free(boxes);
    }
    if (nodes[0] > nodes[1] * 5 / 4 || nodes[1] > nodes[0] * 5 / 4) fail_msg("%u blocks flat, %u in a cube", nodes[0], nodes[1]);
}

// ---- The baked index ----

typedef struct baked_host {
    culler_host h;
    const cull_zone *zone;
    cull_blob blob;
} baked_host;

static const void *lend_blob(const cull_host *host, const cull_zone *zone, const char *id)
{
    const baked_host *b = (const baked_host *)host->user;
    return zone == b->zone && strcmp(id, CULL_EXT_BLOB) == 0 && b->blob.bytes ? &b->blob : NULL;
}

static void baked_host_init(baked_host *b, const cull_zone *zone, const void *bytes, uint64_t size)
{
    culler_host_init(&b->h, 0);
    b->zone = zone;
    b->blob = (cull_blob){bytes, size};
    b->h.host.get_extension = lend_blob;
}

static uint8_t *save(const session *s, uint64_t *size)
{
    const cull_bake *bake = octree_extension(s, CULL_EXT_BAKE);
    *size = bake->save(s->culler, NULL, 0);
    uint8_t *blob = aligned_alloc(64, (*size + 127) / 64 * 64);
    assert_non_null(blob);
    memset(blob, 0xa5, *size + 1);
    assert_int_equal(bake->save(s->culler, blob, *size - 1), *size);
    assert_int_equal(blob[0], 0xa5); // too small: nothing written
    assert_int_equal(bake->save(s->culler, blob, *size), *size);
    assert_int_equal(blob[*size], 0xa5);
    return blob;
}

static uint64_t hash_of(const uint8_t *bytes, uint64_t size)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (uint64_t i = 0; i < size; i++) hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

static void must_be_the_same_tree(const session *a, const session *b)
{
    const cull_hierarchy *x = octree_extension(a, CULL_EXT_HIERARCHY), *y = octree_extension(b, CULL_EXT_HIERARCHY);
    assert_int_equal(x->node_count, y->node_count);
    assert_int_equal(x->depth, y->depth);
    for (uint32_t n = 0; n < x->node_count; n++) {
        cull_node p = x->nodes[n], q = y->nodes[n];
        if (!p.child_count) p.first_child = q.first_child = 0; // says nothing
        assert_memory_equal(&p, &q, sizeof p);
    }
    if (a->item_count) assert_memory_equal(a->built.order, b->built.order, a->item_count * sizeof *a->built.order);
}

static void a_baked_tree_is_the_built_one_and_a_damaged_one_is_refused(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 1, 40, 700};
    uint64_t r = 83;
    uint32_t refused = 0;
    for (int kind = 0; kind < SCENE_KINDS; kind++)
        for (int c = 0; c < 4; c++) {
            cull_box *boxes = scene_make(&r, (scene_kind)kind, counts[c]);
            hand_zone z;
            baked_host b;
            session built, loaded, damaged;
            uint64_t size;
            zone_of_boxes(boxes, counts[c], &z);
            baked_host_init(&b, &z.zone, NULL, 0);
            b.h.host.user = &b;
            assert_int_equal(octree_open(&built, &b.h, &z.zone, &usual), CULL_OK);
            uint8_t *blob = save(&built, &size);
            b.blob = (cull_blob){blob, size};
            assert_int_equal(octree_open(&loaded, &b.h, &z.zone, &usual), CULL_OK);
            must_be_the_same_tree(&built, &loaded);
            session_close(&loaded);
            for (int q = 0; q < 60; q++) {
                const uint64_t at = random_bits(&r) % size, cut = random_bits(&r) % size;
                const uint8_t was = blob[at];
                blob[at] ^= (uint8_t)(1u << q % 8);
                b.blob.size = q % 5 == 4 ? cut : size;
                assert_int_equal(octree_open(&damaged, &b.h, &z.zone, &usual), CULL_ERR_BLOB);
                blob[at] = was;
                refused++;
            }
            const octree_values other = {"auto", "3", "0", "auto"}; // another wish's
            b.blob.size = size;
            assert_int_equal(octree_open(&damaged, &b.h, &z.zone, &other), CULL_ERR_BLOB);
            session_close(&built);
            free(blob);
            hand_zone_free(&z);
            free(boxes);
        }
    assert_true(refused > 2000);
}

// Words changed and the check made right again: what still loads is a sound tree.
static void a_forged_tree_is_refused_or_sound(void **state)
{
    (void)state;
    enum { COUNT = 300, HEAD = 40, CHECK_AT = 32 };
    uint64_t r = 84;
    uint32_t loads = 0;
    cull_box *boxes = scene_make(&r, SCENE_CITY, COUNT);
    hand_zone z;
    baked_host b;
    session built, forged;
    uint64_t size;
    zone_of_boxes(boxes, COUNT, &z);
    baked_host_init(&b, &z.zone, NULL, 0);
    b.h.host.user = &b;
    assert_int_equal(octree_open(&built, &b.h, &z.zone, &usual), CULL_OK);
    uint8_t *blob = save(&built, &size), *copy = aligned_alloc(64, (size + 63) / 64 * 64);
    assert_non_null(copy);
    for (int q = 0; q < 4000; q++) {
        memcpy(copy, blob, size);
        uint32_t *words = (uint32_t *)(void *)(copy + HEAD);
        const uint32_t count = (uint32_t)(size - HEAD) / 4, a = random_below(&r, count), c = random_below(&r, count), spare = words[a];
        if (q % 2) words[a] += random_below(&r, 3) - 1;
        else words[a] = words[c], words[c] = spare; // two of the order change places: another order
        uint64_t check = 0xcbf29ce484222325u;
        for (uint32_t i = 0; i < count; i++) check = (check ^ words[i]) * 0x100000001b3u;
        memcpy(copy + CHECK_AT, &check, sizeof check);
        b.blob = (cull_blob){copy, size};
        const cull_result result = octree_open(&forged, &b.h, &z.zone, &usual);
        if (result != CULL_OK) {
            assert_int_equal(result, CULL_ERR_BLOB);
            continue;
        }
        static made_volumes v;
        volumes_make(&r, boxes, COUNT, 2, &v);
        session_select(&forged, &v.view, v.volumes, 2);
        octree_must_be(&forged, boxes, &v, "forged");
        session_close(&forged);
        loads++;
    }
    assert_true(loads > 100 && loads < 3500);
    free(copy);
    free(blob);
    session_close(&built);
    hand_zone_free(&z);
    free(boxes);
}

// Bytes that gcc's build gives and clang's too, with every instruction set.
static void the_tree_has_the_same_bytes_everywhere(void **state)
{
    (void)state;
    static const uint64_t golden[] = {0xba30fe7c90772aceu, 0xd9200dfeaf128094u, 0x7ab319a8934b4e0du, 0xb91cc500e3ddd0e9u};
    static const scene_kind kinds[] = {SCENE_CITY, SCENE_SPREAD, SCENE_GRID, SCENE_NESTED};
    for (int k = 0; k < 4; k++) {
        uint64_t r = 85, size;
        cull_box *boxes = scene_make(&r, kinds[k], 5000);
        hand_zone z;
        culler_host h;
        session s;
        zone_of_boxes(boxes, 5000, &z);
        culler_host_init(&h, 0);
        assert_int_equal(octree_open(&s, &h, &z.zone, &usual), CULL_OK);
        uint8_t *blob = save(&s, &size);
        if (hash_of(blob, size) != golden[k]) fail_msg("scene %d: 0x%llxu", k, (unsigned long long)hash_of(blob, size));
        free(blob);
        session_close(&s);
        hand_zone_free(&z);
        free(boxes);
    }
}

// ---- Memory ----

static void every_allocation_may_fail(void **state)
{
    (void)state;
    uint64_t r = 86;
    for (int is_baked = 0; is_baked < 2; is_baked++) {
        cull_box *boxes = scene_make(&r, SCENE_CITY, 3000);
        hand_zone z;
        baked_host b;
        session s;
        uint64_t size;
        zone_of_boxes(boxes, 3000, &z);
        baked_host_init(&b, &z.zone, NULL, 0);
        b.h.host.user = &b;
        assert_int_equal(octree_open(&s, &b.h, &z.zone, &usual), CULL_OK);
        uint8_t *blob = save(&s, &size);
        session_close(&s);
        uint64_t k = 1;
        for (;; k++) {
            baked_host_init(&b, &z.zone, is_baked ? blob : NULL, size);
            b.h.memory.fail_at = k;
            b.h.host.user = &b;
            const cull_result result = octree_open(&s, &b.h, &z.zone, &usual);
            if (result == CULL_OK) break;
            assert_int_equal(result, CULL_ERR_MEMORY);
            assert_true(failing_allocator_is_clean(&b.h.memory));
        }
        session_close(&s);
        assert_true(failing_allocator_is_clean(&b.h.memory));
        assert_true(k > 10);
        free(blob);
        hand_zone_free(&z);
        free(boxes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_that_mean_nothing_are_refused_by_name),
        cmocka_unit_test(hard_scenes_are_still_divided),
        cmocka_unit_test(a_flat_scene_costs_no_more_than_the_same_scene_in_a_cube),
        cmocka_unit_test(a_baked_tree_is_the_built_one_and_a_damaged_one_is_refused),
        cmocka_unit_test(a_forged_tree_is_refused_or_sound),
        cmocka_unit_test(the_tree_has_the_same_bytes_everywhere),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("octree build", tests, NULL, NULL);
}
