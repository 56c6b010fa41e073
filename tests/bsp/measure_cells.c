// Not a test: measure_cells MAP [none|auto|doors] [SEGMENTS]: cells, openings, bytes and milliseconds of a map's largest zone (none) or of
// all its zones, and what random segments through each find wrong. Figures to be made again by hand.
// SPDX-License-Identifier: MIT
#include "cells_fixture.h"
#include "cells_sight.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double cpu_ms(void)
{
    return (double)clock() * 1e3 / CLOCKS_PER_SEC;
}

typedef struct totals {
    uint32_t zones, cells, walled, openings, entries, backs, orphans, nodes, depth, doubtful, none;
    size_t bytes;
    uint64_t hash; // of all cells' bytes
    double tree_ms, ms;
} totals;

static void measure(const cull_zone *zone, uint64_t segments, totals *t)
{
    culler_host h;
    culler_host_init(&h, 0);
    bsp_tree tree;
    bsp_cells_data cells;
    const double start = cpu_ms();
    if (bsp_tree_build(&h.host, &(bsp_source){.zone = zone}, &tree) != CULL_OK) abort();
    const double made = cpu_ms();
    if (bsp_cells_build(&h.host, zone, &tree, &cells) != CULL_OK) abort();
    t->ms += cpu_ms() - made;
    t->tree_ms += made - start;
    t->zones++;
    t->none += cells.cell_count == 0;
    t->nodes += cells.node_count;
    t->depth = cells.depth > t->depth ? cells.depth : t->depth;
    t->cells += cells.cell_count;
    t->openings += cells.opening_count;
    t->doubtful += cells.doubtful;
    t->bytes += bsp_cells_bytes(&cells);
    t->hash = t->hash * 31 + cells_hash(&cells, tree.order);
    for (uint32_t i = 0; i < cells.cell_count; i++) {
        t->walled += cells.cells[i].entry_count > 0;
        t->entries += cells.cells[i].entry_count;
        t->backs += cells.cells[i].back_count;
    }
    uint8_t *reached = calloc(cells.cell_count + 1, 1);
    for (uint32_t i = 0; reached && i < cells.opening_count; i++) reached[cells.openings[i].to] = 1;
    for (uint32_t i = 0; reached && i < cells.cell_count; i++) t->orphans += cells.cell_count > 1 && !reached[i] && cells.cells[i].entry_count > 0;
    free(reached);
    if (h.lines) printf("log: %s\n", h.last_line);
    if (segments && cells.cell_count) {
        sight_figures f = {0};
        sight_check(zone, &tree, &cells, segments, 7, &f);
        sight_print(&f);
    }
    bsp_cells_free(&h.host, &cells);
    bsp_tree_free(&h.host, &tree);
    if (!failing_allocator_is_clean(&h.memory)) printf("memory was lost\n");
}

int main(int argc, char **argv)
{
    cells_map map;
    const portal_choice portals = argc > 2 && !strcmp(argv[2], "auto") ? PORTALS_AUTO : argc > 2 && !strcmp(argv[2], "doors") ? PORTALS_DOORS : PORTALS_NONE;
    if (argc < 2 || !cells_map_open(argv[1], portals, &map)) return 1;
    totals t = {0};
    const uint64_t segments = argc > 3 ? strtoull(argv[3], NULL, 10) : 0;
    if (portals == PORTALS_NONE) measure(&cells_map_largest(&map)->zone, segments, &t);
    else
        for (uint32_t z = 0; z < map.whole.scene->zone_count; z++) measure(&map.zones[z].zone, segments, &t);
    printf("%s: %u zones, %u without; %u cells, %u with fronts, %u of those that nothing opens to; %u nodes, depth %u; %u openings, %u doubtful; ", argv[1],
           t.zones, t.none, t.cells, t.walled, t.orphans, t.nodes, t.depth, t.openings, t.doubtful);
    printf("%u entries, %u backs, %zu bytes, hash %016llx; tree %.1f ms, cells %.1f ms\n", t.entries, t.backs, t.bytes, (unsigned long long)t.hash, t.tree_ms, t.ms);
    cells_map_close(&map);
    return 0;
}
