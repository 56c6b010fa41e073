// The culler `octree`: items whose boxes touch a volume, near to far, from a loose octree or quadtree (see cells.h) whose runs are packed into
// wide nodes (see index.h); plane masks: Assarsson and Moeller, Optimized View Frustum Culling Algorithms, 2000.
// SPDX-License-Identifier: MIT
//
// Invariant: the set is exactly that of testing every box against every plane (and with backface=1 every wall's face), whatever the
// options and the instruction set.
#include "cells.h"
#include "explain.h"
#include "ray.h"
#include "walk.h"

#include <portcullis/runs.h>

#include <stdio.h>
#include <string.h>

enum { OPTION_KIND, OPTION_LOOSE, OPTION_BACKFACE, OPTION_ISA, OPTION_COUNT }; // places in octree_options

struct cull_culler {
    const cull_host *host;
    const cull_zone *zone;
    const walk_kernel *kernel;
    octree_wish wish;
    index_faces faces;
    octree_cells cells;
    octree_index index;
};
struct cull_query { const cull_culler *culler; };

// ---- Life of a culler ----

static cull_result option_refused(const cull_host *host, const char *key, const char *value, const char *legal)
{
    char line[200];
    snprintf(line, sizeof line, "octree: %s=%.32s: must be %s", key, value, legal);
    host->log(host, CULL_LOG_ERROR, line);
    return CULL_ERR_OPTION;
}

static int read_kind(const char *value, octree_kind *out)
{
    static const char *const words[] = {[OCTREE_OCT] = "oct", [OCTREE_QUAD] = "quad", [OCTREE_AUTO] = "auto"};
    for (octree_kind kind = OCTREE_OCT; kind <= OCTREE_AUTO; kind++)
        if (strcmp(words[kind], value) == 0) {
            *out = kind;
            return 1;
        }
    return 0;
}

static int read_loose(const char *value, double *out) // digits and a point only: the same in every locale
{
    double number = 0, place = 1;
    int points = 0, digits = 0;
    for (const char *c = value; *c; c++) {
        if (*c == '.' && points++ == 0) continue;
        if (*c < '0' || *c > '9' || ++digits > 9) return 0;
        number = number * 10 + (*c - '0');
        if (points) place *= 10;
    }
    *out = number / place;
    return digits > 0 && points <= 1 && *out > 1 && *out <= 16;
}

static cull_result octree_create(const cull_host *host, const char *const *values, cull_culler **out)
{
    octree_wish wish;
    const char *backface = values[OPTION_BACKFACE];
    if (!read_kind(values[OPTION_KIND], &wish.kind)) return option_refused(host, "kind", values[OPTION_KIND], "oct, quad or auto");
    if (!read_loose(values[OPTION_LOOSE], &wish.loose)) return option_refused(host, "loose", values[OPTION_LOOSE], "a number above 1, at most 16");
    if (strcmp(backface, "0") != 0 && strcmp(backface, "1") != 0) return option_refused(host, "backface", backface, "0 or 1");
    const walk_kernel *kernel = walk_kernel_of(values[OPTION_ISA]);
    if (!kernel) return option_refused(host, "isa", values[OPTION_ISA], "auto, avx512, avx2 or plain, and one that this CPU has");
    cull_culler *c = host->alloc(host, sizeof *c, _Alignof(cull_culler));
    if (!c) return CULL_ERR_MEMORY;
    memset(c, 0, sizeof *c);
    c->host = host;
    c->kernel = kernel;
    c->wish = wish;
    c->faces = strcmp(backface, "1") == 0 ? INDEX_FACES : INDEX_NO_FACES;
    *out = c;
    return CULL_OK;
}

static void octree_destroy(cull_culler *c)
{
    index_free(c->host, &c->index);
    cells_free(c->host, &c->cells);
    c->host->free(c->host, c, sizeof *c);
}

static cull_result octree_build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent; // this culler selects; a hierarchy is for filters
    const octree_source from = {zone, c->host->get_extension(c->host, zone, CULL_EXT_BLOB), c->wish};
    c->zone = zone;
    cull_result result = cells_build(c->host, &from, &c->cells);
    if (result == CULL_OK) result = index_build(c->host, zone, c->cells.order, c->faces, &c->index);
    if (result != CULL_OK) return result;
    out->order = c->cells.order;
    out->max_runs = walk_runs_most(&c->index);
    out->scratch_size = 2 * sizeof(cull_run) * (size_t)out->max_runs; // two lists, for more volumes than a walk takes
    out->index_bytes = sizeof *c + cells_bytes(&c->cells) + c->index.bytes;
    out->promises = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS;
    out->max_steps = 1;
    return CULL_OK;
}

static cull_result octree_open(const cull_culler *c, cull_query **out)
{
    cull_query *q = c->host->alloc(c->host, sizeof *q, _Alignof(cull_query));
    if (!q) return CULL_ERR_MEMORY;
    q->culler = c;
    *out = q;
    return CULL_OK;
}

static void octree_close(cull_query *q)
{
    q->culler->host->free(q->culler->host, q, sizeof *q);
}

// ---- A step ----

// So many volumes that several walks have to be united: ascending then, not near to far.
static uint32_t select_groups(const cull_culler *c, const cull_visit *visit, cull_run *out, uint32_t *nodes_visited)
{
    const uint32_t most = walk_runs_most(&c->index);
    walk_query walk = {&c->index, visit->volumes, visit->view->eye, 0, WALK_ASCENDING};
    cull_run_list found = {out, 0}, next = {visit->scratch, 0}, both = {(cull_run *)visit->scratch + most, 0};
    for (uint32_t first = 0; first < visit->volume_count; first += walk.volume_count) {
        const uint32_t left = visit->volume_count - first;
        walk.volumes = visit->volumes + first;
        walk.volume_count = left < WALK_VOLUMES ? left : WALK_VOLUMES;
        next.count = c->kernel->walk(&walk, next.runs, nodes_visited);
        cull_runs_unite(&found, &next, &both);
        const cull_run_list spare = found;
        found = both;
        both = spare;
    }
    if (found.runs != out) memcpy(out, found.runs, found.count * sizeof *out);
    return found.count;
}

static cull_progress octree_select(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    const cull_culler *c = q->culler;
    cull_run *const out = batch->runs + batch->run_count;
    const walk_query walk = {&c->index, visit->volumes, visit->view->eye, visit->volume_count, WALK_NEAR_FIRST};
    if (visit->volume_count > WALK_VOLUMES) batch->run_count += select_groups(c, visit, out, &batch->nodes_visited);
    else batch->run_count += c->kernel->walk(&walk, out, &batch->nodes_visited);
    return CULL_DONE;
}

// ---- Extensions ----

static size_t octree_explain(cull_query *q, const cull_visit *visit, uint32_t item, char *text, size_t size)
{
    const cull_culler *c = q->culler;
    const explain_source from = {c->zone, &c->cells, c->faces == INDEX_FACES ? EXPLAIN_BACKS_DROPPED : EXPLAIN_BACKS_KEPT};
    return explain_item(&from, visit, item, text, size);
}

static uint64_t octree_save(const cull_culler *c, void *blob, uint64_t size)
{
    return cells_save(&c->cells, &c->wish, blob, size);
}

static uint32_t octree_segment(const cull_culler *c, cull_vec3 from, cull_vec3 to, cull_run *runs, uint32_t max_runs)
{
    const ray_source source = {c->zone, &c->cells};
    return ray_segment(&source, from, to, runs, max_runs);
}

static uint32_t octree_box(const cull_culler *c, const cull_box *box, cull_run *runs, uint32_t max_runs)
{
    const ray_source source = {c->zone, &c->cells};
    return ray_box(&source, box, runs, max_runs);
}

static const void *octree_get_extension(const cull_culler *c, const char *id)
{
    static const cull_explain explain = {octree_explain};
    static const cull_bake bake = {octree_save};
    static const cull_ray ray = {octree_segment, octree_box};
    if (!c) return NULL; // of the library as a whole it has none
    if (strcmp(id, CULL_EXT_HIERARCHY) == 0) return &c->cells.hierarchy;
    if (strcmp(id, CULL_EXT_EXPLAIN) == 0) return &explain;
    if (strcmp(id, CULL_EXT_BAKE) == 0) return &bake;
    return strcmp(id, CULL_EXT_RAY) == 0 ? &ray : NULL;
}

// ---- What the library offers ----

static const cull_option octree_options[OPTION_COUNT] = {
    [OPTION_KIND] = {"kind", "auto", "oct quad auto", "oct: cells are cubes; quad: columns over squares; auto: quad where heights spread at most a quarter as far as the ground"},
    [OPTION_LOOSE] = {"loose", "2", "1.25 1.5 2 4", "sizes of its cell that an item may reach over; at 2 one as wide as a cell still sinks to it"},
    [OPTION_BACKFACE] = {"backface", "0", "0 1", "1: drop one-sided walls that show only their back to the eye"},
    [OPTION_ISA] = {"isa", "auto", NULL, "instruction set: auto, avx512, avx2, plain; all find the same set"},
};

static const cull_descriptor octree_descriptor = {
    .id = "octree",
    .version = "1",
    .summary = "items whose boxes touch the view, near to far, from a loose octree or quadtree",
    .options = octree_options,
    .option_count = OPTION_COUNT,
    .may_promise = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS,
};

static const cull_plugin octree_plugin = {
    .descriptor = &octree_descriptor,
    .create = octree_create,
    .destroy = octree_destroy,
    .build = octree_build,
    .open = octree_open,
    .close = octree_close,
    .select = octree_select,
    .get_extension = octree_get_extension,
};

static const cull_plugin *const octree_plugins[] = {&octree_plugin};
CULL_ENTRY = {CULL_ABI, 1, octree_plugins};
