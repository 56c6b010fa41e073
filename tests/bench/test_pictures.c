// Pictures beside full geometry, from within: nothing is left behind when memory runs out, whatever is asked of a strategy that
// shows nothing is told, and which views warm up.
// SPDX-License-Identifier: MIT
#include "bench/pictures.h"
#include "bench/similarity.h"
#include "host/import/import.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/report_lines.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 96, HEIGHT = 54 };

typedef struct fixture {
    report report;
    host_services services;
    loader *plugins;
    arena texts;
    scene *scene;
    camera_path path;
    chain_spec spec;
    bench_request bench;
    bench_strategy_request chains;
    renderer *g;
    strategy strategy;
    motion motion;
} fixture;

static int fixture_setup(void **state)
{
    const allocator *memory = allocator_heap();
    const loader_options options = {0};
    const renderer_options of_gl = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    const import_options import = {.doors = DOORS_OPEN};
    static fixture f;
    f = (fixture){.report = report_to_stderr(), .texts = arena_make(memory)};
    *state = &f;
    host_services_fill(&f.services, memory, &f.report);
    assert_int_equal(loader_open(&options, memory, &f.report, &f.plugins), RESULT_OK);
    assert_int_equal(import_scene(TWO_ROOMS, &import, memory, &f.report, &f.scene), RESULT_OK);
    assert_int_equal(camera_path_load("path:walk", f.scene, 16.0 / 9, memory, &f.report, &f.path), RESULT_OK);
    f.path.count = 6;
    assert_int_equal(chain_parse("brute", &f.texts, &f.report, &f.spec), RESULT_OK);
    f.bench = (bench_request){.scene = f.scene, .path = &f.path, .strategies = &f.chains, .plugins = f.plugins, .services = &f.services,
                              .strategy_count = 1, .repeat = 1, .width_px = WIDTH, .height_px = HEIGHT, .pictures = BENCH_PICTURES_ALL};
    f.chains = (bench_strategy_request){.name = "brute", .chain = &f.spec};
    if (renderer_open(&of_gl, memory, &f.report, &f.g) != RESULT_OK) return 0; // each test skips
    assert_int_equal(renderer_upload(f.g, f.scene, &f.report), RESULT_OK);
    assert_int_equal(strategy_open(&f.bench, &f.chains, f.g, &f.report, &f.strategy), RESULT_OK);
    assert_int_equal(motion_open(f.scene, NULL, memory, &f.motion), RESULT_OK);
    return 0;
}

static int fixture_teardown(void **state)
{
    fixture *f = *state;
    motion_close(&f->motion);
    strategy_close(&f->strategy);
    renderer_close(f->g);
    f->path.count = 60; // as it was loaded
    camera_path_free(&f->path, allocator_heap());
    scene_free(f->scene, allocator_heap());
    loader_close(f->plugins);
    arena_free(&f->texts);
    return 0;
}

static fixture *with_gl(void **state)
{
    fixture *f = *state;
    if (f->g) return f;
    fprintf(stderr, "SKIPPED: no OpenGL\n");
    skip();
    return NULL;
}

static result look(fixture *f, const bench_request *bench, report *r, bench_row *row)
{
    progress bar = {.total = 1};
    records kept;
    *row = (bench_row){.name = "brute"};
    if (records_open(bench, 0, bench->path->count, &kept) != RESULT_OK) return RESULT_NO_MEMORY;
    result done = pictures_run(&(pictures_request){bench, &f->strategy, row, &kept, &f->motion, f->g}, &bar, r);
    if (done == RESULT_OK) done = records_fill_pictures(&kept, 0, bench->services->memory, row);
    records_close(&kept);
    return done;
}

static void each_allocation_may_fail(void **state)
{
    fixture *f = with_gl(state);
    result done = RESULT_NO_MEMORY;
    for (uint64_t k = 1; done != RESULT_OK; ++k) {
        failing_allocator memory;
        report_lines lines;
        bench_row row;
        host_services services = f->services;
        bench_request bench = f->bench;
        failing_allocator_init(&memory, k);
        report_lines_init(&lines);
        services.memory = &memory.memory;
        bench.services = &services;
        done = look(f, &bench, &lines.report, &row);
        assert_true(done == RESULT_OK || done == RESULT_NO_MEMORY);
        assert_true(failing_allocator_is_clean(&memory));
        assert_int_equal(done == RESULT_OK, memory.failures == 0);
        assert_int_equal(row.pictures_measured, done == RESULT_OK ? f->path.count : 0);
    }
}

static void all_that_is_drawn_by_everybody_differs_in_nothing(void **state)
{
    fixture *f = with_gl(state);
    bench_row row;
    assert_int_equal(look(f, &f->bench, &f->report, &row), RESULT_OK);
    assert_true(row.flip == 0 && row.flip_p99 == 0 && row.ssim == 1 && row.psnr == PSNR_MOST_DB);
    assert_int_equal(row.crack_pixels, 0);
    assert_int_equal(row.faults, 0);
    assert_true(row.popping == 0 && row.popping_p99 == 0);
    assert_int_equal(row.popping_views, f->path.count - 1); // the first follows none
}

static void walls_judged_by_their_fronts_are_no_cracks_from_behind(void **state)
{
    fixture *f = with_gl(state);
    bench_row row;
    f->strategy.walls = WALLS_FRONT_ONLY;
    assert_int_equal(look(f, &f->bench, &f->report, &row), RESULT_OK);
    f->strategy.walls = WALLS_BOTH_SIDES;
    assert_int_equal(row.crack_pixels, 0);
    assert_true(row.flip == 0);
}

static void a_strategy_that_is_not_wanted_is_not_looked_at(void **state)
{
    fixture *f = with_gl(state);
    bench_request bench = f->bench;
    bench_row row;
    bench.pictures = BENCH_PICTURES_SHOWN;
    assert_int_equal(pictures_wanted(&bench, &f->strategy), 0);
    f->strategy.has_pictures = 1;
    assert_int_equal(pictures_wanted(&bench, &f->strategy), 1);
    bench.truth = BENCH_NO_TRUTH;
    assert_int_equal(pictures_wanted(&bench, &f->strategy), 0);
    bench.pictures = BENCH_PICTURES_NONE;
    assert_int_equal(look(f, &bench, &f->report, &row), RESULT_OK);
    f->strategy.has_pictures = 0;
    assert_int_equal(row.pictures_measured, 0);
}

static void cullers_are_told_what_a_frame_may_take(void **state)
{
    fixture *f = with_gl(state);
    const cull_costs before = f->services.costs;
    bench_request bench = f->bench;
    strategy s;
    bench.costs = BENCH_COSTS_FIXED;
    for (int asked = 0; asked < 2; ++asked) {
        bench.frame_ms = asked ? 12.5 : 0;
        assert_int_equal(strategy_open(&bench, &f->chains, NULL, &f->report, &s), RESULT_OK);
        s.has_pictures = 1;
        assert_int_equal(strategy_attach(&s, f->g, &f->report), RESULT_OK);
        assert_true(f->services.costs.frame_ns == bench.frame_ms * 1e6);
        assert_true(f->services.costs.polygon_ns == before.polygon_ns);
        strategy_close(&s);
    }
    host_costs_set(&f->services, &before);
}

static uint32_t warmup(const char *name, uint32_t count)
{
    camera_path path = {.count = count};
    snprintf(path.name, sizeof path.name, "%s", name);
    return bench_warmup_views(&path);
}

static void long_walks_warm_up_and_nothing_else(void **state)
{
    (void)state;
    assert_int_equal(warmup("auto:walk:1000", 1000), 60);
    assert_int_equal(warmup("auto:walk:200", 200), 60);
    assert_int_equal(warmup("auto:walk:199", 199), 0);
    assert_int_equal(warmup("auto:drive:200", 200), 60);
    assert_int_equal(warmup("auto:drive:199", 199), 0);
    assert_int_equal(warmup("auto:1000", 1000), 0);
    assert_int_equal(warmup("auto:turn:1000", 1000), 0);
    assert_int_equal(warmup("walk", 1000), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_allocation_may_fail),
        cmocka_unit_test(all_that_is_drawn_by_everybody_differs_in_nothing),
        cmocka_unit_test(walls_judged_by_their_fronts_are_no_cracks_from_behind),
        cmocka_unit_test(a_strategy_that_is_not_wanted_is_not_looked_at),
        cmocka_unit_test(cullers_are_told_what_a_frame_may_take),
        cmocka_unit_test(long_walks_warm_up_and_nothing_else),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
