// When a strategy counts as slower than in an earlier run: the rule of bench --against.
// SPDX-License-Identifier: MIT
//
// A view's time is the least of its passes, since what disturbs only adds. Views are paired: x = log(new / old) of each view, less the median of the same of a
// reference strategy that both runs measured, so that a machine that is slower today changes nothing. Slower: a one-sided signed-rank test (Wilcoxon, Individual
// Comparisons by Ranking Methods, 1945; normal approximation with ties) says that x lies above the least ratio that counts, at the level by the number of tests
// (Bonferroni). So a shift of all views that stays under that ratio is never called, however sure; that is what two runs of one build differ by.
#ifndef PORTCULLIS_BENCH_AGAINST_RULE_H
#define PORTCULLIS_BENCH_AGAINST_RULE_H

#include <stdint.h>

enum { AGAINST_VIEWS_LEAST = 20 }; // the approximation needs them

typedef struct against_times { // by view; count of each
    const double *old_ns, *new_ns;
    uint32_t count;
} against_times;
typedef struct against_rule {
    double least_ratio; // over 1
    double level;       // of one test
} against_rule;
typedef enum against_verdict { AGAINST_SAME, AGAINST_SLOWER, AGAINST_FASTER, AGAINST_TOO_FEW } against_verdict;
typedef struct against_finding {
    double ratio; // the median of new by old, less the drift
    double p;     // of the verdict; of SLOWER where it is SAME
    against_verdict verdict;
} against_finding;

// scratch: count. 1 where no view has both times.
double against_drift(const against_times *reference, double *scratch);
// scratch: 2 * count.
against_finding against_judge(const against_times *t, double drift, const against_rule *rule, double *scratch);
// One-sided: that the values lie above 0. Writes over them. 1 where there are none but zeros.
double against_signed_rank(double *values, uint32_t count);

#endif
