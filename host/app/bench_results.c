// What `bench` and `merge` tell: see bench_results.h.
// SPDX-License-Identifier: MIT
#include "bench_results.h"

#include "../core/file.h"

#include <stdio.h>
#include <string.h>

static void print_text(const bench_text *text, FILE *to)
{
    fwrite(text->bytes, 1, text->size, to);
}

static result write_text(report *r, const char *file, const bench_text *text)
{
    if (strcmp(file, "-") != 0) return file_write(file, text->bytes, text->size, r);
    print_text(text, stdout);
    if (text->size && text->bytes[text->size - 1] != '\n') printf("\n");
    return RESULT_OK;
}

int is_stdout(const char *file)
{
    return file && strcmp(file, "-") == 0;
}

typedef result (*text_maker)(const bench_result *b, const bench_request *q, const bench_labels *labels, bench_text *out);

typedef struct writing {
    const allocator *memory;
    report *r;
    const bench_output *o;
    const bench_result *b;
} writing;

static result write_made(const writing *w, text_maker make, const char *file)
{
    bench_text text;
    if (!file) return RESULT_OK;
    if (make(w->b, w->o->bench, w->o->labels, &text) != RESULT_OK) return report_no_memory(w->r, NULL);
    const result done = write_text(w->r, file, &text);
    memory_free(w->memory, text.bytes, text.size + 1, 1);
    return done;
}

result bench_results_write(const allocator *memory, report *r, const bench_output *o, const bench_result *b)
{
    const writing w = {memory, r, o, b};
    bench_text text;
    if (bench_table(b, o->bench, o->labels, &text) != RESULT_OK) return report_no_memory(r, NULL);
    print_text(&text, is_stdout(o->json) || is_stdout(o->csv) || is_stdout(o->frames) ? stderr : stdout);
    memory_free(memory, text.bytes, text.size + 1, 1);
    result done = write_made(&w, bench_json, o->json);
    if (done == RESULT_OK) done = write_made(&w, bench_csv, o->csv);
    return done == RESULT_OK ? write_made(&w, bench_frames, o->frames) : done;
}

result bench_results_check(report *r, const bench_output *o)
{
    const char *const files[] = {o->json, o->csv, o->frames};
    result done = RESULT_OK;
    for (int i = 0; i < 3 && done == RESULT_OK; ++i)
        if (files[i] && !is_stdout(files[i])) done = file_can_write(files[i], r);
    return done;
}

uint32_t bench_results_tell_failures(report *r, const bench_request *q, const bench_result *b)
{
    uint32_t failed = 0;
    for (uint32_t i = 0; i < b->row_count; ++i) {
        const bench_row *row = &b->rows[i];
        if (row->picture_differs)
            report_error(r, NULL, 0, "%s: %llu pixels of %u views show something else than the items that it says it drew", row->name,
                         (unsigned long long)row->picture_differs, row->pictures_compared);
        else if (bench_check_failed(row))
            report_error(r, NULL, 0, "%s promises to lose nothing, and missed %llu pixels and %llu items; worst is view %u", row->name,
                         (unsigned long long)row->missed_pixels, (unsigned long long)row->missed_items, row->worst_view);
        failed += bench_check_failed(row);
        if (q->truth == BENCH_TRUTH && row->items_visible <= 0 && i == 0)
            report_warning(r, NULL, 0, "no view of this path sees anything; that nothing is missed says nothing");
    }
    return failed;
}
