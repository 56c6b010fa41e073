// A coarse picture of what a step draws: see cover.h.
// SPDX-License-Identifier: MIT
#include "cover.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { CELL_PX = 4, SMALL_CELLS = 6 };

static uint32_t cells_for(uint32_t size_px, uint32_t most)
{
    const uint32_t cells = size_px / CELL_PX + (size_px % CELL_PX != 0);
    return cells < 1 ? 1 : cells > most ? most : cells;
}

void cover_begin(cover *c, const cull_view *view)
{
    memset(c->rows, 0, sizeof c->rows);
    c->columns = cells_for(view->width_px, COVER_COLUMNS);
    c->row_count = cells_for(view->height_px, COVER_ROWS);
    const float *m = view->clip_from_zone;
    const float half_x = 0.5f * (float)c->columns, half_y = 0.5f * (float)c->row_count;
    for (int k = 0; k < 4; k++) { // cell = (1 + x / w) / 2 * cells
        c->clip[k] = half_x * (m[4 * k] + m[4 * k + 3]);
        c->clip[4 + k] = half_y * (m[4 * k + 1] + m[4 * k + 3]);
        c->clip[8 + k] = m[4 * k + 3];
    }
}

static float row_at(const float row[4], const float p[3])
{
    return row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
}

// 0: the box reaches behind the eye, or is no number.
static int corners_project(const cover *c, const cull_box *box, float x[8], float y[8])
{
    for (int i = 0; i < 8; i++) {
        const float p[3] = {i & 1 ? box->max.x : box->min.x, i & 2 ? box->max.y : box->min.y, i & 4 ? box->max.z : box->min.z};
        const float w = row_at(c->clip + 8, p);
        if (!(w > FLT_MIN)) return 0;
        x[i] = row_at(c->clip, p) / w;
        y[i] = row_at(c->clip + 4, p) / w;
        if (!(fabsf(x[i]) < 1e6f && fabsf(y[i]) < 1e6f)) return 0;
    }
    return 1;
}

// The first cell whose centre is not below v, within 0 .. cells.
static int cell_from(float v, uint32_t cells)
{
    const float first = ceilf(v - 0.5f);
    return first < 0 ? 0 : first > (float)cells ? (int)cells : (int)first;
}

static void edge_add(float spans[COVER_ROWS][2], const float a[2], const float b[2], int rows)
{
    const float *const low = a[1] < b[1] ? a : b, *const high = a[1] < b[1] ? b : a;
    const int first = cell_from(low[1], (uint32_t)rows), end = cell_from(high[1], (uint32_t)rows);
    const float slope = high[1] > low[1] ? (high[0] - low[0]) / (high[1] - low[1]) : 0;
    for (int row = first; row < end; row++) {
        const float x = low[0] + ((float)row + 0.5f - low[1]) * slope;
        spans[row][0] = x < spans[row][0] ? x : spans[row][0];
        spans[row][1] = x > spans[row][1] ? x : spans[row][1];
    }
}

// What holds no centre is taken as the one cell that it lies in.
static void outline_of_point(const cover *c, float x, float y, cover_outline *out)
{
    const int column = (int)fminf(fmaxf(x, 0), (float)c->columns - 1), row = (int)fminf(fmaxf(y, 0), (float)c->row_count - 1);
    out->is_point = 1;
    out->first_row = row;
    out->end_row = row + 1;
    out->low[row] = column;
    out->end[row] = column + 1;
}

int cover_outline_of(const cover *c, const cull_box *box, cover_outline *out)
{
    static const uint8_t edges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
    float x[8], y[8], spans[COVER_ROWS][2];
    if (!corners_project(c, box, x, y)) return 0;
    float low = y[0], high = y[0];
    for (int i = 1; i < 8; i++) {
        low = y[i] < low ? y[i] : low;
        high = y[i] > high ? y[i] : high;
    }
    out->first_row = cell_from(low, c->row_count);
    out->end_row = cell_from(high, c->row_count);
    for (int row = out->first_row; row < out->end_row; row++) {
        spans[row][0] = FLT_MAX;
        spans[row][1] = -FLT_MAX;
    }
    for (int i = 0; i < 12; i++) {
        const float a[2] = {x[edges[i][0]], y[edges[i][0]]}, b[2] = {x[edges[i][1]], y[edges[i][1]]};
        edge_add(spans, a, b, (int)c->row_count);
    }
    int cells = 0;
    out->is_point = 0;
    for (int row = out->first_row; row < out->end_row; row++) {
        out->low[row] = cell_from(spans[row][0], c->columns);
        out->end[row] = spans[row][1] < spans[row][0] ? out->low[row] : cell_from(spans[row][1], c->columns);
        cells += out->end[row] - out->low[row];
    }
    out->cells = cells;
    if (cells == 0) outline_of_point(c, 0.5f * (x[0] + x[7]), 0.5f * (y[0] + y[7]), out);
    return 1;
}

static uint64_t word_mask(int word, int low, int end)
{
    const int from = low - word * 64, to = end - word * 64;
    if (from >= 64 || to <= 0 || low >= end) return 0;
    const uint64_t above = from <= 0 ? UINT64_MAX : UINT64_MAX << from;
    return to >= 64 ? above : above & ((UINT64_C(1) << to) - 1);
}

cover_state cover_look(const cover *c, const cull_box *box)
{
    cover_outline o;
    if (!cover_outline_of(c, box, &o)) return COVER_UNKNOWN;
    for (int row = o.first_row; row < o.end_row; row++)
        for (int word = o.low[row] / 64; word < COVER_WORDS && word * 64 < o.end[row]; word++)
            if (word_mask(word, o.low[row], o.end[row]) & ~c->rows[row][word]) return o.cells < SMALL_CELLS ? COVER_SMALL : COVER_OPEN;
    return COVER_FULL;
}

void cover_mark(cover *c, const cull_box *box)
{
    cover_outline o;
    if (!cover_outline_of(c, box, &o) || o.is_point) return; // a point covers no cell
    for (int row = o.first_row; row < o.end_row; row++)
        for (int word = o.low[row] / 64; word < COVER_WORDS && word * 64 < o.end[row]; word++)
            c->rows[row][word] |= word_mask(word, o.low[row], o.end[row]);
}
