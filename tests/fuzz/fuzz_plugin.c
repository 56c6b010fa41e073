// Fuzz target: any bytes as a culler's library, as they are and as edits of a sound one, because few mutations of anything
// else come past its header. Only what the host reads itself: what it lets pass is native code, and trusted.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "host/core/library_file.h"
#include "tests/fuzz_driver.h"

#include <elf.h>
#include <link.h>
#include <portcullis/culler.h>
#include <stdlib.h>
#include <string.h>

const char *const fuzz_seeds[] = {
    "a text", "\177ELF\2\1\1", "\1abcdefghijkl", "\2\x01\x01\x10\x02\x03", "\3\x01\x40\x10\x02\x03\x01\x41\x10\x02\x03", "\4\x7f", "\5\x01\x60\x20\x01\x7f", NULL,
};
const char *const fuzz_files[] = {NULL};

enum { EDIT_BYTES = 5, EDITS_MOST = 8 };

typedef struct sound_library {
    ElfW(Ehdr) head;
    ElfW(Phdr) load, dynamic_segment;
    ElfW(Dyn) dynamic[5];
    ElfW(Sym) symbols[2];
    ElfW(Addr) gnu_head[2], bloom[1]; // four numbers of 4 bytes
    uint32_t bucket[1], chain[1];
    uint32_t hash[5];
    char texts[16];
    cull_exports entry;
} sound_library;

static uint32_t gnu_hash_of(const char *name)
{
    uint32_t hash = 5381;
    for (; *name; ++name) hash = hash * 33 + (uint8_t)*name;
    return hash;
}

static void make_sound(sound_library *l, int has_gnu_hash)
{
    *l = (sound_library){.bucket = {1}, .hash = {1, 2, 1, 0, 0}, .texts = "\0cull_entry", .entry = {.abi = CULL_ABI}};
    const uint16_t one = 1;
    memcpy(l->head.e_ident, ELFMAG, SELFMAG);
    l->head.e_ident[EI_CLASS] = sizeof(ElfW(Addr)) == 8 ? ELFCLASS64 : ELFCLASS32;
    l->head.e_ident[EI_DATA] = *(const uint8_t *)&one ? ELFDATA2LSB : ELFDATA2MSB;
#if defined(__x86_64__)
    l->head.e_machine = EM_X86_64;
#elif defined(__aarch64__)
    l->head.e_machine = EM_AARCH64;
#endif
    l->head.e_type = ET_DYN;
    l->head.e_phoff = offsetof(sound_library, load);
    l->head.e_phentsize = sizeof l->load;
    l->head.e_phnum = 2;
    l->load = (ElfW(Phdr)){.p_type = PT_LOAD, .p_filesz = sizeof *l, .p_memsz = sizeof *l};
    l->dynamic_segment = (ElfW(Phdr)){.p_type = PT_DYNAMIC, .p_offset = offsetof(sound_library, dynamic), .p_filesz = sizeof l->dynamic, .p_memsz = sizeof l->dynamic};
    l->dynamic[0] = (ElfW(Dyn)){.d_tag = DT_SYMTAB, .d_un.d_ptr = offsetof(sound_library, symbols)};
    l->dynamic[1] = (ElfW(Dyn)){.d_tag = DT_STRTAB, .d_un.d_ptr = offsetof(sound_library, texts)};
    l->dynamic[2] = (ElfW(Dyn)){.d_tag = DT_HASH, .d_un.d_ptr = offsetof(sound_library, hash)};
    if (has_gnu_hash) l->dynamic[3] = (ElfW(Dyn)){.d_tag = DT_GNU_HASH, .d_un.d_ptr = offsetof(sound_library, gnu_head)};
    l->symbols[1] = (ElfW(Sym)){.st_name = 1, .st_info = STB_GLOBAL << 4 | STT_OBJECT, .st_shndx = 1, .st_value = offsetof(sound_library, entry), .st_size = sizeof l->entry};
    const uint32_t numbers[4] = {1, 1, 1, 0}; // buckets, first symbol, words of the bloom filter, its shift
    memcpy(l->gnu_head, numbers, sizeof numbers);
    l->chain[0] = gnu_hash_of(CULL_ENTRY_SYMBOL) | 1;
}

static void edit(uint8_t *file, size_t size, const uint8_t *e) // where (2 bytes), what kind, what value, by how much
{
    static const uint32_t numbers[] = {0, 1, 2, 3, 0x7fffffff, 0x80000000, 0xffffffff, 0xfffffffe, 64, 0x1000, 0xfffffff8};
    const size_t at = (((size_t)e[0] << 8 | e[1]) % size) & ~(size_t)3;
    uint32_t value;
    memcpy(&value, file + at, sizeof value);
    if (e[2] % 4 == 0) value = numbers[e[3] % (sizeof numbers / sizeof *numbers)];
    else if (e[2] % 4 == 1) value += e[3] - UINT32_C(128);
    else if (e[2] % 4 == 2) value ^= UINT32_C(1) << e[3] % 32;
    else value = (value & ~UINT32_C(0xffff)) | (uint32_t)e[3] << 8 | e[4];
    memcpy(file + at, &value, sizeof value);
}

static const char *fault_of(const uint8_t *bytes, size_t size)
{
    library_fault_text text;
    const char *fault = library_bytes_fault(bytes, size, &text);
    if (fault && (strlen(fault) < 8 || strlen(fault) >= LIBRARY_FAULT_BYTES || strchr(fault, '\n'))) abort();
    return fault ? "refused" : NULL; // the text goes with this frame
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    (void)fault_of(data, size);
    if (size == 0) return 0;
    sound_library *file = malloc(sizeof *file);
    if (!file) abort();
    make_sound(file, data[0] & 1);
    size_t edits = 0;
    for (size_t i = 1; i + EDIT_BYTES <= size && edits < EDITS_MOST; i += EDIT_BYTES, ++edits) edit((uint8_t *)file, sizeof *file, data + i);
    const char *fault = fault_of((const uint8_t *)file, sizeof *file);
    if (edits == 0 && fault) abort();
    if (data[0] & 2) { // and cut: refused wherever
        const size_t length = (size_t)(data[0] >> 2) * sizeof *file / 64;
        uint8_t *cut = malloc(length ? length : 1); // of its own size: reading past the end is seen
        if (!cut) abort();
        memcpy(cut, file, length);
        fault = fault_of(cut, length);
        if (edits == 0 && !fault) abort();
        free(cut);
    }
    free(file);
    return 0;
}
