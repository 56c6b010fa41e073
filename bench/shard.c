// Shards: see shard.h.
// SPDX-License-Identifier: MIT
#include "shard.h"
#include "commit.h"
#include "json_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

view_range shard_range(const bench_shard *s, uint32_t views)
{
    if (!s->count) return (view_range){0, views};
    return (view_range){(uint32_t)((uint64_t)views * (s->index - 1) / s->count), (uint32_t)((uint64_t)views * s->index / s->count)};
}

// A whole number up to the closing byte; 0 when it is none.
static int read_number(const char *text, char closing, uint32_t *out, const char **end)
{
    uint32_t value = 0;
    const char *at = text;
    for (; *at >= '0' && *at <= '9' && value <= SHARDS_MOST; ++at) value = value * 10 + (uint32_t)(*at - '0');
    *out = value;
    *end = at + 1;
    return at > text && *at == closing && value <= SHARDS_MOST;
}

int shard_parse(const char *text, bench_shard *out)
{
    const char *rest;
    bench_shard s = {0};
    if (!read_number(text, '/', &s.index, &rest) || !read_number(rest, 0, &s.count, &rest)) return 0;
    if (s.index < 1 || s.index > s.count) return 0;
    out->index = s.index;
    out->count = s.count;
    return 1;
}

int shard_of_environment(const char *(*variable)(const char *name), bench_shard *out)
{
    static const char *const names[][2] = {{"SLURM_PROCID", "SLURM_NTASKS"}, {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, {"PMI_RANK", "PMI_SIZE"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        const char *rank = variable(names[i][0]), *size = variable(names[i][1]), *rest;
        uint32_t index = 0, count = 0;
        if (!rank || !size || !read_number(rank, 0, &index, &rest) || !read_number(size, 0, &count, &rest)) continue;
        if (count < 2 || index >= count) continue;
        out->index = index + 1;
        out->count = count;
        return 1;
    }
    return 0;
}

// ---- What parts must agree on ----

static void hash_text(uint64_t hash, char out[24])
{
    snprintf(out, 24, "%016llx", (unsigned long long)hash);
}

static uint64_t path_hash(const camera_path *path)
{
    uint64_t hash = path->count;
    for (uint32_t v = 0; v < path->count; ++v) {
        const camera *c = &path->cameras[v];
        double numbers[13];
        for (int k = 0; k < 3; ++k) {
            numbers[k] = c->eye[k];
            numbers[3 + k] = c->forward[k];
            numbers[6 + k] = c->up[k];
        }
        numbers[9] = c->fovy_deg;
        numbers[10] = c->aspect;
        numbers[11] = c->near_m;
        numbers[12] = c->far_m;
        hash = XXH3_64bits_withSeed(numbers, sizeof numbers, hash);
    }
    return hash;
}

static json_t *names_of(const bench_request *q)
{
    json_t *names = json_array();
    for (uint32_t k = 0; k < q->strategy_count; ++k) json_array_append_new(names, json_text(q->strategies[k].name));
    return names;
}

static json_t *identity_of(const bench_request *q, const bench_labels *labels)
{
    static const char *const truths[] = {"pixels", "none"}, *const pictures[] = {"shown", "all", "none"}, *const costs[] = {"measured", "fixed"};
    char scene_hash[24], views_hash[24];
    hash_text(q->scene->hash, scene_hash);
    hash_text(path_hash(q->path), views_hash);
    return json_pack("{s:s, s:o, s:s, s:i, s:o, s:s, s:i, s:i, s:i, s:i, s:i, s:i, s:f, s:s, s:s, s:s, s:s, s:s, s:o}", "commit", PORTCULLIS_COMMIT, "scene",
                     json_text(labels->scene), "scene_hash", scene_hash, "movers", (int)q->scene->mover_count, "path", json_text(labels->path), "views_hash",
                     views_hash, "views", (int)q->path->count, "width_px", (int)q->width_px, "height_px", (int)q->height_px, "repeat", (int)q->repeat,
                     "samples", (int)q->samples, "query_latency", (int)q->query_latency, "frame_ms", q->frame_ms, "truth", truths[q->truth], "time_of_ids",
                     q->ids == BENCH_IDS ? "counted" : "left out", "pictures", pictures[q->pictures], "costs", costs[q->costs], "doors",
                     !q->doors ? "scene" : *q->doors == DOORS_OPEN ? "open" : "shut", "strategies", names_of(q));
}

char *shard_identity(const bench_request *q, const bench_labels *labels)
{
    json_t *all = identity_of(q, labels);
    char *text = all ? json_dumps(all, JSON_COMPACT | JSON_SORT_KEYS) : NULL;
    json_decref(all);
    if (!text) return NULL;
    char *copy = memory_alloc(q->services->memory, strlen(text) + 1, 1);
    if (copy) memcpy(copy, text, strlen(text) + 1);
    free(text);
    return copy;
}
