// A report for tests that keeps its lines.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_REPORT_LINES_H
#define PORTCULLIS_TESTS_REPORT_LINES_H

#include "host/core/report.h"

enum { REPORT_LINES_MOST = 64, REPORT_LINE_BYTES = 1024 };

typedef struct report_lines {
    report report; // what the tested code takes; points back here, so the struct must not move
    char lines[REPORT_LINES_MOST][REPORT_LINE_BYTES];
    uint32_t count; // of all lines; only the first REPORT_LINES_MOST are kept
} report_lines;

void report_lines_init(report_lines *l);
// The only line, or a text that says how many there were.
const char *report_lines_only(const report_lines *l);
// 1 when there is one line, and it holds `part`; else prints what there is to stderr.
int report_lines_is_one_with(const report_lines *l, const char *part);

#endif
