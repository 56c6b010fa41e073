// The cells of a zone: see cells.h.
// SPDX-License-Identifier: MIT
#include "cells.h"

#include <portcullis/box.h>
#include <portcullis/plane.h>

#include <math.h>
#include <string.h>

// ---- Listings of one item after the other ----

typedef struct counter { // passes over all listings
    const ground *g;
    uint32_t *stamps;    // by cell: 1 + the place (or item) that listed it last
    uint32_t *counts;    // by cell: runs
    uint32_t place;
    uint32_t joins;      // 0: this place's home is not that of the place before
    uint64_t listings;
} counter;

static void count_touch(void *context, const cells_touch *touch)
{
    counter *c = context;
    const uint32_t row = (uint32_t)touch->row * c->g->columns, stamp = c->place + 1;
    for (int32_t i = touch->columns.first; i <= touch->columns.last; i++) {
        const uint32_t cell = row + (uint32_t)i;
        if (c->stamps[cell] == stamp) continue;
        c->listings++;
        c->counts[cell] += !c->joins || c->stamps[cell] != stamp - 1; // a run goes on where the place before was listed too
        c->stamps[cell] = stamp;
    }
}

typedef struct filler {
    cells *out;
    uint32_t *stamps; // as above
    uint32_t *next;   // by cell: behind its last run
    uint32_t place, home, joins;
} filler;

static cull_box box_in_cell(const ground *g, ground_cell c, cull_box box)
{
    const double low_x = g->x + c.i * g->size, low_z = g->z + c.j * g->size;
    const double high_x = g->x + (c.i + 1) * g->size, high_z = g->z + (c.j + 1) * g->size;
    // A border between two floats: the part reaches to the float beyond it, and never beyond the whole.
    if ((double)box.min.x < low_x) box.min.x = fmaxf(box.min.x, -cull_float_above(-(float)low_x));
    if ((double)box.min.z < low_z) box.min.z = fmaxf(box.min.z, -cull_float_above(-(float)low_z));
    if ((double)box.max.x > high_x) box.max.x = fminf(box.max.x, cull_float_above((float)high_x));
    if ((double)box.max.z > high_z) box.max.z = fminf(box.max.z, cull_float_above((float)high_z));
    return box;
}

static void fill_touch(void *context, const cells_touch *touch)
{
    filler *f = context;
    cells *c = f->out;
    const uint32_t row = (uint32_t)touch->row * c->ground.columns, stamp = f->place + 1;
    for (int32_t i = touch->columns.first; i <= touch->columns.last; i++) {
        const uint32_t cell = row + (uint32_t)i;
        c->boxes[cell] = cull_box_union(c->boxes[cell], box_in_cell(&c->ground, (ground_cell){i, touch->row}, touch->box));
        if (f->stamps[cell] == stamp) continue;
        if (f->joins && f->stamps[cell] == stamp - 1) c->runs[f->next[cell] - 1].count++;
        else c->runs[f->next[cell]++] = (cells_run){f->place, 1, f->home};
        f->stamps[cell] = stamp;
    }
}

// ---- Steps ----

typedef struct room { // while building
    uint32_t *stamps, *counts;
    uint32_t *homes; // by item, Morton codes
    uint32_t *spare; // one an item
    size_t bytes;
    uint32_t cell_most;
} room;

static cull_box items_box(const cull_zone *zone)
{
    cull_box box = cull_box_none();
    for (uint32_t i = 0; i < zone->item_count; i++) box = cull_box_union(box, cull_box_at(&zone->boxes, i));
    if (zone->item_count == 0) box = (cull_box){{0, 0, 0}, {0, 0, 0}};
    return box;
}

static uint32_t joins_last(const room *r, const uint32_t *order, uint32_t place)
{
    return place > 0 && r->homes[order[place]] == r->homes[order[place - 1]];
}

// Counts in the order given, with homes; NULL: as items come, before there are any. Ends early past `most` listings.
static uint64_t count_all(const cull_zone *zone, const ground *g, const uint32_t *order, uint64_t most, room *r)
{
    const size_t cells_size = ground_cell_count(g) * sizeof *r->stamps;
    counter c = {.g = g, .stamps = r->stamps, .counts = r->counts};
    memset(r->stamps, 0, cells_size);
    memset(r->counts, 0, cells_size);
    const cells_listener to = {count_touch, &c};
    for (c.place = 0; c.place < zone->item_count && c.listings <= most; c.place++) {
        c.joins = order ? joins_last(r, order, c.place) : 0;
        cells_list_item(g, zone, order ? order[c.place] : c.place, &to);
    }
    return c.listings;
}

// About CELLS_ITEMS items a cell if they lay side by side.
static uint32_t level_guess(uint32_t item_count)
{
    uint32_t level = 0;
    for (uint64_t cells_there = CELLS_ITEMS; cells_there < item_count && level < GROUND_LEVELS_MOST; cells_there *= 4) level++;
    return level;
}

static void settle_ground(const cull_zone *zone, cull_box box, uint32_t level, room *r, cells *out)
{
    const int is_found = level == CELLS_LEVEL_AUTO;
    const uint64_t copies = is_found ? CELLS_COPIES_MOST : CELLS_COPIES_ASKED, most = zone->item_count * copies + CELLS_LISTINGS_FREE;
    uint32_t at = is_found ? level_guess(zone->item_count) : level;
    out->level_asked = at;
    for (;; at--) {
        out->ground = ground_of(box, at);
        out->listing_count = count_all(zone, &out->ground, NULL, most, r);
        if (out->listing_count <= most || at == 0) break;
    }
    out->cell_count = ground_cell_count(&out->ground);
}

// ---- The order ----

typedef struct home { ground_cell middle, first; enum { HOME_NONE, HOME_FIRST, HOME_MIDDLE } found; } home;

static void home_touch(void *context, const cells_touch *touch)
{
    home *h = context;
    if (h->found == HOME_NONE) {
        h->first = (ground_cell){touch->columns.first, touch->row};
        h->found = HOME_FIRST;
    }
    if (touch->row == h->middle.j && touch->columns.first <= h->middle.i && h->middle.i <= touch->columns.last) h->found = HOME_MIDDLE;
}

// The cell of its box's middle where that lists it, else the first that does.
static uint32_t home_of(const ground *g, const cull_zone *zone, uint32_t item)
{
    const cull_box box = cull_box_at(&zone->boxes, item);
    const double x = ((double)box.min.x + (double)box.max.x) / 2, z = ((double)box.min.z + (double)box.max.z) / 2;
    home h = {{ground_index(g->x, g->size, (int32_t)g->columns, x), ground_index(g->z, g->size, (int32_t)g->rows, z)}, {0, 0}, HOME_NONE};
    const cells_listener to = {home_touch, &h};
    cells_list_item(g, zone, item, &to);
    return ground_morton(h.found == HOME_MIDDLE ? h.middle : h.first);
}

// Eight bits at a time, least first; as items come where homes are equal.
static void order_by_home(const room *r, uint32_t count, uint32_t *order)
{
    for (uint32_t i = 0; i < count; i++) order[i] = i;
    uint32_t *from = order, *to = r->spare;
    for (uint32_t shift = 0; shift < 32; shift += 8) {
        uint32_t starts[257] = {0};
        for (uint32_t i = 0; i < count; i++) starts[(r->homes[from[i]] >> shift & 255) + 1]++;
        for (int k = 0; k < 256; k++) starts[k + 1] += starts[k];
        for (uint32_t i = 0; i < count; i++) to[starts[r->homes[from[i]] >> shift & 255]++] = from[i];
        uint32_t *const done = to;
        to = from;
        from = done;
    } // four passes: the result stands in `order` again
}

static int room_take(const cull_host *host, const cull_zone *zone, uint32_t level, room *r)
{
    r->cell_most = 1u << 2 * level;
    r->bytes = 2 * ((size_t)r->cell_most + zone->item_count) * sizeof *r->stamps;
    r->stamps = host->alloc(host, r->bytes, _Alignof(uint32_t));
    if (!r->stamps) return 0;
    r->counts = r->stamps + r->cell_most;
    r->homes = r->counts + r->cell_most;
    r->spare = r->homes + zone->item_count;
    return 1;
}

// Room for what is told by the counts: not for nothing, as a host may refuse that.
static int cells_take(const cull_host *host, cells *out)
{
    out->first_bytes = (out->cell_count + (size_t)1) * sizeof *out->firsts;
    out->run_bytes = (out->run_count + (size_t)1) * sizeof *out->runs;
    out->box_bytes = out->cell_count * sizeof *out->boxes;
    out->firsts = host->alloc(host, out->first_bytes, _Alignof(uint32_t));
    out->runs = host->alloc(host, out->run_bytes, _Alignof(cells_run));
    out->boxes = host->alloc(host, out->box_bytes, _Alignof(cull_box));
    out->item_bytes = (out->item_count + (size_t)1) * sizeof *out->items;
    out->items = host->alloc(host, out->item_bytes, _Alignof(cull_box));
    return out->firsts && out->runs && out->boxes && out->items;
}

static cull_result fill_all(const cull_host *host, const cull_zone *zone, room *r, cells *out)
{
    count_all(zone, &out->ground, out->order, UINT64_MAX, r);
    uint64_t runs = 0;
    for (uint32_t c = 0; c < out->cell_count; c++) runs += r->counts[c];
    if (runs > INT32_MAX) return CULL_ERR_MEMORY;
    out->run_count = (uint32_t)runs;
    if (!cells_take(host, out)) return CULL_ERR_MEMORY;
    uint32_t at = 0;
    for (uint32_t c = 0; c < out->cell_count; c++) {
        const uint32_t count = r->counts[c];
        out->firsts[c] = r->counts[c] = at;
        out->boxes[c] = cull_box_none();
        out->used_count += count > 0;
        at += count;
    }
    out->firsts[out->cell_count] = at;
    memset(r->stamps, 0, out->cell_count * sizeof *r->stamps);
    filler f = {out, r->stamps, r->counts, 0, 0, 0};
    const cells_listener to = {fill_touch, &f};
    for (; f.place < zone->item_count; f.place++) {
        out->items[f.place] = cull_box_at(&zone->boxes, out->order[f.place]);
        f.home = ground_number(&out->ground, ground_of_morton(r->homes[out->order[f.place]]));
        f.joins = joins_last(r, out->order, f.place);
        cells_list_item(&out->ground, zone, out->order[f.place], &to);
    }
    return CULL_OK;
}

cull_result cells_build(const cull_host *host, const cull_zone *zone, uint32_t level, cells *out)
{
    room r;
    memset(out, 0, sizeof *out);
    if (!room_take(host, zone, level == CELLS_LEVEL_AUTO ? level_guess(zone->item_count) : level, &r)) return CULL_ERR_MEMORY;
    out->item_count = zone->item_count;
    out->order_bytes = (zone->item_count + (size_t)1) * sizeof *out->order;
    out->order = host->alloc(host, out->order_bytes, _Alignof(uint32_t));
    cull_result result = CULL_ERR_MEMORY;
    if (out->order) {
        settle_ground(zone, items_box(zone), level, &r, out);
        for (uint32_t i = 0; i < zone->item_count; i++) r.homes[i] = home_of(&out->ground, zone, i);
        order_by_home(&r, zone->item_count, out->order);
        result = fill_all(host, zone, &r, out);
    }
    host->free(host, r.stamps, r.bytes);
    if (result != CULL_OK) cells_free(host, out);
    return result;
}

void cells_free(const cull_host *host, cells *c)
{
    if (c->order) host->free(host, c->order, c->order_bytes);
    if (c->firsts) host->free(host, c->firsts, c->first_bytes);
    if (c->runs) host->free(host, c->runs, c->run_bytes);
    if (c->boxes) host->free(host, c->boxes, c->box_bytes);
    if (c->items) host->free(host, c->items, c->item_bytes);
    memset(c, 0, sizeof *c);
}

size_t cells_bytes(const cells *c)
{
    return c->order_bytes + c->first_bytes + c->run_bytes + c->box_bytes + c->item_bytes;
}
