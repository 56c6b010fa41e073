// A view as method=hiz needs it: pixels of points, rays of pixels, and the margins that stand between rounding and a wrong answer.
// SPDX-License-Identifier: MIT
//
// Depth is 1/w, w along the view's axis: linear over the picture, greater is nearer, and in the order of the renderer's reversed z.
// Margins, each of the guard band of plane.h: what is tested grows by CULL_GUARD_PX and by CULL_GUARD_DISTANCE of its distance; what hides
// shrinks by INSET_PX (the renderer snaps vertices to 1/256 pixel) and by the same share of distance, and its depth is that of the pixel's far end.
// Both move by what rounding to float does to the farthest corner, over the nearest w: rounding_px of that ratio, much for what is long and near.
#ifndef OCCLUSION_HIZ_VIEW_H
#define OCCLUSION_HIZ_VIEW_H

#include <portcullis/plane.h>

#define HIZ_INSET_PX (1.0 / 128)
#define HIZ_ROUNDING (1.0 / 4194304) // of a corner's distance: a renderer's sums of three products and an offset, in float

typedef struct hiz_view {
    float eye[3], eye_rest[3];              // what float cannot hold of the eye: p - eye - eye_rest
    float row_x[3], row_y[3], row_w[3];     // of a point from the eye: pixel x = row_x . p / row_w . p
    double eye_exact[3];
    double ray[3][3];                       // [axis]: a * x + b * y + c at pixel coordinates, of the ray that reaches w = 1
    double rounding_px;                     // that all coordinates of a corner move by when they are off by their distance, at w 1
    double inset_cell[2];                   // x, y: how far from a cell's centre the centres of its pixels lie, in cells
    double inset_px, near_w;                // nearer than near_w nothing leaves a pixel, or it may be cut
    float outset_px, depth_up, near_up;     // depth_up: factor of a tested depth; near_up: of near_w, as float
    int32_t width_px, height_px;            // of the picture, in cells
    int32_t y_first, y_end;                 // rows that are looked at: all, or a thread's share
    int32_t is_usable;                      // 0: nothing can be said about this view; all counts as seen
} hiz_view;

typedef struct hiz_size { int32_t width_px, height_px; } hiz_size;
// A depth may stand for a cell of several pixels: then all that is said in pixels here and in the buffer is in cells. What hides covers a
// cell where it covers the centres of all its pixels; what is tested has each cell of which it might have one.
// most: what the buffer holds; a larger picture is not usable. cell: its pixels.
void hiz_view_make(const cull_view *view, hiz_size most, hiz_size cell, hiz_view *out);

#endif
