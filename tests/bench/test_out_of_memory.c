// One way through the product: a file is loaded, cullers are built on its zones, views are culled, chains are swapped.
// Allocation 1, 2, 3 ... fails in turn until all of it passes: no crash, nothing left behind; then frames allocate nothing
// but in a swap.
// SPDX-License-Identifier: MIT
#include "bench/strategy.h"
#include "host/import/import.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/report_lines.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 320, HEIGHT = 180, CHAINS_MOST = 3 };

typedef struct way_request {
    const char *path, *views, *chains[CHAINS_MOST];
    uint32_t chain_count, swap_views; // swap_views 0: the first chain everywhere
} way_request;

typedef struct way {
    const way_request *q;
    failing_allocator memory;
    report_lines lines;
    scene *scene;
    camera_path views;
    loader *plugins;
    chain_spec specs[CHAINS_MOST];
    const chain_spec **sets[CHAINS_MOST]; // by zone, in `texts`
    arena texts;
    strategy strategy;
    uint64_t frame_allocations, swaps;
} way;

static result cull_views(way *w, const bench_request *q)
{
    strategy_view view;
    result done = RESULT_OK;
    for (uint32_t v = 0; v < q->path->count && done == RESULT_OK; ++v) {
        const uint64_t before = w->memory.calls, swaps = w->strategy.times.swaps;
        done = strategy_run_view(&w->strategy, &(strategy_request){.view = v, .mode = RENDER_SHADED, .marks = MARK_DRAWN}, &w->lines.report, &view);
        if (w->strategy.times.swaps == swaps) w->frame_allocations += w->memory.calls - before;
    }
    w->swaps = w->strategy.times.swaps;
    return done;
}

static result parse_chains(way *w)
{
    result done = RESULT_OK;
    for (uint32_t i = 0; i < w->q->chain_count && done == RESULT_OK; ++i) {
        done = chain_parse(w->q->chains[i], &w->texts, &w->lines.report, &w->specs[i]);
        w->sets[i] = arena_push(&w->texts, w->scene->zone_count, sizeof *w->sets[i]);
        if (done == RESULT_OK && !w->sets[i]) done = report_no_memory(&w->lines.report, NULL);
        for (uint32_t z = 0; done == RESULT_OK && z < w->scene->zone_count; ++z) w->sets[i][z] = &w->specs[i];
    }
    return done;
}

static result go(way *w)
{
    const allocator *memory = &w->memory.memory;
    const char *const folders[] = {getenv("PORTCULLIS_PLUGINS")};
    const loader_options options = {.folders = folders, .folder_count = 1};
    const import_options import = {.doors = DOORS_OPEN};
    host_services services;
    host_services_fill(&services, memory, &w->lines.report);
    w->texts = arena_make(memory);
    result done = import_scene(w->q->path, &import, memory, &w->lines.report, &w->scene);
    if (done == RESULT_OK) done = camera_path_load(w->q->views, w->scene, (double)WIDTH / HEIGHT, memory, &w->lines.report, &w->views);
    if (done == RESULT_OK) done = loader_open(&options, memory, &w->lines.report, &w->plugins);
    if (done == RESULT_OK) done = parse_chains(w);
    const bench_request q = {.scene = w->scene, .path = &w->views, .plugins = w->plugins, .services = &services, .repeat = 1,
                             .width_px = WIDTH, .height_px = HEIGHT};
    const chain_spec *const *const sets[CHAINS_MOST] = {w->sets[0], w->sets[1], w->sets[2]};
    const bench_strategy_request chains = {
        .name = "way", .chain = &w->specs[0], .sets = sets, .set_count = w->q->chain_count, .swap_views = w->q->swap_views};
    if (done == RESULT_OK) done = strategy_open(&q, &chains, NULL, &w->lines.report, &w->strategy);
    if (done == RESULT_OK) done = cull_views(w, &q);
    strategy_close(&w->strategy);
    loader_close(w->plugins);
    camera_path_free(&w->views, memory);
    scene_free(w->scene, memory);
    arena_free(&w->texts);
    return done;
}

// Returns the swaps of the way that passes.
static uint64_t fail_each_allocation(const way_request *q)
{
    result done = RESULT_NO_MEMORY;
    uint64_t swaps = 0;
    for (uint64_t k = 1; done != RESULT_OK; ++k) {
        way w = {.q = q};
        failing_allocator_init(&w.memory, k);
        report_lines_init(&w.lines);
        done = go(&w);
        assert_true(done == RESULT_OK || done == RESULT_NO_MEMORY);
        assert_true(failing_allocator_is_clean(&w.memory));
        if (done == RESULT_OK) assert_int_equal(w.frame_allocations, 0);
        swaps = w.swaps;
    }
    return swaps;
}

static void from_file_to_frame_each_allocation_may_fail(void **state)
{
    (void)state;
    static const char *const files[] = {"librequake/lqdm12.map", "models/suzanne.obj", "boxes/city-1000.boxes"};
    static const char *const chains[] = {"frustum[backface=1]", "frustum", "brute"};
    const char *folder = getenv("PORTCULLIS_SCENES");
    for (size_t i = 0; i < sizeof files / sizeof *files; ++i) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", folder ? folder : "", files[i]);
        FILE *file = fopen(path, "rb");
        if (!file) {
            fprintf(stderr, "SKIPPED: no %s in PORTCULLIS_SCENES\n", files[i]);
            skip();
        }
        fclose(file);
        fail_each_allocation(&(way_request){.path = path, .views = "auto:4", .chains = {chains[i]}, .chain_count = 1});
    }
}

static void two_rooms_and_their_swaps_survive_each_failure(void **state)
{
    (void)state;
    const uint64_t swaps = fail_each_allocation(&(way_request){.path = TWO_ROOMS, .views = "path:walk", .chains = {"frustum", "brute", "none"},
                                                               .chain_count = 3, .swap_views = 10});
    assert_int_equal(swaps, 2 * 5); // 60 views, both zones every ten of them
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(from_file_to_frame_each_allocation_may_fail),
        cmocka_unit_test(two_rooms_and_their_swaps_survive_each_failure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
