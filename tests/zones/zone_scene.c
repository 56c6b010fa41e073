// Scenes with zones for tests: see zone_scene.h.
// SPDX-License-Identifier: MIT
#include "zone_scene.h"

#include "tests/common/random.h"
#include "tests/core/box_scene.h"

#include <math.h>
#include <stdio.h>

void box_planes(const zone_box *box, scene_solid_plane planes[6])
{
    for (int k = 0; k < 6; ++k) {
        planes[k] = (scene_solid_plane){{0, 0, 0}, k < 3 ? box->max[k] : -box->min[k - 3]};
        planes[k].normal[k % 3] = k < 3 ? 1 : -1;
    }
}

result add_box_zone(scene_builder *b, const char *name, const zone_box *box, uint32_t parent, uint32_t *out)
{
    scene_solid_plane planes[6];
    box_planes(box, planes);
    const builder_hull hull = {planes, 6};
    const builder_zone zone = {.name = name, .hulls = &hull, .hull_count = 1, .parent = parent};
    const char *fault;
    return scene_builder_zone(b, &zone, out, &fault);
}

result add_everywhere(scene_builder *b, const char *name, uint32_t *out)
{
    const builder_zone zone = {.name = name, .parent = SCENE_NONE};
    const char *fault;
    return scene_builder_zone(b, &zone, out, &fault);
}

result add_hole(scene_builder *b, const door_hole *h, uint32_t *out, const char **fault)
{
    const double points[4][3] = {
        {h->x, h->low[0], h->low[1]}, {h->x, h->high[0], h->low[1]}, {h->x, h->high[0], h->high[1]}, {h->x, h->low[0], h->high[1]}};
    const builder_portal portal = {.name = "hole", .points = points, .point_count = 4, .zones = {h->zones[0], h->zones[1]}, .door = SCENE_NONE};
    return scene_builder_portal(b, &portal, out, fault);
}

result add_wall(scene_builder *b, const double corners[4][3])
{
    static const uint32_t two = 2;
    builder_vertex v[4] = {0};
    uint32_t first;
    for (int c = 0; c < 4; ++c)
        for (int k = 0; k < 3; ++k) v[c].position[k] = corners[c][k];
    const result done = scene_builder_vertices(b, v, 4, 0, &first);
    if (done != RESULT_OK) return done;
    double u[3], w[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = corners[1][k] - corners[0][k];
        w[k] = corners[2][k] - corners[0][k];
    }
    const double n[3] = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const uint32_t indices[6] = {first, first + 1, first + 2, first, first + 2, first + 3}, loop[4] = {first, first + 1, first + 2, first + 3};
    builder_item item = {
        .indices = indices, .index_count = 6, .polygon_triangles = &two, .polygon_count = 1, .loop = loop, .loop_count = 4, .flags = CULL_ITEM_WALL};
    for (int k = 0; k < 3; ++k) {
        item.plane[k] = n[k] / length;
        item.plane[3] -= item.plane[k] * corners[0][k];
    }
    return scene_builder_item(b, &item);
}

// ---- Random scenes ----

static double on_grid(double metres)
{
    return floor(metres * 1024) / 1024;
}

enum { ZONES_MOST = 256 };

typedef struct maker {
    scene_builder *b;
    const zone_scene *z;
    uint64_t random;
    zone_box boxes[ZONES_MOST]; // of the first hulls made, relative to z->at
} maker;

// A box, or a box turned about y: then planes are not along the axes.
static void random_planes(maker *m, const zone_box *box, scene_solid_plane planes[6])
{
    const double yaw = random_below(&m->random, 2) ? 0 : random_between(&m->random, -0.5, 0.5);
    box_planes(box, planes);
    for (int p = 0; p < 6; ++p) {
        double *n = planes[p].normal, middle[3], reach = planes[p].distance;
        for (int k = 0; k < 3; ++k) {
            middle[k] = (box->min[k] + box->max[k]) / 2;
            reach -= n[k] * middle[k];
        }
        const double x = cos(yaw) * n[0] - sin(yaw) * n[2], z = sin(yaw) * n[0] + cos(yaw) * n[2];
        n[0] = x;
        n[2] = z;
        planes[p].distance = reach + (n[0] * (middle[0] + m->z->at[0]) + n[1] * (middle[1] + m->z->at[1]) + n[2] * (middle[2] + m->z->at[2]));
    }
}

static result add_random_zone(maker *m, uint32_t number, uint32_t offset)
{
    scene_solid_plane planes[2][6];
    uint32_t parent = number && random_below(&m->random, 3) == 0 ? random_below(&m->random, number) : SCENE_NONE;
    for (int k = 0; k < 3; ++k)
        if (parent != SCENE_NONE && m->boxes[parent].max[k] - m->boxes[parent].min[k] < 3) parent = SCENE_NONE; // too small to hold another
    const builder_hull hulls[2] = {{planes[0], 6}, {planes[1], 6}};
    char name[16];
    zone_box box;
    for (uint32_t h = 0; h < 2; ++h) {
        for (int k = 0; k < 3; ++k) {
            const double size = on_grid(random_between(&m->random, 4, 24));
            const zone_box *outer = parent == SCENE_NONE ? NULL : &m->boxes[parent];
            box.min[k] = outer ? outer->min[k] + 1 : on_grid(random_between(&m->random, -50, 50));
            box.max[k] = outer ? outer->max[k] - 1 : box.min[k] + size;
        }
        random_planes(m, &box, planes[h]);
        if (h == 0) m->boxes[number] = box;
    }
    snprintf(name, sizeof name, "zone %u", number);
    const builder_zone zone = {
        .name = name, .hulls = hulls, .hull_count = 1 + random_below(&m->random, 2), .parent = parent == SCENE_NONE ? SCENE_NONE : parent + offset};
    uint32_t id;
    const char *fault;
    return scene_builder_zone(m->b, &zone, &id, &fault);
}

static result add_random_item(maker *m)
{
    const zone_scene *z = m->z;
    const double reach = random_below(&m->random, 20) ? 2 : 30;
    double min[3], max[3];
    for (int k = 0; k < 3; ++k) {
        min[k] = z->at[k] + on_grid(random_between(&m->random, -60, 60));
        max[k] = min[k] + on_grid(random_between(&m->random, 0, reach));
    }
    return box_scene_add(m->b, min, max, NULL);
}

result zone_scene_fill(scene_builder *b, const zone_scene *z)
{
    maker m = {.b = b, .z = z, .random = z->seed};
    uint32_t id;
    result done = z->zones <= ZONES_MOST ? RESULT_OK : RESULT_BAD_INPUT;
    if (done == RESULT_OK && z->outside == OUTSIDE_FIRST) done = add_everywhere(b, "outside", &id);
    for (uint32_t i = 0; i < z->zones && done == RESULT_OK; ++i) done = add_random_zone(&m, i, z->outside == OUTSIDE_FIRST);
    if (z->outside == OUTSIDE_LAST && done == RESULT_OK) done = add_everywhere(b, "outside", &id);
    for (uint32_t i = 0; i < z->items && done == RESULT_OK; ++i) done = add_random_item(&m);
    return done;
}

result zone_scene_make(const zone_scene *z, const allocator *memory, report *r, scene **out)
{
    scene_builder *b;
    uint32_t id;
    result done = scene_builder_open(memory, &b);
    if (done != RESULT_OK) return done;
    done = scene_builder_material(b, "stone", 5, 0, &id);
    if (done == RESULT_OK) done = scene_builder_object(b, "boxes", 5, &id);
    if (done == RESULT_OK) done = zone_scene_fill(b, z);
    if (done == RESULT_OK) done = scene_builder_finish(b, "zones", r, out);
    scene_builder_close(b);
    return done;
}
