// Cells of a zone, from its tree: gathered, split, opened, filed. See cells.h.
// SPDX-License-Identifier: MIT
// Invariant: all or nothing; what a limit stops leaves a culler that walks its tree, and a line that says so.
#include "cells_build.h"

#include <stdio.h>

static cells_build build_make(const cull_host *host, const cull_zone *zone, const bsp_tree *tree)
{
    const cells_build b = {.host = host, .zone = zone, .tree = tree, .slack = tree->slack, .steps_per_metre = tree->steps_per_metre,
                           .planes = vector_make(host, sizeof(bsp_plane)), .exact = vector_make(host, sizeof(exact_plane)),
                           .points = vector_make(host, sizeof(cull_point)), .stands = vector_make(host, sizeof(cells_stand)),
                           .made = vector_make(host, sizeof(cells_made)), .nodes = vector_make(host, sizeof(bsp_node)),
                           .cells = vector_make(host, sizeof(bsp_cell)), .entries = vector_make(host, sizeof(bsp_entry)),
                           .entry_points = vector_make(host, sizeof(cull_point)), .interfaces = vector_make(host, sizeof(cells_interface)),
                           .opening_points = vector_make(host, sizeof(cull_point)), .sets = vector_make(host, sizeof(cells_set))};
    return b;
}

static void build_free(cells_build *b)
{
    bsp_vector *const lists[] = {&b->planes, &b->exact, &b->points, &b->stands, &b->made, &b->nodes, &b->cells, &b->entries,
                                 &b->entry_points, &b->interfaces, &b->opening_points, &b->sets};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) vector_free(lists[i]);
}

// ---- Planes ----

// The box that bounds what is infinite: the zone's, wider by a quarter of its size and 16 steps, so that eyes a little outside count as in.
static cells_status box_add(cells_build *b)
{
    const cull_box box = b->zone->box;
    double least[3] = {(double)box.min.x, (double)box.min.y, (double)box.min.z}, most[3] = {(double)box.max.x, (double)box.max.y, (double)box.max.z}, size = 0;
    for (int i = 0; i < 3; i++) {
        if (!(least[i] <= most[i])) least[i] = most[i] = 0; // an empty zone's
        if (most[i] - least[i] > size) size = most[i] - least[i];
    }
    const double margin = size * b->steps_per_metre / 4 + 16;
    b->plane_count = b->planes.count;
    for (int i = 0; i < 6; i++) {
        const int axis = i / 2, is_high = i & 1;
        const int64_t at = is_high ? (int64_t)(most[axis] * b->steps_per_metre + margin) : (int64_t)(least[axis] * b->steps_per_metre - margin);
        bsp_plane plane = {.exact.offset = cull_wide_from(is_high ? at : -at), .offset = (double)(is_high ? at : -at) / b->steps_per_metre};
        plane.exact.normal[axis] = is_high ? -1 : 1; // inside in front
        plane.normal[axis] = is_high ? -1 : 1;
        b->box[i] = b->planes.count;
        (is_high ? b->box_high : b->box_low)[axis] = (double)at / b->steps_per_metre;
        if (!vector_add(&b->planes, &plane)) return CELLS_NO_MEMORY;
    }
    return CELLS_FINE;
}

static cells_status planes_match(cells_build *b)
{
    const uint32_t count = b->planes.count;
    bsp_vector scratch = vector_make(b->host, sizeof(uint32_t));
    uint32_t slots = 16;
    while (slots < 2 * count && slots < 1u << 31) slots *= 2;
    exact_plane *exact = vector_push(&b->exact, count);
    uint32_t *words = vector_reserve(&scratch, slots);
    if (exact && words) {
        for (uint32_t i = 0; i < count; i++) {
            const cull_wide_plane *plane = &cells_plane(b, i)->exact;
            exact[i] = (exact_plane){.plane = *plane, .row = cull_row_of(plane)};
        }
        exact_planes_match(exact, count, words, slots);
    }
    vector_free(&scratch);
    return exact && words ? CELLS_FINE : CELLS_NO_MEMORY;
}

// ---- The whole ----

static int fits(const bsp_tree *tree, const cull_zone *zone)
{
    const double most = (double)zone->radius * tree->steps_per_metre;
    return tree->steps_per_metre > 0 && most <= 2.0 * CULL_GRID_MOST; // room for exact.h's bounds, the box's margin among them
}

static cells_status build_run(cells_build *b, bsp_cells_data *out)
{
    bsp_vector pieces = vector_make(b->host, sizeof(cells_piece));
    void *planes = b->tree->plane_count ? vector_push(&b->planes, b->tree->plane_count) : 0;
    cells_status status = b->tree->plane_count && !planes ? CELLS_NO_MEMORY : CELLS_FINE;
    if (planes) memcpy(planes, b->tree->planes, b->tree->plane_count * sizeof(bsp_plane));
    if (status == CELLS_FINE) status = cells_gather(b, &pieces);
    if (status == CELLS_FINE) status = box_add(b);
    if (status == CELLS_FINE) status = planes_match(b);
    if (status == CELLS_FINE) status = cells_split(b, &pieces);
    if (status == CELLS_FINE) status = cells_find_openings(b);
    if (status == CELLS_FINE) status = cells_find_sets(b);
    if (status == CELLS_FINE) status = cells_find_touching(b);
    if (status == CELLS_FINE) status = cells_hand_over(b, out);
    vector_free(&pieces);
    return status;
}

static void say_too_many(const cells_build *b)
{
    char line[200];
    snprintf(line, sizeof line, "bsp: no cells: %u items make more than %u of them, or more than %u MB or %u M steps to build; walks the tree instead",
             b->tree->item_count, CELLS_MOST, CELLS_BYTES_MOST >> 20, CELLS_WORK_MOST / 1000000);
    b->host->log(b->host, CULL_LOG_WARN, line);
}

cull_result bsp_cells_build(const cull_host *host, const cull_zone *zone, const bsp_tree *tree, bsp_cells_data *out)
{
    memset(out, 0, sizeof *out);
    cells_build b = build_make(host, zone, tree);
    const cells_status status = fits(tree, zone) ? build_run(&b, out) : CELLS_TOO_MANY;
    out->doubtful = b.given_up;
    out->depth = b.depth;
    if (status != CELLS_FINE) bsp_cells_free(host, out);
    if (status == CELLS_TOO_MANY) say_too_many(&b);
    if (status == CELLS_NO_MEMORY) host->log(host, CULL_LOG_ERROR, "bsp: out of memory for the zone's cells");
    build_free(&b);
    return status == CELLS_NO_MEMORY ? CULL_ERR_MEMORY : CULL_OK;
}

typedef struct held { void *items; size_t bytes; } held;

enum { HELD = 10 };

static void held_of(const bsp_cells_data *c, held out[HELD])
{
    const held all[HELD] = {{c->planes, c->plane_count * sizeof *c->planes},
                            {c->nodes, c->node_count * sizeof *c->nodes},
                            {c->cells, c->cell_count * sizeof *c->cells},
                            {c->openings, c->opening_count * sizeof *c->openings},
                            {c->opening_points, c->opening_point_count * sizeof *c->opening_points},
                            {c->entries, c->entry_count * sizeof *c->entries},
                            {c->entry_points, c->entry_point_count * sizeof *c->entry_points},
                            {c->portal_offsets, (c->portal_count + (size_t)1) * sizeof *c->portal_offsets},
                            {c->stands, c->stand_count * sizeof *c->stands},
                            {c->stand_points, c->stand_point_count * sizeof *c->stand_points}};
    memcpy(out, all, sizeof all);
}

void bsp_cells_free(const cull_host *host, bsp_cells_data *cells)
{
    held all[HELD];
    held_of(cells, all);
    for (int i = 0; i < HELD; i++)
        if (all[i].items) host->free(host, all[i].items, all[i].bytes);
    memset(cells, 0, sizeof *cells);
}

size_t bsp_cells_bytes(const bsp_cells_data *cells)
{
    held all[HELD];
    size_t bytes = 0;
    held_of(cells, all);
    for (int i = 0; i < HELD; i++) bytes += all[i].items ? all[i].bytes : 0;
    return bytes;
}
