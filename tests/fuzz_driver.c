// A small standalone driver for fuzz targets, so that they run as ordinary tests from every compiler. Repeatable.
// SPDX-License-Identifier: MIT
// With arguments it runs those files instead, as libFuzzer does: to repeat what a fuzzer has found. Without, it begins with
// the target's kept corpus, in which every input that once failed stands too.
#define _XOPEN_SOURCE 700
#include "fuzz_driver.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { INPUT_MOST = 16384, PIECE = 4096, PIECES_A_FILE = 4, MUTATIONS_A_SEED = 1000, EDITS_MOST = 6, RUNS_MOST = 12000 };

typedef struct fuzz {
    uint64_t state; // splitmix64
    uint8_t seed[INPUT_MOST], input[INPUT_MOST + 1];
    size_t seed_size, size;
    unsigned runs;
} fuzz;

static uint64_t bits(fuzz *f)
{
    uint64_t z = f->state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static size_t below(fuzz *f, size_t count)
{
    return count ? (size_t)(bits(f) % count) : 0;
}

static void run_exact(fuzz *f, const void *bytes, size_t size)
{
    uint8_t *exact = malloc(size ? size : 1); // so that reading past the end is seen by ASan
    if (!exact) abort();
    if (size) memcpy(exact, bytes, size);
    LLVMFuzzerTestOneInput(exact, size);
    free(exact);
    f->runs++;
}

static void run(fuzz *f)
{
    run_exact(f, f->input, f->size);
}

// ---- Edits ----

static void flip(fuzz *f)
{
    if (f->size) f->input[below(f, f->size)] ^= (uint8_t)(1u << below(f, 8));
}

static void replace(fuzz *f, size_t at, size_t length, const void *with, size_t with_length)
{
    if (f->size - length + with_length > INPUT_MOST) return;
    memmove(f->input + at + with_length, f->input + at + length, f->size - at - length);
    memcpy(f->input + at, with, with_length);
    f->size = f->size - length + with_length;
}

static void cut(fuzz *f)
{
    const size_t at = below(f, f->size + 1);
    replace(f, at, below(f, f->size - at + 1), "", 0);
}

static void truncate_input(fuzz *f)
{
    f->size = below(f, f->size + 1);
}

static void duplicate(fuzz *f)
{
    uint8_t copy[512];
    const size_t from = below(f, f->size + 1), left = f->size - from;
    const size_t length = below(f, (left < sizeof copy ? left : sizeof copy) + 1);
    memcpy(copy, f->input + from, length);
    replace(f, below(f, f->size + 1), 0, copy, length);
}

static int is_number(uint8_t c)
{
    return (c >= '0' && c <= '9') || c == '.' || c == '-';
}

static void change_number(fuzz *f)
{
    static const char *const numbers[] = {"1e300", "nan",  "-nan", "inf", "-1",    "0",       "4294967296", "18446744073709551616", "-0",  "1e-320",
                                          "0x10",  "1e9", ".",    "-",   "99999", "-2147483649", "1.5",    "3",                    "1048576", "1e+"};
    size_t start = below(f, f->size), end;
    while (start < f->size && !is_number(f->input[start])) start++;
    for (end = start; end < f->size && is_number(f->input[end]);) end++;
    const char *with = numbers[below(f, sizeof numbers / sizeof *numbers)];
    if (start < end) replace(f, start, end - start, with, strlen(with));
}

static void change_byte(fuzz *f)
{
    static const char bytes[] = "\0\n\r\t \"{}()[]/#*-.e\xff";
    if (f->size) f->input[below(f, f->size)] = (uint8_t)bytes[below(f, sizeof bytes - 1)];
}

static void mutate(fuzz *f)
{
    static void (*const edits[])(fuzz *) = {flip, cut, truncate_input, duplicate, change_number, change_number, change_number, change_byte};
    memcpy(f->input, f->seed, f->seed_size);
    f->size = f->seed_size;
    for (size_t i = 1 + below(f, EDITS_MOST); i > 0; --i) edits[below(f, sizeof edits / sizeof *edits)](f);
}

static void run_seed(fuzz *f, const void *bytes, size_t size, unsigned mutations)
{
    f->seed_size = size < INPUT_MOST ? size : INPUT_MOST;
    memcpy(f->seed, bytes, f->seed_size);
    memcpy(f->input, bytes, f->seed_size);
    f->size = f->seed_size;
    run(f);
    for (unsigned i = 0; i < mutations && f->runs < RUNS_MOST; ++i) {
        mutate(f);
        run(f);
    }
}

// ---- Files ----

static char *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    fseek(file, 0, SEEK_END);
    const long length = ftell(file);
    rewind(file);
    char *bytes = length > 0 ? malloc((size_t)length) : NULL;
    *size = bytes ? fread(bytes, 1, (size_t)length, file) : 0;
    fclose(file);
    return bytes;
}

static void run_pieces(fuzz *f, const char *name)
{
    const char *folder = getenv("PORTCULLIS_SCENES");
    char path[1024];
    size_t size = 0;
    snprintf(path, sizeof path, "%s/%s", folder ? folder : ".", name);
    char *bytes = read_file(path, &size);
    if (!bytes) {
        fprintf(stderr, "SKIPPED: the scene %s is not in PORTCULLIS_SCENES; only the seeds of the source are mutated\n", name);
        return;
    }
    for (int i = 0; i < PIECES_A_FILE; ++i) { // the beginning, then anywhere
        const size_t from = i == 0 || size <= PIECE ? 0 : below(f, size - PIECE);
        run_seed(f, bytes + from, size - from < PIECE ? size - from : PIECE, MUTATIONS_A_SEED / 4);
    }
    free(bytes);
}

static void run_file(fuzz *f, const char *path)
{
    size_t size = 0;
    char *bytes = read_file(path, &size); // NULL of an empty file
    run_exact(f, bytes, size);
    free(bytes);
}

static void run_corpus(fuzz *f)
{
    struct dirent **entries = NULL;
    const int count = scandir(FUZZ_CORPUS, &entries, NULL, alphasort);
    for (int i = 0; i < count; ++i) {
        char path[2048];
        const int length = snprintf(path, sizeof path, "%s/%s", FUZZ_CORPUS, entries[i]->d_name);
        if (entries[i]->d_name[0] != '.' && length > 0 && (size_t)length < sizeof path) run_file(f, path);
        free(entries[i]);
    }
    free(entries);
}

int main(int argc, char **argv)
{
    static fuzz f; // too large for a stack
    f.state = 20240229;
    for (int i = 1; i < argc; ++i) run_file(&f, argv[i]);
    if (argc > 1) return 0;
    run_corpus(&f);
    const unsigned kept = f.runs;
    f.runs = 0;
    for (int i = 0; fuzz_seeds[i]; ++i) run_seed(&f, fuzz_seeds[i], strlen(fuzz_seeds[i]), MUTATIONS_A_SEED);
    for (int i = 0; fuzz_files[i]; ++i) run_pieces(&f, fuzz_files[i]);
    run_seed(&f, "", 0, 0);
    printf("%u inputs, and %u kept ones\n", f.runs, kept);
    return f.runs > 0 ? 0 : 1;
}
