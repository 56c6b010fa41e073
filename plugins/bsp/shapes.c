// Items made ready for select: see shapes.h.
// SPDX-License-Identifier: MIT
#include "shapes.h"

#include <portcullis/box.h>

#include <math.h>
#include <string.h>

// ---- What a wall is clipped by ----

// Metres: how far a loop and what is drawn for it may be apart, of the zone's radius; see leaf_clip.h.
static const double LOOP_ROUNDING = 3.0 / 16777216;

static cull_vec3 loop_point(const cull_zone *zone, const cull_wall *wall, uint32_t i)
{
    return zone->positions[zone->wall_vertices[wall->first_vertex + i % wall->vertex_count]];
}

// Half the distance of the two planes along the wall's normal that have the loop between them.
static double loop_bend(const cull_zone *zone, const cull_wall *wall)
{
    const cull_vec3 n = zone->planes[wall->plane].normal;
    double low = 0, high = 0;
    for (uint32_t i = 0; i < wall->vertex_count; i++) {
        const cull_vec3 p = loop_point(zone, wall, i);
        const double height = ((double)n.x * (double)p.x + (double)n.y * (double)p.y) + (double)n.z * (double)p.z;
        if (i == 0 || height < low) low = height;
        if (i == 0 || height > high) high = height;
    }
    return (high - low) / 2;
}

static double distance_to_side(cull_vec3 p, cull_vec3 a, cull_vec3 b)
{
    const double along[3] = {(double)b.x - (double)a.x, (double)b.y - (double)a.y, (double)b.z - (double)a.z};
    const double to[3] = {(double)p.x - (double)a.x, (double)p.y - (double)a.y, (double)p.z - (double)a.z};
    const double square = (along[0] * along[0] + along[1] * along[1]) + along[2] * along[2];
    double t = (to[0] * along[0] + to[1] * along[1]) + to[2] * along[2], sum = 0;
    t = t <= 0 ? 0 : t >= square ? 1 : t / square;
    for (int i = 0; i < 3; i++) sum += (to[i] - t * along[i]) * (to[i] - t * along[i]);
    return sqrt(sum);
}

// The vertex is one of the loop's, or stands on a side.
static int is_in_loop(const cull_zone *zone, const cull_wall *wall, uint32_t position, double most)
{
    for (uint32_t i = 0; i < wall->vertex_count; i++)
        if (zone->wall_vertices[wall->first_vertex + i] == position) return 1;
    for (uint32_t i = 0; i < wall->vertex_count; i++)
        if (distance_to_side(zone->positions[position], loop_point(zone, wall, i), loop_point(zone, wall, i + 1)) <= most) return 1;
    return 0;
}

static shape_kind kind_of(const cull_zone *zone, uint32_t item)
{
    const cull_item *it = &zone->items[item];
    if (!(it->flags & CULL_ITEM_WALL) || !zone->walls || zone->walls[item].vertex_count < 3) return SHAPE_BOX;
    const cull_wall *wall = &zone->walls[item];
    const double most = LOOP_ROUNDING * (double)zone->radius - loop_bend(zone, wall);
    const shape_kind bent = it->index_count >= 3 ? SHAPE_TRIANGLES : SHAPE_BOX;
    if (!(most >= 0)) return bent;
    for (uint32_t i = 0; i < it->index_count; i++)
        if (!is_in_loop(zone, wall, zone->indices[it->first_index + i], most)) return bent;
    return SHAPE_LOOP;
}

// ---- Shapes ----

static shape_head head_of(const cull_zone *zone, uint32_t item)
{
    shape_head head = {kind_of(zone, item), 0, 1, 0};
    if (head.kind == SHAPE_LOOP) {
        head.vertex_count = zone->walls[item].vertex_count;
        head.lane_count = head.vertex_count / 4 + (head.vertex_count % 4 != 0);
    } else if (head.kind == SHAPE_TRIANGLES) {
        head.vertex_count = 3;
        head.lane_count = zone->items[item].index_count / 3;
    }
    return head;
}

// Units never outnumber items, wall vertices and indices together: what stands in memory four bytes each.
static void count_units(const cull_zone *zone, const uint32_t *order, bsp_shapes *out)
{
    for (uint32_t place = 0; place < zone->item_count; place++) {
        const shape_head head = head_of(zone, order[place]);
        out->firsts[place] = out->unit_count;
        out->unit_count += (uint32_t)((sizeof head + head.lane_count * sizeof(bsp_lane) + SHAPE_UNIT - 1) / SHAPE_UNIT);
        if (head.vertex_count > out->most_vertices) out->most_vertices = head.vertex_count;
        if (head.kind == SHAPE_TRIANGLES) out->bent_count++;
    }
}

static void put_vertex(cull_vec3 p, bsp_lane *lanes, uint32_t at)
{
    lanes[at / 4].x[at % 4] = p.x;
    lanes[at / 4].y[at % 4] = p.y;
    lanes[at / 4].z[at % 4] = p.z;
}

static void fill_shape(const cull_zone *zone, uint32_t item, bsp_shape *out)
{
    const shape_head head = head_of(zone, item);
    out->head = head;
    if (head.kind == SHAPE_BOX) {
        const cull_box box = cull_box_at(&zone->boxes, item);
        out->lanes[0] = (bsp_lane){{box.min.x, box.min.y, box.min.z, 0}, {box.max.x, box.max.y, box.max.z, 0}, {0, 0, 0, 0}};
        return;
    }
    for (uint32_t at = 0; at < head.lane_count * 4; at++) {
        if (head.kind == SHAPE_LOOP) put_vertex(loop_point(zone, &zone->walls[item], at < head.vertex_count ? at : head.vertex_count - 1), out->lanes, at);
        else put_vertex(zone->positions[zone->indices[zone->items[item].first_index + at / 4 * 3 + (at % 4 < 3 ? at % 4 : 2)]], out->lanes, at);
    }
}

static size_t at_least_one(uint32_t count)
{
    return count ? count : 1;
}

static size_t unit_bytes(const bsp_shapes *s)
{
    return ((size_t)s->unit_count + 1) * SHAPE_UNIT;
}

cull_result shapes_build(const cull_host *host, const cull_zone *zone, const uint32_t *order, bsp_shapes *out)
{
    memset(out, 0, sizeof *out);
    out->item_count = zone->item_count;
    out->firsts = host->alloc(host, at_least_one(zone->item_count) * sizeof *out->firsts, 64);
    out->faces = host->alloc(host, at_least_one(zone->item_count) * sizeof *out->faces, 64);
    if (out->firsts && out->faces) {
        count_units(zone, order, out);
        out->units = host->alloc(host, unit_bytes(out), SHAPE_UNIT);
    }
    if (!out->units) {
        shapes_free(host, out);
        return CULL_ERR_MEMORY;
    }
    memset(out->units, 0, unit_bytes(out));
    for (uint32_t place = 0; place < zone->item_count; place++) {
        out->faces[place] = cull_face_of(zone, order[place]);
        fill_shape(zone, order[place], (bsp_shape *)(void *)(out->units + (size_t)out->firsts[place] * SHAPE_UNIT));
    }
    return CULL_OK;
}

void shapes_free(const cull_host *host, bsp_shapes *s)
{
    if (s->firsts) host->free(host, s->firsts, at_least_one(s->item_count) * sizeof *s->firsts);
    if (s->faces) host->free(host, s->faces, at_least_one(s->item_count) * sizeof *s->faces);
    if (s->units) host->free(host, s->units, unit_bytes(s));
    memset(s, 0, sizeof *s);
}

size_t shapes_bytes(const bsp_shapes *s)
{
    return s->item_count * (sizeof *s->firsts + sizeof *s->faces) + (size_t)s->unit_count * SHAPE_UNIT;
}
