// The loop of `brute` in plain C: what the compiler makes of the baseline.
// SPDX-License-Identifier: MIT
#include "builtin_brute.h"

// The least height over the planes: minima become vectors in any compiler. A difference of floats has the exact sign.
static inline uint32_t test16(const brute_plane *planes, uint32_t plane_count, uint32_t i)
{
    float least[16] = {0};
    for (uint32_t k = 0; k < plane_count; k++) {
        const brute_plane *p = &planes[k];
        const float *x = p->x + i, *y = p->y + i, *z = p->z + i;
        for (int b = 0; b < 16; b++) {
            const float height = (x[b] * p->normal_x + y[b] * p->normal_y) + z[b] * p->normal_z - p->limit;
            least[b] = height < least[b] ? height : least[b];
        }
    }
    uint32_t bits = 0;
    for (int b = 0; b < 16; b++) bits |= least[b] >= 0 ? UINT32_C(1) << b : 0;
    return bits;
}

static inline uint32_t *put64(uint64_t bits, uint32_t base, uint32_t *out)
{
    for (; bits; bits &= bits - 1) *out++ = base + (uint32_t)__builtin_ctzll(bits);
    return out;
}

#include "builtin_brute_body.h"

uint32_t brute_plain(const brute_job *job, cull_run *runs)
{
    return brute_run(job, runs);
}
