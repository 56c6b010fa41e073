// The kernels in plain C: what the compiler makes of the baseline.
// SPDX-License-Identifier: MIT
#include "walk_plane.h"

// The least height of 16 corners over the planes: minima become vectors in any compiler. A difference of floats has the
// exact sign.
static inline void lower_to(const float *x, const float *y, const float *z, const walk_plane *p, float *least)
{
    for (int i = 0; i < INDEX_WIDTH; i++) {
        const float height = (x[i] * p->x + y[i] * p->y) + z[i] * p->z - p->limit;
        least[i] = height < least[i] ? height : least[i];
    }
}

static inline uint32_t bits_inside(const float *least)
{
    uint32_t bits = 0;
    for (int i = 0; i < INDEX_WIDTH; i++) bits |= least[i] >= 0 ? 1u << i : 0;
    return bits;
}

static inline uint32_t block_touch(const float *block, const walk_plane *planes, uint32_t which)
{
    float least[INDEX_WIDTH] = {0};
    for (; which; which &= which - 1) {
        const walk_plane *p = &planes[__builtin_ctz(which)];
        lower_to(block + p->inner_x, block + p->inner_y, block + p->inner_z, p, least);
    }
    return bits_inside(least);
}

static inline void block_split(const float *block, const walk_plane *planes, uint32_t which, walk_split *out)
{
    out->touching = block_touch(block, planes, which);
    out->cut = 0;
    for (int i = 0; i < INDEX_WIDTH; i++) out->planes[i] = 0;
    for (; which; which &= which - 1) {
        const walk_plane *p = &planes[__builtin_ctz(which)];
        const uint32_t plane_bit = which & -which;
        float least[INDEX_WIDTH] = {0};
        lower_to(block + p->outer_x, block + p->outer_y, block + p->outer_z, p, least);
        for (int i = 0; i < INDEX_WIDTH; i++) out->planes[i] |= least[i] >= 0 ? 0 : plane_bit;
        out->cut |= 0xffffu ^ bits_inside(least);
    }
}

static inline uint32_t block_facing(const float *faces, const float eye[4], float reach)
{
    uint32_t bits = 0;
    for (int i = 0; i < INDEX_WIDTH; i++) {
        const float *f = faces + i;
        const float height = (f[0] * eye[0] + f[16] * eye[1]) + f[32] * eye[2];
        bits |= (height + (f[48] * eye[3] + f[64] * reach) >= 0 ? 1u : 0u) << i;
    }
    return bits;
}

static inline uint32_t *put_places(uint32_t bits, uint32_t base, uint32_t *out)
{
    for (; bits; bits &= bits - 1) *out++ = base + (uint32_t)__builtin_ctz(bits);
    return out;
}

static inline uint32_t *put_firsts(uint32_t bits, const uint32_t *firsts, uint32_t *out)
{
    for (; bits; bits &= bits - 1) *out++ = firsts[__builtin_ctz(bits)];
    return out;
}

static inline uint32_t reorder(uint32_t bits, uint64_t order)
{
    uint32_t out = 0;
    for (uint32_t i = 0; i < INDEX_WIDTH; i++) out |= (bits >> (order >> 4 * i & 15) & 1) << i;
    return out;
}

#include "walk_body.h"
#include "walk_many_body.h"

const walk_kernel walk_plain = {"plain", walk_any};
