// Reader of JSON scenes: the passes over the files, and what they share.
// SPDX-License-Identifier: MIT
#include "json_scene.h"

#include <string.h>

static const double COORDINATE_MOST = 1e9, WIDTH_MOST = 32768 + 2; // metres; scene_builder_finish is exact, by the scene's origin
static const uint64_t SIZE_MOST = 200000000; // triangles, say: some 10 GB of scene

// ---- What the passes share ----

// What scene_builder_finish would say without a place.
static result check_bounds(const json_entry *e)
{
    builder_bounds *b = &e->scene->bounds;
    double width = 0;
    builder_bounds_more(e->scene->job->builder, b);
    for (int k = 0; k < 3; ++k) {
        if (b->low[k] < -COORDINATE_MOST || b->high[k] > COORDINATE_MOST)
            return node_fault(&e->node, "a coordinate beyond 1e9 m; move this nearer to the scene's origin");
        width = b->high[k] - b->low[k] > width ? b->high[k] - b->low[k] : width;
    }
    if (width <= WIDTH_MOST) return RESULT_OK;
    return node_fault(&e->node, "with this the scene is %.0f m wide; one zone holds 32,768 m at 1 mm, so split or scale it", width);
}

result entry_room(const json_entry *e, uint64_t size_each, uint32_t copies)
{
    const uint64_t there = scene_builder_size(e->scene->job->builder), room = there < SIZE_MOST ? SIZE_MOST - there : 0;
    if (size_each <= room / copies) return RESULT_OK;
    return node_fault(&e->node, "%lu times %llu triangles or vertices; a scene holds %llu, so use fewer copies or a simpler file",
                      (unsigned long)copies, (unsigned long long)size_each, (unsigned long long)SIZE_MOST);
}

result entries_read(json_scene *s, const char *list_key, entry_reader read)
{
    json_document *const *documents = s->documents.items;
    result done = RESULT_OK;
    for (size_t d = 0; d < s->documents.count && done == RESULT_OK; ++d) {
        json_node list;
        size_t count = 0;
        const json_node root = node_root(&documents[d]->file);
        if (!node_find(&root, list_key, &list)) continue;
        done = node_array(&list, 0, NODES_MOST, &count);
        for (size_t i = 0; i < count && done == RESULT_OK; ++i) {
            const json_entry e = {s, documents[d], node_item(&list, i)};
            const builder_transform nothing = placement_none();
            done = entry_place(&e, &nothing);
            if (done == RESULT_OK) done = read(&e);
            if (done == RESULT_OK) done = check_bounds(&e);
        }
    }
    scene_builder_transform_end(s->job->builder);
    return done;
}

result entry_no_memory(const json_entry *e)
{
    return report_no_memory(e->scene->job->report, e->document->file.path);
}

result entry_told(const json_entry *e, result done, const char *what, const char *fault)
{
    if (done == RESULT_OK || e->scene->job->report->errors != e->scene->errors_before) return done;
    if (done == RESULT_NO_MEMORY) return entry_no_memory(e);
    if (!fault) fault = "goes beyond what a scene holds; use fewer or smaller parts";
    return node_fault(&e->node, "the %s %s%s", what, fault, strchr(fault, ';') ? "" : "; correct it");
}

result entry_place(const json_entry *e, const builder_transform *inner)
{
    const builder_transform all = placement_within(&e->document->place, inner);
    const result done = scene_builder_transform(e->scene->job->builder, &all);
    if (done != RESULT_BAD_INPUT) return done == RESULT_OK ? done : entry_no_memory(e);
    return node_fault(&e->node, "placed too far away, or scaled too much, by all the includes round it; use smaller numbers");
}

result entry_name(const json_entry *e, const char *name, const char **out)
{
    const char *prefix = *name == '/' ? "" : e->document->prefix;
    if (*name == '/') name++;
    const size_t before = strlen(prefix), length = strlen(name);
    if (before + length > NAME_BYTES_MOST)
        return node_fault(&e->node, "with the includes round it a name of over %d bytes; shorten it", NAME_BYTES_MOST);
    char *full = arena_push(&e->scene->memory, before + length + 1, 1);
    if (!full) return entry_no_memory(e);
    memcpy(full, prefix, before);
    memcpy(full + before, name, length + 1);
    *out = full;
    return RESULT_OK;
}

result entry_new_name(const json_entry *e, name_table *names, const char *kind, uint32_t number, const char **out)
{
    json_node node;
    const char *name;
    result done = node_need(&e->node, "name", &node);
    if (done == RESULT_OK) done = node_text(&node, &name);
    if (done == RESULT_OK && *name == '/') done = node_fault(&node, "a name begins with '/'; take it off");
    if (done == RESULT_OK) done = entry_name(e, name, out);
    if (done != RESULT_OK) return done;
    done = name_table_add(names, *out, number);
    if (done == RESULT_NO_MEMORY) return entry_no_memory(e);
    return done == RESULT_OK ? done : node_fault(&node, "there is a %s '%s' already; choose another name, or give one of two includes a \"name\"", kind, *out);
}

result entry_own(const json_entry *e, name_table *names, named **out)
{
    const char *name = json_string_value(json_object_get(e->node.value, "name")), *full; // is there, and a text
    const result done = entry_name(e, name, &full);
    if (done == RESULT_OK) *out = name_table_change(names, full);
    return done;
}

result entry_refer(const json_entry *e, const json_node *reference, const name_table *names, const char *kind, uint32_t *out)
{
    const char *name, *full;
    result done = node_text(reference, &name);
    if (done == RESULT_OK) done = entry_name(e, name, &full);
    if (done != RESULT_OK) return done;
    const named *found = name_table_find(names, full);
    if (found) {
        *out = found->number;
        return RESULT_OK;
    }
    const char *nearest = name_table_nearest(names, full);
    if (nearest) return node_fault(reference, "there is no %s '%s'; did you mean '%s'?", kind, full, nearest);
    return node_fault(reference, "there is no %s '%s'; correct the name or add it", kind, full);
}

result entry_points(const json_node *list, size_t least, size_t most, double (*out)[3], size_t *out_count)
{
    size_t count = 0;
    result done = node_array(list, least, most, &count);
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) {
        const json_node point = node_item(list, i);
        done = node_numbers(&point, 3, out[i]);
    }
    *out_count = count;
    return done;
}

// ---- The whole ----

typedef result (*scene_pass)(json_scene *s);

static result run_passes(json_scene *s, const scene_pass *passes, size_t count)
{
    result done = RESULT_OK;
    for (size_t p = 0; p < count && done == RESULT_OK; ++p) done = passes[p](s);
    return done;
}

// The first document with anything in that list, or nothing: *found 0.
static result find_list(const json_scene *s, const char *key, json_node *root, json_node *list, size_t *found)
{
    json_document *const *documents = s->documents.items;
    result done = RESULT_OK;
    *found = 0;
    for (size_t d = 0; d < s->documents.count && done == RESULT_OK && !*found; ++d) {
        *root = node_root(&documents[d]->file);
        if (node_find(root, key, list)) done = node_array(list, 0, NODES_MOST, found);
    }
    return done;
}

typedef struct refused_list { const char *key, *why; } refused_list;

static result refuse_lists(json_scene *s, const refused_list *lists, size_t count)
{
    json_node root, list;
    size_t found = 0;
    for (size_t i = 0; i < count; ++i) {
        const result done = find_list(s, lists[i].key, &root, &list, &found);
        if (done != RESULT_OK) return done;
        if (found) return node_fault(&list, "%s", lists[i].why);
    }
    return RESULT_OK;
}

static result refuse_brushes(json_scene *s)
{
    static const refused_list lists[] = {
        {"zone_info", "it names zones of brushes, and there are none; use \"zones\", or add \"brushes\""},
        {"starts", "they stand among brushes, and there are none; take them out, or add \"brushes\""},
    };
    json_node root, list;
    size_t found;
    const result done = find_list(s, "brushes", &root, &list, &found);
    if (done != RESULT_OK) return done;
    if (found) return node_fault(&list, "brushes are to be compiled first: portcullis compile %.200s -o SCENE.pcs, then open that", s->job->path);
    return refuse_lists(s, lists, sizeof lists / sizeof *lists);
}

static result read_passes(json_scene *s)
{
    static const scene_pass passes[] = {documents_load, refuse_brushes, geometry_read, zones_read,  doors_list,
                                        movers_read,    doors_read,     portals_read,  lights_read, paths_read};
    const result done = run_passes(s, passes, sizeof passes / sizeof *passes);
    if (done != RESULT_OK || scene_builder_item_count(s->job->builder)) return done;
    return report_error(s->job->report, s->job->path, 0, "no polygon to draw; add \"meshes\", \"boxes\", \"walls\" or \"movers\"");
}

static result refuse_zones(json_scene *s)
{
    static const refused_list lists[] = {
        {"zones", "zones by hand beside brushes; the compiler finds them: name them with \"zone_info\" and take this out"},
        {"portals", "portals by hand beside brushes; use brushes with \"operation\": \"portal\" and take this out"},
    };
    json_node root, list;
    size_t found;
    const result done = find_list(s, "brushes", &root, &list, &found);
    if (done != RESULT_OK) return done;
    if (!found) return report_error(s->job->report, s->job->path, 0, "no brushes to compile; add \"brushes\", or open the scene as it is");
    return refuse_lists(s, lists, sizeof lists / sizeof *lists);
}

static result read_beside(json_scene *s)
{
    static const scene_pass passes[] = {documents_load, refuse_zones, geometry_read, doors_list, movers_read, doors_read, lights_read, paths_read};
    return run_passes(s, passes, sizeof passes / sizeof *passes);
}

static result scene_run(const reader_job *j, const json_more *more)
{
    const allocator *memory = j->memory;
    json_scene s = {.job = j,
                    .memory = arena_make(memory),
                    .documents = buffer_make(memory, sizeof(json_document *)),
                    .door_list = buffer_make(memory, sizeof(door_entry)),
                    .errors_before = j->report->errors,
                    .bounds = builder_bounds_none(),
                    .user = more ? more->user : NULL,
                    .object = SCENE_NONE};
    name_table *const tables[] = {&s.zones, &s.portals, &s.doors, &s.movers, &s.paths, &s.moved};
    const size_t table_count = sizeof tables / sizeof *tables;
    for (size_t t = 0; t < table_count; ++t) *tables[t] = name_table_make(memory);
    sources_open(&s);
    models_open(&s);
    result done = more ? read_beside(&s) : read_passes(&s);
    if (done == RESULT_OK && more) done = more->read(&s);
    for (size_t t = 0; t < table_count; ++t) name_table_free(tables[t]);
    buffer_free(&s.documents);
    sources_free(&s);
    models_free(&s);
    buffer_free(&s.door_list);
    arena_free(&s.memory);
    return done;
}

result json_into(const reader_job *j)
{
    return scene_run(j, NULL);
}

result json_beside(const reader_job *j, const json_more *more)
{
    return scene_run(j, more);
}
