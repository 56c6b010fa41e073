// Zone order: see zone_order.h.
// SPDX-License-Identifier: MIT
// Invariant: a ray from the eye leaves a zone through a portal whose plane has the eye on that zone's side, so it meets zones
// along "near side to far side" of portals. Where these steps make no ring, any order that follows them is right for every ray
// (a portal with the eye in its plane is crossed by no ray of any width). In a ring, and between zones that no portals join,
// the one whose nearest see-through thing is nearest stands first.
#include "zone_order.h"

#include <math.h>

result zone_order_open(uint32_t zone_count, const allocator *memory, zone_order *out)
{
    *out = (zone_order){.keys = memory_alloc(memory, zone_count, sizeof *out->keys),
                        .ranks = memory_alloc(memory, zone_count, sizeof *out->ranks),
                        .degrees = memory_alloc(memory, zone_count, sizeof *out->degrees),
                        .ready = memory_alloc(memory, zone_count, sizeof *out->ready),
                        .count = zone_count};
    return out->keys && out->ranks && out->degrees && out->ready ? RESULT_OK : RESULT_NO_MEMORY;
}

void zone_order_close(zone_order *o, const allocator *memory)
{
    memory_free(memory, o->keys, o->count, sizeof *o->keys);
    memory_free(memory, o->ranks, o->count, sizeof *o->ranks);
    memory_free(memory, o->degrees, o->count, sizeof *o->degrees);
    memory_free(memory, o->ready, o->count, sizeof *o->ready);
    *o = (zone_order){0};
}

// 0 or 1: the side of the portal that the eye is on; -1: in its plane.
static int near_side(const scene_portal *p, const double eye[3])
{
    const double height = ((p->plane[0] * eye[0] + p->plane[1] * eye[1]) + p->plane[2] * eye[2]) + p->plane[3];
    return height > 0 ? 0 : height < 0 ? 1 : -1;
}

typedef struct ranking {
    zone_order *o;
    const scene *s;
    const double *eye;
    uint32_t ready, ranked, left; // zones with see-through things that are left
} ranking;

static int has_glass(const zone_order *o, uint32_t zone)
{
    return o->keys[zone] < INFINITY;
}

static void make_ready(ranking *k, uint32_t zone)
{
    k->o->ready[k->ready++] = zone;
}

static void find_glass(ranking *k)
{
    for (uint32_t z = 0; z < k->o->count; ++z) {
        k->o->ranks[z] = has_glass(k->o, z) ? 0 : SCENE_NONE;
        k->left += (uint32_t)has_glass(k->o, z);
    }
}

static void count_degrees(ranking *k)
{
    const scene *s = k->s;
    for (uint32_t z = 0; z < k->o->count; ++z) {
        k->o->degrees[z] = 0;
        k->o->ranks[z] = SCENE_NONE;
    }
    for (uint32_t p = 0; p < s->portal_count; ++p) {
        const int side = near_side(&s->portals[p], k->eye);
        if (side >= 0) k->o->degrees[s->portals[p].zones[1 - side]]++;
    }
    for (uint32_t z = 0; z < k->o->count; ++z)
        if (!k->o->degrees[z]) make_ready(k, z);
}

static void rank_zone(ranking *k, uint32_t zone)
{
    const scene *s = k->s;
    k->left -= (uint32_t)has_glass(k->o, zone);
    k->o->ranks[zone] = k->ranked++;
    if (zone >= s->zone_count) return;
    const scene_zone *z = &s->zones[zone];
    for (uint32_t i = z->first_portal; i < z->first_portal + z->portal_count; ++i) {
        const uint32_t side = s->zone_portals[i] & 1;
        const scene_portal *p = &s->portals[s->zone_portals[i] >> 1];
        const uint32_t far_zone = p->zones[1 - side];
        if (near_side(p, k->eye) != (int)side) continue;
        if (--k->o->degrees[far_zone] == 0 && k->o->ranks[far_zone] == SCENE_NONE) make_ready(k, far_zone);
    }
}

// One that shows nothing at once; else the nearest. The place in `ready`; SCENE_NONE: none is ready.
static uint32_t next_ready(const ranking *k)
{
    uint32_t best = SCENE_NONE;
    for (uint32_t i = 0; i < k->ready; ++i) {
        if (!has_glass(k->o, k->o->ready[i])) return i;
        if (best == SCENE_NONE || k->o->keys[k->o->ready[i]] < k->o->keys[k->o->ready[best]]) best = i;
    }
    return best;
}

// All that are left stand in rings or behind them.
static uint32_t nearest_left(const ranking *k)
{
    uint32_t best = SCENE_NONE;
    for (uint32_t z = 0; z < k->o->count; ++z)
        if (k->o->ranks[z] == SCENE_NONE && has_glass(k->o, z) && (best == SCENE_NONE || k->o->keys[z] < k->o->keys[best])) best = z;
    return best;
}

void zone_order_run(zone_order *o, const scene *s, const double eye[3])
{
    ranking k = {.o = o, .s = s, .eye = eye};
    find_glass(&k);
    if (k.left > 1) count_degrees(&k);
    else k.left = 0; // one needs no portals: its rank is 0
    while (k.left) {
        const uint32_t place = next_ready(&k);
        if (place == SCENE_NONE) {
            rank_zone(&k, nearest_left(&k));
            continue;
        }
        const uint32_t zone = o->ready[place];
        o->ready[place] = o->ready[--k.ready];
        if (o->ranks[zone] == SCENE_NONE) rank_zone(&k, zone);
    }
}
