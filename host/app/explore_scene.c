// The viewer's frame: culled by the world, drawn as it goes; chains swapped and doors used while it runs.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "explore.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

static const double DOOR_REACH_M = 6, DOOR_COSINE = 0.5; // within 60 degrees of where one looks

// ---- Driver: the renderer behind the frame ----

// The flow is done before the first draw of a frame: only now are its rectangles known.
static void tell_rectangles(explore *e)
{
    if (e->told_frame == e->frame || e->scissor == SCISSOR_NONE) return;
    e->told_frame = e->frame;
    scissor_tell(&e->rectangles, world_view_flow(e->v), e->g);
}

static void drive_draw(void *user, uint32_t zone, const cull_run *runs, uint32_t count)
{
    explore *e = user;
    tell_rectangles(e);
    renderer_draw(e->g, e->layout, zone, runs, count);
}

static void drive_movers(void *user, const uint32_t *movers, uint32_t count)
{
    explore *e = user;
    renderer_draw_movers(e->g, e->layout, movers, count);
}

static void drive_capture(void *user, uint32_t zone, const cull_capture *captures, uint32_t count)
{
    explore *e = user;
    for (uint32_t i = 0; i < count; ++i) renderer_capture(e->g, e->layout, zone, &captures[i]);
}

static void drive_show(void *user, uint32_t zone, const cull_picture *pictures, uint32_t count)
{
    explore *e = user;
    for (uint32_t i = 0; i < count; ++i) renderer_show(e->g, e->layout, zone, &pictures[i]);
}

static void drive_draw_clipped(void *user, uint32_t zone, const cull_clipped *clipped, uint32_t count)
{
    explore *e = user;
    tell_rectangles(e);
    for (uint32_t i = 0; i < count; ++i) renderer_draw_clipped(e->g, e->layout, zone, &clipped[i]);
}

static void drive_check_slots(void *user, uint32_t zone, uint8_t *slots, uint32_t count)
{
    explore *e = user;
    renderer_check_slots(e->g, e->layout, zone, slots, count);
}

static void drive_test(void *user, uint32_t zone, const cull_test *tests, uint32_t count, uint32_t frame)
{
    explore *e = user;
    renderer_test(e->g, e->layout, zone, tests, count, frame);
}

static uint32_t drive_collect(void *user, uint32_t zone, collect_how how, uint32_t frame, cull_answer *answers, uint32_t capacity, uint32_t *stalled)
{
    explore *e = user;
    const collect_request q = {e->layout, zone, frame, how == COLLECT_EVERYTHING ? COLLECT_ALL : COLLECT_READY};
    return renderer_collect(e->g, &q, answers, capacity, stalled);
}

// ---- Changes while it runs ----

void explore_find_zone(explore *e)
{
    uint32_t zones[8];
    const uint32_t count = graph_zones_at(world_graph(e->w), e->fly.eye, 0, zones, 8);
    e->zone = count ? zones[0] : SCENE_NONE;
}

// How far ahead the door is: its mover, or else the portals that it closes. INFINITY: not in front.
static double door_ahead(const explore *e, uint32_t door)
{
    const scene *s = e->a->scene;
    double at[3] = {0, 0, 0}, points = 0, low[3], high[3], to[3], along = 0, length = 0, forward = 0;
    if (s->doors[door].mover != SCENE_NONE && movers_box(world_movers(e->w), s->doors[door].mover, low, high)) {
        points = 2;
        for (int k = 0; k < 3; ++k) at[k] = low[k] + high[k];
    }
    for (uint32_t p = 0; p < s->portal_count; ++p)
        for (uint32_t i = 0; s->portals[p].door == door && i < s->portals[p].point_count; ++i, ++points)
            for (int k = 0; k < 3; ++k) at[k] += s->portal_points[s->portals[p].first_point + i][k];
    if (points == 0) return INFINITY;
    for (int k = 0; k < 3; ++k) {
        to[k] = at[k] / points - e->fly.eye[k];
        along += to[k] * e->fly.forward[k];
        length += to[k] * to[k];
        forward += e->fly.forward[k] * e->fly.forward[k];
    }
    length = sqrt(length);
    return length <= DOOR_REACH_M && along >= DOOR_COSINE * length * sqrt(forward) ? length : INFINITY;
}

void explore_use_door(explore *e)
{
    const scene *s = e->a->scene;
    uint32_t nearest = SCENE_NONE;
    double least = INFINITY;
    for (uint32_t d = 0; d < s->door_count; ++d) {
        const double away = door_ahead(e, d);
        if (away >= least) continue;
        least = away;
        nearest = d;
    }
    if (nearest == SCENE_NONE) {
        snprintf(e->message, sizeof e->message, "no door in front, within %.0f m", DOOR_REACH_M);
        return;
    }
    const door_state now = world_door(e->w, nearest) == DOORS_OPEN ? DOORS_SHUT : DOORS_OPEN;
    world_set_door(e->w, nearest, now);
    snprintf(e->message, sizeof e->message, "door '%s' is %s", s->doors[nearest].name, now == DOORS_OPEN ? "open" : "shut");
}

// ---- One frame ----

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static void cull_and_draw(explore *e)
{
    const frame_input q = {.camera = &e->fly,
                           .frame = {.width_px = e->width_px, .height_px = e->height_px, .frame = ++e->frame, .purpose = CULL_VIEW_MAIN},
                           .driver = {e, drive_draw, drive_movers, drive_capture, drive_show, drive_test, drive_collect, drive_draw_clipped, drive_check_slots, NULL}};
    world_cull(e->v, &q, &e->set, &e->stats);
    e->counters.cull_us = e->stats.cull_ns / 1000;
}

static void draw_frozen(explore *e)
{
    for (uint32_t i = 0; i < e->set.zone_count; ++i)
        renderer_draw(e->g, e->layout, e->set.zones[i].zone, e->set.zones[i].runs, e->set.zones[i].run_count);
    renderer_draw_movers(e->g, e->layout, e->set.movers, e->set.mover_count);
}

static void count_polygons(explore *e)
{
    const scene *s = e->a->scene;
    e->counters.polygons = 0;
    for (uint32_t i = 0; i < e->set.zone_count; ++i) {
        const visible_zone *z = &e->set.zones[i];
        world_order(e->w, z->zone, e->order);
        for (uint32_t r = 0; r < z->run_count; ++r)
            for (uint32_t p = z->runs[r].first; p < z->runs[r].first + z->runs[r].count; ++p)
                e->counters.polygons += s->items[e->order[p]].polygon_count;
    }
    for (uint32_t i = 0; i < e->set.mover_count; ++i)
        if (e->set.movers[i] < s->mover_count) e->counters.polygons += s->items[s->item_count + e->set.movers[i]].polygon_count;
}

result explore_draw(explore *e)
{
    const double start = now_ms();
    frame_request q = {.camera = &e->fly, .width_px = e->width_px, .height_px = e->height_px, .mode = e->mode};
    if (e->freeze == FREEZE_NOT) q.scissor = e->scissor;
    else q.faces = FACES_FRONT; // so that one looks into rooms from outside
    explore_find_zone(e);
    world_set_time(e->w, e->time_s);
    renderer_poses(e->g, world_poses(e->w));
    const result begun = renderer_begin(e->g, &q, &e->a->report);
    if (begun != RESULT_OK) return begun;
    if (e->freeze == FREEZE_NOT) cull_and_draw(e);
    else draw_frozen(e);
    renderer_end(e->g);
    e->counters.draw_calls = renderer_draw_calls(e->g);
    e->counters.frame_ms = now_ms() - start;
    count_polygons(e);
    explore_overlay(e);
    return RESULT_OK;
}
