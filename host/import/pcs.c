// The scene file's layout: section names and sizes, offsets, hash.
// SPDX-License-Identifier: MIT
#include "pcs.h"

#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#define PCS_SIZE_HOLDS(name, item, bytes) _Static_assert(sizeof(item) == (bytes), #item " changed its size: make a new PCS_VERSION");
PCS_SECTIONS(PCS_SIZE_HOLDS)
#undef PCS_SIZE_HOLDS
_Static_assert(sizeof(pcs_header) == PCS_ALIGN && sizeof(pcs_section) == 32, "the header has no padding");

const uint32_t pcs_item_bytes[PCS_SECTION_COUNT] = {
#define PCS_BYTES(name, item, bytes) bytes,
    PCS_SECTIONS(PCS_BYTES)
#undef PCS_BYTES
};

const char *const pcs_section_names[PCS_SECTION_COUNT] = {
#define PCS_NAME(name, item, bytes) #name,
    PCS_SECTIONS(PCS_NAME)
#undef PCS_NAME
};

static uint64_t round_up(uint64_t at)
{
    return (at + PCS_ALIGN - 1) / PCS_ALIGN * PCS_ALIGN;
}

uint64_t pcs_lay_out(const pcs_counts *counts, uint64_t offsets[PCS_SECTION_COUNT])
{
    uint64_t at = round_up(sizeof(pcs_header) + PCS_SECTION_COUNT * sizeof(pcs_section));
    for (int i = 0; i < PCS_SECTION_COUNT; ++i) {
        offsets[i] = at;
        if (counts->of[i] > PCS_BYTES_MOST / pcs_item_bytes[i]) return 0;
        at = round_up(at + counts->of[i] * pcs_item_bytes[i]);
        if (at > PCS_BYTES_MOST || at >= SIZE_MAX / 2) return 0;
    }
    return at;
}

uint64_t pcs_hash(const void *file, uint64_t size)
{
    pcs_header head;
    memcpy(&head, file, sizeof head);
    head.hash = 0;
    return XXH3_64bits_withSeed((const char *)file + sizeof head, (size_t)size - sizeof head, XXH3_64bits(&head, sizeof head));
}
