// Hulls of polygons in one plane: see flat_hulls.h.
// SPDX-License-Identifier: MIT
#include "flat_hulls.h"

#include "steady.h"

#include <stdlib.h>
#include <string.h>

// The joined hull's area over that of its polygons: 1.5, which two squares that meet in a corner have, and a rounding.
static const double LARGER_MOST = 1.5 * (1 + 1e-9);
// Share of a hull's size by which a corner may stand out of it and be left out: far below a float's step.
static const double FLAT_SHARE = 1e-12;

static double cross(const flat_point *a, const flat_point *b, const flat_point *c)
{
    return (b->at[0] - a->at[0]) * (c->at[1] - a->at[1]) - (b->at[1] - a->at[1]) * (c->at[0] - a->at[0]);
}

static int by_place(const void *a, const void *b)
{
    const flat_point *x = a, *y = b;
    for (int k = 0; k < 2; ++k)
        if (x->at[k] != y->at[k]) return x->at[k] < y->at[k] ? -1 : 1;
    return 0;
}

static double area_of(const flat_point *p, uint32_t count)
{
    double twice = 0;
    for (uint32_t i = 2; i < count; ++i) twice += cross(&p[0], &p[i - 1], &p[i]);
    return twice / 2;
}

static uint32_t chain_push(flat_point *out, uint32_t base, uint32_t count, const flat_point *p, double flat)
{
    while (count - base >= 2 && cross(&out[count - 2], &out[count - 1], p) <= flat) --count;
    out[count] = *p;
    return count + 1;
}

// Of the points in scratch, appended to points.
static result hull_make(flat_hulls *h, flat_hull *out)
{
    const uint32_t count = (uint32_t)h->scratch.count;
    flat_point *from = h->scratch.items;
    qsort(from, count, sizeof *from, by_place);
    flat_point *to = buffer_push(&h->points, 2 * (size_t)count);
    if (!to) return RESULT_NO_MEMORY;
    const double wide = from[count - 1].at[0] - from[0].at[0], flat = FLAT_SHARE * wide * wide;
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; ++i) n = chain_push(to, 0, n, &from[i], flat);
    const uint32_t lower = n - 1;
    for (uint32_t i = count - 1; i-- > 0;) n = chain_push(to, lower, n, &from[i], flat);
    out->count = n - 1; // the first point again
    out->first = (uint32_t)(to - (flat_point *)h->points.items);
    h->points.count = out->first + out->count;
    return RESULT_OK;
}

// ---- What is given ----

flat_hulls flat_hulls_make(const allocator *memory)
{
    return (flat_hulls){.points = buffer_make(memory, sizeof(flat_point)),
                        .hulls = buffer_make(memory, sizeof(flat_hull)),
                        .scratch = buffer_make(memory, sizeof(flat_point)),
                        .pairs = buffer_make(memory, sizeof(flat_pair))};
}

void flat_hulls_free(flat_hulls *h)
{
    buffer_free(&h->points);
    buffer_free(&h->hulls);
    buffer_free(&h->scratch);
    buffer_free(&h->pairs);
}

void flat_hulls_start(flat_hulls *h, const plane_table *planes, plane_ref plane)
{
    const cull_wide_plane p = plane_table_get(planes, plane);
    uint32_t axis = 0;
    for (uint32_t k = 1; k < 3; ++k)
        if (cull_magnitude(p.normal[k]) > cull_magnitude(p.normal[axis])) axis = k;
    h->axes[0] = (axis + 1) % 3;
    h->axes[1] = (axis + 2) % 3;
    h->is_turned = p.normal[axis] < 0;
    h->points.count = h->hulls.count = h->scratch.count = 0;
}

result flat_hulls_corner(flat_hulls *h, const double position[3])
{
    flat_point *p = buffer_push(&h->scratch, 1);
    if (!p) return RESULT_NO_MEMORY;
    memcpy(p->position, position, sizeof p->position);
    for (int k = 0; k < 2; ++k) p->at[k] = position[h->axes[k]];
    return RESULT_OK;
}

result flat_hulls_close(flat_hulls *h)
{
    flat_hull made = {0};
    const result r = hull_make(h, &made);
    if (r != RESULT_OK) return r;
    made.area = area_of(flat_hull_points(h, &made), made.count);
    h->scratch.count = 0;
    return buffer_append(&h->hulls, &made, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

// ---- Joining ----

static flat_hull *hull_at(const flat_hulls *h, uint32_t i)
{
    return (flat_hull *)h->hulls.items + i;
}

// Of two, appended to points.
static result hull_of_both(flat_hulls *h, const uint32_t hulls[2], flat_hull *out)
{
    h->scratch.count = 0;
    *out = (flat_hull){0};
    for (int i = 0; i < 2; ++i) {
        const flat_hull *g = hull_at(h, hulls[i]);
        if (!buffer_append(&h->scratch, flat_hull_points(h, g), g->count)) return RESULT_NO_MEMORY;
        out->area += g->area;
    }
    return hull_make(h, out);
}

// Squared, from the middle of all that was given: its corners alone would depend on where it was cut.
static double off_middle(const flat_hulls *h, const flat_hull *g)
{
    double middle[3] = {0}, all[3] = {0}, weight = 0, square = 0;
    for (uint32_t i = 0; i < g->count; ++i)
        for (int k = 0; k < 3; ++k) middle[k] += flat_hull_points(h, g)[i].position[k] / g->count;
    for (size_t i = 0; i < h->hulls.count; ++i) {
        const flat_hull *x = hull_at(h, (uint32_t)i);
        if (x->is_gone) continue;
        const flat_point *p = flat_hull_points(h, x);
        for (uint32_t c = 0; c < x->count; ++c)
            for (int k = 0; k < 3; ++k) all[k] += p[c].position[k] * x->area / x->count;
        weight += x->area;
    }
    for (int k = 0; k < 3; ++k) square += (middle[k] - all[k] / weight) * (middle[k] - all[k] / weight);
    return square;
}

static result pair_consider(flat_hulls *h, uint32_t a, uint32_t b)
{
    const size_t before = h->points.count;
    flat_hull both;
    flat_pair made = {.hulls = {a, b}};
    const result r = hull_of_both(h, made.hulls, &both);
    if (r != RESULT_OK) return r;
    const double larger = area_of(flat_hull_points(h, &both), both.count) / both.area;
    made.waste = steady_log(larger);
    made.area = steady_log(both.area);
    made.place = steady_log(off_middle(h, &both));
    h->points.count = before;
    return larger > LARGER_MOST || buffer_append(&h->pairs, &made, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

// The one that adds least; of several the largest, then the farthest off.
static int comes_first(const flat_pair *a, const flat_pair *b)
{
    if (a->waste != b->waste) return a->waste < b->waste;
    if (a->area != b->area) return a->area > b->area;
    return a->place > b->place;
}

static flat_pair pair_best(const flat_hulls *h)
{
    const flat_pair *all = h->pairs.items;
    size_t best = 0;
    for (size_t i = 1; i < h->pairs.count; ++i)
        if (comes_first(&all[i], &all[best])) best = i;
    return all[best];
}

static void pairs_drop(flat_hulls *h, const uint32_t gone[2])
{
    flat_pair *all = h->pairs.items;
    size_t kept = 0;
    for (size_t i = 0; i < h->pairs.count; ++i) {
        const uint32_t *of = all[i].hulls;
        if (of[0] != gone[0] && of[0] != gone[1] && of[1] != gone[0] && of[1] != gone[1]) all[kept++] = all[i];
    }
    h->pairs.count = kept;
}

static result pair_join(flat_hulls *h, const flat_pair *pair)
{
    const uint32_t number = (uint32_t)h->hulls.count;
    flat_hull both;
    result r = hull_of_both(h, pair->hulls, &both);
    if (r == RESULT_OK && !buffer_append(&h->hulls, &both, 1)) r = RESULT_NO_MEMORY;
    if (r != RESULT_OK) return r;
    for (int i = 0; i < 2; ++i) hull_at(h, pair->hulls[i])->is_gone = 1;
    pairs_drop(h, pair->hulls);
    for (uint32_t i = 0; i < number && r == RESULT_OK; ++i)
        if (!hull_at(h, i)->is_gone) r = pair_consider(h, i, number);
    return r;
}

result flat_hulls_join(flat_hulls *h, uint32_t *left)
{
    result r = RESULT_OK;
    *left = (uint32_t)h->hulls.count;
    h->pairs.count = 0;
    for (uint32_t a = 0; a < *left; ++a)
        for (uint32_t b = a + 1; b < h->hulls.count && r == RESULT_OK; ++b) r = pair_consider(h, a, b);
    for (; h->pairs.count > 0 && r == RESULT_OK; --*left) {
        const flat_pair best = pair_best(h);
        r = pair_join(h, &best);
    }
    return r;
}
