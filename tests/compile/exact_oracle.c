// Hard planes and GMP's word on them: see exact_oracle.h.
// SPDX-License-Identifier: MIT
#include "exact_oracle.h"

#include "tests/common/random.h"

#include <gmp.h>

// ---- Planes ----

const char *family_name(plane_family f)
{
    static const char *const names[FAMILY_COUNT] = {"random", "small", "one point", "combination", "off by one", "largest"};
    return names[f];
}

void random_point(uint64_t *seed, int32_t most, int32_t out[3])
{
    for (int i = 0; i < 3; ++i) out[i] = (int32_t)random_below(seed, 2 * (uint32_t)most + 1) - most;
}

static void corner_point(uint64_t *seed, int32_t out[3])
{
    for (int i = 0; i < 3; ++i) {
        const int32_t within = CULL_GRID_MOST - (int32_t)(random_below(seed, 4) == 0);
        out[i] = random_below(seed, 2) ? within : -within;
    }
}

static cull_wide_plane plane_near(uint64_t *seed, int32_t most)
{
    cull_wide_plane p;
    int32_t a[3], b[3], c[3];
    do {
        random_point(seed, most, a);
        random_point(seed, most, b);
        random_point(seed, most, c);
    } while (!cull_wide_plane_through(a, b, c, &p));
    return p;
}

static void planes_through_point(uint64_t *seed, cull_wide_plane out[4])
{
    const int32_t most = random_below(seed, 2) ? CULL_GRID_MOST : 2000000;
    int32_t p[3], a[3], b[3];
    random_point(seed, most, p);
    for (int i = 0; i < 4; ++i) do {
            random_point(seed, most, a);
            random_point(seed, most, b);
        } while (!cull_wide_plane_through(p, a, b, &out[i]));
}

static void planes_combined(uint64_t *seed, cull_wide_plane out[4])
{
    const int32_t most = 1 << (6 + random_below(seed, 8)); // normals to 28 bits, offsets to 41
    for (int i = 0; i < 3; ++i) out[i] = plane_near(seed, most);
    out[3] = (cull_wide_plane){{0, 0, 0}, {0, 0}};
    while (!out[3].normal[0] && !out[3].normal[1] && !out[3].normal[2]) {
        out[3].offset = cull_wide_from(0);
        for (int i = 0; i < 3; ++i) {
            const int64_t times = (int64_t)random_below(seed, 1u << 20) - (1 << 19);
            for (int k = 0; k < 3; ++k) out[3].normal[k] += times * out[i].normal[k];
            out[3].offset = cull_wide_add(out[3].offset, cull_wide_scale(out[i].offset, times));
        }
    }
}

static void planes_at_corners(uint64_t *seed, cull_wide_plane out[4])
{
    int32_t a[3], b[3], c[3];
    for (int i = 0; i < 4; ++i) do {
            corner_point(seed, a);
            corner_point(seed, b);
            corner_point(seed, c);
        } while (!cull_wide_plane_through(a, b, c, &out[i]));
}

void family_planes(plane_family f, uint64_t *seed, cull_wide_plane out[4])
{
    switch (f) {
    case FAMILY_RANDOM:
        for (int i = 0; i < 4; ++i) out[i] = plane_near(seed, CULL_GRID_MOST);
        break;
    case FAMILY_SMALL:
        for (int i = 0; i < 4; ++i) out[i] = plane_near(seed, 1 + (int32_t)random_below(seed, 64));
        break;
    case FAMILY_ONE_POINT: planes_through_point(seed, out); break;
    case FAMILY_COMBINATION: planes_combined(seed, out); break;
    case FAMILY_OFF_BY_ONE:
        if (random_below(seed, 2)) planes_combined(seed, out);
        else planes_through_point(seed, out);
        out[3].offset = cull_wide_add(out[3].offset, cull_wide_from(random_below(seed, 2) ? 1 : -1));
        break;
    case FAMILY_LARGEST: planes_at_corners(seed, out); break;
    case FAMILY_COUNT: break;
    }
}

// ---- GMP ----

static void set_wide(mpz_t out, cull_wide v)
{
    const cull_wide size = cull_wide_magnitude(v);
    mpz_set_ui(out, size.high);
    mpz_mul_2exp(out, out, 64);
    mpz_add_ui(out, out, size.low);
    if (cull_wide_sign(v) < 0) mpz_neg(out, out);
}

typedef struct matrix { mpz_t at[4][4]; } matrix; // rows: normal, offset

static void matrix_make(matrix *m, const cull_wide_plane *p, int count)
{
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) mpz_init(m->at[i][k]);
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) mpz_set_si(m->at[i][k], p[i].normal[k]);
        set_wide(m->at[i][3], p[i].offset);
    }
}

static void matrix_free(matrix *m)
{
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) mpz_clear(m->at[i][k]);
}

// Expanded by the last row: nothing in common with the way that exact.h goes.
static void determinant_3(mpz_t out, matrix *m, const int rows[3], const int columns[3])
{
    mpz_t part, other;
    mpz_inits(part, other, NULL);
    mpz_set_ui(out, 0);
    for (int k = 0; k < 3; ++k) {
        const int c = columns[(k + 1) % 3], d = columns[(k + 2) % 3];
        mpz_mul(part, m->at[rows[0]][c], m->at[rows[1]][d]);
        mpz_mul(other, m->at[rows[0]][d], m->at[rows[1]][c]);
        mpz_sub(part, part, other);
        mpz_addmul(out, part, m->at[rows[2]][columns[k]]);
    }
    mpz_clears(part, other, NULL);
}

static const int FIRST_THREE[3] = {0, 1, 2};

int gmp_four_sign(const cull_wide_plane p[4])
{
    static const int columns[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
    matrix m;
    mpz_t sum, minor;
    matrix_make(&m, p, 4);
    mpz_inits(sum, minor, NULL);
    for (int k = 0; k < 4; ++k) {
        determinant_3(minor, &m, FIRST_THREE, columns[k]);
        if (k % 2) mpz_addmul(sum, minor, m.at[3][k]);
        else mpz_submul(sum, minor, m.at[3][k]);
    }
    const int sign = mpz_sgn(sum);
    mpz_clears(sum, minor, NULL);
    matrix_free(&m);
    return sign;
}

int gmp_normals_sign(const cull_wide_plane p[3])
{
    matrix m;
    mpz_t w;
    matrix_make(&m, p, 3);
    mpz_init(w);
    determinant_3(w, &m, FIRST_THREE, FIRST_THREE);
    const int sign = mpz_sgn(w);
    mpz_clear(w);
    matrix_free(&m);
    return sign;
}

int gmp_side_of_point(const cull_wide_plane *p, const int32_t point[3])
{
    mpz_t sum, n;
    mpz_inits(sum, n, NULL);
    set_wide(sum, p->offset);
    for (int k = 0; k < 3; ++k) {
        mpz_set_si(n, p->normal[k]);
        mpz_mul_si(n, n, point[k]);
        mpz_add(sum, sum, n);
    }
    const int sign = mpz_sgn(sum);
    mpz_clears(sum, n, NULL);
    return sign;
}

// Cramer's rule as fractions. 0: no such point.
static int point_of(const cull_wide_plane p[3], mpq_t out[3])
{
    static const int columns[3][3] = {{3, 1, 2}, {0, 3, 2}, {0, 1, 3}};
    matrix m;
    mpz_t w;
    matrix_make(&m, p, 3);
    mpz_init(w);
    determinant_3(w, &m, FIRST_THREE, FIRST_THREE);
    const int found = mpz_sgn(w) != 0;
    for (int k = 0; k < 3 && found; ++k) {
        determinant_3(mpq_numref(out[k]), &m, FIRST_THREE, columns[k]);
        mpz_neg(mpq_numref(out[k]), mpq_numref(out[k]));
        mpz_set(mpq_denref(out[k]), w);
        mpq_canonicalize(out[k]);
    }
    mpz_clear(w);
    matrix_free(&m);
    return found;
}

static void points_make(mpq_t p[3])
{
    for (int k = 0; k < 3; ++k) mpq_init(p[k]);
}

static void points_free(mpq_t p[3])
{
    for (int k = 0; k < 3; ++k) mpq_clear(p[k]);
}

int gmp_order_along(const cull_wide_plane p[4])
{
    const cull_wide_plane other[3] = {p[0], p[1], p[3]};
    const cull_wide_vector line = cull_normals_cross(&p[0], &p[1]);
    mpq_t a[3], b[3], along, sum;
    points_make(a);
    points_make(b);
    mpq_inits(along, sum, NULL);
    int sign = 0;
    if (point_of(p, a) && point_of(other, b)) {
        for (int k = 0; k < 3; ++k) {
            set_wide(mpq_numref(along), line.v[k]);
            mpz_set_ui(mpq_denref(along), 1);
            mpq_sub(a[k], a[k], b[k]);
            mpq_mul(a[k], a[k], along);
            mpq_add(sum, sum, a[k]);
        }
        sign = mpq_sgn(sum);
    }
    mpq_clears(along, sum, NULL);
    points_free(a);
    points_free(b);
    return sign;
}

int gmp_position_is_near(const cull_wide_plane p[3], const double position[3], double error)
{
    mpq_t a[3], off, room;
    points_make(a);
    mpq_inits(off, room, NULL);
    int near = point_of(p, a);
    for (int k = 0; k < 3 && near; ++k) {
        mpq_set_d(off, position[k]);
        mpq_sub(off, off, a[k]);
        mpq_abs(off, off);
        mpq_set_d(room, error);
        mpq_abs(a[k], a[k]);
        mpq_mul(room, room, a[k]);
        near = mpq_cmp(off, room) <= 0;
    }
    mpq_clears(off, room, NULL);
    points_free(a);
    return near;
}

int gmp_crosses_dot_sign(const cull_wide_plane p[4])
{
    matrix m;
    mpz_t sum, one, two, part;
    matrix_make(&m, p, 4);
    mpz_inits(sum, one, two, part, NULL);
    for (int k = 0; k < 3; ++k) {
        const int c = (k + 1) % 3, d = (k + 2) % 3;
        for (int pair = 0; pair < 2; ++pair) {
            mpz_t *const out = pair ? &two : &one;
            mpz_mul(*out, m.at[2 * pair][c], m.at[2 * pair + 1][d]);
            mpz_submul(*out, m.at[2 * pair][d], m.at[2 * pair + 1][c]);
        }
        mpz_addmul(sum, one, two);
    }
    const int sign = mpz_sgn(sum);
    mpz_clears(sum, one, two, part, NULL);
    matrix_free(&m);
    return sign;
}
