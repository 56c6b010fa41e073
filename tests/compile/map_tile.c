// Maps tiled: see map_tile.h. Tokens are copied one by one; points and origins move on the way.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L // open_memstream
#include "map_tile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double LIMIT = 65536, GAP = 256; // units

typedef struct word { const char *text; size_t length; } word; // quotes of a string are part of it

typedef struct tiling {
    const char *end;
    FILE *to;
    double min[2], max[2]; // of all points
    long step;             // from a copy to the next
    unsigned side;
    int is_sound;
} tiling;

static int is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

// An empty word at the end of the text.
static word next_word(const tiling *t, const char **at)
{
    const char *p = *at;
    for (;;) {
        while (p < t->end && is_space(*p)) ++p;
        if (p + 1 >= t->end || p[0] != '/' || p[1] != '/') break;
        while (p < t->end && *p != '\n') ++p;
    }
    const char *from = p;
    if (p < t->end && *p == '"') {
        for (++p; p < t->end && *p != '"'; ++p) {}
        p += p < t->end;
    } else {
        while (p < t->end && !is_space(*p)) ++p;
    }
    *at = p;
    return (word){from, (size_t)(p - from)};
}

static int is(word w, const char *text)
{
    return w.length == strlen(text) && memcmp(w.text, text, w.length) == 0;
}

// ---- Numbers ----

// The decimal plus whole units: its digits behind the point stay. 0: an exponent, or more than 14 of them.
static int put_exactly(FILE *to, word w, long by)
{
    int digits = 0, point = 0, negative = 0;
    long long value = 0, one = 1;
    for (size_t i = 0; i < w.length; ++i) {
        const char c = w.text[i];
        if (i == 0 && (c == '-' || c == '+')) negative = c == '-';
        else if (c == '.' && !point) point = 1;
        else if (c < '0' || c > '9' || digits + point > 17 || value > 90000000000000000) return 0;
        else {
            value = 10 * value + (c - '0');
            digits += point;
            if (point) one *= 10;
        }
    }
    if (one > 100000000000000) return 0; // 10^14 * 65,536 fits
    const long long sum = (negative ? -value : value) + by * one, size = sum < 0 ? -sum : sum;
    if (digits) fprintf(to, "%s%lld.%0*lld", sum < 0 ? "-" : "", size / one, digits, size % one);
    else fprintf(to, "%s%lld", sum < 0 ? "-" : "", size);
    return 1;
}

static double number(word w)
{
    char text[64] = "";
    if (w.length < sizeof text) memcpy(text, w.text, w.length);
    return strtod(text, NULL);
}

static int put_moved(FILE *to, word w, long by)
{
    if (put_exactly(to, w, by)) return 1;
    const double v = number(w) + (double)by;
    return isfinite(v) && fprintf(to, "%.12f", v) > 0;
}

// ---- One entity ----

typedef struct tile { long move[3]; unsigned number; } tile;
typedef enum entity_part { PART_KEYS = 1, PART_BRUSHES = 2 } entity_part;

static void put_words(tiling *t, const char **at, const tile *where) // three numbers, the first two moved
{
    for (int k = 0; k < 3; ++k) {
        const word w = next_word(t, at);
        fputc(' ', t->to);
        if (!put_moved(t->to, w, where->move[k])) t->is_sound = 0;
    }
}

static void put_value(tiling *t, word key, word value, const tile *where)
{
    fprintf(t->to, "%.*s ", (int)key.length, key.text);
    if (is(key, "\"origin\"") && value.length > 2) {
        const tiling inside = {.end = value.text + value.length - 1, .to = t->to, .is_sound = 1};
        tiling copy = inside;
        const char *at = value.text + 1;
        fputc('"', t->to);
        put_words(&copy, &at, where);
        t->is_sound &= copy.is_sound;
        fprintf(t->to, "\"\n");
    } else if (is(key, "\"target\"") || is(key, "\"targetname\"") || is(key, "\"killtarget\"")) {
        fprintf(t->to, "%.*s_%u\"\n", (int)value.length - 1, value.text, where->number);
    } else {
        fprintf(t->to, "%.*s\n", (int)value.length, value.text);
    }
}

// Behind the entity's opening brace to behind its closing one; keys first, then brushes, each if asked for.
static const char *put_entity(tiling *t, const char *at, const tile *where, unsigned parts)
{
    for (int depth = 1, was_point = 0; depth > 0;) {
        const word w = next_word(t, &at);
        if (w.length == 0) {
            t->is_sound = 0;
            break;
        }
        if (is(w, "}") && --depth == 0) break;
        depth += is(w, "{");
        if (depth == 1 && w.text[0] == '"') {
            const word value = next_word(t, &at);
            if (parts & PART_KEYS) put_value(t, w, value, where);
        } else if (parts & PART_BRUSHES) {
            const int brace = is(w, "{") || is(w, "}"), first = is(w, "(") && !was_point;
            fprintf(t->to, "%s%.*s ", brace || first ? "\n" : "", (int)w.length, w.text);
            if (is(w, "(")) put_words(t, &at, where);
            was_point = is(w, ")");
        } else if (is(w, "(")) {
            for (int k = 0; k < 3; ++k) {
                const double v = number(next_word(t, &at));
                if (k < 2) t->min[k] = fmin(t->min[k], v);
                if (k < 2) t->max[k] = fmax(t->max[k], v);
            }
        }
    }
    return at;
}

// ---- All of it ----

static tile tile_at(const tiling *t, unsigned number)
{
    const long span = (long)(t->side - 1) * t->step / 2;
    return (tile){{(long)(number % t->side) * t->step - span, (long)(number / t->side) * t->step - span, 0}, number};
}

static void put_all(tiling *t, const char *text)
{
    const unsigned tiles = t->side * t->side;
    int world = 1;
    const char *at = text;
    for (word w = next_word(t, &at); w.length && t->is_sound; w = next_word(t, &at), world = 0) {
        const char *behind = at;
        t->is_sound &= is(w, "{");
        for (unsigned i = 0; i < tiles; ++i) {
            const tile where = tile_at(t, i);
            if (!world || i == 0) {
                fprintf(t->to, "{\n");
                put_entity(t, at, &where, PART_KEYS);
            }
            behind = put_entity(t, at, &where, PART_BRUSHES);
            if (!world || i + 1 == tiles) fprintf(t->to, "\n}\n");
        }
        at = behind;
    }
}

// A whole, even number of units, so that half of it is whole too.
static void choose_step(tiling *t, const char *text)
{
    const char *at = text;
    const tile nowhere = {0};
    for (word w = next_word(t, &at); w.length && t->is_sound; w = next_word(t, &at)) at = put_entity(t, at, &nowhere, 0);
    const double x = t->max[0] - t->min[0], y = t->max[1] - t->min[1], wider = x > y ? x : y;
    if (wider >= 0 && wider <= 2 * LIMIT) t->step = 64 * (long)ceil((wider + GAP) / 64); // else there is no map, or too wide a one
}

tile_fault map_tile(const char *text, size_t size, unsigned side, char **out, size_t *out_size)
{
    tiling t = {.end = text + size, .min = {INFINITY, INFINITY}, .max = {-INFINITY, -INFINITY}, .side = side, .is_sound = 1};
    choose_step(&t, text);
    if (!t.is_sound || !(t.min[0] < t.max[0])) return TILE_NO_MAP;
    const double span = (double)(side - 1) * (double)t.step / 2;
    for (int k = 0; k < 2; ++k)
        if (t.max[k] + span > LIMIT || t.min[k] - span < -LIMIT) return TILE_TOO_WIDE;
    t.to = open_memstream(out, out_size);
    if (!t.to) return TILE_NO_MEMORY;
    put_all(&t, text);
    if (fclose(t.to) == 0 && t.is_sound) return TILE_SOUND;
    free(*out);
    return t.is_sound ? TILE_NO_MEMORY : TILE_NO_MAP;
}
