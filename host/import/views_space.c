// Free space: see views_space.h. A solid's surface is found again from its planes, so its distance is exact.
// SPDX-License-Identifier: MIT
#include "views_space.h"

#include "map_brush.h"
#include "views_distance.h"

#include <math.h>
#include <string.h>

enum { CELLS_MOST = 1 << 22, AXIS_CELLS_MOST = 1024, PART_CELLS_MOST = 4096 };
static const double SOLID_TOLERANCE = 1.0 / 8192; // metres: the 1/256 unit with which map brushes are cut

typedef enum part_kind { PART_SOLID, PART_BOX, PART_TRIANGLE } part_kind;

typedef struct space_part {
    double min[3], max[3];
    uint32_t kind, what; // part_kind, SPACE_*
    uint32_t first, count;           // triangles
    uint32_t first_plane, plane_count; // solids
} space_part;

struct free_space {
    const allocator *memory;
    double origin[3], zone_from_origin[3];
    buffer parts, triangles, planes; // space_part, double[3][3], scene_solid_plane
    buffer wide;                     // uint32_t: parts over too many cells to list in each
    buffer cell_first, cell_parts;   // uint32_t
    double low[3], high[3], cell_size[3];
    uint32_t cells[3];
};

// ---- Parts ----

static int add_part(free_space *space, const space_part *part)
{
    space_part *p = buffer_append(&space->parts, part, 1);
    if (!p || part->kind == PART_BOX || part->kind == PART_SOLID) return p != NULL;
    const double(*t)[3] = (const double(*)[3])space->triangles.items + (size_t)part->first * 3;
    for (int k = 0; k < 3; ++k) {
        p->min[k] = fmin(fmin(t[0][k], t[1][k]), t[2][k]);
        p->max[k] = fmax(fmax(t[0][k], t[1][k]), t[2][k]);
    }
    return 1;
}

static int add_solid_surface(free_space *space, const brush_body *body)
{
    const brush_loop *loops = body->loops.items;
    const uint32_t *corners = body->corners.items;
    const brush_vertex *vertices = body->vertices.items;
    for (size_t l = 0; l < body->loops.count; ++l)
        for (uint32_t i = 1; i + 1 < loops[l].count; ++i) {
            const uint32_t ids[3] = {corners[loops[l].first], corners[loops[l].first + i], corners[loops[l].first + i + 1]};
            double(*t)[3] = buffer_push(&space->triangles, 1);
            if (!t) return 0;
            for (int c = 0; c < 3; ++c) memcpy(t[c], vertices[ids[c]].position, sizeof t[c]);
        }
    return 1;
}

static int add_solid(free_space *space, const scene *s, const scene_solid *solid, brush_body *body, buffer *cutting)
{
    const double *origin = space->origin;
    const uint32_t first_plane = (uint32_t)space->planes.count, first = (uint32_t)space->triangles.count;
    scene_solid_plane *planes = buffer_append(&space->planes, s->solid_planes + solid->first_plane, solid->plane_count);
    cutting->count = 0;
    brush_plane *cuts = planes ? buffer_push(cutting, solid->plane_count) : NULL;
    if (!cuts) return 0;
    for (uint32_t i = 0; i < solid->plane_count; ++i) {
        const double *n = planes[i].normal;
        planes[i].distance -= n[0] * origin[0] + n[1] * origin[1] + n[2] * origin[2];
        cuts[i] = brush_plane_from_unit(n, planes[i].distance);
    }
    double reach = 1;
    for (int k = 0; k < 3; ++k) reach = fmax(reach, 4 * fmax(fabs(solid->min[k] - origin[k]), fabs(solid->max[k] - origin[k])) + 1);
    const brush_fault fault = brush_body_cut(body, cuts, solid->plane_count, reach, SOLID_TOLERANCE);
    if (fault == BRUSH_NO_MEMORY || (fault == BRUSH_SOUND && !add_solid_surface(space, body))) return 0;
    space_part part = {.kind = PART_SOLID,
                       .what = solid->kind == SOLID_LIQUID ? SPACE_LIQUIDS : SPACE_SOLIDS,
                       .first = first,
                       .count = (uint32_t)space->triangles.count - first,
                       .first_plane = first_plane,
                       .plane_count = solid->plane_count};
    for (int k = 0; k < 3; ++k) {
        part.min[k] = solid->min[k] - origin[k];
        part.max[k] = solid->max[k] - origin[k];
    }
    return add_part(space, &part);
}

static int add_solids(free_space *space, const scene *s)
{
    brush_body body = brush_body_make(space->memory);
    buffer cutting = buffer_make(space->memory, sizeof(brush_plane));
    int good = 1;
    for (uint32_t i = 0; i < s->solid_count && good; ++i) good = add_solid(space, s, &s->solids[i], &body, &cutting);
    buffer_free(&cutting);
    brush_body_free(&body);
    return good;
}

static int add_triangles(free_space *space, const scene *s, const scene_item *item)
{
    for (uint32_t i = item->first_index; i < item->first_index + item->index_count; i += 3) {
        const space_part part = {.kind = PART_TRIANGLE, .what = SPACE_TRIANGLES, .first = (uint32_t)space->triangles.count, .count = 1};
        double(*t)[3] = buffer_push(&space->triangles, 1);
        if (!t) return 0;
        for (uint32_t c = 0; c < 3; ++c) {
            const cull_vec3 p = s->positions[s->indices[i + c]];
            t[c][0] = p.x + space->zone_from_origin[0];
            t[c][1] = p.y + space->zone_from_origin[1];
            t[c][2] = p.z + space->zone_from_origin[2];
        }
        if (!add_part(space, &part)) return 0;
    }
    return 1;
}

static int add_items(free_space *space, const scene *s)
{
    for (uint32_t i = 0; i < s->item_count; ++i) {
        const scene_item *item = &s->items[i];
        if (item->flags & CULL_ITEM_SEE_THROUGH) continue;
        int good = 1;
        if (item->flags & CULL_ITEM_BOX) {
            const double *move = space->zone_from_origin;
            const space_part box = {.min = {s->boxes.min_x[i] + move[0], s->boxes.min_y[i] + move[1], s->boxes.min_z[i] + move[2]},
                                    .max = {s->boxes.max_x[i] + move[0], s->boxes.max_y[i] + move[1], s->boxes.max_z[i] + move[2]},
                                    .kind = PART_BOX,
                                    .what = SPACE_BOXES};
            good = add_part(space, &box);
        } else good = add_triangles(space, s, item);
        if (!good) return 0;
    }
    return 1;
}

// ---- The grid ----

typedef struct cell_range { uint32_t from[3], to[3]; } cell_range;

static uint32_t cell_of(const free_space *space, double x, int k)
{
    const double cell = floor((x - space->low[k]) / space->cell_size[k]);
    if (!(cell > 0)) return 0;
    return cell < space->cells[k] - 1 ? (uint32_t)cell : space->cells[k] - 1;
}

static cell_range cells_of(const free_space *space, const double min[3], const double max[3])
{
    cell_range r;
    for (int k = 0; k < 3; ++k) {
        r.from[k] = cell_of(space, min[k], k);
        r.to[k] = cell_of(space, max[k], k);
    }
    return r;
}

static uint64_t range_size(const cell_range *r)
{
    return (uint64_t)(r->to[0] - r->from[0] + 1) * (r->to[1] - r->from[1] + 1) * (r->to[2] - r->from[2] + 1);
}

static size_t cell_index(const free_space *space, uint32_t x, uint32_t y, uint32_t z)
{
    return ((size_t)z * space->cells[1] + y) * space->cells[0] + x;
}

static void shape_grid(free_space *space)
{
    const space_part *parts = space->parts.items;
    double *high = space->high;
    for (int k = 0; k < 3; ++k) {
        space->low[k] = INFINITY;
        high[k] = -INFINITY;
        for (size_t i = 0; i < space->parts.count; ++i) {
            space->low[k] = fmin(space->low[k], parts[i].min[k]);
            high[k] = fmax(high[k], parts[i].max[k]);
        }
    }
    double least = 1e-3, volume = 1; // metres: a flat scene has cells all the same
    for (int k = 0; k < 3; ++k) least = fmax(least, (high[k] - space->low[k]) / AXIS_CELLS_MOST);
    for (int k = 0; k < 3; ++k) volume *= fmax(high[k] - space->low[k], least);
    const double wanted = fmin(CELLS_MOST / 8, 64 + 2 * (double)space->parts.count);
    const double size = fmax(cbrt(volume / wanted), least);
    for (int k = 0; k < 3; ++k) {
        const double count = ceil((high[k] - space->low[k]) / size);
        space->cells[k] = count < 1 ? 1 : count > AXIS_CELLS_MOST ? AXIS_CELLS_MOST : (uint32_t)count;
        space->cell_size[k] = size;
    }
}

typedef enum list_pass { LIST_COUNT, LIST_FILL } list_pass;

static int list_part(free_space *space, uint32_t number, list_pass pass)
{
    const space_part *p = (const space_part *)space->parts.items + number;
    const cell_range r = cells_of(space, p->min, p->max);
    if (range_size(&r) > PART_CELLS_MOST) return pass == LIST_FILL || buffer_append(&space->wide, &number, 1);
    uint32_t *first = space->cell_first.items, *to = space->cell_parts.items;
    for (uint32_t z = r.from[2]; z <= r.to[2]; ++z)
        for (uint32_t y = r.from[1]; y <= r.to[1]; ++y)
            for (uint32_t x = r.from[0]; x <= r.to[0]; ++x) {
                uint32_t *cell = &first[cell_index(space, x, y, z)];
                if (pass == LIST_COUNT) ++*cell;
                else to[--*cell] = number;
            }
    return 1;
}

// Counts, sums them so that each cell holds its end, then fills downwards: the ends become the firsts.
static int build_grid(free_space *space)
{
    shape_grid(space);
    const size_t cells = (size_t)space->cells[0] * space->cells[1] * space->cells[2];
    uint32_t *first = buffer_push(&space->cell_first, cells + 1);
    if (!first) return 0;
    memset(first, 0, (cells + 1) * sizeof *first);
    for (uint32_t i = 0; i < space->parts.count; ++i)
        if (!list_part(space, i, LIST_COUNT)) return 0;
    uint64_t sum = 0;
    for (size_t c = 0; c <= cells; ++c) {
        sum += first[c];
        first[c] = (uint32_t)sum;
    }
    if (sum > UINT32_MAX || !buffer_push(&space->cell_parts, (size_t)sum + 1)) return 0;
    for (uint32_t i = 0; i < space->parts.count; ++i) list_part(space, i, LIST_FILL);
    return 1;
}

result free_space_open(const scene *s, const double origin[3], const allocator *memory, free_space **out)
{
    free_space *space = memory_alloc_zeroed(memory, 1, sizeof *space);
    if (!space) return RESULT_NO_MEMORY;
    space->memory = memory;
    for (int k = 0; k < 3; ++k) {
        space->origin[k] = origin[k];
        space->zone_from_origin[k] = s->whole.origin[k] - origin[k];
    }
    space->parts = buffer_make(memory, sizeof(space_part));
    space->triangles = buffer_make(memory, 9 * sizeof(double));
    space->planes = buffer_make(memory, sizeof(scene_solid_plane));
    space->wide = buffer_make(memory, sizeof(uint32_t));
    space->cell_first = buffer_make(memory, sizeof(uint32_t));
    space->cell_parts = buffer_make(memory, sizeof(uint32_t));
    if (!add_solids(space, s) || !add_items(space, s) || !build_grid(space)) {
        free_space_close(space);
        return RESULT_NO_MEMORY;
    }
    *out = space;
    return RESULT_OK;
}

void free_space_close(free_space *space)
{
    if (!space) return;
    buffer *const all[] = {&space->parts, &space->triangles, &space->planes, &space->wide, &space->cell_first, &space->cell_parts};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    memory_free(space->memory, space, 1, sizeof *space);
}

// ---- Distance ----

static double part_distance(const free_space *space, const space_part *part, const double p[3], double most)
{
    const double to_box = distance_to_box(p, part->min, part->max);
    if (to_box >= most || part->kind == PART_BOX) return to_box;
    if (part->kind == PART_SOLID) {
        const scene_solid_plane *planes = (const scene_solid_plane *)space->planes.items + part->first_plane;
        double farthest = -INFINITY; // of the planes: no more than the distance itself
        for (uint32_t i = 0; i < part->plane_count; ++i)
            farthest = fmax(farthest, planes[i].normal[0] * p[0] + planes[i].normal[1] * p[1] + planes[i].normal[2] * p[2] - planes[i].distance);
        if (farthest <= 0) return 0;
        if (farthest >= most || part->count == 0) return farthest;
    }
    const double(*t)[3] = (const double(*)[3])space->triangles.items + (size_t)part->first * 3;
    double least = most;
    for (uint32_t i = 0; i < part->count; ++i) least = fmin(least, distance_to_triangle(p, t + (size_t)i * 3));
    return least;
}

static double nearest_of(const free_space *space, const uint32_t *numbers, size_t count, const double p[3], double most, uint32_t what)
{
    const space_part *parts = space->parts.items;
    for (size_t i = 0; i < count; ++i)
        if (parts[numbers[i]].what & what) most = fmin(most, part_distance(space, &parts[numbers[i]], p, most));
    return most;
}

double free_space_clearance(const free_space *space, const double p[3], double most, uint32_t what)
{
    double min[3], max[3];
    for (int k = 0; k < 3; ++k) {
        min[k] = p[k] - most;
        max[k] = p[k] + most;
        if (min[k] > space->high[k] || max[k] < space->low[k]) return most; // beside everything
    }
    const cell_range r = cells_of(space, min, max);
    const uint32_t *first = space->cell_first.items, *listed = space->cell_parts.items;
    double least = nearest_of(space, space->wide.items, space->wide.count, p, most, what);
    for (uint32_t z = r.from[2]; z <= r.to[2]; ++z)
        for (uint32_t y = r.from[1]; y <= r.to[1]; ++y)
            for (uint32_t x = r.from[0]; x <= r.to[0]; ++x) {
                const size_t cell = cell_index(space, x, y, z);
                least = nearest_of(space, listed + first[cell], first[cell + 1] - first[cell], p, least, what);
            }
    return least;
}

// ---- Inside a mesh or not ----

typedef struct axis_hit { double distance; int is_back; } axis_hit;

// How far along the ray the box's side that faces its start lies; INFINITY where it starts within, beyond or beside.
static double box_along_axis(const double p[3], axis_ray ray, const space_part *box)
{
    for (int k = 0; k < 3; ++k)
        if (k != ray.axis && (p[k] < box->min[k] || p[k] > box->max[k])) return INFINITY;
    const double at = ray.sign > 0 ? box->min[ray.axis] - p[ray.axis] : p[ray.axis] - box->max[ray.axis];
    return at >= 0 ? at : INFINITY;
}

typedef struct axis_search { const double *from; axis_ray ray; uint32_t what; } axis_search; // what: SPACE_TRIANGLES and SPACE_BOXES only

static void hit_parts(const free_space *space, const uint32_t *numbers, size_t count, const axis_search *q, axis_hit *hit)
{
    const space_part *parts = space->parts.items;
    for (size_t i = 0; i < count; ++i) {
        const space_part *part = &parts[numbers[i]];
        double facing = 0, at;
        if (!(part->what & q->what) || part->kind == PART_SOLID) continue;
        if (part->kind == PART_BOX) at = box_along_axis(q->from, q->ray, part);
        else at = distance_along_axis(q->from, q->ray, (const double(*)[3])space->triangles.items + (size_t)part->first * 3, &facing);
        if (at >= hit->distance) continue;
        *hit = (axis_hit){at, facing > 0};
    }
}

static axis_hit first_hit(const free_space *space, const axis_search *q)
{
    const double *p = q->from;
    const axis_ray ray = q->ray;
    axis_hit hit = {INFINITY, 0};
    uint32_t cell[3];
    for (int k = 0; k < 3; ++k) cell[k] = cell_of(space, p[k], k);
    hit_parts(space, space->wide.items, space->wide.count, q, &hit);
    const uint32_t *first = space->cell_first.items, *listed = space->cell_parts.items;
    for (;;) {
        const size_t c = cell_index(space, cell[0], cell[1], cell[2]);
        hit_parts(space, listed + first[c], first[c + 1] - first[c], q, &hit);
        const double border = space->low[ray.axis] + (cell[ray.axis] + (ray.sign > 0)) * space->cell_size[ray.axis];
        if (hit.distance <= (border - p[ray.axis]) * ray.sign) return hit; // nothing nearer lies behind this cell
        if (cell[ray.axis] == (ray.sign > 0 ? space->cells[ray.axis] - 1 : 0)) return hit;
        cell[ray.axis] += ray.sign > 0 ? 1 : UINT32_MAX;
    }
}

int free_space_is_enclosed(const free_space *space, const double p[3])
{
    int backs = 0, fronts = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (int sign = -1; sign <= 1; sign += 2) {
            const axis_hit hit = first_hit(space, &(axis_search){p, {axis, sign}, SPACE_TRIANGLES});
            if (isinf(hit.distance)) continue;
            if (hit.is_back) ++backs;
            else ++fronts;
        }
    return backs > fronts;
}

double free_space_ground(const free_space *space, const double p[3])
{
    const axis_hit hit = first_hit(space, &(axis_search){p, {1, -1}, SPACE_TRIANGLES | SPACE_BOXES});
    return hit.is_back ? INFINITY : hit.distance;
}

double free_space_along(const free_space *space, const double p[3], axis_ray ray)
{
    return first_hit(space, &(axis_search){p, ray, SPACE_TRIANGLES | SPACE_BOXES}).distance;
}
