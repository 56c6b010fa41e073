// Inside of flow: one view's memory, and what its files share. The public side is flow.h.
// SPDX-License-Identifier: MIT
// Invariant: a node is one volume in one zone. Nodes are never given back within a run, so paths can be walked to their
// start; one that gave way is NODE_DEAD. A zone lists its living nodes only.
#ifndef PORTCULLIS_HOST_FLOW_INTERNAL_H
#define PORTCULLIS_HOST_FLOW_INTERNAL_H

#include "box_tree.h"
#include "flow.h"
#include "list.h"
#include "zone_seam.h"

#include <portcullis/clip.h>
#include <portcullis/plane.h>

enum {
    FLOW_ROOT_SIDES = VIEW_SIDES_MOST,
    FLOW_PLANES_PER_CROSSING = 12,    // room kept on the average; a volume may have CULL_MAX_PLANES
    FLOW_GROWTHS = 2,                 // of a merged rectangle, before it becomes the whole picture
    FLOW_RECTANGLE_STEPS = 4,         // of a merged rectangle, between the picture's middle and its side
};

// Where a plane was first made, so that carrying it through many zones adds its slack once and not once a zone.
#define FLOW_ROOT_RECORD 0x80000000u // + side: a side of the picture, derived from the camera anew in each zone
typedef struct flow_record {
    cull_plane plane; // as first written
    uint32_t origin;  // the zone that it was written for, or FLOW_ROOT_RECORD + side
} flow_record;

typedef struct flow_rectangle { double low[2], high[2]; } flow_rectangle; // of the picture, -1 .. 1, guard band included

enum {
    NODE_DEAD = 1u << 0,   // gave way
    NODE_QUEUED = 1u << 1,
    NODE_CLIPPED = 1u << 2, // its way was crossed with the eye well in front of it
    NODE_MERGED = 1u << 3,
};
typedef struct flow_node {
    cull_plane *planes; // relative to the zone's origin
    flow_record *records;
    uint32_t plane_count, zone, way, parent;
    uint32_t entry;  // as of cull_volume
    uint32_t source; // 0: the view's whole frustum
    uint32_t flags, place; // place: in the result
    uint64_t path;   // bit (portal mod 64) of each portal on the way here: a quick "surely not"
    flow_rectangle rectangle;
    double key;
} flow_node;

typedef struct flow_turn { // in the queue; of those equally far who came first leaves first
    double key;
    uint32_t turn, node;
} flow_turn;

enum { STATE_REACHED = 1u << 0, STATE_ROOT = 1u << 1, STATE_MERGED = 1u << 2 };
typedef struct flow_state { // of a zone
    uint32_t nodes[FLOW_ZONE_VOLUMES];
    uint32_t count, flags, growths, found; // found: in flow.found
    double key;
} flow_state;

typedef struct flow_gate { // of a portal
    double low[3], high[3]; // its box, world
    double bend;            // metres that its points lie off its plane
} flow_gate;

// A portal as the zone that is left has it, in the order of scene.zone_portals: most are passed over by this alone.
typedef struct flow_exit {
    double normal[3], at[3]; // into the zone; a point of the portal
    double bend;             // as of the gate
    uint32_t way, target;
} flow_exit;

enum { WAY_CROSSED = 1, WAY_REFUSED = 2 }; // refused: the crosser saw nothing behind it

typedef struct flow_polygon { // relative to the eye, world axes
    const cull_point *points;
    uint32_t count;
} flow_polygon;

struct flow {
    const scene *scene;
    const graph *graph;
    const allocator *memory;
    arena blocks;

    // Constant after open.
    view_place *places;   // by zone
    zone_seam *seams;     // by zone
    flow_gate *gates;     // by portal
    flow_exit *exits;     // 2 a portal, zone by zone
    uint32_t *entries;    // by way: the entry of what comes through it, as of cull_volume
    box_tree *trees;      // of zones with many portals, over their portals' boxes, relative to nothing: world
    uint32_t *tree_of;    // by zone: in trees, or SCENE_NONE
    uint32_t tree_count;
    double most_bend;     // metres, of all portals
    list lent;            // CULL_MAX_PLANES for a crosser to write
    list seen;            // and for a sight
    double most_start_m; // of all zones: metres beyond the near plane's corner at which the eye is still taken as in it
    uint32_t first_stray; // the least zone that is one; zone_count: none
    uint32_t node_capacity, pool_capacity, plane_capacity, polygon_capacity;

    // Of the run.
    camera camera;
    view_base base;
    double corner_m, widening, guard_tangent; // near plane's corner; of cull_guard_plane; tangents a line of the picture moves by at most
    flow_node *nodes; // by zone: whole frustum; by zone: merged rectangle; then the pool
    uint32_t pool_count, plane_count, source_count;
    cull_plane *planes;
    flow_record *records;
    flow_state *states; // by zone
    flow_turn *queue;        // a heap, the nearest on top
    uint32_t *queue_places;  // by node: where it stands in it
    uint32_t queue_count, queue_turns;
    uint8_t *ways; // 0, or WAY_*, by way
    cull_point *polygon[2];
    flow_zone *found, *sorted; // in the order reached; near to far
    uint64_t *order[2];
    uint32_t found_count;
    uint32_t *starts; // scene.zone_count
    flow_volume *volumes;
    uint32_t *by_zone;
    flow_result result;
};

static inline flow_node *root_node(const flow *f, uint32_t zone)
{
    return &f->nodes[zone];
}
static inline flow_node *merged_node(const flow *f, uint32_t zone)
{
    return &f->nodes[f->scene->zone_count + zone];
}

// ---- flow_queue.c ----
// Nodes leave near to far, so a node has its least key when it leaves, and zones behind get theirs from it.
void flow_queue(flow *f, flow_node *n);                // in it already: nothing
void flow_nearer(flow *f, flow_node *n, double key);   // reached again, maybe by a nearer way
flow_node *flow_queue_pop(flow *f);                    // the nearest

// ---- flow_ports.c ----
result flow_ports_open(flow *f);
void flow_ports_close(flow *f);
typedef struct flow_port_walk {
    const flow *f;
    const flow_node *from;
    const box_tree *tree;
    cull_cut cuts[CULL_MAX_PLANES]; // by flow_cuts_make, once somebody asks
    int has_cuts;
    uint32_t stack[40], depth, at, end;
} flow_port_walk;
// The zone's portals that a volume may get through, by place in the zone's list; of few portals all of them.
void flow_ports_start(const flow *f, const flow_node *from, flow_port_walk *out);
int flow_ports_next(flow_port_walk *w, uint32_t *out);
const cull_cut *flow_ports_cuts(flow_port_walk *w); // of `from`

// ---- flow.c ----
flow_state *flow_reach(flow *f, uint32_t zone, double key); // the view in it, when it is new
typedef struct flow_arrival { uint32_t zone, way, parent; double key; } flow_arrival;
void flow_root_add(flow *f, const flow_arrival *a); // the whole frustum: all else in the zone gives way

// ---- flow_cross.c ----
double flow_gate_distance(const double low[3], const double high[3], const double eye[3]);
void flow_leave(flow *f, const flow_request *q, flow_node *n); // through all portals of its zone
// Metres within which the eye counts as on the portal's plane, for who leaves the zone (DESIGN.md, rule 3).
double flow_near_m(const flow *f, uint32_t zone, uint32_t portal);
double flow_eye_height(const flow *f, uint32_t way); // above the portal's plane, positive in the zone that is left
int flow_touches(const flow *f, const flow_node *n, uint32_t way); // of the polygon something is left in the volume, or the eye is at it

// ---- flow_volume.c ----
cull_guard flow_guard(const flow *f, uint32_t zone);
flow_record flow_record_of(const flow *f, cull_plane plane, uint32_t zone);
void flow_planes_in(const flow *f, uint32_t zone, const flow_record *records, uint32_t count, cull_plane *out); // as the zone has them
cull_cut flow_cut_at_eye(const flow *f, cull_plane plane, uint32_t zone); // the plane for points relative to the eye
void flow_cuts_make(const flow *f, const flow_node *n, cull_cut cuts[CULL_MAX_PLANES]); // the node's planes for points relative to the eye
flow_polygon flow_clip(const flow *f, uint32_t portal, const cull_cut *cuts, uint32_t cut_count);
flow_rectangle flow_rectangle_of(const flow *f, const flow_polygon *p);
// All that is seen of the zone through the polygon, in a volume of those planes, is in the other volume too.
typedef struct flow_candidate { const flow_record *records; const flow_polygon *polygon; uint32_t plane_count, way; } flow_candidate;
int flow_is_inside(const flow *f, const flow_candidate *c, const flow_node *other);

// ---- flow_merge.c ----
int flow_must_merge(const flow *f, const flow_state *s, uint32_t planes);
void flow_merge_add(flow *f, uint32_t zone, const flow_rectangle *r, double key);

// ---- flow_result.c ----
void flow_finish(flow *f, flow_result *out);

#endif
