// Not a test: what the flow draws over what rays meet, and its time a view, on hand-made blocks of rooms.
//   measure_flow [rooms a side] [views] [rays]
// SPDX-License-Identifier: MIT
#include "flow_views.h"

#include "tests/common/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double now_us(void)
{
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)(t.tv_sec % 100000) * 1e6 + (double)t.tv_nsec * 1e-3;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double step_us(const grid_cells *g, const flow_view *v, bsp_cells how, flow_run *r)
{
    double least = 1e300;
    for (int i = 0; i < 7; i++) {
        const double start = now_us();
        flow_run_step(g, v, how, 1, r);
        const double took = now_us() - start;
        least = took < least ? took : least;
    }
    return least;
}

static uint64_t rays_count(const grid_cells *g, const flow_view *v, uint32_t rays, uint8_t *hit)
{
    uint64_t random = 3, sum = 0;
    memset(hit, 0, g->item_count);
    for (uint32_t k = 0; k < rays; k++) {
        grid_trace t;
        double way[3];
        flow_view_ray(g, v, random_between(&random, -1, 1), random_between(&random, -1, 1), way);
        if (grid_trace_ray(g, v->eye_unposed, way, 1e-9, &t)) hit[t.hit] = 1;
    }
    for (uint32_t k = 0; k < g->first_box; k++) sum += hit[k];
    return sum;
}

int main(int count, char **words)
{
    const uint32_t size = count > 1 ? (uint32_t)atoi(words[1]) : 10, views = count > 2 ? (uint32_t)atoi(words[2]) : 100;
    const uint32_t rays = count > 3 ? (uint32_t)atoi(words[3]) : 0;
    const grid_wish wish = {.size = {size, 4, size}, .seed = 5, .open = 0.5, .shut = 0.15, .one_way = 0, .turn = {0.1, 0.2, 0.3}, .scale = 1};
    grid_cells g;
    flow_run r;
    uint64_t random = 9, hits = 0, drawn[4] = {0}, cells[4] = {0}, openings[4] = {0}, merges[4] = {0};
    double *times[4], sum[4] = {0};
    grid_make(&wish, &g);
    flow_run_make(&g, &r);
    uint8_t *hit = malloc(g.item_count);
    for (int how = 1; how < 4; how++) times[how] = malloc(views * sizeof **times);
    for (uint32_t i = 0; i < views; i++) {
        flow_aim aim = {.near_distance = 0.0625, .tangents = {1.03, 0.58}};
        for (int k = 0; k < 3; k++) {
            const uint32_t room = random_below(&random, g.size[k]);
            aim.eye[k] = random_between(&random, g.places[k][room] + 0.2, g.places[k][room + 1] - 0.2);
            aim.forward[k] = random_between(&random, -1, 1);
        }
        flow_view v;
        flow_view_make(&g, &aim, &v);
        hits += rays_count(&g, &v, rays, hit);
        for (int how = 1; how < 4; how++) {
            times[how][i] = step_us(&g, &v, (bsp_cells)how, &r);
            sum[how] += times[how][i];
            for (uint32_t k = 0; k < g.first_box; k++) drawn[how] += r.drawn[k];
            cells[how] += r.figures.cells_visited;
            openings[how] += r.figures.openings_tried;
            merges[how] += r.figures.merges;
        }
    }
    printf("%u cells, %u walls; hit %.1f a view\n", g.data.cell_count, g.first_box, (double)hits / views);
    for (int how = 1; how < 4; how++) {
        qsort(times[how], views, sizeof **times, by_size);
        printf("%s drawn %.1f (x%.3f) cells %.1f openings %.1f merges %.1f; mean %.2f us, p50 %.2f, p99 %.2f, most %.2f\n", how == 1 ? "rect " : how == 2 ? "hull " : "exact",
               (double)drawn[how] / views, (double)drawn[how] / (double)hits, (double)cells[how] / views, (double)openings[how] / views,
               (double)merges[how] / views, sum[how] / views, times[how][views / 2], times[how][views * 99 / 100], times[how][views - 1]);
        free(times[how]);
    }
    free(hit);
    flow_run_free(&r);
    grid_free(&g);
    return 0;
}
