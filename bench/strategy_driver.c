// Strategies: the renderer behind a frame, and what its pictures truly hold.
// SPDX-License-Identifier: MIT
#include "strategy_parts.h"

#include <string.h>

static void record(strategy *s, uint32_t zone, const cull_run *runs, uint32_t count)
{
    if (s->records == RECORD_NOTHING || !count) return;
    const strategy_draw draw = {zone, (uint32_t)s->draw_runs.count, count};
    s->record_failed |= !buffer_append(&s->draw_runs, runs, count) || !buffer_append(&s->draws, &draw, 1);
}

static void drive_draw(void *user, uint32_t zone, const cull_run *runs, uint32_t count)
{
    strategy *s = user;
    if (s->cut == SCISSOR_ZONES && !s->cut_is_told) {
        s->scissor.sharing = s->may_step ? SHARED_WITH_ALL : SHARED_WITH_FARTHER;
        scissor_tell(&s->scissor, world_view_flow(s->view), s->g);
    }
    s->cut_is_told = 1;
    renderer_draw(s->g, s->layout, zone, runs, count);
    record(s, zone, runs, count);
}

static void drive_draw_movers(void *user, const uint32_t *movers, uint32_t count)
{
    strategy *s = user;
    renderer_draw_movers(s->g, s->layout, movers, count);
    for (uint32_t i = 0; i < count; ++i) record(s, SCENE_NONE, &(cull_run){movers[i], 1}, 1);
}

static void note_clipped(strategy *s, const strategy_zone *z, const cull_clipped *c)
{
    const uint32_t *order = s->order + z->first;
    for (uint32_t i = 0; i < c->run_count; ++i)
        for (uint32_t at = c->runs[i].first; at < c->runs[i].first + c->runs[i].count; ++at) {
            const uint32_t item = order[at], bit = 1u << (item % 32);
            const scene_item *drawn = &s->q->scene->items[item];
            const uint32_t again = (s->clipped_bits[item / 32] & bit) != 0; // the first time it counts as the rest of D
            s->again_polygons += again ? drawn->polygon_count : 0;
            s->again_triangles += again ? drawn->index_count / 3 : 0;
            s->clipped_bits[item / 32] |= bit;
        }
}

static void drive_draw_clipped(void *user, uint32_t zone, const cull_clipped *clipped, uint32_t count)
{
    strategy *s = user;
    for (uint32_t i = 0; i < count; ++i) {
        renderer_draw_clipped(s->g, s->layout, zone, &clipped[i]);
        record(s, zone, clipped[i].runs, clipped[i].run_count);
        if (s->marks == MARK_DRAWN) note_clipped(s, &s->zones[zone], &clipped[i]);
    }
}

static void drive_check_slots(void *user, uint32_t zone, uint8_t *slots, uint32_t count)
{
    strategy *s = user;
    renderer_check_slots(s->g, s->layout, zone, slots, count);
}

static uint32_t run_end(const strategy_zone *z, cull_run run)
{
    const uint32_t end = run.first + run.count;
    return end < z->item_count ? end : z->item_count; // a picture holds no movers
}

// What a picture holds is what was captured into it, not what the culler says later.
static void note_capture(strategy_zone *z, const cull_capture *c)
{
    uint32_t *bits = z->slot_bits + (size_t)c->slot * z->words;
    memset(bits, 0, z->words * sizeof *bits);
    for (uint32_t i = 0; i < c->run_count; ++i)
        for (uint32_t p = c->runs[i].first; p < run_end(z, c->runs[i]); ++p) bits[p / 32] |= 1u << (p % 32);
    for (uint32_t i = 0; i < c->slot_count; ++i)
        for (uint32_t w = 0; w < z->words; ++w) bits[w] |= z->slot_bits[(size_t)c->slots[i] * z->words + w];
}

static void note_picture(strategy *s, const strategy_zone *z, const cull_picture *p)
{
    const uint32_t *held = z->slot_bits + (size_t)p->slot * z->words, *order = s->order + z->first;
    uint32_t missing = 0;
    for (uint32_t k = 0; k < p->run_count; ++k)
        for (uint32_t at = p->runs[k].first; at < run_end(z, p->runs[k]); ++at) {
            const uint32_t bit = held[at / 32] >> (at % 32) & 1u, item = order[at];
            s->picture_bits[item / 32] |= bit << (item % 32); // in D, though only in a picture
            missing |= bit == 0;
        }
    s->picture_faults += missing;
}

static void drive_capture(void *user, uint32_t zone, const cull_capture *captures, uint32_t count)
{
    strategy *s = user;
    for (uint32_t i = 0; i < count; ++i) {
        renderer_capture(s->g, s->layout, zone, &captures[i]);
        note_capture(&s->zones[zone], &captures[i]);
    }
}

static void drive_show(void *user, uint32_t zone, const cull_picture *pictures, uint32_t count)
{
    strategy *s = user;
    for (uint32_t i = 0; i < count; ++i) {
        renderer_show(s->g, s->layout, zone, &pictures[i]);
        record(s, zone, pictures[i].runs, pictures[i].run_count);
        if (s->marks == MARK_DRAWN) note_picture(s, &s->zones[zone], &pictures[i]);
    }
}

static void drive_test(void *user, uint32_t zone, const cull_test *tests, uint32_t count, uint32_t frame)
{
    strategy *s = user;
    renderer_test(s->g, s->layout, zone, tests, count, frame);
}

static uint32_t drive_collect(void *user, uint32_t zone, collect_how how, uint32_t frame, cull_answer *answers, uint32_t capacity, uint32_t *stalled)
{
    strategy *s = user;
    const collect_request q = {s->layout, zone, frame, how == COLLECT_EVERYTHING ? COLLECT_ALL : COLLECT_READY};
    return renderer_collect(s->g, &q, answers, capacity, stalled);
}

frame_driver driver_of(strategy *s)
{
    if (!s->g) return (frame_driver){0};
    return (frame_driver){s, drive_draw, drive_draw_movers, drive_capture, drive_show, drive_test, drive_collect, drive_draw_clipped, drive_check_slots, NULL};
}
