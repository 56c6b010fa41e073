// The options of `portcullis compile`, and whether its files are what they should be before long work is done.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "compile_arguments.h"

#include "../compile/editor_files.h"
#include "../core/file.h"
#include "app.h"

#include <argp.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

static const struct argp_option options[] = {
    {"output", 'o', "FILE.pcs", 0, "where to; needed", 0},
    {"portals", 'p', "none|authored|doors|auto", 0, "what parts zones: nothing, zone_portal brushes, doors as well, narrow places as well (default doors)", 0},
    {"rooms", 'n', "N", 0, "with auto: no more rooms than these, but for what doors part", 0},
    {"max-portals", 'm', "N", 0, "with auto: no more portals than these in all (default 100)", 0},
    {"grid", 'g', "G", 0, "grid steps a unit, a whole number (default 256)", 0},
    {"prt", 'r', "FILE", 0, "the portals too, as map editors read them", 0},
    {"pts", 't', "FILE", 0, "the leak's line too, as map editors read it; without a leak an old one is removed", 0},
    {"plan", 'l', "FILE.png", 0, "a picture of the zones from above, portals as lines", 0},
    {"dump", 'd', "STAGE[=FILE]", 0,
     "what a stage made, as text: input, relations, csg, weld, merge, portals, zones, t_junctions or items (default to stdout); may be given again", 0},
    {"bake", 'b', "CHAIN", 0, "keep the indices that this chain builds in the file", 0},
    {"json", 'j', NULL, 0, "one flat JSON object on stdout", 0},
    {0},
};

static int parse_portals(const char *text, portal_choice *out)
{
    static const char *const names[] = {"doors", "none", "authored", "auto"}; // as portal_choice
    for (int i = 0; i < 4; ++i) {
        if (strcmp(text, names[i]) != 0) continue;
        *out = (portal_choice)i;
        return 1;
    }
    return 0;
}

static int parse_dump(char *text, compile_arguments *a)
{
    char *file = strchr(text, '=');
    if (file) *file++ = 0;
    const compile_stage s = compile_stage_of(text);
    if (s >= (compile_stage)STAGES_DUMPED || (file && !*file)) return 0;
    a->dump_files[s] = file ? file : "";
    return 1;
}

static void check_dumps(const compile_arguments *a, struct argp_state *state)
{
    int to_stdout = a->json;
    for (int s = 0; s < STAGES_DUMPED; ++s) {
        if (!a->dump_files[s] || *a->dump_files[s]) continue;
        const char *name = compile_stage_name((compile_stage)s);
        if (to_stdout && a->json) argp_error(state, "--json has stdout: name a file, --dump %s=FILE", name);
        else if (to_stdout) argp_error(state, "one dump has stdout already: name a file, --dump %s=FILE", name);
        to_stdout = 1;
    }
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    compile_arguments *a = state->input;
    uint32_t grid;
    char names[128];
    if (key == 'j') a->json = 1;
    else if (key == 'o') a->out = text;
    else if (key == 'r') a->prt = text;
    else if (key == 't') a->pts = text;
    else if (key == 'l') a->plan = text;
    else if (key == 'b') a->bake = text;
    else if (key == 'd') {
        compile_stage_names((compile_stage)STAGES_DUMPED, names);
        if (!parse_dump(text, a)) argp_error(state, "--dump takes one of %s, then =FILE or nothing", names);
    } else if (key == 'p') {
        if (!parse_portals(text, &a->zones.portals)) argp_error(state, "--portals takes none, authored, doors or auto, not '%s'", text);
    } else if (key == 'n') {
        if (!parse_count(text, 1, 1000000, &a->zones.rooms.rooms)) argp_error(state, "--rooms takes a whole number from 1 to 1000000, not '%s'", text);
    } else if (key == 'm') {
        if (!parse_count(text, 0, 1000000, &a->zones.rooms.portals)) argp_error(state, "--max-portals takes a whole number up to 1000000, not '%s'", text);
    } else if (key == 'g') {
        if (!parse_count(text, 1, 65536, &grid)) argp_error(state, "--grid takes a whole number from 1 to 65536, not '%s'", text);
        else a->options.grid = grid;
    } else if (key == ARGP_KEY_ARG && !a->input) a->input = text;
    else if (key == ARGP_KEY_ARG) argp_error(state, "one INPUT, not also '%s'", text);
    else if (key == ARGP_KEY_END && (!a->input || !a->out)) argp_error(state, "INPUT and -o are needed");
    else if (key == ARGP_KEY_END) check_dumps(a, state);
    else return ARGP_ERR_UNKNOWN;
    return 0;
}

void compile_arguments_parse(int argc, char **argv, compile_arguments *out)
{
    static const struct argp parser = {options, parse, "INPUT", "Compiles brushes to zones joined by portals: a scene file.", NULL, NULL, NULL};
    *out = (compile_arguments){.zones = zone_options_of(PORTALS_DOORS)};
    if (argp_parse(&parser, argc, argv, 0, NULL, out) != 0) exit(EXIT_USAGE);
}

// ---- Files ----

static int is_same_file(const char *a, const char *b)
{
    struct stat one, other;
    if (stat(a, &one) != 0 || stat(b, &other) != 0) return strcmp(a, b) == 0;
    return one.st_dev == other.st_dev && one.st_ino == other.st_ino && S_ISREG(one.st_mode);
}

result compile_arguments_check(const compile_arguments *a, report *r)
{
    enum { NAMED = 4 };
    const char *outputs[NAMED + STAGES_DUMPED] = {a->out, a->prt, a->pts, a->plan};
    memcpy(outputs + NAMED, a->dump_files, sizeof a->dump_files);
    const char *dot = strrchr(a->out, '.');
    const int is_device = strncmp(a->out, "/dev/", 5) == 0;
    if (!is_device && (!dot || strcasecmp(dot, ".pcs") != 0))
        return report_error(r, a->out, 0, "a compiled scene is a .pcs file; end the name in .pcs");
    if (!*a->input) return report_error(r, NULL, 0, "an empty file name; name a .map or .json of brushes");
    for (int i = 0; i < NAMED + STAGES_DUMPED; ++i) {
        if (!outputs[i] || (i >= NAMED && !*outputs[i])) continue;
        const result can = file_can_write(outputs[i], r);
        if (can != RESULT_OK) return can;
        if (is_same_file(outputs[i], a->input)) return report_error(r, outputs[i], 0, "is the input itself; name another file to write");
        for (int k = 0; k < i; ++k)
            if (outputs[k] && *outputs[k] && is_same_file(outputs[i], outputs[k]))
                return report_error(r, outputs[i], 0, "named for two outputs; name another file for one of them");
    }
    return a->pts ? editor_pts_check(a->pts, r) : RESULT_OK;
}
