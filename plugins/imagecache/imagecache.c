// The culler `imagecache`: an open zone as square cells over x-z, those in view found in whole numbers, near ones shown as geometry and far ones as
// cached pictures (uniform-cell image cache, 1998 report, part A; repaired where it errs: footprint.h, rings.h, bound.h, cut.h).
// SPDX-License-Identifier: MIT
//
// Invariant: but with walk=bresenham no item with a point in a volume is dropped, whatever the other options; each item is drawn once.
#include "explain.h"
#include "geometry.h"
#include "options.h"
#include "tree.h"

#include <stdio.h>
#include <string.h>

enum { FIGURE_COUNT = 18, FIGURES_BUILT = 5 }; // the others change when a query closes

struct cull_culler {
    const cull_host *host;
    options options;
    cells cells;
    tree tree; // what all is walked by while all is geometry; of walk=tree, and where there may be pictures
    show_culler show;
    cull_figure *figures;
    cull_figures lent;
};

struct cull_query {
    const cull_culler *culler;
    inview inview;
    geometry geometry;
    show show;
};

// ---- Life of a culler ----

static cull_result imagecache_create(const cull_host *host, const char *const *values, cull_culler **out)
{
    options read;
    const cull_result result = options_read(host, values, &read);
    if (result != CULL_OK) return result;
    cull_culler *c = host->alloc(host, sizeof *c, _Alignof(cull_culler));
    if (!c) return CULL_ERR_MEMORY;
    memset(c, 0, sizeof *c);
    c->host = host;
    c->options = read;
    *out = c;
    return CULL_OK;
}

static void imagecache_destroy(cull_culler *c)
{
    show_free(c->host, &c->show);
    tree_free(c->host, &c->tree);
    cells_free(c->host, &c->cells);
    if (c->figures) c->host->free(c->host, c->figures, FIGURE_COUNT * sizeof *c->figures);
    c->host->free(c->host, c, sizeof *c);
}

static void say_level(const cull_culler *c)
{
    char line[200];
    if (c->options.level == CELLS_LEVEL_AUTO || c->cells.level_asked == c->cells.ground.level) return;
    snprintf(line, sizeof line, "imagecache: level=%u would list %u items too often (items are wide): level %u is taken", (unsigned)c->cells.level_asked,
             (unsigned)c->cells.item_count, (unsigned)c->cells.ground.level);
    c->host->log(c->host, CULL_LOG_WARN, line);
}

static int make_figures(cull_culler *c)
{
    const cells *s = &c->cells;
    const cull_figure figures[FIGURE_COUNT] = {
        {"cell_level", s->ground.level, CULL_FIGURE_MAX, 0},    {"cell_size_m", s->ground.size, CULL_FIGURE_MAX, 0},
        {"cells", s->cell_count, CULL_FIGURE_SUM, 0},           {"cells_used", s->used_count, CULL_FIGURE_SUM, 0},
        {"cell_listings", (double)s->listing_count, CULL_FIGURE_SUM, 0},
        {"frames_planned", 0, CULL_FIGURE_SUM, 0},              {"frames_of_geometry", 0, CULL_FIGURE_SUM, 0},
        {"pictures_shown", 0, CULL_FIGURE_SUM, 0},              {"pictures_taken", 0, CULL_FIGURE_SUM, 0},
        {"pictures_early", 0, CULL_FIGURE_SUM, 0},              {"pictures_stale", 0, CULL_FIGURE_SUM, 0},
        {"nodes_tested", 0, CULL_FIGURE_SUM, 0},                {"nodes_hidden", 0, CULL_FIGURE_SUM, 0},
        {"pictures_evicted", 0, CULL_FIGURE_SUM, 0},            {"polygons_taken", 0, CULL_FIGURE_SUM, 0},
        {"polygons_spared", 0, CULL_FIGURE_SUM, 0},             {"frames_handed_back", 0, CULL_FIGURE_SUM, 0},
        {"error_px_most", 0, CULL_FIGURE_MAX, 0},
    };
    c->figures = c->host->alloc(c->host, sizeof figures, _Alignof(cull_figure));
    if (!c->figures) return 0;
    memcpy(c->figures, figures, sizeof figures);
    c->lent = (cull_figures){c->figures, FIGURE_COUNT, 0};
    return 1;
}

static void add_counts(cull_figure *figures, const show_counts *n)
{
    const double values[FIGURE_COUNT - FIGURES_BUILT - 1] = {(double)n->frames, (double)n->geometry_frames, (double)n->pictures, (double)n->captures,
                                                             (double)n->early,  (double)n->stale,           (double)n->tests,    (double)n->hidden,
                                                             (double)n->evicted, n->polygons, n->spared, (double)n->handed_back};
    cull_figure *const most = &figures[FIGURE_COUNT - 1];
    for (int i = 0; i < FIGURE_COUNT - FIGURES_BUILT - 1; i++) figures[FIGURES_BUILT + i].value += values[i];
    if (n->error_px > most->value) most->value = n->error_px;
}

static cull_result imagecache_build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)lent; // this culler selects; a hierarchy is for filters
    const inview_walk walk = c->options.ways.walk;
    cull_result result = cells_build(c->host, zone, c->options.level, &c->cells);
    if (result == CULL_OK && c->options.show.show != SHOW_GEOMETRY && c->cells.ground.level > SHOW_LEVELS_MOST) {
        cells_free(c->host, &c->cells);
        result = cells_build(c->host, zone, SHOW_LEVELS_MOST, &c->cells);
    }
    if (result == CULL_OK) result = show_build(c->host, zone, &c->cells, &c->options.show, &c->show);
    if (result != CULL_OK) return result;
    if ((walk == INVIEW_TREE || c->show.costs) && !tree_build(c->host, &c->cells, &c->tree)) return CULL_ERR_MEMORY;
    if (!make_figures(c)) return CULL_ERR_MEMORY;
    say_level(c);
    out->order = c->cells.order;
    out->max_runs = zone->item_count + 1; // neighbours seen from different sides may stand alone
    out->index_bytes = sizeof *c + cells_bytes(&c->cells) + c->tree.bytes;
    out->promises = (c->show.costs ? 0u : CULL_STATELESS) | (walk == INVIEW_BRESENHAM ? 0u : CULL_CONSERVATIVE | CULL_SAMPLED);
    out->max_steps = 1;
    show_tell(&c->show, &c->cells, out);
    return CULL_OK;
}

static void free_query(cull_query *q)
{
    const cull_host *host = q->culler->host;
    show_close(host, &q->show);
    geometry_close(host, &q->geometry);
    inview_close(host, &q->inview);
    host->free(host, q, sizeof *q);
}

static cull_result imagecache_open(const cull_culler *c, cull_query **out)
{
    cull_query *q = c->host->alloc(c->host, sizeof *q, _Alignof(cull_query));
    if (!q) return CULL_ERR_MEMORY;
    memset(q, 0, sizeof *q);
    q->culler = c;
    if (inview_open(c->host, &c->cells, &q->inview) && geometry_open(c->host, &c->cells, &q->geometry) &&
        show_open(c->host, &c->cells, &c->show, &q->show)) {
        *out = q;
        return CULL_OK;
    }
    free_query(q);
    return CULL_ERR_MEMORY;
}

static void imagecache_close(cull_query *q)
{
    add_counts(q->culler->figures, &q->show.counts);
    free_query(q);
}

// ---- A step ----

// Geometry for every cell in view.
static void show_cells(cull_query *q)
{
    const inview *seen = &q->inview;
    for (uint32_t k = 0; k < seen->count; k++)
        geometry_show(&q->geometry, seen->list[k], (geometry_sight){seen->volumes, seen->masks[seen->list[k]]});
    geometry_draw(&q->geometry);
}

// No cell is asked about.
static int is_all_geometry(const cull_culler *c, const cull_visit *visit)
{
    return c->tree.nodes && visit->volume_count <= TREE_VOLUMES;
}

static void show_tree(const cull_culler *c, const cull_visit *visit, cull_batch *batch)
{
    const tree_query all = {&c->tree, &c->cells, visit->volumes, visit->volume_count, inview_eye(&c->cells.ground, visit->view)};
    batch->run_count += tree_walk(&all, batch->runs + batch->run_count, &batch->nodes_visited);
}

// 0: pictures don't pay here.
static int show_near(cull_query *q, const show_frame *f, cull_batch *batch, cull_progress *out)
{
    inview_gather(&q->inview, f->visit, 0, q->culler->options.ways);
    batch->nodes_visited += q->inview.rings_walked;
    if (!show_plan(&q->show, f)) return 0;
    geometry_begin(&q->geometry, batch->runs, GEOMETRY_DRAWN_OFTEN);
    *out = show_geometry(&q->show, f, batch);
    return 1;
}

// Near cells as geometry, far ones as pictures; in two steps where tests say which are hidden. 0: as show_near.
static int show_near_and_far(cull_query *q, const cull_visit *visit, cull_batch *batch, cull_progress *out)
{
    const show_frame f = {visit, &q->inview, &q->geometry, inview_eye(&q->culler->cells.ground, visit->view)};
    *out = CULL_DONE;
    if (visit->step == 0 && (!show_takes(&q->show, visit) || !show_near(q, &f, batch, out))) return 0;
    q->inview.volumes = visit->volumes; // lent for the step
    if (*out == CULL_DONE) {
        show_pictures(&q->show, &f, batch);
        batch->nodes_visited += q->geometry.tested;
    }
    batch->run_count = q->geometry.run_count;
    return 1;
}

static cull_progress imagecache_select(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    cull_progress progress;
    if (show_near_and_far(q, visit, batch, &progress)) return progress;
    if (is_all_geometry(q->culler, visit)) {
        show_tree(q->culler, visit, batch);
        return CULL_DONE;
    }
    geometry_begin(&q->geometry, batch->runs + batch->run_count, visit->volume_count > INVIEW_VOLUMES ? GEOMETRY_DRAWN_OFTEN : GEOMETRY_DRAWN_ONCE);
    for (uint32_t first = 0; first < visit->volume_count;) {
        first += inview_gather(&q->inview, visit, first, q->culler->options.ways);
        show_cells(q);
        batch->nodes_visited += q->inview.rings_walked;
    }
    batch->nodes_visited += q->geometry.tested;
    batch->run_count += q->geometry.run_count;
    return CULL_DONE;
}

// ---- Extensions ----

static size_t imagecache_explain(cull_query *q, const cull_visit *visit, uint32_t item, char *text, size_t size)
{
    const cells *c = &q->culler->cells;
    const int had_pictures = q->show.last == SHOW_HAS_PICTURES;
    const explain_by by = !had_pictures && is_all_geometry(q->culler, visit) ? EXPLAIN_BY_BOXES : EXPLAIN_BY_CELLS;
    const size_t length = explain_item(c, by, visit, item, text, size);
    if (!had_pictures || item >= c->item_count || size < 5 || strncmp(text, "kept", 4) != 0) return length;
    const size_t told = show_explain(&q->show, item, text, size);
    return told ? told : explain_item(c, by, visit, item, text, size);
}

static const void *imagecache_get_extension(const cull_culler *c, const char *id)
{
    static const cull_explain explain = {imagecache_explain};
    if (!c) return NULL; // of the library as a whole it has none
    if (strcmp(id, CULL_EXT_EXPLAIN) == 0) return &explain;
    return strcmp(id, CULL_EXT_FIGURES) == 0 ? &c->lent : NULL;
}

// ---- What the library offers ----

static const cull_descriptor imagecache_descriptor = {
    .id = "imagecache",
    .version = "1",
    .summary = "an open zone as ground cells: near ones as geometry, far ones as cached pictures that are never off by more than a tolerance",
    .options = options_table,
    .option_count = OPTION_COUNT,
    .may_promise = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS,
};

static const cull_plugin imagecache_plugin = {
    .descriptor = &imagecache_descriptor,
    .create = imagecache_create,
    .destroy = imagecache_destroy,
    .build = imagecache_build,
    .open = imagecache_open,
    .close = imagecache_close,
    .select = imagecache_select,
    .get_extension = imagecache_get_extension,
};

static const cull_plugin *const imagecache_plugins[] = {&imagecache_plugin};
CULL_ENTRY = {CULL_ABI, 1, imagecache_plugins};
