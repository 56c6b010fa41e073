// Why an item is kept or dropped: the cells that list it, and the first that a volume sees. See explain.h.
// SPDX-License-Identifier: MIT
#include "explain.h"

#include "footprint.h"

#include <portcullis/plane.h>

#include <stdio.h>

typedef struct finding {
    uint32_t listing, in_view; // cells
    ground_cell seen;          // one in view
    uint32_t volume;           // that sees it
} finding;

static int is_listed(const cells *c, uint32_t cell, uint32_t place)
{
    for (uint32_t r = c->firsts[cell]; r < c->firsts[cell + 1]; r++)
        if (place - c->runs[r].first < c->runs[r].count) return 1;
    return 0;
}

static finding find(const cells *c, const cull_visit *visit, uint32_t place)
{
    finding f = {0};
    for (uint32_t cell = 0; cell < c->cell_count; cell++) f.listing += is_listed(c, cell, place) != 0;
    for (uint32_t v = 0; v < visit->volume_count; v++) {
        footprint print;
        footprint_of(&c->ground, &visit->volumes[v], &print);
        if (!cull_volume_touches(&visit->volumes[v], c->items[place])) continue;
        for (uint32_t cell = 0; cell < c->cell_count; cell++) {
            const ground_cell at = {(int32_t)(cell % c->ground.columns), (int32_t)(cell / c->ground.columns)};
            if (!footprint_keeps(&print, at) || !is_listed(c, cell, place) || !cull_volume_touches(&visit->volumes[v], c->boxes[cell])) continue;
            if (f.in_view++ == 0) f.seen = at, f.volume = v;
        }
    }
    return f;
}

static int explain_box(const cells *c, const cull_visit *visit, uint32_t place, char *text, size_t size)
{
    for (uint32_t v = 0; v < visit->volume_count; v++)
        if (cull_volume_touches(&visit->volumes[v], c->items[place]))
            return snprintf(text, size, "kept: no plane of volume %u has its box outside (walk=tree)", (unsigned)v);
    return snprintf(text, size, "dropped: each volume has a plane that its box lies outside of (walk=tree)");
}

size_t explain_item(const cells *c, explain_by by, const cull_visit *visit, uint32_t place, char *text, size_t size)
{
    int length;
    if (place >= c->item_count) {
        length = snprintf(text, size, "there is no item %u", (unsigned)place);
    } else if (by == EXPLAIN_BY_BOXES && visit->volume_count) {
        length = explain_box(c, visit, place, text, size);
    } else {
        const finding f = find(c, visit, place);
        if (!visit->volume_count) length = snprintf(text, size, "dropped: nothing of the zone is seen");
        else if (f.in_view)
            length = snprintf(text, size, "kept: listed in %u cells of %g m, %u of them in view; cell (%d, %d) through volume %u", (unsigned)f.listing,
                              c->ground.size, (unsigned)f.in_view, (int)f.seen.i, (int)f.seen.j, (unsigned)f.volume);
        else
            length = snprintf(text, size, "dropped: none of the %u cells of %g m that list it is in view together with its box", (unsigned)f.listing,
                              c->ground.size);
    }
    return length < 0 ? 0 : (size_t)length;
}
