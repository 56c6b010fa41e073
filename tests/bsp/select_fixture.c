// See select_fixture.h.
// SPDX-License-Identifier: MIT
#include "select_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- Sessions ----

const cull_plugin *bsp_or_skip(void)
{
    const cull_plugin *p = plugin_named("bsp");
    if (!p) {
        fprintf(stderr, "SKIPPED: the bsp library is not built\n");
        skip();
    }
    return p;
}

cull_result bsp_open(session *s, culler_host *h, const cull_zone *zone, const bsp_values *values)
{
    const char *list[] = {values->backface, values->split, values->choose, values->cells, values->isa};
    return session_open(s, h, bsp_or_skip(), zone, list);
}

// ---- Scenes ----

static void *must(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    if (!memory) abort();
    return memory;
}

static cull_vec3 scaled(cull_vec3 p, float scale)
{
    return (cull_vec3){p.x * scale, p.y * scale, p.z * scale};
}

void zone_changed(const hand_zone *from, const uint32_t *places, float scale, hand_zone *out)
{
    const cull_zone *zone = &from->zone;
    uint32_t *items = must(zone->item_count, sizeof *items);
    for (uint32_t i = 0; i < zone->item_count; i++) items[places[i]] = i;
    hand_zone_open(out, from->items_most, from->vertices_most);
    for (uint32_t place = 0; place < zone->item_count; place++) {
        const uint32_t i = items[place];
        const cull_wall wall = from->walls[i];
        const cull_box box = cull_box_at(&zone->boxes, i);
        cull_vec3 points[LOOP_MOST];
        for (uint32_t k = 0; k < wall.vertex_count; k++) points[k] = scaled(from->positions[wall.first_vertex + k], scale);
        if (wall.vertex_count) hand_zone_wall(out, points, wall.vertex_count, from->items[i].flags);
        else hand_zone_cluster(out, (cull_box){scaled(box.min, scale), scaled(box.max, scale)});
    }
    hand_zone_end(out);
    free(items);
}

static float on_grid(double x)
{
    return (float)(rint(x * 32) / 32);
}

static void add_room(uint64_t *r, hand_zone *out)
{
    cull_box box;
    const hand_face face = random_unit(r) < 0.7 ? FACE_IN : FACE_OUT;
    for (int k = 0; k < 3; k++) {
        (&box.min.x)[k] = on_grid(random_between(r, -40, 30));
        (&box.max.x)[k] = (&box.min.x)[k] + on_grid(random_between(r, 1, 12));
    }
    hand_zone_box(out, box, face, 0);
}

// A convex loop of 3 to 12 corners in any plane; some slivers, some large.
static void add_loop(uint64_t *r, hand_zone *out)
{
    double n[3], u[3], v[3], c[3], length = 0;
    random_direction(r, n);
    random_direction(r, u);
    for (int k = 0; k < 3; k++) c[k] = random_between(r, -40, 40);
    for (int k = 0; k < 3; k++) v[k] = n[(k + 1) % 3] * u[(k + 2) % 3] - n[(k + 2) % 3] * u[(k + 1) % 3];
    for (int k = 0; k < 3; k++) length += v[k] * v[k];
    for (int k = 0; k < 3; k++) v[k] /= sqrt(length);
    for (int k = 0; k < 3; k++) u[k] = v[(k + 1) % 3] * n[(k + 2) % 3] - v[(k + 2) % 3] * n[(k + 1) % 3]; // u x v = n
    const uint32_t kinds = random_unit(r) < 0.2 ? 10 : 3;
    const uint32_t count = 3 + (uint32_t)(random_bits(r) % kinds);
    const double wide = random_unit(r) < 0.1 ? 30 : random_between(r, 0.2, 5);
    const double high = random_unit(r) < 0.1 ? 0.02 : wide;
    cull_vec3 points[12];
    for (uint32_t i = 0; i < count; i++) {
        const double turn = 6.283185307179586 * i / count, a = wide * cos(turn), b = high * sin(turn);
        for (int k = 0; k < 3; k++) (&points[i].x)[k] = (float)(c[k] + a * u[k] + b * v[k]);
    }
    hand_zone_wall(out, points, count, random_unit(r) < 0.1 ? CULL_ITEM_TWO_SIDED : 0u);
}

static void add_cluster(uint64_t *r, hand_zone *out)
{
    cull_box box;
    for (int k = 0; k < 3; k++) {
        (&box.min.x)[k] = (float)random_between(r, -40, 40);
        (&box.max.x)[k] = (&box.min.x)[k] + (float)(random_unit(r) < 0.2 ? 0 : random_between(r, 0, 3));
    }
    hand_zone_cluster(out, box);
}

static void add_equal(hand_zone *out, uint32_t i)
{
    const cull_vec3 points[4] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, turned[4] = {points[3], points[2], points[1], points[0]};
    hand_zone_wall(out, i % 3 ? points : turned, 4, 0);
}

void scene_fill(uint64_t *r, scene_kind kind, uint32_t items, hand_zone *out)
{
    hand_zone_open(out, items, items * LOOP_MOST);
    while (out->zone.item_count < items) {
        const uint32_t i = out->zone.item_count;
        if (kind == SCENE_ROOMS && items - i >= 6) add_room(r, out);
        else if (kind == SCENE_BOXES || (kind == SCENE_MIXED && i % 3 == 0)) add_cluster(r, out);
        else if (kind == SCENE_COINCIDENT) add_equal(out, i);
        else add_loop(r, out);
    }
    hand_zone_end(out);
}

// ---- Views ----

static void make_camera(uint64_t *r, const cull_zone *zone, camera *out)
{
    const cull_box b = zone->box;
    *out = (camera){.near_m = 0.0625, .far_m = INFINITY};
    out->aspect = random_between(r, 0.5, 2.5);
    if (random_unit(r) < 0.2) out->far_m = random_between(r, 5, 60);
    const double out_of = random_unit(r) < 0.2 ? 1.5 : 0;
    for (int k = 0; k < 3; k++) {
        const double low = (double)(&b.min.x)[k], high = (double)(&b.max.x)[k];
        out->eye[k] = random_between(r, low - out_of * (high - low), high + out_of * (high - low));
    }
    if (random_unit(r) < 0.3)
        for (int k = 0; k < 3; k++) out->eye[k] = rint(out->eye[k] * 32) / 32;
    if (random_unit(r) < 0.1 && zone->position_count) {
        const cull_vec3 p = zone->positions[random_bits(r) % zone->position_count];
        for (int k = 0; k < 3; k++) out->eye[k] = (double)(&p.x)[k];
    }
    random_direction(r, out->forward);
    random_direction(r, out->up);
    out->fovy_deg = random_unit(r) < 0.2 ? random_between(r, 1, 5) : random_between(r, 20, 100);
}

void view_fill(uint64_t *r, const cull_zone *zone, uint32_t volumes, made_view *out)
{
    const view_frame frame = {1280, 720, 1, 0, CULL_VIEW_MAIN};
    const double origin[3] = {0, 0, 0};
    camera c;
    make_camera(r, zone, &c);
    out->volume_count = volumes;
    view_derive(&c, &frame, origin, &zone->box, &out->view, &out->parts[0]);
    for (uint32_t i = 0; i < volumes; i++) {
        cull_view same_eye;
        if (i) {
            random_direction(r, c.forward);
            c.fovy_deg = random_between(r, 1, 40);
        }
        view_derive(&c, &frame, origin, &zone->box, &same_eye, &out->parts[i]);
        out->volumes[i] = (cull_volume){out->parts[i].planes, out->parts[i].plane_count, 0};
    }
}

// ---- Oracles ----

typedef struct corners { const uint32_t *positions; uint32_t count; } corners;

static int loop_touches(const cull_zone *zone, corners loop, const cull_volume *volume)
{
    cull_point polygon[2][256];
    uint32_t count = loop.count, from = 0;
    int inside_all = 0;
    for (uint32_t i = 0; i < count; i++) {
        const cull_vec3 p = zone->positions[loop.positions[i]];
        int inside = 1;
        for (uint32_t k = 0; k < volume->plane_count; k++) inside &= cull_plane_height(volume->planes[k], p) >= 0;
        inside_all |= inside;
        polygon[0][i] = (cull_point){(double)p.x, (double)p.y, (double)p.z};
    }
    if (inside_all) return 1;
    for (uint32_t k = 0; k < volume->plane_count; k++) {
        const cull_plane plane = volume->planes[k];
        uint32_t outside = 0;
        for (uint32_t i = 0; i < loop.count; i++)
            outside += cull_plane_height(plane, zone->positions[loop.positions[i]]) < 0;
        if (outside == loop.count) return 0;
        if (!outside) continue;
        const cull_cut cut = {(double)plane.normal.x, (double)plane.normal.y, (double)plane.normal.z, (double)plane.offset};
        count = cull_polygon_clip(polygon[from], count, cut, polygon[1 - from], 256);
        from = 1 - from;
        if (!count) return 0;
    }
    return 1;
}

int item_touches(const cull_zone *zone, uint32_t item, const cull_volume *volume)
{
    const cull_item *it = &zone->items[item];
    if (!(it->flags & CULL_ITEM_WALL) || zone->walls[item].vertex_count < 3) return cull_volume_touches(volume, cull_box_at(&zone->boxes, item));
    int touches = loop_touches(zone, (corners){zone->wall_vertices + zone->walls[item].first_vertex, zone->walls[item].vertex_count}, volume);
    for (uint32_t t = 0; t + 3 <= it->index_count && !touches; t += 3)
        touches = loop_touches(zone, (corners){zone->indices + it->first_index + t, 3}, volume);
    return touches;
}

void loop_set(const cull_zone *zone, const made_view *v, uint8_t *seen)
{
    for (uint32_t i = 0; i < zone->item_count; i++) {
        seen[i] = 0;
        for (uint32_t k = 0; k < v->volume_count && !seen[i]; k++) seen[i] = item_touches(zone, i, &v->volumes[k]) != 0;
    }
}

static int point_is_inside(const made_view *v, const long double p[3], double margin)
{
    for (uint32_t i = 0; i < v->volume_count; i++) {
        uint32_t inside = 0;
        for (uint32_t k = 0; k < v->volumes[i].plane_count; k++) {
            const cull_plane plane = v->volumes[i].planes[k];
            const long double height = (long double)plane.normal.x * p[0] + (long double)plane.normal.y * p[1] + (long double)plane.normal.z * p[2];
            inside += height + (long double)plane.offset >= (long double)margin;
        }
        if (inside == v->volumes[i].plane_count) return 1;
    }
    return 0;
}

int item_is_inside(const cull_zone *zone, uint32_t item, const made_view *v, double margin)
{
    enum { STEPS = 12 };
    const cull_item *it = &zone->items[item];
    for (uint32_t t = 0; t + 3 <= it->index_count; t += 3) {
        const uint32_t *corners = zone->indices + it->first_index + t;
        for (int a = 0; a <= STEPS; a++)
            for (int b = 0; a + b <= STEPS; b++) {
                long double p[3];
                for (int k = 0; k < 3; k++)
                    p[k] = ((long double)(&zone->positions[corners[0]].x)[k] * (STEPS - a - b) + (long double)(&zone->positions[corners[1]].x)[k] * a +
                            (long double)(&zone->positions[corners[2]].x)[k] * b) / STEPS;
                if (point_is_inside(v, p, margin)) return 1;
            }
    }
    return 0;
}
