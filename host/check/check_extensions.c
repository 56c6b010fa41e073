// Checks of what a built culler lends beside its verbs: hierarchy, rays, explanations.
// SPDX-License-Identifier: MIT
#include "../core/hierarchy_check.h"
#include "checks.h"

#include <portcullis/box.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const scene_kind kinds[] = {SCENE_SPREAD, SCENE_CITY, SCENE_MESH, SCENE_FLAT, SCENE_ONE, SCENE_EMPTY};
enum { KINDS = sizeof kinds / sizeof *kinds, ITEMS_MOST = 8192 };

// Each scene in turn. `one` says SKIP where the culler has no such extension.
static check_verdict on_each_scene(check_run *r, check_verdict (*one)(check_run *r, bench_seat *b))
{
    check_verdict verdict = CHECK_SKIP;
    for (int k = 0; k < KINDS; ++k) {
        static bench_seat b;
        const seat_request q = {.kind = kinds[k]};
        const seat_state state = seat_open(r, &q, &b);
        if (state == SEAT_FAULTY) return CHECK_FAIL;
        if (state == SEAT_REFUSED) continue;
        run_at(r, "scene %s", made_scene_name(kinds[k]));
        const check_verdict got = one(r, &b);
        if (got != CHECK_PASS) return got;
        verdict = got;
        seat_close(&b);
    }
    return verdict == CHECK_PASS ? verdict : run_skip(r, "it refuses the scenes for this");
}

// ---- cull.hierarchy/1 ----

static const float *row_in_order(const bench_seat *b, const float *from)
{
    const uint32_t count = b->scene.zone.item_count;
    float *row = calloc(count + CULL_PADDING, sizeof *row);
    for (uint32_t i = 0; row && i < count; ++i) row[i] = from[stand_item(&b->stand, i)];
    return row;
}

static check_verdict one_hierarchy(check_run *r, bench_seat *b)
{
    const cull_hierarchy *h = r->plugin->get_extension(b->stand.culler, CULL_EXT_HIERARCHY);
    if (!h) return run_skip(r, "it has no cull.hierarchy/1");
    const cull_boxes *from = &b->scene.zone.boxes;
    const float *const rows[6] = {row_in_order(b, from->min_x), row_in_order(b, from->min_y), row_in_order(b, from->min_z),
                                  row_in_order(b, from->max_x), row_in_order(b, from->max_y), row_in_order(b, from->max_z)};
    cull_zone ordered = b->scene.zone;
    ordered.boxes = (cull_boxes){rows[0], rows[1], rows[2], rows[3], rows[4], rows[5]};
    const char *fault = NULL;
    if (hierarchy_check(h, &ordered, allocator_heap(), &fault) != RESULT_OK) return run_skip(r, "no memory for the check itself");
    for (int i = 0; i < 6; ++i) free((void *)(uintptr_t)rows[i]);
    return fault ? run_fail(r, "%s", fault) : CHECK_PASS;
}

check_verdict check_hierarchy(check_run *r)
{
    return on_each_scene(r, one_hierarchy);
}

// ---- cull.ray/1 ----

// Items that the runs name; 0: a run is nonsense, or names one twice.
static int mark_runs(check_run *r, const bench_seat *b, const fence *room, uint32_t count, uint8_t *found)
{
    const cull_run *runs = room->memory;
    const uint32_t items = b->scene.zone.item_count;
    memset(found, 0, items + 1u);
    if (count > room->size / sizeof *runs) return run_fail(r, "it says that there are %u runs of %u items", (unsigned)count, (unsigned)items), 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (runs[i].count == 0 || runs[i].first >= items || runs[i].count > items - runs[i].first)
            return run_fail(r, "it gives a run outside the zone, or an empty one"), 0;
        for (uint32_t k = 0; k < runs[i].count; ++k)
            if (found[stand_item(&b->stand, runs[i].first + k)]++) return run_fail(r, "it gives an item twice"), 0;
    }
    return 1;
}

typedef enum contact { APART, CLOSE, TOUCHING } contact; // CLOSE: rounding may say either

static contact segment_contact(const double a[3], const double c[3], const cull_box *b, double radius)
{
    const double slack = radius * 4e-6 + 1e-30; // metres: some steps of float at the zone's edge
    for (int widened = 0; widened < 2; ++widened) {
        double low = 0, high = 1;
        int misses = 0;
        for (int i = 0; i < 3; ++i) {
            const double wide = widened ? slack : -slack, from = (double)(&b->min.x)[i] - wide - a[i];
            const double to = (double)(&b->max.x)[i] + wide - a[i], d = c[i] - a[i];
            if (d == 0) misses |= from > 0 || to < 0 || from > to;
            else low = fmax(low, fmin(from / d, to / d)), high = fmin(high, fmax(from / d, to / d)), misses |= from > to;
        }
        if (!misses && low <= high) return widened ? CLOSE : TOUCHING;
    }
    return APART;
}

static check_verdict one_segment(check_run *r, bench_seat *b, const cull_ray *ray, const fence *room)
{
    static uint8_t found[ITEMS_MOST + 1];
    cull_vec3 ends[2];
    double a[2][3];
    for (int k = 0; k < 6; ++k) {
        const double at = b->scene.middle[k % 3] + run_between(r, -1.5, 1.5) * (b->scene.size + 1);
        (&ends[k / 3].x)[k % 3] = (float)at;
        a[k / 3][k % 3] = (double)(float)at;
    }
    const uint32_t items = b->scene.zone.item_count;
    if (!mark_runs(r, b, room, ray->segment(b->stand.culler, ends[0], ends[1], room->memory, items), found)) return CHECK_FAIL;
    for (uint32_t i = 0; i < items; ++i) {
        const contact c = segment_contact(a[0], a[1], &b->scene.boxes[i], (double)b->scene.zone.radius);
        if (c == TOUCHING && !found[i]) return run_fail(r, "a segment passes through item %u and does not find it", (unsigned)i);
        if (c == APART && found[i]) return run_fail(r, "a segment finds item %u, which it does not touch", (unsigned)i);
    }
    return CHECK_PASS;
}

static check_verdict one_box(check_run *r, bench_seat *b, const cull_ray *ray, const fence *room)
{
    static uint8_t found[ITEMS_MOST + 1];
    const uint32_t items = b->scene.zone.item_count;
    cull_box box;
    for (int k = 0; k < 3; ++k) {
        const double at = b->scene.middle[k] + run_between(r, -1, 1) * (b->scene.size + 1);
        (&box.min.x)[k] = (float)at;
        (&box.max.x)[k] = (float)(at + run_between(r, 0, 20));
    }
    if (!mark_runs(r, b, room, ray->box(b->stand.culler, &box, room->memory, items), found)) return CHECK_FAIL;
    for (uint32_t i = 0; i < items; ++i)
        if (cull_box_touches(b->scene.boxes[i], box) != found[i])
            return run_fail(r, "a box %s item %u, whose box it %s", found[i] ? "finds" : "does not find", (unsigned)i,
                            found[i] ? "does not touch" : "touches");
    return CHECK_PASS;
}

static check_verdict one_ray(check_run *r, bench_seat *b)
{
    const cull_ray *ray = r->plugin->get_extension(b->stand.culler, CULL_EXT_RAY);
    if (!ray) return run_skip(r, "it has no cull.ray/1");
    if (!ray->segment || !ray->box) return run_fail(r, "its cull.ray/1 has an empty slot");
    const fence room = fence_open(b->scene.zone.item_count * sizeof(cull_run), 4, 0, "memory behind the runs of cull.ray/1, over max_runs");
    for (int i = 0; i < 40; ++i)
        if (one_segment(r, b, ray, &room) == CHECK_FAIL || one_box(r, b, ray, &room) == CHECK_FAIL) return CHECK_FAIL;
    fence f = room;
    fence_close(&f);
    return CHECK_PASS;
}

check_verdict check_ray(check_run *r)
{
    return on_each_scene(r, one_ray);
}

// ---- cull.explain/1 ----

static check_verdict one_explain(check_run *r, bench_seat *b)
{
    enum { ROOM = 400 };
    const cull_explain *e = r->plugin->get_extension(b->stand.culler, CULL_EXT_EXPLAIN);
    made_view v;
    if (!e) return run_skip(r, "it has no cull.explain/1");
    if (!e->item) return run_fail(r, "its cull.explain/1 has an empty slot");
    if (b->stand.role != ROLE_SELECT) return run_skip(r, "what a filter explains is not tried");
    fence room = fence_open(ROOM, 1, 0, "memory behind the text of cull.explain/1");
    fence small = fence_open(8, 1, 0, "memory behind a short text of cull.explain/1");
    view_make(r, &b->scene, VIEW_FREE, &v);
    const sitting_frame f = {.view = &v};
    sitting_step(&b->sitting, &f, &b->answer);
    const cull_visit visit = {.view = &v.view, .volumes = v.volumes, .volume_count = v.volume_count,
                               .scratch = b->sitting.scratch.memory, .slots = b->sitting.slots.memory, .may_step = 1};
    for (uint32_t i = 0; i <= b->scene.zone.item_count; ++i) {
        run_at(r, "scene %s, item %u", made_scene_name(b->scene.kind), (unsigned)i);
        memset(room.memory, 1, ROOM);
        memset(small.memory, 1, 8);
        const size_t length = e->item(b->sitting.query, &visit, i, room.memory, ROOM), again = e->item(b->sitting.query, &visit, i, small.memory, 8);
        if (!memchr(room.memory, 0, ROOM) || !memchr(small.memory, 0, 8)) return run_fail(r, "its text has no closing zero");
        if (length < ROOM && strlen(room.memory) != length) return run_fail(r, "it says %zu bytes for a text of %zu", length, strlen(room.memory));
        if (length != again) return run_fail(r, "the text's length depends on the room for it");
        if (memchr(room.memory, '\n', strlen(room.memory))) return run_fail(r, "its text is of more than one line");
    }
    fence_close(&room);
    fence_close(&small);
    return CHECK_PASS;
}

check_verdict check_explain(check_run *r)
{
    return on_each_scene(r, one_explain);
}
