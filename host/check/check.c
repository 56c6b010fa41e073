// The table of checks, and who runs them one after the other: see check.h.
// SPDX-License-Identifier: MIT
#include "checks.h"
#include "process.h"

#include <portcullis/culler.h>

#include <stdio.h>
#include <string.h>

typedef struct check_entry_of {
    const char *name, *proves;
    check_function *run;
    uint32_t cpu_s;
} check_entry_of;

enum { WALL_S_A_CPU_S = 6, BASES = 2 }; // a busy machine gives a process a sixth of a core at the least

// The first BASES carry the others.
static const check_entry_of table[] = {
    {"entry", "ABI number, descriptor and slots are what a host accepts", check_entry, 5},
    {"life", "it builds, opens, steps and closes on plain scenes, and ends", check_life, 10},
    {"options", "its own defaults and sweeps are taken, nonsense is refused with a line", check_options, 10},
    {"batch", "what a step writes is sound: places, counts, repeats, steps", check_batch, 20},
    {"bounds", "nothing is read or written behind a list", check_bounds, 20},
    {"conservative", "what a ray shows is drawn, from a query without history", check_conservative, 60},
    {"sampled", "what owns the middle of a pixel is drawn", check_sampled, 60},
    {"history", "so it is after other views, other frames, cuts", check_history, 60},
    {"storm", "so it is when answers fail, pictures vanish, queries come and go", check_storm, 60},
    {"movers", "movers that are seen are kept, where it decides about them", check_movers, 40},
    {"stateless", "one view, one answer, whatever came before", check_stateless, 40},
    {"ordered", "runs come front to back", check_ordered, 20},
    {"instances", "two cullers do not know of one another", check_instances, 20},
    {"parallel", "queries of one culler run side by side", check_parallel, 40},
    {"constant", "a step writes to its query alone", check_constant, 20},
    {"zone", "the zone stays as it was lent", check_zone, 20},
    {"quiet", "a step allocates nothing, does no input or output, does not sleep", check_quiet, 20},
    {"memory", "each allocation may fail: nothing is left, nothing breaks", check_memory, 60},
    {"leaks", "all memory comes back", check_leaks, 30},
    {"nonsense", "views of no sense do no harm", check_nonsense, 30},
    {"bake", "a baked index answers as the built one; a damaged one is refused", check_bake, 60},
    {"hierarchy", "the tree that it lends holds together", check_hierarchy, 20},
    {"ray", "segments and boxes find what they touch", check_ray, 20},
    {"explain", "it explains every item within the room that it gets", check_explain, 20},
    {"cross", "what is seen through a portal goes on behind it", check_cross, 30},
};
enum { TABLE_COUNT = sizeof table / sizeof *table };

int check_is_known(const char *name)
{
    for (int i = 0; i < TABLE_COUNT; ++i)
        if (strcmp(table[i].name, name) == 0) return 1;
    return 0;
}

void check_each_name(void (*tell)(void *user, const char *name, const char *proves), void *user)
{
    for (int i = 0; i < TABLE_COUNT; ++i) tell(user, table[i].name, table[i].proves);
}

// Of the name and the seed: a check alone finds what it finds among all.
static uint64_t seed_of(const char *name, uint64_t seed)
{
    uint64_t hash = seed * 0x9e3779b97f4a7c15u + 0xcbf29ce484222325u;
    for (; *name; ++name) hash = (hash ^ (unsigned char)*name) * 0x100000001b3u;
    return hash;
}

static void run_one(const check_request *q, const check_entry_of *entry, process_result *out)
{
    process_request p = {.task = entry->run, .id = q->id, .cpu_s = entry->cpu_s, .wall_s = entry->cpu_s * WALL_S_A_CPU_S};
    p.run.file = q->file;
    p.run.plugin = q->plugin;
    p.run.seed = q->seed;
    p.run.random = seed_of(entry->name, q->seed);
    process_run(&p, out);
}

check_count check_culler(const check_request *q)
{
    check_count count = {0, 0, 0};
    const char *broken = NULL; // the base that failed
    for (int i = 0; i < TABLE_COUNT; ++i) {
        const int is_asked = !q->only || strcmp(q->only, table[i].name) == 0;
        if (!is_asked && i >= BASES) continue;
        process_result got = {.verdict = CHECK_SKIP};
        if (broken) snprintf(got.message, sizeof got.message, "not tried: it rests on '%s', which fails", broken);
        else run_one(q, &table[i], &got);
        if (i < BASES && got.verdict == CHECK_FAIL) broken = table[i].name;
        count.passed += got.verdict == CHECK_PASS && is_asked;
        count.failed += got.verdict == CHECK_FAIL;
        count.skipped += got.verdict == CHECK_SKIP && is_asked;
        if (!is_asked && got.verdict != CHECK_FAIL) continue;
        const check_line line = {table[i].name, table[i].proves, got.verdict, got.message, got.seconds};
        q->tell(q->user, &line);
    }
    return count;
}

// ---- Which cullers a library has ----

static check_verdict list_ids(check_run *r)
{
    char ids[RUN_TEXT_BYTES] = "";
    run_ids(r, ids, sizeof ids);
    return run_skip(r, "%s", ids); // a text that comes through is all that is wanted
}

int check_ids(const char *file, char *ids, size_t size)
{
    process_result got;
    process_request p = {.task = list_ids, .cpu_s = 5, .wall_s = 30};
    p.run.file = file;
    process_run(&p, &got);
    if (got.verdict != CHECK_SKIP || !*got.message) return 0;
    snprintf(ids, size, "%s", got.message);
    return 1;
}
