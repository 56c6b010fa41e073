// The rule of bench --against: see against_rule.h.
// SPDX-License-Identifier: MIT
#include "against_rule.h"
#include "statistics.h"

#include <math.h>
#include <stdlib.h>

static int by_size(const void *a, const void *b)
{
    const double x = fabs(*(const double *)a), y = fabs(*(const double *)b);
    return (x > y) - (x < y);
}

static uint32_t drop_zeros(double *values, uint32_t count)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i)
        if (values[i] != 0) values[kept++] = values[i];
    return kept;
}

double against_signed_rank(double *values, uint32_t count)
{
    const uint32_t n = drop_zeros(values, count);
    double above = 0, ties = 0;
    if (!n) return 1;
    qsort(values, n, sizeof *values, by_size);
    for (uint32_t i = 0, end; i < n; i = end) {
        for (end = i + 1; end < n && fabs(values[end]) == fabs(values[i]);) ++end;
        const double tied = end - i, rank = (i + 1 + end) / 2.0; // the mean of ranks i + 1 to end
        for (uint32_t k = i; k < end; ++k) above += values[k] > 0 ? rank : 0;
        ties += tied * tied * tied - tied;
    }
    const double size = n, expected = size * (size + 1) / 4, variance = size * (size + 1) * (2 * size + 1) / 24 - ties / 48;
    if (!(variance > 0)) return 1;
    return 0.5 * erfc((above - expected - 0.5) / sqrt(2 * variance)); // half a rank for continuity
}

// Logarithms of the views that have both times.
static uint32_t logs_of(const against_times *t, double *logs)
{
    uint32_t count = 0;
    for (uint32_t v = 0; v < t->count; ++v)
        if (t->old_ns[v] > 0 && t->new_ns[v] > 0) logs[count++] = log(t->new_ns[v] / t->old_ns[v]);
    return count;
}

double against_drift(const against_times *reference, double *scratch)
{
    const uint32_t count = logs_of(reference, scratch);
    return count ? exp(percentile(scratch, count, 0.5)) : 1;
}

// That sign * log ratio lies above the rule's.
static double p_of(const double *logs, uint32_t count, double sign, const against_rule *rule, double *values)
{
    for (uint32_t i = 0; i < count; ++i) values[i] = sign * logs[i] - log(rule->least_ratio);
    return against_signed_rank(values, count);
}

against_finding against_judge(const against_times *t, double drift, const against_rule *rule, double *scratch)
{
    double *logs = scratch, *values = scratch + t->count;
    const uint32_t count = logs_of(t, logs);
    against_finding f = {1, 1, AGAINST_TOO_FEW};
    if (count < AGAINST_VIEWS_LEAST) return f;
    for (uint32_t i = 0; i < count; ++i) logs[i] -= log(drift);
    f.ratio = exp(percentile(logs, count, 0.5));
    f.p = p_of(logs, count, 1, rule, values);
    f.verdict = f.p < rule->level ? AGAINST_SLOWER : AGAINST_SAME;
    if (f.verdict == AGAINST_SLOWER) return f;
    const double faster = p_of(logs, count, -1, rule, values);
    if (faster < rule->level) f = (against_finding){f.ratio, faster, AGAINST_FASTER};
    return f;
}
