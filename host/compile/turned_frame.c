// Planes in a turned frame, and whether it explains the points of a map: see turned_frame.h. How it is found: frame_search.c.
// SPDX-License-Identifier: MIT
#include "frame_search.h"

#include <math.h>

__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;

enum { NORMAL_BITS = 49, OFFSET_BITS = 73 }; // one less than exact.h bears
static const double TOLERANCE_UNITS = 1.0 / 128; // of a coordinate: half of a second decimal, 0.005, and half as much for the frame's own

// ---- Points ----

// The frame's point that was meant, in its parts of a unit. 0: none is near.
static int frame_point(const turned_frame *f, const int32_t p[3], int64_t out[3], double *move)
{
    const double part = (double)f->grid / f->parts, scale = (double)f->scale;
    double to[3];
    for (int k = 0; k < 3; ++k) {
        double at = 0;
        for (int j = 0; j < 3; ++j) at += (double)f->turn[j][k] * p[j];
        const double shift = (double)f->shift[k] / FRAME_SHIFT_PARTS, whole = nearbyint(at / (scale * part) - shift);
        out[k] = (int64_t)whole;
        to[k] = (whole + shift) * part;
    }
    double most = 0, sum = 0;
    for (int k = 0; k < 3; ++k) {
        double off = -p[k];
        for (int j = 0; j < 3; ++j) off += (double)f->turn[k][j] * to[j] / scale;
        most = fmax(most, fabs(off));
        sum += off * off;
    }
    *move = fmax(*move, sqrt(sum));
    return most <= TOLERANCE_UNITS * f->grid;
}

uint32_t turned_frame_explains(const turned_frame *f, const int32_t (*points)[3], size_t count)
{
    uint32_t explained = 0;
    for (size_t i = 0; i < count; ++i) {
        int64_t at[3];
        double move = 0;
        explained += (uint32_t)frame_point(f, points[i], at, &move);
    }
    return explained;
}

// ---- Planes ----

static int fits(int128 v, int bits)
{
    return v < (int128)1 << bits && -v < (int128)1 << bits;
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

// The frame's normal through three of its points, without a common divisor. 0: they lie on one line.
static int normal_through(int64_t q[3][3], int64_t out[3])
{
    int64_t u[3], v[3], divisor = 0;
    for (int k = 0; k < 3; ++k) {
        u[k] = q[1][k] - q[0][k];
        v[k] = q[2][k] - q[0][k];
    }
    for (int k = 0; k < 3; ++k) {
        out[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
        divisor = divisor_of(divisor, out[k]);
    }
    if (divisor == 0) return 0;
    for (int k = 0; k < 3; ++k) out[k] /= divisor;
    return 1;
}

// With x = turn (y + shift) grid / (scale parts) and m . y = m . q in the frame: (turn m) . x = scale grid / parts m . (q + shift).
static int plane_of(const turned_frame *f, const int64_t m[3], const int64_t q[3], cull_wide_plane *out)
{
    const int64_t finer = f->shift[0] || f->shift[1] || f->shift[2] ? FRAME_SHIFT_PARTS : 1;
    int128 at = 0;
    for (int k = 0; k < 3; ++k) at += (int128)m[k] * (finer * q[k] + (finer > 1 ? f->shift[k] : 0));
    if (!fits(at, 64)) return 0;
    at *= -(int128)f->scale * f->grid; // 64 + 40 + 17 bits
    for (int k = 0; k < 3; ++k) {
        int128 n = 0;
        for (int j = 0; j < 3; ++j) n += (int128)f->turn[k][j] * m[j];
        n *= finer * (int64_t)f->parts;
        if (!fits(n, 62)) return 0;
        out->normal[k] = (int64_t)n;
    }
    out->offset = (cull_wide){(uint64_t)(uint128)at, (uint64_t)((uint128)at >> 64)};
    *out = cull_wide_plane_reduced(*out);
    const int128 offset = (int128)((uint128)out->offset.high << 64 | out->offset.low);
    return fits(out->normal[0], NORMAL_BITS) && fits(out->normal[1], NORMAL_BITS) && fits(out->normal[2], NORMAL_BITS) && fits(offset, OFFSET_BITS);
}

int turned_frame_plane(const turned_frame *f, const int32_t a[3], const int32_t b[3], const int32_t c[3], cull_wide_plane *out, double *move)
{
    int64_t q[3][3], m[3];
    *move = 0;
    if (!frame_point(f, a, q[0], move) || !frame_point(f, b, q[1], move) || !frame_point(f, c, q[2], move)) return 0;
    return normal_through(q, m) && plane_of(f, m, q[0], out);
}
