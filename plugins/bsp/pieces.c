// Pieces of walls, held against planes and cut: see pieces.h.
// SPDX-License-Identifier: MIT
#include "pieces.h"

#include <math.h>

static double point_height(const bsp_plane *plane, cull_point p)
{
    return ((plane->normal[0] * p.x + plane->normal[1] * p.y) + plane->normal[2] * p.z) + plane->offset;
}

// ---- A piece's own figures ----

static double loop_area(const cull_point *points, uint32_t count) // of a fan about the first point
{
    double n[3] = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < count; i++) {
        const cull_point a = points[0], b = points[i], c = points[i + 1];
        const double u[3] = {b.x - a.x, b.y - a.y, b.z - a.z}, v[3] = {c.x - a.x, c.y - a.y, c.z - a.z};
        for (int k = 0; k < 3; k++) n[k] += u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    }
    return 0.5 * sqrt((n[0] * n[0] + n[1] * n[1]) + n[2] * n[2]);
}

static void piece_measure(const piece_set *set, bsp_piece *piece)
{
    const cull_point *points = piece_points(set, piece);
    double low[3] = {points[0].x, points[0].y, points[0].z}, high[3] = {points[0].x, points[0].y, points[0].z};
    for (uint32_t i = 1; i < piece->point_count; i++) {
        const double p[3] = {points[i].x, points[i].y, points[i].z};
        for (int k = 0; k < 3; k++) {
            if (p[k] < low[k]) low[k] = p[k];
            if (p[k] > high[k]) high[k] = p[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        piece->middle[k] = 0.5 * (low[k] + high[k]);
        piece->half[k] = 0.5 * (high[k] - low[k]);
    }
    piece->area = loop_area(points, piece->point_count);
}

// ---- From the zone ----

static int wall_to_piece(const cull_zone *zone, uint32_t item, piece_set *set)
{
    const cull_wall *wall = &zone->walls[item];
    bsp_piece *piece = vector_push(&set->pieces, 1);
    cull_point *points = piece ? vector_push(&set->points, wall->vertex_count) : NULL;
    if (!points) return 0;
    for (uint32_t i = 0; i < wall->vertex_count; i++) {
        const cull_vec3 p = zone->positions[zone->wall_vertices[wall->first_vertex + i]];
        points[i] = (cull_point){(double)p.x, (double)p.y, (double)p.z};
    }
    piece->item = item;
    piece->plane = set->table->wall_planes[item];
    piece->first_point = set->points.count - wall->vertex_count;
    piece->point_count = wall->vertex_count;
    piece_measure(set, piece);
    return 1;
}

cull_result piece_set_make(const cull_host *host, const cull_zone *zone, const plane_table *table, piece_set *out)
{
    piece_set set = {table, vector_make(host, sizeof(bsp_piece)), vector_make(host, sizeof(cull_point)), vector_make(host, sizeof(double))};
    for (uint32_t i = 0; i < zone->item_count; i++) {
        if (table->wall_planes[i] == BSP_NONE || wall_to_piece(zone, i, &set)) continue;
        piece_set_free(&set);
        return CULL_ERR_MEMORY;
    }
    *out = set;
    return CULL_OK;
}

void piece_set_free(piece_set *set)
{
    vector_free(&set->pieces);
    vector_free(&set->points);
    vector_free(&set->heights);
}

// ---- Against a plane ----

static piece_side facing_side(const plane_table *table, uint32_t piece_plane, uint32_t plane)
{
    return cull_normals_dot_sign(&plane_at(table, piece_plane)->exact, &plane_at(table, plane)->exact) < 0 ? PIECE_ON_BACK : PIECE_ON_FRONT;
}

piece_side piece_side_of(const piece_set *set, uint32_t number, uint32_t plane_number)
{
    const bsp_piece *piece = piece_at(set, number);
    const bsp_plane *plane = plane_at(set->table, plane_number);
    const double slack = set->table->slack, height = plane_height(plane, piece->middle);
    if (piece->plane == plane_number) return PIECE_ON_FRONT;
    if (piece->plane == plane_twin(set->table, plane_number)) return PIECE_ON_BACK;
    const double half = (fabs(plane->normal[0]) * piece->half[0] + fabs(plane->normal[1]) * piece->half[1]) + fabs(plane->normal[2]) * piece->half[2];
    if (height - half > slack) return PIECE_FRONT;
    if (height + half < -slack) return PIECE_BACK;
    const cull_point *points = piece_points(set, piece);
    int is_front = 0, is_back = 0;
    for (uint32_t i = 0; i < piece->point_count && !(is_front && is_back); i++) {
        const double h = point_height(plane, points[i]);
        is_front |= h > slack;
        is_back |= h < -slack;
    }
    if (is_front) return is_back ? PIECE_SPANS : PIECE_FRONT;
    return is_back ? PIECE_BACK : facing_side(set->table, piece->plane, plane_number);
}

// ---- Cutting ----

static int heights_fill(piece_set *set, const bsp_piece *piece, const bsp_plane *plane)
{
    set->heights.count = 0;
    double *heights = vector_push(&set->heights, piece->point_count);
    if (!heights) return 0;
    const cull_point *points = piece_points(set, piece);
    for (uint32_t i = 0; i < piece->point_count; i++) {
        const double h = point_height(plane, points[i]);
        heights[i] = fabs(h) <= set->table->slack ? 0 : h;
    }
    return 1;
}

// One part: the points where sign * height >= 0, and the points between. The cut is always made from front to back.
static int part_make(piece_set *set, uint32_t number, double sign, uint32_t *out)
{
    const bsp_piece from = *piece_at(set, number);
    const uint32_t first = set->points.count;
    cull_point *to = vector_push(&set->points, 2 * from.point_count);
    bsp_piece *part = to ? vector_push(&set->pieces, 1) : NULL;
    if (!part) return 0;
    const cull_point *points = piece_points(set, &from);
    const double *heights = set->heights.items;
    uint32_t count = 0;
    for (uint32_t i = 0; i < from.point_count; i++) {
        const uint32_t j = i + 1 < from.point_count ? i + 1 : 0;
        if (sign * heights[i] >= 0) to[count++] = points[i];
        if (heights[i] > 0 && heights[j] < 0) to[count++] = cull_cut_between(points[i], heights[i], points[j], heights[j]);
        if (heights[i] < 0 && heights[j] > 0) to[count++] = cull_cut_between(points[j], heights[j], points[i], heights[i]);
    }
    set->points.count = first + count;
    *part = from;
    part->first_point = first;
    part->point_count = count;
    piece_measure(set, part);
    *out = set->pieces.count - 1;
    return 1;
}

int piece_cut(piece_set *set, uint32_t piece, uint32_t plane, uint32_t parts[2])
{
    if (!heights_fill(set, piece_at(set, piece), plane_at(set->table, plane))) return 0;
    return part_make(set, piece, 1, &parts[0]) && part_make(set, piece, -1, &parts[1]);
}
