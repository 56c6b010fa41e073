// Index ranges that one multi-draw takes: neighbours joined, so runs of whole parts of the scene cost nothing.
// SPDX-License-Identifier: MIT
// Plain glMultiDrawElements, not the indirect one: no command buffer to fill, and half the cost a draw on llvmpipe.
#include "gl.h"

enum { RANGE_MOST = 3 << 28 }; // indices in one range: a multiple of 3 that GLsizei holds

result ranges_open(ranges *a, uint32_t capacity, const allocator *memory)
{
    *a = (ranges){.capacity = capacity};
    a->counts = memory_alloc(memory, capacity, sizeof *a->counts);
    a->offsets = memory_alloc(memory, capacity, sizeof *a->offsets);
    if (a->counts && a->offsets) return RESULT_OK;
    ranges_close(a, memory);
    return RESULT_NO_MEMORY;
}

result ranges_reserve(ranges *a, uint32_t capacity, const allocator *memory)
{
    ranges more;
    if (capacity <= a->capacity) return RESULT_OK;
    if (ranges_open(&more, capacity, memory) != RESULT_OK) return RESULT_NO_MEMORY;
    ranges_close(a, memory);
    *a = more;
    return RESULT_OK;
}

void ranges_close(ranges *a, const allocator *memory)
{
    memory_free(memory, a->counts, a->capacity, sizeof *a->counts);
    memory_free(memory, (void *)a->offsets, a->capacity, sizeof *a->offsets);
    *a = (ranges){0};
}

int ranges_add(ranges *a, uint32_t first_index, uint32_t index_count)
{
    if (index_count == 0) return 1;
    const uint32_t last = a->count - 1;
    if (a->count && a->end == first_index && (uint32_t)a->counts[last] + (uint64_t)index_count <= RANGE_MOST) {
        a->counts[last] += (GLsizei)index_count;
        a->end += index_count;
        return 1;
    }
    if (a->capacity - a->count < (index_count - 1) / RANGE_MOST + 1) return 0;
    while (index_count) {
        const uint32_t part = index_count < RANGE_MOST ? index_count : RANGE_MOST;
        a->counts[a->count] = (GLsizei)part;
        a->offsets[a->count++] = (const void *)((uintptr_t)first_index * sizeof(uint32_t));
        first_index += part;
        index_count -= part;
        a->end = first_index;
    }
    return 1;
}

void ranges_draw(renderer *g, ranges *a)
{
    if (a->count == 0) return;
    if (a->count == 1) glDrawElements(GL_TRIANGLES, a->counts[0], GL_UNSIGNED_INT, a->offsets[0]);
    else glMultiDrawElements(GL_TRIANGLES, a->counts, GL_UNSIGNED_INT, a->offsets, (GLsizei)a->count);
    g->frame.draw_calls++;
    a->count = 0;
}
