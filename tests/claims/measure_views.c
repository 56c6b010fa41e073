// Not a test: what each view of a path costs and reaches. measure_views SCENE PATH STEP CHAIN...: for each chain, in all zones, one
// line of NAME VALUE pairs. A view's time is the least of some frames: what it costs when nothing else runs.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "stage.h"

#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { FRAMES = 5 };

typedef struct sums {
    double worst_ms, total_ms;
    uint64_t zones, volumes, crossings, merges, limits, faults, items;
    uint32_t views, worst_view, most_zones, merging_views;
} sums;

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec / 1e6;
}

static void look(stage *s, const camera *c, uint32_t v, sums *sum)
{
    const frame_input q = stage_input(c, v);
    frame_stats stats = {0};
    double best = 1e300;
    for (int i = 0; i < FRAMES; i++) {
        world_cull(s->view, &q, NULL, &stats);
        best = stats.cull_ns < best ? stats.cull_ns : best;
    }
    if (best * 1e-6 > sum->worst_ms) {
        sum->worst_ms = best * 1e-6;
        sum->worst_view = v;
    }
    sum->total_ms += best * 1e-6;
    sum->zones += stats.zones;
    sum->volumes += stats.volumes;
    sum->crossings += stats.crossings;
    sum->merges += stats.portal_merges;
    sum->merging_views += stats.portal_merges > 0;
    sum->limits += stats.limits_hit;
    sum->faults += stats.faults;
    sum->items += stats.items_drawn;
    sum->most_zones = stats.zones > sum->most_zones ? stats.zones : sum->most_zones;
    sum->views++;
}

static void measure(stage *s, const camera_path *path, uint32_t step, const char *chain)
{
    sums sum = {0};
    const chain_spec **by_zone = calloc(s->scene->zone_count, sizeof *by_zone);
    assert_non_null(by_zone);
    for (uint32_t zone = 0; zone < s->scene->zone_count; zone++) by_zone[zone] = stage_chain_of(s, chain, zone);
    const double start = now_ms();
    stage_open(s, &(stage_world){by_zone, 0});
    const double open_ms = now_ms() - start;
    for (uint32_t v = 0; v < path->count; v += step) look(s, &path->cameras[v], v, &sum);
    const double views = sum.views;
    printf("chain %s views %u worst_ms %.3f worst_view %u mean_ms %.4f zones %.1f most_zones %u volumes %.1f crossings %.1f items %.1f merges %llu merging_views %u limits %llu "
           "faults %llu open_ms %.0f bytes %llu\n",
           chain, sum.views, sum.worst_ms, sum.worst_view, sum.total_ms / views, (double)sum.zones / views, sum.most_zones, (double)sum.volumes / views,
           (double)sum.crossings / views, (double)sum.items / views, (unsigned long long)sum.merges, sum.merging_views, (unsigned long long)sum.limits,
           (unsigned long long)sum.faults, open_ms, (unsigned long long)s->counted.live_bytes);
    stage_shut(s);
    free(by_zone);
}

int main(int count, char **arguments)
{
    static stage s;
    if (count < 5) return 2;
    const double start = now_ms();
    stage_load(&s, arguments[1]);
    printf("scene %s zones %u portals %u import_ms %.0f\n", arguments[1], s.scene->zone_count, s.scene->portal_count, now_ms() - start);
    const camera_path *path = strcmp(arguments[2], "tour") == 0 ? &s.tour : &s.walk;
    for (int i = 4; i < count && path->count; i++) measure(&s, path, (uint32_t)strtoul(arguments[3], NULL, 10), arguments[i]);
    const int code = path->count ? 0 : 1;
    stage_free(&s);
    return code;
}
