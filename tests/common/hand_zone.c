// Zones made by hand: see hand_zone.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "hand_zone.h"

#include <portcullis/plane.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void give_up(const char *what)
{
    fprintf(stderr, "hand_zone: %s\n", what);
    abort();
}

static void *some(size_t count, size_t size)
{
    void *p = calloc(count ? count : 1, size);
    if (!p) give_up("no memory");
    return p;
}

static float *row_of(uint32_t count) // 64-byte aligned, as cull_boxes are
{
    const size_t bytes = ((size_t)count + CULL_PADDING) * sizeof(float);
    void *p = NULL;
    if (posix_memalign(&p, 64, bytes) != 0) give_up("no memory");
    memset(p, 0, bytes);
    return p;
}

void hand_zone_open(hand_zone *z, uint32_t items_most, uint32_t vertices_most)
{
    memset(z, 0, sizeof *z);
    z->items_most = items_most;
    z->vertices_most = vertices_most;
    z->items = some(items_most, sizeof *z->items);
    z->walls = some(items_most, sizeof *z->walls);
    z->planes = some(items_most, sizeof *z->planes);
    z->exact = some(items_most, sizeof *z->exact);
    z->positions = some(vertices_most, sizeof *z->positions);
    z->wall_vertices = some(vertices_most, sizeof *z->wall_vertices);
    z->indices = some((size_t)vertices_most * 3, sizeof *z->indices);
    for (int i = 0; i < 6; i++) z->rows[i] = row_of(items_most);
}

void hand_zone_init(hand_zone *z)
{
    hand_zone_open(z, HAND_MOST, 8 * HAND_MOST);
}

void hand_zone_free(hand_zone *z)
{
    void *const all[] = {z->items, z->walls, z->planes, z->exact, z->positions, z->wall_vertices, z->indices};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
    for (int i = 0; i < 6; i++) free(z->rows[i]);
    memset(z, 0, sizeof *z);
}

static uint32_t item_add(hand_zone *z, cull_box box, uint32_t flags)
{
    const float rows[6] = {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
    if (z->zone.item_count == z->items_most) give_up("too many items");
    const uint32_t item = z->zone.item_count++;
    z->items[item] = (cull_item){.first_index = z->zone.index_count, .polygon_count = 1, .flags = flags};
    for (int i = 0; i < 6; i++) z->rows[i][item] = rows[i];
    return item;
}

static cull_plane plane_through(const cull_vec3 *points, uint32_t count) // Newell
{
    double n[3] = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++) {
        const cull_vec3 a = points[i], b = points[i + 1 < count ? i + 1 : 0];
        n[0] += ((double)a.y - (double)b.y) * ((double)a.z + (double)b.z);
        n[1] += ((double)a.z - (double)b.z) * ((double)a.x + (double)b.x);
        n[2] += ((double)a.x - (double)b.x) * ((double)a.y + (double)b.y);
    }
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), by = length > 0 ? 1 / length : 0;
    for (int i = 0; i < 3; i++) n[i] *= by;
    const double offset = -(n[0] * (double)points[0].x + n[1] * (double)points[0].y + n[2] * (double)points[0].z);
    return (cull_plane){{(float)n[0], (float)n[1], (float)n[2]}, (float)offset};
}

uint32_t hand_zone_wall(hand_zone *z, const cull_vec3 *points, uint32_t count, uint32_t flags)
{
    const uint32_t first = z->zone.wall_vertex_count, position = z->zone.position_count;
    cull_box box = cull_box_none();
    if (count > z->vertices_most || position > z->vertices_most - count) give_up("too many vertices");
    for (uint32_t i = 0; i < count; i++) {
        z->positions[position + i] = points[i];
        z->wall_vertices[first + i] = position + i;
        box = cull_box_with_point(box, points[i]);
    }
    const uint32_t item = item_add(z, box, flags | CULL_ITEM_WALL);
    for (uint32_t i = 2; i < count; i++) {
        const uint32_t fan[3] = {position, position + i - 1, position + i};
        memcpy(z->indices + z->zone.index_count, fan, sizeof fan);
        z->zone.index_count += 3;
    }
    z->items[item].index_count = z->zone.index_count - z->items[item].first_index;
    z->walls[item] = (cull_wall){first, count, z->zone.plane_count, 0};
    z->planes[z->zone.plane_count++] = plane_through(points, count);
    z->zone.wall_vertex_count += count;
    z->zone.position_count += count;
    return item;
}

uint32_t hand_zone_cluster(hand_zone *z, cull_box box)
{
    return item_add(z, box, CULL_ITEM_BOX);
}

void hand_zone_portal(hand_zone *z, const cull_vec3 *points, uint32_t count)
{
    const uint32_t p = z->zone.portal_count;
    if (p == HAND_PORTALS_MOST || count > HAND_PORTAL_POINTS_MOST) give_up("too many portals, or points of one");
    memcpy(z->portal_points[p], points, count * sizeof *points);
    z->portals[p] = (cull_portal){.points = z->portal_points[p], .plane = plane_through(points, count), .point_count = count};
    z->zone.portal_count++;
}

void hand_zone_box(hand_zone *z, cull_box box, hand_face face, uint32_t flags)
{
    const float c[2][3] = {{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}};
    for (int axis = 0; axis < 3; axis++)
        for (int high = 0; high < 2; high++) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            static const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}; // counterclockwise against +axis
            cull_vec3 points[4];
            for (int i = 0; i < 4; i++) {
                float p[3];
                p[axis] = c[high][axis];
                p[u] = c[around[i][0]][u];
                p[v] = c[around[i][1]][v];
                points[high == (face == FACE_OUT) ? i : 3 - i] = (cull_vec3){p[0], p[1], p[2]};
            }
            hand_zone_wall(z, points, 4, flags);
        }
}

void hand_zone_end(hand_zone *z)
{
    cull_zone *out = &z->zone;
    cull_box box = cull_box_none();
    out->items = z->items;
    out->boxes = (cull_boxes){z->rows[0], z->rows[1], z->rows[2], z->rows[3], z->rows[4], z->rows[5]};
    out->positions = z->positions;
    out->indices = z->indices;
    out->walls = out->plane_count ? z->walls : NULL;
    out->wall_vertices = z->wall_vertices;
    out->planes = z->planes;
    out->portals = z->portals;
    for (uint32_t i = 0; i < out->item_count; i++) box = cull_box_union(box, cull_box_at(&out->boxes, i));
    for (uint32_t i = 0; i < out->portal_count; i++)
        for (uint32_t k = 0; k < out->portals[i].point_count; k++) box = cull_box_with_point(box, out->portals[i].points[k]);
    if (out->item_count + out->portal_count == 0) box = (cull_box){{0, 0, 0}, {0, 0, 0}};
    out->box = box;
    out->radius = cull_box_radius(box);
}
