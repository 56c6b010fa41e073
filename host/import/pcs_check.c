// Checks of a scene that no builder made, its geometry: everything that scene.h promises, in the order in which one check
// needs the next; pcs_check_zones.c and pcs_check_motion.c hold the rest.
// SPDX-License-Identifier: MIT
// Invariant: what can be found again is found again, by the builder's own code, and must be equal to the last bit.
#include "pcs.h"
#include "pcs_check.h"

#include "../core/scene_finish.h"

#include <portcullis/box.h>

#include <math.h>
#include <string.h>

static const double STEP_LEAST = 0x1p-64, STEP_MOST = 0x1p-10; // as scene_builder_finish chooses it
static const double STEPS_MOST = 0x1p24;                       // float's mantissa
static const double ORIGIN_MOST = 1e9 + 1;                     // metres: of coordinates up to 1e9, to the next whole metre
static const double WALL_PLANE_MOST = 1.0 / 64;                // metres: a wall's vertex from its plane; importers' walls stay below
static const double WALL_PLANE_SHARE = 1.0 / 32768;            // of the scene's radius, on top: readers take walls flat to 4e-6 of their size
static const double EXACT_PLANE_MOST = 1.0 / 64;               // metres: an exact plane from the same in float
static const double EXACT_NORMAL_MOST = 1e-5;                  // cosine: the same of their normals

static const double TANGENT_UNIT = 1.0 / 128;                  // of its square: components of 10 bits

int check_finite(const double *v, int count)
{
    int finite = 1;
    for (int i = 0; i < count; ++i) finite &= isfinite(v[i]) != 0;
    return finite;
}

int check_unit(const double v[3])
{
    return fabs(((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]) - 1) < CHECK_UNIT; // false of NaN
}

int check_on_step(const scene *s, double relative)
{
    const double steps = relative / s->step; // exact: a power of two
    return fabs(steps) <= STEPS_MOST && finish_round(steps) == steps;
}

static const char *check_whole(const scene *s)
{
    int exponent;
    if (!(s->step >= STEP_LEAST && s->step <= STEP_MOST) || frexp(s->step, &exponent) != 0.5) return "its step is no power of two from 2^-64 to 2^-10 m";
    for (int k = 0; k < 3; ++k)
        if (!(fabs(s->whole.origin[k]) <= ORIGIN_MOST) || floor(s->whole.origin[k]) != s->whole.origin[k]) return "its origin is not whole metres";
    if (s->is_map > 1) return "it is neither a map nor none";
    if (s->flat_triangles > s->index_count / 3) return "it has more flat triangles than triangles";
    return NULL;
}

static const char *check_vertices(const scene *s)
{
    for (uint32_t i = 0; i < s->position_count; ++i) {
        const cull_vec3 p = s->positions[i];
        if (!check_on_step(s, (double)p.x) || !check_on_step(s, (double)p.y) || !check_on_step(s, (double)p.z))
            return "a vertex that is not on the scene's step, or too far out";
        if (s->normals[i] >> 24) return "a normal of over three bytes";
        if (s->vertex_materials[i] >= s->material_count) return "a vertex of a material that is not there";
    }
    for (size_t i = 0; s->texcoords && i < 2 * (size_t)s->position_count; ++i)
        if (!isfinite(s->texcoords[i])) return "a texture coordinate that is not finite";
    for (uint32_t i = 0; i < s->index_count; ++i)
        if (s->indices[i] >= s->position_count) return "a triangle of a vertex that is not there";
    return NULL;
}

// Of each vertex that needs one: a unit vector and a sign. Texture coordinates are there too.
static const char *check_tangents(const scene *s)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->position_count; ++i) count += (s->materials[s->vertex_materials[i]].flags & MATERIAL_NORMAL_MAP) != 0;
    if (count != s->tangent_count) return "tangents that are not those of its normal maps";
    if (count && !s->texcoords) return "a normal map without texture coordinates";
    for (uint32_t i = 0; i < count; ++i) {
        double v[3];
        int turn;
        scene_tangent_unpack(s->tangents[i], v, &turn);
        if (!turn || !(fabs((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2] - 1) < TANGENT_UNIT)) return "a tangent that is no unit vector";
    }
    return NULL;
}

static const char *check_one_item(const scene *s, const scene_item *item, uint32_t index, uint32_t polygon)
{
    if (item->first_index != index || item->index_count == 0 || item->index_count % 3 || item->index_count > s->index_count - index)
        return "items whose triangles do not follow each other";
    if (item->first_polygon != polygon || item->polygon_count == 0 || item->polygon_count > s->polygon_count - polygon)
        return "items whose polygons do not follow each other";
    if (s->polygon_first_triangle[polygon] != index / 3) return "an item whose polygons are not its triangles";
    if (item->material >= s->material_count || item->object >= s->object_count) return "an item of a material or object that is not there";
    return item->flags >> 5 ? "an item with flags that nobody knows" : NULL;
}

static const char *check_items(const scene *s)
{
    uint32_t index = 0, polygon = 0;
    for (uint32_t i = 0; i < s->item_count + s->mover_count; ++i) {
        const char *fault = check_one_item(s, &s->items[i], index, polygon);
        if (fault) return fault;
        index += s->items[i].index_count;
        polygon += s->items[i].polygon_count;
    }
    if (index != s->index_count || polygon != s->polygon_count) return "triangles or polygons of no item";
    if (s->polygon_first_triangle[polygon] != index / 3) return "polygons that are not its triangles";
    for (uint32_t p = 0; p < polygon; ++p)
        if (s->polygon_first_triangle[p] > s->polygon_first_triangle[p + 1]) return "polygons whose triangles do not rise";
    return NULL;
}

static int same_box(cull_box a, cull_box b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static const char *check_boxes(const scene *s)
{
    cull_box all = cull_box_none();
    for (uint32_t i = 0; i < s->item_count + s->mover_count; ++i) {
        const cull_box box = finish_item_box(s, &s->items[i]);
        if (!same_box(box, cull_box_at(&s->boxes, i))) return "a box that is not its item's";
        all = cull_box_union(all, box);
    }
    if (!same_box(all, s->whole.box)) return "a box of everything that is not";
    float radius = cull_box_radius(all);
    for (uint32_t p = 0; p < s->portal_point_count; ++p)
        for (int k = 0; k < 3; ++k) radius = fmaxf(radius, fabsf((float)(s->portal_points[p][k] - s->whole.origin[k])));
    return radius == s->whole.radius ? NULL : "a radius that is not its largest coordinate";
}

static const char *check_groups(const scene *s)
{
    if (s->material_count == 0 || s->material_count > UINT16_MAX || s->object_count == 0) return "no material or object, or too many materials";
    for (uint32_t i = 0; i < s->material_count; ++i)
        if (s->materials[i].flags & ~(uint32_t)(MATERIAL_TRANSLUCENT | MATERIAL_CUT_OUT | MATERIAL_SKY | MATERIAL_NORMAL_MAP)) return "a material with flags that nobody knows";
    for (uint32_t i = 0; i < s->object_count; ++i)
        if (s->objects[i].first_item > s->item_count || s->objects[i].item_count > s->item_count - s->objects[i].first_item)
            return "an object of items that are not there";
    for (uint32_t i = 0; i < s->item_count; ++i) {
        const scene_object *o = &s->objects[s->items[i].object];
        if (i < o->first_item || i - o->first_item >= o->item_count) return "an item outside of its object";
    }
    return NULL;
}

// ---- Walls ----

static double height_over(const scene *s, const cull_plane *p, uint32_t vertex)
{
    const cull_vec3 v = s->positions[vertex], n = p->normal;
    return (((double)n.x * (double)v.x + (double)n.y * (double)v.y) + (double)n.z * (double)v.z) + (double)p->offset;
}

static const char *check_wall(const scene *s, uint32_t item, uint32_t first)
{
    const cull_wall *w = &s->walls[item];
    if (w->first_vertex != first || w->vertex_count > s->wall_vertex_count - first || w->reserved) return "walls whose vertices do not follow each other";
    if ((w->vertex_count != 0) != ((s->items[item].flags & CULL_ITEM_WALL) != 0)) return "a wall without the flag, or the flag without a wall";
    if (!w->vertex_count) return w->plane ? "a plane of no wall" : NULL;
    if (w->vertex_count < 3 || w->plane >= s->plane_count) return "a wall of under 3 vertices, or of a plane that is not there";
    const double most = WALL_PLANE_MOST + WALL_PLANE_SHARE * (double)s->whole.radius + 16 * s->step;
    for (uint32_t i = first; i < first + w->vertex_count; ++i) {
        if (s->wall_vertices[i] >= s->position_count) return "a wall of a vertex that is not there";
        if (!(fabs(height_over(s, &s->planes[w->plane], s->wall_vertices[i])) <= most)) return "a wall's vertex that lies off its plane";
    }
    return NULL;
}

static const char *check_plane(const scene *s, uint32_t plane)
{
    const cull_plane *p = &s->planes[plane];
    const double n[3] = {(double)p->normal.x, (double)p->normal.y, (double)p->normal.z};
    if (!check_unit(n) || !isfinite(p->offset)) return "a wall's plane without a unit normal";
    if (!s->exact_planes) return NULL;
    const cull_exact_plane *e = &s->exact_planes[plane];
    const double m[3] = {(double)e->normal[0], (double)e->normal[1], (double)e->normal[2]};
    const double length = sqrt((m[0] * m[0] + m[1] * m[1]) + m[2] * m[2]);
    const double cosine = ((m[0] * n[0] + m[1] * n[1]) + m[2] * n[2]) / length;
    if (!(cosine > 1 - EXACT_NORMAL_MOST)) return "an exact plane that faces another way than its plane";
    if (!(fabs((double)e->offset / (length * s->grid_steps_per_metre) - (double)p->offset) <= EXACT_PLANE_MOST + 16 * s->step))
        return "an exact plane that lies elsewhere than its plane";
    return NULL;
}

static const char *check_walls(const scene *s)
{
    if (s->exact_planes ? !(s->grid_steps_per_metre > 0 && isfinite(s->grid_steps_per_metre)) : s->grid_steps_per_metre != 0)
        return "a grid without exact planes, or these without a grid";
    for (uint32_t i = 0; i < s->plane_count; ++i) {
        const char *fault = check_plane(s, i);
        if (fault) return fault;
    }
    uint32_t vertices = 0;
    for (uint32_t i = 0; i < s->item_count; ++i) {
        if (!s->walls && s->items[i].flags & CULL_ITEM_WALL) return "the flag of a wall without a wall";
        if (!s->walls) continue;
        const char *fault = check_wall(s, i, vertices);
        if (fault) return fault;
        vertices += s->walls[i].vertex_count;
    }
    return vertices == s->wall_vertex_count ? NULL : "vertices of no wall";
}

const char *check_geometry(const scene *s)
{
    static const char *(*const checks[])(const scene *) = {check_whole, check_vertices, check_items, check_boxes, check_groups, check_tangents, check_walls};
    const char *fault = NULL;
    for (size_t i = 0; i < sizeof checks / sizeof *checks && !fault; ++i) fault = checks[i](s);
    return fault;
}

// Each item in as many zones as its entry says, in one at least; zone_items is checked already.
static result check_listings(const scene *s, const allocator *memory, const char **fault)
{
    uint8_t *listed = memory_alloc_zeroed(memory, s->item_count, 1);
    if (!listed) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < s->zone_item_count; ++i) {
        uint8_t *times = &listed[s->zone_items[i]];
        if (*times < UINT8_MAX) ++*times;
    }
    for (uint32_t i = 0; i < s->item_count; ++i)
        if (!listed[i] || listed[i] != s->listings[i]) *fault = "an item that no zone lists, or fewer or more zones than it says";
    memory_free(memory, listed, s->item_count, 1);
    return RESULT_OK;
}

result pcs_check(const scene *s, const allocator *memory, const char **fault)
{
    *fault = check_geometry(s);
    if (!*fault) *fault = check_motion(s);
    if (!*fault) *fault = check_zones(s);
    return *fault ? RESULT_OK : check_listings(s, memory, fault);
}
