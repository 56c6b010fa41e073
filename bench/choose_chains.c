// Choosing chains: see choose_chains.h. Each measurement is one run of the bench, assignments interleaved, against the truth.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "choose_chains.h"
#include "strategy.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct chooser {
    const chains_request *q;
    const bench_request *bench;
    const allocator *memory;
    report *r;
    chains_result *out;
    uint32_t *usable; // of choose.h's candidates: which of the request's
    uint32_t usable_count;
    double start_s;
    uint32_t is_first; // the run of all groups alike, whose rows are told
} chooser;

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static int is_over(void *user)
{
    const chooser *c = user;
    return now_s() - c->start_s > c->q->budget_s;
}

// ---- Candidates ----

// A chain's promises may hang on its options: only the built one says.
static const char *fault_of(const chooser *c, const bench_strategy_request *chains, report *quiet)
{
    strategy s = {0};
    bench_request one = *c->bench;
    one.strategies = chains;
    one.strategy_count = one.repeat = 1;
    if (strategy_open(&one, chains, NULL, quiet, &s) != RESULT_OK) return "cannot be built here";
    const char *fault = NULL;
    for (uint32_t z = 0; z < c->bench->scene->zone_count && !fault; ++z) {
        const chain *built = world_chain(s.world, z);
        if (built && !(built->promises & (CULL_CONSERVATIVE | CULL_SAMPLED))) fault = "promises nothing";
    }
    if (!fault && s.has_pictures) fault = "shows pictures of its own";
    strategy_close(&s);
    return fault;
}

static result sift(chooser *c)
{
    report quiet = {0};
    for (uint32_t i = 0; i < c->bench->strategy_count; ++i) {
        c->out->candidates[i].rejected = fault_of(c, &c->bench->strategies[i], &quiet);
        if (!c->out->candidates[i].rejected) c->usable[c->usable_count++] = i;
    }
    return c->usable_count ? RESULT_OK : report_error(c->r, NULL, 0, "no candidate can be built that promises to lose nothing; name others");
}

// ---- Weights ----

static double polygons_of(const strategy *s, const visible_zone *v)
{
    const uint32_t *order = s->order + s->zones[v->zone].first;
    double count = 0;
    for (uint32_t r = 0; r < v->run_count; ++r)
        for (uint32_t p = v->runs[r].first; p < v->runs[r].first + v->runs[r].count; ++p) count += s->q->scene->items[order[p]].polygon_count;
    return count;
}

static result weigh_zones(chooser *c, const bench_strategy_request *chains, double *weights)
{
    strategy s = {0};
    bench_request one = *c->bench;
    one.strategies = chains;
    one.strategy_count = one.repeat = 1;
    result done = strategy_open(&one, chains, NULL, c->r, &s);
    for (uint32_t v = 0; v < one.path->count && done == RESULT_OK; ++v) {
        strategy_view view;
        const strategy_request request = {.view = v, .marks = MARK_NOTHING};
        done = strategy_run_view(&s, &request, c->r, &view);
        for (uint32_t i = 0; done == RESULT_OK && i < view.set.zone_count; ++i) weights[view.set.zones[i].zone] += polygons_of(&s, &view.set.zones[i]);
    }
    strategy_close(&s);
    return done;
}

typedef struct weighed { double weight; uint32_t zone; } weighed;

static int by_weight(const void *a, const void *b)
{
    const weighed *x = a, *y = b;
    return x->weight != y->weight ? (x->weight < y->weight) - (x->weight > y->weight) : (x->zone > y->zone) - (x->zone < y->zone);
}

// The heaviest alone, the rest together; sorted by weight again, since the rest may be the heaviest.
static void make_groups(chooser *c, const weighed *zones, uint32_t count)
{
    weighed groups[CHOOSE_GROUPS_MOST] = {{0, 0}};
    uint32_t places[CHOOSE_GROUPS_MOST];
    const uint32_t most = c->q->group_most < CHOOSE_GROUPS_MOST ? c->q->group_most : CHOOSE_GROUPS_MOST - 1;
    double all = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t g = i < most ? i : most;
        groups[g].weight += zones[i].weight;
        groups[g].zone = g;
        c->out->group_of_zone[zones[i].zone] = g;
        all += zones[i].weight;
    }
    c->out->group_count = count < most ? count : most + (count > most);
    qsort(groups, c->out->group_count, sizeof *groups, by_weight);
    for (uint32_t g = 0; g < c->out->group_count; ++g) {
        places[groups[g].zone] = g;
        c->out->shares[g] = all > 0 ? groups[g].weight / all : 0;
    }
    for (uint32_t z = 0; z < count; ++z) c->out->group_of_zone[z] = places[c->out->group_of_zone[z]];
}

static result find_groups(chooser *c)
{
    const uint32_t count = c->bench->scene->zone_count;
    arena names = arena_make(c->memory);
    chain_spec *spec = arena_push(&names, 1, sizeof *spec);
    double *weights = memory_alloc_zeroed(c->memory, count, sizeof *weights);
    weighed *zones = memory_alloc_zeroed(c->memory, count, sizeof *zones);
    result done = spec && weights && zones ? RESULT_OK : report_no_memory(c->r, NULL);
    if (done == RESULT_OK) done = chain_parse("frustum", &names, c->r, spec);
    if (done == RESULT_OK) done = weigh_zones(c, &(bench_strategy_request){.name = "frustum", .chain = spec}, weights);
    for (uint32_t z = 0; z < count && done == RESULT_OK; ++z) zones[z] = (weighed){weights[z], z};
    if (done == RESULT_OK) {
        qsort(zones, count, sizeof *zones, by_weight);
        make_groups(c, zones, count);
    }
    memory_free(c->memory, weights, count, sizeof *weights);
    memory_free(c->memory, zones, count, sizeof *zones);
    arena_free(&names);
    return done;
}

// ---- Measuring ----

typedef struct assigned { // the bench's strategies of some assignments
    bench_strategy_request *strategies;
    const chain_spec **chains;            // count * zones
    const chain_spec *const **sets;       // count
} assigned;

static const chain_spec *chain_in(const bench_strategy_request *candidate, uint32_t zone)
{
    const chain_spec *own = candidate->set_count ? candidate->sets[0][zone] : NULL;
    return own ? own : candidate->chain;
}

static void assign(const chooser *c, const uint32_t *assignments, uint32_t count, const assigned *to)
{
    const uint32_t zones = c->bench->scene->zone_count;
    for (uint32_t i = 0; i < count; ++i) {
        const chain_spec **chains = to->chains + (size_t)i * zones;
        for (uint32_t z = 0; z < zones; ++z) {
            const uint32_t candidate = assignments[(size_t)i * c->out->group_count + c->out->group_of_zone[z]];
            chains[z] = chain_in(&c->bench->strategies[c->usable[candidate]], z);
        }
        to->sets[i] = chains;
        to->strategies[i] = (bench_strategy_request){.name = chains[0]->text, .chain = chains[0], .sets = &to->sets[i], .set_count = 1};
    }
}

static void note_cost(const chooser *c, uint32_t i, const bench_row *row, choose_cost *out)
{
    *out = (choose_cost){row->total_ms_mean, !row->missed_pixels && !row->missed_items && !row->picture_differs && !row->faults};
    if (!c->is_first || i >= c->usable_count) return;
    chains_candidate *told = &c->out->candidates[c->usable[i]];
    told->ms = row->total_ms_mean;
    told->missed_pixels = row->missed_pixels;
    told->missed_items = row->missed_items;
    told->inexact = out->is_exact ? NULL : row->missed_pixels || row->missed_items ? "misses what is seen" : "draws what it does not say";
}

static result measure(void *user, const uint32_t *assignments, uint32_t count, choose_cost *out)
{
    chooser *c = user;
    const size_t zones = c->bench->scene->zone_count;
    bench_request bench = *c->bench;
    bench_result measured;
    const assigned to = {memory_alloc_zeroed(c->memory, count, sizeof(bench_strategy_request)),
                         memory_alloc_zeroed(c->memory, count * zones, sizeof(chain_spec *)), memory_alloc_zeroed(c->memory, count, sizeof(chain_spec **))};
    result done = to.strategies && to.chains && to.sets ? RESULT_OK : report_no_memory(c->r, NULL);
    if (done == RESULT_OK) {
        assign(c, assignments, count, &to);
        bench.strategies = to.strategies;
        bench.strategy_count = count;
        bench.pictures = BENCH_PICTURES_NONE;
        done = bench_run(&bench, c->r, &measured);
    }
    if (done == RESULT_OK) {
        for (uint32_t i = 0; i < count; ++i) note_cost(c, i, &measured.rows[i], &out[i]);
        bench_result_free(&measured);
        c->is_first = 0;
    }
    memory_free(c->memory, to.strategies, count, sizeof *to.strategies);
    memory_free(c->memory, to.chains, count * zones, sizeof *to.chains);
    memory_free(c->memory, to.sets, count, sizeof *to.sets);
    return done;
}

// ---- The choice ----

static void take_uniform(chains_result *out)
{
    out->is_uniform = 1;
    for (uint32_t g = 0; g < out->group_count; ++g) {
        const double share = out->shares[g];
        out->picks[g] = out->uniform;
        if (!(share > 0)) out->picks[g].reason = CHOOSE_UNTRIED;
    }
}

// Small gains, each beyond its margin, may be none together: the mix stays only where it is exact, and faster by the margin than one chain for all.
static result confirm(chooser *c, uint32_t *assignments)
{
    chains_result *out = c->out;
    const uint32_t groups = out->group_count;
    choose_cost costs[2];
    out->is_uniform = 1;
    for (uint32_t g = 0; g < groups; ++g) {
        assignments[g] = out->uniform.candidate;
        assignments[groups + g] = out->picks[g].candidate;
        out->is_uniform &= out->picks[g].candidate == out->uniform.candidate;
    }
    out->uniform_ms = out->chosen_ms = out->uniform.ms;
    if (out->is_uniform) return RESULT_OK;
    const result done = measure(c, assignments, 2, costs);
    if (done != RESULT_OK) return done;
    out->uniform_ms = costs[0].ms;
    out->chosen_ms = costs[1].ms;
    if (!costs[1].is_exact || costs[1].ms * (1 + CHOOSE_MARGIN) >= costs[0].ms) take_uniform(out);
    return RESULT_OK;
}

static uint32_t option_count(const chain_spec *s)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->stage_count; ++i) count += s->stages[i].option_count;
    return count;
}

static void name_requested(const chooser *c, choose_pick *p)
{
    if (p->candidate != UINT32_MAX) p->candidate = c->usable[p->candidate];
    if (p->next != UINT32_MAX) p->next = c->usable[p->next];
}

static result choose(chooser *c)
{
    chains_result *out = c->out;
    choose_candidate *candidates = memory_alloc_zeroed(c->memory, c->usable_count, sizeof *candidates);
    uint32_t *both = memory_alloc_zeroed(c->memory, 2 * (size_t)out->group_count, sizeof *both);
    result done = candidates && both ? RESULT_OK : report_no_memory(c->r, NULL);
    for (uint32_t i = 0; i < c->usable_count && done == RESULT_OK; ++i) {
        const chain_spec *spec = chain_in(&c->bench->strategies[c->usable[i]], 0);
        candidates[i] = (choose_candidate){spec->stage_count, option_count(spec)};
    }
    const choose_request request = {candidates, c->usable_count, out->group_count, out->shares, {c, measure, is_over}};
    c->is_first = 1;
    const uint32_t errors = c->r->errors;
    if (done == RESULT_OK) done = choose_all(&request, c->memory, &out->uniform, out->picks);
    if (done == RESULT_BAD_INPUT && c->r->errors == errors)
        report_error(c->r, NULL, 0, "every candidate misses something over these views: `first-miss` says what");
    if (done == RESULT_OK) done = confirm(c, both);
    for (uint32_t g = 0; g < out->group_count && done == RESULT_OK; ++g) name_requested(c, &out->picks[g]);
    if (done == RESULT_OK) name_requested(c, &out->uniform);
    memory_free(c->memory, candidates, c->usable_count, sizeof *candidates);
    memory_free(c->memory, both, 2 * (size_t)out->group_count, sizeof *both);
    return done;
}

result chains_choose(const chains_request *q, report *r, chains_result *out)
{
    const allocator *memory = q->bench->services->memory;
    chooser c = {.q = q, .bench = q->bench, .memory = memory, .r = r, .out = out, .start_s = now_s()};
    *out = (chains_result){.candidate_count = q->bench->strategy_count, .zone_count = q->bench->scene->zone_count, .memory = memory};
    out->candidates = memory_alloc_zeroed(memory, out->candidate_count, sizeof *out->candidates);
    out->group_of_zone = memory_alloc_zeroed(memory, out->zone_count, sizeof *out->group_of_zone);
    out->shares = memory_alloc_zeroed(memory, CHOOSE_GROUPS_MOST, sizeof *out->shares);
    out->picks = memory_alloc_zeroed(memory, CHOOSE_GROUPS_MOST, sizeof *out->picks);
    c.usable = memory_alloc_zeroed(memory, out->candidate_count, sizeof *c.usable);
    const int opened = out->candidates && out->group_of_zone && out->shares && out->picks && c.usable;
    result done = opened ? sift(&c) : report_no_memory(r, NULL);
    if (done == RESULT_OK) done = find_groups(&c);
    if (done == RESULT_OK) done = choose(&c);
    memory_free(memory, c.usable, out->candidate_count, sizeof *c.usable);
    if (done != RESULT_OK) chains_result_free(out);
    return done;
}

void chains_result_free(chains_result *c)
{
    memory_free(c->memory, c->candidates, c->candidate_count, sizeof *c->candidates);
    memory_free(c->memory, c->group_of_zone, c->zone_count, sizeof *c->group_of_zone);
    memory_free(c->memory, c->shares, CHOOSE_GROUPS_MOST, sizeof *c->shares);
    memory_free(c->memory, c->picks, CHOOSE_GROUPS_MOST, sizeof *c->picks);
    *c = (chains_result){0};
}

uint32_t chains_of_zone(const chains_result *c, uint32_t zone)
{
    return c->picks[c->group_of_zone[zone]].candidate;
}
