// The bounds that there were before: the page's formula, the corner test.
// SPDX-License-Identifier: MIT
#include "bound_baselines.h"

// asin(b (hn / cp) / ((De - r) (De - r'))), with r the box's half diagonal, cp = sqrt(1 - r^2 / D^2), r' = r / cp, hn the box's half
// depth along the line of sight.
double baseline_page_px(const bound_capture *capture, const double eye[3], const bound_optics *optics)
{
    double now[3], moved[3], depth = 0;
    bound_subtract(capture->centre, eye, now);
    bound_subtract(capture->eye, eye, moved);
    for (int k = 0; k < 3; k++) depth += fabs(capture->normal[k]) * capture->half[k];
    const double r = sqrt(bound_dot(capture->half, capture->half)), away = sqrt(bound_dot(now, now));
    const double narrow = sqrt(1 - r * r / (capture->distance * capture->distance)), wide = r / narrow;
    if (!(away > wide)) return INFINITY;
    const double sine = sqrt(bound_dot(moved, moved)) * (depth / narrow) / ((away - r) * (away - wide));
    return sine < 1 ? bound_pixels(sine / sqrt(1 - sine * sine), optics) : INFINITY;
}

double baseline_corners_px(const bound_case *c)
{
    double most = 0;
    for (int i = 0; i < BOUND_CORNERS; i++) {
        const cull_vec3 low = c->box.min, high = c->box.max;
        const double corner[3] = {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
        most = fmax(most, bound_pixels(shown_off_tangent(c, c->view.eye, corner), &c->view.optics));
    }
    return most;
}
