// The bench's results view by view, as CSV: RFC 4180, lines that end in a line feed.
// SPDX-License-Identifier: MIT
#include "records.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static int put(buffer *text, const char *format, ...)
{
    char line[1024];
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(line, sizeof line, format, values);
    va_end(values);
    return length >= 0 && (size_t)length < sizeof line && buffer_append(text, line, (size_t)length) != NULL;
}

// In quotes always: chains have commas in them.
static int put_name(buffer *text, const char *name)
{
    int good = buffer_append(text, "\"", 1) != NULL;
    for (const char *c = name; *c && good; ++c) good = (*c != '"' || buffer_append(text, "\"", 1)) && buffer_append(text, c, 1) != NULL;
    return good && buffer_append(text, "\"", 1) != NULL;
}

static uint64_t missed_most(const records *r, uint32_t strategy, uint32_t view)
{
    uint64_t most = 0;
    for (uint32_t p = 0; p < r->passes; ++p)
        if (records_pass(r, strategy, p, view)->missed_pixels > most) most = records_pass(r, strategy, p, view)->missed_pixels;
    return most;
}

static int put_counts(buffer *text, const counted_record *c)
{
    return put(text, ",%llu,%llu,%llu,%llu,%llu,%u,%u,%u,%u,%u,%u,%u,%u,%u,%u,%u,%llu", (unsigned long long)c->polygons, (unsigned long long)c->triangles,
               (unsigned long long)c->items, (unsigned long long)c->runs, (unsigned long long)c->mover_polygons, c->zones, c->volumes, c->crossings, c->queries,
               c->steps, c->draw_calls, c->state_changes, c->captures, c->portal_merges, c->limits_hit, c->stalls, (unsigned long long)c->picture_bytes);
}

static int put_truth(buffer *text, const counted_record *c, uint64_t missed)
{
    return put(text, ",%llu,%llu,%llu,%llu,%llu,%llu", (unsigned long long)c->polygons_visible, (unsigned long long)c->polygons_items,
               (unsigned long long)c->items_visible, (unsigned long long)c->floor_items, (unsigned long long)c->mover_polygons_visible, (unsigned long long)missed);
}

static int put_pictures(buffer *text, const picture_record *p)
{
    if (!p->is_measured) return put(text, ",,,%llu", (unsigned long long)(p->holes + p->spills));
    int good = put(text, ",%.17g", p->flip);
    good = good && (p->has_ssim ? put(text, ",%.17g", p->ssim) : put(text, ","));
    good = good && (p->has_popping ? put(text, ",%.17g", p->popping) : put(text, ","));
    return good && put(text, ",%llu", (unsigned long long)(p->holes + p->spills));
}

static int put_view(buffer *text, const bench_result *b, const bench_request *q, uint32_t strategy, uint32_t view, double *scratch)
{
    const records *r = b->records;
    const counted_record *c = records_counted(r, strategy, view);
    const double cull_ns = records_time(r, q, strategy, view, (time_weights){1, 0}, scratch), gl_ms = records_time(r, q, strategy, view, (time_weights){0, 1}, scratch);
    int good = put_name(text, b->rows[strategy].name) && put(text, ",%u,%d,%.17g,", view, view < bench_warmup_views(q->path), cull_ns);
    if (b->gl_used) good = good && put(text, "%.17g", gl_ms);
    good = good && put_counts(text, c);
    good = good && (q->truth == BENCH_TRUTH ? put_truth(text, c, missed_most(r, strategy, view)) : put(text, ",,,,,,"));
    good = good && (r->has_pictures[strategy] ? put_pictures(text, records_picture(r, strategy, view)) : put(text, ",,,,"));
    return good && put(text, "\n");
}

static int put_all(buffer *text, const bench_result *b, const bench_request *q, double *scratch)
{
    int good = put(text, "strategy,view,is_warmup,cull_ns,gl_ms,polygons_drawn,triangles_drawn,items_drawn,runs,movers_drawn,zones,volumes,crossings,queries,steps,"
                         "draw_calls,state_changes,refreshes,portal_merges,limits_hit,stalls,picture_bytes,polygons_visible,polygons_items,items_visible,floor,"
                         "movers_visible,missed_pixels,flip,ssim,popping,crack_pixels\n");
    for (uint32_t k = 0; k < b->row_count; ++k)
        for (uint32_t v = 0; v < b->views && good; ++v) good = put_view(text, b, q, k, v, scratch);
    return good;
}

result bench_frames(const bench_result *b, const bench_request *q, const bench_labels *labels, bench_text *out)
{
    (void)labels;
    const allocator *memory = q->services->memory;
    buffer text = buffer_make(memory, 1);
    char *copy = NULL;
    double *scratch = memory_alloc(memory, q->repeat, sizeof *scratch);
    if (scratch && put_all(&text, b, q, scratch)) copy = memory_alloc(memory, text.count + 1, 1);
    if (copy) {
        memcpy(copy, text.items, text.count);
        copy[text.count] = 0;
        *out = (bench_text){copy, text.count};
    }
    memory_free(memory, scratch, q->repeat, sizeof *scratch);
    buffer_free(&text);
    return copy ? RESULT_OK : RESULT_NO_MEMORY;
}
