// Fuzz target: any bytes as a .pcs file, as they are and with the hash put right; and as edits of a sound file, because
// few mutations of anything else come past its header. What opens is used.
// SPDX-License-Identifier: MIT
#include "pcs_fixture.h"

#include "host/core/zone_data.h"
#include "tests/fuzz_driver.h"

#include <stdlib.h>
#include <string.h>

const char *const fuzz_seeds[] = {
    "0aaaa", "1abcdefghijkl", "0\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0a\x0b", "1\xff\xff\xff\x7f\x80\x10\x20\x30\x40\x50\x60", "0zzzzyyyyxxxxwwwwvvvvuuuu", NULL,
};
const char *const fuzz_files[] = {"quake/e1m1.map", "models/cow.obj", NULL};

static void use(const char *file, size_t size)
{
    const allocator *memory = allocator_heap();
    report silent = {0};
    scene *s = NULL;
    const result done = pcs_open("fuzz.pcs", file, size, memory, &silent, &s);
    if ((done == RESULT_OK) != (s != NULL) || (done != RESULT_OK) != (silent.errors == 1)) abort();
    if (!s) return;
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        zone_data data = {0};
        if (zone_data_open(&(zone_data_request){s, z, 4}, memory, &data) != RESULT_OK) abort();
        zone_data_close(&data);
    }
    for (uint32_t m = 0; m < s->mover_count; ++m) {
        scene_pose pose;
        double min[3], max[3];
        scene_pose_at(s, m, 1.5, DOORS_SHUT, &pose);
        scene_pose_box(s, m, &pose, min, max);
    }
    size_t again_bytes = 0;
    void *again = NULL;
    if (pcs_encode(&(pcs_request){.scene = s, .bakes = s->bakes, .bake_count = s->bake_count}, "fuzz.pcs", memory, &silent, &again, &again_bytes) != RESULT_OK) abort();
    memory_free(memory, again, again_bytes, 1);
    scene_free(s, memory);
}

static const char *sound_file(int which, size_t *size)
{
    static char *files[2];
    static size_t sizes[2];
    if (!files[which]) {
        scene *s = which ? small_map_scene() : everything_scene();
        files[which] = encoded_scene(s, &sizes[which]);
        free_heap_scene(s);
    }
    *size = sizes[which];
    return files[which];
}

// Of 5 bytes: where, what kind, what value.
static void edit(char *file, size_t size, const uint8_t *e)
{
    static const uint32_t numbers[] = {0, 1, 2, 3, 0x7fffffff, 0x80000000, 0xffffffff, 0xfffffffe, 0x7fc00000, 0x7f800000, 0x40000000};
    const size_t at = (((size_t)e[0] << 16 | (size_t)e[1] << 8 | e[2]) % size) & ~(size_t)3;
    uint32_t value;
    memcpy(&value, file + at, sizeof value);
    if (e[3] % 4 == 0) value = numbers[e[4] % (sizeof numbers / sizeof *numbers)];
    else if (e[3] % 4 == 1) value += e[4] - UINT32_C(128);
    else if (e[3] % 4 == 2) value ^= UINT32_C(1) << e[4] % 32;
    else value = (value & ~UINT32_C(0xff)) | e[4];
    memcpy(file + at, &value, sizeof value);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    size_t sound_size;
    const char *sound = sound_file(size > 0 && data[0] % 2, &sound_size);
    const size_t most = size > sound_size ? size : sound_size;
    char *file = malloc(most);
    if (!file) return 0;
    if (size) memcpy(file, data, size);
    use(file, size);
    if (size >= sizeof(pcs_header)) {
        memcpy(file, sound, 16);
        memcpy(file + offsetof(pcs_header, file_bytes), &(uint64_t){size}, 8);
        sign(file, size);
        use(file, size);
    }
    memcpy(file, sound, sound_size);
    for (size_t i = 1; i + 5 <= size && i < 5 * 12; i += 5) edit(file, sound_size, data + i);
    sign(file, sound_size);
    use(file, sound_size);
    free(file);
    return 0;
}
