// The flow of a step: windows go from cell to cell, nearest first, so that each cell is visited once with all that it is seen through
// (Luebke and Georges, Portals and Mirrors, 1995; the order of a BSP: Fuchs, Kedem and Naylor, 1980).
// SPDX-License-Identifier: MIT
//
// Invariant: an opening leads from the eye's side of its node's plane to the other, so a cell's windows are complete when its turn
// comes. An eye within `graze` of a plane stands on both its sides: a ray within rounding of the plane may cross it either way, and the
// order can't serve both. What such crossings let through, slivers along the plane, waits for the next pass; a ray crosses a plane
// once, three planes through one point are the most that matter: four passes.
//
// The guard: a ray that is really drawn passes an opening within `slack` of its exact polygon, for positions are rounded to float.
// At a distance r of the eye that turns the ray by slack / r. A line n . q >= 0 (q at depth 1, |q| <= reach) is met at depth t >= r / reach,
// so n . q >= -slack * reach / r. Added to the guard band of plane.h (pixels, widening), each once, when the line is made: the windows
// that the lines cut are not moved again, so nothing adds up along a way of many openings.
#include "flow.h"

#include <string.h>

// ---- Through an opening ----

typedef struct passage { // an opening as it is seen
    flow_when when;
    uint32_t to;
    double height; // the eye's above its plane
    flow_ball ball;
    flow_gate gate;
} passage;

static void windows_pass(flow *f, const passage *p, const flow_visit *v)
{
    window out;
    for (uint32_t i = 0; i < v->count; i++) {
        if (v->count > 1 && flow_ball_is_outside(f, &v->each[i], &p->ball, p->height, f->guard_wide)) continue;
        const window_fate fate = window_cut(v->windows[i], p->gate.lines, p->gate.count, &out);
        if (fate == WINDOW_GREW) f->figures->limits_hit++;
        if (fate != WINDOW_GONE) flow_add(f, p->when, p->to, fate == WINDOW_SAME ? v->windows[i] : &out);
    }
}

static void opening_pass(flow *f, const flow_word *face, const flow_visit *v)
{
    passage p;
    p.height = flow_face_height(f, face);
    p.to = face[FACE_WHO].u;
    if (p.height < -f->graze || f->states[p.to] & FLOW_STARTED) return;
    p.when = p.height <= f->graze ? FLOW_NEXT : FLOW_NOW;
    p.ball = flow_ball_of(f, face);
    if (flow_ball_is_outside(f, &v->sides, &p.ball, p.height, f->guard_wide)) return;
    f->figures->openings_tried++;
    p.gate.count = 0;
    if ((face[FACE_BITS].u & FACE_COUNT) > FLOW_POINTS) {
        f->figures->limits_hit++; // taken as seen whole
    } else {
        flow_shape s;
        flow_shape_of(f, face, &p.ball, &s);
        const double normal[3] = {(double)face[0].f, (double)face[1].f, (double)face[2].f};
        if (p.when == FLOW_NOW) flow_gate_make(f, &s, p.height, &p.gate);
        else flow_gate_make_grazing(f, &s, normal, p.height, &p.gate); // seen edge on: what passes waits for the next pass
    }
    windows_pass(f, &p, v);
}

// ---- Cells, front to back ----

static void slot_free(flow *f, flow_slot *slot)
{
    for (uint32_t at = slot->first; at != WINDOW_NONE;) {
        const uint32_t next = f->pool[at].next;
        f->pool[at].next = f->pool_free;
        f->pool_free = at;
        at = next;
    }
    slot->first = WINDOW_NONE;
    slot->count = 0;
}

static const flow_word *face_after(const flow_word *face)
{
    return face + FACE_HEAD + 3 * (size_t)(face[FACE_BITS].u & FACE_COUNT);
}

static void visit(flow *f, uint32_t number)
{
    const flow_cell *cell = &f->index->cells[number];
    const flow_word *face = f->index->words + cell->first_word;
    flow_slot *slot = &f->slots[f->turn][number];
    const uint8_t waits = f->turn == 0 ? FLOW_WAITS : FLOW_WAITS_NEXT;
    window rectangle;
    flow_visit v;
    v.count = 0;
    v.sides = flow_sides_of(slot->bounds);
    for (uint32_t at = slot->first; at != WINDOW_NONE && v.count < FLOW_WINDOWS; at = f->pool[at].next) v.windows[v.count++] = &f->pool[at];
    if (v.count == 0) {
        window_set_rectangle(slot->bounds, &rectangle);
        v.windows[v.count++] = &rectangle;
    }
    for (uint32_t i = 0; i < v.count && v.count > 1; i++) v.each[i] = flow_sides_of(v.windows[i]->bounds);
    f->states[number] = (uint8_t)((f->states[number] & ~waits) | FLOW_SEEN);
    f->figures->cells_visited++;
    for (uint32_t i = 0; i < cell->opening_count; i++) {
        opening_pass(f, face, &v);
        face = face_after(face);
    }
    flow_items(f, cell, face, &v);
    if (f->states[number] & FLOW_AT_PORTAL) flow_exits_note(f, number, v.windows, v.count);
    slot_free(f, slot);
}

static void walk(flow *f)
{
    const uint8_t waits = f->turn == 0 ? FLOW_WAITS : FLOW_WAITS_NEXT;
    uint32_t count = 1;
    f->stack[0] = f->cells->node_count ? 0 : BSP_LEAF;
    while (count > 0) {
        const uint32_t at = f->stack[--count];
        if (at & BSP_LEAF) {
            const uint32_t cell = at & ~BSP_LEAF;
            if (cell < f->cells->cell_count && f->states[cell] & waits) visit(f, cell);
            continue;
        }
        if (!f->marks[at]) continue;
        const flow_node *node = &f->index->nodes[at];
        const uint32_t near = flow_node_height(f, node) < 0;
        f->stack[count++] = node->child[1 - near];
        f->stack[count++] = node->child[near];
    }
}

static void mark(flow *f, uint32_t cell)
{
    for (uint32_t node = f->index->cells[cell].parent; node != BSP_NONE && !f->marks[node]; node = f->index->nodes[node].parent) f->marks[node] = 1;
}

static void passes(flow *f)
{
    for (uint32_t pass = 0; pass < FLOW_PASSES; pass++) {
        walk(f);
        if (pass == 0) flow_start_again(f);
        if (f->later_count == 0) return;
        memset(f->marks, 0, f->cells->node_count);
        for (uint32_t i = 0; i < f->later_count; i++) mark(f, f->later[i]);
        f->later_count = 0;
        f->turn = 1 - f->turn;
    }
}

// ---- Windows that wait ----

static uint32_t block_take(flow *f)
{
    const uint32_t at = f->pool_free;
    if (at != WINDOW_NONE) {
        f->pool_free = f->pool[at].next;
        return at;
    }
    return f->pool_used < f->pool_size ? f->pool_used++ : WINDOW_NONE;
}

static void block_grow_hull(flow *f, uint32_t block, const window *w)
{
    window hull;
    const window_fate fate = window_hull(&f->pool[block], w, &hull);
    if (fate == WINDOW_SAME) return;
    if (fate == WINDOW_GREW) f->figures->limits_hit++;
    window_copy(&hull, &f->pool[block]);
}

// The window whose rectangle grows least takes it in.
static void slot_grow_nearest(flow *f, flow_slot *slot, const window *w)
{
    uint32_t best = slot->first;
    double least = 1e300;
    for (uint32_t at = slot->first; at != WINDOW_NONE; at = f->pool[at].next) {
        const window_bounds a = f->pool[at].bounds, b = window_bounds_union(a, w->bounds);
        const double growth = (b.u1 - b.u0) * (b.v1 - b.v0) - (a.u1 - a.u0) * (a.v1 - a.v0);
        if (growth < least) {
            least = growth;
            best = at;
        }
    }
    block_grow_hull(f, best, w);
}

// Share of a hull's area that two windows may lack to be joined. Exact: the guard band makes neighbours overlap, and bends their common
// edges, by some 1/10,000 of a window; 1/2048 costs a tenth more time for the same excess, 1/128 a tenth less for up to 0.003 more.
// Hull: fewer windows are cut sooner; 1/8 draws up to 0.016 less in a tenth more time. No margin: a join never takes anything away.
static const double JOIN_SPARE_EXACT = 1.0 / 512, JOIN_SPARE_HULL = 1.0 / 4;

// Takes out of the list what `w` swallows; 1: w is swallowed itself. *w grows by what it joins.
static int slot_swallow(flow *f, flow_slot *slot, window *w)
{
    const double spare = f->q->how == BSP_CELLS_HULL ? JOIN_SPARE_HULL : JOIN_SPARE_EXACT;
    window joined;
    uint32_t *link = &slot->first;
    while (*link != WINDOW_NONE) {
        const uint32_t at = *link;
        window *old = &f->pool[at];
        if (window_contains(old, w)) return 1;
        const int is_inside = window_contains(w, old);
        if (!is_inside && !window_join(old, w, spare, &joined)) {
            link = &old->next;
            continue;
        }
        *link = old->next;
        old->next = f->pool_free;
        f->pool_free = at;
        slot->count--;
        if (is_inside) continue;
        window_copy(&joined, w);
        link = &slot->first; // it may now meet those that it passed; the list is shorter by one, so this ends
    }
    return 0;
}

static void slot_add(flow *f, flow_slot *slot, const window *in)
{
    const uint32_t most = f->q->how == BSP_CELLS_HULL ? FLOW_HULL_WINDOWS : FLOW_WINDOWS;
    window w;
    window_copy(in, &w);
    if (slot_swallow(f, slot, &w)) return;
    const uint32_t block = slot->count < most ? block_take(f) : WINDOW_NONE;
    if (block == WINDOW_NONE) { // none is in the list only where all that was there was swallowed, and then a block is free
        if (f->q->how == BSP_CELLS_EXACT || slot->count < most) f->figures->limits_hit++;
        slot_grow_nearest(f, slot, &w);
        return;
    }
    window_copy(&w, &f->pool[block]);
    f->pool[block].next = slot->first;
    slot->first = block;
    slot->count++;
}

static void slot_open(flow *f, flow_slot *slot, const window *w)
{
    slot->bounds = w->bounds;
    slot->first = WINDOW_NONE;
    slot->count = 0;
    if (f->q->how == BSP_CELLS_RECT) return;
    const uint32_t block = block_take(f);
    if (block == WINDOW_NONE) {
        f->figures->limits_hit++; // the slot's rectangle is its window
        return;
    }
    window_copy(w, &f->pool[block]);
    f->pool[block].next = WINDOW_NONE;
    slot->first = block;
    slot->count = 1;
}

static void slot_more(flow *f, flow_slot *slot, const window *w)
{
    f->figures->merges++;
    slot->bounds = window_bounds_union(slot->bounds, w->bounds);
    if (slot->first == WINDOW_NONE) return;
    slot_add(f, slot, w);
}

// Calls up what the visit will read, for it comes at once or after few others.
static void cell_call(const flow *f, uint32_t cell)
{
#if defined(__GNUC__)
    const char *words = (const char *)(f->index->words + f->index->cells[cell].first_word);
    for (int i = 0; i < 8; i++) __builtin_prefetch(words + 64 * i); // what a cell holds on the average
#else
    (void)f, (void)cell;
#endif
}

void flow_add(flow *f, flow_when when, uint32_t cell, const window *w)
{
    const uint32_t which = when == FLOW_NOW ? f->turn : 1 - f->turn;
    const uint8_t waits = which == 0 ? FLOW_WAITS : FLOW_WAITS_NEXT;
    flow_slot *slot = &f->slots[which][cell];
    if (!(f->states[cell] & waits)) {
        f->states[cell] |= waits;
        slot_open(f, slot, w);
        cell_call(f, cell);
        if (when == FLOW_NOW) mark(f, cell);
        else f->later[f->later_count++] = cell;
        return;
    }
    slot_more(f, slot, w);
}

void flow_exit_add(flow *f, uint32_t portal, const window *w)
{
    if (f->has_exit[portal]) {
        slot_more(f, &f->exits[portal], w);
        return;
    }
    f->has_exit[portal] = 1;
    slot_open(f, &f->exits[portal], w);
}

// ---- A step ----

static size_t rounded_up(size_t bytes)
{
    return (bytes + 63) / 64 * 64;
}

typedef struct flow_layout { size_t slots, exits, pool, stack, later, marks, states, has_exit, total; uint32_t pool_size; } flow_layout;

static uint32_t fewer(size_t a, uint32_t b)
{
    return a < b ? (uint32_t)a : b;
}

static flow_layout layout_of(const bsp_cells_data *cells, bsp_cells how)
{
    const size_t n = cells->cell_count, nodes = cells->node_count;
    flow_layout l = {0};
    const size_t places = n + cells->portal_count;
    l.pool_size = how == BSP_CELLS_EXACT ? fewer(64 + 8 * places, FLOW_EXACT_BLOCKS) : how == BSP_CELLS_HULL ? fewer(16 + 2 * places, FLOW_HULL_BLOCKS) : 0;
    l.exits = rounded_up(((size_t)cells->portal_count + 1) * sizeof(flow_slot));
    l.has_exit = rounded_up((size_t)cells->portal_count + 1);
    l.slots = rounded_up(n * sizeof(flow_slot));
    l.pool = rounded_up(l.pool_size * sizeof(window));
    l.stack = rounded_up((nodes + 2) * sizeof(uint32_t));
    l.later = rounded_up((n + 1) * sizeof(uint32_t));
    l.marks = rounded_up(nodes + 1);
    l.states = rounded_up(n + 1);
    l.total = l.exits + l.has_exit + 2 * l.slots + l.pool + l.stack + l.later + l.marks + l.states;
    return l;
}

size_t bsp_flow_scratch(const bsp_cells_data *cells, bsp_cells how)
{
    return layout_of(cells, how).total;
}

static void scratch_lay(flow *f)
{
    const flow_layout l = layout_of(f->cells, f->q->how);
    char *at = f->q->scratch;
    f->exits = (flow_slot *)(void *)at;
    f->has_exit = (uint8_t *)(at += l.exits);
    f->slots[0] = (flow_slot *)(void *)(at += l.has_exit);
    f->slots[1] = (flow_slot *)(void *)(at += l.slots);
    f->pool = (window *)(void *)(at += l.slots);
    f->stack = (uint32_t *)(void *)(at += l.pool);
    f->later = (uint32_t *)(void *)(at += l.stack);
    f->marks = (uint8_t *)(at += l.later);
    f->states = (uint8_t *)(at += l.marks);
    f->pool_size = l.pool_size;
    f->pool_free = WINDOW_NONE;
    memset(f->marks, 0, f->cells->node_count);
    memset(f->states, 0, f->cells->cell_count);
    memset(f->has_exit, 0, f->cells->portal_count);
}

int bsp_flow(const bsp_flow_request *q, bsp_flow_figures *out)
{
    const bsp_flow_figures none = {0, 0, 0, 0};
    *out = none;
    if (q->how == BSP_CELLS_OFF || q->index->cell_count == 0) return 0;
    flow f = {.q = q, .cells = q->cells, .index = q->index, .figures = out};
    scratch_lay(&f);
    if (q->exits == BSP_EXITS_KEPT) flow_exits_mark(&f);
    if (!flow_start(&f)) {
        *out = none;
        return 0;
    }
    passes(&f);
    return 1;
}

uint32_t bsp_flow_exit(const bsp_flow_request *q, uint32_t portal, window *rectangle, const window **windows)
{
    const flow_layout l = layout_of(q->cells, q->how);
    const char *at = q->scratch;
    const flow_slot *slot = (const flow_slot *)(const void *)at + portal;
    const window *pool = (const window *)(const void *)(at + l.exits + l.has_exit + 2 * l.slots);
    uint32_t count = 0;
    if (!((const uint8_t *)at + l.exits)[portal]) return 0;
    for (uint32_t w = slot->first; w != WINDOW_NONE && count < FLOW_WINDOWS; w = pool[w].next) windows[count++] = &pool[w];
    if (count) return count;
    window_set_rectangle(slot->bounds, rectangle);
    windows[0] = rectangle;
    return 1;
}
