// Scene builder, zones: hulls checked and measured as they come in, found again by name.
// SPDX-License-Identifier: MIT
#include "hull.h"
#include "scene_builder.h"

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

enum { ZONE_SLOTS_FIRST = 64 };

static size_t slot_of_name(const scene_builder *b, const char *name)
{
    const size_t size = b->zone_slots.count;
    const uint32_t *slots = b->zone_slots.items;
    const scene_zone *zones = b->zones.items;
    size_t at = XXH3_64bits(name, strlen(name)) & (size - 1);
    while (slots[at] && strcmp(zones[slots[at] - 1].name, name) != 0) at = (at + 1) & (size - 1);
    return at;
}

static result slots_grow(scene_builder *b)
{
    if (b->zones.count * 2 < b->zone_slots.count) return RESULT_OK;
    const size_t size = b->zone_slots.count ? b->zone_slots.count * 2 : ZONE_SLOTS_FIRST;
    buffer slots = buffer_make(b->memory, sizeof(uint32_t));
    uint32_t *slot = buffer_push(&slots, size);
    if (!slot) return RESULT_NO_MEMORY;
    memset(slot, 0, size * sizeof *slot);
    buffer_free(&b->zone_slots);
    b->zone_slots = slots;
    const scene_zone *zones = b->zones.items;
    for (uint32_t z = 0; z < b->zones.count; ++z) slot[slot_of_name(b, zones[z].name)] = z + 1;
    return RESULT_OK;
}

static const char *zone_fault(const scene_builder *b, const builder_zone *z)
{
    if (!z->name || !*z->name) return "has no name";
    if (((const uint32_t *)b->zone_slots.items)[slot_of_name(b, z->name)]) return "has a name that is taken";
    if (z->parent != SCENE_NONE && z->parent >= b->zones.count) return "lies in a zone that is not there";
    if (!z->hull_count && z->parent != SCENE_NONE) return "has no hull, so it is everywhere and lies in no zone";
    if (!z->hull_count && b->everywhere != SCENE_NONE) return "is the second without a hull; one zone may be everywhere";
    return NULL;
}

// Of unit normal, through the transform. 0: not finite, or no normal.
static int plane_taken(const scene_builder *b, const scene_solid_plane *from, scene_solid_plane *to)
{
    const double *n = from->normal;
    const double length = sqrt((n[0] * n[0] + n[1] * n[1]) + n[2] * n[2]);
    if (!(length > 0) || !isfinite(length) || !isfinite(from->distance)) return 0;
    scene_solid_plane unit = *from;
    if (fabs(length - 1) > 1e-15) { // of a unit: what is one already keeps its bits
        for (int k = 0; k < 3; ++k) unit.normal[k] /= length;
        unit.distance /= length;
    }
    *to = builder_plane(b, &unit);
    return isfinite(to->distance) != 0;
}

static result take_hull(scene_builder *b, const builder_hull *from, const char **fault)
{
    scene_hull hull = {.zone = (uint32_t)b->zones.count, .first_plane = (uint32_t)b->hull_planes.count, .plane_count = from->plane_count};
    *fault = "has a hull of over 256 planes";
    if (from->plane_count > HULL_PLANES_MOST) return RESULT_BAD_INPUT;
    scene_solid_plane *planes = buffer_push(&b->hull_planes, from->plane_count);
    if (!planes) return RESULT_NO_MEMORY;
    *fault = "has a plane with a number that is not finite, or without a normal";
    for (uint32_t p = 0; p < from->plane_count; ++p)
        if (!plane_taken(b, &from->planes[p], &planes[p])) return RESULT_BAD_INPUT;
    *fault = hull_fault(planes, from->plane_count, hull.min, hull.max);
    if (*fault) return RESULT_BAD_INPUT;
    return buffer_append(&b->hulls, &hull, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static result take_zone(scene_builder *b, const builder_zone *z, const char **fault)
{
    scene_zone zone = {.flags = z->hull_count ? 0 : ZONE_EVERYWHERE, .parent = z->parent};
    zone.first_hull = (uint32_t)b->hulls.count;
    zone.hull_count = z->hull_count;
    for (uint32_t h = 0; h < z->hull_count; ++h) {
        const result done = take_hull(b, &z->hulls[h], fault);
        if (done != RESULT_OK) return done;
    }
    zone.name = arena_text(&b->names, z->name, strlen(z->name));
    zone.chain = z->chain ? arena_text(&b->names, z->chain, strlen(z->chain)) : NULL;
    if (!zone.name || (z->chain && !zone.chain)) return RESULT_NO_MEMORY;
    return buffer_append(&b->zones, &zone, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

result scene_builder_zone(scene_builder *b, const builder_zone *z, uint32_t *out, const char **fault)
{
    if (slots_grow(b) != RESULT_OK) return RESULT_NO_MEMORY;
    *fault = zone_fault(b, z);
    if (*fault) return RESULT_BAD_INPUT;
    const size_t hulls = b->hulls.count, planes = b->hull_planes.count, slot = slot_of_name(b, z->name);
    const result done = take_zone(b, z, fault);
    if (done != RESULT_OK) {
        b->hulls.count = hulls;
        b->hull_planes.count = planes;
        return done;
    }
    *out = (uint32_t)b->zones.count - 1;
    ((uint32_t *)b->zone_slots.items)[slot] = *out + 1;
    if (!z->hull_count) b->everywhere = *out;
    *fault = NULL;
    return RESULT_OK;
}
