// Trees of real maps' zones: all that tree.h promises, by every choice.
// SPDX-License-Identifier: MIT
#include "tree_scenes.h"

#include "host/core/zone_data.h"
#include "tests/common/test.h"
#include "tests/compile/whole_fixture.h"

#include <stdio.h>
#include <stdlib.h>

static char *text_of(const char *name, size_t *size)
{
    char path[1024];
    const char *folder = getenv("PORTCULLIS_SCENES");
    snprintf(path, sizeof path, "%s/%s", folder ? folder : "", name);
    FILE *file = folder ? fopen(path, "rb") : NULL;
    if (!file) return NULL;
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(*size + 1);
    if (!text || fread(text, 1, *size, file) != *size) abort();
    fclose(file);
    return text;
}

static void check_zone(const scene *s, uint32_t zone)
{
    static const bsp_wish wishes[4] = {
        {BSP_WHOLE, BSP_BALANCE, 0, 0}, {BSP_SPLIT_LEAVES, BSP_SAH, 0, 0}, {BSP_WHOLE, BSP_FIRST, 0, 0}, {BSP_SPLIT_NODES, BSP_SAH, 0, 0}};
    zone_data data;
    assert_int_equal(zone_data_open(&(zone_data_request){s, zone, 0}, allocator_heap(), &data), RESULT_OK);
    for (int i = 0; i < 4; i++) {
        culler_host host;
        bsp_tree tree;
        const bsp_source from = {&data.zone, NULL, wishes[i]};
        culler_host_init(&host, 0);
        assert_int_equal(bsp_tree_build(&host.host, &from, &tree), CULL_OK);
        assert_no_fault(tree_fault(&data.zone, &tree));
        assert_int_equal(tree.bent_leaves, 0);
        assert_int_equal(tree.boxed_walls, 0);
        assert_true(tree.slack < 1e-4); // metres
        assert_true(tree.entry_count < 5 * tree.item_count);
        tree_end(&host, &tree);
    }
    zone_data_close(&data);
}

static void check_map(const char *name, portal_choice portals)
{
    whole_map map = {.portals = portals};
    whole made;
    report silent = {0};
    char *text = text_of(name, &map.size);
    if (!text) {
        print_message("SKIPPED: %s is not in the folder that PORTCULLIS_SCENES names\n", name);
        skip();
    }
    map.text = text;
    assert_int_equal(whole_compile(&map, &silent, allocator_heap(), &made), RESULT_OK);
    for (uint32_t z = 0; z < made.scene->zone_count; z++) check_zone(made.scene, z);
    whole_free(&made, allocator_heap());
    free(text);
}

static void the_trees_of_dm4_are_right(void **state)
{
    (void)state;
    check_map("quake/dm4.map", PORTALS_DOORS);
}

static void the_trees_of_e1m1_are_right_room_by_room(void **state)
{
    (void)state;
    check_map("quake/e1m1.map", PORTALS_AUTO);
}

static void the_trees_of_a_map_of_turned_and_round_brushes_are_right(void **state)
{
    (void)state;
    check_map("librequake/lqdm7.map", PORTALS_DOORS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_trees_of_dm4_are_right),
        cmocka_unit_test(the_trees_of_e1m1_are_right_room_by_room),
        cmocka_unit_test(the_trees_of_a_map_of_turned_and_round_brushes_are_right),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
