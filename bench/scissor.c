// Screen rectangles: see scissor.h.
// SPDX-License-Identifier: MIT
#include "scissor.h"

#include <string.h>

static const float EMPTY[4] = {1, 1, -1, -1};

static void unite(float r[4], const float other[4])
{
    for (int k = 0; k < 2; ++k) {
        r[k] = other[k] < r[k] ? other[k] : r[k];
        r[k + 2] = other[k + 2] > r[k + 2] ? other[k + 2] : r[k + 2];
    }
}

result scissor_open(const scene *s, const allocator *memory, scissor *out)
{
    *out = (scissor){.scene = s, .memory = memory};
    out->of_zone = memory_alloc(memory, s->zone_count, sizeof *out->of_zone);
    out->of_item = memory_alloc(memory, s->item_count, sizeof *out->of_item);
    if (out->of_zone && out->of_item) return RESULT_OK;
    scissor_close(out);
    return RESULT_NO_MEMORY;
}

void scissor_close(scissor *s)
{
    if (!s->scene) return;
    memory_free(s->memory, s->of_zone, s->scene->zone_count, sizeof *s->of_zone);
    memory_free(s->memory, s->of_item, s->scene->item_count, sizeof *s->of_item);
    *s = (scissor){0};
}

static void start_zone(scissor *s, const flow_result *f, const flow_zone *z)
{
    float *own = s->of_zone[z->zone];
    memcpy(own, EMPTY, sizeof EMPTY);
    for (uint32_t i = z->first; i < z->first + z->count; ++i) unite(own, f->volumes[f->by_zone[i]].rectangle);
    const scene_zone *zone = &s->scene->zones[z->zone];
    for (uint32_t i = zone->first_item; i < zone->first_item + zone->item_count; ++i)
        memcpy(s->of_item[s->scene->zone_items[i]], EMPTY, sizeof EMPTY);
}

// Into the rectangles of the zone's shared items.
static void give(scissor *s, uint32_t zone)
{
    const scene_zone *z = &s->scene->zones[zone];
    for (uint32_t i = z->first_item; i < z->first_item + z->item_count; ++i)
        if (s->scene->listings[s->scene->zone_items[i]] > 1) unite(s->of_item[s->scene->zone_items[i]], s->of_zone[zone]);
}

static void take(const scissor *s, uint32_t zone, float rectangle[4])
{
    const scene_zone *z = &s->scene->zones[zone];
    memcpy(rectangle, s->of_zone[zone], sizeof EMPTY);
    for (uint32_t i = z->first_item; i < z->first_item + z->item_count; ++i)
        if (s->scene->listings[s->scene->zone_items[i]] > 1) unite(rectangle, s->of_item[s->scene->zone_items[i]]);
}

void scissor_tell(scissor *s, const flow_result *f, renderer *g)
{
    float rectangle[4];
    for (uint32_t i = 0; i < f->zone_count; ++i) start_zone(s, f, &f->zones[i]);
    for (uint32_t i = 0; i < f->zone_count && s->sharing == SHARED_WITH_ALL; ++i) give(s, f->zones[i].zone);
    for (uint32_t i = f->zone_count; i-- > 0;) { // far to near
        take(s, f->zones[i].zone, rectangle);
        give(s, f->zones[i].zone);
        renderer_zone_rectangle(g, f->zones[i].zone, rectangle);
    }
}
