// Box tests and pictures of several zones and layouts: boxes stand relative to the zone's origin, and nothing goes to another.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <string.h>

enum { SIDE = 96, ROOMS = 3, ZONES_MOST = 64 };
static const double CORNER[3] = {105.5, -20, 33};

static void drop_pixels(uint8_t *rgba)
{
    memory_free(allocator_heap(), rgba, (size_t)SIDE * SIDE, 4);
}

static camera in_the_middle(void)
{
    camera c = camera_at(CORNER[0] + 1.5 * ROOM_SIDE_M, CORNER[1] + 1.5, CORNER[2] - 1.5 * ROOM_SIDE_M);
    c.near_m = 1.0 / 64;
    return c;
}

static void begin(bed *b, const camera *c)
{
    const frame_request q = {.camera = c, .width_px = SIDE, .height_px = SIDE, .mode = RENDER_ITEMS};
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
}

static uint32_t collect_from(bed *b, const render_layout *l, uint32_t zone, cull_answer *answers, uint32_t capacity)
{
    uint32_t stalled = 0;
    return renderer_collect(b->g, &(collect_request){l, zone, 7, COLLECT_ALL}, answers, capacity, &stalled);
}

static cull_vec3 in_zone(const bed *b, uint32_t zone, const double p[3])
{
    const double *o = b->s->zones[zone].origin;
    return (cull_vec3){(float)(p[0] - o[0]), (float)(p[1] - o[1]), (float)(p[2] - o[2])};
}

static cull_test test_in(const bed *b, uint32_t zone, const double low[3], const double high[3], uint32_t tag)
{
    return (cull_test){.box = {in_zone(b, zone, low), in_zone(b, zone, high)}, .tag = tag};
}

// A box 1 to 2 m before the eye, and one 40 m behind the rooms.
static void two_boxes(double low[2][3], double high[2][3])
{
    const camera c = in_the_middle();
    for (int k = 0; k < 3; ++k) {
        low[0][k] = c.eye[k] - 0.25 - (k == 2 ? 1.75 : 0);
        high[0][k] = c.eye[k] + 0.25 - (k == 2 ? 1 : 0);
        low[1][k] = low[0][k] - (k == 2 ? 60 : 0);
        high[1][k] = high[0][k] - (k == 2 ? 60 : 0);
    }
}

static void the_same_box_gets_the_same_pixels_in_every_zone_s_coordinates(void **state)
{
    bed *b = *state;
    const camera c = in_the_middle();
    double low[2][3], high[2][3];
    cull_answer answers[4];
    uint32_t pixels = 0;
    bed_rooms(b, ROOMS, CORNER);
    render_layout *l = bed_zone_layout(b, LIST_ORDER);
    two_boxes(low, high);
    begin(b, &c);
    bed_draw(b, b->l, &(cull_run){0, b->s->item_count}, 1);
    for (uint32_t z = 0; z < b->s->zone_count; ++z) {
        const cull_test tests[2] = {test_in(b, z, low[0], high[0], 2 * z), test_in(b, z, low[1], high[1], 2 * z + 1)};
        renderer_test(b->g, l, z, tests, 2, 5);
    }
    for (uint32_t z = b->s->zone_count; z-- > 0;) { // in another order than asked
        assert_int_equal(collect_from(b, l, z, answers, 4), 2);
        if (pixels == 0) pixels = answers[0].pixels;
        assert_in_range(pixels, 100, SIDE * SIDE);
        assert_int_equal(answers[0].pixels, pixels);
        assert_int_equal(answers[1].pixels, 0);
        assert_int_equal(answers[0].tag, 2 * z);
        assert_int_equal(answers[1].tag, 2 * z + 1);
        assert_int_equal(answers[1].age, 2);
    }
    renderer_end(b->g);
    assert_in_range(renderer_draw_calls(b->g), 2, 2); // all geometry, all boxes
    render_layout_close(l);
}

static void answers_never_go_to_another_zone_or_layout(void **state)
{
    bed *b = *state;
    enum { LAYOUTS = 2, ROUNDS = 200 };
    const camera c = in_the_middle();
    render_layout *layouts[LAYOUTS];
    uint32_t asked[LAYOUTS][ZONES_MOST] = {0}, answered[LAYOUTS][ZONES_MOST] = {0}, seed = 3;
    double low[2][3], high[2][3];
    bed_rooms(b, ROOMS, CORNER);
    two_boxes(low, high);
    for (int i = 0; i < LAYOUTS; ++i) layouts[i] = bed_zone_layout(b, LIST_ORDER);
    assert_in_range(b->s->zone_count, 9, ZONES_MOST);
    begin(b, &c);
    bed_draw(b, b->l, &(cull_run){0, b->s->item_count}, 1);
    for (uint32_t round = 0; round < ROUNDS; ++round) {
        const uint32_t i = random_next(&seed) % LAYOUTS, z = random_next(&seed) % b->s->zone_count, count = 1 + random_next(&seed) % 4;
        cull_test tests[4];
        cull_answer answers[3];
        for (uint32_t k = 0; k < count; ++k) { // tag: whose, and the how many-th
            const uint32_t number = asked[i][z]++;
            tests[k] = test_in(b, z, low[number % 2], high[number % 2], i << 24 | z << 16 | number);
        }
        renderer_test(b->g, layouts[i], z, tests, count, round);
        const uint32_t from = random_next(&seed) % LAYOUTS, zone = random_next(&seed) % b->s->zone_count;
        const uint32_t got = collect_from(b, layouts[from], zone, answers, 3);
        for (uint32_t k = 0; k < got; ++k) {
            const uint32_t number = answered[from][zone]++;
            assert_int_equal(answers[k].tag, from << 24 | zone << 16 | number);
            assert_int_equal(answers[k].pixels > 0, number % 2 == 0);
        }
        assert_int_equal(got, asked[from][zone] - (answered[from][zone] - got) < 3 ? asked[from][zone] - (answered[from][zone] - got) : 3);
    }
    renderer_end(b->g);
    for (int i = 0; i < LAYOUTS; ++i) render_layout_close(layouts[i]);
}

static void a_zone_s_latency_counts_its_own_collects(void **state)
{
    bed *b = *state;
    const camera c = in_the_middle();
    double low[2][3], high[2][3];
    cull_answer answer;
    uint32_t stalled = 0;
    bed_rooms(b, ROOMS, CORNER);
    render_layout *l = bed_zone_layout(b, LIST_ORDER);
    two_boxes(low, high);
    renderer_query_latency(b->g, 1);
    begin(b, &c);
    const cull_test tests[2] = {test_in(b, 0, low[0], high[0], 10), test_in(b, 1, low[0], high[0], 11)};
    renderer_test(b->g, l, 0, &tests[0], 1, 7);
    renderer_test(b->g, l, 1, &tests[1], 1, 7);
    const collect_request of_first = {l, 0, 7, COLLECT_READY}, of_second = {l, 1, 7, COLLECT_READY};
    assert_int_equal(renderer_collect(b->g, &of_first, &answer, 1, &stalled), 0);
    assert_int_equal(renderer_collect(b->g, &of_first, &answer, 1, &stalled), 1);
    assert_int_equal(answer.tag, 10);
    assert_int_equal(renderer_collect(b->g, &of_second, &answer, 1, &stalled), 0);
    assert_int_equal(renderer_collect(b->g, &of_second, &answer, 1, &stalled), 1);
    assert_int_equal(answer.tag, 11);
    assert_int_equal(stalled, 0);
    renderer_end(b->g);
    render_layout_close(l);
}

static void a_reorder_forgets_the_tests_of_its_zone_only(void **state)
{
    bed *b = *state;
    const camera c = in_the_middle();
    double low[2][3], high[2][3];
    cull_answer answers[4];
    static uint32_t items[256];
    bed_rooms(b, ROOMS, CORNER);
    render_layout *l = bed_zone_layout(b, LIST_ORDER);
    two_boxes(low, high);
    const uint32_t count = b->s->zones[1].item_count;
    memcpy(items, b->s->zone_items + b->s->zones[1].first_item, count * sizeof *items);
    begin(b, &c);
    for (uint32_t z = 0; z < 3; ++z) {
        const cull_test t = test_in(b, z, low[0], high[0], z);
        renderer_test(b->g, l, z, &t, 1, 7);
    }
    renderer_end(b->g);
    assert_int_equal(render_layout_reorder(l, 1, items, &b->r), RESULT_OK);
    for (uint32_t z = 0; z < 3; ++z) assert_int_equal(collect_from(b, l, z, answers, 4), z == 1 ? 0 : 1);
    render_layout_close(l);
}

// ---- Pictures ----

static cull_capture capture_of(const bed *b, uint32_t zone, const camera *c, const cull_run *run)
{
    const double corner[3] = {c->eye[0] - 1, c->eye[1] - 1, c->eye[2] - 1};
    return (cull_capture){.runs = run, .run_count = 1, .corner = in_zone(b, zone, corner), .right = {2, 0, 0}, .up = {0, 2, 0}, .width_px = SIDE, .height_px = SIDE, .keep_depth = 1};
}

static uint32_t pixels_that_differ(const uint8_t *a, const uint8_t *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) count += memcmp(a + (size_t)4 * i, b + (size_t)4 * i, 3) != 0;
    return count;
}

static uint8_t *show_zone(bed *b, render_layout *l, uint32_t zone, const camera *c)
{
    const cull_run run = {0, b->s->zones[zone].item_count};
    uint8_t *rgba = memory_alloc(allocator_heap(), (size_t)SIDE * SIDE, 4);
    begin(b, c);
    renderer_show(b->g, l, zone, &(cull_picture){.slot = 0, .runs = &run, .run_count = 1});
    renderer_end(b->g);
    assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
    return rgba;
}

static uint8_t *draw_zone(bed *b, const render_layout *l, uint32_t zone, const camera *c)
{
    uint8_t *rgba = memory_alloc(allocator_heap(), (size_t)SIDE * SIDE, 4);
    begin(b, c);
    renderer_draw(b->g, l, zone, &(cull_run){0, b->s->zones[zone].item_count}, 1);
    renderer_end(b->g);
    assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
    return rgba;
}

static void slots_of_one_number_in_two_zones_and_layouts_are_different_pictures(void **state)
{
    bed *b = *state;
    const camera c = in_the_middle();
    static uint32_t slots[ZONES_MOST];
    bed_rooms(b, ROOMS, CORNER);
    for (uint32_t z = 0; z < b->s->zone_count; ++z) slots[z] = 1;
    render_layout *l = bed_zone_layout(b, LIST_ORDER), *other = bed_zone_layout(b, LIST_ORDER);
    assert_int_equal(render_layout_slots(l, slots, &b->r), RESULT_OK);
    assert_int_equal(render_layout_slots(other, slots, &b->r), RESULT_OK);
    begin(b, &c);
    for (uint32_t z = 0; z < b->s->zone_count; ++z) {
        const cull_run run = {0, b->s->zones[z].item_count};
        const cull_capture capture = capture_of(b, z, &c, &run);
        if (run.count) renderer_capture(b->g, l, z, &capture);
    }
    renderer_end(b->g);
    for (uint32_t z = 0; z < b->s->zone_count; ++z) {
        if (b->s->zones[z].item_count == 0) continue;
        uint8_t *plain = draw_zone(b, l, z, &c), *shown = show_zone(b, l, z, &c), *empty = show_zone(b, other, z, &c);
        assert_in_range(pixels_that_differ(plain, shown), 0, SIDE * SIDE / 50); // edges, resampled
        assert_memory_equal(plain, empty, SIDE * SIDE * 4);                     // nothing was taken there: geometry
        drop_pixels(plain);
        drop_pixels(shown);
        drop_pixels(empty);
    }
    render_layout_close(other);
    render_layout_close(l);
}

static void a_reorder_forgets_the_pictures_of_its_zone_only(void **state)
{
    bed *b = *state;
    const camera c = in_the_middle();
    static uint32_t slots[ZONES_MOST], items[256];
    bed_rooms(b, ROOMS, CORNER);
    for (uint32_t z = 0; z < b->s->zone_count; ++z) slots[z] = 1;
    render_layout *l = bed_zone_layout(b, LIST_ORDER);
    assert_int_equal(render_layout_slots(l, slots, &b->r), RESULT_OK);
    const cull_run one = {0, 1}; // taken of one item, so that it is told from the geometry
    begin(b, &c);
    for (uint32_t z = 0; z < 3; ++z) {
        const cull_capture capture = capture_of(b, z, &c, &one);
        renderer_capture(b->g, l, z, &capture);
    }
    renderer_end(b->g);
    memcpy(items, b->s->zone_items + b->s->zones[1].first_item, b->s->zones[1].item_count * sizeof *items);
    assert_int_equal(render_layout_reorder(l, 1, items, &b->r), RESULT_OK);
    for (uint32_t z = 0; z < 3; ++z) {
        uint8_t *plain = draw_zone(b, l, z, &c), *shown = show_zone(b, l, z, &c);
        assert_int_equal(pixels_that_differ(plain, shown) > SIDE, z != 1);
        drop_pixels(plain);
        drop_pixels(shown);
    }
    render_layout_close(l);
}

static void clip_planes_are_the_zone_s(void **state)
{
    bed *b = *state;
    const camera c = in_the_middle();
    static uint32_t slots[ZONES_MOST];
    bed_rooms(b, ROOMS, CORNER);
    for (uint32_t z = 0; z < b->s->zone_count; ++z) slots[z] = 1;
    render_layout *l = bed_zone_layout(b, LIST_ORDER);
    assert_int_equal(render_layout_slots(l, slots, &b->r), RESULT_OK);
    for (uint32_t z = 0; z < b->s->zone_count; z += 4) {
        const cull_run run = {0, b->s->zones[z].item_count};
        cull_capture capture = capture_of(b, z, &c, &run);
        capture.clip_plane_count = 1; // left of the eye
        capture.clip_planes[0] = (cull_plane){{-1, 0, 0}, in_zone(b, z, c.eye).x};
        begin(b, &c);
        renderer_capture(b->g, l, z, &capture);
        renderer_end(b->g);
        uint8_t *plain = draw_zone(b, l, z, &c), *shown = show_zone(b, l, z, &c);
        for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
            if (i % SIDE > SIDE / 2 + 1) assert_int_equal(shown[4 * i] + shown[4 * i + 1] + shown[4 * i + 2], 0);
            if (i % SIDE < SIDE / 2 - 1) continue;
            memset(plain + (size_t)4 * i, 0, 3);
            memset(shown + (size_t)4 * i, 0, 3);
        }
        assert_in_range(pixels_that_differ(plain, shown), 0, SIDE * SIDE / 50); // the left half
        drop_pixels(plain);
        drop_pixels(shown);
    }
    render_layout_close(l);
}

static void too_many_slots_are_refused(void **state)
{
    bed *b = *state;
    static uint32_t slots[ZONES_MOST];
    bed_rooms(b, ROOMS, CORNER);
    render_layout *l = bed_zone_layout(b, LIST_ORDER);
    slots[0] = 65536;
    assert_int_equal(render_layout_slots(l, slots, &b->r), RESULT_OK);
    slots[1] = 1;
    b->r.line = NULL;
    assert_int_equal(render_layout_slots(l, slots, &b->r), RESULT_BAD_INPUT);
    assert_int_equal(b->r.errors, 1);
    render_layout_close(l);
}

// Before (odd) or behind (even) the quad of zone z, seen through its middle.
static cull_test test_of_quad(const bed *b, uint32_t z)
{
    const double scale = z % 2 ? 0.5 : 1.025, depth = -10 * scale;
    const double low[3] = {scale * ((z % 40) - 19.6), scale * ((double)(z / 40) - 11.6), depth - 0.05}, high[3] = {low[0] + 0.1, low[1] + 0.1, depth + 0.05};
    return test_in(b, 0, low, high, z);
}

static void a_thousand_zones_with_a_test_each_are_answered_in_a_few_draws(void **state)
{
    bed *b = *state;
    enum { MANY = 1000, FRAMES = 3 };
    static quad quads[MANY];
    static uint32_t items[MANY];
    static render_layout_zone zones[MANY];
    const camera c = camera_at(0, 0, 0);
    render_layout *l = NULL;
    for (uint32_t i = 0; i < MANY; ++i) {
        quads[i] = quad_at(-10, (i % 40) - 20.0, (double)(i / 40) - 12, (i % 40) - 19.1, (double)(i / 40) - 11.1);
        items[i] = i;
        zones[i] = (render_layout_zone){&items[i], 1};
    }
    bed_scene(b, quads, MANY, NULL);
    assert_int_equal(render_layout_open(b->g, zones, MANY, &b->r, &l), RESULT_OK);
    for (uint32_t frame = 0; frame < FRAMES; ++frame) {
        begin(b, &c);
        for (uint32_t z = 0; z < MANY; ++z) renderer_draw(b->g, l, z, &(cull_run){0, 1}, 1);
        for (uint32_t z = 0; z < MANY; ++z) {
            const cull_test t = test_of_quad(b, z);
            renderer_test(b->g, l, z, &t, 1, frame);
        }
        for (uint32_t z = 0; z < MANY; ++z) {
            cull_answer answer;
            assert_int_equal(collect_from(b, l, z, &answer, 1), 1);
            assert_int_equal(answer.tag, z);
            if (z % 40 > 11 && z % 40 < 28 && z / 40 > 3 && z / 40 < 20) assert_int_equal(answer.pixels > 0, z % 2); // in the picture
        }
        renderer_end(b->g);
        assert_int_equal(renderer_draw_calls(b->g), 2);
    }
    render_layout_close(l);
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest zone_answers[] = {
        T(the_same_box_gets_the_same_pixels_in_every_zone_s_coordinates),
        T(answers_never_go_to_another_zone_or_layout),
        T(a_zone_s_latency_counts_its_own_collects),
        T(a_reorder_forgets_the_tests_of_its_zone_only),
        T(a_reorder_forgets_the_pictures_of_its_zone_only),
        T(slots_of_one_number_in_two_zones_and_layouts_are_different_pictures),
        T(clip_planes_are_the_zone_s),
        T(too_many_slots_are_refused),
        T(a_thousand_zones_with_a_test_each_are_answered_in_a_few_draws),
    };
    return RUN_WITH_GL(zone_answers);
}
