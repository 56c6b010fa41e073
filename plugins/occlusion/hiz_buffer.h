// The depth pyramid of method=hiz: tiles of 8 x 8 pixels under blocks of 8 x 8 tiles (Greene, Kass, Miller, Hierarchical Z-Buffer
// Visibility, 1993). A tile is empty, the planes of the polygon that covers all of it, or 64 depths of its own, taken only when a polygon covers part
// of it: exact like a plain z-buffer, and as cheap to clear and to fill as the masked tiles of Hasselgren, Andersson and
// Akenine-Moeller, Masked Software Occlusion Culling, 2016, which keep two depths and a mask instead.
// SPDX-License-Identifier: MIT
//
// Invariant: a tile's far depth, and a block's, is never nearer than that of any of its pixels. Depths only come nearer in a frame, so
// a block that is out of date is only less use.
#ifndef OCCLUSION_HIZ_BUFFER_H
#define OCCLUSION_HIZ_BUFFER_H

#include <stddef.h>
#include <stdint.h>

enum {
    HIZ_TILE_PX = 8,
    HIZ_TILE_PIXELS = HIZ_TILE_PX * HIZ_TILE_PX,
    HIZ_BLOCK_TILES = 8, // a side
    HIZ_WIDTH_MOST = 4096, // in a larger picture all counts as seen
    HIZ_HEIGHT_MOST = 4096,
    HIZ_COLUMNS_MOST = HIZ_WIDTH_MOST / HIZ_TILE_PX,
    HIZ_ROWS_MOST = HIZ_HEIGHT_MOST / HIZ_TILE_PX,
    HIZ_BLOCK_COLUMNS_MOST = HIZ_COLUMNS_MOST / HIZ_BLOCK_TILES,
    HIZ_BLOCK_ROWS_MOST = HIZ_ROWS_MOST / HIZ_BLOCK_TILES,
    HIZ_PADDING_TILES = 16, // behind the last row: vectors read over its end
    HIZ_PICTURES_MOST = 49152, // tiles with depths of their own: 3.1 million pixels of outlines
    HIZ_RECORDS_MOST = 65536,
    HIZ_PLANES_MOST = 3,
    HIZ_EDGES_MOST = 12, // of either side
};
#define HIZ_OWN_DEPTHS 0x80000000u // of an owner: the rest is a place in `depths`; else 1 + a place in `records`; 0: empty

// Depth a * x + b * y + c at pixel coordinates; the least of them counts.
typedef struct hiz_planes {
    float a[HIZ_PLANES_MOST], b[HIZ_PLANES_MOST], c[HIZ_PLANES_MOST];
    uint32_t count;
} hiz_planes;

// What hides, on the picture: the pixels whose centres lie within all edges. x of an edge at height y: at + slope * y.
typedef struct hiz_polygon {
    float left_at[HIZ_EDGES_MOST], left_slope[HIZ_EDGES_MOST], right_at[HIZ_EDGES_MOST], right_slope[HIZ_EDGES_MOST];
    uint32_t left_count, right_count;
    int32_t x0, y0, x1, y1; // pixels x0 .. x1 - 1, y0 .. y1 - 1 may be covered
    float nearest; // no depth of it is greater
    hiz_planes planes;
} hiz_polygon;

// Pixels x0 .. x1, y0 .. y1, none if x1 < x0, and the nearest depth in them.
typedef struct hiz_rectangle {
    int32_t x0, y0, x1, y1;
    float depth;
} hiz_rectangle;

// A tile of a rectangle: those before it, row by row, hide their part of the rectangle, as they will for the rest of the frame.
typedef struct hiz_place { int16_t column, row; } hiz_place;

typedef struct hiz_buffer {
    float *far;       // by tile
    uint32_t *owners; // by tile
    float *coarse;    // by block
    uint64_t *stale;  // by row of blocks, a bit a block: coarse is to be made anew
    float *depths;    // HIZ_TILE_PIXELS a tile, row by row
    hiz_planes *records;
    int32_t pitch, first_row, end_row; // tiles in a row of `far`, and the rows that this buffer has
    int32_t width_px;                  // of the tiles
    uint32_t picture_count, record_count, picture_most, record_most, limits_hit;
    uint32_t prunes;
} hiz_buffer;

// Rows first_row .. end_row - 1 become empty.
void hiz_buffer_clear(hiz_buffer *b);

#endif
