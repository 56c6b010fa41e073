// Worlds of rooms for tests: zones that are boxes, portals with doors, items and movers that are boxes, put together by the
// scene builder; with a driver that notes what each zone is told.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_WORLD_SITE_H
#define PORTCULLIS_TESTS_WORLD_SITE_H

#include "host/core/world_parts.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/report_lines.h"

enum { SITE_ITEMS_MOST = 8192, SITE_EVENTS_MOST = 4096, SITE_TESTS_MOST = 16384, SITE_MOVERS_MOST = 4096 };

typedef enum site_event { SITE_DRAW, SITE_MOVERS, SITE_CAPTURE, SITE_SHOW, SITE_TEST, SITE_READY, SITE_WAIT } site_event;
typedef struct site_note { site_event event; uint32_t zone; } site_note;
typedef struct site_pending { uint32_t zone, tag, frame; } site_pending;

typedef struct site_driver {
    const struct site *site;
    uint32_t (*pixels_of)(uint32_t zone, const cull_test *t); // NULL: everything is seen
    site_note notes[SITE_EVENTS_MOST];
    uint32_t note_count;
    uint32_t drawn[SITE_ITEMS_MOST], movers[SITE_MOVERS_MOST]; // times, by global item and by mover
    site_pending pending[SITE_TESTS_MOST];
    uint32_t pixels[SITE_TESTS_MOST], pending_count;
} site_driver;

typedef struct site {
    failing_allocator memory;
    report_lines lines;
    host_services services;
    arena texts;
    scene_builder *builder;
    scene *scene;
    loader *plugins;
    world *world;
    uint64_t seed;
} site;

// ---- Making one. What fails under a failing allocator leaves result, and site_close takes what is there. ----
typedef struct site_box { double min[3], max[3]; } site_box;
void site_begin(site *s, uint64_t fail_at);
result site_room(site *s, const char *name, const site_box *b, uint32_t parent, uint32_t *out);
result site_outdoors(site *s, const char *name, uint32_t *out); // everywhere
result site_item(site *s, const site_box *b);
result site_mover(site *s, const char *name, const site_box *b, const double open_offset[3]);
// A rectangle in the plane axis = at, low and high along the next two axes. door: SCENE_NONE or as site_door gave it.
typedef struct site_hole { uint32_t zones[2], door, axis; double at, low[2], high[2]; } site_hole;
result site_portal(site *s, const char *name, const site_hole *h);
result site_door(site *s, const char *name, door_state at_rest, uint32_t mover, uint32_t *out);
result site_end(site *s); // the scene, and a loader of the test plugins and the product's

typedef struct site_world { const char *chain, *const *chains; uint32_t more_movers; } site_world; // chains by zone, NULL: chain
result site_open(site *s, const site_world *q);
void site_parse(site *s, const char *chain, chain_spec *out);
void site_close(site *s); // asserts that nothing is left

// ---- Grids: rooms of 4 m by 3 m by 4 m, room (x, z) is zone x + z * wide, its corner at (4 x, 0, 4 z); a hole of 2 m by 2 m with a
// door of its own, open, between neighbours; items strewn over all of it, some across walls. ----
typedef struct site_grid { uint32_t wide, deep, items, movers; uint64_t seed; double at[3]; } site_grid;
result site_make_grid(site *s, const site_grid *g);
camera site_camera(const double eye[3], const double forward[3]);
camera site_random_camera(uint64_t *seed, const site_grid *g); // in a room of the grid
frame_input site_input(const camera *c, uint32_t frame);       // 320 by 240, no driver

// ---- Looking ----
typedef struct site_sight {
    uint8_t items[SITE_ITEMS_MOST], movers[SITE_MOVERS_MOST]; // times in the set
    visible_set set;
    frame_stats stats;
} site_sight;
void site_look(const site *s, world_view *v, const frame_input *q, site_sight *out); // asserts that the set and its counts are sound
// The oracle: what touches a volume of a zone that the view's last frame reached, one plane after the other. `chains`:
// by zone the chain's text, of which it knows: none, brute, frustum, and these with +flood, and +testfilter[keep=right]
// behind them (drops boxes whose min x is below the zone's origin).
void site_oracle(const site *s, const world_view *v, const char *const *chains, uint8_t *items);
void site_oracle_movers(const site *s, const world_view *v, uint8_t *movers);

void site_driver_init(site_driver *d, const site *s);
void site_driver_new_frame(site_driver *d);
frame_driver site_driver_of(site_driver *d);

#endif
