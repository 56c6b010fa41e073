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

static int is_shared(const scene *s, uint32_t listing)
{
    return s->listings[s->zone_items[listing]] > 1;
}

static uint32_t count_shared(scissor *x)
{
    const scene *s = x->scene;
    uint32_t count = 0;
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        x->first_shared[z] = count;
        for (uint32_t i = s->zones[z].first_item; i < s->zones[z].first_item + s->zones[z].item_count; ++i) count += (uint32_t)is_shared(s, i);
    }
    x->first_shared[s->zone_count] = count;
    return count;
}

static void list_shared(scissor *x)
{
    const scene *s = x->scene;
    uint32_t *at = x->shared;
    for (uint32_t z = 0; z < s->zone_count; ++z)
        for (uint32_t i = s->zones[z].first_item; i < s->zones[z].first_item + s->zones[z].item_count; ++i)
            if (is_shared(s, i)) *at++ = s->zone_items[i];
}

result scissor_open(const scene *s, const allocator *memory, scissor *out)
{
    *out = (scissor){.scene = s, .memory = memory};
    out->of_zone = memory_alloc(memory, s->zone_count, sizeof *out->of_zone);
    out->of_item = memory_alloc(memory, s->item_count, sizeof *out->of_item);
    out->first_shared = memory_alloc(memory, (size_t)s->zone_count + 1, sizeof *out->first_shared);
    if (out->first_shared) out->shared = memory_alloc(memory, count_shared(out), sizeof *out->shared);
    if (out->of_zone && out->of_item && out->shared) {
        list_shared(out);
        return RESULT_OK;
    }
    scissor_close(out);
    return RESULT_NO_MEMORY;
}

void scissor_close(scissor *s)
{
    if (!s->scene) return;
    memory_free(s->memory, s->of_zone, s->scene->zone_count, sizeof *s->of_zone);
    memory_free(s->memory, s->of_item, s->scene->item_count, sizeof *s->of_item);
    if (s->shared) memory_free(s->memory, s->shared, s->first_shared[s->scene->zone_count], sizeof *s->shared);
    memory_free(s->memory, s->first_shared, (size_t)s->scene->zone_count + 1, sizeof *s->first_shared);
    *s = (scissor){0};
}

static void start_zone(scissor *s, const flow_result *f, const flow_zone *z)
{
    float *own = s->of_zone[z->zone];
    memcpy(own, EMPTY, sizeof EMPTY);
    for (uint32_t i = z->first; i < z->first + z->count; ++i) unite(own, f->volumes[f->by_zone[i]].rectangle);
    for (uint32_t i = s->first_shared[z->zone]; i < s->first_shared[z->zone + 1]; ++i) memcpy(s->of_item[s->shared[i]], EMPTY, sizeof EMPTY);
}

// Into the rectangles of the zone's shared items.
static void give(scissor *s, uint32_t zone)
{
    for (uint32_t i = s->first_shared[zone]; i < s->first_shared[zone + 1]; ++i) unite(s->of_item[s->shared[i]], s->of_zone[zone]);
}

static void take(const scissor *s, uint32_t zone, float rectangle[4])
{
    memcpy(rectangle, s->of_zone[zone], sizeof EMPTY);
    for (uint32_t i = s->first_shared[zone]; i < s->first_shared[zone + 1]; ++i) unite(rectangle, s->of_item[s->shared[i]]);
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
