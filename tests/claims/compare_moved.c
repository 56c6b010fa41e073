// compare_moved A B STEP same|turned CHAIN...: two scenes of move_scene, A where it stands, B moved. Over every STEP-th view of their paths
// `moved`: the same zones are reached by each chain; an item that one draws and the other doesn't has a box within 2^-18 of
// its zone's radius of a plane of a volume (of turned scenes, whose boxes are others, only counted); id pictures are equal in
// 99.99% of pixels. Exit code 0: so; 1: not; 77: no OpenGL.
// SPDX-License-Identifier: MIT
#include "stage.h"

#include "host/render/render.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 640, HEIGHT = 360, PIXELS = WIDTH * HEIGHT, NO_GL = 77 };
static const double NEAR_A_PLANE = 1.0 / 262144; // of the zone's radius

typedef struct side {
    stage stage;
    camera_path path;
    uint32_t *pictures;                  // PIXELS a view looked at
    uint8_t *zones, *drawn, *near_plane; // of the view at hand; drawn and near_plane by global id
    uint32_t **order;                    // by zone: global ids
} side;

typedef struct tally { uint64_t other_zones, differ, unexplained, drawn; } tally;

// One context at a time.
static int pictures_draw(side *s, uint32_t step)
{
    report r = report_to_stderr();
    renderer *g = NULL;
    id_picture picture;
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = WIDTH, .height_px = HEIGHT};
    s->pictures = calloc((size_t)(s->path.count / step + 1) * PIXELS, sizeof *s->pictures);
    assert_non_null(s->pictures);
    if (renderer_open(&options, allocator_heap(), &r, &g) != RESULT_OK) return 0;
    assert_int_equal(renderer_upload(g, s->stage.scene, &r), RESULT_OK);
    assert_int_equal(id_picture_open(s->stage.scene, WIDTH, HEIGHT, allocator_heap(), &picture), RESULT_OK);
    for (uint32_t v = 0; v < s->path.count; v += step) {
        assert_int_equal(renderer_id_picture(g, &(id_request){.camera = &s->path.cameras[v]}, &r, &picture), RESULT_OK);
        memcpy(s->pictures + (size_t)(v / step) * PIXELS, picture.triangles, PIXELS * sizeof *s->pictures);
    }
    id_picture_free(&picture, allocator_heap());
    renderer_close(g);
    return 1;
}

static int side_open(side *s, const char *file, uint32_t step)
{
    report r = report_to_stderr();
    stage_load(&s->stage, file);
    assert_int_equal(camera_path_load("path:moved", s->stage.scene, 16.0 / 9, allocator_heap(), &r, &s->path), RESULT_OK);
    s->zones = calloc(s->stage.scene->zone_count, 1);
    s->drawn = calloc(s->stage.scene->item_count, 1);
    s->near_plane = calloc(s->stage.scene->item_count, 1);
    s->order = calloc(s->stage.scene->zone_count, sizeof *s->order);
    assert_true(s->zones && s->drawn && s->near_plane && s->order);
    return pictures_draw(s, step);
}

static void world_make(side *s, const char *chain)
{
    const scene *scene = s->stage.scene;
    const chain_spec **by_zone = calloc(scene->zone_count, sizeof *by_zone);
    assert_non_null(by_zone);
    for (uint32_t z = 0; z < scene->zone_count; z++) by_zone[z] = stage_chain(&s->stage, chain);
    stage_open(&s->stage, &(stage_world){by_zone, 0});
    free(by_zone);
    for (uint32_t z = 0; z < scene->zone_count; z++) {
        s->order[z] = calloc(scene->zones[z].item_count + 1, sizeof **s->order);
        assert_non_null(s->order[z]);
        if (world_zone(s->stage.world, z) && scene->zones[z].item_count) world_order(s->stage.world, z, s->order[z]);
    }
}

static void world_drop(side *s)
{
    for (uint32_t z = 0; z < s->stage.scene->zone_count; z++) free(s->order[z]);
    stage_shut(&s->stage);
}

// Boxes against every plane of every volume of the zone: how far the box's nearest corner is from being cut.
static void near_planes_mark(side *s, const flow_result *f)
{
    const scene *scene = s->stage.scene;
    for (uint32_t k = 0; k < f->zone_count; k++) {
        const flow_zone *zone = &f->zones[k];
        const scene_zone *of = &scene->zones[zone->zone];
        double shift[3], radius = 0;
        for (int a = 0; a < 3; a++) shift[a] = scene->whole.origin[a] - of->origin[a];
        for (uint32_t i = 0; i < of->item_count; i++) {
            const uint32_t id = scene->zone_items[of->first_item + i];
            radius = fmax(radius, fmax(fabs((double)scene->boxes.max_x[id] + shift[0]), fmax(fabs((double)scene->boxes.max_y[id] + shift[1]), fabs((double)scene->boxes.max_z[id] + shift[2]))));
            radius = fmax(radius, fmax(fabs((double)scene->boxes.min_x[id] + shift[0]), fmax(fabs((double)scene->boxes.min_y[id] + shift[1]), fabs((double)scene->boxes.min_z[id] + shift[2]))));
        }
        for (uint32_t i = 0; i < of->item_count; i++) {
            const uint32_t id = scene->zone_items[of->first_item + i];
            const double low[3] = {(double)scene->boxes.min_x[id] + shift[0], (double)scene->boxes.min_y[id] + shift[1], (double)scene->boxes.min_z[id] + shift[2]};
            const double high[3] = {(double)scene->boxes.max_x[id] + shift[0], (double)scene->boxes.max_y[id] + shift[1], (double)scene->boxes.max_z[id] + shift[2]};
            for (uint32_t v = 0; v < zone->count; v++) {
                const cull_volume *volume = &f->volumes[f->by_zone[zone->first + v]].volume;
                for (uint32_t p = 0; p < volume->plane_count; p++) {
                    const cull_plane plane = volume->planes[p];
                    const double n[3] = {(double)plane.normal.x, (double)plane.normal.y, (double)plane.normal.z};
                    double height = (double)plane.offset;
                    for (int a = 0; a < 3; a++) height += n[a] * (n[a] >= 0 ? high[a] : low[a]);
                    if (fabs(height) <= NEAR_A_PLANE * radius) s->near_plane[id] = 1;
                }
            }
        }
    }
}

static void look(side *s, uint32_t v)
{
    const scene *scene = s->stage.scene;
    const frame_input q = stage_input(&s->path.cameras[v], v);
    visible_set set;
    memset(s->zones, 0, scene->zone_count);
    memset(s->drawn, 0, scene->item_count);
    memset(s->near_plane, 0, scene->item_count);
    frame_stats stats;
    world_cull(s->stage.view, &q, &set, &stats);
    for (uint32_t k = 0; k < set.zone_count; k++)
        for (uint32_t r = 0; r < set.zones[k].run_count; r++)
            for (uint32_t i = 0; i < set.zones[k].runs[r].count; i++) s->drawn[s->order[set.zones[k].zone][set.zones[k].runs[r].first + i]] = 1;
    const flow_result *f = world_view_flow(s->stage.view);
    for (uint32_t k = 0; k < f->zone_count; k++) s->zones[f->zones[k].zone] = 1;
    near_planes_mark(s, f);
}

static void compare(side *a, side *b, uint32_t v, tally *t)
{
    look(a, v);
    look(b, v);
    const scene *scene = a->stage.scene;
    for (uint32_t z = 0; z < scene->zone_count; z++) t->other_zones += a->zones[z] != b->zones[z];
    for (uint32_t i = 0; i < scene->item_count; i++) {
        t->drawn += a->drawn[i];
        if (a->drawn[i] == b->drawn[i]) continue;
        t->differ++;
        t->unexplained += !a->near_plane[i] && !b->near_plane[i];
    }
}

int main(int count, char **arguments)
{
    static side a, b;
    if (count < 6) return 2;
    const uint32_t step = (uint32_t)strtoul(arguments[3], NULL, 10);
    const int is_turned = strcmp(arguments[4], "turned") == 0;
    if (!side_open(&a, arguments[1], step) || !side_open(&b, arguments[2], step)) return NO_GL;
    assert_int_equal(a.path.count, b.path.count);
    assert_int_equal(a.stage.scene->item_count, b.stage.scene->item_count);
    const size_t pixels = (size_t)((a.path.count + step - 1) / step) * PIXELS;
    size_t other = 0;
    for (size_t i = 0; i < pixels; i++) other += a.pictures[i] != b.pictures[i];
    printf("pictures: %zu of %zu pixels differ\n", other, pixels);
    int bad = other * 10000 > pixels;
    for (int c = 5; c < count; c++) {
        tally t = {0};
        world_make(&a, arguments[c]);
        world_make(&b, arguments[c]);
        for (uint32_t v = 0; v < a.path.count; v += step) compare(&a, &b, v, &t);
        world_drop(&a);
        world_drop(&b);
        printf("%s: zones that differ %llu, items drawn %llu, differ %llu, not at a plane %llu\n", arguments[c], (unsigned long long)t.other_zones,
               (unsigned long long)t.drawn, (unsigned long long)t.differ, (unsigned long long)t.unexplained);
        bad |= t.other_zones || (t.unexplained && !is_turned);
    }
    return bad;
}
