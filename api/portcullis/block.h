// block.h: 16 boxes at once held against planes: the inner loop of a tree over boxes (Wald et al., Getting Rid of Packets, 2008).
// Strict C11, reads as C++17.
// SPDX-License-Identifier: MIT
//
// In vectors where the file that includes this asks for them: it includes <immintrin.h>, and defines CULL_BLOCK_LANES as 16 (AVX-512F) or
// 8 (AVX2 and BMI2), before. Invariant: the answers are the same bit for bit: sums are taken in the order of plane.h, unfused.
#ifndef PORTCULLIS_BLOCK_H
#define PORTCULLIS_BLOCK_H

#include "box.h"
#include "face.h"

#include <math.h>
#include <stdalign.h>

enum {
    CULL_BLOCK_WIDTH = 16,       // boxes
    CULL_BLOCK_FLOATS = 96,      // 16 each of min x, min y, min z, max x, max y, max z; 64-byte aligned
    CULL_BLOCK_FACE_FLOATS = 80, // 16 each of normal x, y, z, offset, doubt: see face.h; 64-byte aligned
};

// A plane made ready for blocks: where in a block the corners stand that lie farthest inside and farthest outside.
typedef struct cull_block_plane {
    float x, y, z;
    float limit; // -offset: comparing a sum with it has the sign of the sum with the offset added, exactly
    uint32_t inner_x, inner_y, inner_z, outer_x, outer_y, outer_z; // floats from the block's start
} cull_block_plane;

// Bit i is of box i.
typedef struct cull_block_split {
    uint32_t touching; // no plane has the box outside
    uint32_t cut;      // some plane has a part of it outside
    alignas(64) uint32_t planes[CULL_BLOCK_WIDTH]; // of each box that touches: the planes that cut it; elsewhere undefined
} cull_block_split;

// ---- Making ready ----

// `count` boxes, at most 16; what is not there touches nothing.
static inline void cull_block_fill(const cull_box *boxes, uint32_t count, float *block)
{
    for (uint32_t i = 0; i < CULL_BLOCK_WIDTH; i++) {
        float row[6] = {INFINITY, INFINITY, INFINITY, -INFINITY, -INFINITY, -INFINITY};
        if (i < count) {
            const cull_box box = boxes[i];
            row[0] = box.min.x, row[1] = box.min.y, row[2] = box.min.z, row[3] = box.max.x, row[4] = box.max.y, row[5] = box.max.z;
        }
        for (uint32_t r = 0; r < 6; r++) block[r * CULL_BLOCK_WIDTH + i] = row[r];
    }
}

// Faces of `count` items of the zone, at most 16: what is not there, and an item whose back counts too, has zeros: never dropped.
static inline void cull_block_fill_faces(const cull_zone *zone, const uint32_t *items, uint32_t count, float *faces)
{
    for (uint32_t i = 0; i < CULL_BLOCK_WIDTH; i++) {
        cull_face face = {{0, 0, 0}, 0, 0};
        if (i < count) face = cull_face_of(zone, items[i]);
        const float row[5] = {face.normal[0], face.normal[1], face.normal[2], face.offset, face.doubt};
        for (uint32_t r = 0; r < 5; r++) faces[r * CULL_BLOCK_WIDTH + i] = row[r];
    }
}

// out: room for the volume's planes.
static inline void cull_block_planes(const cull_volume *volume, cull_block_plane *out)
{
    for (uint32_t k = 0; k < volume->plane_count; k++) {
        const cull_plane p = volume->planes[k];
        const uint32_t x = p.normal.x >= 0 ? 48 : 0, y = p.normal.y >= 0 ? 64 : 16, z = p.normal.z >= 0 ? 80 : 32;
        const cull_block_plane ready = {p.normal.x, p.normal.y, p.normal.z, -p.offset, x, y, z, 48 - x, 80 - y, 112 - z};
        out[k] = ready;
    }
}

// A bit for each plane of the volume.
static inline uint32_t cull_block_all_planes(const cull_volume *volume)
{
    return volume->plane_count ? UINT32_MAX >> (CULL_MAX_PLANES - volume->plane_count) : 0;
}

// The eye's largest coordinate, for cull_block_facing.
static inline float cull_block_reach(const float eye[4])
{
    float most = 0;
    for (int i = 0; i < 3; i++) {
        const float size = eye[i] < 0 ? -eye[i] : eye[i];
        if (size > most) most = size;
    }
    return most;
}

// Of bits that are not 0.
static inline uint32_t cull_lowest_bit(uint32_t bits)
{
#if defined(__GNUC__)
    return (uint32_t)__builtin_ctz(bits);
#else
    uint32_t place = 0;
    while (!(bits >> place & 1)) place++;
    return place;
#endif
}

// ---- Judging: cull_block_touch, cull_block_split_by, cull_block_facing ----
// which: a bit for each plane to judge by. Facing: bit i: the wall may show its front to the eye.

#if defined(CULL_BLOCK_LANES) && CULL_BLOCK_LANES == 16

static inline __m512 cull_block_sum(const float *x, const float *y, const float *z, const cull_block_plane *p)
{
    const __m512 sx = _mm512_mul_ps(_mm512_load_ps(x), _mm512_set1_ps(p->x));
    const __m512 sy = _mm512_mul_ps(_mm512_load_ps(y), _mm512_set1_ps(p->y));
    const __m512 sz = _mm512_mul_ps(_mm512_load_ps(z), _mm512_set1_ps(p->z));
    return _mm512_add_ps(_mm512_add_ps(sx, sy), sz);
}

static inline uint32_t cull_block_touch(const float *block, const cull_block_plane *planes, uint32_t which)
{
    __mmask16 touching = 0xffff;
    for (; which; which &= which - 1) {
        const cull_block_plane *p = &planes[cull_lowest_bit(which)];
        const __m512 sum = cull_block_sum(block + p->inner_x, block + p->inner_y, block + p->inner_z, p);
        touching = _mm512_mask_cmp_ps_mask(touching, sum, _mm512_set1_ps(p->limit), _CMP_GE_OQ);
    }
    return touching;
}

static inline void cull_block_split_by(const float *block, const cull_block_plane *planes, uint32_t which, cull_block_split *out)
{
    __mmask16 touching = 0xffff;
    __m512i cut = _mm512_setzero_si512();
    for (; which; which &= which - 1) {
        const cull_block_plane *p = &planes[cull_lowest_bit(which)];
        const __m512 limit = _mm512_set1_ps(p->limit);
        const __m512 inner = cull_block_sum(block + p->inner_x, block + p->inner_y, block + p->inner_z, p);
        const __m512 outer = cull_block_sum(block + p->outer_x, block + p->outer_y, block + p->outer_z, p);
        touching = _mm512_mask_cmp_ps_mask(touching, inner, limit, _CMP_GE_OQ);
        const __mmask16 is_cut = _mm512_cmp_ps_mask(outer, limit, _CMP_NGE_UQ);
        cut = _mm512_mask_or_epi32(cut, is_cut, cut, _mm512_set1_epi32((int)(which & -which)));
    }
    out->touching = touching;
    out->cut = _mm512_test_epi32_mask(cut, cut);
    _mm512_store_si512(out->planes, cut);
}

static inline uint32_t cull_block_facing(const float *faces, const float eye[4], float reach)
{
    const __m512 x = _mm512_mul_ps(_mm512_load_ps(faces), _mm512_set1_ps(eye[0]));
    const __m512 y = _mm512_mul_ps(_mm512_load_ps(faces + 16), _mm512_set1_ps(eye[1]));
    const __m512 z = _mm512_mul_ps(_mm512_load_ps(faces + 32), _mm512_set1_ps(eye[2]));
    const __m512 offset = _mm512_mul_ps(_mm512_load_ps(faces + 48), _mm512_set1_ps(eye[3]));
    const __m512 doubt = _mm512_mul_ps(_mm512_load_ps(faces + 64), _mm512_set1_ps(reach));
    const __m512 sum = _mm512_add_ps(_mm512_add_ps(_mm512_add_ps(x, y), z), _mm512_add_ps(offset, doubt));
    return _mm512_cmp_ps_mask(sum, _mm512_setzero_ps(), _CMP_GE_OQ);
}

#elif defined(CULL_BLOCK_LANES) && CULL_BLOCK_LANES == 8

static inline __m256 cull_block_within(const float *x, const float *y, const float *z, const cull_block_plane *p)
{
    const __m256 sx = _mm256_mul_ps(_mm256_load_ps(x), _mm256_set1_ps(p->x));
    const __m256 sy = _mm256_mul_ps(_mm256_load_ps(y), _mm256_set1_ps(p->y));
    const __m256 sz = _mm256_mul_ps(_mm256_load_ps(z), _mm256_set1_ps(p->z));
    const __m256 sum = _mm256_add_ps(_mm256_add_ps(sx, sy), sz);
    return _mm256_cmp_ps(sum, _mm256_set1_ps(p->limit), _CMP_GE_OQ);
}

static inline uint32_t cull_block_bits(__m256 low, __m256 high)
{
    return (uint32_t)_mm256_movemask_ps(low) | (uint32_t)_mm256_movemask_ps(high) << 8;
}

static inline uint32_t cull_block_touch(const float *block, const cull_block_plane *planes, uint32_t which)
{
    __m256 low = _mm256_castsi256_ps(_mm256_set1_epi32(-1)), high = low;
    for (; which; which &= which - 1) {
        const cull_block_plane *p = &planes[cull_lowest_bit(which)];
        const float *x = block + p->inner_x, *y = block + p->inner_y, *z = block + p->inner_z;
        low = _mm256_and_ps(low, cull_block_within(x, y, z, p));
        high = _mm256_and_ps(high, cull_block_within(x + 8, y + 8, z + 8, p));
    }
    return cull_block_bits(low, high);
}

static inline void cull_block_split_by(const float *block, const cull_block_plane *planes, uint32_t which, cull_block_split *out)
{
    __m256i cut_low = _mm256_setzero_si256(), cut_high = cut_low;
    out->touching = cull_block_touch(block, planes, which);
    for (; which; which &= which - 1) {
        const cull_block_plane *p = &planes[cull_lowest_bit(which)];
        const __m256i plane_bit = _mm256_set1_epi32((int)(which & -which));
        const float *x = block + p->outer_x, *y = block + p->outer_y, *z = block + p->outer_z;
        cut_low = _mm256_or_si256(cut_low, _mm256_andnot_si256(_mm256_castps_si256(cull_block_within(x, y, z, p)), plane_bit));
        cut_high = _mm256_or_si256(cut_high, _mm256_andnot_si256(_mm256_castps_si256(cull_block_within(x + 8, y + 8, z + 8, p)), plane_bit));
    }
    _mm256_store_si256((__m256i *)(void *)out->planes, cut_low);
    _mm256_store_si256((__m256i *)(void *)(out->planes + 8), cut_high);
    const __m256i zero = _mm256_setzero_si256();
    out->cut = 0xffffu ^ cull_block_bits(_mm256_castsi256_ps(_mm256_cmpeq_epi32(cut_low, zero)),
                                         _mm256_castsi256_ps(_mm256_cmpeq_epi32(cut_high, zero)));
}

static inline __m256 cull_block_facing8(const float *f, const float eye[4], float reach)
{
    const __m256 x = _mm256_mul_ps(_mm256_load_ps(f), _mm256_set1_ps(eye[0]));
    const __m256 y = _mm256_mul_ps(_mm256_load_ps(f + 16), _mm256_set1_ps(eye[1]));
    const __m256 z = _mm256_mul_ps(_mm256_load_ps(f + 32), _mm256_set1_ps(eye[2]));
    const __m256 offset = _mm256_mul_ps(_mm256_load_ps(f + 48), _mm256_set1_ps(eye[3]));
    const __m256 doubt = _mm256_mul_ps(_mm256_load_ps(f + 64), _mm256_set1_ps(reach));
    const __m256 sum = _mm256_add_ps(_mm256_add_ps(_mm256_add_ps(x, y), z), _mm256_add_ps(offset, doubt));
    return _mm256_cmp_ps(sum, _mm256_setzero_ps(), _CMP_GE_OQ);
}

static inline uint32_t cull_block_facing(const float *faces, const float eye[4], float reach)
{
    return cull_block_bits(cull_block_facing8(faces, eye, reach), cull_block_facing8(faces + 8, eye, reach));
}

// The numbers of the set bits of a byte: the bytes 0 .. 7 that stand where a bit is set, moved together.
static inline __m256i cull_block_numbers8(uint32_t bits)
{
    const uint64_t picked = _pext_u64(UINT64_C(0x0706050403020100), _pdep_u64(bits, UINT64_C(0x0101010101010101)) * 255);
    return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)picked));
}

#else

// The least height of 16 corners over the planes: minima become vectors in any compiler. A difference of floats has the
// exact sign.
static inline void cull_block_lower(const float *x, const float *y, const float *z, const cull_block_plane *p, float *least)
{
    for (int i = 0; i < CULL_BLOCK_WIDTH; i++) {
        const float height = (x[i] * p->x + y[i] * p->y) + z[i] * p->z - p->limit;
        least[i] = height < least[i] ? height : least[i];
    }
}

static inline uint32_t cull_block_inside(const float *least)
{
    uint32_t bits = 0;
    for (int i = 0; i < CULL_BLOCK_WIDTH; i++) bits |= least[i] >= 0 ? 1u << i : 0;
    return bits;
}

static inline uint32_t cull_block_touch(const float *block, const cull_block_plane *planes, uint32_t which)
{
    float least[CULL_BLOCK_WIDTH] = {0};
    for (; which; which &= which - 1) {
        const cull_block_plane *p = &planes[cull_lowest_bit(which)];
        cull_block_lower(block + p->inner_x, block + p->inner_y, block + p->inner_z, p, least);
    }
    return cull_block_inside(least);
}

static inline void cull_block_split_by(const float *block, const cull_block_plane *planes, uint32_t which, cull_block_split *out)
{
    out->touching = cull_block_touch(block, planes, which);
    out->cut = 0;
    for (int i = 0; i < CULL_BLOCK_WIDTH; i++) out->planes[i] = 0;
    for (; which; which &= which - 1) {
        const cull_block_plane *p = &planes[cull_lowest_bit(which)];
        const uint32_t plane_bit = which & -which;
        float least[CULL_BLOCK_WIDTH] = {0};
        cull_block_lower(block + p->outer_x, block + p->outer_y, block + p->outer_z, p, least);
        for (int i = 0; i < CULL_BLOCK_WIDTH; i++) out->planes[i] |= least[i] >= 0 ? 0 : plane_bit;
        out->cut |= 0xffffu ^ cull_block_inside(least);
    }
}

static inline uint32_t cull_block_facing(const float *faces, const float eye[4], float reach)
{
    uint32_t bits = 0;
    for (int i = 0; i < CULL_BLOCK_WIDTH; i++) {
        const float *f = faces + i;
        const float height = (f[0] * eye[0] + f[16] * eye[1]) + f[32] * eye[2];
        bits |= (height + (f[48] * eye[3] + f[64] * reach) >= 0 ? 1u : 0u) << i;
    }
    return bits;
}

#endif

#endif
