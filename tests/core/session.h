// Everything between a chain's text and its frames, opened and closed together, counted and watched.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_SESSION_H
#define PORTCULLIS_TESTS_SESSION_H

#include "box_scene.h"
#include "fake_driver.h"
#include "host/core/world_parts.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/report_lines.h"

typedef struct session_request {
    const char *chain;
    box_scene boxes;
    viewer_checks checks;
    uint64_t fail_at; // the allocation that fails; 0: none
} session_request;

typedef struct session {
    session_request q;
    failing_allocator memory;
    report_lines lines;
    host_services services;
    arena texts;
    scene *scene;
    loader *plugins;
    world *world;       // of one zone
    const chain *chain; // its; NULL: no items
    world_view *view;
    fake_driver driver;
    visible_set set; // of the last frame
    frame_stats stats;
} session;

// Loads the test plugins' folder. The session must not move. What failed is left open for session_close.
result session_open(session *s, const session_request *q);
// Closes all and asserts that nothing is left allocated.
void session_close(session *s);
// One view along yaw from `right_m` metres beside the scene's middle; fills driver, set and stats.
typedef struct session_view { uint32_t frame; double yaw_deg, right_m; } session_view;
void session_frame(session *s, const session_view *v);
// The set as times that each global item and mover stands in it; times has FAKE_PLACES_MOST.
void session_set_by_item(const session *s, uint32_t *times);
// Asserts that set and driver have every item and every mover, each once in the set.
void session_assert_whole(const session *s);

#endif
