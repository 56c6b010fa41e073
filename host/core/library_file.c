// A culler's library before it is opened: see library_file.h.
// SPDX-License-Identifier: MIT
// System V ABI, chapters 4 and 5 (object files, dynamic linking); the GNU hash table is the one of glibc's and musl's loaders.
#define _GNU_SOURCE
#include "library_file.h"

#include <errno.h>
#include <fcntl.h>
#include <portcullis/culler.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *const no_symbol = "it has no symbol " CULL_ENTRY_SYMBOL "; declare it with CULL_ENTRY";

const char *library_abi_fault(uint32_t abi, library_fault_text *to)
{
    if (abi == CULL_ABI) return NULL;
    snprintf(to->text, sizeof to->text, "it is of ABI number %u, this host of %u; build it against this host's culler.h", abi, CULL_ABI);
    return to->text;
}

#if defined(__ELF__)
#include <elf.h>
#include <link.h>

typedef ElfW(Ehdr) elf_head;
typedef ElfW(Phdr) elf_segment;
typedef ElfW(Shdr) elf_section;
typedef ElfW(Dyn) elf_dynamic;
typedef ElfW(Sym) elf_symbol;
typedef ElfW(Addr) elf_word; // of the machine's size

typedef struct image {
    const uint8_t *bytes;
    size_t size;
    elf_head head;
    elf_segment dynamic;
} image;

// Places in the file; 0: it has none.
typedef struct tables { uint64_t symbols, texts, hash, gnu_hash; } tables;

static int take(const image *m, uint64_t at, void *to, size_t size)
{
    if (at > m->size || size > m->size - at) return 0;
    memcpy(to, m->bytes + at, size);
    return 1;
}

static uint32_t number_at(const image *m, uint64_t at) // 0 past the end
{
    uint32_t number = 0;
    (void)take(m, at, &number, sizeof number);
    return number;
}

static uint16_t this_machine(void)
{
#if defined(__x86_64__)
    return EM_X86_64;
#elif defined(__aarch64__)
    return EM_AARCH64;
#else
    return EM_NONE; // not compared
#endif
}

static const char *head_fault(image *m)
{
    const uint8_t class = sizeof(elf_word) == 8 ? ELFCLASS64 : ELFCLASS32, order = *(const uint8_t *)&(uint16_t){1} ? ELFDATA2LSB : ELFDATA2MSB;
    if (m->size < EI_NIDENT || memcmp(m->bytes, ELFMAG, SELFMAG) != 0) return "it is no shared library; build it as one (-shared)";
    if (m->bytes[EI_CLASS] != class || m->bytes[EI_DATA] != order) return "it is built for another machine's word size or byte order; build it for this one";
    if (!take(m, 0, &m->head, sizeof m->head)) return "it is cut short within its header; copy or build it again";
    if (this_machine() != EM_NONE && m->head.e_machine != this_machine()) return "it is built for another machine; build it for this one";
    if (m->head.e_type == ET_REL) return "it is an object file, not linked yet; link it with -shared";
    if (m->head.e_type != ET_DYN) return "it is a program or a core, no shared library; link it with -shared";
    if (m->head.e_phentsize != sizeof(elf_segment)) return "its header is damaged; copy or build it again";
    return NULL;
}

static const char *cut_short(const image *m, uint64_t end, library_fault_text *to)
{
    snprintf(to->text, sizeof to->text, "it is cut short: %zu bytes of %llu or more; copy or build it again", m->size, (unsigned long long)end);
    return to->text;
}

static int segment_at(const image *m, uint32_t i, elf_segment *out)
{
    return take(m, (uint64_t)m->head.e_phoff + (uint64_t)i * sizeof *out, out, sizeof *out);
}

static int ends_inside(const image *m, uint64_t at, uint64_t bytes)
{
    return at <= m->size && bytes <= m->size - at;
}

// The system's loader maps segments that the file does not hold, and is killed when it reads them.
static const char *segments_fault(image *m, library_fault_text *to)
{
    uint32_t loaded = 0;
    const uint64_t sections = (uint64_t)m->head.e_shnum * m->head.e_shentsize; // at the end of most files: one being copied lacks them
    if (m->head.e_shoff && !ends_inside(m, m->head.e_shoff, sections)) return cut_short(m, m->head.e_shoff + sections, to);
    for (uint32_t i = 0; i < m->head.e_phnum; ++i) {
        elf_segment s;
        if (!segment_at(m, i, &s)) return cut_short(m, m->head.e_phoff + (uint64_t)m->head.e_phnum * sizeof s, to);
        if (s.p_type != PT_LOAD && s.p_type != PT_DYNAMIC) continue;
        if (!ends_inside(m, s.p_offset, s.p_filesz)) return cut_short(m, s.p_offset + s.p_filesz, to);
        if (s.p_filesz > s.p_memsz) return "a segment is larger in the file than in memory; it is damaged";
        if (s.p_type == PT_DYNAMIC) m->dynamic = s;
        else loaded++;
    }
    return loaded && m->dynamic.p_filesz ? NULL : "it is no shared library: it has no segment to load, or no dynamic one";
}

static int place_of(const image *m, uint64_t address, uint64_t *out) // in the file
{
    elf_segment s;
    for (uint32_t i = 0; i < m->head.e_phnum && segment_at(m, i, &s); ++i) {
        if (s.p_type != PT_LOAD || address < s.p_vaddr || address - s.p_vaddr >= s.p_filesz) continue;
        *out = s.p_offset + (address - s.p_vaddr);
        return 1;
    }
    return 0;
}

static const char *dynamic_fault(const image *m, tables *out)
{
    *out = (tables){0};
    for (uint64_t at = 0; at + sizeof(elf_dynamic) <= m->dynamic.p_filesz; at += sizeof(elf_dynamic)) {
        elf_dynamic d;
        if (!take(m, m->dynamic.p_offset + at, &d, sizeof d) || d.d_tag == DT_NULL) break;
        if (d.d_tag == DT_FLAGS_1 && d.d_un.d_val & DF_1_PIE) return "it is a program, no shared library; link it with -shared";
        uint64_t *const place = d.d_tag == DT_SYMTAB     ? &out->symbols
                                : d.d_tag == DT_STRTAB   ? &out->texts
                                : d.d_tag == DT_HASH     ? &out->hash
                                : d.d_tag == DT_GNU_HASH ? &out->gnu_hash
                                                         : NULL;
        if (place && *place) return "its dynamic segment is damaged: a table stands in it twice"; // keeps the time linear too
        if (place && (!place_of(m, d.d_un.d_ptr, place) || *place == 0)) return "its dynamic segment is damaged: a table lies outside of what is loaded";
    }
    return out->symbols && out->texts ? NULL : no_symbol;
}

// Whether symbol `i` is the entry, defined here.
static int is_entry(const image *m, const tables *t, uint32_t i, elf_symbol *out)
{
    char name[sizeof CULL_ENTRY_SYMBOL];
    if (!take(m, t->symbols + (uint64_t)i * sizeof *out, out, sizeof *out) || out->st_shndx == SHN_UNDEF) return 0;
    return take(m, t->texts + out->st_name, name, sizeof name) && memcmp(name, CULL_ENTRY_SYMBOL, sizeof name) == 0;
}

static int entry_by_gnu_hash(const image *m, const tables *t, elf_symbol *out)
{
    uint32_t hash = 5381;
    for (const char *c = CULL_ENTRY_SYMBOL; *c; ++c) hash = hash * 33 + (uint8_t)*c;
    const uint32_t buckets = number_at(m, t->gnu_hash), first = number_at(m, t->gnu_hash + 4), bloom_words = number_at(m, t->gnu_hash + 8);
    if (buckets == 0) return 0;
    const uint64_t bucket_at = t->gnu_hash + 16 + (uint64_t)bloom_words * sizeof(elf_word), chain_at = bucket_at + (uint64_t)buckets * 4;
    uint32_t i = number_at(m, bucket_at + (uint64_t)(hash % buckets) * 4);
    if (i < first || i == 0) return 0;
    for (;; ++i) {
        uint32_t link;
        if (!take(m, chain_at + (uint64_t)(i - first) * 4, &link, sizeof link)) return 0;
        if ((link | 1) == (hash | 1) && is_entry(m, t, i, out)) return 1;
        if (link & 1 || i == UINT32_MAX) return 0;
    }
}

static int entry_by_hash(const image *m, const tables *t, elf_symbol *out)
{
    uint32_t hash = 0;
    for (const char *c = CULL_ENTRY_SYMBOL; *c; ++c) {
        hash = (hash << 4) + (uint8_t)*c;
        hash = (hash ^ (hash >> 28 << 4)) & 0x0fffffff;
    }
    const uint32_t buckets = number_at(m, t->hash), links = number_at(m, t->hash + 4);
    if (buckets == 0) return 0;
    const uint64_t link_at = t->hash + 8 + (uint64_t)buckets * 4;
    uint32_t i = number_at(m, t->hash + 8 + (uint64_t)(hash % buckets) * 4);
    for (uint64_t steps = 0; i != 0 && steps < links && steps < m->size / 4; ++steps) { // no chain is longer, a ring is
        if (is_entry(m, t, i, out)) return 1;
        i = number_at(m, link_at + (uint64_t)i * 4);
    }
    return 0;
}

static const char *entry_fault(const image *m, const elf_symbol *entry, library_fault_text *to)
{
    uint64_t at;
    const uint32_t sort = entry->st_info & 15u;
    if (sort != STT_OBJECT && sort != STT_NOTYPE) return "its symbol " CULL_ENTRY_SYMBOL " is no data; declare it with CULL_ENTRY";
    const uint32_t abi = place_of(m, entry->st_value, &at) ? number_at(m, at) : 0; // not in the file: memory that starts as zeros
    const char *fault = library_abi_fault(abi, to);
    if (fault) return fault;
    if (entry->st_size && entry->st_size < sizeof(cull_exports)) return "its symbol " CULL_ENTRY_SYMBOL " is smaller than a cull_exports; declare it with CULL_ENTRY";
    return NULL;
}

const char *library_bytes_fault(const uint8_t *bytes, size_t size, library_fault_text *text)
{
    image m = {.bytes = bytes, .size = size};
    tables t;
    elf_symbol entry;
    const char *fault = head_fault(&m);
    if (!fault) fault = segments_fault(&m, text);
    if (!fault) fault = dynamic_fault(&m, &t);
    if (fault) return fault;
    if (!t.hash && !t.gnu_hash) return NULL; // a table of a kind to come: the system's loader may know it
    if (!(t.gnu_hash ? entry_by_gnu_hash(&m, &t, &entry) : entry_by_hash(&m, &t, &entry))) return no_symbol;
    return entry_fault(&m, &entry, text);
}

#else
const char *library_bytes_fault(const uint8_t *bytes, size_t size, library_fault_text *text)
{
    (void)bytes, (void)size, (void)text;
    return NULL;
}
#endif

static const char *system_fault(library_fault_text *to)
{
    snprintf(to->text, sizeof to->text, "cannot open it: %s", strerror(errno));
    return to->text;
}

const char *library_path_fault(const char *path, library_fault_text *text)
{
    struct stat status;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); // a pipe without a writer would be waited for
    if (file < 0) return system_fault(text);
    const char *fault = NULL;
    if (fstat(file, &status) != 0) fault = system_fault(text);
    else if (!S_ISREG(status.st_mode)) fault = "it is a folder, pipe or device, no file";
    else if (status.st_size == 0) fault = "it is empty; copy or build it again";
    if (!fault) { // mapped: only the pages that are looked at are read
        const size_t size = (size_t)status.st_size;
        void *const bytes = mmap(NULL, size, PROT_READ, MAP_PRIVATE, file, 0);
        fault = bytes == MAP_FAILED ? system_fault(text) : library_bytes_fault(bytes, size, text);
        if (bytes != MAP_FAILED) munmap(bytes, size);
    }
    close(file);
    return fault;
}
