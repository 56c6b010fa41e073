// portcullis: dispatches to its subcommands.
// SPDX-License-Identifier: MIT
#include "app.h"

#include <argp.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>

#ifndef PORTCULLIS_VERSION
#define PORTCULLIS_VERSION "unknown"
#endif

const char *argp_program_version = "portcullis " PORTCULLIS_VERSION;

typedef struct command {
    const char *name, *title, *summary; // title: argv[0] of the command
    app_command run;
} command;

static const command commands[] = {
    {"plugins", "portcullis plugins", "list cullers found, and libraries refused with the reason", command_plugins},
    {"info", "portcullis info", "what a scene holds", command_info},
    {"compile", "portcullis compile", "brushes to zones joined by portals: a scene file", command_compile},
    {"bench", "portcullis bench", "measure cullers on a scene and camera path against the truth", command_bench},
    {"merge", "portcullis merge", "put the parts of a sharded bench together", command_merge},
    {"render", "portcullis render", "draw one view to a PNG", command_render},
    {"explain", "portcullis explain", "why one item was drawn or not in one view", command_explain},
    {"first-miss", "portcullis first-miss", "the first wrong pixel of a path: where, why, a picture, and how to see it again", command_first_miss},
    {"auto", "portcullis auto", "measure chains and give each zone the cheapest exact one", command_auto},
    {"stress", "portcullis stress", "where cullers first differ on the scene moved, scaled, turned, jittered, doubled", command_stress},
    {"view", "portcullis view", "fly through a scene in a window", command_view},
    {"generate", "portcullis generate", "write a seeded scene: city, swarm, rooms, demo", command_generate},
    {"check", "portcullis check", "try a culler against the contract", command_check},
    {"new-culler", "portcullis new-culler", "write a whole project for a culler of your own", command_new_culler},
};
enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static void usage(FILE *to)
{
    fprintf(to, "usage: portcullis COMMAND [OPTIONS]\n\n");
    for (int i = 0; i < COMMAND_COUNT; ++i) fprintf(to, "  %-10s %s\n", commands[i].name, commands[i].summary);
    fprintf(to, "\n`portcullis COMMAND --help` tells a command's options. Exit codes: 0 good, 1 a check failed, 2 bad usage or input, 3 no GL.\n");
}

static int run_command(int argc, char **argv)
{
    argp_err_exit_status = EXIT_USAGE;
    if (argc < 2) {
        usage(stderr);
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "help") == 0) {
        usage(stdout);
        return EXIT_GOOD;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("%s\n", argp_program_version);
        return EXIT_GOOD;
    }
    for (int i = 0; i < COMMAND_COUNT; ++i) {
        if (strcmp(argv[1], commands[i].name) != 0) continue;
        char title[64];
        snprintf(title, sizeof title, "%s", commands[i].title);
        argv[1] = title;
        return commands[i].run(argc - 1, argv + 1);
    }
    fprintf(stderr, "portcullis: error: no command '%s'\n", argv[1]);
    usage(stderr);
    return EXIT_USAGE;
}

// What stdout still holds is written only here: a full disk must not look like success.
int main(int argc, char **argv)
{
    const int code = run_command(argc, argv);
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout)) return code;
    fprintf(stderr, "portcullis: error: cannot write to stdout: %s; make room, or send it elsewhere\n",
            errno ? strerror(errno) : "an earlier write failed");
    return EXIT_USAGE;
}
