// Not a test: how the image cache's grid finds and orders cells in view, beside the 1998 report's forms. measure_grid [VIEWS [LEVEL]]: per field of view
// cells lost, extra, views with a loss, views with an order inversion; then views of all kinds, and CPU ns a kept cell. Plain text, one line each.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "grid_score.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static const double DEGREE = 3.14159265358979323846 / 180;
enum { RAYS = 60, TIMED_VIEWS = 2000, TIMED_PASSES = 9 };

static double clock_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

static double percent(uint64_t part, uint64_t whole)
{
    return whole ? 100.0 * (double)part / (double)whole : 0;
}

static void print_score(const char *name, const grid_score *s)
{
    printf("%-22s %8llu %10llu %9llu %8.3f %8.3f %9.1f %11llu %9.1f\n", name, (unsigned long long)s->views, (unsigned long long)s->touched,
           (unsigned long long)s->lost, percent(s->lost, s->touched), percent(s->extra, s->touched), percent(s->views_lost, s->views),
           (unsigned long long)s->inversions, percent(s->views_inverted, s->views));
}

typedef struct grid_case {
    const char *name;
    double fov; // degrees; 0: views of all kinds
    grid_way way;
} grid_case;

static void score_case(grid_bench *b, const grid_case *c, uint32_t views)
{
    grid_score s = {0};
    uint64_t r = 71;
    for (uint32_t k = 0; k < views; k++) {
        grid_view v;
        const grid_turn turn = c->fov > 0 ? grid_turn_level(&r, c->fov * DEGREE) : grid_turn_random(&r);
        grid_view_random(&r, &b->ground, turn, c->fov > 0 ? GRID_EYES_INSIDE : GRID_EYES_ANYWHERE, &v);
        grid_find(b, &v, c->way);
        grid_score_cells(b, &v, &s);
        grid_score_rays(b, &v, RAYS, &r, &s);
    }
    print_score(c->name, &s);
}

// As a culler does: the footprint, the rings, and the number of each cell written to a list.
static double time_views(grid_bench *b, const grid_view *views, uint64_t *kept)
{
    const double start = clock_ns();
    for (uint32_t k = 0; k < TIMED_VIEWS; k++) {
        const double eye[4] = {views[k].eye[0], views[k].eye[1], views[k].eye[2], 1};
        rings_ring ring;
        uint32_t count = 0;
        footprint_of(&b->ground, &views[k].volume, &b->print);
        rings_start(&b->print, ground_eye(&b->ground, eye), RINGS_NEAR_FIRST, &b->rings);
        while (rings_next(&b->rings, &ring))
            for (uint32_t s = 0; s < ring.span_count; s++) {
                const rings_span *span = &ring.spans[s];
                uint32_t cell = ground_number(&b->ground, span->first);
                const uint32_t step = (uint32_t)span->dj * b->ground.columns + (uint32_t)span->di;
                for (uint32_t n = 0; n < span->count; n++, cell += step) b->cells[count++] = cell;
            }
        *kept += count;
    }
    return clock_ns() - start;
}

static void time_case(grid_bench *b, const char *name, double fov)
{
    static grid_view views[TIMED_VIEWS];
    uint64_t r = 72, kept = 0;
    double least = INFINITY;
    for (uint32_t k = 0; k < TIMED_VIEWS; k++) {
        const grid_turn turn = fov > 0 ? grid_turn_level(&r, fov * DEGREE) : grid_turn_random(&r);
        grid_view_random(&r, &b->ground, turn, fov > 0 ? GRID_EYES_INSIDE : GRID_EYES_ANYWHERE, &views[k]);
        views[k].volume.planes = views[k].planes;
    }
    for (int pass = 0; pass < TIMED_PASSES; pass++) {
        kept = 0;
        least = fmin(least, time_views(b, views, &kept));
    }
    printf("%-22s level %u: %8.1f cells a view, %6.2f ns a kept cell, %7.0f ns a view\n", name, (unsigned)b->ground.level, (double)kept / TIMED_VIEWS,
           least / (double)kept, least / TIMED_VIEWS);
}

int main(int count, char **arguments)
{
    const uint32_t views = count > 1 ? (uint32_t)strtoul(arguments[1], NULL, 10) : 500, level = count > 2 ? (uint32_t)strtoul(arguments[2], NULL, 10) : 6;
    static const grid_case cases[] = {
        {"report, fov 30", 30, GRID_REPORT},   {"report, fov 60", 60, GRID_REPORT},   {"report, fov 90", 90, GRID_REPORT},
        {"rings, fov 20", 20, GRID_RINGS},     {"rings, fov 30", 30, GRID_RINGS},     {"rings, fov 60", 60, GRID_RINGS},
        {"rings, fov 90", 90, GRID_RINGS},     {"rings, fov 120", 120, GRID_RINGS},   {"rings, any pitch, roll", 0, GRID_RINGS},
    };
    static grid_bench b;
    if (views == 0 || level > GROUND_LEVELS_MOST) return 2;
    grid_bench_open(&b, level);
    printf("%-22s %8s %10s %9s %8s %8s %9s %11s %9s\n", "way", "views", "touched", "lost", "lost %", "extra %", "lossy %", "inversions", "inverted %");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) score_case(&b, &cases[k], views);
    grid_bench_close(&b);
    grid_bench_open(&b, 8);
    time_case(&b, "rings, fov 20", 20);
    time_case(&b, "rings, fov 60", 60);
    time_case(&b, "rings, fov 120", 120);
    time_case(&b, "rings, any pitch, roll", 0);
    grid_bench_close(&b);
    return 0;
}
