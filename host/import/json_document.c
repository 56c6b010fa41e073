// The documents of a JSON scene: follows includes of .json, tells cycles.
// SPDX-License-Identifier: MIT
// Invariant: a document's file is open once in any chain of includes, and no chain is longer than DEPTH_MOST.
#include "json_scene.h"

#include <stdio.h>
#include <string.h>

enum { DEPTH_MOST = 64, CHAIN_BYTES = 512, PATH_BYTES = 4096, PIECES_MOST = 65536, FORMAT = 1 };

static const char *const top_keys[] = {"portcullis", "name",  "include", "meshes", "boxes", "walls",   "zones",
                                       "portals",    "doors", "movers",  "lights", "paths", "brushes", "zone_info", "starts", "$schema", NULL};
static const char *const include_keys[] = {"file", "name", PLACEMENT_KEYS, NULL};

// ---- Paths ----

// Takes "./" and "name/.." out, as text: links are not followed, so a cycle over one ends at DEPTH_MOST.
static void straighten(char *path)
{
    char *const first = path + (*path == '/'), *to = first;
    for (const char *at = first; *at;) {
        const size_t length = strcspn(at, "/"), step = length + (at[length] == '/');
        char *last = to > first ? to - 1 : to;
        while (last > first && last[-1] != '/') last--;
        const int is_up = length == 2 && memcmp(at, "..", 2) == 0, is_nothing = length == 0 || (length == 1 && *at == '.');
        if (is_up && to > first && memcmp(last, "../", 3) != 0) to = last;
        else if (!is_nothing) {
            memmove(to, at, step);
            to += step;
        }
        at += step;
    }
    *to = 0;
}

result entry_file(const json_entry *e, const json_node *file, const char **out_path)
{
    const char *name, *above = e->document->file.path, *slash = strrchr(above, '/');
    char path[PATH_BYTES];
    const result done = node_text(file, &name);
    if (done != RESULT_OK) return done;
    const int folder = slash && *name != '/' ? (int)(slash - above) + 1 : 0;
    const int length = snprintf(path, sizeof path, "%.*s%s", folder, above, name);
    if (length < 0 || length >= PATH_BYTES) return node_fault(file, "a path of over %d bytes; shorten it", PATH_BYTES - 1);
    straighten(path);
    *out_path = arena_text(&e->scene->memory, path, strlen(path));
    return *out_path ? RESULT_OK : entry_no_memory(e);
}

result entry_count_piece(const json_entry *e)
{
    if (e->scene->pieces == PIECES_MOST) return node_fault(&e->node, "over %d files and copies in one scene; use fewer", PIECES_MOST);
    e->scene->pieces++;
    return RESULT_OK;
}

// ---- Includes ----

typedef struct load_request { // what is to be opened
    const char *path, *prefix;
    builder_transform place;
    const json_document *above;
    uint32_t depth;
} load_request;

static result load(json_scene *s, const load_request *q, const json_file *file);

static result check_chain(const json_entry *e, const json_node *file, const char *path, uint32_t depth)
{
    char chain[CHAIN_BYTES];
    int is_cycle = 0;
    for (const json_document *d = e->document; d && !is_cycle; d = d->above) is_cycle = strcmp(d->file.path, path) == 0;
    if (!is_cycle) return depth < DEPTH_MOST ? RESULT_OK : node_fault(file, "included %d deep; include fewer within each other", DEPTH_MOST);
    size_t used = 0;
    const json_document *links[DEPTH_MOST + 1];
    size_t count = 0;
    for (const json_document *d = e->document; d && count <= DEPTH_MOST; d = d->above) links[count++] = d;
    for (size_t i = count; i-- > 0 && used < sizeof chain;) {
        const int length = snprintf(chain + used, sizeof chain - used, "%s -> ", links[i]->file.path);
        used += length > 0 ? (size_t)length : 0;
    }
    return node_fault(file, "includes itself: %.480s%s; take one of these out", chain, path);
}

static result prefix_of(const json_entry *e, const char **out)
{
    json_node name_node;
    const char *name;
    *out = e->document->prefix;
    if (!node_find(&e->node, "name", &name_node)) return RESULT_OK;
    const result done = node_text(&name_node, &name);
    if (done != RESULT_OK) return done;
    if (*name == '/') return node_fault(&name_node, "a name begins with '/'; take it off");
    const size_t before = strlen(*out), length = strlen(name);
    if (before + length + 1 > NAME_BYTES_MOST)
        return node_fault(&name_node, "with the includes round it a name of over %d bytes; shorten it", NAME_BYTES_MOST);
    char *prefix = arena_push(&e->scene->memory, before + length + 2, 1);
    if (!prefix) return entry_no_memory(e);
    memcpy(prefix, *out, before);
    memcpy(prefix + before, name, length);
    memcpy(prefix + before + length, "/", 2);
    *out = prefix;
    return RESULT_OK;
}

typedef struct kept_line { char text[CHAIN_BYTES]; } kept_line;

static void keep_line(void *user, report_level level, const char *text)
{
    kept_line *k = user;
    if (level == REPORT_ERROR) snprintf(k->text, sizeof k->text, "%.*s", CHAIN_BYTES - 1, text);
}

// What is wrong with a file that cannot be read is told at the place that names it.
result entry_text(const json_entry *e, const json_node *file, const char *path, char **out_text, size_t *out_size)
{
    static const char before[] = ": error: ";
    const reader_job *job = e->scene->job;
    kept_line line = {{0}};
    report kept = {.line = keep_line, .user = &line};
    const result done = reader_text(job->files, path, job->memory, &kept, out_text, out_size);
    if (done == RESULT_NO_MEMORY) return entry_no_memory(e);
    if (done == RESULT_OK) return done;
    const char *why = strstr(line.text, before);
    return node_fault(file, "%s: %s", path, why ? why + sizeof before - 1 : "cannot be read; check the name");
}

static result load_include(const json_entry *e, uint32_t depth)
{
    json_node file;
    load_request q = {.above = e->document, .depth = depth + 1};
    result done = node_object(&e->node, include_keys);
    if (done == RESULT_OK) done = node_need(&e->node, "file", &file);
    if (done == RESULT_OK) done = entry_file(e, &file, &q.path);
    if (done != RESULT_OK) return done;
    const reader read = reader_of_file(q.path);
    if (!read) return node_fault(&file, "unknown kind of scene; the name must end in " READER_ENDINGS);
    if (read != json_into) return RESULT_OK; // geometry_read takes it
    done = check_chain(e, &file, q.path, q.depth);
    if (done == RESULT_OK) done = entry_count_piece(e);
    if (done == RESULT_OK) done = prefix_of(e, &q.prefix);
    builder_transform inner;
    if (done == RESULT_OK) done = placement_read(&e->node, &inner);
    if (done != RESULT_OK) return done;
    q.place = placement_within(&e->document->place, &inner);
    json_file source;
    done = source_find(e, &file, q.path, &source);
    return done == RESULT_OK ? load(e->scene, &q, &source) : done;
}

static result load_includes(json_scene *s, json_document *d, uint32_t depth)
{
    json_node list;
    size_t count;
    const json_node root = node_root(&d->file);
    result done = node_object(&root, top_keys);
    if (done != RESULT_OK || !node_find(&root, "include", &list)) return done;
    done = node_array(&list, 0, NODES_MOST, &count);
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) {
        const json_entry e = {s, d, node_item(&list, i)};
        done = load_include(&e, depth);
    }
    return done;
}

static result check_format(const json_document *d)
{
    json_node format;
    uint32_t number;
    const json_node root = node_root(&d->file);
    if (json_is_object(d->file.root) && !node_find(&root, "portcullis", &format))
        return node_fault(&root, "'portcullis' is missing; begin with {\"portcullis\": %d, ...} if this is a scene", FORMAT);
    if (!json_is_object(d->file.root)) return RESULT_OK; // node_object says it
    const char *name;
    const result done = node_count(&format, 0, UINT32_MAX, &number);
    if (done != RESULT_OK) return done;
    if (number == FORMAT) return node_maybe_text(&root, "name", &name);
    return node_fault(&format, "format %u; this reader knows format %d", number, FORMAT);
}

// The document comes into the list behind its includes.
static result load(json_scene *s, const load_request *q, const json_file *file)
{
    json_document *d = arena_push(&s->memory, 1, sizeof *d);
    if (!d) return report_no_memory(s->job->report, q->path);
    *d = (json_document){.file = *file, .prefix = q->prefix, .place = q->place, .above = q->above};
    result done = check_format(d);
    if (done == RESULT_OK) done = load_includes(s, d, q->depth);
    if (done == RESULT_OK && !buffer_append(&s->documents, &d, 1)) done = report_no_memory(s->job->report, q->path);
    return done;
}

result documents_load(json_scene *s)
{
    const reader_job *j = s->job;
    json_file file;
    char *path = arena_text(&s->memory, j->path, strlen(j->path));
    if (!path) return report_no_memory(j->report, j->path);
    straighten(path);
    const load_request q = {.path = path, .prefix = "", .place = placement_none()};
    const result done = source_add(s, path, (source_text){.bytes = j->text, .size = j->size}, &file);
    return done == RESULT_OK ? load(s, &q, &file) : done;
}
