// See pieces_mesh.h.
// SPDX-License-Identifier: MIT
// Invariant: two polygons of an item that share a stretch of an edge have the same vertices along it, bit for bit (cuts that end
// in the middle of a neighbour's edge are made vertices of it too), so a rasterizer gives each pixel to one of them.
#include "pieces_mesh.h"

#include <portcullis/clip.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Points within this share of the radius are one: cuts of one edge by several planes, computed in double, agree to 2^-45 or so,
// and a float cannot tell points apart that are nearer than 2^-25.
static const double WELD_SHARE = 1.0 / 4294967296; // 2^-32
// A piece is on a triangle's plane within this share: its corners are floats (2^-24 each), planes go through rounded corners.
static const double PLANE_SHARE = 1.0 / 262144; // 2^-18
static const double AREA_SHARE = 1.0 / 4096;    // that the pieces' area may differ from the item's

typedef struct polygon { uint32_t first, count, triangle, piece; } polygon; // in points; piece: place in the request's numbers
typedef struct corner { cull_point p; uint32_t same, is_corner; } corner;   // same: the point that it is welded to
typedef struct place { double key; uint32_t point, reserved; } place;       // points by one coordinate

typedef struct item_cut {
    pieces_mesh *m;
    const pieces_mesh_request *q;
    double weld, plane; // metres
    int axis;           // along which the item is longest
    double area;        // of its triangles
} item_cut;

pieces_mesh pieces_mesh_make(const allocator *memory)
{
    return (pieces_mesh){.vertices = buffer_make(memory, sizeof(piece_vertex)), .indices = buffer_make(memory, sizeof(uint32_t)),
                         .points = buffer_make(memory, sizeof(corner)), .polygons = buffer_make(memory, sizeof(polygon)),
                         .places = buffer_make(memory, sizeof(place)), .loop = buffer_make(memory, sizeof(uint32_t)),
                         .clip = {buffer_make(memory, sizeof(cull_point)), buffer_make(memory, sizeof(cull_point))}, .memory = memory};
}

void pieces_mesh_free(pieces_mesh *m)
{
    buffer *all[] = {&m->vertices, &m->indices, &m->points, &m->polygons, &m->places, &m->loop, &m->clip[0], &m->clip[1]};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
}

// ---- Small mathematics ----

static cull_point minus(cull_point a, cull_point b)
{
    return (cull_point){a.x - b.x, a.y - b.y, a.z - b.z};
}

static cull_point cross(cull_point a, cull_point b)
{
    return (cull_point){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(cull_point a, cull_point b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double length(cull_point a)
{
    return sqrt(dot(a, a));
}

static double along(cull_point p, int axis)
{
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

static cull_point position_of(const scene *s, uint32_t vertex)
{
    const cull_vec3 p = s->positions[vertex];
    return (cull_point){p.x, p.y, p.z};
}

static void corners_of(const scene *s, uint32_t triangle, cull_point out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = position_of(s, s->indices[(size_t)3 * triangle + (size_t)k]);
}

// Twice its area, along its normal.
static cull_point area_of(const cull_point *points, uint32_t count)
{
    cull_point sum = {0, 0, 0};
    for (uint32_t i = 2; i < count; ++i) {
        const cull_point c = cross(minus(points[i - 1], points[0]), minus(points[i], points[0]));
        sum = (cull_point){sum.x + c.x, sum.y + c.y, sum.z + c.z};
    }
    return sum;
}

// ---- Pieces cut by triangles ----

static corner *push_point(pieces_mesh *m, cull_point p, uint32_t is_corner)
{
    corner *c = buffer_push(&m->points, 1);
    if (c) *c = (corner){p, (uint32_t)m->points.count - 1, is_corner};
    return c;
}

static cull_point *room_for(buffer *b, size_t count)
{
    b->count = 0;
    return buffer_push(b, count);
}

static int lies_in(const item_cut *c, const cull_point *loop, uint32_t count, const cull_point t[3], cull_point normal)
{
    for (uint32_t i = 0; i < count; ++i)
        if (fabs(dot(normal, minus(loop[i], t[0]))) > c->plane) return 0;
    return dot(area_of(loop, count), normal) > 0;
}

// The part of the loop inside the triangle, in m->clip[result].
static int cut_by(pieces_mesh *m, uint32_t *count, const cull_point t[3], cull_point normal, uint32_t capacity)
{
    int at = 0;
    for (int k = 0; k < 3 && *count >= 3; ++k) {
        const cull_point edge = minus(t[(k + 1) % 3], t[k]), inward = cross(normal, edge);
        const double scale = 1 / length(edge);
        const cull_cut cut = {inward.x * scale, inward.y * scale, inward.z * scale, -dot(inward, t[k]) * scale};
        *count = cull_polygon_clip(m->clip[at].items, *count, cut, m->clip[!at].items, capacity);
        at = !at;
    }
    return at;
}

static result cut_piece(item_cut *c, uint32_t piece, uint32_t triangle)
{
    pieces_mesh *m = c->m;
    const cull_piece *from = &c->q->lent->pieces[c->q->numbers[piece]];
    const uint32_t capacity = 2 * from->point_count + 6;
    cull_point t[3], *loop = room_for(&m->clip[0], capacity);
    if (!loop || !room_for(&m->clip[1], capacity)) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < from->point_count; ++i) {
        const double *p = c->q->lent->points[from->first_point + i];
        loop[i] = (cull_point){p[0] + c->q->offset[0], p[1] + c->q->offset[1], p[2] + c->q->offset[2]};
    }
    corners_of(c->q->scene, triangle, t);
    const cull_point area = area_of(t, 3);
    const double size = length(area);
    const cull_point normal = {area.x / size, area.y / size, area.z / size};
    uint32_t count = from->point_count;
    if (!(size > 0) || !lies_in(c, loop, count, t, normal)) return RESULT_OK;
    const int at = cut_by(m, &count, t, normal, capacity);
    if (count < 3) return RESULT_OK;
    const cull_point *out = m->clip[at].items;
    const polygon made = {(uint32_t)m->points.count, count, triangle, piece};
    for (uint32_t i = 0; i < count; ++i)
        if (!push_point(m, out[i], 0)) return RESULT_NO_MEMORY;
    return buffer_append(&m->polygons, &made, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static result cut_all(item_cut *c)
{
    const scene_item *item = &c->q->scene->items[c->q->item];
    const uint32_t first = item->first_index / 3, end = first + item->index_count / 3;
    for (uint32_t t = first; t < end; ++t) { // corners first: what is welded to one stands there
        cull_point corners[3];
        corners_of(c->q->scene, t, corners);
        c->area += length(area_of(corners, 3));
        for (int k = 0; k < 3; ++k)
            if (!push_point(c->m, corners[k], 1)) return RESULT_NO_MEMORY;
    }
    for (uint32_t piece = 0; piece < c->q->count; ++piece)
        for (uint32_t t = first; t < end; ++t) {
            const result done = cut_piece(c, piece, t);
            if (done != RESULT_OK) return done;
        }
    return RESULT_OK;
}

// ---- Points that are one ----

static int compare_places(const void *a, const void *b)
{
    const place *p = a, *q = b;
    if (p->key != q->key) return p->key < q->key ? -1 : 1;
    return p->point < q->point ? -1 : p->point > q->point;
}

static int axis_of(const corner *points, size_t count)
{
    double widest = -1;
    int axis = 0;
    for (int k = 0; k < 3; ++k) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < count; ++i) {
            low = fmin(low, along(points[i].p, k));
            high = fmax(high, along(points[i].p, k));
        }
        if (high - low > widest) {
            widest = high - low;
            axis = k;
        }
    }
    return axis;
}

static int are_one(const item_cut *c, cull_point a, cull_point b)
{
    return fabs(a.x - b.x) <= c->weld && fabs(a.y - b.y) <= c->weld && fabs(a.z - b.z) <= c->weld;
}

// Each point is welded to the first one near it; places then holds one of each.
static result weld(item_cut *c)
{
    pieces_mesh *m = c->m;
    corner *points = m->points.items;
    const size_t count = m->points.count;
    m->places.count = 0;
    place *places = buffer_push(&m->places, count);
    if (!places) return RESULT_NO_MEMORY;
    c->axis = axis_of(points, count);
    for (size_t i = 0; i < count; ++i) places[i] = (place){along(points[i].p, c->axis), (uint32_t)i, 0};
    qsort(places, count, sizeof *places, compare_places);
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
        corner *p = &points[places[i].point];
        size_t k = kept;
        while (k > 0 && places[i].key - places[k - 1].key <= c->weld && !are_one(c, points[places[k - 1].point].p, p->p)) --k;
        if (k == 0 || places[i].key - places[k - 1].key > c->weld) {
            places[kept++] = places[i];
            continue;
        }
        corner *first = &points[places[k - 1].point];
        p->same = places[k - 1].point;
        if (p->is_corner && !first->is_corner) { // the key is off by less than the weld: places_near takes that in
            first->p = p->p;
            first->is_corner = 1;
        }
    }
    m->places.count = kept;
    return RESULT_OK;
}

// ---- Edges that others' points lie on ----

static size_t first_place(const pieces_mesh *m, double key)
{
    const place *places = m->places.items;
    size_t low = 0, high = m->places.count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (places[middle].key < key) low = middle + 1;
        else high = middle;
    }
    return low;
}

static int push_loop(pieces_mesh *m, uint32_t point)
{
    return buffer_append(&m->loop, &point, 1) != NULL;
}

// Puts those on the edge behind the loop's end, in the order from a to b.
static result put_between(item_cut *c, uint32_t a, uint32_t b)
{
    pieces_mesh *m = c->m;
    const corner *points = m->points.items;
    const place *places = m->places.items;
    const cull_point from = points[a].p, edge = minus(points[b].p, from);
    const double size = length(edge), begins = along(from, c->axis), ends = along(points[b].p, c->axis);
    const double low = fmin(begins, ends), high = fmax(begins, ends);
    const size_t begin = m->loop.count;
    if (!(size > 0)) return RESULT_OK;
    for (size_t i = first_place(m, low - 2 * c->weld); i < m->places.count && places[i].key <= high + 2 * c->weld; ++i) {
        const uint32_t point = places[i].point;
        const cull_point away = minus(points[point].p, from);
        const double t = dot(away, edge) / size; // metres along
        if (point == a || point == b || t <= 0 || t >= size || length(cross(edge, away)) > c->weld * size) continue;
        if (!push_loop(m, point)) return RESULT_NO_MEMORY;
        uint32_t *loop = m->loop.items;
        for (size_t k = m->loop.count - 1; k > begin && dot(minus(points[loop[k - 1]].p, from), edge) > t * size; --k) {
            loop[k] = loop[k - 1];
            loop[k - 1] = point;
        }
    }
    return RESULT_OK;
}

// The polygon's corners, welded, with those of others between them. Less than 3: it is nothing.
static result loop_of(item_cut *c, const polygon *of)
{
    pieces_mesh *m = c->m;
    const corner *points = m->points.items;
    uint32_t last = points[of->first + of->count - 1].same;
    m->loop.count = 0;
    for (uint32_t i = 0; i < of->count; ++i) {
        const uint32_t at = points[of->first + i].same;
        if (at == last) continue;
        const result done = put_between(c, last, at);
        if (done != RESULT_OK) return done;
        if (!push_loop(m, at)) return RESULT_NO_MEMORY;
        last = at;
    }
    return RESULT_OK;
}

// ---- Triangles ----

static void weights_of(const cull_point t[3], cull_point p, double out[3])
{
    const cull_point normal = area_of(t, 3);
    const double all = dot(normal, normal);
    for (int k = 0; k < 3; ++k) {
        if (p.x == t[k].x && p.y == t[k].y && p.z == t[k].z) {
            out[0] = out[1] = out[2] = 0;
            out[k] = 1;
            return;
        }
    }
    for (int k = 0; k < 3; ++k) out[k] = dot(normal, cross(minus(t[(k + 2) % 3], t[(k + 1) % 3]), minus(p, t[(k + 1) % 3]))) / all;
}

static int push_vertex(item_cut *c, cull_point p, uint32_t triangle, uint32_t is_centre)
{
    cull_point t[3];
    piece_vertex v = {{(float)p.x, (float)p.y, (float)p.z}, triangle, {0}, is_centre};
    corners_of(c->q->scene, triangle, t);
    weights_of(t, p, v.weights);
    return buffer_append(&c->m->vertices, &v, 1) != NULL;
}

// Round its centre: each triangle has area, however many of the loop's points lie on one line.
static result fan(item_cut *c, const polygon *of)
{
    pieces_mesh *m = c->m;
    const uint32_t *loop = m->loop.items;
    const corner *points = m->points.items;
    const uint32_t count = (uint32_t)m->loop.count;
    if (m->vertices.count > UINT32_MAX / 2) return RESULT_NO_MEMORY;
    const uint32_t first = (uint32_t)m->vertices.count;
    cull_point centre = {0, 0, 0};
    for (uint32_t i = 0; i < count; ++i) {
        const cull_point p = points[loop[i]].p;
        centre = (cull_point){centre.x + p.x / count, centre.y + p.y / count, centre.z + p.z / count};
        if (!push_vertex(c, p, of->triangle, 0)) return RESULT_NO_MEMORY;
    }
    if (!push_vertex(c, centre, of->triangle, 1)) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t triangle[3] = {first + i, first + (i + 1 < count ? i + 1 : 0), first + count};
        if (!buffer_append(&m->indices, triangle, 3)) return RESULT_NO_MEMORY;
    }
    return RESULT_OK;
}

static result emit(item_cut *c, piece_span *spans)
{
    pieces_mesh *m = c->m;
    const polygon *polygons = m->polygons.items;
    uint32_t open = UINT32_MAX;
    for (uint32_t i = 0; i < c->q->count; ++i) spans[i] = (piece_span){0, 0};
    for (size_t i = 0; i < m->polygons.count; ++i) { // a piece's polygons stand together
        if (polygons[i].piece != open) spans[open = polygons[i].piece].first_index = (uint32_t)m->indices.count;
        result done = loop_of(c, &polygons[i]);
        if (done == RESULT_OK && m->loop.count >= 3) done = fan(c, &polygons[i]);
        if (done != RESULT_OK) return done;
        spans[open].index_count = (uint32_t)m->indices.count - spans[open].first_index;
    }
    return RESULT_OK;
}

static int covers_once(const item_cut *c)
{
    const polygon *polygons = c->m->polygons.items;
    const corner *points = c->m->points.items;
    double area = 0;
    for (size_t i = 0; i < c->m->polygons.count; ++i) {
        cull_point sum = {0, 0, 0};
        for (uint32_t k = 2; k < polygons[i].count; ++k) {
            const corner *p = &points[polygons[i].first];
            const cull_point more = cross(minus(p[k - 1].p, p->p), minus(p[k].p, p->p));
            sum = (cull_point){sum.x + more.x, sum.y + more.y, sum.z + more.z};
        }
        area += length(sum);
    }
    return fabs(area - c->area) <= AREA_SHARE * c->area;
}

result pieces_mesh_item(pieces_mesh *m, const pieces_mesh_request *q, piece_span *spans)
{
    const double radius = (double)q->scene->whole.radius;
    item_cut c = {.m = m, .q = q, .weld = WELD_SHARE * radius, .plane = PLANE_SHARE * radius};
    const size_t vertices = m->vertices.count, indices = m->indices.count;
    m->points.count = m->polygons.count = 0;
    result done = cut_all(&c);
    if (done == RESULT_OK && !covers_once(&c)) done = RESULT_BAD_INPUT;
    if (done == RESULT_OK) done = weld(&c);
    if (done == RESULT_OK) done = emit(&c, spans);
    if (done == RESULT_OK) return done;
    m->vertices.count = vertices;
    m->indices.count = indices;
    return done;
}
