// The order of items and the entries of leaves and nodes, from what was filed: leaves are runs as far as items stand in one leaf.
// SPDX-License-Identifier: MIT
// Invariant: an item's place is where the walk meets its largest piece, walls before what is filed by its box; entries of one owner
// rise by place.
#include "build.h"

#include <string.h>

typedef struct layout {
    const tree_maker *m;
    bsp_tree *out;
    uint32_t *places;         // an item: its place; until then its home, the filing that it is ordered by
    uint32_t *firsts, *sorted; // filings by place: sorted[firsts[p] .. firsts[p + 1])
    uint32_t *cursors;        // an owner: where its next entry goes; nodes, then leaves; walls, then boxes
    uint32_t owners;
    uint32_t points_used;
} layout;

static const tree_filing *filing_at(const layout *l, uint32_t i)
{
    return (const tree_filing *)l->m->filings.items + i;
}

static uint32_t owner_number(const layout *l, uint32_t owner)
{
    return owner & BSP_LEAF ? l->out->node_count + (owner & ~BSP_LEAF) : owner;
}

// Where the largest piece lies: those pieces are met together, and runs come out 5% longer than by the first piece.
static int is_better_home(const layout *l, uint32_t filing, uint32_t home)
{
    if (home == BSP_NONE) return 1;
    const uint32_t piece = filing_at(l, filing)->piece, known = filing_at(l, home)->piece;
    if (piece == BSP_NONE) return 0;
    return area_class(piece_at(&l->m->set, piece)->area) > area_class(piece_at(&l->m->set, known)->area);
}

static void order_items(layout *l)
{
    uint32_t used = 0;
    for (uint32_t i = 0; i < l->out->item_count; i++) l->places[i] = BSP_NONE;
    for (uint32_t i = 0; i < l->out->entry_count; i++) {
        uint32_t *home = &l->places[filing_at(l, i)->item];
        if (is_better_home(l, i, *home)) *home = i;
    }
    for (uint32_t i = 0; i < l->out->entry_count; i++)
        if (l->places[filing_at(l, i)->item] == i) l->out->order[used++] = filing_at(l, i)->item;
    for (uint32_t p = 0; p < used; p++) l->places[l->out->order[p]] = p;
}

static void sort_filings(layout *l) // by place; those of one place keep their order
{
    const uint32_t items = l->out->item_count, count = l->out->entry_count;
    memset(l->firsts, 0, ((size_t)items + 1) * sizeof *l->firsts);
    for (uint32_t i = 0; i < count; i++) l->firsts[l->places[filing_at(l, i)->item] + 1]++;
    for (uint32_t p = 0; p < items; p++) {
        l->out->spanning += l->firsts[p + 1] > 1;
        l->firsts[p + 1] += l->firsts[p];
    }
    for (uint32_t i = 0; i < count; i++) l->sorted[l->firsts[l->places[filing_at(l, i)->item]]++] = i;
}

static void give_ranges(layout *l)
{
    bsp_tree *out = l->out;
    memset(l->cursors, 0, (size_t)l->owners * 2 * sizeof *l->cursors);
    for (uint32_t i = 0; i < out->entry_count; i++) {
        const tree_filing *f = filing_at(l, i);
        l->cursors[2 * owner_number(l, f->owner) + (f->piece == BSP_NONE)]++;
    }
    uint32_t first = 0;
    for (uint32_t o = 0; o < l->owners; o++) {
        const uint32_t walls = l->cursors[2 * o], boxes = l->cursors[2 * o + 1];
        uint32_t *const to_first = o < out->node_count ? &out->nodes[o].first_entry : &out->leaves[o - out->node_count].first_entry;
        uint32_t *const to_count = o < out->node_count ? &out->nodes[o].entry_count : &out->leaves[o - out->node_count].entry_count;
        *to_first = l->cursors[2 * o] = first;
        l->cursors[2 * o + 1] = first + walls;
        *to_count = walls + boxes;
        first += walls + boxes;
    }
}

static void fill_entries(layout *l)
{
    const piece_set *set = &l->m->set;
    for (uint32_t i = 0; i < l->out->entry_count; i++) {
        const tree_filing *f = filing_at(l, l->sorted[i]);
        bsp_entry *entry = &l->out->entries[l->cursors[2 * owner_number(l, f->owner) + (f->piece == BSP_NONE)]++];
        *entry = (bsp_entry){.item = l->places[f->item], .plane = BSP_NONE};
        if (f->piece == BSP_NONE) continue;
        entry->plane = piece_at(set, f->piece)->plane;
        entry->point_count = f->piece; // until points are given out, in the order of entries
    }
    for (uint32_t i = 0; i < l->out->entry_count; i++) {
        bsp_entry *entry = &l->out->entries[i];
        entry->first_point = l->points_used;
        if (entry->plane == BSP_NONE) continue;
        const bsp_piece *piece = piece_at(set, entry->point_count);
        memcpy(l->out->points + l->points_used, piece_points(set, piece), piece->point_count * sizeof *l->out->points);
        entry->point_count = piece->point_count;
        l->points_used += piece->point_count;
    }
}

static int count_points(const tree_maker *m, uint32_t *out)
{
    uint64_t sum = 0;
    const tree_filing *filings = m->filings.items;
    for (uint32_t i = 0; i < m->piece_filings; i++) sum += piece_at(&m->set, filings[i].piece)->point_count;
    *out = (uint32_t)sum;
    return sum < BSP_LEAF;
}

cull_result tree_lay_out(tree_maker *m, bsp_tree *out)
{
    int failed = 0;
    layout l = {.m = m, .out = out, .owners = out->node_count + out->leaf_count};
    out->entry_count = m->filings.count;
    if (!count_points(m, &out->point_count)) {
        out->point_count = 0;
        failed = 1;
    }
    l.places = array_alloc(m->host, out->item_count, sizeof *l.places, &failed);
    l.firsts = array_alloc(m->host, (size_t)out->item_count + 1, sizeof *l.firsts, &failed);
    l.sorted = array_alloc(m->host, out->entry_count, sizeof *l.sorted, &failed);
    l.cursors = array_alloc(m->host, (size_t)l.owners * 2, sizeof *l.cursors, &failed);
    out->entries = array_alloc(m->host, out->entry_count, sizeof *out->entries, &failed);
    out->points = array_alloc(m->host, out->point_count, sizeof *out->points, &failed);
    if (!failed) {
        order_items(&l);
        sort_filings(&l);
        give_ranges(&l);
        fill_entries(&l);
    }
    array_free(m->host, l.places, out->item_count, sizeof *l.places);
    array_free(m->host, l.firsts, (size_t)out->item_count + 1, sizeof *l.firsts);
    array_free(m->host, l.sorted, out->entry_count, sizeof *l.sorted);
    array_free(m->host, l.cursors, (size_t)l.owners * 2, sizeof *l.cursors);
    return failed ? CULL_ERR_MEMORY : CULL_OK;
}
