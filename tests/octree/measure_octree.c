// Measures octree beside frustum on boxes and views: medians, the strategies in turns view by view.
// SPDX-License-Identifier: MIT
// usage: measure_octree FILE.boxes FILE.views [PASSES [PLUGIN:VALUES ...]], VALUES of all options with commas, as octree:auto,2,0,auto
#define _POSIX_C_SOURCE 200809L
#include "tests/frustum/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_VIEWS = 1000, MOST_STRATEGIES = 12, MOST_PASSES = 99, MOST_OPTIONS = 8, BURST = 4 };

typedef struct strategy {
    char text[128];
    session s;
    double build_ms, *ns, *ids_ns; // of each view, the least over the passes
    uint64_t items, runs, nodes;
} strategy;

typedef struct measured_view { cull_view view; view_volume volume; } measured_view;

static double clock_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

static cull_box *boxes_load(const char *path, uint32_t *count)
{
    FILE *f = fopen(path, "r");
    unsigned n = 0;
    if (!f || fscanf(f, "boxes %u", &n) != 1) exit(2);
    cull_box *boxes = calloc((size_t)n + 1, sizeof *boxes);
    for (unsigned i = 0; boxes && i < n; i++) {
        cull_box *b = &boxes[i];
        if (fscanf(f, "%f %f %f %f %f %f", &b->min.x, &b->min.y, &b->min.z, &b->max.x, &b->max.y, &b->max.z) != 6) exit(2);
    }
    fclose(f);
    *count = n;
    return boxes;
}

static uint32_t views_load(const char *path, const cull_box *box, measured_view *views)
{
    FILE *f = fopen(path, "r");
    const view_frame frame = {1280, 720, 0, 0, CULL_VIEW_MAIN};
    const double origin[3] = {0, 0, 0};
    uint32_t count = 0;
    camera c;
    if (!f) exit(2);
    while (count < MOST_VIEWS && fscanf(f, "%lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf", &c.eye[0], &c.eye[1], &c.eye[2], &c.forward[0], &c.forward[1],
                                        &c.forward[2], &c.up[0], &c.up[1], &c.up[2], &c.fovy_deg, &c.aspect, &c.near_m, &c.far_m) == 13) {
        view_derive(&c, &frame, origin, box, &views[count].view, &views[count].volume);
        count++;
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

static double middle(double *ns, uint32_t count)
{
    qsort(ns, count, sizeof *ns, compare);
    return ns[count / 2];
}

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

static void strategy_run(strategy *t, const measured_view *v, uint32_t *ids, uint32_t pass, uint32_t view)
{
    const cull_volume volume = {v->volume.planes, v->volume.plane_count, 0};
    double start = clock_ns();
    for (int i = 0; i < BURST; i++) session_select(&t->s, &v->view, &volume, 1);
    const double ns = (clock_ns() - start) / BURST;
    start = clock_ns();
    for (int i = 0; i < BURST; i++) {
        session_select(&t->s, &v->view, &volume, 1);
        sink = ids_write(t->s.runs, t->s.run_count, ids);
    }
    const double ids_ns = (clock_ns() - start) / BURST;
    if (pass == 0 || ns < t->ns[view]) t->ns[view] = ns;
    if (pass == 0 || ids_ns < t->ids_ns[view]) t->ids_ns[view] = ids_ns;
    if (pass) return;
    t->runs += t->s.run_count;
    t->nodes += t->s.nodes_visited;
    for (uint32_t i = 0; i < t->s.run_count; i++) t->items += t->s.runs[i].count;
}

int main(int argc, char **argv)
{
    static measured_view views[MOST_VIEWS];
    static strategy strategies[MOST_STRATEGIES];
    const char *usual[] = {"frustum:0,auto", "octree:auto,2,0,auto"};
    if (argc < 3) return 2;
    uint32_t count, passes = argc > 3 ? (uint32_t)atoi(argv[3]) : 5, strategy_count = argc > 4 ? (uint32_t)argc - 4 : 2;
    if (strategy_count > MOST_STRATEGIES) return 2;
    cull_box *boxes = boxes_load(argv[1], &count);
    hand_zone zone;
    zone_of_boxes(boxes, count, &zone);
    const uint32_t view_count = views_load(argv[2], &zone.zone.box, views);
    uint32_t *ids = calloc((size_t)count + 32, sizeof *ids);
    culler_host host;
    culler_host_init(&host, 0);
    if (!ids || !view_count) return 2;
    for (uint32_t i = 0; i < strategy_count; i++) strategy_open(&strategies[i], &host, argc > 4 ? argv[4 + i] : usual[i], &zone.zone, view_count);
    for (uint32_t p = 0; p < passes; p++)
        for (uint32_t v = 0; v < view_count; v++)
            for (uint32_t i = 0; i < strategy_count; i++) strategy_run(&strategies[(i + p + v) % strategy_count], &views[v], ids, p, v);
    printf("%s %s: %u boxes, %u views, %u passes\n", argv[1], argv[2], (unsigned)count, (unsigned)view_count, (unsigned)passes);
    double bar = 0, ids_bar = 0;
    for (uint32_t i = 0; i < strategy_count; i++) {
        strategy *t = &strategies[i];
        double sum = 0;
        for (uint32_t v = 0; v < view_count; v++) sum += t->ns[v] / view_count;
        const double ns = middle(t->ns, view_count), ids_ns = middle(t->ids_ns, view_count), all = (double)view_count;
        if (i == 0) bar = ns, ids_bar = ids_ns;
        printf("%-24s %8.0f ns (mean %8.0f) x%5.2f   ids %8.0f ns x%5.2f  items %9.1f runs %7.1f nodes %7.1f  build %7.1f ms  %.1f B/box\n", t->text, ns, sum,
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
