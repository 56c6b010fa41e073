// portcullis generate: seeded scenes.
// SPDX-License-Identifier: MIT
#include "../../bench/generate.h"
#include "app.h"

#include <argp.h>
#include <errno.h>
#include <stdlib.h>

typedef struct arguments {
    const char *kind, *out;
    uint64_t size, seed;
} arguments;

static const struct argp_option options[] = {
    {"size", 'n', "N", 0, "boxes for city and swarm, rooms for rooms and maze", 0},
    {"seed", 's', "S", 0, "another seed, another scene: 0 to 18446744073709551614 (default 1)", 0},
    {"output", 'o', "FILE", 0, "where to; needed", 0},
    {0},
};

static const uint64_t NUMBER_MOST = UINT64_MAX - 1; // the last means that none was said

static int parse_u64(const char *text, uint64_t *out)
{
    char *end;
    if (*text < '0' || *text > '9') return 0;
    errno = 0;
    *out = strtoull(text, &end, 10);
    return *end == 0 && errno == 0 && *out <= NUMBER_MOST;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    if (key == 'n') {
        if (!parse_u64(text, &a->size)) argp_error(state, "--size takes a whole number, not '%s'", text);
    } else if (key == 's') {
        if (!parse_u64(text, &a->seed))
            argp_error(state, "--seed takes a whole number from 0 to %llu, not '%s'", (unsigned long long)NUMBER_MOST, text);
    } else if (key == 'o') a->out = text;
    else if (key == ARGP_KEY_ARG && !a->kind) a->kind = text;
    else if (key == ARGP_KEY_ARG) argp_error(state, "one KIND, not also '%s'", text);
    else if (key == ARGP_KEY_END && (!a->kind || !a->out)) argp_error(state, "KIND and -o are needed");
    else return ARGP_ERR_UNKNOWN;
    return 0;
}

int command_generate(int argc, char **argv)
{
    static const char about[] = "Writes a seeded scene. KIND: " GENERATE_KINDS ". maze, house and flagship, and rooms with -o FILE.json, "
                                "have zones: they write FILE.json and FILE.obj beside it; demo writes FILE.obj and FILE.views. "
                                "Files of these names are replaced.";
    static const struct argp parser = {options, parse, "KIND", about, NULL, NULL, NULL};
    arguments q = {.size = GENERATE_SIZE_OF_KIND, .seed = GENERATE_SEED_OF_KIND};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    report r = report_to_stderr();
    return app_exit_code(generate_scene(q.kind, q.size, q.seed, q.out, allocator_heap(), &r));
}
