// Levels of detail in pictures: see detail.h.
// SPDX-License-Identifier: MIT
#include "detail.h"

#define SHARE_MOST 0.125 // of the tolerance: the eye comes nearer while the picture lives, and the error with it
#define COVERED 0.5     // of the picture's square that it takes, about

static double distance_to_box(const double eye[3], const cull_box *box)
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const double low = (double)(&box->min.x)[k] - eye[k], high = eye[k] - (double)(&box->max.x)[k];
        const double away = low > high ? low : high;
        if (away > 0) square += away * away;
    }
    return sqrt(square);
}

// What moves by away seen from no nearer than the distance: the sine of the angle is at most their ratio.
double detail_px(double away_m, const double eye[3], const cull_box *box, const bound_optics *optics)
{
    if (!(away_m > 0)) return 0;
    const double sine = away_m / distance_to_box(eye, box) * (1 + 0x1p-40); // some ten operations of 2^-53
    return sine < 0.5 ? bound_pixels(sine / sqrt(1 - sine * sine), optics) : INFINITY;
}

cull_box detail_box(const cull_box *box, double away_m)
{
    cull_box out = *box;
    if (!(away_m > 0)) return out;
    for (int k = 0; k < 3; k++) {
        (&out.min.x)[k] = nextafterf((float)((double)(&box->min.x)[k] - away_m), -INFINITY);
        (&out.max.x)[k] = nextafterf((float)((double)(&box->max.x)[k] + away_m), INFINITY);
    }
    return out;
}

// Of a capture, but for its polygons.
static double rest_ns(const detail_request *q)
{
    double size = 0, from_eye = 0;
    for (int k = 0; k < 3; k++) {
        const double low = (double)(&q->box->min.x)[k], high = (double)(&q->box->max.x)[k], middle = (low + high) / 2 - q->eye[k];
        size += (high - low) * (high - low);
        from_eye += middle * middle;
    }
    const double pixels = COVERED * q->optics->pixels_per_tangent * q->optics->pixels_per_tangent * size / from_eye;
    return q->costs->capture_ns + pixels * (q->costs->capture_pixel_ns + q->costs->pixel_ns);
}

detail_choice detail_choose(const detail_request *q)
{
    const double all = q->polygon_count, rest = rest_ns(q);
    detail_choice best = {0, 0, all};
    double least = (rest + all * q->costs->polygon_ns) / q->tolerance_px; // by the life that it buys
    for (uint32_t k = 0; k < q->costs->level_count && k < CULL_LEVELS_MOST; k++) {
        const cull_level *level = &q->costs->levels[k];
        float away_m = (float)level->away_m;
        if ((double)away_m < level->away_m) away_m = nextafterf(away_m, INFINITY);
        const double off = detail_px((double)away_m, q->eye, q->box, q->optics);
        if (!(off <= SHARE_MOST * q->tolerance_px)) continue;
        const double price = (rest + level->polygons * all * q->costs->polygon_ns) / (q->tolerance_px - off);
        if (!(price < least)) continue;
        least = price;
        best = (detail_choice){away_m, 0, level->polygons * all};
    }
    return best;
}
