// Polygons made of planes: see exact_polygon.h. A cut keeps or inserts references to planes; corners are classified exactly.
// SPDX-License-Identifier: MIT
#include "exact_polygon.h"

exact_pool exact_pool_make(const cull_host *host, const exact_plane *planes)
{
    const exact_pool pool = {planes, vector_make(host, sizeof(exact_edge)), vector_make(host, sizeof(int8_t))};
    return pool;
}

void exact_pool_free(exact_pool *pool)
{
    vector_free(&pool->edges);
    vector_free(&pool->signs);
}

// ---- Which planes are the same ----

// Without a common divisor, the first number of the normal that isn't zero positive.
static cull_wide_plane canonical(const cull_wide_plane *p)
{
    cull_wide_plane out = cull_wide_plane_reduced(*p);
    for (int i = 0; i < 3; i++) {
        if (out.normal[i] == 0) continue;
        return out.normal[i] < 0 ? cull_wide_plane_flipped(out) : out;
    }
    return out;
}

static uint64_t hash_of(const cull_wide_plane *p)
{
    const uint64_t words[5] = {(uint64_t)p->normal[0], (uint64_t)p->normal[1], (uint64_t)p->normal[2], p->offset.low, p->offset.high};
    uint64_t hash = 0xcbf29ce484222325u;
    for (int i = 0; i < 5; i++) {
        hash = (hash ^ words[i]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash;
}

void exact_planes_match(exact_plane *planes, uint32_t count, uint32_t *scratch, uint32_t scratch_count)
{
    const uint32_t mask = scratch_count - 1;
    for (uint32_t i = 0; i < scratch_count; i++) scratch[i] = UINT32_MAX;
    for (uint32_t i = 0; i < count; i++) {
        const cull_wide_plane own = canonical(&planes[i].plane);
        uint32_t slot = (uint32_t)hash_of(&own) & mask;
        planes[i].same = i;
        planes[i].turned = 0;
        for (; scratch[slot] != UINT32_MAX; slot = (slot + 1) & mask) {
            const cull_wide_plane other = canonical(&planes[scratch[slot]].plane);
            if (!cull_wide_plane_equal(&own, &other)) continue;
            planes[i].same = scratch[slot];
            planes[i].turned = cull_normals_dot_sign(&planes[i].plane, &planes[scratch[slot]].plane) < 0;
            break;
        }
        if (planes[i].same == i) scratch[slot] = i;
    }
}

// ---- Corners ----

static void corner_planes(const exact_edge *edges, const exact_polygon *p, uint32_t i, uint32_t meet[3])
{
    meet[0] = p->plane;
    meet[1] = edges[i ? i - 1 : p->count - 1].plane;
    meet[2] = edges[i].plane;
}

static int meet_position(const exact_plane *planes, const uint32_t meet[3], double out[3])
{
    const cull_wide_plane *const p[3] = {&planes[meet[0]].plane, &planes[meet[1]].plane, &planes[meet[2]].plane};
    const cull_row *const r[3] = {&planes[meet[0]].row, &planes[meet[1]].row, &planes[meet[2]].row};
    return cull_meet_position_of_rows(p, r, out);
}

static int side_of_corner(const exact_plane *planes, const uint32_t meet[3], const double position[3], uint32_t by)
{
    const uint32_t same = planes[by].same;
    if (planes[meet[0]].same == same || planes[meet[1]].same == same || planes[meet[2]].same == same) return 0;
    const int sure = cull_side_of_position(&planes[by].row, position);
    if (sure) return sure;
    const cull_wide_plane *const p[4] = {&planes[meet[0]].plane, &planes[meet[1]].plane, &planes[meet[2]].plane, &planes[by].plane};
    const cull_row *const r[4] = {&planes[meet[0]].row, &planes[meet[1]].row, &planes[meet[2]].row, &planes[by].row};
    cull_tier tier;
    const int d = cull_four_sign_of_rows(p, r, &tier);
    return d ? d * cull_normals_sign_of_rows(p, r, &tier) : 0;
}

int exact_polygon_whole(exact_pool *pool, const uint32_t box[6], uint32_t plane, exact_polygon *out)
{
    const double *n = pool->planes[plane].row.n;
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (cull_size(n[i]) > cull_size(n[axis])) axis = i;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3; // counterclockwise seen against +axis: low v, high u, high v, low u
    const uint32_t sides[4] = {box[2 * v], box[2 * u + 1], box[2 * v + 1], box[2 * u]};
    exact_edge *edges = vector_push(&pool->edges, 4);
    if (!edges) return 0;
    out->plane = plane;
    out->first = pool->edges.count - 4;
    out->count = 4;
    for (int i = 0; i < 4; i++) edges[i].plane = sides[n[axis] > 0 ? i : 3 - i];
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t meet[3];
        corner_planes(edges, out, i, meet);
        meet_position(pool->planes, meet, edges[i].start);
    }
    return 1;
}

int exact_polygon_place(exact_pool *pool, const exact_polygon *p, uint32_t by, exact_place *out)
{
    unsigned place = EXACT_ON;
    pool->signs.count = 0;
    int8_t *signs = vector_push(&pool->signs, p->count);
    if (!signs) return 0;
    const exact_edge *edges = exact_edges(pool, p);
    for (uint32_t i = 0; i < p->count; i++) {
        uint32_t meet[3];
        corner_planes(edges, p, i, meet);
        const int side = side_of_corner(pool->planes, meet, edges[i].start, by);
        signs[i] = (int8_t)side;
        place |= side > 0 ? EXACT_FRONT : side < 0 ? EXACT_BEHIND : EXACT_ON;
    }
    *out = (exact_place)place;
    return 1;
}

// ---- Cuts ----

typedef struct cut_state {
    double into[3], back[3]; // where the loop leaves and where it enters the front
    const int8_t *signs;
    uint32_t count, by;
} cut_state;

// The part whose corners have the sign `side`: its edges in order, the cut's own between them.
static uint32_t copy_part(const exact_edge *from, const cut_state *c, int side, exact_edge *out)
{
    const double *leaves = side > 0 ? c->into : c->back, *enters = side > 0 ? c->back : c->into;
    uint32_t n = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        const uint32_t next = i + 1 < c->count ? i + 1 : 0;
        const int here = c->signs[i] * side, there = c->signs[next] * side;
        if (here <= 0 && there <= 0) continue;
        out[n] = from[i];
        if (here < 0) memcpy(out[n].start, enters, sizeof out[n].start);
        n++;
        if (there > 0) continue;
        out[n].plane = c->by;
        memcpy(out[n].start, there == 0 ? from[next].start : leaves, sizeof out[n].start);
        n++;
    }
    return n;
}

int exact_polygon_cut(exact_pool *pool, const exact_polygon *p, uint32_t by, exact_polygon *front, exact_polygon *behind)
{
    const uint32_t room = p->count + 2, base = pool->edges.count;
    const exact_polygon whole = *p;
    if (room > UINT32_MAX / 2 || !vector_reserve(&pool->edges, 2 * room)) return 0;
    exact_edge *all = pool->edges.items, *to = all + base;
    const exact_edge *from = all + whole.first;
    cut_state c = {.signs = pool->signs.items, .count = whole.count, .by = by};
    for (uint32_t i = 0; i < whole.count; i++) {
        const int here = c.signs[i], there = c.signs[i + 1 < whole.count ? i + 1 : 0];
        const uint32_t meet[3] = {whole.plane, from[i].plane, by};
        if (here > 0 && there < 0) meet_position(pool->planes, meet, c.into);
        if (here < 0 && there > 0) meet_position(pool->planes, meet, c.back);
    }
    front->plane = behind->plane = whole.plane;
    front->first = base;
    front->count = copy_part(from, &c, 1, to);
    behind->first = base + front->count;
    behind->count = copy_part(from, &c, -1, to + front->count);
    pool->edges.count = behind->first + behind->count;
    return 1;
}
