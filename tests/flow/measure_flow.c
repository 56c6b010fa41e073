// Not a test: what a flow costs. measure_flow [ROOMS A SIDE], 32 by default: an open grid, flood and portal.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "tests/flow/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec / 1e6;
}

static void measure(maze *m, const camera *c, crosser_kind kind, const char *text)
{
    flow_result r;
    double best = 1e9;
    for (int i = 0; i < 20; i++) {
        const double start = now_ms();
        maze_run(m, c, kind, &r);
        const double took = now_ms() - start;
        best = took < best ? took : best;
    }
    printf("%-28s %7.3f ms, %5u zones, %5u volumes, %6u portals tried, %5u merges, %u limits\n", text, best, r.zone_count, r.volume_count,
           r.crossings, r.portal_merges, r.limits_hit);
}

int main(int count, char **arguments)
{
    const uint32_t side = count > 1 ? (uint32_t)strtoul(arguments[1], NULL, 10) : 32;
    const char *const names[] = {"narrow doors", "random doors", "whole faces"};
    for (uint32_t doors = 0; doors < 3; doors++) {
        maze m;
        maze_grid(&m, &(grid_recipe){.wide = side, .deep = side, .doors = (door_width)doors, .seed = 3, .pose = POSE_NONE});
        const double corner[3] = {0.25, 1.5, 0.25}, middle[3] = {2.0 * side + 1.9, 1.5, 2.0 * side + 1.7}, along[3] = {1, 0, 0.8};
        const camera cameras[2] = {maze_camera(&m, corner, along, 75), maze_camera(&m, middle, along, 75)};
        for (int i = 0; i < 2; i++) {
            char text[64];
            const char *const kinds[] = {"flood", "narrow", "mixed"};
            for (crosser_kind kind = CROSSER_FLOOD; kind <= CROSSER_MIXED; kind++) {
                snprintf(text, sizeof text, "%s, %s, %s", names[doors], i ? "middle" : "corner", kinds[kind]);
                measure(&m, &cameras[i], kind, text);
            }
        }
        maze_close(&m);
    }
    return 0;
}
