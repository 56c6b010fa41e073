// Reader of Wavefront .obj: v, vt, vn (counted), f in every index form, o, g, usemtl; all else is skipped.
// SPDX-License-Identifier: MIT
// Invariant: after reading, every corner's indices are in range; errors name the line.
#include "mesh_soup.h"
#include "mesh_text.h"

#include <string.h>

typedef enum group_kind { GROUP_O, GROUP_G } group_kind;

typedef struct obj_group {
    soup_name name;
    uint32_t first_polygon;
    group_kind kind;
} obj_group;

enum { INDEX_POSITION, INDEX_TEXCOORD, INDEX_NORMAL, INDEX_KINDS };

typedef struct obj_reader {
    mesh_text text;
    mesh_soup *soup;
    buffer groups; // obj_group
    size_t normal_count;
    soup_largest largest[INDEX_KINDS];
    uint32_t material;
    int has_o;
} obj_reader;

static result out_of_memory(obj_reader *o)
{
    return report_no_memory(o->text.report, o->text.path);
}

static result read_texcoord(obj_reader *o)
{
    double uv[2] = {0, 0};
    for (int k = 0; k < 2; ++k) {
        const number_state state = text_number(&o->text, &uv[k]);
        if (state == NUMBER_MISSING && k == 1) break; // v is optional
        if (state != NUMBER_OK || coordinate_fault(uv[k]))
            return report_error(o->text.report, o->text.path, o->text.line, "vt: value %d is not a finite number; write u v", k + 1);
    }
    const float rounded[2] = {(float)uv[0], (float)uv[1]};
    return buffer_append(&o->soup->texcoords, rounded, 1) ? RESULT_OK : out_of_memory(o);
}

static const char *name_of_kind(int kind)
{
    static const char *const names[INDEX_KINDS] = {"vertex", "texture", "normal"};
    return names[kind];
}

static size_t count_of_kind(const obj_reader *o, int kind)
{
    if (kind == INDEX_NORMAL) return o->normal_count;
    return kind == INDEX_POSITION ? o->soup->positions.count : o->soup->texcoords.count;
}

// Indices count from 1, negative ones from the last element so far. Positive ones may name what comes later.
static result read_index(obj_reader *o, int kind, uint32_t *out)
{
    mesh_text *t = &o->text;
    int64_t number;
    if (!text_integer(t, &number))
        return report_error(t->report, t->path, t->line, "f: the %s index is not an integer; write i, i/t, i//n or i/t/n", name_of_kind(kind));
    const int64_t count = (int64_t)count_of_kind(o, kind);
    const int64_t index = number < 0 ? count + number : number - 1;
    if (number == 0 || index < 0 || index >= UINT32_MAX)
        return report_error(t->report, t->path, t->line, "f: %s index %lld is out of range with %lld read so far; count from 1, or from -1 backwards",
                            name_of_kind(kind), (long long)number, (long long)count);
    if (index >= count) soup_use(&o->largest[kind], (uint64_t)index, t->line);
    *out = (uint32_t)index;
    return RESULT_OK;
}

static int starts_integer(char c)
{
    return c == '-' || c == '+' || (c >= '0' && c <= '9');
}

static result read_corner(obj_reader *o, soup_corner *corner)
{
    mesh_text *t = &o->text;
    uint32_t normal;
    corner->texcoord = SOUP_NO_TEXCOORD;
    result done = read_index(o, INDEX_POSITION, &corner->position);
    if (done != RESULT_OK || *t->at != '/') return done;
    t->at++;
    if (starts_integer(*t->at)) done = read_index(o, INDEX_TEXCOORD, &corner->texcoord);
    if (done != RESULT_OK || *t->at != '/') return done; // "1/", as some exporters write, is 1
    t->at++;
    return starts_integer(*t->at) ? read_index(o, INDEX_NORMAL, &normal) : RESULT_OK;
}

static result read_face(obj_reader *o)
{
    mesh_text *t = &o->text;
    const size_t line = t->line, first = o->soup->corners.count;
    while (!text_line_ended(t)) {
        soup_corner corner;
        const result done = read_corner(o, &corner);
        if (done != RESULT_OK) return done;
        if (!text_word_ended(t))
            return report_error(t->report, t->path, t->line, "f: a corner is not i, i/t, i//n or i/t/n; write integers with / between");
        if (o->soup->corners.count - first >= POLYGON_CORNERS_MOST)
            return report_error(t->report, t->path, line, "a face of over %d corners; split it into smaller ones", POLYGON_CORNERS_MOST);
        if (!buffer_append(&o->soup->corners, &corner, 1)) return out_of_memory(o);
    }
    const size_t corners = o->soup->corners.count - first;
    if (corners < 3) return report_error(t->report, t->path, line, "a face of %zu corners; a face has at least 3", corners);
    const result done = soup_polygon_end(o->soup, first, o->material);
    if (done == RESULT_NO_MEMORY) return out_of_memory(o);
    return done == RESULT_OK ? done : report_error(t->report, t->path, line, "over 2^32 corners or faces; split the file");
}

static result read_group(obj_reader *o, group_kind kind)
{
    obj_group *g = buffer_push(&o->groups, 1);
    if (!g) return out_of_memory(o);
    g->name.length = text_rest(&o->text, &g->name.text);
    g->first_polygon = (uint32_t)o->soup->polygons.count;
    g->kind = kind;
    o->has_o |= kind == GROUP_O;
    return RESULT_OK;
}

static result read_material(obj_reader *o)
{
    soup_name name;
    name.length = text_rest(&o->text, &name.text);
    const soup_name *known = (const soup_name *)o->soup->materials.items + o->material;
    if (name.length == 0) return RESULT_OK;
    if (known->length == name.length && memcmp(known->text, name.text, name.length) == 0) return RESULT_OK;
    if (!buffer_append(&o->soup->materials, &name, 1)) return out_of_memory(o);
    o->material = (uint32_t)o->soup->materials.count - 1;
    return RESULT_OK;
}

static result read_statement(obj_reader *o)
{
    const char *word;
    const size_t length = text_word(&o->text, &word);
    if (length == 1 && *word == 'v') {
        double p[3];
        const result done = text_position(&o->text, "v", p);
        if (done != RESULT_OK) return done; // a weight or a colour may follow
        return buffer_append(&o->soup->positions, p, 1) ? RESULT_OK : out_of_memory(o);
    }
    if (length == 1 && *word == 'f') return read_face(o);
    if (length == 2 && memcmp(word, "vt", 2) == 0) return read_texcoord(o);
    if (length == 2 && memcmp(word, "vn", 2) == 0) o->normal_count++;
    if (length == 1 && *word == 'o') return read_group(o, GROUP_O);
    if (length == 1 && *word == 'g') return read_group(o, GROUP_G);
    if (length == 6 && memcmp(word, "usemtl", 6) == 0) return read_material(o);
    return RESULT_OK;
}

static result read_statements(obj_reader *o)
{
    mesh_text *t = &o->text;
    for (text_skip_empty_lines(t); !text_ended(t); text_skip_empty_lines(t)) {
        result done = RESULT_OK;
        if (!text_is_noise(t)) done = read_statement(o);
        if (done != RESULT_OK) return done;
        if (text_is_noise(t)) return report_error(t->report, t->path, t->line, "a byte that no text has; is this an .obj file?");
        text_next_line(t);
    }
    return RESULT_OK;
}

static result check_indices(const obj_reader *o)
{
    for (int kind = 0; kind < INDEX_KINDS; ++kind) {
        const soup_largest *l = &o->largest[kind];
        const size_t count = count_of_kind(o, kind);
        if (l->is_used && l->index >= count)
            return report_error(o->text.report, o->text.path, l->line, "f: %s index %llu is out of range, the file has %zu; correct it",
                                name_of_kind(kind), (unsigned long long)l->index + 1, count);
    }
    return RESULT_OK;
}

// `o` lines make the objects; where there are none, `g` lines do. Faces before the first one get the file's name.
static result make_objects(obj_reader *o)
{
    const obj_group *groups = o->groups.items;
    const soup_object rest = {soup_file_stem(o->text.path), 0};
    if (!buffer_append(&o->soup->objects, &rest, 1)) return out_of_memory(o);
    for (size_t i = 0; i < o->groups.count; ++i) {
        if (o->has_o && groups[i].kind != GROUP_O) continue;
        const soup_object object = {groups[i].name, groups[i].first_polygon};
        if (!buffer_append(&o->soup->objects, &object, 1)) return out_of_memory(o);
    }
    return RESULT_OK;
}

static result read_all(obj_reader *o)
{
    const soup_name fallback = {"default", 7};
    if (!buffer_append(&o->soup->materials, &fallback, 1)) return out_of_memory(o);
    result done = read_statements(o);
    if (done == RESULT_OK) done = check_indices(o);
    if (done == RESULT_OK && o->soup->polygons.count == 0)
        done = report_error(o->text.report, o->text.path, o->text.line, "no faces (f lines) up to the end of the file; is this a whole .obj file?");
    return done == RESULT_OK ? make_objects(o) : done;
}

result obj_into(const reader_job *j)
{
    mesh_soup soup = soup_make(j->memory);
    obj_reader o = {.text = text_make(j->path, j->text, j->size, j->report), .soup = &soup, .groups = buffer_make(j->memory, sizeof(obj_group))};
    o.text.joins_lines = 1;
    result done = read_all(&o);
    if (done == RESULT_OK) done = mesh_scene_into(&soup, j);
    buffer_free(&o.groups);
    soup_free(&soup);
    return done;
}
