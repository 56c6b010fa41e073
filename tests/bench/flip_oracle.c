// FLIP as the paper tells it: see flip_oracle.h. Shares nothing with the bench's, not even the numbers of sRGB's matrix.
// SPDX-License-Identifier: MIT
#include "flip_oracle.h"

#include <math.h>

static const double PI_OF = 3.14159265358979323846;
static const double XYZ[3][3] = {{0.4123907993, 0.3575843394, 0.1804807884}, {0.2126390059, 0.7151686788, 0.0721923154}, {0.0193308187, 0.1191947798, 0.9505321522}};
static const double RGB[3][3] = {{3.2409699419, -1.5373831776, -0.4986107603}, {-0.9692436363, 1.8759675015, 0.0415550574}, {0.0556300797, -0.2039769589, 1.0569715142}};
static const double WHITE[3] = {0.4123907993 + 0.3575843394 + 0.1804807884, 1, 0.0193308187 + 0.1191947798 + 0.9505321522};

typedef struct vector { double v[3]; } vector;

static vector times(const double m[3][3], vector a)
{
    vector out;
    for (int r = 0; r < 3; ++r) out.v[r] = m[r][0] * a.v[0] + m[r][1] * a.v[1] + m[r][2] * a.v[2];
    return out;
}

static int clamped(int i, int count)
{
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

// Y, Cx, Cz of a pixel, linear.
static vector opponent_of(const oracle_request *q, const uint8_t *rgba, int x, int y)
{
    const uint8_t *p = rgba + 4 * ((long)clamped(y, q->high) * q->wide + clamped(x, q->wide));
    vector linear;
    for (int k = 0; k < 3; ++k) {
        const double s = p[k] / 255.0;
        linear.v[k] = s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
    }
    const vector xyz = times(XYZ, linear);
    const double xn = xyz.v[0] / WHITE[0], yn = xyz.v[1] / WHITE[1], zn = xyz.v[2] / WHITE[2];
    return (vector){{116 * yn - 16, 500 * (xn - yn), 200 * (yn - zn)}};
}

static double sensitivity(int channel, double squared_degrees)
{
    static const double a[3][2] = {{1, 0}, {1, 0}, {34.1, 13.5}}, b[3][2] = {{0.0047, 1e-5}, {0.0053, 1e-5}, {0.04, 0.025}};
    double sum = 0;
    for (int i = 0; i < 2; ++i) sum += a[channel][i] * sqrt(PI_OF / b[channel][i]) * exp(-PI_OF * PI_OF * squared_degrees / b[channel][i]);
    return sum;
}

static vector filtered(const oracle_request *q, const uint8_t *rgba, int x, int y)
{
    const int reach = (int)ceil(3 * sqrt(0.04 / (2 * PI_OF * PI_OF)) * q->pixels_per_degree);
    vector sum = {{0}}, weights = {{0}};
    for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
            const vector c = opponent_of(q, rgba, x + dx, y + dy);
            const double squared = (dx * dx + dy * dy) / (q->pixels_per_degree * q->pixels_per_degree);
            for (int k = 0; k < 3; ++k) {
                sum.v[k] += c.v[k] * sensitivity(k, squared);
                weights.v[k] += sensitivity(k, squared);
            }
        }
    for (int k = 0; k < 3; ++k) sum.v[k] /= weights.v[k];
    return sum;
}

static vector lab_of_linear(vector rgb)
{
    vector xyz = times(XYZ, rgb), f;
    for (int k = 0; k < 3; ++k) {
        const double t = xyz.v[k] / WHITE[k], d = 6.0 / 29;
        f.v[k] = t > d * d * d ? cbrt(t) : t / (3 * d * d) + 4.0 / 29;
    }
    const double lightness = 116 * f.v[1] - 16;
    return (vector){{lightness, 0.01 * lightness * 500 * (f.v[0] - f.v[1]), 0.01 * lightness * 200 * (f.v[1] - f.v[2])}};
}

static vector seen_colour(const oracle_request *q, const uint8_t *rgba, int x, int y)
{
    const vector c = filtered(q, rgba, x, y);
    const double yn = (c.v[0] + 16) / 116;
    vector rgb = times(RGB, (vector){{(yn + c.v[1] / 500) * WHITE[0], yn * WHITE[1], (yn - c.v[2] / 200) * WHITE[2]}});
    for (int k = 0; k < 3; ++k) rgb.v[k] = fmin(fmax(rgb.v[k], 0), 1);
    return lab_of_linear(rgb);
}

static double hyab(vector a, vector b)
{
    return fabs(a.v[0] - b.v[0]) + hypot(a.v[1] - b.v[1], a.v[2] - b.v[2]);
}

// Weight of the filter at (dx, dy), along x; order 1: edges, 2: points.
static double feature_weight(const oracle_request *q, int order, int dx, int dy)
{
    const double sigma = 0.5 * 0.082 * q->pixels_per_degree, g = exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
    return order == 1 ? -dx * g : (dx * dx / (sigma * sigma) - 1) * g;
}

static double feature(const oracle_request *q, const uint8_t *rgba, int order, const int at[2])
{
    const int reach = (int)ceil(3 * 0.5 * 0.082 * q->pixels_per_degree);
    double positive = 0, negative = 0, along[2][2] = {{0}}; // by axis: of positive and of negative weights
    for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
            const double w = feature_weight(q, order, dx, dy), across = (opponent_of(q, rgba, at[0] + dx, at[1] + dy).v[0] + 16) / 116;
            const double down = (opponent_of(q, rgba, at[0] + dy, at[1] + dx).v[0] + 16) / 116;
            *(w > 0 ? &positive : &negative) += fabs(w);
            along[0][w < 0] += w * across;
            along[1][w < 0] += w * down;
        }
    return hypot(along[0][0] / positive + along[0][1] / negative, along[1][0] / positive + along[1][1] / negative);
}

static double difference(const oracle_request *q, int x, int y)
{
    const vector green = lab_of_linear((vector){{0, 1, 0}}), blue = lab_of_linear((vector){{0, 0, 1}});
    const double most = pow(hyab(green, blue), 0.7), c = pow(hyab(seen_colour(q, q->reference, x, y), seen_colour(q, q->test, x, y)), 0.7);
    const double colour = c < 0.4 * most ? 0.95 / (0.4 * most) * c : 0.95 + (c - 0.4 * most) / (most - 0.4 * most) * 0.05;
    double strongest = 0;
    for (int order = 1; order <= 2; ++order) {
        const int at[2] = {x, y};
        strongest = fmax(strongest, fabs(feature(q, q->reference, order, at) - feature(q, q->test, order, at)));
    }
    return pow(colour, 1 - sqrt(strongest / sqrt(2)));
}

double flip_oracle(const oracle_request *q, double *map)
{
    double sum = 0;
    for (int y = 0; y < q->high; ++y)
        for (int x = 0; x < q->wide; ++x) {
            map[(long)y * q->wide + x] = difference(q, x, y);
            sum += map[(long)y * q->wide + x];
        }
    return sum / ((double)q->wide * q->high);
}
