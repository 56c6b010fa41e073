// The stand-in for the OpenMesh bridge: see mesh.h. Welds only: every edge is a boundary, every face is shaded flat.
// SPDX-License-Identifier: MIT
#include "mesh.h"

#include <string.h>

static uint64_t hash_of(const double p[3])
{
    uint64_t bits[3], hash = 0;
    memcpy(bits, p, sizeof bits);
    for (int k = 0; k < 3; ++k) {
        hash = (hash + bits[k] + 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u;
        hash ^= hash >> 31;
    }
    return hash;
}

// The vertex already at p, or a new one. slots hold vertex + 1.
static uint32_t vertex_at(mesh_output *out, uint32_t *slots, size_t slot_count, const double p[3])
{
    size_t at = hash_of(p) & (slot_count - 1);
    for (; slots[at]; at = (at + 1) & (slot_count - 1))
        if (memcmp(out->positions + 3 * (size_t)(slots[at] - 1), p, 3 * sizeof *p) == 0) return slots[at] - 1;
    memcpy(out->positions + 3 * (size_t)out->position_count, p, 3 * sizeof *p);
    slots[at] = ++out->position_count;
    return out->position_count - 1;
}

result mesh_repair(const mesh_input *in, arena *memory, mesh_output *out)
{
    const uint32_t corner_count = in->polygon_first[in->polygon_count];
    size_t slot_count = 64;
    while (slot_count < (size_t)in->position_count * 2) slot_count *= 2;
    mesh_output o = {.positions = arena_push(memory, in->position_count, 3 * sizeof(double)),
                     .normals = arena_push(memory, in->position_count, 3 * sizeof(float)),
                     .corners = arena_push(memory, corner_count, sizeof(uint32_t)),
                     .corner_neighbours = arena_push(memory, corner_count, sizeof(uint32_t)),
                     .boundary_edges = corner_count};
    uint32_t *slots = memory_alloc_zeroed(memory->memory, slot_count, sizeof *slots);
    if (!o.positions || !o.normals || !o.corners || !o.corner_neighbours || !slots) {
        memory_free(memory->memory, slots, slot_count, sizeof *slots);
        return RESULT_NO_MEMORY;
    }
    for (uint32_t c = 0; c < corner_count; ++c) {
        const double *from = in->positions + 3 * (size_t)in->corners[c];
        const double p[3] = {from[0] + 0.0, from[1] + 0.0, from[2] + 0.0}; // -0 becomes 0
        o.corners[c] = vertex_at(&o, slots, slot_count, p);
        o.corner_neighbours[c] = MESH_NO_NEIGHBOUR;
    }
    memset(o.normals, 0, (size_t)in->position_count * 3 * sizeof(float));
    memory_free(memory->memory, slots, slot_count, sizeof *slots);
    *out = o;
    return RESULT_OK;
}

result mesh_read_stl(const char *path, const char *bytes, size_t size, arena *memory, report *r, double **out_triangles, uint32_t *out_count)
{
    (void)bytes;
    (void)size;
    (void)memory;
    (void)out_triangles;
    (void)out_count;
    return report_error(r, path, 0, "built without OpenMesh, which reads .stl; write it as .obj, .ply or .off");
}
