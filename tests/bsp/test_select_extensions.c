// Tests of what bsp lends beside select: its hierarchy, rays, explanations, figures, and its baked index.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "select_fixture.h"

#include "host/core/hierarchy_check.h"
#include "host/core/memory.h"
#include "tests/common/ray_check.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ITEMS_MOST = 400 };
static const bsp_values forms[] = {{"0", "0", "balance", "off", "auto"}, {"0", "1", "sah", "off", "auto"}, {"0", "node", "first", "off", "auto"}};
enum { FORM_COUNT = sizeof forms / sizeof *forms };

static const void *extension(const session *s, const char *id)
{
    const void *found = s->plugin->get_extension(s->culler, id);
    assert_non_null(found);
    return found;
}

// ---- Hierarchy ----

// What a filter that walks it keeps: items of nodes that touch a volume.
static void walk_hierarchy(const cull_hierarchy *h, const cull_volume *volume, uint8_t *kept)
{
    uint8_t *is_met = calloc(h->node_count + 1, 1);
    assert_non_null(is_met);
    if (h->node_count) is_met[0] = 1;
    for (uint32_t n = 0; n < h->node_count; n++) {
        const cull_node *node = &h->nodes[n];
        if (!is_met[n] || !cull_volume_touches(volume, node->box)) continue;
        for (uint32_t i = node->first_item; i < node->first_item + node->item_count; i++) kept[h->items[i]] = 1;
        for (uint32_t c = 0; c < node->child_count; c++) is_met[node->first_child + c] = 1;
    }
    free(is_met);
}

static void the_hierarchy_is_sound_and_a_filter_that_walks_it_loses_nothing(void **state)
{
    (void)state;
    uint64_t r = {51};
    static const uint32_t counts[] = {0, 1, 9, 60, 300};
    uint64_t kept_sum = 0, needed_sum = 0;
    for (int kind = 0; kind < SCENE_KIND_COUNT; kind++)
        for (int c = 0; c < 5; c++)
            for (int f = 0; f < FORM_COUNT; f++) {
                hand_zone w;
                hand_zone laid;
                culler_host host;
                session s;
                const char *fault;
                scene_fill(&r, (scene_kind)kind, counts[c], &w);
                culler_host_init(&host, 0);
                assert_int_equal(bsp_open(&s, &host, &w.zone, &forms[f]), CULL_OK);
                const cull_hierarchy *h = extension(&s, CULL_EXT_HIERARCHY);
                zone_in_order(&w.zone, s.built.order, &laid);
                assert_int_equal(hierarchy_check(h, &laid.zone, allocator_heap(), &fault), RESULT_OK);
                if (fault) fail_msg("kind %d, %u items, form %d: %s", kind, counts[c], f, fault);
                for (int q = 0; q < 20; q++) {
                    static made_view v;
                    static uint8_t kept[ITEMS_MOST], needed[ITEMS_MOST];
                    view_fill(&r, &w.zone, 1, &v);
                    memset(kept, 0, sizeof kept);
                    walk_hierarchy(h, &v.volumes[0], kept);
                    for (uint32_t k = 0; k < v.parts[0].plane_count; k++) v.parts[0].planes[k].offset -= 1e-4f; // rounding apart
                    loop_set(&w.zone, &v, needed);
                    for (uint32_t place = 0; place < w.zone.item_count; place++) {
                        const uint32_t item = s.built.order[place];
                        assert_true(kept[place] >= needed[item]);
                        kept_sum += kept[place];
                        needed_sum += needed[item];
                    }
                }
                hand_zone_free(&laid);
                session_close(&s);
                hand_zone_free(&w);
            }
    assert_true(needed_sum > 10000 && kept_sum < 4 * needed_sum); // and it culls
}

// ---- Rays ----

static ray_check ray_check_of(const hand_zone *w, const session *s)
{
    return (ray_check){&w->zone, s->built.order, s->culler, extension(s, CULL_EXT_RAY)};
}

static void a_segment_finds_the_boxes_it_touches_nearest_first(void **state)
{
    (void)state;
    uint64_t r = {52};
    for (int kind = 0; kind < SCENE_KIND_COUNT; kind++)
        for (int f = 0; f < FORM_COUNT; f++) {
            hand_zone w;
            culler_host h;
            session s;
            scene_fill(&r, (scene_kind)kind, 200, &w);
            culler_host_init(&h, 0);
            assert_int_equal(bsp_open(&s, &h, &w.zone, &forms[f]), CULL_OK);
            const ray_check check = ray_check_of(&w, &s);
            for (int q = 0; q < 100; q++) {
                cull_vec3 a, b;
                for (int k = 0; k < 3; k++) {
                    (&a.x)[k] = (float)random_between(&r, -50, 50);
                    (&b.x)[k] = q % 4 == k ? (&a.x)[k] : (float)random_between(&r, -50, 50); // along an axis' plane now and then
                }
                if (q % 10 == 9) b = a; // a point
                if (q % 7 == 0 && w.zone.position_count) a = w.positions[random_bits(&r) % w.zone.position_count];
                segment_must_be_right(&check, a, b);
            }
            session_close(&s);
            hand_zone_free(&w);
        }
}

static void a_box_finds_the_boxes_it_touches(void **state)
{
    (void)state;
    uint64_t r = {53};
    for (int kind = 0; kind < SCENE_KIND_COUNT; kind++) {
        hand_zone w;
        culler_host h;
        session s;
        scene_fill(&r, (scene_kind)kind, 200, &w);
        culler_host_init(&h, 0);
        assert_int_equal(bsp_open(&s, &h, &w.zone, &forms[0]), CULL_OK);
        const ray_check check = ray_check_of(&w, &s);
        for (int q = 0; q < 100; q++) {
            cull_box box;
            for (int k = 0; k < 3; k++) {
                (&box.min.x)[k] = (float)random_between(&r, -50, 50);
                (&box.max.x)[k] = (&box.min.x)[k] + (float)random_between(&r, 0, 30);
            }
            box_must_be_right(&check, box);
        }
        session_close(&s);
        hand_zone_free(&w);
    }
}

// ---- Explanations ----

// Returns 1 where it takes several planes to drop it.
static uint32_t must_explain(const hand_zone *w, const session *s, const made_view *v, uint32_t place, int is_drawn)
{
    const cull_explain *explain = extension(s, CULL_EXT_EXPLAIN);
    const cull_visit visit = {.view = &v->view, .volumes = v->volumes, .volume_count = v->volume_count, .scratch = s->scratch};
    const uint32_t item = s->built.order[place];
    char text[300], cut[8];
    const size_t length = explain->item(s->query, &visit, place, text, sizeof text);
    if ((strncmp(text, "kept: ", 6) == 0) != is_drawn) fail_msg("item %u, drawn %d: %s", item, is_drawn, text);
    assert_int_equal(length, strlen(text));
    assert_int_equal(explain->item(s->query, &visit, place, cut, sizeof cut), length);
    assert_int_equal(strlen(cut), 7);
    assert_int_equal(strncmp(text, "dropped: ", 9) == 0, !is_drawn);
    uint32_t volume, plane;
    const char *at = strstr(text, "outside plane ");
    if (at) { // all of it is, and no other volume has it
        assert_int_equal(sscanf(at, "outside plane %u of volume %u", &plane, &volume), 2);
        const cull_volume one = {&v->volumes[volume].planes[plane], 1, 0};
        assert_int_equal(item_touches(&w->zone, item, &one), 0);
    }
    at = strstr(text, "together leave nothing");
    if (at) {
        assert_int_equal(sscanf(text, "dropped: the planes of volume %u", &volume), 1);
        assert_int_equal(item_touches(&w->zone, item, &v->volumes[volume]), 0);
        for (uint32_t k = 0; k < v->volumes[volume].plane_count; k++) { // each alone has some of it
            const cull_volume one = {&v->volumes[volume].planes[k], 1, 0};
            assert_int_equal(item_touches(&w->zone, item, &one), 1);
        }
    }
    at = strstr(text, "is inside volume ");
    if (at && is_drawn) {
        assert_int_equal(sscanf(at, "is inside volume %u", &volume), 1);
        assert_int_equal(item_touches(&w->zone, item, &v->volumes[volume]), 1);
    }
    if (strstr(text, "shows only its back")) assert_true(w->items[item].flags == CULL_ITEM_WALL);
    return strstr(text, "together leave nothing") != NULL;
}

static void explain_gives_a_true_reason(void **state)
{
    (void)state;
    const bsp_values values[] = {{"0", "0", "balance", "off", "auto"}, {"1", "0", "balance", "off", "auto"}, {"1", "0", "balance", "exact", "auto"}};
    uint64_t r = {54};
    uint32_t together = 0;
    for (int kind = 0; kind < SCENE_KIND_COUNT; kind++)
        for (int o = 0; o < 3; o++) {
            hand_zone w;
            culler_host h;
            session s;
            scene_fill(&r, (scene_kind)kind, 100, &w);
            culler_host_init(&h, 0);
            assert_int_equal(bsp_open(&s, &h, &w.zone, &values[o]), CULL_OK);
            for (int q = 0; q < 12; q++) {
                static made_view v;
                static uint8_t seen[ITEMS_MOST];
                view_fill(&r, &w.zone, (uint32_t)q % 4, &v);
                session_select(&s, &v.view, v.volumes, v.volume_count);
                assert_null(session_set_any_order(&s, seen));
                for (uint32_t place = 0; place < w.zone.item_count; place++) together += must_explain(&w, &s, &v, place, seen[s.built.order[place]]);
            }
            char text[64];
            const cull_visit none = {.scratch = s.scratch};
            ((const cull_explain *)extension(&s, CULL_EXT_EXPLAIN))->item(s.query, &none, w.zone.item_count, text, sizeof text);
            assert_string_equal(text, "there is no item 100");
            session_close(&s);
            hand_zone_free(&w);
        }
    assert_true(together > 4);
}

// ---- Figures ----

static double figure(const session *s, const char *name)
{
    const cull_figures *f = extension(s, CULL_EXT_FIGURES);
    for (uint32_t i = 0; i < f->count; i++)
        if (strcmp(f->figures[i].name, name) == 0) return f->figures[i].value;
    fail_msg("no figure '%s'", name);
    return 0;
}

static void figures_tell_of_the_tree(void **state)
{
    (void)state;
    uint64_t r = {55};
    hand_zone w;
    culler_host h;
    session s[2];
    const bsp_values values[] = {{"0", "0", "balance", "off", "auto"}, {"0", "0", "balance", "rect", "auto"}};
    scene_fill(&r, SCENE_ROOMS, 120, &w);
    culler_host_init(&h, 0);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(bsp_open(&s[i], &h, &w.zone, &values[i]), CULL_OK);
        assert_true(figure(&s[i], "leaves") == figure(&s[i], "nodes") + 1); // a binary tree
        assert_true(figure(&s[i], "listings") >= 120 + figure(&s[i], "items_spanning"));
        assert_true(figure(&s[i], "depth") >= 6 && figure(&s[i], "depth") <= figure(&s[i], "nodes") + 1);
        assert_true(figure(&s[i], "splits") > 0);
    }
    assert_true(figure(&s[1], "cells") >= figure(&s[1], "leaves"));
    assert_true(figure(&s[1], "openings") > 0);
    for (int i = 0; i < 2; i++) session_close(&s[i]);
    hand_zone_free(&w);
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

static void a_baked_index_finds_the_same_and_a_damaged_one_is_refused(void **state)
{
    (void)state;
    uint64_t r = {56};
    for (int f = 0; f < FORM_COUNT; f++) {
        hand_zone w;
        static baked_host b;
        session built, loaded, damaged;
        scene_fill(&r, SCENE_MIXED, 120, &w);
        culler_host_init(&b.h, 0);
        b.h.host.get_extension = lend_blob;
        b.zone = &w.zone;
        b.blob = (cull_blob){NULL, 0};
        assert_int_equal(bsp_open(&built, &b.h, &w.zone, &forms[f]), CULL_OK);
        const cull_bake *bake = extension(&built, CULL_EXT_BAKE);
        const uint64_t size = bake->save(built.culler, NULL, 0);
        uint8_t *bytes = aligned_alloc(64, (size_t)(size + 63) / 64 * 64);
        assert_non_null(bytes);
        assert_int_equal(bake->save(built.culler, bytes, size), size);
        b.blob = (cull_blob){bytes, size};
        assert_int_equal(bsp_open(&loaded, &b.h, &w.zone, &forms[f]), CULL_OK);
        assert_memory_equal(built.built.order, loaded.built.order, w.zone.item_count * sizeof(uint32_t));
        for (int q = 0; q < 20; q++) {
            static made_view v;
            view_fill(&r, &w.zone, 2, &v);
            session_select(&built, &v.view, v.volumes, 2);
            session_select(&loaded, &v.view, v.volumes, 2);
            assert_int_equal(built.run_count, loaded.run_count);
            if (built.run_count) assert_memory_equal(built.runs, loaded.runs, built.run_count * sizeof(cull_run));
        }
        for (int q = 0; q < 40; q++) {
            const uint64_t at = random_bits(&r) % size;
            const uint8_t bit = (uint8_t)(1u << random_bits(&r) % 8);
            bytes[at] ^= bit;
            const uint64_t blocks = b.h.memory.live_blocks;
            assert_int_equal(bsp_open(&damaged, &b.h, &w.zone, &forms[f]), CULL_ERR_BLOB);
            assert_int_equal(b.h.memory.live_blocks, blocks);
            bytes[at] ^= bit;
        }
        session_close(&built);
        session_close(&loaded);
        assert_int_equal(b.h.memory.live_blocks, 0);
        free(bytes);
        hand_zone_free(&w);
    }
}

// ---- The library ----

static void the_library_exports_exactly_one_symbol(void **state)
{
    (void)state;
    (void)bsp_or_skip();
    char command[4200], line[512], found[512] = "";
    snprintf(command, sizeof command, "nm -D --defined-only '%s/bsp.culler.so'", getenv("PORTCULLIS_PLUGINS"));
    FILE *nm = popen(command, "r");
    assert_non_null(nm);
    int symbols = 0;
    while (fgets(line, sizeof line, nm)) {
        if (strstr(line, "__asan") || strstr(line, "__ubsan") || strstr(line, "__odr_asan") || strstr(line, "__tsan")) continue;
        symbols++;
        snprintf(found, sizeof found, "%s", line);
    }
    if (pclose(nm) != 0) {
        fprintf(stderr, "SKIPPED: nm is missing\n");
        skip();
    }
    assert_int_equal(symbols, 1);
    assert_non_null(strstr(found, " " CULL_ENTRY_SYMBOL));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hierarchy_is_sound_and_a_filter_that_walks_it_loses_nothing),
        cmocka_unit_test(a_segment_finds_the_boxes_it_touches_nearest_first),
        cmocka_unit_test(a_box_finds_the_boxes_it_touches),
        cmocka_unit_test(explain_gives_a_true_reason),
        cmocka_unit_test(figures_tell_of_the_tree),
        cmocka_unit_test(a_baked_index_finds_the_same_and_a_damaged_one_is_refused),
        cmocka_unit_test(the_library_exports_exactly_one_symbol),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
