// The application's API: what it opens, changes, culls, explains and refuses.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "fixture.h"

#include "tests/common/test.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <stdio.h>
#include <string.h>

static const double hall_crate[3] = {1.5, 1, 4}, kitchen_crate[3] = {14.5, 1, 4};

static cull_visible seen_from(api_bed *b, double x, double z, double yaw_deg)
{
    const cull_camera c = api_camera(x, z, yaw_deg);
    cull_visible seen = {.struct_size = sizeof seen};
    assert_int_equal(cull_scene_cull(b->view, &c, &seen), CULL_OK);
    return seen;
}

static void a_scene_tells_what_it_holds(void **state)
{
    api_bed *b = *state;
    cull_scene_info info = {.struct_size = sizeof info};
    assert_int_equal(cull_scene_describe(b->scene, &info), CULL_OK);
    assert_int_equal(info.zone_count, 3);
    assert_int_equal(info.portal_count, 1);
    assert_int_equal(info.door_count, 1);
    assert_int_equal(info.mover_count, 1);
    assert_int_equal(info.mover_capacity, 101);
    assert_true(info.min[0] == 0 && info.max[0] == 22);
    assert_string_equal(cull_scene_zone_name(b->scene, cull_scene_find_zone(b->scene, "kitchen")), "kitchen");
    assert_int_equal(cull_scene_find_zone(b->scene, "attic"), UINT32_MAX);
    assert_null(cull_scene_zone_name(b->scene, 99));
    info.struct_size = 4;
    assert_int_equal(cull_scene_describe(b->scene, &info), CULL_ERR_OPTION);
}

static void points_and_boxes_find_their_zones(void **state)
{
    api_bed *b = *state;
    uint32_t zones[4];
    const double in_hall[3] = {4, 1, 4}, on_border[3] = {8, 1, 4}, low[3] = {7, 1, 1}, high[3] = {9, 2, 2}, away[3] = {1000, 0, 0};
    assert_int_equal(cull_scene_zones_at(b->scene, in_hall, zones, 4), 1);
    assert_int_equal(zones[0], cull_scene_find_zone(b->scene, "hall"));
    assert_true(cull_scene_zones_at(b->scene, on_border, zones, 4) >= 2);
    assert_true(cull_scene_zones_of_box(b->scene, low, high, zones, 4) >= 2);
    assert_int_equal(cull_scene_zones_at(b->scene, away, zones, 4), 1);
    assert_int_equal(zones[0], cull_scene_find_zone(b->scene, "open"));
}

static void a_shut_door_hides_the_room_behind_it_until_it_is_opened(void **state)
{
    api_bed *b = *state;
    const uint32_t door = cull_scene_find_door(b->scene, "door");
    cull_visible seen = seen_from(b, 4, 4, 90);
    assert_false(api_sees_item_at(b, &seen, kitchen_crate));
    assert_int_equal(cull_scene_set_door(b->scene, door, 1), CULL_OK);
    seen = seen_from(b, 4, 4, 90);
    assert_true(api_sees_item_at(b, &seen, kitchen_crate));
    assert_int_equal(cull_scene_set_door(b->scene, door, 0), CULL_OK);
    seen = seen_from(b, 4, 4, 90);
    assert_false(api_sees_item_at(b, &seen, kitchen_crate));
    assert_int_equal(cull_scene_set_door(b->scene, 7, 1), CULL_ERR_ZONE);
    assert_non_null(strstr(b->log, "door 7"));
}

static void a_chain_is_swapped_between_two_frames_and_a_bad_one_changes_nothing(void **state)
{
    api_bed *b = *state;
    const uint32_t hall = cull_scene_find_zone(b->scene, "hall");
    static const char *const good[] = {"frustum", "none", "brute", "frustum+flood"};
    for (int i = 0; i < 4; ++i) {
        assert_int_equal(cull_scene_set_chain(b->scene, hall, good[i]), CULL_OK);
        const cull_visible seen = seen_from(b, 4, 4, -90);
        assert_true(api_sees_item_at(b, &seen, hall_crate));
    }
    assert_int_equal(cull_scene_set_chain(b->scene, hall, "nosuch"), CULL_ERR_OPTION);
    assert_non_null(strstr(b->log, "nosuch"));
    assert_int_equal(cull_scene_set_chain(b->scene, hall, "frustum[leaf"), CULL_ERR_OPTION);
    assert_int_equal(cull_scene_set_chain(b->scene, 99, "none"), CULL_ERR_ZONE);
    assert_int_equal(cull_scene_set_chain(b->scene, hall, NULL), CULL_ERR_OPTION);
    const cull_visible seen = seen_from(b, 4, 4, -90);
    assert_true(api_sees_item_at(b, &seen, hall_crate));
}

static void a_swap_is_built_beside_and_may_be_dropped(void **state)
{
    api_bed *b = *state;
    cull_scene_swap *swap = NULL, *unwanted = NULL;
    assert_int_equal(cull_scene_swap_build(b->scene, 1, "none", &swap), CULL_OK);
    assert_int_equal(cull_scene_swap_build(b->scene, 2, "none", &unwanted), CULL_OK);
    (void)seen_from(b, 4, 4, 0);
    assert_int_equal(cull_scene_swap_commit(b->scene, swap), CULL_OK);
    cull_scene_swap_drop(unwanted);
    cull_scene_swap_drop(NULL);
    const cull_visible seen = seen_from(b, 4, 4, -90);
    assert_true(api_sees_item_at(b, &seen, hall_crate));
}

static int sees_mover(const cull_visible *seen, uint32_t mover)
{
    int found = 0;
    for (uint32_t i = 0; i < seen->mover_count; ++i) found += seen->movers[i] == mover;
    return found;
}

static void movers_are_seen_where_they_are(void **state)
{
    api_bed *b = *state;
    const double low[3] = {2, 0, 6}, high[3] = {3, 1, 7}, far_low[3] = {12, 0, 6}, far_high[3] = {13, 1, 7}, bad[3] = {NAN, 0, 0};
    uint32_t mover = 0;
    assert_int_equal(cull_scene_mover_add(b->scene, low, high, &mover), CULL_OK);
    cull_visible seen = seen_from(b, 6, 4, -90);
    assert_int_equal(sees_mover(&seen, mover), 1);
    assert_int_equal(cull_scene_mover_move(b->scene, mover, far_low, far_high), CULL_OK);
    seen = seen_from(b, 6, 4, -90);
    assert_int_equal(sees_mover(&seen, mover), 0);
    assert_int_equal(cull_scene_mover_move(b->scene, mover, bad, high), CULL_ERR_ZONE);
    assert_int_equal(cull_scene_mover_remove(b->scene, mover), CULL_OK);
    assert_int_equal(cull_scene_mover_remove(b->scene, mover), CULL_ERR_ZONE);
    assert_int_equal(cull_scene_mover_move(b->scene, mover, low, high), CULL_ERR_ZONE);
}

static void explanations_name_door_and_zone(void **state)
{
    api_bed *b = *state;
    char text[4096];
    uint32_t order[64];
    cull_scene_item item = {.struct_size = sizeof item};
    assert_non_null(memset(text, 0, sizeof text));
    assert_true(cull_scene_explain(b->view, 0, text, sizeof text) > 0); // before any frame
    (void)seen_from(b, 4, 4, 90);
    const uint32_t kitchen = cull_scene_find_zone(b->scene, "kitchen");
    assert_true(cull_scene_zone_item_count(b->scene, kitchen) <= 64);
    cull_scene_order(b->scene, kitchen, order);
    uint32_t crate = UINT32_MAX;
    for (uint32_t i = 0; i < cull_scene_zone_item_count(b->scene, kitchen); ++i)
        if (cull_scene_item_get(b->scene, order[i], &item) == CULL_OK && strcmp(item.material, "crate") == 0) crate = order[i];
    assert_int_not_equal(crate, UINT32_MAX);
    const size_t length = cull_scene_explain(b->view, crate, text, sizeof text);
    assert_int_equal(length, strlen(text));
    assert_non_null(strstr(text, "door"));
    assert_non_null(strstr(text, "kitchen"));
    char part[8];
    assert_int_equal(cull_scene_explain(b->view, crate, part, sizeof part), length);
    assert_int_equal(strlen(part), 7);
}

static void what_cannot_be_opened_is_told_in_one_line(void **state)
{
    api_bed *b = *state;
    cull_scene *none = NULL;
    assert_int_equal(cull_scene_open("/nowhere/at/all.json", &b->options, &none), CULL_ERR_ZONE);
    assert_null(none);
    assert_non_null(strstr(b->log, "/nowhere/at/all.json"));
    cull_scene_options wrong = b->options;
    wrong.struct_size = 8;
    assert_int_equal(cull_scene_open(b->path, &wrong, &none), CULL_ERR_OPTION);
    wrong = b->options;
    wrong.chain = "nosuch";
    assert_int_equal(cull_scene_open(b->path, &wrong, &none), CULL_ERR_OPTION);
    assert_null(none);
    cull_camera c = api_camera(4, 4, 0);
    c.fovy_deg = NAN;
    cull_visible seen = {.struct_size = sizeof seen};
    assert_int_equal(cull_scene_cull(b->view, &c, &seen), CULL_ERR_OPTION);
    assert_int_equal(seen.zone_count, 0);
    seen.struct_size = 3;
    assert_int_equal(cull_scene_cull(b->view, &c, &seen), CULL_ERR_OPTION);
}

static void a_chain_of_the_file_that_cannot_be_is_told_with_file_and_zone(void **state)
{
    api_bed *b = *state;
    static const char text[] = "{\"portcullis\": 1, \"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,1]}], \"zones\": [{\"name\": \"attic\", \"chain\": \"nosuch\"}]}";
    char path[512], line[640];
    cull_scene *none = NULL;
    scratch_folder_name(&b->folder, "wrong.json", path, sizeof path);
    scratch_folder_write(&b->folder, "wrong.json", text, sizeof text - 1);
    assert_int_equal(cull_scene_open(path, &b->options, &none), CULL_ERR_OPTION);
    assert_null(none);
    snprintf(line, sizeof line, "%s: error: zone 'attic': no culler 'nosuch'; found: ", path);
    assert_non_null(strstr(b->log, line));
    const char *end = strchr(b->log, '\n');
    assert_non_null(end);
    assert_int_equal(end[1], 0); // one line
}

static void a_swap_of_another_scene_is_refused(void **state)
{
    api_bed *b = *state;
    cull_scene *other = NULL;
    cull_scene_swap *swap = NULL;
    assert_int_equal(cull_scene_open(b->path, &b->options, &other), CULL_OK);
    assert_int_equal(cull_scene_swap_build(other, 1, "none", &swap), CULL_OK);
    assert_int_equal(cull_scene_swap_commit(b->scene, swap), CULL_ERR_OPTION);
    assert_non_null(strstr(b->log, "another scene"));
    cull_scene_close(other);
    const cull_visible seen = seen_from(b, 4, 4, -90);
    assert_true(api_sees_item_at(b, &seen, hall_crate));
}

static void fields_that_mean_nothing_yet_must_be_zero(void **state)
{
    api_bed *b = *state;
    cull_visible seen = {.struct_size = sizeof seen};
    cull_camera cameras[4] = {api_camera(4, 4, 0), api_camera(4, 4, 0), api_camera(4, 4, 0), api_camera(4, 4, 0)};
    cameras[0].flags = 0x80;
    cameras[1].reserved = 1;
    cameras[2].width_px = 4000000000u;
    cameras[3].struct_size = 8;
    for (int i = 0; i < 4; ++i) assert_int_equal(cull_scene_cull(b->view, &cameras[i], &seen), CULL_ERR_OPTION);
    cull_scene_options options = b->options;
    cull_scene *none = NULL;
    options.reserved = 5;
    assert_int_equal(cull_scene_open(b->path, &options, &none), CULL_ERR_OPTION);
    cull_scene_item item = {.struct_size = sizeof item};
    assert_int_equal(cull_scene_item_get(b->scene, 9999, &item), CULL_ERR_ZONE);
    assert_non_null(strstr(b->log, "item 9999"));
}

// ---- Several views at once ----

enum { TURNS = 200 };
typedef struct turner {
    cull_scene_view *view;
    uint64_t items[TURNS];
} turner;

static void *turn(void *user)
{
    turner *t = user;
    for (int i = 0; i < TURNS; ++i) {
        const cull_camera c = api_camera(2 + i % 12, 4, i * 7.0);
        cull_visible seen = {.struct_size = sizeof seen};
        cull_scene_cull(t->view, &c, &seen);
        t->items[i] = seen.items * 1000 + seen.mover_count;
    }
    return NULL;
}

static void four_views_in_two_threads_see_what_one_sees_alone(void **state)
{
    api_bed *b = *state;
    turner alone = {.view = b->view}, four[4] = {{0}};
    pthread_t threads[4];
    turn(&alone);
    for (int i = 0; i < 4; ++i) assert_int_equal(cull_scene_view_open(b->scene, &four[i].view), CULL_OK);
    for (int pair = 0; pair < 4; pair += 2) {
        for (int i = pair; i < pair + 2; ++i) assert_int_equal(pthread_create(&threads[i], NULL, turn, &four[i]), 0);
        for (int i = pair; i < pair + 2; ++i) pthread_join(threads[i], NULL);
    }
    for (int i = 0; i < 4; ++i) assert_memory_equal(four[i].items, alone.items, sizeof alone.items);
    cull_scene_view_close(four[0].view); // the others go with the scene
}

#define IN_BED(f) cmocka_unit_test_setup_teardown(f, api_bed_open, api_bed_close)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_BED(a_scene_tells_what_it_holds),
        IN_BED(points_and_boxes_find_their_zones),
        IN_BED(a_shut_door_hides_the_room_behind_it_until_it_is_opened),
        IN_BED(a_chain_is_swapped_between_two_frames_and_a_bad_one_changes_nothing),
        IN_BED(a_swap_is_built_beside_and_may_be_dropped),
        IN_BED(movers_are_seen_where_they_are),
        IN_BED(explanations_name_door_and_zone),
        IN_BED(what_cannot_be_opened_is_told_in_one_line),
        IN_BED(a_chain_of_the_file_that_cannot_be_is_told_with_file_and_zone),
        IN_BED(a_swap_of_another_scene_is_refused),
        IN_BED(fields_that_mean_nothing_yet_must_be_zero),
        IN_BED(four_views_in_two_threads_see_what_one_sees_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
