// What bound.h is compared with: the page's own formula, and the corner test of 1996, which is no bound. Neither has rounding in it.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_BOUND_BASELINES_H
#define PORTCULLIS_TESTS_BOUND_BASELINES_H

#include "bound_cases.h"

// Section 1.10 of the reference page: half diagonal and distances only. A bound, a loose one.
double baseline_page_px(const bound_capture *capture, const double eye[3], const bound_optics *optics);
// Shade et al. 1996: the worst of the box's 8 corners, exactly. NOT a bound.
double baseline_corners_px(const bound_case *c);

#endif
