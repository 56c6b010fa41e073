// Cells by rings about the eye's cell: see rings.h.
// SPDX-License-Identifier: MIT
#include "rings.h"

// Each axis belongs to one quadrant: place runs from 1, so d - place is 0 on one of a quadrant's axes and place never is.
static const struct { int32_t ai, aj, bi, bj; } WAYS[RINGS_QUADRANTS] = {
    {1, -1, 0, 1},  // di = place, dj = d - place
    {1, 1, -1, 0},  // di = place - d, dj = place
    {-1, 1, 0, -1}, // di = -place, dj = place - d
    {-1, -1, 1, 0}, // di = d - place, dj = -place
};

typedef struct ring_line { int64_t place, ring, one; } ring_line; // place * p + ring * t + one >= 0, t: rings since the first

static int64_t floor_of(int64_t n, int64_t d) // d above 0
{
    return n >= 0 ? n / d : -((-n + d - 1) / d);
}

static rings_lane lane_of(int64_t start, int64_t step, int64_t divisor)
{
    rings_lane l = {.divisor = divisor, .value = floor_of(start, divisor), .value_step = floor_of(step, divisor)};
    l.rest = start - l.value * divisor;
    l.rest_step = step - l.value_step * divisor;
    return l;
}

static int64_t lane_next(rings_lane *l)
{
    const int64_t value = l->value;
    l->value += l->value_step;
    l->rest += l->rest_step;
    if (l->rest >= l->divisor) {
        l->rest -= l->divisor;
        l->value++;
    }
    return value;
}

// How a * i + b * j + c >= 0 reads in a quadrant whose first ring is d0 and whose rings go by `step`.
static ring_line line_in(const rings *r, const rings_quadrant *q, footprint_edge e, int32_t d0)
{
    const int64_t ring = e.a * q->bi + e.b * q->bj;
    const ring_line l = {e.a * q->ai + e.b * q->aj, ring * r->step, e.a * r->eye.i + e.b * r->eye.j + e.c + ring * d0};
    return l;
}

// place >= -(one + ring t) / place': minus the least place is floor((one + ring t) / place'); place <= (one + ring t) / -place'.
static void lane_add(rings_quadrant *q, const ring_line *l, int lower)
{
    if (lower ? l->place <= 0 : l->place >= 0) return;
    q->lanes[q->lane_count++] = lane_of(l->one, l->ring, lower ? l->place : -l->place);
}

// Where the place has no part the line only says which rings there are.
static void rings_cut(const ring_line *l, const rings *r, rings_quadrant *q)
{
    if (l->place != 0) return;
    int64_t last = (int64_t)(q->ring_last - q->ring) * r->step, first = 0; // in rings since the first
    if (l->ring == 0) {
        if (l->one < 0) last = -1;
    } else if (l->ring > 0) {
        const int64_t least = -floor_of(l->one, l->ring);
        if (least > first) first = least;
    } else {
        const int64_t most = floor_of(l->one, -l->ring);
        if (most < last) last = most;
    }
    if (first > last) {
        q->ring_last = q->ring - r->step;
        return;
    }
    q->ring_last = q->ring + (int32_t)last * r->step;
    q->ring += (int32_t)first * r->step;
}

static int32_t nearest(int32_t low, int32_t high) // of low .. high to 0
{
    return low > 0 ? low : high < 0 ? -high : 0;
}

static int32_t farthest(int32_t low, int32_t high)
{
    return -low > high ? -low : high;
}

// The rings of the footprint's box that have a part in the quadrant; 0: none.
static int quadrant_rings(const rings *r, const footprint *f, rings_quadrant *q)
{
    int32_t low_i = f->columns.first - r->eye.i, high_i = f->columns.last - r->eye.i;
    int32_t low_j = f->rows.first - r->eye.j, high_j = f->rows.last - r->eye.j;
    const int32_t quadrant = (int32_t)(q - r->quadrants);
    static const struct { int32_t low_i, high_i, low_j, high_j; } SIGNS[RINGS_QUADRANTS] = {
        {1, INT32_MAX, 0, INT32_MAX}, {-INT32_MAX, 0, 1, INT32_MAX}, {-INT32_MAX, -1, -INT32_MAX, 0}, {0, INT32_MAX, -INT32_MAX, -1}};
    if (low_i < SIGNS[quadrant].low_i) low_i = SIGNS[quadrant].low_i;
    if (high_i > SIGNS[quadrant].high_i) high_i = SIGNS[quadrant].high_i;
    if (low_j < SIGNS[quadrant].low_j) low_j = SIGNS[quadrant].low_j;
    if (high_j > SIGNS[quadrant].high_j) high_j = SIGNS[quadrant].high_j;
    if (low_i > high_i || low_j > high_j) return 0;
    const int32_t least = nearest(low_i, high_i) + nearest(low_j, high_j), most = farthest(low_i, high_i) + farthest(low_j, high_j);
    q->ring = r->step > 0 ? least : most;
    q->ring_last = r->step > 0 ? most : least;
    return 1;
}

static uint32_t edges_of(const footprint *f, footprint_edge *edges)
{
    uint32_t count = 0;
    for (uint32_t e = 0; e < f->edge_count; e++) edges[count++] = f->edges[e];
    edges[count++] = (footprint_edge){1, 0, -(int64_t)f->columns.first};
    edges[count++] = (footprint_edge){-1, 0, f->columns.last};
    edges[count++] = (footprint_edge){0, 1, -(int64_t)f->rows.first};
    edges[count++] = (footprint_edge){0, -1, f->rows.last};
    return count;
}

static void quadrant_start(const rings *r, const footprint *f, rings_quadrant *q)
{
    footprint_edge edges[RINGS_LANES];
    const uint32_t edge_count = edges_of(f, edges);
    q->lane_count = q->lower_count = 0;
    if (!quadrant_rings(r, f, q)) {
        q->ring = 0;
        q->ring_last = -r->step;
        return;
    }
    for (uint32_t e = 0; e < edge_count; e++) {
        const ring_line l = line_in(r, q, edges[e], q->ring);
        rings_cut(&l, r, q);
    }
    const ring_line own[2] = {{1, 0, -1}, {-1, r->step, q->ring}}; // place >= 1, place <= d
    for (int lower = 1; lower >= 0; lower--) {
        for (uint32_t e = 0; e < edge_count; e++) {
            const ring_line l = line_in(r, q, edges[e], q->ring);
            lane_add(q, &l, lower);
        }
        lane_add(q, &own[!lower], lower);
        if (lower) q->lower_count = q->lane_count;
    }
}

void rings_start(const footprint *f, ground_cell eye, rings_direction direction, rings *out)
{
    out->eye = eye;
    out->step = direction == RINGS_NEAR_FIRST ? 1 : -1;
    out->eye_cell = footprint_keeps(f, eye) ? RINGS_EYE_CELL_KEPT : RINGS_EYE_CELL_OUT;
    int32_t least = INT32_MAX, most = -1;
    for (int k = 0; k < RINGS_QUADRANTS; k++) {
        rings_quadrant *q = &out->quadrants[k];
        q->ai = WAYS[k].ai, q->aj = WAYS[k].aj, q->bi = WAYS[k].bi, q->bj = WAYS[k].bj;
        if (f->point_count == 0) {
            q->ring = 0, q->ring_last = -out->step, q->lane_count = q->lower_count = 0;
            continue;
        }
        quadrant_start(out, f, q);
        if ((q->ring_last - q->ring) * out->step < 0) continue;
        const int32_t low = out->step > 0 ? q->ring : q->ring_last, high = out->step > 0 ? q->ring_last : q->ring;
        if (low < least) least = low;
        if (high > most) most = high;
    }
    if (out->eye_cell == RINGS_EYE_CELL_KEPT) least = 0, most = most < 0 ? 0 : most;
    if (most < 0) least = 0; // nothing
    out->ring = out->step > 0 ? least : most;
    out->ring_last = out->step > 0 ? most : least;
    if (most < 0) out->ring = out->ring_last + out->step;
}

static uint32_t quadrant_next(const rings *r, rings_quadrant *q, rings_span *span)
{
    int64_t least = -(int64_t)INT32_MAX, most = INT32_MAX;
    for (uint32_t k = 0; k < q->lower_count; k++) {
        const int64_t place = -lane_next(&q->lanes[k]);
        if (place > least) least = place;
    }
    for (uint32_t k = q->lower_count; k < q->lane_count; k++) {
        const int64_t place = lane_next(&q->lanes[k]);
        if (place < most) most = place;
    }
    const int32_t d = q->ring;
    q->ring += r->step;
    if (least > most) return 0;
    const int32_t p = (int32_t)least;
    span->first = (ground_cell){r->eye.i + q->ai * p + q->bi * d, r->eye.j + q->aj * p + q->bj * d};
    span->di = q->ai;
    span->dj = q->aj;
    span->count = (uint32_t)(most - least) + 1;
    return 1;
}

int rings_next(rings *r, rings_ring *out)
{
    while ((r->ring_last - r->ring) * r->step >= 0) {
        const int32_t d = r->ring;
        out->span_count = 0;
        out->distance = d;
        r->ring += r->step;
        if (d == 0) {
            if (r->eye_cell == RINGS_EYE_CELL_OUT) continue;
            out->spans[out->span_count++] = (rings_span){r->eye, 0, 0, 1};
            return 1;
        }
        for (int k = 0; k < RINGS_QUADRANTS; k++) {
            rings_quadrant *q = &r->quadrants[k];
            if (q->ring == d && (q->ring_last - d) * r->step >= 0) out->span_count += quadrant_next(r, q, &out->spans[out->span_count]);
        }
        if (out->span_count) return 1;
    }
    return 0;
}
