// Not a test: what movers cost that all move every frame. measure_swarm SCENE VIEWS MOVERS [CHAIN [PASSES]]: one line, ns of CPU time a mover a
// frame: telling the world where it is, and what culling takes longer than beside a world without movers, medians over views in turns.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "stage.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { STILL, MOVING, VIEWS_MOST = 1000 };

typedef struct swarm {
    stage stages[2]; // without movers, and with
    double (*middles)[3], (*speeds)[3];
    uint32_t *numbers, count;
} swarm;

static double clock_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double middle_of(double *values, uint32_t count)
{
    qsort(values, count, sizeof *values, compare);
    return values[count / 2];
}

static void stage_start(stage *s, const char *file, const char *chain, uint32_t movers)
{
    stage_load(s, file);
    const chain_spec **by_zone = calloc(s->scene->zone_count, sizeof *by_zone);
    if (!by_zone) exit(2);
    for (uint32_t zone = 0; zone < s->scene->zone_count; zone++) by_zone[zone] = stage_chain(s, chain);
    stage_open(s, &(stage_world){by_zone, movers});
    free(by_zone);
}

// Anywhere in the scene, as large as a person up to as a lorry, up to 0.3 m a frame.
static void swarm_start(swarm *w)
{
    const scene_extent *e = &w->stages[MOVING].scene->whole;
    uint64_t random = 1;
    for (uint32_t i = 0; i < w->count; i++) {
        double min[3], max[3];
        const double size = random_between(&random, 0.3, 4);
        for (int k = 0; k < 3; k++) {
            w->middles[i][k] = e->origin[k] + random_between(&random, (double)(&e->box.min.x)[k], (double)(&e->box.max.x)[k]);
            w->speeds[i][k] = random_between(&random, -0.3, 0.3);
            min[k] = w->middles[i][k] - size;
            max[k] = w->middles[i][k] + size;
        }
        if (world_mover_add(w->stages[MOVING].world, min, max, &w->numbers[i]) != RESULT_OK) exit(2);
    }
}

static void swarm_move(swarm *w, uint32_t frame)
{
    const double way = frame / 100 % 2 ? -1 : 1;
    for (uint32_t i = 0; i < w->count; i++) {
        double min[3], max[3];
        for (int k = 0; k < 3; k++) {
            w->middles[i][k] += way * w->speeds[i][k];
            min[k] = w->middles[i][k] - 1;
            max[k] = w->middles[i][k] + 1;
        }
        if (world_mover_move(w->stages[MOVING].world, w->numbers[i], min, max) != RESULT_OK) exit(2);
    }
}

static double cull_ns(stage *s, const camera *c, uint32_t frame, frame_stats *stats)
{
    const frame_input q = stage_input(c, frame);
    const double start = clock_ns();
    world_cull(s->view, &q, NULL, stats);
    return clock_ns() - start;
}

static void report_swarm(swarm *w, const camera_path *path, uint32_t passes)
{
    static double move_ns[VIEWS_MOST], more_ns[VIEWS_MOST], still_ns[VIEWS_MOST];
    uint64_t seen = 0;
    for (uint32_t v = 0; v < path->count; v++) move_ns[v] = still_ns[v] = more_ns[v] = 1e300;
    for (uint32_t p = 0, frame = 0; p < passes; p++)
        for (uint32_t v = 0; v < path->count; v++, frame++) {
            frame_stats stats;
            const double start = clock_ns();
            swarm_move(w, frame);
            const double moved = clock_ns() - start, still = cull_ns(&w->stages[STILL], &path->cameras[v], frame, &stats);
            const double moving = cull_ns(&w->stages[MOVING], &path->cameras[v], frame, &stats);
            if (moved < move_ns[v]) move_ns[v] = moved;
            if (still < still_ns[v]) still_ns[v] = still;
            if (moving < more_ns[v]) more_ns[v] = moving;
            seen += p == 0 ? stats.movers_drawn : 0;
        }
    for (uint32_t v = 0; v < path->count; v++) more_ns[v] -= still_ns[v];
    const double moved = middle_of(move_ns, path->count) / w->count, more = middle_of(more_ns, path->count) / w->count;
    printf("movers %u seen_a_view %.0f still_ns %.0f move_ns_a_mover %.1f cull_ns_a_mover %.1f ns_a_mover %.1f\n", w->count, (double)seen / path->count,
           middle_of(still_ns, path->count), moved, more, moved + more);
}

int main(int argc, char **argv)
{
    static swarm w;
    camera_path path;
    report r = report_to_stderr();
    if (argc < 4) return 2;
    const char *chain = argc > 4 ? argv[4] : "octree";
    w.count = (uint32_t)strtoul(argv[3], NULL, 10);
    stage_start(&w.stages[STILL], argv[1], chain, 0);
    stage_start(&w.stages[MOVING], argv[1], chain, w.count);
    w.middles = calloc(w.count, sizeof *w.middles);
    w.speeds = calloc(w.count, sizeof *w.speeds);
    w.numbers = calloc(w.count, sizeof *w.numbers);
    if (!w.count || !w.middles || !w.speeds || !w.numbers) return 2;
    if (camera_path_load(argv[2], w.stages[STILL].scene, 16.0 / 9, allocator_heap(), &r, &path) != RESULT_OK || path.count > VIEWS_MOST) return 2;
    swarm_start(&w);
    report_swarm(&w, &path, argc > 5 ? (uint32_t)strtoul(argv[5], NULL, 10) : 5);
    camera_path_free(&path, allocator_heap());
    for (int i = 0; i < 2; i++) {
        stage_shut(&w.stages[i]);
        stage_free(&w.stages[i]);
    }
    free(w.middles);
    free(w.speeds);
    free(w.numbers);
    return 0;
}
