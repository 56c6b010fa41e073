// The world: a scene under management. Zones with a chain each, portals, doors, movers, and any number of views on them.
// SPDX-License-Identifier: MIT
// Invariant: a frame allocates nothing and cannot fail; chains are swapped between frames, and the old one stays when the
// new one fails; one view's memory never changes another's answer.
#ifndef PORTCULLIS_HOST_WORLD_H
#define PORTCULLIS_HOST_WORLD_H

#include "flow.h"
#include "visible.h"
#include "movers.h"

typedef struct world world;

typedef struct world_request {
    const scene *scene;
    loader *plugins;
    const host_services *services;
    const chain_spec *const *chains; // by zone, NULL entries and NULL: the one below
    const chain_spec *chain;         // of all other zones
    uint32_t more_movers;            // room for movers that are not the scene's own
} world_request;

// [main, and no view being culled, unless said otherwise] Everything is borrowed for the world's life, specs for the call.
// Builds the chains of all zones that list an item. On failure a line, and nothing is left.
result world_open(const world_request *q, report *r, world **out);
void world_close(world *w); // NULL is fine; closes the views that are left

// ---- Chains ----
const chain *world_chain(const world *w, uint32_t zone);    // NULL: the zone lists no items
const zone_data *world_zone(const world *w, uint32_t zone);
// Global id at each place of the zone's present order; zone.item_count of them.
void world_order(const world *w, uint32_t zone, uint32_t *out);
// Live swap in two steps: build beside the old one [any thread, views may be culled meanwhile], then put it in its place.
// Libraries are looked for and cullers created by one building thread at a time; the services' allocator and report are
// asked from each of them, so they must bear that. Everything else here, drop too, is [main].
typedef struct world_swap world_swap;
result world_swap_build(const world *w, uint32_t zone, const chain_spec *spec, report *r, world_swap **out);
// Takes the swap. On failure the old chain stays, in every view. A visible set with runs of the zone ends with it.
result world_swap_commit(world *w, world_swap *s, report *r);
void world_swap_drop(world_swap *s); // NULL is fine: a swap that is not wanted any more
result world_set_chain(world *w, uint32_t zone, const chain_spec *spec, report *r); // both steps

// Something in the box looks otherwise from now on: an item's material, a light. Pictures that show it are taken anew, in every view.
void world_changed(world *w, const double min[3], const double max[3]);

// ---- Doors and movers ----
void world_set_door(world *w, uint32_t door, door_state state); // its portals, and its mover's place
door_state world_door(const world *w, uint32_t door);
void world_set_time(world *w, double time_s); // the scene's own movers to where their paths have them
const scene_pose *world_poses(const world *w); // scene.mover_count: where the scene's own movers are
// The application's movers. Numbers from scene.mover_count on; BAD_INPUT as movers_*.
result world_mover_add(world *w, const double min[3], const double max[3], uint32_t *out);
result world_mover_move(world *w, uint32_t mover, const double min[3], const double max[3]);
result world_mover_remove(world *w, uint32_t mover);
const movers *world_movers(const world *w);
const graph *world_graph(const world *w);

// ---- Views ----
typedef struct world_view world_view; // one viewer's memory: history, lists, volumes
result world_view_open(world *w, viewer_checks checks, report *r, world_view **out);
void world_view_close(world_view *v); // NULL is fine
// [any thread, one at a time per view, views of one world in parallel] Never fails and allocates nothing. out_set may be NULL.
void world_cull(world_view *v, const frame_input *q, visible_set *out_set, frame_stats *out_stats);
const flow_result *world_view_flow(const world_view *v); // of its last frame
double world_view_clock_overhead_ns(const world_view *v);  // of the clock readings of a frame, already taken off cull_ns

// Why an item or mover was drawn or not in the view's last frame, for a person: zone, portals on the way, door, plane,
// culler or limit; some lines. Like snprintf: writes at most size bytes with the closing zero, returns the whole length.
typedef struct explain_request { const frame_input *frame; uint32_t item; } explain_request; // global id; movers behind the items
size_t world_explain(world_view *v, const explain_request *q, char *text, size_t size);

#endif
