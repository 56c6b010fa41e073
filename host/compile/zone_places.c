// Where point entities stand: in a region of air, in the void, or in a wall.
// SPDX-License-Identifier: MIT
#include "zone_trace.h"

#include "steady.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define UNITS_A_METRE 32.0
#define NUDGE_UNITS 1.0 // an entity that stands on a floor or against a wall is looked for this far off it too

static int32_t on_grid(double steps)
{
    const double most = CULL_GRID_MOST;
    return (int32_t)floor((steps > most ? most : steps > -most ? steps : -most) + 0.5);
}

void zone_place_point(const compile_input *in, const compile_entity *e, int32_t out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = on_grid(e->origin[k] * in->steps_per_metre);
}

enum { TOUCHED_MOST = 32 }; // regions that meet in a point; more are not asked
typedef struct place_votes { uint32_t regions[TOUCHED_MOST], votes[TOUCHED_MOST], count; } place_votes;

static uint32_t *vote_of(place_votes *v, uint32_t region)
{
    uint32_t i = 0;
    while (i < v->count && v->regions[i] != region) ++i;
    if (i == TOUCHED_MOST) return NULL;
    if (i == v->count) v->regions[v->count] = region, v->votes[v->count++] = 0;
    return &v->votes[i];
}

static void vote(place_votes *v, uint32_t region)
{
    uint32_t *votes = vote_of(v, region);
    if (votes) ++*votes;
}

// A region's size, for ties.
static int64_t region_extent(const zone_trace *t, uint32_t region)
{
    double sum = 0;
    for (uint32_t f = 0; f < t->shells.face_count; ++f) {
        if (t->shells.shell_of[f] == SHELL_NONE || zone_trace_region(t, f) != region) continue;
        const surface_polygon *p = surface_polygon_at(&t->s, f >> 1);
        const surface_corner *c = surface_corners(&t->s, p);
        for (uint32_t i = 0; i < p->count; ++i) {
            const double *a = surface_vertex_at(&t->s, c[i].vertex)->position, *b = surface_vertex_at(&t->s, c[i + 1 < p->count ? i + 1 : 0].vertex)->position;
            sum += sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) + (b[2] - a[2]) * (b[2] - a[2]));
        }
    }
    return steady_log(sum);
}

static uint32_t elected(const zone_trace *t, const place_votes *v)
{
    uint32_t best = REGION_SOLID, most = 0;
    int64_t extent = INT64_MIN;
    if (v->count == 1) return v->regions[0]; // nearly always: the extents are dear
    for (uint32_t i = 0; i < v->count; ++i) {
        if (v->votes[i] < most) continue;
        const int64_t own = region_extent(t, v->regions[i]);
        if (v->votes[i] == most && own <= extent) continue;
        best = v->regions[i];
        most = v->votes[i];
        extent = own;
    }
    return best;
}

static int touches(const zone_trace *t, uint32_t polygon, const int32_t point[3])
{
    const surface_polygon *p = surface_polygon_at(&t->s, polygon);
    const surface_corner *c = surface_corners(&t->s, p);
    if (p->kind == SURFACE_LIQUID) return 0;
    for (int k = 0; k < 3; ++k)
        if (point[k] < p->min[k] - 1 || point[k] > p->max[k] + 1) return 0;
    if (plane_table_side_of_point(t->s.planes, point, p->plane) != 0) return 0;
    for (uint32_t i = 0; i < p->count; ++i)
        if (plane_table_side_of_point(t->s.planes, point, c[i].edge) > 0) return 0;
    return 1;
}

// The air in front of polygons that the point lies on, and behind portals: one voice each, for what they are, not how many.
static void find_touched(const zone_trace *t, const int32_t point[3], place_votes *v)
{
    for (uint32_t i = 0; i < surface_polygon_count(&t->s); ++i) {
        if (!touches(t, i, point)) continue;
        const uint32_t sides = surface_is_two_sided(surface_polygon_at(&t->s, i)->kind) ? 2 : 1;
        for (uint32_t side = 0; side < sides; ++side) {
            const uint32_t region = zone_trace_region(t, 2 * i + side);
            if (region != REGION_VOID && region != REGION_SOLID) (void)vote_of(v, region);
        }
    }
}

// One on a floor, in a wall's face or a portal's is in the largest region that it touches: the same however the map is turned.
// One in a wall is where most ways off it lead. Off a wall never into the void: that would be a leak that isn't there.
static result place(const compile_input *in, zone_trace *t, const compile_entity *e, uint32_t *region)
{
    static const int32_t ways[][3] = {{0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}};
    const double nudge = NUDGE_UNITS * in->steps_per_metre / UNITS_A_METRE;
    place_votes votes = {.count = 0};
    int32_t point[3];
    zone_place_point(in, e, point);
    result r = region_of_point(&t->regions, &t->rays, point, region);
    if (r != RESULT_OK || *region != REGION_SOLID) return r;
    find_touched(t, point, &votes);
    const int is_touching = votes.count > 0;
    for (size_t i = 0; i < sizeof(ways) / sizeof(ways[0]) && r == RESULT_OK && !is_touching; ++i) {
        int32_t by[3];
        uint32_t found;
        for (int k = 0; k < 3; ++k) by[k] = on_grid(point[k] + ways[i][k] * nudge);
        r = region_of_point(&t->regions, &t->rays, by, &found);
        if (r == RESULT_OK && found != REGION_SOLID && found != REGION_VOID) vote(&votes, found);
    }
    *region = elected(t, &votes);
    return r;
}

static void number_zones(zone_places *p)
{
    uint32_t next = 0;
    for (uint32_t i = 0; i < p->region_count; ++i) p->zone_of[i] = ZONE_NONE;
    for (uint32_t e = 0; e < p->entity_count; ++e) {
        const uint32_t region = p->region_of[e];
        if (region < p->region_count && p->zone_of[region] == ZONE_NONE) p->zone_of[region] = next++;
    }
    for (uint32_t i = 0; i < p->region_count; ++i)
        if (p->zone_of[i] == ZONE_NONE) p->zone_of[i] = next++;
}

result zone_places_make(const compile_input *in, zone_trace *t, const allocator *memory, zone_places *out)
{
    zone_places p = {.memory = memory, .entity_count = in->entity_count, .region_count = t->regions.region_count, .leaking = ZONE_NONE};
    p.region_of = memory_alloc(memory, p.entity_count, sizeof(uint32_t));
    p.zone_of = memory_alloc(memory, p.region_count, sizeof(uint32_t));
    result r = p.region_of && p.zone_of ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t e = 0; e < in->entity_count && r == RESULT_OK; ++e) {
        p.region_of[e] = REGION_NOT_PLACED;
        if (!in->entities[e].has_origin || in->entities[e].brush_count) continue;
        r = place(in, t, &in->entities[e], &p.region_of[e]);
        if (p.region_of[e] == REGION_VOID && p.leaking == ZONE_NONE) p.leaking = e;
    }
    if (r == RESULT_OK) number_zones(&p);
    *out = p;
    if (r != RESULT_OK) zone_places_free(out);
    return r;
}

void zone_places_free(zone_places *p)
{
    if (!p->memory) return;
    memory_free(p->memory, p->region_of, p->entity_count, sizeof(uint32_t));
    memory_free(p->memory, p->zone_of, p->region_count, sizeof(uint32_t));
    p->memory = NULL;
}

// ---- Names ----

static const char *value_of(const compile_entity *e, const char *key)
{
    for (uint32_t i = 0; i < e->key_count; ++i)
        if (strcmp(e->keys[2 * i], key) == 0) return e->keys[2 * i + 1];
    return NULL;
}

static const char *copied(arena *memory, const char *text)
{
    return arena_text(memory, text, strlen(text));
}

static result tell(compiled_zones *z, compiled_zone *zone, const compile_entity *info)
{
    const char *name = value_of(info, "name"), *chain = value_of(info, "chain");
    if (!name) name = info->name;
    if (name && !zone->name && !(zone->name = copied(&z->memory, name))) return RESULT_NO_MEMORY;
    if (chain && !zone->chain && !(zone->chain = copied(&z->memory, chain))) return RESULT_NO_MEMORY;
    return RESULT_OK;
}

static void warn(const compile_input *in, const compile_entity *info, const char *what, report *r)
{
    report_warning(r, in->path, info->line, "the zone_info at %g %g %g %s", info->origin[0], info->origin[1], info->origin[2], what);
}

result zone_places_name(const compile_input *in, const zone_places *p, report *r, compiled_zones *z)
{
    for (uint32_t e = 0; e < in->entity_count; ++e) {
        const uint32_t region = p->region_of[e];
        const int is_info = strcmp(in->entities[e].class_name, "zone_info") == 0;
        if (region == REGION_NOT_PLACED) continue;
        if (!z->leak && region >= p->region_count) {
            if (is_info) warn(in, &in->entities[e], "stands in no air and names no zone; move it into the zone", r);
            continue;
        }
        compiled_zone *zone = &z->zones[z->leak ? 0 : p->zone_of[region]];
        zone->entity_count++;
        if (!is_info) continue;
        if (!z->leak && (zone->name || zone->chain)) warn(in, &in->entities[e], "shares its zone with an earlier one, which wins; take one away", r);
        const result told = tell(z, zone, &in->entities[e]);
        if (told != RESULT_OK) return told;
    }
    for (uint32_t i = 0; i < z->zone_count; ++i) {
        char text[32];
        snprintf(text, sizeof(text), "zone %u", i);
        if (!z->zones[i].name && !(z->zones[i].name = copied(&z->memory, text))) return RESULT_NO_MEMORY;
        z->zones_sealed += z->zones[i].entity_count == 0;
        z->zones[i].is_outside = z->leak;
    }
    return RESULT_OK;
}
