// Choosing a chain for each group of zones: see choose.h.
// SPDX-License-Identifier: MIT
// Invariant: every choice is exact in a run in which all other groups had what they have by then, so the whole always is.
#include "choose.h"

#include <math.h>
#include <string.h>

static const uint32_t NOBODY = UINT32_MAX;

static int is_simpler(const choose_candidate *a, const choose_candidate *b)
{
    return a->stages != b->stages ? a->stages < b->stages : a->options < b->options;
}

static uint32_t fastest_but(const choose_cost *costs, uint32_t count, uint32_t but)
{
    uint32_t best = NOBODY;
    for (uint32_t i = 0; i < count; ++i)
        if (costs[i].is_exact && i != but && (best == NOBODY || costs[i].ms < costs[best].ms)) best = i;
    return best;
}

choose_pick choose_one(const choose_candidate *candidates, const choose_cost *costs, uint32_t count, double noise)
{
    const uint32_t fastest = fastest_but(costs, count, NOBODY);
    choose_pick p = {.candidate = fastest, .next = NOBODY, .margin = fmax(CHOOSE_MARGIN, 2 * noise)};
    if (fastest == NOBODY) return p;
    for (uint32_t i = 0; i < count; ++i) // a tie goes to the simpler one, of equally simple ones to the faster
        if (costs[i].is_exact && costs[i].ms <= costs[fastest].ms * (1 + p.margin) && is_simpler(&candidates[i], &candidates[p.candidate])) p.candidate = i;
    for (uint32_t i = 0; i < count; ++i)
        if (costs[i].is_exact && !is_simpler(&candidates[p.candidate], &candidates[i]) && !is_simpler(&candidates[i], &candidates[p.candidate]) &&
            costs[i].ms < costs[p.candidate].ms)
            p.candidate = i;
    p.next = fastest_but(costs, count, p.candidate);
    p.ms = costs[p.candidate].ms;
    p.next_ms = p.next == NOBODY ? 0 : costs[p.next].ms;
    p.reason = p.next == NOBODY ? CHOOSE_ONLY : p.next_ms <= p.ms * (1 + p.margin) ? CHOOSE_SIMPLER : CHOOSE_FASTEST;
    return p;
}

typedef struct search {
    const choose_request *q;
    const allocator *memory;
    uint32_t *assignments; // (candidates + 1) * groups
    uint32_t *which;       // the candidate that each assignment of a run tries
    choose_cost *measured, *costs; // in the order of the run; by candidate
    uint32_t *now;         // by group
    uint8_t *is_usable;    // by candidate: exact where all groups have it
} search;

// Tries those candidates in the group (NOBODY: in all), and the present state once more at the end, which tells the noise.
static result try_all(search *s, uint32_t group, uint32_t count, double *out_noise)
{
    const uint32_t groups = s->q->group_count;
    for (uint32_t i = 0; i <= count; ++i) {
        uint32_t *to = s->assignments + (size_t)i * groups;
        memcpy(to, s->now, groups * sizeof *to);
        for (uint32_t g = 0; g < groups && i < count; ++g)
            if (group == NOBODY || g == group) to[g] = s->which[i];
        if (i == count && group == NOBODY)
            for (uint32_t g = 0; g < groups; ++g) to[g] = s->which[0];
    }
    const result done = s->q->measurer.measure(s->q->measurer.user, s->assignments, count + 1, s->measured);
    if (done != RESULT_OK) return done;
    memset(s->costs, 0, s->q->candidate_count * sizeof *s->costs);
    double twin = NAN;
    for (uint32_t i = 0; i < count; ++i) {
        s->costs[s->which[i]] = s->measured[i];
        if (memcmp(s->assignments + (size_t)i * groups, s->assignments + (size_t)count * groups, groups * sizeof *s->now) == 0) twin = s->measured[i].ms;
    }
    *out_noise = twin > 0 ? fabs(s->measured[count].ms - twin) / twin : 0;
    return RESULT_OK;
}

static result choose_uniform(search *s, choose_pick *out)
{
    const choose_request *q = s->q;
    double noise;
    for (uint32_t i = 0; i < q->candidate_count; ++i) s->which[i] = i;
    const result done = try_all(s, NOBODY, q->candidate_count, &noise);
    if (done != RESULT_OK) return done;
    *out = choose_one(q->candidates, s->costs, q->candidate_count, noise);
    if (out->candidate == NOBODY) return RESULT_BAD_INPUT;
    for (uint32_t i = 0; i < q->candidate_count; ++i) s->is_usable[i] = s->costs[i].is_exact != 0;
    for (uint32_t g = 0; g < q->group_count; ++g) s->now[g] = out->candidate;
    return RESULT_OK;
}

// Stays as it is where nothing tried is exact, which then says that the present state is not measured as exact again.
static result choose_group(search *s, uint32_t group, choose_pick *out)
{
    const choose_request *q = s->q;
    uint32_t count = 0;
    double noise;
    for (uint32_t i = 0; i < q->candidate_count; ++i)
        if (s->is_usable[i]) s->which[count++] = i;
    const result done = try_all(s, group, count, &noise);
    if (done != RESULT_OK) return done;
    const choose_pick pick = choose_one(q->candidates, s->costs, q->candidate_count, noise);
    if (pick.candidate == NOBODY) return RESULT_OK;
    *out = pick;
    s->now[group] = pick.candidate;
    return RESULT_OK;
}

static result search_all(search *s, choose_pick *out_uniform, choose_pick *out)
{
    const choose_request *q = s->q;
    result done = choose_uniform(s, out_uniform);
    uint32_t usable = 0;
    for (uint32_t i = 0; i < q->candidate_count; ++i) usable += s->is_usable[i];
    for (uint32_t g = 0; g < q->group_count && done == RESULT_OK; ++g) {
        out[g] = *out_uniform;
        if (q->group_count == 1 || usable < 2) continue;
        out[g].reason = CHOOSE_UNTRIED;
        if (!(q->weights[g] > 0) || q->measurer.is_over(q->measurer.user)) continue;
        done = choose_group(s, g, &out[g]);
    }
    return done;
}

result choose_all(const choose_request *q, const allocator *memory, choose_pick *out_uniform, choose_pick *out)
{
    const size_t runs = (size_t)q->candidate_count + 1;
    search s = {.q = q, .memory = memory};
    s.assignments = memory_alloc_zeroed(memory, runs * q->group_count, sizeof *s.assignments);
    s.which = memory_alloc_zeroed(memory, runs, sizeof *s.which);
    s.measured = memory_alloc_zeroed(memory, runs, sizeof *s.measured);
    s.costs = memory_alloc_zeroed(memory, runs, sizeof *s.costs);
    s.now = memory_alloc_zeroed(memory, q->group_count, sizeof *s.now);
    s.is_usable = memory_alloc_zeroed(memory, runs, 1);
    const int opened = s.assignments && s.which && s.measured && s.costs && s.now && s.is_usable;
    const result done = opened ? search_all(&s, out_uniform, out) : RESULT_NO_MEMORY;
    memory_free(memory, s.assignments, runs * q->group_count, sizeof *s.assignments);
    memory_free(memory, s.which, runs, sizeof *s.which);
    memory_free(memory, s.measured, runs, sizeof *s.measured);
    memory_free(memory, s.costs, runs, sizeof *s.costs);
    memory_free(memory, s.now, q->group_count, sizeof *s.now);
    memory_free(memory, s.is_usable, runs, 1);
    return done;
}
