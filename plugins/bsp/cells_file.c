// What the build found, filed by cell: the openings that leave each, the cells at each zone portal.
// SPDX-License-Identifier: MIT
// Invariant: counting sorts, so the order is that of the nodes, the same on every machine.
#include "cells_build.h"
#include "loop_bent.h"

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
    bsp_vector openings = vector_make(b->host, sizeof(bsp_opening)), points = vector_make(b->host, sizeof(cull_point));
    bsp_cell *cells = b->cells.items;
    const uint32_t total = openings_count(b, cells);
    uint64_t corners = 0;
    for (uint32_t i = 0; i < b->interfaces.count; i++) corners += (uint64_t)found[i].point_count * ((found[i].open & 1) + (found[i].open >> 1));
    bsp_opening *to = vector_push(&openings, total);
    cull_point *loops = corners <= UINT32_MAX ? vector_reserve(&points, (uint32_t)corners) : 0;
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
    if (status == CELLS_FINE && !vector_take(&openings, &out->openings, &out->opening_count)) status = CELLS_NO_MEMORY;
    if (status == CELLS_FINE && !vector_take(&points, &out->opening_points, &out->opening_point_count)) status = CELLS_NO_MEMORY;
    vector_free(&openings);
    vector_free(&points);
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

// By portal, in it by cell: they were found so.
static void stands_sort(const cells_build *b, uint32_t *starts, uint32_t *order)
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
    for (uint32_t i = 0; i < count; i++) order[starts[stands[i].portal]++] = i;
    for (uint32_t p = portals; p > 0; p--) starts[p] = starts[p - 1];
    starts[0] = 0;
}

static cells_status stands_copy(const cells_build *b, const uint32_t *order, bsp_vector *stands, bsp_vector *points)
{
    for (uint32_t i = 0; i < b->stands.count; i++) {
        const cells_stand *from = (const cells_stand *)b->stands.items + order[i];
        const cull_point *at = (const cull_point *)b->points.items + from->first_point;
        bsp_stand made = {from->cell, points->count, from->point_count, 0};
        cull_vec3 *to = vector_push(points, from->point_count);
        if (!to) return CELLS_NO_MEMORY;
        for (uint32_t k = 0; k < from->point_count; k++) to[k] = (cull_vec3){(float)at[k].x, (float)at[k].y, (float)at[k].z};
        made.is_bent = (uint32_t)loop_is_bent(to, made.point_count, cells_plane(b, from->plane)->normal, 0x1p-22 * (double)b->zone->radius); // as flow_index.c
        if (!vector_add(stands, &made)) return CELLS_NO_MEMORY;
    }
    return CELLS_FINE;
}

static cells_status portals_file(cells_build *b, bsp_cells_data *out)
{
    const uint32_t portals = b->zone->portal_count;
    bsp_vector offsets = vector_make(b->host, sizeof(uint32_t)), order = offsets, air = vector_make(b->host, 1);
    bsp_vector stands = vector_make(b->host, sizeof(bsp_stand)), points = vector_make(b->host, sizeof(cull_vec3));
    uint32_t *starts = vector_push(&offsets, portals + 1), *by_portal = vector_push(&order, b->stands.count), made;
    uint8_t *has_air = vector_push(&air, portals);
    cells_status status = starts && (by_portal || !b->stands.count) && (has_air || !portals) ? CELLS_FINE : CELLS_NO_MEMORY;
    if (status == CELLS_FINE) {
        if (portals) stands_thin(b, has_air);
        stands_sort(b, starts, by_portal);
        status = stands_copy(b, by_portal, &stands, &points);
    }
    if (status == CELLS_FINE && !vector_take(&offsets, &out->portal_offsets, &made)) status = CELLS_NO_MEMORY;
    out->portal_count = status == CELLS_FINE ? portals : 0;
    if (status == CELLS_FINE && !vector_take(&stands, &out->stands, &out->stand_count)) status = CELLS_NO_MEMORY;
    if (status == CELLS_FINE && !vector_take(&points, &out->stand_points, &out->stand_point_count)) status = CELLS_NO_MEMORY;
    bsp_vector *const lists[] = {&offsets, &order, &air, &stands, &points};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) vector_free(lists[i]);
    return status;
}

// ---- The whole ----

cells_status cells_hand_over(cells_build *b, bsp_cells_data *out)
{
    cells_status status = openings_file(b, out);
    if (status == CELLS_FINE) status = portals_file(b, out);
    if (status != CELLS_FINE) return status;
    b->planes.count = b->plane_count;
    const int handed = vector_take(&b->planes, &out->planes, &out->plane_count) && vector_take(&b->nodes, &out->nodes, &out->node_count) &&
                       vector_take(&b->cells, &out->cells, &out->cell_count) && vector_take(&b->entries, &out->entries, &out->entry_count) &&
                       vector_take(&b->entry_points, &out->entry_points, &out->entry_point_count);
    out->slack = b->slack;
    for (int i = 0; i < 3; i++) {
        out->box_low[i] = b->box_low[i];
        out->box_high[i] = b->box_high[i];
    }
    return handed ? CELLS_FINE : CELLS_NO_MEMORY;
}
