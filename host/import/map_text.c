// Scanner and parser of .map text, Standard and Valve 220, over the bytes. Every number is a finite double in range.
// SPDX-License-Identifier: MIT
// Invariant: `at` never passes `end`, and there is no recursion: a file nests entity, brush, face and no deeper.
#include "map_text.h"

#include "number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    FACES_MOST = 4096,     // of one brush: clipping costs their square
    TRAILING_MOST = 16,    // Quake 2, Hexen 2 and Daikatana write 1 to 8 numbers behind a face
    SHOWN_BYTES = 40,      // of a wrong word in a message
    BYTE_TEXT = 4,         // \xNN
};
static const double TEXTURE_NUMBER_MOST = 1e9; // texels or their scale: keeps texture coordinates finite in float

typedef struct place { // what an error line says of where it happened
    map_reader *m;
    const map_entity *entity;
    int in_brush;
} place;

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

int map_word_starts(map_word word, const char *lower_case)
{
    const size_t length = strlen(lower_case);
    if (word.length < length) return 0;
    for (size_t i = 0; i < length; ++i)
        if (lower(word.text[i]) != lower_case[i]) return 0;
    return 1;
}

int map_word_is(map_word word, const char *lower_case)
{
    return word.length == strlen(lower_case) && map_word_starts(word, lower_case);
}

map_entity map_entity_make(const allocator *memory)
{
    return (map_entity){.keys = buffer_make(memory, sizeof(map_key)),
                        .brushes = buffer_make(memory, sizeof(map_brush)),
                        .faces = buffer_make(memory, sizeof(map_face))};
}

void map_entity_free(map_entity *e)
{
    buffer_free(&e->keys);
    buffer_free(&e->brushes);
    buffer_free(&e->faces);
}

const map_key *map_entity_key(const map_entity *e, const char *key)
{
    const map_key *keys = e->keys.items;
    for (size_t i = e->keys.count; i-- > 0;)
        if (map_word_is(keys[i].key, key)) return &keys[i];
    return NULL;
}

// ---- Words ----

static int is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f';
}

static int is_comment(const map_reader *m)
{
    return m->end - m->at >= 2 && m->at[0] == '/' && m->at[1] == '/';
}

static void step_over(map_reader *m)
{
    if (*m->at == '\n' || (*m->at == '\r' && (m->at + 1 == m->end || m->at[1] != '\n'))) m->line++;
    m->at++;
}

static void skip_space(map_reader *m)
{
    while (m->at < m->end) {
        if (is_comment(m))
            while (m->at < m->end && *m->at != '\n' && *m->at != '\r') m->at++;
        else if (is_space(*m->at)) step_over(m);
        else return;
    }
}

static map_word peek_word(const map_reader *m)
{
    const char *end = m->at;
    while (end < m->end && !is_space(*end)) end++;
    return (map_word){m->at, (size_t)(end - m->at)};
}

// What a terminal might act on, or not be able to show, as \xNN.
static void show_word(map_word word, char to[SHOWN_BYTES * BYTE_TEXT + 1])
{
    const size_t shown = word.length < SHOWN_BYTES ? word.length : SHOWN_BYTES;
    size_t used = 0;
    for (size_t i = 0; i < shown; ++i) {
        const unsigned char byte = (unsigned char)word.text[i];
        if (byte >= 32 && byte < 127) to[used++] = (char)byte;
        else used += (size_t)snprintf(to + used, BYTE_TEXT + 1, "\\x%02x", byte);
    }
    to[used] = 0;
}

static result fault(const place *p, const char *expected, const char *advice)
{
    const map_reader *m = p->m;
    const map_word word = peek_word(m);
    char brush[32] = "", shown[SHOWN_BYTES * BYTE_TEXT + 1], found[sizeof shown + 32];
    show_word(word, shown);
    if (m->at >= m->end) snprintf(found, sizeof found, "the end of the file");
    else if (word.length == 0) snprintf(found, sizeof found, "the end of the line");
    else snprintf(found, sizeof found, "'%s'", shown);
    if (p->in_brush) snprintf(brush, sizeof brush, " brush %zu", p->entity->brushes.count - 1);
    return report_error(m->report, m->path, m->line, "entity %u%s: expected %s, found %s; %s", p->entity->number, brush, expected, found, advice);
}

static int take_char(map_reader *m, char c)
{
    skip_space(m);
    if (m->at >= m->end || *m->at != c) return 0;
    m->at++;
    return 1;
}

static int ends_number(const map_reader *m, const char *at)
{
    return at == m->end || is_space(*at) || *at == ')' || *at == ']' || *at == '(' || *at == '[' || *at == '}';
}

static result take_number(const place *p, double most, double *out)
{
    map_reader *m = p->m;
    skip_space(m);
    double number = 0;
    const char *behind = number_read(m->at, m->end, &number);
    if (!behind || !ends_number(m, behind)) return fault(p, "a decimal number", "repair the line");
    if (!(fabs(number) <= most)) return fault(p, most == MAP_COORDINATE_MOST ? "a coordinate within 2^20 units" : "a number within 1e9", "move or repair it");
    m->at = behind;
    *out = number;
    return RESULT_OK;
}

static result take_numbers(const place *p, double most, double *out, int count)
{
    for (int i = 0; i < count; ++i) {
        const result done = take_number(p, most, &out[i]);
        if (done != RESULT_OK) return done;
    }
    return RESULT_OK;
}

int map_word_numbers(map_word word, double *numbers, int count)
{
    const char *at = word.text, *end = word.text + word.length;
    for (int i = 0; i < count; ++i) {
        while (at < end && is_space(*at)) at++;
        at = number_read(at, end, &numbers[i]);
        if (!at || (at < end && !is_space(*at))) return 0;
    }
    while (at < end && is_space(*at)) at++;
    return at == end;
}

// ---- Keys ----

// A backslash hides a quote, unless the line ends right behind it: folders of old editors end in one.
static int closes_string(const char *start, const char *at, const char *end)
{
    if (at == start || at[-1] != '\\') return 1;
    for (++at; at < end && (*at == ' ' || *at == '\t'); ++at) {}
    return at == end || *at == '\n' || *at == '\r';
}

static result take_string(const place *p, const char *what, map_word *out)
{
    map_reader *m = p->m;
    if (!take_char(m, '"')) return fault(p, what, "write \"key\" \"value\"");
    const char *start = m->at;
    for (; m->at < m->end; m->at++) {
        if (*m->at == '\n' || *m->at == '\r') break;
        if (*m->at == '"' && closes_string(start, m->at, m->end)) {
            *out = (map_word){start, (size_t)(m->at - start)};
            m->at++;
            return RESULT_OK;
        }
    }
    return fault(p, "a closing quote on the same line", "close the string");
}

static result take_key(const place *p, map_entity *e)
{
    map_key key = {.line = p->m->line};
    result done = take_string(p, "a key in quotes", &key.key);
    if (done == RESULT_OK) done = take_string(p, "a value in quotes", &key.value);
    if (done != RESULT_OK) return done;
    return buffer_append(&e->keys, &key, 1) ? RESULT_OK : report_no_memory(p->m->report, p->m->path);
}

// ---- Faces ----

static result take_point(const place *p, double out[3], map_word decimals[3])
{
    if (!take_char(p->m, '(')) return fault(p, "'(' of a point", "a face is three points, a texture and its numbers");
    for (int i = 0; i < 3; ++i) {
        skip_space(p->m);
        const char *start = p->m->at;
        const result done = take_number(p, MAP_COORDINATE_MOST, &out[i]);
        if (done != RESULT_OK) return done;
        decimals[i] = (map_word){start, (size_t)(p->m->at - start)};
    }
    return take_char(p->m, ')') ? RESULT_OK : fault(p, "')' behind three coordinates", "repair the point");
}

static result take_texture(const place *p, map_word *out)
{
    map_reader *m = p->m;
    skip_space(m);
    if (m->at < m->end && *m->at == '"') return take_string(p, "a texture in quotes", out);
    *out = peek_word(m);
    if (out->length == 0 || *m->at == '(') return fault(p, "a texture name", "name one behind the three points");
    m->at += out->length;
    return RESULT_OK;
}

static result take_valve_axis(const place *p, double axis[3], double *shift)
{
    if (!take_char(p->m, '[')) return fault(p, "'[' of a texture axis", "Valve 220 has two axes of four numbers");
    double numbers[4];
    const result done = take_numbers(p, TEXTURE_NUMBER_MOST, numbers, 4);
    if (done != RESULT_OK) return done;
    memcpy(axis, numbers, 3 * sizeof *axis);
    *shift = numbers[3];
    return take_char(p->m, ']') ? RESULT_OK : fault(p, "']' behind four numbers", "repair the texture axis");
}

static result take_projection(const place *p, map_face *face)
{
    skip_space(p->m);
    result done;
    if (p->m->at < p->m->end && *p->m->at == '[') {
        face->projection = MAP_VALVE;
        done = take_valve_axis(p, face->axes[0], &face->shift[0]);
        if (done == RESULT_OK) done = take_valve_axis(p, face->axes[1], &face->shift[1]);
    } else {
        face->projection = MAP_STANDARD;
        done = take_numbers(p, TEXTURE_NUMBER_MOST, face->shift, 2);
    }
    if (done == RESULT_OK) done = take_number(p, TEXTURE_NUMBER_MOST, &face->rotation_deg);
    if (done == RESULT_OK) done = take_numbers(p, TEXTURE_NUMBER_MOST, face->scale, 2);
    return done;
}

static result skip_trailing(const place *p)
{
    double number;
    for (int i = 0;; ++i) {
        skip_space(p->m);
        if (p->m->at >= p->m->end || *p->m->at == '(' || *p->m->at == '}') return RESULT_OK;
        if (i == TRAILING_MOST) return fault(p, "a face or '}'", "repair the end of the face");
        const result done = take_number(p, 1e18, &number); // flags, contents and values of later games, without use here
        if (done != RESULT_OK) return done;
    }
}

static result take_face(const place *p, map_entity *e)
{
    map_face face = {.line = p->m->line};
    result done = RESULT_OK;
    for (int i = 0; i < 3 && done == RESULT_OK; ++i) done = take_point(p, face.points[i], face.decimals[i]);
    if (done == RESULT_OK) done = take_texture(p, &face.texture);
    if (done == RESULT_OK) done = take_projection(p, &face);
    if (done == RESULT_OK) done = skip_trailing(p);
    if (done != RESULT_OK) return done;
    return buffer_append(&e->faces, &face, 1) ? RESULT_OK : report_no_memory(p->m->report, p->m->path);
}

// ---- Brushes and entities ----

static result refuse_other_games(const place *p)
{
    static const char *const words[] = {"brushdef", "patchdef", "terraindef"};
    skip_space(p->m);
    const map_word word = peek_word(p->m);
    for (size_t i = 0; i < sizeof words / sizeof *words; ++i)
        if (map_word_starts(word, words[i])) return fault(p, "faces", "this is Quake 3's format: save the map as Standard or Valve 220");
    return RESULT_OK;
}

static result unclosed(const place *p, const char *what, size_t line)
{
    return report_error(p->m->report, p->m->path, p->m->line, "entity %u: the file ends within the %s of line %zu; close it with '}'",
                        p->entity->number, what, line);
}

static result take_brush(map_reader *m, map_entity *e)
{
    map_brush *brush = buffer_push(&e->brushes, 1);
    if (!brush) return report_no_memory(m->report, m->path);
    *brush = (map_brush){.first_face = e->faces.count, .line = m->line};
    const place p = {m, e, 1};
    result done = refuse_other_games(&p);
    if (done != RESULT_OK) return done;
    while (!take_char(m, '}')) {
        if (m->at >= m->end) return unclosed(&p, "brush", brush->line);
        done = take_face(&p, e);
        if (done != RESULT_OK) return done;
        if (++brush->face_count > FACES_MOST) return fault(&p, "at most 4096 faces", "split the brush");
    }
    if (brush->face_count < 4)
        return report_error(m->report, m->path, brush->line, "entity %u brush %zu: %zu faces enclose nothing; give it 4 or more", e->number,
                            e->brushes.count - 1, brush->face_count);
    return RESULT_OK;
}

static result take_entity(map_reader *m, map_entity *e)
{
    const place p = {m, e, 0};
    while (!take_char(m, '}')) {
        if (m->at >= m->end) return unclosed(&p, "entity", e->line);
        result done;
        if (*m->at == '"') done = take_key(&p, e);
        else if (take_char(m, '{')) done = take_brush(m, e);
        else done = fault(&p, "a key, a brush or '}'", "is this a .map file?");
        if (done != RESULT_OK) return done;
    }
    return RESULT_OK;
}

result map_reader_next(map_reader *m, map_entity *e, map_more *out)
{
    e->keys.count = e->brushes.count = e->faces.count = 0;
    skip_space(m);
    *out = m->at < m->end ? MAP_ENTITY : MAP_END;
    if (*out == MAP_END) return RESULT_OK;
    e->line = m->line;
    e->number = m->entities_read;
    const place p = {m, e, 0};
    if (!take_char(m, '{')) return fault(&p, "'{' of an entity", "is this a .map file?");
    m->entities_read++;
    return take_entity(m, e);
}
