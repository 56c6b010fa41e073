// JSON scenes with brushes: order, names, doors and all that stands beside the brushes come through to the compiled scene;
// what is wrong is told with file, line, column and key.
// SPDX-License-Identifier: MIT
#include "json_fixture.h"

#include "host/import/import.h"
#include "tests/common/failing_allocator.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROCK "{\"box\": {\"min\": [-1,-1,-1], \"max\": [9,4,5]}}"
#define ROOM_A "{\"operation\": \"subtract\", \"box\": {\"min\": [0,0,0], \"max\": [4,3,4]}}"
#define ROOM_B "{\"operation\": \"subtract\", \"box\": {\"min\": [4,0,0], \"max\": [8,3,4]}}"
#define GATE "{\"operation\": \"portal\", \"name\": \"gate\", \"box\": {\"min\": [3.9,-1,-1], \"max\": [4.1,4,5]}"
#define INFOS "\"zone_info\": [{\"name\": \"west\", \"at\": [1,1,1], \"chain\": \"frustum\"}, {\"name\": \"east\", \"at\": [7,1,1]}]"

// ---- Brushes ----

static void included_brushes_come_first_and_where_they_are_put(void **state)
{
    (void)state;
    const memory_file files[] = {{"room.json", HEAD "\"brushes\": [\n{\"box\": {\"min\": [0,0,0], \"max\": [1,1,1]}}]}"}, {0}};
    compile_input *in = brushes_of(HEAD "\"brushes\": [{\"operation\": \"subtract\", \"box\": {\"min\": [0,0,0], \"max\": [9,9,9]}}],\n"
                                        "\"include\": [{\"file\": \"room.json\", \"at\": [10,0,0]}, {\"file\": \"room.json\", \"at\": [20,0,0], \"scale\": 2}]}", files);
    assert_int_equal(in->brush_count, 3);
    assert_int_equal(in->brushes[2].kind, BRUSH_SUBTRACT);
    assert_int_equal(in->brushes[0].min[0], 10 * 8192);
    assert_int_equal(in->brushes[1].max[0], 22 * 8192);
    assert_int_equal(in->faces[in->brushes[1].first_face].line, 3);
    assert_int_equal(in->faces[in->brushes[2].first_face].line, 2);
    compile_input_free(in);
}

static void materials_mean_what_they_mean_in_a_map(void **state)
{
    (void)state;
    compile_input *in = brushes_of(HEAD "\"brushes\": [{\"box\": {\"min\": [0,0,0], \"max\": [1,1,1]}},\n"
                                        "{\"box\": {\"min\": [0,1,0], \"max\": [1,2,1]}, \"material\": \"*pond\"},\n"
                                        "{\"box\": {\"min\": [0,2,0], \"max\": [1,3,1]}, \"material\": \"clip\"},\n"
                                        "{\"box\": {\"min\": [0,3,0], \"max\": [1,4,1]}, \"material\": \"sky1\"}]}", NULL);
    assert_int_equal(in->brush_count, 3);
    assert_int_equal(in->brushes_dropped, 1);
    assert_int_equal(in->brushes[1].role, BRUSH_LIQUID);
    assert_int_equal(in->brushes[2].role, BRUSH_STRUCTURE);
    assert_int_equal(in->materials[in->faces[in->brushes[2].first_face].material].flags, MATERIAL_SKY);
    assert_string_equal(in->materials[in->faces[0].material].name, "default");
    compile_input_free(in);
}

static void textures_lie_upright_at_their_scale(void **state)
{
    (void)state;
    compile_input *in = brush_of("{\"box\": {\"min\": [0,0,0], \"max\": [1,1,1]}, \"texture\": {\"scale\": 2, \"offset\": [0.25, -1]}}");
    for (uint32_t f = 0; f < 6; ++f) {
        const cull_wide_plane p = plane_table_get(in->planes, in->faces[f].plane);
        const double(*rows)[4] = (const double(*)[4])in->faces[f].texture;
        assert_true(rows[0][3] == 0.25 && rows[1][3] == -1);
        for (int i = 0; i < 2; ++i) {
            double length = 0, along = 0;
            for (int k = 0; k < 3; ++k) {
                length += rows[i][k] * rows[i][k];
                along += rows[i][k] * (double)p.normal[k];
            }
            assert_true(length == 0.25 && along == 0);
        }
        if (p.normal[1] == 0) assert_true(rows[0][1] == 0 && rows[1][1] == -0.5); // down the wall
    }
    compile_input_free(in);
}

// ---- What comes through ----

static void zones_take_names_and_chains_and_portals_names_and_doors(void **state)
{
    (void)state;
    compiled c = compiled_of(brushes_of(HEAD "\"brushes\": [" ROCK "," ROOM_A "," ROOM_B "," GATE ", \"door\": \"d\"}],\n" INFOS
                                             ", \"starts\": [{\"at\": [2,1,2]}],\n\"doors\": [{\"name\": \"c\"}, {\"name\": \"d\", \"open\": false, \"mover\": \"m\"}],\n"
                                             "\"movers\": [{\"name\": \"m\", \"box\": {\"min\": [3.9,0,0], \"max\": [4.1,3,4]}, \"open\": [0,3,0]}]}", NULL));
    const scene *s = c.scene;
    assert_int_equal(s->zone_count, 2);
    assert_string_equal(s->zones[0].name, "west");
    assert_string_equal(s->zones[0].chain, "frustum");
    assert_string_equal(s->zones[1].name, "east");
    assert_null(s->zones[1].chain);
    assert_int_equal(s->portal_count, 1);
    assert_string_equal(s->portals[0].name, "gate");
    assert_int_equal(s->door_count, 2);
    assert_int_equal(s->portals[0].door, 1);
    assert_string_equal(s->doors[1].name, "d");
    assert_int_equal(s->doors[1].at_rest, DOORS_SHUT);
    assert_int_equal(s->doors[1].mover, mover_of(s, "m"));
    assert_int_equal(s->place_count, 3);
    assert_true(s->is_map);
    compiled_free(&c);
}

static void what_stands_beside_the_brushes_comes_along(void **state)
{
    (void)state;
    const memory_file files[] = {{"t.obj", "v 1 1 1\nv 2 1 1\nv 1 2 1\nf 1 2 3\n"}, {0}};
    compiled c = compiled_of(brushes_of(HEAD "\"brushes\": [" ROCK "," ROOM_A "," ROOM_B "," GATE "}],\n" INFOS ",\n"
                                             "\"meshes\": [{\"file\": \"t.obj\", \"repeat\": {\"count\": 2, \"step\": [4,0,0]}}],\n"
                                             "\"boxes\": [{\"min\": [6,0,2], \"max\": [7,1,3], \"material\": \"oak\"}],\n"
                                             "\"movers\": [{\"name\": \"lift\", \"box\": {\"min\": [1,0,3], \"max\": [2,0.1,3.5]}, \"path\": [{\"time\": 0}, {\"time\": 2, \"at\": [0,2,0]}]}],\n"
                                             "\"lights\": [{\"kind\": \"sun\", \"direction\": [0,-1,0]}, {\"kind\": \"point\", \"at\": [1,2,1], \"reach\": 3}],\n"
                                             "\"paths\": [{\"name\": \"walk\", \"views\": [{\"eye\": [1,1,1], \"forward\": [1,0,0]}, {\"eye\": [7,1,1], \"forward\": [-1,0,0]}]}]}", files));
    compiled bare = compiled_of(brushes_of(HEAD "\"brushes\": [" ROCK "," ROOM_A "," ROOM_B "," GATE "}],\n" INFOS "}", NULL));
    const scene *s = c.scene;
    assert_int_equal(s->item_count, bare.scene->item_count + 2 + 6);
    assert_int_equal(s->mover_count, 1);
    assert_string_equal(s->movers[0].name, "lift");
    assert_int_equal(s->key_count, 2);
    assert_int_equal(s->light_count, 2);
    assert_int_equal(s->lights[0].kind, LIGHT_SUN);
    assert_true(s->lights[1].reach == 3 && s->lights[1].position[1] == 2);
    assert_int_equal(s->path_count, 1);
    assert_string_equal(s->paths[0].name, "walk");
    assert_int_equal(s->camera_count, 2);
    assert_int_equal(s->zone_count, 2);
    compiled_free(&c);
    compiled_free(&bare);
}

static void an_opening_with_no_portal_brush_makes_one_zone(void **state)
{
    (void)state;
    compiled c = compiled_of(brushes_of(HEAD "\"brushes\": [" ROCK "," ROOM_A "," ROOM_B "],\n" INFOS "}", NULL));
    assert_int_equal(c.scene->zone_count, 1);
    assert_int_equal(c.zones->leak, 0);
    assert_string_equal(c.scene->zones[0].name, "west");
    compiled_free(&c);
}

static void the_scene_that_is_shipped_has_three_zones_of_round_rooms(void **state)
{
    (void)state;
    report_lines lines;
    report_lines_init(&lines);
    compile_input *in = NULL;
    assert_int_equal(compile_input_open(PORTCULLIS_SOURCE "/scenes/pillars.json", NULL, allocator_heap(), &lines.report, &in), RESULT_OK);
    assert_int_equal(lines.count, 0);
    compiled c = compiled_of(in);
    assert_int_equal(c.scene->zone_count, 3);
    assert_int_equal(c.zones->zones_sealed, 0);
    assert_int_equal(c.zones->leak, 0);
    assert_int_equal(c.scene->portal_count, 2);
    assert_string_equal(c.scene->portals[0].name, "archway");
    assert_string_equal(c.scene->portals[1].name, "well");
    assert_int_equal(c.scene->stray_items, 0);
    compiled_free(&c);
}

// ---- Faults ----

static void shapes_that_are_wrong_are_told_with_their_place(void **state)
{
    (void)state;
    expect_brush_error("{}", "t.json:2:13: error: /brushes/0: no shape; write one of \"plane\", \"box\", \"cylinder\", \"cone\", \"convex\"");
    expect_brush_error("{\"box\": 1, \"cone\": 2}", "t.json:2:13: error: /brushes/0: more than one shape; write one of \"plane\", \"box\", \"cylinder\", \"cone\", \"convex\"");
    expect_brush_error("{\"bx\": 1}", "t.json:2:14: error: /brushes/0/bx: this key is unknown here; did you mean 'box'? Known: name, operation, material, texture, "
                                      "door, plane, box, cylinder, cone, convex, at, turn, scale");
    expect_brush_error("{\"box\": {\"min\": [0,0,0], \"max\": [1,0,1]}}",
                       "t.json:2:21: error: /brushes/0/box: no volume is left on the grid of 0.00012207 m; make it thicker, take a finer grid, or take it out");
    expect_brush_error("{\"box\": {\"min\": [0,2,0], \"max\": [1,1,1]}}",
                       "t.json:2:21: error: /brushes/0/box: min is above max in y; write the three least coordinates as min");
    expect_brush_error("{\"cylinder\": {\"base\": [0,0,0], \"top\": [0,1,0], \"radius\": 3e-5}}",
                       "t.json:2:26: error: /brushes/0/cylinder: no volume is left on the grid of 0.00012207 m; make it thicker, take a finer grid, or take it out");
    expect_brush_error("{\"cylinder\": {\"base\": [0,0,0], \"top\": [0,0,0], \"radius\": 1}}",
                       "t.json:2:26: error: /brushes/0/cylinder: no volume is left on the grid of 0.00012207 m; make it thicker, take a finer grid, or take it out");
    expect_brush_error("{\"cylinder\": {\"base\": [0,0,0], \"top\": [0,1,0], \"radius\": 1, \"segments\": 2}}",
                       "t.json:2:85: error: /brushes/0/cylinder/segments: 2 is not within 3 to 128; correct it");
    expect_brush_error("{\"cone\": {\"base\": [0,0,0], \"apex\": [3000,1,0], \"radius\": 1}}",
                       "t.json:2:22: error: /brushes/0/cone: a point beyond 2048 m, 2^24 steps of the grid; move it or take a coarser grid");
    expect_brush_error("{\"convex\": {\"points\": [[0,0,0],[1,0,0],[0,0,1],[1,0,1]]}}",
                       "t.json:2:24: error: /brushes/0/convex: no volume is left on the grid of 0.00012207 m; make it thicker, take a finer grid, or take it out");
    expect_brush_error("{\"convex\": {}}", "t.json:2:24: error: /brushes/0/convex: it needs either \"points\" or \"planes\"; write one of them");
    expect_brush_error("{\"plane\": {\"point\": [0,0,0], \"normal\": [0,0,0]}}",
                       "t.json:2:52: error: /brushes/0/plane/normal: a direction of no length; write where the plane's outside is");
    expect_brush_error("{\"operation\": \"cut\", \"plane\": {\"point\": [0,0,0], \"normal\": [0,1,0]}}",
                       "t.json:2:27: error: /brushes/0/operation: 'cut' is none of: add, subtract, portal");
    expect_brush_error("{\"door\": \"d\", \"plane\": {\"point\": [0,0,0], \"normal\": [0,1,0]}}",
                       "t.json:2:22: error: /brushes/0/door: only a portal has a door; add \"operation\": \"portal\", or take this out");
    expect_brush_error("{\"operation\": \"portal\", \"door\": \"d\", \"plane\": {\"point\": [0,0,0], \"normal\": [0,1,0]}}",
                       "t.json:2:45: error: /brushes/0/door: there is no door 'd'; correct the name or add it");
}

static void an_open_brush_is_told_with_its_line(void **state)
{
    (void)state;
    expect_brushes_error(HEAD "\"brushes\": [\n" ROCK ",\n{\"convex\": {\"planes\": [{\"point\": [0,0,0], \"normal\": [-1,0,0]}, {\"point\": [0,0,0], \"normal\": [0,-2,0]},"
                              "{\"point\": [5,0,0], \"normal\": [0,0,-1]}, {\"point\": [0,9,0], \"normal\": [0,1,0]}]}}]}",
                         NULL, "t.json:4: error: /brushes/1: its faces leave it open; add the side that is missing");
    const memory_file files[] = {{"i.json", HEAD "\"brushes\": [\n\n{\"convex\": {\"planes\": [{\"point\": [0,0,0], \"normal\": [-1,0,0]}, {\"point\": [0,0,0], \"normal\": [0,-2,0]},"
                                                 "{\"point\": [5,0,0], \"normal\": [0,0,-1]}, {\"point\": [0,9,0], \"normal\": [0,1,0]}]}}]}"}, {0}};
    expect_brushes_error(HEAD "\"include\": [{\"file\": \"i.json\"}]}", files, "i.json:4: error: /brushes/0: its faces leave it open; add the side that is missing");
}

static void what_does_not_go_with_brushes_is_refused_by_name(void **state)
{
    (void)state;
    expect_brushes_error(HEAD "\"brushes\": [" ROCK "],\n\"zones\": [{\"name\": \"a\"}]}", NULL,
                         "t.json:3:10: error: /zones: zones by hand beside brushes; the compiler finds them: name them with \"zone_info\" and take this out");
    expect_brushes_error(HEAD "\"brushes\": [" ROCK "],\n\"portals\": [{}]}", NULL,
                         "t.json:3:12: error: /portals: portals by hand beside brushes; use brushes with \"operation\": \"portal\" and take this out");
    expect_brushes_error(HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,1]}]}", NULL,
                         "t.json: error: no brushes to compile; add \"brushes\", or open the scene as it is");
    expect_brushes_error(HEAD "\"brushes\": [" ROCK "],\n\"zone_info\": [{\"name\": \"a\", \"at\": [1,1,1]}, {\"name\": \"a\", \"at\": [1,1,1]}]}", NULL,
                         "t.json:3:54: error: /zone_info/1/name: there is a zone 'a' already; choose another name, or give one of two includes a \"name\"");
    expect_brushes_error(HEAD "\"brushes\": [" ROCK "],\n\"zone_info\": [{\"name\": \"a\"}]}", NULL, "t.json:3:15: error: /zone_info/0: 'at' is missing; add it");
    expect_brushes_error(HEAD "\"brushes\": 5}", NULL, "t.json:2:12: error: /brushes: a number, where an array [ ] belongs");
}

static void a_scene_with_brushes_is_to_be_compiled_before_it_is_opened(void **state)
{
    (void)state;
    expect_json_error(HEAD "\"brushes\": [" ROCK "]}", NULL,
                      "t.json:2:12: error: /brushes: brushes are to be compiled first: portcullis compile t.json -o SCENE.pcs, then open that");
    expect_json_error(HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,1]}], \"zone_info\": [{}]}", NULL,
                      "t.json:2:59: error: /zone_info: it names zones of brushes, and there are none; use \"zones\", or add \"brushes\"");
    expect_json_error(HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,1]}], \"starts\": [{}]}", NULL,
                      "t.json:2:56: error: /starts: they stand among brushes, and there are none; take them out, or add \"brushes\"");
}

static void other_files_need_no_compiling(void **state)
{
    (void)state;
    report_lines lines;
    report_lines_init(&lines);
    compile_input *in = NULL;
    assert_int_equal(compile_input_open("a.obj", NULL, allocator_heap(), &lines.report, &in), RESULT_BAD_INPUT);
    assert_string_equal(report_lines_only(&lines), "a.obj: error: compile takes a .map or a .json of brushes; other scenes need no compiling");
}

// ---- Memory ----

static void every_allocation_may_fail(void **state)
{
    (void)state;
    static const char text[] = HEAD "\"brushes\": [" ROCK "," ROOM_A "," GATE ", \"door\": \"d\"},{\"cylinder\": {\"base\": [1,0,1], \"top\": [1,2,1], \"radius\": 0.5},"
                                    "\"turn\": [10,0,0]},{\"plane\": {\"point\": [0,0,0], \"normal\": [0,1,0]}}],\n" INFOS
                                    ", \"starts\": [{\"at\": [2,1,2]}], \"doors\": [{\"name\": \"d\"}],\n"
                                    "\"boxes\": [{\"min\": [6,0,2], \"max\": [7,1,3]}], \"lights\": [{\"kind\": \"sun\", \"direction\": [0,-1,0]}]}";
    for (uint64_t k = 1;; ++k) {
        failing_allocator a;
        failing_allocator_init(&a, k);
        report r = {0};
        compile_input *in = NULL;
        const result done = compile_input_json("t.json", text, sizeof text - 1, NULL, NULL, &a.memory, &r, &in);
        if (a.failures) assert_int_equal(done, RESULT_NO_MEMORY);
        if (done == RESULT_OK) compile_input_free(in);
        else assert_null(in);
        assert_true(failing_allocator_is_clean(&a));
        if (!a.failures) {
            assert_int_equal(done, RESULT_OK);
            assert_in_range(k, 50, 100000);
            return;
        }
        assert_int_equal(r.errors, 1);
    }
}

typedef struct stage_calls { uint64_t input, all; } stage_calls; // allocations asked for

// All stages up to the scene, allocation `fail_at` failing.
static result compile_failing(uint64_t fail_at, const char *text, stage_calls *calls)
{
    failing_allocator a;
    failing_allocator_init(&a, fail_at);
    report r = {0};
    compile_input *in = NULL;
    compile_mesh *mesh = NULL;
    compiled_zones *zones = NULL;
    scene *s = NULL;
    csg_counts counts;
    compile_checks checks;
    result done = compile_input_json("t.json", text, strlen(text), NULL, NULL, &a.memory, &r, &in);
    if (done == RESULT_OK) done = compile_csg(in, &r, &a.memory, &mesh, &counts);
    if (done == RESULT_OK) done = compile_zones(in, mesh, PORTALS_DOORS, &r, &a.memory, &zones);
    calls->input = a.calls;
    if (done == RESULT_OK) done = compile_items(in, zones, &r, &a.memory, &s, &checks);
    calls->all = a.calls;
    scene_free(s, &a.memory);
    compiled_zones_free(zones);
    compile_input_free(in);
    assert_true(failing_allocator_is_clean(&a));
    assert_int_equal(r.errors, done == RESULT_OK ? 0 : 1);
    return done;
}

static void every_allocation_of_the_items_may_fail_too(void **state)
{
    (void)state;
    static const char text[] = HEAD "\"brushes\": [" ROCK "," ROOM_A "," ROOM_B "," GATE ", \"door\": \"d\"}],\n" INFOS ", \"doors\": [{\"name\": \"d\"}],\n"
                                    "\"boxes\": [{\"min\": [6,0,2], \"max\": [7,1,3]}], \"lights\": [{\"kind\": \"sun\", \"direction\": [0,-1,0]}]}";
    stage_calls sound, calls;
    assert_int_equal(compile_failing(0, text, &sound), RESULT_OK);
    assert_true(sound.all > sound.input + 20);
    for (uint64_t k = sound.input + 1; k <= sound.all; ++k) assert_int_equal(compile_failing(k, text, &calls), RESULT_NO_MEMORY);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(included_brushes_come_first_and_where_they_are_put),
        cmocka_unit_test(materials_mean_what_they_mean_in_a_map),
        cmocka_unit_test(textures_lie_upright_at_their_scale),
        cmocka_unit_test(zones_take_names_and_chains_and_portals_names_and_doors),
        cmocka_unit_test(what_stands_beside_the_brushes_comes_along),
        cmocka_unit_test(an_opening_with_no_portal_brush_makes_one_zone),
        cmocka_unit_test(the_scene_that_is_shipped_has_three_zones_of_round_rooms),
        cmocka_unit_test(shapes_that_are_wrong_are_told_with_their_place),
        cmocka_unit_test(an_open_brush_is_told_with_its_line),
        cmocka_unit_test(what_does_not_go_with_brushes_is_refused_by_name),
        cmocka_unit_test(a_scene_with_brushes_is_to_be_compiled_before_it_is_opened),
        cmocka_unit_test(other_files_need_no_compiling),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(every_allocation_of_the_items_may_fail_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
