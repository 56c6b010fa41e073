// Topological weld: see vertex_weld.h. Corners of the same three planes by a hash; then points by a hash of their doubles with
// a probe of the next cell where the border is near, and three exact tests.
// SPDX-License-Identifier: MIT
#include "vertex_weld.h"

#include <math.h>
#include <string.h>

#define CELL_STEPS 0.125        // an eighth of a step: points of a map are rarely nearer
#define CELL_OFFSET 0.0439      // steps: whole steps and halves lie well inside a cell
#define NEAR_STEPS 0.00000095367431640625 // 2^-20: twice the error of a position, 2^-25, with room to spare

enum { CHAIN_END = 0 };

typedef struct corner_key { plane_ref meet[3]; } corner_key; // canonical planes, ascending

typedef struct known_corner {
    corner_key key;
    uint32_t vertex, next;
} known_corner;

typedef struct known_point {
    uint32_t vertex, next;
} known_point;

typedef struct known_plane { // one more plane through a vertex
    plane_ref plane;
    uint32_t next;
} known_plane;

typedef struct weld_state {
    const plane_table *planes;
    buffer *vertices;
    buffer corners, points, more; // known_corner, known_point, known_plane; index + 1 in the chains
    buffer more_of;               // uint32_t: of a vertex
    uint32_t *corner_heads, *point_heads, mask;
} weld_state;

static uint64_t mix(uint64_t h, uint64_t v)
{
    h = (h ^ v) * 0x9e3779b97f4a7c15u;
    return h ^ h >> 29;
}

static corner_key key_of(plane_ref polygon, const polygon_edge *edges, uint32_t count, uint32_t i)
{
    plane_ref m[3];
    polygon_corner(polygon, edges, count, i, m);
    for (int k = 0; k < 3; ++k) m[k] &= ~1u;
    corner_key key = {{m[0], m[1], m[2]}};
    if (key.meet[0] > key.meet[1]) key = (corner_key){{key.meet[1], key.meet[0], key.meet[2]}};
    if (key.meet[1] > key.meet[2]) key = (corner_key){{key.meet[0], key.meet[2], key.meet[1]}};
    if (key.meet[0] > key.meet[1]) key = (corner_key){{key.meet[1], key.meet[0], key.meet[2]}};
    return key;
}

// ---- Points ----

static uint32_t point_slot(const weld_state *w, const int64_t cell[3])
{
    uint64_t h = 0;
    for (int k = 0; k < 3; ++k) h = mix(h, (uint64_t)cell[k]);
    return (uint32_t)(h >> 16) & w->mask;
}

static int is_same_point(const weld_state *w, const compile_vertex *v, const corner_key *key, const double position[3])
{
    for (int k = 0; k < 3; ++k)
        if (fabs(v->position[k] - position[k]) > NEAR_STEPS) return 0;
    for (int k = 0; k < 3; ++k)
        if (plane_table_side(w->planes, v->planes, key->meet[k]) != 0) return 0;
    return 1;
}

static uint32_t find_in_cell(const weld_state *w, const int64_t cell[3], const corner_key *key, const double position[3])
{
    const known_point *points = w->points.items;
    const compile_vertex *vertices = w->vertices->items;
    for (uint32_t at = w->point_heads[point_slot(w, cell)]; at != CHAIN_END; at = points[at - 1].next)
        if (is_same_point(w, &vertices[points[at - 1].vertex], key, position)) return points[at - 1].vertex;
    return UINT32_MAX;
}

static uint32_t find_point(const weld_state *w, const corner_key *key, const double position[3], int64_t own[3])
{
    int64_t low[3], high[3], cell[3];
    for (int k = 0; k < 3; ++k) {
        const double at = (position[k] + CELL_OFFSET) / CELL_STEPS, near = NEAR_STEPS / CELL_STEPS;
        own[k] = (int64_t)floor(at);
        low[k] = (int64_t)floor(at - near);
        high[k] = (int64_t)floor(at + near);
    }
    for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0])
        for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1])
            for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2]) {
                const uint32_t found = find_in_cell(w, cell, key, position);
                if (found != UINT32_MAX) return found;
            }
    return UINT32_MAX;
}

static int add_point(weld_state *w, const corner_key *key, const double position[3], const int64_t cell[3], uint32_t *vertex)
{
    compile_vertex v = {.planes = {key->meet[0], key->meet[1], key->meet[2]}};
    memcpy(v.position, position, sizeof v.position);
    const uint32_t slot = point_slot(w, cell), none = CHAIN_END;
    *vertex = (uint32_t)w->vertices->count;
    const known_point point = {*vertex, w->point_heads[slot]};
    if (!buffer_append(w->vertices, &v, 1) || !buffer_append(&w->points, &point, 1) || !buffer_append(&w->more_of, &none, 1)) return 0;
    w->point_heads[slot] = (uint32_t)w->points.count;
    return 1;
}

static int add_plane(weld_state *w, uint32_t vertex, plane_ref plane)
{
    const compile_vertex *v = (const compile_vertex *)w->vertices->items + vertex;
    if (v->planes[0] == plane || v->planes[1] == plane || v->planes[2] == plane) return 1;
    uint32_t *head = (uint32_t *)w->more_of.items + vertex;
    const known_plane *more = w->more.items;
    for (uint32_t at = *head; at != CHAIN_END; at = more[at - 1].next)
        if (more[at - 1].plane == plane) return 1;
    const known_plane p = {plane, *head};
    if (!buffer_append(&w->more, &p, 1)) return 0;
    *head = (uint32_t)w->more.count;
    return 1;
}

// ---- Corners ----

static int number_corner(weld_state *w, const corner_key *key, const double position[3], uint32_t *vertex)
{
    const uint32_t slot = (uint32_t)(mix(mix(mix(0, key->meet[0]), key->meet[1]), key->meet[2]) >> 16) & w->mask;
    const known_corner *corners = w->corners.items;
    for (uint32_t at = w->corner_heads[slot]; at != CHAIN_END; at = corners[at - 1].next)
        if (memcmp(&corners[at - 1].key, key, sizeof *key) == 0) {
            *vertex = corners[at - 1].vertex;
            return 1;
        }
    int64_t cell[3];
    *vertex = find_point(w, key, position, cell);
    if (*vertex == UINT32_MAX) {
        if (!add_point(w, key, position, cell, vertex)) return 0;
    } else
        for (int k = 0; k < 3; ++k)
            if (!add_plane(w, *vertex, key->meet[k])) return 0;
    const known_corner corner = {*key, *vertex, w->corner_heads[slot]};
    if (!buffer_append(&w->corners, &corner, 1)) return 0;
    w->corner_heads[slot] = (uint32_t)w->corners.count;
    return 1;
}

static int number_all(weld_state *w, polygon_soup *soup)
{
    for (size_t p = 0; p < soup->polygons.count; ++p) {
        const plane_polygon *shape = &((const body_polygon *)soup->polygons.items)[p].shape;
        polygon_edge *edges = (polygon_edge *)soup->edges.items + shape->first;
        for (uint32_t i = 0; i < shape->count; ++i) {
            const corner_key key = key_of(shape->plane, edges, shape->count, i);
            if (!number_corner(w, &key, edges[i].start, &edges[i].vertex)) return 0;
        }
    }
    return 1;
}

// ---- The least triple ----

static int are_parallel(const plane_table *t, plane_ref a, plane_ref b)
{
    const cull_wide_vector cross = cull_normals_cross(plane_table_canonical(t, a), plane_table_canonical(t, b));
    return cull_wide_sign(cross.v[0]) == 0 && cull_wide_sign(cross.v[1]) == 0 && cull_wide_sign(cross.v[2]) == 0;
}

// Planes that are independent of those taken before, least first: that gives the least triple.
static int take_least(weld_state *w, uint32_t vertex, buffer *all)
{
    compile_vertex *v = (compile_vertex *)w->vertices->items + vertex;
    all->count = 0;
    if (!buffer_append(all, v->planes, 3)) return 0;
    const known_plane *more = w->more.items;
    for (uint32_t at = ((const uint32_t *)w->more_of.items)[vertex]; at != CHAIN_END; at = more[at - 1].next)
        if (!buffer_append(all, &more[at - 1].plane, 1)) return 0;
    plane_ref *planes = all->items;
    for (size_t i = 1; i < all->count; ++i) // a handful
        for (size_t j = i; j > 0 && planes[j - 1] > planes[j]; --j) {
            const plane_ref swap = planes[j];
            planes[j] = planes[j - 1];
            planes[j - 1] = swap;
        }
    v->planes[0] = planes[0];
    size_t i = 1;
    while (are_parallel(w->planes, planes[0], planes[i])) ++i;
    v->planes[1] = planes[i++];
    while (plane_table_normals_sign(w->planes, planes[0], v->planes[1], planes[i]) == 0) ++i;
    v->planes[2] = planes[i];
    return 1;
}

static int take_least_of_all(weld_state *w, const allocator *memory)
{
    buffer all = buffer_make(memory, sizeof(plane_ref));
    int good = 1;
    for (uint32_t v = 0; good && v < w->vertices->count; ++v)
        if (((const uint32_t *)w->more_of.items)[v] != CHAIN_END) good = take_least(w, v, &all);
    buffer_free(&all);
    return good;
}

result vertex_weld(const plane_table *planes, polygon_soup *soup, const allocator *memory, buffer *vertices)
{
    size_t slots = 1024;
    while (slots < soup->edges.count && slots < (size_t)1 << 31) slots *= 2;
    weld_state w = {.planes = planes,
                    .vertices = vertices,
                    .corners = buffer_make(memory, sizeof(known_corner)),
                    .points = buffer_make(memory, sizeof(known_point)),
                    .more = buffer_make(memory, sizeof(known_plane)),
                    .more_of = buffer_make(memory, sizeof(uint32_t)),
                    .corner_heads = memory_alloc_zeroed(memory, slots, sizeof(uint32_t)),
                    .point_heads = memory_alloc_zeroed(memory, slots, sizeof(uint32_t)),
                    .mask = (uint32_t)(slots - 1)};
    const int good = w.corner_heads && w.point_heads && number_all(&w, soup) && take_least_of_all(&w, memory);
    memory_free(memory, w.corner_heads, slots, sizeof(uint32_t));
    memory_free(memory, w.point_heads, slots, sizeof(uint32_t));
    buffer_free(&w.corners);
    buffer_free(&w.points);
    buffer_free(&w.more);
    buffer_free(&w.more_of);
    return good ? RESULT_OK : RESULT_NO_MEMORY;
}
