// A coarse picture of how near the boxes of what is drawn stand: see chc_picture.h.
// SPDX-License-Identifier: MIT
#include "chc_picture.h"

#include <portcullis/plane.h>

#include <float.h>
#include <math.h>

static void cross(const float a[3], const float b[3], float scale, float out[3])
{
    for (int k = 0; k < 3; k++) out[k] = scale * (a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
}

void picture_begin(chc_picture *p, const cull_view *view)
{
    cover_begin(&p->grid, view);
    const float *x = p->grid.clip, *y = x + 4, *w = x + 8;
    float normal[3];
    cross(x, y, 1, normal);
    const float volume = normal[0] * w[0] + normal[1] * w[1] + normal[2] * w[2];
    p->is_blind = view->eye[3] == 0 || !(fabsf(volume) > 0);
    if (p->is_blind) return;
    cross(x, y, 1 / volume, p->ray[0]);
    cross(y, w, 1 / volume, p->ray[1]);
    cross(w, x, 1 / volume, p->ray[2]);
    for (int k = 0; k < 3; k++) {
        p->ray[0][k] += 0.5f * (p->ray[1][k] + p->ray[2][k]);
        p->eye[k] = view->eye[k];
    }
    for (uint32_t row = 0; row < p->grid.row_count; row++)
        for (uint32_t column = 0; column < p->grid.columns; column++) p->nearness[row][column] = 0;
}

// The box's front in a row of cells: where a ray enters it is the farthest of the planes that face the eye, and on each of them one
// by the distance is linear in the picture.
typedef struct front { float base[3], step[3]; } front;

static front front_of(const chc_picture *p, const cull_box *box, int row)
{
    const float low[3] = {box->min.x, box->min.y, box->min.z}, high[3] = {box->max.x, box->max.y, box->max.z};
    front f;
    for (int k = 0; k < 3; k++) {
        const float gap = p->eye[k] < low[k] ? low[k] - p->eye[k] : p->eye[k] > high[k] ? high[k] - p->eye[k] : 0;
        const float within = 0.5f * (fabsf(p->ray[1][k]) + fabsf(p->ray[2][k])) / fabsf(gap); // the farthest in the cell
        f.base[k] = gap == 0 ? FLT_MAX : (p->ray[0][k] + (float)row * p->ray[2][k]) / gap - within;
        f.step[k] = gap == 0 ? 0 : p->ray[1][k] / gap;
    }
    return f;
}

void picture_mark(chc_picture *p, const cull_box *box)
{
    cover_outline o;
    const int is_round_eye = p->eye[0] >= box->min.x && p->eye[0] <= box->max.x && p->eye[1] >= box->min.y && p->eye[1] <= box->max.y && p->eye[2] >= box->min.z && p->eye[2] <= box->max.z;
    if (p->is_blind || is_round_eye || !cover_outline_of(&p->grid, box, &o) || o.is_point) return;
    for (int row = o.first_row; row < o.end_row; row++) {
        const front f = front_of(p, box, row);
        float *cells = p->nearness[row];
        for (int column = o.low[row]; column < o.end[row]; column++) {
            const float at = (float)column, a = f.base[0] + at * f.step[0], b = f.base[1] + at * f.step[1], c = f.base[2] + at * f.step[2];
            const float ab = a < b ? a : b, nearness = ab < c ? ab : c;
            cells[column] = cells[column] > nearness ? cells[column] : nearness;
        }
    }
}

// Most boxes that stand free do so at a corner.
static int corners_hidden(const chc_picture *p, const cull_box *box, float nearness)
{
    const float *x = p->grid.clip, *y = x + 4, *w = x + 8;
    for (int i = 0; i < 8; i++) {
        const float at[3] = {i & 1 ? box->max.x : box->min.x, i & 2 ? box->max.y : box->min.y, i & 4 ? box->max.z : box->min.z};
        const float by = 1 / (w[0] * at[0] + w[1] * at[1] + w[2] * at[2] + w[3]);
        const float column = (x[0] * at[0] + x[1] * at[1] + x[2] * at[2] + x[3]) * by, row = (y[0] * at[0] + y[1] * at[1] + y[2] * at[2] + y[3]) * by;
        if (!(column >= 0 && column < (float)p->grid.columns && row >= 0 && row < (float)p->grid.row_count)) continue;
        if (!(p->nearness[(int)row][(int)column] > nearness)) return 0;
    }
    return 1;
}

// margin: cells more all round.
static int cells_hidden(const chc_picture *p, const cover_outline *o, float nearness, int margin)
{
    if (o->first_row == o->end_row) return 1; // beside the picture
    for (int row = o->first_row - margin; row < o->end_row + margin; row++) {
        const int inside = row < o->first_row ? o->first_row : row < o->end_row ? row : o->end_row - 1, columns = (int)p->grid.columns;
        if (row < 0 || row >= (int)p->grid.row_count) continue;
        const int low = o->low[inside] > margin ? o->low[inside] - margin : 0, end = o->end[inside] < columns - margin ? o->end[inside] + margin : columns;
        for (int column = low; column < end; column++)
            if (!(p->nearness[row][column] > nearness)) return 0;
    }
    return 1;
}

picture_verdict picture_look(const chc_picture *p, const cull_box *box)
{
    cover_outline o;
    const float *w = p->grid.clip + 8;
    const cull_vec3 towards = {-w[0], -w[1], -w[2]}, nearest = cull_box_corner(*box, towards);
    const float nearness = 1 / (w[0] * nearest.x + w[1] * nearest.y + w[2] * nearest.z + w[3]);
    if (p->is_blind || !(nearness > 0) || !corners_hidden(p, box, nearness) || !cover_outline_of(&p->grid, box, &o)) return PICTURE_OPEN;
    if (!cells_hidden(p, &o, nearness, 0)) return PICTURE_OPEN;
    return cells_hidden(p, &o, nearness, 1) ? PICTURE_HIDDEN : PICTURE_NARROW;
}
