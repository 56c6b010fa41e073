// Eyes: see eyes.h.
// SPDX-License-Identifier: MIT
#include "eyes.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { TRIES = 4096 };
static const double SLIDE_STEP = 1.0 / 64;
static const double PI = 3.14159265358979323846;
static const double AIR_M = 1.0 / 1024; // from a zone's border and what is solid, of eyes in the air
static const double PITCH_MOST_DEG = 70, NEAR_M = 0.0625;
const char *const eye_kind_names[EYE_KINDS] = {"in the air", "on a portal", "on an edge", "on a corner"};

void eyes_open(eyes *e, const scene *s, const camera_path *walk, uint64_t seed)
{
    static const double whole[3] = {0, 0, 0};
    *e = (eyes){.scene = s, .walk = walk, .random = seed};
    assert_int_equal(free_space_open(s, whole, allocator_heap(), &e->space), RESULT_OK);
}

void eyes_close(eyes *e)
{
    free_space_close(e->space);
}

double eyes_room(const eyes *e, const double at[3], double most)
{
    return free_space_clearance(e->space, at, most, SPACE_SOLIDS);
}

int eyes_is_air(const eyes *e, const double at[3], double margin)
{
    int inside = 0;
    for (uint32_t z = 0; z < e->scene->zone_count && !inside; ++z)
        inside = (e->scene->zones[z].flags & (ZONE_EVERYWHERE | ZONE_STRAY)) == ZONE_EVERYWHERE;
    for (uint32_t h = 0; h < e->scene->hull_count && !inside; ++h) {
        const scene_hull *hull = &e->scene->hulls[h];
        int in_box = 1;
        for (int k = 0; k < 3; ++k) in_box &= at[k] > hull->min[k] && at[k] < hull->max[k];
        inside = in_box && scene_hull_height(e->scene, h, at) < -margin;
    }
    return inside && (e->scene->solid_count == 0 || eyes_room(e, at, margin) >= margin);
}

// ---- Places ----

static int beside_walk(eyes *e, double out[3])
{
    if (!e->walk->count) return 0;
    memcpy(out, e->walk->cameras[random_below(&e->random, e->walk->count)].eye, 3 * sizeof *out);
    for (int k = 0; k < 3; ++k) out[k] += random_between(&e->random, -EYES_BESIDE_M, EYES_BESIDE_M);
    return 1;
}

static int in_air(eyes *e, double out[3])
{
    if (e->scene->solid_count == 0) return beside_walk(e, out);
    if (e->scene->hull_count == 0) return 0;
    for (int tries = 0; tries < TRIES; ++tries) {
        const uint32_t zone = random_below(&e->random, e->scene->zone_count);
        const scene_zone *z = &e->scene->zones[zone];
        if (z->hull_count == 0) continue;
        const scene_hull *hull = &e->scene->hulls[z->first_hull + random_below(&e->random, z->hull_count)];
        for (int k = 0; k < 3; ++k) out[k] = random_between(&e->random, hull->min[k], hull->max[k]);
        if (eyes_is_air(e, out, AIR_M)) return 1;
    }
    return 0;
}

static const double *portal_point(const eyes *e, const scene_portal *p, uint32_t i)
{
    return e->scene->portal_points[p->first_point + i % p->point_count];
}

static void mix(const double from[3], const double to[3], double share, double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = from[k] + share * (to[k] - from[k]); // bit for bit what both have
}

static void on_portal(eyes *e, const scene_portal *p, eye_kind kind, double out[3])
{
    const uint32_t i = random_below(&e->random, p->point_count);
    memcpy(out, portal_point(e, p, i), 3 * sizeof *out);
    if (kind == EYE_ON_CORNER) return;
    double edge[3];
    mix(out, portal_point(e, p, i + 1), random_between(&e->random, 0, 1), edge);
    memcpy(out, edge, sizeof edge);
    if (kind == EYE_ON_EDGE) return;
    double other[3];
    const uint32_t j = random_below(&e->random, p->point_count);
    mix(portal_point(e, p, j), portal_point(e, p, j + 1), random_between(&e->random, 0, 1), other);
    mix(edge, other, random_between(&e->random, 0, 1), out);
}

// Where nobody knows what is solid an eye keeps off all triangles, as near to the portal's edge or corner as that lets it.
static int slide_off_triangles(const eyes *e, const double middle[3], double at[3])
{
    double from[3];
    memcpy(from, at, sizeof from);
    for (double share = 0; share <= 1; share += SLIDE_STEP) {
        mix(from, middle, share, at);
        const double room = free_space_clearance(e->space, at, EYES_BESIDE_M, SPACE_ALL);
        if (room >= EYES_BESIDE_M && !free_space_is_enclosed(e->space, at)) return 1;
    }
    return 0;
}

static int portal_place(eyes *e, eye_kind kind, double out[3])
{
    for (int tries = 0; tries < TRIES; ++tries) {
        const scene_portal *p = &e->scene->portals[random_below(&e->random, e->scene->portal_count)];
        double middle[3];
        on_portal(e, p, kind, out);
        if (e->scene->solid_count) return 1;
        mix(portal_point(e, p, 0), portal_point(e, p, p->point_count / 2), 0.5, middle);
        if (slide_off_triangles(e, middle, out)) return 1;
    }
    return 0;
}

static double by_ulps(double value, int count, int is_float)
{
    const double towards = count < 0 ? -INFINITY : INFINITY;
    for (int i = 0; i < (count < 0 ? -count : count); ++i)
        value = is_float ? (double)nextafterf((float)value, (float)towards) : nextafter(value, towards);
    return value;
}

static void move_by_ulps(eyes *e, double at[3])
{
    if (random_below(&e->random, 2)) return;
    const int is_float = (int)random_below(&e->random, 2);
    for (int k = 0; k < 3; ++k) at[k] = by_ulps(at[k], (int)random_below(&e->random, 2 * EYES_ULPS + 1) - EYES_ULPS, is_float);
}

int eyes_next(eyes *e, eye_kind kind, camera *out)
{
    *out = (camera){.up = {0, 1, 0}, .fovy_deg = 60, .aspect = 16.0 / 9, .near_m = NEAR_M, .far_m = 16 + 8 * scene_radius_m(e->scene)};
    if (kind == EYE_IN_AIR) {
        if (!in_air(e, out->eye)) return 0;
    } else {
        if (!e->scene->portal_count || !portal_place(e, kind, out->eye)) return 0;
        move_by_ulps(e, out->eye);
    }
    const double yaw = random_between(&e->random, -PI, PI), pitch = random_between(&e->random, -PITCH_MOST_DEG, PITCH_MOST_DEG) * (PI / 180);
    out->forward[0] = cos(pitch) * cos(yaw);
    out->forward[1] = sin(pitch);
    out->forward[2] = cos(pitch) * sin(yaw);
    return 1;
}

// ---- Targets ----

// On an edge, and beside it by 1/2 to 1/4096 m.
void eyes_portal_target(eyes *e, double out[3])
{
    if (!e->scene->portal_count) {
        eyes_item_target(e, out);
        return;
    }
    on_portal(e, &e->scene->portals[random_below(&e->random, e->scene->portal_count)], EYE_ON_EDGE, out);
    const double reach = ldexp(1, -(int)(1 + random_below(&e->random, 12)));
    for (int k = 0; k < 3; ++k) out[k] += random_between(&e->random, -reach, reach);
}

void eyes_item_target(eyes *e, double out[3])
{
    const scene *s = e->scene;
    const uint32_t triangle = random_below(&e->random, s->index_count / 3);
    double u = random_between(&e->random, 0, 1), v = random_between(&e->random, 0, 1);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    const cull_vec3 a = s->positions[s->indices[3 * triangle]], b = s->positions[s->indices[3 * triangle + 1]],
                    c = s->positions[s->indices[3 * triangle + 2]];
    out[0] = s->whole.origin[0] + (1 - u - v) * (double)a.x + u * (double)b.x + v * (double)c.x;
    out[1] = s->whole.origin[1] + (1 - u - v) * (double)a.y + u * (double)b.y + v * (double)c.y;
    out[2] = s->whole.origin[2] + (1 - u - v) * (double)a.z + u * (double)b.z + v * (double)c.z;
}
