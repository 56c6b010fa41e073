// Blocks judged by planes: <portcullis/block.h>'s way, or in vectors of four where the source file asks for no wider ones and the baseline
// has SSE2 (all of x86-64): a compiler takes apart what plain C gathers into bits.
// SPDX-License-Identifier: MIT
// Invariant: sums and comparisons are those of the wider kernels in block.h, in their order, unfused.

#if defined(__SSE2__) && !defined(CULL_BLOCK_LANES)
#include <emmintrin.h>

enum { JUDGE_LANES = 4, JUDGE_PARTS = CULL_BLOCK_WIDTH / JUDGE_LANES };

// Where four corners stand on the plane's inner side: all bits, elsewhere none.
static inline __m128 judge_within(const float *x, const float *y, const float *z, const cull_block_plane *p)
{
    const __m128 sx = _mm_mul_ps(_mm_load_ps(x), _mm_set1_ps(p->x));
    const __m128 sy = _mm_mul_ps(_mm_load_ps(y), _mm_set1_ps(p->y));
    const __m128 sz = _mm_mul_ps(_mm_load_ps(z), _mm_set1_ps(p->z));
    return _mm_cmpge_ps(_mm_add_ps(_mm_add_ps(sx, sy), sz), _mm_set1_ps(p->limit));
}

static inline uint32_t judge_bits(const __m128i *all)
{
    return (uint32_t)_mm_movemask_epi8(_mm_packs_epi16(_mm_packs_epi32(all[0], all[1]), _mm_packs_epi32(all[2], all[3])));
}

static inline uint32_t judge_touch(const float *block, const cull_block_plane *planes, uint32_t which)
{
    __m128i touching[JUDGE_PARTS];
    for (int i = 0; i < JUDGE_PARTS; i++) touching[i] = _mm_set1_epi32(-1);
    for (; which; which &= which - 1) {
        const cull_block_plane *p = &planes[cull_lowest_bit(which)];
        const float *x = block + p->inner_x, *y = block + p->inner_y, *z = block + p->inner_z;
        for (int i = 0; i < JUDGE_PARTS; i++)
            touching[i] = _mm_and_si128(touching[i], _mm_castps_si128(judge_within(x + JUDGE_LANES * i, y + JUDGE_LANES * i, z + JUDGE_LANES * i, p)));
    }
    return judge_bits(touching);
}

static inline void judge_split(const float *block, const cull_block_plane *planes, uint32_t which, cull_block_split *out)
{
    __m128i cut[JUDGE_PARTS], uncut[JUDGE_PARTS];
    for (int i = 0; i < JUDGE_PARTS; i++) cut[i] = _mm_setzero_si128();
    for (uint32_t rest = which; rest; rest &= rest - 1) {
        const cull_block_plane *p = &planes[cull_lowest_bit(rest)];
        const float *x = block + p->outer_x, *y = block + p->outer_y, *z = block + p->outer_z;
        const __m128i plane_bit = _mm_set1_epi32((int)(rest & -rest));
        for (int i = 0; i < JUDGE_PARTS; i++) {
            const __m128 within = judge_within(x + JUDGE_LANES * i, y + JUDGE_LANES * i, z + JUDGE_LANES * i, p);
            cut[i] = _mm_or_si128(cut[i], _mm_andnot_si128(_mm_castps_si128(within), plane_bit));
        }
    }
    for (int i = 0; i < JUDGE_PARTS; i++) {
        _mm_store_si128((__m128i *)(void *)(out->planes + JUDGE_LANES * i), cut[i]);
        uncut[i] = _mm_cmpeq_epi32(cut[i], _mm_setzero_si128());
    }
    out->touching = judge_touch(block, planes, which);
    out->cut = 0xffffu ^ judge_bits(uncut);
}

#else

static inline uint32_t judge_touch(const float *block, const cull_block_plane *planes, uint32_t which)
{
    return cull_block_touch(block, planes, which);
}

static inline void judge_split(const float *block, const cull_block_plane *planes, uint32_t which, cull_block_split *out)
{
    cull_block_split_by(block, planes, which, out);
}

#endif
