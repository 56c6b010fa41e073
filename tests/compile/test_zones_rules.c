// What makes a zone of a map and what does not, where published compilers differ: see expected_zones in test_zones_oracle.c.
// SPDX-License-Identifier: MIT
#include "tests/common/test.h"

#include "zones_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_BYTES = 16384 };

typedef struct map_text { char text[TEXT_BYTES]; size_t size; } map_text;

static void add(map_text *m, const char *text)
{
    const size_t size = strlen(text);
    assert_true(m->size + size < TEXT_BYTES);
    memcpy(m->text + m->size, text, size + 1);
    m->size += size;
}

static void add_box(map_text *m, const int low[3], const int high[3], const char *texture)
{
    char line[256];
    add(m, "{\n");
    for (int f = 0; f < 6; ++f) { // the low side of an axis, then the high one
        const int k = f / 2, side = f % 2, at = side ? high[k] : low[k];
        int p[3][3];
        for (int i = 0; i < 3; ++i) p[i][k] = at, p[i][(k + 1) % 3] = 0, p[i][(k + 2) % 3] = 0;
        p[1][(k + (side ? 2 : 1)) % 3] = 64;
        p[2][(k + (side ? 1 : 2)) % 3] = 64;
        snprintf(line, sizeof line, "( %d %d %d ) ( %d %d %d ) ( %d %d %d ) %s 0 0 0 1 1\n", p[0][0], p[0][1], p[0][2], p[1][0], p[1][1], p[1][2], p[2][0],
                 p[2][1], p[2][2], texture);
        add(m, line);
    }
    add(m, "}\n");
}

typedef enum wall_reach { WALLS_MEET_IN_EDGES, WALLS_MEET_IN_FACES } wall_reach;

// Six walls of 16 round the air of a box.
static void add_room(map_text *m, const int low[3], const int high[3], wall_reach reach)
{
    for (int k = 0; k < 3; ++k)
        for (int side = 0; side < 2; ++side) {
            int from[3], to[3];
            for (int i = 0; i < 3; ++i) {
                const int more = reach == WALLS_MEET_IN_FACES && i != k ? 16 : 0;
                from[i] = low[i] - more;
                to[i] = high[i] + more;
            }
            from[k] = side ? high[k] : low[k] - 16;
            to[k] = side ? high[k] + 16 : low[k];
            add_box(m, from, to, "wall");
        }
}

static void expect_zones(const map_text *m, uint32_t zones, uint32_t reached)
{
    report quiet = {0};
    compile_input *in = NULL;
    assert_int_equal(compile_input_map("t.map", m->text, m->size, NULL, allocator_heap(), &quiet, &in), RESULT_OK);
    compiled_zones *z = zones_of(in, PORTALS_NONE, NULL);
    oracle_zones o;
    oracle_bsp(in, &o);
    assert_int_equal(z->leak, 0);
    assert_int_equal(z->zone_count, zones);
    assert_int_equal(zones_reached(z), reached);
    assert_int_equal(o.leak, 0);
    assert_int_equal(o.regions, zones);
    assert_int_equal(o.reached, reached);
    compiled_zones_free(z);
    compile_input_free(in);
}

static const int low[3] = {0, 0, 0}, high[3] = {96, 96, 96};

static void walls_that_meet_along_edges_alone_seal(void **state)
{
    (void)state;
    for (int reach = WALLS_MEET_IN_EDGES; reach <= WALLS_MEET_IN_FACES; ++reach) {
        map_text m = {.size = 0};
        add(&m, "{\n\"classname\" \"worldspawn\"\n}\n{\n\"classname\" \"func_group\"\n");
        add_room(&m, low, high, (wall_reach)reach);
        add(&m, "}\n{\n\"classname\" \"monster_demon1\"\n\"origin\" \"48 40 24\"\n}\n");
        expect_zones(&m, 1, 1);
    }
}

static void tool_brushes_part_nothing(void **state)
{
    (void)state;
    static const char *const tools[4] = {"hint", "clip", "skip", "trigger"};
    static const int from[3] = {32, 0, 0}, to[3] = {64, 96, 96};
    for (int i = 0; i < 5; ++i) {
        map_text m = {.size = 0};
        add(&m, "{\n\"classname\" \"worldspawn\"\n");
        add_room(&m, low, high, WALLS_MEET_IN_FACES);
        add_box(&m, from, to, i < 4 ? tools[i] : "wall");
        add(&m, "}\n{\n\"classname\" \"light\"\n\"origin\" \"16 48 48\"\n}\n{\n\"classname\" \"light\"\n\"origin\" \"80 48 48\"\n}\n");
        expect_zones(&m, i < 4 ? 1 : 2, i < 4 ? 1 : 2);
    }
}

// Its brushes make nothing, but it is no point entity for that.
static void a_trigger_with_an_origin_reaches_no_zone(void **state)
{
    (void)state;
    static const int from[3] = {40, 40, 40}, to[3] = {56, 56, 56};
    map_text m = {.size = 0};
    add(&m, "{\n\"classname\" \"worldspawn\"\n");
    add_room(&m, low, high, WALLS_MEET_IN_FACES);
    add(&m, "}\n{\n\"classname\" \"trigger_once\"\n\"origin\" \"48 48 48\"\n");
    add_box(&m, from, to, "trigger");
    add(&m, "}\n");
    expect_zones(&m, 1, 0);
}

static void sky_is_solid_and_illusions_are_not(void **state)
{
    (void)state;
    static const int from[3] = {32, 0, 0}, to[3] = {64, 96, 96};
    static const struct { const char *class_name, *texture; uint32_t zones; } cases[6] = {
        {"func_group", "sky1", 2}, {"func_detail", "wall", 2}, {"func_detail_wall", "wall", 2}, {"func_detail_illusionary", "wall", 1},
        {"func_wall", "wall", 1},  {"func_door", "wall", 1}};
    for (int i = 0; i < 6; ++i) {
        map_text m = {.size = 0};
        add(&m, "{\n\"classname\" \"worldspawn\"\n");
        add_room(&m, low, high, WALLS_MEET_IN_FACES);
        add(&m, "}\n{\n\"classname\" \"");
        add(&m, cases[i].class_name);
        add(&m, "\"\n");
        add_box(&m, from, to, cases[i].texture);
        add(&m, "}\n{\n\"classname\" \"light\"\n\"origin\" \"16 48 48\"\n}\n{\n\"classname\" \"light\"\n\"origin\" \"80 48 48\"\n}\n");
        expect_zones(&m, cases[i].zones, cases[i].zones);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walls_that_meet_along_edges_alone_seal),
        cmocka_unit_test(tool_brushes_part_nothing),
        cmocka_unit_test(a_trigger_with_an_origin_reaches_no_zone),
        cmocka_unit_test(sky_is_solid_and_illusions_are_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
