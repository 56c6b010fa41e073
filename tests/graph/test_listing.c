// Tests that items and movers are judged by one rule: what scene_builder_finish lists in a zone is what host/core/graph
// finds for the item's box.
// SPDX-License-Identifier: MIT
#include "host/core/graph.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ITEMS = 3000, ZONES_MOST = 256 };

static void add_zone(scene_builder *b, uint32_t place, const builder_hull *hulls, uint32_t hull_count, uint32_t parent)
{
    char name[32];
    snprintf(name, sizeof name, "zone %u", place);
    const builder_zone zone = {.name = name, .hulls = hulls, .hull_count = hull_count, .parent = parent};
    uint32_t number;
    const char *fault = "";
    if (scene_builder_zone(b, &zone, &number, &fault) != RESULT_OK) fail_msg("the zone %s", fault);
    assert_int_equal(number, place);
}

static void box_planes(scene_solid_plane *planes, const double min[3], const double max[3])
{
    memset(planes, 0, 6 * sizeof *planes);
    for (int k = 0; k < 3; k++) {
        planes[2 * k].normal[k] = -1;
        planes[2 * k].distance = -min[k];
        planes[2 * k + 1].normal[k] = 1;
        planes[2 * k + 1].distance = max[k];
    }
}

// Eight rooms by eight, 8 m wide; in each third a closet whose corner an oblique plane cuts off.
static void add_rooms(scene_builder *b, const double corner[3], uint32_t parent)
{
    for (uint32_t i = 0, next = parent == SCENE_NONE ? 0 : 1; i < 64; i++) {
        const double x = corner[0] + 8 * (i % 8), y = corner[1], z = corner[2] + 8 * (double)(i / 8);
        scene_solid_plane planes[14];
        const double wall[3] = {x + 8, y + 4, z + 4}, low[3] = {x, y, z + 4}, high[3] = {x + 8, y + 4, z + 8};
        box_planes(planes, (const double[]){x, y, z}, wall); // a room of two hulls
        box_planes(planes + 6, low, high);
        const uint32_t room = next++;
        add_zone(b, room, (const builder_hull[]){{planes, 6}, {planes + 6, 6}}, 2, parent);
        if (i % 3 > 0) continue;
        box_planes(planes, (const double[]){x + 1, y, z + 1}, (const double[]){x + 6, y + 3, z + 6});
        planes[6] = (scene_solid_plane){{0.6, 0, 0.8}, 0.6 * (x + 6) + 0.8 * (z + 6) - 2};
        add_zone(b, next++, &(builder_hull){planes, 7}, 1, room);
    }
}

// A triangle that fills its box to the corners, on eighths of a metre as often as not.
static void add_item(scene_builder *b, const double corner[3], uint64_t *random)
{
    builder_vertex vertices[3];
    double min[3], max[3];
    uint32_t first;
    memset(vertices, 0, sizeof vertices);
    const int is_even = (int)random_below(random, 2);
    for (int k = 0; k < 3; k++) {
        min[k] = random_between(random, -3, k == 1 ? 5 : 66);
        max[k] = min[k] + random_between(random, 0.125, random_below(random, 20) ? 3 : 20);
        if (is_even) {
            min[k] = floor(min[k] * 8) / 8;
            max[k] = floor(max[k] * 8) / 8;
        }
        vertices[0].position[k] = corner[k] + min[k];
        vertices[1].position[k] = corner[k] + max[k];
        vertices[2].position[k] = corner[k] + (k == 1 ? max[k] : min[k]);
    }
    assert_int_equal(scene_builder_vertices(b, vertices, 3, 0, &first), RESULT_OK);
    const uint32_t own[] = {first, first + 1, first + 2};
    assert_int_equal(scene_builder_item(b, &(builder_item){.indices = own, .index_count = 3, .polygon_count = 1}), RESULT_OK);
}

static scene *scene_make(const double corner[3], int has_ground)
{
    scene_builder *b;
    scene *s = NULL;
    report silent = {0};
    uint32_t number;
    uint64_t random = 21;
    assert_int_equal(scene_builder_open(allocator_heap(), &b), RESULT_OK);
    assert_int_equal(scene_builder_material(b, "m", 1, 0, &number), RESULT_OK);
    assert_int_equal(scene_builder_object(b, "o", 1, &number), RESULT_OK);
    if (has_ground) add_zone(b, 0, NULL, 0, SCENE_NONE);
    add_rooms(b, corner, has_ground ? 0 : SCENE_NONE);
    for (int i = 0; i < ITEMS; i++) add_item(b, corner, &random);
    assert_int_equal(scene_builder_finish(b, "test", &silent, &s), RESULT_OK);
    scene_builder_close(b);
    return s;
}

static uint32_t zones_that_list(const scene *s, uint32_t item, uint32_t *zones)
{
    uint32_t count = 0;
    for (uint32_t z = 0; z < s->zone_count; z++) {
        const uint32_t *items = s->zone_items + s->zones[z].first_item;
        uint32_t low = 0, high = s->zones[z].item_count;
        while (low < high) {
            const uint32_t middle = (low + high) / 2;
            if (items[middle] < item) low = middle + 1;
            else high = middle;
        }
        if (low < s->zones[z].item_count && items[low] == item) zones[count++] = z;
    }
    return count;
}

static void assert_listed_as_found(const double corner[3], int has_ground)
{
    scene *s = scene_make(corner, has_ground);
    graph *g;
    uint32_t in_none = 0, in_several = 0;
    assert_int_equal(graph_open(s, allocator_heap(), &g), RESULT_OK);
    for (uint32_t i = 0; i < s->item_count; i++) {
        uint32_t listed[ZONES_MOST], found[ZONES_MOST];
        const double min[3] = {s->whole.origin[0] + (double)s->boxes.min_x[i], s->whole.origin[1] + (double)s->boxes.min_y[i],
                               s->whole.origin[2] + (double)s->boxes.min_z[i]};
        const double max[3] = {s->whole.origin[0] + (double)s->boxes.max_x[i], s->whole.origin[1] + (double)s->boxes.max_y[i],
                               s->whole.origin[2] + (double)s->boxes.max_z[i]};
        const uint32_t listed_count = zones_that_list(s, i, listed);
        uint32_t count = graph_zones_of_box(g, min, max, found, ZONES_MOST);
        in_none += count == 0;
        in_several += count > 1;
        if (count == 0) found[count++] = s->zone_count - 1; // the stray zone
        assert_int_equal(count, listed_count);
        assert_memory_equal(found, listed, count * sizeof *found);
    }
    assert_true(has_ground ? in_none == 0 : in_none == s->stray_items && in_none > 0);
    assert_true(in_several > ITEMS / 10);
    graph_close(g);
    scene_free(s, allocator_heap());
}

static void items_are_listed_in_the_zones_that_the_graph_finds(void **state)
{
    (void)state;
    assert_listed_as_found((const double[]){0, 0, 0}, 0);
    assert_listed_as_found((const double[]){0, 0, 0}, 1);
}

static void items_far_from_the_origin_are_listed_in_the_zones_that_the_graph_finds(void **state)
{
    (void)state;
    assert_listed_as_found((const double[]){1e7, -1e5, -1e7}, 0);
    assert_listed_as_found((const double[]){-1e7, 1e3, 1e7}, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(items_are_listed_in_the_zones_that_the_graph_finds),
        cmocka_unit_test(items_far_from_the_origin_are_listed_in_the_zones_that_the_graph_finds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
