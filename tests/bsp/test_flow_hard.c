// The flow where it is hard: eyes that are none, several volumes, full arenas, memory that runs out, any pose.
// SPDX-License-Identifier: MIT
#include "flow_views.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const grid_wish plain = {.size = {6, 3, 5}, .seed = 3, .open = 0.4, .shut = 0.2, .one_way = 0.05, .scale = 1};
static const bsp_cells ways[] = {BSP_CELLS_RECT, BSP_CELLS_HULL, BSP_CELLS_EXACT};
enum { WAYS = 3, FLOW_TEST_VISITS = 4 }; // passes of a flow

static flow_aim aim_at(const grid_cells *g, uint64_t *random)
{
    flow_aim a = {.tangents = {1.03, 0.58}, .near_distance = 0.01};
    for (int k = 0; k < 3; k++) {
        a.eye[k] = random_between(random, g->places[k][0] + 0.05, g->places[k][g->size[k]] - 0.05);
        a.forward[k] = random_between(random, -1, 1);
    }
    a.forward[random_below(random, 3)] += 1.5;
    return a;
}

static uint32_t count_of(const uint8_t *bytes, uint32_t count)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < count; i++) sum += bytes[i];
    return sum;
}

static int is_within(const uint8_t *inner, const uint8_t *outer, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (inner[i] > outer[i]) return 0;
    return 1;
}

static void views_without_an_eye_at_a_point_in_the_cells_are_left_to_the_walk(void **state)
{
    grid_cells g;
    flow_run r;
    flow_view v;
    (void)state;
    grid_make(&plain, &g);
    flow_run_make(&g, &r);
    const flow_aim good = {{1, 1, 1}, {1, 0, 0.1}, {1, 0.6}, 0.01};
    for (int i = 0; i < 10; i++) {
        flow_view_make(&g, &good, &v);
        const double bad[] = {NAN, INFINITY, -INFINITY, 1e30};
        if (i < 4) v.view.eye_exact[i % 3] = bad[i];
        if (i >= 4 && i < 6) v.view.forward[i % 3] = bad[i - 4];
        if (i == 6) v.view.eye[3] = 0;
        if (i == 7) v.view.reach = 1e9;
        if (i == 8) v.view.eye_exact[0] = -50; // outside the box, inside the volume
        if (i == 9) v.view.reach = NAN;
        if (i == 8) v.volume.plane_count = 0;
        flow_run_step(&g, &v, BSP_CELLS_HULL, 1, &r);
        assert_int_equal(r.result, 0);
        assert_int_equal(r.figures.cells_visited, 0);
        assert_int_equal(count_of(r.drawn, g.item_count), 0);
    }
    flow_view_make(&g, &good, &v);
    flow_run_step(&g, &v, BSP_CELLS_OFF, 1, &r);
    assert_int_equal(r.result, 0);
    flow_run_step(&g, &v, BSP_CELLS_HULL, 1, &r);
    assert_int_equal(r.result, 1);
    flow_run_free(&r);
    grid_free(&g);
}

static void eyes_anywhere_give_an_answer(void **state)
{
    uint64_t random = 8;
    grid_wish wish = plain;
    grid_cells g;
    flow_run r;
    uint32_t answers = 0;
    (void)state;
    wish.has_foreign = 1;
    grid_make(&wish, &g);
    flow_run_make(&g, &r);
    for (int i = 0; i < 20000; i++) {
        flow_aim a = aim_at(&g, &random);
        const double far_off = exp(random_between(&random, -5, 33));
        for (int k = 0; k < 3; k++) {
            if (random_below(&random, 3) == 0) a.eye[k] = g.places[k][random_below(&random, g.size[k] + 1)];
            if (random_below(&random, 9) == 0) a.eye[k] += random_between(&random, -far_off, far_off);
            if (random_below(&random, 3) == 0) a.forward[k] = 0;
        }
        if (a.forward[0] == 0 && a.forward[1] == 0 && a.forward[2] == 0) a.forward[i % 3] = 1;
        a.near_distance = random_below(&random, 5) ? 0.01 : 0;
        flow_view v;
        flow_view_make(&g, &a, &v);
        if (random_below(&random, 8) == 0) v.volume.plane_count = random_below(&random, 5);
        flow_run_step(&g, &v, ways[i % WAYS], 1, &r);
        answers += r.result == 1;
        assert_true(r.result == 0 || r.figures.cells_visited <= FLOW_TEST_VISITS * g.data.cell_count);
    }
    assert_true(answers > 5000);
    flow_run_free(&r);
    grid_free(&g);
}

static void each_way_draws_no_more_than_the_coarser(void **state)
{
    uint64_t random = 9;
    grid_cells g;
    flow_run r[WAYS];
    (void)state;
    grid_make(&plain, &g);
    for (int k = 0; k < WAYS; k++) flow_run_make(&g, &r[k]);
    for (int i = 0; i < 300; i++) {
        const flow_aim a = aim_at(&g, &random);
        flow_view v;
        flow_view_make(&g, &a, &v);
        for (int k = 0; k < WAYS; k++) flow_run_step(&g, &v, ways[k], 1, &r[k]);
        assert_true(is_within(r[1].drawn, r[0].drawn, g.item_count));
        assert_true(is_within(r[2].drawn, r[1].drawn, g.item_count));
    }
    for (int k = 0; k < WAYS; k++) flow_run_free(&r[k]);
    grid_free(&g);
}

// Left and right half of a picture, each of its own: together they draw all that the whole draws.
static void several_volumes_draw_what_each_of_them_draws(void **state)
{
    uint64_t random = 10;
    grid_cells g;
    flow_run whole, parts[2], both;
    (void)state;
    grid_make(&plain, &g);
    flow_run_make(&g, &whole);
    flow_run_make(&g, &both);
    for (int k = 0; k < 2; k++) flow_run_make(&g, &parts[k]);
    for (int i = 0; i < 200; i++) {
        const flow_aim a = aim_at(&g, &random);
        const bsp_cells how = ways[i % WAYS];
        flow_view v;
        cull_plane planes[2][5];
        cull_volume volumes[2];
        flow_view_make(&g, &a, &v);
        flow_run_step(&g, &v, how, 1, &whole);
        cull_guard guard = {.pixel_tangent = v.view.pixel_tangent, .reach = v.view.reach, .radius = (double)g.zone.radius};
        memcpy(guard.eye, v.view.eye_exact, sizeof guard.eye);
        memcpy(guard.forward, v.view.forward, sizeof guard.forward);
        for (int k = 0; k < 2; k++) {
            const double n[3] = {k ? -v.right[0] : v.right[0], k ? -v.right[1] : v.right[1], k ? -v.right[2] : v.right[2]};
            memcpy(planes[k], v.planes, 4 * sizeof *v.planes);
            planes[k][4] = cull_guard_plane(&guard, n, 0);
            volumes[k] = (cull_volume){planes[k], 5, 0};
            v.visit.volumes = &volumes[k];
            flow_run_step(&g, &v, how, 1, &parts[k]);
            if (how != BSP_CELLS_EXACT) assert_true(is_within(parts[k].drawn, whole.drawn, g.item_count)); // exact joins with a little to spare
        }
        v.visit.volumes = volumes;
        v.visit.volume_count = 2;
        flow_run_step(&g, &v, how, 1, &both);
        for (int k = 0; k < 2; k++) assert_true(is_within(parts[k].drawn, both.drawn, g.item_count));
        for (uint32_t k = 0; k < g.item_count && how == BSP_CELLS_EXACT; k++)
            if (both.drawn[k]) assert_true(parts[0].drawn[k] || parts[1].drawn[k]);
    }
    flow_run_free(&whole);
    flow_run_free(&both);
    for (int k = 0; k < 2; k++) flow_run_free(&parts[k]);
    grid_free(&g);
}

static void what_lies_in_the_scratch_does_not_matter(void **state)
{
    uint64_t random = 11;
    grid_cells g;
    flow_run r, again;
    (void)state;
    grid_make(&plain, &g);
    flow_run_make(&g, &r);
    flow_run_make(&g, &again);
    for (int i = 0; i < 60; i++) {
        const flow_aim a = aim_at(&g, &random);
        flow_view v;
        flow_view_make(&g, &a, &v);
        memset(r.scratch, i % 2 ? 0xff : 0x5a, bsp_flow_scratch(&g.data, ways[i % WAYS]));
        flow_run_step(&g, &v, ways[i % WAYS], 1, &r);
        memset(again.scratch, 0, bsp_flow_scratch(&g.data, ways[i % WAYS]));
        flow_run_step(&g, &v, ways[i % WAYS], 1, &again);
        assert_memory_equal(r.drawn, again.drawn, g.item_count);
        assert_memory_equal(&r.figures, &again.figures, sizeof r.figures);
    }
    flow_run_free(&r);
    flow_run_free(&again);
    grid_free(&g);
}

// The same block in other places and sizes: the guard grows with the distance to the origin, so a wall more may touch.
static void where_the_block_lies_and_its_size_hardly_matter(void **state)
{
    const double moves[][4] = {{0, 0, 0, 1}, {100, -50, 30, 1}, {-30, 70, -100, 1}, {0, 0, 0, 10}, {0, 0, 0, 0.05}, {3, 1, 2, 1}};
    uint32_t counts[6] = {0};
    (void)state;
    for (int pose = 0; pose < 6; pose++) {
        uint64_t random = 12;
        grid_wish wish = plain;
        grid_cells g;
        flow_run r;
        memcpy(wish.move, moves[pose], sizeof wish.move);
        wish.scale = moves[pose][3];
        grid_make(&wish, &g);
        flow_run_make(&g, &r);
        for (int i = 0; i < 200; i++) {
            flow_aim a = aim_at(&g, &random);
            flow_view v;
            a.near_distance = 0.02 * wish.scale;
            flow_view_make(&g, &a, &v);
            flow_run_step(&g, &v, BSP_CELLS_HULL, 1, &r);
            assert_int_equal(r.result, 1);
            counts[pose] += count_of(r.drawn, g.first_box);
        }
        flow_run_free(&r);
        grid_free(&g);
    }
    for (int pose = 1; pose < 6; pose++) assert_true(fabs((double)counts[pose] - counts[0]) < 0.03 * counts[0]);
}

// 13,824 rooms without an inner wall: more windows wait than the arena holds.
static void a_full_arena_draws_more_and_tells_it(void **state)
{
    const grid_wish wish = {.size = {24, 24, 24}, .seed = 1, .open = 1, .scale = 1};
    const flow_aim aim = {{0.5, 0.5, 0.5}, {1, 1, 1}, {1, 1}, 0.01};
    uint64_t random = 13;
    grid_cells g;
    flow_run r;
    flow_view v;
    (void)state;
    grid_make(&wish, &g);
    flow_run_make(&g, &r);
    flow_view_make(&g, &aim, &v);
    flow_run_step(&g, &v, BSP_CELLS_HULL, 1, &r);
    assert_true(r.figures.limits_hit > 0);
    for (int i = 0; i < 20000; i++) {
        grid_trace t;
        double way[3];
        flow_view_ray(&g, &v, random_between(&random, -1, 1), random_between(&random, -1, 1), way);
        if (grid_trace_ray(&g, v.eye_unposed, way, 1e-9, &t)) assert_true(r.drawn[t.hit]);
    }
    flow_run_free(&r);
    grid_free(&g);
}

static void backs_are_drawn_where_they_show(void **state)
{
    uint64_t random = 14;
    grid_wish wish = plain;
    grid_cells g;
    flow_run fronts, all, two_sided;
    uint32_t more = 0;
    (void)state;
    wish.one_way = 0.4;
    grid_make(&wish, &g);
    flow_run_make(&g, &fronts);
    flow_run_make(&g, &all);
    flow_run_make(&g, &two_sided);
    for (int i = 0; i < 100; i++) {
        const flow_aim a = aim_at(&g, &random);
        flow_view v;
        flow_view_make(&g, &a, &v);
        flow_run_step(&g, &v, BSP_CELLS_HULL, 1, &fronts);
        flow_run_step(&g, &v, BSP_CELLS_HULL, 0, &all);
        assert_true(is_within(fronts.drawn, all.drawn, g.item_count));
        more += count_of(all.drawn, g.item_count) - count_of(fronts.drawn, g.item_count);
    }
    assert_true(more > 20);
    for (uint32_t i = 0; i < g.item_count; i++) g.items[i].flags |= CULL_ITEM_TWO_SIDED;
    bsp_flow_free(grid_host(), &g.index);
    assert_int_equal(bsp_flow_build(grid_host(), &g.zone, NULL, &g.data, &g.index), CULL_OK);
    random = 14;
    for (int i = 0; i < 100; i++) { // of two-sided walls backface leaves out none
        const flow_aim a = aim_at(&g, &random);
        flow_view v;
        flow_view_make(&g, &a, &v);
        flow_run_step(&g, &v, BSP_CELLS_HULL, 0, &all);
        flow_run_step(&g, &v, BSP_CELLS_HULL, 1, &two_sided);
        assert_memory_equal(all.drawn, two_sided.drawn, g.item_count);
    }
    flow_run_free(&fronts);
    flow_run_free(&all);
    flow_run_free(&two_sided);
    grid_free(&g);
}

// One triangle for all of them, in the plane or rising out of it by a hundredth.
static uint32_t items_left_out(grid_cells *g, float rise)
{
    const cull_vec3 positions[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, rise}};
    const uint32_t corners[3] = {0, 1, 2};
    const cull_plane plane = {{0, 0, 1}, 0};
    cull_wall *walls = calloc(g->item_count, sizeof *walls);
    uint64_t random = 14;
    uint32_t out = 0;
    flow_run with, without;
    assert_non_null(walls);
    for (uint32_t i = 0; i < g->item_count; i++) {
        walls[i].vertex_count = g->items[i].index_count = 3;
        g->items[i].first_index = 0;
    }
    g->zone.positions = positions, g->zone.indices = g->zone.wall_vertices = corners, g->zone.planes = &plane, g->zone.walls = walls;
    bsp_flow_free(grid_host(), &g->index);
    assert_int_equal(bsp_flow_build(grid_host(), &g->zone, NULL, &g->data, &g->index), CULL_OK);
    flow_run_make(g, &with);
    flow_run_make(g, &without);
    for (int i = 0; i < 100; i++) {
        const flow_aim a = aim_at(g, &random);
        flow_view v;
        flow_view_make(g, &a, &v);
        flow_run_step(g, &v, BSP_CELLS_EXACT, 0, &without);
        flow_run_step(g, &v, BSP_CELLS_EXACT, 1, &with);
        out += count_of(without.drawn, g->item_count) - count_of(with.drawn, g->item_count);
    }
    flow_run_free(&with);
    flow_run_free(&without);
    free(walls);
    return out;
}

// A sliver's triangle, its corners rounded, lost a pixel to an eye 4 cm behind the wall's plane.
static void walls_whose_triangles_rise_out_of_their_plane_are_left_out_by_no_plane(void **state)
{
    grid_wish wish = plain;
    grid_cells g;
    (void)state;
    wish.one_way = 0.4;
    grid_make(&wish, &g);
    assert_true(items_left_out(&g, 0) > 20);
    assert_int_equal(items_left_out(&g, 0.01f), 0);
    grid_free(&g);
}

// ---- The guard ----

// An eye in the first of two rooms from which the far wall's end lies hidden behind the door's post by `hidden` tangents of a picture
// along x. 0: the door stands so that there is none.
static int eye_beside_post(const grid_cells *g, double hidden, uint64_t *random, double eye[3])
{
    const grid_face *f = &g->faces[0][1];
    const double p1 = g->places[0][1], p2 = g->places[0][2], q = g->places[2][1], post = f->door[2]; // doors are told along y, then z
    const double x = random_between(random, 0.2 * p1, 0.8 * p1), near_by = 1 / (p1 - x), far_by = 1 / (p2 - x);
    const double z = (post * near_by - q * far_by - hidden) / (near_by - far_by); // (post - z) near_by - (q - z) far_by = hidden
    eye[0] = x;
    eye[1] = (f->door[0] + f->door[1]) / 2;
    eye[2] = z;
    return post > 0 && z > 0.05 && z < post - 0.05 && (post - z) * near_by < 0.9 && p1 - x > 0.5; // in the picture
}

static void a_door_lets_pass_what_lies_within_the_guard_beside_it_and_little_more(void **state)
{
    uint64_t random = 15;
    uint32_t seen = 0, hidden = 0;
    (void)state;
    for (uint64_t seed = 1; seed < 200; seed++) {
        const grid_wish wish = {.size = {2, 1, 1}, .seed = seed, .scale = 1, .turn = {0.3 * (double)seed, 0.1, 0.2}};
        grid_cells g;
        flow_run r;
        flow_view v;
        grid_make(&wish, &g);
        flow_run_make(&g, &r);
        const uint32_t wall = g.faces[0][2].items[1][0];
        for (int k = 0; k < 12; k++) {
            flow_aim a = {.forward = {1, 0, 0}, .tangents = {1, 1}, .near_distance = 0.001};
            const double guard = CULL_GUARD_PX * (2.0 / 720), by = k % 2 ? 0.7 * guard : 3 * guard;
            if (!eye_beside_post(&g, by, &random, a.eye)) continue;
            flow_view_make(&g, &a, &v);
            flow_run_step(&g, &v, ways[k / 2 % WAYS], 1, &r);
            assert_int_equal(r.result, 1);
            if (k % 2) assert_true(r.drawn[wall]);
            else if (k / 2 % WAYS) assert_false(r.drawn[wall]); // a rectangle holds more
            seen += k % 2 ? 1u : 0u;
            hidden += k % 2 ? 0u : 1u;
        }
        flow_run_free(&r);
        grid_free(&g);
    }
    assert_true(seen > 50 && hidden > 50);
}

// ---- Memory ----

typedef struct scarce { uint32_t calls, fail_at, live; } scarce;

static void *scarce_alloc(const cull_host *host, size_t size, size_t align)
{
    scarce *s = host->user;
    (void)align;
    if (++s->calls == s->fail_at) return NULL;
    s->live++;
    return aligned_alloc(64, (size + 63) / 64 * 64);
}

static void scarce_free(const cull_host *host, void *memory, size_t size)
{
    scarce *s = host->user;
    (void)size;
    s->live--;
    free(memory);
}

static void memory_that_runs_out_leaves_nothing(void **state)
{
    grid_cells g;
    scarce s = {.fail_at = 0};
    const cull_host host = {.abi = CULL_ABI, .user = &s, .alloc = scarce_alloc, .free = scarce_free};
    bsp_flow_index index;
    (void)state;
    grid_make(&plain, &g);
    assert_int_equal(bsp_flow_build(&host, &g.zone, NULL, &g.data, &index), CULL_OK);
    assert_true(bsp_flow_bytes(&index) > 0 && s.live > 0);
    const uint32_t calls = s.calls;
    bsp_flow_free(&host, &index);
    assert_int_equal(s.live, 0);
    for (uint32_t i = 1; i <= calls; i++) {
        s = (scarce){.fail_at = i};
        assert_int_equal(bsp_flow_build(&host, &g.zone, NULL, &g.data, &index), CULL_ERR_MEMORY);
        assert_int_equal(s.live, 0);
        bsp_flow_free(&host, &index); // of zeros
        assert_int_equal(bsp_flow_bytes(&index), 0);
    }
    grid_free(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_without_an_eye_at_a_point_in_the_cells_are_left_to_the_walk),
        cmocka_unit_test(eyes_anywhere_give_an_answer),
        cmocka_unit_test(each_way_draws_no_more_than_the_coarser),
        cmocka_unit_test(several_volumes_draw_what_each_of_them_draws),
        cmocka_unit_test(what_lies_in_the_scratch_does_not_matter),
        cmocka_unit_test(where_the_block_lies_and_its_size_hardly_matter),
        cmocka_unit_test(a_full_arena_draws_more_and_tells_it),
        cmocka_unit_test(backs_are_drawn_where_they_show),
        cmocka_unit_test(walls_whose_triangles_rise_out_of_their_plane_are_left_out_by_no_plane),
        cmocka_unit_test(a_door_lets_pass_what_lies_within_the_guard_beside_it_and_little_more),
        cmocka_unit_test(memory_that_runs_out_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
