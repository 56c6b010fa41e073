// An allocator for tests: see failing_allocator.h. Each block stands behind a header that remembers its size.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "failing_allocator.h"

#include <stdlib.h>
#include <string.h>

enum { LEAST_ALIGN = 64, BYTES_MOST = 1 << 30 };

typedef struct header {
    void *block;
    size_t size;
} header;

static void *count_alloc(void *user, size_t size, size_t align)
{
    failing_allocator *a = user;
    const size_t gap = align > LEAST_ALIGN ? align : LEAST_ALIGN;
    void *block = NULL;
    if (++a->calls == a->fail_at || size > a->bytes_most || posix_memalign(&block, gap, gap + (size ? size : 1)) != 0) {
        a->failures++;
        return NULL;
    }
    char *memory = (char *)block + gap;
    const header h = {block, size};
    memcpy(memory - sizeof h, &h, sizeof h);
    memset(memory, 0xa5, size); // what is read before it is written shows
    a->live_blocks++;
    a->live_bytes += size;
    return memory;
}

static void count_free(void *user, void *memory, size_t size)
{
    failing_allocator *a = user;
    header h;
    memcpy(&h, (char *)memory - sizeof h, sizeof h);
    a->wrong_frees += h.size != size;
    a->live_blocks--;
    a->live_bytes -= h.size;
    free(h.block);
}

void failing_allocator_init(failing_allocator *a, uint64_t fail_at)
{
    *a = (failing_allocator){.memory = {count_alloc, count_free, a}, .fail_at = fail_at, .bytes_most = BYTES_MOST};
}

int failing_allocator_is_clean(const failing_allocator *a)
{
    return a->live_blocks == 0 && a->live_bytes == 0 && a->wrong_frees == 0;
}
