// A zone that tells what of a volume gets to its portals, part by part: what is reached then, and what nonsense leads to.
// SPDX-License-Identifier: MIT
#include "tests/flow/fixture.h"
#include "tests/flow/oracle.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <portcullis/plane.h>

#include <math.h>
#include <string.h>

typedef enum telling {
    TELL_ALL,     // SAME
    TELL_WHOLE,   // one part: the volume itself
    TELL_THREE,
    TELL_SIXTEEN, // as many as there may be
    TELL_HALF_THEN_ALL,
    TELL_FAITHFUL, // these and above lose nothing
    TELL_ENDLESS = TELL_FAITHFUL,
    TELL_NAN,
    TELL_NO_NORMAL,
    TELL_MANY_PLANES,
    TELL_ODD,
    TELL_NONE_AT_ONE, // nothing gets to one portal
    TELLINGS
} telling;

typedef struct teller {
    flow_crosser inner;
    telling how;
    uint32_t zone, portal; // of TELL_NONE_AT_ONE
    uint32_t asked, most_part;
} teller;

static cull_crossing cross(void *user, uint32_t zone, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes,
                           uint32_t *plane_count)
{
    const teller *t = user;
    return t->inner.cross(t->inner.user, zone, view, in, portal, planes, plane_count);
}

// An upright strip of the picture, from edge i to edge i + 1 of `count`; its outer edges stand nowhere.
static cull_crossing strip(const flow_sight *q, uint32_t count, cull_plane *planes, uint32_t *plane_count)
{
    const cull_view *v = q->view;
    cull_guard guard = {.pixel_tangent = v->pixel_tangent, .reach = v->reach, .radius = 1000};
    double right[3] = {-v->forward[2], 0, v->forward[0]}, size = sqrt(right[0] * right[0] + right[2] * right[2]);
    memcpy(guard.eye, v->eye_exact, sizeof guard.eye);
    memcpy(guard.forward, v->forward, sizeof guard.forward);
    if (q->part >= count) return CULL_CROSS_NONE;
    if (q->in->plane_count + 2 > CULL_MAX_PLANES || !(size > 0.01)) return q->part ? CULL_CROSS_NONE : CULL_CROSS_SAME;
    memcpy(planes, q->in->planes, q->in->plane_count * sizeof *planes);
    *plane_count = q->in->plane_count;
    for (uint32_t side = 0; side < 2; side++) {
        const uint32_t edge = q->part + side;
        const double sign = side ? -1 : 1, tangent = -1.2 + 2.4 * edge / count, inverse = sign / sqrt(1 + tangent * tangent);
        double n[3];
        if (edge == 0 || edge == count) continue;
        for (int k = 0; k < 3; k++) n[k] = (right[k] / size - tangent * v->forward[k]) * inverse;
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int k = 0; k < 3; k++) n[k] /= length;
        planes[(*plane_count)++] = cull_guard_plane(&guard, n, 0);
    }
    return CULL_CROSS_NARROW;
}

static cull_crossing sight(void *user, const flow_sight *q, cull_plane *planes, uint32_t *plane_count)
{
    teller *t = user;
    t->asked++;
    t->most_part = q->part > t->most_part ? q->part : t->most_part;
    planes[0] = (cull_plane){{1, 0, 0}, t->how == TELL_NAN ? NAN : -1e30f}; // nothing is inside
    *plane_count = t->how == TELL_MANY_PLANES ? CULL_MAX_PLANES + 1 : 1;
    switch (t->how) {
    case TELL_ALL: return CULL_CROSS_SAME;
    case TELL_WHOLE: return strip(q, 1, planes, plane_count);
    case TELL_THREE: return strip(q, 3, planes, plane_count);
    case TELL_SIXTEEN: return strip(q, CULL_MAX_PARTS, planes, plane_count);
    case TELL_HALF_THEN_ALL: return q->part ? CULL_CROSS_SAME : strip(q, 2, planes, plane_count);
    case TELL_ODD: return 17;
    case TELL_NO_NORMAL: planes[0].normal.x = 0; return CULL_CROSS_NARROW;
    case TELL_NONE_AT_ONE: return q->zone == t->zone && q->portal == t->portal ? CULL_CROSS_NONE : CULL_CROSS_SAME;
    default: return CULL_CROSS_NARROW;
    }
}

static void run(maze *m, const camera *c, teller *t, telling how, flow_result *out)
{
    t->inner = maze_crosser(m, CROSSER_NARROW);
    t->how = how;
    t->asked = t->most_part = 0;
    const flow_request q = {.camera = c, .frame = {320, 240, 0, 0, CULL_VIEW_MAIN}, .open = m->open, .crosser = {t, cross, sight, NULL}};
    flow_run(m->flow, &q, out);
}

enum { WIDE = 5, DEEP = 4 };

static camera look(const maze *m, uint64_t *seed)
{
    const double eye[3] = {random_between(seed, 0.1, 4.0 * WIDE - 0.1), random_between(seed, 0.2, 2.8), random_between(seed, 0.1, 4.0 * DEEP - 0.1)};
    const double forward[3] = {random_between(seed, -1, 1), random_between(seed, -0.2, 0.2), random_between(seed, 0.1, 1)};
    return maze_camera(m, eye, forward, random_between(seed, 40, 90));
}

static void grid_of(maze *m, uint64_t seed)
{
    maze_grid(m, &(grid_recipe){.wide = WIDE, .deep = DEEP, .doors = seed % 2 ? DOORS_RANDOM : DOORS_WHOLE_FACE, .seed = seed, .pose = POSE_NONE});
}

// Numbers alone: planes live until the next run.
typedef struct gist { uint32_t zones[WIDE * DEEP + 1], zone_count, volumes, crossings, merges, limits; } gist;

static gist gist_of(const flow_result *r)
{
    gist g = {.zone_count = r->zone_count, .volumes = r->volume_count, .crossings = r->crossings, .merges = r->portal_merges, .limits = r->limits_hit};
    for (uint32_t i = 0; i < r->zone_count; i++) g.zones[i] = r->zones[i].zone;
    return g;
}

static int reaches_all_of(const gist *more, const gist *fewer)
{
    for (uint32_t i = 0; i < fewer->zone_count; i++) {
        uint32_t k = 0;
        while (k < more->zone_count && more->zones[k] != fewer->zones[i]) k++;
        if (k == more->zone_count) return 0;
    }
    return 1;
}

// plain: without sight.
static void expect_fits(const teller *t, const gist *g, const gist *plain)
{
    if (t->how == TELL_ALL || t->how == TELL_WHOLE) assert_memory_equal(g, plain, sizeof *g);
    assert_in_range(t->most_part, 0, CULL_MAX_PARTS); // one more than there may be, to hear that it is none
    if (t->how < TELL_FAITHFUL) assert_int_equal(g->limits, plain->limits);
    else if (t->asked) assert_true(g->limits > plain->limits);
    if (t->how >= TELL_FAITHFUL || t->how == TELL_HALF_THEN_ALL) assert_true(reaches_all_of(g, plain));
    assert_true(t->how >= TELL_FAITHFUL || reaches_all_of(plain, g));
}

static void whatever_the_parts_no_ray_is_lost_and_nonsense_passes_all(void **state)
{
    (void)state;
    uint64_t random = 3, behind = 0;
    uint32_t asked[TELLINGS] = {0}, most_part = 0;
    for (uint64_t n = 0; n < 6; n++) {
        maze m;
        grid_of(&m, n);
        for (uint32_t i = 0; i < 12; i++) {
            const camera c = look(&m, &random);
            flow_result r;
            maze_run(&m, &c, CROSSER_NARROW, &r);
            const gist plain = gist_of(&r);
            for (int how = TELL_ALL; how < TELL_NONE_AT_ONE; how++) {
                teller t = {0};
                run(&m, &c, &t, (telling)how, &r);
                const gist g = gist_of(&r);
                asked[how] += t.asked;
                if (how == TELL_SIXTEEN && t.most_part > most_part) most_part = t.most_part;
                expect_fits(&t, &g, &plain);
                const oracle_answer a = oracle_ask(&(oracle_request){m.scene, m.open, &c, &r, 200, random + 1});
                if (a.missed) fail_msg("telling %d: %llu points missed, first in zone %u", how, (unsigned long long)a.missed, a.zone);
                behind += a.behind;
            }
        }
        maze_close(&m);
    }
    for (int how = TELL_ALL; how < TELL_NONE_AT_ONE; how++) assert_true(asked[how] > 50);
    assert_true(behind > 1000);
    assert_int_equal(most_part, CULL_MAX_PARTS);
}

// A corridor of five rooms in a row, seen along.
static void what_gets_to_no_part_of_a_portal_is_not_reached_behind_it(void **state)
{
    (void)state;
    maze m;
    flow_result r;
    maze_begin(&m, &POSE_NONE);
    for (uint32_t i = 0; i < 5; i++) {
        const double low[3] = {0, 0, 4.0 * i}, high[3] = {4, 3, 4.0 * i + 4}, middle[3] = {2, 1, 4.0 * i + 2};
        assert_int_equal(maze_box(&m, low, high, SCENE_NONE), i);
        maze_piece(&m, middle);
    }
    for (uint32_t i = 0; i + 1 < 5; i++) (void)maze_opening(&m, i, i + 1, &(opening){2, 4.0 * i + 4, {1, 0.5}, {3, 2.5}});
    maze_end(&m);
    const double eye[3] = {2, 1.5, 2}, forward[3] = {0, 0, 1};
    const camera c = maze_camera(&m, eye, forward, 60);
    const flow_request q = {.camera = &c, .frame = {320, 240, 0, 0, CULL_VIEW_MAIN}, .open = m.open};
    for (uint32_t last = 0; last < 4; last++) {
        teller t = {.zone = last, .portal = last ? 1 : 0}; // the way on
        run(&m, &c, &t, TELL_NONE_AT_ONE, &r);
        for (uint32_t zone = 0; zone < 5; zone++) assert_int_equal(maze_find(&r, zone) != NULL, zone <= last);
        assert_int_equal(flow_fate_of(m.flow, &q, 2 * last), FLOW_OUTSIDE);
        assert_int_equal(r.limits_hit, 0);
        if (last > 0) assert_int_equal(flow_fate_of(m.flow, &q, 2 * last - 2), FLOW_CROSSED);
    }
    maze_close(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whatever_the_parts_no_ray_is_lost_and_nonsense_passes_all),
        cmocka_unit_test(what_gets_to_no_part_of_a_portal_is_not_reached_behind_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
