// Bodies of brushes: each face begins as a square wider than the world and is clipped by the brush's other planes.
// SPDX-License-Identifier: MIT
#include "brush_polygons.h"

#include <string.h>

// Wider than any coordinate, so that a square edge left over means an open brush. Room for the error of doubled corners.
enum { WORLD_STEPS = 1 << (COMPILE_COORDINATE_BITS + 1) };
#define BODY_MARGIN 0.0009765625 // steps: corner positions are within 2^-25 of a step

typedef struct body_maker {
    const compile_input *in;
    report *report;
    plane_ref walls[6]; // -x, +x, -y, +y, -z, +z: the world's box, fronts outside
    buffer loop, clipped, sides; // plane_ref, plane_ref, int8_t
    brush_bodies *out;
} body_maker;

static int add_walls(body_maker *m)
{
    for (int i = 0; i < 6; ++i) {
        cull_wide_plane wall = {{0, 0, 0}, cull_wide_from(-WORLD_STEPS)};
        wall.normal[i / 2] = i & 1 ? 1 : -1;
        m->walls[i] = plane_table_add(m->in->planes, &wall);
        if (m->walls[i] == PLANE_NONE) return 0;
    }
    return 1;
}

// Counterclockwise from the front: walls round the axis that the plane faces most.
static int start_loop(body_maker *m, plane_ref plane)
{
    const cull_wide_plane p = plane_table_get(m->in->planes, plane);
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (cull_magnitude(p.normal[k]) > cull_magnitude(p.normal[axis])) axis = k;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const plane_ref up[4] = {m->walls[2 * u + 1], m->walls[2 * v + 1], m->walls[2 * u], m->walls[2 * v]};
    const plane_ref down[4] = {up[0], up[3], up[2], up[1]};
    m->loop.count = 0;
    return buffer_append(&m->loop, p.normal[axis] > 0 ? up : down, 4) != NULL;
}

static unsigned classify(body_maker *m, plane_ref plane, plane_ref by)
{
    const plane_ref *loop = m->loop.items;
    int8_t *sides = m->sides.items;
    unsigned seen = 0;
    for (size_t i = 0; i < m->loop.count; ++i) {
        const plane_ref meet[3] = {plane, loop[i ? i - 1 : m->loop.count - 1], loop[i]};
        sides[i] = (int8_t)plane_table_side(m->in->planes, meet, by);
        seen |= sides[i] > 0 ? POLYGON_FRONT : sides[i] < 0 ? POLYGON_BEHIND : POLYGON_ON;
    }
    return seen;
}

// Keeps what is behind `by`; an empty loop: nothing.
static int clip_loop(body_maker *m, plane_ref plane, plane_ref by)
{
    m->sides.count = m->clipped.count = 0;
    if (!buffer_push(&m->sides, m->loop.count) || !buffer_push(&m->clipped, m->loop.count + 1)) return 0;
    const unsigned seen = classify(m, plane, by);
    if (!(seen & POLYGON_BEHIND)) m->loop.count = 0;
    if (seen != POLYGON_ACROSS) return 1;
    const plane_ref *loop = m->loop.items;
    plane_ref *to = m->clipped.items;
    const int8_t *sides = m->sides.items;
    size_t n = 0;
    for (size_t i = 0; i < m->loop.count; ++i) {
        const size_t next = i + 1 < m->loop.count ? i + 1 : 0;
        if (sides[i] >= 0 && sides[next] >= 0) continue;
        to[n++] = loop[i];
        if (sides[next] >= 0) to[n++] = by;
    }
    m->clipped.count = n;
    const buffer kept = m->loop;
    m->loop = m->clipped;
    m->clipped = kept;
    return 1;
}

static int is_open(const body_maker *m)
{
    const plane_ref *loop = m->loop.items;
    for (size_t i = 0; i < m->loop.count; ++i)
        for (int w = 0; w < 6; ++w)
            if (loop[i] == m->walls[w]) return 1;
    return 0;
}

static void sort_three(plane_ref p[3])
{
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j + 1 < 3 - i; ++j)
            if (p[j] > p[j + 1]) {
                const plane_ref t = p[j];
                p[j] = p[j + 1];
                p[j + 1] = t;
            }
}

static result add_corner(body_maker *m, brush_body *body, const plane_ref meet[3], double position[3])
{
    body_corner corner = {.meet = {meet[0], meet[1], meet[2]}};
    sort_three(corner.meet);
    const body_corner *known = (const body_corner *)m->out->corners.items + body->first_corner;
    for (uint32_t i = 0; i < body->corner_count; ++i)
        if (memcmp(known[i].meet, corner.meet, sizeof corner.meet) == 0) {
            memcpy(position, known[i].position, sizeof corner.position);
            return RESULT_OK;
        }
    plane_table_position(m->in->planes, corner.meet, corner.position);
    memcpy(position, corner.position, sizeof corner.position);
    for (int k = 0; k < 3; ++k) {
        if (body->corner_count == 0 || position[k] - BODY_MARGIN < body->min[k]) body->min[k] = position[k] - BODY_MARGIN;
        if (body->corner_count == 0 || position[k] + BODY_MARGIN > body->max[k]) body->max[k] = position[k] + BODY_MARGIN;
    }
    body->corner_count++;
    return buffer_append(&m->out->corners, &corner, 1) ? RESULT_OK : RESULT_NO_MEMORY;
}

static result add_polygon(body_maker *m, uint32_t brush, uint32_t face, brush_body *body)
{
    const plane_ref plane = m->in->faces[face].plane, *loop = m->loop.items;
    const uint32_t count = (uint32_t)m->loop.count;
    const body_polygon polygon = {{plane, (uint32_t)m->out->edges.count, count}, brush, face};
    polygon_edge *edges = buffer_push(&m->out->edges, count);
    if (!edges || !buffer_append(&m->out->polygons, &polygon, 1)) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i) {
        edges[i] = (polygon_edge){.plane = loop[i]};
        const plane_ref meet[3] = {plane, loop[i ? i - 1 : count - 1], loop[i]};
        const result done = add_corner(m, body, meet, edges[i].start);
        if (done != RESULT_OK) return done;
    }
    body->polygon_count++;
    return RESULT_OK;
}

// The first of equal planes keeps the face; a plane and its opposite leave nothing.
static result add_face(body_maker *m, uint32_t brush, uint32_t face, brush_body *body)
{
    const compile_input *in = m->in;
    const compile_brush *b = &in->brushes[brush];
    const plane_ref plane = in->faces[face].plane;
    if (!start_loop(m, plane)) return RESULT_NO_MEMORY;
    for (uint32_t other = b->first_face; other < b->first_face + b->face_count && m->loop.count; ++other) {
        const plane_ref by = in->faces[other].plane;
        if (by == plane && other >= face) continue;
        if (by >> 1 == plane >> 1) m->loop.count = 0;
        else if (!clip_loop(m, plane, by)) return RESULT_NO_MEMORY;
    }
    if (m->loop.count == 0) return RESULT_OK;
    if (is_open(m))
        return report_error(m->report, in->path, in->faces[face].line, "the brush is open here; give it the planes that close it");
    return add_polygon(m, brush, face, body);
}

static int makes_something(const compile_input *in, const compile_brush *b)
{
    for (uint32_t f = 0; f < b->face_count; ++f)
        if (in->faces[b->first_face + f].material != COMPILE_NOTHING) return 1;
    return 0;
}

static result add_body(body_maker *m, uint32_t brush)
{
    const compile_brush *b = &m->in->brushes[brush];
    brush_body *body = &m->out->of[brush];
    *body = (brush_body){.first_polygon = (uint32_t)m->out->polygons.count, .first_corner = (uint32_t)m->out->corners.count};
    for (uint32_t f = 0; f < b->face_count; ++f) {
        const result done = add_face(m, brush, b->first_face + f, body);
        if (done != RESULT_OK) return done;
    }
    if (body->polygon_count >= 4) return RESULT_OK;
    report_warning(m->report, m->in->path, b->face_count ? m->in->faces[b->first_face].line : 0,
                   "the brush encloses nothing and is left out; turn its faces outwards or remove it");
    m->out->polygons.count = body->first_polygon;
    m->out->corners.count = body->first_corner;
    body->polygon_count = body->corner_count = 0;
    return RESULT_OK;
}

result brush_bodies_make(const compile_input *in, unsigned roles, report *r, const allocator *memory, brush_bodies *out)
{
    *out = (brush_bodies){.polygons = buffer_make(memory, sizeof(body_polygon)),
                          .edges = buffer_make(memory, sizeof(polygon_edge)),
                          .corners = buffer_make(memory, sizeof(body_corner)),
                          .brush_count = in->brush_count};
    out->of = memory_alloc_zeroed(memory, in->brush_count, sizeof *out->of);
    body_maker m = {.in = in,
                    .report = r,
                    .loop = buffer_make(memory, sizeof(plane_ref)),
                    .clipped = buffer_make(memory, sizeof(plane_ref)),
                    .sides = buffer_make(memory, 1),
                    .out = out};
    result done = out->of && add_walls(&m) ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t b = 0; done == RESULT_OK && b < in->brush_count; ++b)
        if ((roles >> in->brushes[b].role & 1) && makes_something(in, &in->brushes[b])) done = add_body(&m, b);
    buffer_free(&m.loop);
    buffer_free(&m.clipped);
    buffer_free(&m.sides);
    if (done == RESULT_OK) return done;
    if (out->of) brush_bodies_free(out);
    *out = (brush_bodies){0};
    return done;
}

void brush_bodies_free(brush_bodies *b)
{
    const allocator *memory = b->polygons.memory;
    if (!memory) return;
    memory_free(memory, b->of, b->brush_count, sizeof *b->of);
    buffer_free(&b->polygons);
    buffer_free(&b->edges);
    buffer_free(&b->corners);
    *b = (brush_bodies){0};
}
