// The culler `occlusion`: drops what is hidden behind what is drawn, by asking the host for box tests. As a filter it walks the
// tree that the select lends, or takes its candidates; as a select it has a tree of its own. The methods stand in method_*.c.
// SPDX-License-Identifier: MIT
//
// A lent tree that lists each item once is walked, and the select does not run: that tree says all that a select by boxes knows.
// One that lists items several times is of a select that knows more than boxes (walls, cells): its candidates are taken then,
// under a tree of occlusion's own, whose boxes fit better. So does one of its own where the lent one is flat.
#include "chc.h"
#include "cover.h"
#include "explain.h"
#include "figures.h"
#include "hiz_rest.h"
#include "method.h"
#include "pictures.h"

#include <stdio.h>
#include <string.h>

enum { OPTION_METHOD, OPTION_WALK, OPTION_BATCH, OPTION_PRUNE, OPTION_THREADS, OPTION_ISA, OPTION_PIXELS, OPTION_COUNT }; // places in occlusion_options

typedef enum walk_choice { WALK_AUTO, WALK_LENT, WALK_CANDIDATES } walk_choice;

struct cull_culler {
    const cull_host *host;
    const occlusion_method *method;
    walk_choice walk;
    uint32_t batches; // of chc: tests are saved up
    hiz_options hiz_options; // of hiz
    hiz hiz;
    uint32_t mover_capacity, has_tree, has_hiz, numbers_differ; // numbers_differ: places are not the zone's own numbers
    occlusion_tree tree;
    occlusion_figures *figures; // its own: added to while the culler is constant
};
struct cull_query {
    const cull_culler *culler;
    occlusion_history history;
};

// ---- Life of a culler ----

static cull_result option_refused(const cull_host *host, const char *key, const char *value, const char *legal)
{
    char line[200];
    snprintf(line, sizeof line, "occlusion: %s=%.32s: must be %s", key, value, legal);
    host->log(host, CULL_LOG_ERROR, line);
    return CULL_ERR_OPTION;
}

static const occlusion_method *method_named(const char *name)
{
    static const occlusion_method *const methods[] = {&method_wait, &method_last, &method_twophase, &method_chc, &method_hiz};
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++)
        if (strcmp(methods[i]->name, name) == 0) return methods[i];
    return NULL;
}

static int walk_named(const char *name, walk_choice *out)
{
    static const char *const names[] = {"auto", "lent", "candidates"};
    for (int i = 0; i < 3; i++)
        if (strcmp(names[i], name) == 0) {
            *out = (walk_choice)i;
            return 1;
        }
    return 0;
}

static cull_result occlusion_create(const cull_host *host, const char *const *values, cull_culler **out)
{
    walk_choice walk;
    const occlusion_method *method = method_named(values[OPTION_METHOD]);
    if (!method) return option_refused(host, "method", values[OPTION_METHOD], "wait, last, twophase, chc or hiz");
    if (!walk_named(values[OPTION_WALK], &walk)) return option_refused(host, "walk", values[OPTION_WALK], "auto, lent or candidates");
    const int batches = strcmp(values[OPTION_BATCH], "on") == 0;
    if (!batches && strcmp(values[OPTION_BATCH], "off") != 0) return option_refused(host, "batch", values[OPTION_BATCH], "on or off");
    hiz_options hiz_options;
    const cull_result hiz_result = hiz_options_read(host, values + OPTION_PRUNE, &hiz_options);
    if (hiz_result != CULL_OK) return hiz_result;
    cull_culler *c = host->alloc(host, sizeof *c, _Alignof(cull_culler));
    if (!c) return CULL_ERR_MEMORY;
    memset(c, 0, sizeof *c);
    c->hiz_options = hiz_options;
    c->host = host;
    c->method = method;
    c->walk = walk;
    c->batches = batches != 0;
    *out = c;
    return CULL_OK;
}

static void occlusion_destroy(cull_culler *c)
{
    if (c->has_hiz) hiz_free(&c->hiz);
    if (c->has_tree) tree_free(c->host, &c->tree);
    if (c->figures) c->host->free(c->host, c->figures, sizeof *c->figures);
    c->host->free(c->host, c, sizeof *c);
}

static uint32_t entries_of(const cull_culler *c)
{
    return c->tree.node_count + c->tree.item_count + c->mover_capacity;
}

// Of a select before, in a step of their own: hiz has them in its one, and last has but one.
static int tests_pictures(const cull_culler *c)
{
    return c->method != &method_hiz && c->method != &method_last;
}

static void tell(cull_culler *c, cull_built *out)
{
    const uint32_t entries = entries_of(c);
    out->scratch_size = c->has_hiz ? hiz_scratch_bytes(&c->hiz) : sizeof(cover);
    out->index_bytes = sizeof *c + tree_bytes(&c->tree) + (c->has_hiz ? hiz_bytes(&c->hiz) : 0);
    out->promises = c->method->promises;
    out->max_runs = c->tree.item_count;
    out->max_steps = c->method->steps_most(entries);
    out->max_tests = c->method->tests_most(entries);
    if (tests_pictures(c)) {
        out->max_steps += out->max_steps < CULL_MAX_STEPS;
        out->max_tests += pictures_tests(c->tree.item_count);
    }
    out->takes_movers = 1; // a mover may be worth many tests, and its box is as good to test as an item's
}

// Where nothing is lent it may stand first or behind a select without a tree: only the verb tells. The order that is told here
// counts for a select alone, who then says places; a filter says the zone's own numbers.
static cull_result occlusion_build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    const uint64_t entries = (uint64_t)zone->item_count * 2 + zone->mover_capacity + (lent ? lent->node_count : zone->item_count);
    if (entries >= WALK_FINAL / 2) {
        c->host->log(c->host, CULL_LOG_ERROR, "occlusion: the zone has too many items for tags of 31 bits; split it");
        return CULL_ERR_ZONE;
    }
    c->mover_capacity = zone->mover_capacity;
    c->figures = c->host->alloc(c->host, sizeof *c->figures, _Alignof(occlusion_figures));
    if (!c->figures) return CULL_ERR_MEMORY;
    const int walks = c->walk != WALK_CANDIDATES && tree_can_walk(zone, lent);
    if (c->walk == WALK_LENT && lent && !walks) {
        c->host->log(c->host, CULL_LOG_ERROR, "occlusion: walk=lent: the lent tree lists items several times; use walk=auto");
        return CULL_ERR_OPTION;
    }
    const cull_result result = tree_make(c->host, zone, walks && tree_is_fine(lent) ? lent : NULL, &c->tree);
    if (result != CULL_OK) return result;
    c->has_tree = 1;
    for (uint32_t i = 0; i < zone->item_count; i++) c->numbers_differ |= c->tree.ids[i] != i;
    if (c->method == &method_hiz) {
        const cull_result made = hiz_make(c->host, zone, &c->hiz_options, &c->hiz);
        if (made != CULL_OK) return made;
        c->has_hiz = 1;
    }
    figures_begin(&c->tree, c->figures);
    tell(c, out);
    out->order = c->tree.ids;
    out->walks_hierarchy = walks != 0;
    return CULL_OK;
}

static cull_result occlusion_open(const cull_culler *c, cull_query **out)
{
    cull_query *q = c->host->alloc(c->host, sizeof *q, _Alignof(cull_query));
    if (!q) return CULL_ERR_MEMORY;
    const history_request request = {&c->tree, c->mover_capacity};
    if (history_open(c->host, &request, &q->history) != CULL_OK) {
        c->host->free(c->host, q, sizeof *q);
        return CULL_ERR_MEMORY;
    }
    const chc_request wanted = {entries_of(c), c->batches};
    if (c->method == &method_chc && chc_open(c->host, &q->history, &wanted) != CULL_OK) {
        history_close(c->host, &q->history);
        c->host->free(c->host, q, sizeof *q);
        return CULL_ERR_MEMORY;
    }
    q->history.test_most = c->method->tests_most(entries_of(c));
    q->culler = c;
    *out = q;
    return CULL_OK;
}

static void occlusion_close(cull_query *q)
{
    const cull_host *host = q->culler->host;
    figures_add(q->culler->figures, &q->history.counters);
    chc_close(host, &q->history);
    history_close(host, &q->history);
    host->free(host, q, sizeof *q);
}

// ---- A step ----

static occlusion_walk walk_of(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    const cull_view *view = visit->view;
    const float corner = view->near_distance * (float)view->reach * 1.001f + 1e-6f * (float)view->reach;
    occlusion_walk w = {.tree = &q->culler->tree, .h = &q->history, .visit = visit, .batch = batch, .eye = {view->eye[0], view->eye[1], view->eye[2]}};
    w.near2 = view->eye[3] == 0 ? -1 : corner * corner;
    w.ids = q->history.says_places ? NULL : w.tree->ids;
    w.places = q->history.says_places ? NULL : w.tree->places;
    w.takes_candidates = visit->candidates != NULL;
    return w;
}

static cull_progress hiz_frame_step(cull_query *q, occlusion_walk *w)
{
    const hiz *h = &q->culler->hiz;
    hiz_counters *counters = &q->history.counters.hiz;
    if (hiz_rest_frame(w, &counters->rest)) return CULL_DONE;
    const uint64_t saved = counters->drops.polygons;
    const cull_progress progress = hiz_step(h, q->history.says_places ? q->culler->tree.places : NULL, w->visit, w->batch, counters);
    hiz_rest_judge(w, h, counters->drops.polygons - saved, &counters->rest);
    return progress;
}

// Answers to what the method asked for the next frame come now, as they would then.
static cull_progress pictures_step(occlusion_walk *w)
{
    if (w->h->chc) chc_hear(w);
    pictures_judge(w);
    return CULL_DONE;
}

static cull_progress occlusion_step(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    const cull_culler *c = q->culler;
    occlusion_walk w = walk_of(q, visit, batch);
    if (c->has_hiz) return hiz_frame_step(q, &w);
    if (visit->step == 0) walk_begin(&w);
    q->history.first_run = batch->run_count;
    walk_hear(&w);
    if (q->history.is_over) return pictures_step(&w);
    const cull_progress progress = c->method->step(&w);
    const int asks = progress == CULL_DONE && tests_pictures(c) && pictures_ask(&w);
    walk_count_turns(&w);
    return asks ? CULL_WAIT : progress;
}

static cull_progress occlusion_select(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    q->history.says_places = 1;
    return occlusion_step(q, visit, batch);
}

static cull_progress occlusion_filter(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    q->history.says_places = !q->culler->numbers_differ;
    return occlusion_step(q, visit, batch);
}

// ---- Extensions ----

static size_t occlusion_explain(cull_query *q, const cull_visit *visit, uint32_t item, char *text, size_t size)
{
    const occlusion_walk w = walk_of(q, visit, NULL);
    const int rests = q->history.serial && q->history.rested == q->history.serial;
    if (q->culler->has_hiz && !rests && item < w.tree->item_count)
        return explain_sight(&w, item, hiz_look(&q->culler->hiz, visit, q->history.says_places ? w.tree->ids[item] : item), text, size);
    return explain_item(&w, item, text, size);
}

static const void *occlusion_get_extension(const cull_culler *c, const char *id)
{
    static const cull_explain explain = {occlusion_explain};
    if (!c) return NULL; // of the library as a whole it has none
    if (strcmp(id, CULL_EXT_EXPLAIN) == 0) return &explain;
    return strcmp(id, CULL_EXT_FIGURES) == 0 ? &c->figures->lent : NULL;
}

// ---- What the library offers ----

static const cull_option occlusion_options[OPTION_COUNT] = {
    [OPTION_METHOD] = {"method", "twophase", "wait last twophase chc hiz",
                       "wait: each box is tested and waited for; last: the last frame's answers are believed; twophase: what was seen is drawn, the rest "
                       "tested in rounds; chc: the same while tests are under way, several boxes under one; hiz: behind what the CPU draws of the items, nothing is asked of the host"},
    [OPTION_WALK] = {"walk", "auto", NULL, "lent: the select's tree, the select does not run; candidates: what the select found; auto: lent where that tree lists each item once"},
    [OPTION_BATCH] = {"batch", "on", NULL, "of chc: on: tests are saved up, which saves state changes; off: each is asked as it is found"},
    [OPTION_PRUNE] = {"prune", "on", NULL, "of hiz: on: tiles that a polygon does not touch are passed over; off: all tiles of its rectangle are looked at"},
    [OPTION_THREADS] = {"threads", "1", NULL, "of hiz: 1, 2, 4 or 8 bands of the picture, each a task of its own; the same result"},
    [OPTION_ISA] = {"isa", "auto", NULL, "of hiz: instruction set: auto, avx512, avx2, plain; all find the same set"},
    [OPTION_PIXELS] = {"pixels", "auto", NULL, "of hiz: 1, 2 or 4 pixels share a depth: coarser is faster and leaves more; auto: 2 in a large picture of few boxes, else 1"},
};

static const cull_descriptor occlusion_descriptor = {
    .id = "occlusion",
    .version = "1",
    .summary = "drops what is hidden behind what is drawn, by box tests",
    .options = occlusion_options,
    .option_count = OPTION_COUNT,
    .may_promise = CULL_SAMPLED | CULL_STATELESS,
};

static const cull_plugin occlusion_plugin = {
    .descriptor = &occlusion_descriptor,
    .create = occlusion_create,
    .destroy = occlusion_destroy,
    .build = occlusion_build,
    .open = occlusion_open,
    .close = occlusion_close,
    .select = occlusion_select,
    .filter = occlusion_filter,
    .get_extension = occlusion_get_extension,
};

static const cull_plugin *const occlusion_plugins[] = {&occlusion_plugin};
CULL_ENTRY = {CULL_ABI, 1, occlusion_plugins};
