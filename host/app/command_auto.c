// portcullis auto: measures chains over a path and gives each zone the cheapest exact one, the simpler where there is no difference.
// SPDX-License-Identifier: MIT
#include "../../bench/choose_chains.h"
#include "auto_write.h"
#include "chains.h"

#include <argp.h>
#include <stdio.h>
#include <string.h>

enum { KEY_VIEWS = 256, KEY_CANDIDATE, KEY_BUDGET, KEY_ZONES, KEY_REPEAT, KEY_SIZE, KEY_DOORS, KEY_PLUGIN };
enum { CANDIDATES_MOST = 32, BUDGET_MOST_S = 1000000 };

typedef struct arguments {
    const char *scene, *views, *out;
    const char *candidates[CANDIDATES_MOST];
    uint32_t candidate_count, budget_s, zones_most, repeat;
    app_size size;
    doors_choice doors;
    app_plugin_files plugins;
} arguments;

static const struct argp_option options[] = {
    {"views", KEY_VIEWS, APP_VIEWS, 0, "the camera path; needed", 0},
    {"output", 'o', "OUT.json|OUT.pcs", 0, "the scene with a chain at each zone (default: only told)", 0},
    {"candidate", KEY_CANDIDATE, "CHAIN", 0, "one to try instead of the usual ones; may stand several times", 0},
    {"budget", KEY_BUDGET, "SECONDS", 0, "no zone is looked at alone after that time (default 120); all zones alike are always measured", 0},
    {"zones", KEY_ZONES, "N", 0, "the N zones that draw most are looked at alone, all others together (default 8, at most 31)", 0},
    {"repeat", KEY_REPEAT, "N", 0, "passes over the path in each run (default 3)", 0},
    {"size", KEY_SIZE, "WxH", 0, "of the picture (default 1280x720)", 0},
    {"doors", KEY_DOORS, "open|shut|scene", 0, "how doors stand (default open; scene: as its file says)", 0},
    {"plugin", KEY_PLUGIN, "FILE", 0, "look at this library first; may stand several times", 0},
    {0},
};

static void parse_numbers(int key, const char *text, struct argp_state *state)
{
    arguments *a = state->input;
    if (key == KEY_BUDGET && !parse_count(text, 0, BUDGET_MOST_S, &a->budget_s)) argp_error(state, "--budget takes 0 to 1000000 seconds, not '%s'", text);
    if (key == KEY_ZONES && !parse_count(text, 1, CHOOSE_GROUPS_MOST - 1, &a->zones_most)) argp_error(state, "--zones takes 1 to 31, not '%s'", text);
    if (key == KEY_REPEAT && !parse_count(text, 1, 10000, &a->repeat)) argp_error(state, "--repeat takes 1 to 10000, not '%s'", text);
    if (key == KEY_SIZE && !parse_size(text, &a->size)) argp_error(state, "--size takes WxH of 1 to 8192, not '%s'", text);
    if (key == KEY_DOORS && !app_doors_parse(text, &a->doors)) argp_error(state, "--doors takes open, shut or scene, not '%s'", text);
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case KEY_VIEWS: a->views = text; break;
    case 'o': a->out = text; break;
    case KEY_CANDIDATE:
        if (a->candidate_count == CANDIDATES_MOST) argp_error(state, "too many of one option");
        a->candidates[a->candidate_count++] = text;
        break;
    case KEY_PLUGIN:
        if (a->plugins.count == APP_PLUGINS_MOST) argp_error(state, "too many of one option");
        a->plugins.files[a->plugins.count++] = text;
        break;
    case KEY_BUDGET:
    case KEY_ZONES:
    case KEY_REPEAT:
    case KEY_SIZE:
    case KEY_DOORS: parse_numbers(key, text, state); break;
    case ARGP_KEY_ARG:
        if (a->scene) argp_error(state, "one SCENE, not also '%s'", text);
        a->scene = text;
        break;
    case ARGP_KEY_END:
        if (!a->scene || !a->views) argp_error(state, "SCENE and --views are needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

// ---- Candidates ----

static int is_there(app *a, const char *text)
{
    report quiet = {0};
    chain_spec spec;
    const cull_plugin *plugin;
    int found = chain_parse(text, &a->texts, &quiet, &spec) == RESULT_OK;
    for (uint32_t i = 0; found && i < spec.stage_count; ++i) found = loader_find(a->plugins, spec.stages[i].id, &quiet, &plugin) == RESULT_OK;
    return found;
}

// Of those whose plugins are there. Portals only where the scene has some; nothing that drops backs, which a picture may show.
static void take_usual(app *a, arguments *q)
{
    static const char *const plain[] = {"none", "frustum", "octree", "bsp", "frustum+occlusion", "octree+occlusion",
                                        "octree+occlusion[method=chc]", "octree+occlusion[method=hiz]"};
    static const char *const portals[] = {"frustum+portal", "octree+portal", "bsp+portal", "bsp[cells=exact]+portal", "octree+portal+occlusion",
                                          "octree+portal+occlusion[method=hiz]", "bsp+portal+occlusion"};
    for (size_t i = 0; i < sizeof plain / sizeof *plain; ++i)
        if (is_there(a, plain[i])) q->candidates[q->candidate_count++] = plain[i];
    for (size_t i = 0; i < sizeof portals / sizeof *portals && a->scene->portal_count; ++i)
        if (is_there(a, portals[i])) q->candidates[q->candidate_count++] = portals[i];
}

// ---- What is told ----

static void print_candidates(const arguments *q, const chains_result *c)
{
    printf("%-40s %10s\n", "all zones alike", "ms a view");
    for (uint32_t i = 0; i < c->candidate_count; ++i) {
        const chains_candidate *one = &c->candidates[i];
        if (one->rejected) printf("%-40s %10s  not tried: %s\n", q->candidates[i], "-", one->rejected);
        else if (one->missed_items) printf("%-40s %10.3f  not taken: %s, %llu pixels of %llu items\n", q->candidates[i], one->ms, one->inexact,
                                           (unsigned long long)one->missed_pixels, (unsigned long long)one->missed_items);
        else if (one->inexact) printf("%-40s %10.3f  not taken: %s\n", q->candidates[i], one->ms, one->inexact);
        else printf("%-40s %10.3f  exact%s\n", q->candidates[i], one->ms, i == c->uniform.candidate ? ", the choice for all" : "");
    }
}

static void print_why(const arguments *q, const choose_pick *p)
{
    const char *next = p->next == UINT32_MAX ? "" : q->candidates[p->next];
    switch (p->reason) {
    case CHOOSE_FASTEST: printf("%.0f%% less than %s, %.3f ms\n", 100 * (1 - p->ms / p->next_ms), next, p->next_ms); break;
    case CHOOSE_SIMPLER: printf("%s, %.3f ms, is within %.0f%% and no simpler\n", next, p->next_ms, 100 * p->margin); break;
    case CHOOSE_ONLY: printf("no other is exact\n"); break;
    case CHOOSE_UNTRIED: printf("as all: not looked at alone\n"); break;
    }
}

static uint32_t zones_of(const chains_result *c, uint32_t group, uint32_t *out_first)
{
    uint32_t count = 0;
    for (uint32_t z = 0; z < c->zone_count; ++z)
        if (c->group_of_zone[z] == group && count++ == 0) *out_first = z;
    return count;
}

static void print_zones(const app *a, const arguments *q, const chains_result *c)
{
    char name[64];
    printf("\n%-28s %6s  %-36s %10s  %s\n", "zone", "share", "chain", "ms a view", "why");
    for (uint32_t g = 0; g < c->group_count; ++g) {
        uint32_t first = 0;
        const uint32_t count = zones_of(c, g, &first);
        if (count == 1) snprintf(name, sizeof name, "%s", a->scene->zones[first].name);
        else snprintf(name, sizeof name, "(%u other zones)", count);
        printf("%-28s %5.1f%%  %-36s %10.3f  ", name, 100 * c->shares[g], q->candidates[c->picks[g].candidate], c->picks[g].ms);
        print_why(q, &c->picks[g]);
    }
    if (c->is_uniform) {
        printf("\none chain for all zones: %s, %.3f ms a view: ", q->candidates[c->uniform.candidate], c->chosen_ms);
        print_why(q, &c->uniform);
    }
    else printf("\nin one run: %.3f ms a view, %s for all zones %.3f ms\n", c->chosen_ms, q->candidates[c->uniform.candidate], c->uniform_ms);
}

// ---- The choice ----

static result take_chains(app *a, const arguments *q, const chains_result *c)
{
    for (uint32_t z = 0; z < a->scene->zone_count; ++z) a->scene->zones[z].chain = q->candidates[chains_of_zone(c, z)];
    return q->out ? auto_write(a, q->scene, q->out) : RESULT_OK;
}

static result choose(app *a, arguments *q, const camera_path *path)
{
    bench_strategy_request candidates[CANDIDATES_MOST];
    chain_book book = {0};
    chains_result chosen;
    const zone_options none = {.count = 0};
    result done = chains_check(a, q->candidates, q->candidate_count, &none);
    if (done == RESULT_OK && !q->candidate_count) take_usual(a, q);
    if (done == RESULT_OK) done = chain_book_open(a, &none, &book);
    for (uint32_t i = 0; i < q->candidate_count && done == RESULT_OK; ++i) done = chain_book_strategy(&book, q->candidates[i], &candidates[i]);
    chain_book_close(&book);
    if (done != RESULT_OK) return done;
    const bench_request bench = {.scene = a->scene, .path = path, .strategies = candidates, .strategy_count = q->candidate_count,
                                 .doors = app_doors_of(&q->doors), .plugins = a->plugins, .services = &a->services, .repeat = q->repeat,
                                 .width_px = q->size.width_px, .height_px = q->size.height_px, .truth = BENCH_TRUTH};
    done = chains_choose(&(chains_request){&bench, q->budget_s, q->zones_most}, &a->report, &chosen);
    if (done != RESULT_OK) return done;
    print_candidates(q, &chosen);
    print_zones(a, q, &chosen);
    done = take_chains(a, q, &chosen);
    if (done == RESULT_OK && q->out) printf("written: %s; `portcullis bench %s --views %s` measures it\n", q->out, q->out, q->views);
    chains_result_free(&chosen);
    return done;
}

int command_auto(int argc, char **argv)
{
    static const struct argp parser = {options, parse, "SCENE",
                                       "Measures chains of cullers over a path and gives each zone the cheapest one that misses nothing; where there is no "
                                       "difference the simpler one. Tells why.",
                                       NULL, NULL, NULL};
    arguments q = {.size = {1280, 720}, .budget_s = 120, .zones_most = 8, .repeat = 3};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    app a;
    camera_path path = {0};
    const import_options import = {.doors = app_doors_import(q.doors)};
    result done = app_open(&a, &q.plugins);
    if (done == RESULT_OK) done = import_scene(q.scene, &import, a.memory, &a.report, &a.scene);
    if (done == RESULT_OK && q.out) done = auto_can_write(&a, q.scene, q.out);
    if (done == RESULT_OK) done = camera_path_load(q.views, a.scene, (double)q.size.width_px / q.size.height_px, a.memory, &a.report, &path);
    if (done == RESULT_OK) done = choose(&a, &q, &path);
    camera_path_free(&path, a.memory);
    app_close(&a);
    return app_exit_code(done);
}
