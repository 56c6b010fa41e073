// A scene made anew: see stress_scene.h.
// SPDX-License-Identifier: MIT
// Invariant: vertices, items, zones, portals, doors and movers keep their numbers, so that two such scenes compare item by item.
#include "stress_scene.h"

#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

typedef struct rebuild {
    const scene *from;
    const scene_change *change;
    const allocator *memory;
    report *r;
    scene_builder *to;
    uint32_t *polygon_triangles; // from->polygon_count
    uint32_t *zone_firsts, *zone_lists; // zones by item: from firsts[item] to firsts[item + 1]
} rebuild;

// ---- Points ----

static void jitter(const rebuild *b, double p[3])
{
    if (b->change->jitter_m == 0) return;
    const double key[3] = {p[0], p[1], p[2]};
    uint64_t hash = XXH3_64bits_withSeed(key, sizeof key, b->change->seed);
    for (int k = 0; k < 3; ++k, hash >>= 20) p[k] += ((double)(hash % 3) - 1) * b->change->jitter_m;
}

static void point_of(const rebuild *b, cull_vec3 p, double out[3])
{
    const double relative[3] = {(double)p.x, (double)p.y, (double)p.z};
    for (int k = 0; k < 3; ++k) out[k] = b->from->whole.origin[k] + relative[k];
    jitter(b, out);
}

// Those of one material in a row at once.
static result add_vertices(const rebuild *b)
{
    enum { BLOCK = 4096 };
    const scene *s = b->from;
    builder_vertex *block = memory_alloc(b->memory, BLOCK, sizeof *block);
    result done = block ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t v = 0; v < s->position_count && done == RESULT_OK;) {
        uint32_t count = 0, first;
        const uint16_t material = s->vertex_materials[v];
        for (; count < BLOCK && v + count < s->position_count && s->vertex_materials[v + count] == material; ++count) {
            block[count] = (builder_vertex){{0}, {0}, {0}};
            point_of(b, s->positions[v + count], block[count].position);
            if (s->texcoords) memcpy(block[count].texcoord, s->texcoords + 2 * (size_t)(v + count), sizeof block[count].texcoord);
        }
        done = scene_builder_vertices(b->to, block, count, material, &first);
        v += count;
    }
    memory_free(b->memory, block, BLOCK, sizeof *block);
    return done;
}

static result add_names(const rebuild *b)
{
    const scene *s = b->from;
    result done = RESULT_OK;
    uint32_t number;
    for (uint32_t m = 0; m < s->material_count && done == RESULT_OK; ++m) {
        const scene_material *from = &s->materials[m];
        done = scene_builder_material(b->to, from->name, strlen(from->name), from->flags & ~(uint32_t)MATERIAL_NORMAL_MAP, &number);
        if (done == RESULT_OK && number != m) return report_error(b->r, s->path, 0, "two materials named '%s'", from->name);
    }
    for (uint32_t o = 0; o < s->object_count && done == RESULT_OK; ++o)
        done = scene_builder_object(b->to, s->objects[o].name, strlen(s->objects[o].name), &number);
    return done;
}

// ---- Zones ----

static result add_zone(const rebuild *b, const scene_zone *z)
{
    const scene *s = b->from;
    const char *fault = NULL;
    uint32_t number;
    builder_hull *hulls = memory_alloc(b->memory, z->hull_count, sizeof *hulls);
    if (!hulls) return RESULT_NO_MEMORY;
    for (uint32_t h = 0; h < z->hull_count; ++h) {
        const scene_hull *hull = &s->hulls[z->first_hull + h];
        hulls[h] = (builder_hull){s->hull_planes + hull->first_plane, hull->plane_count};
    }
    const builder_zone add = {z->name, z->chain, hulls, z->hull_count, z->parent};
    result done = scene_builder_zone(b->to, &add, &number, &fault);
    if (done == RESULT_BAD_INPUT) done = report_error(b->r, s->path, 0, "the zone '%s' %s", z->name, fault ? fault : "is wrong");
    memory_free(b->memory, hulls, z->hull_count, sizeof *hulls);
    return done;
}

static result add_portal(const rebuild *b, const scene_portal *p)
{
    const char *fault = NULL;
    uint32_t number;
    double(*points)[3] = memory_alloc(b->memory, p->point_count, sizeof *points);
    if (!points) return RESULT_NO_MEMORY;
    memcpy(points, b->from->portal_points + p->first_point, p->point_count * sizeof *points);
    for (uint32_t i = 0; i < p->point_count; ++i) jitter(b, points[i]);
    const builder_portal add = {p->name, (const double(*)[3])points, p->point_count, {p->zones[0], p->zones[1]}, p->door, p->plane};
    result done = scene_builder_portal(b->to, &add, &number, &fault);
    if (done == RESULT_BAD_INPUT) done = report_error(b->r, b->from->path, 0, "the portal '%s' %s", p->name ? p->name : "", fault ? fault : "is wrong");
    memory_free(b->memory, points, p->point_count, sizeof *points);
    return done;
}

// Which zones list each item. The stray one is made anew by the builder for what no zone lists.
static result find_zones(rebuild *b)
{
    const scene *s = b->from;
    b->zone_firsts = memory_alloc_zeroed(b->memory, (size_t)s->item_count + 2, sizeof(uint32_t));
    b->zone_lists = memory_alloc(b->memory, s->zone_item_count, sizeof(uint32_t));
    if (!b->zone_firsts || !b->zone_lists) return RESULT_NO_MEMORY;
    uint32_t *firsts = b->zone_firsts + 1; // one ahead while they are filled
    for (uint32_t z = 0; z < s->zone_count; ++z)
        for (uint32_t i = 0; i < s->zones[z].item_count && !(s->zones[z].flags & ZONE_STRAY); ++i) firsts[s->zone_items[s->zones[z].first_item + i] + 1]++;
    for (uint32_t i = 0; i < s->item_count; ++i) firsts[i + 1] += firsts[i];
    for (uint32_t z = 0; z < s->zone_count; ++z)
        for (uint32_t i = 0; i < s->zones[z].item_count && !(s->zones[z].flags & ZONE_STRAY); ++i)
            b->zone_lists[firsts[s->zone_items[s->zones[z].first_item + i]]++] = z;
    return RESULT_OK;
}

// ---- Items ----

static builder_item item_like(const rebuild *b, uint32_t i)
{
    const scene *s = b->from;
    const scene_item *item = &s->items[i];
    builder_item like = {.indices = s->indices + item->first_index, .polygon_triangles = b->polygon_triangles + item->first_polygon,
                         .index_count = item->index_count, .polygon_count = item->polygon_count, .material = item->material, .object = item->object,
                         .flags = item->flags & ~(uint32_t)CULL_ITEM_WALL};
    const cull_wall *wall = s->walls && i < s->item_count ? &s->walls[i] : NULL;
    if (!wall || !wall->vertex_count) return like;
    const cull_plane plane = s->planes[wall->plane];
    const double normal[3] = {(double)plane.normal.x, (double)plane.normal.y, (double)plane.normal.z};
    like.flags = item->flags;
    like.loop = s->wall_vertices + wall->first_vertex;
    like.loop_count = wall->vertex_count;
    like.plane[3] = (double)plane.offset;
    for (int k = 0; k < 3; ++k) {
        like.plane[k] = normal[k];
        like.plane[3] -= normal[k] * s->whole.origin[k];
    }
    return like;
}

static result add_item(const rebuild *b, uint32_t i, const builder_item *item)
{
    const uint32_t first = b->zone_firsts[i], count = b->zone_firsts[i + 1] - first;
    const result done = scene_builder_item(b->to, item);
    return done == RESULT_OK && count ? scene_builder_item_zones(b->to, b->zone_lists + first, count) : done;
}

static result add_tiny(const rebuild *b, uint32_t i)
{
    const scene *s = b->from;
    const uint32_t material = s->items[i].material;
    const double side = b->change->tiny_m;
    builder_vertex corners[3] = {{{0}, {0}, {0}}, {{0}, {0}, {0}}, {{0}, {0}, {0}}};
    uint32_t first;
    for (int v = 0; v < 3; ++v) point_of(b, s->positions[s->indices[s->items[i].first_index]], corners[v].position);
    corners[1].position[0] += side;
    corners[2].position[1] += side;
    const result done = scene_builder_vertices(b->to, corners, 3, material, &first);
    const uint32_t indices[3] = {first, first + 1, first + 2};
    const builder_item tiny = {.indices = indices, .index_count = 3, .polygon_count = 1, .material = material, .object = s->items[i].object,
                               .flags = CULL_ITEM_TWO_SIDED};
    return done == RESULT_OK ? add_item(b, i, &tiny) : done;
}

static result add_items(const rebuild *b)
{
    const uint32_t count = b->from->item_count;
    result done = RESULT_OK;
    for (uint32_t copy = 0; copy < b->change->copies; ++copy)
        for (uint32_t i = 0; i < count && done == RESULT_OK; ++i) {
            const builder_item like = item_like(b, i);
            done = add_item(b, i, &like);
        }
    for (uint32_t tiny = 0; tiny < b->change->tiny_count; ++tiny)
        for (uint32_t i = 0; i < count && done == RESULT_OK; ++i) done = add_tiny(b, i);
    return done;
}

// ---- What moves ----

static void turn_back(const double axes[9], const double v[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = axes[k] * v[0] + axes[3 + k] * v[1] + axes[6 + k] * v[2];
}

// Its turns are about axes of its own where it came through a turned include: the path goes through that turn again.
static result add_path(const rebuild *b, uint32_t m)
{
    const scene_mover *mover = &b->from->movers[m];
    const builder_transform *place = &b->change->place;
    builder_transform turned = *place;
    double pivot[3];
    scene_key *keys = memory_alloc(b->memory, mover->key_count, sizeof *keys);
    if (!keys) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < mover->key_count; ++i) {
        keys[i] = b->from->keys[mover->first_key + i];
        turn_back(mover->axes, b->from->keys[mover->first_key + i].offset, keys[i].offset);
    }
    turn_back(mover->axes, mover->pivot, pivot);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            turned.rows[i][k] = 0;
            for (int l = 0; l < 3; ++l) turned.rows[i][k] += place->rows[i][l] * mover->axes[3 * l + k];
        }
    result done = scene_builder_transform(b->to, &turned);
    const builder_path path = {keys, pivot, mover->key_count, mover->loops};
    if (done == RESULT_OK) done = scene_builder_mover_path(b->to, m, &path);
    if (done == RESULT_BAD_INPUT) done = report_error(b->r, b->from->path, 0, "the path of mover '%s' leads beyond 1e9 m", mover->name);
    const result back = scene_builder_transform(b->to, place);
    memory_free(b->memory, keys, mover->key_count, sizeof *keys);
    return done == RESULT_OK ? back : done;
}

static result add_movers(const rebuild *b)
{
    const scene *s = b->from;
    result done = RESULT_OK;
    for (uint32_t m = 0; m < s->mover_count && done == RESULT_OK; ++m) {
        const builder_item like = item_like(b, s->item_count + m);
        done = scene_builder_mover(b->to, s->movers[m].name, s->movers[m].open_offset, &like);
        if (done == RESULT_OK && s->movers[m].key_count) done = add_path(b, m);
    }
    for (uint32_t d = 0; d < s->door_count && done == RESULT_OK; ++d) {
        uint32_t number;
        done = scene_builder_door(b->to, s->doors[d].name, s->doors[d].at_rest, s->doors[d].mover, &number);
        if (done == RESULT_BAD_INPUT) done = report_error(b->r, s->path, 0, "the leaf of door '%s' lies beyond 1e9 m", s->doors[d].name);
    }
    return done;
}

static result add_all(rebuild *b)
{
    const scene *s = b->from;
    result done = scene_builder_transform(b->to, &b->change->place);
    b->polygon_triangles = memory_alloc(b->memory, s->polygon_count, sizeof(uint32_t));
    if (!b->polygon_triangles) return RESULT_NO_MEMORY;
    for (uint32_t p = 0; p < s->polygon_count; ++p) b->polygon_triangles[p] = s->polygon_first_triangle[p + 1] - s->polygon_first_triangle[p];
    if (done == RESULT_OK) done = find_zones(b);
    if (done == RESULT_OK) done = add_names(b);
    if (done == RESULT_OK) done = add_vertices(b);
    if (done == RESULT_OK) done = add_movers(b);
    for (uint32_t z = 0; z < s->zone_count && done == RESULT_OK; ++z)
        if (!(s->zones[z].flags & ZONE_STRAY)) done = add_zone(b, &s->zones[z]);
    for (uint32_t p = 0; p < s->portal_count && done == RESULT_OK; ++p) done = add_portal(b, &s->portals[p]);
    return done == RESULT_OK ? add_items(b) : done;
}

result scene_rebuild(const scene *from, const scene_change *c, const allocator *memory, report *r, scene **out)
{
    rebuild b = {.from = from, .change = c, .memory = memory, .r = r};
    const uint32_t errors = r->errors;
    result done = scene_builder_open(memory, &b.to);
    if (done == RESULT_OK) done = add_all(&b);
    if (done == RESULT_NO_MEMORY) report_no_memory(r, from->path);
    if (done == RESULT_BAD_INPUT && r->errors == errors)
        report_error(r, from->path, 0, "numbers beyond what a scene holds; scale it less, or move it nearer to its origin");
    if (done == RESULT_OK) done = scene_builder_finish(b.to, from->path, r, out);
    scene_builder_close(b.to);
    memory_free(memory, b.polygon_triangles, from->polygon_count, sizeof(uint32_t));
    memory_free(memory, b.zone_firsts, (size_t)from->item_count + 2, sizeof(uint32_t));
    memory_free(memory, b.zone_lists, from->zone_item_count, sizeof(uint32_t));
    return done;
}

uint32_t scene_rebuilt_from(const scene *from, const scene *rebuilt, uint32_t item)
{
    return item < rebuilt->item_count ? item % from->item_count : item - rebuilt->item_count + from->item_count;
}
