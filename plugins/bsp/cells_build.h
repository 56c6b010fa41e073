// What the parts of bsp_cells_build share: the walls on their way down the tree, the nodes that they make, the openings found.
// SPDX-License-Identifier: MIT
//
// Invariant: a piece lies in the closed region of the node or cell that lists it, up to `slack`; regions are bounded by planes alone and
// are exact. Where an allocation fails or a limit bites, the part says so and the whole is dropped.
#ifndef PORTCULLIS_BSP_CELLS_BUILD_H
#define PORTCULLIS_BSP_CELLS_BUILD_H

#include "cells.h"
#include "exact_polygon.h"
#include "vector.h"

#include <portcullis/clip.h>

typedef enum cells_status { CELLS_FINE, CELLS_NO_MEMORY, CELLS_TOO_MANY } cells_status;

enum {
    CELLS_MOST = 1 << 18,        // cells of a zone; past one of these four there are none, and the tree is walked
    CELLS_BYTES_MOST = 1 << 28,  // that the build holds at once in its long lists
    CELLS_WORK_MOST = 50000000,  // polygons against planes, exactly: some seconds
    CELLS_FRAGMENTS_MOST = 64,   // that an opening's uncovered part may fall into before it counts as open
};

enum { // cells_piece.flags
    PIECE_PORTAL = 1u << 0, // item is a portal of the zone
    PIECE_BOX = 1u << 1,    // no wall: goes where its box does
    PIECE_BACK = 1u << 2,   // the wall's back: sinks on the other side of its plane
    PIECE_PLACED = 1u << 3, // a node above holds its plane
};

typedef struct cells_piece {
    uint32_t item;               // in the tree's order, or a portal
    uint32_t plane;              // in build.planes, its face in front; BSP_NONE: a box
    uint32_t first_point, point_count; // in build.points
    uint32_t flags;
} cells_piece;

// A portal borders the cell from inside; the piece of it that does, in build.points.
typedef struct cells_stand { uint32_t portal, cell, plane, first_point, point_count; } cells_stand;

typedef struct cells_made { uint32_t first_stand, stand_count; } cells_made; // of a cell

typedef struct cells_interface { // between the cell in front of a node's plane and the one behind it
    uint32_t cells[2], plane;
    uint32_t first_point, point_count; // in opening_points, counterclockwise seen from the front
    uint32_t open;                     // bit 0: for eyes in front, bit 1: for eyes behind
    uint32_t by_portals;               // the same bits: it is shut, and would be open but for the zone's portals
    uint32_t at_portals;               // the same bits: some of it lies in portals that the cell on that side borders from inside
    uint32_t is_sliver;                // no circle of slack fits in
} cells_interface;

// Cells joined by openings that are open both ways. Of a root: areas of the one-sided walls that face its cells, and turn away.
typedef struct cells_set { uint32_t root, has_slivers, is_beyond; double fronts, backs; } cells_set; // has_slivers: open ones that lead to another set

typedef struct cells_build {
    const cull_host *host;
    const cull_zone *zone;
    const bsp_tree *tree;
    double slack, steps_per_metre;
    bsp_vector planes;         // bsp_plane: the tree's, portals' own, and at the end six of the box
    bsp_vector exact;          // exact_plane, of the same
    uint32_t plane_count;      // without the box's
    uint32_t box[6];           // low and high x, y, z: planes
    double box_low[3], box_high[3]; // metres
    bsp_vector points;         // cull_point, of pieces
    bsp_vector stands, made;   // cells_stand, by cell; cells_made, one a cell
    bsp_vector nodes, cells;   // bsp_node, bsp_cell
    bsp_vector entries, entry_points;       // bsp_entry, cull_point
    bsp_vector interfaces, opening_points;  // cells_interface, cull_point
    bsp_vector sets;                        // cells_set, by cell
    uint64_t work;
    uint32_t depth;    // of nodes
    uint32_t given_up; // interfaces that fell into too many fragments
} cells_build;

// Walls, clusters and portals as pieces, appended to `out` (cells_piece).
cells_status cells_gather(cells_build *b, bsp_vector *out);
// Nodes, cells, their entries and stands.
cells_status cells_split(cells_build *b, bsp_vector *pieces);
cells_status cells_find_openings(cells_build *b);
// Sets found->open by the walls and portals that border its two cells.
cells_status cells_cover(cells_build *b, cells_interface *found, bsp_vector *scratch);
// Finds the sets of cells, says which lie beyond portals, and opens what a portal shut though air of this zone lies behind it.
cells_status cells_find_sets(cells_build *b);
uint32_t cells_root(cells_build *b, uint32_t cell);
// Walls turn their backs on it, and nearly none a front.
int cells_is_rock(cells_build *b, uint32_t cell);
// Some wall faces it, and it is no rock.
int cells_is_air(cells_build *b, uint32_t cell);
// Lists pieces also in the cells of other sets that they touch.
cells_status cells_find_touching(cells_build *b);
// 1: the polygon of plane `own` lies in the plane `by`, up to slack, facing as *facing says: 1 as `by` does, -1 against it, 0 too thin to tell.
int cells_lie_in(const cells_build *b, const cull_point *points, uint32_t count, uint32_t own, uint32_t by, int *facing);
// The openings by cell and the portals' cells, all lists handed over.
cells_status cells_hand_over(cells_build *b, bsp_cells_data *out);

static inline const bsp_plane *cells_plane(const cells_build *b, uint32_t plane)
{
    return (const bsp_plane *)b->planes.items + plane;
}

static inline const exact_plane *cells_exact(const cells_build *b, uint32_t plane)
{
    return (const exact_plane *)b->exact.items + plane;
}

static inline double cells_height(const bsp_plane *plane, cull_point p)
{
    return ((plane->normal[0] * p.x + plane->normal[1] * p.y) + plane->normal[2] * p.z) + plane->offset;
}

#endif
