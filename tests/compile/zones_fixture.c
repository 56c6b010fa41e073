// See zones_fixture.h.
// SPDX-License-Identifier: MIT
#include "tests/common/test.h"

#include "zones_fixture.h"

#include "host/compile/brush_shape.h"
#include "tests/common/report_lines.h"

#include <math.h>
#include <stdlib.h>

void zone_scene_begin(zone_scene *s)
{
    *s = (zone_scene){.draft = draft_make()};
    s->entities[s->entity_count++] = (compile_entity){.class_name = "worldspawn"};
}

void zone_scene_box(zone_scene *s, brush_kind kind, int x, int y, int z, int dx, int dy, int dz)
{
    const int32_t min[3] = {x * UNIT, y * UNIT, z * UNIT}, max[3] = {(x + dx) * UNIT, (y + dy) * UNIT, (z + dz) * UNIT};
    draft_box(&s->draft, kind, min, max, 0);
    s->entities[s->entity_count - 1].brush_count++;
}

void zone_scene_hollow(zone_scene *s, int x, int y, int z, int dx, int dy, int dz)
{
    zone_scene_box(s, BRUSH_ADD, x, y, z, dx, dy, dz);
    zone_scene_box(s, BRUSH_SUBTRACT, x + 8, y + 8, z + 8, dx - 16, dy - 16, dz - 16);
}

static const char *const role_names[] = {"structure", "liquid", "entity", "portal"};

void zone_scene_brushes_of(zone_scene *s, const char *class_name, brush_role role)
{
    assert_true(s->entity_count < ENTITIES_MOST);
    s->entities[s->entity_count++] =
        (compile_entity){.class_name = class_name, .name = role_names[role], .first_brush = (uint32_t)s->draft.brushes.count, .line = (uint32_t)role};
}

void zone_scene_point(zone_scene *s, const char *class_name, double x, double y, double z)
{
    assert_true(s->entity_count < ENTITIES_MOST);
    s->entities[s->entity_count++] = (compile_entity){.class_name = class_name, .origin = {x / 32, y / 32, z / 32}, .has_origin = 1};
}

void zone_scene_end(zone_scene *s)
{
    s->in = draft_input(&s->draft);
    s->in.entities = s->entities;
    s->in.entity_count = s->entity_count;
    brush_shape shape = brush_shape_make(allocator_heap());
    plane_ref cube[6], planes[64];
    assert_true(brush_shape_cube(s->in.planes, cube));
    for (uint32_t e = 0; e < s->entity_count; ++e)
        for (uint32_t i = 0; i < s->entities[e].brush_count; ++i) {
            compile_brush *b = &s->in.brushes[s->entities[e].first_brush + i];
            b->entity = e;
            if (e) b->role = (brush_role)s->entities[e].line;
            for (uint32_t f = 0; f < b->face_count; ++f) planes[f] = s->in.faces[b->first_face + f].plane;
            assert_int_equal(brush_shape_cut(&shape, s->in.planes, cube, planes, b->face_count), SHAPE_SOUND);
            brush_shape_bounds(&shape, s->in.planes, b->min, b->max);
        }
    brush_shape_free(&shape);
}

void zone_scene_free(zone_scene *s)
{
    draft_free(&s->draft);
}

compiled_zones *zones_of(const compile_input *in, portal_choice choice, report *r)
{
    report quiet = {0};
    csg_counts counts;
    compile_mesh *mesh = surface_of(in, &counts);
    compiled_zones *z = NULL;
    assert_int_equal(compile_zones(in, mesh, choice, r ? r : &quiet, allocator_heap(), &z), RESULT_OK);
    return z;
}

uint32_t zones_reached(const compiled_zones *z)
{
    return z->leak ? 0 : z->zone_count - z->zones_sealed;
}

static int is_inside_edge(const compile_input *in, const compile_mesh *m, uint32_t v, const uint32_t ends[2], plane_ref own, plane_ref edge)
{
    const compile_vertex *a = &m->vertices[ends[0]], *b = &m->vertices[ends[1]], *p = &m->vertices[v];
    double along = 0, length = 0, off = 0;
    for (int k = 0; k < 3; ++k) {
        along += (p->position[k] - a->position[k]) * (b->position[k] - a->position[k]);
        length += (b->position[k] - a->position[k]) * (b->position[k] - a->position[k]);
    }
    if (along <= 0 || along >= length) return 0;
    for (int k = 0; k < 3; ++k) {
        const double d = a->position[k] + (b->position[k] - a->position[k]) * along / length - p->position[k];
        off += d * d;
    }
    return off < 1e-4 && plane_table_side(in->planes, p->planes, own) == 0 && plane_table_side(in->planes, p->planes, edge) == 0;
}

uint32_t t_junctions_left(const compile_input *in, const compile_mesh *m)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < m->polygon_count; ++i)
        for (uint32_t k = 0; k < m->polygons[i].vertex_count; ++k) {
            const compile_polygon *p = &m->polygons[i];
            const uint32_t ends[2] = {m->loop[p->first_vertex + k], m->loop[p->first_vertex + (k + 1) % p->vertex_count]};
            for (uint32_t v = 0; v < m->vertex_count; ++v)
                if (v != ends[0] && v != ends[1]) left += is_inside_edge(in, m, v, ends, p->plane, m->edge_planes[p->first_vertex + k]) != 0;
        }
    return left;
}

typedef struct directed { uint32_t low, high; int count; } directed;

static int directed_order(const void *a, const void *b)
{
    const directed *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    return (p->high > q->high) - (p->high < q->high);
}

uint32_t open_edges(const compile_input *in, const compiled_zones *z)
{
    const compile_mesh *m = z->mesh;
    directed *edges = malloc((m->loop_count + 1) * sizeof(*edges));
    assert_non_null(edges);
    size_t count = 0;
    for (uint32_t i = 0; i < m->polygon_count; ++i) {
        const compile_polygon *p = &m->polygons[i];
        if (in->brushes[p->brush].role == BRUSH_LIQUID) continue;
        for (uint32_t k = 0; k < p->vertex_count; ++k) {
            const uint32_t a = m->loop[p->first_vertex + k], b = m->loop[p->first_vertex + (k + 1) % p->vertex_count];
            edges[count++] = (directed){a < b ? a : b, a < b ? b : a, a < b ? 1 : -1};
        }
    }
    qsort(edges, count, sizeof(*edges), directed_order);
    uint32_t open = 0;
    for (size_t i = 0; i < count;) {
        int sum = 0;
        size_t end = i;
        while (end < count && directed_order(&edges[i], &edges[end]) == 0) sum += edges[end++].count;
        open += sum != 0;
        i = end;
    }
    free(edges);
    return open;
}

uint32_t polygons_in_zone(const compiled_zones *z, uint32_t zone)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < z->mesh->polygon_count; ++i) count += z->polygon_zone[i] == zone;
    return count;
}
