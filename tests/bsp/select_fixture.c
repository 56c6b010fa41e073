// See select_fixture.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "select_fixture.h"

#include <dlfcn.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- Sessions ----

const cull_plugin *plugin_named(const char *id)
{
    const char *folder = getenv("PORTCULLIS_PLUGINS");
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.culler.so", folder ? folder : "build/plugins", id);
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL); // stays open: sanitizers want its symbols
    if (!library) {
        fprintf(stderr, "no library: %s\n", dlerror());
        return NULL;
    }
    const cull_entry_v0 *entry = dlsym(library, CULL_ENTRY_SYMBOL);
    return entry && entry->abi == CULL_ABI && entry->plugin_count == 1 ? entry->plugins[0] : NULL;
}

const cull_plugin *bsp_or_skip(void)
{
    const cull_plugin *p = plugin_named("bsp");
    if (!p) {
        fprintf(stderr, "SKIPPED: the bsp library is not built\n");
        skip();
    }
    return p;
}

cull_result bsp_open(session *s, test_host *h, const cull_zone *zone, const bsp_values *values)
{
    const char *list[] = {values->backface, values->split, values->choose, values->cells, values->isa};
    return session_open(s, h, bsp_or_skip(), zone, list);
}

const char *select_set(const session *s, uint8_t *seen)
{
    if (s->item_count) memset(seen, 0, s->item_count);
    if (s->run_count > s->built.max_runs) return "more runs than max_runs";
    for (uint32_t i = 0; i < s->run_count; i++) {
        const cull_run r = s->runs[i];
        if (r.count == 0) return "an empty run";
        if (r.first >= s->item_count || r.count > s->item_count - r.first) return "a run beyond the last item";
        for (uint32_t place = r.first; place < r.first + r.count; place++)
            if (seen[s->built.order[place]]++) return "an item twice";
    }
    return NULL;
}

// ---- Scenes ----

static void *must(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    if (!memory) abort();
    return memory;
}

void wall_zone_init(wall_zone *w, uint32_t items_most)
{
    memset(w, 0, sizeof *w);
    w->item_room = items_most;
    w->boxes = must(items_most, sizeof *w->boxes);
    w->walls = must(items_most, sizeof *w->walls);
    w->planes = must(items_most, sizeof *w->planes);
    w->flags = must(items_most, sizeof *w->flags);
    w->positions = must((size_t)items_most * LOOP_MOST, sizeof *w->positions);
    w->loops = must((size_t)items_most * LOOP_MOST, sizeof *w->loops);
    w->indices = must((size_t)items_most * LOOP_MOST * 3, sizeof *w->indices);
}

static uint32_t item_add(wall_zone *w, cull_box box, uint32_t flags)
{
    if (w->item_count == w->item_room) abort();
    w->boxes[w->item_count] = box;
    w->flags[w->item_count] = flags;
    return w->item_count++;
}

static cull_plane plane_through(const cull_vec3 *points, uint32_t count)
{
    double n[3] = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++) {
        const cull_vec3 a = points[i], b = points[(i + 1) % count];
        n[0] += ((double)a.y - (double)b.y) * ((double)a.z + (double)b.z);
        n[1] += ((double)a.z - (double)b.z) * ((double)a.x + (double)b.x);
        n[2] += ((double)a.x - (double)b.x) * ((double)a.y + (double)b.y);
    }
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), by = length > 0 ? 1 / length : 0;
    const double offset = -(n[0] * (double)points[0].x + n[1] * (double)points[0].y + n[2] * (double)points[0].z) * by;
    return (cull_plane){{(float)(n[0] * by), (float)(n[1] * by), (float)(n[2] * by)}, (float)offset};
}

uint32_t wall_zone_wall(wall_zone *w, const cull_vec3 *points, uint32_t count, uint32_t flags)
{
    const uint32_t first = w->position_count;
    cull_box box = cull_box_none();
    for (uint32_t i = 0; i < count; i++) {
        w->loops[first + i] = first + i;
        w->positions[first + i] = points[i];
        box = cull_box_with_point(box, points[i]);
    }
    w->position_count += count;
    const uint32_t item = item_add(w, box, flags);
    w->walls[item] = (cull_wall){first, count, w->plane_count, 0};
    w->planes[w->plane_count++] = plane_through(points, count);
    return item;
}

uint32_t wall_zone_box(wall_zone *w, cull_box box)
{
    return item_add(w, box, CULL_ITEM_BOX);
}

void wall_zone_end(wall_zone *w)
{
    cull_zone *z = &w->z.zone;
    test_zone_make(w->boxes, w->item_count, &w->z);
    for (uint32_t i = 0; i < w->item_count; i++) {
        const cull_wall wall = w->walls[i];
        w->z.items[i] = (cull_item){.first_index = w->index_count, .polygon_count = 1, .flags = w->flags[i]};
        for (uint32_t k = 2; k < wall.vertex_count; k++) {
            const uint32_t fan[3] = {wall.first_vertex, wall.first_vertex + k - 1, wall.first_vertex + k};
            memcpy(w->indices + w->index_count, fan, sizeof fan);
            w->index_count += 3;
        }
        w->z.items[i].index_count = w->index_count - w->z.items[i].first_index;
    }
    z->positions = w->positions;
    z->indices = w->indices;
    z->walls = w->walls;
    z->wall_vertices = w->loops;
    z->planes = w->planes;
    z->position_count = z->wall_vertex_count = w->position_count;
    z->index_count = w->index_count;
    z->plane_count = w->plane_count;
}

void wall_zone_free(wall_zone *w)
{
    test_zone_free(&w->z);
    free(w->boxes);
    free(w->walls);
    free(w->planes);
    free(w->flags);
    free(w->positions);
    free(w->loops);
    free(w->indices);
}

static cull_vec3 scaled(cull_vec3 p, float scale)
{
    return (cull_vec3){p.x * scale, p.y * scale, p.z * scale};
}

void wall_zone_changed(const wall_zone *from, const uint32_t *places, float scale, wall_zone *out)
{
    uint32_t *items = must(from->item_count, sizeof *items);
    for (uint32_t i = 0; i < from->item_count; i++) items[places[i]] = i;
    wall_zone_init(out, from->item_room);
    for (uint32_t place = 0; place < from->item_count; place++) {
        const uint32_t i = items[place];
        const cull_wall wall = from->walls[i];
        cull_vec3 points[LOOP_MOST];
        for (uint32_t k = 0; k < wall.vertex_count; k++) points[k] = scaled(from->positions[wall.first_vertex + k], scale);
        if (wall.vertex_count) wall_zone_wall(out, points, wall.vertex_count, from->flags[i]);
        else wall_zone_box(out, (cull_box){scaled(from->boxes[i].min, scale), scaled(from->boxes[i].max, scale)});
    }
    wall_zone_end(out);
    free(items);
}

static float on_grid(double x)
{
    return (float)(rint(x * 32) / 32);
}

// Six walls that face in or out.
static void add_room(random_state *r, wall_zone *out)
{
    float c[2][3];
    const int inward = random_unit(r) < 0.7;
    for (int k = 0; k < 3; k++) {
        c[0][k] = on_grid(random_between(r, -40, 30));
        c[1][k] = c[0][k] + on_grid(random_between(r, 1, 12));
    }
    for (int axis = 0; axis < 3; axis++)
        for (int high = 0; high < 2; high++) {
            static const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}; // counterclockwise against +axis
            cull_vec3 points[4];
            for (int i = 0; i < 4; i++) {
                cull_vec3 *p = &points[high != inward ? i : 3 - i];
                (&p->x)[axis] = c[high][axis];
                (&p->x)[(axis + 1) % 3] = c[around[i][0]][(axis + 1) % 3];
                (&p->x)[(axis + 2) % 3] = c[around[i][1]][(axis + 2) % 3];
            }
            wall_zone_wall(out, points, 4, CULL_ITEM_WALL);
        }
}

// A convex loop of 3 to 12 corners in any plane; some slivers, some large.
static void add_loop(random_state *r, wall_zone *out)
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
    const uint32_t count = 3 + (uint32_t)(random_next(r) % kinds);
    const double wide = random_unit(r) < 0.1 ? 30 : random_between(r, 0.2, 5);
    const double high = random_unit(r) < 0.1 ? 0.02 : wide;
    cull_vec3 points[12];
    for (uint32_t i = 0; i < count; i++) {
        const double turn = 6.283185307179586 * i / count, a = wide * cos(turn), b = high * sin(turn);
        for (int k = 0; k < 3; k++) (&points[i].x)[k] = (float)(c[k] + a * u[k] + b * v[k]);
    }
    wall_zone_wall(out, points, count, CULL_ITEM_WALL | (random_unit(r) < 0.1 ? CULL_ITEM_TWO_SIDED : 0u));
}

static void add_cluster(random_state *r, wall_zone *out)
{
    cull_box box;
    for (int k = 0; k < 3; k++) {
        (&box.min.x)[k] = (float)random_between(r, -40, 40);
        (&box.max.x)[k] = (&box.min.x)[k] + (float)(random_unit(r) < 0.2 ? 0 : random_between(r, 0, 3));
    }
    wall_zone_box(out, box);
}

static void add_equal(wall_zone *out, uint32_t i)
{
    const cull_vec3 points[4] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, turned[4] = {points[3], points[2], points[1], points[0]};
    wall_zone_wall(out, i % 3 ? points : turned, 4, CULL_ITEM_WALL);
}

void scene_fill(random_state *r, scene_kind kind, uint32_t items, wall_zone *out)
{
    wall_zone_init(out, items);
    while (out->item_count < items) {
        const uint32_t i = out->item_count;
        if (kind == SCENE_ROOMS && items - i >= 6) add_room(r, out);
        else if (kind == SCENE_BOXES || (kind == SCENE_MIXED && i % 3 == 0)) add_cluster(r, out);
        else if (kind == SCENE_COINCIDENT) add_equal(out, i);
        else add_loop(r, out);
    }
    wall_zone_end(out);
}

// ---- Views ----

static void make_camera(random_state *r, const cull_zone *zone, camera *out)
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
        const cull_vec3 p = zone->positions[random_next(r) % zone->position_count];
        for (int k = 0; k < 3; k++) out->eye[k] = (double)(&p.x)[k];
    }
    random_direction(r, out->forward);
    random_direction(r, out->up);
    out->fovy_deg = random_unit(r) < 0.2 ? random_between(r, 1, 5) : random_between(r, 20, 100);
}

void view_fill(random_state *r, const cull_zone *zone, uint32_t volumes, made_view *out)
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
