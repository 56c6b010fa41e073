// Checks that what is seen is drawn: the promises CONSERVATIVE and SAMPLED, without and with history, in good and bad worlds.
// SPDX-License-Identifier: MIT
#include "checks.h"

#include <portcullis/plane.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ITEMS_MOST = 8192, RAYS = 900 };

typedef struct trial {
    const stand_values *values;
    const char *variant;
    scene_kind kind;
    sight_rays rays;
    uint32_t views;
    int keeps_query;       // 0: each view from a query of its own
    sitting_world world;
    cull_promises asked;   // what is tried only where it is promised
} trial;

// The built promises bind: CONSERVATIVE holds SAMPLED.
static int is_bound(const stand *s, cull_promises asked)
{
    const cull_promises has = s->built.promises & CULL_CONSERVATIVE ? s->built.promises | CULL_SAMPLED : s->built.promises;
    return (has & asked) == asked;
}

static check_verdict judge(check_run *r, const bench_seat *b, const made_view *v, sight_rays rays)
{
    static uint8_t must[ITEMS_MOST];
    memset(must, 0, sizeof must);
    sight_mark(r, &b->scene, v, b->stand.backs, rays, RAYS, must);
    for (uint32_t i = 0; i < b->scene.zone.item_count; ++i)
        if (must[i] && !b->answer.drawn[i])
            return run_fail(r, "it drops item %u, which %s", (unsigned)i, rays == SIGHT_SAMPLES ? "owns the middle of a pixel" : "a ray from the eye shows");
    return CHECK_PASS;
}

static const char *how_text(const trial *t)
{
    return t->world == WORLD_CARELESS ? ", careless host" : t->keeps_query ? ", one query" : "";
}

static check_verdict try_views(check_run *r, const trial *t, bench_seat *b)
{
    made_view views[2];
    b->sitting.world = t->world;
    b->sitting.random = run_bits(r);
    for (uint32_t i = 0; i < t->views; ++i) {
        const view_how how = (view_how)((i + run_below(r, 2)) % VIEW_HOWS);
        made_view *v = &views[i % 2];
        double eye[3];
        const int stays = t->keeps_query && i > 0 && run_below(r, 3) == 0; // the eye, while all else changes
        if (stays) memcpy(eye, views[(i + 1) % 2].camera.eye, sizeof eye);
        if (stays) view_make_from(r, &b->scene, how, eye, v);
        else if (i < 2 || !t->keeps_query || run_below(r, 3) == 0) view_make(r, &b->scene, how, v); // else two views in turn
        if (!t->keeps_query || (t->world == WORLD_CARELESS && run_below(r, 6) == 0)) {
            const sitting_world world = b->sitting.world;
            const uint64_t random = b->sitting.random;
            sitting_close(&b->sitting);
            if (sitting_open(&b->sitting, &b->stand, LISTS_ROOMY) != CULL_OK) return run_fail(r, "it opens no second query");
            b->sitting.world = world;
            b->sitting.random = random;
        }
        run_at(r, "scene %s, view %u (%s), %s%s", made_scene_name(t->kind), (unsigned)i, view_name(how), t->variant, how_text(t));
        const sitting_frame f = {.view = v, .flags = run_below(r, 6) == 0 ? CULL_VIEW_CUT : 0};
        sitting_step(&b->sitting, &f, &b->answer);
        if (judge(r, b, v, t->rays) == CHECK_FAIL) return CHECK_FAIL;
    }
    return CHECK_PASS;
}

static check_verdict try_one(check_run *r, const trial *t)
{
    static bench_seat b;
    const seat_request q = {.kind = t->kind, .values = t->values};
    const seat_state state = seat_open(r, &q, &b);
    if (state == SEAT_FAULTY) return CHECK_FAIL;
    check_verdict verdict = CHECK_SKIP;
    if (state == SEAT_GOOD && is_bound(&b.stand, t->asked)) verdict = try_views(r, t, &b);
    if (verdict != CHECK_FAIL) seat_close(&b);
    return verdict;
}

// The defaults on every scene, each other value of an option on one.
static check_verdict try_all(check_run *r, const trial *like, const char *promise)
{
    stand_values values;
    char name[128], words[512];
    uint32_t tried = 0;
    if (stand_role_of(r->plugin) == ROLE_CROSS) return run_skip(r, "it draws nothing, see cross");
    for (uint32_t n = 0; variant_make(r->plugin, n, &values, name, sizeof name, words, sizeof words); ++n)
        for (int k = 0; k < (n ? 1 : SCENE_EMPTY); ++k) {
            trial t = *like;
            t.values = &values;
            t.variant = name;
            t.kind = (scene_kind)(n ? run_below(r, SCENE_EMPTY) : (uint32_t)k);
            const check_verdict verdict = try_one(r, &t);
            if (verdict == CHECK_FAIL) return verdict;
            tried += verdict == CHECK_PASS;
        }
    return tried ? CHECK_PASS : run_skip(r, "it does not promise %s", promise);
}

check_verdict check_conservative(check_run *r)
{
    const trial t = {.views = 9, .rays = SIGHT_ANYWHERE, .asked = CULL_CONSERVATIVE};
    return try_all(r, &t, "CONSERVATIVE");
}

check_verdict check_sampled(check_run *r)
{
    const trial t = {.views = 5, .rays = SIGHT_SAMPLES, .asked = CULL_SAMPLED};
    return try_all(r, &t, "SAMPLED");
}

static check_verdict try_kept(check_run *r, sitting_world world)
{
    trial t = {.views = 12, .rays = SIGHT_ANYWHERE, .asked = CULL_CONSERVATIVE, .keeps_query = 1, .world = world};
    const check_verdict verdict = try_all(r, &t, "CONSERVATIVE");
    if (verdict == CHECK_FAIL) return verdict;
    t.rays = SIGHT_SAMPLES;
    t.asked = CULL_SAMPLED;
    t.views = 6;
    return verdict == CHECK_PASS ? verdict : try_all(r, &t, "SAMPLED");
}

check_verdict check_history(check_run *r)
{
    return try_kept(r, WORLD_PROMPT);
}

check_verdict check_storm(check_run *r)
{
    return try_kept(r, WORLD_CARELESS);
}

// ---- Movers ----

static uint32_t movers_make(check_run *r, const made_scene *s, cull_mover movers[SITTING_MOVERS_MOST])
{
    const uint32_t count = run_below(r, SITTING_MOVERS_MOST + 1);
    for (uint32_t i = 0; i < count; ++i) {
        cull_mover *m = &movers[i];
        *m = (cull_mover){.id = s->zone.item_count + i};
        for (int k = 0; k < 3; ++k) {
            const double at = s->middle[k] + run_between(r, -1, 1) * s->size * (k == 1 ? 0.3 : 1);
            (&m->box.min.x)[k] = (float)at;
            (&m->box.max.x)[k] = (float)(at + 1 + run_between(r, 0, 2));
        }
    }
    return count;
}

// By points within the box: one that nothing surely hides.
static int mover_is_seen(check_run *r, const made_scene *s, const made_view *v, const cull_box *box)
{
    for (int k = 0; k < 24; ++k) {
        double p[3], to[3], depth = 0;
        sight_hit hits[SIGHT_HITS_MOST];
        for (int i = 0; i < 3; ++i) {
            p[i] = run_between(r, (double)(&box->min.x)[i], (double)(&box->max.x)[i]);
            to[i] = p[i] - v->camera.eye[i];
        }
        if (!view_wants(v, p)) continue;
        for (int i = 0; i < 3; ++i) depth += to[i] * v->axes[2][i];
        // as a pixel's middle: what promises samples only is asked about those
        double x = 0, y = 0;
        for (int i = 0; i < 3; ++i) x += to[i] * v->axes[0][i], y += to[i] * v->axes[1][i];
        x = (floor((x / depth / v->wide + 1) * VIEW_WIDTH_PX / 2) + 0.5) * 2 / VIEW_WIDTH_PX - 1;
        y = (floor((y / depth / v->tall + 1) * VIEW_HEIGHT_PX / 2) + 0.5) * 2 / VIEW_HEIGHT_PX - 1;
        sight_ray ray = {.near_m = v->camera.near_m, .far_m = v->camera.far_m};
        double low = v->camera.near_m, high = v->camera.far_m;
        for (int i = 0; i < 3; ++i) {
            ray.from[i] = v->camera.eye[i];
            ray.along[i] = v->axes[2][i] + x * v->wide * v->axes[0][i] + y * v->tall * v->axes[1][i];
            const double a = ((double)(&box->min.x)[i] - ray.from[i]) / ray.along[i], c = ((double)(&box->max.x)[i] - ray.from[i]) / ray.along[i];
            low = fmax(low, fmin(a, c));
            high = fmin(high, fmax(a, c));
        }
        if (!(low < high * (1 - 1e-6))) continue;
        for (int i = 0; i < 3; ++i) p[i] = ray.from[i] + (low + high) / 2 * ray.along[i];
        ray.far_m = (low + high) / 2;
        if (view_wants(v, p) && sight_cast(s, &ray, hits) == 0 && !sight_meets(s, &ray)) return 1;
    }
    return 0;
}

static check_verdict move_and_look(check_run *r, bench_seat *b)
{
    for (uint32_t i = 0; i < 30; ++i) {
        cull_mover movers[SITTING_MOVERS_MOST];
        made_view v;
        view_make(r, &b->scene, i % 3 ? VIEW_FREE : VIEW_WINDOWS, &v);
        uint32_t count = movers_make(r, &b->scene, movers), lent = 0;
        for (uint32_t m = 0; m < count; ++m) { // lent are those inside a volume
            int touches = 0;
            for (uint32_t k = 0; k < v.volume_count; ++k) touches |= cull_volume_touches(&v.volumes[k], movers[m].box);
            if (touches) movers[lent++] = movers[m];
        }
        run_at(r, "scene %s, view %u, %u movers", made_scene_name(b->scene.kind), (unsigned)i, (unsigned)lent);
        const sitting_frame f = {.view = &v, .movers = movers, .mover_count = lent};
        sitting_step(&b->sitting, &f, &b->answer);
        for (uint32_t m = 0; m < lent; ++m)
            if (!b->answer.drawn[movers[m].id] && mover_is_seen(r, &b->scene, &v, &movers[m].box))
                return run_fail(r, "it drops mover %u, which is seen", (unsigned)movers[m].id);
    }
    return CHECK_PASS;
}

check_verdict check_movers(check_run *r)
{
    static bench_seat b;
    static const scene_kind kinds[] = {SCENE_SPREAD, SCENE_CITY, SCENE_ROOM, SCENE_MESH};
    if (stand_role_of(r->plugin) == ROLE_CROSS) return run_skip(r, "it draws nothing, see cross");
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i) {
        const seat_request q = {.kind = kinds[i], .mover_capacity = SITTING_MOVERS_MOST};
        const seat_state state = seat_open(r, &q, &b);
        if (state == SEAT_FAULTY) return CHECK_FAIL;
        if (state == SEAT_GOOD && !b.stand.built.takes_movers) return run_skip(r, "it leaves movers to the host");
        if (state == SEAT_GOOD && move_and_look(r, &b) == CHECK_FAIL) return CHECK_FAIL;
        seat_close(&b);
    }
    return CHECK_PASS;
}
