// Maps written by hand: geometry, textures, entities, doors.
// SPDX-License-Identifier: MIT
#include "brushes.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double low[3] = {-64, 0, 16}, high[3] = {64, 32, 80};

static scene *scene_of(map_text *m, const import_options *options)
{
    return map_of(m->text, options);
}

static void world_position(const scene *s, uint32_t vertex, double out[3])
{
    const cull_vec3 p = s->positions[vertex];
    out[0] = s->whole.origin[0] + p.x;
    out[1] = s->whole.origin[1] + p.y;
    out[2] = s->whole.origin[2] + p.z;
}

// The loop's normal by Newell, unit length.
static void loop_normal(const scene *s, const cull_wall *wall, double out[3])
{
    out[0] = out[1] = out[2] = 0;
    for (uint32_t i = 0; i < wall->vertex_count; ++i) {
        double a[3], b[3];
        world_position(s, s->wall_vertices[wall->first_vertex + i], a);
        world_position(s, s->wall_vertices[wall->first_vertex + (i + 1) % wall->vertex_count], b);
        for (int k = 0; k < 3; ++k) out[k] += (a[(k + 1) % 3] - b[(k + 1) % 3]) * (a[(k + 2) % 3] + b[(k + 2) % 3]);
    }
    const double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int k = 0; k < 3; ++k) out[k] /= length;
}

static void a_box_brush_gives_six_polygons_that_face_outwards(void **state)
{
    (void)state;
    map_text m = {0};
    map_add(&m, "{\n\"classname\" \"worldspawn\"\n");
    map_add_box(&m, low, high, "stone");
    map_add(&m, "}\n");
    scene *s = scene_of(&m, &doors_open);
    assert_int_equal(s->item_count, 6);
    assert_int_equal(s->polygon_count, 6);
    assert_int_equal(s->index_count, 36);
    assert_int_equal(s->flat_triangles, 0);
    assert_int_equal(s->is_map, 1);
    const double centre[3] = {0, 48 / 32.0, -16 / 32.0};
    double faces_seen[3] = {0};
    for (uint32_t i = 0; i < 6; ++i) {
        assert_int_equal(s->walls[i].vertex_count, 4);
        assert_true(s->items[i].flags & CULL_ITEM_WALL);
        const cull_plane plane = s->planes[s->walls[i].plane];
        double normal[3], p[3];
        loop_normal(s, &s->walls[i], normal);
        world_position(s, s->wall_vertices[s->walls[i].first_vertex], p);
        double out = 0, along = 0;
        const float *n = &plane.normal.x;
        for (int k = 0; k < 3; ++k) {
            out += (p[k] - centre[k]) * normal[k];
            along += normal[k] * n[k];
            faces_seen[k] += fabs(normal[k]);
        }
        assert_true(out > 0.4);
        assert_true(along > 1 - 1e-6);
    }
    assert_true(faces_seen[0] == 2 && faces_seen[1] == 2 && faces_seen[2] == 2);
    scene_free(s, allocator_heap());
}

static void a_map_point_is_turned_to_y_up_and_scaled_to_metres(void **state)
{
    (void)state;
    map_text m = {0};
    map_add(&m, "{\n\"classname\" \"worldspawn\"\n");
    map_add_box(&m, low, high, "stone");
    map_add(&m, "}\n");
    scene *s = scene_of(&m, &doors_open);
    double min[3] = {1e9, 1e9, 1e9}, max[3] = {-1e9, -1e9, -1e9};
    for (uint32_t v = 0; v < s->position_count; ++v) {
        double p[3];
        world_position(s, v, p);
        for (int k = 0; k < 3; ++k) {
            min[k] = fmin(min[k], p[k]);
            max[k] = fmax(max[k], p[k]);
        }
    }
    const double expected_min[3] = {-2, 0.5, -1}, expected_max[3] = {2, 2.5, 0};
    for (int k = 0; k < 3; ++k) {
        assert_true(min[k] == expected_min[k]);
        assert_true(max[k] == expected_max[k]);
    }
    scene_free(s, allocator_heap());
}

static void a_turned_brush_keeps_its_shape(void **state)
{
    (void)state;
    for (int step = 1; step < 24; ++step) {
        const double angle = step * 0.2617, c = cos(angle), sn = sin(angle);
        point_set faces[6];
        box_faces(low, high, faces);
        for (int f = 0; f < 6; ++f)
            for (int i = 0; i < 3; ++i) { // about (1, 1, 1): Rodrigues
                const double *p = faces[f].points[i], d = (p[0] + p[1] + p[2]) / 3 * (1 - c), r = sn / sqrt(3);
                const double q[3] = {p[0] * c + (p[2] - p[1]) * r + d, p[1] * c + (p[0] - p[2]) * r + d, p[2] * c + (p[1] - p[0]) * r + d};
                memcpy(faces[f].points[i], q, sizeof q);
            }
        map_text m = {0};
        map_add(&m, "{\n\"classname\" \"worldspawn\"\n");
        map_add_faces(&m, faces, 6, "stone");
        map_add(&m, "}\n");
        scene *s = scene_of(&m, &doors_open);
        assert_int_equal(s->item_count, 6);
        double area = 0;
        for (uint32_t i = 0; i < s->index_count; i += 3) {
            double t[3][3], n[3];
            for (uint32_t k = 0; k < 3; ++k) world_position(s, s->indices[i + k], t[k]);
            for (int k = 0; k < 3; ++k)
                n[k] = (t[1][(k + 1) % 3] - t[0][(k + 1) % 3]) * (t[2][(k + 2) % 3] - t[0][(k + 2) % 3]) -
                       (t[1][(k + 2) % 3] - t[0][(k + 2) % 3]) * (t[2][(k + 1) % 3] - t[0][(k + 1) % 3]);
            area += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
        }
        assert_true(fabs(area - 2 * (4 * 1 + 4 * 2 + 1 * 2)) < 1e-4); // 4 x 1 x 2 m, coordinates rounded to 2^-22 m
        scene_free(s, allocator_heap());
    }
}

static void planes_that_repeat_or_only_touch_change_nothing(void **state)
{
    (void)state;
    point_set faces[8];
    box_faces(low, high, faces);
    faces[6] = faces[1];
    const point_set touching = {{{64, 0, 17}, {64, 0, 16}, {65, -1, 16}}}; // along one edge of the box, outside of it
    faces[7] = touching;
    map_text m = {0};
    map_add(&m, "{\n\"classname\" \"worldspawn\"\n");
    map_add_faces(&m, faces, 8, "stone");
    map_add(&m, "}\n");
    scene *s = scene_of(&m, &doors_open);
    assert_int_equal(s->item_count, 6);
    for (uint32_t i = 0; i < 6; ++i) assert_int_equal(s->walls[i].vertex_count, 4);
    scene_free(s, allocator_heap());
}

static void comments_line_ends_and_trailing_numbers_are_read_over(void **state)
{
    (void)state;
    scene *s = map_of("// a comment\r\n{\r\n\"classname\" \"worldspawn\" // behind a key\r\n\"wad\" \"C:\\quake\\\"\r\n\"message\" \"say \\\"hi\\\" //\"\r\n{\r\n"
                      "( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) a 0 0 0 1 1 0 0 0\r\n// in a brush\r\n( 32 0 0 ) ( 32 0 1 ) ( 32 1 0 ) a 0 0 0 1 1 -1\r\n"
                      "(0 0 0)(0 0 1)(1 0 0)a 0 0 0 1 1( 0 32 0 ) ( 1 32 0 ) ( 0 32 1 ) a 0 0 0 1 1\r\n"
                      "( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) a [ 1 0 0 0 ] [ 0 -1 0 0 ] 0 1 1 4 5 6\r\n( 0 0 32 ) ( 0 1 32 ) ( 1 0 32 ) a 0 0 0 1 1}}",
                      &doors_open);
    assert_int_equal(s->item_count, 6);
    scene_free(s, allocator_heap());
}

static void a_byte_order_mark_before_a_map_is_read_over(void **state)
{
    (void)state;
    map_text m = {0};
    map_add(&m, "\xef\xbb\xbf{\n\"classname\" \"worldspawn\"\n");
    map_add_box(&m, low, high, "stone");
    map_add(&m, "}\n");
    scene *s = scene_of(&m, &doors_open);
    assert_int_equal(s->item_count, 6);
    scene_free(s, allocator_heap());
}

static void tool_textures_make_nothing_and_others_say_what_they_are(void **state)
{
    (void)state;
    static const char *const tools[] = {"clip", "SKIP", "hint", "HintSkip", "trigger", "origin", "common/nodraw", "null", "textures/common/caulk", "*waterskip"};
    map_text m = {0};
    map_add(&m, "{\n\"classname\" \"worldspawn\"\n");
    for (size_t i = 0; i < sizeof tools / sizeof *tools; ++i) map_add_box(&m, low, high, tools[i]);
    map_add_box(&m, low, high, "Wall");
    map_add_box(&m, low, high, "*Water");
    map_add_box(&m, low, high, "{grate");
    map_add_box(&m, low, high, "Sky1");
    map_add_box(&m, low, high, "clipper");
    map_add(&m, "}\n");
    scene *s = scene_of(&m, &doors_open);
    assert_int_equal(s->item_count, 30);
    assert_int_equal(s->material_count, 5);
    assert_int_equal(s->solid_count, 5);
    static const char *const names[] = {"Wall", "*Water", "{grate", "Sky1", "clipper"};
    static const uint32_t flags[] = {0, MATERIAL_TRANSLUCENT, MATERIAL_CUT_OUT, MATERIAL_SKY, 0};
    static const solid_kind kinds[] = {SOLID_STRUCTURE, SOLID_LIQUID, SOLID_STRUCTURE, SOLID_STRUCTURE, SOLID_STRUCTURE};
    for (uint32_t i = 0; i < 5; ++i) {
        assert_string_equal(s->materials[i].name, names[i]);
        assert_int_equal(s->materials[i].flags, flags[i]);
        assert_int_equal(s->solids[i].kind, kinds[i]);
    }
    assert_non_null(s->texcoords);
    assert_true(s->items[6].flags & CULL_ITEM_SEE_THROUGH && s->items[6].flags & CULL_ITEM_TWO_SIDED);
    assert_true(s->items[12].flags & CULL_ITEM_CUT_OUT);
    scene_free(s, allocator_heap());
}

// The texture coordinates at the corner whose scene position is (x, y, z), on the item that faces up.
static void texcoord_at(const scene *s, const double at[3], float out[2])
{
    for (uint32_t i = 0; i < s->item_count; ++i) {
        if (s->planes[s->walls[i].plane].normal.y < 0.9f) continue;
        for (uint32_t v = 0; v < s->walls[i].vertex_count; ++v) {
            const uint32_t vertex = s->wall_vertices[s->walls[i].first_vertex + v];
            double p[3];
            world_position(s, vertex, p);
            if (p[0] != at[0] || p[1] != at[1] || p[2] != at[2]) continue;
            memcpy(out, s->texcoords + 2 * (size_t)vertex, 2 * sizeof(float));
            return;
        }
    }
    fail_msg("no such corner");
}

static void texture_coordinates_follow_both_projections(void **state)
{
    (void)state;
    static const struct { const char *numbers; float s, t; } cases[] = {
        // at the map's (64, 32, 80); texels / 64. Standard on a floor: s = x, t = -y, turned, scaled, shifted.
        {"0 0 0 1 1", 64 / 64.0f, -32 / 64.0f},
        {"16 8 0 2 0.5", (32 + 16) / 64.0f, (-64 + 8) / 64.0f},
        {"0 0 90 1 1", 32 / 64.0f, 64 / 64.0f},
        {"0 0 0 0 0", 64 / 64.0f, -32 / 64.0f},
        {"[ 0 1 0 5 ] [ 0.5 0 0.25 -3 ] 77 2 1", (16 + 5) / 64.0f, (32 + 20 - 3) / 64.0f},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
        map_text m = {0};
        point_set faces[6];
        box_faces(low, high, faces);
        map_add(&m, "{\n\"classname\" \"worldspawn\"\n{\n");
        for (int f = 0; f < 6; ++f) {
            for (int i = 0; i < 3; ++i) map_add(&m, "( %g %g %g ) ", faces[f].points[i][0], faces[f].points[i][1], faces[f].points[i][2]);
            map_add(&m, "{g %s\n", cases[c].numbers);
        }
        map_add(&m, "}\n}\n");
        scene *s = scene_of(&m, &doors_open);
        const double corner[3] = {2, 2.5, -1};
        float found[2];
        texcoord_at(s, corner, found);
        assert_true(fabsf(found[0] - cases[c].s) < 1e-6f);
        assert_true(fabsf(found[1] - cases[c].t) < 1e-6f);
        scene_free(s, allocator_heap());
    }
}

// ---- Entities ----

static void each_entity_plays_its_part(void **state)
{
    (void)state;
    static const char *const classes[] = {"worldspawn", "func_group", "func_detail_wall", "func_detail_illusionary", "func_wall", "func_episodegate",
                                          "trigger_once", "func_door", "func_plat", "func_button", "func_train", "func_door_secret"};
    map_text m = {0};
    for (size_t i = 0; i < sizeof classes / sizeof *classes; ++i) {
        map_add(&m, "{\n\"classname\" \"%s\"\n", classes[i]);
        map_add_box(&m, low, high, "stone");
        map_add(&m, "}\n");
    }
    map_add(&m, "{ \"classname\" \"info_player_start\" \"origin\" \"32 64 96\" }\n{ \"classname\" \"monster_ogre\" \"origin\" \"0 0 0\" }\n");
    map_add(&m, "{ \"classname\" \"light\" \"origin\" \"1 2 -3.5\" }\n{ \"classname\" \"info_null\" }\n");
    scene *s = scene_of(&m, &doors_open);
    assert_int_equal(s->mover_count, 5);
    assert_int_equal(s->item_count, 6 * 6);
    assert_int_equal(s->polygon_count, 11 * 6);
    assert_int_equal(s->object_count, 11);
    assert_string_equal(s->objects[0].name, "worldspawn");
    assert_string_equal(s->objects[4].name, "func_wall 4");
    assert_int_equal(s->objects[4].item_count, 6);
    assert_int_equal(s->solid_count, 11); // neither the trigger nor the illusion; the door shut and open
    uint32_t structure = 0;
    for (uint32_t i = 0; i < s->solid_count; ++i) structure += s->solids[i].kind == SOLID_STRUCTURE;
    assert_int_equal(structure, 3);
    assert_int_equal(s->place_count, 3);
    assert_int_equal(s->places[0].kind, PLACE_PLAYER);
    assert_int_equal(s->places[1].kind, PLACE_MONSTER);
    assert_int_equal(s->places[2].kind, PLACE_OTHER);
    assert_true(s->places[0].position[0] == 1 && s->places[0].position[1] == 3 && s->places[0].position[2] == -2);
    scene_free(s, allocator_heap());
}

static scene *door_scene(const char *keys, const import_options *options)
{
    map_text m = {0};
    const double far_low[3] = {-2048, -2048, -2048}, far_high[3] = {-2000, -2000, -2000}; // keeps bounds and origin alike
    const double other_low[3] = {2000, 2000, 2000}, other_high[3] = {2048, 2048, 2048};
    map_add(&m, "{\n\"classname\" \"worldspawn\"\n");
    map_add_box(&m, far_low, far_high, "stone");
    map_add_box(&m, other_low, other_high, "stone");
    map_add(&m, "}\n{\n\"classname\" \"func_door\"\n%s\n", keys);
    map_add_box(&m, low, high, "door");
    map_add(&m, "}\n");
    return scene_of(&m, options);
}

static void doors_open_along_their_angle_by_their_size_less_the_lip(void **state)
{
    (void)state;
    static const struct { const char *keys; double x, y, z; } cases[] = {
        // the door is 128 x 32 x 64 units; offsets in scene axes, metres
        {"", 120 / 32.0, 0, 0},
        {"\"angle\" \"0\" \"lip\" \"16\"", 112 / 32.0, 0, 0},
        {"\"angle\" \"90\"", 0, 0, -24 / 32.0},
        {"\"angle\" \"180\" \"spawnflags\" \"1\"", -120 / 32.0, 0, 0},
        {"\"angle\" \"-1\" \"lip\" \"0\"", 0, 56 / 32.0, 0},
        {"\"angle\" \"-2\" \"lip\" \"-8\"", 0, -72 / 32.0, 0},
        {"\"angles\" \"0 270 0\"", 0, 0, 24 / 32.0},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
        scene *open = door_scene(cases[c].keys, &doors_open), *shut = door_scene(cases[c].keys, &doors_shut);
        const double expected[3] = {cases[c].x, cases[c].y, cases[c].z};
        assert_int_equal(open->mover_count, 1);
        assert_int_equal(open->position_count, shut->position_count);
        assert_int_equal(open->door_count, 1);
        assert_int_equal(open->movers[0].door, 0);
        assert_int_equal(open->doors[0].mover, 0);
        assert_int_equal(open->doors[0].at_rest, DOORS_OPEN);
        assert_int_equal(shut->doors[0].at_rest, DOORS_SHUT);
        for (int k = 0; k < 3; ++k) {
            assert_true(open->movers[0].open_offset[k] == expected[k]);
            assert_true(shut->movers[0].open_offset[k] == expected[k]);
            assert_true(open->solids[3].min[k] - open->solids[2].min[k] == expected[k]);
            assert_true(shut->solids[2].min[k] == open->solids[2].min[k] && shut->solids[3].min[k] == open->solids[3].min[k]);
        }
        const scene_item *door = &open->items[open->item_count];
        for (uint32_t i = 0; i < door->index_count; ++i) {
            double a[3], b[3];
            world_position(open, open->indices[door->first_index + i], a);
            world_position(shut, shut->indices[door->first_index + i], b);
            for (int k = 0; k < 3; ++k) assert_true(a[k] - b[k] == expected[k]);
        }
        scene_free(open, allocator_heap());
        scene_free(shut, allocator_heap());
    }
}

static void a_mover_keeps_the_material_of_each_face(void **state)
{
    (void)state;
    map_text m = {0};
    map_add(&m, "{\n\"classname\" \"worldspawn\"\n}\n{\n\"classname\" \"func_button\"\n");
    map_add_box(&m, low, high, "*lava");
    map_add_box(&m, low, high, "stone");
    map_add(&m, "}\n");
    scene *s = scene_of(&m, &doors_open);
    assert_int_equal(s->mover_count, 1);
    assert_int_equal(s->items[0].polygon_count, 12);
    assert_string_equal(s->materials[s->items[0].material].name, "stone");
    assert_int_equal(s->items[0].flags & CULL_ITEM_SEE_THROUGH, 0);
    uint32_t lava = 0;
    for (uint32_t v = 0; v < s->position_count; ++v) lava += strcmp(s->materials[s->vertex_materials[v]].name, "*lava") == 0;
    assert_int_equal(lava, 24);
    scene_free(s, allocator_heap());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_brush_gives_six_polygons_that_face_outwards),
        cmocka_unit_test(a_map_point_is_turned_to_y_up_and_scaled_to_metres),
        cmocka_unit_test(a_turned_brush_keeps_its_shape),
        cmocka_unit_test(planes_that_repeat_or_only_touch_change_nothing),
        cmocka_unit_test(comments_line_ends_and_trailing_numbers_are_read_over),
        cmocka_unit_test(a_byte_order_mark_before_a_map_is_read_over),
        cmocka_unit_test(tool_textures_make_nothing_and_others_say_what_they_are),
        cmocka_unit_test(texture_coordinates_follow_both_projections),
        cmocka_unit_test(each_entity_plays_its_part),
        cmocka_unit_test(doors_open_along_their_angle_by_their_size_less_the_lip),
        cmocka_unit_test(a_mover_keeps_the_material_of_each_face),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
