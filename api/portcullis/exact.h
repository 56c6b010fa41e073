// exact.h: decisions about integer planes that are never wrong: signs only, no tolerance. Strict C11, reads as C++17.
// SPDX-License-Identifier: MIT
//
// Invariant: points are whole grid steps, |coordinate| <= 2^24 (k = 24); a plane is n . p + offset >= 0 in front with the
// bounds of planes through three such points; a vertex is the point where three planes meet, never a number.
//
// Bounds, each attained, a sign not counted:
//   n       twice the area of a triangle's shadow in a square of side 2^(k+1): 2^(2k+2)         50 bits
//   offset  a determinant of three points, at most 4 products of three: 2^(3k+2)                74
//   s       n n - n n, a minor of two normals: 2^(4k+5)                                        101
//   t       n offset - n offset: 2^(5k+5)                                                      125: why k is 24, not 25
//   w       determinant of three normals: 4 (2^(2k+2))^3 = 2^(6k+8)                            152
//   x, y, z of a meeting point before the division by w: 2^(7k+8)                              176
//   D       determinant of four planes' rows: 16 2^(6k+6) 2^(3k+2) = 2^(9k+12); sums in between one bit more   228
// Where row 4 is put in for the point of rows 1 to 3, D = w (n4 . p + offset4): the side is sign(D) sign(w).
//
// Tiers. D is the sum of the six products of minors of rows 1, 2 with those of rows 3, 4. With N = max |n| and
// O = max(|offset|, 1) of each plane, the sum of all terms' sizes is at most 6 Q, Q = N1 N2 (N3 O4 + N4 O3) + N3 N4 (N1 O2 + N2 O1),
// and no minor and no partial sum exceeds that.
//   double: a term goes through at most 12 roundings (offset 2, minors 2 + 2, their product 1, five sums 5), so the error is
//           below 12 * 1.01 * 6 Q 2^-53 = 8.1e-15 Q; 1.2e-14 leaves room for the rounding of Q itself
//   64 bits while 6 Q < 2^62; 128 bits while 6 Q < 2^126; else 256 bits.
// A true zero always goes past the first tier; on real maps that is most of what does.
#ifndef PORTCULLIS_EXACT_H
#define PORTCULLIS_EXACT_H

#include "culler.h"
#include "wide_integer.h"

#define CULL_GRID_MOST 16777216 // 2^24 steps

typedef struct cull_wide_plane {
    int64_t normal[3]; // not all zero
    cull_wide offset;
} cull_wide_plane;

typedef struct cull_wide_vector { cull_wide v[3]; } cull_wide_vector;

// ---- Planes ----

static inline uint64_t cull_divisor(uint64_t a, uint64_t b) // greatest common; of (0, b) b
{
    while (b) {
        const uint64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

static inline cull_wide_plane cull_wide_plane_flipped(cull_wide_plane p)
{
    for (int i = 0; i < 3; i++) p.normal[i] = -p.normal[i];
    p.offset = cull_wide_negate(p.offset);
    return p;
}

static inline bool cull_wide_plane_equal(const cull_wide_plane *a, const cull_wide_plane *b)
{
    return a->normal[0] == b->normal[0] && a->normal[1] == b->normal[1] && a->normal[2] == b->normal[2] && cull_wide_equal(a->offset, b->offset);
}

static inline cull_wide cull_wide_dot_point(const int64_t normal[3], const int32_t p[3])
{
    cull_wide sum = cull_wide_product(normal[0], p[0]);
    sum = cull_wide_add(sum, cull_wide_product(normal[1], p[1]));
    return cull_wide_add(sum, cull_wide_product(normal[2], p[2]));
}

// Schoolbook, a bit at a time; quotient written where it is asked for. Seldom called.
static inline uint64_t cull_wide_divide_unsigned(cull_wide v, uint64_t divisor, cull_wide *quotient)
{
    cull_wide out = {0, 0};
    uint64_t rest = 0;
    for (int bit = 127; bit >= 0; bit--) {
        const uint64_t next = bit >= 64 ? v.high >> (bit - 64) : v.low >> bit, spill = rest >> 63;
        rest = (rest << 1) | (next & 1);
        if (!spill && rest < divisor) continue;
        rest -= divisor;
        if (bit >= 64) out.high |= (uint64_t)1 << (bit - 64);
        else out.low |= (uint64_t)1 << bit;
    }
    if (quotient) *quotient = out;
    return rest;
}

// The same plane without a common divisor of its four numbers.
static inline cull_wide_plane cull_wide_plane_reduced(cull_wide_plane p)
{
    uint64_t divisor = cull_divisor(cull_divisor(cull_magnitude(p.normal[0]), cull_magnitude(p.normal[1])), cull_magnitude(p.normal[2]));
    if (divisor <= 1) return p;
    const cull_wide size = cull_wide_magnitude(p.offset);
    divisor = cull_divisor(divisor, cull_wide_divide_unsigned(size, divisor, 0));
    if (divisor <= 1) return p;
    const bool negative = cull_wide_sign(p.offset) < 0;
    cull_wide_divide_unsigned(size, divisor, &p.offset);
    if (negative) p.offset = cull_wide_negate(p.offset);
    for (int i = 0; i < 3; i++) p.normal[i] /= (int64_t)divisor;
    return p;
}

// Through three points, reduced; counterclockwise seen from the front. false when they lie on one line.
static inline bool cull_wide_plane_through(const int32_t a[3], const int32_t b[3], const int32_t c[3], cull_wide_plane *out)
{
    int64_t u[3], v[3], n[3];
    for (int i = 0; i < 3; i++) {
        u[i] = (int64_t)b[i] - a[i];
        v[i] = (int64_t)c[i] - a[i];
    }
    for (int i = 0; i < 3; i++) n[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
    const int64_t divisor = (int64_t)cull_divisor(cull_divisor(cull_magnitude(n[0]), cull_magnitude(n[1])), cull_magnitude(n[2]));
    if (divisor == 0) return false;
    for (int i = 0; i < 3; i++) out->normal[i] = n[i] / divisor;
    out->offset = cull_wide_negate(cull_wide_dot_point(out->normal, a)); // the divisor divides n . a too
    return true;
}

// The same plane for points told from `origin`.
static inline cull_wide_plane cull_wide_plane_from_origin(cull_wide_plane p, const int32_t origin[3])
{
    p.offset = cull_wide_add(p.offset, cull_wide_dot_point(p.normal, origin));
    return p;
}

// false when the offset needs more than 63 bits; *out stays as it was.
static inline bool cull_exact_plane_from_wide(const cull_wide_plane *p, cull_exact_plane *out)
{
    if (!cull_wide_fits_int64(p->offset)) return false;
    for (int i = 0; i < 3; i++) out->normal[i] = p->normal[i];
    out->offset = cull_wide_to_int64(p->offset);
    return true;
}

static inline cull_wide_plane cull_wide_plane_from_exact(const cull_exact_plane *p)
{
    const cull_wide_plane out = {{p->normal[0], p->normal[1], p->normal[2]}, cull_wide_from(p->offset)};
    return out;
}

static inline int cull_side_of_point(const cull_wide_plane *plane, const int32_t p[3]) // 1 front, 0 on it, -1 behind
{
    return cull_wide_sign(cull_wide_add(cull_wide_dot_point(plane->normal, p), plane->offset)); // 77 bits
}

// ---- Rows of doubles: what the filter reads ----

typedef struct cull_row {
    double n[3], offset; // normals are exact, 50 bits
    double most;         // N
    double reach;        // O
} cull_row;

static inline double cull_larger(double a, double b)
{
    return a > b ? a : b;
}

static inline double cull_size(double v) // no branch on a sign, which would be as good as random
{
    return cull_larger(v, -v);
}

static inline cull_row cull_row_of(const cull_wide_plane *p)
{
    const double x = (double)p->normal[0], y = (double)p->normal[1], z = (double)p->normal[2], offset = cull_wide_to_double(p->offset);
    const cull_row r = {{x, y, z}, offset, cull_larger(cull_larger(cull_size(x), cull_size(y)), cull_size(z)), cull_larger(cull_size(offset), 1)};
    return r;
}

#define CULL_MOST_64 4.5e18   // < 2^62 = 4.61e18, room for the bound's own rounding
#define CULL_MOST_128 8.4e37  // < 2^126 = 8.51e37

// ---- Minors of two rows ----

typedef struct cull_minors { double xy, xz, yz, x, y, z; } cull_minors; // x: of columns x and offset
typedef struct cull_minors_64 { int64_t xy, xz, yz, x, y, z; } cull_minors_64;
typedef struct cull_minors_128 { cull_wide xy, xz, yz, x, y, z; } cull_minors_128;

static inline cull_minors cull_minors_of(const cull_row *a, const cull_row *b)
{
    const cull_minors m = {a->n[0] * b->n[1] - a->n[1] * b->n[0],     a->n[0] * b->n[2] - a->n[2] * b->n[0],
                           a->n[1] * b->n[2] - a->n[2] * b->n[1],     a->n[0] * b->offset - a->offset * b->n[0],
                           a->n[1] * b->offset - a->offset * b->n[1], a->n[2] * b->offset - a->offset * b->n[2]};
    return m;
}

static inline cull_minors_64 cull_minors_64_of(const cull_wide_plane *a, const cull_wide_plane *b)
{
    const int64_t *n = a->normal, *m = b->normal, o = cull_wide_to_int64(a->offset), q = cull_wide_to_int64(b->offset);
    const cull_minors_64 out = {n[0] * m[1] - n[1] * m[0], n[0] * m[2] - n[2] * m[0], n[1] * m[2] - n[2] * m[1],
                                n[0] * q - o * m[0],       n[1] * q - o * m[1],       n[2] * q - o * m[2]};
    return out;
}

static inline cull_wide cull_wide_minor(int64_t a, int64_t b, int64_t c, int64_t d) // a b - c d
{
    return cull_wide_subtract(cull_wide_product(a, b), cull_wide_product(c, d));
}

static inline cull_wide cull_wide_offset_minor(int64_t n, cull_wide q, cull_wide o, int64_t m) // n q - o m
{
    return cull_wide_subtract(cull_wide_scale(q, n), cull_wide_scale(o, m));
}

static inline cull_minors_128 cull_minors_128_of(const cull_wide_plane *a, const cull_wide_plane *b)
{
    const int64_t *n = a->normal, *m = b->normal;
    cull_minors_128 out;
    out.xy = cull_wide_minor(n[0], m[1], n[1], m[0]);
    out.xz = cull_wide_minor(n[0], m[2], n[2], m[0]);
    out.yz = cull_wide_minor(n[1], m[2], n[2], m[1]);
    out.x = cull_wide_offset_minor(n[0], b->offset, a->offset, m[0]);
    out.y = cull_wide_offset_minor(n[1], b->offset, a->offset, m[1]);
    out.z = cull_wide_offset_minor(n[2], b->offset, a->offset, m[2]);
    return out;
}

// ---- Four planes ----

typedef enum cull_tier { CULL_TIER_DOUBLE, CULL_TIER_64, CULL_TIER_128, CULL_TIER_256 } cull_tier; // which one decided

static inline int cull_four_64(const cull_wide_plane *const p[4])
{
    const cull_minors_64 s = cull_minors_64_of(p[0], p[1]), c = cull_minors_64_of(p[2], p[3]);
    const int64_t d = s.xy * c.z - s.xz * c.y + s.x * c.yz + s.yz * c.x - s.y * c.xz + s.z * c.xy;
    return (d > 0) - (d < 0);
}

static inline int cull_four_128(const cull_wide_plane *const p[4])
{
    const cull_minors_128 s = cull_minors_128_of(p[0], p[1]), c = cull_minors_128_of(p[2], p[3]);
    cull_wide d = cull_wide_subtract(cull_wide_multiply(s.xy, c.z), cull_wide_multiply(s.xz, c.y));
    d = cull_wide_add(d, cull_wide_add(cull_wide_multiply(s.x, c.yz), cull_wide_multiply(s.yz, c.x)));
    d = cull_wide_add(d, cull_wide_subtract(cull_wide_multiply(s.z, c.xy), cull_wide_multiply(s.y, c.xz)));
    return cull_wide_sign(d);
}

static inline int cull_four_256(const cull_wide_plane *const p[4])
{
    const cull_minors_128 s = cull_minors_128_of(p[0], p[1]), c = cull_minors_128_of(p[2], p[3]);
    cull_int256 d = {{0, 0, 0, 0}};
    cull_int256_multiply_add(&d, s.xy, c.z);
    cull_int256_multiply_subtract(&d, s.xz, c.y);
    cull_int256_multiply_add(&d, s.x, c.yz);
    cull_int256_multiply_add(&d, s.yz, c.x);
    cull_int256_multiply_subtract(&d, s.y, c.xz);
    cull_int256_multiply_add(&d, s.z, c.xy);
    return cull_int256_sign(&d);
}

// The sign of D, the determinant of four planes' rows; rows made before, see cull_row_of.
static inline int cull_four_sign_of_rows(const cull_wide_plane *const p[4], const cull_row *const r[4], cull_tier *tier)
{
    const double low = r[0]->most * r[1]->most, high = r[2]->most * r[3]->most;
    const double q = low * (r[2]->most * r[3]->reach + r[3]->most * r[2]->reach) + high * (r[0]->most * r[1]->reach + r[1]->most * r[0]->reach);
    const cull_minors s = cull_minors_of(r[0], r[1]), c = cull_minors_of(r[2], r[3]);
    const double d = s.xy * c.z - s.xz * c.y + s.x * c.yz + s.yz * c.x - s.y * c.xz + s.z * c.xy, error = 1.2e-14 * q;
    *tier = CULL_TIER_DOUBLE;
    if (cull_size(d) > error) return (d > 0) - (d < 0);
    *tier = 6 * q < CULL_MOST_64 ? CULL_TIER_64 : 6 * q < CULL_MOST_128 ? CULL_TIER_128 : CULL_TIER_256;
    return *tier == CULL_TIER_64 ? cull_four_64(p) : *tier == CULL_TIER_128 ? cull_four_128(p) : cull_four_256(p);
}

static inline int cull_four_sign_tier(const cull_wide_plane *a, const cull_wide_plane *b, const cull_wide_plane *c, const cull_wide_plane *d,
                                      cull_tier *tier)
{
    const cull_wide_plane *const planes[4] = {a, b, c, d};
    const cull_row one = cull_row_of(a), two = cull_row_of(b), three = cull_row_of(c), four = cull_row_of(d);
    const cull_row *const rows[4] = {&one, &two, &three, &four};
    return cull_four_sign_of_rows(planes, rows, tier);
}

// The sign of D. 0 also where three of them have no point in common, so ask cull_normals_sign first.
static inline int cull_four_sign(const cull_wide_plane *a, const cull_wide_plane *b, const cull_wide_plane *c, const cull_wide_plane *d)
{
    cull_tier tier;
    return cull_four_sign_tier(a, b, c, d, &tier);
}

// ---- Three normals ----

static inline int cull_three_256(const int64_t *a, const int64_t *b, const int64_t *c)
{
    cull_int256 w = {{0, 0, 0, 0}};
    cull_int256_scale_add(&w, cull_wide_minor(a[0], b[1], a[1], b[0]), c[2]);
    cull_int256_scale_subtract(&w, cull_wide_minor(a[0], b[2], a[2], b[0]), c[1]);
    cull_int256_scale_add(&w, cull_wide_minor(a[1], b[2], a[2], b[1]), c[0]);
    return cull_int256_sign(&w);
}

static inline int cull_three_128(const int64_t *a, const int64_t *b, const int64_t *c)
{
    cull_wide w = cull_wide_scale(cull_wide_minor(a[0], b[1], a[1], b[0]), c[2]);
    w = cull_wide_subtract(w, cull_wide_scale(cull_wide_minor(a[0], b[2], a[2], b[0]), c[1]));
    w = cull_wide_add(w, cull_wide_scale(cull_wide_minor(a[1], b[2], a[2], b[1]), c[0]));
    return cull_wide_sign(w);
}

static inline int cull_three_64(const int64_t *a, const int64_t *b, const int64_t *c)
{
    const int64_t w = (a[0] * b[1] - a[1] * b[0]) * c[2] - (a[0] * b[2] - a[2] * b[0]) * c[1] + (a[1] * b[2] - a[2] * b[1]) * c[0];
    return (w > 0) - (w < 0);
}

// The sign of w = det(n_a, n_b, n_c) = (n_a x n_b) . n_c; 0: the planes don't meet in one point. A term goes through five
// roundings and there are six, each at most N N N: 30 * 1.01 * 2^-53 = 3.4e-15. Rows made before, see cull_row_of.
static inline int cull_normals_sign_of_rows(const cull_wide_plane *const p[3], const cull_row *const r[3], cull_tier *tier)
{
    const double *u = r[0]->n, *v = r[1]->n, *n = r[2]->n, size = r[0]->most * r[1]->most * r[2]->most, error = 4e-15 * size;
    const double w = (u[0] * v[1] - u[1] * v[0]) * n[2] - (u[0] * v[2] - u[2] * v[0]) * n[1] + (u[1] * v[2] - u[2] * v[1]) * n[0];
    *tier = CULL_TIER_DOUBLE;
    if (cull_size(w) > error) return (w > 0) - (w < 0);
    *tier = 6 * size < CULL_MOST_64 ? CULL_TIER_64 : 6 * size < CULL_MOST_128 ? CULL_TIER_128 : CULL_TIER_256;
    if (*tier == CULL_TIER_64) return cull_three_64(p[0]->normal, p[1]->normal, p[2]->normal);
    return *tier == CULL_TIER_128 ? cull_three_128(p[0]->normal, p[1]->normal, p[2]->normal) : cull_three_256(p[0]->normal, p[1]->normal, p[2]->normal);
}

static inline int cull_normals_sign_tier(const cull_wide_plane *a, const cull_wide_plane *b, const cull_wide_plane *c, cull_tier *tier)
{
    const cull_wide_plane *const planes[3] = {a, b, c};
    const cull_row one = cull_row_of(a), two = cull_row_of(b), three = cull_row_of(c);
    const cull_row *const rows[3] = {&one, &two, &three};
    return cull_normals_sign_of_rows(planes, rows, tier);
}

static inline int cull_normals_sign(const cull_wide_plane *a, const cull_wide_plane *b, const cull_wide_plane *c)
{
    cull_tier tier;
    return cull_normals_sign_tier(a, b, c, &tier);
}

// ---- Vertices ----

// The side of `of` on which the point lies where a, b and c meet (they must: cull_normals_sign is not 0).
static inline int cull_side_of_meet(const cull_wide_plane *a, const cull_wide_plane *b, const cull_wide_plane *c, const cull_wide_plane *of)
{
    const int d = cull_four_sign(a, b, c, of);
    return d ? d * cull_normals_sign(a, b, c) : 0;
}

// Where along the line of a and b, in the direction n_a x n_b, the point of c lies against the point of d: 1 behind it
// (farther along), 0 the same, -1 before. Both meet the line. From d's height h at c's point: it changes along the line
// by det(n_a, n_b, n_d) a unit of n_a x n_b, so the way from d's point is h over that.
static inline int cull_order_along(const cull_wide_plane *a, const cull_wide_plane *b, const cull_wide_plane *c, const cull_wide_plane *d)
{
    const int height = cull_side_of_meet(a, b, c, d);
    return height ? height * cull_normals_sign(a, b, d) : 0;
}

static inline bool cull_meet_position_64(const cull_wide_plane *a, const cull_wide_plane *b, const cull_wide_plane *c, double out[3])
{
    const cull_minors_64 s = cull_minors_64_of(a, b);
    const int64_t *n = c->normal, o = cull_wide_to_int64(c->offset), w = s.xy * n[2] - s.xz * n[1] + s.yz * n[0];
    if (w == 0) return false;
    out[0] = (double)(s.y * n[2] - s.yz * o - s.z * n[1]) / (double)w + 0.0;
    out[1] = (double)(s.xz * o - s.x * n[2] + s.z * n[0]) / (double)w + 0.0;
    out[2] = (double)(s.x * n[1] - s.xy * o - s.y * n[0]) / (double)w + 0.0;
    return true;
}

static inline double cull_numerator_to_double(cull_wide v) // as cull_int256_to_double has it, so that no position tells its tier
{
    const cull_int256 wide = cull_int256_of(v, cull_wide_from(cull_signed(cull_mask_negative(v.high))));
    return cull_int256_to_double(&wide);
}

static inline bool cull_meet_position_128(const cull_wide_plane *a, const cull_wide_plane *b, const cull_wide_plane *c, double out[3])
{
    const cull_minors_128 s = cull_minors_128_of(a, b);
    const int64_t *n = c->normal;
    const cull_wide w = cull_wide_add(cull_wide_subtract(cull_wide_scale(s.xy, n[2]), cull_wide_scale(s.xz, n[1])), cull_wide_scale(s.yz, n[0]));
    if (cull_wide_sign(w) == 0) return false;
    const cull_wide x = cull_wide_subtract(cull_wide_scale(s.y, n[2]), cull_wide_scale(s.z, n[1])), x_rest = cull_wide_multiply(s.yz, c->offset);
    const cull_wide y = cull_wide_subtract(cull_wide_scale(s.z, n[0]), cull_wide_scale(s.x, n[2])), y_rest = cull_wide_multiply(s.xz, c->offset);
    const cull_wide z = cull_wide_subtract(cull_wide_scale(s.x, n[1]), cull_wide_scale(s.y, n[0])), z_rest = cull_wide_multiply(s.xy, c->offset);
    const double unit = cull_numerator_to_double(w);
    out[0] = cull_numerator_to_double(cull_wide_subtract(x, x_rest)) / unit + 0.0;
    out[1] = cull_numerator_to_double(cull_wide_add(y, y_rest)) / unit + 0.0;
    out[2] = cull_numerator_to_double(cull_wide_subtract(z, z_rest)) / unit + 0.0;
    return true;
}

static inline bool cull_meet_position_256(const cull_wide_plane *a, const cull_wide_plane *b, const cull_wide_plane *c, double out[3])
{
    const cull_minors_128 s = cull_minors_128_of(a, b);
    const int64_t *n = c->normal;
    cull_int256 w = {{0, 0, 0, 0}}, x = w, y = w, z = w;
    cull_int256_scale_add(&w, s.xy, n[2]);
    cull_int256_scale_subtract(&w, s.xz, n[1]);
    cull_int256_scale_add(&w, s.yz, n[0]);
    if (cull_int256_sign(&w) == 0) return false;
    cull_int256_scale_add(&x, s.y, n[2]);
    cull_int256_multiply_subtract(&x, s.yz, c->offset);
    cull_int256_scale_subtract(&x, s.z, n[1]);
    cull_int256_multiply_add(&y, s.xz, c->offset);
    cull_int256_scale_subtract(&y, s.x, n[2]);
    cull_int256_scale_add(&y, s.z, n[0]);
    cull_int256_scale_add(&z, s.x, n[1]);
    cull_int256_multiply_subtract(&z, s.xy, c->offset);
    cull_int256_scale_subtract(&z, s.y, n[0]);
    const double unit = cull_int256_to_double(&w);
    out[0] = cull_int256_to_double(&x) / unit + 0.0;
    out[1] = cull_int256_to_double(&y) / unit + 0.0;
    out[2] = cull_int256_to_double(&z) / unit + 0.0;
    return true;
}

// The meeting point in doubles, from the exact numerators and w, the cofactors of row 4 in D: each coordinate within 2^-50
// of its own size (3 + 3 roundings, and the division's one). Signs and zeros are exact. false when there is none.
// With N and O as for D, no minor, numerator or sum in between exceeds 2 M, M = N1 N2 O3 + N1 O2 N3 + O1 N2 N3, nor w
// 6 N1 N2 N3: 64 bits do while both are below 2^62, as in nearly all of a hand-made map; 128 while both are below 2^126.
// Rows made before, see cull_row_of.
static inline bool cull_meet_position_of_rows(const cull_wide_plane *const p[3], const cull_row *const r[3], double out[3])
{
    const double n01 = r[0]->most * r[1]->most, n012 = 6 * (n01 * r[2]->most);
    const double most = 4 * (n01 * r[2]->reach + (r[0]->most * r[1]->reach + r[0]->reach * r[1]->most) * r[2]->most);
    if (most < CULL_MOST_64 && n012 < CULL_MOST_64) return cull_meet_position_64(p[0], p[1], p[2], out);
    return most < CULL_MOST_128 && n012 < CULL_MOST_128 ? cull_meet_position_128(p[0], p[1], p[2], out) : cull_meet_position_256(p[0], p[1], p[2], out);
}

static inline bool cull_meet_position(const cull_wide_plane *a, const cull_wide_plane *b, const cull_wide_plane *c, double out[3])
{
    const cull_wide_plane *const planes[3] = {a, b, c};
    const cull_row one = cull_row_of(a), two = cull_row_of(b), three = cull_row_of(c);
    const cull_row *const rows[3] = {&one, &two, &three};
    return cull_meet_position_of_rows(planes, rows, out);
}
#define CULL_MEET_ERROR 8.881784197001252e-16 // 2^-50, of each coordinate's size

// The side of a meeting point by its doubles from cull_meet_position alone: 1 or -1 when that is sure, 0 when it isn't,
// and then cull_side_of_meet is to be asked. Errors, of N (|x| + |y| + |z|) + O: the point's 2^-50 is 8, and a term goes
// through the offset's 2 and at most 4 roundings: 14 * 2^-53 = 1.6e-15.
static inline int cull_side_of_position(const cull_row *plane, const double p[3])
{
    const double x = plane->n[0] * p[0], y = plane->n[1] * p[1], z = plane->n[2] * p[2], height = ((x + y) + z) + plane->offset;
    const double error = 2e-15 * (((cull_size(x) + cull_size(y)) + cull_size(z)) + plane->reach);
    return (height > error) - (height < -error);
}

// ---- Directions: radial order round a line ----

static inline cull_wide_vector cull_normals_cross(const cull_wide_plane *a, const cull_wide_plane *b) // n_a x n_b: 101 bits
{
    cull_wide_vector out;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out.v[i] = cull_wide_minor(a->normal[j], b->normal[k], a->normal[k], b->normal[j]);
    }
    return out;
}

static inline int cull_wide_vector_dot_sign(const cull_wide_vector *a, const cull_wide_vector *b) // 204 bits
{
    cull_int256 sum = {{0, 0, 0, 0}};
    for (int i = 0; i < 3; i++) cull_int256_multiply_add(&sum, a->v[i], b->v[i]);
    return cull_int256_sign(&sum);
}

static inline int cull_normals_dot_sign(const cull_wide_plane *a, const cull_wide_plane *b) // 102 bits
{
    cull_wide sum = cull_wide_product(a->normal[0], b->normal[0]);
    for (int i = 1; i < 3; i++) sum = cull_wide_add(sum, cull_wide_product(a->normal[i], b->normal[i]));
    return cull_wide_sign(sum);
}

// For planes through one line of direction `line` (any multiple): 1 when n_b is reached from n_a by a turn of less than half
// a circle, counterclockwise seen against the line; -1 the other way; 0 when they are parallel. n_a x n_b is a multiple of
// the line, so one component that is not zero tells.
static inline int cull_normals_turn(const cull_wide_plane *a, const cull_wide_plane *b, const cull_wide_vector *line)
{
    for (int i = 0; i < 3; i++) {
        const int along = cull_wide_sign(line->v[i]);
        if (!along) continue;
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        return along * cull_wide_sign(cull_wide_minor(a->normal[j], b->normal[k], a->normal[k], b->normal[j]));
    }
    return 0;
}

#endif
