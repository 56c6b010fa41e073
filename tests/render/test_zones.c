// Layouts of many zones: the same picture from any zone's list, few draw calls, and answers that stay with who asked.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <string.h>

enum { SIDE = 96, ROOMS = 5 };
static const double NEAR_CORNER[3] = {-7, 2, 3}, FAR_CORNER[3] = {1e7 + 1.5, -1e7, 1e7 - 0.25};

static void drop_pixels(uint8_t *rgba)
{
    memory_free(allocator_heap(), rgba, (size_t)SIDE * SIDE, 4);
}

static frame_request request(const camera *c, render_mode mode)
{
    return (frame_request){.camera = c, .width_px = SIDE, .height_px = SIDE, .mode = mode};
}

// An eye in a room, not at a wall, looking anywhere.
static camera random_eye(const double corner[3], uint32_t *seed)
{
    camera c = camera_at(0, 0, 0);
    c.near_m = 1.0 / 64;
    c.eye[0] = corner[0] + ROOM_SIDE_M * (random_next(seed) % ROOMS + 0.1 + 0.8 * random_unit(seed));
    c.eye[1] = corner[1] + ROOM_HIGH_M * (0.1 + 0.8 * random_unit(seed));
    c.eye[2] = corner[2] - ROOM_SIDE_M * (random_next(seed) % ROOMS + 0.1 + 0.8 * random_unit(seed));
    for (int k = 0; k < 3; ++k) c.forward[k] = random_unit(seed) - 0.5;
    c.forward[1] *= 0.5;
    return c;
}

static void draw_all_zones(bed *b, const render_layout *l)
{
    for (uint32_t z = 0; z < b->s->zone_count; ++z)
        if (b->s->zones[z].item_count) renderer_draw(b->g, l, z, &(cull_run){0, b->s->zones[z].item_count}, 1);
}

static uint8_t *picture_of_zones(bed *b, const frame_request *q, const render_layout *l)
{
    uint8_t *rgba = memory_alloc(allocator_heap(), (size_t)SIDE * SIDE, 4);
    assert_non_null(rgba);
    assert_int_equal(renderer_begin(b->g, q, &b->r), RESULT_OK);
    draw_all_zones(b, l);
    renderer_end(b->g);
    assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
    return rgba;
}

static void rooms_are_zones_of_many_origins(void **state)
{
    bed *b = *state;
    bed_rooms(b, ROOMS, NEAR_CORNER);
    assert_true(b->s->zone_count >= ROOMS * ROOMS);
    assert_true(b->s->zone_item_count > b->s->item_count); // walls between rooms stand in both
    assert_true(memcmp(b->s->zones[0].origin, b->s->zones[ROOMS * ROOMS - 1].origin, sizeof b->s->zones[0].origin) != 0);
}

static void no_crack_shows_between_zones_near_or_far_from_the_world_s_origin(void **state)
{
    bed *b = *state;
    const double *const corners[] = {NEAR_CORNER, FAR_CORNER};
    uint32_t seed = 77;
    for (int where = 0; where < 2; ++where) {
        bed_rooms(b, ROOMS, corners[where]);
        render_layout *l = bed_zone_layout(b, LIST_REVERSED);
        for (int view = 0; view < 40; ++view) {
            const camera c = random_eye(corners[where], &seed);
            const frame_request q = request(&c, RENDER_ITEMS);
            id_picture p = bed_ids(b, &(id_request){.camera = &c}, SIDE, SIDE);
            uint8_t *rgba = picture_of_zones(b, &q, l);
            for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
                assert_int_not_equal(p.triangles[i], 0);
                assert_int_not_equal(rgba[4 * i] + rgba[4 * i + 1] + rgba[4 * i + 2], 0);
            }
            id_picture_free(&p, allocator_heap());
            drop_pixels(rgba);
        }
        render_layout_close(l);
    }
}

static void an_item_shows_the_same_from_any_zone_that_lists_it(void **state)
{
    bed *b = *state;
    static const render_mode MODES[] = {RENDER_SHADED, RENDER_ITEMS, RENDER_ZONES, RENDER_DEPTH};
    uint32_t seed = 5;
    bed_rooms(b, ROOMS, NEAR_CORNER);
    render_layout *l = bed_zone_layout(b, LIST_REVERSED);
    for (uint32_t mode = 0; mode < 4; ++mode) {
        const camera c = random_eye(NEAR_CORNER, &seed);
        const frame_request q = request(&c, MODES[mode]);
        uint8_t *plain = bed_frame(b, &q, b->l, &(cull_run){0, b->s->item_count}, 1), *zones = picture_of_zones(b, &q, l);
        assert_memory_equal(plain, zones, SIDE * SIDE * 4);
        drop_pixels(plain);
        drop_pixels(zones);
    }
    render_layout_close(l);
}

static void a_thousand_zones_cost_one_draw_call(void **state)
{
    bed *b = *state;
    enum { MANY = 1000 };
    static quad quads[MANY];
    static uint32_t items[MANY];
    static render_layout_zone zones[MANY];
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c, RENDER_ITEMS);
    render_layout *l = NULL;
    for (uint32_t i = 0; i < MANY; ++i) {
        const double x = (i % 40) - 20.0, y = (double)(i / 40) - 12;
        quads[i] = quad_at(-10, x, y, x + 0.9, y + 0.9);
        items[i] = (i * 7) % MANY;
        zones[i] = (render_layout_zone){&items[i], 1};
    }
    bed_scene(b, quads, MANY, NULL);
    assert_int_equal(render_layout_open(b->g, zones, MANY, &b->r, &l), RESULT_OK);
    uint8_t *plain = bed_frame(b, &q, b->l, &(cull_run){0, MANY}, 1);
    uint8_t *rgba = memory_alloc(allocator_heap(), (size_t)SIDE * SIDE, 4);
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    for (uint32_t z = 0; z < MANY; ++z) renderer_draw(b->g, l, z, &(cull_run){0, 1}, 1);
    renderer_end(b->g);
    assert_int_equal(renderer_draw_calls(b->g), 1);
    assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
    assert_memory_equal(plain, rgba, SIDE * SIDE * 4);
    drop_pixels(plain);
    drop_pixels(rgba);
    render_layout_close(l);
}

static uint32_t colour_at(const uint8_t *rgba, uint32_t x, uint32_t y_from_top)
{
    const uint8_t *p = rgba + 4 * ((size_t)y_from_top * SIDE + x);
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16;
}

static void zones_mode_shows_one_colour_for_what_a_zone_lists_first(void **state)
{
    bed *b = *state;
    bed_rooms(b, ROOMS, (const double[3]){0, 0, 0});
    camera c = camera_at(2, 1.5, -2);
    c.forward[1] = -1; // the floors; a room's neighbour touches it and lists it too
    c.forward[2] = -0.001;
    c.near_m = 1.0 / 64;
    const frame_request q = request(&c, RENDER_ZONES);
    uint8_t *in_first = bed_frame(b, &q, b->l, &(cull_run){0, b->s->item_count}, 1);
    c.eye[0] = 2 + 2 * ROOM_SIDE_M;
    uint8_t *in_second = bed_frame(b, &q, b->l, &(cull_run){0, b->s->item_count}, 1);
    const uint32_t first = colour_at(in_first, SIDE / 2, SIDE / 2), second = colour_at(in_second, SIDE / 2, SIDE / 2);
    assert_int_not_equal(first, second);
    assert_int_equal(colour_at(in_first, SIDE / 3, SIDE / 2), first);
    assert_int_equal(colour_at(in_second, SIDE / 3, SIDE / 2), second);
    drop_pixels(in_first);
    drop_pixels(in_second);
}

// ---- Reorder ----

static void reverse(uint32_t *items, uint32_t count)
{
    for (uint32_t i = 0; i < count / 2; ++i) {
        const uint32_t kept = items[i];
        items[i] = items[count - 1 - i];
        items[count - 1 - i] = kept;
    }
}

// Place by place: one item of the zone at a time, named by its colour.
static void assert_places(bed *b, const render_layout *l, uint32_t zone, const uint32_t *items, uint32_t count)
{
    const camera c = camera_at(2, 1.5, -2);
    const frame_request q = request(&c, RENDER_ITEMS);
    uint8_t *rgba = memory_alloc(allocator_heap(), (size_t)SIDE * SIDE, 4);
    for (uint32_t place = 0; place < count; ++place) {
        uint8_t *wanted = bed_frame(b, &q, b->l, &(cull_run){items[place], 1}, 1);
        assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
        renderer_draw(b->g, l, zone, &(cull_run){place, 1}, 1);
        renderer_end(b->g);
        assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
        assert_memory_equal(wanted, rgba, SIDE * SIDE * 4);
        drop_pixels(wanted);
    }
    drop_pixels(rgba);
}

static void a_reordered_zone_draws_in_its_new_order_and_others_in_their_old(void **state)
{
    bed *b = *state;
    uint32_t items[64];
    bed_rooms(b, 2, (const double[3]){0, 0, 0});
    render_layout *l = bed_zone_layout(b, LIST_ORDER);
    const scene_zone *first = &b->s->zones[0], *second = &b->s->zones[1];
    assert_in_range(first->item_count, 2, 64);
    memcpy(items, b->s->zone_items + first->first_item, first->item_count * sizeof *items);
    for (int round = 0; round < 3; ++round) {
        reverse(items, first->item_count);
        assert_int_equal(render_layout_reorder(l, 0, items, &b->r), RESULT_OK);
        assert_places(b, l, 0, items, first->item_count);
        assert_places(b, l, 1, b->s->zone_items + second->first_item, second->item_count);
        reverse(items + 1, first->item_count - 1);
    }
    render_layout_close(l);
}

static void a_layout_that_shared_the_scene_s_indices_may_be_reordered(void **state)
{
    bed *b = *state;
    uint32_t items[64];
    render_layout *l = NULL;
    bed_rooms(b, 2, (const double[3]){0, 0, 0});
    assert_in_range(b->s->item_count, 2, 64);
    assert_int_equal(bed_layout(b, NULL, &l), RESULT_OK);
    for (uint32_t i = 0; i < b->s->item_count; ++i) items[i] = (i + 3) % b->s->item_count;
    b->memory.fail_at = b->memory.calls + 2; // of two: nothing may change
    b->r.line = NULL;
    assert_int_equal(render_layout_reorder(l, 0, items, &b->r), RESULT_NO_MEMORY);
    b->memory.fail_at = 0;
    uint32_t straight[64];
    for (uint32_t i = 0; i < b->s->item_count; ++i) straight[i] = i;
    assert_places(b, l, 0, straight, b->s->item_count);
    assert_int_equal(render_layout_reorder(l, 0, items, &b->r), RESULT_OK);
    assert_places(b, l, 0, items, b->s->item_count);
    render_layout_close(l);
}

static void movers_stand_behind_all_zones_before_and_after_a_reorder(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c, RENDER_ITEMS);
    static const uint32_t straight[3] = {0, 1, 2}, turned[3] = {2, 1, 0};
    const render_layout_zone one[1] = {{straight, 3}}, two[2] = {{turned, 3}, {turned + 1, 2}};
    quad quads[5];
    for (int i = 0; i < 5; ++i) quads[i] = quad_at(-5, 2 * i - 5, -2, 2 * i - 3, 2);
    quads[3].is_mover = quads[4].is_mover = 1;
    bed_scene(b, quads, 5, NULL);
    for (uint32_t zones = 1; zones <= 2; ++zones) {
        render_layout *l = NULL;
        assert_int_equal(render_layout_open(b->g, zones == 1 ? one : two, zones, &b->r, &l), RESULT_OK);
        for (int round = 0; round < 2; ++round) {
            uint8_t *wanted = bed_frame(b, &q, b->l, &(cull_run){3, 2}, 1), got[SIDE * SIDE * 4];
            assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
            renderer_draw_movers(b->g, l, (const uint32_t[]){1, 0}, 2);
            renderer_end(b->g);
            assert_int_equal(renderer_read(b->g, got, &b->r), RESULT_OK);
            assert_memory_equal(wanted, got, sizeof got);
            assert_int_not_equal(colour_at(got, SIDE * 7 / 10, SIDE / 2), 0);
            drop_pixels(wanted);
            assert_int_equal(render_layout_reorder(l, 0, round ? straight : turned, &b->r), RESULT_OK);
        }
        render_layout_close(l);
    }
}

// ---- Rectangles ----

// Two quads side by side, a zone each, and a wall behind in a third.
static render_layout *three_zones(bed *b)
{
    static const uint32_t items[3] = {0, 1, 2};
    const render_layout_zone zones[3] = {{&items[0], 1}, {&items[1], 1}, {&items[2], 1}};
    quad quads[] = {quad_at(-5, -4, -2, -1, 2), quad_at(-5, 1, -2, 4, 2), quad_at(-8, -20, -20, 20, 20)};
    render_layout *l = NULL;
    quads[0].material = "red";
    quads[0].colour = 0xff0000ffu;
    quads[1].material = "*water";
    quads[1].colour = 0xffff0000u;
    quads[1].material_flags = MATERIAL_TRANSLUCENT;
    bed_scene(b, quads, 3, NULL);
    assert_int_equal(render_layout_open(b->g, zones, 3, &b->r, &l), RESULT_OK);
    return l;
}

static uint8_t *picture_cut(bed *b, render_scissor scissor, const render_layout *l, const float (*rectangles)[4])
{
    const camera c = camera_at(0, 0, 0);
    frame_request q = request(&c, RENDER_SHADED);
    q.scissor = scissor;
    uint8_t *rgba = memory_alloc(allocator_heap(), (size_t)SIDE * SIDE, 4);
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    for (uint32_t z = 0; z < 3; ++z) {
        renderer_zone_rectangle(b->g, z, rectangles[z]);
        renderer_draw(b->g, l, z, &(cull_run){0, 1}, 1);
    }
    renderer_end(b->g);
    assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
    return rgba;
}

static void rectangles_that_bound_what_is_seen_change_no_pixel(void **state)
{
    bed *b = *state;
    static const float TIGHT[3][4] = {{-0.8f, -0.4f, -0.2f, 0.4f}, {0.2f, -0.4f, 0.8f, 0.4f}, {-1, -1, 1, 1}};
    render_layout *l = three_zones(b);
    uint8_t *whole = picture_cut(b, SCISSOR_NONE, l, TIGHT), *cut = picture_cut(b, SCISSOR_ZONES, l, TIGHT);
    assert_memory_equal(whole, cut, SIDE * SIDE * 4);
    drop_pixels(whole);
    drop_pixels(cut);
    render_layout_close(l);
}

static void a_smaller_rectangle_cuts_opaque_and_translucent_and_ends_with_its_frame(void **state)
{
    bed *b = *state;
    static const float SMALL[3][4] = {{-0.8f, -0.4f, -0.5f, 0.4f}, {0.5f, -0.4f, 0.8f, 0.4f}, {-1, -1, 1, 1}};
    static const float WRONG[3][4] = {{0.9f, 0, -0.9f, 0}, {2, 2, 3, 3}, {-1, -1, 1, 1}};
    const uint32_t y = SIDE / 2, inside = SIDE * 15 / 100, outside = SIDE * 35 / 100;
    render_layout *l = three_zones(b);
    uint8_t *whole = picture_cut(b, SCISSOR_NONE, l, SMALL), *cut = picture_cut(b, SCISSOR_ZONES, l, SMALL);
    uint8_t *none = picture_cut(b, SCISSOR_ZONES, l, WRONG), *again = picture_cut(b, SCISSOR_NONE, l, SMALL);
    const uint32_t wall = colour_at(whole, SIDE / 2, y);
    for (uint32_t mirror = 0; mirror < 2; ++mirror) {
        const uint32_t in = mirror ? SIDE - 1 - inside : inside, out = mirror ? SIDE - 1 - outside : outside;
        assert_int_not_equal(colour_at(whole, in, y), wall);
        assert_int_not_equal(colour_at(whole, out, y), wall);
        assert_int_equal(colour_at(cut, in, y), colour_at(whole, in, y));
        assert_int_equal(colour_at(cut, out, y), wall);
        assert_int_equal(colour_at(none, in, y), wall);
    }
    assert_memory_equal(whole, again, SIDE * SIDE * 4);
    drop_pixels(whole);
    drop_pixels(cut);
    drop_pixels(none);
    drop_pixels(again);
    render_layout_close(l);
}

// Least and greatest of where the corners of a zone's items are in the picture; whole when one is behind the eye.
static void rectangle_of(const bed *b, uint32_t zone, const camera *c, float out[4])
{
    const scene_zone *z = &b->s->zones[zone];
    const cull_boxes *x = &b->s->boxes;
    double clip[16], least[2] = {1e9, 1e9}, most[2] = {-1e9, -1e9};
    camera_clip_from_eye(c, clip);
    memcpy(out, (const float[4]){-1, -1, 1, 1}, 4 * sizeof *out);
    for (uint32_t i = 0; i < z->item_count * 8; ++i) {
        const uint32_t item = b->s->zone_items[z->first_item + i / 8];
        const float corner[3] = {i & 1 ? x->max_x[item] : x->min_x[item], i & 2 ? x->max_y[item] : x->min_y[item], i & 4 ? x->max_z[item] : x->min_z[item]};
        double at[4];
        for (int row = 0; row < 4; ++row) {
            at[row] = clip[12 + row];
            for (int k = 0; k < 3; ++k) at[row] += clip[4 * k + row] * ((double)corner[k] + b->s->whole.origin[k] - c->eye[k]);
        }
        if (at[3] < c->near_m) return;
        for (int k = 0; k < 2; ++k) {
            least[k] = at[k] / at[3] < least[k] ? at[k] / at[3] : least[k];
            most[k] = at[k] / at[3] > most[k] ? at[k] / at[3] : most[k];
        }
    }
    for (int k = 0; k < 2; ++k) {
        out[k] = (float)(least[k] < -1 ? -1 : least[k] > 1 ? 1 : least[k]);
        out[2 + k] = (float)(most[k] < -1 ? -1 : most[k] > 1 ? 1 : most[k]);
    }
}

static void rooms_cut_to_where_they_are_show_the_same(void **state)
{
    bed *b = *state;
    uint32_t seed = 19, cut_zones = 0;
    bed_rooms(b, ROOMS, NEAR_CORNER);
    render_layout *l = bed_zone_layout(b, LIST_ORDER);
    for (int view = 0; view < 20; ++view) {
        const camera c = random_eye(NEAR_CORNER, &seed);
        frame_request q = request(&c, RENDER_ITEMS);
        uint8_t *whole = picture_of_zones(b, &q, l), cut[SIDE * SIDE * 4];
        q.scissor = SCISSOR_ZONES;
        assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
        for (uint32_t z = 0; z < b->s->zone_count; ++z) {
            float rectangle[4];
            if (b->s->zones[z].item_count == 0) continue;
            rectangle_of(b, z, &c, rectangle);
            cut_zones += rectangle[0] > -1 || rectangle[2] < 1;
            renderer_zone_rectangle(b->g, z, rectangle);
            renderer_draw(b->g, l, z, &(cull_run){0, b->s->zones[z].item_count}, 1);
        }
        renderer_end(b->g);
        assert_int_equal(renderer_read(b->g, cut, &b->r), RESULT_OK);
        assert_memory_equal(whole, cut, SIDE * SIDE * 4);
        drop_pixels(whole);
    }
    assert_true(cut_zones > 20);
    render_layout_close(l);
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest zones[] = {
        T(rooms_are_zones_of_many_origins),
        T(no_crack_shows_between_zones_near_or_far_from_the_world_s_origin),
        T(an_item_shows_the_same_from_any_zone_that_lists_it),
        T(a_thousand_zones_cost_one_draw_call),
        T(zones_mode_shows_one_colour_for_what_a_zone_lists_first),
        T(a_reordered_zone_draws_in_its_new_order_and_others_in_their_old),
        T(a_layout_that_shared_the_scene_s_indices_may_be_reordered),
        T(movers_stand_behind_all_zones_before_and_after_a_reorder),
        T(rectangles_that_bound_what_is_seen_change_no_pixel),
        T(rooms_cut_to_where_they_are_show_the_same),
        T(a_smaller_rectangle_cuts_opaque_and_translucent_and_ends_with_its_frame),
    };
    return RUN_WITH_GL(zones);
}
