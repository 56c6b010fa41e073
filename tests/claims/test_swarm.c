// Ten thousand movers in a city, all of them moving every frame, under octree with and without occlusion: no pixel missed, nothing
// allocated from frame to frame, nothing left behind.
// SPDX-License-Identifier: MIT
#include "stage.h"
#include "bench/generate.h"
#include "bench/strategy.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>

enum { BOXES = 2000, MOVERS = 10000, WIDTH = 320, HEIGHT = 180, FRAMES_SHORT = 25, FRAMES_LONG = 1000, FIRST_FRAMES = 2 };

typedef struct swarm {
    stage stage;
    camera_path path;
    renderer *g;
    report report;
} swarm;

// Boxes from a person's size to a lorry's, each to and fro on a way of its own, up to 10 m/s.
static void scene_write(const char *file, const char *city)
{
    uint64_t r = 3;
    FILE *f = fopen(file, "w");
    assert_non_null(f);
    fprintf(f, "{\"portcullis\": 1, \"include\": [{\"file\": \"%s\"}], \"movers\": [\n", city);
    for (int i = 0; i < MOVERS; i++) {
        const double x = random_between(&r, -400, 400), z = random_between(&r, -400, 400), size = random_between(&r, 0.4, 3);
        fprintf(f, "%s{\"name\": \"m%d\", \"box\": {\"min\": [%.3f, 0.1, %.3f], \"max\": [%.3f, %.3f, %.3f]}, \"loop\": true, \"path\": [{\"time\": 0}, ", i ? "," : "", i, x, z,
                x + size, 0.1 + size, z + size / 2);
        fprintf(f, "{\"time\": 3, \"at\": [%.3f, %.3f, %.3f]}, {\"time\": 6, \"at\": [0, 0, 0]}]}\n", random_between(&r, -30, 30), random_between(&r, 0, 4),
                random_between(&r, -30, 30));
    }
    fprintf(f, "]}\n");
    assert_int_equal(fclose(f), 0);
}

static int swarm_open(swarm *w)
{
    scratch_folder folder;
    char city[512], file[512], views[32];
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    w->report = report_to_stderr();
    if (renderer_open(&options, allocator_heap(), &w->report, &w->g) != RESULT_OK) return 0;
    scratch_folder_make(&folder);
    scratch_folder_name(&folder, "city.boxes", city, sizeof city);
    scratch_folder_name(&folder, "swarm.json", file, sizeof file);
    assert_int_equal(generate_scene("city", BOXES, GENERATE_SEED_OF_KIND, city, allocator_heap(), &w->report), RESULT_OK);
    scene_write(file, "city.boxes");
    stage_load(&w->stage, file);
    scratch_folder_remove(&folder);
    snprintf(views, sizeof views, "auto:walk:%d", stage_tier() == TIER_LONG ? FRAMES_LONG : FRAMES_SHORT);
    assert_int_equal(camera_path_load(views, w->stage.scene, 16.0 / 9, allocator_heap(), &w->report, &w->path), RESULT_OK);
    assert_int_equal(renderer_upload(w->g, w->stage.scene, &w->report), RESULT_OK);
    return 1;
}

static void swarm_close(swarm *w)
{
    renderer_close(w->g);
    camera_path_free(&w->path, allocator_heap());
    assert_true(failing_allocator_is_clean(&w->stage.counted));
    stage_free(&w->stage);
}

static void check_chain(swarm *w, const char *chain)
{
    strategy s;
    truth t;
    const bench_strategy_request chains = {.name = chain, .chain = stage_chain(&w->stage, chain)};
    const bench_request q = {.scene = w->stage.scene, .path = &w->path, .strategies = &chains, .strategy_count = 1, .plugins = w->stage.plugins,
                             .services = &w->stage.services, .repeat = 1, .width_px = WIDTH, .height_px = HEIGHT};
    const truth_request request = {w->stage.scene, WIDTH, HEIGHT, WALLS_BOTH_SIDES};
    uint64_t calls = 0, bytes = 0, drawn = 0, missed = 0;
    assert_int_equal(strategy_open(&q, &chains, NULL, &w->report, &s), RESULT_OK);
    renderer_reserve(w->g, strategy_tests(&s), &w->report);
    assert_int_equal(strategy_attach(&s, w->g, &w->report), RESULT_OK);
    assert_int_equal(truth_open(&request, allocator_heap(), &w->report, &t), RESULT_OK);
    for (uint32_t v = 0; v < w->path.count; v++) {
        strategy_view view;
        motion_show(&s.motion, v, w->g);
        assert_int_equal(truth_add_view(&t, w->g, &w->path.cameras[v], &w->report), RESULT_OK);
        assert_int_equal(strategy_run_view(&s, &(strategy_request){.view = v, .mode = RENDER_SHADED, .marks = MARK_DRAWN}, &w->report, &view), RESULT_OK);
        assert_int_equal(view.faults, 0);
        const view_misses m = strategy_misses(&s, &t, v);
        missed += m.pixels + m.items;
        drawn += view.set.mover_count;
        if (v < FIRST_FRAMES) calls = w->stage.counted.calls, bytes = w->stage.counted.live_bytes;
    }
    print_message("%s: %u frames, %.0f of %d movers drawn a frame, %llu pixels and items missed\n", chain, w->path.count, (double)drawn / w->path.count,
                  MOVERS, (unsigned long long)missed);
    assert_int_equal(missed, 0);
    assert_true(drawn > 0);
    assert_int_equal(w->stage.counted.calls, calls);
    assert_int_equal(w->stage.counted.live_bytes, bytes);
    truth_close(&t);
    strategy_close(&s);
}

static void ten_thousand_movers_in_a_city_lose_no_pixel_and_grow_nothing(void **state)
{
    (void)state;
    static swarm w;
    if (!swarm_open(&w)) {
        fprintf(stderr, "SKIPPED: no OpenGL\n");
        skip();
    }
    check_chain(&w, "octree");
    check_chain(&w, "octree+occlusion");
    check_chain(&w, "octree+occlusion[method=hiz]");
    swarm_close(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ten_thousand_movers_in_a_city_lose_no_pixel_and_grow_nothing),
    };
    return cmocka_run_group_tests_name("claims swarm", tests, NULL, NULL);
}
