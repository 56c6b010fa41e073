// Parts: see part.h.
// SPDX-License-Identifier: MIT
#include "part.h"
#include "json_text.h"

#include "../host/core/file.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

static const char MAGIC[] = "portcullis part 1\n";
static const uint64_t BYTE_ORDER_MARK = UINT64_C(0x0102030405060708);

// ---- Writing ----

static json_t *figures_of(const bench_figures *f)
{
    json_t *all = json_array();
    for (uint32_t i = 0; i < f->count; ++i) json_array_append_new(all, json_pack("[s, f]", f->list[i].name, f->list[i].value));
    return all;
}

static json_t *rows_of(const bench_result *b)
{
    json_t *rows = json_array();
    for (uint32_t k = 0; k < b->row_count; ++k) {
        const bench_row *row = &b->rows[k];
        json_array_append_new(rows, json_pack("{s:f, s:I, s:i, s:i, s:i, s:o}", "build_ms", row->build_ms, "index_bytes", (json_int_t)row->index_bytes,
                                              "indices_built", (int)row->indices_built, "front_walls_only", (int)row->front_walls_only, "has_pictures",
                                              (int)b->records->has_pictures[k], "figures", figures_of(&row->figures)));
    }
    return rows;
}

static json_t *facts_of(const bench_result *b)
{
    return json_pack("{s:i, s:i, s:i, s:i, s:o, s:I, s:I, s:I}", "zones", (int)b->zones, "portals", (int)b->portals, "plugins_opened", (int)b->plugins_opened,
                     "gl_used", (int)b->gl_used, "gl_name", json_text(b->gl_name), "pixels", (json_int_t)b->pixels, "polygons_total",
                     (json_int_t)b->polygons_total, "items_total", (json_int_t)b->items_total);
}

static json_t *head_of(const bench_request *q, const bench_result *b)
{
    json_t *identity = json_loads(q->shard.identity, 0, NULL);
    if (!identity) return NULL;
    return json_pack("{s:o, s:i, s:i, s:i, s:i, s:i, s:[i, i, i], s:o, s:o}", "identity", identity, "shard", (int)q->shard.index, "shards", (int)q->shard.count,
                     "first", (int)b->records->first, "count", (int)b->records->count, "passes", (int)b->records->passes, "record_bytes",
                     (int)sizeof(counted_record), (int)sizeof(pass_record), (int)sizeof(picture_record), "facts", facts_of(b), "rows", rows_of(b));
}

static int put_records(buffer *text, const records *r)
{
    const size_t views = (size_t)r->strategies * r->count;
    return buffer_append(text, &BYTE_ORDER_MARK, sizeof BYTE_ORDER_MARK) && buffer_append(text, r->counted, views * sizeof *r->counted) &&
           buffer_append(text, r->timed, views * r->passes * sizeof *r->timed) && buffer_append(text, r->pictures, views * sizeof *r->pictures);
}

static int put_all(buffer *text, const bench_request *q, const bench_result *b)
{
    json_t *head = head_of(q, b);
    char *line = head ? json_dumps(head, JSON_COMPACT) : NULL;
    json_decref(head);
    int good = line && buffer_append(text, MAGIC, sizeof MAGIC - 1) && buffer_append(text, line, strlen(line)) && buffer_append(text, "\n", 1);
    free(line);
    good = good && put_records(text, b->records);
    if (!good) return 0;
    const uint64_t hash = XXH3_64bits(text->items, text->count);
    return buffer_append(text, &hash, sizeof hash) != NULL;
}

result part_write(const bench_request *q, const bench_result *b, report *r)
{
    buffer text = buffer_make(q->services->memory, 1);
    const result done = put_all(&text, q, b) ? file_write(q->shard.part, text.items, text.count, r) : report_no_memory(r, q->shard.part);
    buffer_free(&text);
    return done;
}

// ---- Reading ----

json_int_t part_number(const part *p, const char *key)
{
    const json_t *value = json_object_get(p->head, key);
    return json_is_integer(value) ? json_integer_value(value) : -1;
}

static int is_whole(const part *p)
{
    uint64_t hash;
    if (p->size < sizeof MAGIC - 1 + sizeof hash || memcmp(p->bytes, MAGIC, sizeof MAGIC - 1) != 0) return 0;
    memcpy(&hash, p->bytes + p->size - sizeof hash, sizeof hash);
    return hash == XXH3_64bits(p->bytes, p->size - sizeof hash);
}

static int has_sizes(const part *p)
{
    const json_t *sizes = json_object_get(p->head, "record_bytes");
    const size_t wanted[] = {sizeof(counted_record), sizeof(pass_record), sizeof(picture_record)};
    for (size_t i = 0; i < 3; ++i)
        if (json_integer_value(json_array_get(sizes, i)) != (json_int_t)wanted[i]) return 0;
    return 1;
}

// The numbers that places are found by.
static int has_numbers(const part *p)
{
    static const char *const keys[] = {"shard", "shards", "first", "count", "passes"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; ++i)
        if (part_number(p, keys[i]) < 0 || part_number(p, keys[i]) > UINT32_MAX) return 0;
    return json_is_object(json_object_get(p->head, "identity")) && json_is_object(json_object_get(p->head, "facts")) &&
           json_is_array(json_object_get(p->head, "rows")) && part_number(p, "shard") >= 1;
}

static result parse(part *p, report *r)
{
    json_error_t error;
    if (!is_whole(p)) return report_error(r, p->path, 0, "is no whole part of a bench; make it again with --shard");
    const char *line = p->bytes + sizeof MAGIC - 1, *end = memchr(line, '\n', p->size - (sizeof MAGIC - 1));
    if (end) p->head = json_loadb(line, (size_t)(end - line), JSON_REJECT_DUPLICATES, &error);
    if (!p->head || !has_numbers(p)) return report_error(r, p->path, 2, "does not say what it is a part of; make it again with --shard");
    p->records_at = (size_t)(end + 1 - p->bytes) + sizeof BYTE_ORDER_MARK;
    if (!has_sizes(p) || p->records_at > p->size || memcmp(end + 1, &BYTE_ORDER_MARK, sizeof BYTE_ORDER_MARK) != 0)
        return report_error(r, p->path, 0, "was written by another program or kind of machine; merge with the program that made it");
    return RESULT_OK;
}

result part_read(const char *path, const allocator *memory, report *r, part *out)
{
    *out = (part){.path = path, .memory = memory};
    result done = file_read_most(path, SIZE_MAX >> 1, memory, r, &out->bytes, &out->size);
    if (done == RESULT_OK) done = parse(out, r);
    if (done != RESULT_OK) part_close(out);
    return done;
}

void part_close(part *p)
{
    if (!p->memory) return;
    json_decref(p->head);
    if (p->bytes) memory_free(p->memory, p->bytes, p->size + 1, 1);
    *p = (part){0};
}

result part_take(const part *p, report *r, records *out)
{
    const uint64_t rows = json_array_size(json_object_get(p->head, "rows")), passes = (uint64_t)part_number(p, "passes");
    const uint64_t first = (uint64_t)part_number(p, "first"), count = (uint64_t)part_number(p, "count");
    const size_t of_strategy = sizeof(counted_record) + passes * sizeof(pass_record) + sizeof(picture_record);
    if (rows != out->strategies || passes != out->passes || first + count > out->count)
        return report_error(r, p->path, 2, "has strategies, passes or views that the others have not; merge parts of one bench only");
    if (p->size - p->records_at - sizeof(uint64_t) != rows * count * of_strategy)
        return report_error(r, p->path, 0, "has not the records that it tells of; make it again with --shard");
    const char *at = p->bytes + p->records_at;
    for (uint32_t k = 0; k < rows; ++k, at += count * sizeof(counted_record)) memcpy(&out->counted[k * out->count + first], at, count * sizeof(counted_record));
    for (uint64_t k = 0; k < rows * passes; ++k, at += count * sizeof(pass_record)) memcpy(&out->timed[k * out->count + first], at, count * sizeof(pass_record));
    for (uint32_t k = 0; k < rows; ++k, at += count * sizeof(picture_record)) memcpy(&out->pictures[k * out->count + first], at, count * sizeof(picture_record));
    return RESULT_OK;
}
