// What leaves the zone through its portals: the windows of the cells that border them, cut by the portals.
// SPDX-License-Identifier: MIT
// Invariant: a ray that leaves through a portal lies in a window of the cell that it leaves from, so in one of the portal's.
#include "flow.h"

void flow_exits_mark(flow *f)
{
    const bsp_cells_data *c = f->cells;
    for (uint32_t p = 0; p < c->portal_count; p++)
        for (uint32_t i = c->portal_offsets[p]; i < c->portal_offsets[p + 1]; i++) f->states[c->portal_cells[i]] |= FLOW_AT_PORTAL;
}

static int borders(const bsp_cells_data *c, uint32_t portal, uint32_t cell)
{
    for (uint32_t i = c->portal_offsets[portal]; i < c->portal_offsets[portal + 1]; i++)
        if (c->portal_cells[i] == cell) return 1;
    return 0;
}

void flow_exits_note(flow *f, uint32_t cell, const window *const *windows, uint32_t window_count)
{
    for (uint32_t p = 0; p < f->cells->portal_count; p++) {
        if (!borders(f->cells, p, cell)) continue;
        for (uint32_t i = 0; i < window_count; i++) {
            window cut;
            const window_fate fate = flow_through_portal(f, &f->q->zone->portals[p], PORTAL_OUT, windows[i], &cut);
            if (fate != WINDOW_GONE) flow_exit_add(f, p, fate == WINDOW_SAME ? windows[i] : &cut);
        }
    }
}
