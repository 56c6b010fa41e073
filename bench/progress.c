// Progress bar: see progress.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "progress.h"

#include <stdio.h>
#include <unistd.h>

progress progress_start(uint64_t total)
{
    return (progress){.total = total ? total : 1, .shown = isatty(STDERR_FILENO), .percent = -1};
}

void progress_tell(progress *p, const char *what)
{
    const int percent = (int)(p->done++ * 100 / p->total);
    if (!p->shown || percent == p->percent) return;
    p->percent = percent;
    fprintf(stderr, "\r\033[K[%-20.*s] %3d%% %.40s", percent / 5, "####################", percent, what);
    fflush(stderr);
}

void progress_end(progress *p)
{
    if (p->shown) fprintf(stderr, "\r\033[K");
}
