// Flow: how one view reaches zones through portals, and through which volumes each zone is then seen.
// SPDX-License-Identifier: MIT
// After Luebke and Georges, Portals and Mirrors (1995), and id Tech 4's flood through areas: an explicit work list,
// volumes that keep their source, merges where the paths grow too many. The rules stand in DESIGN.md, "Flow through portals".
// Invariant: ends always; no zone that a sight line reaches through open portals is left out; allocates nothing in a run.
#ifndef PORTCULLIS_HOST_FLOW_H
#define PORTCULLIS_HOST_FLOW_H

#include "graph.h"
#include "zone_data.h"

enum {
    FLOW_ZONE_VOLUMES = 64,  // volumes of a zone before they merge to their screen rectangle
    FLOW_CROSSINGS = 4096,   // volumes of a view that are not its whole frustum, before all that come merge
};

typedef struct flow_sight {
    const cull_view *view;
    const cull_volume *in;
    uint32_t zone, portal, part; // portal: in the order of the zone's cull_zone.portals
} flow_sight;
// Who narrows volumes. NULL cross, or a zone without crosser (it answers CULL_CROSS_SAME): the flood.
typedef struct flow_crosser {
    void *user;
    // portal: in the order of the zone's cull_zone.portals. As cull_plugin.cross.
    cull_crossing (*cross)(void *user, uint32_t zone, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes,
                           uint32_t *plane_count);
    // As cull_sight.part, before cross is asked about each part; one part too many is asked for, which has to be NONE. NULL, or SAME of
    // part 0: all goes to the portal.
    cull_crossing (*sight)(void *user, const flow_sight *q, cull_plane *planes, uint32_t *plane_count);
    // 1: what is seen of a volume in that zone depends on the portal that it came in through, so that one through another portal is a volume
    // of its own, though it lies inside. NULL: in no zone.
    int (*is_by_entry)(void *user, uint32_t zone);
} flow_crosser;

typedef struct flow_request {
    const camera *camera;
    view_frame frame;
    const uint8_t *open; // a byte a portal: 1 open, 0 shut
    flow_crosser crosser;
} flow_request;

typedef struct flow_volume {
    cull_volume volume;   // planes relative to the zone's origin, guarded; they live until the next run
    uint32_t zone;
    uint32_t way;         // 2 * portal + side that it came in through, as of the zone that it came from; SCENE_NONE: started here, or merged
    uint32_t parent;      // in flow_result.volumes (what took its place where it merged); SCENE_NONE: started here, or merged
    uint32_t is_merged;   // 1: a screen rectangle, or the whole picture, around several ways into the zone
    float rectangle[4];   // of the picture that it covers: least x, least y, greatest x, greatest y, in -1 .. 1; whole where it is not known
} flow_volume;

typedef struct flow_zone {
    cull_view view; // relative to the zone's origin
    double distance; // order only: how far the zone is along the nearest path, in metres
    uint32_t zone, first, count; // its volumes: flow_result.by_zone[first ...]
} flow_zone;

typedef struct flow_result {
    const flow_zone *zones; // near to far, each once; stray zones last
    const flow_volume *volumes;
    const uint32_t *by_zone; // volume numbers, zone by zone; volumes that gave way are in neither
    uint32_t zone_count, volume_count;
    uint32_t crossings;     // portals tried
    uint32_t portal_merges; // volumes that gave way to a rectangle
    uint32_t limits_hit;    // narrowings given up for want of room for planes, or as the crosser wrote nonsense
    uint32_t is_everything; // the eye was in no zone: all zones are there, seen whole
} flow_result;

typedef struct flow flow; // one view's memory

typedef struct flow_open_request {
    const scene *scene;
    const graph *graph;
    const zone_data *zones; // scene.zone_count
} flow_open_request;
result flow_open(const flow_open_request *q, const allocator *memory, flow **out); // all borrowed
void flow_close(flow *f); // NULL is fine
void flow_run(flow *f, const flow_request *q, flow_result *out); // [any thread, one at a time per flow]

// Why a run did not cross a portal from a zone that it reached: for explain. After flow_run, with its request.
typedef enum flow_fate {
    FLOW_CROSSED,   // it did
    FLOW_SHUT,      // its door is shut
    FLOW_BEHIND,    // the eye is behind it
    FLOW_OUTSIDE,   // no volume of the zone touches it, or the crosser saw nothing behind it
    FLOW_UNREACHED, // the zone itself was not reached
} flow_fate;
flow_fate flow_fate_of(const flow *f, const flow_request *q, uint32_t way); // way: 2 * portal + side, side: the zone that is left

#endif
