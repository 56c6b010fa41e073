// Measures what a mover costs in grids of rooms on open ground.
// SPDX-License-Identifier: MIT
// Told: ns of CPU time for each small move, teleport, removal with adding, point to zone, and move of a box larger than all
// rooms, the median over passes.
// usage: measure_movers [MOVERS [PASSES]]
#define _POSIX_C_SOURCE 200809L
#include "fixture.h"

#include "tests/common/random.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { PASSES_MOST = 101, ZONES_MOST = 64 };
#define ROOM_M 8.0

typedef enum work { WORK_MOVE, WORK_TELEPORT, WORK_EXCHANGE, WORK_POINT, WORK_LARGE } work;

typedef struct bench {
    zone_fixture zones;
    graph *graph;
    movers *movers;
    double (*middles)[3];
    double span_m;
    uint64_t random;
    uint32_t count, passes;
} bench;

static double clock_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

static void place_anew(bench *b, uint32_t mover)
{
    for (int k = 0; k < 3; k++) b->middles[mover][k] = random_between(&b->random, 0, k == 1 ? 4 : b->span_m);
}

static void put(bench *b, uint32_t mover, result (*how)(movers *m, uint32_t mover, const double min[3], const double max[3]))
{
    double min[3], max[3];
    for (int k = 0; k < 3; k++) {
        min[k] = b->middles[mover][k] - 0.4;
        max[k] = b->middles[mover][k] + 0.4;
    }
    if (how(b->movers, mover, min, max) != RESULT_OK) exit(2);
}

static void work_on(bench *b, work kind, uint32_t mover)
{
    uint32_t zones[ZONES_MOST];
    switch (kind) {
    case WORK_MOVE:
        for (int k = 0; k < 3; k++) b->middles[mover][k] += random_between(&b->random, -0.05, 0.05);
        put(b, mover, movers_move);
        break;
    case WORK_TELEPORT:
        place_anew(b, mover);
        put(b, mover, movers_move);
        break;
    case WORK_EXCHANGE:
        if (movers_remove(b->movers, mover) != RESULT_OK) exit(2);
        put(b, mover, movers_add);
        break;
    case WORK_POINT:
        graph_zones_at(b->graph, b->middles[mover], 0.1, zones, ZONES_MOST);
        break;
    case WORK_LARGE: { // than all rooms together
        const double min[3] = {-1, -1, -1}, max[3] = {b->span_m + 1, 5, b->span_m + 1};
        if (movers_move(b->movers, mover, min, max) != RESULT_OK) exit(2);
        break;
    }
    }
}

static int double_order(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static double median_ns(bench *b, work kind)
{
    double ns[PASSES_MOST];
    for (uint32_t pass = 0; pass < b->passes; pass++) {
        const double start = clock_ns();
        for (uint32_t i = 0; i < b->count; i++) work_on(b, kind, i);
        ns[pass] = (clock_ns() - start) / b->count;
    }
    qsort(ns, b->passes, sizeof *ns, double_order);
    return ns[b->passes / 2];
}

static void bench_open(bench *b, uint32_t side)
{
    const allocator *heap = allocator_heap();
    fixture_make(&b->zones);
    const uint32_t ground = fixture_zone(&b->zones, ZONE_EVERYWHERE, SCENE_NONE);
    fixture_rooms(&b->zones, side, ROOM_M, (const double[]){0, 0, 0});
    for (uint32_t z = 1; z < b->zones.scene.zone_count; z++) b->zones.scene.zones[z].parent = ground;
    b->span_m = ROOM_M * side;
    b->middles = memory_alloc(heap, b->count, sizeof *b->middles);
    if (!b->middles || graph_open(&b->zones.scene, heap, &b->graph) != RESULT_OK) exit(2);
    if (movers_open(&(movers_request){&b->zones.scene, b->graph, b->count}, heap, &b->movers) != RESULT_OK) exit(2);
    for (uint32_t i = 0; i < b->count; i++) {
        place_anew(b, i);
        put(b, i, movers_add);
    }
}

static void bench_close(bench *b)
{
    movers_close(b->movers);
    graph_close(b->graph);
    memory_free(allocator_heap(), b->middles, b->count, sizeof *b->middles);
    fixture_free(&b->zones);
}

int main(int argc, char **argv)
{
    const uint32_t count = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 10000;
    const uint32_t passes = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 15;
    if (!count || !passes || passes > PASSES_MOST) {
        fprintf(stderr, "usage: measure_movers [MOVERS [PASSES]], at least 1 of each and at most %d passes\n", PASSES_MOST);
        return 2;
    }
    printf("%8s %8s %10s %12s %12s %10s %10s %10s\n", "rooms", "movers", "move ns", "teleport ns", "exchange ns", "point ns", "large ns", "relocated");
    const uint32_t sides[] = {1, 4, 16, 32, 100};
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
        bench b = {.random = 1, .count = count, .passes = passes};
        bench_open(&b, sides[i]);
        const double move_ns = median_ns(&b, WORK_MOVE);
        const mover_counts counts = movers_counts(b.movers);
        const double teleport_ns = median_ns(&b, WORK_TELEPORT), exchange_ns = median_ns(&b, WORK_EXCHANGE), point_ns = median_ns(&b, WORK_POINT);
        const double large_ns = median_ns(&b, WORK_LARGE);
        printf("%8u %8u %10.0f %12.0f %12.0f %10.0f %10.0f %9.1f%%\n", sides[i] * sides[i], count, move_ns, teleport_ns, exchange_ns, point_ns, large_ns,
               100 * (double)counts.relocations / (double)counts.moves);
        bench_close(&b);
    }
    return 0;
}
