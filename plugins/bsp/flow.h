// What the parts of bsp_flow share: the view's numbers, polygons seen from the eye, the windows of cells that wait to be visited.
// SPDX-License-Identifier: MIT
//
// Invariant: whatever a ray of the picture reaches has a window that holds the ray. Every line is moved outward once, when it is made
// from its polygon (flow_margin); a window's own edges never move again. See flow.c for how.
#ifndef PORTCULLIS_BSP_FLOW_H
#define PORTCULLIS_BSP_FLOW_H

#include "flow_index.h"
#include "window.h"

#include <portcullis/plane.h>

enum {
    FLOW_WINDOWS = 16,       // of one cell, cells=exact; one more and two become their hull
    FLOW_HULL_WINDOWS = 4,   // the same, cells=hull
    FLOW_HULL_BLOCKS = 1024, // windows of cells that wait, cells=hull
    FLOW_EXACT_BLOCKS = 4096,
    FLOW_PASSES = 4,         // see flow.c
};

typedef enum flow_when { FLOW_NOW, FLOW_NEXT } flow_when; // this pass, or the next

// The windows of a cell that waits. Windows of the pool where `first` is one; else its rectangle is the window.
typedef struct flow_slot { window_bounds bounds; uint32_t first, count; } flow_slot;

enum { // bits of flow.states, by cell
    FLOW_WAITS = 1u << 0,      // in slots[turn]
    FLOW_WAITS_NEXT = 1u << 1, // in slots[1 - turn]
    FLOW_SEEN = 1u << 2,       // visited in the first pass
    FLOW_STARTED = 1u << 3,    // holds the whole window of the only volume
    FLOW_AT_PORTAL = 1u << 4,  // borders a zone portal from inside
};

typedef struct flow {
    const bsp_flow_request *q;
    const bsp_cells_data *cells;
    const bsp_flow_index *index;
    bsp_flow_figures *figures;
    double eye[3];
    double axes[3][4];     // right, up, forward; [3]: minus the eye's place along it
    double reach, radius, slack;
    double guard_tangents; // per unit of a line's (a, b): the pixel part of the guard band
    double guard_share;    // per unit of a line's normal: its widening
    double guard_wide;     // both, in tangents of the picture
    double slack_wide;     // slack seen from a metre, in tangents of the picture
    double near;           // metres: what lies nearer to the eye is seen whole, see flow_start.c
    double graze;          // metres: an eye this near to a plane is on both its sides
    uint8_t *marks, *states; // nodes with a waiting cell below; cells
    flow_slot *slots[2];
    flow_slot *exits;      // by zone portal: what leaves the zone through it; kept where the request says so
    uint8_t *has_exit;     // by zone portal
    uint32_t *stack, *later; // later: cells that wait for the next pass
    window *pool;
    uint32_t turn, later_count, pool_free, pool_used, pool_size;
} flow;

// A convex polygon in view space: x to the right, y up, z forward, metres from the eye; counterclockwise seen from the eye.
typedef struct flow_shape {
    double x[FLOW_POINTS + 2], y[FLOW_POINTS + 2], z[FLOW_POINTS + 2]; // the first point stands behind the last once more
    uint32_t count;
    uint32_t is_bent;
    double distance; // of the eye: at most that to any point of it, by its ball
    double size;     // no coordinate is larger
} flow_shape;

// The ball around a face, in view space. size: no coordinate of a point in it is larger.
typedef struct flow_ball { double x, y, z, radius, size; } flow_ball;
double flow_ball_distance(const flow_ball *b); // of the eye to it; below 0 inside
flow_ball flow_ball_of(const flow *f, const flow_word *face);
void flow_shape_of(const flow *f, const flow_word *face, const flow_ball *ball, flow_shape *out); // FACE_COUNT at most FLOW_POINTS
typedef enum flow_winding { FLOW_AS_STORED, FLOW_REVERSED } flow_winding;
void flow_shape_make(const flow *f, const cull_vec3 *points, uint32_t count, flow_winding winding, flow_shape *out);
double flow_shape_distance(const flow_shape *s); // of the eye to it, metres

// Lines of the polygon's edges: moved outward by these, in tangents per unit of a line's (a, b), of its whole normal, and absolute.
typedef struct flow_margin { double tangents, share, rounding; } flow_margin;
void flow_shape_edges(const flow_shape *s, flow_margin margin, window_line *lines); // count of them
double flow_rounding(const flow *f, double size); // of a line's value, for a polygon of that size

// A window's rectangle made ready: sides that a ball may be outside of.
typedef struct flow_sides { window_bounds bounds; double norms[4]; } flow_sides;
// A cell's turn: its windows, the sides around all, and where they are more than one those of each.
typedef struct flow_visit { const window *windows[FLOW_WINDOWS]; uint32_t count; flow_sides sides, each[FLOW_WINDOWS]; } flow_visit;
flow_sides flow_sides_of(window_bounds bounds);
// With lines moved out by `tangents` and by slack seen from the ball's distance. The eye is `height` above its plane. 0 where it is near.
int flow_ball_is_outside(const flow *f, const flow_sides *s, const flow_ball *ball, double height, double tangents);

static inline double flow_face_height(const flow *f, const flow_word *plane) // of the eye above it, metres
{
    return (((double)plane[0].f * f->eye[0] + (double)plane[1].f * f->eye[1]) + (double)plane[2].f * f->eye[2]) + (double)plane[3].f;
}

static inline double flow_node_height(const flow *f, const flow_node *n)
{
    return (((double)n->normal[0] * f->eye[0] + (double)n->normal[1] * f->eye[1]) + (double)n->normal[2] * f->eye[2]) + (double)n->offset;
}

// What an opening or portal lets through: what lies inside all lines. None: all, for it is too near to the eye.
typedef struct flow_gate { window_line lines[FLOW_POINTS]; uint32_t count; } flow_gate;
void flow_gate_make(const flow *f, const flow_shape *s, double height, flow_gate *out); // height: the eye's above its plane, either sign
void flow_gate_make_grazing(const flow *f, const flow_shape *s, const double normal[3], double height, flow_gate *out);

void flow_add(flow *f, flow_when when, uint32_t cell, const window *w);
void flow_exit_add(flow *f, uint32_t portal, const window *w);
void flow_exits_mark(flow *f); // cells at portals, before anything flows
void flow_exits_note(flow *f, uint32_t cell, const window *const *windows, uint32_t window_count); // of a cell that is being visited

typedef enum portal_way { PORTAL_IN, PORTAL_OUT } portal_way; // as the rays go through it
window_fate flow_through_stand(const flow *f, const cull_portal *p, const bsp_stand *stand, portal_way way, const window *w, window *out);
int flow_axes(const cull_view *view, double axes[3][3]); // right, up, forward. 0: forward is no direction
// Starts all volumes. 0: this view is none for windows, see bsp_flow.
int flow_start(flow *f);
// Portals that the eye is outside of, as the rays that left the zone see them again: into the next pass.
void flow_start_again(flow *f);

// Marks the items of the cell that show in one of the windows; their words start at `face`.
void flow_items(flow *f, const flow_cell *cell, const flow_word *face, const flow_visit *v);

#endif
