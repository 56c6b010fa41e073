// What a ray from an eye meets first is drawn: 64 rays an eye, half of the eyes within 4 ulps of portals' planes, edges and corners, against an
// oracle that knows nothing of zones; no plane of a volume is NaN, no frame allocates. A part of the eyes is looked at by pictures too.
// SPDX-License-Identifier: MIT
// A ray is judged from RAYS_START_M on, where that place is in the air (in a zone's hull, in no solid, and not behind the first face that it
// meets of what stands still; and in a map, which is closed, it meets some): an eye on a portal's corner is on a wall, and what it would see from
// within is nothing, but for doors that move in the wall. What grazes (see test_rays_oracle.h) is left out and counted.
#include "eyes.h"
#include "maps.h"
#include "test_rays_oracle.h"

#include "bench/bench.h"
#include "bench/generate.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RAYS = 64, LOST_SHOWN = 3, WIDTH = 640, HEIGHT = 360, PICTURE_TRIES = 64, EYE_TRIES = 256 };
static const double AIR_MARGIN_M = 1.0 / 16384; // of the place that a ray is judged from: well over the rounding of positions
static const double PICTURE_ROOM_M = 0.125;     // the near plane's corner is 0.13 m from the eye at most

static const char *const chains[] = {
    "frustum+portal",
    "frustum[backface=1]+portal",
    "frustum[backface=1]+portal[clip=octagon]",
    "frustum[backface=1]+portal[clip=rect]",
    "frustum[backface=1]+portal[clip=planes]",
    "frustum[backface=1]+portal[clip=flood]",
#if HAS_BSP
    "bsp+portal",
    "bsp[backface=1]+portal",
    "bsp[backface=1,cells=rect]+portal",
    "bsp[backface=1,cells=hull]+portal",
    "bsp[backface=1,cells=exact]+portal",
#endif
};
enum { CHAINS = sizeof chains / sizeof *chains };

typedef struct watcher { // a chain, and what it draws of the eye at hand
    const char *chain;
    world *world;
    world_view *view;
    uint32_t **order; // by zone: global ids
    uint32_t *drawn;  // by global id: the number of the eye that it was last drawn for
    uint32_t sides;
    uint64_t lost, lost_of_kind[EYE_KINDS], faults, bad_planes;
} watcher;

typedef struct tally {
    uint64_t eyes[EYE_KINDS], in_void, nowhere, rays, judged, grazing, outside, nearer, escaping, veils;
} tally;

typedef struct sight {
    stage *stage;
    eyes eyes;
    ray_oracle *oracle;
    watcher watchers[CHAINS];
    tally tally;
    camera camera;
    ray rays[RAYS];
    ray_hit hits[RAYS][RAYS_SIDES];
    eye_kind kind;
    uint32_t outside; // rays of the eye that start in no air
    uint32_t number;  // of the eye, from 1
} sight;

// ---- Worlds ----

static void watcher_open(sight *x, watcher *w, const char *chain)
{
    const scene *s = x->stage->scene;
    const world_request q = {.scene = s, .plugins = x->stage->plugins, .services = &x->stage->services, .chain = stage_chain(x->stage, chain)};
    *w = (watcher){.chain = chain, .sides = strstr(chain, "backface=1") ? RAYS_FRONTS : RAYS_BOTH_SIDES};
    if (world_open(&q, &x->stage->lines.report, &w->world) != RESULT_OK) fail_msg("%s: %s", chain, report_lines_only(&x->stage->lines));
    for (uint32_t d = 0; d < s->door_count; ++d) world_set_door(w->world, d, DOORS_OPEN);
    assert_int_equal(world_view_open(w->world, VIEWER_CHECK_ALL, &x->stage->lines.report, &w->view), RESULT_OK);
    w->order = calloc(s->zone_count, sizeof *w->order);
    w->drawn = calloc(s->item_count + s->mover_count, sizeof *w->drawn);
    assert_true(w->order && w->drawn);
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        if (!world_chain(w->world, z)) continue;
        w->order[z] = calloc(world_zone(w->world, z)->zone.item_count + 1, sizeof **w->order);
        assert_non_null(w->order[z]);
        world_order(w->world, z, w->order[z]);
    }
}

static void watcher_close(sight *x, watcher *w)
{
    for (uint32_t z = 0; z < x->stage->scene->zone_count; ++z) free(w->order[z]);
    free(w->order);
    free(w->drawn);
    world_view_close(w->view);
    world_close(w->world);
}

static int plane_is_sound(cull_plane p)
{
    const double length = sqrt((double)p.normal.x * p.normal.x + (double)p.normal.y * p.normal.y + (double)p.normal.z * p.normal.z);
    return fabs(length - 1) < 1e-3 && isfinite(p.offset);
}

static void check_volumes(watcher *w, const flow_result *flow)
{
    for (uint32_t v = 0; v < flow->volume_count; ++v)
        for (uint32_t i = 0; i < flow->volumes[v].volume.plane_count; ++i) w->bad_planes += !plane_is_sound(flow->volumes[v].volume.planes[i]);
}

static void watcher_look(sight *x, watcher *w)
{
    const scene *s = x->stage->scene;
    const frame_input q = stage_input(&x->camera, x->number);
    visible_set set;
    frame_stats stats = {0};
    world_cull(w->view, &q, &set, &stats);
    w->faults += stats.faults;
    check_volumes(w, world_view_flow(w->view));
    for (uint32_t i = 0; i < set.zone_count; ++i)
        for (uint32_t k = 0; k < set.zones[i].run_count; ++k) {
            const cull_run run = set.zones[i].runs[k];
            for (uint32_t p = run.first; p < run.first + run.count; ++p) w->drawn[w->order[set.zones[i].zone][p]] = x->number;
        }
    for (uint32_t i = 0; i < set.mover_count; ++i)
        if (set.movers[i] < s->mover_count) w->drawn[s->item_count + set.movers[i]] = x->number;
}

// ---- Rays ----

typedef struct picture {
    double right[3], up[3], back[3], tall, wide;
} picture;

static picture picture_of(const camera *c)
{
    picture p;
    camera_axes(c, p.right, p.up, p.back);
    p.tall = tan(c->fovy_deg * (3.14159265358979323846 / 360));
    p.wide = p.tall * c->aspect;
    return p;
}

static double along(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// 0: it lies outside of the picture.
static int ray_towards(const sight *x, const picture *p, const double target[3], ray *out)
{
    double way[3], length = 0;
    for (int k = 0; k < 3; ++k) {
        way[k] = target[k] - x->camera.eye[k];
        length += way[k] * way[k];
    }
    const double depth = -along(way, p->back);
    if (!(depth > 0) || fabs(along(way, p->right)) >= p->wide * depth || fabs(along(way, p->up)) >= p->tall * depth) return 0;
    for (int k = 0; k < 3; ++k) {
        out->from[k] = x->camera.eye[k];
        out->along[k] = way[k] / sqrt(length);
    }
    return 1;
}

static void ray_anywhere(sight *x, const picture *p, ray *out)
{
    const double u = random_between(&x->eyes.random, -p->wide, p->wide), v = random_between(&x->eyes.random, -p->tall, p->tall);
    double target[3];
    for (int k = 0; k < 3; ++k) target[k] = x->camera.eye[k] + u * p->right[k] + v * p->up[k] - p->back[k];
    if (!ray_towards(x, p, target, out)) ray_anywhere(x, p, out); // on the picture's edge
}

// A quarter by portals' edges, a quarter at items, the rest anywhere.
static void rays_make(sight *x)
{
    const picture p = picture_of(&x->camera);
    for (uint32_t i = 0; i < RAYS; ++i) {
        double target[3];
        if (i % 4 == 0) eyes_portal_target(&x->eyes, target);
        if (i % 4 == 1) eyes_item_target(&x->eyes, target);
        if (i % 4 > 1 || !ray_towards(x, &p, target, &x->rays[i])) ray_anywhere(x, &p, &x->rays[i]);
    }
}

static int starts_in_air(const sight *x, const ray *r, eye_kind kind)
{
    double start[3];
    for (int k = 0; k < 3; ++k) start[k] = r->from[k] + RAYS_START_M * r->along[k];
    return kind == EYE_IN_AIR || eyes_is_air(&x->eyes, start, AIR_MARGIN_M);
}

// Of the eye: 1 where a ray meets a back first, or, in a map, nothing. Then it stands in the void between brushes.
static int rays_cast(sight *x, eye_kind kind)
{
    int is_void = 0;
    x->outside = 0;
    for (uint32_t i = 0; i < RAYS; ++i) {
        int is_good = starts_in_air(x, &x->rays[i], kind);
        if (is_good) ray_oracle_cast(x->oracle, &x->rays[i], x->hits[i]);
        const ray_hit *fixed = &x->hits[i][RAYS_FIXED];
        is_good = is_good && !fixed->enters && !(fixed->end != RAY_ESCAPES && fixed->is_back);
        is_good = is_good && !(x->stage->scene->solid_count && fixed->end == RAY_ESCAPES);
        is_void |= !is_good;
        if (is_void && kind == EYE_IN_AIR) return 1;
        if (is_good) continue;
        x->outside++;
        for (int s = 0; s < RAYS_SIDES; ++s) x->hits[i][s] = (ray_hit){.end = RAY_ESCAPES, .veil = SCENE_NONE};
    }
    return is_void;
}

static void rays_count(sight *x)
{
    const picture p = picture_of(&x->camera);
    for (uint32_t i = 0; i < RAYS; ++i)
        for (int s = 0; s < RAYS_SIDES; ++s) {
            ray_hit *h = &x->hits[i][s];
            const int is_nearer = h->end == RAY_HITS && -h->distance * along(x->rays[i].along, p.back) <= x->camera.near_m;
            if (is_nearer) h->end = RAY_ESCAPES; // no picture holds it
            if (s != RAYS_FRONTS) continue;
            x->tally.nearer += (uint64_t)is_nearer;
            x->tally.grazing += h->end == RAY_GRAZES;
            x->tally.judged += h->end == RAY_HITS;
            x->tally.escaping += h->end == RAY_ESCAPES && !is_nearer;
            x->tally.veils += h->veil != SCENE_NONE;
        }
}

static void lose(const sight *x, watcher *w, const ray *r, uint32_t item, double distance)
{
    w->lost_of_kind[x->kind]++;
    if (w->lost++ >= LOST_SHOWN) return;
    const camera *c = &x->camera;
    print_message("LOST by %s: item %u at %.9g m, eye %.17g %.17g %.17g forward %.17g %.17g %.17g ray %.17g %.17g %.17g\n", w->chain, item, distance,
                  c->eye[0], c->eye[1], c->eye[2], c->forward[0], c->forward[1], c->forward[2], r->along[0], r->along[1], r->along[2]);
}

static void watcher_judge(sight *x, watcher *w)
{
    for (uint32_t i = 0; i < RAYS; ++i) {
        const ray_hit *h = &x->hits[i][w->sides];
        if (h->end == RAY_HITS && w->drawn[h->item] != x->number) lose(x, w, &x->rays[i], h->item, h->distance);
        if (h->veil != SCENE_NONE && w->drawn[h->veil] != x->number) lose(x, w, &x->rays[i], h->veil, 0);
    }
}

static int eye_find(sight *x, eye_kind kind)
{
    for (int tries = 0; tries < EYE_TRIES; ++tries) {
        if (!eyes_next(&x->eyes, kind, &x->camera)) return 0;
        rays_make(x);
        if (!rays_cast(x, kind) || kind != EYE_IN_AIR) return 1;
        x->tally.in_void++;
    }
    return 0;
}

static void eye_look(sight *x)
{
    const eye_kind kind = x->number % 2 ? (eye_kind)(EYE_ON_PORTAL + x->number / 2 % 3) : EYE_IN_AIR;
    x->number++;
    if (!eye_find(x, kind)) return;
    x->kind = kind;
    x->tally.eyes[kind]++;
    x->tally.rays += RAYS;
    x->tally.outside += x->outside;
    rays_count(x);
    for (int c = 0; c < CHAINS; ++c) {
        watcher_look(x, &x->watchers[c]);
        watcher_judge(x, &x->watchers[c]);
    }
    x->tally.nowhere += world_view_flow(x->watchers[0].view)->is_everything;
}

// ---- Pictures ----

// Eyes with room for the near plane: see indoor.md's pitfall of an eye on a face.
static uint32_t picture_cameras(sight *x, uint32_t wanted, camera *out)
{
    uint32_t count = 0;
    for (uint32_t i = 0; count < wanted && i < wanted * PICTURE_TRIES; ++i) {
        const eye_kind kind = i % 2 ? (eye_kind)(EYE_ON_PORTAL + i / 2 % 3) : EYE_IN_AIR;
        if (!eye_find(x, kind)) continue;
        out[count] = x->camera;
        const double room = free_space_clearance(x->eyes.space, out[count].eye, PICTURE_ROOM_M, SPACE_ALL & ~(uint32_t)SPACE_LIQUIDS);
        count += room >= PICTURE_ROOM_M && eyes_is_air(&x->eyes, out[count].eye, 0);
    }
    return count;
}

static void check_pictures(sight *x, uint32_t wanted)
{
    bench_strategy_request strategies[CHAINS];
    bench_result found;
    camera *cameras = calloc(wanted, sizeof *cameras);
    assert_non_null(cameras);
    static const door_state open = DOORS_OPEN;
    const camera_path path = {.cameras = cameras, .count = picture_cameras(x, wanted, cameras), .name = "rays"};
    for (int c = 0; c < CHAINS; ++c) strategies[c] = (bench_strategy_request){.name = chains[c], .chain = stage_chain(x->stage, chains[c])};
    report r = report_to_stderr();
    const bench_request q = {.scene = x->stage->scene,
                             .path = &path,
                             .strategies = strategies,
                             .strategy_count = CHAINS,
                             .doors = &open,
                             .plugins = x->stage->plugins,
                             .services = &x->stage->services,
                             .width_px = WIDTH,
                             .height_px = HEIGHT,
                             .samples = 1, .repeat = 1};
    const result done = bench_run(&q, &r, &found);
    if (done == RESULT_OK) {
        for (int c = 0; c < CHAINS; ++c) {
            print_message("  %u pictures, %s: %llu pixels missed\n", path.count, chains[c], (unsigned long long)found.rows[c].missed_pixels);
            if (found.rows[c].missed_pixels) {
                const camera *v = &cameras[found.rows[c].worst_view];
                print_message("  worst: eye %.17g %.17g %.17g forward %.17g %.17g %.17g\n", v->eye[0], v->eye[1], v->eye[2], v->forward[0],
                              v->forward[1], v->forward[2]);
            }
            assert_int_equal(found.rows[c].missed_pixels, 0);
            assert_int_equal(found.rows[c].missed_items, 0);
        }
        bench_result_free(&found);
    } else assert_int_equal(done, RESULT_NO_GL);
    free(cameras);
    if (done == RESULT_NO_GL) print_message("SKIPPED: no OpenGL, no pictures\n");
}

// ---- Scenes ----

typedef struct amount {
    uint32_t eyes, pictures;
} amount;

static void tell(const sight *x, const char *name)
{
    const tally *t = &x->tally;
    print_message("%s: eyes", name);
    for (int k = 0; k < EYE_KINDS; ++k) print_message(" %llu %s,", (unsigned long long)t->eyes[k], eye_kind_names[k]);
    print_message(" %llu in no zone, %llu more in the void, left out; %llu rays: %llu judged, %llu graze, %llu start in no air, %llu end before the "
                  "near plane, %llu meet nothing, %llu veils\n",
                  (unsigned long long)t->nowhere, (unsigned long long)t->in_void, (unsigned long long)t->rays, (unsigned long long)t->judged,
                  (unsigned long long)t->grazing, (unsigned long long)t->outside, (unsigned long long)t->nearer,
                  (unsigned long long)(t->escaping - t->outside), (unsigned long long)t->veils);
}

static void watch(stage *s, const char *name, amount wanted)
{
    static sight x;
    memset(&x, 0, sizeof x);
    x.stage = s;
    x.oracle = ray_oracle_open(s->scene);
    eyes_open(&x.eyes, s->scene, &s->walk, 0x7261797300000000u + wanted.eyes);
    for (int c = 0; c < CHAINS; ++c) watcher_open(&x, &x.watchers[c], chains[c]);
    const uint64_t calls = s->counted.calls;
    for (uint32_t i = 0; i < wanted.eyes; ++i) eye_look(&x);
    assert_int_equal(s->counted.calls, calls); // no frame allocates
    tell(&x, name);
    uint64_t lost = 0, looked = 0;
    for (int k = 0; k < EYE_KINDS; ++k) looked += x.tally.eyes[k];
    for (int c = 0; c < CHAINS; ++c) {
        const watcher *w = &x.watchers[c];
        print_message("  %s: %llu lost, %llu planes unsound, %llu faults\n", w->chain, (unsigned long long)w->lost, (unsigned long long)w->bad_planes,
                      (unsigned long long)w->faults);
        for (int k = 0; k < EYE_KINDS && w->lost; ++k)
            print_message("    %llu of eyes %s\n", (unsigned long long)w->lost_of_kind[k], eye_kind_names[k]);
        lost += w->lost + w->bad_planes + w->faults;
    }
    for (int c = 0; c < CHAINS; ++c) watcher_close(&x, &x.watchers[c]);
    assert_true(failing_allocator_is_clean(&s->counted));
    assert_int_equal(lost, 0);
    assert_int_equal(looked, wanted.eyes);
    assert_true(x.tally.judged > x.tally.rays / 4); // most of the other rays start behind walls
    check_pictures(&x, wanted.pictures);
    ray_oracle_close(x.oracle);
    eyes_close(&x.eyes);
}

static void watch_generated(const char *kind, uint64_t size, amount wanted)
{
    static stage s;
    stage_make(&s, kind, size);
    watch(&s, kind, wanted);
    stage_free(&s);
}

static void watch_map(const char *map, amount wanted)
{
    static stage s;
    map_load(&s, map);
    watch(&s, map, wanted);
    stage_free(&s);
}

static void in_a_maze_what_a_ray_meets_first_is_drawn(void **state)
{
    (void)state;
    if (stage_tier() == TIER_LONG) watch_generated("maze", 1000, (amount){100000, 100});
    else watch_generated("maze", 100, (amount){5000, 4});
}

static void in_a_house_what_a_ray_meets_first_is_drawn(void **state)
{
    (void)state;
    watch_generated("house", GENERATE_SIZE_OF_KIND, stage_tier() == TIER_LONG ? (amount){100000, 100} : (amount){5000, 4});
}

static void on_a_compiled_map_what_a_ray_meets_first_is_drawn(void **state)
{
    maps_need();
    watch_map(*state, stage_tier() == TIER_LONG ? (amount){125000, 250} : (amount){10000, 10});
}

// Argument: a pattern of the tests to run, as "*e1m4*".
int main(int count, char **arguments)
{
    enum { GENERATED = 2 };
    struct CMUnitTest tests[GENERATED + MAPS] = {
        cmocka_unit_test(in_a_maze_what_a_ray_meets_first_is_drawn),
        cmocka_unit_test(in_a_house_what_a_ray_meets_first_is_drawn),
    };
    const int maps = stage_tier() == TIER_LONG ? MAPS : 1; // cmocka leaves out what is empty
    for (int m = 0; m < maps; ++m)
        tests[GENERATED + m] = (struct CMUnitTest){.name = map_names[m],
                                                   .test_func = on_a_compiled_map_what_a_ray_meets_first_is_drawn,
                                                   .initial_state = (void *)(uintptr_t)map_names[m]};
    if (count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests_name("claims rays", tests, NULL, NULL);
}
