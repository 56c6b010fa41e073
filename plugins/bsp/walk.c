// The choice of an instruction set, made once when a culler is created, and the walk's memory.
// SPDX-License-Identifier: MIT
#include "walk_parts.h"

#include <string.h>

walk_kernel walk_kernel_of(const char *isa)
{
#if defined(__x86_64__)
    const walk_kernel avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") ? walk_avx2 : NULL;
#else
    const walk_kernel avx2 = NULL;
#endif
    if (strcmp(isa, "plain") == 0) return walk_plain;
    if (strcmp(isa, "avx2") == 0) return avx2;
    if (strcmp(isa, "auto") == 0) return avx2 ? avx2 : walk_plain;
    return NULL;
}

typedef struct layout { size_t room, cuts, steps, wanted, bytes; } layout; // offsets

static size_t take(size_t *offset, size_t bytes)
{
    const size_t at = *offset;
    *offset = (at + bytes + 63) / 64 * 64;
    return at;
}

static layout layout_of(const bsp_walk *walk, const bsp_shapes *shapes)
{
    layout l;
    size_t offset = 0;
    take(&offset, sizeof(walk_memory));
    l.room = take(&offset, 2 * clip_capacity(shapes->most_vertices) * sizeof(cull_point));
    l.cuts = take(&offset, ((size_t)walk->depth + 1) * WALK_VOLUMES * sizeof(walk_cut));
    l.steps = take(&offset, (2 * (size_t)walk->depth + 3) * sizeof(walk_step));
    l.wanted = take(&offset, shapes->item_count);
    l.bytes = offset;
    return l;
}

size_t walk_scratch(const bsp_walk *walk, const bsp_shapes *shapes)
{
    return layout_of(walk, shapes).bytes;
}

walk_memory *walk_memory_of(const walk_request *q)
{
    const layout l = layout_of(q->walk, q->shapes);
    char *at = q->scratch;
    walk_memory *m = q->scratch;
    m->room.capacity = clip_capacity(q->shapes->most_vertices);
    m->room.points[0] = (cull_point *)(void *)(at + l.room);
    m->room.points[1] = m->room.points[0] + m->room.capacity;
    m->cuts = (walk_cut *)(void *)(at + l.cuts);
    m->steps = (walk_step *)(void *)(at + l.steps);
    m->wanted = (uint8_t *)(at + l.wanted);
    return m;
}
