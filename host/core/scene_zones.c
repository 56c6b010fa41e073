// Scene builder, the end: zones, portals on the scene's step, doors, paths, lights.
// SPDX-License-Identifier: MIT
// Invariant: a portal's points are rounded once, by the scene's step, so both its zones have the same polygon.
#include "scene_finish.h"

#include <portcullis/box.h>

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

// ---- Copies ----

static void copy_motion(finish *f)
{
    scene *s = f->s;
    const scene_builder *b = f->b;
    s->doors = finish_copy(f, &b->doors);
    s->keys = finish_copy(f, &b->keys);
    s->lights = finish_copy(f, &b->lights);
    s->paths = finish_copy(f, &b->paths);
    s->cameras = finish_copy(f, &b->cameras);
    s->door_count = (uint32_t)b->doors.count;
    s->key_count = (uint32_t)b->keys.count;
    s->light_count = (uint32_t)b->lights.count;
    s->path_count = (uint32_t)b->paths.count;
    s->camera_count = (uint32_t)b->cameras.count;
    for (uint32_t i = 0; !f->failed && i < s->door_count; ++i) s->doors[i].name = finish_text(f, s->doors[i].name);
    for (uint32_t i = 0; !f->failed && i < s->light_count; ++i) s->lights[i].name = finish_text(f, s->lights[i].name);
    for (uint32_t i = 0; !f->failed && i < s->path_count; ++i) s->paths[i].name = finish_text(f, s->paths[i].name);
}

static void copy_zones(finish *f)
{
    scene *s = f->s;
    const scene_builder *b = f->b;
    const uint32_t given = (uint32_t)b->zones.count;
    s->zone_count = given ? given : 1;
    s->zones = finish_take(f, (size_t)s->zone_count + 1, sizeof *s->zones);
    s->hulls = finish_copy(f, &b->hulls);
    s->hull_planes = finish_copy(f, &b->hull_planes);
    s->hull_count = (uint32_t)b->hulls.count;
    s->hull_plane_count = (uint32_t)b->hull_planes.count;
    if (f->failed) return;
    if (given) memcpy(s->zones, b->zones.items, given * sizeof *s->zones);
    else s->zones[0] = (scene_zone){.name = "all", .flags = ZONE_EVERYWHERE, .parent = SCENE_NONE};
    for (uint32_t z = 0; z < given && !f->failed; ++z) {
        scene_zone *zone = &s->zones[z];
        zone->name = finish_text(f, zone->name);
        if (zone->chain) zone->chain = finish_text(f, zone->chain);
        if (zone->parent == SCENE_NONE && z != b->everywhere) zone->parent = b->everywhere;
    }
}

// ---- Portals ----

static void round_point(const scene *s, const double from[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = s->whole.origin[k] + finish_round((from[k] - s->whole.origin[k]) / s->step) * s->step;
}

int finish_portal_plane(const double (*points)[3], uint32_t count, double out[4])
{
    double middle[3], twice_area[3];
    polygon_measure(points, count, middle, twice_area);
    const double length = sqrt((twice_area[0] * twice_area[0] + twice_area[1] * twice_area[1]) + twice_area[2] * twice_area[2]);
    if (!(length > 0)) return 0;
    out[3] = 0;
    for (int k = 0; k < 3; ++k) {
        out[k] = twice_area[k] / length + 0.0;
        out[3] -= out[k] * middle[k];
    }
    return 1;
}

static int same_point(const double a[3], const double b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

// Points that rounding made one are left out.
static uint32_t round_portal(const scene *s, const double (*from)[3], uint32_t count, double (*out)[3])
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i) {
        round_point(s, from[i], out[kept]);
        if (!kept || !same_point(out[kept], out[kept - 1])) ++kept;
    }
    while (kept > 1 && same_point(out[kept - 1], out[0])) --kept;
    return kept;
}

static result finish_portals(finish *f, const char *path, report *r)
{
    scene *s = f->s;
    const builder_gate *gates = f->b->gates.items;
    const double(*points)[3] = f->b->gate_points.items;
    s->portal_count = (uint32_t)f->b->gates.count;
    s->portals = finish_take(f, s->portal_count, sizeof *s->portals);
    s->portal_points = finish_take(f, f->b->gate_points.count, sizeof *s->portal_points);
    for (uint32_t p = 0; p < s->portal_count && !f->failed; ++p) {
        const builder_gate *g = &gates[p];
        const char *name = finish_text(f, g->name);
        scene_portal *to = &s->portals[p];
        *to = (scene_portal){.name = name, .zones = {g->zones[0], g->zones[1]}, .first_point = s->portal_point_count, .door = g->door};
        double(*rounded)[3] = s->portal_points + to->first_point;
        to->point_count = round_portal(s, points + g->first_point, g->point_count, rounded);
        if (to->point_count < 3 || !finish_portal_plane((const double(*)[3])rounded, to->point_count, to->plane))
            return report_error(r, path, 0, "the portal \"%s\" has no area at this scene's precision of %g m; make it larger or leave it out",
                                g->name, s->step);
        s->portal_point_count += to->point_count;
    }
    return RESULT_OK;
}

static void list_portals(finish *f)
{
    scene *s = f->s;
    s->zone_portals = finish_take(f, (size_t)s->portal_count * 2, sizeof *s->zone_portals);
    if (f->failed) return;
    for (uint32_t i = 0; i < 2 * s->portal_count; ++i) s->zones[s->portals[i / 2].zones[i % 2]].portal_count++;
    uint32_t first = 0;
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        s->zones[z].first_portal = first;
        first += s->zones[z].portal_count;
        s->zones[z].portal_count = 0;
    }
    for (uint32_t i = 0; i < 2 * s->portal_count; ++i) {
        scene_zone *zone = &s->zones[s->portals[i / 2].zones[i % 2]];
        s->zone_portals[zone->first_portal + zone->portal_count++] = i;
    }
}

// ---- Origins ----

typedef struct span { double low[3], high[3]; } span;

static void span_add(span *b, const double low[3], const double high[3])
{
    for (int k = 0; k < 3; ++k) {
        b->low[k] = fmin(b->low[k], low[k]);
        b->high[k] = fmax(b->high[k], high[k]);
    }
}

// Of items and portals; of the hulls where there are none.
static span span_of_zone(const scene *s, const scene_zone *z)
{
    span b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = z->first_item; i < z->first_item + z->item_count; ++i) {
        const cull_box box = cull_box_at(&s->boxes, s->zone_items[i]);
        const double low[3] = {(double)box.min.x, (double)box.min.y, (double)box.min.z};
        const double high[3] = {(double)box.max.x, (double)box.max.y, (double)box.max.z};
        span_add(&b, low, high);
    }
    for (int k = 0; k < 3; ++k) { // infinite stays infinite
        b.low[k] += s->whole.origin[k];
        b.high[k] += s->whole.origin[k];
    }
    for (uint32_t i = z->first_portal; i < z->first_portal + z->portal_count; ++i) {
        const scene_portal *p = &s->portals[s->zone_portals[i] / 2];
        for (uint32_t c = p->first_point; c < p->first_point + p->point_count; ++c) span_add(&b, s->portal_points[c], s->portal_points[c]);
    }
    if (b.low[0] <= b.high[0]) return b;
    for (uint32_t h = z->first_hull; h < z->first_hull + z->hull_count; ++h) span_add(&b, s->hulls[h].min, s->hulls[h].max);
    return b;
}

void finish_zone_origin(const scene *s, uint32_t zone, double out[3])
{
    const span b = span_of_zone(s, &s->zones[zone]);
    const int is_plain = s->zone_count == 1 || !(b.low[0] <= b.high[0]);
    for (int k = 0; k < 3; ++k) out[k] = is_plain ? s->whole.origin[k] : finish_origin((b.low[k] + b.high[k]) / 2);
}

static void widen_radius(scene *s)
{
    for (uint32_t p = 0; p < s->portal_point_count; ++p)
        for (int k = 0; k < 3; ++k) s->whole.radius = fmaxf(s->whole.radius, fabsf((float)(s->portal_points[p][k] - s->whole.origin[k])));
}

// ---- Hash ----

static uint64_t hash_of_portal(const scene *s, const scene_portal *p, uint64_t hash)
{
    const uint32_t numbers[] = {p->zones[0], p->zones[1], p->door, p->point_count};
    hash = XXH3_64bits_withSeed(numbers, sizeof numbers, hash);
    return XXH3_64bits_withSeed(s->portal_points + p->first_point, p->point_count * sizeof *s->portal_points, hash);
}

static uint64_t hash_of_zones(const scene *s, uint64_t hash)
{
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        const scene_zone *zone = &s->zones[z];
        const uint32_t numbers[] = {zone->flags, zone->parent, zone->hull_count, zone->item_count, zone->portal_count};
        hash = XXH3_64bits_withSeed(numbers, sizeof numbers, hash);
    }
    for (uint32_t h = 0; h < s->hull_count; ++h)
        hash = XXH3_64bits_withSeed(s->hull_planes + s->hulls[h].first_plane, s->hulls[h].plane_count * sizeof *s->hull_planes, hash);
    for (uint32_t p = 0; p < s->portal_count; ++p) hash = hash_of_portal(s, &s->portals[p], hash);
    for (uint32_t d = 0; d < s->door_count; ++d) {
        const uint32_t numbers[] = {s->doors[d].at_rest, s->doors[d].mover};
        hash = XXH3_64bits_withSeed(numbers, sizeof numbers, hash);
    }
    return hash;
}

static uint64_t hash_of_paths(const scene *s, uint64_t hash)
{
    for (uint32_t m = 0; m < s->mover_count; ++m) {
        const scene_mover *mover = &s->movers[m];
        const uint32_t numbers[] = {m, mover->key_count, mover->loops};
        hash = XXH3_64bits_withSeed(numbers, sizeof numbers, hash);
        hash = XXH3_64bits_withSeed(mover->pivot, sizeof mover->pivot, hash);
    }
    return XXH3_64bits_withSeed(s->keys, s->key_count * sizeof *s->keys, hash);
}

result finish_zones(finish *f, const char *path, report *r)
{
    scene *s = f->s;
    copy_motion(f);
    copy_zones(f);
    if (f->failed) return report_no_memory(r, path);
    result done = finish_portals(f, path, r);
    if (done != RESULT_OK) return done;
    if (!f->failed) list_portals(f);
    if (f->failed) return report_no_memory(r, path);
    done = finish_listings(f, path, r);
    if (done == RESULT_OK) done = finish_overlaps(f, path, r);
    if (done != RESULT_OK) return done;
    for (uint32_t z = 0; z < s->zone_count; ++z) finish_zone_origin(s, z, s->zones[z].origin);
    widen_radius(s);
    if (f->b->zones.count) s->hash = hash_of_zones(s, s->hash);
    if (s->key_count) s->hash = hash_of_paths(s, s->hash);
    return RESULT_OK;
}
