// One viewer's memory of a zone: see history.h.
// SPDX-License-Identifier: MIT
#include "history.h"

#include <string.h>

typedef struct array_plan { void **array; size_t count, size; } array_plan;
enum { PLANS = 13 };

static void plans_fill(occlusion_history *h, array_plan plans[PLANS])
{
    const size_t items = h->tree->item_count, nodes = h->tree->node_count, all = items + nodes + h->mover_capacity;
    const array_plan made[PLANS] = {
        {(void **)&h->items, items, sizeof *h->items},
        {(void **)&h->nodes, nodes, sizeof *h->nodes},
        {(void **)&h->open_until, nodes, sizeof *h->open_until},
        {(void **)&h->kept_below, nodes, sizeof *h->kept_below},
        {(void **)&h->drawn, items, sizeof *h->drawn},
        {(void **)&h->seen_list, items, sizeof *h->seen_list},
        {(void **)&h->drawn_list, items, sizeof *h->drawn_list},
        {(void **)&h->pages, nodes, sizeof *h->pages},
        {(void **)&h->masked, items / 64 + 1, sizeof *h->masked},
        {(void **)&h->node_marks, nodes, sizeof *h->node_marks},
        {(void **)&h->heap, all, sizeof *h->heap},
        {(void **)&h->pending, all, sizeof *h->pending},
        {(void **)&h->pixels, all, sizeof *h->pixels},
    };
    memcpy(plans, made, sizeof made);
}

static size_t plan_bytes(const array_plan *p)
{
    return (p->count ? p->count : 1) * p->size;
}

cull_result history_open(const cull_host *host, const history_request *q, occlusion_history *out)
{
    array_plan plans[PLANS];
    *out = (occlusion_history){.tree = q->tree, .mover_capacity = q->mover_capacity};
    plans_fill(out, plans);
    for (int i = 0; i < PLANS; i++) {
        *plans[i].array = host->alloc(host, plan_bytes(&plans[i]), 64);
        if (!*plans[i].array) {
            history_close(host, out);
            return CULL_ERR_MEMORY;
        }
        memset(*plans[i].array, 0, plan_bytes(&plans[i]));
    }
    return CULL_OK;
}

void history_close(const cull_host *host, occlusion_history *h)
{
    array_plan plans[PLANS];
    plans_fill(h, plans);
    for (int i = 0; i < PLANS; i++)
        if (*plans[i].array) host->free(host, *plans[i].array, plan_bytes(&plans[i]));
}

void history_keep(occlusion_history *h, uint32_t node, int change)
{
    for (uint32_t n = node; n != TREE_NONE; n = h->tree->nodes[n].parent) h->kept_below[n] += (uint32_t)change;
}

void history_see(occlusion_history *h, uint32_t place)
{
    if (h->items[place] & ITEM_SEEN) return;
    h->items[place] = ITEM_SEEN;
    history_keep(h, h->tree->item_nodes[place], 1);
}

void history_lose(occlusion_history *h, uint32_t place)
{
    if (!(h->items[place] & ITEM_SEEN)) return;
    h->items[place] = 0;
    history_keep(h, h->tree->item_nodes[place], -1);
}

void history_forget(occlusion_history *h)
{
    for (uint32_t i = 0; i < h->seen_count; i++) history_lose(h, h->seen_list[i]);
    for (uint32_t i = 0; i < h->drawn_count; i++) h->items[h->drawn_list[i]] &= (uint8_t)~ITEM_LOST;
    h->seen_count = h->drawn_count = 0;
}

void history_turn(occlusion_history *h)
{
    for (uint32_t i = 0; i < h->seen_count; i++) {
        const uint32_t place = h->seen_list[i], unit = h->tree->nodes[h->tree->item_nodes[place]].unit;
        if (h->drawn[place] != h->serial || (unit != TREE_NONE && h->pages[unit].is_off)) history_lose(h, place);
    }
    for (uint32_t i = 0; i < h->drawn_count; i++) {
        const uint32_t place = h->drawn_list[i];
        if (h->items[place] & ITEM_LOST) h->items[place] = 0;
        else history_see(h, place);
    }
    uint32_t *const list = h->seen_list;
    h->seen_list = h->drawn_list;
    h->seen_count = h->drawn_count;
    h->drawn_list = list;
    h->drawn_count = 0;
}
