// portcullis check: is this culler what the contract says?
// SPDX-License-Identifier: MIT
#include "../../bench/json_text.h"
#include "../check/check.h"
#include "app.h"

#include <argp.h>
#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEY_SEED = 256, KEY_JSON, KEY_ONLY, KEY_LIST };

typedef struct arguments {
    const char *culler, *only;
    uint64_t seed;
    int json, list;
} arguments;

static const struct argp_option options[] = {
    {"seed", KEY_SEED, "S", 0, "of the random scenes and views, from 0 (default 1)", 0},
    {"only", KEY_ONLY, "NAME", 0, "this check, and what it rests on", 0},
    {"json", KEY_JSON, NULL, 0, "one JSON object on stdout", 0},
    {"list", KEY_LIST, NULL, 0, "name the checks and end", 0},
    {0},
};

static int parse_seed(const char *text, uint64_t *out)
{
    char *end;
    errno = 0;
    if (*text < '0' || *text > '9') return 0;
    *out = strtoull(text, &end, 10);
    return !*end && !errno;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case KEY_SEED:
        if (!parse_seed(text, &a->seed)) argp_error(state, "--seed takes a number from 0, not '%s'", text);
        break;
    case KEY_ONLY:
        if (!check_is_known(text)) argp_error(state, "there is no check '%s'; see --list", text);
        a->only = text;
        break;
    case KEY_JSON: a->json = 1; break;
    case KEY_LIST: a->list = 1; break;
    case ARGP_KEY_ARG:
        if (a->culler) argp_error(state, "one culler at a time");
        a->culler = text;
        break;
    case ARGP_KEY_END:
        if (!a->culler && !a->list) argp_error(state, "no culler was named; give a library's file, or an id that `portcullis plugins` lists");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

typedef struct telling {
    const arguments *arguments;
    const char *id;  // of the culler that is tried; NULL: not known
    json_t *checks;  // NULL: lines are printed
    check_count sum;
} telling;

static const char *const verdicts[] = {"pass", "FAIL", "skip"};

static void tell_json(telling *t, const check_line *line)
{
    json_array_append_new(t->checks, json_pack("{s:o, s:s, s:s, s:s, s:o, s:f}", "id", json_text(t->id ? t->id : ""),
                                               "name", line->name, "proves", line->proves,
                                               "verdict", line->verdict == CHECK_FAIL ? "fail" : verdicts[line->verdict], "message", json_text(line->message),
                                               "seconds", line->seconds));
}

static void tell_line(void *user, const check_line *line)
{
    telling *t = user;
    const arguments *a = t->arguments;
    if (t->checks) {
        tell_json(t, line);
        return;
    }
    printf("%s %s", verdicts[line->verdict], line->name);
    if (*line->message) printf(": %s", line->message);
    if (line->verdict == CHECK_FAIL) printf("; again: portcullis check %s --seed %llu --only %s", a->culler, (unsigned long long)a->seed, line->name);
    printf("\n");
    fflush(stdout);
}

static void tell_name(void *user, const char *name, const char *proves)
{
    (void)user;
    printf("%-13s %s\n", name, proves);
}

static int is_file(const char *culler)
{
    const size_t length = strlen(culler), suffix = strlen(".so");
    return strchr(culler, '/') || (length > suffix && strcmp(culler + length - suffix, ".so") == 0);
}

static void run_checks(telling *t, check_request *q)
{
    q->seed = t->arguments->seed;
    q->only = t->arguments->only;
    q->tell = tell_line;
    q->user = t;
    t->id = q->id;
    const check_count count = check_culler(q);
    t->sum.passed += count.passed;
    t->sum.failed += count.failed;
    t->sum.skipped += count.skipped;
}

static int end_telling(telling *t)
{
    const arguments *a = t->arguments;
    if (t->checks) {
        json_t *root = json_pack("{s:o, s:I, s:i, s:i, s:i, s:o}", "culler", json_text(a->culler), "seed", (json_int_t)a->seed, "passed", (int)t->sum.passed,
                                 "failed", (int)t->sum.failed, "skipped", (int)t->sum.skipped, "checks", t->checks);
        json_dumpf(root, stdout, JSON_INDENT(2));
        printf("\n");
        json_decref(root);
    } else {
        printf("%u passed, %u failed, %u skipped\n", t->sum.passed, t->sum.failed, t->sum.skipped);
    }
    return t->sum.failed ? EXIT_CHECK_FAILED : EXIT_GOOD;
}

// The library is opened by the processes of the checks alone; one that they cannot read fails its first check.
static int check_file(const arguments *a)
{
    FILE *there = fopen(a->culler, "rb");
    if (!there) {
        fprintf(stderr, "%s: error: cannot be opened: %s; name a culler's library\n", a->culler, strerror(errno));
        return EXIT_USAGE;
    }
    fclose(there);
    char ids[512];
    telling t = {.arguments = a, .checks = a->json ? json_array() : NULL};
    const int is_read = check_ids(a->culler, ids, sizeof ids), are_several = is_read && strchr(ids, ' ');
    char *id = is_read ? ids : NULL;
    do {
        char *next = id ? strchr(id, ' ') : NULL;
        if (next) *next++ = 0;
        if (are_several && !a->json) printf("culler %s:\n", id);
        check_request q = {.file = a->culler, .id = id};
        run_checks(&t, &q);
        id = next;
    } while (id);
    return end_telling(&t);
}

static int check_id(const arguments *a)
{
    app held;
    const cull_plugin *plugin = NULL;
    uint32_t count = 0;
    result done = app_open(&held, NULL);
    if (done == RESULT_OK) done = loader_find(held.plugins, a->culler, &held.report, &plugin);
    int code = app_exit_code(done);
    if (done == RESULT_OK) {
        telling t = {.arguments = a, .checks = a->json ? json_array() : NULL};
        check_request q = {.id = a->culler, .plugin = plugin};
        const loaded_plugin *all = loader_plugins(held.plugins, &count);
        for (uint32_t i = 0; i < count; ++i)
            if (all[i].plugin == plugin) q.file = all[i].path;
        run_checks(&t, &q);
        code = end_telling(&t);
    }
    app_close(&held);
    return code;
}

int command_check(int argc, char **argv)
{
    static const struct argp parser = {options, parse, "PLUGIN|ID",
                                       "Tries a culler against the contract, each check in a process of its own. "
                                       "Exit codes: 0 all pass, 1 one fails, 2 bad usage.", NULL, NULL, NULL};
    arguments a = {.seed = 1};
    if (argp_parse(&parser, argc, argv, 0, NULL, &a) != 0) return EXIT_USAGE;
    if (a.list) {
        check_each_name(tell_name, NULL);
        return EXIT_GOOD;
    }
    return is_file(a.culler) ? check_file(&a) : check_id(&a);
}
