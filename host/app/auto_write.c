// Where `portcullis auto` writes its choice: see auto_write.h.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "auto_write.h"
#include "../../bench/json_text.h"
#include "../compile/pcs_write.h"
#include "../core/file.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

static int ends_with(const char *path, const char *ending)
{
    const size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcmp(path + length - tail, ending) == 0;
}

static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

// Both exist by then, or at least the folders do.
static int are_beside(const char *a, const char *b, arena *texts)
{
    const char *folders[2] = {arena_text(texts, a, folder_length(a)), arena_text(texts, b, folder_length(b))};
    if (!folders[0] || !folders[1]) return 0;
    char *real[2];
    for (int i = 0; i < 2; ++i) real[i] = realpath(*folders[i] ? folders[i] : ".", NULL);
    const int same = real[0] && real[1] && strcmp(real[0], real[1]) == 0;
    free(real[0]);
    free(real[1]);
    return same;
}

static int names_files(json_t *node)
{
    const char *key;
    json_t *value;
    size_t i;
    json_array_foreach(node, i, value) if (names_files(value)) return 1;
    json_object_foreach(node, key, value) if (strcmp(key, "file") == 0 || names_files(value)) return 1;
    return 0;
}

static json_t *zone_named(json_t *zones, const char *name)
{
    size_t i;
    json_t *zone;
    json_array_foreach(zones, i, zone)
    {
        const char *have = json_string_value(json_object_get(zone, "name"));
        if (have && strcmp(have, name) == 0) return zone;
    }
    return NULL;
}

static result load(app *a, const char *path, json_t **out)
{
    char *text;
    size_t size;
    const result done = file_read(path, a->memory, &a->report, &text, &size);
    if (done != RESULT_OK) return done;
    json_error_t error;
    *out = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
    memory_free(a->memory, text, size + 1, 1);
    return *out ? RESULT_OK : report_error(&a->report, path, (size_t)(error.line > 0 ? error.line : 0), "%s", error.text);
}

static result refuse_zone(app *a, const char *scene_path, const char *name)
{
    return report_error(&a->report, scene_path, 0, "the zone '%s' comes from a file that this one includes; write OUT.pcs instead of a .json", name);
}

// A scene without zones has one, "all".
static result set_chains(app *a, const char *scene_path, json_t *root)
{
    const scene *s = a->scene;
    json_t *zones = json_object_get(root, "zones");
    if (!zones) {
        zones = json_array();
        if (!zones || json_object_set_new(root, "zones", zones) != 0) return report_no_memory(&a->report, scene_path);
        if (json_array_append_new(zones, json_pack("{s:o}", "name", json_text(s->zones[0].name))) != 0) return report_no_memory(&a->report, scene_path);
    }
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        if (s->zones[z].flags & ZONE_STRAY || !s->zones[z].chain) continue;
        json_t *zone = zone_named(zones, s->zones[z].name);
        if (!zone) return refuse_zone(a, scene_path, s->zones[z].name);
        if (json_object_set_new(zone, "chain", json_text(s->zones[z].chain)) != 0) return report_no_memory(&a->report, scene_path);
    }
    return RESULT_OK;
}

static result write_json(app *a, json_t *root, const char *out_path)
{
    char *text = json_dumps(root, JSON_INDENT(1) | JSON_REAL_PRECISION(17));
    if (!text) return report_no_memory(&a->report, out_path);
    const result done = file_write(out_path, text, strlen(text), &a->report);
    free(text);
    return done;
}

static result write_of_json(app *a, const char *scene_path, const char *out_path)
{
    json_t *root = NULL;
    result done = load(a, scene_path, &root);
    if (done == RESULT_OK) done = set_chains(a, scene_path, root);
    if (done == RESULT_OK) done = write_json(a, root, out_path);
    json_decref(root);
    return done;
}

// A new scene of one zone, which includes the geometry.
static result write_of_geometry(app *a, const char *scene_path, const char *out_path)
{
    char *real = are_beside(scene_path, out_path, &a->texts) ? NULL : realpath(scene_path, NULL);
    const char *file = real ? real : scene_path + folder_length(scene_path);
    json_t *root = json_pack("{s:i, s:[{s:o}]}", "portcullis", 1, "include", "file", json_text(file));
    result done = root ? set_chains(a, scene_path, root) : report_no_memory(&a->report, out_path);
    if (done == RESULT_OK) done = write_json(a, root, out_path);
    json_decref(root);
    free(real);
    return done;
}

result auto_can_write(app *a, const char *scene_path, const char *out_path)
{
    const result done = file_can_write(out_path, &a->report);
    if (done != RESULT_OK || ends_with(out_path, ".pcs")) return done;
    if (!ends_with(out_path, ".json")) return report_error(&a->report, out_path, 0, "takes a name that ends in .json or .pcs");
    if (ends_with(scene_path, ".pcs")) return report_error(&a->report, out_path, 0, "a compiled scene's chains go to a .pcs; name one");
    if (!ends_with(scene_path, ".json")) return RESULT_OK;
    json_t *root = NULL;
    result loaded = load(a, scene_path, &root);
    if (loaded == RESULT_OK && names_files(root) && !are_beside(scene_path, out_path, &a->texts))
        loaded = report_error(&a->report, out_path, 0, "must lie beside %s, which names files by their place", scene_path);
    for (uint32_t z = 0; loaded == RESULT_OK && z < a->scene->zone_count && a->scene->zone_count > 1; ++z)
        if (!(a->scene->zones[z].flags & ZONE_STRAY) && !zone_named(json_object_get(root, "zones"), a->scene->zones[z].name))
            loaded = refuse_zone(a, scene_path, a->scene->zones[z].name);
    json_decref(root);
    return loaded;
}

result auto_write(app *a, const char *scene_path, const char *out_path)
{
    if (ends_with(out_path, ".pcs")) return pcs_write(&(pcs_request){.scene = a->scene}, out_path, a->memory, &a->report);
    return ends_with(scene_path, ".json") ? write_of_json(a, scene_path, out_path) : write_of_geometry(a, scene_path, out_path);
}
