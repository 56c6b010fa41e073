// What exact decisions cost: ns a call by family of planes, beside GMP; for each map given ns a side of a brush's corner against
// the planes of brushes near it, and ms for the input. The least round and the median one.
// usage: measure_exact [MAP...]
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 199309L // clock_gettime
#include "exact_oracle.h"
#include "host/compile/brush_shape.h"
#include "host/compile/compile.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SETS = 4096, ROUNDS = 101, GMP_ROUNDS = 3, MAP_RUNS = 5, QUERIES_MOST = 1000000, QUERY_ROUNDS = 11 };

static double cpu_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

// ---- Rounds ----

typedef struct cost { double least, median; } cost; // ns a call
typedef int64_t call_round(const void *of); // calls all of it, gives the sum of signs

static int64_t sum; // printed, so that no call can be left out

static cost cost_of(call_round *call, const void *of, size_t calls, int rounds)
{
    double ns[ROUNDS];
    for (int r = 0; r < rounds; ++r) {
        const double start = cpu_ms();
        sum += call(of);
        ns[r] = (cpu_ms() - start) * 1e6 / (double)calls;
    }
    qsort(ns, (size_t)rounds, sizeof *ns, by_size);
    return (cost){ns[0], ns[rounds / 2]};
}

// ---- Families ----

typedef struct planes_set {
    cull_wide_plane p[4];
    cull_row rows[4];
} planes_set;

static int64_t sign_by_rows(const void *of)
{
    const planes_set *sets = of;
    int64_t all = 0;
    for (int i = 0; i < SETS; ++i) {
        cull_tier tier;
        const cull_wide_plane *const p[4] = {&sets[i].p[0], &sets[i].p[1], &sets[i].p[2], &sets[i].p[3]};
        const cull_row *const r[4] = {&sets[i].rows[0], &sets[i].rows[1], &sets[i].rows[2], &sets[i].rows[3]};
        all += cull_four_sign_of_rows(p, r, &tier);
    }
    return all;
}

static int64_t sign_alone(const void *of)
{
    const planes_set *sets = of;
    int64_t all = 0;
    for (int i = 0; i < SETS; ++i) all += cull_four_sign(&sets[i].p[0], &sets[i].p[1], &sets[i].p[2], &sets[i].p[3]);
    return all;
}

static int64_t widest_sign(const void *of)
{
    const planes_set *sets = of;
    int64_t all = 0;
    for (int i = 0; i < SETS; ++i) {
        const cull_wide_plane *const p[4] = {&sets[i].p[0], &sets[i].p[1], &sets[i].p[2], &sets[i].p[3]};
        all += cull_four_256(p);
    }
    return all;
}

static int64_t meet_position(const void *of)
{
    const planes_set *sets = of;
    int64_t all = 0;
    for (int i = 0; i < SETS; ++i) {
        double at[3];
        all += cull_meet_position(&sets[i].p[0], &sets[i].p[1], &sets[i].p[2], at) && at[0] > 0;
    }
    return all;
}

static int64_t sign_by_gmp(const void *of)
{
    const planes_set *sets = of;
    int64_t all = 0;
    for (int i = 0; i < SETS; ++i) all += gmp_four_sign(sets[i].p);
    return all;
}

static void measure_family(plane_family f, planes_set *sets)
{
    uint64_t seed = 1;
    uint32_t tiers[4] = {0};
    for (int i = 0; i < SETS; ++i) {
        planes_set *s = &sets[i];
        cull_tier tier;
        family_planes(f, &seed, s->p);
        for (int k = 0; k < 4; ++k) s->rows[k] = cull_row_of(&s->p[k]);
        cull_four_sign_tier(&s->p[0], &s->p[1], &s->p[2], &s->p[3], &tier);
        tiers[tier]++;
    }
    const cost c[4] = {cost_of(sign_by_rows, sets, SETS, ROUNDS), cost_of(sign_alone, sets, SETS, ROUNDS), cost_of(widest_sign, sets, SETS, ROUNDS),
                       cost_of(meet_position, sets, SETS, ROUNDS)};
    printf("%-12s", family_name(f));
    for (int k = 0; k < 4; ++k) printf(" %6.1f %6.1f", c[k].least, c[k].median);
    printf(" %7.1f  ", cost_of(sign_by_gmp, sets, SETS, GMP_ROUNDS).least);
    for (int t = 0; t < 4; ++t) printf(" %5.1f", tiers[t] * 100.0 / SETS);
    printf("\n");
}

// ---- Maps ----

typedef struct side_query { plane_ref meet[3], of; double position[3]; } side_query;
typedef struct side_queries {
    const plane_table *planes;
    side_query *items;
    size_t count;
} side_queries;

static int64_t sides_exactly(const void *of)
{
    const side_queries *q = of;
    int64_t all = 0;
    for (size_t i = 0; i < q->count; ++i) all += plane_table_side(q->planes, q->items[i].meet, q->items[i].of);
    return all;
}

static int64_t sides_by_position(const void *of)
{
    const side_queries *q = of;
    int64_t all = 0;
    for (size_t i = 0; i < q->count; ++i) all += plane_table_side_at(q->planes, q->items[i].meet, q->items[i].position, q->items[i].of);
    return all;
}

static int boxes_meet(const compile_brush *a, const compile_brush *b)
{
    for (int k = 0; k < 3; ++k)
        if (a->min[k] > b->max[k] || b->min[k] > a->max[k]) return 0;
    return 1;
}

static void ask_brush(side_queries *q, const compile_input *in, const brush_shape *shape, const compile_brush *other)
{
    const shape_corner *c = shape->corners.items;
    for (size_t i = 0; i < shape->corners.count; ++i)
        for (uint32_t f = 0; f < other->face_count && q->count < QUERIES_MOST; ++f) {
            const plane_ref of = in->faces[other->first_face + f].plane;
            q->items[q->count++] = (side_query){{c[i].planes[0], c[i].planes[1], c[i].planes[2]}, of, {c[i].position[0], c[i].position[1], c[i].position[2]}};
        }
}

// Corners of brushes against the planes of brushes whose boxes meet theirs.
static int measure_sides(const compile_input *in)
{
    side_queries q = {.planes = in->planes, .items = malloc(QUERIES_MOST * sizeof *q.items)};
    brush_shape shape = brush_shape_make(allocator_heap());
    plane_ref cube[6], planes[1024];
    int made = q.items && brush_shape_cube(in->planes, cube);
    for (uint32_t a = 0; a < in->brush_count && made; ++a) {
        const compile_brush *brush = &in->brushes[a];
        if (brush->face_count > 1024) continue;
        for (uint32_t f = 0; f < brush->face_count; ++f) planes[f] = in->faces[brush->first_face + f].plane;
        made = brush_shape_cut(&shape, in->planes, cube, planes, brush->face_count) == SHAPE_SOUND;
        for (uint32_t b = 0; b < in->brush_count && made; ++b)
            if (b != a && boxes_meet(brush, &in->brushes[b])) ask_brush(&q, in, &shape, &in->brushes[b]);
    }
    if (made && q.count) {
        const cost exact = cost_of(sides_exactly, &q, q.count, QUERY_ROUNDS), near = cost_of(sides_by_position, &q, q.count, QUERY_ROUNDS);
        printf("  %zu sides of corners: %.1f ns, median %.1f; with positions at hand %.1f, median %.1f\n", q.count, exact.least, exact.median, near.least,
               near.median);
    }
    brush_shape_free(&shape);
    free(q.items);
    return made;
}

static int measure_map(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file) return 0;
    fseek(file, 0, SEEK_END);
    const size_t size = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(size + 1);
    int read = text && fread(text, 1, size, file) == size;
    fclose(file);
    double runs[MAP_RUNS];
    report r = {0};
    for (int i = 0; i < MAP_RUNS && read; ++i) {
        compile_input *in = NULL;
        const double start = cpu_ms();
        read = compile_input_map(path, text, size, NULL, allocator_heap(), &r, &in) == RESULT_OK;
        runs[i] = cpu_ms() - start;
        if (read && i + 1 == MAP_RUNS) {
            qsort(runs, MAP_RUNS, sizeof *runs, by_size);
            printf("%s: %u brushes, %u faces, %u welded: %.1f ms, median of %d\n", path, in->brush_count, in->face_count, in->weld_moves,
                   runs[MAP_RUNS / 2], MAP_RUNS);
            read = measure_sides(in);
        }
        compile_input_free(in);
    }
    free(text);
    return read;
}

int main(int count, char **arguments)
{
    planes_set *sets = malloc(SETS * sizeof *sets);
    if (!sets) return 1;
    printf("ns a call     filtered      rows to make  256 bits only meeting point     GMP   %% decided by\n");
    printf("               least median  least median  least median  least median   least   double  64   128   256\n");
    for (int f = 0; f < FAMILY_COUNT; ++f) measure_family((plane_family)f, sets);
    printf("(%lld)\n", (long long)sum);
    free(sets);
    for (int i = 1; i < count; ++i)
        if (!measure_map(arguments[i])) {
            fprintf(stderr, "%s: cannot be read\n", arguments[i]);
            return 1;
        }
    return 0;
}
