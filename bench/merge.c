// Parts put together: see merge.h.
// SPDX-License-Identifier: MIT
#include "merge.h"
#include "commit.h"
#include "part.h"
#include "shard.h"

#include "../host/core/host.h"

#include <stdlib.h>
#include <string.h>

typedef struct merging {
    const allocator *memory;
    report *r;
    part *parts; // by shard, once they are sorted
    uint32_t count;
    merged *out;
} merging;

// ---- Which parts ----

static json_t *identity_of(const part *p)
{
    return json_object_get(p->head, "identity");
}

static result tell_difference(const merging *m, const part *a, const part *b, json_t *of_a, json_t *of_b)
{
    const char *key;
    json_t *value;
    json_object_foreach(of_a, key, value) {
        if (json_equal(value, json_object_get(of_b, key))) continue;
        char *first = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT), *second = json_dumps(json_object_get(of_b, key), JSON_ENCODE_ANY | JSON_COMPACT);
        const result done = report_error(m->r, b->path, 2, "is of another bench than %s: %s is %s, not %s; merge parts of one bench only", a->path, key,
                                         second ? second : "nothing", first ? first : "nothing");
        free(first);
        free(second);
        return done;
    }
    return report_error(m->r, b->path, 2, "is of another bench than %s; merge parts of one bench only", a->path);
}

static result check_same(const merging *m, const part *a, const part *b)
{
    json_t *const facts[] = {json_object_get(a->head, "facts"), json_object_get(b->head, "facts")};
    if (part_number(a, "shards") != part_number(b, "shards"))
        return report_error(m->r, b->path, 2, "is one of %lld shards, %s of %lld; merge parts of one bench only", (long long)part_number(b, "shards"), a->path,
                            (long long)part_number(a, "shards"));
    if (!json_equal(identity_of(a), identity_of(b))) return tell_difference(m, a, b, identity_of(a), identity_of(b));
    return json_equal(facts[0], facts[1]) ? RESULT_OK : tell_difference(m, a, b, facts[0], facts[1]);
}

static int by_shard(const void *a, const void *b)
{
    const json_int_t x = part_number(a, "shard"), y = part_number(b, "shard");
    return (x > y) - (x < y);
}

// Sorted by shard.
static result check_complete(const merging *m)
{
    const json_int_t shards = part_number(&m->parts[0], "shards");
    for (uint32_t i = 0; i < m->count; ++i) {
        const part *p = &m->parts[i];
        const json_int_t shard = part_number(p, "shard");
        if (i && shard == part_number(p - 1, "shard"))
            return report_error(m->r, p->path, 0, "is shard %lld, as %s is; name each part once", (long long)shard, p[-1].path);
        if (shard != (json_int_t)i + 1)
            return report_error(m->r, m->parts[0].path, 0, "shard %u of %lld is missing; run it with --shard %u/%lld, and name its part too", i + 1,
                                (long long)shards, i + 1, (long long)shards);
    }
    if (m->count != shards)
        return report_error(m->r, m->parts[0].path, 0, "shard %u of %lld is missing; run it with --shard %u/%lld, and name its part too", m->count + 1,
                            (long long)shards, m->count + 1, (long long)shards);
    return RESULT_OK;
}

static result read_parts(merging *m, const char *const *files)
{
    result done = RESULT_OK;
    for (uint32_t i = 0; i < m->count && done == RESULT_OK; ++i) done = part_read(files[i], m->memory, m->r, &m->parts[i]);
    for (uint32_t i = 1; i < m->count && done == RESULT_OK; ++i) done = check_same(m, &m->parts[0], &m->parts[i]);
    if (done != RESULT_OK) return done;
    qsort(m->parts, m->count, sizeof *m->parts, by_shard);
    return check_complete(m);
}

// ---- What was asked ----

static json_int_t number(const json_t *object, const char *key)
{
    return json_integer_value(json_object_get(object, key));
}

static const char *text(merging *m, const json_t *object, const char *key)
{
    const char *value = json_string_value(json_object_get(object, key));
    return value ? arena_text(&m->out->texts, value, strlen(value)) : NULL;
}

static int is_text(const json_t *object, const char *key, const char *wanted)
{
    const char *value = json_string_value(json_object_get(object, key));
    return value && strcmp(value, wanted) == 0;
}

static int fill_strategies(merging *m, const json_t *names)
{
    merged *out = m->out;
    out->request.strategy_count = (uint32_t)json_array_size(names);
    out->strategies = memory_alloc_zeroed(m->memory, out->request.strategy_count, sizeof *out->strategies);
    if (!out->strategies) return 0;
    for (uint32_t k = 0; k < out->request.strategy_count; ++k) {
        const char *name = json_string_value(json_array_get(names, k));
        out->strategies[k].name = arena_text(&out->texts, name ? name : "", name ? strlen(name) : 0);
        if (!out->strategies[k].name) return 0;
    }
    return 1;
}

static int fill_request(merging *m, const json_t *identity)
{
    merged *out = m->out;
    const char *hash = json_string_value(json_object_get(identity, "scene_hash")), *path = json_string_value(json_object_get(identity, "path"));
    out->scene = memory_alloc_zeroed(m->memory, 1, sizeof *out->scene);
    if (!out->scene || !fill_strategies(m, json_object_get(identity, "strategies"))) return 0;
    out->scene->hash = hash ? strtoull(hash, NULL, 16) : 0;
    out->path.count = (uint32_t)number(identity, "views");
    if (path) memcpy(out->path.name, path, strlen(path) < sizeof out->path.name ? strlen(path) : sizeof out->path.name - 1);
    out->labels = (bench_labels){text(m, identity, "scene"), out->path.name};
    out->services.memory = m->memory;
    const bench_request asked = {.scene = out->scene, .path = &out->path, .strategies = out->strategies, .services = &out->services,
                                 .strategy_count = out->request.strategy_count, .width_px = (uint32_t)number(identity, "width_px"),
                                 .height_px = (uint32_t)number(identity, "height_px"), .repeat = (uint32_t)number(identity, "repeat"),
                                 .samples = (uint32_t)number(identity, "samples"), .query_latency = (uint32_t)number(identity, "query_latency"),
                                 .frame_ms = json_number_value(json_object_get(identity, "frame_ms")),
                                 .truth = is_text(identity, "truth", "none") ? BENCH_NO_TRUTH : BENCH_TRUTH,
                                 .costs = is_text(identity, "costs", "fixed") ? BENCH_COSTS_FIXED : BENCH_COSTS_MEASURED};
    out->request = asked;
    return out->labels.scene != NULL;
}

static result check_request(const merging *m)
{
    const bench_request *q = &m->out->request;
    const part *p = &m->parts[0];
    if (!is_text(identity_of(p), "commit", PORTCULLIS_COMMIT))
        return report_error(m->r, p->path, 2, "was made by another commit than this program, %s; merge with the program that made it", PORTCULLIS_COMMIT);
    if (q->path->count < 1 || q->repeat < 1 || q->strategy_count < 1 || bench_warmup_views(q->path) >= q->path->count)
        return report_error(m->r, p->path, 2, "tells of no views, passes or strategies; make it again with --shard");
    return RESULT_OK;
}

// ---- Results ----

static void fill_facts(merging *m)
{
    const json_t *facts = json_object_get(m->parts[0].head, "facts");
    const char *name = json_string_value(json_object_get(facts, "gl_name"));
    bench_result *b = &m->out->result;
    b->zones = (uint32_t)number(facts, "zones");
    b->portals = (uint32_t)number(facts, "portals");
    b->plugins_opened = (uint32_t)number(facts, "plugins_opened");
    b->gl_used = (uint32_t)number(facts, "gl_used");
    b->pixels = (uint64_t)number(facts, "pixels");
    b->polygons_total = (uint64_t)number(facts, "polygons_total");
    b->items_total = (uint64_t)number(facts, "items_total");
    b->shards = m->count;
    if (name) memcpy(b->gl_name, name, strlen(name) < sizeof b->gl_name ? strlen(name) : sizeof b->gl_name - 1);
}

static int all_agree(const merging *m, uint32_t strategy, size_t figure, const json_t *value)
{
    for (uint32_t i = 1; i < m->count; ++i) {
        const json_t *row = json_array_get(json_object_get(m->parts[i].head, "rows"), strategy);
        if (!json_equal(json_array_get(json_object_get(row, "figures"), figure), value)) return 0;
    }
    return 1;
}

static void fill_figures(const merging *m, uint32_t strategy, const json_t *figures, bench_row *row)
{
    size_t i;
    const json_t *figure;
    json_array_foreach(figures, i, figure) {
        const char *name = json_string_value(json_array_get(figure, 0));
        if (!name || strlen(name) >= FIGURE_NAME_BYTES || row->figures.count == FIGURES_MOST || !all_agree(m, strategy, i, figure)) continue;
        bench_figure *f = &row->figures.list[row->figures.count++];
        memcpy(f->name, name, strlen(name) + 1);
        f->value = json_number_value(json_array_get(figure, 1));
    }
}

// Of what every process measures for itself, the first shard's.
static result fill_rows(const merging *m)
{
    bench_result *b = &m->out->result;
    for (uint32_t k = 0; k < b->row_count; ++k) {
        const json_t *row = json_array_get(json_object_get(m->parts[0].head, "rows"), k);
        b->rows[k].build_ms = json_number_value(json_object_get(row, "build_ms"));
        b->rows[k].index_bytes = (uint64_t)number(row, "index_bytes");
        b->rows[k].indices_built = (uint32_t)number(row, "indices_built");
        b->rows[k].front_walls_only = (uint32_t)number(row, "front_walls_only");
        b->records->has_pictures[k] = (uint8_t)(number(row, "has_pictures") != 0);
        fill_figures(m, k, json_object_get(row, "figures"), &b->rows[k]);
        for (uint32_t i = 1; i < m->count; ++i) {
            const json_t *other = json_array_get(json_object_get(m->parts[i].head, "rows"), k);
            if (number(other, "index_bytes") == number(row, "index_bytes") && number(other, "has_pictures") == number(row, "has_pictures")) continue;
            return report_error(m->r, m->parts[i].path, 2, "%s: an index of another size than in %s; measure all shards with the same plugins", b->rows[k].name,
                                m->parts[0].path);
        }
    }
    return RESULT_OK;
}

static result take_records(const merging *m)
{
    const bench_request *q = &m->out->request;
    uint64_t views = 0;
    result done = RESULT_OK;
    for (uint32_t i = 0; i < m->count && done == RESULT_OK; ++i) {
        const view_range range = shard_range(&(bench_shard){.index = i + 1, .count = m->count}, q->path->count);
        if (part_number(&m->parts[i], "first") != range.first || part_number(&m->parts[i], "count") != range.end - range.first)
            return report_error(m->r, m->parts[i].path, 2, "does not have the views of shard %u of %u; make it again", i + 1, m->count);
        views += range.end - range.first;
        done = part_take(&m->parts[i], m->r, m->out->result.records);
    }
    return done == RESULT_OK && views != q->path->count ? report_error(m->r, m->parts[0].path, 0, "the parts don't make up the path; make them again") : done;
}

static result merge_parts(merging *m)
{
    merged *out = m->out;
    if (!fill_request(m, identity_of(&m->parts[0]))) return report_no_memory(m->r, NULL);
    result done = check_request(m);
    if (done != RESULT_OK) return done;
    if (bench_result_open(&out->request, &out->result) != RESULT_OK) return report_no_memory(m->r, NULL);
    if (records_open(&out->request, 0, out->path.count, out->result.records) != RESULT_OK) return report_no_memory(m->r, NULL);
    done = take_records(m);
    if (done == RESULT_OK) fill_facts(m);
    if (done == RESULT_OK) done = fill_rows(m);
    if (done == RESULT_OK && records_fill(out->result.records, &out->request, &out->result) != RESULT_OK) done = report_no_memory(m->r, NULL);
    return done;
}

result merge_open(const char *const *files, uint32_t count, const allocator *memory, report *r, merged *out)
{
    *out = (merged){.texts = arena_make(memory)};
    merging m = {.memory = memory, .r = r, .count = count, .out = out};
    m.parts = memory_alloc_zeroed(memory, count, sizeof *m.parts);
    result done = m.parts ? read_parts(&m, files) : report_no_memory(r, NULL);
    if (done == RESULT_OK) done = merge_parts(&m);
    for (uint32_t i = 0; m.parts && i < count; ++i) part_close(&m.parts[i]);
    memory_free(memory, m.parts, count, sizeof *m.parts);
    out->services.memory = memory;
    if (done != RESULT_OK) merge_close(out);
    return done;
}

void merge_close(merged *m)
{
    const allocator *memory = m->services.memory;
    if (!memory) return;
    if (m->result.memory) bench_result_free(&m->result);
    memory_free(memory, m->scene, 1, sizeof *m->scene);
    memory_free(memory, m->strategies, m->request.strategy_count, sizeof *m->strategies);
    arena_free(&m->texts);
    *m = (merged){0};
}
