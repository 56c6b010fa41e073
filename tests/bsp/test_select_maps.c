// Tests of bsp's select on compiled maps: every zone's set is that of a loop over its items, within what frustum finds.
// SPDX-License-Identifier: MIT
#include "cells_fixture.h"
#include "select_fixture.h"

#include "host/core/hierarchy_check.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct zone_sets { uint8_t *bsp, *frustum, *loop, *facing; } zone_sets;

typedef struct zone_sessions { session bsp, frustum; } zone_sessions;

static uint32_t check_view(const cull_zone *zone, zone_sessions *s, const made_view *v, zone_sets *sets)
{
    const cull_volume all = {NULL, 0, 0};
    uint32_t found = 0;
    session_select(&s->bsp, &v->view, v->volumes, v->volume_count);
    assert_null(session_set_any_order(&s->bsp, sets->bsp));
    session_select(&s->frustum, &v->view, v->volumes, v->volume_count);
    assert_null(session_set_any_order(&s->frustum, sets->frustum));
    session_select(&s->frustum, &v->view, &all, 1);
    assert_null(session_set_any_order(&s->frustum, sets->facing));
    loop_set(zone, v, sets->loop);
    for (uint32_t i = 0; i < zone->item_count; i++) {
        assert_int_equal(sets->bsp[i], sets->loop[i] & sets->facing[i]);
        assert_true(sets->bsp[i] <= sets->frustum[i]);
        found += sets->bsp[i];
    }
    return found;
}

// A filter's view of it is checked by the host's own check.
static void check_hierarchy(const cull_zone *zone, const session *s)
{
    const cull_hierarchy *h = s->plugin->get_extension(s->culler, CULL_EXT_HIERARCHY);
    cull_box *boxes = calloc(zone->item_count + 1, sizeof *boxes);
    hand_zone ordered;
    const char *fault;
    assert_non_null(boxes);
    for (uint32_t place = 0; place < zone->item_count; place++) boxes[place] = cull_box_at(&zone->boxes, s->built.order[place]);
    zone_of_boxes(boxes, zone->item_count, &ordered);
    assert_int_equal(hierarchy_check(h, &ordered.zone, allocator_heap(), &fault), RESULT_OK);
    if (fault) fail_msg("%s", fault);
    hand_zone_free(&ordered);
    free(boxes);
}

static uint32_t check_zone(uint64_t *r, const cull_zone *zone, uint32_t views)
{
    static const char *const of_frustum[] = {"1", "auto"};
    static const bsp_values values = {"1", "0", "balance", "off", "auto"};
    const cull_plugin *frustum = plugin_named("frustum");
    zone_sessions s;
    culler_host h;
    zone_sets sets;
    uint8_t *bytes = calloc((size_t)zone->item_count + 1, 4);
    uint32_t found = 0;
    assert_non_null(frustum);
    assert_non_null(bytes);
    sets = (zone_sets){bytes, bytes + zone->item_count, bytes + 2 * zone->item_count, bytes + 3 * zone->item_count};
    culler_host_init(&h, 0);
    assert_int_equal(bsp_open(&s.bsp, &h, zone, &values), CULL_OK);
    assert_int_equal(session_open(&s.frustum, &h, frustum, zone, of_frustum), CULL_OK);
    check_hierarchy(zone, &s.bsp);
    for (uint32_t q = 0; q < views; q++) {
        static made_view v;
        view_fill(r, zone, 1 + q % 3, &v);
        found += check_view(zone, &s, &v, &sets);
    }
    session_close(&s.bsp);
    session_close(&s.frustum);
    assert_int_equal(h.memory.live_blocks, 0);
    free(bytes);
    return found;
}

static void on_map(const char *name, portal_choice portals, uint32_t views)
{
    cells_map map;
    uint64_t r = {61};
    uint32_t found = 0;
    if (!cells_map_open(name, portals, &map)) skip();
    for (uint32_t z = 0; z < map.whole.scene->zone_count; z++) found += check_zone(&r, &map.zones[z].zone, views);
    assert_true(found > 1000);
    cells_map_close(&map);
}

static void every_room_of_a_map_is_selected_as_a_loop_would(void **state)
{
    (void)state;
    on_map("quake/e1m1.map", PORTALS_AUTO, 40);
    on_map("librequake/lq_e0m8.map", PORTALS_AUTO, 40);
}

static void a_map_without_portals_is_selected_as_a_loop_would(void **state)
{
    (void)state;
    on_map("quake/dm4.map", PORTALS_NONE, 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_room_of_a_map_is_selected_as_a_loop_would),
        cmocka_unit_test(a_map_without_portals_is_selected_as_a_loop_would),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
