// scenes/glass.json through importer, plugin, world and renderer: both ways to split give one picture, distance another, and a
// swap of chains takes the pieces along.
// SPDX-License-Identifier: MIT
#include "bench/strategy_parts.h"
#include "host/import/import.h"
#include "tests/common/test.h"

#include <stdlib.h>
#include <string.h>

enum { WIDE = 320, HIGH = 240, PIXELS = WIDE * HIGH, BYTES = 4 * PIXELS, CHAINS = 3, ZONES = 2 };
enum { BY_DISTANCE, SPLIT_LEAVES, SPLIT_NODES }; // places in chain_texts
static const char *const chain_texts[CHAINS] = {"bsp+portal", "bsp[split=1]+portal", "bsp[split=node]+portal"};

typedef struct bed {
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
    uint8_t *pictures[CHAINS];
} bed;

static void draw(bed *b, strategy *s, uint32_t view, uint8_t *rgba)
{
    strategy_view out;
    assert_int_equal(strategy_run_view(s, &(strategy_request){.view = view, .mode = RENDER_SHADED}, &b->report, &out), RESULT_OK);
    assert_int_equal(out.faults, 0);
    assert_int_equal(renderer_read(b->g, rgba, &b->report), RESULT_OK);
}

// Pixels more than 2 levels apart: a plane's colour differs by a level between a triangle and a part of it, and blends round.
static uint32_t pixels_apart(const uint8_t *a, const uint8_t *b)
{
    uint32_t count = 0;
    for (int i = 0; i < PIXELS; ++i)
        for (int k = 0; k < 3; ++k)
            if (abs(a[4 * i + k] - b[4 * i + k]) > 2) {
                count++;
                break;
            }
    return count;
}

static void a_material_named_with_a_star_is_see_through(void **state)
{
    bed *b = *state;
    uint32_t seen = 0;
    for (uint32_t i = 0; i < b->scene->item_count; ++i) {
        const scene_item *item = &b->scene->items[i];
        const int is = (item->flags & CULL_ITEM_SEE_THROUGH) != 0;
        assert_int_equal(is, b->scene->materials[item->material].name[0] == '*');
        seen += (uint32_t)is;
    }
    assert_int_equal(seen, 3 + 3 + 5 + 1 + 4 * 6); // over each other, crossing, in the back room, in the doorway, boxes
}

static void both_ways_to_split_draw_the_same_and_distance_does_not(void **state)
{
    bed *b = *state;
    uint32_t wrong = 0;
    for (uint32_t view = 0; view < b->path.count; ++view) {
        for (int c = 0; c < CHAINS; ++c) {
            strategy s;
            b->chains = (bench_strategy_request){.name = "test", .chain = &b->specs[c]};
            assert_int_equal(strategy_open(&b->bench, &b->chains, b->g, &b->report, &s), RESULT_OK);
            draw(b, &s, view, b->pictures[c]);
            strategy_close(&s);
        }
        assert_true(pixels_apart(b->pictures[SPLIT_LEAVES], b->pictures[SPLIT_NODES]) <= PIXELS / 5000); // sides of panes
        wrong += pixels_apart(b->pictures[BY_DISTANCE], b->pictures[SPLIT_LEAVES]);
    }
    assert_true(wrong > b->path.count * PIXELS / 100);
}

static void a_swapped_chain_brings_its_pieces(void **state)
{
    bed *b = *state;
    strategy swapped, alone;
    b->chains = (bench_strategy_request){.name = "swapped", .chain = &b->specs[0], .sets = b->sets, .set_count = CHAINS, .swap_views = 1};
    assert_int_equal(strategy_open(&b->bench, &b->chains, b->g, &b->report, &swapped), RESULT_OK);
    const bench_strategy_request still = {.name = "alone", .chain = &b->specs[0], .sets = b->sets, .set_count = 1};
    for (uint32_t view = 0; view < b->path.count; ++view) {
        draw(b, &swapped, view, b->pictures[0]);
        for (uint32_t z = 0; z < ZONES; ++z) b->by_zone[0][z] = &b->specs[(z + view) % CHAINS]; // what the zones have by now
        assert_int_equal(strategy_open(&b->bench, &still, b->g, &b->report, &alone), RESULT_OK);
        draw(b, &alone, view, b->pictures[1]);
        strategy_close(&alone);
        for (uint32_t z = 0; z < ZONES; ++z) b->by_zone[0][z] = &b->specs[0];
        assert_memory_equal(b->pictures[0], b->pictures[1], BYTES);
    }
    strategy_close(&swapped);
}

static int setup(void **state)
{
    const allocator *memory = allocator_heap();
    const char *const folders[] = {getenv("PORTCULLIS_PLUGINS")};
    const loader_options options = {.folders = folders, .folder_count = folders[0] ? 1 : 0};
    const import_options import = {.doors = DOORS_OPEN};
    bed *b = calloc(1, sizeof *b);
    if (!b) return -1;
    *state = b;
    b->report = report_to_stderr();
    b->texts = arena_make(memory);
    host_services_fill(&b->services, memory, &b->report);
    if (loader_open(&options, memory, &b->report, &b->plugins) != RESULT_OK) return -1;
    if (import_scene(GLASS, &import, memory, &b->report, &b->scene) != RESULT_OK || b->scene->zone_count != ZONES) return -1;
    if (camera_path_load("path:round", b->scene, (double)WIDE / HIGH, memory, &b->report, &b->path) != RESULT_OK) return -1;
    for (int c = 0; c < CHAINS; ++c) {
        if (chain_parse(chain_texts[c], &b->texts, &b->report, &b->specs[c]) != RESULT_OK) return -1;
        for (int z = 0; z < ZONES; ++z) b->by_zone[c][z] = &b->specs[c];
        b->sets[c] = b->by_zone[c];
        b->pictures[c] = malloc(BYTES);
    }
    b->bench = (bench_request){.scene = b->scene, .path = &b->path, .plugins = b->plugins, .services = &b->services, .repeat = 1,
                               .width_px = WIDE, .height_px = HIGH};
    if (renderer_open(NULL, memory, &b->report, &b->g) != RESULT_OK) return -1;
    return renderer_upload(b->g, b->scene, &b->report) == RESULT_OK ? 0 : -1;
}

static int teardown(void **state)
{
    bed *b = *state;
    const uint32_t errors = renderer_errors(b->g);
    renderer_close(b->g);
    camera_path_free(&b->path, allocator_heap());
    scene_free(b->scene, allocator_heap());
    loader_close(b->plugins);
    arena_free(&b->texts);
    for (int c = 0; c < CHAINS; ++c) free(b->pictures[c]);
    free(b);
    return errors ? -1 : 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_material_named_with_a_star_is_see_through, setup, teardown),
        cmocka_unit_test_setup_teardown(both_ways_to_split_draw_the_same_and_distance_does_not, setup, teardown),
        cmocka_unit_test_setup_teardown(a_swapped_chain_brings_its_pieces, setup, teardown),
    };
    renderer *g = NULL;
    report r = report_to_stderr();
    if (renderer_open(NULL, allocator_heap(), &r, &g) == RESULT_NO_GL) {
        print_message("SKIPPED: no OpenGL 4.5 on this machine\n");
        return 77;
    }
    renderer_close(g);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
