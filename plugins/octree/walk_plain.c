// The kernels in plain C: what the compiler makes of the baseline.
// SPDX-License-Identifier: MIT
#include "walk.h"

static inline void bottom_rows(const index_bottom *b, float rows[CULL_BLOCK_FLOATS])
{
    for (int row = 0; row < 6; row++)
        for (int i = 0; i < CULL_BLOCK_WIDTH; i++) {
            const float along = b->step[row % 3] * (float)b->steps[row * CULL_BLOCK_WIDTH + i];
            rows[row * CULL_BLOCK_WIDTH + i] = b->origin[row % 3] + along;
        }
}

static inline void bottom_split(const index_bottom *b, const cull_block_plane *planes, uint32_t which, cull_block_split *out)
{
    float rows[CULL_BLOCK_FLOATS];
    uint8_t is_out[CULL_BLOCK_WIDTH];
    bottom_rows(b, rows);
    out->touching = out->cut = 0;
    for (int i = 0; i < CULL_BLOCK_WIDTH; i++) {
        is_out[i] = 0;
        out->planes[i] = 0;
    }
    for (; which; which &= which - 1) {
        const cull_block_plane *p = &planes[cull_lowest_bit(which)];
        const float *x = rows + p->inner_x, *y = rows + p->inner_y, *z = rows + p->inner_z;
        const float *u = rows + p->outer_x, *v = rows + p->outer_y, *w = rows + p->outer_z;
        for (int i = 0; i < CULL_BLOCK_WIDTH; i++) {
            is_out[i] |= (x[i] * p->x + y[i] * p->y) + z[i] * p->z < p->limit;
            out->planes[i] |= (u[i] * p->x + v[i] * p->y) + w[i] * p->z >= p->limit ? 0 : which & -which;
        }
    }
    for (uint32_t i = 0; i < CULL_BLOCK_WIDTH; i++) {
        out->touching |= (is_out[i] ? 0u : 1u) << i;
        out->cut |= (out->planes[i] ? 1u : 0u) << i;
    }
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
    for (uint32_t i = 0; i < CULL_BLOCK_WIDTH; i++) out |= (bits >> (order >> 4 * i & 15) & 1) << i;
    return out;
}

#include "walk_body.h"
#include "walk_many_body.h"

const walk_kernel walk_plain = {"plain", walk_any};
