// Fuzz target: baked indices of frustum, octree and bsp: any bytes, and edits of sound blobs, signed anew. What is taken must be
// an index that saves as the same bytes, and no memory may be left behind.
// SPDX-License-Identifier: MIT
#include "plugins/bsp/tree.h"
#include "plugins/frustum/index.h"
#include "plugins/octree/cells.h"
#include "tests/common/culler_host.h"
#include "tests/common/hand_zone.h"
#include "tests/fuzz_driver.h"

#include <stdlib.h>
#include <string.h>

const char *const fuzz_seeds[] = {
    // which culler's, uncut; then edits of 5 bytes
    "0", "1", "2", "3\x01\x20\x02\x03\x01", "4\x01\x40\x01\x81\x01\x01\x60\x01\x7f\x01", "5\x01\x50\x02\x01\x01", "2\x02\x10\x04\x03\x01\x02\x80\x01\x81\x01",
    "\x81zzzz", "\x40" "frustum1", NULL,
};
const char *const fuzz_files[] = {NULL};

enum { EDIT_BYTES = 5, EDITS_MOST = 8, BLOB_MOST = 16384, BOXES = 5 };
typedef enum index_kind { INDEX_FRUSTUM, INDEX_OCTREE, INDEX_BSP, INDEX_KINDS } index_kind;

static const size_t head_bytes[INDEX_KINDS] = {24, 40, 80}; // the check of all behind it stands at the head's end
static const bsp_wish tree_wish = {BSP_WHOLE, BSP_BALANCE, 0, 0};
static const octree_wish cells_wish = {OCTREE_OCT, 2};

static void expect(int holds)
{
    if (!holds) abort();
}

static const cull_zone *small_zone(void)
{
    static hand_zone zone;
    if (zone.zone.item_count) return &zone.zone;
    hand_zone_open(&zone, 64, 512);
    for (int i = 0; i < BOXES; ++i) {
        const float x = (float)(3 * (i % 3)), z = (float)(4 * (i / 3)), high = 1 + (float)i / 2;
        hand_zone_box(&zone, (cull_box){{x, 0, z}, {x + 2, high, z + 1}}, FACE_OUT, 0);
    }
    hand_zone_cluster(&zone, (cull_box){{0, 1, 0}, {1, 2, 1}});
    hand_zone_end(&zone);
    return &zone.zone;
}

// Builds the index from the blob, or from the zone where that has no bytes. Returns the bytes that it saves as in `out`; 0: refused.
static size_t build(index_kind kind, cull_blob blob, uint8_t out[BLOB_MOST])
{
    static culler_host h;
    const cull_zone *zone = small_zone();
    const cull_blob *lent = blob.bytes ? &blob : NULL;
    uint64_t size = 0;
    cull_result result;
    culler_host_init(&h, 0);
    if (kind == INDEX_FRUSTUM) {
        frustum_index index = {0};
        result = index_build(&h.host, &(index_source){zone, lent, INDEX_NO_FACES}, &index);
        if (result == CULL_OK) size = index_save(&index, out, BLOB_MOST);
        index_free(&h.host, &index);
    } else if (kind == INDEX_OCTREE) {
        octree_cells cells = {0};
        result = cells_build(&h.host, &(octree_source){zone, lent, cells_wish}, &cells);
        if (result == CULL_OK) size = cells_save(&cells, &cells_wish, out, BLOB_MOST);
        if (result == CULL_OK) cells_free(&h.host, &cells);
    } else {
        bsp_tree tree = {0};
        result = bsp_tree_build(&h.host, &(bsp_source){zone, lent, tree_wish}, &tree);
        if (result == CULL_OK) size = bsp_tree_save(&tree, out, BLOB_MOST);
        if (result == CULL_OK) bsp_tree_free(&h.host, &tree);
    }
    expect(result == CULL_OK || (lent && result == CULL_ERR_BLOB));
    expect(size <= BLOB_MOST && failing_allocator_is_clean(&h.memory));
    return (size_t)size;
}

static void sign(index_kind kind, uint8_t *bytes, size_t size) // as the cullers do: Fowler, Noll and Vo's hash by words
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t at = head_bytes[kind]; at + 4 <= size; at += 4) {
        uint32_t word;
        memcpy(&word, bytes + at, sizeof word);
        hash = (hash ^ word) * 0x100000001b3u;
    }
    if (size >= head_bytes[kind]) memcpy(bytes + head_bytes[kind] - sizeof hash, &hash, sizeof hash);
}

static int use(index_kind kind, const uint8_t *bytes, size_t size)
{
    static uint8_t again[BLOB_MOST];
    uint8_t *own = size ? aligned_alloc(64, (size + 63) & ~(size_t)63) : malloc(1); // as blobs are lent
    expect(own != NULL);
    if (size) memcpy(own, bytes, size);
    const size_t saved = build(kind, (cull_blob){own, size}, again);
    if (saved) expect(saved == size && memcmp(again, own, size) == 0);
    free(own);
    return saved != 0;
}

static void edit(uint8_t *blob, size_t size, const uint8_t *e) // where (2 bytes), what kind, what value, by how much
{
    static const uint32_t numbers[] = {0, 1, 2, 3, 0x7fffffff, 0x80000000, 0x80000001, 0xffffffff, 0xfffffffe, 0x7fc00000, 0x7f800000};
    const size_t at = (((size_t)e[0] << 8 | e[1]) % size) & ~(size_t)3;
    uint32_t value;
    memcpy(&value, blob + at, sizeof value);
    if (e[2] % 4 == 0) value = numbers[e[3] % (sizeof numbers / sizeof *numbers)];
    else if (e[2] % 4 == 1) value += e[3] - UINT32_C(128);
    else if (e[2] % 4 == 2) value = e[3];
    else value ^= (uint32_t)e[4] << e[3] % 32;
    memcpy(blob + at, &value, sizeof value);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static uint8_t sound[INDEX_KINDS][BLOB_MOST], blob[BLOB_MOST];
    static size_t sizes[INDEX_KINDS];
    if (size == 0) return 0;
    const index_kind kind = (index_kind)(data[0] % INDEX_KINDS);
    if (!sizes[kind]) {
        sizes[kind] = build(kind, (cull_blob){NULL, 0}, sound[kind]);
        expect(sizes[kind] > head_bytes[kind] && use(kind, sound[kind], sizes[kind]));
    }
    if (data[0] & 64) {
        (void)use(kind, data + 1, size - 1);
        return 0;
    }
    size_t length = sizes[kind];
    memcpy(blob, sound[kind], length);
    for (size_t i = 1, edits = 0; i + EDIT_BYTES <= size && edits < EDITS_MOST; i += EDIT_BYTES, ++edits) edit(blob, length, data + i);
    if (data[0] & 128) length -= size % length; // and cut
    sign(kind, blob, length);
    (void)use(kind, blob, length);
    return 0;
}
