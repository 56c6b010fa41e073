// compare_far A B DX DY DZ STEP open|closed: scene B is A moved. Over every STEP-th view of walk and tour: the same zones are
// reached, by the flood and by a crosser; id pictures are equal in 99.99% of pixels; in closed scenes no pixel shows
// nothing (a crack). Exit code 0: so; 1: not; 77: no OpenGL.
// SPDX-License-Identifier: MIT
#include "stage.h"

#include "host/render/render.h"
#include "tests/common/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 320, HEIGHT = 180, PIXELS = WIDTH * HEIGHT, CHAINS = 2, NO_GL = 77 };
static const char *const chains[CHAINS] = {"frustum", "frustum+portal"};

typedef struct seen { // of one scene, view after view
    uint32_t *pictures;     // PIXELS a view
    uint8_t *zones[CHAINS]; // volumes of each zone, at most 255
    uint64_t items[CHAINS];
    uint32_t views, zone_count;
} seen;

typedef struct job { const char *file; double move[3]; uint32_t step; } job;

static camera camera_at(const stage *s, const job *j, uint32_t v)
{
    const camera_path *path = v < s->walk.count ? &s->walk : &s->tour;
    camera c = path->cameras[v < s->walk.count ? v : v - s->walk.count];
    for (int k = 0; k < 3; k++) c.eye[k] += j->move[k];
    return c;
}

static void reach(stage *s, const job *j, const stage *home, uint32_t chain, seen *out)
{
    const chain_spec **by_zone = calloc(s->scene->zone_count, sizeof *by_zone);
    assert_non_null(by_zone);
    for (uint32_t zone = 0; zone < s->scene->zone_count; zone++) by_zone[zone] = stage_chain(s, chains[chain]);
    stage_open(s, &(stage_world){by_zone, 0});
    for (uint32_t i = 0; i < out->views; i++) {
        const camera c = camera_at(home, j, i * j->step);
        const frame_input q = stage_input(&c, i);
        frame_stats stats;
        world_cull(s->view, &q, NULL, &stats);
        out->items[chain] += stats.items_drawn;
        const flow_result *f = world_view_flow(s->view);
        uint8_t *zones = out->zones[chain] + (size_t)i * out->zone_count;
        for (uint32_t k = 0; k < f->zone_count; k++) zones[f->zones[k].zone] = (uint8_t)(f->zones[k].count < 255 ? f->zones[k].count : 255);
    }
    stage_shut(s);
    free(by_zone);
}

static int draw(stage *s, const job *j, const stage *home, seen *out)
{
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    renderer *g = NULL;
    id_picture picture;
    report r = report_to_stderr();
    if (renderer_open(&options, allocator_heap(), &r, &g) != RESULT_OK) return 0;
    assert_int_equal(renderer_upload(g, s->scene, &r), RESULT_OK);
    assert_int_equal(id_picture_open(s->scene, WIDTH, HEIGHT, allocator_heap(), &picture), RESULT_OK);
    for (uint32_t i = 0; i < out->views; i++) {
        const camera c = camera_at(home, j, i * j->step);
        assert_int_equal(renderer_id_picture(g, &(id_request){.camera = &c}, &r, &picture), RESULT_OK);
        memcpy(out->pictures + (size_t)i * PIXELS, picture.triangles, PIXELS * sizeof(uint32_t));
    }
    id_picture_free(&picture, allocator_heap());
    renderer_close(g);
    return 1;
}

static int look(const job *j, const stage *home, seen *out)
{
    static stage s;
    stage_load(&s, j->file);
    out->zone_count = s.scene->zone_count;
    out->views = (home->walk.count + home->tour.count + j->step - 1) / j->step;
    out->pictures = calloc((size_t)out->views * PIXELS, sizeof(uint32_t));
    assert_non_null(out->pictures);
    for (uint32_t k = 0; k < CHAINS; k++) {
        out->zones[k] = calloc(out->views, out->zone_count);
        assert_non_null(out->zones[k]);
        reach(&s, j, home, k, out);
    }
    const int has_gl = draw(&s, j, home, out);
    stage_free(&s);
    return has_gl;
}

int main(int count, char **arguments)
{
    static stage home;
    seen a = {0}, b = {0};
    if (count != 8) return 2;
    const uint32_t step = (uint32_t)strtoul(arguments[6], NULL, 10);
    const job at_home = {arguments[1], {0, 0, 0}, step};
    const job far = {arguments[2], {strtod(arguments[3], NULL), strtod(arguments[4], NULL), strtod(arguments[5], NULL)}, step};
    stage_load(&home, arguments[1]);
    if (!look(&at_home, &home, &a) || !look(&far, &home, &b)) return NO_GL;
    size_t differ = 0, cracks[2] = {0};
    const size_t pixels = (size_t)a.views * PIXELS;
    for (size_t i = 0; i < pixels; i++) {
        differ += a.pictures[i] != b.pictures[i];
        cracks[0] += a.pictures[i] == 0;
        cracks[1] += b.pictures[i] == 0;
    }
    int other_zones = a.zone_count != b.zone_count;
    for (uint32_t k = 0; k < CHAINS && !other_zones; k++)
        for (size_t i = 0; i < (size_t)a.views * a.zone_count; i++) other_zones += a.zones[k][i] != b.zones[k][i];
    printf("%u views: %d zones or volumes differ, %zu of %zu pixels differ (%.5f%%), empty pixels %zu at home, %zu far, items drawn %llu and %llu, narrowed %llu and %llu\n",
           a.views, other_zones, differ, pixels, 100.0 * (double)differ / (double)pixels, cracks[0], cracks[1], (unsigned long long)a.items[0],
           (unsigned long long)b.items[0], (unsigned long long)a.items[1], (unsigned long long)b.items[1]);
    const int is_closed = strcmp(arguments[7], "closed") == 0;
    return other_zones || differ * 10000 > pixels || (is_closed && cracks[0] + cracks[1] > 0);
}
