// Pieces of walls on their way into the tree: convex polygons in double, held against planes and cut by them.
// SPDX-License-Identifier: MIT
// Invariant: a cut shares its new points between both parts, bit for bit, and a vertex within the slack of a plane lies on it, so
// the parts cover the piece and overlap nowhere.
#ifndef PORTCULLIS_BSP_PIECES_H
#define PORTCULLIS_BSP_PIECES_H

#include "planes.h"

#include <string.h>

typedef struct bsp_piece {
    double middle[3], half[3]; // its box
    double area;
    uint32_t item, plane, first_point, point_count;
} bsp_piece;

typedef struct piece_set {
    const plane_table *table;
    bsp_vector pieces; // bsp_piece
    bsp_vector points; // cull_point
    bsp_vector heights; // double: of one piece's points over one plane
} piece_set;

typedef enum piece_side { PIECE_FRONT, PIECE_BACK, PIECE_ON_FRONT, PIECE_ON_BACK, PIECE_SPANS } piece_side; // ON: by where it faces

// All walls with a usable plane, in the zone's order. CULL_ERR_MEMORY leaves nothing.
cull_result piece_set_make(const cull_host *host, const cull_zone *zone, const plane_table *table, piece_set *out);
void piece_set_free(piece_set *set);

piece_side piece_side_of(const piece_set *set, uint32_t piece, uint32_t plane);
// Of a piece that spans the plane: parts[0] in front, parts[1] behind. 0 without memory.
int piece_cut(piece_set *set, uint32_t piece, uint32_t plane, uint32_t parts[2]);

static inline const bsp_piece *piece_at(const piece_set *set, uint32_t piece)
{
    return (const bsp_piece *)set->pieces.items + piece;
}

static inline const cull_point *piece_points(const piece_set *set, const bsp_piece *piece)
{
    return (const cull_point *)set->points.items + piece->first_point;
}

// Areas by eighths of an octave. The borders are moved by an odd share, so that no area of small whole numbers lies on one: rounding,
// which turns with the scene, changes no class.
static inline uint64_t area_class(double area)
{
    uint64_t bits;
    memcpy(&bits, &area, sizeof bits);
    return (bits + 0x0000b504f333f9deu) >> 49;
}

#endif
