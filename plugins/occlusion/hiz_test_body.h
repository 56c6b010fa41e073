// Whether a rectangle is hidden: blocks, then tiles, then pixels; included by each kernel behind hiz_raster_body.h.
// SPDX-License-Identifier: MIT

static inline float planes_far(const hiz_planes *p, const hiz_rectangle *q)
{
    float farthest = 0;
    for (uint32_t k = 0; k < p->count; k++) {
        const float x = (float)(p->a[k] > 0 ? q->x0 : q->x1) + 0.5f, y = (float)(p->b[k] > 0 ? q->y0 : q->y1) + 0.5f;
        const float here = p->a[k] * x + (p->b[k] * y + p->c[k]);
        farthest = k && farthest < here ? farthest : here;
    }
    return farthest;
}

// Of a tile whose far depth does not hide the rectangle: its pixels in the rectangle might.
static inline int tile_hides(const hiz_buffer *b, const hiz_rectangle *q, int32_t column, int32_t row)
{
    const uint32_t owner = b->owners[row * b->pitch + column];
    const int32_t x = column * HIZ_TILE_PX, y = row * HIZ_TILE_PX;
    if (!owner) return 0;
    const hiz_rectangle in = {q->x0 > x ? q->x0 : x, q->y0 > y ? q->y0 : y, q->x1 < x + 7 ? q->x1 : x + 7, q->y1 < y + 7 ? q->y1 : y + 7, q->depth};
    if (!(owner & HIZ_OWN_DEPTHS)) return planes_far(&b->records[owner - 1], &in) > q->depth;
    if (in.x1 - in.x0 == 7 && in.y1 - in.y0 == 7) return 0;
    const float *depths = b->depths + (size_t)(owner & ~HIZ_OWN_DEPTHS) * HIZ_TILE_PIXELS;
    const uint32_t columns = (0xffu << (in.x0 - x)) & (0xffu >> (7 - (in.x1 - x)));
    const uint64_t rows = (UINT64_MAX << (8 * (in.y0 - y))) & (UINT64_MAX >> (8 * (7 - (in.y1 - y))));
    const uint64_t pixels = rows & (columns * UINT64_C(0x0101010101010101));
    const hiz_f depth = f_set(q->depth);
    for (int i = 0; i < 4; i++) {
        const uint32_t asked = (uint32_t)(pixels >> (16 * i)) & HIZ_ALL_LANES;
        if (asked & ~f_above(f_load(depths + 16 * i), depth)) return 0;
    }
    return 1;
}

typedef struct tile_span { int32_t column0, row0, column1, row1; } tile_span; // inclusive

// at: where to begin; where it ended, if it hides not all.
static inline int tiles_hide(const hiz_buffer *b, const hiz_rectangle *q, const tile_span *t, hiz_place *at)
{
    const hiz_f depth = f_set(q->depth);
    int32_t first = at->column;
    for (int32_t row = at->row; row <= t->row1; row++, first = t->column0)
        for (int32_t column = first; column <= t->column1; column += HIZ_LANES) {
            const uint32_t there = hiz_low_lanes((uint32_t)(t->column1 - column + 1));
            for (uint32_t open = there & ~f_above(f_load(b->far + row * b->pitch + column), depth); open; open &= open - 1) {
                const int32_t here = column + __builtin_ctz(open);
                if (tile_hides(b, q, here, row)) continue;
                *at = (hiz_place){(int16_t)here, (int16_t)row};
                return 0;
            }
        }
    return 1;
}

// The least far depth of two neighbouring blocks of tiles; of depths that are not negative the bits compare like the numbers. What lies
// beyond the end of a row counts in: that makes a block no nearer than it is.
static inline void blocks_refresh(hiz_buffer *b, int32_t block_row, int32_t block)
{
    const int32_t row0 = block_row * HIZ_BLOCK_TILES, end = row0 + HIZ_BLOCK_TILES < b->end_row ? row0 + HIZ_BLOCK_TILES : b->end_row;
    hiz_i least = i_load(b->far + row0 * b->pitch + block * HIZ_BLOCK_TILES);
    int32_t bits[2];
    for (int32_t row = row0 + 1; row < end; row++) least = i_min(least, i_load(b->far + row * b->pitch + block * HIZ_BLOCK_TILES));
    i_least_halves(least, bits);
    memcpy(b->coarse + block_row * HIZ_BLOCK_COLUMNS_MOST + block, bits, sizeof bits);
    b->stale[block_row] &= ~(UINT64_C(3) << block);
}

// Block by block; what a block's far depth does not hide is looked at tile by tile.
static inline int blocks_hide(hiz_buffer *b, const hiz_rectangle *q, const tile_span *t, hiz_place *open)
{
    const int32_t first = t->column0 >> 3, last = t->column1 >> 3;
    for (int32_t block_row = t->row0 >> 3; block_row <= t->row1 >> 3; block_row++) {
        const int32_t row = block_row * HIZ_BLOCK_TILES;
        for (int32_t block = first & ~1; block <= last; block += 2)
            if (b->stale[block_row] >> block & 3) blocks_refresh(b, block_row, block);
        for (int32_t block = first; block <= last; block++) {
            if (b->coarse[block_row * HIZ_BLOCK_COLUMNS_MOST + block] > q->depth) continue;
            const int32_t column = block * HIZ_BLOCK_TILES;
            const tile_span in = {t->column0 > column ? t->column0 : column, t->row0 > row ? t->row0 : row,
                                  t->column1 < column + 7 ? t->column1 : column + 7, t->row1 < row + 7 ? t->row1 : row + 7};
            *open = (hiz_place){(int16_t)in.column0, (int16_t)in.row0};
            if (!tiles_hide(b, q, &in, open)) return 0;
        }
    }
    return 1;
}

enum { TEST_COLUMNS = 24, TEST_ROWS = 12 }; // tiles of a rectangle from which on blocks are looked at first

// open: a tile to begin with; of a rectangle tested before the one that was not hidden then.
static int rectangle_hidden(hiz_buffer *b, const hiz_rectangle *q, hiz_place *open)
{
    const tile_span t = {q->x0 >> 3, q->y0 >> 3, q->x1 >> 3, q->y1 >> 3};
    if (t.column1 - t.column0 < TEST_COLUMNS || t.row1 - t.row0 < TEST_ROWS) return tiles_hide(b, q, &t, open);
    if (!(b->far[open->row * b->pitch + open->column] > q->depth) && !tile_hides(b, q, open->column, open->row)) return 0;
    return blocks_hide(b, q, &t, open);
}
