// Sets of cells that see each other without passing a portal: air of the zone, rock, and what lies beyond its portals.
// SPDX-License-Identifier: MIT
//
// Invariant: a portal may be wider than its hole (joined ones are hulls), so it shuts an opening only where no air of this zone lies
// behind: what it shuts by mistake would be lost, what it leaves open by mistake is only drawn too much. Slivers join nothing: between planes
// that are one but for rounding they lead from the air into the rock, and all portals would stand open.
#include "cells_build.h"

static const double MOSTLY = 2; // times as much area

// The root is the least cell of its set.
static uint32_t root_of(cells_set *sets, uint32_t cell)
{
    while (sets[cell].root != cell) cell = sets[cell].root = sets[sets[cell].root].root;
    return cell;
}

uint32_t cells_root(cells_build *b, uint32_t cell)
{
    return root_of(b->sets.items, cell);
}

static double area_of(const cells_build *b, const bsp_entry *e)
{
    double sum = 0;
    if (e->point_count == 0) return 0;
    const cull_point *p = (const cull_point *)b->entry_points.items + e->first_point;
    for (uint32_t i = 1; i + 1 < e->point_count; i++) {
        const double u[3] = {p[i].x - p[0].x, p[i].y - p[0].y, p[i].z - p[0].z}, v[3] = {p[i + 1].x - p[0].x, p[i + 1].y - p[0].y, p[i + 1].z - p[0].z};
        const double *n = cells_plane(b, e->plane)->normal;
        for (int k = 0; k < 3; k++) sum += n[k] * (u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
    }
    return sum > 0 ? sum : 0;
}

static double areas_of(const cells_build *b, uint32_t first, uint32_t count)
{
    double sum = 0;
    for (uint32_t i = first; i < first + count; i++) {
        const bsp_entry *e = (const bsp_entry *)b->entries.items + i;
        if (!(b->zone->items[b->tree->order[e->item]].flags & CULL_ITEM_TWO_SIDED)) sum += area_of(b, e);
    }
    return sum;
}

static void sets_make(cells_build *b)
{
    const cells_interface *found = b->interfaces.items;
    const bsp_cell *cells = b->cells.items;
    cells_set *sets = b->sets.items;
    for (uint32_t i = 0; i < b->cells.count; i++) sets[i] = (cells_set){.root = i};
    for (uint32_t i = 0; i < b->interfaces.count; i++) {
        const uint32_t u = root_of(sets, found[i].cells[0]), v = root_of(sets, found[i].cells[1]);
        if (found[i].open == 3 && !found[i].is_sliver) sets[u > v ? u : v].root = u > v ? v : u;
    }
    for (uint32_t i = 0; i < b->interfaces.count; i++) {
        const uint32_t u = root_of(sets, found[i].cells[0]), v = root_of(sets, found[i].cells[1]);
        if (found[i].open && u != v) sets[u].has_slivers |= found[i].is_sliver, sets[v].has_slivers |= found[i].is_sliver;
    }
    for (uint32_t i = 0; i < b->cells.count; i++) {
        cells_set *own = &sets[root_of(sets, i)];
        own->fronts += areas_of(b, cells[i].first_entry, cells[i].entry_count);
        own->backs += areas_of(b, cells[i].first_back, cells[i].back_count);
    }
}

// A zone with holes to the rock is one set of both, and one where walls hang free is too: neither has any rock.
static int turns_its_back(const cells_set *set)
{
    return set->backs > MOSTLY * set->fronts;
}

// Behind a sliver air may go on: what leads to one is never called rock for sure.
int cells_is_rock(cells_build *b, uint32_t cell)
{
    const cells_set *set = (const cells_set *)b->sets.items + cells_root(b, cell);
    return turns_its_back(set) && !set->has_slivers;
}

int cells_is_air(cells_build *b, uint32_t cell)
{
    const cells_set *set = (const cells_set *)b->sets.items + cells_root(b, cell);
    return set->fronts > 0 && !turns_its_back(set);
}

// What lies on the far side of a portal, and of all ways to it without one. A portal that reaches over its hole into air of the zone
// itself parts nothing.
static void beyond_find(cells_build *b)
{
    const cells_interface *found = b->interfaces.items;
    bsp_cell *cells = b->cells.items;
    cells_set *sets = b->sets.items;
    for (uint32_t i = 0; i < b->cells.count; i++) sets[i] = (cells_set){.root = i};
    for (uint32_t i = 0; i < b->interfaces.count; i++) {
        const uint32_t u = root_of(sets, found[i].cells[0]), v = root_of(sets, found[i].cells[1]);
        if (found[i].open == 3 && !found[i].at_portals && !found[i].is_sliver) sets[u > v ? u : v].root = u > v ? v : u;
    }
    for (uint32_t i = 0; i < b->interfaces.count; i++)
        for (uint32_t side = 0; side < 2; side++) {
            const uint32_t in = root_of(sets, found[i].cells[side]), out = root_of(sets, found[i].cells[!side]);
            if (found[i].at_portals >> side & 1 && in != out) sets[out].is_beyond = 1;
        }
    for (uint32_t i = 0; i < b->cells.count; i++) cells[i].is_beyond = sets[root_of(sets, i)].is_beyond;
}

static uint32_t reopen(cells_build *b)
{
    cells_interface *found = b->interfaces.items;
    uint32_t reopened = 0;
    for (uint32_t i = 0; i < b->interfaces.count; i++)
        for (uint32_t side = 0; side < 2; side++) {
            if (!(found[i].by_portals >> side & 1) || !cells_is_air(b, found[i].cells[!side])) continue;
            found[i].open |= 1u << side;
            reopened++;
        }
    return reopened;
}

cells_status cells_find_sets(cells_build *b)
{
    if (!vector_push(&b->sets, b->cells.count)) return CELLS_NO_MEMORY; // there is one cell at least
    beyond_find(b);
    sets_make(b);
    if (reopen(b)) sets_make(b);
    return CELLS_FINE;
}
