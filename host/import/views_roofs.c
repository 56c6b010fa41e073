// Automatic views auto:roofs:N: a flight over all that there is, along a figure of Lissajous, a little over the roofs.
// SPDX-License-Identifier: MIT
// Invariant: an eye is at least OVER_M over all within BESIDE_M of it, so it stands in air.
#include "views_auto.h"

#include <math.h>

enum { RING = 8, RINGS = 3, EASE = 4 };
static const double PI = 3.14159265358979323846;
static const double OVER_M = 3, BESIDE_M = 12, PACE_M = 2.4, REACH = 0.42; // REACH: of the width, to each side
static const double PITCH_DEG = -12, SWAY_DEG = 40;

static double top_at(const auto_views *a, double x, double z)
{
    const double from[3] = {x, a->high[1] + 1, z};
    const double drop = free_space_along(a->space, from, (axis_ray){1, -1});
    return isinf(drop) ? a->low[1] : from[1] - drop;
}

// The highest of what lies within `far`, at some places of rings. Of boxes and roofs larger than a ring's gap that is all.
static double top_near(const auto_views *a, double x, double z, double far)
{
    double top = top_at(a, x, z);
    for (int ring = 1; ring <= RINGS; ++ring)
        for (int i = 0; i < RING * ring; ++i) {
            const double turn = 2 * PI * i / (RING * ring), r = far * ring / RINGS;
            top = fmax(top, top_at(a, x + r * cos(turn), z + r * sin(turn)));
        }
    return top;
}

static void figure(const auto_views *a, double t, double out[2])
{
    out[0] = (a->low[0] + a->high[0]) / 2 + REACH * (a->high[0] - a->low[0]) * sin(2 * t);
    out[1] = (a->low[2] + a->high[2]) / 2 + REACH * (a->high[2] - a->low[2]) * sin(3 * t + 0.5);
}

// The mean of what is highest at some places ahead and behind, each looked at twice as far round: never below the highest here.
static double height_at(const auto_views *a, const double at[2], const double way[2])
{
    double sum = 0;
    for (int i = -EASE; i <= EASE; ++i) {
        const double along = BESIDE_M * i / EASE;
        sum += top_near(a, at[0] + along * way[0], at[1] + along * way[1], 2 * BESIDE_M);
    }
    return fmax(sum / (2 * EASE + 1), top_near(a, at[0], at[1], BESIDE_M)) + OVER_M;
}

result auto_roofs_make(auto_views *a, uint32_t count, camera *cameras)
{
    double t = 0;
    for (uint32_t i = 0; i < count; ++i) {
        double at[2], ahead[2];
        figure(a, t, at);
        figure(a, t + 1e-3, ahead);
        const double x = ahead[0] - at[0], z = ahead[1] - at[1], pace = sqrt(x * x + z * z);
        const double way[2] = {pace > 0 ? x / pace : 1, pace > 0 ? z / pace : 0};
        const double eye[3] = {at[0], height_at(a, at, way), at[1]};
        const double sway = SWAY_DEG * sin(i * 0.11), pitch = PITCH_DEG + PITCH_DEG / 2 * sin(i * 0.07);
        cameras[i] = auto_camera(a, eye, atan2(way[1], way[0]) + sway * (PI / 180), pitch * (PI / 180));
        t += pace > 0 ? fmin(1e-3 * PACE_M / pace, 0.05) : 0.05;
    }
    return RESULT_OK;
}
