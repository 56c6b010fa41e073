// The culler `frustum`: items whose boxes touch a volume, found in a wide tree (Wald et al., Getting Rid of Packets, 2008;
// plane masks: Assarsson and Moeller, Optimized View Frustum Culling Algorithms, 2000). Start a culler of your own from this folder.
// SPDX-License-Identifier: MIT
//
// Invariant: the set is exactly that of testing every box against every plane, whatever the tree and the instruction set.
// A culler has four lives: `cull_culler` (the index, constant once built), `cull_query` (one viewer's memory of it: here
// none), a step (no allocation, no failure), and the constant tables at the end, which a host reads before it runs any of this.
#include "explain.h"
#include "index.h"
#include "walk.h"

#include <portcullis/runs.h>

#include <stdio.h>
#include <string.h>

enum { OPTION_BACKFACE, OPTION_ISA, OPTION_COUNT }; // places in frustum_options

struct cull_culler {
    const cull_host *host;
    const walk_kernel *kernel;
    index_faces faces;
    frustum_index index;
    uint32_t max_runs;
};
struct cull_query { const cull_culler *culler; };

// ---- Life of a culler ----

static cull_result option_refused(const cull_host *host, const char *key, const char *value, const char *legal)
{
    char line[200];
    snprintf(line, sizeof line, "frustum: %s=%.32s: %s", key, value, legal);
    host->log(host, CULL_LOG_ERROR, line);
    return CULL_ERR_OPTION;
}

static cull_result frustum_create(const cull_host *host, const char *const *values, cull_culler **out)
{
    const char *backface = values[OPTION_BACKFACE], *isa = values[OPTION_ISA];
    if (strcmp(backface, "0") != 0 && strcmp(backface, "1") != 0)
        return option_refused(host, "backface", backface, "must be 0 or 1");
    const walk_kernel *kernel = walk_kernel_of(isa);
    if (!kernel) return option_refused(host, "isa", isa, "must be auto, avx512, avx2 or plain, and one that this CPU has");
    cull_culler *c = host->alloc(host, sizeof *c, _Alignof(cull_culler));
    if (!c) return CULL_ERR_MEMORY;
    memset(c, 0, sizeof *c);
    c->host = host;
    c->kernel = kernel;
    c->faces = strcmp(backface, "1") == 0 ? INDEX_FACES : INDEX_NO_FACES;
    *out = c;
    return CULL_OK;
}

static void frustum_destroy(cull_culler *c)
{
    index_free(c->host, &c->index);
    c->host->free(c->host, c, sizeof *c);
}

static cull_result frustum_build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent; // this culler selects; a hierarchy is for filters
    const index_source from = {zone, c->host->get_extension(c->host, zone, CULL_EXT_BLOB), c->faces};
    const cull_result result = index_build(c->host, &from, &c->index);
    if (result != CULL_OK) return result;
    // Runs never touch, so at most every second item starts one.
    c->max_runs = zone->item_count / 2 + zone->item_count % 2 + WALK_SPARE_RUNS;
    out->order = c->index.order;
    out->scratch_size = 2 * sizeof(cull_run) * (size_t)c->max_runs; // two lists beside the batch's own
    out->index_bytes = sizeof *c + c->index.order_bytes + c->index.box_bytes + c->index.face_bytes;
    out->promises = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS;
    out->max_runs = c->max_runs;
    out->max_steps = 1;
    return CULL_OK;
}

static cull_result frustum_open(const cull_culler *c, cull_query **out)
{
    cull_query *q = c->host->alloc(c->host, sizeof *q, _Alignof(cull_query));
    if (!q) return CULL_ERR_MEMORY;
    q->culler = c;
    *out = q;
    return CULL_OK;
}

static void frustum_close(cull_query *q)
{
    q->culler->host->free(q->culler->host, q, sizeof *q);
}

// ---- A step ----

// Three lists take turns: what is found so far, the next volume's, and their union. Returns what all volumes found.
static cull_run_list select_volumes(const cull_culler *c, const cull_visit *visit, cull_run_list found, cull_run_list next, cull_run_list both,
                                    uint32_t *nodes_visited)
{
    for (uint32_t v = 0; v < visit->volume_count; v++) {
        cull_run_list *into = v == 0 ? &found : &next;
        into->count = c->kernel->volume(&c->index, &visit->volumes[v], into->runs, nodes_visited);
        if (v == 0) continue;
        cull_runs_unite(&found, &next, &both);
        const cull_run_list spare = found;
        found = both;
        both = spare;
    }
    return found;
}

static int is_small(const frustum_index *index, const cull_visit *visit)
{
    return index->level_count <= WALK_SMALL_LEVELS && visit->volume_count <= WALK_SMALL_VOLUMES;
}

static cull_progress frustum_select(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    const cull_culler *c = q->culler;
    cull_run *const out = batch->runs + batch->run_count;
    if (is_small(&c->index, visit)) {
        const small_query all = {visit->volumes, visit->view->eye, visit->volume_count};
        batch->run_count += c->kernel->small(&c->index, &all, out, &batch->nodes_visited);
        return CULL_DONE;
    }
    const cull_run_list a = {visit->scratch, 0}, b = {(cull_run *)visit->scratch + c->max_runs, 0}, last = {out, 0};
    if (c->index.faces) {
        const cull_run_list touching = select_volumes(c, visit, a, b, last, &batch->nodes_visited);
        cull_run *const facing = touching.runs == out ? a.runs : out;
        const uint32_t count = c->kernel->facing(&c->index, visit->view->eye, touching.runs, touching.count, facing);
        if (facing != out) memcpy(out, facing, count * sizeof *out);
        batch->run_count += count;
    } else {
        const cull_run_list touching = select_volumes(c, visit, last, a, b, &batch->nodes_visited);
        if (touching.runs != out) memcpy(out, touching.runs, touching.count * sizeof *out);
        batch->run_count += touching.count;
    }
    return CULL_DONE;
}

// ---- Extensions ----

static size_t frustum_explain(cull_query *q, const cull_visit *visit, uint32_t item, char *text, size_t size)
{
    return explain_item(&q->culler->index, visit, item, text, size);
}

static uint64_t frustum_save(const cull_culler *c, void *blob, uint64_t size)
{
    return index_save(&c->index, blob, size);
}

static const void *frustum_get_extension(const cull_culler *c, const char *id)
{
    static const cull_explain explain = {frustum_explain};
    static const cull_bake bake = {frustum_save};
    if (!c) return NULL; // of the library as a whole it has none
    if (strcmp(id, CULL_EXT_EXPLAIN) == 0) return &explain;
    return strcmp(id, CULL_EXT_BAKE) == 0 ? &bake : NULL;
}

// ---- What the library offers ----

static const cull_option frustum_options[OPTION_COUNT] = {
    [OPTION_BACKFACE] = {"backface", "0", "0 1", "1: drop one-sided walls that show only their back to the eye"},
    [OPTION_ISA] = {"isa", "auto", NULL, "instruction set: auto, avx512, avx2, plain; all find the same set"},
};

static const cull_descriptor frustum_descriptor = {
    .id = "frustum",
    .version = "1",
    .summary = "items whose boxes touch the view, from a 16-wide tree",
    .options = frustum_options,
    .option_count = OPTION_COUNT,
    .may_promise = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS,
};

static const cull_plugin frustum_plugin = {
    .descriptor = &frustum_descriptor,
    .create = frustum_create,
    .destroy = frustum_destroy,
    .build = frustum_build,
    .open = frustum_open,
    .close = frustum_close,
    .select = frustum_select,
    .get_extension = frustum_get_extension,
};

static const cull_plugin *const frustum_plugins[] = {&frustum_plugin};
CULL_ENTRY = {CULL_ABI, 1, frustum_plugins};
