// The culler `bsp`: a tree of the walls' own planes over the inside of a zone (Fuchs, Kedem and Naylor, On Visible Surface Generation by
// A Priori Tree Structures, 1980). select walks it, or flows through the openings between its cells; see walk.h and cells.h.
// SPDX-License-Identifier: MIT
//
// Invariant: with cells=off the set is that of asking clip_shape (and with backface=1 shows_its_back) about every item, whatever the tree.
#include "cells.h"
#include "explain.h"
#include "figures.h"
#include "hierarchy.h"
#include "pieces_order.h"
#include "ray.h"
#include "sight.h"
#include "walk.h"

#include <stdio.h>
#include <string.h>

enum { OPTION_BACKFACE, OPTION_SPLIT, OPTION_CHOOSE, OPTION_CELLS, OPTION_WORDS, OPTION_ISA = OPTION_WORDS, OPTION_COUNT }; // places in bsp_options

struct cull_culler {
    const cull_host *host;
    const cull_zone *zone;
    walk_kernel kernel;
    uint32_t backface;
    bsp_wish wish;
    bsp_cells how;
    bsp_tree tree;
    bsp_shapes shapes;
    bsp_walk walk;
    bsp_lent lent;
    bsp_cells_data cells;
    bsp_flow_index flow;
    bsp_pieces pieces;
    bsp_figures figures;
    size_t drawn_bytes; // of a byte an item, for the flow
};
struct cull_query {
    const cull_culler *culler;
    bsp_sight sight; // with cells
};

// ---- Life of a culler ----

typedef struct option_words { const char *key, *legal, *const *words; uint32_t count; } option_words;
static const char *const backface_words[] = {"0", "1"};
static const char *const split_words[] = {"0", "1", "node"};                // bsp_split
static const char *const choose_words[] = {"balance", "sah", "first"};      // bsp_choose
static const char *const cells_words[] = {"off", "rect", "hull", "exact"};  // bsp_cells
static const option_words option_legal[OPTION_WORDS] = {
    [OPTION_BACKFACE] = {"backface", "0 or 1", backface_words, 2},
    [OPTION_SPLIT] = {"split", "0, 1 or node", split_words, 3},
    [OPTION_CHOOSE] = {"choose", "balance, sah or first", choose_words, 3},
    [OPTION_CELLS] = {"cells", "off, rect, hull or exact", cells_words, 4},
};

static cull_result option_refused(const cull_host *host, const char *key, const char *value, const char *legal)
{
    char line[200];
    snprintf(line, sizeof line, "bsp: %s=%.32s: must be %s", key, value, legal);
    host->log(host, CULL_LOG_ERROR, line);
    return CULL_ERR_OPTION;
}

static cull_result option_read(const cull_host *host, const option_words *legal, const char *value, uint32_t *out)
{
    for (uint32_t i = 0; i < legal->count; i++)
        if (strcmp(legal->words[i], value) == 0) {
            *out = i;
            return CULL_OK;
        }
    return option_refused(host, legal->key, value, legal->legal);
}

static cull_result bsp_create(const cull_host *host, const char *const *values, cull_culler **out)
{
    uint32_t read[OPTION_WORDS];
    for (uint32_t i = 0; i < OPTION_WORDS; i++)
        if (option_read(host, &option_legal[i], values[i], &read[i]) != CULL_OK) return CULL_ERR_OPTION;
    const walk_kernel kernel = walk_kernel_of(values[OPTION_ISA]);
    if (!kernel) return option_refused(host, "isa", values[OPTION_ISA], "auto, avx2 or plain, and one that this CPU has");
    cull_culler *c = host->alloc(host, sizeof *c, _Alignof(cull_culler));
    if (!c) return CULL_ERR_MEMORY;
    memset(c, 0, sizeof *c);
    c->host = host;
    c->kernel = kernel;
    c->backface = read[OPTION_BACKFACE];
    c->wish = (bsp_wish){(bsp_split)read[OPTION_SPLIT], (bsp_choose)read[OPTION_CHOOSE], 0, 0};
    c->how = (bsp_cells)read[OPTION_CELLS];
    *out = c;
    return CULL_OK;
}

static void bsp_destroy(cull_culler *c)
{
    bsp_pieces_free(c->host, &c->pieces);
    bsp_flow_free(c->host, &c->flow);
    bsp_cells_free(c->host, &c->cells);
    lent_free(c->host, &c->lent);
    walk_free(c->host, &c->walk);
    shapes_free(c->host, &c->shapes);
    bsp_tree_free(c->host, &c->tree);
    c->host->free(c->host, c, sizeof *c);
}

static size_t whole_lines(size_t bytes)
{
    return (bytes + 63) / 64 * 64;
}

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

static int has_cells(const cull_culler *c)
{
    return c->how != BSP_CELLS_OFF && c->cells.cell_count > 0;
}

static int keeps_pieces(const cull_culler *c)
{
    return c->wish.split != BSP_WHOLE;
}

static cull_result build_index(cull_culler *c, const cull_zone *zone)
{
    const bsp_source from = {zone, c->host->get_extension(c->host, zone, CULL_EXT_BLOB), c->wish};
    cull_result result = bsp_tree_build(c->host, &from, &c->tree);
    if (result == CULL_OK) result = shapes_build(c->host, zone, c->tree.order, &c->shapes);
    if (result == CULL_OK) result = walk_build(c->host, zone, &c->tree, &c->shapes, &c->walk);
    if (result == CULL_OK) result = lent_build(c->host, zone, &c->tree, &c->lent);
    if (result == CULL_OK && c->how != BSP_CELLS_OFF) result = bsp_cells_build(c->host, zone, &c->tree, &c->cells);
    if (result == CULL_OK && c->how != BSP_CELLS_OFF) result = bsp_flow_build(c->host, zone, c->tree.order, &c->cells, &c->flow);
    if (result == CULL_OK && keeps_pieces(c)) result = bsp_pieces_make(c->host, &c->tree, &c->pieces);
    return result;
}

static void tell(const cull_culler *c, const cull_zone *zone, cull_built *out)
{
    out->order = c->tree.order;
    out->scratch_size = larger(walk_scratch(&c->walk, &c->shapes), explain_scratch(&c->shapes));
    out->index_bytes = sizeof *c + bsp_tree_bytes(&c->tree) + shapes_bytes(&c->shapes) + walk_bytes(&c->walk) + lent_bytes(&c->lent) +
                       bsp_cells_bytes(&c->cells) + bsp_flow_bytes(&c->flow) + bsp_pieces_bytes(&c->pieces);
    out->promises = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS;
    out->max_runs = zone->item_count;
    out->max_steps = 1;
}

static cull_result bsp_build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent; // this culler selects; a hierarchy is for filters
    c->zone = zone;
    const cull_result result = build_index(c, zone);
    if (result != CULL_OK) return result;
    c->drawn_bytes = whole_lines(zone->item_count);
    figures_fill(&c->tree, &c->shapes, &c->walk, has_cells(c) ? &c->cells : NULL, &c->figures);
    tell(c, zone, out);
    return CULL_OK;
}

static cull_result bsp_open(const cull_culler *c, cull_query **out)
{
    cull_query *q = c->host->alloc(c->host, sizeof *q, _Alignof(cull_query));
    if (!q) return CULL_ERR_MEMORY;
    memset(q, 0, sizeof *q);
    q->culler = c;
    const bsp_flow_request how = {.cells = &c->cells, .index = &c->flow, .zone = c->zone, .how = c->how, .backface = c->backface, .exits = BSP_EXITS_KEPT};
    if (has_cells(c) && sight_open(c->host, &how, c->drawn_bytes, &q->sight) != CULL_OK) {
        c->host->free(c->host, q, sizeof *q);
        return CULL_ERR_MEMORY;
    }
    *out = q;
    return CULL_OK;
}

static void bsp_close(cull_query *q)
{
    const cull_host *host = q->culler->host;
    sight_close(host, &q->sight);
    host->free(host, q, sizeof *q);
}

// ---- A step ----

// What the flow through the cells reaches, a byte an item. NULL: this view is none for it.
static uint8_t *flow(cull_query *q, const cull_visit *visit, bsp_flow_figures *out)
{
    return has_cells(q->culler) && sight_select(&q->sight, visit, out) ? q->sight.flow.drawn : NULL;
}

// With cells: of what the flow reaches, the part that touches the volumes; so cells only ever take away.
static cull_progress bsp_select(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    const cull_culler *c = q->culler;
    bsp_flow_figures figures = {0, 0, 0, 0};
    walk_request walk = {&c->walk, &c->shapes, visit, c->backface, NULL, visit->scratch, batch->runs + batch->run_count};
    walk.wanted = flow(q, visit, &figures);
    batch->nodes_visited += figures.cells_visited;
    batch->limits_hit += figures.limits_hit;
    batch->run_count += c->kernel(&walk, &batch->nodes_visited);
    return CULL_DONE;
}

// ---- Extensions ----

static size_t bsp_explain(cull_query *q, const cull_visit *visit, uint32_t item, char *text, size_t size)
{
    const cull_culler *c = q->culler;
    bsp_flow_figures figures = {0, 0, 0, 0};
    explain_request request = {&c->shapes, visit, c->backface, EXPLAIN_WALKED};
    const uint8_t *drawn = item < c->shapes.item_count ? flow(q, visit, &figures) : NULL;
    if (drawn) request.flow = drawn[item] ? EXPLAIN_REACHED : EXPLAIN_UNREACHED;
    return explain_item(&request, item, text, size);
}

static uint64_t bsp_save(const cull_culler *c, void *blob, uint64_t size)
{
    return bsp_tree_save(&c->tree, blob, size);
}

static ray_source ray_source_of(const cull_culler *c)
{
    const ray_source from = {&c->walk, c->zone, c->tree.order};
    return from;
}

static uint32_t bsp_segment(const cull_culler *c, cull_vec3 from, cull_vec3 to, cull_run *runs, uint32_t max_runs)
{
    const ray_source source = ray_source_of(c);
    return ray_segment(&source, from, to, runs, max_runs);
}

static uint32_t bsp_box(const cull_culler *c, const cull_box *box, cull_run *runs, uint32_t max_runs)
{
    const ray_source source = ray_source_of(c);
    return ray_box(&source, box, runs, max_runs);
}

static cull_crossing bsp_sight_part(cull_query *q, const cull_view *view, const cull_volume *in, uint32_t portal, uint32_t part, cull_plane *planes,
                                    uint32_t *plane_count)
{
    const sight_question question = {view, in, portal, part};
    return sight_part(&q->sight, &question, planes, plane_count);
}

static const void *bsp_get_extension(const cull_culler *c, const char *id)
{
    static const cull_sight sight = {bsp_sight_part};
    static const cull_explain explain = {bsp_explain};
    static const cull_bake bake = {bsp_save};
    static const cull_ray ray = {bsp_segment, bsp_box};
    if (!c) return NULL; // of the library as a whole it has none
    if (strcmp(id, CULL_EXT_EXPLAIN) == 0) return &explain;
    if (strcmp(id, CULL_EXT_BAKE) == 0) return &bake;
    if (strcmp(id, CULL_EXT_RAY) == 0) return &ray;
    if (strcmp(id, CULL_EXT_HIERARCHY) == 0) return &c->lent.hierarchy;
    if (strcmp(id, CULL_EXT_FIGURES) == 0) return &c->figures.lent;
    if (strcmp(id, CULL_EXT_SIGHT) == 0 && has_cells(c)) return &sight;
    if (strcmp(id, CULL_EXT_PIECES) == 0 && keeps_pieces(c)) return &c->pieces.lent;
    return NULL;
}

// ---- What the library offers ----

static const cull_option bsp_options[OPTION_COUNT] = {
    [OPTION_BACKFACE] = {"backface", "0", "0 1", "1: drop one-sided walls that show only their back to the eye"},
    [OPTION_SPLIT] = {"split", "0", "0 1 node", "0: walls stay whole, listed in every leaf they reach; 1: their pieces stand in leaves; node: in the nodes whose plane they lie in"},
    [OPTION_CHOOSE] = {"choose", "balance", "balance sah first", "how planes are chosen: few splits and even sides, least expected cost, or as they come"},
    [OPTION_CELLS] = {"cells", "off", "off rect hull exact", "what is seen flows through the openings between cells of the tree: one rectangle a cell, up to four convex windows, or up to sixteen, nearly exact"},
    [OPTION_ISA] = {"isa", "auto", NULL, "instruction set: auto, avx2, plain; all find the same set"},
};

static const cull_descriptor bsp_descriptor = {
    .id = "bsp",
    .version = "1",
    .summary = "walls that touch the view, from a tree of their own planes",
    .options = bsp_options,
    .option_count = OPTION_COUNT,
    .may_promise = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS,
};

static const cull_plugin bsp_plugin = {
    .descriptor = &bsp_descriptor,
    .create = bsp_create,
    .destroy = bsp_destroy,
    .build = bsp_build,
    .open = bsp_open,
    .close = bsp_close,
    .select = bsp_select,
    .get_extension = bsp_get_extension,
};

static const cull_plugin *const bsp_plugins[] = {&bsp_plugin};
CULL_ENTRY = {CULL_ABI, 1, bsp_plugins};
