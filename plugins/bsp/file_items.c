// Items without a piece, filed by their boxes: mesh clusters, and walls without a usable plane.
// SPDX-License-Identifier: MIT
// Invariant: whatever point of a box lies in a leaf's region or within the slack of it, the item stands in that leaf or in the one beside.
#include "build.h"

#include <math.h>

enum { FILINGS_AN_ITEM = 64, FILINGS_LEAST = 1 << 20 }; // more in all than this, and a tree is of no use for this zone

// Bit 0: the box reaches in front of the plane, bit 1: behind. One that lies in the plane is seen from both.
static unsigned box_sides(const bsp_plane *plane, const cull_box *box, double slack)
{
    const double low[3] = {(double)box->min.x, (double)box->min.y, (double)box->min.z};
    const double high[3] = {(double)box->max.x, (double)box->max.y, (double)box->max.z};
    double middle[3], half = 0;
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * (low[k] + high[k]);
        half += fabs(plane->normal[k]) * (0.5 * (high[k] - low[k]));
    }
    const double height = plane_height(plane, middle);
    const unsigned sides = (height + half > slack ? 1u : 0u) | (height - half < -slack ? 2u : 0u);
    return sides ? sides : 3u;
}

static int file_box(tree_maker *m, uint32_t item, bsp_vector *ways)
{
    const cull_box box = cull_box_at(&m->zone->boxes, item);
    ways->count = 0;
    if (!vector_add(ways, &(uint32_t){m->nodes.count ? 0 : BSP_LEAF})) return 0;
    while (ways->count) {
        const uint32_t at = ((const uint32_t *)ways->items)[--ways->count];
        if (at & BSP_LEAF) {
            if (!vector_add(&m->filings, &(tree_filing){at, item, BSP_NONE})) return 0;
            continue;
        }
        const bsp_node *node = (const bsp_node *)m->nodes.items + at;
        const unsigned sides = box_sides(plane_at(&m->table, node->plane), &box, m->table.slack);
        for (int side = 1; side >= 0; side--)
            if (sides >> side & 1u && !vector_add(ways, &node->child[side])) return 0;
    }
    return 1;
}

cull_result tree_file_boxes(tree_maker *m)
{
    const uint64_t most = (uint64_t)FILINGS_AN_ITEM * m->zone->item_count + FILINGS_LEAST;
    bsp_vector ways = vector_make(m->host, sizeof(uint32_t));
    cull_result result = CULL_OK;
    for (uint32_t i = 0; i < m->zone->item_count && result == CULL_OK; i++) {
        if (m->table.wall_planes[i] != BSP_NONE) continue;
        if (!file_box(m, i, &ways)) result = CULL_ERR_MEMORY;
        else if (m->filings.count - m->piece_filings > most) result = CULL_ERR_ZONE;
    }
    vector_free(&ways);
    return result;
}
