// A turned grid fitted to points, and its rotation as whole numbers: see frame_search.h.
// SPDX-License-Identifier: MIT
#include "frame_search.h"

#include <math.h>
#include <string.h>

enum { QUATERNION_MOST = 1 << 16, NEAR_LEAST = 12 };
static const double FIRST_REACH = 8;         // parts: a grid 1/256 askew is off by 1/32 of a part there, far from half of one
static const double INLIER_UNITS = 1.0 / 16; // of a point from its grid's, while the rotation is not known well
static const double SKEW_STEPS = 0.25;       // that a rational rotation may take a point off: half of what rounding does
static const double SHIFT_LEAST = 0.25;      // steps: less is an error of rounding

// ---- A grid fitted ----

typedef struct fit_sums { // of points x = turn (y + small rotation x y) + shift, about the reference
    double outer[3][3], turned[3], x[3], y[3], count, near;
} fit_sums;

static void to_frame(const rough_frame *f, const double x[3], double out[3])
{
    for (int k = 0; k < 3; ++k) out[k] = f->turn[0][k] * x[0] + f->turn[1][k] * x[1] + f->turn[2][k] * x[2];
}

static void take_point(const frame_points *p, const rough_frame *f, const double x[3], fit_sums *s)
{
    const double part = (double)p->grid / f->parts;
    double y[3], whole[3], most = 0;
    to_frame(f, x, y);
    for (int k = 0; k < 3; ++k) {
        whole[k] = (nearbyint(y[k] / part - f->shift[k]) + f->shift[k]) * part;
        most = fmax(most, fabs(y[k] - whole[k]));
    }
    s->near += 1;
    if (most > fmin(INLIER_UNITS * p->grid, part / 4)) return;
    s->count += 1;
    for (int k = 0; k < 3; ++k) {
        s->x[k] += y[k] - whole[k];
        s->y[k] += whole[k];
        s->turned[k] += whole[(k + 1) % 3] * (y[(k + 2) % 3] - whole[(k + 2) % 3]) - whole[(k + 2) % 3] * (y[(k + 1) % 3] - whole[(k + 1) % 3]);
        for (int j = 0; j < 3; ++j) s->outer[k][j] += whole[k] * whole[j];
    }
}

static double determinant(double m[3][3])
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += m[0][k] * (m[1][(k + 1) % 3] * m[2][(k + 2) % 3] - m[1][(k + 2) % 3] * m[2][(k + 1) % 3]);
    return sum;
}

// By Cramer's rule. 0: the points lie on a line.
static int solve(double m[3][3], const double right[3], double out[3])
{
    const double all = determinant(m);
    if (!(fabs(all) > 1e-9 * fabs(m[0][0] * m[1][1] * m[2][2]))) return 0;
    for (int k = 0; k < 3; ++k) {
        double with[3][3];
        memcpy(with, m, sizeof with);
        for (int j = 0; j < 3; ++j) with[j][k] = right[j];
        out[k] = determinant(with) / all;
    }
    return 1;
}

static void make_orthogonal(double turn[3][3]) // columns
{
    for (int c = 0; c < 2; ++c) {
        double along = 0, length = 0;
        for (int k = 0; k < 3; ++k) along += turn[k][0] * turn[k][c];
        for (int k = 0; k < 3 && c; ++k) turn[k][c] -= along * turn[k][0];
        for (int k = 0; k < 3; ++k) length += turn[k][c] * turn[k][c];
        for (int k = 0; k < 3; ++k) turn[k][c] /= sqrt(length);
    }
    for (int k = 0; k < 3; ++k) turn[k][2] = turn[(k + 1) % 3][0] * turn[(k + 2) % 3][1] - turn[(k + 2) % 3][0] * turn[(k + 1) % 3][1];
}

// Least squares for a small rotation w, y - whole = w x whole + t, about the middle of the points.
static int correct(const frame_points *p, rough_frame *f, fit_sums *s)
{
    double m[3][3], right[3], w[3], trace = 0;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        right[k] = s->turned[k] - (s->y[i] * s->x[j] - s->y[j] * s->x[i]) / s->count;
        for (int l = 0; l < 3; ++l) m[k][l] = s->y[k] * s->y[l] / s->count - s->outer[k][l];
        trace -= m[k][k];
    }
    for (int k = 0; k < 3; ++k) m[k][k] += trace;
    if (!solve(m, right, w)) return 0;
    double turn[3][3]; // turn (1 + w x)
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c)
            turn[k][c] = f->turn[k][c] + f->turn[k][(c + 1) % 3] * w[(c + 2) % 3] - f->turn[k][(c + 2) % 3] * w[(c + 1) % 3];
    const double part = (double)p->grid / f->parts;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        f->shift[k] += (s->x[k] - (w[i] * s->y[j] - w[j] * s->y[i])) / s->count / part;
    }
    memcpy(f->turn, turn, sizeof turn);
    make_orthogonal(f->turn);
    return 1;
}

static int fit_within(const frame_points *p, rough_frame *f, double reach)
{
    fit_sums s = {.count = 0};
    const int32_t *o = p->at[p->reference];
    for (size_t i = 0; i < p->count; ++i) {
        const double x[3] = {(double)p->at[i][0] - o[0], (double)p->at[i][1] - o[1], (double)p->at[i][2] - o[2]};
        if (x[0] * x[0] + x[1] * x[1] + x[2] * x[2] <= reach * reach) take_point(p, f, x, &s);
    }
    if (s.near < NEAR_LEAST) return 1; // farther out there are more
    return s.count >= 7.0 / 8 * s.near && (correct(p, f, &s) || reach < p->reach);
}

int rough_frame_fit(const frame_points *p, rough_frame *f)
{
    const double part = (double)p->grid / f->parts;
    for (int k = 0; k < 3; ++k) f->shift[k] = 0;
    for (double reach = FIRST_REACH * part;; reach *= 2) {
        if (!fit_within(p, f, reach)) return 0;
        if (reach >= p->reach) break;
    }
    return fit_within(p, f, p->reach);
}

// ---- Whole numbers ----

static void quaternion_of(const rough_frame *f, double q[4])
{
    const double(*t)[3] = (const double(*)[3])f->turn;
    const double trace = t[0][0] + t[1][1] + t[2][2];
    if (trace > 0) {
        q[0] = 1 + trace;
        for (int k = 0; k < 3; ++k) q[1 + k] = t[(k + 2) % 3][(k + 1) % 3] - t[(k + 1) % 3][(k + 2) % 3];
        return;
    }
    int i = t[1][1] > t[0][0] ? 1 : 0;
    if (t[2][2] > t[i][i]) i = 2;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    q[0] = t[k][j] - t[j][k];
    q[1 + i] = 1 + t[i][i] - t[j][j] - t[k][k];
    q[1 + j] = t[j][i] + t[i][j];
    q[1 + k] = t[k][i] + t[i][k];
}

static int64_t divisor_of(int64_t a, int64_t b)
{
    while (b) {
        const int64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a < 0 ? -a : a;
}

static void rotation_of(const int64_t q[4], turned_frame *out)
{
    const int64_t w = q[0], *v = q + 1, size = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    int64_t divisor = out->scale = w * w + size;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const int64_t turned = i == j ? 0 : (j == (i + 2) % 3 ? 1 : -1) * 2 * w * v[3 - i - j];
            out->turn[i][j] = 2 * v[i] * v[j] + turned + (i == j ? w * w - size : 0);
            divisor = divisor_of(divisor, out->turn[i][j]);
        }
    out->scale /= divisor;
    for (int i = 0; i < 9; ++i) out->turn[i / 3][i % 3] /= divisor;
}

static int is_rotation_near(const turned_frame *f, const rough_frame *to, double skew)
{
    for (int i = 0; i < 9; ++i)
        if (fabs((double)f->turn[i / 3][i % 3] / (double)f->scale - to->turn[i / 3][i % 3]) > skew) return 0;
    return 1;
}

// The fitted shift is about the reference; by the rational rotation the way from there is right however far it is.
static void shift_to_origin(const frame_points *p, const rough_frame *f, turned_frame *out)
{
    const double part = (double)p->grid / f->parts;
    const int32_t *o = p->at[p->reference];
    for (int k = 0; k < 3; ++k) {
        double at = 0;
        for (int j = 0; j < 3; ++j) at += (double)out->turn[j][k] * o[j];
        double shift = at / ((double)out->scale * part) + f->shift[k];
        shift -= nearbyint(shift);
        out->shift[k] = fabs(shift) * part < SHIFT_LEAST ? 0 : (int64_t)nearbyint(shift * FRAME_SHIFT_PARTS);
    }
}

int rough_frame_rational(const frame_points *p, const rough_frame *f, turned_frame *out)
{
    double q[4], largest = 0;
    quaternion_of(f, q);
    for (int i = 0; i < 4; ++i) largest = fmax(largest, fabs(q[i]));
    for (int most = 1; most <= QUATERNION_MOST; ++most) {
        int64_t whole[4];
        for (int i = 0; i < 4; ++i) whole[i] = (int64_t)nearbyint(q[i] / largest * most);
        rotation_of(whole, out);
        if (!is_rotation_near(out, f, SKEW_STEPS / p->reach)) continue;
        out->grid = p->grid;
        out->parts = f->parts;
        shift_to_origin(p, f, out);
        return 1;
    }
    return 0;
}
