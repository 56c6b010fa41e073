// From the mesh to the surface: vertices by their point, the plane of each edge.
// SPDX-License-Identifier: MIT
#include "surface.h"

#include <assert.h>

typedef struct loader {
    surface *s;
    const compile_input *in;
    const compile_mesh *mesh;
    const uint8_t *seals;
    uint32_t *vertex_of; // of the mesh's vertices
} loader;

static int holds_edge(const surface *s, plane_ref candidate, plane_ref own, const uint32_t ends[2])
{
    return candidate >> 1 != own >> 1 && surface_side(s, ends[0], candidate) == 0 && surface_side(s, ends[1], candidate) == 0;
}

static plane_ref brush_plane(const loader *l, uint32_t brush, plane_ref own, const uint32_t ends[2])
{
    const compile_brush *b = &l->in->brushes[brush];
    for (uint32_t f = 0; f < b->face_count; ++f) {
        const plane_ref candidate = l->in->faces[b->first_face + f].plane;
        if (holds_edge(l->s, candidate, own, ends)) return candidate;
    }
    return PLANE_NONE;
}

static int box_holds(const compile_brush *b, const double p[3])
{
    for (int k = 0; k < 3; ++k)
        if (p[k] < b->min[k] - 1.0 || p[k] > b->max[k] + 1.0) return 0;
    return 1;
}

// An edge of the surface lies on a face of some brush besides the polygon's own.
static plane_ref find_edge_plane(const loader *l, const compile_polygon *p, const uint32_t ends[2])
{
    const surface *s = l->s;
    for (int e = 0; e < 2; ++e)
        for (int i = 0; i < 3; ++i) {
            const plane_ref candidate = surface_vertex_at(s, ends[e])->planes[i];
            if (holds_edge(s, candidate, p->plane, ends)) return candidate;
        }
    plane_ref found = p->brush < l->in->brush_count ? brush_plane(l, p->brush, p->plane, ends) : PLANE_NONE;
    for (uint32_t b = 0; b < l->in->brush_count && found == PLANE_NONE; ++b)
        if (box_holds(&l->in->brushes[b], surface_vertex_at(s, ends[0])->position) &&
            box_holds(&l->in->brushes[b], surface_vertex_at(s, ends[1])->position))
            found = brush_plane(l, b, p->plane, ends);
    return found;
}

// Turned so that the polygon lies behind it.
static plane_ref turned_outward(const surface *s, plane_ref edge, const surface_corner *corners, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        const int side = surface_side(s, corners[i].vertex, edge);
        if (side) return side > 0 ? plane_ref_flipped(edge) : edge;
    }
    return edge;
}

int compile_polygon_is_liquid(const compile_input *in, const compile_polygon *p)
{
    return p->brush < in->brush_count && in->brushes[p->brush].role == BRUSH_LIQUID;
}

static result add_polygon(loader *l, uint32_t number, buffer *corners)
{
    const compile_polygon *p = &l->mesh->polygons[number];
    const uint32_t *loop = l->mesh->loop + p->first_vertex;
    corners->count = 0;
    surface_corner *c = buffer_push(corners, p->vertex_count);
    if (!c) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < p->vertex_count; ++i) c[i].vertex = l->vertex_of[loop[i]];
    for (uint32_t i = 0; i < p->vertex_count; ++i) {
        const uint32_t ends[2] = {c[i].vertex, c[i + 1 < p->vertex_count ? i + 1 : 0].vertex};
        plane_ref edge = l->mesh->edge_planes ? l->mesh->edge_planes[p->first_vertex + i] : PLANE_NONE;
        if (edge == PLANE_NONE) edge = find_edge_plane(l, p, ends);
        assert(edge != PLANE_NONE && holds_edge(l->s, edge, p->plane, ends));
        c[i].edge = turned_outward(l->s, edge, c, p->vertex_count);
    }
    const int is_liquid = compile_polygon_is_liquid(l->in, p);
    const surface_kind liquid = l->seals && l->seals[number] ? SURFACE_SEAL : SURFACE_LIQUID;
    const surface_polygon like = {
        .kind = is_liquid ? liquid : SURFACE_WALL, .material = p->material, .brush = p->brush, .face = p->face, .source = number};
    return surface_add(l->s, p->plane, c, p->vertex_count, &like, NULL);
}

result surface_load(surface *s, const compile_input *in, const compile_mesh *mesh, const uint8_t *seals)
{
    loader l = {s, in, mesh, seals, memory_alloc(s->memory, mesh->vertex_count, sizeof(uint32_t))};
    if (!l.vertex_of) return RESULT_NO_MEMORY;
    buffer corners = buffer_make(s->memory, sizeof(surface_corner));
    result r = RESULT_OK;
    for (uint32_t v = 0; v < mesh->vertex_count && r == RESULT_OK; ++v) r = surface_vertex(s, mesh->vertices[v].planes, &l.vertex_of[v]);
    for (uint32_t p = 0; p < mesh->polygon_count && r == RESULT_OK; ++p) r = add_polygon(&l, p, &corners);
    buffer_free(&corners);
    memory_free(s->memory, l.vertex_of, mesh->vertex_count, sizeof(uint32_t));
    return r;
}
