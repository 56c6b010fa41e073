// Exact percentiles and means of samples.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_STATISTICS_H
#define PORTCULLIS_BENCH_STATISTICS_H

#include <stddef.h>

// Sorts `values`. The median of an even count is the mean of the middle two; other shares are the nearest rank. count >= 1.
double percentile(double *values, size_t count, double share);
double mean(const double *values, size_t count);

#endif
