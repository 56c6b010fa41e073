// The compiler's mesh: see mesh.h.
// SPDX-License-Identifier: MIT
#include "mesh.h"

#include <string.h>

// number[v]: the place of vertex v among those used, filled by first use in `vertices`' order.
static uint32_t number_vertices(const polygon_soup *soup, uint32_t vertex_count, uint32_t *number)
{
    const polygon_edge *edges = soup->edges.items;
    memset(number, 0, vertex_count * sizeof *number);
    for (size_t e = 0; e < soup->edges.count; ++e) number[edges[e].vertex] = 1;
    uint32_t used = 0;
    for (uint32_t v = 0; v < vertex_count; ++v)
        if (number[v]) number[v] = used++;
    return used;
}

static void fill(const compile_input *in, const polygon_soup *soup, const buffer *vertices, const uint32_t *number, compile_mesh *m)
{
    const body_polygon *polygons = soup->polygons.items;
    const polygon_edge *edges = soup->edges.items;
    const compile_vertex *from = vertices->items;
    for (size_t p = 0; p < soup->polygons.count; ++p) {
        const plane_polygon *shape = &polygons[p].shape;
        m->polygons[p] = (compile_polygon){.plane = shape->plane,
                                           .first_vertex = m->loop_count,
                                           .vertex_count = shape->count,
                                           .material = in->faces[polygons[p].face].material,
                                           .brush = polygons[p].brush,
                                           .face = polygons[p].face};
        for (uint32_t i = 0; i < shape->count; ++i) {
            const polygon_edge *e = &edges[shape->first + i];
            m->vertices[number[e->vertex]] = from[e->vertex];
            m->loop[m->loop_count] = number[e->vertex];
            m->edge_planes[m->loop_count++] = e->plane;
        }
    }
    m->polygon_count = (uint32_t)soup->polygons.count;
}

result compile_mesh_make(const compile_input *in, const polygon_soup *soup, const buffer *vertices, const allocator *memory, compile_mesh **out)
{
    const uint32_t vertex_count = (uint32_t)vertices->count;
    *out = NULL;
    uint32_t *number = memory_alloc(memory, vertex_count, sizeof *number);
    compile_mesh *m = memory_alloc_zeroed(memory, 1, sizeof *m);
    if (number && m) {
        m->memory = arena_make(memory);
        m->vertex_count = number_vertices(soup, vertex_count, number);
        m->vertices = arena_push(&m->memory, m->vertex_count, sizeof *m->vertices);
        m->loop = arena_push(&m->memory, soup->edges.count, sizeof *m->loop);
        m->edge_planes = arena_push(&m->memory, soup->edges.count, sizeof *m->edge_planes);
        m->polygons = arena_push(&m->memory, soup->polygons.count, sizeof *m->polygons);
        if (m->vertices && m->loop && m->edge_planes && m->polygons) {
            fill(in, soup, vertices, number, m);
            *out = m;
        }
    }
    memory_free(memory, number, vertex_count, sizeof *number);
    if (*out) return RESULT_OK;
    if (m && m->memory.memory) compile_mesh_free(m);
    else memory_free(memory, m, 1, sizeof *m);
    return RESULT_NO_MEMORY;
}

void compile_mesh_free(compile_mesh *m)
{
    if (!m) return;
    const allocator *memory = m->memory.memory;
    arena_free(&m->memory);
    memory_free(memory, m, 1, sizeof *m);
}
