// The scene that mixes all strategies: whichever exact chain each of its zones has no pixel is missed, the truth stays the same while zones are
// swapped, and what was allocated after all chains had their turn is what is allocated after more turns.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "stage.h"
#include "bench/bench.h"
#include "bench/generate.h"
#include "bench/strategy.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 320, HEIGHT = 180, SWAP_VIEWS = 10, VIEWS_MOST = 1200, ZONES_MOST = 128 };
enum { PLACE_OPEN, PLACE_STREET, PLACE_ROOMS, PLACE_CELLAR, PLACES };

typedef struct assignment { const char *name, *chains[PLACES]; } assignment; // a NULL name ends a list

// The first ones are uniform; test "swap" goes through these.
enum { UNIFORM = 4 };
static const assignment assignments[] = {
    {"frustum", {"frustum", "frustum", "frustum", "frustum"}},
    {"bsp", {"bsp+portal", "bsp+portal", "bsp+portal", "bsp+portal"}},
    {"octree", {"octree+occlusion", "octree+occlusion", "octree+occlusion", "octree+occlusion"}},
    {"pictures", {"imagecache", "imagecache", "imagecache", "imagecache"}},
    {"scene", {"imagecache+portal", "octree+portal+occlusion[method=hiz]", "bsp+portal", "bsp+portal"}},
    {"pictures within", {"bsp+portal", "imagecache", "octree+occlusion[method=hiz]", "imagecache+portal"}},
    {"turned", {"bsp+portal", "imagecache", "octree+occlusion", "frustum"}},
    {"turned again", {"octree+occlusion", "frustum", "imagecache", "bsp+portal+occlusion"}},
    {"pictures over all", {"imagecache+occlusion", "imagecache+portal", "frustum+portal", "octree+portal+occlusion"}},
    {"chc", {"octree+occlusion[method=chc]", "octree+portal+occlusion[method=chc]", "bsp+portal", "frustum+portal"}},
    {"hiz", {"octree+occlusion[method=hiz]", "octree+portal+occlusion[method=hiz]", "bsp+portal+occlusion", "brute+flood"}},
};
enum { ASSIGNMENTS = sizeof assignments / sizeof *assignments };

typedef struct sets { const chain_spec *of[ASSIGNMENTS][ZONES_MOST]; const chain_spec *const *list[ASSIGNMENTS]; } sets;

static int place_of(const scene *s, uint32_t zone)
{
    const scene_zone *z = &s->zones[zone];
    if (z->flags & ZONE_EVERYWHERE) return PLACE_OPEN;
    if (strcmp(z->name, "street") == 0) return PLACE_STREET;
    return s->hulls[z->first_hull].min[1] < -3 ? PLACE_CELLAR : PLACE_ROOMS;
}

static void sets_make(stage *s, sets *out)
{
    assert_true(s->scene->zone_count <= ZONES_MOST);
    for (int i = 0; i < ASSIGNMENTS; i++) {
        for (uint32_t z = 0; z < s->scene->zone_count; z++) out->of[i][z] = stage_chain(s, assignments[i].chains[place_of(s->scene, z)]);
        out->list[i] = out->of[i];
    }
}

typedef struct legs { camera cameras[VIEWS_MOST]; camera_path path; } legs;

// Runs of neighbouring views from all over the path, which begins anew where it ends.
static void legs_make(const camera_path *p, uint32_t count, uint32_t views, legs *out)
{
    const uint32_t step = p->count / count;
    assert_true(count * views <= VIEWS_MOST);
    out->path = (camera_path){.name = "legs", .cameras = out->cameras, .count = count * views};
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < views; k++) out->cameras[i * views + k] = p->cameras[(i * step + k) % p->count];
}

static int renderer_is_there(void)
{
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    report r = report_to_stderr();
    renderer *g = NULL;
    const int is = renderer_open(&options, allocator_heap(), &r, &g) == RESULT_OK;
    renderer_close(g);
    if (!is) fprintf(stderr, "SKIPPED: no OpenGL\n");
    return is;
}

// ---- Nothing is missed ----

static void row_check(const bench_row *row, const bench_row *first)
{
    print_message("%-18s %8.1f polygons of %8.1f visible, %llu pixels missed, %llu faults, %llu swaps\n", row->name, row->polygons_drawn, row->polygons_visible,
                  (unsigned long long)row->missed_pixels, (unsigned long long)row->faults, (unsigned long long)row->swaps);
    assert_int_equal(row->missed_pixels, 0);
    assert_int_equal(row->missed_items, 0);
    assert_int_equal(row->faults, 0);
    assert_int_equal(row->picture_differs, 0);
    assert_true(row->polygons_visible > 0 && row->polygons_visible == first->polygons_visible && row->items_visible == first->items_visible); // the same truth
    assert_true(row->polygons_drawn > 0);
}

static void check_path(stage *s, const sets *all, const camera_path *path)
{
    bench_strategy_request strategies[ASSIGNMENTS + 1];
    bench_result found;
    report r = report_to_stderr();
    for (int i = 0; i < ASSIGNMENTS; i++)
        strategies[i] = (bench_strategy_request){.name = assignments[i].name, .chain = all->of[i][0], .sets = &all->list[i], .set_count = 1};
    strategies[ASSIGNMENTS] = (bench_strategy_request){.name = "swap", .chain = all->of[0][0], .sets = all->list, .set_count = ASSIGNMENTS, .swap_views = SWAP_VIEWS};
    const bench_request q = {.scene = s->scene, .path = path, .strategies = strategies, .strategy_count = ASSIGNMENTS + 1, .plugins = s->plugins,
                             .services = &s->services, .repeat = 1, .width_px = WIDTH, .height_px = HEIGHT, .pictures = BENCH_PICTURES_NONE};
    assert_int_equal(bench_run(&q, &r, &found), RESULT_OK);
    for (int i = 0; i <= ASSIGNMENTS; i++)
        row_check(&found.rows[i], &found.rows[0]);
    assert_true(found.rows[ASSIGNMENTS].swaps > 0);
    bench_result_free(&found);
}

static void no_assignment_of_chains_to_zones_and_no_swap_of_them_misses_a_pixel(void **state)
{
    (void)state;
    static stage s;
    static sets all;
    static legs walk;
    if (!renderer_is_there()) skip();
    const int is_long = stage_tier() == TIER_LONG;
    stage_make(&s, "flagship", is_long ? 1000 : GENERATE_SIZE_OF_KIND);
    sets_make(&s, &all);
    legs_make(&s.walk, is_long ? 20 : 5, is_long ? 45 : 6, &walk);
    check_path(&s, &all, &walk.path);
    if (is_long) check_path(&s, &all, &s.tour);
    assert_true(failing_allocator_is_clean(&s.counted));
    stage_free(&s);
}

// ---- Nothing grows ----

static size_t resident_bytes(void)
{
    unsigned long size = 0, resident = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (!f) return 0;
    if (fscanf(f, "%lu %lu", &size, &resident) != 2) resident = 0;
    fclose(f);
    return resident * (size_t)sysconf(_SC_PAGESIZE);
}

typedef struct watch { uint64_t bytes[VIEWS_MOST], blocks[VIEWS_MOST]; size_t resident[VIEWS_MOST]; } watch; // after each view

static void watch_swaps(stage *s, const bench_request *q, watch *out)
{
    strategy x;
    renderer *g = NULL;
    report r = report_to_stderr();
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    assert_int_equal(renderer_open(&options, allocator_heap(), &r, &g), RESULT_OK);
    assert_int_equal(renderer_upload(g, s->scene, &r), RESULT_OK);
    assert_int_equal(strategy_open(q, q->strategies, NULL, &r, &x), RESULT_OK);
    assert_int_equal(strategy_attach(&x, g, &r), RESULT_OK);
    assert_int_equal(strategy_restart(&x, &r), RESULT_OK);
    for (uint32_t v = 0; v < q->path->count; v++) {
        strategy_view view;
        assert_int_equal(strategy_run_view(&x, &(strategy_request){.view = v, .mode = RENDER_SHADED, .marks = MARK_NOTHING}, &r, &view), RESULT_OK);
        assert_int_equal(view.faults, 0);
        out->bytes[v] = s->counted.live_bytes;
        out->blocks[v] = s->counted.live_blocks;
        out->resident[v] = resident_bytes();
    }
    strategy_close(&x);
    renderer_close(g);
}

static void zones_swapped_through_all_chains_again_and_again_take_no_more_memory(void **state)
{
    (void)state;
    static stage s;
    static sets all;
    static watch w;
    static legs walk;
    enum { CYCLE = UNIFORM * SWAP_VIEWS };
    if (!renderer_is_there()) skip();
    const int is_long = stage_tier() == TIER_LONG;
    stage_make(&s, "flagship", GENERATE_SIZE_OF_KIND);
    sets_make(&s, &all);
    legs_make(&s.walk, is_long ? 1 : 3, is_long ? VIEWS_MOST : CYCLE, &walk);
    const camera_path *path = &walk.path;
    const bench_strategy_request swap = {.name = "swap", .chain = all.of[0][0], .sets = all.list, .set_count = UNIFORM, .swap_views = SWAP_VIEWS};
    const bench_request q = {.scene = s.scene, .path = path, .strategies = &swap, .strategy_count = 1, .plugins = s.plugins, .services = &s.services,
                             .repeat = 1, .width_px = WIDTH, .height_px = HEIGHT};
    watch_swaps(&s, &q, &w);
    for (uint32_t v = 2 * CYCLE; v < path->count; v++) { // every zone had every chain, and once more: views keep the room of the largest
        assert_int_equal(w.bytes[v], w.bytes[v - CYCLE]);
        assert_int_equal(w.blocks[v], w.blocks[v - CYCLE]);
    }
    const uint32_t early = is_long ? 100 : CYCLE, last = path->count - 1;
    print_message("%u views, %u swaps of all zones: %llu bytes after view %u, %llu after the last; resident %zu and %zu\n", path->count, last / SWAP_VIEWS,
                  (unsigned long long)w.bytes[early], early, (unsigned long long)w.bytes[last], w.resident[early], w.resident[last]);
    if (is_long) assert_true(w.resident[last] < w.resident[early] + w.resident[early] / 5); // the driver's too
    assert_true(failing_allocator_is_clean(&s.counted));
    stage_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_assignment_of_chains_to_zones_and_no_swap_of_them_misses_a_pixel),
        cmocka_unit_test(zones_swapped_through_all_chains_again_and_again_take_no_more_memory),
    };
    return cmocka_run_group_tests_name("claims flagship", tests, NULL, NULL);
}
