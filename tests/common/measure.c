// See measure.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static const double RADIANS = 0.017453292519943295; // in a degree

double clock_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

cull_box *boxes_load(const char *path, uint32_t *count)
{
    FILE *f = fopen(path, "r");
    unsigned n = 0;
    if (!f || fscanf(f, "boxes %u", &n) != 1) {
        fprintf(stderr, "%s: no boxes\n", path);
        exit(2);
    }
    cull_box *boxes = calloc((size_t)n + 1, sizeof *boxes);
    if (!boxes) exit(2);
    for (unsigned i = 0; i < n; i++) {
        cull_box *b = &boxes[i];
        if (fscanf(f, "%f %f %f %f %f %f", &b->min.x, &b->min.y, &b->min.z, &b->max.x, &b->max.y, &b->max.z) != 6) exit(2);
    }
    fclose(f);
    *count = n;
    return boxes;
}

// Wedge i of n, turned about the view's upward axis.
static camera wedge_of(const camera *c, uint32_t i, uint32_t n)
{
    const double half = atan(tan(c->fovy_deg * RADIANS / 2) * c->aspect), turn = half * ((2.0 * i + 1) / n - 1), *f = c->forward, *u = c->up;
    const double side[3] = {f[1] * u[2] - f[2] * u[1], f[2] * u[0] - f[0] * u[2], f[0] * u[1] - f[1] * u[0]};
    camera out = *c;
    for (int k = 0; k < 3; k++) out.forward[k] = f[k] * cos(turn) + side[k] * sin(turn);
    out.aspect = tan(half / n) / tan(c->fovy_deg * RADIANS / 2);
    return out;
}

uint32_t views_load(const char *path, const cull_box *of_all, uint32_t wedges, measured_view views[MEASURE_VIEWS])
{
    FILE *f = fopen(path, "r");
    const view_frame frame = {1280, 720, 0, 0, CULL_VIEW_MAIN};
    const double origin[3] = {0, 0, 0};
    uint32_t count = 0;
    camera c;
    if (!f) {
        fprintf(stderr, "%s: no views\n", path);
        exit(2);
    }
    while (count < MEASURE_VIEWS && fscanf(f, "%lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf", &c.eye[0], &c.eye[1], &c.eye[2], &c.forward[0],
                                           &c.forward[1], &c.forward[2], &c.up[0], &c.up[1], &c.up[2], &c.fovy_deg, &c.aspect, &c.near_m, &c.far_m) == 13) {
        measured_view *v = &views[count++];
        view_derive(&c, &frame, origin, of_all, &v->view, &v->volume);
        for (uint32_t i = 0; i < wedges; i++) {
            const camera wedge = wedge_of(&c, i, wedges);
            cull_view same_eye;
            view_derive(&wedge, &frame, origin, of_all, &same_eye, &v->wedges[i]);
        }
    }
    fclose(f);
    return count;
}

uint64_t ids_write(const cull_run *runs, uint32_t run_count, uint32_t *ids)
{
    uint32_t *to = ids;
    for (uint32_t r = 0; r < run_count; r++) {
        const uint32_t first = runs[r].first, count = runs[r].count;
        uint32_t at = 0;
        do {
            for (uint32_t i = 0; i < MEASURE_IDS_SPARE; i++) to[at + i] = first + at + i;
            at += MEASURE_IDS_SPARE;
        } while (at < count);
        to += count;
    }
    return (uint64_t)(to - ids);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double middle_of(double *values, uint32_t count)
{
    qsort(values, count, sizeof *values, compare);
    return values[count / 2];
}
