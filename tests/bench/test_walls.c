// Walls judged by their fronts: which count, which only hide what is behind them, and that no seam beside one shows the hidden.
// SPDX-License-Identifier: MIT
#include "bench/truth.h"
#include "host/import/import.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>

enum { WIDTH = 1280, HEIGHT = 720, TOP_STEP = 1, HIDDEN = 3, ITEMS = 4 }; // items: as step.json has them

static scene *load_step(report *r)
{
    const import_options import = {.doors = DOORS_OPEN};
    scene *s = NULL;
    assert_int_equal(import_scene(STEP, &import, allocator_heap(), r, &s), RESULT_OK);
    assert_int_equal(s->item_count, ITEMS);
    return s;
}

static camera camera_at_height(double height)
{
    return (camera){.eye = {0.25, height, 0}, .forward = {0, 0, -1}, .up = {0, 1, 0}, .fovy_deg = 20, .aspect = (double)WIDTH / HEIGHT,
                    .near_m = 0.0625, .far_m = INFINITY};
}

typedef struct step_bits { uint32_t shown, edge_on; } step_bits;

static step_bits step_from(const scene *s, double height)
{
    step_bits bits;
    const camera c = camera_at_height(height);
    walls_in_front(s, &(walls_view){&c, WIDTH, HEIGHT}, &bits.shown, &bits.edge_on);
    return (step_bits){bits.shown >> TOP_STEP & 1, bits.edge_on};
}

static void a_wall_with_the_eye_in_its_plane_counts(void **state)
{
    (void)state;
    report r = report_to_stderr();
    scene *s = load_step(&r);
    assert_int_equal(step_from(s, 0.5).shown, 1);
    assert_int_equal(step_from(s, 1e-15).shown, 1);
    assert_int_equal(step_from(s, 0).shown, 1);
    assert_int_equal(step_from(s, 0).edge_on, 0);
    scene_free(s, allocator_heap());
}

// The guard's part of a pixel, at the step's near edge 3 m away.
static void a_back_thinner_than_rounding_hides_and_counts_not(void **state)
{
    (void)state;
    report r = report_to_stderr();
    scene *s = load_step(&r);
    const double thin = CULL_GUARD_PX * 3 * 2 * tan(10 * 3.14159265358979323846 / 180) / HEIGHT;
    const double heights[] = {-1e-15, -1e-9, -0.99 * thin};
    for (size_t i = 0; i < sizeof heights / sizeof *heights; ++i) {
        assert_int_equal(step_from(s, heights[i]).shown, 0);
        assert_int_equal(step_from(s, heights[i]).edge_on, 1u << TOP_STEP);
    }
    assert_int_equal(step_from(s, -1.01 * thin).edge_on, 0);
    assert_int_equal(step_from(s, -1).edge_on, 0);
    assert_int_equal(step_from(s, -1).shown, 0);
    scene_free(s, allocator_heap());
}

static double random_share(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) * (1.0 / (1 << 24));
}

// Where the step hides it all. Rolled and turned, so that seams cross many centres of pixels.
static camera random_camera(uint32_t *seed, double height)
{
    camera c = camera_at_height(height);
    c.eye[0] = 0.5 * random_share(seed) - 0.25;
    for (int k = 0; k < 2; ++k) c.forward[k] = 0.4 * random_share(seed) - 0.2;
    c.up[0] = 4 * random_share(seed) - 2;
    return c;
}

static void no_seam_beside_a_wall_seen_edge_on_shows_the_hidden(void **state)
{
    enum { VIEWS = 24 };
    static const double heights[] = {0, -1e-12, -1e-7, -1e-5};
    (void)state;
    report r = report_to_stderr();
    renderer *g = NULL;
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    if (renderer_open(&options, allocator_heap(), &r, &g) != RESULT_OK) {
        fprintf(stderr, "SKIPPED: no OpenGL\n");
        skip();
    }
    scene *s = load_step(&r);
    truth t;
    const truth_request request = {s, WIDTH, HEIGHT, WALLS_FRONT_ONLY};
    assert_int_equal(renderer_upload(g, s, &r), RESULT_OK);
    assert_int_equal(truth_open(&request, allocator_heap(), &r, &t), RESULT_OK);
    uint32_t seed = 1, others = 0;
    for (uint32_t i = 0; i < VIEWS; ++i) {
        const camera c = random_camera(&seed, heights[i % (sizeof heights / sizeof *heights)]);
        assert_int_equal(truth_add_view(&t, g, &c, &r), RESULT_OK);
    }
    const truth_item *items = t.items.items;
    for (size_t i = 0; i < t.items.count; ++i) {
        assert_int_not_equal(items[i].item, HIDDEN);
        ++others;
    }
    assert_true(others >= 2 * VIEWS); // both risers in each
    truth_close(&t);
    scene_free(s, allocator_heap());
    renderer_close(g);
}

int main(void)
{
    const struct CMUnitTest walls[] = {
        cmocka_unit_test(a_wall_with_the_eye_in_its_plane_counts),
        cmocka_unit_test(a_back_thinner_than_rounding_hides_and_counts_not),
        cmocka_unit_test(no_seam_beside_a_wall_seen_edge_on_shows_the_hidden),
    };
    return cmocka_run_group_tests(walls, NULL, NULL);
}
