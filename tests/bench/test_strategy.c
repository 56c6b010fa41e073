// A strategy over two rooms: which chain each zone has and when, where movers are, what counts once and what is a fault.
// SPDX-License-Identifier: MIT
#include "bench/strategy_parts.h"
#include "host/import/import.h"
#include "tests/common/test.h"

#include <stdlib.h>
#include <string.h>

enum { ZONES = 2, CHAINS = 3 };

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
} fixture;

static void fixture_open(fixture *f)
{
    static const char *const texts[CHAINS] = {"frustum", "brute", "none"};
    const allocator *memory = allocator_heap();
    const char *const folders[] = {getenv("PORTCULLIS_PLUGINS")};
    const loader_options options = {.folders = folders, .folder_count = folders[0] ? 1 : 0};
    const import_options import = {.doors = DOORS_OPEN};
    *f = (fixture){.report = report_to_stderr(), .texts = arena_make(memory)};
    host_services_fill(&f->services, memory, &f->report);
    assert_int_equal(loader_open(&options, memory, &f->report, &f->plugins), RESULT_OK);
    assert_int_equal(import_scene(TWO_ROOMS, &import, memory, &f->report, &f->scene), RESULT_OK);
    assert_int_equal(f->scene->zone_count, ZONES);
    assert_int_equal(camera_path_load("path:walk", f->scene, 16.0 / 9, memory, &f->report, &f->path), RESULT_OK);
    for (int i = 0; i < CHAINS; ++i) {
        assert_int_equal(chain_parse(texts[i], &f->texts, &f->report, &f->specs[i]), RESULT_OK);
        for (int z = 0; z < ZONES; ++z) f->by_zone[i][z] = &f->specs[i];
        f->sets[i] = f->by_zone[i];
    }
    f->bench = (bench_request){
        .scene = f->scene, .path = &f->path, .plugins = f->plugins, .services = &f->services, .repeat = 1, .width_px = 320, .height_px = 180};
    f->chains = (bench_strategy_request){.name = "test", .chain = &f->specs[0], .sets = f->sets, .set_count = CHAINS};
}

static void fixture_close(fixture *f)
{
    camera_path_free(&f->path, allocator_heap());
    scene_free(f->scene, allocator_heap());
    loader_close(f->plugins);
    arena_free(&f->texts);
}

static strategy_view run(fixture *f, strategy *s, uint32_t view)
{
    strategy_view out;
    assert_int_equal(strategy_run_view(s, &(strategy_request){.view = view, .marks = MARK_DRAWN}, &f->report, &out), RESULT_OK);
    return out;
}

static const char *culler_of(const strategy *s, uint32_t zone)
{
    return world_chain(s->world, zone)->stages[0].plugin->descriptor->id;
}

static void a_set_names_chains_by_zone_and_the_rest_takes_the_common_one(void **state)
{
    (void)state;
    fixture f;
    strategy s;
    fixture_open(&f);
    f.by_zone[0][0] = NULL;
    f.by_zone[0][1] = &f.specs[2];
    f.chains.set_count = 1;
    assert_int_equal(strategy_open(&f.bench, &f.chains, NULL, &f.report, &s), RESULT_OK);
    assert_string_equal(culler_of(&s, 0), "frustum");
    assert_string_equal(culler_of(&s, 1), "none");
    assert_int_equal(s.indices_built, ZONES);
    strategy_close(&s);
    fixture_close(&f);
}

static void a_swap_goes_on_every_so_many_views_with_neighbours_one_apart(void **state)
{
    (void)state;
    static const char *const names[CHAINS] = {"frustum", "brute", "none"};
    fixture f;
    strategy s;
    fixture_open(&f);
    f.chains.swap_views = 7;
    assert_int_equal(strategy_open(&f.bench, &f.chains, NULL, &f.report, &s), RESULT_OK);
    for (uint32_t v = 0; v < f.path.count; ++v) {
        assert_int_equal(run(&f, &s, v).faults, 0);
        for (uint32_t z = 0; z < ZONES; ++z) assert_string_equal(culler_of(&s, z), names[(z + v / 7) % CHAINS]);
    }
    assert_int_equal(s.times.swaps, ZONES * ((f.path.count - 1) / 7));
    assert_int_equal(run(&f, &s, 0).faults, 0); // a new pass: back to the first set
    assert_string_equal(culler_of(&s, 0), "frustum");
    strategy_close(&s);
    fixture_close(&f);
}

static void swapped_chains_draw_what_they_draw_alone(void **state)
{
    (void)state;
    fixture f;
    strategy swapped, alone;
    fixture_open(&f);
    const bench_strategy_request frustum = {.name = "frustum", .chain = &f.specs[0]};
    for (int z = 0; z < ZONES; ++z) f.by_zone[2][z] = &f.specs[1]; // frustum and brute only: they draw the same
    f.chains.swap_views = 3;
    assert_int_equal(strategy_open(&f.bench, &f.chains, NULL, &f.report, &swapped), RESULT_OK);
    assert_int_equal(strategy_open(&f.bench, &frustum, NULL, &f.report, &alone), RESULT_OK);
    for (uint32_t v = 0; v < f.path.count; ++v) {
        assert_int_equal(run(&f, &swapped, v).stats.zones, run(&f, &alone, v).stats.zones);
        assert_memory_equal(swapped.drawn_bits, alone.drawn_bits, alone.words * sizeof(uint32_t));
    }
    strategy_close(&swapped);
    strategy_close(&alone);
    fixture_close(&f);
}

static void the_pictures_and_the_world_have_movers_at_the_same_places(void **state)
{
    (void)state;
    static const door_state both[] = {DOORS_OPEN, DOORS_SHUT};
    fixture f;
    strategy s;
    fixture_open(&f);
    for (int d = 0; d < 2; ++d) {
        f.bench.doors = &both[d];
        assert_int_equal(strategy_open(&f.bench, &f.chains, NULL, &f.report, &s), RESULT_OK);
        assert_int_equal(world_door(s.world, 0), both[d]);
        for (uint32_t v = 0; v < f.path.count; v += 5) {
            (void)run(&f, &s, v);
            motion_find(&s.motion, v);
            assert_memory_equal(s.motion.poses, world_poses(s.world), f.scene->mover_count * sizeof(scene_pose));
        }
        strategy_close(&s);
    }
    fixture_close(&f);
}

static void a_mover_moves_along_its_path(void **state)
{
    (void)state;
    fixture f;
    motion m;
    fixture_open(&f);
    assert_int_equal(motion_open(f.scene, NULL, allocator_heap(), &m), RESULT_OK);
    motion_find(&m, 0);
    assert_true(m.poses[1].offset[0] == 0);
    motion_find(&m, 45); // the cart after 1.5 s
    assert_true(m.poses[1].offset[0] == 12);
    motion_close(&m);
    fixture_close(&f);
}

static void an_item_that_the_host_gives_twice_is_a_repeat_and_counts_once(void **state)
{
    (void)state;
    fixture f;
    strategy s;
    fixture_open(&f);
    assert_int_equal(strategy_open(&f.bench, &f.chains, NULL, &f.report, &s), RESULT_OK);
    uint32_t shared = 0, places[ZONES] = {0};
    while (f.scene->listings[shared] < 2) ++shared;
    for (uint32_t z = 0; z < ZONES; ++z)
        while (s.order[s.zones[z].first + places[z]] != shared) ++places[z];
    const cull_run runs[ZONES] = {{places[0], 1}, {places[1], 1}};
    const visible_zone zones[ZONES] = {{0, 1, &runs[0]}, {1, 1, &runs[1]}};
    const uint32_t movers[] = {1, 1, 99};
    set_mark(&s, &(visible_set){.zones = zones, .zone_count = 1});
    assert_int_equal(s.repeats, 0);
    memset(s.drawn_bits, 0, s.words * sizeof(uint32_t));
    set_mark(&s, &(visible_set){.zones = zones, .zone_count = 2, .movers = movers, .mover_count = 3});
    assert_int_equal(s.repeats, 3); // the item, the mover, and one that there is not
    assert_int_equal(strategy_count(&s, &(visible_set){.zones = zones, .zone_count = 2}).items, 1);
    strategy_close(&s);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_set_names_chains_by_zone_and_the_rest_takes_the_common_one),
        cmocka_unit_test(a_swap_goes_on_every_so_many_views_with_neighbours_one_apart),
        cmocka_unit_test(swapped_chains_draw_what_they_draw_alone),
        cmocka_unit_test(the_pictures_and_the_world_have_movers_at_the_same_places),
        cmocka_unit_test(a_mover_moves_along_its_path),
        cmocka_unit_test(an_item_that_the_host_gives_twice_is_a_repeat_and_counts_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
