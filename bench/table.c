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

// Drawn by visible; "-" where nothing was visible.
static const char *short_excess(const bench_row *row, char out[16])
{
    if (row->polygons_visible > 0) snprintf(out, 16, "%.2f", row->excess);
    else snprintf(out, 16, "-");
    return out;
}

typedef struct columns {
    int name_width;
    bench_truth truth;
    uint32_t gl_used;
    uint32_t has_zones, has_motion, has_pictures; // more than one zone; movers on paths; a row beside full geometry
} columns;

static columns columns_of(const bench_result *b, const bench_request *q)
{
    columns c = {.name_width = 8, .truth = q->truth, .gl_used = b->gl_used, .has_zones = b->zones > 1};
    for (uint32_t i = 0; i < b->row_count; ++i) {
        const int length = (int)strlen(b->rows[i].name);
        c.name_width = length > c.name_width ? length : c.name_width;
        c.has_pictures |= b->rows[i].pictures_measured;
        c.has_motion |= b->rows[i].mover_update_ns > 0;
    }
    return c;
}

static int put_head(buffer *text, const columns *c)
{
    int good = put(text, "%-*s %10s %10s %8s %8s %8s", c->name_width, "strategy", "cull", "p95", "items", "polygons", "runs");
    if (c->has_zones) good = good && put(text, " %8s %8s %9s %7s", "zones", "volumes", "crossings", "merges");
    if (c->has_motion) good = good && put(text, " %9s", "a mover");
    if (c->gl_used) good = good && put(text, " %9s %9s", "gl ms", "total ms");
    if (c->has_pictures)
        good = good && put(text, " %9s %9s %7s %9s %9s %6s %6s %6s %7s %7s %7s", "total p95", "total p99", "p99/p50", "refreshes", "pictures", "PSNR", "SSIM", "FLIP",
                           "p99", "cracks", "popping");
    if (c->truth == BENCH_TRUTH) good = good && put(text, " %8s %7s %9s %7s", "visible", "excess", "missed px", "items");
    return good && put(text, "\n");
}

static int put_marks(buffer *text, const bench_row *row)
{
    const char *check = row->picture_differs ? "DRAWN WRONG" : bench_check_failed(row) ? "FAILED" : row->faults ? "faults" : "";
    return put(text, "  %s%s%s\n", check, *check && row->front_walls_only ? " " : "", row->front_walls_only ? "front walls" : "");
}

static const char *short_bytes(uint64_t bytes, char out[16])
{
    if (bytes >= 1u << 20) snprintf(out, 16, "%.2f MB", (double)bytes / (1u << 20));
    else snprintf(out, 16, "%.1f KB", (double)bytes / (1u << 10));
    return out;
}

static int put_pictures(buffer *text, const bench_row *row)
{
    char bytes[16], ssim[16] = "-", ratio[16] = "-", popping[16] = "-";
    if (row->total_ms > 0) snprintf(ratio, sizeof ratio, "%.2f", row->total_ms_p99 / row->total_ms);
    if (row->popping_views) snprintf(popping, sizeof popping, "%.4f", row->popping);
    int good = put(text, " %9.2f %9.2f %7s %9.2f %9s", row->total_ms_p95, row->total_ms_p99, ratio, row->refreshes, short_bytes(row->picture_bytes, bytes));
    if (row->has_ssim) snprintf(ssim, sizeof ssim, "%.4f", row->ssim);
    if (!row->pictures_measured) return good && put(text, " %6s %6s %6s %7s %7s %7s", "-", "-", "-", "-", "-", "-");
    return good && put(text, " %6.2f %6s %6.4f %7.4f %7llu %7s", row->psnr, ssim, row->flip, row->flip_p99, (unsigned long long)row->crack_pixels, popping);
}

static int put_row(buffer *text, const bench_row *row, const columns *c)
{
    char t[3][16], n[9][16];
    int good = put(text, "%-*s %10s %10s %8s %8s %8s", c->name_width, row->name, short_time(row->cull_ns, t[0]), short_time(row->cull_ns_p95, t[1]),
                   short_count(row->items_drawn, n[0]), short_count(row->polygons_drawn, n[1]), short_count(row->runs, n[2]));
    if (c->has_zones)
        good = good && put(text, " %8s %8s %9s %7s", short_count(row->zones, n[5]), short_count(row->volumes, n[6]),
                           short_count(row->crossings, n[7]), short_count((double)row->portal_merges, n[8]));
    if (c->has_motion) good = good && put(text, " %9s", short_time(row->mover_update_ns, t[2]));
    if (c->gl_used) good = good && put(text, " %9.2f %9.2f", row->gl_ms, row->total_ms);
    if (c->has_pictures) good = good && put_pictures(text, row);
    if (c->truth == BENCH_TRUTH)
        good = good && put(text, " %8s %7s %9llu %7llu", short_count(row->polygons_visible, n[3]), short_excess(row, n[4]),
                           (unsigned long long)row->missed_pixels, (unsigned long long)row->missed_items);
    return good && put_marks(text, row);
}

static int put_figures(buffer *text, const bench_row *row)
{
    if (!row->figures.count) return 1;
    int good = put(text, "%s: built in %.2f ms", row->name, row->build_ms);
    for (uint32_t i = 0; i < row->figures.count; ++i) good = good && put(text, ", %s %.10g", row->figures.list[i].name, row->figures.list[i].value);
    return good && put(text, "\n");
}

static int put_all(buffer *text, const bench_result *b, const bench_request *q, const bench_labels *labels)
{
    char n[2][16];
    const columns c = columns_of(b, q);
    int good = put(text, "%s, %u views of %s, %s items, %s polygons\n", labels->scene, b->views, labels->path,
                   short_count((double)b->items_total, n[0]), short_count((double)b->polygons_total, n[1]));
    if (c.has_zones) good = good && put(text, "%u zones, %u portals\n", b->zones, b->portals);
    if (b->gl_used) good = good && put(text, "drawn by %s\n", b->gl_name);
    good = good && put_head(text, &c);
    for (uint32_t i = 0; i < b->row_count; ++i) good = good && put_row(text, &b->rows[i], &c);
    for (uint32_t i = 0; i < b->row_count; ++i) good = good && put_figures(text, &b->rows[i]);
    return good;
}

result bench_table(const bench_result *b, const bench_request *q, const bench_labels *labels, bench_text *out)
{
    const allocator *memory = q->services->memory;
    buffer text = buffer_make(memory, 1);
    char *copy = NULL;
    if (put_all(&text, b, q, labels)) copy = memory_alloc(memory, text.count + 1, 1);
    if (copy) {
        memcpy(copy, text.items, text.count);
        copy[text.count] = 0;
        *out = (bench_text){copy, text.count};
    }
    buffer_free(&text);
    return copy ? RESULT_OK : RESULT_NO_MEMORY;
}
