// What leaves the zone through its portals: the windows of the cells that border them, cut by the part of the portal that does.
// SPDX-License-Identifier: MIT
// Invariant: a ray that leaves through a portal lies in a window of the cell that it leaves from, so in one of the portal's.
#include "flow.h"

void flow_exits_mark(flow *f)
{
    const bsp_cells_data *c = f->cells;
    for (uint32_t i = 0; i < c->portal_offsets[c->portal_count]; i++) f->states[c->stands[i].cell] |= FLOW_AT_PORTAL;
}

static void stand_note(flow *f, uint32_t portal, const bsp_stand *stand, const window *const *windows, uint32_t window_count)
{
    for (uint32_t i = 0; i < window_count; i++) {
        window cut;
        const window_fate fate = flow_through_stand(f, &f->q->zone->portals[portal], stand, PORTAL_OUT, windows[i], &cut);
        if (fate != WINDOW_GONE) flow_exit_add(f, portal, fate == WINDOW_SAME ? windows[i] : &cut);
    }
}

void flow_exits_note(flow *f, uint32_t cell, const window *const *windows, uint32_t window_count)
{
    const bsp_cells_data *c = f->cells;
    for (uint32_t p = 0; p < c->portal_count; p++)
        for (uint32_t i = c->portal_offsets[p]; i < c->portal_offsets[p + 1]; i++)
            if (c->stands[i].cell == cell) stand_note(f, p, &c->stands[i], windows, window_count);
}
