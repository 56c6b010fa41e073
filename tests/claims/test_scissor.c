// What a zone draws is cut to the rectangle that the flow gives for it: the picture is the same, and fewer pixels are touched.
// SPDX-License-Identifier: MIT
#include "stage.h"
#include "bench/generate.h"
#include "bench/images.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 480, HEIGHT = 270, BYTES = WIDTH * HEIGHT * 4, VIEWS_SHORT = 6, VIEWS_LONG = 100, LAYERS_MOST = 64 };

typedef struct pair { uint8_t whole[BYTES], cut[BYTES]; } pair; // the same view, without and with rectangles
typedef struct touched { uint64_t whole, cut; } touched;         // pixels drawn to, as often as they were

static uint8_t palette_colours[LAYERS_MOST][3];

// As host/render/shaders/heat.frag shows layers.
static void palette_make(void)
{
    static const double palette[7][3] = {{0, 0, 0}, {0.05, 0.10, 0.55}, {0, 0.65, 0.80}, {0.15, 0.75, 0.15}, {0.95, 0.90, 0.10}, {0.90, 0.15, 0.05}, {1, 1, 1}};
    for (int n = 0; n < LAYERS_MOST; n++) {
        const double at = n < 1 ? n : fmin(1 + log2(n), 6);
        const int step = at < 5 ? (int)at : 5;
        for (int k = 0; k < 3; k++) palette_colours[n][k] = (uint8_t)lrint(255 * (palette[step][k] + (at - step) * (palette[step + 1][k] - palette[step][k])));
    }
}

static uint32_t layers_of(const uint8_t *rgba)
{
    uint32_t best = 0;
    int least = 4 * 256;
    for (uint32_t n = 0; n < LAYERS_MOST; n++) {
        int off = 0;
        for (int k = 0; k < 3; k++) off += abs(rgba[k] - palette_colours[n][k]);
        if (off >= least) continue;
        least = off;
        best = n;
    }
    return best;
}

static void draw_both(strategy *s, report *r, uint32_t view, render_mode mode, pair *out)
{
    uint64_t missed;
    picture_request q = {.view = view, .mode = mode};
    assert_int_equal(picture_of(s, NULL, &q, r, out->whole, &missed), RESULT_OK);
    q.scissor = SCISSOR_ZONES;
    assert_int_equal(picture_of(s, NULL, &q, r, out->cut, &missed), RESULT_OK);
}

static void look(strategy *s, report *r, uint32_t view, touched *sum)
{
    static pair p;
    draw_both(s, r, view, RENDER_SHADED, &p);
    assert_memory_equal(p.whole, p.cut, BYTES);
    draw_both(s, r, view, RENDER_ITEMS, &p);
    assert_memory_equal(p.whole, p.cut, BYTES);
    draw_both(s, r, view, RENDER_OVERDRAW, &p);
    for (size_t i = 0; i < BYTES; i += 4) {
        const uint32_t whole = layers_of(p.whole + i), cut = layers_of(p.cut + i);
        assert_true(cut <= whole);
        assert_true(cut > 0 || whole == 0); // what shows is never cut
        sum->whole += whole;
        sum->cut += cut;
    }
}

static void check(const char *kind, uint64_t size, const char *chain)
{
    static stage scene;
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    renderer *g = NULL;
    report r = report_to_stderr();
    strategy s;
    if (renderer_open(&options, allocator_heap(), &r, &g) != RESULT_OK) {
        fprintf(stderr, "SKIPPED: no OpenGL\n");
        skip();
    }
    palette_make();
    stage_make(&scene, kind, size);
    assert_int_equal(renderer_upload(g, scene.scene, &r), RESULT_OK);
    const bench_strategy_request chains = {.name = chain, .chain = stage_chain(&scene, chain)};
    const bench_request q = {.scene = scene.scene, .path = &scene.walk, .strategies = &chains, .strategy_count = 1, .plugins = scene.plugins,
                             .services = &scene.services, .repeat = 1, .width_px = WIDTH, .height_px = HEIGHT};
    const uint32_t wanted = stage_tier() == TIER_LONG ? VIEWS_LONG : VIEWS_SHORT, step = scene.walk.count / wanted;
    touched sum = {0, 0};
    assert_int_equal(strategy_open(&q, &chains, g, &r, &s), RESULT_OK);
    for (uint32_t i = 0; i < wanted; i++) look(&s, &r, i * step, &sum);
    print_message("%s, %s: %u views, %llu pixels touched whole, %llu cut to zones: %.3f\n", kind, chain, wanted, (unsigned long long)sum.whole,
                  (unsigned long long)sum.cut, (double)sum.cut / (double)sum.whole);
    assert_true(sum.cut < sum.whole);
    strategy_close(&s);
    renderer_close(g);
    stage_free(&scene);
}

static void on_the_flagship_rectangles_change_no_pixel_and_spare_some(void **state)
{
    (void)state;
    check("flagship", GENERATE_SIZE_OF_KIND, "frustum+portal");
}

static void in_a_maze_rectangles_change_no_pixel_and_spare_some(void **state)
{
    (void)state;
    check("maze", 100, "frustum+portal");
}

// Zones drawn whole: what is cut is more.
static void of_rooms_drawn_whole_rectangles_change_no_pixel_and_spare_more(void **state)
{
    (void)state;
    check("maze", 100, "none+portal");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(on_the_flagship_rectangles_change_no_pixel_and_spare_some),
        cmocka_unit_test(in_a_maze_rectangles_change_no_pixel_and_spare_some),
        cmocka_unit_test(of_rooms_drawn_whole_rectangles_change_no_pixel_and_spare_more),
    };
    return cmocka_run_group_tests_name("claims scissor", tests, NULL, NULL);
}
