// Zones made of walls, and a host that counts memory: see tree_fixture.h.
// SPDX-License-Identifier: MIT
#include "tree_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- The host ----

static void *host_alloc(const cull_host *host, size_t size, size_t align)
{
    tree_host *h = host->user;
    return h->memory.memory.alloc(h->memory.memory.user, size, align);
}

static void host_free(const cull_host *host, void *memory, size_t size)
{
    tree_host *h = host->user;
    if (memory) h->memory.memory.free(h->memory.memory.user, memory, size);
}

static void host_log(const cull_host *host, cull_log_level level, const char *message)
{
    tree_host *h = host->user;
    (void)level;
    h->lines++;
    snprintf(h->last_line, sizeof h->last_line, "%s", message);
}

static void host_parallel_for(const cull_host *host, void (*task)(void *, uint32_t), void *context, uint32_t count)
{
    (void)host;
    for (uint32_t i = 0; i < count; i++) task(context, i);
}

static const void *host_get_extension(const cull_host *host, const cull_zone *zone, const char *id)
{
    (void)host;
    (void)zone;
    (void)id;
    return NULL;
}

void tree_host_init(tree_host *h, uint64_t fail_at)
{
    memset(h, 0, sizeof *h);
    failing_allocator_init(&h->memory, fail_at);
    h->memory.memory.user = &h->memory;
    h->host = (cull_host){CULL_ABI, h, host_alloc, host_free, host_log, host_parallel_for, host_get_extension};
}

// ---- Zones ----

static void *must_alloc(size_t count, size_t size)
{
    void *memory = calloc(count + 1, size);
    if (!memory) abort();
    return memory;
}

void made_zone_open(made_zone *z, uint32_t items_most, uint32_t vertices_most)
{
    memset(z, 0, sizeof *z);
    z->item_capacity = items_most;
    z->vertex_capacity = vertices_most;
    z->items = must_alloc(items_most, sizeof *z->items);
    z->walls = must_alloc(items_most, sizeof *z->walls);
    z->planes = must_alloc(items_most, sizeof *z->planes);
    z->exact = must_alloc(items_most, sizeof *z->exact);
    z->positions = must_alloc(vertices_most, sizeof *z->positions);
    z->wall_vertices = must_alloc(vertices_most, sizeof *z->wall_vertices);
    z->indices = must_alloc((size_t)vertices_most * 3, sizeof *z->indices);
    for (int row = 0; row < 6; row++) z->rows[row] = must_alloc((size_t)items_most + CULL_PADDING, sizeof(float));
}

void made_zone_free(made_zone *z)
{
    void *const all[] = {z->items, z->walls, z->planes, z->exact, z->positions, z->wall_vertices, z->indices};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
    for (int row = 0; row < 6; row++) free(z->rows[row]);
    memset(z, 0, sizeof *z);
}

static uint32_t item_add(made_zone *z, cull_box box, uint32_t flags)
{
    const uint32_t item = z->zone.item_count++;
    if (item >= z->item_capacity) abort();
    const float c[6] = {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
    for (int row = 0; row < 6; row++) z->rows[row][item] = c[row];
    z->items[item] = (cull_item){.first_index = z->zone.index_count, .polygon_count = 1, .flags = flags};
    return item;
}

uint32_t made_zone_cluster(made_zone *z, cull_box box)
{
    return item_add(z, box, CULL_ITEM_BOX);
}

static void loop_fan(made_zone *z, uint32_t item, uint32_t first, uint32_t count)
{
    for (uint32_t i = 1; i + 1 < count; i++) {
        const uint32_t corners[3] = {first, first + i, first + i + 1};
        memcpy(z->indices + z->zone.index_count, corners, sizeof corners);
        z->zone.index_count += 3;
        z->items[item].index_count += 3;
    }
}

uint32_t made_zone_points(made_zone *z, const cull_vec3 *points, uint32_t count)
{
    cull_box box = cull_box_none();
    double n[3] = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++) {
        const cull_vec3 a = points[i], b = points[i + 1 < count ? i + 1 : 0];
        box = cull_box_with_point(box, a);
        n[0] += ((double)a.y - (double)b.y) * ((double)a.z + (double)b.z);
        n[1] += ((double)a.z - (double)b.z) * ((double)a.x + (double)b.x);
        n[2] += ((double)a.x - (double)b.x) * ((double)a.y + (double)b.y);
    }
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 0)) n[1] = length = 1;
    const uint32_t item = item_add(z, box, CULL_ITEM_WALL), first = z->zone.position_count;
    if (first + count > z->vertex_capacity) abort();
    for (uint32_t i = 0; i < count; i++) {
        z->positions[first + i] = points[i];
        z->wall_vertices[first + i] = first + i;
    }
    z->zone.position_count += count;
    z->zone.wall_vertex_count += count;
    loop_fan(z, item, first, count);
    const cull_vec3 normal = {(float)(n[0] / length), (float)(n[1] / length), (float)(n[2] / length)};
    const double offset = -((double)normal.x * (double)points[0].x + (double)normal.y * (double)points[0].y + (double)normal.z * (double)points[0].z);
    z->walls[item] = (cull_wall){first, count, z->zone.plane_count, 0};
    z->planes[z->zone.plane_count++] = (cull_plane){normal, (float)offset};
    return item;
}

static int loop_plane(const grid_loop *loop, cull_exact_plane *out) // 0: the points lie on one line
{
    cull_wide_plane wide;
    for (uint32_t i = 1; i + 1 < loop->count; i++)
        if (cull_wide_plane_through(loop->p[0], loop->p[i], loop->p[i + 1], &wide)) return cull_exact_plane_from_wide(&wide, out);
    return 0;
}

uint32_t made_zone_wall(made_zone *z, const grid_loop *loop)
{
    cull_vec3 points[8];
    for (uint32_t i = 0; i < loop->count; i++)
        points[i] = (cull_vec3){(float)loop->p[i][0] / STEPS_PER_METRE, (float)loop->p[i][1] / STEPS_PER_METRE, (float)loop->p[i][2] / STEPS_PER_METRE};
    const uint32_t item = made_zone_points(z, points, loop->count), plane = z->walls[item].plane;
    if (!loop_plane(loop, &z->exact[plane])) z->exact[plane] = (cull_exact_plane){{0, 1, 0}, -loop->p[0][1]};
    for (uint32_t p = 0; p < plane; p++) {
        if (memcmp(&z->exact[p], &z->exact[plane], sizeof *z->exact) != 0) continue;
        z->walls[item].plane = p;
        z->zone.plane_count--;
        break;
    }
    return item;
}

void made_zone_close(made_zone *z, zone_kind kind)
{
    cull_box all = cull_box_none();
    z->zone.items = z->items;
    z->zone.boxes = (cull_boxes){z->rows[0], z->rows[1], z->rows[2], z->rows[3], z->rows[4], z->rows[5]};
    for (uint32_t i = 0; i < z->zone.item_count; i++) all = cull_box_union(all, cull_box_at(&z->zone.boxes, i));
    if (z->zone.item_count == 0) all = (cull_box){{0, 0, 0}, {0, 0, 0}};
    z->zone.positions = z->positions;
    z->zone.indices = z->indices;
    z->zone.wall_vertices = z->wall_vertices;
    z->zone.planes = z->planes;
    z->zone.walls = z->zone.plane_count ? z->walls : NULL;
    z->zone.exact_planes = kind == ZONE_EXACT && z->zone.plane_count ? z->exact : NULL;
    z->zone.grid_steps_per_metre = z->zone.exact_planes ? STEPS_PER_METRE : 0;
    z->zone.box = all;
    z->zone.radius = cull_box_radius(all);
}

uint32_t made_zone_plan(made_zone *z, const int32_t w[4], int32_t height)
{
    const grid_loop loop = {{{w[0], 0, w[1]}, {w[2], 0, w[3]}, {w[2], height, w[3]}, {w[0], height, w[1]}}, 4}; // floor: x and z, y up
    return made_zone_wall(z, &loop);
}

void made_zone_box(made_zone *z, const int32_t low[3], const int32_t high[3], box_faces faces)
{
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int side = 0; side < 2; side++) {
            grid_loop loop = {.count = 4};
            for (int corner = 0; corner < 4; corner++) { // (u, v) counterclockwise seen along -axis
                const int at = (side == 1) == (faces == BOX_OUTWARD) ? corner : 3 - corner;
                int32_t *p = loop.p[at];
                p[axis] = side ? high[axis] : low[axis];
                p[u] = corner == 1 || corner == 2 ? high[u] : low[u];
                p[v] = corner >= 2 ? high[v] : low[v];
            }
            made_zone_wall(z, &loop);
        }
    }
}

static int32_t step_of(float metres)
{
    const double steps = (double)metres * STEPS_PER_METRE;
    if (steps != floor(steps)) abort();
    return (int32_t)steps;
}

static void point_move(const grid_motion *motion, const int32_t from[3], int32_t to[3])
{
    for (int row = 0; row < 3; row++) {
        int32_t sum = 0;
        for (int k = 0; k < 3; k++) sum += motion->matrix[row][k] * from[k];
        if (sum % motion->divisor) abort();
        to[row] = sum / motion->divisor + motion->move[row];
    }
}

void made_zone_moved(const made_zone *from, const grid_motion *motion, zone_kind kind, made_zone *out)
{
    made_zone_open(out, from->item_capacity, from->vertex_capacity);
    for (uint32_t i = 0; i < from->zone.item_count; i++) {
        const cull_wall *wall = &from->walls[i];
        grid_loop loop = {.count = wall->vertex_count};
        if (wall->vertex_count == 0 || wall->vertex_count > 8) abort();
        for (uint32_t k = 0; k < wall->vertex_count; k++) {
            const cull_vec3 p = from->positions[from->wall_vertices[wall->first_vertex + k]];
            const int32_t at[3] = {step_of(p.x), step_of(p.y), step_of(p.z)};
            point_move(motion, at, loop.p[k]);
        }
        made_zone_wall(out, &loop);
    }
    made_zone_close(out, kind);
}
