// Text of generated files: see generate_text.h.
// SPDX-License-Identifier: MIT
#include "generate_text.h"

#include "../host/core/file.h"

#include <string.h>

enum { NUMBER_BYTES = 32 };

text_file text_open(const allocator *memory)
{
    return (text_file){.bytes = buffer_make(memory, 1)};
}

void text_free(text_file *t)
{
    buffer_free(&t->bytes);
}

static void append(text_file *t, const char *bytes, size_t count)
{
    if (t->failed || count == 0) return;
    if (!buffer_append(&t->bytes, bytes, count)) t->failed = 1;
}

void text_add(text_file *t, const char *words)
{
    append(t, words, strlen(words));
}

// Writes backwards from `end`; returns the first digit.
static char *digits_before(char *end, uint64_t value, uint32_t least_digits)
{
    do {
        *--end = (char)('0' + value % 10);
        value /= 10;
        if (least_digits) least_digits--;
    } while (value || least_digits);
    return end;
}

void text_count(text_file *t, uint64_t count)
{
    char number[NUMBER_BYTES];
    char *const end = number + sizeof number, *const first = digits_before(end, count, 1);
    append(t, first, (size_t)(end - first));
}

void text_decimal(text_file *t, int64_t value, uint32_t decimals)
{
    char number[NUMBER_BYTES];
    char *const end = number + sizeof number;
    uint64_t size = value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
    while (decimals && size % 10 == 0) {
        size /= 10;
        decimals--;
    }
    uint64_t power = 1;
    for (uint32_t i = 0; i < decimals; ++i) power *= 10;
    char *first = end;
    if (decimals) {
        first = digits_before(first, size % power, decimals);
        *--first = '.';
    }
    first = digits_before(first, size / power, 1);
    if (value < 0) *--first = '-';
    append(t, first, (size_t)(end - first));
}

result text_close(text_file *t, const char *path, report *r)
{
    const result done = t->failed ? report_no_memory(r, path) : file_write(path, t->bytes.items, t->bytes.count, r);
    text_free(t);
    return done;
}
