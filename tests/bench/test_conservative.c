// CONSERVATIVE holds beyond the picture's own samples: against the union of 16 sub-pixel shifts and against a picture of
// 4x4 its size, no item that owns a sample is dropped. Also the bench's statistics.
// SPDX-License-Identifier: MIT
#include "bench/statistics.h"
#include "bench/strategy.h"
#include "host/import/import.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 480, HEIGHT = 270, VIEWS_SHORT = 3, VIEWS_LONG = 40 };

typedef struct fixture {
    report report;
    host_services services;
    loader *plugins;
    arena texts;
    renderer *g;
} fixture;

static int fixture_open(fixture *f)
{
    const allocator *memory = allocator_heap();
    const char *const folders[] = {getenv("PORTCULLIS_PLUGINS")};
    const loader_options options = {.folders = folders, .folder_count = folders[0] ? 1 : 0};
    const renderer_options of_gl = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    f->report = report_to_stderr();
    host_services_fill(&f->services, memory, &f->report);
    f->texts = arena_make(memory);
    assert_int_equal(loader_open(&options, memory, &f->report, &f->plugins), RESULT_OK);
    return renderer_open(&of_gl, memory, &f->report, &f->g) == RESULT_OK;
}

static void fixture_close(fixture *f)
{
    renderer_close(f->g);
    loader_close(f->plugins);
    arena_free(&f->texts);
}

// Misses of one chain over the path, in finer pictures of the same views.
static uint64_t finer_misses(fixture *f, const bench_request *q, const char *chain)
{
    static const truth_finer shifted = {16, 1}, larger = {1, 4};
    chain_spec spec;
    strategy s;
    truth t;
    uint64_t misses = 0;
    assert_int_equal(chain_parse(chain, &f->texts, &f->report, &spec), RESULT_OK);
    const bench_strategy_request chains = {.name = chain, .chain = &spec};
    assert_int_equal(strategy_open(q, &chains, NULL, &f->report, &s), RESULT_OK);
    const truth_request request = {q->scene, WIDTH, HEIGHT, s.walls};
    assert_int_equal(truth_open(&request, q->services->memory, &f->report, &t), RESULT_OK);
    for (uint32_t v = 0; v < q->path->count; ++v) {
        strategy_view view;
        assert_int_equal(strategy_run_view(&s, &(strategy_request){.view = v, .mode = RENDER_SHADED, .marks = MARK_DRAWN}, &f->report, &view),
                         RESULT_OK);
        assert_int_equal(truth_add_finer(&t, f->g, &q->path->cameras[v], &shifted, &f->report), RESULT_OK);
        assert_int_equal(truth_add_finer(&t, f->g, &q->path->cameras[v], &larger, &f->report), RESULT_OK);
        misses += strategy_misses(&s, &t, 2 * v).items + strategy_misses(&s, &t, 2 * v + 1).items;
        assert_true(((const truth_view *)t.views.items)[2 * v].count > 0 || ((const truth_view *)t.views.items)[2 * v + 1].count == 0);
    }
    truth_close(&t);
    strategy_close(&s);
    return misses;
}

static void check_scene(fixture *f, const char *file)
{
    const char *folder = getenv("PORTCULLIS_SCENES"), *chains[] = {"brute", "frustum", "frustum[isa=plain]", "frustum[backface=1]"};
    const allocator *memory = allocator_heap();
    char path[1024], what[32];
    scene *s = NULL;
    camera_path views;
    snprintf(path, sizeof path, "%s/%s", folder, file);
    snprintf(what, sizeof what, "auto:%d", getenv("PORTCULLIS_LONG") ? VIEWS_LONG : VIEWS_SHORT);
    const import_options import = {.doors = DOORS_OPEN};
    assert_int_equal(import_scene(path, &import, memory, &f->report, &s), RESULT_OK);
    assert_int_equal(camera_path_load(what, s, (double)WIDTH / HEIGHT, memory, &f->report, &views), RESULT_OK);
    assert_int_equal(renderer_upload(f->g, s, &f->report), RESULT_OK);
    const bench_request q = {.scene = s, .path = &views, .plugins = f->plugins, .services = &f->services, .repeat = 1,
                             .width_px = WIDTH, .height_px = HEIGHT};
    for (size_t i = 0; i < sizeof chains / sizeof *chains; ++i) assert_int_equal(finer_misses(f, &q, chains[i]), 0);
    camera_path_free(&views, memory);
    scene_free(s, memory);
}

static int scenes_are_there(void)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/quake/e1m1.map", getenv("PORTCULLIS_SCENES") ? getenv("PORTCULLIS_SCENES") : "");
    FILE *file = fopen(path, "rb");
    if (file) fclose(file);
    return file != NULL;
}

static void no_item_with_a_visible_point_is_dropped(void **state)
{
    (void)state;
    fixture f = {0};
    const int has_gl = fixture_open(&f);
    if (!has_gl || !scenes_are_there()) {
        fprintf(stderr, "SKIPPED: %s\n", has_gl ? "no real scenes in PORTCULLIS_SCENES" : "no OpenGL");
        fixture_close(&f);
        skip();
    }
    check_scene(&f, "quake/e1m1.map");
    check_scene(&f, "librequake/lq_e3m4.map");
    check_scene(&f, "city/delft.obj");
    check_scene(&f, "boxes/city-1000.boxes");
    fixture_close(&f);
}

static void percentiles_are_exact(void **state)
{
    (void)state;
    double odd[] = {5, 1, 3}, even[] = {4, 1, 3, 2}, hundred[100];
    for (int i = 0; i < 100; ++i) hundred[i] = 100 - i;
    assert_true(percentile(odd, 3, 0.5) == 3);
    assert_true(percentile(even, 4, 0.5) == 2.5);
    assert_true(percentile(hundred, 100, 0.95) == 95);
    assert_true(percentile(hundred, 100, 0.99) == 99);
    assert_true(percentile(odd, 1, 0.99) == 1);
    assert_true(mean(even, 4) == 2.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(percentiles_are_exact),
        cmocka_unit_test(no_item_with_a_visible_point_is_dropped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
