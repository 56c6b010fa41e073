// The way out of a leaking map: over the surface, from polygon to polygon across their edges through the air, it cannot
// miss the hole, however small. From a body that hangs free a ray jumps to the next.
// SPDX-License-Identifier: MIT
#include "zone_trace.h"

#include <string.h>

#define OFF_SURFACE 1.0 // steps: points lie that much in front of their polygon

typedef struct leak_walk {
    const compile_input *in;
    zone_trace *t;
    const allocator *memory;
    uint32_t *first, *pair_of;         // pairs of each face
    uint32_t *from, *across;           // by face: the face before it + 1 (0: not seen), the pair between + 1
    buffer order;                      // faces, as seen
    size_t jumped;                     // of them: their rays meet nothing new any more
    double out[3];                     // past the end of the last face
} leak_walk;

static void middle(const leak_walk *w, uint32_t face, double out[3])
{
    const surface *s = &w->t->s;
    const surface_polygon *p = surface_polygon_at(s, face >> 1);
    const cull_wide_plane plane = plane_table_get(s->planes, p->plane ^ (face & 1));
    double most = 0;
    for (int k = 0; k < 3; ++k) most = (double)cull_magnitude(plane.normal[k]) > most ? (double)cull_magnitude(plane.normal[k]) : most;
    for (int k = 0; k < 3; ++k) {
        out[k] = OFF_SURFACE * (double)plane.normal[k] / most;
        for (uint32_t i = 0; i < p->count; ++i) out[k] += surface_vertex_at(s, surface_corners(s, p)[i].vertex)->position[k] / p->count;
    }
}

static void group_pairs(leak_walk *w)
{
    const face_pair *pairs = w->t->shells.pairs.items;
    const size_t count = w->t->shells.pairs.count;
    for (size_t i = 0; i < count; ++i) w->first[pairs[i].a + 1]++, w->first[pairs[i].b + 1]++;
    for (uint32_t f = 0; f < w->t->shells.face_count; ++f) w->first[f + 1] += w->first[f];
    for (size_t i = count; i-- > 0;) {
        w->pair_of[--w->first[pairs[i].a + 1]] = (uint32_t)i;
        w->pair_of[--w->first[pairs[i].b + 1]] = (uint32_t)i;
    }
} // first[f + 1] is now where the pairs of f begin

static int is_at_border(const leak_walk *w, uint32_t face)
{
    const surface_polygon *p = surface_polygon_at(&w->t->s, face >> 1);
    const tree_box *all = &w->t->rays.tree.nodes[0].box;
    for (int k = 0; k < 3; ++k) {
        if (p->max[k] < all->max[k] && p->min[k] > all->min[k]) continue;
        return 1;
    }
    return 0;
}

static result see(leak_walk *w, uint32_t face, uint32_t from, uint32_t across)
{
    w->from[face] = from + 1;
    w->across[face] = across + 1;
    return buffer_append(&w->order, &face, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

// Along the surface; *end is the face at the border, or RAY_NO_FACE.
static result walk_shell(leak_walk *w, size_t at, uint32_t *end)
{
    const face_pair *pairs = w->t->shells.pairs.items;
    *end = RAY_NO_FACE;
    for (; at < w->order.count; ++at) {
        const uint32_t face = ((uint32_t *)w->order.items)[at];
        if (is_at_border(w, face)) {
            *end = face;
            return RESULT_OK;
        }
        const uint32_t last = face + 1 < w->t->shells.face_count ? w->first[face + 2] : 2 * (uint32_t)w->t->shells.pairs.count;
        for (uint32_t i = w->first[face + 1]; i < last; ++i) {
            const face_pair *p = &pairs[w->pair_of[i]];
            const uint32_t other = p->a == face ? p->b : p->a;
            if (w->from[other]) continue;
            const result r = see(w, other, face, w->pair_of[i]);
            if (r != RESULT_OK) return r;
        }
    }
    return RESULT_OK;
}

// From some face seen to one that isn't, through the air; *end: a face whose ray meets nothing.
static result jump(leak_walk *w, int *found, uint32_t *end)
{
    *found = 0;
    for (; w->jumped < w->order.count && !*found && *end == RAY_NO_FACE; ++w->jumped) {
        const uint32_t face = ((uint32_t *)w->order.items)[w->jumped];
        ray_end done = RAY_UNCLEAR;
        for (uint32_t attempt = 0; attempt < 4 && done != RAY_DONE; ++attempt) {
            const result r = ray_from_face(&w->t->rays, face, attempt, &done);
            if (r != RESULT_OK) return r;
        }
        if (done != RAY_DONE) continue;
        const uint32_t next = w->t->rays.ray.nearest;
        if (next == RAY_NO_FACE) {
            *end = face;
            memcpy(w->out, w->t->rays.ray.to, sizeof(w->out));
        } else if (!w->from[next]) {
            *found = 1;
            return see(w, next, face, UINT32_MAX);
        }
    }
    return RESULT_OK;
}

static void leave_box(leak_walk *w, uint32_t face)
{
    const tree_box *all = &w->t->rays.tree.nodes[0].box;
    const surface_polygon *p = surface_polygon_at(&w->t->s, face >> 1);
    middle(w, face, w->out);
    for (int k = 0; k < 3; ++k) {
        if (p->max[k] >= all->max[k]) w->out[k] = all->max[k] + 64 * OFF_SURFACE;
        else if (p->min[k] <= all->min[k]) w->out[k] = all->min[k] - 64 * OFF_SURFACE;
        else continue;
        break;
    }
}

static result find_way(leak_walk *w, uint32_t start, uint32_t *end)
{
    result r = see(w, start, start, UINT32_MAX);
    size_t at = 0;
    *end = RAY_NO_FACE;
    for (int found = 1; r == RESULT_OK && found && *end == RAY_NO_FACE;) {
        r = walk_shell(w, at, end);
        if (r != RESULT_OK) break;
        if (*end != RAY_NO_FACE) leave_box(w, *end);
        at = w->order.count;
        found = 0;
        if (*end == RAY_NO_FACE) r = jump(w, &found, end);
    }
    return r;
}

static void put(const leak_walk *w, compiled_zones *z, const double steps[3])
{
    for (int k = 0; k < 3; ++k) z->leak_line[z->leak_line_count][k] = steps[k] / w->in->steps_per_metre;
    z->leak_line_count++;
}

static result write_line(leak_walk *w, uint32_t entity, uint32_t start, uint32_t end, compiled_zones *z)
{
    uint32_t steps = 0;
    for (uint32_t f = end; f != RAY_NO_FACE && f != start; f = w->from[f] - 1) ++steps;
    z->leak_line = arena_push(&z->memory, 2 * (size_t)steps + 3, sizeof(*z->leak_line));
    uint32_t *way = memory_alloc(w->memory, (size_t)steps + 1, sizeof(*way));
    if (!z->leak_line || !way) {
        memory_free(w->memory, way, (size_t)steps + 1, sizeof(*way));
        return RESULT_NO_MEMORY;
    }
    uint32_t at = steps;
    for (uint32_t f = end; f != RAY_NO_FACE; f = w->from[f] - 1) {
        way[at] = f;
        if (at-- == 0) break;
    }
    memcpy(z->leak_line[0], w->in->entities[entity].origin, sizeof(z->leak_line[0]));
    z->leak_line_count = 1;
    for (uint32_t i = 0; end != RAY_NO_FACE && i <= steps; ++i) {
        double p[3];
        if (i && w->across[way[i]]) {
            const face_pair *pair = (face_pair *)w->t->shells.pairs.items + w->across[way[i]] - 1;
            const double *a = surface_vertex_at(&w->t->s, pair->start)->position, *b = surface_vertex_at(&w->t->s, pair->end)->position;
            for (int k = 0; k < 3; ++k) p[k] = (a[k] + b[k]) / 2;
            put(w, z, p);
        }
        middle(w, way[i], p);
        put(w, z, p);
    }
    put(w, z, w->out);
    memory_free(w->memory, way, (size_t)steps + 1, sizeof(*way));
    return RESULT_OK;
}

result leak_line_make(const compile_input *in, zone_trace *t, uint32_t entity, const allocator *memory, compiled_zones *z)
{
    const uint32_t faces = t->shells.face_count;
    const size_t pairs = t->shells.pairs.count;
    leak_walk w = {.in = in, .t = t, .memory = memory, .order = buffer_make(memory, sizeof(uint32_t))};
    int32_t point[3];
    ray_end done = RAY_UNCLEAR;
    zone_place_point(in, &in->entities[entity], point);
    w.first = memory_alloc_zeroed(memory, (size_t)faces + 1, sizeof(uint32_t));
    w.pair_of = memory_alloc(memory, 2 * pairs, sizeof(uint32_t));
    w.from = memory_alloc_zeroed(memory, faces, sizeof(uint32_t));
    w.across = memory_alloc_zeroed(memory, faces, sizeof(uint32_t));
    result r = w.first && w.pair_of && w.from && w.across ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t attempt = 0; attempt < RAY_ATTEMPTS && r == RESULT_OK && done == RAY_UNCLEAR; ++attempt)
        r = ray_from_point(&t->rays, point, attempt, &done);
    uint32_t end = RAY_NO_FACE;
    const uint32_t start = done == RAY_DONE && t->rays.polygon_count ? t->rays.ray.nearest : RAY_NO_FACE;
    if (r == RESULT_OK && t->rays.polygon_count) memcpy(w.out, t->rays.ray.to, sizeof(w.out));
    if (r == RESULT_OK) group_pairs(&w);
    if (r == RESULT_OK && start != RAY_NO_FACE) r = find_way(&w, start, &end);
    if (r == RESULT_OK) r = write_line(&w, entity, start, end, z);
    memory_free(memory, w.first, (size_t)faces + 1, sizeof(uint32_t));
    memory_free(memory, w.pair_of, 2 * pairs, sizeof(uint32_t));
    memory_free(memory, w.from, faces, sizeof(uint32_t));
    memory_free(memory, w.across, faces, sizeof(uint32_t));
    buffer_free(&w.order);
    return r;
}
