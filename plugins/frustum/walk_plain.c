// The kernels in plain C: what the compiler makes of the baseline.
// SPDX-License-Identifier: MIT
#include "walk_plane.h"

static inline uint32_t block_touch(const float *block, const walk_plane *planes, uint32_t which)
{
    uint32_t inside[INDEX_WIDTH];
    for (int i = 0; i < INDEX_WIDTH; i++) inside[i] = 1u << i;
    for (; which; which &= which - 1) {
        const walk_plane *p = &planes[__builtin_ctz(which)];
        const float *x = block + p->inner_x, *y = block + p->inner_y, *z = block + p->inner_z;
        for (int i = 0; i < INDEX_WIDTH; i++) inside[i] = (x[i] * p->x + y[i] * p->y) + z[i] * p->z >= p->limit ? inside[i] : 0;
    }
    uint32_t bits = 0;
    for (int i = 0; i < INDEX_WIDTH; i++) bits |= inside[i];
    return bits;
}

static inline void block_split(const float *block, const walk_plane *planes, uint32_t which, walk_split *out)
{
    for (int i = 0; i < INDEX_WIDTH; i++) out->planes[i] = 0;
    out->touching = block_touch(block, planes, which);
    for (; which; which &= which - 1) {
        const walk_plane *p = &planes[__builtin_ctz(which)];
        const uint32_t plane_bit = which & -which;
        const float *x = block + p->outer_x, *y = block + p->outer_y, *z = block + p->outer_z;
        for (int i = 0; i < INDEX_WIDTH; i++)
            out->planes[i] |= (x[i] * p->x + y[i] * p->y) + z[i] * p->z >= p->limit ? 0 : plane_bit;
    }
    out->cut = 0;
    for (int i = 0; i < INDEX_WIDTH; i++) out->cut |= out->planes[i] ? 1u << i : 0;
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

static inline uint32_t *put16(uint32_t bits, uint32_t base, uint32_t shift, uint32_t *out)
{
    for (; bits; bits &= bits - 1) *out++ = base + ((uint32_t)__builtin_ctz(bits) << shift);
    return out;
}

#include "walk_body.h"

const walk_kernel walk_plain = {"plain", walk_volume, walk_facing};
