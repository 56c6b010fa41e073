// What sinks down the tree: walls as loops in double, items that are no walls as boxes, zone portals with a plane in whole numbers.
// SPDX-License-Identifier: MIT
//
// Invariant: every item is one piece. A portal takes the plane of a wall where all its points lie within slack of it, else one of its
// own; that plane only cuts space and says which openings the portal shuts, so its rounding loses nothing.
#include "cells_build.h"

#include <math.h>

static const double NORMAL_SCALE = 68719476736; // 2^36: the largest number of a portal's own normal

// ---- Items ----

typedef struct items { uint32_t *places, *planes; } items; // by the zone's own numbers: the cells do not depend on the tree's order

static cells_status wall_add(cells_build *b, bsp_vector *out, const items *all, uint32_t item)
{
    const cull_wall *wall = &b->zone->walls[item];
    const cells_piece made = {.item = all->places[item], .plane = all->planes[item], .first_point = b->points.count, .point_count = wall->vertex_count};
    cull_point *to = vector_push(&b->points, wall->vertex_count);
    if (!to) return CELLS_NO_MEMORY;
    for (uint32_t i = 0; i < wall->vertex_count; i++) {
        const cull_vec3 p = b->zone->positions[b->zone->wall_vertices[wall->first_vertex + i]];
        to[i] = (cull_point){(double)p.x, (double)p.y, (double)p.z};
    }
    return vector_add(out, &made) ? CELLS_FINE : CELLS_NO_MEMORY;
}

static cells_status items_add(cells_build *b, bsp_vector *out, const items *all)
{
    cells_status status = CELLS_FINE;
    for (uint32_t item = 0; item < b->tree->item_count && status == CELLS_FINE; item++)
        if (all->planes[item] != BSP_NONE) status = wall_add(b, out, all, item);
    for (uint32_t item = 0; item < b->tree->item_count && status == CELLS_FINE; item++) {
        const cells_piece box = {.item = all->places[item], .plane = BSP_NONE, .flags = PIECE_BOX};
        if (all->planes[item] == BSP_NONE && !vector_add(out, &box)) status = CELLS_NO_MEMORY;
    }
    return status;
}

// As the tree filed them: one that has points nowhere goes by its box.
static void items_read(const cells_build *b, items *all)
{
    const bsp_tree *tree = b->tree;
    for (uint32_t place = 0; place < tree->item_count; place++) {
        all->places[tree->order[place]] = place;
        all->planes[place] = BSP_NONE;
    }
    for (uint32_t i = 0; i < tree->entry_count; i++) {
        const bsp_entry *e = &tree->entries[i];
        const uint32_t item = tree->order[e->item];
        if (e->point_count == 0 || e->plane >= tree->plane_count || !b->zone->walls) continue;
        if (b->zone->walls[item].vertex_count >= 3) all->planes[item] = e->plane;
    }
}

// ---- Portals ----

static double farthest_from(const bsp_plane *plane, const cull_portal *portal)
{
    double most = 0;
    for (uint32_t i = 0; i < portal->point_count; i++) {
        const cull_vec3 p = portal->points[i];
        const cull_point at = {(double)p.x, (double)p.y, (double)p.z};
        const double height = fabs(cells_height(plane, at));
        if (!(height <= most)) most = height;
    }
    return most;
}

// The nearest of the tree's planes that all points lie within slack of; BSP_NONE: none.
static uint32_t wall_plane_of(cells_build *b, const cull_portal *portal)
{
    uint32_t best = BSP_NONE;
    double least = b->slack;
    b->work += b->tree->plane_count;
    for (uint32_t i = 0; i < b->tree->plane_count; i++) {
        const bsp_plane *plane = cells_plane(b, i);
        const double along = fabs((plane->normal[0] * (double)portal->plane.normal.x + plane->normal[1] * (double)portal->plane.normal.y) +
                                  plane->normal[2] * (double)portal->plane.normal.z);
        if (!(along > 0.5)) continue;
        const double far = farthest_from(plane, portal);
        if (!(far < least)) continue;
        least = far;
        best = i;
    }
    return best;
}

// Through the middle of its points, its normal that of their areas in whole numbers; 0: no area. Off by NORMAL_SCALE's rounding alone:
// 1.5 * 2^-36 of the distance from the zone's origin, far below slack, which is at least 2^-25 of the radius.
static int own_plane_of(const cells_build *b, const cull_portal *portal, cull_wide_plane *out)
{
    double n[3] = {0, 0, 0}, middle[3] = {0, 0, 0}, most = 0, sum = 0;
    for (uint32_t i = 0; i < portal->point_count; i++) {
        const cull_vec3 at = portal->points[i], to = portal->points[i + 1 < portal->point_count ? i + 1 : 0], first = portal->points[0];
        const double p[3] = {(double)at.x - (double)first.x, (double)at.y - (double)first.y, (double)at.z - (double)first.z};
        const double q[3] = {(double)to.x - (double)first.x, (double)to.y - (double)first.y, (double)to.z - (double)first.z};
        for (int k = 0; k < 3; k++) n[k] += p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3];
        middle[0] += (double)at.x / portal->point_count;
        middle[1] += (double)at.y / portal->point_count;
        middle[2] += (double)at.z / portal->point_count;
    }
    for (int k = 0; k < 3; k++)
        if (fabs(n[k]) > most) most = fabs(n[k]);
    if (!(most > 0)) return 0;
    for (int k = 0; k < 3; k++) {
        const double whole = n[k] / most * NORMAL_SCALE;
        out->normal[k] = (int64_t)(whole < 0 ? whole - 0.5 : whole + 0.5);
        sum += (double)out->normal[k] * (middle[k] * b->steps_per_metre);
    }
    out->offset = cull_wide_from((int64_t)-sum); // below 3 * 2^36 * 2^25
    *out = cull_wide_plane_reduced(*out);
    return 1;
}

static bsp_plane plane_in_metres(const cells_build *b, cull_wide_plane exact)
{
    const cull_row row = cull_row_of(&exact);
    const double length = sqrt((row.n[0] * row.n[0] + row.n[1] * row.n[1]) + row.n[2] * row.n[2]);
    const bsp_plane out = {exact, {row.n[0] / length, row.n[1] / length, row.n[2] / length}, row.offset / length / b->steps_per_metre};
    return out;
}

// Looks into the zone. BSP_NONE with CELLS_FINE: the portal has no area.
static cells_status portal_plane(cells_build *b, const cull_portal *portal, uint32_t *out)
{
    const double into[3] = {(double)portal->plane.normal.x, (double)portal->plane.normal.y, (double)portal->plane.normal.z};
    const uint32_t wall = wall_plane_of(b, portal);
    bsp_plane made;
    *out = BSP_NONE;
    if (wall != BSP_NONE) made = *cells_plane(b, wall);
    else {
        cull_wide_plane exact;
        if (!own_plane_of(b, portal, &exact)) return CELLS_FINE;
        made = plane_in_metres(b, exact);
    }
    if ((made.normal[0] * into[0] + made.normal[1] * into[1]) + made.normal[2] * into[2] < 0) made = plane_in_metres(b, cull_wide_plane_flipped(made.exact));
    *out = b->planes.count;
    return vector_add(&b->planes, &made) ? CELLS_FINE : CELLS_NO_MEMORY;
}

static cells_status portal_add(cells_build *b, bsp_vector *out, uint32_t index)
{
    const cull_portal *portal = &b->zone->portals[index];
    cells_piece made = {.item = index, .first_point = b->points.count, .point_count = portal->point_count, .flags = PIECE_PORTAL};
    cells_status status = portal_plane(b, portal, &made.plane);
    if (status != CELLS_FINE) return status;
    if (made.plane == BSP_NONE) {
        b->host->log(b->host, CULL_LOG_WARN, "bsp: a zone portal has no area: its cells are not told, nothing is seen through it");
        return CELLS_FINE;
    }
    cull_point *to = vector_push(&b->points, portal->point_count);
    if (!to) return CELLS_NO_MEMORY;
    for (uint32_t i = 0; i < portal->point_count; i++) {
        const cull_vec3 p = portal->points[i];
        to[i] = (cull_point){(double)p.x, (double)p.y, (double)p.z};
    }
    return vector_add(out, &made) ? CELLS_FINE : CELLS_NO_MEMORY;
}

cells_status cells_gather(cells_build *b, bsp_vector *out)
{
    bsp_vector numbers = vector_make(b->host, 2 * sizeof(uint32_t));
    uint32_t *both = vector_reserve(&numbers, b->tree->item_count + 1);
    cells_status status = both ? CELLS_FINE : CELLS_NO_MEMORY;
    if (both) {
        items all = {both, both + b->tree->item_count};
        items_read(b, &all);
        for (uint32_t i = 0; i < b->zone->portal_count && status == CELLS_FINE; i++) status = portal_add(b, out, i);
        if (status == CELLS_FINE) status = items_add(b, out, &all);
    }
    vector_free(&numbers);
    return status;
}
