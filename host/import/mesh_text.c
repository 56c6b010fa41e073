// The scanner of the text formats of meshes: see mesh_text.h.
// SPDX-License-Identifier: MIT
#include "mesh_text.h"
#include "number.h"

#include <math.h>
#include <string.h>

static const double COORDINATE_MOST_M = 1e9; // beyond, doubles no longer hold a tenth of a micrometre

mesh_text text_make(const char *path, const char *text, size_t size, report *r)
{
    if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) text += 3, size -= 3; // byte order mark
    return (mesh_text){.at = text, .end = text + size, .line = 1, .path = path, .report = r};
}

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

static int is_break(char c)
{
    return c == '\n' || c == '\r';
}

static void skip_break(mesh_text *t)
{
    t->at += t->at[0] == '\r' && t->at[1] == '\n' ? 2 : 1;
    t->line++;
}

static int joins_next(const mesh_text *t)
{
    return t->joins_lines && *t->at == '\\' && is_break(t->at[1]);
}

void text_skip_blanks(mesh_text *t)
{
    for (;;) {
        while (is_blank(*t->at)) t->at++;
        if (!joins_next(t)) return;
        t->at++;
        skip_break(t);
    }
}

int text_ended(const mesh_text *t)
{
    return t->at >= t->end;
}

int text_line_ended(mesh_text *t)
{
    text_skip_blanks(t);
    return is_break(*t->at) || *t->at == '#' || text_ended(t);
}

void text_next_line(mesh_text *t)
{
    int in_comment = 0;
    for (; !text_ended(t) && !is_break(*t->at); t->at++) {
        if (*t->at == '#') in_comment = 1;
        if (!in_comment && joins_next(t)) { // a path at the end of a comment continues nothing
            t->at++;
            skip_break(t);
            t->at--;
        }
    }
    if (!text_ended(t)) skip_break(t);
}

void text_skip_empty_lines(mesh_text *t)
{
    while (!text_ended(t) && text_line_ended(t)) text_next_line(t);
}

size_t text_word(mesh_text *t, const char **out)
{
    if (text_line_ended(t)) return 0;
    const char *first = t->at;
    while (!text_ended(t) && !is_blank(*t->at) && !is_break(*t->at) && *t->at != '#' && !joins_next(t)) t->at++;
    *out = first;
    return (size_t)(t->at - first);
}

size_t text_rest(mesh_text *t, const char **out)
{
    text_skip_blanks(t);
    const char *first = t->at;
    while (!text_ended(t) && !is_break(*t->at) && !(*t->at == '#' && (t->at == first || is_blank(t->at[-1])))) t->at++;
    const char *last = t->at;
    while (last > first && is_blank(last[-1])) last--;
    *out = first;
    return (size_t)(last - first);
}

int text_is_noise(const mesh_text *t)
{
    const unsigned char c = (unsigned char)*t->at;
    return !text_ended(t) && (c == 127 || (c < 32 && !is_blank((char)c) && !is_break((char)c)));
}

// ---- Numbers ----

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

int text_word_ended(const mesh_text *t)
{
    return is_blank(*t->at) || is_break(*t->at) || *t->at == '#' || text_ended(t) || joins_next(t);
}

// Of what number_read refuses: nan, inf, and digits that overflow a double.
static number_state why_no_number(const mesh_text *t)
{
    const char *at = t->at + (*t->at == '-' || *t->at == '+');
    return strchr("nNiI.0123456789", *at) && *at ? NUMBER_NOT_FINITE : NUMBER_BAD;
}

number_state text_number(mesh_text *t, double *out)
{
    if (text_line_ended(t)) return NUMBER_MISSING;
    double value;
    const char *behind = number_read(t->at, t->end, &value);
    if (!behind) return why_no_number(t);
    const mesh_text rest = {.at = behind, .end = t->end, .joins_lines = t->joins_lines};
    if (!text_word_ended(&rest)) return NUMBER_BAD;
    t->at = behind;
    *out = value;
    return NUMBER_OK;
}

int text_integer(mesh_text *t, int64_t *out)
{
    const char *at = t->at;
    const int negative = *at == '-';
    at += *at == '-' || *at == '+';
    if (!is_digit(*at)) return 0;
    int64_t value = 0;
    for (; is_digit(*at); ++at)
        if (value < (int64_t)1 << 58) value = value * 10 + (*at - '0');
    *out = negative ? -value : value;
    t->at = at;
    return 1;
}

const char *coordinate_fault(double metres)
{
    if (!isfinite(metres)) return "a coordinate is not a finite number; write three finite numbers";
    if (fabs(metres) > COORDINATE_MOST_M) return "a coordinate lies beyond 1e9 m; scale the mesh or move it nearer to its origin";
    return NULL;
}

result text_position(mesh_text *t, const char *what, double out[3])
{
    for (int k = 0; k < 3; ++k) {
        const number_state state = text_number(t, &out[k]);
        if (state == NUMBER_MISSING)
            return report_error(t->report, t->path, t->line, "%s has %d of 3 coordinates; write x y z", what, k);
        if (state == NUMBER_BAD)
            return report_error(t->report, t->path, t->line, "%s: coordinate %d is not a number; write x y z", what, k + 1);
        const char *fault = coordinate_fault(state == NUMBER_NOT_FINITE ? INFINITY : out[k]);
        if (fault) return report_error(t->report, t->path, t->line, "%s: %s", what, fault);
    }
    return RESULT_OK;
}
