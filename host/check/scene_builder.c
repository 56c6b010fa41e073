// Items to a zone: see scene_builder.h.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "scene_builder.h"
#include "process.h"

#include <portcullis/box.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

static void *must_have(void *memory)
{
    if (!memory) process_fail_now("no memory for the check itself; end other programs and try again");
    return memory;
}

scene_builder *builder_open(void)
{
    return must_have(calloc(1, sizeof(scene_builder)));
}

static cull_item *item_add(scene_builder *b, cull_box box, uint32_t flags)
{
    cull_item *item = &b->items[b->item_count];
    *item = (cull_item){.first_index = b->index_count, .polygon_count = 1, .flags = flags};
    b->boxes[b->item_count++] = box;
    return item;
}

static int has_room(const scene_builder *b, uint32_t points)
{
    return b->item_count < BUILDER_ITEMS_MOST && b->position_count + points <= BUILDER_POINTS_MOST && b->index_count + 3 * points <= 3 * BUILDER_POINTS_MOST;
}

static cull_box box_of(const cull_vec3 *points, uint32_t count)
{
    cull_box box = cull_box_none();
    for (uint32_t i = 0; i < count; ++i) box = cull_box_with_point(box, points[i]);
    return box;
}

// The faces of a box, counterclockwise from outside.
static void box_face(cull_box box, int axis, int high, cull_vec3 out[4])
{
    static const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const float c[2][3] = {{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}};
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < 4; ++i) {
        float *p = &out[high ? i : 3 - i].x;
        p[axis] = c[high][axis];
        p[u] = c[around[i][0]][u];
        p[v] = c[around[i][1]][v];
    }
}

static void fan(scene_builder *b, cull_item *item, uint32_t first, uint32_t count)
{
    for (uint32_t i = 2; i < count; ++i) {
        const uint32_t triangle[3] = {first, first + i - 1, first + i};
        memcpy(b->indices + b->index_count, triangle, sizeof triangle);
        b->index_count += 3;
    }
    item->index_count = b->index_count - item->first_index;
}

static uint32_t points_add(scene_builder *b, const cull_vec3 *points, uint32_t count)
{
    memcpy(b->positions + b->position_count, points, count * sizeof *points);
    b->position_count += count;
    return b->position_count - count;
}

void builder_box(scene_builder *b, cull_box box)
{
    if (!has_room(b, 24)) return;
    cull_item *item = item_add(b, box, CULL_ITEM_BOX);
    for (int face = 0; face < 6; ++face) {
        cull_vec3 points[4];
        box_face(box, face / 2, face % 2, points);
        fan(b, item, points_add(b, points, 4), 4);
    }
    item->polygon_count = 6;
}

void builder_triangles(scene_builder *b, const cull_vec3 *points, uint32_t triangles, uint32_t flags)
{
    if (!has_room(b, 3 * triangles)) return;
    cull_item *item = item_add(b, box_of(points, 3 * triangles), flags);
    const uint32_t first = points_add(b, points, 3 * triangles);
    for (uint32_t t = 0; t < triangles; ++t) fan(b, item, first + 3 * t, 3);
    item->polygon_count = triangles;
}

static cull_plane plane_through(const cull_vec3 *points, uint32_t count) // Newell
{
    double n[3] = {0, 0, 0};
    for (uint32_t i = 0; i < count; ++i) {
        const cull_vec3 a = points[i], c = points[i + 1 < count ? i + 1 : 0];
        n[0] += ((double)a.y - (double)c.y) * ((double)a.z + (double)c.z);
        n[1] += ((double)a.z - (double)c.z) * ((double)a.x + (double)c.x);
        n[2] += ((double)a.x - (double)c.x) * ((double)a.y + (double)c.y);
    }
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), by = length > 0 ? 1 / length : 0;
    for (int i = 0; i < 3; ++i) n[i] *= by;
    const double offset = -(n[0] * (double)points[0].x + n[1] * (double)points[0].y + n[2] * (double)points[0].z);
    return (cull_plane){{(float)n[0], (float)n[1], (float)n[2]}, (float)offset};
}

void builder_wall(scene_builder *b, const cull_vec3 *points, uint32_t count, uint32_t flags)
{
    if (!has_room(b, count)) return;
    const uint32_t at = b->item_count;
    cull_item *item = item_add(b, box_of(points, count), flags | CULL_ITEM_WALL);
    const uint32_t first = points_add(b, points, count);
    fan(b, item, first, count);
    for (uint32_t i = 0; i < count; ++i) b->wall_vertices[b->wall_vertex_count + i] = first + i;
    const cull_plane plane = plane_through(points, count);
    b->walls[at] = (cull_wall){b->wall_vertex_count, count, b->wall_count, 0};
    b->wall_vertex_count += count;
    b->exact[b->wall_count] = (cull_exact_plane){{(int64_t)plane.normal.x, (int64_t)plane.normal.y, (int64_t)plane.normal.z}, (int64_t)plane.offset};
    b->planes[b->wall_count++] = plane;
}

void builder_walls(scene_builder *b, cull_box box, builder_face face, uint32_t flags)
{
    for (int k = 0; k < 6; ++k) {
        cull_vec3 points[4], turned[4];
        box_face(box, k / 2, k % 2, points);
        for (int i = 0; i < 4; ++i) turned[i] = points[face == FACE_OUT ? i : 3 - i];
        builder_wall(b, turned, 4, flags);
    }
}

// ---- The zone ----

static void *lay(made_scene *s, const void *from, size_t size, size_t padding, const char *name)
{
    fence *f = &s->arrays[s->array_count++];
    *f = fence_open(size + padding, padding ? 64 : 8, 0, name);
    must_have(f->memory);
    if (size) memcpy(f->memory, from, size);
    if (padding) memset((char *)f->memory + size, 0x7f, padding); // large numbers: of no meaning
    return f->memory;
}

static const float *lay_row(made_scene *s, const scene_builder *b, int at)
{
    static const char *const names[6] = {"memory behind boxes.min_x", "memory behind boxes.min_y", "memory behind boxes.min_z",
                                         "memory behind boxes.max_x", "memory behind boxes.max_y", "memory behind boxes.max_z"};
    float *row = must_have(calloc(b->item_count + 1u, sizeof *row));
    for (uint32_t i = 0; i < b->item_count; ++i) row[i] = (at < 3 ? &b->boxes[i].min.x : &b->boxes[i].max.x)[at % 3];
    const size_t size = b->item_count * sizeof *row, whole = (size + 63) / 64 * 64; // so that rows end at their page and start aligned
    const float *lent = lay(s, row, size, whole - size + CULL_PADDING * sizeof *row, names[at]);
    free(row);
    return lent;
}

static void oracle_make(const scene_builder *b, made_scene *s)
{
    s->triangle_count = b->index_count / 3;
    s->triangles = must_have(calloc(s->triangle_count + 1u, sizeof *s->triangles));
    s->boxes = must_have(calloc(b->item_count + 1u, sizeof *s->boxes));
    s->flags = must_have(calloc(b->item_count + 1u, sizeof *s->flags));
    s->first_triangle = must_have(calloc(b->item_count + 2u, sizeof *s->first_triangle));
    memcpy(s->boxes, b->boxes, b->item_count * sizeof *s->boxes);
    for (uint32_t i = 0; i < b->item_count; ++i) {
        s->flags[i] = b->items[i].flags;
        s->first_triangle[i] = b->items[i].first_index / 3;
        for (uint32_t t = 0; t < b->items[i].index_count / 3; ++t) {
            scene_triangle *to = &s->triangles[s->first_triangle[i] + t];
            to->item = i;
            for (uint32_t k = 0; k < 9; ++k) to->p[k / 3][k % 3] = (double)(&b->positions[b->indices[b->items[i].first_index + 3 * t + k / 3]].x)[k % 3];
        }
    }
    s->first_triangle[b->item_count] = s->triangle_count;
}

void builder_end(scene_builder *b, made_scene *s)
{
    cull_zone *z = &s->zone;
    z->item_count = b->item_count;
    z->position_count = b->position_count;
    z->index_count = b->index_count;
    z->items = lay(s, b->items, b->item_count * sizeof *b->items, 0, "memory behind zone.items");
    z->positions = lay(s, b->positions, b->position_count * sizeof *b->positions, 0, "memory behind zone.positions");
    z->indices = lay(s, b->indices, b->index_count * sizeof *b->indices, 0, "memory behind zone.indices");
    const float *rows[6];
    for (int i = 0; i < 6; ++i) rows[i] = lay_row(s, b, i);
    z->boxes = (cull_boxes){rows[0], rows[1], rows[2], rows[3], rows[4], rows[5]};
    if (b->wall_count) {
        z->wall_vertex_count = b->wall_vertex_count;
        z->plane_count = b->wall_count;
        z->walls = lay(s, b->walls, b->item_count * sizeof *b->walls, 0, "memory behind zone.walls");
        z->wall_vertices = lay(s, b->wall_vertices, b->wall_vertex_count * sizeof *b->wall_vertices, 0, "memory behind zone.wall_vertices");
        z->planes = lay(s, b->planes, b->wall_count * sizeof *b->planes, 0, "memory behind zone.planes");
        if (b->is_exact) z->exact_planes = lay(s, b->exact, b->wall_count * sizeof *b->exact, 0, "memory behind zone.exact_planes");
        z->grid_steps_per_metre = b->is_exact ? 1 : 0;
    }
    cull_box box = cull_box_none();
    for (uint32_t i = 0; i < b->item_count; ++i) box = cull_box_union(box, b->boxes[i]);
    z->box = b->item_count ? box : (cull_box){{0, 0, 0}, {0, 0, 0}};
    z->radius = cull_box_radius(z->box);
    oracle_make(b, s);
    s->hash = made_scene_hash(s);
    free(b);
}

uint64_t made_scene_hash(const made_scene *s)
{
    uint64_t hash = 0xcbf29ce484222325u; // FNV-1a
    for (uint32_t i = 0; i < s->array_count; ++i) {
        const unsigned char *bytes = s->arrays[i].memory;
        for (size_t k = 0; k < s->arrays[i].size; ++k) hash = (hash ^ bytes[k]) * 0x100000001b3u;
    }
    return hash;
}

void made_scene_protect(const made_scene *s)
{
    for (uint32_t i = 0; i < s->array_count; ++i) {
        const fence *f = &s->arrays[i];
        process_name_region(f->map, f->map_size - 4096, "the zone, which is lent to be read only");
        mprotect(f->map, f->map_size - 4096, PROT_READ);
    }
}

void made_scene_free(made_scene *s)
{
    for (uint32_t i = 0; i < s->array_count; ++i) fence_close(&s->arrays[i]);
    free(s->triangles);
    free(s->boxes);
    free(s->flags);
    free(s->first_triangle);
    *s = (made_scene){0};
}
