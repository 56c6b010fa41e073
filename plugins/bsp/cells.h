// The cells of a zone and the openings between them: space cut by the planes of all walls until each cell is convex air or nothing; what is
// seen flows through them (Teller and Sequin, Visibility Preprocessing for Interactive Walkthroughs, 1991; Luebke and Georges, 1995).
// SPDX-License-Identifier: MIT
//
// Invariant: cells and openings are exact polygons of integer planes (exact.h), positions only their rounding; an opening is part of
// one node's plane and joins a cell in front of it to one behind; where a wall's front covers it whole it is shut that way.
#ifndef PORTCULLIS_BSP_CELLS_H
#define PORTCULLIS_BSP_CELLS_H

#include "tree.h"

// One way through: from `from` to `to`, seen by eyes on the side `side` of the node's plane (0 in front, 1 behind).
typedef struct bsp_opening {
    uint32_t to;           // cell
    uint32_t plane;        // in cells.planes
    uint32_t side;         // the eye's
    uint32_t first_point, point_count; // in opening_points, counterclockwise seen from the eye's side
} bsp_opening;

typedef struct bsp_cell {
    uint32_t parent;                         // node
    uint32_t first_opening, opening_count;   // those that leave it, by `from`
    uint32_t first_entry, entry_count;       // in entries: pieces seen from inside (front faces), and items that are no walls
    uint32_t first_back, back_count;         // pieces whose back borders the cell: seen from here only from behind
    uint32_t first_touching, touching_count; // pieces that face other cells and touch this one: at their edges they share its pixels
    uint32_t apart_count;                    // of them, the first: no open way leads around to the cell that they face
    uint32_t is_beyond;                      // 1: from the zone only a portal leads here: air of another zone, though walls of this one may show
} bsp_cell;

// The part of a zone portal that borders a cell from inside.
typedef struct bsp_stand {
    uint32_t cell;
    uint32_t first_point, point_count; // in stand_points, counterclockwise seen from inside, as the portal's own
    uint32_t is_bent;                  // as loop_is_bent has it
} bsp_stand;

typedef struct bsp_cells_data {
    bsp_plane *planes;     // of nodes
    bsp_node *nodes;       // a tree of its own, its planes chosen for few cells: 30% fewer than the select's tree cut on; a leaf child is a cell
    bsp_cell *cells;
    bsp_opening *openings; // by cell
    cull_point *opening_points, *entry_points;
    cull_vec3 *stand_points;
    bsp_entry *entries;
    uint32_t plane_count, node_count, cell_count, opening_count, opening_point_count, entry_count, entry_point_count;
    uint32_t portal_count, stand_count, stand_point_count;
    // Portals shut openings for who looks out of the zone, but for those that lead to air of this same zone (cells_sets.c); an eye a hair
    // beyond one still sees in. A portal that reaches over rock (walls' backs all around) has stands in its cells of air alone, unless it
    // borders none.
    uint32_t *portal_offsets; // stands of zone portal p: [portal_offsets[p] .. portal_offsets[p + 1]), by cell
    bsp_stand *stands;
    double slack;
    double box_low[3], box_high[3]; // metres: openings are cut to it. An eye outside sees in through zone portals alone
    uint32_t depth;                 // of nodes
    uint32_t doubtful;              // openings left open because walls cut them into too many fragments
} bsp_cells_data;

// cell_count 0: the zone would make more cells, openings or work than cells_build.h says; a line was logged, and bsp_flow returns 0.
// On failure a line is logged and nothing is left.
cull_result bsp_cells_build(const cull_host *host, const cull_zone *zone, const bsp_tree *tree, bsp_cells_data *out);
void bsp_cells_free(const cull_host *host, bsp_cells_data *cells); // of zeros is fine
size_t bsp_cells_bytes(const bsp_cells_data *cells);

// The cells as the flow reads them: in float, all that a cell holds in one place (flow_index.c). Build it once, with the tree's order.
typedef struct bsp_flow_index {
    struct flow_node *nodes;
    struct flow_cell *cells;
    union flow_word *words;
    size_t word_count;
    uint32_t node_count, cell_count;
    double slack; // metres: the cells' and the rounding to float
} bsp_flow_index;
cull_result bsp_flow_build(const cull_host *host, const cull_zone *zone, const uint32_t *order, const bsp_cells_data *cells, bsp_flow_index *out);
void bsp_flow_free(const cull_host *host, bsp_flow_index *index); // of zeros is fine
size_t bsp_flow_bytes(const bsp_flow_index *index);

typedef enum bsp_exits { BSP_EXITS_LOST, BSP_EXITS_KEPT } bsp_exits; // what leaves the zone through its portals

// The flow of one step: marks what is seen. `drawn` has item_count bytes, zero before; 1 = draw. Scratch as told.
typedef struct bsp_flow_request {
    const bsp_cells_data *cells; // its portals and box
    const bsp_flow_index *index; // of these cells
    const cull_zone *zone;
    const cull_visit *visit;
    bsp_cells how;            // rect, hull or exact
    uint32_t backface;        // 1: walls that show only their back are left out
    void *scratch;            // bsp_flow_scratch bytes
    uint8_t *drawn;           // by place in the tree's order, as all items here
    bsp_exits exits;          // KEPT: for bsp_flow_exit
} bsp_flow_request;
typedef struct bsp_flow_figures { uint32_t cells_visited, openings_tried, merges, limits_hit; } bsp_flow_figures;
size_t bsp_flow_scratch(const bsp_cells_data *cells, bsp_cells how);
// 0: this view has no eye at a point, or something else it can't do: the caller walks the tree instead.
int bsp_flow(const bsp_flow_request *q, bsp_flow_figures *out);

// What left through a zone portal in the flow that just filled this request's scratch: at most FLOW_WINDOWS convex windows that lie in
// the scratch, or in *rectangle. Returns how many.
struct window;
uint32_t bsp_flow_exit(const bsp_flow_request *q, uint32_t portal, struct window *rectangle, const struct window **windows);

#endif
