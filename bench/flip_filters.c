// FLIP: its filters and colour spaces, from the paper's figures (sections 4.1 and 4.2) and IEC 61966-2-1 (sRGB).
// SPDX-License-Identifier: MIT
#include "flip_parts.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

// ---- Contrast sensitivity: sums of Gaussians a * sqrt(pi / b) * exp(-pi^2 x^2 / b), x in degrees (the paper's table 1) ----

typedef struct sensitivity { double a, b; } sensitivity;
static const sensitivity LUMINANCE = {1, 0.0047}, RED_GREEN = {1, 0.0053}, BLUE_YELLOW[2] = {{34.1, 0.04}, {13.5, 0.025}};
static const double WIDEST = 0.04;                // b of the widest of them: all reach three of its deviations
static const double FEATURE_WIDTH_DEG = 0.082;    // of an edge detector, peak to peak
static const double WEIGHT_LEAST = 0x1p-30;       // of the middle's: what is under it is under float's last bit of any sum

static double gaussian(double x, double b)
{
    return exp(-PI * PI * x * x / b);
}

// Not normalised. Returns the sum over both sides.
static double sample(double b, double pixels_per_degree, double out[FLIP_REACH_MOST + 1], int32_t *out_reach)
{
    const int32_t all = (int32_t)ceil(3 * sqrt(WIDEST / (2 * PI * PI)) * pixels_per_degree);
    double sum = 0;
    *out_reach = 0;
    for (int32_t k = 0; k <= all && k <= FLIP_REACH_MOST; ++k) {
        out[k] = gaussian(k / pixels_per_degree, b);
        sum += k ? 2 * out[k] : out[k];
        if (out[k] >= WEIGHT_LEAST) *out_reach = k;
    }
    return sum;
}

static void make_one(double b, double scale, double pixels_per_degree, flip_taps *out)
{
    double weights[FLIP_REACH_MOST + 1] = {0};
    const double sum = sample(b, pixels_per_degree, weights, &out->reach);
    for (int32_t k = 0; k <= out->reach; ++k) out->weight[k] = (float)(weights[k] * scale / sum);
}

// A sum of two Gaussians is no product of a row and a column, but each of the two is.
static void make_two(double pixels_per_degree, flip_taps out[2][2])
{
    double shares[2], weights[FLIP_REACH_MOST + 1] = {0};
    for (int i = 0; i < 2; ++i) {
        int32_t reach;
        const double sum = sample(BLUE_YELLOW[i].b, pixels_per_degree, weights, &reach);
        shares[i] = BLUE_YELLOW[i].a * sqrt(PI / BLUE_YELLOW[i].b) * sum * sum;
    }
    for (int i = 0; i < 2; ++i) {
        make_one(BLUE_YELLOW[i].b, 1, pixels_per_degree, &out[i][0]);
        make_one(BLUE_YELLOW[i].b, shares[i] / (shares[0] + shares[1]), pixels_per_degree, &out[i][1]);
    }
}

// ---- Features: derivatives of a Gaussian, positive weights summing to 1 and negative ones to -1 ----

static void make_features(double pixels_per_degree, flip_filters *out)
{
    const double deviation = FEATURE_WIDTH_DEG * pixels_per_degree / 2;
    const int32_t reach = (int32_t)ceil(3 * deviation);
    double sum = 0, slopes = 0, positive = 0, negative = 0;
    for (int32_t k = 0; k <= reach; ++k) {
        const double g = exp(-k * k / (2 * deviation * deviation)), bend = (k * k / (deviation * deviation) - 1) * g, twice = k ? 2 : 1;
        sum += twice * g;
        slopes += k * g;
        positive += bend > 0 ? twice * bend : 0;
        negative -= bend < 0 ? twice * bend : 0;
    }
    for (int32_t k = 0; k <= reach; ++k) {
        const double g = exp(-k * k / (2 * deviation * deviation)), bend = (k * k / (deviation * deviation) - 1) * g;
        out->smooth.weight[k] = (float)(g / sum);
        out->edge.weight[k] = (float)(k * g / slopes);
        out->point.weight[k] = (float)(bend > 0 ? bend / positive : bend / negative);
    }
    out->smooth.reach = out->edge.reach = out->point.reach = reach;
}

void flip_make_filters(double pixels_per_degree, flip_filters *out)
{
    *out = (flip_filters){0};
    make_one(LUMINANCE.b, 1, pixels_per_degree, &out->luminance);
    make_one(RED_GREEN.b, 1, pixels_per_degree, &out->red_green);
    make_two(pixels_per_degree, out->blue_yellow);
    make_features(pixels_per_degree, out);
}

int32_t flip_reach(const flip_filters *filters)
{
    const flip_taps *const all[] = {&filters->luminance, &filters->red_green, &filters->blue_yellow[0][0], &filters->blue_yellow[1][0],
                                    &filters->smooth};
    int32_t reach = 0;
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) reach = all[i]->reach > reach ? all[i]->reach : reach;
    return reach;
}

// ---- Colours ----

static void invert(double m[3][3], double out[3][3])
{
    double determinant = 0;
    for (int c = 0; c < 3; ++c) determinant += m[0][c] * (m[1][(c + 1) % 3] * m[2][(c + 2) % 3] - m[1][(c + 2) % 3] * m[2][(c + 1) % 3]);
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            out[c][r] = (m[(r + 1) % 3][(c + 1) % 3] * m[(r + 2) % 3][(c + 2) % 3] - m[(r + 1) % 3][(c + 2) % 3] * m[(r + 2) % 3][(c + 1) % 3]) / determinant;
}

// From the chromaticities of sRGB's primaries and of its white, D65. Rows by the white's X, Y, Z: white is (1, 1, 1).
void flip_make_colours(flip_colours *out)
{
    static const double at[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}, white[2] = {0.3127, 0.3290};
    double primaries[3][3], inverse[3][3], by_white[3][3];
    const double white_xyz[3] = {white[0] / white[1], 1, (1 - white[0] - white[1]) / white[1]};
    for (int c = 0; c < 3; ++c) {
        primaries[0][c] = at[c][0];
        primaries[1][c] = at[c][1];
        primaries[2][c] = 1 - at[c][0] - at[c][1];
    }
    invert(primaries, inverse);
    for (int c = 0; c < 3; ++c) {
        double strength = 0;
        for (int k = 0; k < 3; ++k) strength += inverse[c][k] * white_xyz[k];
        for (int r = 0; r < 3; ++r) by_white[r][c] = primaries[r][c] * strength / white_xyz[r];
    }
    invert(by_white, inverse);
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
            out->white_from_rgb[r][c] = (float)by_white[r][c];
            out->rgb_from_white[r][c] = (float)inverse[r][c];
        }
    for (int i = 0; i < 256; ++i) {
        const double s = i / 255.0;
        out->linear[i] = (float)(s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4));
    }
}
