// Bodies of brushes: the faces that brush_shape.c cuts, each corner told by its two edges, one place for each in a body.
// SPDX-License-Identifier: MIT
#include "brush_polygons.h"

#include "brush_shape.h"

#include <string.h>

#define BODY_MARGIN 0.0009765625 // steps: corner positions are within 2^-25 of a step

typedef struct body_maker {
    const compile_input *in;
    report *report;
    plane_ref cube[6];
    brush_shape shape;
    buffer planes; // plane_ref: of one brush
    brush_bodies *out;
} body_maker;

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
    const plane_ref plane = m->in->faces[face].plane;
    const shape_corner *loop = m->shape.loop.items;
    const uint32_t count = (uint32_t)m->shape.loop.count;
    const body_polygon polygon = {{plane, (uint32_t)m->out->edges.count, count}, brush, face};
    polygon_edge *edges = buffer_push(&m->out->edges, count);
    if (!edges || !buffer_append(&m->out->polygons, &polygon, 1)) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i) {
        edges[i] = (polygon_edge){.plane = loop[i].edge};
        const plane_ref meet[3] = {plane, loop[i ? i - 1 : count - 1].edge, loop[i].edge};
        const result done = add_corner(m, body, meet, edges[i].start);
        if (done != RESULT_OK) return done;
    }
    body->polygon_count++;
    return RESULT_OK;
}

static result add_face(body_maker *m, uint32_t brush, uint32_t number, brush_body *body)
{
    const compile_input *in = m->in;
    const uint32_t face = in->brushes[brush].first_face + number;
    switch (brush_shape_face(&m->shape, in->planes, m->cube, m->planes.items, (uint32_t)m->planes.count, number)) {
    case SHAPE_NO_MEMORY: return RESULT_NO_MEMORY;
    case SHAPE_EMPTY: return RESULT_OK;
    case SHAPE_OPEN: return report_error(m->report, in->path, in->faces[face].line, "the brush is open here; give it the planes that close it");
    case SHAPE_SOUND: break;
    }
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
    m->planes.count = 0;
    plane_ref *planes = buffer_push(&m->planes, b->face_count);
    if (!planes) return RESULT_NO_MEMORY;
    for (uint32_t f = 0; f < b->face_count; ++f) planes[f] = m->in->faces[b->first_face + f].plane;
    for (uint32_t f = 0; f < b->face_count; ++f) {
        const result done = add_face(m, brush, f, body);
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
                    .shape = brush_shape_make(memory),
                    .planes = buffer_make(memory, sizeof(plane_ref)),
                    .out = out};
    const int made = out->of && buffer_push(&out->polygons, 0) && buffer_push(&out->edges, 0) && buffer_push(&out->corners, 0); // never NULL: of no bodies too
    result done = made && brush_shape_cube(in->planes, m.cube) ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t b = 0; done == RESULT_OK && b < in->brush_count; ++b)
        if ((roles >> in->brushes[b].role & 1) && makes_something(in, &in->brushes[b])) done = add_body(&m, b);
    brush_shape_free(&m.shape);
    buffer_free(&m.planes);
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
