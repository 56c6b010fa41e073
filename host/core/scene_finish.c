// Scene builder, the end: origin, rounding to a common step, boxes, plane ids, hash.
// SPDX-License-Identifier: MIT
// Invariant: every relative coordinate is a multiple of scene.step and exact in float, so no later sum of origin and
// position depends on who computes it.
#include "exact_plane.h"
#include "scene_finish.h"

#include <portcullis/box.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

static const double ZONE_RADIUS_MOST = 16384; // metres: float steps of 2^-10 m, just under 1 mm
static const int STEP_LOG2_LEAST = -64;       // 5e-20 m: in a scene of no size the squares of coordinates stay in float
static const double COORDINATE_MOST = 1e9;    // metres: beyond, doubles no longer hold a tenth of a micrometre
enum { STEPS_LOG2 = 24 };                     // float's mantissa: coordinates up to 2^24 steps are exact

// Rounds |v| < 2^51 to the nearest integer, ties to even: the sum has no bits below one. A library call each is slower.
double finish_round(double v)
{
    const double shift = 6755399441055744.0; // 1.5 * 2^52
    return (v + shift) - shift;
}

void *finish_take(finish *f, size_t count, size_t item_size)
{
    void *memory = f->failed ? NULL : arena_push(&f->s->memory, count, item_size);
    if (!memory) f->failed = 1;
    return memory;
}

void *finish_copy(finish *f, const buffer *from)
{
    void *to = finish_take(f, from->count, from->item_size);
    if (to && from->count) memcpy(to, from->items, from->count * from->item_size);
    return to;
}

const char *finish_text(finish *f, const char *text)
{
    const char *copy = f->failed ? NULL : arena_text(&f->s->memory, text, strlen(text));
    if (!copy) f->failed = 1;
    return copy;
}

static void find_bounds(finish *f)
{
    const buffer *const all[] = {&f->b->positions, &f->b->gate_points};
    for (int k = 0; k < 3; ++k) {
        f->low[k] = INFINITY;
        f->high[k] = -INFINITY;
    }
    for (int a = 0; a < 2; ++a) {
        const double(*p)[3] = all[a]->items;
        for (size_t i = 0; i < all[a]->count; ++i)
            for (int k = 0; k < 3; ++k) {
                f->low[k] = p[i][k] < f->low[k] ? p[i][k] : f->low[k];
                f->high[k] = p[i][k] > f->high[k] ? p[i][k] : f->high[k];
            }
    }
}

double finish_origin(double middle)
{
    return floor(middle + 0.5); // not to even: halves round alike wherever the scene lies
}

finish_frame finish_frame_of(const double low[3], const double high[3])
{
    finish_frame f = {.radius = 0};
    for (int k = 0; k < 3; ++k) {
        f.origin[k] = finish_origin((low[k] + high[k]) / 2);
        f.radius = fmax(f.radius, fmax(high[k] - f.origin[k], f.origin[k] - low[k]));
    }
    int exponent;
    if (frexp(f.radius, &exponent) == 0.5) exponent--; // 2^24 steps themselves are exact
    f.step = ldexp(1, exponent - STEPS_LOG2 > STEP_LOG2_LEAST ? exponent - STEPS_LOG2 : STEP_LOG2_LEAST);
    return f;
}

static result choose_origin(finish *f, const char *path, report *r)
{
    for (int k = 0; k < 3; ++k)
        if (f->low[k] < -COORDINATE_MOST || f->high[k] > COORDINATE_MOST)
            return report_error(r, path, 0, "a coordinate beyond 1e9 m; move the scene nearer to its origin");
    const finish_frame frame = finish_frame_of(f->low, f->high);
    if (frame.radius > ZONE_RADIUS_MOST)
        return report_error(r, path, 0, "the scene is %.0f m wide; one zone holds 32,768 m at 1 mm, so split or scale it", 2 * frame.radius);
    memcpy(f->s->whole.origin, frame.origin, sizeof f->s->whole.origin);
    f->s->step = frame.step;
    return RESULT_OK;
}

static void round_positions(finish *f)
{
    scene *s = f->s;
    const double(*from)[3] = f->b->positions.items;
    const double steps = 1 / s->step;
    s->position_count = (uint32_t)f->b->positions.count;
    s->positions = finish_take(f, s->position_count, sizeof *s->positions);
    if (f->failed) return;
    for (uint32_t i = 0; i < s->position_count; ++i) {
        double to[3];
        for (int k = 0; k < 3; ++k) to[k] = finish_round((from[i][k] - s->whole.origin[k]) * steps) * s->step + 0.0;
        s->positions[i] = (cull_vec3){(float)to[0], (float)to[1], (float)to[2]};
    }
}

static void join_streams(finish *f)
{
    scene *s = f->s;
    const builder_stream *streams[] = {&f->b->statics, &f->b->movers};
    s->item_count = (uint32_t)streams[0]->items.count;
    s->mover_count = (uint32_t)streams[1]->items.count;
    s->index_count = (uint32_t)(streams[0]->indices.count + streams[1]->indices.count);
    s->polygon_count = (uint32_t)(streams[0]->polygon_triangles.count + streams[1]->polygon_triangles.count);
    s->items = finish_take(f, s->item_count + s->mover_count, sizeof *s->items);
    s->indices = finish_take(f, s->index_count, sizeof *s->indices);
    s->polygon_first_triangle = finish_take(f, (size_t)s->polygon_count + 1, sizeof(uint32_t));
    if (f->failed) return;
    uint32_t item = 0, index = 0, polygon = 0, triangle = 0;
    for (int k = 0; k < 2; ++k) {
        const scene_item *items = streams[k]->items.items;
        const uint32_t *triangles = streams[k]->polygon_triangles.items;
        const uint32_t first_index = index, first_polygon = polygon;
        for (size_t i = 0; i < streams[k]->items.count; ++i, ++item) {
            s->items[item] = items[i];
            s->items[item].first_index += first_index;
            s->items[item].first_polygon += first_polygon;
        }
        if (streams[k]->indices.count) memcpy(s->indices + index, streams[k]->indices.items, streams[k]->indices.count * sizeof(uint32_t));
        index += (uint32_t)streams[k]->indices.count;
        for (size_t i = 0; i < streams[k]->polygon_triangles.count; ++i) {
            s->polygon_first_triangle[polygon++] = triangle;
            triangle += triangles[i];
        }
    }
    s->polygon_first_triangle[polygon] = triangle;
}

static float *take_floats(finish *f, size_t count)
{
    float *floats = finish_take(f, count + CULL_PADDING, sizeof(float));
    if (floats) memset(floats + count, 0, CULL_PADDING * sizeof(float));
    return floats;
}

cull_box finish_item_box(const scene *s, const scene_item *item)
{
    cull_box box = cull_box_none();
    for (uint32_t i = item->first_index; i < item->first_index + item->index_count; ++i) box = cull_box_with_point(box, s->positions[s->indices[i]]);
    return box;
}

static void find_boxes(finish *f)
{
    scene *s = f->s;
    const size_t count = (size_t)s->item_count + s->mover_count;
    float *axes[6];
    for (int k = 0; k < 6; ++k) axes[k] = take_floats(f, count);
    if (f->failed) return;
    cull_box all = cull_box_none();
    for (size_t i = 0; i < count; ++i) {
        const cull_box box = finish_item_box(s, &s->items[i]);
        const float values[6] = {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
        for (int k = 0; k < 6; ++k) axes[k][i] = values[k];
        all = cull_box_union(all, box);
    }
    s->boxes = (cull_boxes){axes[0], axes[1], axes[2], axes[3], axes[4], axes[5]};
    s->whole.box = all;
    s->whole.radius = cull_box_radius(all);
}

// Plane ids: planes whose rounded numbers agree are one, or whose exact ones do where there are such. Rounding only decides
// sharing, never a position.
typedef struct plane_key { int64_t number[4]; } plane_key;
static const double NORMAL_STEPS = 1 << 20; // a millionth of a radian: far finer than any two walls that differ

static plane_key key_of_plane(const double plane[4], double offset, double step)
{
    const double offset_steps = offset / (step * 16); // 16 vertex steps: what rounding of the vertices may move it
    return (plane_key){{llrint(plane[0] * NORMAL_STEPS), llrint(plane[1] * NORMAL_STEPS), llrint(plane[2] * NORMAL_STEPS), llrint(offset_steps)}};
}

static plane_key key_of_exact_plane(const cull_exact_plane *p)
{
    return (plane_key){{p->normal[0], p->normal[1], p->normal[2], p->offset}};
}

static uint32_t plane_find(finish *f, plane_key *keys, uint32_t *slots, size_t slot_count, plane_key key)
{
    size_t at = XXH3_64bits(&key, sizeof key) & (slot_count - 1);
    for (; slots[at]; at = (at + 1) & (slot_count - 1))
        if (memcmp(&keys[slots[at] - 1], &key, sizeof key) == 0) return slots[at] - 1;
    keys[f->s->plane_count] = key;
    slots[at] = ++f->s->plane_count;
    return f->s->plane_count - 1;
}

// An exact plane of the world is kept about the scene's origin; without one of them none is any use.
static void keep_exact_plane(scene *s, uint32_t plane, const cull_exact_plane *from)
{
    if (s->exact_planes && !exact_plane_move(from, s->whole.origin, s->grid_steps_per_metre, &s->exact_planes[plane])) s->exact_planes = NULL;
}

static void number_planes(finish *f, plane_key *keys, uint32_t *slots, size_t slot_count)
{
    scene *s = f->s;
    const builder_wall *from = f->b->walls.items;
    const cull_exact_plane *exact = s->exact_planes ? f->b->exact_planes.items : NULL;
    for (uint32_t i = 0; i < s->item_count; ++i) {
        s->walls[i] = (cull_wall){.first_vertex = from[i].first_vertex, .vertex_count = from[i].vertex_count};
        if (!from[i].vertex_count) continue;
        const double *p = from[i].plane;
        const double offset = p[3] + p[0] * s->whole.origin[0] + p[1] * s->whole.origin[1] + p[2] * s->whole.origin[2];
        const uint32_t known = s->plane_count;
        const plane_key key = exact ? key_of_exact_plane(&exact[i]) : key_of_plane(p, offset, s->step);
        s->walls[i].plane = plane_find(f, keys, slots, slot_count, key);
        if (s->plane_count == known) continue;
        s->planes[known] = (cull_plane){{(float)p[0], (float)p[1], (float)p[2]}, (float)offset};
        if (exact) keep_exact_plane(s, known, &exact[i]);
    }
    if (!s->exact_planes) s->grid_steps_per_metre = 0;
}

// Each wall has one: those of another builder's copies, and those from before there was a grid, do not.
static int walls_are_exact(const scene_builder *b)
{
    const builder_wall *walls = b->walls.items;
    const cull_exact_plane *planes = b->exact_planes.items;
    if (!(b->grid_steps_per_metre > 0) || b->inexact_walls) return 0;
    for (size_t i = 0; i < b->walls.count; ++i) {
        const int64_t *n = i < b->exact_planes.count ? planes[i].normal : NULL;
        if (walls[i].vertex_count && (!n || !(n[0] | n[1] | n[2]))) return 0;
    }
    return 1;
}

static void finish_walls(finish *f)
{
    scene *s = f->s;
    if (!f->b->wall_count) return;
    s->wall_vertices = finish_copy(f, &f->b->wall_vertices);
    s->wall_vertex_count = (uint32_t)f->b->wall_vertices.count;
    s->walls = finish_take(f, s->item_count, sizeof *s->walls);
    s->planes = finish_take(f, f->b->wall_count, sizeof *s->planes);
    if (walls_are_exact(f->b)) {
        s->exact_planes = finish_take(f, f->b->wall_count, sizeof *s->exact_planes);
        s->grid_steps_per_metre = f->b->grid_steps_per_metre;
    }
    size_t slot_count = 64;
    while (slot_count < (size_t)f->b->wall_count * 2) slot_count *= 2;
    plane_key *keys = memory_alloc(f->b->memory, f->b->wall_count, sizeof *keys);
    uint32_t *slots = memory_alloc_zeroed(f->b->memory, slot_count, sizeof *slots);
    if (!keys || !slots) f->failed = 1;
    if (!f->failed) number_planes(f, keys, slots, slot_count);
    memory_free(f->b->memory, keys, f->b->wall_count, sizeof *keys);
    memory_free(f->b->memory, slots, slot_count, sizeof *slots);
}

static void finish_lists(finish *f, const char *path)
{
    scene *s = f->s;
    const scene_builder *b = f->b;
    s->path = finish_text(f, path);
    s->normals = finish_copy(f, &b->normals);
    s->vertex_materials = finish_copy(f, &b->vertex_materials);
    s->materials = finish_copy(f, &b->materials);
    s->objects = finish_copy(f, &b->objects);
    s->movers = finish_copy(f, &b->mover_list);
    s->places = finish_copy(f, &b->places);
    s->solids = finish_copy(f, &b->solids);
    s->solid_planes = finish_copy(f, &b->solid_planes);
    s->material_count = (uint32_t)b->materials.count;
    s->object_count = (uint32_t)b->objects.count;
    s->place_count = (uint32_t)b->places.count;
    s->solid_count = (uint32_t)b->solids.count;
    s->solid_plane_count = (uint32_t)b->solid_planes.count;
    s->is_map = b->is_map;
    uint32_t flags = 0;
    for (uint32_t i = 0; !f->failed && i < s->material_count; ++i) {
        s->materials[i].name = finish_text(f, s->materials[i].name);
        flags |= s->materials[i].flags;
    }
    for (uint32_t i = 0; !f->failed && i < s->object_count; ++i) s->objects[i].name = finish_text(f, s->objects[i].name);
    for (uint32_t i = 0; !f->failed && i < s->mover_count; ++i) s->movers[i].name = finish_text(f, s->movers[i].name);
    if (flags & (MATERIAL_CUT_OUT | MATERIAL_NORMAL_MAP)) s->texcoords = finish_copy(f, &b->texcoords);
}

static void finish_objects(scene *s)
{
    for (uint32_t i = 0; i < s->item_count; ++i) { // items of an object lie together; an object without items keeps 0, 0
        scene_object *o = &s->objects[s->items[i].object];
        if (o->item_count == 0) o->first_item = i;
        o->item_count = i - o->first_item + 1;
    }
}

static void count_flat_triangles(scene *s)
{
    for (uint32_t i = 0; i < s->index_count; i += 3) {
        const cull_vec3 a = s->positions[s->indices[i]], b = s->positions[s->indices[i + 1]], c = s->positions[s->indices[i + 2]];
        const double u[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z};
        const double v[3] = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z};
        s->flat_triangles += u[1] * v[2] == u[2] * v[1] && u[2] * v[0] == u[0] * v[2] && u[0] * v[1] == u[1] * v[0];
    }
}

static uint64_t hash_of(const scene *s)
{
    uint64_t hash = XXH3_64bits_withSeed(s->positions, s->position_count * sizeof *s->positions, s->item_count);
    hash = XXH3_64bits_withSeed(s->indices, s->index_count * sizeof *s->indices, hash);
    hash = XXH3_64bits_withSeed(s->items, ((size_t)s->item_count + s->mover_count) * sizeof *s->items, hash);
    return XXH3_64bits_withSeed(s->vertex_materials, s->position_count * sizeof *s->vertex_materials, hash);
}

static result fill(finish *f, const char *path, report *r)
{
    const result parted = finish_part_mirrored(f->b);
    if (parted == RESULT_NO_MEMORY) return report_no_memory(r, path);
    if (parted != RESULT_OK) return report_error(r, path, 0, "over 2^32 vertices; split the scene");
    find_bounds(f);
    const result origin = choose_origin(f, path, r);
    if (origin != RESULT_OK) return origin;
    round_positions(f);
    join_streams(f);
    if (!f->failed) find_boxes(f);
    if (!f->failed) finish_lists(f, path);
    if (!f->failed) finish_walls(f);
    if (!f->failed) finish_tangents(f);
    if (f->failed) return report_no_memory(r, path);
    finish_objects(f->s);
    count_flat_triangles(f->s);
    f->s->hash = hash_of(f->s);
    return finish_zones(f, path, r);
}

result scene_builder_finish(scene_builder *b, const char *path, report *r, scene **out)
{
    const size_t items = b->statics.items.count + b->movers.items.count;
    if (items == 0) return report_error(r, path, 0, "no polygon to draw; the scene is empty or holds tool surfaces only");
    if (items > UINT32_MAX / 2 || b->statics.indices.count + b->movers.indices.count > UINT32_MAX)
        return report_error(r, path, 0, "over 2^31 items or 2^32 indices; split the scene");
    scene *s = memory_alloc_zeroed(b->memory, 1, sizeof *s);
    if (!s) return report_no_memory(r, path);
    s->memory = arena_make(b->memory);
    finish f = {.b = b, .s = s};
    const result done = fill(&f, path, r);
    if (done != RESULT_OK) {
        scene_free(s, b->memory);
        return done;
    }
    *out = s;
    return RESULT_OK;
}

void scene_free(scene *s, const allocator *memory)
{
    if (!s) return;
    arena_free(&s->memory);
    memory_free(memory, s->file, s->file_bytes, 1);
    memory_free(memory, s, 1, sizeof *s);
}

double scene_radius_m(const scene *s)
{
    const cull_box b = s->whole.box;
    const double x = (double)b.max.x - b.min.x, y = (double)b.max.y - b.min.y, z = (double)b.max.z - b.min.z;
    return sqrt(x * x + y * y + z * z) / 2;
}
