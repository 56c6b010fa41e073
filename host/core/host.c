// Host services: see host.h.
// SPDX-License-Identifier: MIT
#define _DEFAULT_SOURCE
#include "host.h"

#include <string.h>
#include <sys/mman.h>

static const size_t HUGE_PAGE_BYTES = 2 * 1024 * 1024; // x86-64 and AArch64 with 4 KiB pages; elsewhere the advice is just unused

static const host_services *services_of(const cull_host *host)
{
    return host->user;
}

// A large index asks for huge pages: a tree walked across its memory else waits for addresses as long as for data.
static void *host_alloc(const cull_host *host, size_t size, size_t align)
{
    const allocator *memory = services_of(host)->memory;
    if (size < HUGE_PAGE_BYTES) return memory->alloc(memory->user, size, align);
    void *block = memory->alloc(memory->user, size, align > HUGE_PAGE_BYTES ? align : HUGE_PAGE_BYTES);
    if (block) (void)madvise(block, size / HUGE_PAGE_BYTES * HUGE_PAGE_BYTES, MADV_HUGEPAGE);
    return block;
}

static void host_free(const cull_host *host, void *block, size_t size)
{
    const allocator *memory = services_of(host)->memory;
    if (block) memory->free(memory->user, block, size);
}

static void host_log(const cull_host *host, cull_log_level level, const char *message)
{
    report *log = services_of(host)->log;
    if (level >= CULL_LOG_ERROR) report_error(log, NULL, 0, "%s", message);
    else if (level == CULL_LOG_WARN) report_warning(log, NULL, 0, "%s", message);
    else report_note(log, "%s", message);
}

// One thread for now: the contract allows any order, so a pool can take its place without a plugin noticing.
static void host_parallel_for(const cull_host *host, void (*task)(void *context, uint32_t i), void *context, uint32_t count)
{
    (void)host;
    for (uint32_t i = 0; i < count; ++i) task(context, i);
}

static const void *host_extension(const cull_host *host, const cull_zone *zone, const char *id)
{
    return !zone && strcmp(id, CULL_EXT_COSTS) == 0 ? &services_of(host)->costs : NULL;
}

// Until somebody measures (host/render/costs.c): what a software renderer, llvmpipe, takes on an x86-64 server, rounded.
static const cull_costs FIXED_COSTS = {.polygon_ns = 250, .pixel_ns = 3, .picture_ns = 1500, .picture_pixel_ns = 6, .picture_depth_pixel_ns = 10,
                                       .capture_ns = 25000, .capture_pixel_ns = 9, .picture_bytes = 256u << 20, .pixel_bytes = 4,
                                       .depth_pixel_bytes = 8};

void host_services_fill(host_services *s, const allocator *memory, report *log)
{
    *s = (host_services){.host = {CULL_ABI, 0, s, host_alloc, host_free, host_log, host_parallel_for, host_extension},
                         .memory = memory,
                         .log = log,
                         .costs = FIXED_COSTS};
}

void host_costs_set(const host_services *s, const cull_costs *costs)
{
    host_services *own = s->host.user; // the same, as it was filled: those who use it have it as constant
    own->costs = *costs;
}
