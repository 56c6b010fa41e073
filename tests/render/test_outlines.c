// Outlines of pictures: what they spare changes no picture.
// SPDX-License-Identifier: MIT
#include "picture_fixture.h"

enum { OUTLINES = 4096, FIRST_SPARE = 1000 }; // as many have an outline at once; those that come later are shown whole

static void take_the_other_outlines(bed *b, void *what)
{
    cull_capture c = *(const cull_capture *)what;
    c.width_px = c.height_px = 1;
    for (uint32_t i = 0; i < OUTLINES; ++i) {
        c.slot = FIRST_SPARE + i;
        renderer_capture(b->g, b->l, 0, &c);
    }
    renderer_show(b->g, b->l, 0, &(cull_picture){.slot = c.slot});
}

typedef struct sides { uint32_t width_px, height_px; } sides;
static const sides SIZES[] = {{SIDE, SIDE}, {2 * SIDE, 2 * SIDE}, {1, 1}, {2, 300}, {300, 3}, {17, 15}, {33, 250}, {1000, 64}, {97, 101}, {15, 16}};
enum { SIZES_COUNT = sizeof SIZES / sizeof *SIZES, CASES = 3 * SIZES_COUNT };

static cull_capture capture_of(const bed *b, const camera *c, const cull_run *run, uint32_t i)
{
    cull_capture out = whole_picture(b, c, 10, run, 1);
    out.width_px = SIZES[i % SIZES_COUNT].width_px;
    out.height_px = SIZES[i % SIZES_COUNT].height_px;
    out.keep_depth = i % 2;
    return out;
}

static uint8_t *shown_from(bed *b, uint32_t slot, uint32_t way)
{
    camera c = camera_at(way == 2 ? 0.3 : 0, way == 2 ? -0.2 : 0, 0);
    c.forward[0] = way * 0.113;
    c.forward[1] = way * 0.071;
    if (way == 1) c.fovy_deg = 140; // many texels a pixel
    const frame_request q = request(&c);
    const cull_picture p = {.slot = slot};
    return frame_with(b, &q, NULL, &p, NULL);
}

// Those taken before the outlines ran out beside the same taken after. Another strip of triangles rounds places otherwise, so a pixel
// between two texels may fall to either.
static void a_picture_is_the_same_with_its_outline_and_without(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    random_scene(b, 41);
    cull_run runs[CASES];
    uint32_t lit = 0;
    for (uint32_t i = 0; i < CASES; ++i) runs[i] = (cull_run){i % 50, i / SIZES_COUNT == 0 ? 1 : i / SIZES_COUNT == 1 ? 4 : 10};
    for (uint32_t i = 0; i < 2 * CASES; ++i) {
        cull_capture capture = capture_of(b, &c, &runs[i % CASES], i % CASES);
        if (i == CASES) drop_pixels(frame_of(b, &q, take_the_other_outlines, &capture));
        capture.slot = i;
        const cull_picture p = {.slot = i};
        drop_pixels(frame_with(b, &q, &capture, &p, NULL));
    }
    for (uint32_t i = 0; i < CASES; ++i)
        for (uint32_t way = 0; way < 3; ++way) {
            uint8_t *outlined = shown_from(b, i, way), *whole = shown_from(b, CASES + i, way);
            assert_in_range(pixels_that_differ(outlined, whole), 0, 2);
            for (uint32_t k = 0; k < SIDE * SIDE; ++k) lit += whole[4 * k] != 0;
            drop_pixels(outlined);
            drop_pixels(whole);
        }
    assert_true(lit > CASES * SIDE); // they show something
}

// Two towers and nothing between and about them: what is not covered stays as it was.
static void empty_strips_show_nothing_and_their_neighbours_all(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const quad quads[] = {quad_at(-8, -6.03, -7.02, -5.51, 6.04), quad_at(-8, 4.07, -3.03, 4.52, 1.01)};
    const cull_run both = {0, 2};
    scene_with_slots(b, quads, 2);
    uint8_t *plain = bed_frame(b, &q, b->l, &both, 1);
    const cull_capture capture = whole_picture(b, &c, 8, &both, 1);
    const cull_picture p = {.slot = capture.slot};
    uint8_t *shown = frame_with(b, &q, &capture, &p, NULL);
    assert_int_equal(pixels_that_differ(plain, shown), 0);
    drop_pixels(plain);
    drop_pixels(shown);
}

// A slot that is emptied gives its outline back: there are always as many as there are.
static void outlines_of_emptied_slots_are_there_again(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const frame_request q = request(&c);
    const cull_run all = {0, QUADS};
    random_scene(b, 43);
    cull_capture capture = whole_picture(b, &c, 10, &all, 1);
    uint8_t *before = frame_with(b, &q, &capture, &(cull_picture){.slot = capture.slot}, NULL);
    for (int i = 0; i < 3; ++i) {
        drop_pixels(frame_of(b, &q, take_the_other_outlines, &capture));
        renderer_forget_pictures(b->g);
    }
    uint8_t *after = frame_with(b, &q, &capture, &(cull_picture){.slot = capture.slot}, NULL);
    assert_memory_equal(before, after, SIDE * SIDE * 4);
    drop_pixels(before);
    drop_pixels(after);
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest outlines[] = {
        T(a_picture_is_the_same_with_its_outline_and_without),
        T(empty_strips_show_nothing_and_their_neighbours_all),
        T(outlines_of_emptied_slots_are_there_again),
    };
    return RUN_WITH_GL(outlines);
}
