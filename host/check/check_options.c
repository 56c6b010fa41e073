// Checks of what stands in the library before anything is built: entry, descriptor, options.
// SPDX-License-Identifier: MIT
#include "checks.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int is_word(const char *text, const char *letters, size_t most)
{
    const size_t length = text ? strlen(text) : 0;
    return length > 0 && length <= most && strspn(text, letters) == length;
}

static const char *option_fault(const cull_descriptor *d, uint32_t i)
{
    const cull_option *o = &d->options[i];
    if (!o->key || !o->fallback || !o->help) return "an option has no key, fallback or help";
    if (!is_word(o->key, "abcdefghijklmnopqrstuvwxyz0123456789_-", 63)) return "an option's key is not of a-z, 0-9, _ and -";
    for (uint32_t k = 0; k < i; ++k)
        if (strcmp(d->options[k].key, o->key) == 0) return "an option stands twice in its table";
    return NULL;
}

// A host may ask a library as a whole before any culler of it is made: what belongs to a culler isn't there.
static check_verdict asks_whole(check_run *r)
{
    static const char *const ids[] = {"check.nothing/1", CULL_EXT_HIERARCHY, CULL_EXT_BAKE, CULL_EXT_EXPLAIN, CULL_EXT_RAY,
                                      CULL_EXT_FIGURES, CULL_EXT_PIECES, CULL_EXT_SIGHT};
    for (size_t i = 0; i < sizeof ids / sizeof *ids; ++i) {
        run_at(r, "get_extension of the plugin as a whole (culler NULL), %s", ids[i]);
        if (r->plugin->get_extension(NULL, ids[i])) return run_fail(r, "it gives an extension of a culler where there is none");
    }
    return CHECK_PASS;
}

check_verdict check_entry(check_run *r)
{
    const cull_plugin *p = r->plugin;
    const cull_descriptor *d = p->descriptor;
    const cull_promises known = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS | CULL_ORDERED;
    run_at(r, "its descriptor");
    if (!is_word(d->id, "abcdefghijklmnopqrstuvwxyz0123456789-", 63)) return run_fail(r, "its id is empty, too long, or not of a-z, 0-9 and -");
    if (!d->version || !*d->version || !d->summary || !*d->summary) return run_fail(r, "it has no version or summary");
    if (strpbrk(d->summary, "\n\r")) return run_fail(r, "its summary is of more than one line");
    if (d->option_count > STAND_OPTIONS_MOST || (d->option_count && !d->options)) return run_fail(r, "its option table is missing or too long");
    for (uint32_t i = 0; i < d->option_count; ++i)
        if (option_fault(d, i)) return run_fail(r, "%s (option %u)", option_fault(d, i), (unsigned)i);
    if (d->may_promise & ~known) return run_fail(r, "it may promise what no contract knows (bits %x)", (unsigned)(d->may_promise & ~known));
    if (!p->create || !p->destroy || !p->build || !p->open || !p->close || !p->get_extension)
        return run_fail(r, "one of create, destroy, build, open, close, get_extension is NULL");
    if (!p->select && !p->filter && !p->cross) return run_fail(r, "it has no verb: select, filter and cross are all NULL");
    return asks_whole(r);
}

static cull_result try_value(check_run *r, uint32_t option, const char *value, uint32_t *lines)
{
    stand_values values;
    lender l;
    cull_culler *made = NULL;
    stand_defaults(r->plugin, &values);
    if (value) values.values[option] = value;
    if (value) run_at(r, "create with %s='%.60s'", r->plugin->descriptor->options[option].key, value);
    lender_open(&l);
    const cull_result result = r->plugin->create(&l.host, values.values, &made);
    if (result == CULL_OK && made) r->plugin->destroy(made);
    *lines = l.lines;
    lender_close(&l);
    return result;
}

static int is_number(const char *text)
{
    char *end;
    (void)strtod(text, &end);
    return end != text && *end == 0;
}

static check_verdict refuses(check_run *r, uint32_t option, const char *value)
{
    uint32_t lines;
    const cull_result result = try_value(r, option, value, &lines);
    if (result == CULL_OK) return run_fail(r, "it takes nonsense for the option; refuse it with CULL_ERR_OPTION and a log line");
    if (result != CULL_ERR_OPTION) return run_fail(r, "it refuses an option with result %d, not CULL_ERR_OPTION", (int)result);
    return lines ? CHECK_PASS : run_fail(r, "it refuses an option without a log line that says why");
}

check_verdict check_options(check_run *r)
{
    const cull_descriptor *d = r->plugin->descriptor;
    static const char *const words[] = {"no-such-value", "", " ", "%n%s", "\x01\xff"};
    static const char *const numbers[] = {"nan", "inf", "1e400", "99999999999999999999999999", "1x", "-1e30"};
    uint32_t lines;
    run_at(r, "create with defaults");
    if (try_value(r, 0, NULL, &lines) != CULL_OK) return run_fail(r, "it refuses its own defaults");
    for (uint32_t i = 0; i < d->option_count; ++i) {
        check_verdict verdict = CHECK_PASS;
        const int has_numbers = is_number(d->options[i].fallback);
        for (size_t k = 0; k < sizeof words / sizeof *words && verdict == CHECK_PASS; ++k) verdict = refuses(r, i, words[k]);
        for (size_t k = 0; has_numbers && k < sizeof numbers / sizeof *numbers && verdict == CHECK_PASS; ++k) verdict = refuses(r, i, numbers[k]);
        if (verdict != CHECK_PASS) return verdict;
    }
    stand_values values;
    char name[128], text[512];
    for (uint32_t v = 1; variant_make(r->plugin, v, &values, name, sizeof name, text, sizeof text); ++v) {
        lender l;
        cull_culler *made = NULL;
        run_at(r, "create with %s, which its own sweep lists", name);
        lender_open(&l);
        const cull_result result = r->plugin->create(&l.host, values.values, &made);
        if (result != CULL_OK || !made) return run_fail(r, "it refuses a value that it wants measured");
        r->plugin->destroy(made);
        lender_close(&l);
    }
    return CHECK_PASS;
}
