// Pictures among geometry and each other: depth by order, re-projected depth, outlines, composed pictures, memory and counts.
// SPDX-License-Identifier: MIT
#include "picture_fixture.h"

#include "host/render/costs.h"

#include <math.h>
#include <string.h>

static const cull_run first_quad = {0, 1}, second_quad = {1, 1}, third_quad = {2, 1};

static cull_picture picture_of(const cull_capture *c)
{
    return (cull_picture){.runs = c->runs, .run_count = c->run_count, .slot = c->slot};
}

// ---- Depth by order ----

typedef struct shows {
    const cull_capture *captures;
    uint32_t count;
    const cull_run *before, *after; // geometry drawn before and after the pictures
} shows;

static void draw_shows(bed *b, void *what)
{
    const shows *s = what;
    for (uint32_t i = 0; i < s->count; ++i) renderer_capture(b->g, b->l, 0, &s->captures[i]);
    if (s->before) bed_draw(b, b->l, s->before, 1);
    for (uint32_t i = 0; i < s->count; ++i) {
        const cull_picture p = picture_of(&s->captures[i]);
        renderer_show(b->g, b->l, 0, &p);
    }
    if (s->after) bed_draw(b, b->l, s->after, 1);
}

// The first quad as a picture, the second as geometry, which stands in front however far it is.
static void assert_stands_in_front(bed *b, double far_m)
{
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const quad quads[] = {quad_at(-8, -20, -20, 20, 20), quad_at(-far_m, -2 * far_m, -2 * far_m, 0, 2 * far_m)};
    scene_with_slots(b, quads, 2);
    uint8_t *wall = bed_frame(b, &q, b->l, &second_quad, 1), *near = bed_frame(b, &q, b->l, &first_quad, 1);
    const cull_capture capture = whole_picture(b, &c, 8, &first_quad, 1);
    for (int order = 0; order < 2; ++order) {
        const shows s = {&capture, 1, order ? &second_quad : NULL, order ? NULL : &second_quad};
        uint8_t *shown = frame_of(b, &q, draw_shows, (void *)(uintptr_t)&s);
        for (uint32_t i = 0; i < SIDE * SIDE; ++i) assert_memory_equal(shown + 4 * i, (i % SIDE < SIDE / 2 ? wall : near) + 4 * i, 3);
        drop_pixels(shown);
    }
    drop_pixels(wall);
    drop_pixels(near);
}

static void a_picture_without_depth_stands_behind_geometry_at_any_distance(void **state)
{
    for (double far_m = 2; far_m < 5000; far_m *= 9) assert_stands_in_front(*state, far_m);
}

static void of_pictures_without_depth_the_first_shown_stands_in_front(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const quad quads[] = {quad_at(-20, -60, -60, 0, 60), quad_at(-8, -20, -20, 20, 20), quad_at(-2, -20, -20, 20, 0)};
    scene_with_slots(b, quads, 3);
    uint8_t *far = bed_frame(b, &q, b->l, &first_quad, 1), *near = bed_frame(b, &q, b->l, &second_quad, 1);
    cull_capture captures[3] = {whole_picture(b, &c, 20, &first_quad, 1), whole_picture(b, &c, 8, &second_quad, 1), whole_picture(b, &c, 2, &third_quad, 1)};
    for (uint32_t i = 0; i < 3; ++i) captures[i].slot = 100 + i;
    const shows s = {captures, 3, NULL, NULL};
    uint8_t *shown = frame_of(b, &q, draw_shows, (void *)(uintptr_t)&s);
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) assert_memory_equal(shown + 4 * i, (i % SIDE < SIDE / 2 ? far : near) + 4 * i, 3);
    drop_pixels(far);
    drop_pixels(near);
    drop_pixels(shown);
}

// Seen from another eye, a kept depth sorts geometry a 200th of its distance before and behind the surface; a 50th on a wall that is not
// square to the view, where a pixel shows what belongs beside it.
static void a_kept_depth_is_that_of_the_surface_from_any_eye(void **state)
{
    bed *b = *state;
    const camera taken = camera_at(0, 0, 0), seen = camera_at(1.5, 0.5, -1);
    const frame_request at_taken = request(&taken), at_seen = request(&seen);
    quad quads[3] = {quad_at(-16, -8, -8, 8, 8)};
    for (int slanted = 0; slanted < 2; ++slanted) {
        for (int k = 0; slanted && k < 4; ++k) quads[0].corners[k][2] += 0.25 * quads[0].corners[k][0];
        const double apart = slanted ? 0.02 : 0.005;
        for (int i = 1; i < 3; ++i) // towards and away from the eye
            for (int k = 0; k < 4; ++k)
                for (int axis = 0; axis < 3; ++axis)
                    quads[i].corners[k][axis] = seen.eye[axis] + (quads[0].corners[k][axis] - seen.eye[axis]) * (i == 1 ? 1 - apart : 1 + apart);
        quads[1].material = quads[2].material = "grey";
        scene_with_slots(b, quads, 3);
        cull_capture capture = whole_picture(b, &taken, 16, &first_quad, 1);
        capture.keep_depth = 1;
        capture.width_px = capture.height_px = 4 * SIDE;
        const cull_picture p = picture_of(&capture);
        uint8_t *rgba = frame_with(b, &at_taken, &capture, NULL, NULL);
        uint8_t *before = bed_frame(b, &at_seen, b->l, &second_quad, 1), *with_before = frame_with(b, &at_seen, NULL, &p, &second_quad);
        uint8_t *wall = bed_frame(b, &at_seen, b->l, &first_quad, 1), *with_behind = frame_with(b, &at_seen, NULL, &p, &third_quad);
        assert_in_range(pixels_that_differ(before, with_before), 0, 4 * SIDE); // the outline
        assert_in_range(pixels_that_differ(wall, with_behind), 0, 4 * SIDE);
        drop_pixels(rgba);
        drop_pixels(before);
        drop_pixels(with_before);
        drop_pixels(wall);
        drop_pixels(with_behind);
    }
}

// ---- What tests see ----

static uint32_t pixels_of_the_second_quad(bed *b)
{
    uint32_t stalled = 0;
    cull_answer answer;
    const cull_test test = {.box = {in_zone(b, -1, -1, -9.5), in_zone(b, 1, 1, -8.5)}, .tag = 5};
    renderer_test(b->g, b->l, 0, &test, 1, 1);
    assert_int_equal(bed_collect(b, COLLECT_ALL, 1, &answer, 1, &stalled), 1);
    return answer.pixels;
}

// Its outline and its depth may be off by the tolerance.
static void a_picture_with_depth_hides_no_test_and_geometry_does(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const quad quads[] = {quad_at(-5, -20, -20, 20, 20), quad_at(-9, -1, -1, 1, 1)};
    scene_with_slots(b, quads, 2);
    cull_capture capture = whole_picture(b, &c, 5, &first_quad, 1);
    capture.keep_depth = 1;
    const cull_picture p = picture_of(&capture);
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    renderer_capture(b->g, b->l, 0, &capture);
    renderer_show(b->g, b->l, 0, &p);
    assert_true(pixels_of_the_second_quad(b) > 0);
    bed_draw(b, b->l, &first_quad, 1);
    assert_int_equal(pixels_of_the_second_quad(b), 0);
    renderer_end(b->g);
}

static void show_and_capture_again(bed *b, void *what)
{
    const cull_capture *captures = what; // of the same slot
    const cull_picture p = picture_of(&captures[0]);
    renderer_capture(b->g, b->l, 0, &captures[0]);
    renderer_show(b->g, b->l, 0, &p);
    renderer_capture(b->g, b->l, 0, &captures[1]);
}

static void a_slot_captured_again_in_the_frame_that_showed_it_shows_what_it_held(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const quad quads[] = {quad_at(-8, -4, -4, 0, 4), quad_at(-8, 0, -4, 4, 4)};
    scene_with_slots(b, quads, 2);
    cull_capture captures[] = {whole_picture(b, &c, 8, &first_quad, 1), whole_picture(b, &c, 8, &second_quad, 1)};
    uint8_t *plain = bed_frame(b, &q, b->l, &first_quad, 1), *shown = frame_of(b, &q, show_and_capture_again, captures);
    assert_int_equal(pixels_that_differ(plain, shown), 0);
    drop_pixels(plain);
    drop_pixels(shown);
}

// ---- Outlines ----

static void set_options(bed *b, picture_filter filter, picture_format format, uint64_t bytes_most)
{
    renderer_picture_options(b->g, &(picture_options){filter, format, bytes_most});
}

static int is_lit(const uint8_t *rgba, int x, int y)
{
    const uint8_t *at = rgba + 4 * (y * SIDE + x);
    return at[0] + at[1] + at[2] != 0;
}

static void a_picture_is_exact_at_its_eye_in_every_format(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0.5, 0.25, 0);
    const frame_request q = request(&c);
    const cull_run all = {0, QUADS};
    random_scene(b, 13);
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1);
    const cull_capture capture = whole_picture(b, &c, 10, &all, 1);
    const cull_picture p = picture_of(&capture);
    for (int filter = 0; filter < 2; ++filter)
        for (int format = 0; format < 2; ++format) {
            set_options(b, (picture_filter)filter, (picture_format)format, 1u << 20);
            uint8_t *shown = frame_with(b, &q, &capture, &p, NULL);
            for (int i = 0; i < SIDE * SIDE; ++i) assert_int_equal(is_lit(plain, i % SIDE, i / SIDE), is_lit(shown, i % SIDE, i / SIDE));
            assert_in_range(pixels_that_differ(plain, shown), 0, SIDE * SIDE / 200);
            const render_picture_counts counts = render_layout_picture_counts(b->l);
            assert_int_equal(counts.bytes, SIDE * SIDE * (format == PICTURE_8_BITS ? 4 : 2));
            drop_pixels(shown);
        }
    drop_pixels(plain);
}

static uint32_t lit_pixels(const uint8_t *rgba, uint32_t *odd)
{
    const uint8_t *colour = rgba + 4 * (SIDE * SIDE / 2 + SIDE / 2); // of the middle, which is covered
    uint32_t lit = 0;
    *odd = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
        const uint8_t *at = rgba + 4 * i;
        if (at[0] + at[1] + at[2] == 0) continue;
        lit++;
        for (uint32_t k = 0; k < 3; ++k) { // filters may weigh in 8 bits, colour and coverage each: at least half of 255, so two steps
            const int d = at[k] - colour[k];
            if (d < -2 || d > 2) {
                *odd += 1;
                break;
            }
        }
    }
    return lit;
}

// Between two eyes the texels fall between the pixels.
static void filtering_takes_no_colour_from_outside_the_outline(void **state)
{
    bed *b = *state;
    const camera taken = camera_at(0, 0, 0), seen = camera_at(0.13, 0.07, 0.2);
    const frame_request at_taken = request(&taken), at_seen = request(&seen);
    const quad quads[] = {quad_at(-8, -4.03, -4.01, 4.07, 4.05)};
    uint32_t odd;
    scene_with_slots(b, quads, 1);
    const cull_capture capture = whole_picture(b, &taken, 8, &first_quad, 1);
    const cull_picture p = picture_of(&capture);
    uint8_t *rgba = frame_with(b, &at_taken, &capture, NULL, NULL), *shown = frame_with(b, &at_seen, NULL, &p, NULL);
    assert_true(lit_pixels(shown, &odd) > SIDE * SIDE / 5);
    assert_int_equal(odd, 0);
    drop_pixels(rgba);
    drop_pixels(shown);
}

static int is_lit_around(const uint8_t *rgba, int x, int y)
{
    int lit = x == 0 || y == 0 || x == SIDE - 1 || y == SIDE - 1; // outside there may be
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) lit |= x + dx >= 0 && x + dx < SIDE && y + dy >= 0 && y + dy < SIDE && is_lit(rgba, x + dx, y + dy);
    return lit;
}

// The eye turned: nothing moves on the parallelogram, but texels fall anywhere between pixels. With filtering a picture goes on for a quarter of a texel
// beyond halfway, so a gap can open only where the outline is a quarter of a texel and less inside a pixel's middle.
static void a_turned_eye_finds_few_gaps_along_outlines_and_nothing_a_pixel_away_from_them(void **state)
{
    bed *b = *state;
    const camera taken = camera_at(0, 0, 0);
    const frame_request at_taken = request(&taken);
    uint32_t gaps[2] = {0, 0}, lit[2] = {0, 0}; // the nearest texel, and between texels
    random_scene(b, 17);
    for (uint32_t turn = 1; turn < 24; ++turn) {
        const cull_run some = {turn, 5};
        camera c = taken;
        c.forward[0] = 0.011 * turn;
        c.forward[1] = 0.007 * turn;
        c.fovy_deg = 55;
        const frame_request q = request(&c);
        set_options(b, turn % 2 ? PICTURE_LINEAR : PICTURE_NEAREST, PICTURE_8_BITS, 1u << 30);
        cull_capture capture = whole_picture(b, &taken, 10, &some, 1);
        capture.width_px = capture.height_px = 2 * SIDE; // a texel is a pixel there, and less
        const cull_picture p = picture_of(&capture);
        uint8_t *rgba = frame_with(b, &at_taken, &capture, NULL, NULL);
        uint8_t *plain = bed_frame(b, &q, b->l, &some, 1), *shown = frame_with(b, &q, NULL, &p, NULL);
        for (int i = 0; i < SIDE * SIDE; ++i) {
            const int x = i % SIDE, y = i / SIDE;
            gaps[turn % 2] += is_lit(plain, x, y) && !is_lit(shown, x, y) ? 1u : 0u;
            lit[turn % 2] += is_lit(plain, x, y) != 0 ? 1u : 0u;
            if (is_lit(plain, x, y)) assert_true(is_lit_around(shown, x, y));
            if (is_lit(shown, x, y)) assert_true(is_lit_around(plain, x, y));
        }
        drop_pixels(rgba);
        drop_pixels(plain);
        drop_pixels(shown);
    }
    print_message("pixels open along outlines: %u of %u with the nearest texel, %u of %u between texels\n", (unsigned)gaps[0], (unsigned)lit[0], (unsigned)gaps[1], (unsigned)lit[1]);
    assert_true((uint64_t)gaps[1] * lit[0] < (uint64_t)gaps[0] * lit[1]);
    assert_true(100 * gaps[1] < lit[1]);
}

// ---- Pictures of pictures ----

static void a_parent_of_four_children_is_what_one_capture_would_be(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const cull_run all = {0, QUADS};
    random_scene(b, 21);
    static cull_capture captures[5];
    static const uint32_t parts[4] = {10, 11, 12, 13};
    for (uint32_t i = 0; i < 4; ++i) { // a quarter of the picture each, by planes through the eye; the parts overlap by half a degree
        captures[i] = whole_picture(b, &c, 10, &all, 1);
        captures[i].slot = parts[i];
        captures[i].clip_plane_count = 2;
        captures[i].clip_planes[0] = plane_in_zone(b, i & 1 ? 1 : -1, 0, -0.01, 0);
        captures[i].clip_planes[1] = plane_in_zone(b, 0, i & 2 ? 1 : -1, -0.01, 0);
        const double *o = b->s->whole.origin;
        captures[i].clip_planes[0].offset = (float)((i & 1 ? 1 : -1) * o[0] - 0.01 * o[2]);
        captures[i].clip_planes[1].offset = (float)((i & 2 ? 1 : -1) * o[1] - 0.01 * o[2]);
    }
    captures[4] = whole_picture(b, &c, 9, NULL, 0);
    captures[4].slots = parts;
    captures[4].slot_count = 4;
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1), *rgba = memory_alloc(allocator_heap(), (size_t)SIDE * SIDE, 4);
    for (uint32_t keep = 0; keep < 2; ++keep) {
        for (int i = 0; i < 5; ++i) captures[i].keep_depth = keep;
        assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
        for (int i = 0; i < 5; ++i) renderer_capture(b->g, b->l, 0, &captures[i]);
        renderer_show(b->g, b->l, 0, &(cull_picture){.slot = 7, .runs = &all, .run_count = 1});
        renderer_end(b->g);
        assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
        assert_in_range(pixels_that_differ(plain, rgba), 0, SIDE * SIDE / 100);
    }
    drop_pixels(plain);
    drop_pixels(rgba);
}

// ---- Memory and counts ----

static void memory_is_never_over_the_limit_and_the_oldest_goes_first(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const cull_run all = {0, QUADS};
    const uint64_t one = SIDE * SIDE * 4, most = 3 * one + one / 2;
    random_scene(b, 31);
    set_options(b, PICTURE_LINEAR, PICTURE_8_BITS, most);
    cull_capture capture = whole_picture(b, &c, 10, &all, 1);
    for (uint32_t i = 0; i < 6; ++i) { // slots 0 .. 5, a frame each; slot 0 is shown each time
        capture.slot = i;
        drop_pixels(frame_with(b, &q, &capture, &(cull_picture){.slot = 0, .runs = &all, .run_count = 1}, NULL));
        assert_true(render_layout_picture_counts(b->l).bytes <= most);
    }
    uint8_t slots[8];
    memset(slots, 1, sizeof slots);
    renderer_check_slots(b->g, b->l, 0, slots, 8);
    const uint8_t left[8] = {1, 0, 0, 0, 1, 1, 0, 0};
    assert_memory_equal(slots, left, sizeof slots);
    const render_picture_counts counts = render_layout_picture_counts(b->l);
    assert_int_equal(counts.bytes, 3 * one);
    assert_int_equal(counts.bytes_peak, 3 * one);
    assert_int_equal(counts.captures, 6);
    assert_int_equal(counts.pixels_captured, 6 * SIDE * SIDE);
    assert_int_equal(counts.shown, 6);
    assert_true(fabs(counts.pixels_shown - 6.0 * SIDE * SIDE) < 1);
    assert_int_equal(counts.emptied, 3);
    assert_int_equal(counts.refused, 0);
}

typedef struct many { const cull_run *runs; uint32_t count; cull_capture capture; } many;

static void capture_and_show_many(bed *b, void *what)
{
    many *m = what;
    for (m->capture.slot = 0; m->capture.slot < m->count; m->capture.slot++) {
        renderer_capture(b->g, b->l, 0, &m->capture);
        const cull_picture p = picture_of(&m->capture);
        renderer_show(b->g, b->l, 0, &p);
    }
}

static void a_frame_that_needs_more_than_the_limit_draws_the_items(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const cull_run all = {0, QUADS};
    random_scene(b, 33);
    set_options(b, PICTURE_LINEAR, PICTURE_8_BITS, 2 * SIDE * SIDE * 4);
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1);
    many m = {&all, 5, whole_picture(b, &c, 10, &all, 1)};
    uint8_t *shown = frame_of(b, &q, capture_and_show_many, &m);
    assert_int_equal(render_layout_picture_counts(b->l).refused, 3);
    assert_int_equal(render_layout_picture_counts(b->l).shown, 2);
    assert_memory_equal(plain, shown, SIDE * SIDE * 4); // geometry covers what the pictures are of
    set_options(b, PICTURE_LINEAR, PICTURE_8_BITS, 1);
    drop_pixels(shown);
    shown = frame_of(b, &q, capture_and_show_many, &m);
    assert_int_equal(render_layout_picture_counts(b->l).bytes, 0);
    assert_memory_equal(plain, shown, SIDE * SIDE * 4);
    drop_pixels(shown);
    drop_pixels(plain);
}

static void a_picture_of_another_mode_is_not_shown(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    frame_request q = request(&c);
    const cull_run all = {0, QUADS};
    random_scene(b, 35);
    const cull_capture capture = whole_picture(b, &c, 10, &all, 1);
    const cull_picture p = picture_of(&capture);
    drop_pixels(frame_with(b, &q, &capture, &p, NULL));
    q.mode = RENDER_DEPTH;
    uint8_t *plain = bed_frame(b, &q, b->l, &all, 1), *shown = frame_with(b, &q, NULL, &p, NULL), slots[8] = {0, 0, 0, 0, 0, 0, 0, 1};
    renderer_check_slots(b->g, b->l, 0, slots, 8);
    assert_int_equal(slots[7], 0);
    assert_memory_equal(plain, shown, SIDE * SIDE * 4);
    drop_pixels(plain);
    drop_pixels(shown);
}

// ---- Costs ----

static void costs_are_measured_once_and_leave_frames_as_they_were(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const cull_run all = {0, QUADS};
    cull_costs costs, again;
    random_scene(b, 41);
    uint8_t *before = bed_frame(b, &q, b->l, &all, 1);
    assert_int_equal(renderer_costs(b->g, &b->r, &costs), RESULT_OK);
    assert_int_equal(costs.is_measured, 1);
    assert_true(costs.polygon_ns > 0 && costs.pixel_ns > 0 && costs.picture_ns > 0 && costs.picture_pixel_ns > 0);
    assert_true(costs.picture_depth_pixel_ns > 0 && costs.capture_ns > 0 && costs.capture_pixel_ns >= 0);
    assert_int_equal(costs.picture_bytes, 256u << 20);
    assert_int_equal(costs.depth_pixel_bytes, 8);
    assert_int_equal(renderer_costs(b->g, &b->r, &again), RESULT_OK);
    assert_memory_equal(&costs, &again, sizeof costs);
    uint8_t *after = bed_frame(b, &q, b->l, &all, 1);
    assert_memory_equal(before, after, SIDE * SIDE * 4);
    assert_int_equal(render_layout_picture_counts(b->l).bytes, 0);
    set_options(b, PICTURE_NEAREST, PICTURE_5_BITS, 12345); // other pictures, other costs
    assert_int_equal(renderer_costs(b->g, &b->r, &costs), RESULT_OK);
    assert_int_equal(costs.picture_bytes, 12345);
    assert_int_equal(costs.pixel_bytes, 2);
    assert_true(memcmp(&costs.polygon_ns, &again.polygon_ns, 9 * sizeof(double)) != 0);
    drop_pixels(before);
    drop_pixels(after);
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest pictures[] = {
        T(a_picture_without_depth_stands_behind_geometry_at_any_distance),
        T(of_pictures_without_depth_the_first_shown_stands_in_front),
        T(a_kept_depth_is_that_of_the_surface_from_any_eye),
        T(a_picture_with_depth_hides_no_test_and_geometry_does),
        T(a_slot_captured_again_in_the_frame_that_showed_it_shows_what_it_held),
        T(a_picture_is_exact_at_its_eye_in_every_format),
        T(filtering_takes_no_colour_from_outside_the_outline),
        T(a_turned_eye_finds_few_gaps_along_outlines_and_nothing_a_pixel_away_from_them),
        T(a_parent_of_four_children_is_what_one_capture_would_be),
        T(memory_is_never_over_the_limit_and_the_oldest_goes_first),
        T(a_frame_that_needs_more_than_the_limit_draws_the_items),
        T(a_picture_of_another_mode_is_not_shown),
        T(costs_are_measured_once_and_leave_frames_as_they_were),
    };
    return RUN_WITH_GL(pictures);
}
