// A frame driver without a renderer: notes what it is told, and answers tests by a rule.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_FAKE_DRIVER_H
#define PORTCULLIS_TESTS_FAKE_DRIVER_H

#include "host/core/visible.h"

enum { FAKE_PLACES_MOST = 4096, FAKE_EVENTS_MOST = 256, FAKE_TESTS_MOST = 4096 };
#define FAKE_NO_ANSWER UINT32_MAX

typedef enum fake_event { FAKE_DRAW, FAKE_DRAW_MOVERS, FAKE_CAPTURE, FAKE_SHOW, FAKE_TEST, FAKE_COLLECT_READY, FAKE_COLLECT_ALL, FAKE_DRAW_CLIPPED } fake_event;

typedef struct fake_pending {
    uint32_t tag, pixels, frame, collects_left;
} fake_pending;

typedef struct fake_driver {
    uint32_t mover_base; // places of movers: behind the items
    uint32_t (*pixels_of)(const cull_test *test); // the rule; FAKE_NO_ANSWER: it never comes. NULL: everything is seen
    uint32_t latency;                             // collects before the one that finds an answer ready
    fake_event events[FAKE_EVENTS_MOST];
    uint32_t event_count;
    uint32_t drawn[FAKE_PLACES_MOST]; // times that a place was drawn; movers behind the items
    uint32_t shown[FAKE_PLACES_MOST]; // times that it stood in a picture
    uint32_t clipped[FAKE_PLACES_MOST]; // times that it was drawn clipped
    uint32_t captures, shows, tests, clips, last_slot;
    uint32_t loses_slots; // 1: no slot holds its picture any more
    fake_pending pending[FAKE_TESTS_MOST];
    uint32_t pending_count;
} fake_driver;

void fake_driver_init(fake_driver *f);
void fake_driver_new_frame(fake_driver *f); // forgets events and counts, keeps pending tests
frame_driver fake_driver_of(fake_driver *f);

#endif
