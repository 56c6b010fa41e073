// Drawing what hides into the pyramid, sixteen tiles or sixteen scanlines at a time; included by each kernel.
// SPDX-License-Identifier: MIT
#include "hiz_buffer.h"
#include "hiz_lanes.h"

#include <string.h>

static const float column_ramp[HIZ_LANES] = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
static const float row_ramp[HIZ_LANES] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};

// ---- A polygon ----

typedef struct raster_plane { // depths at tile (0, 0), and how they change
    float first, farthest;    // of its first pixel; the least over its pixels
    float column, row, rows2;       // from tile to tile; over two rows of pixels
} raster_plane;

typedef struct raster_run { // of one polygon
    const hiz_polygon *polygon;
    hiz_f tiles[HIZ_PLANES_MOST], pixels[HIZ_PLANES_MOST]; // depths of 16 tiles less the first's; of two rows of a tile less the first pixel's
    raster_plane planes[HIZ_PLANES_MOST];
    uint32_t plane_count, owner; // owner: 1 + the polygon's record; 0: none yet
} raster_run;

static inline void plane_make(const hiz_planes *p, uint32_t k, raster_run *r)
{
    raster_plane *to = &r->planes[k];
    const float a = p->a[k], b = p->b[k], across = a * (HIZ_TILE_PX - 1), down = b * (HIZ_TILE_PX - 1);
    to->first = a * 0.5f + (b * 0.5f + p->c[k]);
    to->farthest = to->first + ((a > 0 ? 0 : across) + (b > 0 ? 0 : down));
    to->column = a * HIZ_TILE_PX;
    to->row = b * HIZ_TILE_PX;
    to->rows2 = b * 2;
    r->tiles[k] = f_mul(f_load(hiz_ramp), f_set(to->column));
    r->pixels[k] = f_add(f_mul(f_load(column_ramp), f_set(a)), f_mul(f_load(row_ramp), f_set(b)));
}

// How far a plane's depths at a tile lie from those at tile (0, 0).
static inline float plane_moved(const raster_plane *p, int32_t column, int32_t row)
{
    return p->column * (float)column + p->row * (float)row;
}

// ---- One tile ----

// Depths of pixels of the tile at column, row of tiles, in four vectors of two rows.
static inline void depths_of(const raster_run *r, int32_t column, int32_t row, hiz_f out[4])
{
    const hiz_f first = f_add(f_set(r->planes[0].first + plane_moved(&r->planes[0], column, row)), r->pixels[0]);
    for (int i = 0; i < 4; i++) out[i] = f_add(first, f_set(r->planes[0].rows2 * (float)i));
    for (uint32_t k = 1; k < r->plane_count; k++) {
        const hiz_f other = f_add(f_set(r->planes[k].first + plane_moved(&r->planes[k], column, row)), r->pixels[k]);
        for (int i = 0; i < 4; i++) out[i] = f_min(out[i], f_add(other, f_set(r->planes[k].rows2 * (float)i)));
    }
}

static inline float far_of(const float *depths)
{
    const hiz_f low = f_min(f_load(depths), f_load(depths + 16)), high = f_min(f_load(depths + 32), f_load(depths + 48));
    return f_least(f_min(low, high));
}

// The polygon covers a tile that has depths of its own.
static inline void depths_cover(hiz_buffer *b, const raster_run *r, int32_t tile, int32_t column, int32_t row)
{
    float *depths = b->depths + (size_t)(b->owners[tile] & ~HIZ_OWN_DEPTHS) * HIZ_TILE_PIXELS;
    hiz_f with[4];
    depths_of(r, column, row, with);
    for (int i = 0; i < 4; i++) f_store(depths + 16 * i, f_max(f_load(depths + 16 * i), with[i]));
    b->far[tile] = far_of(depths);
}

static inline hiz_f pixels_pick(uint64_t pixels, int i, hiz_f yes, hiz_f no)
{
    return f_pick((uint32_t)(pixels >> (16 * i)) & HIZ_ALL_LANES, yes, no);
}

// The first polygon that covers part of a tile gives it depths of its own.
static inline void depths_make(hiz_buffer *b, int32_t tile, int32_t column, int32_t row, uint64_t pixels, const hiz_f with[4])
{
    const uint32_t owner = b->owners[tile];
    if (b->picture_count == b->picture_most) { // the tile stays as it is
        b->limits_hit++;
        return;
    }
    float *depths = b->depths + (size_t)b->picture_count * HIZ_TILE_PIXELS;
    b->owners[tile] = HIZ_OWN_DEPTHS | b->picture_count++;
    if (!owner) { // its far depth stays 0: not all of it is covered
        for (int i = 0; i < 4; i++) f_store(depths + 16 * i, pixels_pick(pixels, i, with[i], f_set(0)));
        return;
    }
    const hiz_planes *before = &b->records[owner - 1];
    raster_run old = {.plane_count = before->count};
    hiz_f was[4];
    for (uint32_t k = 0; k < old.plane_count; k++) plane_make(before, k, &old);
    depths_of(&old, column, row, was);
    for (int i = 0; i < 4; i++) f_store(depths + 16 * i, pixels_pick(pixels, i, f_max(was[i], with[i]), was[i]));
    b->far[tile] = far_of(depths);
}

// pixels: the bits that the polygon covers, not all.
static inline void tile_cover_part(hiz_buffer *b, const raster_run *r, int32_t column, int32_t row, uint64_t pixels)
{
    const int32_t tile = row * b->pitch + column;
    hiz_f with[4];
    depths_of(r, column, row, with);
    if (!(b->owners[tile] & HIZ_OWN_DEPTHS)) {
        depths_make(b, tile, column, row, pixels, with);
        return;
    }
    float *depths = b->depths + (size_t)(b->owners[tile] & ~HIZ_OWN_DEPTHS) * HIZ_TILE_PIXELS;
    for (int i = 0; i < 4; i++) {
        const hiz_f old = f_load(depths + 16 * i);
        f_store(depths + 16 * i, pixels_pick(pixels, i, f_max(old, with[i]), old));
    }
    b->far[tile] = far_of(depths);
}

// ---- Rows of tiles ----

// The polygon's own record, 0 without room.
static inline uint32_t record_of(hiz_buffer *b, raster_run *r)
{
    if (r->owner) return r->owner;
    if (b->record_count == b->record_most) {
        b->limits_hit++;
        return 0;
    }
    b->records[b->record_count++] = r->polygon->planes;
    r->owner = b->record_count;
    return r->owner;
}

// Tiles from .. end - 1 of a row are covered whole.
static inline void tiles_cover(hiz_buffer *b, raster_run *r, int32_t row, int32_t from, int32_t end)
{
    for (int32_t column = from; column < end; column += HIZ_LANES) {
        const int32_t tile = row * b->pitch + column;
        const hiz_f far = f_load(b->far + tile);
        const uint32_t there = hiz_low_lanes((uint32_t)(end - column));
        if (!(f_above(f_set(r->polygon->nearest), far) & there)) continue;
        hiz_f here = f_add(f_set(r->planes[0].farthest + plane_moved(&r->planes[0], column, row)), r->tiles[0]);
        for (uint32_t k = 1; k < r->plane_count; k++)
            here = f_min(here, f_add(f_set(r->planes[k].farthest + plane_moved(&r->planes[k], column, row)), r->tiles[k]));
        const uint32_t nearer = f_above(here, far) & there;
        if (!nearer) continue;
        uint32_t own = i_negative(i_load(b->owners + tile)) & nearer;
        const uint32_t plain = nearer & ~own;
        if (plain && record_of(b, r)) {
            f_store_some(b->far + tile, plain, here);
            i_store_some(b->owners + tile, plain, i_set((int32_t)r->owner));
        }
        for (; own; own &= own - 1) depths_cover(b, r, tile + __builtin_ctz(own), column + __builtin_ctz(own), row);
    }
}

typedef struct raster_spans { // of 16 scanlines: columns low .. end - 1; of each half the least and the greatest of both
    hiz_i low, end;
    int32_t low_least[2], low_most[2], end_least[2], end_most[2];
} raster_spans;

static inline void spans_of(const hiz_polygon *p, int32_t y, raster_spans *out)
{
    const hiz_f ys = f_add(f_set((float)y + 0.5f), f_load(hiz_ramp));
    hiz_f low = f_set((float)p->x0), end = f_set((float)p->x1);
    for (uint32_t i = 0; i < p->left_count; i++) low = f_max(low, f_add(f_set(p->left_at[i]), f_mul(f_set(p->left_slope[i]), ys)));
    for (uint32_t i = 0; i < p->right_count; i++) end = f_min(end, f_add(f_set(p->right_at[i]), f_mul(f_set(p->right_slope[i]), ys)));
    low = f_min(low, f_set((float)p->x1));
    end = f_max(end, f_set((float)p->x0));
    const hiz_i first = f_to_i(f_ceil(f_sub(low, f_set(0.5f)))), last = f_to_i(f_floor(f_sub(end, f_set(0.5f))));
    const hiz_i behind = i_add(last, i_set(1)), rows = i_add(i_set(y), f_to_i(f_load(hiz_ramp)));
    const uint32_t there = i_above(behind, first) & i_above(rows, i_set(p->y0 - 1)) & i_above(i_set(p->y1), rows);
    out->low = i_pick(there, first, i_set(p->x1));
    out->end = i_pick(there, behind, i_set(p->x0));
    i_least_halves(out->low, out->low_least);
    i_most_halves(out->low, out->low_most);
    i_least_halves(out->end, out->end_least);
    i_most_halves(out->end, out->end_most);
}

typedef struct raster_row { hiz_i low, end; } raster_row; // lanes 0 to 7: the scanlines of a row of tiles

static inline void tiles_cover_part(hiz_buffer *b, const raster_run *r, int32_t row, int32_t from, int32_t end, const raster_row *s)
{
    for (int32_t column = from; column < end; column++) {
        if (!(r->polygon->nearest > b->far[row * b->pitch + column])) continue;
        const uint64_t pixels = i_row_bits(s->low, s->end, column * HIZ_TILE_PX);
        if (pixels) tile_cover_part(b, r, column, row, pixels);
    }
}

static inline void row_cover(hiz_buffer *b, raster_run *r, int32_t row, const raster_spans *s)
{
    const int half = row & 1;
    const int32_t low = b->prunes ? s->low_least[half] : r->polygon->x0, end = b->prunes ? s->end_most[half] : r->polygon->x1;
    if (end <= low) return;
    const int32_t from = low >> 3, to = (end + 7) >> 3, full_from = (s->low_most[half] + 7) >> 3, full_end = s->end_least[half] >> 3;
    const raster_row lines = {i_half(s->low, half), i_half(s->end, half)};
    if (full_from >= full_end) {
        tiles_cover_part(b, r, row, from, to, &lines);
        return;
    }
    tiles_cover_part(b, r, row, from, full_from, &lines);
    tiles_cover(b, r, row, full_from, full_end);
    tiles_cover_part(b, r, row, full_end, to, &lines);
}

// All that the polygon could cover in a row of tiles lies behind what is there.
static inline int row_hides(const hiz_buffer *b, const hiz_polygon *p, int32_t row)
{
    const hiz_f nearest = f_set(p->nearest);
    const int32_t end = (p->x1 + 7) >> 3;
    for (int32_t column = p->x0 >> 3; column < end; column += HIZ_LANES)
        if (f_above(nearest, f_load(b->far + row * b->pitch + column)) & hiz_low_lanes((uint32_t)(end - column))) return 0;
    return 1;
}

static inline void stale_mark(hiz_buffer *b, const hiz_polygon *p)
{
    const int32_t from = p->x0 >> 6, to = (p->x1 - 1) >> 6;
    const uint64_t bits = (UINT64_MAX << from) & (UINT64_MAX >> (63 - to));
    for (int32_t y = p->y0 >> 6; y <= (p->y1 - 1) >> 6; y++) b->stale[y] |= bits;
}

static void polygon_cover(hiz_buffer *b, const hiz_polygon *polygon)
{
    hiz_polygon p = *polygon;
    raster_run r;
    p.y0 = p.y0 > b->first_row * HIZ_TILE_PX ? p.y0 : b->first_row * HIZ_TILE_PX;
    p.y1 = p.y1 < b->end_row * HIZ_TILE_PX ? p.y1 : b->end_row * HIZ_TILE_PX;
    p.x0 = p.x0 > 0 ? p.x0 : 0;
    p.x1 = p.x1 < b->width_px ? p.x1 : b->width_px;
    if (p.x0 >= p.x1 || p.y0 >= p.y1) return;
    r.polygon = &p;
    r.plane_count = p.planes.count;
    r.owner = 0;
    for (uint32_t k = 0; k < r.plane_count; k++) plane_make(&p.planes, k, &r);
    for (int32_t y = p.y0 & ~15; y < p.y1; y += HIZ_LANES) {
        const int32_t first = y >> 3 > p.y0 >> 3 ? y >> 3 : p.y0 >> 3, last = (y >> 3) + 1 < (p.y1 - 1) >> 3 ? (y >> 3) + 1 : (p.y1 - 1) >> 3;
        const uint32_t open = b->prunes ? (uint32_t)!row_hides(b, &p, first) | (uint32_t)!row_hides(b, &p, last) << (last - first) : 3;
        if (!open) continue;
        raster_spans s;
        spans_of(&p, y, &s);
        if (open & 1) row_cover(b, &r, first, &s);
        if (last > first && open & 2) row_cover(b, &r, last, &s);
    }
    stale_mark(b, &p);
}
