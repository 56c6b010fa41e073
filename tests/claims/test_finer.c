// CONSERVATIVE holds through portals: against the union of 16 sub-pixel shifts and a picture of 4x4 the size, no item that
// owns a sample is dropped on the flagship or in a maze, by the flood or by a crosser that narrows.
// SPDX-License-Identifier: MIT
#include "stage.h"
#include "bench/generate.h"
#include "bench/strategy.h"
#include "tests/common/test.h"

#include <stdio.h>

enum { WIDTH = 480, HEIGHT = 270, VIEWS_SHORT = 4, VIEWS_LONG = 60 };

typedef struct sight { stage *stage; renderer *g; report *r; const camera_path *path; uint64_t looked, misses, pixels; } sight;

static void look(sight *x, strategy *s, truth *t, uint32_t v, uint32_t number)
{
    static const truth_finer shifted = {16, 1}, larger = {1, 4};
    strategy_view view;
    assert_int_equal(strategy_run_view(s, &(strategy_request){.view = v, .mode = RENDER_SHADED, .marks = MARK_DRAWN}, x->r, &view), RESULT_OK);
    motion_show(&s->motion, v, x->g);
    assert_int_equal(truth_add_finer(t, x->g, &x->path->cameras[v], &shifted, x->r), RESULT_OK);
    assert_int_equal(truth_add_finer(t, x->g, &x->path->cameras[v], &larger, x->r), RESULT_OK);
    for (uint32_t i = 0; i < 2; i++) {
        const view_misses m = strategy_misses(s, t, 2 * number + i);
        x->misses += m.items;
        x->pixels += m.pixels;
        x->looked += ((const truth_view *)t->views.items)[2 * number + i].count;
    }
}

static void check_chain(sight *x, const char *chain)
{
    strategy s;
    truth t;
    const bench_strategy_request chains = {.name = chain, .chain = stage_chain(x->stage, chain)};
    const bench_request q = {.scene = x->stage->scene, .path = x->path, .strategies = &chains, .strategy_count = 1, .plugins = x->stage->plugins,
                             .services = &x->stage->services, .repeat = 1, .width_px = WIDTH, .height_px = HEIGHT};
    const truth_request request = {x->stage->scene, WIDTH, HEIGHT, WALLS_BOTH_SIDES};
    const uint32_t wanted = stage_tier() == TIER_LONG ? VIEWS_LONG : VIEWS_SHORT, step = x->path->count / wanted;
    assert_int_equal(strategy_open(&q, &chains, NULL, x->r, &s), RESULT_OK);
    assert_int_equal(truth_open(&request, allocator_heap(), x->r, &t), RESULT_OK);
    x->looked = x->misses = x->pixels = 0;
    for (uint32_t i = 0; i < wanted; i++) look(x, &s, &t, i * step, i);
    print_message("%s: %u views, %llu items own a sample, %llu missed\n", chain, wanted, (unsigned long long)x->looked, (unsigned long long)x->misses);
    assert_int_equal(x->misses, 0);
    assert_int_equal(x->pixels, 0);
    assert_true(x->looked > 0);
    truth_close(&t);
    strategy_close(&s);
}

static void check(const char *kind, uint64_t size)
{
    static stage s;
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    renderer *g = NULL;
    report r = report_to_stderr();
    if (renderer_open(&options, allocator_heap(), &r, &g) != RESULT_OK) {
        fprintf(stderr, "SKIPPED: no OpenGL\n");
        skip();
    }
    stage_make(&s, kind, size);
    assert_int_equal(renderer_upload(g, s.scene, &r), RESULT_OK);
    const camera_path *const paths[] = {&s.walk, &s.tour};
    for (int i = 0; i < 2; i++) {
        sight x = {.stage = &s, .g = g, .r = &r, .path = paths[i]};
        check_chain(&x, "frustum+flood");
        check_chain(&x, "frustum+portal");
    }
    renderer_close(g);
    stage_free(&s);
}

static void on_the_flagship_no_item_with_a_visible_point_is_dropped(void **state)
{
    (void)state;
    check("flagship", GENERATE_SIZE_OF_KIND);
}

static void in_a_maze_no_item_with_a_visible_point_is_dropped(void **state)
{
    (void)state;
    check("maze", 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(on_the_flagship_no_item_with_a_visible_point_is_dropped),
        cmocka_unit_test(in_a_maze_no_item_with_a_visible_point_is_dropped),
    };
    return cmocka_run_group_tests_name("claims finer", tests, NULL, NULL);
}
