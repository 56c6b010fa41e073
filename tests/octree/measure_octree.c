// Measures octree beside frustum on boxes and views: medians, the strategies in turns view by view.
// SPDX-License-Identifier: MIT
// usage: measure_octree [--cold] [--each] [--volumes N] FILE.boxes FILE.views [PASSES [PLUGIN:VALUES ...]], VALUES of all options with commas, as
// octree:auto,2,0,auto. Cold: before each walk other memory is read, as pictures between walks do. Each: a view of a strategy a
// line, boxes there are, boxes seen, runs, nodes, ns. N: wedges that the view is cut into.
#include "host/core/host.h"
#include "host/core/memory.h"
#include "tests/common/measure.h"
#include "tests/frustum/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_STRATEGIES = 12, MOST_PASSES = 99, MOST_OPTIONS = 8, BURST = 4, COLD_BYTES = 32 << 20 };

typedef struct strategy {
    char text[128];
    session s;
    double build_ms, *ns, *ids_ns; // of each view, the least over the passes
    uint64_t items, runs, nodes;
} strategy;

static void strategy_open(strategy *t, culler_host *h, const char *text, const cull_zone *zone, uint32_t views)
{
    const char *values[MOST_OPTIONS];
    char words[128];
    uint32_t count = 0;
    snprintf(t->text, sizeof t->text, "%s", text);
    snprintf(words, sizeof words, "%s", text);
    const char *name = strtok(words, ":");
    for (char *word = strtok(NULL, ","); word && count < MOST_OPTIONS; word = strtok(NULL, ",")) values[count++] = word;
    const cull_plugin *plugin = plugin_named(name);
    const double start = clock_ns();
    if (!plugin || plugin->descriptor->option_count != count || session_open(&t->s, h, plugin, zone, values) != CULL_OK) {
        fprintf(stderr, "%s: %s\n", text, h->last_line);
        exit(2);
    }
    t->build_ms = (clock_ns() - start) / 1e6;
    t->ns = calloc(views, sizeof(double));
    t->ids_ns = calloc(views, sizeof(double));
}

static volatile uint64_t sink;

static void caches_empty(void)
{
    static char other[COLD_BYTES];
    for (size_t i = 0; i < COLD_BYTES; i += 64) sink += (uint64_t)++other[i];
}

typedef struct form { int is_cold, is_each; uint32_t volumes; } form;

static double time_select(strategy *t, const form *how, const measured_view *v, uint32_t *ids)
{
    const uint32_t burst = how->is_cold ? 1 : BURST;
    cull_volume volumes[MEASURE_VOLUMES];
    for (uint32_t i = 0; i < how->volumes; i++) volumes[i] = (cull_volume){v->wedges[i].planes, v->wedges[i].plane_count, 0};
    if (how->volumes == 1) volumes[0] = (cull_volume){v->volume.planes, v->volume.plane_count, 0};
    if (how->is_cold) caches_empty();
    const double start = clock_ns();
    for (uint32_t i = 0; i < burst; i++) {
        session_select(&t->s, &v->view, volumes, how->volumes);
        if (ids) sink = ids_write(t->s.runs, t->s.run_count, ids);
    }
    return (clock_ns() - start) / burst;
}

static void strategy_run(strategy *t, const form *how, const measured_view *v, uint32_t *ids, uint32_t pass, uint32_t view)
{
    const double ns = time_select(t, how, v, NULL), ids_ns = time_select(t, how, v, ids);
    if (pass == 0 || ns < t->ns[view]) t->ns[view] = ns;
    if (pass == 0 || ids_ns < t->ids_ns[view]) t->ids_ns[view] = ids_ns;
    if (pass) return;
    t->runs += t->s.run_count;
    t->nodes += t->s.nodes_visited;
    for (uint32_t i = 0; i < t->s.run_count; i++) t->items += t->s.runs[i].count;
}

static void views_print(strategy *t, const form *how, const measured_view *views, uint32_t view_count)
{
    for (uint32_t v = 0; v < view_count; v++) {
        uint64_t items = 0;
        time_select(t, how, &views[v], NULL);
        for (uint32_t i = 0; i < t->s.run_count; i++) items += t->s.runs[i].count;
        printf("%u %llu %u %u %.0f\n", (unsigned)t->s.item_count, (unsigned long long)items, (unsigned)t->s.run_count, (unsigned)t->s.nodes_visited, t->ns[v]);
    }
}

int main(int argc, char **argv)
{
    static measured_view views[MEASURE_VIEWS];
    static strategy strategies[MOST_STRATEGIES];
    const char *usual[] = {"frustum:0,auto", "octree:auto,2,0,auto"};
    form how = {0, 0, 1};
    for (; argc > 1 && argv[1][0] == '-'; argc--, argv++) {
        if (strcmp(argv[1], "--cold") == 0) how.is_cold = 1;
        else if (strcmp(argv[1], "--each") == 0) how.is_each = 1;
        else if (strcmp(argv[1], "--volumes") == 0 && argc > 2) how.volumes = (uint32_t)atoi(argv[2]), argc--, argv++;
        else return 2;
    }
    if (argc < 3 || how.volumes < 1 || how.volumes > MEASURE_VOLUMES) return 2;
    uint32_t count, passes = argc > 3 ? (uint32_t)atoi(argv[3]) : 5, strategy_count = argc > 4 ? (uint32_t)argc - 4 : 2;
    if (strategy_count > MOST_STRATEGIES) return 2;
    cull_box *boxes = boxes_load(argv[1], &count);
    hand_zone zone;
    zone_of_boxes(boxes, count, &zone);
    const uint32_t view_count = views_load(argv[2], &zone.zone.box, how.volumes, views);
    uint32_t *ids = calloc((size_t)count + 2 * MEASURE_IDS_SPARE, sizeof *ids);
    culler_host host;
    host_services real;
    report log = report_to_stderr();
    culler_host_init(&host, 0);
    host_services_fill(&real, allocator_heap(), &log);
    host.host = real.host; // its memory, as huge pages count
    if (!ids || !view_count) return 2;
    for (uint32_t i = 0; i < strategy_count; i++) strategy_open(&strategies[i], &host, argc > 4 ? argv[4 + i] : usual[i], &zone.zone, view_count);
    for (uint32_t p = 0; p < passes; p++)
        for (uint32_t v = 0; v < view_count; v++)
            for (uint32_t i = 0; i < strategy_count; i++) strategy_run(&strategies[(i + p + v) % strategy_count], &how, &views[v], ids, p, v);
    for (uint32_t i = 0; how.is_each && i < strategy_count; i++) views_print(&strategies[i], &how, views, view_count);
    if (!how.is_each) printf("%s %s: %u boxes, %u views, %u passes\n", argv[1], argv[2], (unsigned)count, (unsigned)view_count, (unsigned)passes);
    double bar = 0, ids_bar = 0;
    for (uint32_t i = 0; i < strategy_count; i++) {
        strategy *t = &strategies[i];
        double sum = 0;
        for (uint32_t v = 0; v < view_count; v++) sum += t->ns[v] / view_count;
        const double ns = middle_of(t->ns, view_count), ids_ns = middle_of(t->ids_ns, view_count), all = (double)view_count;
        if (i == 0) bar = ns, ids_bar = ids_ns;
        if (!how.is_each) printf("%-24s %8.0f ns (mean %8.0f) x%5.2f   ids %8.0f ns x%5.2f  items %9.1f runs %7.1f nodes %7.1f  build %7.1f ms  %.1f B/box\n", t->text, ns, sum,
               ns / bar, ids_ns, ids_ns / ids_bar, (double)t->items / all, (double)t->runs / all, (double)t->nodes / all, t->build_ms,
               (double)t->s.built.index_bytes / (count ? count : 1));
        session_close(&t->s);
        free(t->ns);
        free(t->ids_ns);
    }
    free(ids);
    hand_zone_free(&zone);
    free(boxes);
    return 0;
}
