// The compiler's input from a .map file, Standard or Valve 220. The text is read by host/import's reader; its decimals again,
// exactly, here.
// SPDX-License-Identifier: MIT
// Invariant: a map point (x, y, z) is (x, z, -y) in the scene, a rotation, so fronts stay fronts and no step is lost.
#include "input.h"
#include "input_grid.h"
#include "turned_frame.h"

#include "../import/map_entity.h"
#include "../import/map_texture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WHERE_BYTES = 64 };
static const double UNITS_PER_METRE = 32, TEXELS = 64; // a texture coordinate of 1 is 64 texels, as in host/import

typedef struct map_input {
    map_reader reader;
    map_entity entity;
    input_draft draft;
    buffer faces; // compile_face: of one brush
    buffer turns; // weld_change: of one brush, its number not yet known
    turned_frame frame;
    frame_verdict has_frame; // the map was turned as a whole: its planes are those of the frame
} map_input;

static void name_place(const map_input *m, size_t brush, char where[WHERE_BYTES])
{
    snprintf(where, WHERE_BYTES, "entity %u brush %zu", m->entity.number, brush);
}

// ---- Faces ----

static void scene_point(const int64_t steps[3], int32_t out[3])
{
    out[0] = (int32_t)steps[0];
    out[1] = (int32_t)steps[2];
    out[2] = (int32_t)-steps[1];
}

static result grid_point(map_input *m, const map_face *face, int point, const char *where, int32_t out[3])
{
    int64_t steps[3];
    int rounded = 0;
    for (int k = 0; k < 3; ++k) {
        const map_word word = face->decimals[point][k];
        rounded |= grid_round(word.text, word.length, m->draft.grid, &steps[k]) == GRID_ROUNDED;
        if (steps[k] > CULL_GRID_MOST || steps[k] < -CULL_GRID_MOST)
            return report_error(m->reader.report, m->reader.path, face->line,
                                "%s: a coordinate beyond %g units (2^24 steps of the grid); move it or take a coarser grid", where,
                                (double)CULL_GRID_MOST / m->draft.grid);
    }
    m->draft.in->points_rounded += rounded != 0;
    scene_point(steps, out);
    return RESULT_OK;
}

// Rows for scene metres: s = a . (32 x, -32 z, 32 y) + shift texels, and 64 texels are 1.
static void texture_rows(const map_face *face, const cull_wide_plane *outward, double rows[2][4])
{
    const double normal[3] = {(double)outward->normal[0], -(double)outward->normal[2], (double)outward->normal[1]};
    const texture_map map = texture_map_of(face, normal);
    for (int i = 0; i < 2; ++i) {
        const double *a = map.axes[i];
        rows[i][0] = a[0] * (UNITS_PER_METRE / TEXELS);
        rows[i][1] = a[2] * (UNITS_PER_METRE / TEXELS);
        rows[i][2] = -a[1] * (UNITS_PER_METRE / TEXELS) + 0.0;
        rows[i][3] = map.shift[i] / TEXELS;
    }
}

// The plane that was meant before the map was turned and its points rounded.
static result turn_face(map_input *m, const int32_t p[3][3], compile_face *face)
{
    cull_wide_plane meant;
    double move;
    if (m->has_frame != FRAME_FOUND || !turned_frame_plane(&m->frame, p[1], p[0], p[2], &meant, &move)) return RESULT_OK;
    const plane_ref to = plane_table_add(m->draft.in->planes, &meant);
    const weld_change change = {WELD_TURN, 0, face->line, face->plane, to, move / m->draft.grid};
    if (to == PLANE_NONE || (to != face->plane && !buffer_append(&m->turns, &change, 1))) return report_no_memory(m->reader.report, m->reader.path);
    face->plane = to;
    face->is_rounded = 0;
    return RESULT_OK;
}

static result take_face(map_input *m, const map_face *face, const char *where, compile_face *out)
{
    int32_t p[3][3];
    const uint32_t rounded = m->draft.in->points_rounded;
    for (int i = 0; i < 3; ++i) {
        const result done = grid_point(m, face, i, where, p[i]);
        if (done != RESULT_OK) return done;
    }
    cull_wide_plane outward;
    if (!cull_wide_plane_through(p[1], p[0], p[2], &outward))
        return report_error(m->reader.report, m->reader.path, face->line, "%s: the three points of a face lie on one line%s", where,
                            rounded == m->draft.in->points_rounded ? "; move one" : " of the grid; move one or take a finer grid");
    *out = (compile_face){.plane = plane_table_add(m->draft.in->planes, &outward), .material = COMPILE_NOTHING, .line = (uint32_t)face->line};
    out->is_rounded = rounded != m->draft.in->points_rounded;
    texture_rows(face, &outward, out->texture);
    const texture_kind kind = texture_kind_of(face->texture);
    if (kind != TEXTURE_TOOL) out->material = input_draft_material(&m->draft, face->texture.text, face->texture.length, texture_material_flags(kind));
    if (out->plane == PLANE_NONE || (kind != TEXTURE_TOOL && out->material == UINT32_MAX)) return report_no_memory(m->reader.report, m->reader.path);
    return turn_face(m, (const int32_t(*)[3])p, out);
}

// ---- Brushes ----

typedef struct entity_use { // what its brushes are
    brush_kind kind;
    brush_role role;
    int makes_nothing; // triggers
} entity_use;

static entity_use use_of(map_word class_name)
{
    entity_use use = {BRUSH_ADD, BRUSH_ENTITY, 0};
    if (map_word_is(class_name, "csg_subtract")) use.kind = BRUSH_SUBTRACT;
    if (map_word_is(class_name, "csg_add") || map_word_is(class_name, "csg_subtract")) use.role = BRUSH_STRUCTURE;
    else if (map_word_is(class_name, "zone_portal")) use.role = BRUSH_PORTAL;
    else if (entity_body_of(class_name) == BODY_STRUCTURE) use.role = BRUSH_STRUCTURE;
    use.makes_nothing = entity_role_of(class_name) == ENTITY_NOTHING;
    return use;
}

typedef struct brush_look { int visible, liquid, fence; } brush_look; // liquid: a face of it; fence: all that is to be seen has holes

static brush_look look_of(const map_face *faces, size_t count)
{
    brush_look look = {0};
    int holes = 0, rest = 0;
    for (size_t i = 0; i < count; ++i) {
        const texture_kind kind = texture_kind_of(faces[i].texture);
        look.visible |= kind != TEXTURE_TOOL;
        look.liquid |= kind == TEXTURE_LIQUID;
        holes |= kind == TEXTURE_CUT_OUT;
        rest |= kind != TEXTURE_TOOL && kind != TEXTURE_CUT_OUT;
    }
    look.fence = holes && !rest;
    return look;
}

// Of the faces that the brush has kept.
static result list_turns(map_input *m)
{
    input_draft *d = &m->draft;
    const uint32_t number = (uint32_t)d->brushes.count - 1;
    const compile_brush *b = (const compile_brush *)d->brushes.items + number;
    const compile_face *faces = (const compile_face *)d->faces.items + b->first_face;
    weld_change *turns = m->turns.items;
    for (size_t i = 0, f = 0; i < m->turns.count; ++i) { // both in the order of the file
        while (f < b->face_count && faces[f].line < turns[i].line) f++;
        if (f == b->face_count || faces[f].line != turns[i].line) continue;
        turns[i].brush = number;
        if (!buffer_append(&d->changes, &turns[i], 1)) return report_no_memory(d->report, d->path);
        d->in->max_move = fmax(d->in->max_move, turns[i].move);
    }
    return RESULT_OK;
}

static result take_brush(map_input *m, size_t number, const entity_use *use, uint32_t entity)
{
    const map_brush *brush = (const map_brush *)m->entity.brushes.items + number;
    const map_face *from = (const map_face *)m->entity.faces.items + brush->first_face;
    const brush_look look = look_of(from, brush->face_count);
    if (use->makes_nothing || (!look.visible && use->role != BRUSH_PORTAL)) {
        m->draft.in->brushes_dropped++;
        return RESULT_OK;
    }
    char where[WHERE_BYTES];
    name_place(m, number, where);
    m->faces.count = m->turns.count = 0;
    compile_face *faces = buffer_push(&m->faces, brush->face_count);
    if (!faces) return report_no_memory(m->reader.report, m->reader.path);
    for (size_t i = 0; i < brush->face_count; ++i) {
        const result done = take_face(m, &from[i], where, &faces[i]);
        if (done != RESULT_OK) return done;
    }
    compile_brush made = {.entity = entity, .kind = use->kind, .role = use->role};
    if (made.role == BRUSH_STRUCTURE && made.kind == BRUSH_ADD && look.liquid) made.role = BRUSH_LIQUID;
    if (made.role == BRUSH_STRUCTURE && made.kind == BRUSH_ADD && look.fence) made.role = BRUSH_ENTITY; // what lies behind shows through it
    brush_verdict verdict;
    const result done = input_draft_brush(&m->draft, &made, faces, (uint32_t)brush->face_count, where, (uint32_t)brush->line, &verdict);
    return done == RESULT_OK && verdict == BRUSH_TAKEN ? list_turns(m) : done;
}

// ---- Entities ----

static const char *keep_text(map_input *m, map_word word)
{
    return arena_text(&m->draft.in->memory, word.text, word.length);
}

static result take_keys(map_input *m, compile_entity *out)
{
    const map_key *keys = m->entity.keys.items;
    const size_t count = m->entity.keys.count;
    const char **to = arena_push(&m->draft.in->memory, 2 * count + 1, sizeof *to);
    int complete = to != NULL;
    for (size_t i = 0; i < count && complete; ++i) {
        to[2 * i] = keep_text(m, keys[i].key);
        to[2 * i + 1] = keep_text(m, keys[i].value);
        complete = to[2 * i] && to[2 * i + 1];
    }
    out->keys = to;
    out->key_count = (uint32_t)count;
    out->class_name = complete ? keep_text(m, entity_class(&m->entity)) : NULL;
    const map_key *name = map_entity_key(&m->entity, "targetname");
    if (out->class_name && name) out->name = keep_text(m, name->value);
    return out->class_name && (!name || out->name) ? RESULT_OK : report_no_memory(m->reader.report, m->reader.path);
}

static result take_origin(map_input *m, compile_entity *out)
{
    const map_entity *e = &m->entity;
    const map_key *origin = map_entity_key(e, "origin");
    if (!origin || e->brushes.count) return RESULT_OK; // of a brush entity nobody asks for it, though all its brushes are dropped
    double units[3] = {0};
    int good = map_word_numbers(origin->value, units, 3);
    for (int k = 0; good && k < 3; ++k) good = fabs(units[k]) <= MAP_COORDINATE_MOST;
    if (!good)
        return report_error(m->reader.report, m->reader.path, origin->line, "entity %u: \"origin\" takes three numbers within 2^20; repair its value",
                            e->number);
    out->has_origin = 1;
    out->origin[0] = units[0] / UNITS_PER_METRE;
    out->origin[1] = units[2] / UNITS_PER_METRE;
    out->origin[2] = -units[1] / UNITS_PER_METRE + 0.0;
    return RESULT_OK;
}

static result take_entity(map_input *m)
{
    compile_entity made = {.first_brush = (uint32_t)m->draft.brushes.count, .line = (uint32_t)m->entity.line};
    const entity_use use = use_of(entity_class(&m->entity));
    result done = take_keys(m, &made);
    if (done == RESULT_OK) done = take_origin(m, &made);
    for (size_t b = 0; b < m->entity.brushes.count && done == RESULT_OK; ++b) done = take_brush(m, b, &use, (uint32_t)m->draft.entities.count);
    made.brush_count = (uint32_t)m->draft.brushes.count - made.first_brush;
    if (done == RESULT_OK && !buffer_append(&m->draft.entities, &made, 1)) done = report_no_memory(m->reader.report, m->reader.path);
    return done;
}

static result read_map(map_input *m, compile_input **out)
{
    for (;;) {
        map_more more;
        result done = map_reader_next(&m->reader, &m->entity, &more);
        if (done == RESULT_OK && more == MAP_END) break;
        if (done == RESULT_OK) done = take_entity(m);
        if (done != RESULT_OK) return done;
    }
    if (m->reader.entities_read == 0) return report_error(m->reader.report, m->reader.path, m->reader.line, "no entity in it; is this a .map file?");
    return input_draft_finish(&m->draft, out);
}

// ---- Turned maps ----

// Points in the text with a decimal point, of all: without any there is nothing to find, and no need to read the text twice.
static int has_decimals(const char *at, const char *end)
{
    size_t points = 0, decimals = 0;
    while ((at = memchr(at, '(', (size_t)(end - at))) != NULL) {
        const char *close = memchr(at, ')', (size_t)(end - at));
        if (!close) break;
        points++;
        decimals += memchr(at, '.', (size_t)(close - at)) != NULL;
        at = close;
    }
    return decimals > points / 2;
}

// What can't be read or is no point of the grid is left to the second reading, which says so.
static result gather_points(map_input *m, buffer *points)
{
    report quiet = {0};
    map_reader reader = m->reader;
    reader.report = &quiet;
    for (;;) {
        map_more more;
        const result done = map_reader_next(&reader, &m->entity, &more);
        if (done == RESULT_NO_MEMORY) return report_no_memory(m->reader.report, m->reader.path);
        if (done != RESULT_OK || more == MAP_END) return RESULT_OK;
        const map_face *faces = m->entity.faces.items;
        for (size_t f = 0; f < m->entity.faces.count; ++f) {
            int32_t p[3][3];
            int is_good = 1;
            for (int i = 0; i < 3 && is_good; ++i) {
                int64_t steps[3];
                for (int k = 0; k < 3; ++k) {
                    grid_round(faces[f].decimals[i][k].text, faces[f].decimals[i][k].length, m->draft.grid, &steps[k]);
                    is_good &= steps[k] <= CULL_GRID_MOST && steps[k] >= -CULL_GRID_MOST;
                }
                if (is_good) scene_point(steps, p[i]);
            }
            if (is_good && !buffer_append(points, p, 3)) return report_no_memory(m->reader.report, m->reader.path);
        }
    }
}

static result find_frame(map_input *m)
{
    if (!has_decimals(m->reader.at, m->reader.end)) return RESULT_OK;
    buffer points = buffer_make(m->faces.memory, sizeof(int32_t[3]));
    result done = gather_points(m, &points);
    if (done == RESULT_OK) {
        done = turned_frame_find((const int32_t(*)[3])points.items, points.count, m->draft.grid, m->faces.memory, &m->frame, &m->has_frame);
        if (done == RESULT_NO_MEMORY) report_no_memory(m->reader.report, m->reader.path);
    }
    buffer_free(&points);
    return done;
}

static size_t byte_order_mark(const char *text, size_t size) // UTF-8's
{
    return size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

result compile_input_map(const char *path, const char *text, size_t size, const input_options *o, const allocator *memory, report *r, compile_input **out)
{
    const size_t mark = byte_order_mark(text, size);
    map_input m = {.reader = {.path = path, .at = text + mark, .end = text + size, .line = 1, .report = r},
                   .entity = map_entity_make(memory),
                   .faces = buffer_make(memory, sizeof(compile_face)),
                   .turns = buffer_make(memory, sizeof(weld_change)),
                   .has_frame = FRAME_NONE};
    result done = input_draft_open(path, o, memory, r, &m.draft);
    if (done == RESULT_OK) done = find_frame(&m);
    if (done == RESULT_OK) done = read_map(&m, out);
    input_draft_close(&m.draft);
    buffer_free(&m.faces);
    buffer_free(&m.turns);
    map_entity_free(&m.entity);
    return done;
}
