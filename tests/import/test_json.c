// JSON scenes: what each part of the format becomes, includes, names, and scenes that must be the same.
// SPDX-License-Identifier: MIT
#include "json_support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define HEAD "{\"portcullis\": 1,\n"
#define BOX "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,1]}]"
#define ROOMS                                                                                                                            \
    "\"boxes\": [{\"min\": [0,0,0], \"max\": [4,3,5], \"side\": \"in\", \"omit\": [\"+x\"]}, {\"min\": [4,0,0], \"max\": [8,3,5], \"side\": \"in\", \"omit\": [\"-x\"]}],\n" \
    "\"zones\": [{\"name\": \"hall\", \"box\": [[0,0,0],[4,3,5]], \"chain\": \"frustum[backface=1]\"}, {\"name\": \"kitchen\", \"box\": [[4,0,0],[8,3,5]]}],\n" \
    "\"portals\": [{\"name\": \"way\", \"zones\": [\"hall\", \"kitchen\"], \"points\": [[4,0,2],[4,0,3],[4,2,3],[4,2,2]], \"door\": \"front\"}],\n" \
    "\"doors\": [{\"name\": \"front\", \"mover\": \"leaf\"}],\n"                                                                                \
    "\"movers\": [{\"name\": \"leaf\", \"box\": {\"min\": [3.75,0,2], \"max\": [4.25,2,3]}, \"open\": [0,0,1]},"                                \
    " {\"name\": \"cart\", \"box\": {\"min\": [1,0,1], \"max\": [2,1,2]}, \"path\": [{\"time\": 0}, {\"time\": 2, \"at\": [1,0,0], \"turn\": [0,90,0]}], \"loop\": true}],\n" \
    "\"lights\": [{\"kind\": \"point\", \"name\": \"lamp\", \"at\": [1,2,3], \"reach\": 4}],\n"                                                  \
    "\"paths\": [{\"name\": \"walk\", \"views\": [{\"eye\": [1,1.5,1], \"forward\": [1,0,0]}, {\"eye\": [6,1.5,1], \"forward\": [1,0,0.5], \"far\": \"inf\"}]}]"

static double volume_of_item(const scene *s, uint32_t item) // above 0 when its faces look out
{
    double six = 0;
    const scene_item *it = &s->items[item];
    for (uint32_t i = it->first_index; i < it->first_index + it->index_count; i += 3) {
        const cull_vec3 a = s->positions[s->indices[i]], b = s->positions[s->indices[i + 1]], c = s->positions[s->indices[i + 2]];
        six += a.x * ((double)b.y * c.z - (double)b.z * c.y) + a.y * ((double)b.z * c.x - (double)b.x * c.z) + a.z * ((double)b.x * c.y - (double)b.y * c.x);
    }
    return six / 6;
}

static double volume_of(const scene *s, uint32_t first, uint32_t count)
{
    double sum = 0;
    for (uint32_t i = first; i < first + count; ++i) sum += volume_of_item(s, i);
    return sum;
}

static void a_box_is_six_walls_that_look_out_or_in(void **state)
{
    (void)state;
    scene *s = json_of(HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,2,3], \"material\": \"brick\"}, {\"min\": [5,0,0], \"max\": [6,2,3], \"side\": \"in\"}]}", NULL);
    assert_int_equal(s->item_count, 12);
    for (uint32_t i = 0; i < 12; ++i) assert_true(s->items[i].flags & CULL_ITEM_WALL);
    assert_true(fabs(volume_of(s, 0, 6) - 6) < 1e-6);
    assert_true(fabs(volume_of(s, 6, 6) + 6) < 1e-6);
    assert_string_equal(s->materials[s->items[0].material].name, "brick");
    assert_string_equal(s->materials[s->items[6].material].name, "default");
    assert_int_equal(s->zone_count, 1);
    assert_string_equal(s->zones[0].name, "all");
    scene_free(s, allocator_heap());
}

static void planes_of_boxes_and_walls_face_as_their_triangles_do(void **state)
{
    (void)state;
    scene *s = json_of(HEAD BOX ", \"walls\": [{\"points\": [[3,0,0],[4,0,0],[5,0,0],[5,1,1],[3,1,1]]}]}", NULL);
    assert_int_equal(s->item_count, 7);
    for (uint32_t i = 0; i < s->item_count; ++i) {
        const cull_plane p = s->planes[s->walls[i].plane];
        double along = 0;
        for (uint32_t t = s->items[i].first_index; t < s->items[i].first_index + s->items[i].index_count; t += 3) {
            const cull_vec3 a = s->positions[s->indices[t]], b = s->positions[s->indices[t + 1]], c = s->positions[s->indices[t + 2]];
            const double u[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z}, v[3] = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z};
            along += p.normal.x * (u[1] * v[2] - u[2] * v[1]) + p.normal.y * (u[2] * v[0] - u[0] * v[2]) + p.normal.z * (u[0] * v[1] - u[1] * v[0]);
            assert_true(fabs(p.normal.x * (double)a.x + p.normal.y * (double)a.y + p.normal.z * (double)a.z + (double)p.offset) < 1e-6);
        }
        assert_true(along > 0.9);
    }
    assert_int_equal(s->flat_triangles, 0); // the corner of 180 degrees is no fan's start
    scene_free(s, allocator_heap());
}

static void sides_are_omitted_by_name(void **state)
{
    (void)state;
    scene *s = json_of(HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,1], \"omit\": [\"-x\", \"+y\"]}, {\"min\": [0,3,0], \"max\": [1,3,1]}]}", NULL);
    assert_int_equal(s->item_count, 6); // of the flat one the two sides with an area
    scene_free(s, allocator_heap());
}

static void zones_portals_doors_and_movers_are_joined_by_name(void **state)
{
    (void)state;
    scene *s = json_of(HEAD ROOMS "}", NULL);
    assert_int_equal(s->zone_count, 2);
    assert_string_equal(s->zones[zone_of(s, "hall")].chain, "frustum[backface=1]");
    assert_null(s->zones[zone_of(s, "kitchen")].chain);
    assert_int_equal(s->portal_count, 1);
    assert_int_equal(s->portals[0].zones[0], zone_of(s, "hall"));
    assert_int_equal(s->portals[0].zones[1], zone_of(s, "kitchen"));
    assert_int_equal(s->portals[0].door, 0);
    assert_int_equal(s->doors[0].mover, mover_of(s, "leaf"));
    assert_int_equal(s->movers[mover_of(s, "leaf")].door, 0);
    assert_true(s->movers[mover_of(s, "leaf")].open_offset[2] == 1);
    const scene_mover *cart = &s->movers[mover_of(s, "cart")];
    assert_int_equal(cart->key_count, 2);
    assert_int_equal(cart->loops, 1);
    assert_true(cart->pivot[0] == 1.5 && cart->pivot[1] == 0.5 && cart->pivot[2] == 1.5);
    assert_true(s->keys[cart->first_key + 1].time_s == 2 && s->keys[cart->first_key + 1].turn_deg[1] == 90);
    assert_int_equal(s->light_count, 1);
    assert_string_equal(s->lights[0].name, "lamp");
    scene_free(s, allocator_heap());
}

static double box_of_mover(const scene *s, uint32_t m, int side) // least or greatest z, world
{
    const float *of = side ? s->boxes.max_z : s->boxes.min_z;
    return s->whole.origin[2] + (double)of[s->item_count + m];
}

static void a_door_leaf_stands_as_its_door_does(void **state)
{
    (void)state;
    scene *open = json_with_doors(HEAD ROOMS "}", &doors_open), *shut = json_with_doors(HEAD ROOMS "}", &doors_shut);
    assert_true(box_of_mover(open, 0, 0) == 3 && box_of_mover(open, 0, 1) == 4);
    assert_true(box_of_mover(shut, 0, 0) == 2 && box_of_mover(shut, 0, 1) == 3);
    assert_int_equal(open->doors[0].at_rest, DOORS_OPEN);
    assert_int_equal(shut->doors[0].at_rest, DOORS_SHUT);
    scene_free(open, allocator_heap());
    scene_free(shut, allocator_heap());
    scene *own = json_of(HEAD BOX ", \"doors\": [{\"name\": \"d\", \"open\": false, \"mover\": \"m\"}],"
                              "\"movers\": [{\"name\": \"m\", \"box\": {\"min\": [0,0,2], \"max\": [1,1,3]}, \"open\": [0,0,1]}]}", NULL);
    assert_int_equal(own->doors[0].at_rest, DOORS_SHUT);
    assert_true(box_of_mover(own, 0, 0) == 2);
    scene_free(own, allocator_heap());
}

static void a_turned_and_scaled_mover_of_a_file_is_one_item(void **state)
{
    (void)state;
    const memory_file files[] = {{"two.boxes", "boxes 2\n0 0 0 1 1 1\n2 0 0 3 1 1\n"}, {0}};
    scene *s = json_of(HEAD BOX ", \"movers\": [{\"name\": \"m\", \"file\": \"two.boxes\", \"at\": [10,0,0], \"turn\": [0,90,0], \"scale\": 2},"
                            " {\"name\": \"n\", \"file\": \"./two.boxes\"}]}", files);
    assert_int_equal(s->mover_count, 2);
    assert_int_equal(s->items[s->item_count].polygon_count, 12);
    assert_true(fabs(volume_of_item(s, s->item_count) - 16) < 1e-4); // outward still
    assert_true(fabs(volume_of_item(s, s->item_count + 1) - 2) < 1e-4);
    assert_true(box_of_mover(s, 0, 0) == -6 && box_of_mover(s, 0, 1) == 0); // x of 0..3, doubled, turned to -z
    scene_free(s, allocator_heap());
}

static void a_mesh_is_repeated_step_by_step(void **state)
{
    (void)state;
    const memory_file files[] = {{"one.boxes", "boxes 1\n0 0 0 1 1 1\n"}, {0}};
    scene *s = json_of(HEAD "\"meshes\": [{\"file\": \"one.boxes\", \"at\": [0,1,0], \"repeat\": {\"count\": 5, \"step\": [2,0,0]}}]}", files);
    assert_int_equal(s->item_count, 5);
    for (uint32_t i = 0; i < 5; ++i) {
        assert_true(s->whole.origin[0] + (double)s->boxes.min_x[i] == 2 * i);
        assert_true(s->whole.origin[1] + (double)s->boxes.min_y[i] == 1);
    }
    scene_free(s, allocator_heap());
}

static void a_hull_of_points_is_a_zone_however_its_points_are_ordered(void **state)
{
    (void)state;
    static const char *const corners[2] = {"[0,0,0],[4,0,0],[4,0,4],[0,0,4],[2,3,2],[2,0,2]", "[2,0,2],[0,0,4],[2,3,2],[4,0,4],[0,0,0],[4,0,0]"};
    for (int k = 0; k < 2; ++k) {
        char text[512];
        snprintf(text, sizeof text, HEAD BOX ", \"zones\": [{\"name\": \"tent\", \"hull\": [%s]}]}", corners[k]);
        scene *s = json_of(text, NULL);
        const scene_hull *h = &s->hulls[s->zones[zone_of(s, "tent")].first_hull];
        assert_int_equal(h->plane_count, 5);
        assert_true(scene_hull_height(s, 0, (const double[3]){2, 1, 2}) < -0.5);
        assert_true(scene_hull_height(s, 0, (const double[3]){2, 3.25, 2}) > 0.1);
        assert_true(scene_hull_height(s, 0, (const double[3]){0.25, 1, 2}) > 0.1);
        scene_free(s, allocator_heap());
    }
}

static void an_included_scene_has_its_names_behind_a_prefix(void **state)
{
    (void)state;
    const memory_file files[] = {{"lib/house.json", HEAD ROOMS ",\n\"include\": [{\"file\": \"../one.boxes\", \"at\": [1,0,1]}]}"}, {"one.boxes", "boxes 1\n0 0 0 1 1 1\n"}, {0}};
    scene *s = json_of(HEAD "\"include\": [{\"file\": \"lib/house.json\", \"name\": \"red\"}, {\"file\": \"lib/house.json\", \"name\": \"blue\", \"at\": [100,0,0], \"turn\": [0,90,0]}],"
                            "\"zones\": [{\"name\": \"outside\"}],"
                            "\"portals\": [{\"zones\": [\"red/kitchen\", \"outside\"], \"points\": [[8,0,2],[8,0,3],[8,2,3],[8,2,2]]}]}", files);
    assert_int_equal(s->zone_count, 5);
    assert_int_equal(s->portal_count, 3);
    assert_string_equal(s->portals[2].name, "red/kitchen - outside");
    assert_string_equal(s->doors[s->portals[1].door].name, "blue/front");
    assert_string_equal(s->movers[s->doors[1].mover].name, "blue/leaf");
    assert_string_equal(s->paths[1].name, "blue/walk");
    assert_string_equal(s->portals[1].name, "blue/way");
    assert_int_equal(s->portals[1].zones[0], zone_of(s, "blue/hall"));
    assert_true(s->cameras[2].eye[0] == 101 && s->cameras[2].eye[2] == -1);
    scene_free(s, allocator_heap());
}

static void a_name_behind_a_slash_is_one_of_the_whole_scene(void **state)
{
    (void)state;
    const memory_file files[] = {{"house.json", HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [4,3,5], \"side\": \"in\", \"omit\": [\"+x\"]}],"
                                                     "\"zones\": [{\"name\": \"hall\", \"box\": [[0,0,0],[4,3,5]], \"in\": \"/outside\"}],"
                                                     "\"portals\": [{\"zones\": [\"hall\", \"/outside\"], \"points\": [[4,0,2],[4,0,3],[4,2,3],[4,2,2]]}]}"}, {0}};
    scene *s = json_of(HEAD "\"include\": [{\"file\": \"house.json\", \"name\": \"1\"}, {\"file\": \"house.json\", \"name\": \"2\", \"at\": [20,0,0], \"turn\": [0,180,0]}],"
                            "\"zones\": [{\"name\": \"outside\"}]}", files);
    assert_int_equal(s->zones[zone_of(s, "1/hall")].parent, zone_of(s, "outside"));
    assert_int_equal(s->zones[zone_of(s, "2/hall")].parent, zone_of(s, "outside"));
    assert_int_equal(s->portals[1].zones[1], zone_of(s, "outside"));
    assert_true(s->portal_points[s->portals[1].first_point][0] == 16);
    scene_free(s, allocator_heap());
}

static void an_include_is_the_same_as_its_text_in_place(void **state)
{
    (void)state;
    const memory_file files[] = {{"rooms.json", HEAD ROOMS "}"}, {0}};
    scene *direct = json_of(HEAD ROOMS "}", NULL), *included = json_of(HEAD "\"include\": [{\"file\": \"rooms.json\"}]}", files);
    assert_same_scene(direct, included);
    scene_free(direct, allocator_heap());
    scene_free(included, allocator_heap());
}

static void nested_placements_multiply_and_undo_each_other(void **state)
{
    (void)state;
    const memory_file files[] = {{"rooms.json", HEAD ROOMS "}"},
                                 {"turned.json", HEAD "\"include\": [{\"file\": \"rooms.json\", \"at\": [0,0,64], \"turn\": [0,90,0], \"scale\": 2}]}"}, {0}};
    scene *direct = json_of(HEAD ROOMS "}", NULL);
    scene *back = json_of(HEAD "\"include\": [{\"file\": \"turned.json\", \"at\": [32,0,0], \"turn\": [0,-90,0], \"scale\": 0.5}]}", files);
    assert_same_scene(direct, back);
    scene_free(direct, allocator_heap());
    scene_free(back, allocator_heap());
}

static void a_placed_include_is_the_scene_written_in_its_place(void **state)
{
    (void)state;
    const memory_file files[] = {{"a.json", HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [2,1,1]}], \"zones\": [{\"name\": \"z\", \"box\": [[0,0,0],[2,1,1]]}]}"}, {0}};
    scene *placed = json_of(HEAD "\"include\": [{\"file\": \"a.json\", \"at\": [10,20,30], \"turn\": [0,90,0], \"scale\": 2}]}", files);
    scene *written = json_of(HEAD "\"boxes\": [{\"min\": [10,20,26], \"max\": [12,22,30]}], \"zones\": [{\"name\": \"z\", \"box\": [[10,20,26],[12,22,30]]}]}", NULL);
    for (int k = 0; k < 3; ++k) {
        assert_true(placed->whole.origin[k] == written->whole.origin[k]);
        assert_true(placed->hulls[0].min[k] == written->hulls[0].min[k] && placed->hulls[0].max[k] == written->hulls[0].max[k]);
    }
    assert_memory_equal(&placed->whole.box, &written->whole.box, sizeof placed->whole.box);
    assert_int_equal(placed->zones[0].item_count, written->zones[0].item_count);
    scene_free(placed, allocator_heap());
    scene_free(written, allocator_heap());
}

static void turns_are_about_x_then_y_then_z(void **state)
{
    (void)state;
    static const char *const turns[2] = {"[90,90,0]", "[30,0,0]"};
    static const double expected[2][3][3] = {{{0, 0, -1}, {1, 0, 0}, {0, -1, 0}}, {{1, 0, 0}, {0, 0.8660254037844386, 0.5}, {0, -0.5, 0.8660254037844386}}};
    const memory_file files[] = {{"t.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n"}, {0}};
    for (int t = 0; t < 2; ++t) {
        char text[256];
        snprintf(text, sizeof text, HEAD "\"include\": [{\"file\": \"t.obj\", \"turn\": %s}]}", turns[t]);
        scene *s = json_of(text, files);
        for (int v = 0; v < 3; ++v) {
            const cull_vec3 p = s->positions[s->indices[v]];
            const double at[3] = {s->whole.origin[0] + (double)p.x, s->whole.origin[1] + (double)p.y, s->whole.origin[2] + (double)p.z};
            for (int k = 0; k < 3; ++k) assert_true(t ? fabs(at[k] - expected[t][v][k]) < 1e-6 : at[k] == expected[t][v][k]);
        }
        scene_free(s, allocator_heap());
    }
}

static void permuted_lists_give_the_same_zones(void **state)
{
    (void)state;
    static const char *const zones[] = {"{\"name\": \"outside\"}", "{\"name\": \"house\", \"box\": [[0,0,0],[9,3,5]], \"in\": \"outside\"}",
                                        "{\"name\": \"cupboard\", \"box\": [[1,0,1],[2,2,2]], \"in\": \"house\"}"};
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int o = 0; o < 6; ++o) {
        char text[1024];
        snprintf(text, sizeof text, HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [9,3,5], \"side\": \"in\"}, {\"min\": [1.25,0.25,1.25], \"max\": [1.75,1,1.75]}], \"zones\": [%s, %s, %s]}",
                 zones[orders[o][0]], zones[orders[o][1]], zones[orders[o][2]]);
        scene *s = json_of(text, NULL);
        const uint32_t outside = zone_of(s, "outside"), house = zone_of(s, "house"), cupboard = zone_of(s, "cupboard");
        assert_int_equal(s->zones[house].parent, outside);
        assert_int_equal(s->zones[cupboard].parent, house);
        assert_int_equal(s->zones[outside].item_count, 6);
        assert_int_equal(s->zones[house].item_count, 6); // what the cupboard holds wholly is not the house's
        assert_int_equal(s->zones[cupboard].item_count, 7);
        scene_free(s, allocator_heap());
    }
}

static void a_scene_far_away_has_the_same_zones(void **state)
{
    (void)state;
    static const char *const places[] = {"1000", "100000", "10000000"};
    const memory_file files[] = {{"rooms.json", HEAD ROOMS "}"}, {0}};
    scene *near = json_of(HEAD ROOMS "}", NULL);
    for (int p = 0; p < 3; ++p) {
        char text[256];
        snprintf(text, sizeof text, HEAD "\"include\": [{\"file\": \"rooms.json\", \"at\": [%s, -%s, %s]}]}", places[p], places[p], places[p]);
        scene *far = json_of(text, files);
        assert_memory_equal(near->positions, far->positions, near->position_count * sizeof *near->positions);
        assert_int_equal(near->zone_count, far->zone_count);
        for (uint32_t z = 0; z < near->zone_count; ++z) {
            assert_int_equal(near->zones[z].item_count, far->zones[z].item_count);
            assert_memory_equal(near->zone_items + near->zones[z].first_item, far->zone_items + far->zones[z].first_item, near->zones[z].item_count * sizeof(uint32_t));
        }
        for (uint32_t i = 0; i < near->portal_point_count; ++i)
            for (int k = 0; k < 3; ++k)
                assert_true(near->portal_points[i][k] - near->whole.origin[k] == far->portal_points[i][k] - far->whole.origin[k]);
        scene_free(far, allocator_heap());
    }
    scene_free(near, allocator_heap());
}

static void each_of_many_zones_is_found_by_its_name(void **state)
{
    (void)state;
    enum { ZONES = 400 };
    static char text[1 << 17];
    int used = snprintf(text, sizeof text, HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [%d,1,1]}], \"portals\": [", ZONES);
    for (int z = 1; z < ZONES; ++z)
        used += snprintf(text + used, sizeof text - (size_t)used, "%s{\"zones\": [\"r%d\", \"r%d\"], \"points\": [[%d,0,0],[%d,0,1],[%d,1,1]]}", z > 1 ? "," : "", z - 1, z, z, z, z);
    used += snprintf(text + used, sizeof text - (size_t)used, "], \"zones\": [");
    for (int z = ZONES; z-- > 0;)
        used += snprintf(text + used, sizeof text - (size_t)used, "{\"name\": \"r%d\", \"box\": [[%d,0,0],[%d,1,1]]}%s", z, z, z + 1, z ? "," : "]}");
    scene *s = json_of(text, NULL);
    assert_int_equal(s->zone_count, ZONES);
    for (uint32_t p = 0; p < s->portal_count; ++p) {
        char name[16];
        snprintf(name, sizeof name, "r%u", p + 1);
        assert_string_equal(s->zones[s->portals[p].zones[1]].name, name);
    }
    scene_free(s, allocator_heap());
}

static void a_path_of_the_scene_is_loaded_by_name(void **state)
{
    (void)state;
    scene *s = json_of(HEAD ROOMS "}", NULL);
    camera_path path;
    heard h;
    report r = hear(&h);
    for (int k = 0; k < 2; ++k) {
        assert_int_equal(camera_path_load(k ? "path:walk" : "path:", s, 1, allocator_heap(), &r, &path), RESULT_OK);
        assert_int_equal(path.count, 2);
        assert_string_equal(path.name, "walk");
        assert_true(path.cameras[0].aspect == 16.0 / 9 && path.cameras[0].near_m == 0.0625 && path.cameras[0].far_m == 1000 && path.cameras[0].fovy_deg == 60);
        assert_true(isinf(path.cameras[1].far_m));
        camera_path_free(&path, allocator_heap());
    }
    assert_int_equal(camera_path_load("path:run", s, 1, allocator_heap(), &r, &path), RESULT_BAD_INPUT);
    assert_string_equal(h.text, "portcullis: error: --views path:run: no such path in t.json; it has: walk");
    scene_free(s, allocator_heap());
    s = json_of(HEAD BOX "}", NULL);
    assert_int_equal(camera_path_load("path:", s, 1, allocator_heap(), &r, &path), RESULT_BAD_INPUT);
    assert_string_equal(h.text, "portcullis: error: --views path:: t.json has no camera path; use auto:N, or a .views file");
    scene_free(s, allocator_heap());
}

static void a_path_may_come_from_a_views_file(void **state)
{
    (void)state;
    const memory_file files[] = {{"w.views", "0 1.7 -120 0 0 1 0 1 0 60 1.5 0.1 10000\n"}, {0}};
    scene *s = json_of(HEAD BOX ", \"paths\": [{\"name\": \"w\", \"file\": \"w.views\"}]}", files);
    assert_int_equal(s->camera_count, 1);
    assert_true(s->cameras[0].eye[2] == -120 && s->cameras[0].aspect == 1.5);
    scene_free(s, allocator_heap());
}

static void an_included_map_brings_its_movers_and_their_doors(void **state)
{
    (void)state;
#define CUBE(n) "{\n( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) a 0 0 0 1 1\n( " n " 0 0 ) ( " n " 0 1 ) ( " n " 1 0 ) b 0 0 0 1 1\n( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) c 0 0 0 1 1\n" \
    "( 0 64 0 ) ( 1 64 0 ) ( 0 64 1 ) d 0 0 0 1 1\n( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) e 0 0 0 1 1\n( 0 0 64 ) ( 0 1 64 ) ( 1 0 64 ) f 0 0 0 1 1\n}\n"
    const memory_file files[] = {{"m.map", "{\n\"classname\" \"worldspawn\"\n" CUBE("64") "}\n{\n\"classname\" \"func_door\"\n\"angle\" \"0\"\n" CUBE("32") "}\n"}, {0}};
    scene *s = json_of(HEAD "\"include\": [{\"file\": \"m.map\", \"turn\": [0,90,0]}]}", files);
    assert_int_equal(s->item_count, 6);
    assert_int_equal(s->mover_count, 1);
    assert_int_equal(s->door_count, 1);
    assert_int_equal(s->doors[0].mover, 0);
    assert_int_equal(s->doors[0].at_rest, DOORS_OPEN);
    assert_true(s->movers[0].open_offset[0] == 0 && s->movers[0].open_offset[2] == -0.75); // 32 units less the lip of 8
    scene_free(s, allocator_heap());
}

static void notes_and_a_byte_order_mark_are_no_matter(void **state)
{
    (void)state;
    scene *plain = json_of(HEAD BOX "}", NULL);
    scene *noted = json_of("\xef\xbb\xbf" HEAD "\"$schema\": \"x\", \"note\": \"why\", \"boxes\": [{\"note\": \"a cube\", \"min\": [0,0,0], \"max\": [1,1,1]}]}", NULL);
    assert_same_scene(plain, noted);
    scene_free(plain, allocator_heap());
    scene_free(noted, allocator_heap());
}

static void the_example_of_the_manual_is_read(void **state)
{
    (void)state;
    static char text[1 << 16];
    FILE *file = fopen(PORTCULLIS_SOURCE "/docs/scene-format.md", "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    char *first = strstr(text, "```json\n"), *end = first ? strstr(first + 8, "```") : NULL;
    assert_non_null(end);
    *end = 0;
    const memory_file files[] = {{"house.json", HEAD BOX ", \"zones\": [{\"name\": \"hall\", \"box\": [[0,0,0],[1,1,1]], \"in\": \"/outside\"}]}"}, {0}};
    scene *s = json_of(first + 8, files);
    assert_int_equal(s->zone_count, 3);
    assert_int_equal(s->portal_count, 1);
    scene_free(s, allocator_heap());
}

static void the_example_has_two_rooms_and_a_garden(void **state)
{
    (void)state;
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    if (import_scene(PORTCULLIS_SOURCE "/scenes/two_rooms.json", &doors_open, allocator_heap(), &r, &s) != RESULT_OK) fail_msg("%s", h.text);
    assert_int_equal(r.warnings, 0);
    assert_int_equal(s->zone_count, 3);
    assert_int_equal(s->portal_count, 2);
    assert_int_equal(s->mover_count, 2);
    assert_int_equal(s->stray_items, 0);
    assert_int_equal(s->flat_triangles, 0);
    assert_int_equal(s->path_count, 1);
    scene_free(s, allocator_heap());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_is_six_walls_that_look_out_or_in),
        cmocka_unit_test(planes_of_boxes_and_walls_face_as_their_triangles_do),
        cmocka_unit_test(sides_are_omitted_by_name),
        cmocka_unit_test(zones_portals_doors_and_movers_are_joined_by_name),
        cmocka_unit_test(a_door_leaf_stands_as_its_door_does),
        cmocka_unit_test(a_turned_and_scaled_mover_of_a_file_is_one_item),
        cmocka_unit_test(a_mesh_is_repeated_step_by_step),
        cmocka_unit_test(a_hull_of_points_is_a_zone_however_its_points_are_ordered),
        cmocka_unit_test(an_included_scene_has_its_names_behind_a_prefix),
        cmocka_unit_test(a_name_behind_a_slash_is_one_of_the_whole_scene),
        cmocka_unit_test(an_include_is_the_same_as_its_text_in_place),
        cmocka_unit_test(nested_placements_multiply_and_undo_each_other),
        cmocka_unit_test(a_placed_include_is_the_scene_written_in_its_place),
        cmocka_unit_test(turns_are_about_x_then_y_then_z),
        cmocka_unit_test(permuted_lists_give_the_same_zones),
        cmocka_unit_test(a_scene_far_away_has_the_same_zones),
        cmocka_unit_test(each_of_many_zones_is_found_by_its_name),
        cmocka_unit_test(a_path_of_the_scene_is_loaded_by_name),
        cmocka_unit_test(a_path_may_come_from_a_views_file),
        cmocka_unit_test(an_included_map_brings_its_movers_and_their_doors),
        cmocka_unit_test(notes_and_a_byte_order_mark_are_no_matter),
        cmocka_unit_test(the_example_of_the_manual_is_read),
        cmocka_unit_test(the_example_has_two_rooms_and_a_garden),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
