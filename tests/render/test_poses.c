// Movers: at rest they are drawn to the bit as if they never moved, and posed as if they had been built where they are.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 160, QUADS = 40, MOVERS = 10 };

static const scene_pose REST = {.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

static void drop_pixels(uint8_t *rgba)
{
    memory_free(allocator_heap(), rgba, (size_t)SIDE * SIDE, 4);
}

static frame_request request(const camera *c, render_mode mode)
{
    return (frame_request){.camera = c, .width_px = SIDE, .height_px = SIDE, .mode = mode};
}

// Random quads on a grid of 1/64 m, in every direction; the last MOVERS of them movers where asked.
static void random_quads(quad *quads, uint32_t seed, uint32_t is_mover)
{
    for (uint32_t i = 0; i < QUADS; ++i) {
        double a[3], u[3] = {0}, v[3] = {0};
        const uint32_t axis = random_next(&seed) % 3;
        for (int k = 0; k < 3; ++k) a[k] = floor(64 * (16 * random_unit(&seed) - 8)) / 64;
        u[(axis + 1) % 3] = floor(64 * (5 * random_unit(&seed) + 0.5)) / 64;
        v[(axis + 2) % 3] = floor(64 * (5 * random_unit(&seed) + 0.5)) / 64;
        quads[i] = quad_at(0, 0, 0, 0, 0);
        for (int k = 0; k < 3; ++k) {
            quads[i].corners[0][k] = a[k];
            quads[i].corners[1][k] = a[k] + u[k];
            quads[i].corners[2][k] = a[k] + u[k] + v[k];
            quads[i].corners[3][k] = a[k] + v[k];
        }
        quads[i].is_mover = is_mover && i >= QUADS - MOVERS;
    }
}

static void turn(const double m[9], const double from[3], double out[3])
{
    for (int row = 0; row < 3; ++row) out[row] = m[3 * row] * from[0] + m[3 * row + 1] * from[1] + m[3 * row + 2] * from[2];
}

static void apply(const scene_pose *p, double corner[3])
{
    double away[3], turned[3];
    for (int k = 0; k < 3; ++k) away[k] = corner[k] - p->pivot[k];
    turn(p->rotation, away, turned);
    for (int k = 0; k < 3; ++k) corner[k] = turned[k] + p->pivot[k] + p->offset[k];
}

static scene_pose random_pose(uint32_t *seed)
{
    static const double TURNS[4][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, -1, 0, 1, 0, 0, 0, 0, 1}, {0, 0, 1, 0, 1, 0, -1, 0, 0}, {1, 0, 0, 0, -1, 0, 0, 0, -1}};
    scene_pose p = {0};
    memcpy(p.rotation, TURNS[random_next(seed) % 4], sizeof p.rotation);
    for (int k = 0; k < 3; ++k) {
        p.pivot[k] = floor(64 * (4 * random_unit(seed) - 2)) / 64;
        p.offset[k] = floor(64 * (4 * random_unit(seed) - 2)) / 64;
    }
    return p;
}

static camera eye_number(int i)
{
    camera c = camera_at(3.0 * i - 7, 0.7 * i - 1, i % 2 ? 14 : 1.3);
    c.up[0] = 0.2 * i;
    return c;
}

static void movers_at_rest_are_drawn_to_the_bit_as_what_never_moves(void **state)
{
    bed *b = *state;
    quad quads[QUADS];
    scene_pose poses[MOVERS];
    for (uint32_t i = 0; i < MOVERS; ++i) poses[i] = REST;
    for (uint32_t i = 0; i < MOVERS; ++i) poses[i].pivot[0] = 0.1 * i; // of no meaning without a turn
    for (uint32_t seed = 1; seed <= 3; ++seed)
        for (int eye = 0; eye < 4; ++eye) {
            const camera c = eye_number(eye);
            const frame_request q = request(&c, RENDER_ITEMS);
            const cull_run all = {0, QUADS};
            random_quads(quads, seed, 0);
            bed_scene(b, quads, QUADS, NULL);
            id_picture still = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
            uint8_t *still_rgba = bed_frame(b, &q, b->l, &all, 1);
            random_quads(quads, seed, 1);
            bed_scene(b, quads, QUADS, NULL);
            for (int set = 0; set < 2; ++set) {
                if (set) renderer_poses(b->g, poses);
                id_picture posed = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
                uint8_t *rgba = bed_frame(b, &q, b->l, &all, 1);
                assert_memory_equal(still.triangles, posed.triangles, sizeof(uint32_t) * SIDE * SIDE);
                assert_memory_equal(still_rgba, rgba, SIDE * SIDE * 4);
                id_picture_free(&posed, allocator_heap());
                drop_pixels(rgba);
            }
            id_picture_free(&still, allocator_heap());
            drop_pixels(still_rgba);
        }
}

static uint32_t triangles_that_differ(const id_picture *a, const id_picture *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) count += a->triangles[i] != b->triangles[i];
    return count;
}

// The scene built with its movers where `poses` have them.
static id_picture picture_of_moved(bed *b, const quad *quads, const scene_pose *poses, const camera *c)
{
    quad moved[QUADS];
    memcpy(moved, quads, sizeof moved);
    for (uint32_t i = 0; i < MOVERS; ++i)
        for (int k = 0; k < 4; ++k) apply(&poses[i], moved[QUADS - MOVERS + i].corners[k]);
    bed_scene(b, moved, QUADS, NULL);
    return bed_ids(b, &(id_request){.camera = c}, SIDE, SIDE);
}

static void posed_movers_are_drawn_where_they_are(void **state)
{
    bed *b = *state;
    quad quads[QUADS];
    scene_pose poses[MOVERS];
    uint32_t seed = 12;
    for (int round = 0; round < 8; ++round) {
        const camera c = eye_number(round % 4);
        random_quads(quads, 20 + (uint32_t)round, 1);
        for (uint32_t i = 0; i < MOVERS; ++i) poses[i] = random_pose(&seed);
        id_picture moved = picture_of_moved(b, quads, poses, &c);
        bed_scene(b, quads, QUADS, NULL);
        id_picture rest = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
        renderer_poses(b->g, poses);
        id_picture posed = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
        assert_true(triangles_that_differ(&rest, &posed) > SIDE);
        assert_in_range(triangles_that_differ(&moved, &posed), 0, 20); // edges, of other rounding
        id_picture_free(&moved, allocator_heap());
        id_picture_free(&rest, allocator_heap());
        id_picture_free(&posed, allocator_heap());
    }
}

static void an_upload_puts_movers_to_rest(void **state)
{
    bed *b = *state;
    quad quads[QUADS];
    scene_pose poses[MOVERS];
    uint32_t seed = 4;
    const camera c = eye_number(1);
    random_quads(quads, 2, 1);
    for (uint32_t i = 0; i < MOVERS; ++i) poses[i] = random_pose(&seed);
    bed_scene(b, quads, QUADS, NULL);
    id_picture rest = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
    renderer_poses(b->g, poses);
    assert_int_equal(renderer_upload(b->g, b->s, &b->r), RESULT_OK);
    id_picture again = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
    assert_int_equal(triangles_that_differ(&rest, &again), 0);
    id_picture_free(&rest, allocator_heap());
    id_picture_free(&again, allocator_heap());
}

static int has_bit(const uint32_t *bits, uint32_t i)
{
    return (int)(bits[i >> 5] >> (i & 31) & 1);
}

static void rotate_z(scene_pose *p, double radians)
{
    const double turned[9] = {cos(radians), -sin(radians), 0, sin(radians), cos(radians), 0, 0, 0, 1};
    memcpy(p->rotation, turned, sizeof turned);
}

static void the_floor_and_the_frame_follow_poses(void **state)
{
    bed *b = *state;
    quad quads[QUADS];
    scene_pose poses[MOVERS];
    uint32_t seed = 31, owners = 0, left_out = 0;
    for (int round = 0; round < 10; ++round) {
        const camera c = eye_number(round % 4);
        const frame_request q = request(&c, RENDER_ITEMS);
        uint32_t bits[QUADS / 32 + 1];
        random_quads(quads, 40 + (uint32_t)round, 1);
        bed_scene(b, quads, QUADS, NULL);
        for (uint32_t i = 0; i < MOVERS; ++i) {
            poses[i] = random_pose(&seed);
            rotate_z(&poses[i], random_unit(&seed) * 6);
        }
        renderer_poses(b->g, poses);
        id_picture p = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
        assert_int_equal(renderer_floor(b->g, &c, &b->r, bits), RESULT_OK);
        uint8_t *rgba = bed_frame(b, &q, b->l, &(cull_run){0, QUADS}, 1);
        uint32_t differ = 0;
        for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
            const uint32_t owner = p.triangles[i] ? (p.triangles[i] - 1) / 2 : QUADS, x = i % SIDE, y = SIDE - 1 - i / SIDE;
            const uint8_t *at = rgba + 4 * ((size_t)y * SIDE + x);
            differ += (at[0] + at[1] + at[2] != 0) != (owner < QUADS);
            if (owner < QUADS) assert_true(has_bit(bits, owner));
            owners += owner >= QUADS - MOVERS && owner < QUADS;
        }
        assert_int_equal(differ, 0); // the same raster in both
        for (uint32_t i = QUADS - MOVERS; i < QUADS; ++i) left_out += !has_bit(bits, i);
        id_picture_free(&p, allocator_heap());
        drop_pixels(rgba);
    }
    assert_true(owners > 1000 && left_out > 5);
}

static void a_moved_liquid_is_seen_through_and_sorted_where_it_is(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c, RENDER_SHADED);
    quad quads[] = {quad_at(-8, -20, -20, 20, 20), quad_at(-6, -20, -20, 20, 20), quad_at(-4, -20, -20, 20, 20)};
    for (int i = 1; i < 3; ++i) {
        quads[i].material = i == 1 ? "*green" : "*red";
        quads[i].colour = i == 1 ? 0xff00ff00u : 0xff0000ffu;
        quads[i].material_flags = MATERIAL_TRANSLUCENT;
    }
    quads[0].material = "white";
    quads[0].colour = 0xffffffffu;
    quads[2].is_mover = 1;
    bed_scene(b, quads, 3, NULL);
    const cull_run all = {0, 3};
    const size_t middle = 4 * ((size_t)SIDE / 2 * SIDE + SIDE / 2);
    scene_pose pose = REST;
    for (int where = 0; where < 3; ++where) { // before the green one, behind it, behind the wall
        pose.offset[2] = where == 0 ? 0 : where == 1 ? -3 : -5;
        renderer_poses(b->g, &pose);
        uint8_t *rgba = bed_frame(b, &q, b->l, &all, 1);
        id_picture p = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
        assert_int_equal(see_through_at(&p, 2), 1);
        assert_int_equal(see_through_at(&p, 4), where < 2);
        if (where == 0) assert_true(rgba[middle] > rgba[middle + 1] + 20);
        else assert_true(rgba[middle + 1] > rgba[middle] + 20);
        id_picture_free(&p, allocator_heap());
        drop_pixels(rgba);
    }
}

static void a_mover_that_shares_vertices_with_a_wall_leaves_the_wall(void **state)
{
    bed *b = *state;
    const double still[3] = {0, 0, 0};
    const camera c = camera_at(0, 0, 0);
    scene_builder *builder = NULL;
    uint32_t object, material, first;
    builder_vertex vertices[6] = {{{-4, -2, -5}, {0, 0, 0}, {0, 0}}, {{0, -2, -5}, {0, 0, 0}, {0, 0}}, {{0, 2, -5}, {0, 0, 0}, {0, 0}},
                                  {{-4, 2, -5}, {0, 0, 0}, {0, 0}},  {{4, -2, -5}, {0, 0, 0}, {0, 0}}, {{4, 2, -5}, {0, 0, 0}, {0, 0}}};
    assert_int_equal(scene_builder_open(&b->memory.memory, &builder), RESULT_OK);
    assert_int_equal(scene_builder_object(builder, "all", 3, &object), RESULT_OK);
    assert_int_equal(scene_builder_material(builder, "grey", 4, 0, &material), RESULT_OK);
    assert_int_equal(scene_builder_vertices(builder, vertices, 6, material, &first), RESULT_OK);
    const uint32_t left[6] = {0, 1, 2, 0, 2, 3}, right[6] = {1, 4, 5, 1, 5, 2};
    const builder_item wall = {.indices = left, .index_count = 6, .polygon_count = 2, .material = material, .object = object};
    builder_item door = wall;
    door.indices = right;
    assert_int_equal(scene_builder_item(builder, &wall), RESULT_OK);
    assert_int_equal(scene_builder_mover(builder, "door", still, &door), RESULT_OK);
    assert_int_equal(scene_builder_mover(builder, "second", still, &door), RESULT_OK); // shares all with the first
    assert_int_equal(scene_builder_finish(builder, "test", &b->r, &b->s), RESULT_OK);
    scene_builder_close(builder);
    assert_int_equal(renderer_upload(b->g, b->s, &b->r), RESULT_OK);
    scene_pose poses[2] = {REST, REST};
    poses[0].offset[1] = 1.5; // its lower edge at -0.5, the second's upper at 0.5
    poses[1].offset[1] = -1.5;
    renderer_poses(b->g, poses);
    id_picture p = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
    const uint32_t x_left = SIDE * 3 / 10, x_right = SIDE * 6 / 10;
    assert_in_range(id_at(&p, x_left, SIDE / 2), 1, 2);
    assert_int_equal(id_at(&p, x_left, SIDE * 8 / 10), 0); // the wall's top is at 0.7
    assert_in_range(id_at(&p, x_right, SIDE * 8 / 10), 3, 4);
    assert_in_range(id_at(&p, x_right, SIDE / 2), 3, 4); // of equal depth: the lower id
    assert_in_range(id_at(&p, x_right, SIDE * 2 / 10), 5, 6);
    assert_int_equal(id_at(&p, x_right, SIDE * 95 / 100), 0);
    id_picture_free(&p, allocator_heap());
}

static void far_from_the_origin_poses_are_as_fine(void **state)
{
    bed *b = *state;
    const double far_off[3] = {1e7, -1e7, 1e7};
    quad quads[QUADS];
    scene_pose poses[MOVERS];
    uint32_t seed = 61;
    camera c = eye_number(1);
    random_quads(quads, 9, 1);
    for (uint32_t i = 0; i < MOVERS; ++i) {
        poses[i] = random_pose(&seed);
        rotate_z(&poses[i], 0.3 * i);
    }
    bed_scene(b, quads, QUADS, NULL);
    renderer_poses(b->g, poses);
    id_picture near_by = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
    bed_scene(b, quads, QUADS, far_off);
    for (int k = 0; k < 3; ++k) {
        c.eye[k] += far_off[k];
        for (uint32_t i = 0; i < MOVERS; ++i) poses[i].pivot[k] += far_off[k];
    }
    renderer_poses(b->g, poses);
    id_picture far_away = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
    assert_in_range(triangles_that_differ(&near_by, &far_away), 0, 20);
    id_picture_free(&near_by, allocator_heap());
    id_picture_free(&far_away, allocator_heap());
}

static void poses_allocate_nothing_and_count_from_the_next_draw_on(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c, RENDER_ITEMS);
    quad quads[] = {quad_at(-30, -20, -20, 20, 20), quad_at(-5, -2, -2, 2, 2)};
    uint8_t rgba[SIDE * SIDE * 4];
    quads[1].is_mover = 1;
    bed_scene(b, quads, 2, NULL);
    scene_pose pose = REST;
    pose.offset[0] = 100;
    drop_pixels(bed_frame(b, &q, b->l, &(cull_run){0, 2}, 1));
    const uint64_t before = b->memory.calls;
    for (int moved = 0; moved < 2; ++moved) {
        assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
        if (!moved) renderer_draw_movers(b->g, b->l, (const uint32_t[]){0, 1, 700}, 3); // of those that the scene lacks nothing is drawn
        renderer_poses(b->g, &pose);
        if (moved) renderer_draw_movers(b->g, b->l, (const uint32_t[]){0}, 1);
        renderer_end(b->g);
        assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
        const uint8_t *p = rgba + 4 * ((size_t)SIDE / 2 * SIDE + SIDE / 2);
        assert_int_equal(p[0] + p[1] + p[2] != 0, !moved);
    }
    assert_int_equal(b->memory.calls, before);
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest poses[] = {
        T(movers_at_rest_are_drawn_to_the_bit_as_what_never_moves),
        T(posed_movers_are_drawn_where_they_are),
        T(an_upload_puts_movers_to_rest),
        T(the_floor_and_the_frame_follow_poses),
        T(a_moved_liquid_is_seen_through_and_sorted_where_it_is),
        T(a_mover_that_shares_vertices_with_a_wall_leaves_the_wall),
        T(far_from_the_origin_poses_are_as_fine),
        T(poses_allocate_nothing_and_count_from_the_next_draw_on),
    };
    return RUN_WITH_GL(poses);
}
