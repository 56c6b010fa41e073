// Movers in a view: those of each zone that is reached against its volumes, those that stand everywhere against the whole
// picture. Each is shown once, whichever zone found it.
// SPDX-License-Identifier: MIT
#include "world_parts.h"

#include <portcullis/plane.h>

#include <math.h>

// Metres per metre of coordinate, for boxes that stick out of what the planes were guarded for (the zone's radius): the
// rounding term of cull_plane_outward at the longest normal, 4.004 * 2^-24 * sqrt(3) < 2^-21.
static const float ROUNDING_OUTSIDE = 1.0f / 2097152;

// ---- One zone ----

static float larger(float a, float b)
{
    return a > b ? a : b;
}

// How far a plane may misjudge each box, and keep it.
static void block_slack(const mover_block *b, float radius, float slack[MOVER_BLOCK])
{
    for (uint32_t i = 0; i < MOVER_BLOCK; ++i) {
        const float x = larger(fabsf(b->min_x[i]), fabsf(b->max_x[i])), y = larger(fabsf(b->min_y[i]), fabsf(b->max_y[i]));
        const float size = larger(larger(x, y), larger(fabsf(b->min_z[i]), fabsf(b->max_z[i])));
        slack[i] = size > radius ? size * ROUNDING_OUTSIDE : 0;
    }
}

// One bit a mover that the volume touches.
static uint32_t block_touches(const mover_block *b, const cull_volume *volume, const float slack[MOVER_BLOCK])
{
    float least[MOVER_BLOCK];
    for (uint32_t i = 0; i < MOVER_BLOCK; ++i) least[i] = 0;
    for (uint32_t k = 0; k < volume->plane_count; ++k) {
        const cull_plane p = volume->planes[k];
        const float *x = p.normal.x >= 0 ? b->max_x : b->min_x, *y = p.normal.y >= 0 ? b->max_y : b->min_y,
                    *z = p.normal.z >= 0 ? b->max_z : b->min_z;
        for (uint32_t i = 0; i < MOVER_BLOCK; ++i) {
            const float height = ((p.normal.x * x[i] + p.normal.y * y[i]) + p.normal.z * z[i]) + p.offset + slack[i];
            least[i] = height < least[i] ? height : least[i];
        }
    }
    uint32_t bits = 0;
    for (uint32_t i = 0; i < MOVER_BLOCK; ++i) bits |= (uint32_t)(least[i] >= 0) << i;
    return bits & (b->count < 32 ? (1u << b->count) - 1 : ~0u);
}

static uint32_t block_seen(const mover_search *q, const world *w, const mover_block *b)
{
    float slack[MOVER_BLOCK];
    uint32_t bits = 0;
    block_slack(b, w->data[q->zone].zone.radius, slack);
    for (uint32_t k = 0; k < q->volume_count; ++k) bits |= block_touches(b, &q->volumes[k], slack);
    return bits;
}

// ---- Slots: names of movers for a culler that takes them ----

static int is_in_zone(const world *w, uint32_t mover, uint32_t zone)
{
    const uint32_t *zones;
    const uint32_t count = movers_zones(w->movers, mover, &zones);
    for (uint32_t i = 0; i < count; ++i)
        if (zones[i] == zone) return 1;
    return 0;
}

static uint32_t free_slot(const world *w, const viewer *v, uint32_t mover)
{
    const uint32_t *names = v->slot_movers.items;
    const uint32_t capacity = v->chain->zone.mover_capacity;
    for (uint32_t i = 0; i < capacity; ++i) {
        const uint32_t slot = (mover + i) % capacity;
        if (names[slot] == SCENE_NONE || !is_in_zone(w, names[slot], v->chain->data->index)) return slot;
    }
    return SCENE_NONE;
}

// Looked for from where free_slot began, so mostly found at once.
static uint32_t slot_named(const uint32_t *names, uint32_t capacity, uint32_t mover)
{
    const uint32_t home = mover % capacity;
    for (uint32_t slot = home; slot < capacity; ++slot)
        if (names[slot] == mover) return slot;
    for (uint32_t slot = 0; slot < home; ++slot)
        if (names[slot] == mover) return slot;
    return SCENE_NONE;
}

// The mover keeps its slot while it stays in the zone. SCENE_NONE: all are taken, of which there are at most ZONE_MOVERS_MOST.
static uint32_t slot_of(const world *w, viewer *v, uint32_t mover)
{
    uint32_t *names = v->slot_movers.items;
    const uint32_t capacity = v->chain->zone.mover_capacity;
    if (!v->slot_movers.size) return mover < capacity ? mover : SCENE_NONE; // as many slots as numbers
    const uint32_t named = slot_named(names, capacity, mover);
    if (named != SCENE_NONE) return named;
    if (v->full_serial == v->serial) return SCENE_NONE; // none becomes free while a frame lasts
    const uint32_t slot = free_slot(w, v, mover);
    if (slot != SCENE_NONE) names[slot] = mover;
    else v->full_serial = v->serial;
    return slot;
}

static void lend(world_view *v, viewer *zone, const mover_block *b, uint32_t lane)
{
    const uint32_t slot = slot_of(v->world, zone, b->mover[lane]);
    if (slot == SCENE_NONE) {
        v->stats->limits_hit++;
        mover_mark(&v->marks, b->mover[lane]);
        return;
    }
    const cull_box box = {{b->min_x[lane], b->min_y[lane], b->min_z[lane]}, {b->max_x[lane], b->max_y[lane], b->max_z[lane]}};
    assert(v->lent_count < v->lent_capacity); // a mover stands in MOVER_ZONES_MOST zones
    ((uint32_t *)zone->slot_lent.items)[slot] = zone->serial;
    if (!zone->visit.mover_count) zone->visit.movers = v->lent + v->lent_count;
    v->lent[v->lent_count++] = (cull_mover){box, zone->chain->zone.item_count + slot, 0};
    zone->visit.mover_count++;
}

void view_find_movers(world_view *v, const mover_search *q)
{
    const world *w = v->world;
    viewer *taker = q->viewer && viewer_takes_movers(q->viewer) ? q->viewer : NULL;
    for (const mover_block *b = movers_of_zone(w->movers, q->zone); b; b = movers_next(w->movers, b)) {
        v->stats->movers_tested += b->count;
        for (uint32_t bits = block_seen(q, w, b), i = 0; bits; bits >>= 1, ++i) {
            if (!(bits & 1)) continue;
            if (taker) lend(v, taker, b, i);
            else mover_mark(&v->marks, b->mover[i]);
        }
    }
}

void view_mark_all_movers(world_view *v, uint32_t zone)
{
    for (const mover_block *b = movers_of_zone(v->world->movers, zone); b; b = movers_next(v->world->movers, b))
        for (uint32_t i = 0; i < b->count; ++i) mover_mark(&v->marks, b->mover[i]);
}

// ---- Everywhere ----

static float float_below(double x)
{
    const float f = (float)x;
    return (double)f > x ? nextafterf(f, -INFINITY) : f;
}

static float float_above(double x)
{
    return -float_below(-x);
}

// The mover as if it were a zone of its own, its origin at the eye: there its box and the volume are told finest.
static int is_in_picture(const view_base *base, const double min[3], const double max[3])
{
    view_place place = {.origin = {base->camera->eye[0], base->camera->eye[1], base->camera->eye[2]}};
    const double *o = place.origin;
    place.box = (cull_box){{float_below(min[0] - o[0]), float_below(min[1] - o[1]), float_below(min[2] - o[2])},
                           {float_above(max[0] - o[0]), float_above(max[1] - o[1]), float_above(max[2] - o[2])}};
    place.radius = cull_box_radius(place.box);
    view_volume planes;
    view_volume_in_zone(base, &place, &planes);
    const cull_volume volume = {planes.planes, planes.plane_count, 0};
    return cull_volume_touches(&volume, place.box);
}

void view_find_movers_everywhere(world_view *v, const frame_input *q)
{
    uint32_t count;
    const uint32_t *numbers = movers_everywhere(v->world->movers, &count);
    if (!count) return;
    view_base base;
    view_base_make(q->camera, &q->frame, &base);
    v->stats->movers_tested += count;
    for (uint32_t i = 0; i < count; ++i) {
        double min[3], max[3];
        if (movers_box(v->world->movers, numbers[i], min, max) && is_in_picture(&base, min, max)) mover_mark(&v->marks, numbers[i]);
    }
}
