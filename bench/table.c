// The bench's table for people.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "bench.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static int put(buffer *text, const char *format, ...)
{
    char line[512];
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(line, sizeof line, format, values);
    va_end(values);
    if (length < 0) return 0;
    return buffer_append(text, line, (size_t)length < sizeof line ? (size_t)length : sizeof line - 1) != NULL;
}

// 1.23k, 45.6M: four characters of number.
static const char *short_count(double n, char out[16])
{
    if (n >= 1e9) snprintf(out, 16, "%.2fG", n * 1e-9);
    else if (n >= 1e6) snprintf(out, 16, "%.2fM", n * 1e-6);
    else if (n >= 1e5) snprintf(out, 16, "%.0fk", n * 1e-3);
    else if (n >= 1e4) snprintf(out, 16, "%.1fk", n * 1e-3);
    else snprintf(out, 16, "%.*f", n < 100 && n != (double)(long)n ? 1 : 0, n);
    return out;
}

static const char *short_time(double ns, char out[16])
{
    if (ns >= 1e6) snprintf(out, 16, "%.2f ms", ns * 1e-6);
    else if (ns >= 1e3) snprintf(out, 16, "%.2f us", ns * 1e-3);
    else snprintf(out, 16, "%.0f ns", ns);
    return out;
}

static int put_row(buffer *text, const bench_result *b, const bench_row *row, int name_width, int has_truth)
{
    char t[4][16], n[6][16];
    int good = put(text, "%-*s %10s %10s %8s %8s %8s", name_width, row->name, short_time(row->cull_ns, t[0]), short_time(row->cull_ns_p95, t[1]),
                   short_count(row->items_drawn, n[0]), short_count(row->polygons_drawn, n[1]), short_count(row->runs, n[2]));
    if (b->gl_used) good = good && put(text, " %9.2f %9.2f", row->gl_ms, row->total_ms);
    if (has_truth)
        good = good && put(text, " %8s %7.2f %9llu %7llu", short_count(row->polygons_visible, n[3]), row->excess,
                           (unsigned long long)row->missed_pixels, (unsigned long long)row->missed_items);
    return good && put(text, "  %s\n", bench_check_failed(row) ? "FAILED" : row->faults ? "faults" : "");
}

static int put_all(buffer *text, const bench_result *b, const bench_labels *labels)
{
    char n[2][16];
    int width = 8, has_truth = 0;
    for (uint32_t i = 0; i < b->row_count; ++i) {
        if ((int)strlen(b->rows[i].name) > width) width = (int)strlen(b->rows[i].name);
        has_truth |= b->rows[i].items_visible > 0;
    }
    int good = put(text, "%s, %u views of %s, %s items, %s polygons\n", labels->scene, b->views, labels->path,
                   short_count((double)b->items_total, n[0]), short_count((double)b->polygons_total, n[1]));
    if (b->gl_used) good = good && put(text, "drawn by %s\n", b->gl_name);
    good = good && put(text, "%-*s %10s %10s %8s %8s %8s", width, "strategy", "cull", "p95", "items", "polygons", "runs");
    if (b->gl_used) good = good && put(text, " %9s %9s", "gl ms", "total ms");
    if (has_truth) good = good && put(text, " %8s %7s %9s %7s", "visible", "excess", "missed px", "items");
    good = good && put(text, "\n");
    for (uint32_t i = 0; i < b->row_count; ++i) good = good && put_row(text, b, &b->rows[i], width, has_truth);
    return good;
}

result bench_table(const bench_result *b, const bench_labels *labels, const allocator *memory, char **out_text, size_t *out_size)
{
    buffer text = buffer_make(memory, 1);
    char *copy = NULL;
    if (put_all(&text, b, labels)) copy = memory_alloc(memory, text.count + 1, 1);
    if (copy) {
        memcpy(copy, text.items, text.count);
        copy[text.count] = 0;
        *out_text = copy;
        *out_size = text.count;
    }
    buffer_free(&text);
    return copy ? RESULT_OK : RESULT_NO_MEMORY;
}
