// Chains of zones: see chains.h.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "chains.h"

#include <fnmatch.h>
#include <stdio.h>
#include <string.h>

enum { NAMES_TOLD = 12, TEXT_BYTES = 8192 };

static int is_of_scene(const char *culler)
{
    return strcmp(culler, "scene") == 0;
}

// ---- A culler that names zones: NAME=CHAIN;NAME=CHAIN;CHAIN ----

// The next ';' that stands in no option, or the end.
static const char *part_end(const char *text)
{
    int depth = 0;
    for (; *text && !(*text == ';' && depth == 0); ++text) depth += *text == '[' ? 1 : *text == ']' && depth ? -1 : 0;
    return text;
}

// The chain of all zones that the culler does not name.
static const char *chain_of_others(const char *culler)
{
    for (const char *end = part_end(culler); *end; end = part_end(culler)) culler = end + 1;
    return culler;
}

static result check_chain(app *a, const char *text)
{
    chain_spec spec;
    const cull_plugin *plugin;
    result done = chain_parse(text, &a->texts, &a->report, &spec);
    for (uint32_t i = 0; done == RESULT_OK && i < spec.stage_count; ++i) done = loader_find(a->plugins, spec.stages[i].id, &a->report, &plugin);
    return done;
}

static result no_chain_of_others(app *a, const char *culler)
{
    return report_error(&a->report, NULL, 0, "--culler '%s': write NAME=CHAIN;CHAIN, last the chain of all other zones, without a name", culler);
}

static int is_named(const char *part)
{
    return part[strcspn(part, "=[+")] == '=';
}

static result check_culler(app *a, const char *culler)
{
    result done = RESULT_OK;
    const char *last = chain_of_others(culler), *part = culler;
    if (is_named(last) || (*last == 0 && last > culler)) return no_chain_of_others(a, culler);
    for (const char *end; done == RESULT_OK && part < last; part = end + 1) {
        end = part_end(part);
        const char *copy = arena_text(&a->texts, part, (size_t)(end - part));
        if (!copy) return report_no_memory(&a->report, NULL);
        const char *equals = strchr(copy, '=');
        if (!equals || equals == copy || !equals[1]) return no_chain_of_others(a, culler);
        done = is_of_scene(equals + 1) ? RESULT_OK : check_chain(a, equals + 1);
    }
    return done != RESULT_OK || is_of_scene(last) ? done : check_chain(a, last);
}

// With --zone there may be no zone left for a culler, and then its library is not opened.
result chains_check(app *a, const char *const *cullers, uint32_t culler_count, const zone_options *zones)
{
    result done = RESULT_OK;
    for (uint32_t i = 0; i < culler_count && done == RESULT_OK && !zones->count; ++i)
        if (cullers[i] && !is_of_scene(cullers[i])) done = check_culler(a, cullers[i]);
    for (uint32_t i = 0; i < zones->count && done == RESULT_OK; ++i) {
        const char *equals = strchr(zones->texts[i], '=');
        if (equals && !is_of_scene(equals + 1)) done = check_chain(a, equals + 1);
    }
    return done;
}

// ---- Zones by name ----

typedef struct naming {
    const char *option;  // that says so
    const char **chains; // by zone, or NULL
    uint8_t *is_exact;   // by zone: it was named, and not by a pattern
} naming;

static result naming_open(app *a, const char *option, naming *out)
{
    const uint32_t zone_count = a->scene->zone_count;
    *out = (naming){option, arena_push(&a->texts, zone_count, sizeof *out->chains), arena_push(&a->texts, zone_count, 1)};
    if (!out->chains || !out->is_exact) return report_no_memory(&a->report, NULL);
    for (uint32_t z = 0; z < zone_count; ++z) {
        out->chains[z] = NULL;
        out->is_exact[z] = 0;
    }
    return RESULT_OK;
}

static void name_zones(const scene *s, char *out, size_t size)
{
    size_t used = 0;
    *out = 0;
    for (uint32_t z = 0; z < s->zone_count && z < NAMES_TOLD && used < size; ++z)
        used += (size_t)snprintf(out + used, size - used, "%s%s", z ? ", " : "", s->zones[z].name);
    if (s->zone_count > NAMES_TOLD && used < size) snprintf(out + used, size - used, " and %u more", s->zone_count - NAMES_TOLD);
}

static result no_such_form(app *a, const naming *n, const char *text)
{
    char names[1024];
    name_zones(a->scene, names, sizeof names);
    return report_error(&a->report, NULL, 0, "%s '%s': write NAME=CHAIN; the zones of this scene are: %s", n->option, text, names);
}

static result unknown_zone(app *a, const naming *n, const char *text, const char *pattern)
{
    char names[1024];
    name_zones(a->scene, names, sizeof names);
    return report_error(&a->report, NULL, 0, "%s '%s': there is no zone '%s'; the zones of this scene are: %s", n->option, text, pattern, names);
}

typedef enum zone_match { MATCH_NONE, MATCH_PATTERN, MATCH_EXACT } zone_match;

static zone_match match_of(const char *pattern, const char *name)
{
    if (strcmp(pattern, name) == 0) return MATCH_EXACT;
    return fnmatch(pattern, name, 0) == 0 ? MATCH_PATTERN : MATCH_NONE;
}

static result take_name(app *a, const naming *n, const char *text)
{
    uint32_t matches = 0;
    const char *equals = strchr(text, '=');
    const char *pattern = equals ? arena_text(&a->texts, text, (size_t)(equals - text)) : NULL;
    if (!equals || equals == text || !equals[1]) return no_such_form(a, n, text);
    if (!pattern) return report_no_memory(&a->report, NULL);
    for (uint32_t z = 0; z < a->scene->zone_count; ++z) {
        const zone_match how = match_of(pattern, a->scene->zones[z].name);
        matches += how != MATCH_NONE;
        if (how == MATCH_EXACT && n->is_exact[z])
            return report_error(&a->report, NULL, 0, "%s '%s': that zone has a chain already; name it once", n->option, text);
        if (how == MATCH_NONE || (how == MATCH_PATTERN && n->is_exact[z])) continue;
        n->chains[z] = equals + 1;
        n->is_exact[z] = how == MATCH_EXACT;
    }
    return matches ? RESULT_OK : unknown_zone(a, n, text, pattern);
}

static result make_suffix(chain_book *b, const zone_options *zones)
{
    char suffix[TEXT_BYTES / 2] = "";
    size_t used = 0;
    for (uint32_t i = 0; i < zones->count; ++i) {
        used += (size_t)snprintf(suffix + used, sizeof suffix - used, ",%s", zones->texts[i]);
        if (used >= sizeof suffix) return report_error(&b->app->report, NULL, 0, "--zone: too long");
    }
    b->suffix = arena_text(&b->app->texts, suffix, used);
    return b->suffix ? RESULT_OK : report_no_memory(&b->app->report, NULL);
}

result chain_book_open(app *a, const zone_options *zones, chain_book *out)
{
    naming n;
    *out = (chain_book){.app = a, .specs = buffer_make(a->memory, sizeof(const chain_spec *))};
    result done = naming_open(a, "--zone", &n);
    if (done == RESULT_OK) done = make_suffix(out, zones);
    for (uint32_t i = 0; i < zones->count && done == RESULT_OK; ++i) done = take_name(a, &n, zones->texts[i]);
    out->of_options = n.chains;
    if (done != RESULT_OK) chain_book_close(out);
    return done;
}

void chain_book_close(chain_book *b)
{
    if (b->app) buffer_free(&b->specs);
    *b = (chain_book){0};
}

// ---- Strategies ----

static result find_spec(chain_book *b, const char *text, const chain_spec **out)
{
    app *a = b->app;
    const chain_spec *const *known = b->specs.items;
    for (size_t i = 0; i < b->specs.count; ++i)
        if (strcmp(known[i]->text, text) == 0) {
            *out = known[i];
            return RESULT_OK;
        }
    chain_spec *spec = arena_push(&a->texts, 1, sizeof *spec);
    if (!spec) return report_no_memory(&a->report, NULL);
    const result done = chain_parse(text, &a->texts, &a->report, spec);
    if (done != RESULT_OK) return done;
    *out = spec;
    return buffer_append(&b->specs, out, 1) ? RESULT_OK : report_no_memory(&a->report, NULL);
}

static result take_culler(app *a, const char *culler, naming *out)
{
    result done = naming_open(a, "--culler", out);
    const char *last = chain_of_others(culler), *part = culler;
    for (const char *end; done == RESULT_OK && part < last; part = end + 1) {
        end = part_end(part);
        const char *text = arena_text(&a->texts, part, (size_t)(end - part));
        done = text ? take_name(a, out, text) : report_no_memory(&a->report, NULL);
    }
    return done;
}

static result find_set(chain_book *b, const char *culler, const chain_spec **set)
{
    const scene *s = b->app->scene;
    const char *others = chain_of_others(culler);
    naming n;
    result done = take_culler(b->app, culler, &n);
    for (uint32_t z = 0; z < s->zone_count && done == RESULT_OK; ++z) {
        const char *text = b->of_options[z] ? b->of_options[z] : n.chains[z] ? n.chains[z] : others;
        if (is_of_scene(text)) text = s->zones[z].chain ? s->zones[z].chain : "frustum";
        done = find_spec(b, text, &set[z]);
    }
    return done;
}

static const char *name_of(chain_book *b, const char *culler)
{
    char full[TEXT_BYTES];
    const int length = snprintf(full, sizeof full, "%s%s", culler, b->suffix);
    return arena_text(&b->app->texts, full, length > 0 && (size_t)length < sizeof full ? (size_t)length : strlen(full));
}

result chain_book_strategy(chain_book *b, const char *culler, bench_strategy_request *out)
{
    app *a = b->app;
    const chain_spec **set = arena_push(&a->texts, a->scene->zone_count, sizeof *set);
    const chain_spec *const **sets = arena_push(&a->texts, 1, sizeof *sets);
    *out = (bench_strategy_request){.name = name_of(b, culler ? culler : "scene"), .sets = sets, .set_count = 1};
    if (!set || !sets || !out->name) return report_no_memory(&a->report, NULL);
    *sets = set;
    const result done = find_set(b, culler ? culler : "scene", set);
    if (done == RESULT_OK) out->chain = set[0];
    return done;
}

result chain_book_swap(chain_book *b, const bench_strategy_request *strategies, uint32_t count, uint32_t views, bench_strategy_request *out)
{
    char name[32];
    const chain_spec *const **sets = arena_push(&b->app->texts, count, sizeof *sets);
    snprintf(name, sizeof name, "swap/%u", views);
    *out = (bench_strategy_request){.name = name_of(b, name), .chain = strategies[0].chain, .sets = sets, .set_count = count, .swap_views = views};
    if (!sets || !out->name) return report_no_memory(&b->app->report, NULL);
    for (uint32_t i = 0; i < count; ++i) sets[i] = strategies[i].sets[0];
    return RESULT_OK;
}
