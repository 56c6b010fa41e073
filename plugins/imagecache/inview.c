// The cells of a zone that are in view: see inview.h.
// SPDX-License-Identifier: MIT
#include "inview.h"

#include <string.h>

struct inview_room {
    footprint footprints[INVIEW_VOLUMES];
    rings rings[INVIEW_VOLUMES];
    rings_ring ahead[INVIEW_VOLUMES]; // the next ring of each volume
    forms_border border;
};

int inview_open(const cull_host *host, const cells *c, inview *out)
{
    const size_t numbers = 2 * c->cell_count * sizeof(uint32_t), start = (sizeof(struct inview_room) + 63) / 64 * 64;
    memset(out, 0, sizeof *out);
    out->bytes = start + numbers;
    char *memory = host->alloc(host, out->bytes, 64);
    if (!memory) return 0;
    out->cells = c;
    out->room = (struct inview_room *)(void *)memory;
    out->list = (uint32_t *)(void *)(memory + start);
    out->masks = out->list + c->cell_count;
    memset(out->masks, 0, c->cell_count * sizeof *out->masks);
    return 1;
}

void inview_close(const cull_host *host, inview *v)
{
    if (v->room) host->free(host, v->room, v->bytes);
}

static void cell_seen(inview *v, uint32_t cell, uint32_t bit)
{
    if (cells_is_empty(v->cells, cell)) return;
    if (v->masks[cell] == 0) v->list[v->count++] = cell;
    v->masks[cell] |= bit;
}

static void ring_seen(inview *v, const rings_ring *ring, uint32_t bit)
{
    const ground *g = &v->cells->ground;
    for (uint32_t s = 0; s < ring->span_count; s++) {
        const rings_span *span = &ring->spans[s];
        const uint32_t step = (uint32_t)span->dj * g->columns + (uint32_t)span->di; // wraps where it is below 0
        uint32_t cell = ground_number(g, span->first);
        for (uint32_t k = 0; k < span->count; k++, cell += step) cell_seen(v, cell, bit);
    }
}

// The report's border says which cells; rings over its box only put them in order.
static void border_seen(inview *v, const rings_ring *ring, uint32_t bit)
{
    for (uint32_t s = 0; s < ring->span_count; s++) {
        const rings_span *span = &ring->spans[s];
        ground_cell at = span->first;
        for (uint32_t k = 0; k < span->count; k++, at.i += span->di, at.j += span->dj)
            if (forms_border_keeps(&v->room->border, at)) cell_seen(v, ground_number(&v->cells->ground, at), bit);
    }
}

static void gather_by_border(inview *v, ground_cell eye)
{
    struct inview_room *const r = v->room;
    for (uint32_t k = 0; k < v->volume_count; k++) {
        rings_ring ring;
        forms_border_of(&v->cells->ground, &r->footprints[k], &r->border);
        r->footprints[k].edge_count = 0; // the box alone
        rings_start(&r->footprints[k], eye, RINGS_NEAR_FIRST, &r->rings[0]);
        while (rings_next(&r->rings[0], &ring)) border_seen(v, &ring, 1u << k);
    }
}

// All volumes ring by ring, so that the order is that of the eye whichever volume sees a cell.
static void gather_by_rings(inview *v, ground_cell eye)
{
    struct inview_room *const r = v->room;
    uint32_t open = 0;
    for (uint32_t k = 0; k < v->volume_count; k++) {
        rings_start(&r->footprints[k], eye, RINGS_NEAR_FIRST, &r->rings[k]);
        if (rings_next(&r->rings[k], &r->ahead[k])) open |= 1u << k;
    }
    while (open) {
        int32_t nearest = INT32_MAX;
        for (uint32_t k = 0; k < v->volume_count; k++)
            if ((open >> k & 1) && r->ahead[k].distance < nearest) nearest = r->ahead[k].distance;
        for (uint32_t k = 0; k < v->volume_count; k++) {
            if (!(open >> k & 1) || r->ahead[k].distance != nearest) continue;
            ring_seen(v, &r->ahead[k], 1u << k);
            if (!rings_next(&r->rings[k], &r->ahead[k])) open &= ~(1u << k);
        }
        v->rings_walked++;
    }
}

// A viewer infinitely far off has no exact place: only a direction.
ground_cell inview_eye(const ground *g, const cull_view *view)
{
    double eye[4] = {0, 0, 0, (double)view->eye[3]};
    for (int k = 0; k < 3; k++) eye[k] = view->eye[3] > 0 ? view->eye_exact[k] : (double)view->eye[k];
    return ground_eye(g, eye);
}

uint32_t inview_gather(inview *v, const cull_visit *visit, uint32_t first, inview_ways ways)
{
    const uint32_t left = visit->volume_count - first;
    const ground *g = &v->cells->ground;
    for (uint32_t k = 0; k < v->count; k++) v->masks[v->list[k]] = 0;
    v->count = v->rings_walked = 0;
    v->volumes = visit->volumes + first;
    v->volume_count = left < INVIEW_VOLUMES ? left : INVIEW_VOLUMES;
    for (uint32_t k = 0; k < v->volume_count; k++) footprint_of(g, &v->volumes[k], &v->room->footprints[k]);
    const ground_cell at = ways.order == INVIEW_BY_SLOPE ? forms_slope_eye(g, visit->view->forward) : inview_eye(g, visit->view);
    if (ways.walk == INVIEW_BRESENHAM) gather_by_border(v, at);
    else gather_by_rings(v, at);
    return v->volume_count;
}
