// The interactive viewer behind `portcullis view`: one world, one window, one camera that flies.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_EXPLORE_H
#define PORTCULLIS_HOST_EXPLORE_H

#include "../../bench/scissor.h"
#include "../core/world.h"
#include "../render/render.h"
#include "app.h"

enum { EXPLORE_CHAINS_MOST = 32, EXPLORE_TEXT_BYTES = 2048 };

typedef enum freeze { FREEZE_NOT, FREEZE_CULLING } freeze; // CULLING: the set and its volumes stay, the camera flies on

typedef struct explore_counters {
    double frame_ms, cull_us;
    uint64_t polygons;
    uint32_t draw_calls, swaps, swap_failures;
} explore_counters;

typedef struct explore {
    app *a;
    renderer *g;
    world *w;
    world_view *v;
    render_layout *layout;
    uint32_t *order;      // scratch: the largest zone's items
    uint32_t order_count;
    const chain_spec **own; // by zone: the chain it was opened with; C goes through it and through `chains`
    chain_spec chains[EXPLORE_CHAINS_MOST];
    uint32_t chain_count;
    uint32_t *zone_chain; // by zone: place in `chains` that it has now, + 1; 0: its own
    uint32_t has_pictures; // some chain wanted slots
    result failure;        // that a key met and that ends the viewer
    camera fly, frozen;
    freeze freeze;
    visible_set set;      // of the last frame that was culled
    frame_stats stats;
    explore_counters counters;
    buffer lines, faces;  // overlay_vertex, reused
    double time_s, speed_m_s, frame_ms; // frame_ms: that a frame may take, as cullers are told; 0: nobody says
    scissor rectangles;
    uint32_t frame, told_frame, width_px, height_px, zone; // zone: that the camera is in, the first of them; SCENE_NONE: none
    render_mode mode;
    render_scissor scissor;
    uint32_t shows_help, shows_portals, time_stands, wants_picture, is_over;
    char message[256];
} explore;

typedef struct explore_step { char key; double dt_s; } explore_step; // key: a letter as on the keyboard, '.' none

void explore_press(explore *e, char key);                 // what a key does once: see explore_input.c
void explore_poll(explore *e, double dt_s);               // the window's keys and mouse
void explore_move(explore *e, char key, double dt_s);     // w a s d q e i j k l (the arrows), as if held for dt_s
void explore_cycle_chain(explore *e);                     // of the zone that the camera is in; e->failure when layout and chain came apart
void explore_find_zone(explore *e);                       // that the camera is in, into e->zone
result explore_reserve(explore *e);                       // pictures and tests that the chains may want, from layout and renderer
void explore_use_door(explore *e);                        // the one in front
result explore_draw(explore *e);                          // one frame, to the window
void explore_overlay(explore *e);                         // volumes, portals, text

#endif
