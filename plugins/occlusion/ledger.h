// Where testing does not pay. A unit (a subtree of at most 256 items) whose tests took fewer polygons away than they cost is
// drawn without tests for a while: 8 frames, then twice as many each time, at most 64, or until it draws a quarter more than it
// did. Where tests pay in the zone as a whole it is then tested again; else a frame of it is drawn and tested afterwards, which
// nobody waits for, and what would have been hidden decides anew. So begin units that come into sight while the zone does not pay.
// A zone of which less than a fifth is hidden, or whose tests don't bring in a quarter of what they cost, rests in the same way, at
// most 512 frames: then nothing is waited for, and every eighth frame one item in 16 is tested after it is drawn, of many items fewer.
// Counts and no clock: the same answers give the same runs on every machine. What things cost, in polygons drawn: a test is a
// box of 6 faces that writes nothing; a step that is waited for empties the graphics processor's queue. Both are rough: halving
// or doubling them moves the point where it switches off by as much.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_LEDGER_H
#define OCCLUSION_LEDGER_H

#include "history.h"

enum { LEDGER_SCALE = 4 }; // costs and gains are kept in quarters of a polygon
enum { LEDGER_TEST = 8, LEDGER_ROUND = 32 * LEDGER_SCALE }; // a test; a step waited for, shared by its tests
enum { LEDGER_TRIAL_TESTS = 24, LEDGER_TRIAL_FRAMES = 4, LEDGER_PROBE_FRAMES = 3, LEDGER_LEVEL_LEAST = 3, LEDGER_LEVEL_MOST = 6, LEDGER_MOST = 1 << 16 };
enum { LEDGER_SHARE = 5, LEDGER_COMMON = 4, LEDGER_REST_MOST = 9, LEDGER_PATIENCE = 4, LEDGER_WINDOW = 16, LEDGER_ZONE_MOST = 1 << 30 };
// Of a zone: hidden at least, one in; its longest pause; frames until the first; frames after which what was counts half

static inline void ledger_halve(ledger_page *page)
{
    page->tests = page->tests / 2 > LEDGER_TRIAL_TESTS ? page->tests / 2 : page->tests; // it stays proven
    page->spent /= 2;
    page->gained /= 2;
    page->shown /= 2;
}

// An answered test: what it cost and, in polygons, what it took away.
static inline void ledger_note(ledger_page *page, uint32_t cost, uint32_t polygons)
{
    const uint32_t most = 1u << 24;
    page->tests++;
    page->spent += cost < most ? cost : most;
    page->gained += polygons < most / LEDGER_SCALE ? polygons * LEDGER_SCALE : most;
}

static inline void ledger_enter(ledger_page *page, uint32_t cost, uint32_t polygons)
{
    ledger_note(page, cost, polygons);
    if (page->spent > LEDGER_MOST || page->gained > LEDGER_MOST) ledger_halve(page);
}

// The same of a zone, whose pages are turned by frames.
static inline void ledger_enter_zone(ledger_page *zone, uint32_t cost, uint32_t polygons)
{
    ledger_note(zone, cost, polygons);
    if (zone->spent > LEDGER_ZONE_MOST || zone->gained > LEDGER_ZONE_MOST) ledger_halve(zone);
}

// Polygons drawn, of what was looked at.
static inline void ledger_show(ledger_page *page, uint32_t polygons)
{
    const uint32_t most = 1u << 24;
    page->shown += polygons < most / LEDGER_SCALE ? polygons * LEDGER_SCALE : most;
    if (page->shown > LEDGER_ZONE_MOST) ledger_halve(page);
}

static inline int ledger_pays(const ledger_page *page)
{
    return page->tests < LEDGER_TRIAL_TESTS || page->gained >= page->spent;
}

// The host steps all zones in common rounds, so that of what a zone's rounds cost it alone may cause a part only.
static inline int ledger_zone_pays(const ledger_page *zone)
{
    return zone->tests < LEDGER_TRIAL_TESTS || (zone->gained >= zone->spent / LEDGER_COMMON && zone->gained >= zone->shown / (LEDGER_SHARE - 1));
}

typedef enum ledger_turn { LEDGER_ON, LEDGER_OFF, LEDGER_PROBE } ledger_turn; // PROBE: this frame, drawn and looked at afterwards

// number spreads the ends of pauses over the frames.
static inline ledger_turn ledger_look(ledger_page *page, const ledger_page *zone, uint32_t serial, uint32_t number)
{
    const int is_new = !page->is_known;
    page->is_known = 1;
    if (page->is_off) {
        if ((int32_t)(serial - page->off_until) < 0) return LEDGER_OFF;
        page->is_off = 0;
        page->on_since = serial;
        return ledger_pays(zone) ? LEDGER_ON : LEDGER_PROBE;
    }
    if (is_new) {
        page->on_since = serial;
        return ledger_pays(zone) ? LEDGER_ON : LEDGER_PROBE;
    }
    const int is_proven = page->tests >= LEDGER_TRIAL_TESTS, follows_zone = !is_proven && !ledger_pays(zone) && serial - page->on_since >= LEDGER_PROBE_FRAMES;
    if ((ledger_pays(page) && !follows_zone) || (is_proven && page->gained >= page->spent / 4 && serial - page->on_since < LEDGER_TRIAL_FRAMES)) {
        if (is_proven && ledger_pays(page)) page->level = 0;
        return LEDGER_ON;
    }
    const uint32_t level = page->level < LEDGER_LEVEL_LEAST ? LEDGER_LEVEL_LEAST : page->level, pause = 1u << level;
    page->off_until = serial + pause / 2 + number * 2654435761u % (pause / 2) + 1;
    page->level = level < LEDGER_LEVEL_MOST ? level + 1 : level;
    if (is_proven) page->tests = page->spent = page->gained = 0; // else they go on with the next probe
    page->is_off = 1;
    return LEDGER_OFF;
}

static inline void ledger_begin_anew(ledger_page *page, uint32_t serial)
{
    page->tests = page->spent = page->gained = page->shown = 0;
    page->on_since = serial;
}

static inline void ledger_wake(ledger_page *zone, uint32_t serial)
{
    zone->is_off = 0;
    ledger_begin_anew(zone, serial);
}

static inline void ledger_rest(ledger_page *zone, uint32_t serial)
{
    const uint32_t level = zone->level < LEDGER_LEVEL_LEAST ? LEDGER_LEVEL_LEAST : zone->level;
    if (!zone->is_off) ledger_begin_anew(zone, serial);
    zone->is_off = 1;
    zone->off_until = serial + (1u << level);
    zone->level = level < LEDGER_REST_MOST ? level + 1 : level;
}

// Of a zone, asked once a frame: 1 while nothing in it is to be tested before it is drawn. Where half of what is looked at
// turns out hidden it does not wait for the end of the pause: the scene, or the view, is another.
static inline int ledger_rests(ledger_page *zone, uint32_t serial)
{
    if (serial % LEDGER_WINDOW == 0 && zone->tests > 2 * LEDGER_TRIAL_TESTS) ledger_halve(zone); // what is long past counts less
    const int pays = ledger_zone_pays(zone), is_proven = zone->tests >= LEDGER_TRIAL_TESTS, is_due = (int32_t)(serial - zone->off_until) >= 0;
    if (!zone->is_off && (pays || serial - zone->on_since < LEDGER_PATIENCE)) {
        if (serial - zone->on_since > 1u << LEDGER_REST_MOST) zone->level = 0;
        return 0;
    }
    if (zone->is_off && is_proven && pays && (is_due || zone->gained >= zone->shown)) {
        ledger_wake(zone, serial);
        return 0;
    }
    if (zone->is_off && !is_due) return 1;
    ledger_rest(zone, serial);
    return 1;
}

#endif
