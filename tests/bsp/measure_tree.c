// Not a test: builds the trees of a scene file's zones, checks them, and prints their figures.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "tree_fixture.h"

#include "host/core/zone_data.h"
#include "host/import/pcs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static int measure_zone(const scene *s, uint32_t zone, bsp_wish wish, int is_checked)
{
    zone_data data;
    culler_host host;
    bsp_tree tree;
    if (zone_data_open(&(zone_data_request){s, zone, 0}, allocator_heap(), &data) != RESULT_OK) return 1;
    culler_host_init(&host, 0);
    const bsp_source from = {&data.zone, NULL, wish};
    const double start = now_ms();
    if (bsp_tree_build(&host.host, &from, &tree) != CULL_OK) return 1;
    const double ms = now_ms() - start;
    const char *fault = is_checked ? tree_fault(&data.zone, &tree) : NULL;
    printf("zone %u: items %u exact %d nodes %u depth %u splits %u spanning %u entries %u", zone, tree.item_count, data.zone.exact_planes != NULL,
           tree.node_count, tree.depth, tree.splits, tree.spanning, tree.entry_count);
    printf(" bent %u boxed %u slack %g tests/item %.0f ms %.1f bytes %zu %s\n", tree.bent_leaves, tree.boxed_walls, tree.slack,
           (double)tree.classified / (tree.item_count ? tree.item_count : 1), ms, bsp_tree_bytes(&tree), fault ? fault : "good");
    bsp_tree_free(&host.host, &tree);
    zone_data_close(&data);
    return fault != NULL;
}

int main(int argc, char **argv)
{
    scene *s = NULL;
    report r = report_to_stderr();
    if (argc < 4) {
        fprintf(stderr, "usage: measure_tree FILE.pcs balance|sah|first 0|1|node [nocheck]\n");
        return 2;
    }
    const bsp_choose choose = strcmp(argv[2], "sah") == 0 ? BSP_SAH : strcmp(argv[2], "first") == 0 ? BSP_FIRST : BSP_BALANCE;
    const bsp_split split = strcmp(argv[3], "node") == 0 ? BSP_SPLIT_NODES : argv[3][0] == '1' ? BSP_SPLIT_LEAVES : BSP_WHOLE;
    if (pcs_load(argv[1], allocator_heap(), &r, &s) != RESULT_OK) return 1;
    int failed = 0;
    for (uint32_t z = 0; z < s->zone_count; z++) failed |= measure_zone(s, z, (bsp_wish){split, choose, 0, 0}, argc < 5);
    return failed;
}
