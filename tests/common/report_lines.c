// A report for tests that keeps its lines: see report_lines.h.
// SPDX-License-Identifier: MIT
#include "report_lines.h"

#include <stdio.h>
#include <string.h>

static void keep_line(void *user, report_level level, const char *text)
{
    report_lines *l = user;
    (void)level;
    if (l->count < REPORT_LINES_MOST) snprintf(l->lines[l->count], REPORT_LINE_BYTES, "%s", text);
    l->count++;
}

void report_lines_init(report_lines *l)
{
    memset(l, 0, sizeof *l);
    l->report = (report){.line = keep_line, .user = l};
}

const char *report_lines_only(const report_lines *l)
{
    return l->count == 0 ? "(no line)" : l->count == 1 ? l->lines[0] : "(several lines)";
}

int report_lines_is_one_with(const report_lines *l, const char *part)
{
    if (l->count == 1 && strstr(l->lines[0], part)) return 1;
    fprintf(stderr, "expected one line with '%s', got %u:\n", part, l->count);
    for (uint32_t i = 0; i < l->count && i < REPORT_LINES_MOST; ++i) fprintf(stderr, "  %s\n", l->lines[i]);
    return 0;
}
