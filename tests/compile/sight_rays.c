// Rays through a compiled scene's air: see sight_rays.h. By brute force over all walls.
// SPDX-License-Identifier: MIT
#include "sight_rays.h"

#include "host/core/zone_seam.h"
#include "host/import/map_entity.h"
#include "host/import/views_random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const uint64_t SEED = 0x7369676874726179;
static const double OFF_WALL_M = 1.0 / 1024;  // a start's distance from its wall: over the scene's step, under any gap
static const double OFF_EDGE_M = 1.0 / 32;    // from its triangle's edges: a wall that leans over it by less than 2 degrees has the start in it
static const double SAME_PLACE_M = 1.0 / 8192; // a step of the compiler's grid: portals that near each other are one place
static const double BESIDE = 1.0 / 2048;      // of a ray's length to what it hits: how far beside it the others go

enum { BACKS_MOST = 16 };

typedef struct first_hit {
    double at;     // of the ray's way
    uint32_t item; // SCENE_NONE: nothing
    int is_front;
} first_hit;

typedef struct gate { double at; uint32_t portal; } gate;

struct sight_rays {
    const scene *s;
    zone_seam *seams;
    uint32_t *walls, wall_count; // items: opaque, one-sided, of the structure
    uint64_t *listed;            // by item: bits of zones, `words` each
    uint64_t *reached;           // words
    uint32_t words;
    gate *gates; // portal_count
    random_stream random;
};

static int is_structure(const scene *s, uint32_t item) // by the class of its object's name
{
    const char *name = s->objects[s->items[item].object].name;
    return entity_body_of((map_word){name, strcspn(name, " ")}) == BODY_STRUCTURE;
}

static void take_walls(sight_rays *r)
{
    const scene *s = r->s;
    const uint32_t open = CULL_ITEM_SEE_THROUGH | CULL_ITEM_CUT_OUT | CULL_ITEM_TWO_SIDED;
    for (uint32_t i = 0; i < s->item_count; ++i)
        if (s->items[i].flags & CULL_ITEM_WALL && !(s->items[i].flags & open) && is_structure(s, i)) r->walls[r->wall_count++] = i;
    for (uint32_t z = 0; z < s->zone_count; ++z)
        for (uint32_t i = s->zones[z].first_item; i < s->zones[z].first_item + s->zones[z].item_count; ++i)
            if (s->zone_items[i] < s->item_count) r->listed[(size_t)s->zone_items[i] * r->words + z / 64] |= (uint64_t)1 << z % 64;
}

sight_rays *sight_rays_open(const scene *s)
{
    sight_rays *r = calloc(1, sizeof *r);
    if (!r) return NULL;
    *r = (sight_rays){.s = s, .words = s->zone_count / 64 + 1, .random = {SEED}};
    r->seams = calloc(s->zone_count + 1, sizeof *r->seams);
    r->walls = calloc(s->item_count + 1, sizeof *r->walls);
    r->listed = calloc((size_t)s->item_count * r->words + 1, sizeof *r->listed);
    r->reached = calloc(r->words, sizeof *r->reached);
    r->gates = calloc(s->portal_count + 1, sizeof *r->gates);
    if (r->seams && r->walls && r->listed && r->reached && r->gates) {
        zone_seams_find(s, r->seams);
        take_walls(r);
        if (r->wall_count) return r;
    }
    sight_rays_close(r);
    return NULL;
}

void sight_rays_close(sight_rays *r)
{
    if (!r) return;
    free(r->seams);
    free(r->walls);
    free(r->listed);
    free(r->reached);
    free(r->gates);
    free(r);
}

// ---- Hits ----

static double dot(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void corner_of(const scene *s, uint32_t index, double out[3])
{
    const cull_vec3 p = s->positions[s->indices[index]];
    out[0] = s->whole.origin[0] + (double)p.x;
    out[1] = s->whole.origin[1] + (double)p.y;
    out[2] = s->whole.origin[2] + (double)p.z;
}

// Moeller and Trumbore: above 0 where the ray meets the front, below 0 the back, 0: not before `nearest`.
static double hit_triangle(const scene *s, uint32_t first, const sight_ray *ray, double nearest)
{
    double a[3], u[3], v[3], from[3], h[3], q[3];
    corner_of(s, first, a);
    corner_of(s, first + 1, u);
    corner_of(s, first + 2, v);
    for (int k = 0; k < 3; ++k) u[k] -= a[k], v[k] -= a[k], from[k] = ray->from[k] - a[k];
    cross(ray->way, v, h);
    const double det = dot(u, h);
    if (det == 0) return 0;
    const double x = dot(from, h) / det;
    if (!(x >= 0 && x <= 1)) return 0;
    cross(from, u, q);
    const double y = dot(ray->way, q) / det;
    if (!(y >= 0 && x + y <= 1)) return 0;
    const double at = dot(v, q) / det;
    return at > 0 && at < nearest ? (det > 0 ? at : -at) : 0;
}

static int meets_box(const scene *s, uint32_t i, const sight_ray *ray, double nearest)
{
    const cull_boxes *b = &s->boxes;
    const double low[3] = {(double)b->min_x[i], (double)b->min_y[i], (double)b->min_z[i]};
    const double high[3] = {(double)b->max_x[i], (double)b->max_y[i], (double)b->max_z[i]};
    double from = 0, to = nearest;
    for (int k = 0; k < 3; ++k) {
        const double at = ray->from[k] - s->whole.origin[k];
        if (ray->way[k] == 0) {
            if (at < low[k] || at > high[k]) return 0;
            continue;
        }
        const double one = (low[k] - at) / ray->way[k], two = (high[k] - at) / ray->way[k];
        from = fmax(from, fmin(one, two));
        to = fmin(to, fmax(one, two));
    }
    return from <= to;
}

static first_hit hit_first(const sight_rays *r, const sight_ray *ray)
{
    first_hit best = {INFINITY, SCENE_NONE, 0};
    for (uint32_t w = 0; w < r->wall_count; ++w) {
        const scene_item *item = &r->s->items[r->walls[w]];
        if (!meets_box(r->s, r->walls[w], ray, best.at)) continue;
        for (uint32_t t = item->first_index; t < item->first_index + item->index_count; t += 3) {
            const double at = hit_triangle(r->s, t, ray, best.at);
            if (at != 0) best = (first_hit){fabs(at), r->walls[w], at > 0};
        }
    }
    return best;
}

// ---- Zones on the way ----

static int by_place(const void *a, const void *b)
{
    const double x = ((const gate *)a)->at, y = ((const gate *)b)->at;
    return (x > y) - (x < y);
}

// Where the ray goes through the portal's plane, within a step of its polygon. 0: it does not.
static int passes(const scene *s, const scene_portal *p, const sight_ray *ray, double *at)
{
    const double(*points)[3] = (const double(*)[3]) & s->portal_points[p->first_point];
    const double along = dot(p->plane, ray->way), above = dot(p->plane, ray->from) + p->plane[3];
    *at = fabs(above) <= SAME_PLACE_M ? 0 : -above / along;
    if (!(*at >= 0 && *at < INFINITY)) return 0;
    for (uint32_t i = 0; i < p->point_count; ++i) {
        const double *a = points[i], *b = points[(i + 1) % p->point_count];
        double edge[3], out[3], off = 0, length = 0;
        for (int k = 0; k < 3; ++k) edge[k] = b[k] - a[k];
        cross(edge, p->plane, out);
        for (int k = 0; k < 3; ++k) off += out[k] * (ray->from[k] + *at * ray->way[k] - a[k]), length += out[k] * out[k];
        if (off > SAME_PLACE_M * sqrt(length)) return 0;
    }
    return 1;
}

static int has(const uint64_t *bits, uint32_t i)
{
    return bits[i / 64] >> i % 64 & 1;
}

static void go_through(sight_rays *r, const scene_portal *p, const sight_ray *ray)
{
    const double along = dot(p->plane, ray->way), flat = SAME_PLACE_M * sqrt(dot(ray->way, ray->way));
    for (int side = 0; side < 2; ++side) {
        if ((side ? -along : along) > flat || !has(r->reached, p->zones[side])) continue; // it goes the other way
        r->reached[p->zones[1 - side] / 64] |= (uint64_t)1 << p->zones[1 - side] % 64;
    }
}

// As a flow from the ray's start reaches them, were its volume the ray alone, up to `end`. Returns how many hold the start.
static uint32_t reach_zones(sight_rays *r, const sight_ray *ray, double end)
{
    const scene *s = r->s;
    const double length = sqrt(dot(ray->way, ray->way));
    uint32_t holders = 0, count = 0;
    memset(r->reached, 0, r->words * sizeof *r->reached);
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        const int is_everywhere = (s->zones[z].flags & ZONE_EVERYWHERE) != 0;
        if (!is_everywhere && zone_height(s, z, ray->from) > r->seams[z].touch) continue;
        r->reached[z / 64] |= (uint64_t)1 << z % 64;
        ++holders;
    }
    for (uint32_t i = 0; i < s->portal_count; ++i) {
        double at;
        if (passes(s, &s->portals[i], ray, &at) && at <= end) r->gates[count++] = (gate){at, i};
    }
    if (count) qsort(r->gates, count, sizeof *r->gates, by_place);
    for (uint32_t i = 0, first = 0; i < count; ++i) {
        while (r->gates[first].at * length < r->gates[i].at * length - SAME_PLACE_M) ++first;
        for (uint32_t k = first; k <= i; ++k) // again: of portals in one place any may come first
            for (uint32_t j = first; j <= i; ++j) go_through(r, &s->portals[r->gates[j].portal], ray);
    }
    return holders;
}

// Backs are looked through: what stands in the air with one side alone (that of a liquid's brush) hides nothing from behind.
sight_fault sight_judge(sight_rays *r, const sight_ray *ray)
{
    sight_ray on = *ray;
    first_hit hit = hit_first(r, &on);
    double end = hit.at;
    int backs = 0;
    for (; hit.item != SCENE_NONE && !hit.is_front; end += hit.at) {
        if (++backs > BACKS_MOST) return SIGHT_BACK;
        for (int k = 0; k < 3; ++k) on.from[k] += hit.at * (1 + 1e-9) * on.way[k];
        hit = hit_first(r, &on);
    }
    if (hit.item == SCENE_NONE) return SIGHT_VOID;
    if (!reach_zones(r, ray, end)) return SIGHT_NO_ZONE;
    const uint64_t *listed = &r->listed[(size_t)hit.item * r->words];
    for (uint32_t w = 0; w < r->words; ++w)
        if (listed[w] & r->reached[w]) return SIGHT_GOOD;
    return backs ? SIGHT_BACK : SIGHT_UNLISTED;
}

// ---- Random rays ----

static void random_way(random_stream *random, double out[3])
{
    do
        for (int k = 0; k < 3; ++k) out[k] = random_between(random, -1, 1);
    while (!(dot(out, out) > 0.01 && dot(out, out) < 1));
}

// A point a little off the front of the item; 0: the triangle is too small, or what it looks into is a slit.
static int off_wall(sight_rays *r, uint32_t item, double out[3])
{
    const scene *s = r->s;
    const scene_item *of = &s->items[item];
    const uint32_t first = of->first_index + 3 * random_below(&r->random, of->index_count / 3);
    double a[3], u[3], v[3], w[3], n[3], x = random_unit(&r->random), y = random_unit(&r->random);
    corner_of(s, first, a);
    corner_of(s, first + 1, u);
    corner_of(s, first + 2, v);
    for (int k = 0; k < 3; ++k) u[k] -= a[k], v[k] -= a[k], w[k] = v[k] - u[k];
    cross(u, v, n);
    if (x + y > 1) x = 1 - x, y = 1 - y;
    const double length = sqrt(dot(n, n)), least = OFF_EDGE_M / length; // of what is left to the edges, over twice the area
    if (!(y > least * sqrt(dot(u, u)) && x > least * sqrt(dot(v, v)) && 1 - x - y > least * sqrt(dot(w, w)))) return 0;
    sight_ray off; // from right before the wall, a few steps of the scene
    for (int k = 0; k < 3; ++k) {
        off.way[k] = OFF_WALL_M / length * n[k];
        off.from[k] = a[k] + x * u[k] + y * v[k] + off.way[k] / 64;
        out[k] = off.from[k] + off.way[k];
    }
    return hit_first(r, &off).at > 2;
}

static void portal_point(sight_rays *r, const scene_portal *p, double out[3])
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) out[k] = 0;
    for (uint32_t i = 0; i < p->point_count; ++i) {
        const double weight = random_unit(&r->random) + 1e-3;
        for (int k = 0; k < 3; ++k) out[k] += weight * r->s->portal_points[p->first_point + i][k];
        sum += weight;
    }
    for (int k = 0; k < 3; ++k) out[k] /= sum;
}

static int is_confirmed(sight_rays *r, const sight_ray *ray, sight_fault fault)
{
    const double length = sqrt(dot(ray->way, ray->way));
    for (int i = 0; i < 3; ++i) {
        sight_ray beside = *ray;
        double by[3];
        random_way(&r->random, by);
        for (int k = 0; k < 3; ++k) beside.way[k] += BESIDE * length * by[k];
        if (sight_judge(r, &beside) != fault) return 0;
    }
    return 1;
}

typedef struct cast { sight_rays *r; uint32_t *found; sight_ray *last; } cast;

static void judge(const cast *c, const sight_ray *ray)
{
    sight_fault fault = sight_judge(c->r, ray);
    if (fault != SIGHT_GOOD && !is_confirmed(c->r, ray, fault)) fault = SIGHT_GOOD;
    c->found[fault]++;
    if (fault != SIGHT_GOOD) *c->last = *ray;
}

static uint32_t item_near(sight_rays *r, const scene_portal *p)
{
    const scene_zone *z = &r->s->zones[p->zones[random_below(&r->random, 2)]];
    for (int tries = 0; z->item_count && tries < 16; ++tries) {
        const uint32_t item = r->s->zone_items[z->first_item + random_below(&r->random, z->item_count)];
        for (uint32_t w = 0; w < r->wall_count; ++w)
            if (r->walls[w] == item) return item;
    }
    return SCENE_NONE;
}

// From a wall to a point of the portal and on; and, where no wall stands between, from that point somewhere.
static void cast_through(const cast *c)
{
    const scene *s = c->r->s;
    const scene_portal *p = &s->portals[random_below(&c->r->random, s->portal_count)];
    const uint32_t item = item_near(c->r, p);
    sight_ray ray;
    double at[3];
    if (item == SCENE_NONE || !off_wall(c->r, item, ray.from)) return;
    portal_point(c->r, p, at);
    for (int k = 0; k < 3; ++k) ray.way[k] = at[k] - ray.from[k];
    if (!(dot(ray.way, ray.way) > 0)) return;
    const first_hit hit = hit_first(c->r, &ray);
    judge(c, &ray);
    if (hit.item == SCENE_NONE || hit.at < 1 + BESIDE) return;
    memcpy(ray.from, at, sizeof at);
    random_way(&c->r->random, ray.way);
    judge(c, &ray);
}

// From a wall somewhere; and from a point on the way somewhere else.
static void cast_off_wall(const cast *c)
{
    sight_ray ray;
    if (!off_wall(c->r, c->r->walls[random_below(&c->r->random, c->r->wall_count)], ray.from)) return;
    random_way(&c->r->random, ray.way);
    const first_hit hit = hit_first(c->r, &ray);
    judge(c, &ray);
    if (hit.item == SCENE_NONE || !hit.is_front) return;
    const double share = hit.at * random_between(&c->r->random, 0.05, 0.95);
    for (int k = 0; k < 3; ++k) ray.from[k] += share * ray.way[k];
    random_way(&c->r->random, ray.way);
    judge(c, &ray);
}

uint32_t sight_rays_cast(sight_rays *r, uint32_t count, uint32_t found[SIGHT_FAULTS], sight_ray *last)
{
    const cast c = {r, found, last};
    memset(found, 0, SIGHT_FAULTS * sizeof *found);
    for (uint32_t i = 0; i < count; ++i) {
        if (i % 2 == 0 || r->s->portal_count == 0) cast_off_wall(&c);
        else cast_through(&c);
    }
    uint32_t bad = 0;
    for (int f = SIGHT_GOOD + 1; f < SIGHT_FAULTS; ++f) bad += found[f];
    return bad;
}
