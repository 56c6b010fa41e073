// The loop of `brute`, included by one source file per instruction set.
// SPDX-License-Identifier: MIT
// That file defines before:
//   uint32_t test16(const brute_plane *, uint32_t plane_count, uint32_t i)  bit b: box i + b touches all the planes
//   uint32_t *put64(uint64_t bits, uint32_t base, uint32_t *out)            base + b for each set bit, may scribble 16 more
// Invariant: the stream of places where visibility changes, taken in pairs, is the list of runs as (first, end).

enum { CHUNK_WORDS = 16, CHUNK_ITEMS = CHUNK_WORDS * 64 }; // a chunk's runs are finished while they are in the first cache

static uint32_t planes_ready(const cull_volume *volume, const cull_boxes *boxes, brute_plane *out)
{
    for (uint32_t k = 0; k < volume->plane_count; k++) {
        const cull_plane p = volume->planes[k];
        out[k] = (brute_plane){
            .x = p.normal.x >= 0 ? boxes->max_x : boxes->min_x,
            .y = p.normal.y >= 0 ? boxes->max_y : boxes->min_y,
            .z = p.normal.z >= 0 ? boxes->max_z : boxes->min_z,
            .normal_x = p.normal.x,
            .normal_y = p.normal.y,
            .normal_z = p.normal.z,
            .limit = -p.offset,
        };
    }
    return volume->plane_count;
}

// plane_count is a constant at each place of call below, so the loop over planes is unrolled.
static inline void test_chunk(const brute_plane *planes, uint32_t plane_count, uint32_t first, uint32_t count, uint64_t *words)
{
    const uint32_t blocks = (count + 15) / 16;
    uint32_t b = 0;
    for (; b + 4 <= blocks; b += 4) {
        const uint32_t i = first + 16 * b;
        words[b / 4] |= (uint64_t)test16(planes, plane_count, i) | (uint64_t)test16(planes, plane_count, i + 16) << 16 |
                        (uint64_t)test16(planes, plane_count, i + 32) << 32 | (uint64_t)test16(planes, plane_count, i + 48) << 48;
    }
    for (; b < blocks; b++) words[b / 4] |= (uint64_t)test16(planes, plane_count, first + 16 * b) << (16 * (b % 4));
    if (count % 64) words[count / 64] &= (UINT64_C(1) << count % 64) - 1;
}

static void test_chunk_of(const brute_plane *planes, uint32_t plane_count, uint32_t first, uint32_t count, uint64_t *words)
{
    switch (plane_count) {
    case 3: test_chunk(planes, 3, first, count, words); break;
    case 4: test_chunk(planes, 4, first, count, words); break;
    case 5: test_chunk(planes, 5, first, count, words); break;
    case 6: test_chunk(planes, 6, first, count, words); break;
    default: test_chunk(planes, plane_count, first, count, words); break;
    }
}

// [*done, whole pairs up to end): (first, end) becomes (first, count).
static uint32_t *ends_to_counts(uint32_t *done, const uint32_t *end)
{
    const size_t pairs = (size_t)(end - done) / 2;
    for (size_t i = 0; i < pairs; i++) done[2 * i + 1] -= done[2 * i];
    return done + 2 * pairs;
}

static uint32_t brute_run(const brute_job *job, cull_run *runs)
{
    uint32_t *const start = &runs[0].first;
    uint32_t *out = start, *done = start;
    brute_plane planes[CULL_MAX_PLANES];
    uint32_t plane_count = 0;
    uint64_t open = 0;
    for (uint32_t first = 0; first < job->item_count;) {
        const uint32_t left = job->item_count - first, count = left < CHUNK_ITEMS ? left : CHUNK_ITEMS;
        uint64_t words[CHUNK_WORDS] = {0};
        for (uint32_t v = 0; v < job->volume_count; v++) {
            if (first == 0 || job->volume_count > 1) plane_count = planes_ready(&job->volumes[v], &job->boxes, planes);
            test_chunk_of(planes, plane_count, first, count, words);
        }
        for (uint32_t w = 0; w < (count + 63) / 64; w++) {
            const uint64_t changes = words[w] ^ (words[w] << 1 | open);
            open = words[w] >> 63;
            if (changes) out = put64(changes, first + 64 * w, out);
        }
        done = ends_to_counts(done, out);
        first += count; // at most item_count: no overflow
    }
    if ((out - start) % 2) *out++ = job->item_count;
    ends_to_counts(done, out);
    return (uint32_t)((out - start) / 2);
}
