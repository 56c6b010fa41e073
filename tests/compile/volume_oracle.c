// Convex cells of rational points, cut plane by plane: see volume_oracle.h.
// SPDX-License-Identifier: MIT
// Invariant: a cell's faces are convex loops, counterclockwise from outside; points that faces share are the same point.
#include "volume_oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CELL_REACH 33554432 // 2^25
static const double SURE = 1e-13; // of the sum of sizes: a hundred times the error of the seven roundings before

typedef struct point { mpq_t at[3]; double rough[3]; } point;
typedef struct points { point *all; uint32_t count, room; } points;

typedef struct cell { // face i: loop[first[i]] up to loop[first[i + 1]]
    uint32_t *loop, *first, face_count;
} cell;
typedef struct cells { cell *all; size_t count, room; } cells;

static void *grown(void *had, size_t size)
{
    void *now = realloc(had, size ? size : 1);
    if (!now) abort();
    return now;
}

static void require(int truth) // in every build
{
    if (!truth) abort();
}

// ---- Points ----

static uint32_t add_point(points *p)
{
    if (p->count == p->room) {
        p->room = p->room ? 2 * p->room : 64;
        p->all = grown(p->all, p->room * sizeof *p->all);
    }
    for (int k = 0; k < 3; ++k) mpq_init(p->all[p->count].at[k]);
    return p->count++;
}

static void drop_points(points *p)
{
    for (uint32_t i = 0; i < p->count; ++i)
        for (int k = 0; k < 3; ++k) mpq_clear(p->all[i].at[k]);
    free(p->all);
    *p = (points){0};
}

static void height(const oracle_plane *h, const point *p, mpq_t out) // normal . p + offset
{
    mpq_t part, factor;
    mpq_inits(part, factor, NULL);
    mpq_set_z(out, h->offset);
    for (int k = 0; k < 3; ++k) {
        mpq_set_z(factor, h->normal[k]);
        mpq_mul(part, factor, p->at[k]);
        mpq_add(out, out, part);
    }
    mpq_clears(part, factor, NULL);
}

static int side_of(const oracle_plane *h, const point *p)
{
    double sum = h->rough[3], sizes = fabs(h->rough[3]);
    for (int k = 0; k < 3; ++k) {
        sum += h->rough[k] * p->rough[k];
        sizes += fabs(h->rough[k] * p->rough[k]);
    }
    if (fabs(sum) > SURE * sizes) return sum > 0 ? 1 : -1;
    mpq_t exact;
    mpq_init(exact);
    height(h, p, exact);
    const int sign = mpq_sgn(exact);
    mpq_clear(exact);
    return sign;
}

static uint32_t meeting_point(points *p, uint32_t a, uint32_t b, const oracle_plane *h)
{
    const uint32_t made = add_point(p);
    point *to = &p->all[made];
    mpq_t ha, hb, part;
    mpq_inits(ha, hb, part, NULL);
    height(h, &p->all[a], ha);
    height(h, &p->all[b], hb);
    mpq_sub(hb, ha, hb);
    mpq_div(ha, ha, hb); // how far from a to b
    for (int k = 0; k < 3; ++k) {
        mpq_sub(part, p->all[b].at[k], p->all[a].at[k]);
        mpq_mul(part, part, ha);
        mpq_add(to->at[k], p->all[a].at[k], part);
        to->rough[k] = mpq_get_d(to->at[k]);
    }
    mpq_clears(ha, hb, part, NULL);
    return made;
}

// ---- Cells ----

static cell cube(points *p)
{
    static const uint32_t loops[24] = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
    uint32_t corners[8];
    cell c = {grown(NULL, sizeof loops), grown(NULL, 7 * sizeof *c.first), 6};
    for (int i = 0; i < 8; ++i) {
        corners[i] = add_point(p);
        for (int k = 0; k < 3; ++k) {
            mpq_set_si(p->all[corners[i]].at[k], i >> k & 1 ? CELL_REACH : -CELL_REACH, 1);
            p->all[corners[i]].rough[k] = i >> k & 1 ? CELL_REACH : -CELL_REACH;
        }
    }
    for (int i = 0; i < 24; ++i) c.loop[i] = corners[loops[i]];
    for (uint32_t f = 0; f <= 6; ++f) c.first[f] = 4 * f;
    return c;
}

static void drop_cell(cell *c)
{
    free(c->loop);
    free(c->first);
    *c = (cell){0};
}

static void keep_cell(cells *list, cell c)
{
    if (list->count == list->room) {
        list->room = list->room ? 2 * list->room : 16;
        list->all = grown(list->all, list->room * sizeof *list->all);
    }
    list->all[list->count++] = c;
}

typedef struct cut { // of one cell by one plane
    points *points;
    const oracle_plane *by;
    const int8_t *sides;      // by place in the cell's loops
    uint32_t (*edges)[3];     // both ends, the point between
    uint32_t edge_count;
} cut;

static uint32_t point_on(cut *c, uint32_t a, uint32_t b)
{
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    for (uint32_t i = 0; i < c->edge_count; ++i)
        if (c->edges[i][0] == low && c->edges[i][1] == high) return c->edges[i][2];
    uint32_t *e = c->edges[c->edge_count++];
    e[0] = low;
    e[1] = high;
    e[2] = meeting_point(c->points, low, high, c->by);
    return e[2];
}

// The part of the face on the side `keep` (-1 or 1) to out; *cap: its edge on the plane, the other way round. 0: nothing but its border is there.
static uint32_t cut_face(cut *c, const cell *from, uint32_t face, int keep, uint32_t *out, uint32_t cap[2])
{
    uint32_t count = 0, on_plane[2], at[2], on_count = 0, inside = 0;
    const uint32_t first = from->first[face], corners = from->first[face + 1] - first;
    for (uint32_t i = 0; i < corners; ++i) inside += c->sides[first + i] == keep;
    if (!inside) return 0;
    for (uint32_t i = 0; i < corners; ++i) {
        const uint32_t a = from->loop[first + i], b = from->loop[first + (i + 1) % corners];
        const int side_a = c->sides[first + i], side_b = c->sides[first + (i + 1) % corners];
        if (side_a == 0) {
            require(on_count < 2);
            at[on_count] = count;
            on_plane[on_count++] = a;
        }
        if (side_a == keep || side_a == 0) out[count++] = a;
        if (side_a * side_b >= 0) continue;
        require(on_count < 2);
        at[on_count] = count;
        on_plane[on_count++] = out[count++] = point_on(c, a, b);
    }
    cap[0] = cap[1] = UINT32_MAX;
    if (on_count < 2) return count;
    const int follows = at[1] == at[0] + 1; // the edge goes from the first to the second; else from the second round to the first
    cap[0] = on_plane[follows ? 1 : 0];
    cap[1] = on_plane[follows ? 0 : 1];
    return count;
}

static uint32_t chain_cap(uint32_t (*edges)[2], uint32_t count, uint32_t *out)
{
    uint32_t next = edges[0][0];
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t e = 0;
        while (e < count && edges[e][0] != next) ++e;
        require(e < count);
        out[i] = next;
        next = edges[e][1];
    }
    require(next == edges[0][0]);
    return count;
}

// The part of the cell on one side of the plane, which goes through its inside.
static cell part_of(cut *c, const cell *from, int keep)
{
    const uint32_t corners = from->first[from->face_count];
    cell to = {grown(NULL, (3 * (size_t)corners + 8) * sizeof *to.loop), grown(NULL, (from->face_count + 2) * sizeof *to.first), 0};
    uint32_t(*caps)[2] = grown(NULL, from->face_count * sizeof *caps), cap_count = 0, used = 0;
    for (uint32_t f = 0; f < from->face_count; ++f) {
        const uint32_t count = cut_face(c, from, f, keep, to.loop + used, caps[cap_count]);
        if (!count) continue;
        to.first[to.face_count++] = used;
        used += count;
        cap_count += caps[cap_count][0] != UINT32_MAX;
    }
    require(cap_count >= 3);
    to.first[to.face_count++] = used;
    used += chain_cap(caps, cap_count, to.loop + used);
    to.first[to.face_count] = used;
    free(caps);
    return to;
}

// Bit 1: some of it lies outside of the plane, bit 2: some inside.
static unsigned sides_of(const points *p, const cell *c, const oracle_plane *by, int8_t *sides)
{
    unsigned found = 0;
    for (uint32_t i = 0; i < c->first[c->face_count]; ++i) {
        sides[i] = (int8_t)side_of(by, &p->all[c->loop[i]]);
        found |= sides[i] > 0 ? 1u : sides[i] < 0 ? 2u : 0u;
    }
    return found;
}

// The cell inside the plane; what was outside goes to `outside`, or nowhere where that is NULL. An empty cell has no faces.
static void clip(points *p, cell *c, const oracle_plane *by, cells *outside)
{
    const uint32_t corners = c->first[c->face_count];
    int8_t *sides = grown(NULL, corners);
    const unsigned found = sides_of(p, c, by, sides);
    if (found == 3) {
        cut k = {p, by, sides, grown(NULL, corners * sizeof *k.edges), 0};
        const cell inside = part_of(&k, c, -1);
        if (outside) keep_cell(outside, part_of(&k, c, 1));
        free(k.edges);
        drop_cell(c);
        *c = inside;
    } else if (found == 1) {
        if (outside) keep_cell(outside, *c);
        else drop_cell(c);
        *c = (cell){0};
    }
    free(sides);
}

// ---- Volumes ----

static void add_triangle(const point *a, const point *b, const point *c, mpq_t sum) // a . (b x c)
{
    mpq_t left, right;
    mpq_inits(left, right, NULL);
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        mpq_mul(left, b->at[i], c->at[j]);
        mpq_mul(right, b->at[j], c->at[i]);
        mpq_sub(left, left, right);
        mpq_mul(left, left, a->at[k]);
        mpq_add(sum, sum, left);
    }
    mpq_clears(left, right, NULL);
}

static void add_volume(const points *p, const cell *c, mpq_t sum)
{
    for (uint32_t f = 0; f < c->face_count; ++f)
        for (uint32_t i = c->first[f] + 1; i + 1 < c->first[f + 1]; ++i)
            add_triangle(&p->all[c->loop[c->first[f]]], &p->all[c->loop[i]], &p->all[c->loop[i + 1]], sum);
}

static int is_apart(const points *p, const cell *c, const oracle_body *b)
{
    int8_t *sides = grown(NULL, c->first[c->face_count]);
    int apart = 0;
    for (uint32_t i = 0; i < b->plane_count && !apart; ++i) apart = !(sides_of(p, c, &b->planes[i], sides) & 2u);
    free(sides);
    return apart;
}

static int boxes_meet(const oracle_body *a, const oracle_body *b)
{
    for (int k = 0; k < 3; ++k)
        if (a->min[k] > b->max[k] || b->min[k] > a->max[k]) return 0;
    return 1;
}

static void subtract(points *p, cells *list, const oracle_body *b)
{
    cells rest = {0};
    for (size_t i = 0; i < list->count; ++i) {
        cell *c = &list->all[i];
        if (is_apart(p, c, b)) {
            keep_cell(&rest, *c);
            continue;
        }
        for (uint32_t h = 0; h < b->plane_count && c->face_count; ++h) clip(p, c, &b->planes[h], &rest);
        drop_cell(c);
    }
    free(list->all);
    *list = rest;
}

uint64_t oracle_volume(const oracle_body *bodies, uint32_t count, mpq_t six_volumes)
{
    uint64_t measured = 0;
    mpq_set_ui(six_volumes, 0, 1);
    for (uint32_t i = 0; i < count; ++i) {
        if (bodies[i].kind == ORACLE_SUBTRACT) continue;
        points p = {0};
        cells list = {0};
        cell whole = cube(&p);
        for (uint32_t h = 0; h < bodies[i].plane_count && whole.face_count; ++h) clip(&p, &whole, &bodies[i].planes[h], NULL);
        if (whole.face_count) keep_cell(&list, whole);
        for (uint32_t j = i + 1; j < count; ++j)
            if (boxes_meet(&bodies[i], &bodies[j])) subtract(&p, &list, &bodies[j]);
        for (size_t c = 0; c < list.count; ++c) {
            add_volume(&p, &list.all[c], six_volumes);
            drop_cell(&list.all[c]);
        }
        measured += list.count;
        free(list.all);
        drop_points(&p);
    }
    return measured;
}
