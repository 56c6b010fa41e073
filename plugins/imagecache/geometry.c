// Cells shown as geometry: see geometry.h.
// SPDX-License-Identifier: MIT
#include "geometry.h"

#include <portcullis/plane.h>

#include <string.h>

enum { IS_INSIDE = 1 }; // geometry.states: a volume holds all of the cell's box

int geometry_open(const cull_host *host, const cells *c, geometry *out)
{
    const size_t numbers = (c->item_count + 2 * (size_t)c->cell_count) * sizeof *out->stamps;
    memset(out, 0, sizeof *out);
    out->bytes = numbers + c->cell_count;
    out->stamps = host->alloc(host, out->bytes, _Alignof(uint32_t));
    if (!out->stamps) return 0;
    memset(out->stamps, 0, out->bytes);
    out->masks = out->stamps + c->item_count;
    out->shown = out->masks + c->cell_count;
    out->states = (uint8_t *)out->stamps + numbers;
    out->cells = c;
    return 1;
}

void geometry_close(const cull_host *host, geometry *g)
{
    if (g->stamps) host->free(host, g->stamps, g->bytes);
}

void geometry_begin(geometry *g, cull_run *runs, geometry_draws draws)
{
    if (++g->stamp == 0) { // after 2^32 frames old stamps would look new
        memset(g->stamps, 0, g->cells->item_count * sizeof *g->stamps);
        g->stamp = 1;
    }
    g->runs = runs;
    g->promised = draws;
    g->run_count = g->tested = g->draws = g->settled = 0;
}

void geometry_settle(geometry *g)
{
    g->settled = g->run_count;
    g->draws++;
}

// ---- Cells ----

void geometry_show(geometry *g, uint32_t cell, geometry_sight sight)
{
    const cull_box box = g->cells->boxes[cell];
    uint32_t mask = sight.mask;
    uint8_t state = 0;
    g->tested++;
    g->volumes = sight.volumes;
    for (uint32_t v = 0, left = mask; left && !state; v++, left >>= 1) {
        if (!(left & 1)) continue;
        if (!cull_volume_touches(&sight.volumes[v], box)) mask &= ~(1u << v);
        else if (cull_volume_contains(&sight.volumes[v], box)) state = IS_INSIDE;
    }
    if (!mask) return;
    g->masks[cell] = mask;
    g->states[cell] = state;
    g->shown[g->shown_count++] = cell;
}

// ---- Items ----

static void put_run(geometry *g, uint32_t first, uint32_t count)
{
    cull_run *const last = g->run_count > g->settled ? &g->runs[g->run_count - 1] : NULL;
    if (last && last->first + last->count == first) last->count += count;
    else g->runs[g->run_count++] = (cull_run){first, count};
}

static int is_touched(const geometry *g, uint32_t mask, cull_box box)
{
    for (uint32_t v = 0; mask; v++, mask >>= 1)
        if ((mask & 1) && cull_volume_touches(&g->volumes[v], box)) return 1;
    return 0;
}

// Where geometry_draw is called once nobody asks for the stamps of a home that is inside.
static void draw_all(geometry *g, const cells_run *run)
{
    if (g->promised == GEOMETRY_DRAWN_OFTEN)
        for (uint32_t p = run->first; p < run->first + run->count; p++) g->stamps[p] = g->stamp;
    put_run(g, run->first, run->count);
}

// Those not drawn yet; mask 0: whether a volume touches them or not.
static void draw_some(geometry *g, const cells_run *run, uint32_t mask)
{
    for (uint32_t p = run->first; p < run->first + run->count; p++) {
        if (g->stamps[p] == g->stamp) continue;
        g->tested += mask != 0;
        if (mask && !is_touched(g, mask, g->cells->items[p])) continue;
        g->stamps[p] = g->stamp;
        put_run(g, p, 1);
    }
}

static void draw_home(geometry *g, const cells_run *run)
{
    const int is_inside = g->states[run->home] & IS_INSIDE;
    if (is_inside && g->draws == 0) draw_all(g, run); // none is drawn as a stray, see there
    else draw_some(g, run, is_inside ? 0 : g->masks[run->home]);
}

// Items at home elsewhere. Where their home is inside, or all volumes that see this cell see it, they are drawn there: it judges them by all of these.
static void draw_strays(geometry *g, uint32_t cell, const cells_run *run)
{
    const uint32_t at_home = g->masks[run->home];
    if ((g->states[run->home] & IS_INSIDE) || !(g->masks[cell] & ~at_home)) return;
    draw_some(g, run, g->states[cell] & IS_INSIDE ? 0 : g->masks[cell]);
}

void geometry_draw(geometry *g)
{
    const cells *c = g->cells;
    for (uint32_t k = 0; k < g->shown_count; k++) {
        const uint32_t cell = g->shown[k];
        for (uint32_t r = c->firsts[cell]; r < c->firsts[cell + 1]; r++) {
            if (c->runs[r].home == cell) draw_home(g, &c->runs[r]);
            else draw_strays(g, cell, &c->runs[r]);
        }
    }
    for (uint32_t k = 0; k < g->shown_count; k++) g->masks[g->shown[k]] = g->states[g->shown[k]] = 0;
    g->shown_count = 0;
    g->draws++;
}
