// csg_subtract and csg_add in free space: what a point is, the last brush of the file that holds it says.
// SPDX-License-Identifier: MIT
#include "brushes.h"
#include "support.h"

#include "host/import/views_space.h"
#include "tests/common/random.h"

#include <math.h>
#include <string.h>

enum { BRUSHES = 24, POINTS = 4000, SCENES = 12 };

typedef struct box { double min[3], max[3], corner; int adds; } box; // corner: x + y + z of min up to which it is cut off

static void add_brush(map_text *m, const box *b)
{
    point_set faces[7];
    box_faces(b->min, b->max, faces);
    // Through three points on the edges from `min`, clockwise from outside.
    const double d = b->corner, *o = b->min;
    const point_set cut = {{{o[0] + d, o[1], o[2]}, {o[0], o[1] + d, o[2]}, {o[0], o[1], o[2] + d}}};
    faces[6] = cut;
    map_add_faces(m, faces, 7, "wall");
}

// How deep below (or, negative, how far above) the brush's surface the map point is, of its planes.
static double depth_of(const box *b, const double p[3])
{
    double depth = (p[0] + p[1] + p[2] - b->min[0] - b->min[1] - b->min[2] - b->corner) / sqrt(3);
    for (int k = 0; k < 3; ++k) depth = fmin(depth, fmin(p[k] - b->min[k], b->max[k] - p[k]));
    return depth;
}

static void random_box(uint64_t *seed, box *b)
{
    for (int k = 0; k < 3; ++k) {
        b->min[k] = (double)random_below(seed, 20) * 16;
        b->max[k] = b->min[k] + 48 + (double)random_below(seed, 16) * 16;
    }
    b->corner = 8 + (double)random_below(seed, 5) * 8;
    b->adds = random_below(seed, 2) != 0;
}

static void write_map(map_text *m, const box *boxes)
{
    m->size = 0;
    map_add(m, "{\n\"classname\" \"worldspawn\"\n");
    add_brush(m, &boxes[0]);
    map_add(m, "}\n");
    for (int i = 1; i < BRUSHES; ++i) {
        map_add(m, "{\n\"classname\" \"%s\"\n", boxes[i].adds ? "csg_add" : "csg_subtract");
        add_brush(m, &boxes[i]);
        map_add(m, "}\n");
    }
}

static double clearance_at(const free_space *space, const double p[3])
{
    const double at[3] = {p[0] / 32, p[2] / 32, -p[1] / 32};
    return free_space_clearance(space, at, 1, SPACE_SOLIDS);
}

static void test_free_space_follows_the_order_of_adding_and_taking_away(void **state)
{
    (void)state;
    static map_text m;
    uint64_t seed = 5, solid = 0, air = 0;
    for (int round = 0; round < SCENES; ++round) {
        box boxes[BRUSHES];
        for (int i = 0; i < BRUSHES; ++i) random_box(&seed, &boxes[i]);
        boxes[0].adds = 1;
        write_map(&m, boxes);
        scene *s = map_of(m.text, &doors_open);
        free_space *space;
        static const double origin[3] = {0, 0, 0};
        assert_int_equal(free_space_open(s, origin, allocator_heap(), &space), RESULT_OK);
        for (int i = 0; i < POINTS; ++i) {
            double p[3], nearest = INFINITY;
            int is_solid = 0;
            for (int k = 0; k < 3; ++k) p[k] = random_between(&seed, -20, 640);
            for (int b = 0; b < BRUSHES; ++b) {
                const double depth = depth_of(&boxes[b], p);
                nearest = fmin(nearest, fabs(depth));
                if (depth > 0) is_solid = boxes[b].adds;
            }
            if (nearest < 1) continue; // units: a surface goes neither way
            if (is_solid) assert_true(clearance_at(space, p) == 0);
            else assert_true(clearance_at(space, p) > 0);
            solid += (uint64_t)is_solid;
            air += !is_solid;
        }
        free_space_close(space);
        scene_free(s, allocator_heap());
    }
    assert_true(solid > 2000 && air > 2000);
}

static scene *carved_room(const char *first, const char *last)
{
    static map_text m;
    static const double rock[2][3] = {{-512, -512, -512}, {512, 512, 512}}, room[2][3] = {{-128, -128, -64}, {128, 128, 64}};
    m.size = 0;
    map_add(&m, "{\n\"classname\" \"%s\"\n", first);
    map_add_box(&m, rock[0], rock[1], "rock");
    map_add(&m, "}\n{\n\"classname\" \"%s\"\n", last);
    map_add_box(&m, room[0], room[1], "room");
    map_add(&m, "}\n{\n\"classname\" \"info_player_start\"\n\"origin\" \"0 0 0\"\n}\n");
    return map_of(m.text, &doors_open);
}

static void test_automatic_views_stand_in_a_carved_room(void **state)
{
    (void)state;
    scene *s = carved_room("worldspawn", "csg_subtract");
    camera_path path;
    heard h;
    report r = hear(&h);
    assert_int_equal(camera_path_load("auto:8", s, 16.0 / 9, allocator_heap(), &r, &path), RESULT_OK);
    assert_int_equal(h.notes, 0); // none that they are spread over the scene
    for (uint32_t i = 0; i < path.count; ++i) {
        assert_true(fabs(path.cameras[i].eye[0]) < 4 && fabs(path.cameras[i].eye[2]) < 4);
        assert_true(fabs(path.cameras[i].eye[1]) < 2);
    }
    camera_path_free(&path, allocator_heap());
    scene_free(s, allocator_heap());
}

static void test_what_is_added_later_is_not_carved(void **state)
{
    (void)state;
    static map_text m;
    static const double room[2][3] = {{-128, -128, -64}, {128, 128, 64}}, rock[2][3] = {{-512, -512, -512}, {512, 512, 512}};
    m.size = 0;
    map_add(&m, "{\n\"classname\" \"worldspawn\"\n}\n{\n\"classname\" \"csg_subtract\"\n");
    map_add_box(&m, room[0], room[1], "room");
    map_add(&m, "}\n{\n\"classname\" \"csg_add\"\n");
    map_add_box(&m, rock[0], rock[1], "rock");
    map_add(&m, "}\n");
    scene *s = map_of(m.text, &doors_open);
    assert_int_equal(s->solid_count, 1);
    assert_int_equal(s->solids[0].kind, SOLID_STRUCTURE);
    scene_free(s, allocator_heap());
}

static void test_a_portal_brush_of_the_compiler_is_neither_seen_nor_solid(void **state)
{
    (void)state;
    scene *s = carved_room("worldspawn", "zone_portal");
    assert_int_equal(s->item_count, 6);
    assert_int_equal(s->solid_count, 1);
    scene_free(s, allocator_heap());
}

// Boxes less boxes are boxes: pieces of pieces don't gather the planes of all holes.
static void test_pieces_have_no_plane_that_bounds_nothing(void **state)
{
    (void)state;
    static const double box[3] = {0, 0, 0}, size = 640;
    static map_text m;
    m.size = 0;
    map_add(&m, "{\n\"classname\" \"worldspawn\"\n");
    map_add_box(&m, box, (const double[3]){size, size, size}, "rock");
    map_add(&m, "}\n");
    for (int i = 0; i < 8; ++i) { // each meets the next
        const double low = 64 + 48 * i, high = low + 80;
        map_add(&m, "{\n\"classname\" \"csg_subtract\"\n");
        map_add_box(&m, (const double[3]){low, low, low}, (const double[3]){high, high, high}, "hole");
        map_add(&m, "}\n");
    }
    scene *s = map_of(m.text, &doors_open);
    double solid = 0, rock = 1, hole = 0;
    for (int k = 0; k < 3; ++k) rock *= size / 32;
    hole = 8 * pow(80.0 / 32, 3) - 7 * pow(1, 3); // less what two share, a cube of 32 units
    for (uint32_t i = 0; i < s->solid_count; ++i) {
        const scene_solid *b = &s->solids[i];
        assert_int_equal(b->plane_count, 6);
        solid += (b->max[0] - b->min[0]) * (b->max[1] - b->min[1]) * (b->max[2] - b->min[2]);
    }
    assert_true(s->solid_count > 6 && fabs(solid - (rock - hole)) < 1e-6);
    scene_free(s, allocator_heap());
}

static void test_carving_takes_every_path_out_of_memory(void **state)
{
    (void)state;
    static const scene_solid_plane box[6] = {{{-1, 0, 0}, 1}, {{1, 0, 0}, 1}, {{0, -1, 0}, 1}, {{0, 1, 0}, 1}, {{0, 0, -1}, 1}, {{0, 0, 1}, 1}};
    static const scene_solid_plane hole[6] = {{{-1, 0, 0}, 0.5}, {{1, 0, 0}, 0.5}, {{0, -1, 0}, 0.5}, {{0, 1, 0}, 0.5}, {{0, 0, -1}, 0.5}, {{0, 0, 1}, 0.5}};
    static const double min[3] = {-1, -1, -1}, max[3] = {1, 1, 1};
    result done = RESULT_NO_MEMORY;
    for (uint64_t fail_at = 1; done == RESULT_NO_MEMORY; ++fail_at) {
        shaky_memory memory = {.fail_at = fail_at};
        const allocator a = shaky_allocator(&memory);
        scene_builder *b = NULL;
        done = scene_builder_open(&a, &b);
        if (done == RESULT_OK) done = scene_builder_solid(b, SOLID_STRUCTURE, box, 6, min, max);
        if (done == RESULT_OK) done = scene_builder_solid_subtract(b, hole, 6);
        if (done == RESULT_OK) assert_true(scene_builder_size(b) >= 6 * 6); // six pieces
        scene_builder_close(b);
        assert_int_equal(memory.live_bytes, 0);
        assert_true(fail_at < 100);
    }
    assert_int_equal(done, RESULT_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_free_space_follows_the_order_of_adding_and_taking_away),
        cmocka_unit_test(test_automatic_views_stand_in_a_carved_room),
        cmocka_unit_test(test_what_is_added_later_is_not_carved),
        cmocka_unit_test(test_a_portal_brush_of_the_compiler_is_neither_seen_nor_solid),
        cmocka_unit_test(test_pieces_have_no_plane_that_bounds_nothing),
        cmocka_unit_test(test_carving_takes_every_path_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
