// Half-edge collapses in passes: see simplify.h. What a collapse does to the surface is in simplify_star.c.
// SPDX-License-Identifier: MIT
#include "simplify_star.h"

#include <math.h>
#include <string.h>

#define NONE UINT32_MAX
enum { LOOK_IN_VAIN, LOOK_NOW, LOOK_AT_MORE }; // until something round it changes; as something did; when more is allowed
enum { PASSES_MOST = 6, STEPS = 3 };
#define WORTH_A_PASS (1.0 / 64) // of the points: fewer collapses end a step

struct simplify {
    simplify_input in;
    const allocator *memory;
    uint32_t *corners;  // the caller's
    uint32_t *place_of; // a vertex: the first one with its position
    uint32_t *heads;    // a place: the first corner there, or NONE
    uint32_t *next;     // a corner: the next one there
    float *errors;      // a triangle: how far its points may stand from their places, metres
    uint8_t *looks;     // a place: LOOK_*
    uint32_t live;      // triangles
};

// ---- Points ----

static uint32_t hash_of(const float p[3])
{
    uint32_t bits[3], hash = 0x9e3779b9u;
    memcpy(bits, p, sizeof bits);
    for (int k = 0; k < 3; ++k) {
        hash = (hash ^ bits[k]) * 0x85ebca6bu;
        hash ^= hash >> 15;
    }
    return hash;
}

static result weld(simplify *s)
{
    const uint32_t count = s->in.position_count;
    size_t size = 64;
    while (size < 2 * (size_t)count) size *= 2;
    uint32_t *slots = memory_alloc(s->memory, size, sizeof *slots);
    if (!slots) return RESULT_NO_MEMORY;
    memset(slots, 0xff, size * sizeof *slots);
    for (uint32_t v = 0; v < count; ++v) {
        const float *p = s->in.positions + 3 * (size_t)v;
        const float at[3] = {p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f}; // -0 becomes 0
        size_t slot = hash_of(at) & (size - 1);
        for (; slots[slot] != NONE; slot = (slot + 1) & (size - 1)) {
            const float *q = s->in.positions + 3 * (size_t)slots[slot];
            if (q[0] == p[0] && q[1] == p[1] && q[2] == p[2]) break;
        }
        if (slots[slot] == NONE) slots[slot] = v;
        s->place_of[v] = slots[slot];
    }
    memory_free(s->memory, slots, size, sizeof *slots);
    return RESULT_OK;
}

static void put_corner(simplify *s, uint32_t corner, uint32_t place)
{
    s->next[corner] = s->heads[place];
    s->heads[place] = corner;
}

// ---- The triangles round a point ----

static void set_point(const simplify *s, uint32_t vertex, star_point *out)
{
    const float *p = s->in.positions + 3 * (size_t)vertex;
    out->place = s->place_of[vertex];
    for (int k = 0; k < 3; ++k) out->at[k] = (double)p[k];
}

// What is gone is unlinked on the way. 0: too many for a star.
static int gather(simplify *s, uint32_t place, star *out)
{
    uint32_t *link = &s->heads[place];
    out->count = 0;
    while (*link != NONE) {
        const uint32_t c = *link, t = c / 3, *corners = s->corners + (size_t)3 * t;
        if (corners[0] == SIMPLIFY_GONE) {
            *link = s->next[c];
            continue;
        }
        if (out->count == STAR_MOST) return 0;
        star_triangle *to = &out->triangles[out->count++];
        to->corner = c;
        to->group = s->in.groups[t];
        to->error = (double)s->errors[t];
        to->wedge = s->corners[c];
        to->vertices[0] = corners[(c + 1) % 3 == 0 ? 0 : c % 3 + 1];
        to->vertices[1] = corners[(c + 2) % 3];
        for (int k = 0; k < 2; ++k) set_point(s, to->vertices[k], &to->points[k]);
        link = &s->next[c];
    }
    return 1;
}

// Points that the two have beside them both: a collapse that has more than the tips of their common triangles makes a fold.
static uint32_t common_neighbours(const simplify *s, const star *round, uint32_t other)
{
    uint32_t count = 0, seen[STAR_MOST * 2];
    for (uint32_t c = s->heads[other]; c != NONE; c = s->next[c]) {
        const uint32_t t = c / 3, *corners = s->corners + (size_t)3 * t;
        if (corners[0] == SIMPLIFY_GONE) continue;
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t place = s->place_of[corners[k]];
            uint32_t is_new = place != other && place != round->centre.place && star_has(round, place);
            for (uint32_t i = 0; i < count && is_new; ++i) is_new = seen[i] != place;
            if (!is_new) continue;
            if (count == STAR_MOST * 2) return count;
            seen[count++] = place;
        }
    }
    return count;
}

static double normal_part(uint32_t packed, int k)
{
    return (double)(int8_t)(packed >> 8 * k & 0xff) / 127;
}

static void set_normals(const simplify *s, star *round)
{
    for (uint32_t i = 0; i < round->count; ++i) {
        star_triangle *t = &round->triangles[i];
        for (int k = 0; k < 3; ++k) {
            t->normals[0][k] = normal_part(s->in.normals[t->vertices[0]], k);
            t->normals[1][k] = normal_part(s->in.normals[t->vertices[1]], k);
            t->normals[2][k] = normal_part(s->in.normals[t->wedge], k);
        }
    }
}

static int may_change(const simplify *s, const star *round)
{
    for (uint32_t i = 0; i < round->count; ++i) {
        const star_triangle *t = &round->triangles[i];
        if (t->group == SIMPLIFY_KEPT || !(s->in.normals[t->wedge] & 0xffffffu)) return 0;
        if (!(s->in.normals[t->vertices[0]] & 0xffffffu) || !(s->in.normals[t->vertices[1]] & 0xffffffu)) return 0;
    }
    return round->count > 0;
}

// ---- Collapses ----

static void collapse(simplify *s, const star *round, const star_collapse *how)
{
    for (uint32_t i = 0; i < round->count; ++i) {
        const star_triangle *t = &round->triangles[i];
        const uint32_t triangle = t->corner / 3;
        s->looks[t->points[0].place] = s->looks[t->points[1].place] = LOOK_NOW;
        if (how->wedges[i] == STAR_ENDS) {
            s->corners[(size_t)3 * triangle] = SIMPLIFY_GONE;
            s->live--;
            continue;
        }
        s->corners[t->corner] = how->wedges[i];
        s->errors[triangle] = nextafterf((float)how->error, INFINITY); // never below the sum
        put_corner(s, t->corner, how->target);
    }
    s->heads[round->centre.place] = NONE;
}

static int try_place(simplify *s, uint32_t place, const star_limits *limits)
{
    star round;
    star_collapse best = {.cost = INFINITY}, now;
    round.centre.place = place;
    s->looks[place] = LOOK_IN_VAIN;
    if (!gather(s, place, &round) || !may_change(s, &round)) return 0;
    set_point(s, place, &round.centre);
    if (!star_open(&round)) return 0;
    set_normals(s, &round);
    for (uint32_t i = 0; i < round.count; ++i) {
        if (!star_try(&round, i, limits, &now) || !(now.cost < best.cost)) continue;
        if (common_neighbours(s, &round, now.target) == 2) best = now;
    }
    s->looks[place] = LOOK_AT_MORE;
    if (!(best.cost < INFINITY)) return 0;
    collapse(s, &round, &best);
    return 1;
}

uint32_t simplify_to(simplify *s, double bound_m)
{
    for (int step = STEPS; step-- > 0;) {
        const star_limits limits = {.sum = bound_m, .once = ldexp(bound_m, -step)};
        for (uint32_t p = 0; p < s->in.position_count; ++p)
            if (s->looks[p] == LOOK_AT_MORE) s->looks[p] = LOOK_NOW;
        for (int pass = 0; pass < PASSES_MOST; ++pass) {
            uint32_t done = 0;
            for (uint32_t p = 0; p < s->in.position_count; ++p)
                if (s->looks[p] == LOOK_NOW && s->heads[p] != NONE) done += (uint32_t)try_place(s, p, &limits);
            if (done <= WORTH_A_PASS * s->in.position_count) break;
        }
    }
    return s->live;
}

// ---- The whole ----

static result fill(simplify *s)
{
    const size_t triangles = s->in.triangle_count, places = s->in.position_count;
    s->place_of = memory_alloc(s->memory, places, sizeof *s->place_of);
    s->heads = memory_alloc(s->memory, places, sizeof *s->heads);
    s->next = memory_alloc(s->memory, triangles, 3 * sizeof *s->next);
    s->errors = memory_alloc_zeroed(s->memory, triangles, sizeof *s->errors);
    s->looks = memory_alloc(s->memory, places, 1);
    if (!s->place_of || !s->heads || !s->next || !s->errors || !s->looks || weld(s) != RESULT_OK) return RESULT_NO_MEMORY;
    memset(s->heads, 0xff, places * sizeof *s->heads);
    memset(s->looks, LOOK_NOW, places);
    for (size_t c = 3 * triangles; c-- > 0;) put_corner(s, (uint32_t)c, s->place_of[s->corners[c]]);
    s->live = s->in.triangle_count;
    return RESULT_OK;
}

result simplify_open(const simplify_input *in, uint32_t *corners, const allocator *memory, simplify **out)
{
    simplify *s = memory_alloc_zeroed(memory, 1, sizeof *s);
    if (!s) return RESULT_NO_MEMORY;
    s->in = *in;
    s->memory = memory;
    s->corners = corners;
    if (fill(s) != RESULT_OK) {
        simplify_close(s);
        return RESULT_NO_MEMORY;
    }
    *out = s;
    return RESULT_OK;
}

void simplify_close(simplify *s)
{
    if (!s) return;
    const size_t triangles = s->in.triangle_count, places = s->in.position_count;
    memory_free(s->memory, s->place_of, places, sizeof *s->place_of);
    memory_free(s->memory, s->heads, places, sizeof *s->heads);
    memory_free(s->memory, s->next, triangles, 3 * sizeof *s->next);
    memory_free(s->memory, s->errors, triangles, sizeof *s->errors);
    memory_free(s->memory, s->looks, places, 1);
    memory_free(s->memory, s, 1, sizeof *s);
}
