// A view as method=hiz needs it: see hiz_view.h.
// SPDX-License-Identifier: MIT
#include "hiz_view.h"

static void cross3(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Columns of the inverse of the matrix with these rows. 0: it has none.
static int inverse_of(const double rows[3][3], double columns[3][3])
{
    cross3(rows[1], rows[2], columns[0]);
    cross3(rows[2], rows[0], columns[1]);
    cross3(rows[0], rows[1], columns[2]);
    const double determinant = dot3(rows[0], columns[0]);
    if (!(fabs(determinant) > 0) || !isfinite(1 / determinant)) return 0;
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) columns[c][k] /= determinant;
    return 1;
}

static int is_finite_view(const hiz_view *v)
{
    double sum = v->inset_px + v->rounding_px + v->near_w + (double)v->outset_px + (double)v->depth_up;
    for (int k = 0; k < 3; k++) {
        sum += fabs(v->eye_exact[k]) + fabs((double)v->row_x[k]) + fabs((double)v->row_y[k]) + fabs((double)v->row_w[k]);
        for (int i = 0; i < 3; i++) sum += fabs(v->ray[k][i]);
    }
    return isfinite(sum);
}

static int32_t cells_of(uint32_t pixels, int32_t cell)
{
    return (int32_t)(pixels / (uint32_t)cell + (pixels % (uint32_t)cell != 0));
}

void hiz_view_make(const cull_view *view, hiz_size most, hiz_size cell, hiz_view *out)
{
    const float *m = view->clip_from_zone;
    const double width = (double)view->width_px / cell.width_px, height = (double)view->height_px / cell.height_px, reach = view->reach;
    double rows[3][3], columns[3][3];
    *out = (hiz_view){.near_up = FLT_MAX, .width_px = 1, .height_px = 1, .y_end = 1}; // until it is: all boxes count as near
    for (int k = 0; k < 3; k++) {
        rows[0][k] = (double)m[4 * k];
        rows[1][k] = (double)m[4 * k + 1];
        rows[2][k] = (double)m[4 * k + 3];
        out->eye_exact[k] = view->eye_exact[k];
        out->eye[k] = (float)view->eye_exact[k];
        out->eye_rest[k] = (float)(view->eye_exact[k] - (double)out->eye[k]);
        out->row_x[k] = (float)(0.5 * width * (rows[0][k] + rows[2][k]));
        out->row_y[k] = (float)(0.5 * height * (rows[1][k] + rows[2][k]));
        out->row_w[k] = (float)rows[2][k];
    }
    if (view->width_px > (uint32_t)most.width_px || view->height_px > (uint32_t)most.height_px) return;
    if (view->eye[3] == 0 || !inverse_of((const double(*)[3])rows, columns)) return;
    for (int k = 0; k < 3; k++) { // clip x = 2 * pixel / width - 1
        out->ray[k][0] = columns[0][k] * 2 / width;
        out->ray[k][1] = columns[1][k] * 2 / height;
        out->ray[k][2] = columns[2][k] - columns[0][k] - columns[1][k];
    }
    const double across = 0.5 * width * sqrt(dot3(rows[0], rows[0])), up = 0.5 * height * sqrt(dot3(rows[1], rows[1]));
    const double pixels_per_tangent = across > up ? across : up;
    // Of x / w: as much of x's row as of w's, which counts as often as the picture is wide.
    out->rounding_px = (across > up ? across : up) * (1 + reach) + (width > height ? width : height);
    const double moved = 1.7320508075688772 * CULL_GUARD_DISTANCE * reach; // of a corner, per metre of w
    out->outset_px = (float)(CULL_GUARD_PX + pixels_per_tangent * moved * (1 + reach));
    out->inset_px = HIZ_INSET_PX + pixels_per_tangent * moved * (1 + reach);
    out->inset_cell[0] = (cell.width_px - 1) / (2.0 * cell.width_px);
    out->inset_cell[1] = (cell.height_px - 1) / (2.0 * cell.height_px);
    out->depth_up = (float)(1 + 2 * moved);
    out->near_w = (double)view->near_distance;
    out->near_up = (float)((double)view->near_distance * (1 + 2 * moved) * (1 + 1.0 / 1024));
    out->width_px = cells_of(view->width_px, cell.width_px);
    out->height_px = cells_of(view->height_px, cell.height_px);
    out->y_end = out->height_px;
    out->is_usable = is_finite_view(out) && view->near_distance > 0 && width > 0 && height > 0;
    if (!out->is_usable) *out = (hiz_view){.near_up = FLT_MAX, .width_px = 1, .height_px = 1, .y_end = 1};
}
