// What the bench compares: the frame as it was drawn, beside the set that it says, pixel by pixel.
// SPDX-License-Identifier: MIT
#include "bench/drawn.h"
#include "bench/strategy_parts.h"
#include "host/import/import.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 160, HEIGHT = 90, ZONES = 2, CHAINS = 2 };

typedef struct fixture {
    report report;
    host_services services;
    loader *plugins;
    arena texts;
    scene *scene;
    camera_path path;
    chain_spec specs[CHAINS];
    const chain_spec *by_zone[CHAINS][ZONES];
    const chain_spec *const *sets[CHAINS];
    bench_request bench;
    bench_strategy_request chains;
    renderer *g;
    strategy strategy;
    truth truth;
} fixture;

static int fixture_setup(void **state)
{
    static const char *const texts[CHAINS] = {"frustum", "brute"};
    const allocator *memory = allocator_heap();
    const char *const folders[] = {getenv("PORTCULLIS_PLUGINS")};
    const loader_options options = {.folders = folders, .folder_count = folders[0] ? 1 : 0};
    const renderer_options of_gl = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    const import_options import = {.doors = DOORS_OPEN};
    static fixture f;
    f = (fixture){.report = report_to_stderr(), .texts = arena_make(memory)};
    *state = &f;
    host_services_fill(&f.services, memory, &f.report);
    assert_int_equal(loader_open(&options, memory, &f.report, &f.plugins), RESULT_OK);
    assert_int_equal(import_scene(TWO_ROOMS, &import, memory, &f.report, &f.scene), RESULT_OK);
    assert_int_equal(camera_path_load("path:walk", f.scene, 16.0 / 9, memory, &f.report, &f.path), RESULT_OK);
    for (int i = 0; i < CHAINS; ++i) {
        assert_int_equal(chain_parse(texts[i], &f.texts, &f.report, &f.specs[i]), RESULT_OK);
        for (int z = 0; z < ZONES; ++z) f.by_zone[i][z] = &f.specs[i];
        f.sets[i] = f.by_zone[i];
    }
    f.bench = (bench_request){.scene = f.scene, .path = &f.path, .plugins = f.plugins, .services = &f.services, .repeat = 1,
                              .width_px = WIDTH, .height_px = HEIGHT};
    f.chains = (bench_strategy_request){.name = "test", .chain = &f.specs[0], .sets = f.sets, .set_count = CHAINS, .swap_views = 3};
    if (renderer_open(&of_gl, memory, &f.report, &f.g) != RESULT_OK) return 0; // each test skips
    const truth_request request = {f.scene, WIDTH, HEIGHT, WALLS_BOTH_SIDES};
    assert_int_equal(renderer_upload(f.g, f.scene, &f.report), RESULT_OK);
    assert_int_equal(strategy_open(&f.bench, &f.chains, f.g, &f.report, &f.strategy), RESULT_OK);
    assert_int_equal(truth_open(&request, memory, &f.report, &f.truth), RESULT_OK);
    return 0;
}

static int fixture_teardown(void **state)
{
    fixture *f = *state;
    truth_close(&f->truth);
    strategy_close(&f->strategy);
    renderer_close(f->g);
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

static uint64_t wrong_pixels(fixture *f, uint32_t view)
{
    uint64_t pixels = 0;
    assert_int_equal(drawn_compare(&f->strategy, &f->truth, view, &f->report, &pixels), RESULT_OK);
    return pixels;
}

static strategy_view run(fixture *f, uint32_t view)
{
    strategy_view out;
    const strategy_request q = {.view = view, .marks = MARK_DRAWN, .records = RECORD_DRAWS};
    assert_int_equal(strategy_run_view(&f->strategy, &q, &f->report, &out), RESULT_OK);
    return out;
}

static void every_view_shows_what_it_says_while_chains_are_swapped(void **state)
{
    fixture *f = with_gl(state);
    for (uint32_t v = 0; v < f->path.count; ++v) {
        run(f, v);
        assert_int_equal(wrong_pixels(f, v), 0);
    }
    assert_true(f->strategy.times.swaps > 20);
    assert_int_equal(renderer_errors(f->g), 0);
}

static void a_layout_in_another_order_than_the_chain_s_is_seen(void **state)
{
    fixture *f = with_gl(state);
    const strategy_zone *z = &f->strategy.zones[0];
    uint32_t *turned = test_malloc(z->item_count * sizeof *turned);
    run(f, 0);
    assert_int_equal(wrong_pixels(f, 0), 0);
    for (uint32_t i = 0; i < z->item_count; ++i) turned[i] = f->strategy.order[z->first + z->item_count - 1 - i];
    assert_int_equal(render_layout_reorder(f->strategy.layout, 0, turned, &f->report), RESULT_OK);
    test_free(turned);
    run(f, 0);
    assert_true(wrong_pixels(f, 0) > WIDTH * HEIGHT / 50);
}

static uint32_t most_seen(const fixture *f)
{
    const truth_item *items = f->truth.items.items;
    uint32_t most = 0;
    for (size_t i = 1; i < f->truth.items.count; ++i)
        if (items[i].pixels > items[most].pixels) most = (uint32_t)i;
    return most;
}

static void an_item_drawn_and_not_said_is_seen_and_so_is_one_said_and_not_drawn(void **state)
{
    fixture *f = with_gl(state);
    run(f, 0);
    assert_int_equal(truth_add_view(&f->truth, f->g, &f->path.cameras[0], &f->report), RESULT_OK);
    const truth_item seen = ((const truth_item *)f->truth.items.items)[most_seen(f)];
    f->strategy.drawn_bits[seen.item / 32] &= ~(1u << (seen.item % 32));
    assert_int_equal(wrong_pixels(f, 0), seen.pixels); // where it owns a pixel something else would show
    f->strategy.drawn_bits[seen.item / 32] |= 1u << (seen.item % 32);
    assert_int_equal(wrong_pixels(f, 0), 0);
    f->strategy.draws.count = 0;
    uint64_t owned = 0;
    for (size_t i = 0; i < f->truth.items.count; ++i) owned += ((const truth_item *)f->truth.items.items)[i].pixels;
    assert_int_equal(wrong_pixels(f, 0), owned); // nothing drawn at all
}

static void more_ids_than_items_are_a_fault_and_are_not_written(void **state)
{
    fixture *f = *state;
    strategy s;
    f->bench.ids = BENCH_IDS;
    assert_int_equal(strategy_open(&f->bench, &f->chains, NULL, &f->report, &s), RESULT_OK);
    const uint32_t count = s.zones[0].item_count;
    const cull_run runs[] = {{0, count}, {0, count}, {0, count}};
    const visible_zone zones[] = {{0, 3, runs}, {1, 0, NULL}};
    memset(s.ids, 0xff, (f->scene->item_count + RUNS_OVERWRITE) * sizeof *s.ids);
    set_write_ids(&s, &(visible_set){.zones = zones, .zone_count = 2});
    assert_int_equal(s.id_faults, 1);
    assert_int_equal(s.ids[0], UINT32_MAX);
    const visible_zone once[] = {{0, 1, runs}};
    set_write_ids(&s, &(visible_set){.zones = once, .zone_count = 1});
    assert_int_equal(s.id_faults, 0);
    assert_int_equal(s.ids[0], s.order[s.zones[0].first]);
    strategy_close(&s);
}

int main(void)
{
#define T(name) cmocka_unit_test_setup_teardown(name, fixture_setup, fixture_teardown)
    const struct CMUnitTest tests[] = {
        T(every_view_shows_what_it_says_while_chains_are_swapped),
        T(a_layout_in_another_order_than_the_chain_s_is_seen),
        T(an_item_drawn_and_not_said_is_seen_and_so_is_one_said_and_not_drawn),
        T(more_ids_than_items_are_a_fault_and_are_not_written),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
