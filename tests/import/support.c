// See support.h.
// SPDX-License-Identifier: MIT
#include "support.h"

#include "host/core/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const import_options doors_open = {DOORS_OPEN}, doors_shut = {DOORS_SHUT};
const char *const real_maps[8] = {"quake/dm4.map",          "quake/e1m1.map",          "quake/e1m4.map",        "quake/e3m5.map",
                                  "librequake/lqdm12.map", "librequake/lq_e0m8.map", "librequake/lqdm7.map", "librequake/lq_e3m4.map"};

static void keep_line(void *user, report_level level, const char *text)
{
    heard *h = user;
    if (level == REPORT_NOTE) h->notes++;
    h->level = level;
    snprintf(h->text, sizeof h->text, "%s", text);
}

report hear(heard *h)
{
    *h = (heard){0};
    return (report){.line = keep_line, .user = h};
}

static void *shaky_alloc(void *user, size_t size, size_t align)
{
    shaky_memory *m = user;
    if (++m->allocations == m->fail_at) return NULL;
    const allocator *heap = allocator_heap();
    void *block = heap->alloc(heap->user, size, align);
    if (block) m->live_bytes += size;
    return block;
}

static void shaky_free(void *user, void *block, size_t size)
{
    shaky_memory *m = user;
    m->live_bytes -= size;
    const allocator *heap = allocator_heap();
    heap->free(heap->user, block, size);
}

allocator shaky_allocator(shaky_memory *m)
{
    return (allocator){shaky_alloc, shaky_free, m};
}

scene *map_of(const char *text, const import_options *options)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    if (import_map("t.map", text, strlen(text), options, allocator_heap(), &r, &s) != RESULT_OK) fail_msg("%s", h.text);
    if (r.warnings) fail_msg("%s", h.text);
    return s;
}

void expect_map_error(const char *text, const char *line)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    assert_int_equal(import_map("t.map", text, strlen(text), &doors_open, allocator_heap(), &r, &s), RESULT_BAD_INPUT);
    assert_null(s);
    assert_int_equal(r.errors, 1);
    assert_string_equal(h.text, line);
}

char *real_scene(const char *name, size_t *out_size)
{
    const char *folder = getenv("PORTCULLIS_SCENES");
    char path[1024];
    char *text = NULL;
    snprintf(path, sizeof path, "%s/%s", folder ? folder : ".", name);
    report silent = {0};
    if (!folder || file_read(path, allocator_heap(), &silent, &text, out_size) != RESULT_OK) {
        fprintf(stderr, "SKIPPED: the scene %s is not in PORTCULLIS_SCENES (%s)\n", name, folder ? folder : "not set");
        return NULL;
    }
    return text;
}
