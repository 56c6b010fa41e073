// What of each item hides: see hiz_shapes.h.
// SPDX-License-Identifier: MIT
#include "hiz_shapes.h"

#include <string.h>

static void *array_alloc(const cull_host *host, size_t count, size_t size)
{
    return count > SIZE_MAX / size ? NULL : host->alloc(host, (count + !count) * size, 64);
}

static void array_free(const cull_host *host, void *array, size_t count, size_t size)
{
    if (array) host->free(host, array, (count + !count) * size);
}

static uint32_t wall_vertices_of(const cull_zone *zone, uint32_t item)
{
    return zone->walls && (zone->items[item].flags & CULL_ITEM_WALL) ? zone->walls[item].vertex_count : 0;
}

static hiz_shape_kind kind_of(const cull_zone *zone, uint32_t item)
{
    const cull_item *is = &zone->items[item];
    if (is->flags & (CULL_ITEM_SEE_THROUGH | CULL_ITEM_CUT_OUT)) return HIZ_HIDES_NOTHING;
    if (is->flags & CULL_ITEM_BOX) return HIZ_HIDES_AS_BOX;
    return wall_vertices_of(zone, item) >= 3 || is->index_count >= 3 ? HIZ_HIDES_AS_LOOPS : HIZ_HIDES_NOTHING;
}

// Newell's normal; its length does not matter, nor do its errors: a loop's depth is bounded by its own vertices.
static void normal_of(const cull_vec3 *positions, const uint32_t *loop, uint32_t count, float out[3])
{
    double n[3] = {0, 0, 0};
    const cull_vec3 origin = positions[loop[0]];
    for (uint32_t i = 0; i < count; i++) {
        const cull_vec3 a = positions[loop[i]], b = positions[loop[i + 1 < count ? i + 1 : 0]];
        const double ax = (double)a.x - (double)origin.x, ay = (double)a.y - (double)origin.y, az = (double)a.z - (double)origin.z;
        const double bx = (double)b.x - (double)origin.x, by = (double)b.y - (double)origin.y, bz = (double)b.z - (double)origin.z;
        n[0] += ay * bz - az * by;
        n[1] += az * bx - ax * bz;
        n[2] += ax * by - ay * bx;
    }
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++) out[k] = length > 0 ? (float)(n[k] / length) : 0;
}

static void face_put(hiz_shapes *s, const uint32_t *loop, uint32_t count)
{
    hiz_face *f = &s->faces[s->face_count];
    normal_of(s->positions, loop, count, f->normal);
    if (f->normal[0] == 0 && f->normal[1] == 0 && f->normal[2] == 0) return;
    f->first = s->vertex_count;
    f->count = count;
    memcpy(s->vertices + s->vertex_count, loop, count * sizeof *loop);
    s->vertex_count += count;
    s->face_count++;
}

// Of a wall of many vertices some are left out: what is left lies within it, as it is convex.
static void wall_put(hiz_shapes *s, const uint32_t *loop, uint32_t count)
{
    uint32_t kept[HIZ_LOOP_MOST];
    const uint32_t size = count < HIZ_LOOP_MOST ? count : HIZ_LOOP_MOST;
    for (uint32_t i = 0; i < size; i++) kept[i] = loop[(uint64_t)i * count / size];
    face_put(s, kept, size);
}

// ---- Triangles to polygons ----

typedef struct vec { double x, y, z; } vec;

static vec vec_between(cull_vec3 a, cull_vec3 b)
{
    const vec v = {(double)b.x - (double)a.x, (double)b.y - (double)a.y, (double)b.z - (double)a.z};
    return v;
}

static double height_over(const hiz_shapes *s, const hiz_face *f, uint32_t vertex)
{
    const vec v = vec_between(s->positions[s->vertices[f->first]], s->positions[vertex]);
    return v.x * (double)f->normal[0] + v.y * (double)f->normal[1] + v.z * (double)f->normal[2];
}

// Its points lie on f's plane, as far as floats can tell.
static int is_flat_with(const hiz_shapes *s, const hiz_face *f, const hiz_face *other, double tolerance)
{
    const float *a = f->normal, *b = other->normal;
    if (a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < 0.9999f) return 0;
    for (uint32_t i = 0; i < other->count; i++)
        if (!(fabs(height_over(s, f, s->vertices[other->first + i])) <= tolerance)) return 0;
    return 1;
}

static int is_convex(const hiz_shapes *s, const float normal[3], const uint32_t *loop, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const cull_vec3 a = s->positions[loop[i]], b = s->positions[loop[(i + 1) % count]], c = s->positions[loop[(i + 2) % count]];
        const vec u = vec_between(a, b), v = vec_between(b, c);
        const double x = u.y * v.z - u.z * v.y, y = u.z * v.x - u.x * v.z, z = u.x * v.y - u.y * v.x;
        const double turn = x * (double)normal[0] + y * (double)normal[1] + z * (double)normal[2];
        if (!(turn >= 0)) return 0;
    }
    return 1;
}

// The loop round both, where they share one edge. Returns its size, 0: they don't, or it is too long.
static uint32_t loop_round(const hiz_shapes *s, const hiz_face *f, const hiz_face *g, uint32_t out[HIZ_LOOP_MOST])
{
    const uint32_t *a = s->vertices + f->first, *b = s->vertices + g->first;
    if (f->count + g->count - 2 > HIZ_LOOP_MOST) return 0;
    for (uint32_t i = 0; i < f->count; i++)
        for (uint32_t k = 0; k < g->count; k++) {
            if (a[i] != b[(k + 1) % g->count] || a[(i + 1) % f->count] != b[k]) continue;
            uint32_t count = 0;
            for (uint32_t n = 1; n <= f->count; n++) out[count++] = a[(i + n) % f->count]; // from the edge's end round to its start
            for (uint32_t n = 2; n < g->count; n++) out[count++] = b[(k + n) % g->count];
            return count;
        }
    return 0;
}

// Two triangles of a wall leave no gap along their common edge when they are one polygon. A joined face keeps its place with
// room for all of its vertices at the list's end; the other goes.
static int faces_join(hiz_shapes *s, hiz_face *f, hiz_face *g, double tolerance)
{
    uint32_t loop[HIZ_LOOP_MOST];
    if (!is_flat_with(s, f, g, tolerance)) return 0;
    const uint32_t count = loop_round(s, f, g, loop);
    if (!count || !is_convex(s, f->normal, loop, count)) return 0;
    f->first = s->vertex_count;
    f->count = count;
    memcpy(s->vertices + s->vertex_count, loop, count * sizeof *loop);
    s->vertex_count += count;
    g->count = 0;
    return 1;
}

enum { JOIN_FACES_MOST = 512 }; // of an item with more triangles each is a face of its own: pairs are tried out

static void triangles_put(hiz_shapes *s, const cull_zone *zone, const cull_item *is)
{
    const uint32_t first = s->face_count;
    const double tolerance = (double)zone->radius / 1048576;
    for (uint32_t i = 0; i + 3 <= is->index_count; i += 3) face_put(s, zone->indices + is->first_index + i, 3);
    if (s->face_count - first > JOIN_FACES_MOST) return;
    for (uint32_t f = first; f < s->face_count; f++)
        for (uint32_t g = first; g < s->face_count && s->faces[f].count; g++) {
            if (g == f || !s->faces[g].count || !faces_join(s, &s->faces[f], &s->faces[g], tolerance)) continue;
            g = first - 1; // the longer loop may take faces passed over
        }
    uint32_t kept = first;
    for (uint32_t f = first; f < s->face_count; f++)
        if (s->faces[f].count) s->faces[kept++] = s->faces[f];
    s->face_count = kept;
}

static void item_put(hiz_shapes *s, const cull_zone *zone, uint32_t item, hiz_shape *out)
{
    const cull_item *is = &zone->items[item];
    const uint32_t in_wall = wall_vertices_of(zone, item);
    out->kind = (uint16_t)kind_of(zone, item);
    out->is_one_sided = (is->flags & CULL_ITEM_WALL) && !(is->flags & CULL_ITEM_TWO_SIDED);
    out->first_face = s->face_count;
    if (out->kind == HIZ_HIDES_AS_LOOPS) {
        if (in_wall >= 3) wall_put(s, zone->wall_vertices + zone->walls[item].first_vertex, in_wall);
        else triangles_put(s, zone, is);
    }
    out->face_count = s->face_count - out->first_face;
}

cull_result hiz_shapes_make(const cull_host *host, const cull_zone *zone, const uint32_t *items, hiz_shapes *out)
{
    hiz_shapes s = {.positions = zone->positions, .shape_most = zone->item_count};
    for (uint32_t i = 0; i < zone->item_count; i++) {
        if (kind_of(zone, i) != HIZ_HIDES_AS_LOOPS) continue;
        const size_t corners = wall_vertices_of(zone, i), triangles = zone->items[i].index_count / 3;
        s.face_most += corners >= 3 ? 1 : triangles;
        s.vertex_most += corners >= 3 ? HIZ_LOOP_MOST : 3 * triangles + triangles * HIZ_LOOP_MOST; // each joining writes a loop anew
    }
    s.shapes = array_alloc(host, s.shape_most, sizeof *s.shapes);
    s.faces = array_alloc(host, s.face_most, sizeof *s.faces);
    s.vertices = array_alloc(host, s.vertex_most, sizeof *s.vertices);
    if (!s.shapes || !s.faces || !s.vertices || s.face_most > UINT32_MAX || s.vertex_most > UINT32_MAX) {
        hiz_shapes_free(host, &s);
        return CULL_ERR_MEMORY;
    }
    for (uint32_t slot = 0; slot < zone->item_count; slot++) item_put(&s, zone, items[slot], &s.shapes[slot]);
    *out = s;
    return CULL_OK;
}

void hiz_shapes_free(const cull_host *host, hiz_shapes *s)
{
    array_free(host, s->shapes, s->shape_most, sizeof *s->shapes);
    array_free(host, s->faces, s->face_most, sizeof *s->faces);
    array_free(host, s->vertices, s->vertex_most, sizeof *s->vertices);
    *s = (hiz_shapes){.shapes = NULL};
}

size_t hiz_shapes_bytes(const hiz_shapes *s)
{
    return s->shape_most * sizeof *s->shapes + s->face_most * sizeof *s->faces + s->vertex_most * sizeof *s->vertices;
}

void hiz_face_loop(const hiz_shapes *s, const hiz_face *face, const double eye[3], hiz_loop *out)
{
    out->count = face->count;
    for (int k = 0; k < 3; k++) out->normal[k] = (double)face->normal[k];
    for (uint32_t i = 0; i < face->count; i++) {
        const cull_vec3 p = s->positions[s->vertices[face->first + i]];
        out->points[i][0] = (double)p.x - eye[0];
        out->points[i][1] = (double)p.y - eye[1];
        out->points[i][2] = (double)p.z - eye[2];
    }
}
