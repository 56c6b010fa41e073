// terrain: hills over a grid of heights, a mesh object a tile of 8 x 8 cells; flat beside its width, as quadtrees want it.
// SPDX-License-Identifier: MIT
// Invariant: a corner's height is of its place and the seed alone, so tiles meet without cracks, and terrain N is a part of any larger square.
#include "generate_obj.h"

#include "generate_random.h"

enum {
    CELL = 6 * METRE,
    TILE_CELLS = 8, // 128 triangles a tile: an item
    OCTAVES = 6,
    FIRST_STEP = 128,         // cells between the heights of the coarsest octave
    FIRST_RISE = 48 * METRE,  // between its lowest and its highest; each further one has half of both
    TERRAIN_KEY = 0x7465726e,
};

// A height of the coarse grid, 0 .. rise.
static double lattice_height(uint64_t seed, uint32_t octave, uint32_t column, uint32_t row, double rise)
{
    random_stream r = random_make(seed ^ TERRAIN_KEY, (uint64_t)octave << 48 | (uint64_t)column << 24 | row);
    return random_unit(&r) * rise;
}

static double eased(double t)
{
    return t * t * (3 - 2 * t);
}

static double octave_height(uint64_t seed, uint32_t octave, uint32_t column, uint32_t row)
{
    const uint32_t step = FIRST_STEP >> octave, x = column / step, z = row / step;
    const double rise = (double)(FIRST_RISE >> octave);
    const double u = eased((double)(column % step) / step), v = eased((double)(row % step) / step);
    const double north = lattice_height(seed, octave, x, z, rise) * (1 - u) + lattice_height(seed, octave, x + 1, z, rise) * u;
    const double south = lattice_height(seed, octave, x, z + 1, rise) * (1 - u) + lattice_height(seed, octave, x + 1, z + 1, rise) * u;
    return north * (1 - v) + south * v;
}

static place corner(uint64_t seed, uint32_t column, uint32_t row)
{
    double height = 0;
    for (uint32_t octave = 0; octave < OCTAVES; ++octave) height += octave_height(seed, octave, column, row);
    return (place){(int32_t)column * CELL, (int32_t)height / CENTIMETRE * CENTIMETRE, (int32_t)row * CELL};
}

static const char *material_of(const place corners[4])
{
    int32_t low = corners[0].y, high = corners[0].y;
    for (int i = 1; i < 4; ++i) {
        if (corners[i].y < low) low = corners[i].y;
        if (corners[i].y > high) high = corners[i].y;
    }
    if (high - low > 5 * METRE) return "rock";
    return low < 36 * METRE ? "sand" : "grass";
}

static void tile_write(obj_writer *w, uint64_t seed, uint32_t first_column, uint32_t first_row)
{
    place rows[TILE_CELLS + 1][TILE_CELLS + 1];
    for (uint32_t z = 0; z <= TILE_CELLS; ++z)
        for (uint32_t x = 0; x <= TILE_CELLS; ++x) rows[z][x] = corner(seed, first_column + x, first_row + z);
    for (uint32_t z = 0; z < TILE_CELLS; ++z)
        for (uint32_t x = 0; x < TILE_CELLS; ++x) {
            const place c[4] = {rows[z][x], rows[z + 1][x], rows[z + 1][x + 1], rows[z][x + 1]};
            obj_material(w, material_of(c));
            obj_polygon(w, (const place[3]){c[0], c[1], c[2]}, 3);
            obj_polygon(w, (const place[3]){c[0], c[2], c[3]}, 3);
        }
}

void generate_terrain(uint64_t tiles, uint64_t seed, const allocator *memory, text_file *out)
{
    obj_writer w = obj_open(out, memory);
    uint32_t across = 1;
    while ((uint64_t)across * across < tiles) ++across;
    for (uint32_t i = 0; i < tiles && !out->failed; ++i) {
        obj_numbered_object(&w, "tile", i);
        tile_write(&w, seed, i % across * TILE_CELLS, i / across * TILE_CELLS);
    }
    obj_close(&w);
}
