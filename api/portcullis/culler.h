// culler.h: the whole contract between a Portcullis host and a culling plugin. Strict C11, reads as C++17.
// SPDX-License-Identifier: MIT
//
// CULL_ABI numbers all below. Under one number no struct and no slot changes; a new ability is a new extension, asked for
// by its id "cull.NAME/REVISION", where NULL means "not here". A slot marked NULL-able may be NULL, every other one is
// checked once, at load. `reserved`: 0 from who writes it, not looked at by who reads. A flag that a plugin doesn't know
// means nothing to it, and a purpose that it doesn't know is CULL_VIEW_MAIN's.
// What is lent for a call (a view, visit, zone or query) is known to the other side by its address, as extensions may tell
// more about it: hand on the one that you were given, no copy.
// Threads: [main]  the host's control thread, no step of this culler running.
//          [build] any thread, one at a time per culler.
//          [step]  any thread, one at a time per query; queries of one culler run in parallel.
//          [any]   any thread at any time.
// Memory: what the host lends is read only and lives as its comment says. A [step] call allocates nothing, does no I/O
// and cannot fail: where a limit bites it draws more, and adds to limits_hit.
// Space: every coordinate is float, in metres, relative to the zone's origin, right-handed, Y up.
// Trust: the host checks each number that a plugin writes. One wrong id, count, slot or repeat, or one step too many,
// and the host draws the whole zone in that view, counts it in `faults` and names the culler.
#ifndef PORTCULLIS_CULLER_H
#define PORTCULLIS_CULLER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CULL_ABI 1u
#define CULL_MAX_PLANES 32u       // planes in one volume; a narrowing that needs more keeps the volume it had
#define CULL_MAX_STEPS 1000000u   // the largest cull_built.max_steps that a host accepts
#define CULL_PADDING 16u          // elements readable, of no meaning, behind each array of cull_boxes

typedef int32_t cull_result;
enum { CULL_OK = 0, CULL_ERR_OPTION = -1, CULL_ERR_ZONE = -2, CULL_ERR_MEMORY = -3, CULL_ERR_BLOB = -4 };

typedef int32_t cull_log_level;
enum { CULL_LOG_INFO = 1, CULL_LOG_WARN = 2, CULL_LOG_ERROR = 3 };

typedef struct cull_vec3 { float x, y, z; } cull_vec3;
typedef struct cull_box { cull_vec3 min, max; } cull_box;
typedef struct cull_plane { cull_vec3 normal; float offset; } cull_plane; // inside: dot(normal, p) + offset >= 0; unit normal

// Consecutive items in the zone's order: first .. first + count - 1. count is at least 1.
typedef struct cull_run { uint32_t first, count; } cull_run;

// ---- A zone: lent at build, valid and unchanged until the culler is destroyed ----

enum { // cull_item.flags
    CULL_ITEM_SEE_THROUGH = 1u << 0, // leaves no depth: hides nothing
    CULL_ITEM_TWO_SIDED = 1u << 1,   // meant to be seen from both sides; see below for what leaves pixels
    CULL_ITEM_CUT_OUT = 1u << 2,     // alpha-tested: leaves depth at some texels only, no occluder
    CULL_ITEM_WALL = 1u << 3,        // one flat convex polygon: cull_zone.walls[item] is set
    CULL_ITEM_BOX = 1u << 4,         // the item's surface is its box
};
// Both sides of every triangle leave pixels, TWO_SIDED or not. One exception: a chain whose select has the option
// `backface` set to 1 is judged with those walls that are not TWO_SIDED and show only their back to the eye left out.

// The unit of visibility. Its id is its index in the zone's order.
typedef struct cull_item {
    uint32_t first_index, index_count; // triangles in cull_zone.indices; a polygon is a fan of them
    uint32_t polygon_count, material, flags, reserved;
} cull_item;

// Item boxes, one array a coordinate, 64-byte aligned, CULL_PADDING elements readable behind the last. min <= max.
typedef struct cull_boxes { const float *min_x, *min_y, *min_z, *max_x, *max_y, *max_z; } cull_boxes;

// A wall polygon: a loop of positions, counterclockwise from its front.
typedef struct cull_wall {
    uint32_t first_vertex, vertex_count; // in cull_zone.wall_vertices; vertex_count 0: the item is no wall
    uint32_t plane, reserved;            // in cull_zone.planes; coplanar polygons facing one way share it
} cull_wall;

// normal . p + offset >= 0 in front, exact, p in grid steps from the zone's origin (cull_zone.grid_steps_per_metre).
typedef struct cull_exact_plane { int64_t normal[3], offset; } cull_exact_plane;

// A convex hole. The plugin learns its shape and its index, never what lies behind. Counterclockwise seen from inside
// the zone; plane.normal points into the zone.
typedef struct cull_portal {
    const cull_vec3 *points;
    cull_plane plane;
    uint32_t point_count, reserved;
} cull_portal;

typedef struct cull_zone {
    const cull_item *items; // what never moves; movers are the host's, see cull_mover
    cull_boxes boxes;
    const cull_vec3 *positions;
    const uint32_t *indices;
    const cull_wall *walls;               // NULL: no item is a wall; else item_count of them
    const uint32_t *wall_vertices;        // in positions
    const cull_plane *planes;             // of walls, unit normals
    const cull_exact_plane *exact_planes; // NULL-able; else plane_count of them, the same planes exactly
    const cull_portal *portals;
    double grid_steps_per_metre; // of exact_planes; 0 without them
    cull_box box;                // of all items and portals
    float radius;                // largest absolute coordinate that occurs
    uint32_t item_count, position_count, index_count, wall_vertex_count, plane_count, portal_count;
    uint32_t mover_capacity; // mover ids are item_count .. item_count + mover_capacity - 1
} cull_zone;

// Extension "cull.hierarchy/1" of a culler: cull_hierarchy, valid and unchanged from build to destroy, in the zone's
// order after the culler's own cull_built.order. The host checks all of it once, before anyone walks it; boxes are
// finite with min <= max, a node that lists nothing has one too.
// Node 0 is the root. A node's children are contiguous and come after it, so one backward loop folds the tree upwards.
// The boxes of the nodes that list an item cover it together: an item may be dropped when ALL nodes that list it are
// hidden, and may be drawn when one is seen. Movers are never in it, so nothing ever invalidates it.
#define CULL_EXT_HIERARCHY "cull.hierarchy/1"
typedef struct cull_node {
    cull_box box; // covers the children and the node's own share of its items
    uint32_t first_child, child_count;
    uint32_t first_item, item_count; // the node's own: in cull_hierarchy.items, or items themselves where that is NULL
    cull_run subtree;                // all items at and under the node where they lie together; count 0: they don't
} cull_node;
typedef struct cull_hierarchy {
    const cull_node *nodes;
    const uint32_t *items; // item ids, every item of the zone at least once. NULL: nodes list runs, each item once
    uint32_t node_count, item_count, depth, reserved; // depth: nodes on the longest way from the root
} cull_hierarchy;

// ---- What one step is told: lent for the call ----

typedef uint32_t cull_purpose;
enum { CULL_VIEW_MAIN = 1, CULL_VIEW_SHADOW = 2, CULL_VIEW_CUBE_FACE = 3, CULL_VIEW_CAPTURE = 4 };

enum { // cull_view.flags
    CULL_VIEW_CUT = 1u << 0, // the viewer jumped: history is a bad guess (never a wrong answer)
};

typedef struct cull_view {
    // The view in double, for who derives planes of his own (cross): with the zone's radius the fields of cull_guard in
    // plane.h.
    double eye_exact[4];  // relative to the zone's origin; w 1
    double forward[3];    // a unit vector
    double pixel_tangent; // height (or width, the larger) of a pixel, at distance 1 along forward
    double reach;         // the largest distance of a point of the picture, at distance 1 along forward
    float eye[4];             // w 1. A parallel view comes only to who has an extension for it
    float clip_from_zone[16]; // column major, visible: -w <= x, y <= w and 0 <= z <= w, nearer is larger (reversed z)
    float pixels_per_tangent; // projected radius in pixels = this * radius / distance
    float near_distance;      // along the view's axis
    uint32_t width_px, height_px;
    cull_purpose purpose;
    uint32_t frame; // rises by one each frame of this viewer
    uint32_t flags, reserved;
} cull_view;

// A convex set: no planes is everything. Never holds the near plane. The host has moved the planes outward (guard band
// and rounding, see plane.h): plain float arithmetic on them, in any order, fused or not, loses nothing.
// entry: 1 + the place in cull_zone.portals of the one portal that all its lines come into the zone through; 0: not known, or it starts
// here.
typedef struct cull_volume { const cull_plane *planes; uint32_t plane_count, entry; } cull_volume;

// A mover inside one of the volumes. The id stays while the mover stays in the zone and may then name another mover:
// good enough for a guess about this frame, never for an answer.
typedef struct cull_mover { cull_box box; uint32_t id, reserved; } cull_mover;

// What the host found for a cull_test. A test without an answer counts as seen.
typedef struct cull_answer {
    uint32_t tag;    // the test's
    uint32_t pixels; // 0: nothing in the box can leave a pixel. Else a count, or 1 when the host only knows "some"
    uint32_t age;    // frames since it was asked; only age 0 is a fact about this frame
} cull_answer;

typedef struct cull_capture cull_capture;
typedef struct cull_picture cull_picture;
typedef struct cull_clipped cull_clipped;

typedef struct cull_visit {
    const cull_view *view;
    const cull_volume *volumes; // the zone is seen through all of them: an item counts if any touches its box
    const cull_run *candidates; // filter: runs of the culler before, each item once, in no promised order. NULL: walk the
                                // lent hierarchy, and leave out what the pictures kept stand for: a select that has
                                // pictures has run, its runs are not handed on
    const cull_picture *pictures; // filter: pictures and captures of the culler before, see cull_batch.keep_*
    const cull_capture *captures;
    const cull_mover *movers;   // for who takes_movers: to be kept or dropped like items
    const cull_answer *answers; // to any earlier tests of this query; not sorted; at most 2 * max_tests + 1. After
                                // CULL_WAIT every answer to that step's tests is here: older ones give way to them
    const cull_clipped *clipped; // filter: clipped items of the culler before, see cull_batch.keep_clipped. Who walks the lent hierarchy
                                 // leaves out those kept too; one that is given all the same is only drawn twice
    const uint8_t *slots;       // per picture slot: 1 holds the last capture, 0 empty. May change to 0 at any frame: where memory
                                // ran short, something in the capture's box changed, or the last capture was not carried out
    void *scratch;              // cull_built.scratch_size bytes, 64-byte aligned, of undefined content
    uint32_t volume_count, candidate_count, picture_count, capture_count, mover_count, answer_count, clipped_count;
    uint32_t step;              // 0 in the first step of a frame
    uint32_t may_step;          // 1: it is the last of select and filters, which may give tests and return CULL_MORE or CULL_WAIT
    uint32_t reserved;
} cull_visit;

// ---- What one step gives: host memory, sized once from cull_built ----

// "Could anything in this box leave a pixel?" Asked after all draws of this step, and maybe of other zones. The plugin
// gives the plain box; the host widens it for its own rounding and answers "seen" when it reaches the near plane. Tests
// given with CULL_MORE or CULL_WAIT are answered in a later step of the frame, age 0; with CULL_DONE in the first step
// of a later frame, age >= 1. So are tests given with CULL_MORE that no step of their frame got the answer to.
typedef struct cull_test { cull_box box; uint32_t tag, reserved; } cull_test;

// "Take a picture of these items from this eye." Pixel (u, v) in [0,1]^2 looks along corner + u*right + v*up - eye.
// The same parallelogram is what a cull_picture of the slot later shows, so turning the view costs no error.
struct cull_capture {
    const cull_run *runs;      // the culler's or query's, valid until the next step
    const uint32_t *slots;     // pictures to compose in beside the items; earlier captures of the batch may fill them
    cull_plane clip_planes[4]; // items are clipped to what lies inside all of them
    cull_box box;              // of what it shows
    cull_vec3 corner, right, up;
    uint32_t run_count, slot_count, clip_plane_count;
    uint32_t slot, width_px, height_px;
    uint32_t keep_depth; // 1: the slot keeps depth, so that a picture shown writes it, re-projected. 0: it stands behind all
                         // that has depth, and of several such pictures of a frame the one shown first stands in front
    cull_vec3 eye;         // where eye_is_said: what it is taken from, such as where the view's eye will be in some frames
    uint32_t eye_is_said;  // 0: from the view's eye
    float detail_m;        // 0: exactly these items; else coarser ones will do, of which no point is farther from its place (cull_costs.levels)
    uint32_t reserved;
};

// "Show slot instead of these items." Allowed while visit.slots[slot] is 1, or once captured in this step or before.
struct cull_picture {
    const cull_run *runs; // what it stands for, for the bench; as in cull_capture
    cull_box box;
    uint32_t run_count, slot;
    float error_px; // the culler's bound on how far a pixel may sit from its place
    uint32_t place_is_said;      // 0: it is shown as the parallelogram that it was taken through
    cull_vec3 corner, right, up; // else as this one
    uint32_t reserved;
};

// "Draw these items clipped to what lies inside all planes": geometry that meets a picture at a seam. An item may stand in
// several of a frame, once in each, but then in no run of the culler: it is drawn, and counts, once for each. No movers.
struct cull_clipped {
    const cull_run *runs; // the culler's or query's, valid until the next step
    cull_box box;         // of what it shows, for a filter
    cull_plane planes[4];
    uint32_t run_count, plane_count;
};

// runs, clipped and pictures are appended to over the steps of a frame, tests and captures start at 0 in each step.
// After a step the host does, in this order: new runs, new clipped, captures one by one, new pictures, tests. What is drawn stays
// drawn: runs of earlier steps may not be taken back, and writing over them changes nothing.
// The pointers are the host's and stay: one that is replaced is a fault, and counts are looked at before lists.
// A slot is a number of the one culler of a chain that has slots; a chain with two such cullers is refused.
typedef struct cull_batch {
    cull_run *runs;          // room for max_runs; each item at most once in a frame; movers are runs of their ids
    cull_picture *pictures;  // room for max_pictures
    cull_test *tests;        // room for max_tests
    cull_capture *captures;  // room for max_captures
    uint8_t *keep_pictures;  // filter: one byte a picture of the visit, 1 before the first step; 0 drops it
    uint8_t *keep_captures;  // filter: the same for captures; one that a kept picture shows or a kept later capture is
                             // composed of is carried out all the same
    uint32_t run_count, picture_count, test_count, capture_count;
    uint32_t nodes_visited; // for the bench, added to
    uint32_t limits_hit;    // for the bench, added to: times a limit made this culler draw more
    cull_clipped *clipped;  // room for max_clipped
    uint8_t *keep_clipped;  // filter: as keep_pictures, for clipped items
    uint32_t clipped_count, reserved;
} cull_batch;

typedef int32_t cull_progress;
enum {
    CULL_DONE = 0, // the frame's answer is complete
    CULL_MORE = 1, // carry out the batch, call again with the answers that are ready
    CULL_WAIT = 2, // carry out the batch, call again when all its tests are answered; a `stall` if one was not ready
};

typedef int32_t cull_crossing;
enum {
    CULL_CROSS_NONE = 0,   // nothing behind the portal is seen through this volume
    CULL_CROSS_NARROW = 1, // the planes written are the volume behind it
    CULL_CROSS_SAME = 2,   // the volume passes unclipped
};

// ---- The host's services ----

typedef struct cull_host cull_host;
struct cull_host {
    uint32_t abi, reserved; // abi: the number that is spoken to this plugin, its own
    void *user;                                                          // the host's
    // [any, not in a step] align is a power of two. NULL: out of memory.
    void *(*alloc)(const cull_host *, size_t size, size_t align);
    void (*free)(const cull_host *, void *memory, size_t size);          // [any, not in a step] size as asked for
    void (*log)(const cull_host *, cull_log_level, const char *message); // [any]
    // [build, step] Runs task(context, 0 .. count-1) in any order and returns when all are done.
    void (*parallel_for)(const cull_host *, void (*task)(void *context, uint32_t i), void *context, uint32_t count);
    // [main, build] zone NULL: of the host. Valid as long as the host or the zone.
    const void *(*get_extension)(const cull_host *, const cull_zone *zone, const char *id);
};

// ---- The plugin ----

typedef uint32_t cull_promises;
enum { // held to by `portcullis check`
    CULL_CONSERVATIVE = 1u << 0, // never drops an item with a visible point, at any picture size
    CULL_SAMPLED = 1u << 1,      // never drops an item that owns a pixel sample of this view
    CULL_STATELESS = 1u << 2,    // the answer depends on zone, options, view and volumes only
    CULL_ORDERED = 1u << 3,      // runs come front to back: the box of the first item of a run is no farther from the eye
                                 // (distance to the nearest point of the box) than that of the run behind it
};

// Told once, after build: all a host needs to size every array of a frame.
typedef struct cull_built {
    const uint32_t *order; // select, NULL-able: order[place] = item; item_count of them, a permutation, valid until
                           // destroy. The host lays the zone out in it; every run and id said later is in that order
    size_t scratch_size;
    size_t index_bytes;     // memory of the index, for the bench
    cull_promises promises; // with these options; never more than the descriptor's may_promise
    uint32_t max_runs;      // in one frame; movers' runs come on top: mover_capacity for who takes_movers
    uint32_t max_steps;     // steps in one frame, 1 .. CULL_MAX_STEPS
    uint32_t max_tests, max_captures;  // in one step
    uint32_t max_pictures, slot_count; // in one frame; slots of one query
    uint32_t walks_hierarchy; // filter: 1 walks the lent hierarchy, so the host runs no select but one that has pictures,
                              // and no filter between; 0 takes candidates
    uint32_t takes_movers;    // last of select and filters: 1 decides about movers too; 0 the host draws them
    uint32_t max_clipped;     // in one frame
    uint32_t reserved[2];
} cull_built;

// The key `backface` is reserved: a select's, "1": drops walls that are not TWO_SIDED and show only their back to the
// eye, see CULL_ITEM_*.
typedef struct cull_option {
    const char *key, *fallback; // fallback is a legal value
    const char *sweep;          // values worth a bench, space between; NULL: none
    const char *help;
} cull_option;

typedef struct cull_descriptor {
    const char *id; // "octree": the name in scene files, chains and bench tables; [a-z0-9-], unique
    const char *version, *summary;
    const cull_option *options; // option_count of them
    uint32_t option_count;
    cull_promises may_promise; // with the best options
} cull_descriptor;

typedef struct cull_culler cull_culler; // the built index of one zone
typedef struct cull_query cull_query;   // one viewer's memory of it

// A chain's first culler selects; each later one serves by its filter verb, else its cross verb. Only the last of
// select and filters may return CULL_MORE or CULL_WAIT. Verbs are NULL-able, one at least is there.
typedef struct cull_plugin {
    const cull_descriptor *descriptor;
    // [build] values[i] belongs to options[i], is never NULL and lives for the call only: copy what is kept. On failure
    // logs why and leaves *out untouched.
    cull_result (*create)(const cull_host *, const char *const *values, cull_culler **out);
    void (*destroy)(cull_culler *); // [main] no query open; also after a failed build
    // [build] once. lent: the hierarchy of the chain's select, NULL when it has none; outlives this culler. *out is
    // zeroed before the call.
    cull_result (*build)(cull_culler *, const cull_zone *, const cull_hierarchy *lent, cull_built *out);
    cull_result (*open)(const cull_culler *, cull_query **out); // [main] built. On failure leaves *out untouched
    void (*close)(cull_query *);                                // [main]
    // [step] Items of the zone whose box touches a volume, or fewer. Between two steps of a frame the host may step
    // other zones and other views; depth only ever comes nearer, so a test answered 0 stays true for the frame.
    cull_progress (*select)(cull_query *, const cull_visit *, cull_batch *);
    // [step] The candidates (or the hierarchy's items inside the volumes) and movers that may be seen.
    cull_progress (*filter)(cull_query *, const cull_visit *, cull_batch *);
    // [step] How `in` goes on behind an open portal; planes has room for CULL_MAX_PLANES. Before any step of the frame.
    // The planes written are guarded: made by cull_guard_plane, or cull_plane_outward where nothing moves with the eye
    // (plane.h), from the view's eye_exact, forward, pixel_tangent and reach and the zone's radius.
    cull_crossing (*cross)(cull_query *, const cull_view *, const cull_volume *in, uint32_t portal, cull_plane *planes,
                           uint32_t *plane_count);
    // [any] Of a culler, after build; culler NULL: of the plugin as a whole. NULL when unknown.
    const void *(*get_extension)(const cull_culler *, const char *id);
} cull_plugin;

// Extension "cull.bake/1" of a built culler: keep the index in the scene file. The host keys blobs by descriptor id and
// version, option values and a hash of the zone; load still checks every number it reads.
#define CULL_EXT_BAKE "cull.bake/1"
typedef struct cull_bake {
    uint64_t (*save)(const cull_culler *, void *blob, uint64_t size); // [build] bytes needed; writes when they fit
} cull_bake;
// Extension of a host, for the zone being built: the blob to load instead of building. NULL: build.
// Where build refuses it with CULL_ERR_BLOB, the host warns, destroys the culler, and builds one anew that is lent none.
#define CULL_EXT_BLOB "cull.blob/1"
typedef struct cull_blob { const void *bytes; uint64_t size; } cull_blob; // 64-byte aligned, as long as the zone

// Extension "cull.costs/1" of a host (zone NULL): cull_costs, what drawing takes on this machine. Ask [build], read [step]: the numbers
// stand while a frame lasts, and may be measured anew between two. CPU time, of all threads, in nanoseconds.
#define CULL_EXT_COSTS "cull.costs/1"
#define CULL_LEVELS_MOST 3u
typedef struct cull_level {
    double away_m;   // no point of it is farther from its place
    double polygons; // of the scene's, that are left: 0 .. 1
} cull_level;
typedef struct cull_costs {
    double polygon_ns;             // a triangle inside the picture, however small
    double pixel_ns;               // a pixel that geometry covers
    double picture_ns;             // a picture shown, however small
    double picture_pixel_ns;       // a pixel that a picture shown covers
    double picture_depth_pixel_ns; // the same, where the slot keeps depth
    double capture_ns;             // a capture, however small
    double capture_pixel_ns;       // a pixel of a capture, beside what its items take as in a frame
    double frame_ns;               // what a frame may take, pictures and all; 0: nobody said
    uint64_t picture_bytes;        // what the pictures of all zones and views may take together; beyond it slots are emptied
    uint32_t pixel_bytes, depth_pixel_bytes; // of those, what a pixel of a slot takes; where it keeps depth
    uint32_t is_measured;          // 0: fixed numbers, the same on every machine
    uint32_t level_count;          // of levels; 0: captures draw every polygon
    cull_level levels[CULL_LEVELS_MOST]; // finest first: what a capture's detail_m is worth
} cull_costs;

// Extension "cull.explain/1" of a built culler: why an item is kept or dropped, one line of text for a person.
#define CULL_EXT_EXPLAIN "cull.explain/1"
typedef struct cull_explain {
    // [step] After the frame's last step, with the visit of its first. Writes at most size bytes with the closing zero,
    // returns the length that the whole text has.
    size_t (*item)(cull_query *, const cull_visit *, uint32_t item, char *text, size_t size);
} cull_explain;

// Extension "cull.ray/1" of a built culler: items whose boxes a segment or a box touches, for picking, movers and
// collision. Writes at most max_runs runs, each item once, nearest first for a segment; returns how many there are.
#define CULL_EXT_RAY "cull.ray/1"
typedef struct cull_ray {
    uint32_t (*segment)(const cull_culler *, cull_vec3 from, cull_vec3 to, cull_run *runs, uint32_t max_runs); // [any]
    uint32_t (*box)(const cull_culler *, const cull_box *, cull_run *runs, uint32_t max_runs);                 // [any]
} cull_ray;

// Extension "cull.figures/1" of a built culler: cull_figures, numbers about its index for a person and the bench, valid from
// build to destroy. What counts how it was used changes when a query closes, and only then: read it [main]. A name is a word of [a-z0-9_] with its unit, if any, at its end.
#define CULL_EXT_FIGURES "cull.figures/1"
typedef uint32_t cull_figure_sort;
enum { CULL_FIGURE_SUM = 0, CULL_FIGURE_MAX = 1 }; // what the figures of several zones come to
typedef struct cull_figure {
    const char *name;
    double value;
    cull_figure_sort sort;
    uint32_t reserved;
} cull_figure;
typedef struct cull_figures { const cull_figure *figures; uint32_t count, reserved; } cull_figures;

// Extension "cull.pieces/1" of a built culler: items cut into flat convex pieces that can be put in an exact order of depth,
// for what is see-through; cull_pieces, valid and unchanged from build to destroy. item is in the zone's order after the
// culler's own cull_built.order. An item has no piece (it is drawn by other means), or its pieces cover it and overlap
// nowhere. A loop is convex, has 3 to 65,536 points, and runs as the item's triangles do there: counterclockwise from the front.
// No limit, no allocation and no failure: the order is written over the numbers asked about, in the caller's memory.
#define CULL_EXT_PIECES "cull.pieces/1"
typedef struct cull_piece {
    uint32_t item;
    uint32_t first_point, point_count; // in cull_pieces.points
    uint32_t reserved;
} cull_piece;
typedef uint32_t cull_depth_order;
enum { CULL_FAR_FIRST = 1, CULL_NEAR_FIRST = 2 };
typedef struct cull_piece_request {
    double eye[4];     // relative to the zone's origin; w 1: a point; w 0: the direction towards an infinitely far viewer
    uint32_t *numbers; // in: pieces, each once, in any order; out: the same in order. Far first: what stands later hides or
                       // tints what stands before, never the other way round, along every ray from the eye. Pieces that
                       // no ray meets at two depths stand in any order, the same for the same eye and the same set
    void *scratch;     // cull_pieces.scratch_size bytes, 64-byte aligned, of undefined content
    uint32_t count;    // of numbers
    cull_depth_order depth_order;
} cull_piece_request;
typedef struct cull_pieces cull_pieces;
struct cull_pieces {
    const cull_piece *pieces;
    const double (*points)[3]; // metres from the zone's origin
    size_t scratch_size;
    uint32_t piece_count, point_count;
    void (*order)(const cull_pieces *, const cull_piece_request *); // [any] no two calls share numbers or scratch
};

// Extension "cull.sight/1" of a built culler that selects: what of a volume gets through the zone to a portal, past what stands in
// between. A crosser narrows by the portal's polygon alone; a select that knows what hides what is asked first, and the
// crosser narrows each part of its answer. Of no effect in a chain without crosser.
#define CULL_EXT_SIGHT "cull.sight/1"
#define CULL_MAX_PARTS 16u
typedef struct cull_sight {
    // [step] As cull_plugin.cross. Parts 0, 1, 2 ... are asked for in turn: volumes that together hold all of `in` that gets
    // to the portal, up to CULL_CROSS_NONE: no more of them; at most CULL_MAX_PARTS. CULL_CROSS_SAME: all of `in` may get there, and no
    // part is asked for after it. Planes are guarded as those of cull_plugin.cross.
    // `in` and its planes stay where they are while its portals are asked about, one after the other.
    cull_crossing (*part)(cull_query *, const cull_view *, const cull_volume *in, uint32_t portal, uint32_t part, cull_plane *planes,
                          uint32_t *plane_count);
} cull_sight;

// The one exported symbol. Data, not code: reading what a library offers runs nothing of it.
typedef struct cull_exports { uint32_t abi, plugin_count; const cull_plugin *const *plugins; } cull_exports;
#define CULL_ENTRY_SYMBOL "cull_entry"
#if defined(_WIN32)
#define CULL_EXPORT __declspec(dllexport)
#else
#define CULL_EXPORT __attribute__((visibility("default")))
#endif
#ifdef __cplusplus
#define CULL_ENTRY extern "C" CULL_EXPORT const cull_exports cull_entry
#else
#define CULL_ENTRY CULL_EXPORT const cull_exports cull_entry
#endif
extern CULL_EXPORT const cull_exports cull_entry;
#ifdef __cplusplus
}
#endif

#endif
