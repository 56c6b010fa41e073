// Measures brute and frustum on a city of boxes.
// SPDX-License-Identifier: MIT
// Told: ns a box, medians over views and passes, strategies interleaved pass by pass.
// usage: measure_frustum FILE.boxes FILE.views [PASSES]
#include "fixture.h"
#include "tests/common/measure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_STRATEGIES = 12, MOST_PASSES = 25 };

typedef struct strategy {
    const char *name;
    session s;
    int writes_ids;
    double build_ms;
    double *ns; // a sample for each view and pass
    uint64_t items, runs, nodes;
} strategy;

// Per view the median over passes, then the median over views.
static double median_ns(const double *ns, uint32_t views, uint32_t passes)
{
    double of_views[MEASURE_VIEWS], of_passes[MOST_PASSES];
    for (uint32_t v = 0; v < views; v++) {
        for (uint32_t p = 0; p < passes; p++) of_passes[p] = ns[p * views + v];
        of_views[v] = middle_of(of_passes, passes);
    }
    return middle_of(of_views, views);
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

static void strategy_open(strategy *t, culler_host *h, const char *name, const cull_plugin *plugin, const cull_zone *zone,
                          const char *const *values, int writes_ids, size_t samples)
{
    const double start = clock_ns();
    if (session_open(&t->s, h, plugin, zone, values) != CULL_OK) {
        fprintf(stderr, "%s: %s\n", name, h->last_line);
        exit(2);
    }
    t->build_ms = (clock_ns() - start) / 1e6;
    t->name = name;
    t->writes_ids = writes_ids;
    t->ns = calloc(samples, sizeof(double));
    if (!t->ns) exit(2);
}

static volatile uint64_t sink;

static double strategy_run(strategy *t, const measured_view *v, uint32_t *ids)
{
    const cull_volume volume = {v->volume.planes, v->volume.plane_count, 0};
    const double start = clock_ns();
    session_select(&t->s, &v->view, &volume, 1);
    if (t->writes_ids) sink = ids_write(t->s.runs, t->s.run_count, ids);
    const double ns = clock_ns() - start;
    t->runs += t->s.run_count;
    t->nodes += t->s.nodes_visited;
    for (uint32_t i = 0; i < t->s.run_count; i++) t->items += t->s.runs[i].count;
    return ns;
}

int main(int argc, char **argv)
{
    static measured_view views[MEASURE_VIEWS];
    if (argc < 3) {
        fprintf(stderr, "usage: measure_frustum FILE.boxes FILE.views [PASSES]\n");
        return 2;
    }
    uint32_t count, passes = argc > 3 ? (uint32_t)atoi(argv[3]) : 5;
    if (passes < 1 || passes > MOST_PASSES) passes = 5;
    cull_box *boxes = boxes_load(argv[1], &count);
    hand_zone zone;
    zone_of_boxes(boxes, count, &zone);
    const uint32_t view_count = views_load(argv[2], &zone.zone.box, 0, views);
    culler_host host;
    culler_host_init(&host, 0);
    uint64_t planes = 0;
    for (uint32_t v = 0; v < view_count; v++) planes += views[v].volume.plane_count;
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
    uint32_t *ids = calloc((size_t)count + 2 * MEASURE_IDS_SPARE, sizeof *ids);
    double *read_ns = calloc(samples, sizeof *read_ns), *empty_ns = calloc(samples, sizeof *empty_ns);
    if (!ids || !read_ns || !empty_ns) return 2;
    for (uint32_t p = 0; p < passes; p++) {
        for (uint32_t v = 0; v < view_count; v++) {
            const size_t sample = (size_t)p * view_count + v;
            double start = clock_ns();
            empty_ns[sample] = clock_ns() - start;
            start = clock_ns();
            sink = read_all(&zone.zone);
            read_ns[sample] = clock_ns() - start;
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
