// What the build found, filed by cell: the openings that leave each, the cells at each zone portal.
// SPDX-License-Identifier: MIT
// Invariant: counting sorts, so the order is that of the nodes, the same on every machine.
#include "cells_build.h"

// ---- Openings ----

static uint32_t openings_count(const cells_build *b, bsp_cell *cells)
{
    const cells_interface *found = b->interfaces.items;
    uint32_t total = 0;
    for (uint32_t i = 0; i < b->interfaces.count; i++)
        for (uint32_t side = 0; side < 2; side++) cells[found[i].cells[side]].opening_count += found[i].open >> side & 1;
    for (uint32_t i = 0; i < b->cells.count; i++) {
        cells[i].first_opening = total;
        total += cells[i].opening_count;
        cells[i].opening_count = 0;
    }
    return total;
}

static void points_turn(const cull_point *from, uint32_t count, cull_point *to)
{
    for (uint32_t i = 0; i < count; i++) to[i] = from[count - 1 - i];
}

// An opening's points stand once for each way that it is open.
static cells_status openings_file(cells_build *b, bsp_cells_data *out)
{
    const cells_interface *found = b->interfaces.items;
    cells_list openings = cells_list_make(b->host, sizeof(bsp_opening)), points = cells_list_make(b->host, sizeof(cull_point));
    bsp_cell *cells = b->cells.items;
    const uint32_t total = openings_count(b, cells);
    uint64_t corners = 0;
    for (uint32_t i = 0; i < b->interfaces.count; i++) corners += (uint64_t)found[i].point_count * ((found[i].open & 1) + (found[i].open >> 1));
    bsp_opening *to = cells_list_push(&openings, total);
    cull_point *loops = corners <= UINT32_MAX ? cells_list_reserve(&points, (uint32_t)corners) : 0;
    cells_status status = total && (!to || !loops) ? CELLS_NO_MEMORY : CELLS_FINE;
    for (uint32_t i = 0; i < b->interfaces.count && status == CELLS_FINE; i++)
        for (uint32_t side = 0; side < 2; side++) {
            if (!(found[i].open >> side & 1)) continue;
            bsp_cell *from = &cells[found[i].cells[side]];
            const cull_point *loop = (const cull_point *)b->opening_points.items + found[i].first_point;
            to[from->first_opening + from->opening_count++] = (bsp_opening){found[i].cells[!side], found[i].plane, side, points.count, found[i].point_count};
            if (side) points_turn(loop, found[i].point_count, loops + points.count);
            else memcpy(loops + points.count, loop, found[i].point_count * sizeof *loop);
            points.count += found[i].point_count;
        }
    if (status == CELLS_FINE && !cells_list_take(&openings, &out->openings, &out->opening_count)) status = CELLS_NO_MEMORY;
    if (status == CELLS_FINE && !cells_list_take(&points, &out->opening_points, &out->opening_point_count)) status = CELLS_NO_MEMORY;
    cells_list_free(&openings);
    cells_list_free(&points);
    return status;
}

// ---- Portals ----

// A portal may be larger than its hole: around it lies rock, where nobody looks out of. A portal with nothing else behind it (a zone that
// is inside out) keeps all of its cells.
static void stands_thin(cells_build *b, uint8_t *has_air)
{
    cells_stand *stands = b->stands.items;
    uint32_t kept = 0;
    memset(has_air, 0, b->zone->portal_count);
    for (uint32_t i = 0; i < b->stands.count; i++) has_air[stands[i].portal] |= !cells_is_rock(b, stands[i].cell);
    for (uint32_t i = 0; i < b->stands.count; i++)
        if (!has_air[stands[i].portal] || !cells_is_rock(b, stands[i].cell)) stands[kept++] = stands[i];
    b->stands.count = kept;
}

// By portal, and in it by cell where they come so; the same cell twice in a row only counts once.
static void stands_sort(const cells_build *b, uint32_t *starts, uint32_t *cells)
{
    const cells_stand *stands = b->stands.items;
    const uint32_t portals = b->zone->portal_count, count = b->stands.count;
    memset(starts, 0, (portals + (size_t)1) * sizeof *starts);
    for (uint32_t i = 0; i < count; i++) starts[stands[i].portal]++;
    for (uint32_t p = 0, total = 0; p <= portals; p++) {
        const uint32_t own = starts[p];
        starts[p] = total;
        total += own;
    }
    for (uint32_t i = 0; i < count; i++) cells[starts[stands[i].portal]++] = stands[i].cell;
    for (uint32_t p = portals; p > 0; p--) starts[p] = starts[p - 1];
    starts[0] = 0;
}

// Ascending cells, each once: few a portal.
static uint32_t stands_once(uint32_t *starts, uint32_t *cells, uint32_t portals)
{
    uint32_t kept = 0;
    for (uint32_t p = 0, first = 0; p < portals; p++) {
        const uint32_t end = starts[p + 1], own = kept;
        for (uint32_t i = first; i < end; i++) {
            uint32_t at = kept;
            const uint32_t cell = cells[i];
            while (at > own && cells[at - 1] >= cell) at--;
            if (at < kept && cells[at] == cell) continue;
            memmove(cells + at + 1, cells + at, (kept - at) * sizeof *cells);
            cells[at] = cell;
            kept++;
        }
        first = end;
        starts[p] = own;
    }
    starts[portals] = kept;
    return kept;
}

static cells_status portals_file(cells_build *b, bsp_cells_data *out)
{
    const uint32_t portals = b->zone->portal_count, count = b->stands.count;
    cells_list offsets = cells_list_make(b->host, sizeof(uint32_t)), cells = offsets;
    cells_list air = cells_list_make(b->host, 1);
    uint32_t *starts = cells_list_push(&offsets, portals + 1), *to = cells_list_push(&cells, count);
    uint8_t *has_air = cells_list_push(&air, portals);
    cells_status status = starts && (to || !count) && (has_air || !portals) ? CELLS_FINE : CELLS_NO_MEMORY;
    if (status == CELLS_FINE) {
        if (portals) stands_thin(b, has_air);
        stands_sort(b, starts, to);
        cells.count = stands_once(starts, to, portals);
    }
    uint32_t made;
    if (status == CELLS_FINE && !cells_list_take(&offsets, &out->portal_offsets, &made)) status = CELLS_NO_MEMORY;
    out->portal_count = status == CELLS_FINE ? portals : 0;
    if (status == CELLS_FINE && !cells_list_take(&cells, &out->portal_cells, &out->portal_cell_count)) status = CELLS_NO_MEMORY;
    cells_list_free(&offsets);
    cells_list_free(&cells);
    cells_list_free(&air);
    return status;
}

// ---- The whole ----

cells_status cells_hand_over(cells_build *b, bsp_cells_data *out)
{
    cells_status status = openings_file(b, out);
    if (status == CELLS_FINE) status = portals_file(b, out);
    if (status != CELLS_FINE) return status;
    b->planes.count = b->plane_count;
    const int handed = cells_list_take(&b->planes, &out->planes, &out->plane_count) && cells_list_take(&b->nodes, &out->nodes, &out->node_count) &&
                       cells_list_take(&b->cells, &out->cells, &out->cell_count) && cells_list_take(&b->entries, &out->entries, &out->entry_count) &&
                       cells_list_take(&b->entry_points, &out->entry_points, &out->entry_point_count);
    out->slack = b->slack;
    for (int i = 0; i < 3; i++) {
        out->box_low[i] = b->box_low[i];
        out->box_high[i] = b->box_high[i];
    }
    return handed ? CELLS_FINE : CELLS_NO_MEMORY;
}
