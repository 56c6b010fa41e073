// Not a test: measure_flow_map MAP [auto:N|auto:edges:N] [rays] [passes] [way]: the flow in a map's largest zone: cells, walls drawn over walls that rays meet first
// (against all walls, with nothing of the cells), walls lost, and the time of a step, the best of the passes.
// SPDX-License-Identifier: MIT
#include "cells_fixture.h"

#include "host/import/views.h"
#include "tests/common/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct wall_plane { double n[3], offset; double edges[32][4]; uint32_t count, item; } wall_plane;

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

static void cross3(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static uint32_t walls_make(const cull_zone *z, wall_plane *out)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < z->item_count; i++) {
        const cull_wall *w = &z->walls[i];
        if (!w->vertex_count || w->vertex_count > 32) continue;
        wall_plane *p = &out[n++];
        const cull_plane plane = z->planes[w->plane];
        p->n[0] = (double)plane.normal.x, p->n[1] = (double)plane.normal.y, p->n[2] = (double)plane.normal.z, p->offset = (double)plane.offset;
        p->count = w->vertex_count;
        p->item = i;
        for (uint32_t k = 0; k < w->vertex_count; k++) {
            const cull_vec3 a = z->positions[z->wall_vertices[w->first_vertex + k]], b = z->positions[z->wall_vertices[w->first_vertex + (k + 1) % w->vertex_count]];
            const double way[3] = {(double)b.x - (double)a.x, (double)b.y - (double)a.y, (double)b.z - (double)a.z}, at[3] = {(double)a.x, (double)a.y, (double)a.z};
            cross3(p->n, way, p->edges[k]);
            p->edges[k][3] = -dot3(p->edges[k], at);
        }
    }
    return n;
}

static uint32_t first_hit(const wall_plane *walls, uint32_t count, const double eye[3], const double way[3], double *least)
{
    uint32_t hit = UINT32_MAX;
    *least = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        const wall_plane *p = &walls[i];
        const double h = dot3(p->n, eye) + p->offset, v = dot3(p->n, way);
        if (!(h > 0 && v < 0)) continue;
        const double t = -h / v;
        if (t >= *least) continue;
        const double at[3] = {eye[0] + t * way[0], eye[1] + t * way[1], eye[2] + t * way[2]};
        int in = 1;
        for (uint32_t k = 0; k < p->count && in; k++) in = dot3(p->edges[k], at) + p->edges[k][3] >= 0;
        if (!in) continue;
        *least = t;
        hit = p->item;
    }
    return hit;
}

typedef struct picture { cull_view view; view_volume planes; cull_volume volume; cull_visit visit; view_base base; } picture;

static void picture_make(const camera *c, const scene_zone *place, const cull_zone *z, picture *p)
{
    const view_frame frame = {.width_px = 1280, .height_px = 720, .purpose = CULL_VIEW_MAIN};
    memset(p, 0, sizeof *p);
    view_base_make(c, &frame, &p->base);
    view_derive(c, &frame, place->origin, &z->box, &p->view, &p->planes);
    p->volume = (cull_volume){p->planes.planes, p->planes.plane_count, 0};
    p->visit.view = &p->view;
    p->visit.volumes = &p->volume;
    p->visit.volume_count = 1;
}

typedef struct measure {
    const cull_zone *zone;
    const bsp_tree *tree;
    const bsp_cells_data *cells;
    const bsp_flow_index *index;
    const picture *pictures;
    uint32_t views;
    void *scratch;
    uint8_t *drawn, *hit;
    wall_plane *walls;
    uint32_t wall_count;
    uint64_t lost;
} measure;

static bsp_flow_figures step(measure *m, uint32_t view, bsp_cells how)
{
    bsp_flow_figures f;
    const bsp_flow_request q = {m->cells, m->index, m->zone, &m->pictures[view].visit, how, 1, m->scratch, m->drawn, BSP_EXITS_LOST};
    memset(m->drawn, 0, m->zone->item_count);
    if (!bsp_flow(&q, &f)) printf("view %u: none for the flow\n", view);
    return f;
}

// Over the whole path again and again, so that neither the caches nor the branches know the next view.
static void time_way(measure *m, bsp_cells how, uint32_t passes)
{
    double *times = malloc(m->views * sizeof *times), sum = 0;
    for (uint32_t i = 0; i < m->views; i++) times[i] = 1e300;
    for (uint32_t pass = 0; pass < passes; pass++)
        for (uint32_t i = 0; i < m->views; i++) {
            const double start = now_us();
            step(m, i, how);
            const double took = now_us() - start;
            times[i] = took < times[i] ? took : times[i];
        }
    for (uint32_t i = 0; i < m->views; i++) sum += times[i];
    qsort(times, m->views, sizeof *times, by_size);
    printf("  mean %.2f p50 %.2f p99 %.2f us\n", sum / m->views, times[m->views / 2], times[m->views * 99 / 100]);
    free(times);
}

static uint64_t cast_rays(measure *m, uint32_t view, uint32_t rays)
{
    const picture *p = &m->pictures[view];
    uint64_t random = 99 + view, sum = 0;
    memset(m->hit, 0, m->zone->item_count);
    for (uint32_t r = 0; r < rays; r++) {
        double way[3], t;
        const double u = random_between(&random, -p->base.wide, p->base.wide), v = random_between(&random, -p->base.tall, p->base.tall);
        for (int k = 0; k < 3; k++) way[k] = p->view.forward[k] + u * p->base.right[k] + v * p->base.up[k];
        const uint32_t item = first_hit(m->walls, m->wall_count, p->view.eye_exact, way, &t);
        if (item != UINT32_MAX) m->hit[item] = 1;
    }
    for (uint32_t k = 0; k < m->zone->item_count; k++) sum += m->hit[k];
    return sum;
}

static void count_way(measure *m, bsp_cells how, uint32_t rays)
{
    uint64_t drawn = 0, hit = 0, cells = 0, tried = 0, merges = 0, limits = 0;
    for (uint32_t i = 0; i < m->views; i++) {
        const bsp_flow_figures f = step(m, i, how);
        hit += cast_rays(m, i, rays);
        for (uint32_t k = 0; k < m->zone->item_count; k++) {
            drawn += m->drawn[k];
            if (!m->hit[m->tree->order[k]] || m->drawn[k]) continue;
            m->lost++;
            printf("view %u way %d: lost item %u\n", i, (int)how, m->tree->order[k]);
        }
        if (getenv("VERBOSE")) {
            uint32_t here = 0, here_hit = 0;
            for (uint32_t k = 0; k < m->zone->item_count; k++) here += m->drawn[k], here_hit += m->hit[k];
            printf("view %u way %d: drawn %u hit %u cells %u merges %u\n", i, (int)how, here, here_hit, f.cells_visited, f.merges);
        }
        cells += f.cells_visited, tried += f.openings_tried, merges += f.merges, limits += f.limits_hit;
    }
    const double n = m->views;
    printf("way %d: drawn %.1f x%.3f cells %.1f openings %.1f merges %.1f limits %.2f", (int)how, (double)drawn / n, (double)drawn / (double)hit, (double)cells / n,
           (double)tried / n, (double)merges / n, (double)limits / n);
}

int main(int argc, char **argv)
{
    cells_map map;
    if (argc < 2 || !cells_map_open(argv[1], PORTALS_NONE, &map)) return 1;
    const uint32_t rays = argc > 3 ? (uint32_t)atoi(argv[3]) : 0, passes = argc > 4 ? (uint32_t)atoi(argv[4]) : 10, only = argc > 5 ? (uint32_t)atoi(argv[5]) : 0;
    const cull_zone *z = &cells_map_largest(&map)->zone;
    const scene_zone *place = &map.whole.scene->zones[cells_map_largest(&map)->index];
    report silent = {0};
    camera_path path;
    culler_host h;
    bsp_tree tree;
    bsp_cells_data cells;
    bsp_flow_index index;
    culler_host_init(&h, 0);
    if (camera_path_load(argc > 2 ? argv[2] : "auto:20", map.whole.scene, 16.0 / 9, allocator_heap(), &silent, &path) != RESULT_OK) abort();
    if (bsp_tree_build(&h.host, &(bsp_source){.zone = z}, &tree) != CULL_OK || bsp_cells_build(&h.host, z, &tree, &cells) != CULL_OK) abort();
    if (bsp_flow_build(&h.host, z, tree.order, &cells, &index) != CULL_OK) abort();
    picture *pictures = malloc(path.count * sizeof *pictures);
    for (uint32_t i = 0; i < path.count; i++) picture_make(&path.cameras[i], place, z, &pictures[i]);
    const size_t bytes = bsp_flow_scratch(&cells, BSP_CELLS_EXACT);
    measure m = {z, &tree, &cells, &index, pictures, path.count, aligned_alloc(64, (bytes + 63) / 64 * 64), malloc(z->item_count), malloc(z->item_count),
                 malloc(z->item_count * sizeof(wall_plane)), 0, 0};
    m.wall_count = walls_make(z, m.walls);
    printf("%s: %u walls %u cells %u openings, %zu bytes for the flow\n", argv[1], m.wall_count, cells.cell_count, cells.opening_count, bsp_flow_bytes(&index));
    for (uint32_t how = only ? only : 1; how < (only ? only + 1 : 4); how++) {
        count_way(&m, (bsp_cells)how, rays);
        time_way(&m, (bsp_cells)how, passes);
    }
    printf("lost %llu\n", (unsigned long long)m.lost);
    return m.lost > 0;
}
