// The mesh's vertices as the scene will have them: rounded to its step about its origin, and which of them become one.
// SPDX-License-Identifier: MIT
// Invariant: the same frame as scene_builder_finish, over the same bounds; the checks read the finished scene.
#include "items.h"
#include "../core/scene_finish.h"

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

static result find_same(rounded_mesh *m)
{
    size_t size = 64;
    while (size < 2 * (size_t)m->vertex_count) size *= 2;
    uint32_t *slots = memory_alloc_zeroed(m->memory, size, sizeof *slots);
    if (!slots) return RESULT_NO_MEMORY;
    for (uint32_t v = 0; v < m->vertex_count; ++v) {
        size_t at = XXH3_64bits(m->points[v], sizeof m->points[v]) & (size - 1);
        while (slots[at] && memcmp(m->points[slots[at] - 1], m->points[v], sizeof m->points[v]) != 0) at = (at + 1) & (size - 1);
        if (!slots[at]) slots[at] = v + 1;
        m->same_as[v] = slots[at] - 1;
    }
    memory_free(m->memory, slots, size, sizeof *slots);
    return RESULT_OK;
}

result rounded_mesh_make(const item_job *j, rounded_mesh *out)
{
    const compile_mesh *mesh = j->zones->mesh;
    builder_bounds bounds = builder_bounds_none();
    builder_bounds_more(j->builder, &bounds);
    const finish_frame f = finish_frame_of(bounds.low, bounds.high);
    const double steps = 1 / f.step, limit = 1 << 28; // of vertices that no item has, farther out than all that do
    *out = (rounded_mesh){.memory = j->memory, .vertex_count = mesh->vertex_count};
    out->points = memory_alloc(j->memory, mesh->vertex_count, sizeof *out->points);
    out->same_as = memory_alloc(j->memory, mesh->vertex_count, sizeof *out->same_as);
    if (!out->points || !out->same_as) return RESULT_NO_MEMORY;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        for (int k = 0; k < 3; ++k) {
            const double rounded = finish_round((mesh->vertices[v].position[k] / j->in->steps_per_metre - f.origin[k]) * steps);
            out->points[v][k] = (int32_t)fmax(-limit, fmin(limit, rounded));
        }
    return find_same(out);
}

void rounded_mesh_free(rounded_mesh *m)
{
    if (!m->memory) return;
    memory_free(m->memory, m->points, m->vertex_count, sizeof *m->points);
    memory_free(m->memory, m->same_as, m->vertex_count, sizeof *m->same_as);
}
