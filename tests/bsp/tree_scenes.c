// Scenes for tests of the tree: see tree_scenes.h.
// SPDX-License-Identifier: MIT
#include "tree_scenes.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>

static int32_t random_step(uint64_t *seed, int32_t most) // -most .. most
{
    return (int32_t)random_below(seed, (uint32_t)(2 * most + 1)) - most;
}

void scene_of_boxes(const box_scene *wish, hand_zone *out)
{
    uint64_t seed = wish->seed;
    const int32_t r = wish->room * wish->unit, room_low[3] = {-r, -r, -r}, room_high[3] = {r, r, r};
    hand_zone_open(out, (wish->boxes + 2) * 6, (wish->boxes + 2) * 24); // room for a few more
    grid_box(out, room_low, room_high, FACE_IN);
    for (uint32_t i = 0; i < wish->boxes; i++) {
        int32_t low[3], high[3];
        for (int k = 0; k < 3; k++) {
            low[k] = random_step(&seed, wish->room - 8) * wish->unit;
            high[k] = low[k] + (1 + (int32_t)random_below(&seed, 7)) * wish->unit;
        }
        grid_box(out, low, high, FACE_OUT);
    }
}

void scene_of_polygons(uint32_t count, uint64_t seed, hand_zone *out)
{
    hand_zone_open(out, count, count * 3);
    while (out->zone.item_count < count) {
        grid_loop loop = {.count = 3};
        cull_wide_plane plane;
        for (uint32_t i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) loop.p[i][k] = random_step(&seed, 1000);
        if (cull_wide_plane_through(loop.p[0], loop.p[1], loop.p[2], &plane)) grid_wall(out, &loop);
    }
}

void scene_of_column(uint32_t sides, hand_face faces, hand_zone *out)
{
    hand_zone_open(out, sides, sides * 4);
    for (uint32_t i = 0; i < sides; i++) {
        const double radius = 4000000; // corners on a fine grid: no two walls share a plane
        const double a = 6.283185307179586 * i / sides, b = 6.283185307179586 * (i + 1) / sides;
        const int32_t p[4] = {(int32_t)(radius * cos(a)), (int32_t)(radius * sin(a)), (int32_t)(radius * cos(b)), (int32_t)(radius * sin(b))};
        const int32_t outward[4] = {p[2], p[3], p[0], p[1]};
        grid_plan(out, faces == FACE_IN ? p : outward, 1000);
    }
}

void assert_no_fault(const char *fault)
{
    assert_string_equal(fault ? fault : "no fault", "no fault");
}

void tree_of(const hand_zone *zone, bsp_wish wish, culler_host *host, bsp_tree *out)
{
    culler_host_init(host, 0);
    const bsp_source from = {&zone->zone, NULL, wish};
    assert_int_equal(bsp_tree_build(&host->host, &from, out), CULL_OK);
    assert_no_fault(tree_fault(&zone->zone, out));
}

void tree_end(culler_host *host, bsp_tree *tree)
{
    bsp_tree_free(&host->host, tree);
    assert_true(failing_allocator_is_clean(&host->memory));
}
