// Canonical orders: see canonical.h. Sums of centres are whole numbers, so that the order of summing leaves no trace.
// SPDX-License-Identifier: MIT
#include "canonical.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CENTRE_PARTS 16.0 // a centre is summed in 1/16 step
#define FIELD_PARTS 274877906944.0 // 2^38 of the largest square distance: a double errs by less than a hundredth of that
#define AREA_STEP 16.0    // square steps

static void body_centre(const brush_bodies *b, const brush_body *body, double out[3])
{
    const body_polygon *polygons = (const body_polygon *)b->polygons.items + body->first_polygon;
    double sum[3] = {0, 0, 0}, weight = 0;
    for (uint32_t p = 0; p < body->polygon_count; ++p) {
        const polygon_edge *edges = (const polygon_edge *)b->edges.items + polygons[p].shape.first;
        const uint32_t count = polygons[p].shape.count;
        for (uint32_t i = 0; i < count; ++i) {
            const double *from = edges[i].start, *to = edges[i + 1 < count ? i + 1 : 0].start;
            double square = 0;
            for (int k = 0; k < 3; ++k) square += (to[k] - from[k]) * (to[k] - from[k]);
            const double length = sqrt(square);
            for (int k = 0; k < 3; ++k) sum[k] += 0.5 * (from[k] + to[k]) * length;
            weight += length;
        }
    }
    for (int k = 0; k < 3; ++k) out[k] = weight > 0 ? sum[k] / weight : 0;
}

static double body_area(const brush_bodies *b, const brush_body *body)
{
    const body_polygon *polygons = (const body_polygon *)b->polygons.items + body->first_polygon;
    double area = 0;
    for (uint32_t p = 0; p < body->polygon_count; ++p)
        area += polygon_area((const polygon_edge *)b->edges.items + polygons[p].shape.first, polygons[p].shape.count);
    return area;
}

// A power of two, so that no rounding of the extent shows.
static double field_step(const brush_bodies *b, const double centre[3])
{
    const body_corner *corners = b->corners.items;
    double most = 1;
    for (size_t i = 0; i < b->corners.count; ++i) {
        double square = 0;
        for (int k = 0; k < 3; ++k) square += (corners[i].position[k] - centre[k]) * (corners[i].position[k] - centre[k]);
        if (square > most) most = square;
    }
    int power;
    frexp(most * 1.37, &power);
    return ldexp(1 / FIELD_PARTS, power);
}

map_field map_field_of(const brush_bodies *bodies)
{
    __extension__ typedef __int128 int128;
    int128 sums[3][3] = {{0}}, weights[3] = {0};
    for (uint32_t b = 0; b < bodies->brush_count; ++b) {
        const brush_body *body = &bodies->of[b];
        if (body->polygon_count == 0) continue;
        double centre[3];
        body_centre(bodies, body, centre);
        const int64_t weigh[3] = {1, (int64_t)body->polygon_count * body->polygon_count, 1 + (int64_t)(body_area(bodies, body) / 65536)};
        for (int w = 0; w < 3; ++w) {
            weights[w] += weigh[w];
            for (int k = 0; k < 3; ++k) sums[w][k] += (int128)weigh[w] * (int64_t)floor(centre[k] * CENTRE_PARTS + 0.5);
        }
    }
    map_field f = {.step = 1};
    for (int w = 0; w < 3; ++w)
        for (int k = 0; k < 3; ++k)
            if (weights[w]) f.centres[w][k] = (double)sums[w][k] / (double)weights[w] / CENTRE_PARTS;
    f.step = field_step(bodies, f.centres[0]);
    return f;
}

int64_t map_field_at(const map_field *f, const double p[3])
{
    static const double share[3] = {1, 0.7548776662466927, 0.5698402909980532}; // far from any ratio of small numbers
    double sum = 0;
    for (int w = 0; w < 3; ++w) {
        double square = 0;
        for (int k = 0; k < 3; ++k) square += (p[k] - f->centres[w][k]) * (p[k] - f->centres[w][k]);
        sum += share[w] * square;
    }
    return (int64_t)floor(sum / f->step + 0.37);
}

// ---- Ranks ----

typedef struct rank_key {
    uint32_t phase, brush;
    int64_t area, field, most; // field: of the centre; most: of the corners, for bodies that share a centre
    const compile_input *in;
    const brush_body *body;
} rank_key;

static int compare_names(const compile_input *in, uint32_t a, uint32_t b)
{
    if (a == b) return 0;
    if (a == COMPILE_NOTHING || b == COMPILE_NOTHING) return a == COMPILE_NOTHING ? -1 : 1;
    return strcmp(in->materials[a].name, in->materials[b].name);
}

static int compare_doubles(const double *a, const double *b, int count)
{
    for (int i = 0; i < count; ++i)
        if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
    return 0;
}

static int compare_covers(const compile_input *in, const compile_brush *a, const compile_brush *b)
{
    if (a->face_count != b->face_count) return a->face_count < b->face_count ? -1 : 1;
    for (uint32_t f = 0; f < a->face_count; ++f) {
        const compile_face *p = &in->faces[a->first_face + f], *q = &in->faces[b->first_face + f];
        int order = compare_names(in, p->material, q->material);
        if (!order) order = compare_doubles(&p->texture[0][0], &q->texture[0][0], 8);
        if (order) return order;
    }
    return 0;
}

static int compare_sizes(const void *left, const void *right)
{
    const rank_key *a = left, *b = right;
    if (a->area != b->area) return a->area > b->area ? -1 : 1;
    if (a->field != b->field) return a->field < b->field ? -1 : 1;
    if (a->most != b->most) return a->most < b->most ? -1 : 1;
    int order = compare_doubles(a->body->min, b->body->min, 3);
    if (!order) order = compare_doubles(a->body->max, b->body->max, 3);
    if (!order) order = compare_covers(a->in, &a->in->brushes[a->brush], &b->in->brushes[b->brush]);
    return order ? order : a->brush < b->brush ? -1 : 1;
}

static int64_t most_at_corners(const brush_bodies *b, const brush_body *body, const map_field *field)
{
    const body_corner *corners = (const body_corner *)b->corners.items + body->first_corner;
    int64_t most = INT64_MIN;
    for (uint32_t i = 0; i < body->corner_count; ++i) {
        const int64_t at = map_field_at(field, corners[i].position);
        if (at > most) most = at;
    }
    return most;
}

static void fill_keys(const compile_input *in, const brush_bodies *bodies, const map_field *field, rank_key *keys)
{
    uint32_t phase = 0;
    brush_kind last = BRUSH_ADD;
    for (uint32_t b = 0; b < in->brush_count; ++b) {
        const brush_body *body = &bodies->of[b];
        if (body->polygon_count && in->brushes[b].role == BRUSH_STRUCTURE && in->brushes[b].kind != last) {
            last = in->brushes[b].kind;
            ++phase;
        }
        double centre[3];
        body_centre(bodies, body, centre);
        keys[b] = (rank_key){.phase = phase,
                             .brush = b,
                             .area = (int64_t)floor(body_area(bodies, body) / AREA_STEP + 0.37),
                             .field = map_field_at(field, centre),
                             .most = most_at_corners(bodies, body, field),
                             .in = in,
                             .body = body};
    }
}

static int compare_phases(const void *left, const void *right)
{
    const rank_key *a = left, *b = right;
    return a->phase != b->phase ? (a->phase < b->phase ? -1 : 1) : compare_sizes(left, right);
}

result brush_ranks_make(const compile_input *in, const brush_bodies *bodies, const map_field *field, const allocator *memory, brush_rank **rank)
{
    const uint32_t n = in->brush_count;
    rank_key *keys = memory_alloc(memory, n, sizeof *keys);
    *rank = keys ? memory_alloc(memory, n, sizeof **rank) : NULL;
    if (*rank) {
        fill_keys(in, bodies, field, keys);
        if (n > 1) qsort(keys, n, sizeof *keys, compare_sizes);
        for (uint32_t i = 0; i < n; ++i) (*rank)[keys[i].brush] = (brush_rank){.phase = keys[i].phase, .size = i};
        if (n > 1) qsort(keys, n, sizeof *keys, compare_phases);
        for (uint32_t i = 0; i < n; ++i) (*rank)[keys[i].brush].rank = i;
    }
    memory_free(memory, keys, n, sizeof *keys);
    return *rank ? RESULT_OK : RESULT_NO_MEMORY;
}

// ---- Classes ----

typedef struct class_key { const compile_face *face; } class_key;

static int compare_classes(const void *left, const void *right)
{
    const compile_face *a = ((const class_key *)left)->face, *b = ((const class_key *)right)->face;
    if (a->material != b->material) return a->material < b->material ? -1 : 1;
    return a->material == COMPILE_NOTHING ? 0 : compare_doubles(&a->texture[0][0], &b->texture[0][0], 8);
}

result face_classes_make(const compile_input *in, const allocator *memory, uint32_t **class_of)
{
    const uint32_t n = in->face_count;
    class_key *keys = memory_alloc(memory, n, sizeof *keys);
    *class_of = keys ? memory_alloc(memory, n, sizeof **class_of) : NULL;
    if (*class_of) {
        for (uint32_t f = 0; f < n; ++f) keys[f].face = &in->faces[f];
        if (n > 1) qsort(keys, n, sizeof *keys, compare_classes);
        uint32_t number = 0;
        for (uint32_t f = 0; f < n; ++f) {
            if (f && compare_classes(&keys[f - 1], &keys[f])) ++number;
            (*class_of)[keys[f].face - in->faces] = number;
        }
    }
    memory_free(memory, keys, n, sizeof *keys);
    return *class_of ? RESULT_OK : RESULT_NO_MEMORY;
}
