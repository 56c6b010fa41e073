// Statistics: see statistics.h.
// SPDX-License-Identifier: MIT
#include "statistics.h"

#include <math.h>
#include <stdlib.h>

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double percentile(double *values, size_t count, double share)
{
    qsort(values, count, sizeof *values, ascending);
    if (share == 0.5) return (values[(count - 1) / 2] + values[count / 2]) / 2;
    const double rank = ceil(share * (double)count);
    const size_t at = rank < 1 ? 0 : (size_t)rank - 1;
    return values[at < count ? at : count - 1];
}

double mean(const double *values, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; ++i) sum += values[i];
    return sum / (double)count;
}
