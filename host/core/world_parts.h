// What a world and its views are made of: shared by the world_*.c files only.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_WORLD_PARTS_H
#define PORTCULLIS_HOST_WORLD_PARTS_H

#include "viewer.h"
#include "world.h"

#include <assert.h>
#include <pthread.h>
#include <time.h>

#ifndef NDEBUG
#include <stdatomic.h>
#endif

enum {
    ZONE_MOVERS_MOST = 256,     // movers that a culler of one zone of many decides about in a frame; others the host draws
    MOVERS_MOST = 1 << 24,      // of a world, the scene's own among them
    GUARDED_ZONES_MOST = 256,   // above, lists have no guard pages: the system's mappings are few
};

typedef struct zone_chain {
    chain *chain;         // NULL: the zone lists no items
    shared_place *shared; // the zone data's shared_count, by place in the chain's order
} zone_chain;

struct world {
    const scene *scene;
    loader *plugins;
    const host_services *services;
    const allocator *memory;
    zone_data *data;          // by zone, like the next
    zone_chain *chains;
    graph *graph;
    movers *movers;
    uint32_t *shared_items;   // global ids that several zones list, ascending; their places are the shared numbers
    uint8_t *open;            // by portal
    door_state *doors;
    uint32_t *door_portals;   // portals that doors close, door by door
    uint32_t *door_first;     // by door, and one more: in door_portals
    scene_pose *poses;        // by mover of the scene
    world_view *views;
    pthread_mutex_t *loading; // libraries and creates, see chain_request
    double time_s;
    uint32_t shared_count, mover_numbers;
    uint32_t open_changes;    // times that `open` changed
#ifndef NDEBUG
    atomic_uint culling;      // views being culled: nothing may change then
#endif
};

struct world_view {
    world *world;
    world_view *next;
    flow *flow;
    flow_result reached;
    viewer **zones;        // by zone; NULL: no items
    viewer **active;       // of this frame, near to far
    viewer **stepping;     // of this round
    cull_volume *volumes;  // of zones seen through several
    cull_mover *lent;      // movers of zones whose cullers take them, zone by zone
    visible_zone *visible;
    visible_set set;       // of the last frame, for explain
    shared_stamp *stamps;  // by shared number
    uint8_t *open;         // by portal, as of the last frame: explain looks back at it
    mover_marks marks;
    viewer_room room;
    viewer_frame frame;
    frame_stats *stats;
    struct timespec since; // the frame's own time runs from here
    double clock_overhead_ns;
    viewer_checks checks;
    uint32_t serial, active_count, volume_count, volume_capacity, lent_count, lent_capacity, told_crosser, open_changes;
};

// Nothing may change while a view is culled; debug builds assert it.
static inline void world_assert_still(const world *w)
{
#ifndef NDEBUG
    assert(atomic_load(&((world *)(uintptr_t)w)->culling) == 0);
#else
    (void)w;
#endif
}

// ---- world_chains.c ----
typedef struct zone_chain_request { const world *world; uint32_t zone; const chain_spec *spec; } zone_chain_request;
result zone_chain_build(const zone_chain_request *q, report *r, zone_chain *out);
void zone_chain_close(zone_chain *c, const world *w, uint32_t zone); // zeroed is fine

// ---- world_view.c ----
result world_view_open_zone(world_view *v, uint32_t zone, const zone_chain *c, report *r, viewer **out);

// ---- world_frame.c ----
// A flow_crosser's: user is the view.
cull_crossing world_view_cross(void *user, uint32_t zone, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes,
                               uint32_t *plane_count);
cull_crossing world_view_sight(void *user, const flow_sight *q, cull_plane *planes, uint32_t *plane_count);
int world_view_is_by_entry(void *user, uint32_t zone);

// ---- world_movers.c ----
typedef struct mover_search { // movers of a zone, seen through its volumes
    uint32_t zone;
    const cull_volume *volumes;
    uint32_t volume_count;
    viewer *viewer; // NULL: no items
} mover_search;
void view_find_movers(world_view *v, const mover_search *q); // marks those seen, or lends them to who takes them
void view_mark_all_movers(world_view *v, uint32_t zone);      // of a zone that is drawn whole
void view_find_movers_everywhere(world_view *v, const frame_input *q);

#endif
