// A host for tests of cullers: see culler_host.h.
// SPDX-License-Identifier: MIT
#include "culler_host.h"

#include <stdio.h>
#include <string.h>

static void *host_alloc(const cull_host *host, size_t size, size_t align)
{
    culler_host *h = host->user;
    return h->memory.memory.alloc(h->memory.memory.user, size, align);
}

static void host_free(const cull_host *host, void *memory, size_t size)
{
    culler_host *h = host->user;
    if (memory) h->memory.memory.free(h->memory.memory.user, memory, size);
}

static void host_log(const cull_host *host, cull_log_level level, const char *message)
{
    culler_host *h = host->user;
    (void)level;
    h->lines++;
    snprintf(h->last_line, sizeof h->last_line, "%s", message);
}

static void host_parallel_for(const cull_host *host, void (*task)(void *, uint32_t), void *context, uint32_t count)
{
    (void)host;
    for (uint32_t i = 0; i < count; i++) task(context, i);
}

static const void *host_get_extension(const cull_host *host, const cull_zone *zone, const char *id)
{
    (void)host;
    (void)zone;
    (void)id;
    return NULL;
}

void culler_host_init(culler_host *h, uint64_t fail_at)
{
    memset(h, 0, sizeof *h);
    failing_allocator_init(&h->memory, fail_at);
    h->host = (cull_host){CULL_ABI, 0, h, host_alloc, host_free, host_log, host_parallel_for, host_get_extension};
}
