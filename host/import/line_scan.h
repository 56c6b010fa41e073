// Scanner of text with numbers in lines: blanks, line ends, comments, and where it stands, for messages.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_LINE_SCAN_H
#define PORTCULLIS_HOST_LINE_SCAN_H

#include "../core/report.h"

typedef struct line_scan { // [one thread]
    const char *path, *at, *end;
    size_t line; // of `at`, from 1
    report *report;
    char comment; // from it to the line's end is nothing; '\n': no such sign
} line_scan;

void line_scan_skip_blanks(line_scan *s);
int line_scan_at_end(line_scan *s);      // 1 when nothing but blanks and a comment is left of the line; skips the blanks
void line_scan_next(line_scan *s);       // to the next line's first byte
void line_scan_skip_empty(line_scan *s); // to the first byte of the next line that holds anything, or to the end
// One number with a blank, a comment or the line's end behind it. 0: none stands there, only blanks were skipped.
int line_scan_number(line_scan *s, double *out);
int line_scan_word(line_scan *s, const char *word); // the same for a word
result line_scan_fault(line_scan *s, const char *what); // reports it with the line

#endif
