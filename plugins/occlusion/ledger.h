// Where testing does not pay. A unit (a subtree of at most 256 items) whose tests took fewer polygons away than they cost is
// drawn without tests for a while: 8 frames, then twice as many each time, at most 64, or until it draws a quarter more than it
// did. Where tests pay in the zone as a whole it is then tested again; else a frame of it is drawn and tested afterwards, which
// nobody waits for, and what would have been hidden decides anew. So begin units that come into sight while the zone does not pay.
// Counts and no clock: the same answers give the same runs on every machine. What things cost, in polygons drawn: a test is a
// box of 6 faces that writes nothing; a step that is waited for leaves the graphics processor idle. Both are rough: halving or
// doubling them moves the point where it switches off by as much.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_LEDGER_H
#define OCCLUSION_LEDGER_H

#include "history.h"

enum { LEDGER_SCALE = 4 }; // costs and gains are kept in quarters of a polygon
enum { LEDGER_TEST = 3, LEDGER_ROUND = 32 * LEDGER_SCALE }; // a test; a step waited for, shared by its tests
enum { LEDGER_TRIAL_TESTS = 24, LEDGER_TRIAL_FRAMES = 4, LEDGER_PROBE_FRAMES = 3, LEDGER_LEVEL_LEAST = 3, LEDGER_LEVEL_MOST = 6, LEDGER_MOST = 1 << 16 };

// An answered test: what it cost and, in polygons, what it took away.
static inline void ledger_enter(ledger_page *page, uint32_t cost, uint32_t polygons)
{
    const uint32_t most = 1u << 24;
    page->tests++;
    page->spent += cost < most ? cost : most;
    page->gained += polygons < most / LEDGER_SCALE ? polygons * LEDGER_SCALE : most;
    if (page->spent <= LEDGER_MOST && page->gained <= LEDGER_MOST) return;
    page->tests = page->tests / 2 + 1;
    page->spent /= 2;
    page->gained /= 2;
}

static inline int ledger_pays(const ledger_page *page)
{
    return page->tests < LEDGER_TRIAL_TESTS || page->gained >= page->spent;
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

#endif
