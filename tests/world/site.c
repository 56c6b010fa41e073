// Worlds of rooms for tests: see site.h.
// SPDX-License-Identifier: MIT
#include "site.h"

#include "tests/common/random.h"
#include "tests/common/test.h"
#include "tests/core/box_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- Making ----

void site_begin(site *s, uint64_t fail_at)
{
    memset(s, 0, sizeof *s);
    failing_allocator_init(&s->memory, fail_at);
    report_lines_init(&s->lines);
    host_services_fill(&s->services, &s->memory.memory, &s->lines.report);
    s->texts = arena_make(&s->memory.memory);
}

static result builder_ready(site *s)
{
    uint32_t material, object;
    if (s->builder) return RESULT_OK;
    result done = scene_builder_open(&s->memory.memory, &s->builder);
    if (done == RESULT_OK) done = scene_builder_material(s->builder, "stone", 5, 0, &material);
    if (done == RESULT_OK) done = scene_builder_object(s->builder, "boxes", 5, &object);
    return done;
}

static result zone_add(site *s, const builder_zone *z, uint32_t *out)
{
    const char *fault = NULL;
    const result ready = builder_ready(s);
    if (ready != RESULT_OK) return ready;
    const result done = scene_builder_zone(s->builder, z, out, &fault);
    if (done == RESULT_BAD_INPUT) fail_msg("the zone '%s' %s", z->name, fault);
    return done;
}

result site_room(site *s, const char *name, const site_box *b, uint32_t parent, uint32_t *out)
{
    scene_solid_plane planes[6] = {0};
    for (int i = 0; i < 6; i++) {
        planes[i].normal[i % 3] = i < 3 ? 1 : -1;
        planes[i].distance = i < 3 ? b->max[i] : -b->min[i - 3];
    }
    const builder_hull hull = {planes, 6};
    return zone_add(s, &(builder_zone){.name = name, .hulls = &hull, .hull_count = 1, .parent = parent}, out);
}

result site_outdoors(site *s, const char *name, uint32_t *out)
{
    return zone_add(s, &(builder_zone){.name = name, .parent = SCENE_NONE}, out);
}

result site_item(site *s, const site_box *b)
{
    const result ready = builder_ready(s);
    return ready == RESULT_OK ? box_scene_add(s->builder, b->min, b->max, NULL) : ready;
}

result site_mover(site *s, const char *name, const site_box *b, const double open_offset[3])
{
    const result ready = builder_ready(s);
    return ready == RESULT_OK ? box_scene_add_door(s->builder, b->min, b->max, &(box_scene_door){name, open_offset}) : ready;
}

result site_portal(site *s, const char *name, const site_hole *h)
{
    double points[4][3];
    for (int i = 0; i < 4; i++) {
        points[i][h->axis] = h->at;
        points[i][(h->axis + 1) % 3] = i == 1 || i == 2 ? h->high[0] : h->low[0];
        points[i][(h->axis + 2) % 3] = i >= 2 ? h->high[1] : h->low[1];
    }
    const builder_portal p = {.name = name, .points = (const double(*)[3])points, .point_count = 4, .zones = {h->zones[0], h->zones[1]}, .door = h->door};
    const char *fault = NULL;
    uint32_t out;
    const result done = scene_builder_portal(s->builder, &p, &out, &fault);
    if (done == RESULT_BAD_INPUT) fail_msg("the portal '%s' %s", name, fault);
    return done;
}

result site_door(site *s, const char *name, door_state at_rest, uint32_t mover, uint32_t *out)
{
    const result ready = builder_ready(s);
    return ready == RESULT_OK ? scene_builder_door(s->builder, name, at_rest, mover, out) : ready;
}

result site_end(site *s)
{
    static const char *const folders[] = {TEST_PLUGINS, PRODUCT_PLUGINS};
    const loader_options o = {.folders = folders, .folder_count = 2};
    const result done = scene_builder_finish(s->builder, "site", &s->lines.report, &s->scene);
    scene_builder_close(s->builder);
    s->builder = NULL;
    return done == RESULT_OK ? loader_open(&o, &s->memory.memory, &s->lines.report, &s->plugins) : done;
}

void site_parse(site *s, const char *chain, chain_spec *out)
{
    if (chain_parse(chain, &s->texts, &s->lines.report, out) == RESULT_BAD_INPUT) fail_msg("'%s' is no chain", chain);
}

static result parse_chains(site *s, const site_world *q, const chain_spec **specs, chain_spec *room)
{
    for (uint32_t i = 0; q->chains && i < s->scene->zone_count; i++) {
        if (!q->chains[i]) continue;
        const result done = chain_parse(q->chains[i], &s->texts, &s->lines.report, &room[i]);
        if (done != RESULT_OK) return done;
        specs[i] = &room[i];
    }
    return RESULT_OK;
}

result site_open(site *s, const site_world *q)
{
    chain_spec all;
    const result parsed = chain_parse(q->chain, &s->texts, &s->lines.report, &all);
    if (parsed != RESULT_OK) return parsed;
    const chain_spec **specs = calloc(s->scene->zone_count, sizeof *specs);
    chain_spec *room = calloc(q->chains ? s->scene->zone_count : 1, sizeof *room);
    assert_true(specs && room);
    result done = parse_chains(s, q, specs, room);
    const world_request w = {.scene = s->scene, .plugins = s->plugins, .services = &s->services, .chains = specs, .chain = &all, .more_movers = q->more_movers};
    if (done == RESULT_OK) done = world_open(&w, &s->lines.report, &s->world);
    free(specs);
    free(room);
    return done;
}

void site_close(site *s)
{
    world_close(s->world);
    loader_close(s->plugins);
    scene_builder_close(s->builder);
    scene_free(s->scene, &s->memory.memory);
    arena_free(&s->texts);
    assert_true(failing_allocator_is_clean(&s->memory));
}

// ---- Grids ----

enum { ROOM_M = 4 };
static const double ROOM_HIGH_M = 3;

static double on_grid(double metres)
{
    return floor(metres * 256) / 256;
}

static result grid_hole(site *s, const site_grid *g, uint32_t room, uint32_t axis)
{
    const double *o = g->at;
    char name[32];
    const uint32_t beside = axis == 0 ? room + 1 : room + g->wide;
    const double x = o[0] + ROOM_M * (room % g->wide), z = o[2] + ROOM_M * (double)(room / g->wide);
    uint32_t door;
    snprintf(name, sizeof name, "%u-%u", room, beside);
    const result done = site_door(s, name, DOORS_OPEN, SCENE_NONE, &door);
    if (done != RESULT_OK) return done;
    if (axis == 0) return site_portal(s, name, &(site_hole){{room, beside}, door, 0, x + ROOM_M, {o[1], z + 1}, {o[1] + 2, z + 3}});
    return site_portal(s, name, &(site_hole){{room, beside}, door, 2, z + ROOM_M, {x + 1, o[1]}, {x + 3, o[1] + 2}});
}

static site_box strewn(site *s, const site_grid *g)
{
    const double high[3] = {ROOM_M * (double)g->wide - 1, ROOM_HIGH_M - 1, ROOM_M * (double)g->deep - 1};
    site_box b;
    for (int k = 0; k < 3; k++) {
        b.min[k] = g->at[k] + on_grid(random_between(&s->seed, 0, high[k]));
        b.max[k] = b.min[k] + on_grid(random_between(&s->seed, 0.125, 1));
    }
    return b;
}

static result grid_rooms(site *s, const site_grid *g)
{
    result done = RESULT_OK;
    for (uint32_t i = 0; i < g->wide * g->deep && done == RESULT_OK; i++) {
        char name[16];
        uint32_t zone;
        snprintf(name, sizeof name, "r%u", i);
        const double x = g->at[0] + ROOM_M * (i % g->wide), z = g->at[2] + ROOM_M * (double)(i / g->wide);
        const site_box b = {{x, g->at[1], z}, {x + ROOM_M, g->at[1] + ROOM_HIGH_M, z + ROOM_M}};
        done = site_room(s, name, &b, SCENE_NONE, &zone);
    }
    return done;
}

result site_make_grid(site *s, const site_grid *g)
{
    static const double none[3] = {0, 0, 0};
    s->seed = g->seed;
    result done = grid_rooms(s, g);
    for (uint32_t i = 0; i < g->wide * g->deep && done == RESULT_OK; i++) {
        if (i % g->wide + 1 < g->wide) done = grid_hole(s, g, i, 0);
        if (done == RESULT_OK && i / g->wide + 1 < g->deep) done = grid_hole(s, g, i, 2);
    }
    for (uint32_t i = 0; i < g->items && done == RESULT_OK; i++) {
        const site_box b = strewn(s, g);
        done = site_item(s, &b);
    }
    for (uint32_t i = 0; i < g->movers && done == RESULT_OK; i++) {
        const site_box b = strewn(s, g);
        done = site_mover(s, "lift", &b, none);
    }
    return done == RESULT_OK ? site_end(s) : done;
}

camera site_camera(const double eye[3], const double forward[3])
{
    return (camera){.eye = {eye[0], eye[1], eye[2]}, .forward = {forward[0], forward[1], forward[2]}, .up = {0, 1, 0},
                    .fovy_deg = 60, .aspect = 4.0 / 3, .near_m = 1.0 / 16, .far_m = INFINITY};
}

camera site_random_camera(uint64_t *seed, const site_grid *g)
{
    double eye[3];
    const double high[3] = {ROOM_M * (double)g->wide, ROOM_HIGH_M, ROOM_M * (double)g->deep}, yaw = random_between(seed, 0, 6.283185307);
    for (int k = 0; k < 3; k++) eye[k] = g->at[k] + random_between(seed, 0.25, high[k] - 0.25);
    return site_camera(eye, (double[3]){cos(yaw), random_between(seed, -0.5, 0.5), sin(yaw)});
}

frame_input site_input(const camera *c, uint32_t frame)
{
    return (frame_input){.camera = c, .frame = {.width_px = 320, .height_px = 240, .frame = frame, .purpose = CULL_VIEW_MAIN}};
}
