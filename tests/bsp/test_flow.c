// The flow through cells against rays that walk from room to room: what a ray meets first is drawn, and little else.
// SPDX-License-Identifier: MIT
#include "flow_views.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const bsp_cells ways[] = {BSP_CELLS_RECT, BSP_CELLS_HULL, BSP_CELLS_EXACT};
enum { WAYS = 3 };

static grid_wish wish_of(uint64_t seed)
{
    uint64_t random = seed;
    grid_wish w = {.seed = seed, .open = random_between(&random, 0.2, 0.6), .shut = random_between(&random, 0, 0.3), .one_way = 0.05, .scale = 1};
    for (int k = 0; k < 3; k++) w.size[k] = 2 + random_below(&random, 7);
    if (seed % 2) // turned and moved: no plane along an axis
        for (int k = 0; k < 3; k++) {
            w.turn[k] = random_between(&random, -3, 3);
            w.move[k] = random_between(&random, -20, 20);
        }
    return w;
}

static flow_aim aim_of(const grid_cells *g, uint64_t *random)
{
    static const double spans[4][2] = {{1.03, 0.58}, {1, 1}, {0.3, 0.2}, {3, 2}}; // a picture, a cube face, a narrow one, a wide one
    flow_aim a = {.near_distance = 0.001};
    double square = 0;
    for (int k = 0; k < 3; k++) {
        a.eye[k] = random_between(random, g->places[k][0] + 0.01, g->places[k][g->size[k]] - 0.01);
        a.forward[k] = random_between(random, -1, 1);
        square += a.forward[k] * a.forward[k];
    }
    if (square < 0.01) a.forward[0] = 1;
    if (random_below(random, 4) == 0) { // along an axis
        a.forward[0] = a.forward[1] = a.forward[2] = 0;
        a.forward[random_below(random, 3)] = random_bits(random) & 1 ? 1 : -1;
    }
    memcpy(a.tangents, spans[random_below(random, 4)], sizeof a.tangents);
    return a;
}

typedef struct oracle { uint8_t *hit; uint32_t rays, certain; } oracle;

// Casts rays; each item first hit, each box met and (backface 0) each back passed must be drawn.
static void rays_check(const grid_cells *g, const flow_view *v, const uint8_t *drawn, uint32_t backface, uint64_t seed, uint32_t count, oracle *o)
{
    for (uint32_t i = 0; i < count; i++) {
        grid_trace t;
        double way[3];
        const double u = random_between(&seed, -1, 1), w = random_between(&seed, -1, 1);
        flow_view_ray(g, v, u, w, way);
        o->rays++;
        const int certain = grid_trace_ray(g, v->eye_unposed, way, 1e-9, &t);
        if (!certain) continue;
        o->certain++;
        o->hit[t.hit] = 1;
        if (!drawn[t.hit]) fail_msg("ray %u (%.17g, %.17g): item %u is not drawn, after %u rooms", i, u, w, t.hit, t.room_count);
        for (uint32_t k = 0; k < t.seen_count && !backface; k++) {
            o->hit[t.seen[k]] = 1;
            if (!drawn[t.seen[k]]) fail_msg("ray %u: the back of item %u is not drawn", i, t.seen[k]);
        }
    }
}

static uint32_t count_of(const uint8_t *bytes, uint32_t first, uint32_t count)
{
    uint32_t sum = 0;
    for (uint32_t i = first; i < count; i++) sum += bytes[i];
    return sum;
}

typedef enum eye_place { EYE_ANYWHERE, EYE_ON_PLANES, EYE_BESIDE_PLANES, EYE_IN_FOREIGN } eye_place;

static void eye_put(const grid_cells *g, eye_place place, uint64_t *random, double eye[3])
{
    const uint32_t which = 1 + random_below(random, 7); // a plane, an edge or a corner
    if (place == EYE_IN_FOREIGN) {
        const uint32_t room[3] = {g->foreign % g->size[0], g->foreign / g->size[0] % g->size[1], g->foreign / g->size[0] / g->size[1]};
        for (int k = 0; k < 3; k++) eye[k] = random_between(random, g->places[k][room[k]] + 0.01, g->places[k][room[k] + 1] - 0.01);
        return;
    }
    for (int k = 0; k < 3 && place != EYE_ANYWHERE; k++) {
        if (!(which >> k & 1) || g->size[k] < 2) continue;
        eye[k] = g->places[k][1 + random_below(random, g->size[k] - 1)];
        const uint32_t steps = place == EYE_BESIDE_PLANES ? random_below(random, 5) : 0;
        const double to = random_bits(random) & 1 ? 1e9 : -1e9;
        for (uint32_t i = 0; i < steps; i++) eye[k] = nextafter(eye[k], to);
    }
}

static void grids_check(eye_place place, uint32_t has_foreign, uint32_t views, uint32_t rays)
{
    const uint32_t grids = 30;
    uint32_t drawn[WAYS] = {0}, hits = 0, certain = 0, cells = 0, limits = 0;
    for (uint32_t n = 0; n < grids; n++) {
        grid_wish wish = wish_of(n + 1);
        wish.has_foreign = has_foreign;
        grid_cells g;
        flow_run r;
        uint64_t random = 77 + n;
        grid_make(&wish, &g);
        flow_run_make(&g, &r);
        uint8_t *hit = test_malloc(g.item_count);
        for (uint32_t i = 0; i < views; i++) {
            flow_aim aim = aim_of(&g, &random);
            eye_put(&g, place, &random, aim.eye);
            flow_view v;
            flow_view_make(&g, &aim, &v);
            oracle o = {.hit = hit};
            const uint32_t backface = i % 2;
            memset(hit, 0, g.item_count);
            for (int k = 0; k < WAYS; k++) {
                flow_run_step(&g, &v, ways[k], backface, &r);
                assert_int_equal(r.result, 1);
                rays_check(&g, &v, r.drawn, backface, random + 5, rays, &o);
                drawn[k] += count_of(r.drawn, 0, g.first_box);
                limits += r.figures.limits_hit;
                if (k == 1) cells += r.figures.cells_visited;
            }
            certain += o.certain;
            hits += count_of(hit, 0, g.first_box);
        }
        test_free(hit);
        flow_run_free(&r);
        grid_free(&g);
    }
    printf("hit %u, drawn rect %u hull %u exact %u; certain rays %u; cells a view %.1f, limits %u\n", hits, drawn[0], drawn[1], drawn[2], certain,
           cells / (double)(grids * views), limits);
    assert_true(certain > grids * views * rays);
    assert_true(drawn[2] <= drawn[1] && drawn[1] <= drawn[0] && hits <= drawn[2]);
}

static void what_rays_meet_is_drawn(void **state)
{
    (void)state;
    grids_check(EYE_ANYWHERE, 0, 10, 2000);
}

static void what_rays_meet_from_planes_edges_and_corners_is_drawn(void **state)
{
    (void)state;
    grids_check(EYE_ON_PLANES, 0, 10, 1000);
}

static void what_rays_meet_within_four_ulp_of_planes_is_drawn(void **state)
{
    (void)state;
    grids_check(EYE_BESIDE_PLANES, 0, 10, 1000);
}

static void what_rays_meet_beyond_another_zone_is_drawn(void **state)
{
    (void)state;
    grids_check(EYE_ANYWHERE, 1, 20, 2000);
    grids_check(EYE_ON_PLANES, 1, 10, 1000);
}

static void what_rays_meet_from_another_zone_is_drawn(void **state)
{
    (void)state;
    grids_check(EYE_IN_FOREIGN, 1, 20, 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_rays_meet_is_drawn),
        cmocka_unit_test(what_rays_meet_from_planes_edges_and_corners_is_drawn),
        cmocka_unit_test(what_rays_meet_within_four_ulp_of_planes_is_drawn),
        cmocka_unit_test(what_rays_meet_beyond_another_zone_is_drawn),
        cmocka_unit_test(what_rays_meet_from_another_zone_is_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
