// A small reader of generated .obj files for tests: see obj_probe.h.
// SPDX-License-Identifier: MIT
#include "obj_probe.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

char *bytes_of_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    bytes[*size] = 0;
    fclose(file);
    return bytes;
}

typedef struct numbered_place { double at[3]; uint32_t vertex; } numbered_place;

static int by_place(const void *left, const void *right)
{
    return memcmp(left, right, sizeof(double[3]));
}

// numbers[v] becomes the same for vertices at the same place.
static void places_number(double (*vertices)[3], size_t count, uint32_t *numbers)
{
    numbered_place *all = calloc(count + 1, sizeof *all);
    assert_non_null(all);
    for (size_t i = 0; i < count; ++i) {
        for (int n = 0; n < 3; ++n) all[i].at[n] = vertices[i][n] + 0.0;
        all[i].vertex = (uint32_t)i;
    }
    qsort(all, count, sizeof *all, by_place);
    for (size_t i = 0; i < count; ++i)
        numbers[all[i].vertex] = i && by_place(&all[i - 1], &all[i]) == 0 ? numbers[all[i - 1].vertex] : all[i].vertex;
    free(all);
}

static void polygon_read(probe *p, char *line, const probe_polygon *now)
{
    probe_polygon *q = &p->polygons[p->polygon_count++];
    *q = *now;
    for (char *word = line + 1; *word == ' ' && q->corner_count < PROBE_CORNERS;) {
        const unsigned long vertex = strtoul(word, &word, 10);
        assert_true(vertex >= 1 && vertex <= p->place_count); // only vertices that stand before it
        q->corners[q->corner_count++] = (uint32_t)vertex - 1;
    }
    assert_true(q->corner_count >= 3);
    p->triangle_count += q->corner_count - 2;
}

static void line_read(probe *p, char *line, probe_polygon *now)
{
    if (line[0] == 'v') {
        double *at = p->places[p->place_count++];
        assert_int_equal(sscanf(line, "v %lf %lf %lf", &at[0], &at[1], &at[2]), 3);
        for (int n = 0; n < 3; ++n) assert_true(isfinite(at[n]));
    } else if (line[0] == 'f') {
        polygon_read(p, line, now);
    } else if (line[0] == 'o') {
        p->object_count++;
        snprintf(now->object, sizeof now->object, "%.31s", line + 2);
        now->material[0] = 0;
    } else {
        assert_int_equal(strncmp(line, "usemtl ", 7), 0);
        snprintf(now->material, sizeof now->material, "%.31s", line + 7);
    }
}

probe probe_read(const char *path)
{
    size_t size = 0, lines = 1;
    char *text = bytes_of_file(path, &size);
    assert_non_null(text);
    for (size_t i = 0; i < size; ++i) lines += text[i] == '\n';
    probe p = {.places = malloc(lines * sizeof *p.places), .polygons = malloc(lines * sizeof *p.polygons)};
    uint32_t *numbers = calloc(lines, sizeof *numbers);
    assert_true(p.places && p.polygons && numbers);
    probe_polygon now = {0};
    for (char *line = text; *line;) {
        char *end = memchr(line, '\n', size - (size_t)(line - text));
        assert_non_null(end); // the last line ends too
        *end = 0;
        line_read(&p, line, &now);
        line = end + 1;
    }
    places_number(p.places, p.place_count, numbers);
    for (size_t i = 0; i < p.polygon_count; ++i)
        for (uint32_t k = 0; k < p.polygons[i].corner_count; ++k) p.polygons[i].corners[k] = numbers[p.polygons[i].corners[k]];
    free(numbers);
    free(text);
    return p;
}

void probe_free(probe *p)
{
    free(p->places);
    free(p->polygons);
}

static double determinant(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

double probe_volume(const probe *p, probe_choice takes, const char *name)
{
    double six_times = 0;
    for (size_t i = 0; i < p->polygon_count; ++i) {
        const probe_polygon *q = &p->polygons[i];
        if (!takes(q, name)) continue;
        for (uint32_t k = 2; k < q->corner_count; ++k)
            six_times += determinant(p->places[q->corners[0]], p->places[q->corners[k - 1]], p->places[q->corners[k]]);
    }
    return six_times / 6;
}

static int by_number(const void *left, const void *right)
{
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return a < b ? -1 : a > b;
}

size_t probe_open_edges(const probe *p, probe_choice takes, const char *name)
{
    uint64_t *edges = malloc((p->polygon_count + 1) * PROBE_CORNERS * sizeof *edges);
    size_t count = 0, open = 0;
    assert_non_null(edges);
    for (size_t i = 0; i < p->polygon_count; ++i) {
        const probe_polygon *q = &p->polygons[i];
        for (uint32_t k = 0; takes(q, name) && k < q->corner_count; ++k)
            edges[count++] = (uint64_t)q->corners[k] << 32 | q->corners[(k + 1) % q->corner_count];
    }
    qsort(edges, count, sizeof *edges, by_number);
    for (size_t i = 0; i < count; ++i) {
        const uint64_t opposite = edges[i] << 32 | edges[i] >> 32;
        const int repeated = i && edges[i] == edges[i - 1];
        open += repeated || !bsearch(&opposite, edges, count, sizeof *edges, by_number);
    }
    free(edges);
    return open;
}

static uint32_t root_of(uint32_t *parents, uint32_t at)
{
    while (parents[at] != at) at = parents[at] = parents[parents[at]];
    return at;
}

size_t probe_parts(const probe *p, probe_choice takes, const char *name)
{
    uint32_t *parents = malloc((p->place_count + 1) * sizeof *parents);
    unsigned char *used = calloc(p->place_count + 1, 1);
    assert_true(parents && used);
    for (size_t i = 0; i < p->place_count; ++i) parents[i] = (uint32_t)i;
    for (size_t i = 0; i < p->polygon_count; ++i) {
        const probe_polygon *q = &p->polygons[i];
        for (uint32_t k = 0; takes(q, name) && k < q->corner_count; ++k) {
            used[q->corners[k]] = 1;
            parents[root_of(parents, q->corners[k])] = root_of(parents, q->corners[0]);
        }
    }
    size_t parts = 0;
    for (size_t i = 0; i < p->place_count; ++i) parts += used[i] && root_of(parents, (uint32_t)i) == i;
    free(parents);
    free(used);
    return parts;
}

static void minus(const double a[3], const double b[3], double out[3])
{
    for (int n = 0; n < 3; ++n) out[n] = a[n] - b[n];
}

// By signs of tetrahedra: the ends lie on different sides of the triangle, and the line passes within its edges.
static int passes(const double from[3], const double to[3], const double a[3], const double b[3], const double c[3])
{
    double pa[3], pb[3], pc[3], qa[3], qb[3], qc[3];
    minus(a, from, pa);
    minus(b, from, pb);
    minus(c, from, pc);
    minus(a, to, qa);
    minus(b, to, qb);
    minus(c, to, qc);
    if ((determinant(pa, pb, pc) > 0) == (determinant(qa, qb, qc) > 0)) return 0;
    double along[3];
    minus(to, from, along);
    const int ab = determinant(along, pa, pb) > 0, bc = determinant(along, pb, pc) > 0, ca = determinant(along, pc, pa) > 0;
    return ab == bc && bc == ca;
}

// Do the boxes round the segment and the polygon miss each other?
static int is_far(const probe *p, const probe_polygon *q, const double from[3], const double to[3])
{
    for (int n = 0; n < 3; ++n) {
        const double least = fmin(from[n], to[n]), most = fmax(from[n], to[n]);
        uint32_t below = 0, above = 0;
        for (uint32_t k = 0; k < q->corner_count; ++k) {
            below += p->places[q->corners[k]][n] < least;
            above += p->places[q->corners[k]][n] > most;
        }
        if (below == q->corner_count || above == q->corner_count) return 1;
    }
    return 0;
}

size_t probe_crossings(const probe *p, const double from[3], const double to[3])
{
    size_t count = 0;
    for (size_t i = 0; i < p->polygon_count; ++i) {
        const probe_polygon *q = &p->polygons[i];
        if (is_far(p, q, from, to)) continue;
        for (uint32_t k = 2; k < q->corner_count; ++k)
            count += (size_t)passes(from, to, p->places[q->corners[0]], p->places[q->corners[k - 1]], p->places[q->corners[k]]);
    }
    return count;
}
