// Random boxes, capture eyes and views, and where pictures of them truly come to stand: the oracle of the bounds, in long double.
// It projects points with the parallelogram as it is lent in floats, and knows nothing of the bounds' formulas.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_BOUND_CASES_H
#define PORTCULLIS_TESTS_BOUND_CASES_H

#include "plugins/imagecache/compose.h"
#include "plugins/imagecache/quad.h"

#include <stdint.h>

typedef struct bound_case {
    cull_box box;
    bound_view taken, view;       // of the capture; of the frame that shows it
    double taken_wide[2], wide[2]; // tangents of the pictures' half sides
    bound_capture capture;
    quad quad;
} bound_case;

typedef enum case_motion {
    MOTION_ANY,    // from a hundred-thousandth of the distance to a third of it
    MOTION_TURNED, // none: the view turns only
    MOTION_CENTRE, // small, the axes nearly kept: where centre alignment is at home
} case_motion;

// The k-th case of this seed; those that quad_of refuses are drawn anew.
bound_case case_random(uint64_t *state, case_motion motion);

// The view looks such that this point of the world lies somewhere in its picture, a third of the time on its border.
void case_look_at(uint64_t *state, const double point[3], const double wide[2], bound_view *view);

// A point of the box: inside, on a face, on an edge or a corner.
void case_point(uint64_t *state, const cull_box *box, double out[3]);
// Point number i of a grid over its faces, corners among them: `side` points along each side, i < 6 * side * side.
void case_grid_point(const cull_box *box, uint32_t i, uint32_t side, double out[3]);

typedef struct case_place {
    double x, y;      // tangents
    int32_t in_front; // of the eye
} case_place;
case_place place_of(const bound_view *view, const long double point[3]);
int place_inside(case_place place, const double wide[2]);

// Where on the parallelogram the ray from the eye through the point goes: fractions of right and up, and the point itself.
typedef struct case_image {
    long double u, v, point[3];
} case_image;
case_image image_of(const quad *q, const double eye[3], const double point[3]);

// Pixels between where the point belongs and where it is shown; negative: neither is inside the picture.
double shown_off_px(const bound_case *c, const double point[3]);
double aligned_off_px(const bound_case *c, const quad *taken, const quad *shown, const double point[3]);
double deep_off_px(const bound_case *c, const double point[3], double depth_error);
// The tangent of the angle between the two, from this eye.
double shown_off_tangent(const bound_case *c, const double eye[3], const double point[3]);

#endif
