// The files that a JSON scene is made of: each is read and parsed once, however often it is included.
// SPDX-License-Identifier: MIT
// Invariant: what all includes together make is bounded by the text they stand for, each counted as often as it stands.
#include "json_scene.h"

#include <stdio.h>
#include <string.h>

enum { PLACE_BYTES = 512 };
static const uint64_t PARSED_BYTES_MOST = (uint64_t)1 << 28; // of different files: parsed, a byte takes some 30
static const uint64_t INCLUDED_BYTES_MOST = (uint64_t)1 << 30; // of all documents: each makes its own parts

typedef struct json_source { // of number `named.number` of source_names
    json_file file;
    char *own_text; // NULL: the job's
    size_t own_bytes;
} json_source;

static size_t byte_order_mark(const char *text, size_t size) // UTF-8's
{
    return size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

// jansson tells the end of the word that it stumbles over, and the word: its beginning is where people look.
static json_place place_of(const json_file *f, const json_error_t *error)
{
    static const char before[] = " near '";
    size_t at = error->position > 0 ? (size_t)error->position : 0;
    const char *near = strstr(error->text, before);
    const size_t word = near ? strlen(near + sizeof before - 1) - 1 : 0; // less the closing quote
    if (at > f->size) at = f->size;
    return json_place_at(f->text, word <= at ? at - word : at);
}

static result parse(json_file *f)
{
    json_error_t error;
    f->root = json_loadb(f->text, f->size, JSON_REJECT_DUPLICATES | JSON_DECODE_INT_AS_REAL, &error);
    if (f->root) return RESULT_OK;
    const enum json_error_code code = json_error_code(&error);
    if (code == json_error_out_of_memory) return report_no_memory(f->report, f->path);
    char place[PLACE_BYTES];
    const json_place p = place_of(f, &error);
    snprintf(place, sizeof place, "%.480s:%zu", f->path, p.line);
    if (code == json_error_null_character || code == json_error_null_byte_in_key)
        return report_error(f->report, place, p.column, "a text holds \\u0000, which no name can; take it out");
    return report_error(f->report, place, p.column, "not JSON: %s; correct it", error.text);
}

result source_add(json_scene *s, const char *path, source_text text, json_file *out)
{
    const size_t mark = byte_order_mark(text.bytes, text.size);
    json_source source = {.file = {.path = path, .text = text.bytes + mark, .size = text.size - mark, .report = s->job->report},
                          .own_text = text.own,
                          .own_bytes = text.size + 1};
    result done = RESULT_OK;
    s->parsed_bytes += text.size;
    if (s->parsed_bytes > PARSED_BYTES_MOST)
        done = report_error(s->job->report, path, 0, "over %llu bytes of JSON in all files; put geometry into .obj files",
                            (unsigned long long)PARSED_BYTES_MOST);
    if (done == RESULT_OK) done = parse(&source.file);
    if (done == RESULT_OK) {
        done = name_table_add(&s->source_names, path, (uint32_t)s->sources.count);
        if (done == RESULT_OK && !buffer_append(&s->sources, &source, 1)) done = RESULT_NO_MEMORY;
        if (done == RESULT_NO_MEMORY) report_no_memory(s->job->report, path);
    }
    if (done == RESULT_OK) *out = source.file;
    else {
        json_decref(source.file.root);
        if (text.own) memory_free(s->job->memory, text.own, text.size + 1, 1);
    }
    return done;
}

static result find_or_read(const json_entry *e, const json_node *file, const char *path, json_file *out)
{
    json_scene *s = e->scene;
    const named *known = name_table_find(&s->source_names, path);
    if (known) {
        *out = ((const json_source *)s->sources.items)[known->number].file;
        return RESULT_OK;
    }
    source_text text = {0};
    const result done = entry_text(e, file, path, &text.own, &text.size);
    text.bytes = text.own;
    return done == RESULT_OK ? source_add(s, path, text, out) : done;
}

result source_find(const json_entry *e, const json_node *file, const char *path, json_file *out)
{
    const result done = find_or_read(e, file, path, out);
    if (done != RESULT_OK) return done;
    e->scene->included_bytes += out->size;
    if (e->scene->included_bytes <= INCLUDED_BYTES_MOST) return RESULT_OK;
    return node_fault(file, "with this, all includes together stand for over %llu bytes of JSON; include fewer or smaller scenes",
                      (unsigned long long)INCLUDED_BYTES_MOST);
}

void sources_open(json_scene *s)
{
    s->sources = buffer_make(s->job->memory, sizeof(json_source));
    s->source_names = name_table_make(s->job->memory);
}

void sources_free(json_scene *s)
{
    const json_source *sources = s->sources.items;
    for (size_t i = 0; i < s->sources.count; ++i) {
        json_decref(sources[i].file.root);
        if (sources[i].own_text) memory_free(s->job->memory, sources[i].own_text, sources[i].own_bytes, 1);
    }
    buffer_free(&s->sources);
    name_table_free(&s->source_names);
}
