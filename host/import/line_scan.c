// Scanner of lines: see line_scan.h.
// SPDX-License-Identifier: MIT
#include "line_scan.h"

#include "number.h"

#include <string.h>

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

// A byte order mark can only stand first: some editors put one there.
static void skip_mark(line_scan *s)
{
    if (s->line == 1 && s->end - s->at >= 3 && memcmp(s->at, "\xef\xbb\xbf", 3) == 0) s->at += 3;
}

void line_scan_skip_blanks(line_scan *s)
{
    skip_mark(s);
    while (s->at < s->end && is_blank(*s->at)) s->at++;
}

int line_scan_at_end(line_scan *s)
{
    line_scan_skip_blanks(s);
    return s->at >= s->end || *s->at == '\n' || *s->at == s->comment;
}

void line_scan_next(line_scan *s)
{
    while (s->at < s->end && *s->at != '\n') s->at++;
    if (s->at < s->end) s->at++;
    s->line++;
}

void line_scan_skip_empty(line_scan *s)
{
    while (line_scan_at_end(s) && s->at < s->end) line_scan_next(s);
}

static int take(line_scan *s, const char *behind)
{
    if (behind < s->end && !is_blank(*behind) && *behind != '\n' && *behind != s->comment) return 0;
    s->at = behind;
    return 1;
}

int line_scan_number(line_scan *s, double *out)
{
    line_scan_skip_blanks(s);
    const char *behind = number_read(s->at, s->end, out);
    return behind && take(s, behind);
}

int line_scan_word(line_scan *s, const char *word)
{
    const size_t length = strlen(word);
    line_scan_skip_blanks(s);
    return (size_t)(s->end - s->at) >= length && memcmp(s->at, word, length) == 0 && take(s, s->at + length);
}

result line_scan_fault(line_scan *s, const char *what)
{
    return report_error(s->report, s->path, s->line, "%s", what);
}
