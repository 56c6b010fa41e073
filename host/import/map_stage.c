// Staging of brushes: see map_stage.h.
// SPDX-License-Identifier: MIT
#include "map_stage.h"

#include <math.h>
#include <string.h>

static const double REACH = 2 * MAP_COORDINATE_MOST; // units: a body that ends farther out counts as open
static const double ON_PLANE = 1.0 / 256;            // units (0.1 mm): editors save off-grid points to 1e-4 at best
static const double STRAIGHT = 1.0 / 4096;           // units (8 um): the float step of a scene of 128 m
static const float TEXELS = 64;                      // what a texture coordinate of 1 is

map_stage map_stage_make(const allocator *memory)
{
    map_stage s = {.polygons = buffer_make(memory, sizeof(staged_polygon)),
                   .points = buffer_make(memory, sizeof(staged_point)),
                   .solids = buffer_make(memory, sizeof(staged_solid)),
                   .solid_planes = buffer_make(memory, sizeof(staged_plane)),
                   .body = brush_body_make(memory),
                   .planes = buffer_make(memory, sizeof(brush_plane))};
    map_stage_clear(&s);
    return s;
}

void map_stage_free(map_stage *s)
{
    buffer *const all[] = {&s->polygons, &s->points, &s->solids, &s->solid_planes, &s->planes};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    brush_body_free(&s->body);
}

void map_stage_clear(map_stage *s)
{
    s->polygons.count = s->points.count = s->solids.count = s->solid_planes.count = 0;
    for (int k = 0; k < 3; ++k) {
        s->min[k] = INFINITY;
        s->max[k] = -INFINITY;
    }
}

static const map_face *faces_of(const map_entity *e, const map_brush *brush)
{
    return (const map_face *)e->faces.items + brush->first_face;
}

typedef struct brush_look { int visible, liquid; } brush_look; // liquid: one face is enough, as in Quake's compilers

static brush_look look_of(const map_face *faces, size_t count)
{
    brush_look look = {0};
    for (size_t i = 0; i < count; ++i) {
        const texture_kind kind = texture_kind_of(faces[i].texture);
        look.visible |= kind != TEXTURE_TOOL;
        look.liquid |= kind == TEXTURE_LIQUID;
    }
    return look;
}

static result find_planes(map_stage *s, const map_entity *e, size_t number, const map_reader *m)
{
    const map_brush *brush = (const map_brush *)e->brushes.items + number;
    const map_face *faces = faces_of(e, brush);
    s->planes.count = 0;
    brush_plane *planes = buffer_push(&s->planes, brush->face_count);
    if (!planes) return report_no_memory(m->report, m->path);
    for (size_t i = 0; i < brush->face_count; ++i)
        if (!brush_plane_from_points(faces[i].points, &planes[i]))
            return report_error(m->report, m->path, faces[i].line, "entity %u brush %zu: the three points of a face lie on one line; move one",
                                e->number, number);
    return RESULT_OK;
}

typedef struct bounds { double min[3], max[3]; } bounds;

static bounds bounds_of(const brush_body *body)
{
    bounds b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    const brush_loop *loops = body->loops.items;
    const uint32_t *corners = body->corners.items;
    const brush_vertex *vertices = body->vertices.items;
    for (size_t l = 0; l < body->loops.count; ++l)
        for (uint32_t i = 0; i < loops[l].count; ++i)
            for (int k = 0; k < 3; ++k) {
                b.min[k] = fmin(b.min[k], vertices[corners[loops[l].first + i]].position[k]);
                b.max[k] = fmax(b.max[k], vertices[corners[loops[l].first + i]].position[k]);
            }
    return b;
}

static result stage_solid(map_stage *s, solid_kind kind, const bounds *b)
{
    const brush_plane *planes = s->planes.items;
    const brush_loop *loops = s->body.loops.items;
    staged_solid solid = {.first_plane = s->solid_planes.count, .plane_count = s->body.loops.count, .kind = kind};
    memcpy(solid.min, b->min, sizeof solid.min);
    memcpy(solid.max, b->max, sizeof solid.max);
    staged_plane *to = buffer_push(&s->solid_planes, s->body.loops.count);
    if (!to || !buffer_append(&s->solids, &solid, 1)) return RESULT_NO_MEMORY;
    for (size_t l = 0; l < s->body.loops.count; ++l) {
        const brush_plane *p = &planes[loops[l].plane];
        for (int k = 0; k < 3; ++k) to[l].normal[k] = p->normal[k] / p->length;
        to[l].distance = p->distance / p->length;
    }
    return RESULT_OK;
}

static result stage_polygon(map_stage *s, const map_face *face, const brush_loop *loop)
{
    uint32_t *corners = (uint32_t *)s->body.corners.items + loop->first;
    const brush_vertex *vertices = s->body.vertices.items;
    const brush_plane *plane = (const brush_plane *)s->planes.items + loop->plane;
    const uint32_t count = brush_loop_for_fan(vertices, corners, loop->count, STRAIGHT);
    if (count < 3) {
        s->polygons_dropped++;
        return RESULT_OK;
    }
    staged_polygon polygon = {.first_point = s->points.count,
                              .point_count = count,
                              .distance = plane->distance / plane->length,
                              .texture = face->texture,
                              .kind = texture_kind_of(face->texture)};
    for (int k = 0; k < 3; ++k) polygon.normal[k] = plane->normal[k] / plane->length + 0.0;
    staged_point *points = buffer_push(&s->points, count);
    if (!points || !buffer_append(&s->polygons, &polygon, 1)) return RESULT_NO_MEMORY;
    const texture_map map = texture_map_of(face, plane->normal);
    for (uint32_t i = 0; i < count; ++i) {
        const double *p = vertices[corners[i]].position;
        memcpy(points[i].position, p, sizeof points[i].position);
        for (int a = 0; a < 2; ++a)
            points[i].texcoord[a] = (float)(p[0] * map.axes[a][0] + p[1] * map.axes[a][1] + p[2] * map.axes[a][2] + map.shift[a]) / TEXELS;
    }
    return RESULT_OK;
}

static result stage_body(map_stage *s, const map_face *faces, entity_body body, brush_look look)
{
    const bounds b = bounds_of(&s->body);
    for (int k = 0; k < 3; ++k) {
        s->min[k] = fmin(s->min[k], b.min[k]);
        s->max[k] = fmax(s->max[k], b.max[k]);
    }
    result done = RESULT_OK;
    if (look.liquid && body != BODY_HOLLOW) done = stage_solid(s, SOLID_LIQUID, &b);
    else if (body != BODY_NONE) done = stage_solid(s, body == BODY_ENTITY ? SOLID_ENTITY : SOLID_STRUCTURE, &b);
    for (size_t l = 0; l < s->body.loops.count && done == RESULT_OK; ++l) {
        const brush_loop *loop = (const brush_loop *)s->body.loops.items + l;
        if (texture_kind_of(faces[loop->plane].texture) != TEXTURE_TOOL) done = stage_polygon(s, &faces[loop->plane], loop);
    }
    return done;
}

result map_stage_brush(map_stage *s, const map_entity *e, size_t number, entity_body body, const map_reader *m)
{
    const map_brush *brush = (const map_brush *)e->brushes.items + number;
    const map_face *faces = faces_of(e, brush);
    const brush_look look = look_of(faces, brush->face_count);
    if (!look.visible) return RESULT_OK;
    result done = find_planes(s, e, number, m);
    if (done != RESULT_OK) return done;
    switch (brush_body_cut(&s->body, s->planes.items, (uint32_t)brush->face_count, REACH, ON_PLANE)) {
    case BRUSH_SOUND: break;
    case BRUSH_NO_MEMORY: return report_no_memory(m->report, m->path);
    case BRUSH_OPEN:
        return report_error(m->report, m->path, brush->line, "entity %u brush %zu: its faces leave it open; add the side that is missing", e->number,
                            number);
    case BRUSH_EMPTY:
        report_warning(m->report, m->path, brush->line, "entity %u brush %zu: its faces leave nothing; dropped", e->number, number);
        return RESULT_OK;
    case BRUSH_BROKEN:
        report_warning(m->report, m->path, brush->line, "entity %u brush %zu: too thin to be a body; dropped", e->number, number);
        return RESULT_OK;
    }
    done = stage_body(s, faces, body, look);
    return done == RESULT_NO_MEMORY ? report_no_memory(m->report, m->path) : done;
}
