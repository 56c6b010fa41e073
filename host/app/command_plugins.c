// portcullis plugins: cullers found, libraries refused.
// SPDX-License-Identifier: MIT
#include "../../bench/json_text.h"
#include "app.h"

#include <argp.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

typedef struct arguments {
    app_plugin_files files;
    int json;
} arguments;

static const struct argp_option options[] = {
    {"json", 'j', NULL, 0, "one JSON object on stdout", 0},
    {"plugin", 'p', "FILE", 0, "look at this library first; may stand several times", 0},
    {0},
};

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    if (key == 'j') a->json = 1;
    else if (key == 'p' && a->files.count < APP_PLUGINS_MOST) a->files.files[a->files.count++] = text;
    else if (key == ARGP_KEY_ARG) argp_error(state, "plugins takes no argument");
    else return ARGP_ERR_UNKNOWN;
    return 0;
}

static const char *verbs_of(const cull_plugin *p)
{
    static const char *const names[8] = {"",      "select",        "filter",        "select, filter",
                                         "cross", "select, cross", "filter, cross", "select, filter, cross"};
    return names[(p->select ? 1 : 0) | (p->filter ? 2 : 0) | (p->cross ? 4 : 0)];
}

static json_t *promises_of(cull_promises promises)
{
    static const char *const names[] = {"conservative", "sampled", "stateless", "ordered"};
    json_t *list = json_array();
    for (uint32_t i = 0; i < 4; ++i)
        if (promises >> i & 1) json_array_append_new(list, json_string(names[i]));
    return list;
}

static const char *origin_of(const app *a, const char *path)
{
    return path ? search_path_origin_name(&a->search, path) : "built in";
}

static int is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

static json_t *folders_json(const search_path *p)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < p->count; ++i)
        json_array_append_new(list, json_pack("{s:o, s:s, s:b}", "path", json_text(p->folders[i]), "origin", search_origin_name(p->origins[i]),
                                              "is_there", is_folder(p->folders[i])));
    return list;
}

static json_t *plugin_json(const app *a, const loaded_plugin *l)
{
    const cull_descriptor *d = l->plugin->descriptor;
    json_t *table = json_array();
    for (uint32_t i = 0; i < d->option_count; ++i)
        json_array_append_new(table,
                              json_pack("{s:o, s:o, s:o, s:o}", "key", json_text(d->options[i].key), "default", json_text(d->options[i].fallback),
                                        "help", json_text(d->options[i].help), "sweep", json_text(d->options[i].sweep)));
    return json_pack("{s:s, s:o, s:o, s:s, s:o, s:o, s:o, s:s}", "id", d->id, "version", json_text(d->version), "summary", json_text(d->summary), "verbs",
                     verbs_of(l->plugin), "may_promise", promises_of(d->may_promise), "options", table, "path",
                     json_text(l->path ? l->path : "built in"), "origin", origin_of(a, l->path));
}

static void print_json(const app *a)
{
    const loader *l = a->plugins;
    uint32_t count;
    json_t *found = json_array(), *refused = json_array();
    const loaded_plugin *plugins = loader_plugins(l, &count);
    for (uint32_t i = 0; i < count; ++i) json_array_append_new(found, plugin_json(a, &plugins[i]));
    const refused_plugin *refusals = loader_refusals(l, &count);
    for (uint32_t i = 0; i < count; ++i)
        json_array_append_new(refused, json_pack("{s:o, s:o}", "path", json_text(refusals[i].path), "reason", json_text(refusals[i].reason)));
    json_t *root = json_pack("{s:i, s:o, s:o, s:o}", "abi", (int)CULL_ABI, "plugins", found, "refused", refused, "folders", folders_json(&a->search));
    json_dumpf(root, stdout, JSON_INDENT(2));
    printf("\n");
    json_decref(root);
}

static void print_text(const app *a)
{
    const loader *l = a->plugins;
    uint32_t count;
    const loaded_plugin *plugins = loader_plugins(l, &count);
    for (uint32_t i = 0; i < count; ++i) {
        const cull_descriptor *d = plugins[i].plugin->descriptor;
        const char *path = plugins[i].path;
        printf("%s %s (%s): %s\n    %s", d->id, d->version, verbs_of(plugins[i].plugin), d->summary, path ? path : "built in");
        if (path) printf(" (%s)", origin_of(a, path));
        printf("\n");
        for (uint32_t o = 0; o < d->option_count; ++o) printf("    %s=%s  %s\n", d->options[o].key, d->options[o].fallback, d->options[o].help);
    }
    const refused_plugin *refused = loader_refusals(l, &count);
    for (uint32_t i = 0; i < count; ++i) printf("refused %s: %s\n", refused[i].path, refused[i].reason);
    printf("looked in, in this order:\n");
    for (uint32_t i = 0; i < a->search.count; ++i)
        printf("    %s (%s)%s\n", a->search.folders[i], search_origin_name(a->search.origins[i]), is_folder(a->search.folders[i]) ? "" : ": not there");
}

int command_plugins(int argc, char **argv)
{
    static const struct argp parser = {options, parse, NULL, "Lists the cullers found, and the libraries refused with the reason.", NULL, NULL, NULL};
    arguments q = {0};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    app a;
    result done = app_open(&a, &q.files);
    if (done == RESULT_OK) done = loader_scan(a.plugins, &a.report);
    if (done == RESULT_OK && q.json) print_json(&a);
    else if (done == RESULT_OK) print_text(&a);
    app_close(&a);
    return app_exit_code(done);
}
