// One way through the product: a file is loaded, cullers are built on it, views are culled. Allocation 1, 2, 3 ... fails in
// turn until all of it passes: no crash, nothing left behind; then frames allocate nothing.
// SPDX-License-Identifier: MIT
#include "bench/strategy.h"
#include "host/import/import.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/report_lines.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>

enum { VIEWS = 4, WIDTH = 320, HEIGHT = 180 };

typedef struct way {
    const char *path, *chain;
    failing_allocator memory;
    report_lines lines;
    scene *scene;
    camera_path views;
    loader *plugins;
    strategy strategy;
    uint64_t frame_allocations;
} way;

static result cull_views(way *w, const bench_request *q)
{
    strategy_view view;
    result done = RESULT_OK;
    const uint64_t before = w->memory.calls;
    for (uint32_t v = 0; v < q->path->count && done == RESULT_OK; ++v)
        done = strategy_run_view(&w->strategy, &(strategy_request){v, RENDER_SHADED, MARK_DRAWN}, &w->lines.report, &view);
    w->frame_allocations = w->memory.calls - before;
    return done;
}

static result go(way *w)
{
    const allocator *memory = &w->memory.memory;
    const char *const folders[] = {getenv("PORTCULLIS_PLUGINS")};
    const loader_options options = {.folders = folders, .folder_count = 1};
    const import_options import = {.doors = DOORS_OPEN};
    host_services services;
    chain_spec spec;
    arena texts = arena_make(memory);
    host_services_fill(&services, memory, &w->lines.report);
    result done = import_scene(w->path, &import, memory, &w->lines.report, &w->scene);
    if (done == RESULT_OK) done = camera_path_load("auto:4", w->scene, (double)WIDTH / HEIGHT, memory, &w->lines.report, &w->views);
    if (done == RESULT_OK) done = loader_open(&options, memory, &w->lines.report, &w->plugins);
    if (done == RESULT_OK) done = chain_parse(w->chain, &texts, &w->lines.report, &spec);
    const bench_request q = {.scene = w->scene, .path = &w->views, .plugins = w->plugins, .services = &services, .repeat = 1,
                             .width_px = WIDTH, .height_px = HEIGHT};
    if (done == RESULT_OK) done = strategy_open(&q, &spec, NULL, &w->lines.report, &w->strategy);
    if (done == RESULT_OK) done = cull_views(w, &q);
    strategy_close(&w->strategy);
    loader_close(w->plugins);
    camera_path_free(&w->views, memory);
    scene_free(w->scene, memory);
    arena_free(&texts);
    return done;
}

static void fail_each_allocation(const char *path, const char *chain)
{
    result done = RESULT_NO_MEMORY;
    for (uint64_t k = 1; done != RESULT_OK; ++k) {
        way w = {.path = path, .chain = chain};
        failing_allocator_init(&w.memory, k);
        report_lines_init(&w.lines);
        done = go(&w);
        assert_true(done == RESULT_OK || done == RESULT_NO_MEMORY);
        assert_true(failing_allocator_is_clean(&w.memory));
        if (done == RESULT_OK) assert_int_equal(w.frame_allocations, 0);
    }
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
        fail_each_allocation(path, chains[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(from_file_to_frame_each_allocation_may_fail)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
