// Where the flow starts: the volumes as windows, the cells at the eye, and the cells behind portals that the eye looks in through.
// SPDX-License-Identifier: MIT
//
// Invariant: a picture begins at its near plane, whose points lie within near_distance * reach of the eye. Every cell that the ball of
// that radius touches starts with the whole window, so it doesn't matter which of them a ray begins in, or what stands between.
#include "flow.h"

#include <string.h>

static const double NEAR_SHARE = 1.0 / 65536; // of the zone's radius, as the host counts an eye to be at a portal (DESIGN.md, rule 3)

// ---- The view ----

static double axis_along(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

// Right is the picture's own, so that rectangles lie as portals of upright walls do, and turn with the scene; any other will do.
int flow_axes(const cull_view *view, double axes[3][3])
{
    double *right = axes[0], *up = axes[1], *forward = axes[2];
    memcpy(forward, view->forward, sizeof view->forward);
    const double row[3] = {(double)view->clip_from_zone[0], (double)view->clip_from_zone[4], (double)view->clip_from_zone[8]};
    const double size = sqrt(axis_along(row, row)), ahead = axis_along(row, forward);
    if (size > 1e-30 && size < 1e30 && fabs(ahead) < 1e-3 * size) {
        for (int i = 0; i < 3; i++) right[i] = row[i] / size - ahead / size * forward[i];
    } else {
        const int k = fabs(forward[1]) < 0.75 ? 1 : 0; // an axis well off forward
        const double v[3] = {k == 0, k == 1, 0};
        right[0] = forward[1] * v[2] - forward[2] * v[1];
        right[1] = forward[2] * v[0] - forward[0] * v[2];
        right[2] = forward[0] * v[1] - forward[1] * v[0];
    }
    const double length = sqrt(axis_along(right, right));
    if (!(length > 0.5)) return 0; // forward is no unit vector
    for (int i = 0; i < 3; i++) right[i] /= length;
    up[0] = right[1] * forward[2] - right[2] * forward[1];
    up[1] = right[2] * forward[0] - right[0] * forward[2];
    up[2] = right[0] * forward[1] - right[1] * forward[0];
    return 1;
}

static int axes_make(const cull_view *view, flow *f)
{
    double axes[3][3];
    if (!flow_axes(view, axes)) return 0;
    for (int i = 0; i < 3; i++) {
        memcpy(f->axes[i], axes[i], sizeof axes[i]);
        f->axes[i][3] = -axis_along(axes[i], f->eye);
    }
    return 1;
}

static int view_take(flow *f)
{
    const cull_view *view = f->q->visit->view;
    if (!(view->eye[3] > 0)) return 0;
    for (int i = 0; i < 3; i++)
        if (!(fabs(view->eye_exact[i]) < 1e15) || !(fabs(view->forward[i]) < 1.001)) return 0;
    memcpy(f->eye, view->eye_exact, sizeof f->eye);
    f->reach = view->reach;
    if (!(f->reach >= 1 && f->reach < WINDOW_REACH_MOST / 4) || !axes_make(view, f)) return 0;
    f->radius = (double)f->q->zone->radius;
    for (int i = 0; i < 3; i++) f->radius = fabs(f->eye[i]) > f->radius ? fabs(f->eye[i]) : f->radius;
    f->slack = f->index->slack + 0x1p-48 * f->radius;
    f->guard_tangents = CULL_GUARD_PX * view->pixel_tangent;
    f->guard_share = 1.7320508075688772 * CULL_GUARD_DISTANCE * (1 + 1.0 / 262144) * f->reach;
    f->guard_wide = f->guard_tangents + f->guard_share * f->reach;
    f->near = (double)view->near_distance * f->reach + f->radius * NEAR_SHARE;
    if (f->near < 4 * f->slack) f->near = 4 * f->slack;
    f->graze = 2 * f->slack;
    f->slack_wide = f->slack < 0.5 ? f->slack * f->reach * f->reach / (1 - f->slack) : 1e9;
    return f->near < 1e15;
}

// ---- A volume's window ----

typedef enum volume_side { VOLUME_HOLDS_EYE, VOLUME_BEYOND_EYE, VOLUME_EMPTY } volume_side;

// A point at depth t of the ray q is inside where t n . q + height >= 0, and t is at least near_distance: n . q >= -height / near_distance
// holds for all of the ray that is drawn. Of a plane that has the eye outside, no ray gets inside where n . q <= 0. The volume's planes are
// guarded by the host already; here only what double rounds (2^-48 of the radius, over the near distance) is added.
static volume_side volume_window(const flow *f, const cull_volume *volume, window *out)
{
    window_line lines[CULL_MAX_PLANES];
    window whole;
    volume_side side = VOLUME_HOLDS_EYE;
    const double near_distance = (double)f->q->visit->view->near_distance, shortest = near_distance > 1e-6 ? near_distance : 1e-6;
    const double wide = f->reach * (1 + 0x1p-10) + f->guard_tangents + f->guard_share * f->reach;
    uint32_t count = 0;
    window_set_rectangle((window_bounds){-wide, wide, -wide, wide}, &whole);
    for (uint32_t i = 0; i < volume->plane_count && i < CULL_MAX_PLANES; i++) {
        const double n[3] = {(double)volume->planes[i].normal.x, (double)volume->planes[i].normal.y, (double)volume->planes[i].normal.z};
        const double height = ((n[0] * f->eye[0] + n[1] * f->eye[1]) + n[2] * f->eye[2]) + (double)volume->planes[i].offset;
        if (!(height > -f->near)) side = VOLUME_BEYOND_EYE;
        const double out_by = ((height > 0 ? height : 0) + 0x1p-48 * f->radius) / shortest;
        double at[3];
        for (int k = 0; k < 3; k++) at[k] = (n[0] * f->axes[k][0] + n[1] * f->axes[k][1]) + n[2] * f->axes[k][2];
        lines[count++] = (window_line){at[0], at[1], at[2] + out_by};
    }
    const window_fate fate = window_cut(&whole, lines, count, out);
    if (fate == WINDOW_SAME) *out = whole;
    return fate == WINDOW_GONE ? VOLUME_EMPTY : side;
}

// ---- Cells at the eye ----

static int cell_has_front(const flow *f, uint32_t number)
{
    return number < f->index->cell_count && f->index->cells[number].front_count > 0;
}

static int eye_is_in_box(const flow *f)
{
    for (int k = 0; k < 3; k++)
        if (!(f->eye[k] >= f->cells->box_low[k] && f->eye[k] <= f->cells->box_high[k])) return 0;
    return 1;
}

// Of the eye, or BSP_NONE.
static uint32_t eye_cell(const flow *f)
{
    uint32_t at = f->cells->node_count ? 0 : BSP_LEAF;
    if (!eye_is_in_box(f)) return BSP_NONE;
    while (!(at & BSP_LEAF)) at = f->index->nodes[at].child[flow_node_height(f, &f->index->nodes[at]) < 0];
    return at & ~BSP_LEAF;
}

// 1: the eye's own cell shows the front of a wall and lies beyond no portal: it is air, of this zone. Else nothing is known.
static int eye_is_in_air(const flow *f)
{
    const uint32_t cell = eye_cell(f);
    return cell_has_front(f, cell) && !f->cells->cells[cell].is_beyond;
}

// 1: the eye's own cell shows walls from behind alone.
static int eye_is_behind_walls(const flow *f)
{
    const uint32_t cell = eye_cell(f);
    return cell < f->index->cell_count && f->index->cells[cell].front_count == 0 && f->cells->cells[cell].back_count > 0;
}

typedef enum start_cells { START_ALL, START_AIR } start_cells;

static void start_at_eye(flow *f, const window *w, start_cells which)
{
    uint32_t count = 1;
    f->stack[0] = f->cells->node_count ? 0 : BSP_LEAF;
    while (count > 0) {
        const uint32_t at = f->stack[--count];
        if (at & BSP_LEAF) {
            const uint32_t cell = at & ~BSP_LEAF;
            if (cell >= f->index->cell_count || (which == START_AIR && !cell_has_front(f, cell))) continue;
            flow_add(f, FLOW_NOW, cell, w);
            if (f->q->visit->volume_count == 1) f->states[cell] |= FLOW_STARTED;
            continue;
        }
        const flow_node *node = &f->index->nodes[at];
        const double height = flow_node_height(f, node);
        if (height >= -f->near) f->stack[count++] = node->child[0];
        if (height <= f->near) f->stack[count++] = node->child[1];
    }
}

// ---- Portals ----

// Of the eye, positive on the side that the rays come from.
static double portal_height(const flow *f, const cull_portal *p, portal_way way)
{
    const double n[3] = {(double)p->plane.normal.x, (double)p->plane.normal.y, (double)p->plane.normal.z};
    const double height = ((n[0] * f->eye[0] + n[1] * f->eye[1]) + n[2] * f->eye[2]) + (double)p->plane.offset;
    return way == PORTAL_OUT ? height : -height;
}

// The eye is so near that the portal lets everything pass.
static int is_at_portal(const flow *f, const cull_portal *p)
{
    flow_shape s;
    if (fabs(portal_height(f, p, PORTAL_IN)) > f->near || p->point_count > FLOW_POINTS) return 0;
    flow_shape_make(f, p->points, p->point_count, FLOW_REVERSED, &s);
    return s.distance <= f->near;
}

static int is_at_any_portal(const flow *f)
{
    for (uint32_t i = 0; i < f->cells->portal_count; i++)
        if (is_at_portal(f, &f->q->zone->portals[i])) return 1;
    return 0;
}

// Each stand stands for itself: of one nearer than `near` all passes; what else passes a portal in whose plane the eye all but lies is a line.
window_fate flow_through_stand(const flow *f, const cull_portal *p, const bsp_stand *stand, portal_way way, const window *w, window *out)
{
    flow_shape s;
    flow_gate gate;
    const double height = portal_height(f, p, way);
    if (height < -f->near) return WINDOW_GONE;
    if (stand->point_count > FLOW_POINTS) {
        f->figures->limits_hit++;
        return WINDOW_SAME;
    }
    flow_shape_make(f, f->cells->stand_points + stand->first_point, stand->point_count, way == PORTAL_OUT ? FLOW_AS_STORED : FLOW_REVERSED, &s);
    s.is_bent = stand->is_bent;
    if (fabs(height) <= f->near && s.distance <= f->near) return WINDOW_SAME;
    if (height < -f->graze) return WINDOW_GONE;
    const double normal[3] = {(double)p->plane.normal.x, (double)p->plane.normal.y, (double)p->plane.normal.z};
    if (height > f->graze) flow_gate_make(f, &s, height, &gate);
    else flow_gate_make_grazing(f, &s, normal, height, &gate);
    return window_cut(w, gate.lines, gate.count, out);
}

static void start_at_portal(flow *f, flow_when when, uint32_t portal, const window *w)
{
    for (uint32_t i = f->cells->portal_offsets[portal]; i < f->cells->portal_offsets[portal + 1]; i++) {
        const bsp_stand *stand = &f->cells->stands[i];
        window cut;
        const window_fate fate = flow_through_stand(f, &f->q->zone->portals[portal], stand, PORTAL_IN, w, &cut);
        if (fate != WINDOW_GONE) flow_add(f, when, stand->cell, fate == WINDOW_SAME ? w : &cut);
    }
}

static void start_at_portals(flow *f, flow_when when, const window *w)
{
    for (uint32_t i = 0; i < f->cells->portal_count; i++) start_at_portal(f, when, i, w);
}

// Through the portal that the volume came in through, where it tells; what is seen round a ring of zones is a volume of its own.
static void start_at_entry(flow *f, const cull_volume *volume, const window *w)
{
    if (volume->entry > 0 && volume->entry <= f->cells->portal_count) start_at_portal(f, FLOW_NOW, volume->entry - 1, w);
    else start_at_portals(f, FLOW_NOW, w);
}

// What of the window left the zone through portals. 0: nothing.
static int leaving_find(const flow *f, const window *w, window_bounds *out)
{
    const bsp_cells_data *c = f->cells;
    int any = 0;
    *out = (window_bounds){WINDOW_REACH_MOST, -WINDOW_REACH_MOST, WINDOW_REACH_MOST, -WINDOW_REACH_MOST};
    for (uint32_t p = 0; p < c->portal_count; p++)
        for (uint32_t i = c->portal_offsets[p]; i < c->portal_offsets[p + 1]; i++) {
            const bsp_stand *stand = &c->stands[i];
            window seen, cut;
            if (!(f->states[stand->cell] & FLOW_SEEN) || !window_bounds_touch(f->slots[0][stand->cell].bounds, w->bounds)) continue;
            window_set_rectangle(f->slots[0][stand->cell].bounds, &seen);
            const window_fate fate = flow_through_stand(f, &f->q->zone->portals[p], stand, PORTAL_OUT, &seen, &cut);
            if (fate == WINDOW_GONE) continue;
            *out = window_bounds_union(*out, fate == WINDOW_SAME ? seen.bounds : cut.bounds);
            any = 1;
        }
    return any;
}

// An eye in the zone sees through a portal's far side only what left the zone before: rays that come round a ring of zones.
void flow_start_again(flow *f)
{
    const cull_visit *visit = f->q->visit;
    window w, cut;
    window_bounds left;
    if (f->cells->portal_count < 2 || !eye_is_in_air(f)) return;
    for (uint32_t v = 0; v < visit->volume_count; v++) {
        if (volume_window(f, &visit->volumes[v], &w) != VOLUME_HOLDS_EYE || !leaving_find(f, &w, &left)) continue;
        const window_line lines[4] = {{1, 0, -left.u0}, {-1, 0, left.u1}, {0, 1, -left.v0}, {0, -1, left.v1}};
        const window_fate fate = window_cut(&w, lines, 4, &cut);
        if (fate != WINDOW_GONE) start_at_portals(f, FLOW_NEXT, fate == WINDOW_SAME ? &w : &cut);
    }
}

// An eye in rock, by a hair or more, sees along behind the walls: what leaves the zone there leaves from cells that no portal lists.
static void exits_open(flow *f, const window *w)
{
    for (uint32_t i = 0; i < f->cells->portal_count; i++) flow_exit_add(f, i, w);
}

// The volume came in through a portal that borders no cell that is known.
static int has_lost_entry(const flow *f, const cull_volume *volume)
{
    const uint32_t *offsets = f->cells->portal_offsets;
    return volume->entry > 0 && volume->entry <= f->cells->portal_count && offsets[volume->entry - 1] == offsets[volume->entry];
}

int flow_start(flow *f)
{
    const cull_visit *visit = f->q->visit;
    if (!view_take(f) || f->q->zone->portal_count != f->cells->portal_count) return 0;
    const int is_in_air = eye_is_in_air(f), is_at_portal_now = is_at_any_portal(f);
    for (uint32_t v = 0; v < visit->volume_count; v++) {
        window w;
        const volume_side side = volume_window(f, &visit->volumes[v], &w);
        if (side == VOLUME_EMPTY) continue;
        // An eye outside sees the zone through a portal where it is at one; else nothing is known of what stands between, and from there
        // the backs of walls are seen through. Cells end at their box.
        if (side == VOLUME_HOLDS_EYE && !is_in_air && !is_at_portal_now && !eye_is_in_box(f)) return 0;
        if (side == VOLUME_HOLDS_EYE) start_at_eye(f, &w, !is_in_air && is_at_portal_now ? START_AIR : START_ALL);
        if (side == VOLUME_HOLDS_EYE && !is_at_portal_now && f->q->exits == BSP_EXITS_KEPT && eye_is_behind_walls(f)) exits_open(f, &w);
        if (side == VOLUME_BEYOND_EYE && has_lost_entry(f, &visit->volumes[v])) return 0;
        if (side == VOLUME_BEYOND_EYE) start_at_entry(f, &visit->volumes[v], &w);
        else if (!is_in_air) start_at_portals(f, FLOW_NOW, &w);
    }
    return 1;
}
