// Measures brute and frustum on a city of boxes.
// SPDX-License-Identifier: MIT
// Told: ns a box, medians over views and passes, strategies interleaved pass by pass.
// usage: measure_frustum FILE.boxes FILE.views [PASSES]
#define _POSIX_C_SOURCE 200809L
#include "fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_VIEWS = 1000, MOST_STRATEGIES = 12, MOST_PASSES = 25 };

typedef struct strategy {
    const char *name;
    session s;
    int writes_ids;
    double build_ms;
    double *ns; // a sample for each view and pass
    uint64_t items, runs, nodes;
} strategy;

static double clock_ns(clockid_t id)
{
    struct timespec t;
    clock_gettime(id, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

static cull_box *boxes_load(const char *path, uint32_t *count)
{
    FILE *f = fopen(path, "r");
    unsigned n = 0;
    if (!f || fscanf(f, "boxes %u", &n) != 1) {
        fprintf(stderr, "%s: no boxes\n", path);
        exit(2);
    }
    cull_box *boxes = calloc((size_t)n + 1, sizeof *boxes);
    for (unsigned i = 0; boxes && i < n; i++) {
        cull_box *b = &boxes[i];
        if (fscanf(f, "%f %f %f %f %f %f", &b->min.x, &b->min.y, &b->min.z, &b->max.x, &b->max.y, &b->max.z) != 6) exit(2);
    }
    fclose(f);
    *count = n;
    return boxes;
}

static uint32_t views_load(const char *path, camera *cameras)
{
    FILE *f = fopen(path, "r");
    uint32_t count = 0;
    if (!f) {
        fprintf(stderr, "%s: no views\n", path);
        exit(2);
    }
    for (; count < MOST_VIEWS; count++) {
        camera *c = &cameras[count];
        if (fscanf(f, "%lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf", &c->eye[0], &c->eye[1], &c->eye[2], &c->forward[0],
                   &c->forward[1], &c->forward[2], &c->up[0], &c->up[1], &c->up[2], &c->fovy_deg, &c->aspect, &c->near_m,
                   &c->far_m) != 13)
            break;
    }
    fclose(f);
    return count;
}

// The ids of runs, 4 bytes each; `ids` has room for 16 more.
static uint64_t ids_write(const cull_run *runs, uint32_t run_count, uint32_t *ids)
{
    uint32_t *to = ids;
    for (uint32_t r = 0; r < run_count; r++) {
        const uint32_t first = runs[r].first, count = runs[r].count;
        uint32_t at = 0;
        do {
            for (uint32_t i = 0; i < 16; i++) to[at + i] = first + at + i;
            at += 16;
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

// Per view the median over passes, then the median over views.
static double median_ns(const double *ns, uint32_t views, uint32_t passes)
{
    double of_views[MOST_VIEWS], of_passes[MOST_PASSES];
    for (uint32_t v = 0; v < views; v++) {
        for (uint32_t p = 0; p < passes; p++) of_passes[p] = ns[p * views + v];
        qsort(of_passes, passes, sizeof(double), compare);
        of_views[v] = of_passes[passes / 2];
    }
    qsort(of_views, views, sizeof(double), compare);
    return of_views[views / 2];
}

// What memory allows: every byte of the boxes read once, in the widest vectors there are.
static inline uint32_t read_rows(const cull_zone *zone)
{
    const float *rows[6] = {zone->boxes.min_x, zone->boxes.min_y, zone->boxes.min_z, zone->boxes.max_x, zone->boxes.max_y, zone->boxes.max_z};
    uint32_t sums[64] = {0};
    for (uint32_t first = 0; first + 64 <= zone->item_count; first += 64)
        for (int row = 0; row < 6; row++) {
            uint32_t bits[64];
            memcpy(bits, rows[row] + first, sizeof bits);
            for (int i = 0; i < 64; i++) sums[i] += bits[i];
        }
    uint32_t sum = 0;
    for (int i = 0; i < 64; i++) sum += sums[i];
    return sum;
}

#if defined(__x86_64__)
__attribute__((target("avx512f"))) static uint32_t read_wide(const cull_zone *zone)
{
    return read_rows(zone);
}
static uint32_t read_all(const cull_zone *zone)
{
    return __builtin_cpu_supports("avx512f") ? read_wide(zone) : read_rows(zone);
}
#else
static uint32_t read_all(const cull_zone *zone)
{
    return read_rows(zone);
}
#endif

typedef struct measured_view { cull_view view; view_volume volume; } measured_view;

static void strategy_open(strategy *t, culler_host *h, const char *name, const cull_plugin *plugin, const cull_zone *zone,
                          const char *const *values, int writes_ids, size_t samples)
{
    const double start = clock_ns(CLOCK_THREAD_CPUTIME_ID);
    if (session_open(&t->s, h, plugin, zone, values) != CULL_OK) {
        fprintf(stderr, "%s: %s\n", name, h->last_line);
        exit(2);
    }
    t->build_ms = (clock_ns(CLOCK_THREAD_CPUTIME_ID) - start) / 1e6;
    t->name = name;
    t->writes_ids = writes_ids;
    t->ns = calloc(samples, sizeof(double));
    if (!t->ns) exit(2);
}

static volatile uint64_t sink;

static double strategy_run(strategy *t, const measured_view *v, uint32_t *ids)
{
    const cull_volume volume = {v->volume.planes, v->volume.plane_count, 0};
    const double start = clock_ns(CLOCK_THREAD_CPUTIME_ID);
    session_select(&t->s, &v->view, &volume, 1);
    if (t->writes_ids) sink = ids_write(t->s.runs, t->s.run_count, ids);
    const double ns = clock_ns(CLOCK_THREAD_CPUTIME_ID) - start;
    t->runs += t->s.run_count;
    t->nodes += t->s.nodes_visited;
    for (uint32_t i = 0; i < t->s.run_count; i++) t->items += t->s.runs[i].count;
    return ns;
}

int main(int argc, char **argv)
{
    static camera cameras[MOST_VIEWS];
    static measured_view views[MOST_VIEWS];
    if (argc < 3) {
        fprintf(stderr, "usage: measure_frustum FILE.boxes FILE.views [PASSES]\n");
        return 2;
    }
    uint32_t count, passes = argc > 3 ? (uint32_t)atoi(argv[3]) : 5;
    if (passes < 1 || passes > MOST_PASSES) passes = 5;
    cull_box *boxes = boxes_load(argv[1], &count);
    const uint32_t view_count = views_load(argv[2], cameras);
    hand_zone zone;
    zone_of_boxes(boxes, count, &zone);
    culler_host host;
    culler_host_init(&host, 0);
    const view_frame frame = {1280, 720, 0, 0, CULL_VIEW_MAIN};
    const double origin[3] = {0, 0, 0};
    uint64_t planes = 0;
    for (uint32_t v = 0; v < view_count; v++) {
        view_derive(&cameras[v], &frame, origin, &zone.zone.box, &views[v].view, &views[v].volume);
        planes += views[v].volume.plane_count;
    }
    const cull_plugin *frustum = plugin_named("frustum");
    if (!frustum || view_count == 0) return 2;
    static const char *const isas[] = {"plain", "avx2", "avx512"};
    static const char *const names[2][2][3] = {{{"brute plain", "brute avx2", "brute avx512"}, {"frustum plain", "frustum avx2", "frustum avx512"}},
                                               {{"", "", "brute ids"}, {"", "", "frustum ids"}}};
    strategy strategies[MOST_STRATEGIES];
    memset(strategies, 0, sizeof strategies);
    uint32_t strategy_count = 0;
    const size_t samples = (size_t)view_count * passes;
    for (int writes_ids = 0; writes_ids < 2; writes_ids++)
        for (int i = writes_ids ? 2 : 0; i < 3; i++)
            for (int tree = 0; tree < 2; tree++) {
                const char *values[2] = {tree ? "0" : isas[i], isas[i]};
                strategy_open(&strategies[strategy_count++], &host, names[writes_ids][tree][i], tree ? frustum : &builtin_brute, &zone.zone,
                              values, writes_ids, samples);
            }
    uint32_t *ids = calloc((size_t)count + 32, sizeof *ids);
    double *read_ns = calloc(samples, sizeof *read_ns), *empty_ns = calloc(samples, sizeof *empty_ns);
    if (!ids || !read_ns || !empty_ns) return 2;
    for (uint32_t p = 0; p < passes; p++) {
        for (uint32_t v = 0; v < view_count; v++) {
            const size_t sample = (size_t)p * view_count + v;
            double start = clock_ns(CLOCK_THREAD_CPUTIME_ID);
            empty_ns[sample] = clock_ns(CLOCK_THREAD_CPUTIME_ID) - start;
            start = clock_ns(CLOCK_THREAD_CPUTIME_ID);
            sink = read_all(&zone.zone);
            read_ns[sample] = clock_ns(CLOCK_THREAD_CPUTIME_ID) - start;
        }
        for (uint32_t i = 0; i < strategy_count; i++)
            for (uint32_t v = 0; v < view_count; v++) strategies[i].ns[(size_t)p * view_count + v] = strategy_run(&strategies[i], &views[v], ids);
    }
    const double empty = median_ns(empty_ns, view_count, passes), all_views = (double)view_count * passes;
    printf("%s %s: %u boxes, %u views, %u passes, %.1f planes, clock %.0f ns (taken off)\n", argv[1], argv[2], (unsigned)count,
           (unsigned)view_count, (unsigned)passes, (double)planes / view_count, empty);
    const double read = median_ns(read_ns, view_count, passes) - empty;
    printf("%-16s %12.0f ns %8.4f ns/box\n", "plain read", read, read / count);
    for (uint32_t i = 0; i < strategy_count; i++) {
        strategy *t = &strategies[i];
        const double ns = median_ns(t->ns, view_count, passes) - empty;
        const strategy *brute = &strategies[t->writes_ids ? 6 : 4];
        const double bar = median_ns(brute->ns, view_count, passes) - empty;
        printf("%-16s %12.0f ns %8.4f ns/box  brute/this %6.2f  items %9.1f runs %8.1f nodes %7.1f  build %6.1f ms  index %.1f B/box\n", t->name,
               ns, ns / count, bar / ns, (double)t->items / all_views, (double)t->runs / all_views, (double)t->nodes / all_views, t->build_ms,
               (double)t->s.built.index_bytes / (count ? count : 1));
        session_close(&t->s);
        free(t->ns);
    }
    free(ids);
    free(read_ns);
    free(empty_ns);
    hand_zone_free(&zone);
    free(boxes);
    return 0;
}
