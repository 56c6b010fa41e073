// The bench's results as CSV: RFC 4180, lines that end in a line feed.
// SPDX-License-Identifier: MIT
// Invariant: the columns are those of the first row, so every line has as many fields as the first.
#include "json_entry.h"

#include <stdlib.h>
#include <string.h>

static int put(buffer *text, const char *part)
{
    return buffer_append(text, part, strlen(part)) != NULL;
}

// In quotes, where it needs them.
static int put_text(buffer *text, const char *value)
{
    if (!strpbrk(value, ",\"\n\r")) return put(text, value);
    int good = put(text, "\"");
    for (const char *c = value; *c && good; ++c) good = (*c != '"' || put(text, "\"")) && buffer_append(text, c, 1) != NULL;
    return good && put(text, "\"");
}

static int put_value(buffer *text, const json_t *value)
{
    if (!value || json_is_null(value)) return 1;
    if (json_is_string(value)) return put_text(text, json_string_value(value));
    char *number = json_dumps(value, JSON_ENCODE_ANY);
    const int good = number && put(text, number);
    free(number);
    return good;
}

static int put_line(buffer *text, json_t *columns, const json_t *values) // values NULL: the names
{
    const char *key;
    json_t *first;
    int good = 1, fields = 0;
    json_object_foreach(columns, key, first) {
        if (json_is_object(first)) continue; // figures
        if (fields++) good = good && put(text, ",");
        good = good && (values ? put_value(text, json_object_get(values, key)) : put_text(text, key));
    }
    return good && put(text, "\n");
}

result bench_csv(const bench_result *b, const bench_request *q, const bench_labels *labels, bench_text *out)
{
    const allocator *memory = q->services->memory;
    buffer text = buffer_make(memory, 1);
    json_t *columns = NULL;
    int good = 1;
    for (uint32_t i = 0; i < b->row_count && good; ++i) {
        json_t *entry = bench_json_entry(b, q, labels, &b->rows[i]);
        good = entry != NULL;
        if (good && !columns) good = put_line(&text, columns = json_incref(entry), NULL);
        good = good && put_line(&text, columns, entry);
        json_decref(entry);
    }
    json_decref(columns);
    char *copy = good ? memory_alloc(memory, text.count + 1, 1) : NULL;
    if (copy) {
        if (text.count) memcpy(copy, text.items, text.count);
        copy[text.count] = 0;
        *out = (bench_text){copy, text.count};
    }
    buffer_free(&text);
    return copy ? RESULT_OK : RESULT_NO_MEMORY;
}
