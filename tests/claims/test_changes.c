// What changes is not shown as it was: after an item, a light or a door changed, every picture that may show it is taken anew, and no other is. A forest under
// imagecache, through the scene manager.
// SPDX-License-Identifier: MIT
#include "stage.h"
#include "bench/generate.h"
#include "bench/strategy.h"
#include "host/core/viewer.h"
#include "host/core/world_parts.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 60000, WIDTH = 640, HEIGHT = 360, SETTLED = 70, CHANGES = 60, EYES = 12, EYE_FRAMES = 3 };

typedef struct field {
    stage stage;
    strategy strategy;
    camera_path path;
    renderer *g;
    report report;
    uint32_t eye; // a view of the path
} field;

static bench_strategy_request chains_of(field *f)
{
    return (bench_strategy_request){.name = "imagecache", .chain = stage_chain(&f->stage, "imagecache[hidden=shown]")};
}

// One eye, that stays where it is.
static int field_open(field *f, const bench_request *q)
{
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    if (renderer_open(&options, allocator_heap(), &f->report, &f->g) != RESULT_OK) return 0;
    assert_int_equal(renderer_upload(f->g, f->stage.scene, &f->report), RESULT_OK);
    assert_int_equal(strategy_open(q, q->strategies, NULL, &f->report, &f->strategy), RESULT_OK);
    renderer_reserve(f->g, strategy_tests(&f->strategy), &f->report);
    assert_int_equal(strategy_attach(&f->strategy, f->g, &f->report), RESULT_OK);
    return 1;
}

static void field_close(field *f)
{
    strategy_close(&f->strategy);
    renderer_close(f->g);
}

static strategy_view look(field *f)
{
    strategy_view seen;
    assert_int_equal(strategy_run_view(&f->strategy, &(strategy_request){.view = f->eye, .mode = RENDER_SHADED, .marks = MARK_DRAWN}, &f->report, &seen), RESULT_OK);
    assert_int_equal(seen.faults, 0);
    return seen;
}

static int touch(const cull_box *a, const cull_box *b)
{
    return a->min.x <= b->max.x && b->min.x <= a->max.x && a->min.y <= b->max.y && b->min.y <= a->max.y && a->min.z <= b->max.z && b->min.z <= a->max.z;
}

// Of slots that are full: those whose picture touches the box.
static uint32_t touched(const viewer *v, const cull_box *box)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < v->slot_count; i++) count += v->slots[i] && touch(&v->slot_boxes[i], box);
    return count;
}

static uint32_t full(const viewer *v)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < v->slot_count; i++) count += v->slots[i];
    return count;
}

static void change(field *f, const cull_box *box)
{
    const double *o = f->stage.scene->zones[0].origin;
    const double min[3] = {(double)box->min.x + o[0], (double)box->min.y + o[1], (double)box->min.z + o[2]};
    const double max[3] = {(double)box->max.x + o[0], (double)box->max.y + o[1], (double)box->max.z + o[2]};
    world_changed(f->strategy.world, min, max);
}

// A box of an item, or what a lamp of some metres lights.
static cull_box changed_box(const field *f, uint64_t *r, int is_light)
{
    const cull_zone *zone = &world_chain(f->strategy.world, 0)->zone;
    const uint32_t i = random_below(r, zone->item_count);
    const float lit = is_light ? 15 : 0;
    const cull_box box = {{zone->boxes.min_x[i] - lit, zone->boxes.min_y[i] - lit, zone->boxes.min_z[i] - lit},
                     {zone->boxes.max_x[i] + lit, zone->boxes.max_y[i] + lit, zone->boxes.max_z[i] + lit}};
    return box;
}

static void scene_load(field *f)
{
    scratch_folder folder;
    char file[512];
    scratch_folder_make(&folder);
    scratch_folder_name(&folder, "forest.obj", file, sizeof file);
    assert_int_equal(generate_scene("forest", SIZE, GENERATE_SEED_OF_KIND, file, allocator_heap(), &f->report), RESULT_OK);
    stage_load(&f->stage, file);
    scratch_folder_remove(&folder);
}

// Where most pictures are shown.
static void find_eye(field *f)
{
    uint64_t most = 0;
    uint32_t best = 0;
    for (f->eye = 0; f->eye < EYES; f->eye++) {
        uint64_t pictures = 0;
        for (int i = 0; i < EYE_FRAMES; i++) pictures = look(f).stats.pictures;
        if (pictures > most) best = f->eye, most = pictures;
    }
    f->eye = best;
}

static void check_changes(field *f)
{
    uint64_t r = 71;
    uint32_t hits = 0, misses = 0, taken = 0;
    find_eye(f);
    for (int i = 0; i < SETTLED; i++) look(f);
    const viewer *v = f->strategy.view->zones[0];
    const strategy_view still = look(f);
    assert_int_equal(still.stats.captures, 0);
    assert_true(still.stats.pictures > 3);
    for (int i = 0; i < CHANGES; i++) {
        const cull_box box = changed_box(f, &r, i % 4 == 0);
        const uint32_t stale = touched(v, &box), before = full(v);
        change(f, &box);
        assert_int_equal(full(v), before - stale);
        const strategy_view after = look(f);
        assert_true(after.stats.captures <= stale); // what is not shown now is taken when it is
        assert_int_equal(after.stats.pictures, still.stats.pictures);
        assert_int_equal(look(f).stats.captures, 0);
        taken += (uint32_t)after.stats.captures;
        hits += after.stats.captures > 0;
        misses += stale == 0;
    }
    print_message("%d changes: %u made pictures stale that are shown, %u none; %u taken anew\n", CHANGES, hits, misses, taken);
    assert_true(hits > 5 && misses > 5);
}

static void a_changed_item_or_light_is_in_no_picture_that_was_taken_before(void **state)
{
    (void)state;
    static field f;
    f.report = report_to_stderr();
    scene_load(&f);
    f.path = (camera_path){0};
    assert_int_equal(camera_path_load("auto:walk:12", f.stage.scene, 16.0 / 9, allocator_heap(), &f.report, &f.path), RESULT_OK);
    const bench_strategy_request chains = chains_of(&f);
    const bench_request q = {.scene = f.stage.scene, .path = &f.path, .strategies = &chains, .strategy_count = 1, .plugins = f.stage.plugins,
                             .services = &f.stage.services, .repeat = 1, .width_px = WIDTH, .height_px = HEIGHT};
    const int has_gl = field_open(&f, &q);
    if (has_gl) {
        check_changes(&f);
        field_close(&f);
    }
    camera_path_free(&f.path, allocator_heap());
    assert_true(failing_allocator_is_clean(&f.stage.counted));
    stage_free(&f.stage);
    if (has_gl) return;
    fprintf(stderr, "SKIPPED: no OpenGL\n");
    skip();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_changed_item_or_light_is_in_no_picture_that_was_taken_before),
    };
    return cmocka_run_group_tests_name("claims changes", tests, NULL, NULL);
}
