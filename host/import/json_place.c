// Places of values in JSON text: see json_place.h.
// SPDX-License-Identifier: MIT
// Invariant: never reads at or behind `end`, whatever the text is; each byte is looked at a fixed number of times.
#include "json_place.h"

#include <stdint.h>
#include <string.h>

typedef struct scan { const char *at, *end; } scan;

static void skip_space(scan *s)
{
    while (s->at < s->end && (*s->at == ' ' || *s->at == '\t' || *s->at == '\n' || *s->at == '\r')) s->at++;
}

static int take(scan *s, char c) // blanks, then the sign
{
    skip_space(s);
    if (s->at >= s->end || *s->at != c) return 0;
    s->at++;
    return 1;
}

static void skip_string(scan *s) // at its opening quote
{
    for (s->at++; s->at < s->end && *s->at != '"'; s->at++)
        if (*s->at == '\\' && s->at + 1 < s->end) s->at++;
    if (s->at < s->end) s->at++;
}

static void skip_value(scan *s)
{
    size_t depth = 0;
    skip_space(s);
    while (s->at < s->end) {
        const char c = *s->at;
        if (depth == 0 && (c == ',' || c == '}' || c == ']')) return;
        if (c == '"') {
            skip_string(s);
            continue;
        }
        if (c == '{' || c == '[') depth++;
        if (c == '}' || c == ']') depth--;
        s->at++;
    }
}

// ---- Keys ----

static uint32_t hex4(scan *s)
{
    uint32_t code = 0;
    for (int i = 0; i < 4 && s->at < s->end; ++i, ++s->at) {
        const char c = *s->at;
        code = code * 16 + (uint32_t)(c <= '9' ? c - '0' : (c | 32) - 'a' + 10);
    }
    return code;
}

static size_t utf8(uint32_t code, char out[4])
{
    static const unsigned char heads[5] = {0, 0, 0xc0, 0xe0, 0xf0};
    const size_t length = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    for (size_t i = length; i-- > 1; code >>= 6) out[i] = (char)(0x80 | (code & 0x3f));
    out[0] = (char)(heads[length] | code);
    return length;
}

// One character of a string, unescaped.
static size_t next_character(scan *s, char out[4])
{
    static const char letters[] = "bfnrt", meanings[] = "\b\f\n\r\t";
    if (*s->at != '\\' || s->at + 1 >= s->end) {
        out[0] = *s->at++;
        return 1;
    }
    s->at++;
    const char c = *s->at++;
    const char *letter = strchr(letters, c);
    out[0] = letter && c ? meanings[letter - letters] : c;
    if (c != 'u') return 1;
    uint32_t code = hex4(s);
    if (code >= 0xd800 && code < 0xdc00 && s->end - s->at >= 6 && s->at[0] == '\\' && s->at[1] == 'u') {
        s->at += 2;
        code = 0x10000 + ((code - 0xd800) << 10) + ((hex4(s) - 0xdc00) & 0x3ff);
    }
    return utf8(code & 0x1fffff, out);
}

static int string_is(scan s, const char *key) // s: a copy, at the opening quote
{
    for (s.at++; s.at < s.end && *s.at != '"';) {
        char character[4];
        const size_t length = next_character(&s, character);
        if (strncmp(key, character, length) != 0) return 0;
        key += length;
    }
    return *key == 0;
}

// ---- The way ----

typedef enum way { WAY_FOUND, WAY_LOST } way;

static way enter_key(scan *s, const char *key, json_place_kind kind)
{
    if (!take(s, '{')) return WAY_LOST;
    for (;;) {
        skip_space(s);
        if (s->at >= s->end || *s->at != '"') return WAY_LOST;
        const int is_it = string_is(*s, key);
        if (is_it && kind == PLACE_OF_KEY) return WAY_FOUND;
        skip_string(s);
        if (!take(s, ':')) return WAY_LOST;
        skip_space(s);
        if (is_it) return WAY_FOUND;
        skip_value(s);
        if (!take(s, ',')) return WAY_LOST;
    }
}

static way enter_index(scan *s, size_t index)
{
    if (!take(s, '[')) return WAY_LOST;
    for (; index > 0; --index) {
        skip_value(s);
        if (!take(s, ',')) return WAY_LOST;
    }
    skip_space(s);
    return WAY_FOUND;
}

json_place json_place_at(const char *text, size_t offset)
{
    json_place p = {1, 1};
    for (size_t i = 0; i < offset; ++i) {
        if (text[i] == '\n') {
            p.line++;
            p.column = 1;
        } else if (((unsigned char)text[i] & 0xc0) != 0x80) p.column++; // a character's further bytes take no column
    }
    return p;
}

json_place json_place_find(const char *text, size_t size, const json_step *steps, size_t step_count, json_place_kind kind)
{
    scan s = {text, text + size};
    skip_space(&s);
    for (size_t i = 0; i < step_count; ++i) {
        const scan before = s;
        const way w = steps[i].key ? enter_key(&s, steps[i].key, i + 1 == step_count ? kind : PLACE_OF_VALUE) : enter_index(&s, steps[i].index);
        if (w == WAY_FOUND) continue;
        s = before;
        break;
    }
    return json_place_at(text, (size_t)(s.at - text));
}

// ---- Lines of a list ----

static void pass_to(json_item_lines *l, const char *to)
{
    for (; l->at < to; ++l->at) l->line += *l->at == '\n';
}

json_item_lines json_item_lines_of(const char *text, size_t size, const char *list_key)
{
    json_item_lines l = {text, text + size, 1};
    scan s = {text, l.end};
    skip_space(&s);
    if (enter_key(&s, list_key, PLACE_OF_VALUE) == WAY_FOUND && take(&s, '[')) pass_to(&l, s.at);
    return l;
}

size_t json_item_lines_next(json_item_lines *l)
{
    scan s = {l->at, l->end};
    skip_space(&s);
    pass_to(l, s.at);
    const size_t line = l->line;
    skip_value(&s);
    (void)take(&s, ',');
    pass_to(l, s.at);
    return line;
}
