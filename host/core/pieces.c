// Pieces: see pieces.h.
// SPDX-License-Identifier: MIT
// Invariant: what is lent to a renderer has been read once, number by number; the order is checked anew each time it is asked.
#include "pieces.h"

#include <math.h>

static const size_t SCRATCH_BYTES_MOST = (size_t)1 << 32; // who wants more is wrong about something
enum { PIECE_POINTS_MOST = 1 << 16 };                     // and so here

static const char *piece_fault(const cull_pieces *p, const cull_piece *piece, uint32_t item_count)
{
    if (piece->item >= item_count) return "a piece is of no item";
    if (piece->point_count < 3 || piece->point_count > PIECE_POINTS_MOST) return "a piece has not 3 to 65,536 points";
    if (piece->first_point > p->point_count || piece->point_count > p->point_count - piece->first_point) return "a piece's points are not there";
    for (uint32_t i = piece->first_point; i < piece->first_point + piece->point_count; ++i)
        if (!isfinite(p->points[i][0]) || !isfinite(p->points[i][1]) || !isfinite(p->points[i][2])) return "a piece's point is not finite";
    return NULL;
}

const char *pieces_fault(const cull_pieces *p, uint32_t item_count)
{
    if (!p->order) return "they have no order";
    if (p->scratch_size > SCRATCH_BYTES_MOST) return "their order wants over 4 GiB of scratch";
    if (p->piece_count && (!p->pieces || !p->points)) return "there are no lists of them";
    for (uint32_t i = 0; i < p->piece_count; ++i) {
        const char *fault = piece_fault(p, &p->pieces[i], item_count);
        if (fault) return fault;
    }
    return NULL;
}

const cull_pieces *chain_pieces(const chain *c, report *r)
{
    if (!c) return NULL;
    const chain_stage *select = &c->stages[0];
    const cull_pieces *p = select->plugin->get_extension(select->culler, CULL_EXT_PIECES);
    if (!p || !p->piece_count) return NULL;
    const char *fault = pieces_fault(p, c->zone.item_count);
    if (!fault) return p;
    report_warning(r, c->data->scene->path, 0, "culler '%s' lends pieces that are nonsense: %s; mend the plugin (see-through items go by distance)",
                   select->plugin->descriptor->id, fault);
    return NULL;
}
