// For tests of the image cache's grid: random views of a ground, and oracles that know nothing of how the plugin does it.
// SPDX-License-Identifier: MIT
#ifndef TESTS_IMAGECACHE_GRID_CAMERA_H
#define TESTS_IMAGECACHE_GRID_CAMERA_H

#include "plugins/imagecache/footprint.h"
#include "tests/common/random.h"

enum { GRID_SIDES = 5, GRID_AXES = 26 }; // 4 sides and the far plane; separating axes of a pyramid and a box

// A pyramid, as a camera sees: apex and four far corners.
typedef struct grid_view {
    double eye[3], right[3], up[3], forward[3];
    double tan_wide, tan_tall, far_m;
    double corners[4][3];
    cull_plane planes[GRID_SIDES]; // guarded as a host does
    cull_volume volume;
} grid_view;

typedef struct grid_turn { // radians
    double heading, pitch, roll, fov; // fov: horizontal
} grid_turn;

typedef enum grid_eyes { GRID_EYES_INSIDE, GRID_EYES_ANYWHERE } grid_eyes; // inside: over the ground, between its heights

grid_turn grid_turn_random(uint64_t *r);             // pitch, roll and fov 20 to 120 degrees of all kinds
grid_turn grid_turn_level(uint64_t *r, double fov);  // any heading, no pitch, no roll
void grid_view_random(uint64_t *r, const ground *g, grid_turn turn, grid_eyes eyes, grid_view *out);

// How far the pyramid and the closed column of a cell are apart, metres: at most 0 where they touch. The largest gap of all
// separating axes (Gottschalk et al., 1996), each a unit; where it is above `enough` not all are looked at.
typedef struct grid_oracle {
    double axes[GRID_AXES][3], low[GRID_AXES], high[GRID_AXES]; // of the pyramid along them
    uint32_t count;
    double margin; // metres: well above what rounding does to a gap
} grid_oracle;
void grid_oracle_of(const ground *g, const grid_view *v, grid_oracle *out);
double grid_gap(const grid_oracle *o, const ground *g, ground_cell c);

// Cells that a ray of the view passes through for more than a millionth of a cell, near first; returns how many.
enum { GRID_RAY_CELLS = 4 << GROUND_LEVELS_MOST };
uint32_t grid_ray(uint64_t *r, const ground *g, const grid_view *v, ground_cell *cells);

#endif
