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
    return !culler || strcmp(culler, "scene") == 0;
}

static result check_chain(app *a, const char *text)
{
    chain_spec spec;
    const cull_plugin *plugin;
    result done = chain_parse(text, &a->texts, &a->report, &spec);
    for (uint32_t i = 0; done == RESULT_OK && i < spec.stage_count; ++i) done = loader_find(a->plugins, spec.stages[i].id, &a->report, &plugin);
    return done;
}

// With --zone there may be no zone left for a culler, and then its library is not opened.
result chains_check(app *a, const char *const *cullers, uint32_t culler_count, const zone_options *zones)
{
    result done = RESULT_OK;
    for (uint32_t i = 0; i < culler_count && done == RESULT_OK && !zones->count; ++i)
        if (!is_of_scene(cullers[i])) done = check_chain(a, cullers[i]);
    for (uint32_t i = 0; i < zones->count && done == RESULT_OK; ++i) {
        const char *equals = strchr(zones->texts[i], '=');
        if (equals) done = check_chain(a, equals + 1);
    }
    return done;
}

// ---- --zone ----

static void name_zones(const scene *s, char *out, size_t size)
{
    size_t used = 0;
    *out = 0;
    for (uint32_t z = 0; z < s->zone_count && z < NAMES_TOLD && used < size; ++z)
        used += (size_t)snprintf(out + used, size - used, "%s%s", z ? ", " : "", s->zones[z].name);
    if (s->zone_count > NAMES_TOLD && used < size) snprintf(out + used, size - used, " and %u more", s->zone_count - NAMES_TOLD);
}

static result no_such_form(app *a, const char *text)
{
    char names[1024];
    name_zones(a->scene, names, sizeof names);
    return report_error(&a->report, NULL, 0, "--zone '%s': write NAME=CHAIN; the zones of this scene are: %s", text, names);
}

static result unknown_zone(app *a, const char *text, const char *pattern)
{
    char names[1024];
    name_zones(a->scene, names, sizeof names);
    return report_error(&a->report, NULL, 0, "--zone '%s': there is no zone '%s'; the zones of this scene are: %s", text, pattern, names);
}

typedef enum zone_match { MATCH_NONE, MATCH_PATTERN, MATCH_EXACT } zone_match;

static zone_match match_of(const char *pattern, const char *name)
{
    if (strcmp(pattern, name) == 0) return MATCH_EXACT;
    return fnmatch(pattern, name, 0) == 0 ? MATCH_PATTERN : MATCH_NONE;
}

static result take_option(chain_book *b, const char *text, uint8_t *is_exact)
{
    app *a = b->app;
    uint32_t matches = 0;
    const char *equals = strchr(text, '=');
    const char *pattern = equals ? arena_text(&a->texts, text, (size_t)(equals - text)) : NULL;
    if (!equals || equals == text || !equals[1]) return no_such_form(a, text);
    if (!pattern) return report_no_memory(&a->report, NULL);
    for (uint32_t z = 0; z < a->scene->zone_count; ++z) {
        const zone_match how = match_of(pattern, a->scene->zones[z].name);
        matches += how != MATCH_NONE;
        if (how == MATCH_EXACT && is_exact[z])
            return report_error(&a->report, NULL, 0, "--zone '%s': that zone has a chain already; name it once", text);
        if (how == MATCH_NONE || (how == MATCH_PATTERN && is_exact[z])) continue;
        b->of_options[z] = equals + 1;
        is_exact[z] = how == MATCH_EXACT;
    }
    return matches ? RESULT_OK : unknown_zone(a, text, pattern);
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
    const uint32_t zone_count = a->scene->zone_count;
    *out = (chain_book){.app = a, .specs = buffer_make(a->memory, sizeof(const chain_spec *))};
    out->of_options = arena_push(&a->texts, zone_count, sizeof *out->of_options);
    uint8_t *is_exact = memory_alloc_zeroed(a->memory, zone_count, 1);
    result done = out->of_options && is_exact ? make_suffix(out, zones) : report_no_memory(&a->report, NULL);
    for (uint32_t z = 0; z < zone_count && done == RESULT_OK; ++z) out->of_options[z] = NULL;
    for (uint32_t i = 0; i < zones->count && done == RESULT_OK; ++i) done = take_option(out, zones->texts[i], is_exact);
    memory_free(a->memory, is_exact, zone_count, 1);
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

static result find_set(chain_book *b, const char *culler, const chain_spec **set)
{
    const scene *s = b->app->scene;
    result done = RESULT_OK;
    for (uint32_t z = 0; z < s->zone_count && done == RESULT_OK; ++z) {
        const char *text = b->of_options[z];
        if (!text) text = !is_of_scene(culler) ? culler : s->zones[z].chain ? s->zones[z].chain : "frustum";
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
    const result done = find_set(b, culler, set);
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
