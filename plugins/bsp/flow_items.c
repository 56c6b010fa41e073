// What of a visited cell shows in its windows: walls' pieces, and the sides of boxes that face the eye.
// SPDX-License-Identifier: MIT
//
// Invariant: a window and a polygon in front of the eye share no inner point only if an edge of one of them parts them (convex, flat);
// of a polygon that reaches behind the eye the window's cut by its edges says so. A piece is drawn up to `slack` off its place, so
// edges move out by that.
#include "flow.h"
#include "pairs.h"

typedef struct flow_sight { // a window made ready
    const window *w;
    window_line edges[WINDOW_POINTS];
    double slacks[WINDOW_POINTS]; // by which a point that is drawn may lie outside the edge: its value there
} flow_sight;

static void sight_make(const flow *f, const window *w, flow_sight *out)
{
    out->w = w;
    window_edges(w, out->edges);
    for (uint32_t i = 0; i < w->count; i++)
        out->slacks[i] = f->slack * ((fabs(out->edges[i].a) + fabs(out->edges[i].b)) + fabs(out->edges[i].c));
}

typedef enum sight_fate { SIGHT_OUTSIDE, SIGHT_INSIDE, SIGHT_UNKNOWN } sight_fate;

// By the window's edges: all corners outside one, or one corner inside all. Of an odd count the first corner is taken once more.
static sight_fate window_parts(const flow_sight *s, const flow_shape *shape)
{
    const pair zero = pair_of(0);
    uint64_t inside = pair_bits(shape->count);
    for (uint32_t i = 0; i < s->w->count; i++) {
        const pair a = pair_of(s->edges[i].a), b = pair_of(s->edges[i].b), c = pair_of(s->edges[i].c), more = pair_of(s->slacks[i]);
        uint64_t within = 0;
        for (uint32_t k = 0; k < shape->count; k += PAIR) {
            const pair sum = pair_add(pair_mul(a, pair_load(shape->x + k)), pair_mul(b, pair_load(shape->y + k)));
            const pair at = pair_add(pair_add(sum, pair_mul(c, pair_load(shape->z + k))), more);
            within |= (uint64_t)pair_below(zero, at) << k;
        }
        if (!within) return SIGHT_OUTSIDE;
        inside &= within;
    }
    return inside ? SIGHT_INSIDE : SIGHT_UNKNOWN;
}

static int reaches_behind(const flow_shape *shape)
{
    int behind = 0;
    for (uint32_t k = 0; k < shape->count; k++) behind |= shape->z[k] <= 0;
    return behind;
}

// By the polygon's edges: all of the window outside one, or nothing of it inside all.
static sight_fate shape_parts(const flow *f, const window *w, const flow_shape *shape, double height)
{
    const double distance = shape->distance > height ? shape->distance : height;
    if (!(distance > f->near)) return SIGHT_INSIDE;
    const flow_margin margin = {0, f->slack * f->reach / (distance - f->slack), flow_rounding(f, shape->size)};
    window_line lines[FLOW_POINTS];
    flow_shape_edges(shape, margin, lines);
    for (uint32_t i = 0; i < shape->count; i++) {
        const window_line l = lines[i];
        if (window_line_least(l, w->bounds) > 0) continue;
        if (window_is_outside(w, l)) return SIGHT_OUTSIDE;
    }
    window left;
    return reaches_behind(shape) && window_cut(w, lines, shape->count, &left) == WINDOW_GONE ? SIGHT_OUTSIDE : SIGHT_INSIDE;
}

// Windows made ready, each where it is first asked for.
typedef struct flow_sights { const flow_visit *v; uint32_t ready; flow_sight all[FLOW_WINDOWS]; } flow_sights;

static const flow_sight *sight_get(const flow *f, flow_sights *sights, uint32_t i)
{
    if (!(sights->ready >> i & 1)) sight_make(f, sights->v->windows[i], &sights->all[i]);
    sights->ready |= 1u << i;
    return &sights->all[i];
}

static int shape_shows(const flow *f, const flow_sight *s, const flow_shape *shape, double height)
{
    const sight_fate fate = window_parts(s, shape);
    return fate == SIGHT_UNKNOWN ? shape_parts(f, s->w, shape, height) == SIGHT_INSIDE : fate == SIGHT_INSIDE;
}

// A side of a box that the eye stands outside of: the low one along the axis, or the high one.
static void box_side(const flow *f, const flow_word *box, int axis, int is_high, flow_shape *out)
{
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    cull_vec3 corners[4];
    for (int i = 0; i < 4; i++) {
        const int high[2] = {i == 1 || i == 2, i >= 2}; // counterclockwise seen from the axis' high end
        float p[3];
        p[axis] = box[(is_high ? FACE_BALL : FACE_PLANE) + axis].f;
        p[b] = box[(high[0] ? FACE_BALL : FACE_PLANE) + b].f;
        p[c] = box[(high[1] ? FACE_BALL : FACE_PLANE) + c].f;
        corners[i] = (cull_vec3){p[0], p[1], p[2]};
    }
    flow_shape_make(f, corners, 4, is_high ? FLOW_AS_STORED : FLOW_REVERSED, out);
}

// What shows of a box is the sides that face the eye; of one that the eye is in or at, all.
static int box_shows_in_any(const flow *f, flow_sights *sights, const flow_word *box)
{
    int is_inside = 1;
    for (int k = 0; k < 6; k++) {
        const int axis = k / 2, is_high = k % 2;
        const double at = (double)box[(is_high ? FACE_BALL : FACE_PLANE) + axis].f, height = is_high ? f->eye[axis] - at : at - f->eye[axis];
        flow_shape shape;
        if (height > f->near) is_inside = 0;
        if (height < -f->graze) continue;
        box_side(f, box, axis, is_high, &shape);
        for (uint32_t i = 0; i < sights->v->count; i++)
            if (shape_shows(f, sight_get(f, sights, i), &shape, height)) return 1;
    }
    return is_inside;
}

static void shape_turn(flow_shape *s)
{
    for (uint32_t i = 0, k = s->count; i < k; i++, k--) { // the first stands behind the last
        const double x = s->x[i], y = s->y[i], z = s->z[i];
        s->x[i] = s->x[k], s->y[i] = s->y[k], s->z[i] = s->z[k];
        s->x[k] = x, s->y[k] = y, s->z[k] = z;
    }
}

// A piece seen from the side that the cell does not lie on: what of it is in the windows is the guard band along its edges, where it
// competes for the pixels that its edges share with what hides it.
static int is_wanted_turned(const flow *f, uint32_t bits)
{
    return !(bits & FACE_ONE_SIDED) || bits & FACE_BACK || !f->q->backface;
}

static int piece_shows_in_any(const flow *f, flow_sights *sights, const flow_word *face)
{
    double height = flow_face_height(f, face);
    const int is_turned = height < -f->graze;
    if (is_turned && !is_wanted_turned(f, face[FACE_BITS].u)) return 0;
    if (is_turned) height = -height;
    if ((face[FACE_BITS].u & FACE_COUNT) > FLOW_POINTS) return 1;
    const flow_ball ball = flow_ball_of(f, face);
    if (flow_ball_is_outside(f, &sights->v->sides, &ball, height, 0)) return 0;
    flow_shape shape;
    shape.count = 0;
    for (uint32_t i = 0; i < sights->v->count; i++) {
        if (sights->v->count > 1 && flow_ball_is_outside(f, &sights->v->each[i], &ball, height, 0)) continue;
        if (shape.count == 0) {
            flow_shape_of(f, face, &ball, &shape);
            if (is_turned) shape_turn(&shape);
        }
        if (shape_shows(f, sight_get(f, sights, i), &shape, height)) return 1;
    }
    return 0;
}

void flow_items(flow *f, const flow_cell *cell, const flow_word *face, const flow_visit *v)
{
    uint8_t *drawn = f->q->drawn;
    flow_sights sights;
    sights.v = v;
    sights.ready = 0;
    const uint32_t entries = cell->entry_count + (f->q->backface ? 0 : cell->edge_count);
    for (uint32_t i = 0; i < entries; i++) {
        const uint32_t item = face[FACE_WHO].u, bits = face[FACE_BITS].u, count = bits & FACE_COUNT;
        const int is_left_out = f->q->backface && (bits & (FACE_ONE_SIDED | FACE_BACK)) == (FACE_ONE_SIDED | FACE_BACK);
        if (!drawn[item] && !is_left_out && (count ? piece_shows_in_any(f, &sights, face) : box_shows_in_any(f, &sights, face))) drawn[item] = 1;
        face += FACE_HEAD + 3 * (size_t)count;
    }
}
