// The built-in culler `brute`: every box against every plane, in the order given, 16 at a time. No index: what a tree
// has to beat, and the set that it has to find.
// SPDX-License-Identifier: MIT
#include "builtin.h"
#include "builtin_brute.h"

#include <stdio.h>
#include <string.h>

struct cull_culler {
    const cull_host *host;
    brute_loop *loop;
    cull_boxes boxes;
    uint32_t item_count;
};
struct cull_query { const cull_culler *culler; };

static brute_loop *loop_avx2(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt")) return brute_avx2;
#endif
    return NULL;
}

static brute_loop *loop_avx512(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("popcnt")) return brute_avx512;
#endif
    return NULL;
}

static brute_loop *loop_of(const char *isa)
{
    if (strcmp(isa, "plain") == 0) return brute_plain;
    if (strcmp(isa, "avx2") == 0) return loop_avx2();
    if (strcmp(isa, "avx512") == 0) return loop_avx512();
    if (strcmp(isa, "auto") != 0) return NULL;
    if (loop_avx512()) return loop_avx512();
    return loop_avx2() ? loop_avx2() : brute_plain;
}

static cull_result brute_create(const cull_host *host, const char *const *values, cull_culler **out)
{
    brute_loop *loop = loop_of(values[0]);
    if (!loop) {
        char line[160];
        snprintf(line, sizeof line, "brute: isa=%.32s is not one of auto, avx512, avx2, plain, or this CPU lacks it", values[0]);
        host->log(host, CULL_LOG_ERROR, line);
        return CULL_ERR_OPTION;
    }
    cull_culler *c = host->alloc(host, sizeof *c, _Alignof(cull_culler));
    if (!c) return CULL_ERR_MEMORY;
    *c = (cull_culler){.host = host, .loop = loop};
    *out = c;
    return CULL_OK;
}

static void brute_destroy(cull_culler *c)
{
    c->host->free(c->host, c, sizeof *c);
}

static cull_result brute_build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent;
    c->boxes = zone->boxes;
    c->item_count = zone->item_count;
    out->promises = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS;
    out->index_bytes = sizeof *c;
    out->max_runs = zone->item_count / 2 + zone->item_count % 2 + BRUTE_SPARE_RUNS;
    out->max_steps = 1;
    return CULL_OK;
}

static cull_result brute_open(const cull_culler *c, cull_query **out)
{
    cull_query *q = c->host->alloc(c->host, sizeof *q, _Alignof(cull_query));
    if (!q) return CULL_ERR_MEMORY;
    q->culler = c;
    *out = q;
    return CULL_OK;
}

static void brute_close(cull_query *q)
{
    q->culler->host->free(q->culler->host, q, sizeof *q);
}

static cull_progress brute_select(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    const cull_culler *c = q->culler;
    const brute_job job = {c->boxes, c->item_count, visit->volumes, visit->volume_count};
    batch->run_count += c->loop(&job, batch->runs + batch->run_count);
    return CULL_DONE;
}

static const void *brute_get_extension(const cull_culler *c, const char *id)
{
    (void)c;
    (void)id;
    return NULL;
}

static const cull_option brute_options[] = {
    {"isa", "auto", NULL, "instruction set of the loop: auto, avx512, avx2, plain; all find the same set"},
};

static const cull_descriptor brute_descriptor = {
    .id = "brute",
    .version = "1",
    .summary = "tests every box against every plane, no index",
    .options = brute_options,
    .option_count = sizeof brute_options / sizeof brute_options[0],
    .may_promise = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS,
};

const cull_plugin builtin_brute = {
    .descriptor = &brute_descriptor,
    .create = brute_create,
    .destroy = brute_destroy,
    .build = brute_build,
    .open = brute_open,
    .close = brute_close,
    .select = brute_select,
    .get_extension = brute_get_extension,
};
