// Not a test: what each view of a scene's paths costs beside how many zones it sees. measure_rooms SCENE STEP CHAIN: a line for every STEP-th view of
// walk and tour: zones there are, zones seen, portals tried, items drawn, least cull_ns of some frames. One thread.
// SPDX-License-Identifier: MIT
#include "stage.h"

#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { FRAMES = 7 };

static void look(stage *s, const camera *c, uint32_t v)
{
    const frame_input q = stage_input(c, v);
    frame_stats stats = {0};
    double best = INFINITY;
    for (int i = 0; i < FRAMES; i++) {
        world_cull(s->view, &q, NULL, &stats);
        best = fmin(best, stats.cull_ns);
    }
    printf("%u %u %u %llu %.0f\n", s->scene->zone_count, stats.zones, stats.crossings, (unsigned long long)stats.items_drawn, best);
}

int main(int count, char **arguments)
{
    static stage s;
    if (count != 4) return 2;
    stage_load(&s, arguments[1]);
    const uint32_t step = (uint32_t)strtoul(arguments[2], NULL, 10);
    const chain_spec **by_zone = calloc(s.scene->zone_count, sizeof *by_zone);
    assert_true(by_zone && step);
    for (uint32_t zone = 0; zone < s.scene->zone_count; zone++) by_zone[zone] = stage_chain_of(&s, arguments[3], zone);
    stage_open(&s, &(stage_world){by_zone, 0});
    for (uint32_t d = 0; d < s.scene->door_count; ++d) world_set_door(s.world, d, DOORS_OPEN);
    const camera_path *const paths[] = {&s.walk, &s.tour};
    for (int p = 0; p < 2; p++)
        for (uint32_t v = 0; v < paths[p]->count; v += step) look(&s, &paths[p]->cameras[v], v);
    stage_shut(&s);
    free(by_zone);
    stage_free(&s);
    return 0;
}
