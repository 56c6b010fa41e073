// The host that a culler under check is lent: see lender.h.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "lender.h"
#include "process.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum { PAGE_BYTES = 4096, ALIGN_LEAST = 16 };
static const size_t BYTES_MOST = (size_t)1 << 30; // larger requests fail, whatever this machine has

static size_t rounded(size_t size, size_t to)
{
    return (size + to - 1) / to * to;
}

fence fence_open(size_t size, size_t align, size_t slack, const char *name)
{
    fence f = {.size = size};
    const size_t span = rounded(size + slack + align, PAGE_BYTES);
    if (align == 0 || align > PAGE_BYTES || size > BYTES_MOST) return f;
    f.map_size = span + PAGE_BYTES;
    f.map = mmap(NULL, f.map_size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (f.map == MAP_FAILED) return (fence){.size = size};
    if (mprotect(f.map + span, PAGE_BYTES, PROT_NONE) != 0) {
        munmap(f.map, f.map_size);
        return (fence){.size = size};
    }
    f.memory = f.map + (span - slack - size) / align * align; // nothing of the span is behind what has no more alignment than its size
    process_name_region(f.map + span, PAGE_BYTES, name);
    return f;
}

void fence_close(fence *f)
{
    if (f->map) munmap(f->map, f->map_size);
    *f = (fence){0};
}

static int has_room(lender *l)
{
    if (l->block_count < l->block_capacity) return 1;
    const uint32_t capacity = l->block_capacity ? 2 * l->block_capacity : 256;
    lender_block *blocks = realloc(l->blocks, capacity * sizeof *blocks);
    if (!blocks) return 0;
    l->blocks = blocks;
    l->block_capacity = capacity;
    return 1;
}

static void *lend(lender *l, size_t size, size_t align)
{
    l->calls_in_step += l->is_in_step != 0;
    if (++l->calls == l->fail_at || align == 0 || (align & (align - 1)) || !has_room(l)) {
        l->failures++;
        return NULL;
    }
    const size_t least = align < ALIGN_LEAST ? ALIGN_LEAST : align;
    const fence f = fence_open(size ? size : 1, least, 0, "memory behind a block that it asked the host for");
    if (!f.memory) {
        l->failures++;
        return NULL;
    }
    memset(f.memory, l->fill, size);
    l->blocks[l->block_count++] = (lender_block){f, align, 1};
    l->live_blocks++;
    l->live_bytes += size;
    return f.memory;
}

static void *host_alloc(const cull_host *host, size_t size, size_t align)
{
    lender *l = host->user;
    pthread_mutex_lock(&l->lock);
    void *memory = lend(l, size, align);
    pthread_mutex_unlock(&l->lock);
    return memory;
}

static void take_back(lender *l, const void *memory, size_t size)
{
    for (uint32_t i = l->block_count; i-- > 0;) {
        lender_block *b = &l->blocks[i];
        if (!b->is_live || b->fence.memory != memory) continue;
        l->wrong_frees += b->fence.size != (size ? size : 1);
        l->live_bytes -= size ? b->fence.size : 0;
        l->live_blocks--;
        fence_close(&b->fence);
        *b = l->blocks[--l->block_count];
        return;
    }
    l->wrong_frees++;
}

static void host_free(const cull_host *host, void *memory, size_t size)
{
    lender *l = host->user;
    if (!memory) return;
    pthread_mutex_lock(&l->lock);
    l->calls_in_step += l->is_in_step != 0;
    take_back(l, memory, size);
    pthread_mutex_unlock(&l->lock);
}

static void host_log(const cull_host *host, cull_log_level level, const char *message)
{
    lender *l = host->user;
    (void)level;
    pthread_mutex_lock(&l->lock);
    l->lines++;
    snprintf(l->last_line, sizeof l->last_line, "%s", message ? message : "(NULL)");
    pthread_mutex_unlock(&l->lock);
}

static void host_parallel_for(const cull_host *host, void (*task)(void *, uint32_t), void *context, uint32_t count)
{
    const lender *l = host->user;
    for (uint32_t i = 0; i < count; ++i) task(context, l->tasks == TASKS_FORWARD ? i : count - 1 - i);
}

static const void *host_extension(const cull_host *host, const cull_zone *zone, const char *id)
{
    const lender *l = host->user;
    if (!zone) return strcmp(id, CULL_EXT_COSTS) == 0 ? &l->costs : NULL;
    return zone == l->zone && l->blob.bytes && strcmp(id, CULL_EXT_BLOB) == 0 ? &l->blob : NULL;
}

// What a software renderer takes, about: any numbers that hang together do.
static const cull_costs COSTS = {.polygon_ns = 250, .pixel_ns = 3, .picture_ns = 1500, .picture_pixel_ns = 6, .picture_depth_pixel_ns = 10,
                                 .capture_ns = 25000, .capture_pixel_ns = 9, .picture_bytes = 16u << 20, .pixel_bytes = 4, .depth_pixel_bytes = 8};

void lender_open(lender *l)
{
    *l = (lender){.host = {CULL_ABI, 0, l, host_alloc, host_free, host_log, host_parallel_for, host_extension}, .costs = COSTS, .fill = 0xa5};
    pthread_mutex_init(&l->lock, NULL);
}

void lender_close(lender *l)
{
    for (uint32_t i = 0; i < l->block_count; ++i) fence_close(&l->blocks[i].fence);
    free(l->blocks);
    pthread_mutex_destroy(&l->lock);
    *l = (lender){0};
}

static void protect(lender *l, int how)
{
    for (uint32_t i = 0; i < l->block_count; ++i) {
        const fence *f = &l->blocks[i].fence;
        mprotect(f->map, f->map_size - PAGE_BYTES, how);
        if (how == PROT_READ)
            process_name_region(f->map, f->map_size - PAGE_BYTES, "its built index, which is constant: what changes in a step belongs to a query");
    }
}

void lender_seal(lender *l)
{
    protect(l, PROT_READ);
}

void lender_release(lender *l)
{
    protect(l, PROT_READ | PROT_WRITE);
}
