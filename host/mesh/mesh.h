// The OpenMesh bridge: polygons of one object in, a repaired, welded mesh with normals and adjacency out. The only C++ of
// the product stands behind this header.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_MESH_H
#define PORTCULLIS_HOST_MESH_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" { // round the C headers too
#endif
#include "../core/memory.h"
#include "../core/report.h"

#define MESH_NO_NEIGHBOUR UINT32_MAX

// Corners of polygon i: corners[polygon_first[i]] up to corners[polygon_first[i + 1]], at least 3. All lent for the call.
typedef struct mesh_input {
    const double *positions; // 3 a vertex, finite
    const uint32_t *corners; // vertex numbers, below position_count
    const uint32_t *polygon_first; // polygon_count + 1, from 0
    uint32_t position_count, polygon_count;
} mesh_input;

// Vertices are welded where positions are equal; edges and points where over two faces meet are cut by doubling vertices.
// No polygon is lost or turned: corner c of the output is corner c of the input. All arrays stand in the caller's arena.
typedef struct mesh_output {
    double *positions;           // 3 a vertex; those of the input, with -0 as 0
    float *normals;              // 3 a vertex: unit, smooth where faces meet under 30 degrees; zero where there is none
    uint32_t *corners;           // vertex numbers, in order of their first corner
    uint32_t *corner_neighbours; // across the edge from this corner to the next: polygon, or MESH_NO_NEIGHBOUR
    uint32_t position_count;
    uint32_t boundary_edges;   // edges without a neighbour; 0: the mesh is closed
    uint32_t cut_vertices;     // doubled because the mesh is no surface there (not those doubled for a crease)
    uint32_t apart_polygons;   // given vertices of their own: they touch themselves or their neighbours twice
} mesh_output;

// [any thread] Deterministic. RESULT_NO_MEMORY, unreported, when the arena, or operator new, fails.
result mesh_repair(const mesh_input *in, arena *memory, mesh_output *out);

// A binary .stl, from bytes whose size fits their count and whose values were checked, by OpenMesh's own reader: triangles,
// 9 doubles each, in the arena. (Its ascii reader takes anything for a number, and a failed allocation for 0.)
result mesh_read_stl(const char *path, const char *bytes, size_t size, arena *memory, report *r, double **out_triangles, uint32_t *out_count);

#ifdef __cplusplus
}
#endif
#endif
