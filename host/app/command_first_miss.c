// portcullis first-miss: the first wrong pixel of a path, why, a picture of the spot, and the command that shows it again.
// SPDX-License-Identifier: MIT
#include "../../bench/first_miss.h"
#include "../core/file.h"
#include "chains.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEY_VIEWS = 256, KEY_FROM, KEY_CULLER, KEY_ZONE, KEY_DOORS, KEY_SIZE, KEY_LATENCY, KEY_PLUGIN };

typedef struct arguments {
    const char *scene, *views, *culler, *out;
    uint32_t from, latency;
    app_size size;
    const char *doors_text;
    doors_choice doors;
    zone_options zones;
    app_plugin_files plugins;
} arguments;

static const struct argp_option options[] = {
    {"views", KEY_VIEWS, APP_VIEWS, 0, "the camera path; needed", 0},
    {"from", KEY_FROM, "I", 0, "the view to start at, from 0, without history (default 0)", 0},
    {"culler", KEY_CULLER, "CHAIN|scene", 0, "what culls (default scene: what the scene file names, frustum where it names none)", 0},
    {"zone", KEY_ZONE, "NAME=CHAIN", 0, "these zones take this chain; NAME may be a pattern such as cellar*; may stand several times", 0},
    {"doors", KEY_DOORS, "open|shut|scene", 0, "how doors stand (default open; scene: as its file says)", 0},
    {"size", KEY_SIZE, "WxH", 0, "of the picture (default 1280x720)", 0},
    {"query-latency", KEY_LATENCY, "L", 0, "an answer is readable L steps later (default 0)", 0},
    {"output", 'o', "FILE.png", 0,
     "where the picture goes when something is missed (default first-miss.png): missed pixels in magenta, a ring round the first, in a corner what was "
     "drawn there and, framed in green, what is true",
     0},
    {"plugin", KEY_PLUGIN, "FILE", 0, "look at this library first; may stand several times", 0},
    {0},
};

static void parse_numbers(int key, const char *text, struct argp_state *state)
{
    arguments *a = state->input;
    if (key == KEY_FROM && !parse_count(text, 0, UINT32_MAX - 1, &a->from)) argp_error(state, "--from takes a number from 0, not '%s'", text);
    if (key == KEY_SIZE && !parse_size(text, &a->size)) argp_error(state, "--size takes WxH of 1 to 8192, not '%s'", text);
    if (key == KEY_LATENCY && !parse_count(text, 0, 64, &a->latency)) argp_error(state, "--query-latency takes 0 to 64, not '%s'", text);
    if (key == KEY_DOORS && !app_doors_parse(text, &a->doors)) argp_error(state, "--doors takes open, shut or scene, not '%s'", text);
    if (key == KEY_DOORS) a->doors_text = text;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case KEY_VIEWS: a->views = text; break;
    case KEY_CULLER: a->culler = text; break;
    case 'o': a->out = text; break;
    case KEY_ZONE:
        if (a->zones.count == ZONE_OPTIONS_MOST) argp_error(state, "too many of one option");
        a->zones.texts[a->zones.count++] = text;
        break;
    case KEY_PLUGIN:
        if (a->plugins.count == APP_PLUGINS_MOST) argp_error(state, "too many of one option");
        a->plugins.files[a->plugins.count++] = text;
        break;
    case KEY_FROM:
    case KEY_SIZE:
    case KEY_LATENCY:
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

// ---- The command that shows it again ----

// As a shell takes it: in quotes where a character could mean something to one.
static void print_quoted(const char *text)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=.,:/@%";
    if (*text && strspn(text, plain) == strlen(text)) {
        printf("%s", text);
        return;
    }
    printf("'");
    for (const char *c = text; *c; ++c) *c == '\'' ? (void)printf("'\\''") : (void)putchar(*c);
    printf("'");
}

static void print_word(const char *text)
{
    printf(" ");
    print_quoted(text);
}

static void print_option(const char *name, const char *value)
{
    printf(" --%s", name);
    print_word(value);
}

static void print_command(const arguments *q, const char *command)
{
    char size[32];
    const char *path = getenv("PORTCULLIS_PLUGIN_PATH"); // app_open looks there
    printf("again:");
    if (path) {
        printf(" PORTCULLIS_PLUGIN_PATH=");
        print_quoted(path);
    }
    printf(" portcullis %s", command);
    print_word(q->scene);
    print_option("views", q->views);
    if (q->culler) print_option("culler", q->culler);
    for (uint32_t i = 0; i < q->zones.count; ++i) print_option("zone", q->zones.texts[i]);
    for (uint32_t i = 0; i < q->plugins.count; ++i) print_option("plugin", q->plugins.files[i]);
    if (q->doors_text) print_option("doors", q->doors_text);
    snprintf(size, sizeof size, "%ux%u", q->size.width_px, q->size.height_px);
    print_option("size", size);
}

static void print_again(const arguments *q, const first_miss *m)
{
    if (m->repeats == MISS_REPEATS_NOT)
        printf("again: not seen when the same views were walked once more: the culler remembers what is not its query's, or time decides what it draws\n");
    if (m->from == m->view && m->repeats == MISS_REPEATS && q->latency == 0) { // explain and render look at one view, answers come at once
        print_command(q, "explain");
        printf(" --view %u --item %u --truth\n", m->view, m->item);
        if (m->kind != MISS_PIXEL) return;
        print_command(q, "render");
        printf(" --view %u --mode error -o missed.png\n", m->view);
        return;
    }
    print_command(q, "first-miss");
    if (q->latency) printf(" --query-latency %u", q->latency);
    if (m->from) printf(" --from %u", m->from);
    printf("\n");
}

// ---- What is told ----

static void print_item(const scene *s, const first_miss *m)
{
    const scene_item *item = &s->items[m->item];
    if (m->item >= s->item_count) printf("item: %u, the mover '%s'", m->item, s->movers[m->item - s->item_count].name);
    else printf("item: %u, of '%s', material '%s'", m->item, s->objects[item->object].name, s->materials[item->material].name);
    printf(", %u polygon%s", item->polygon_count, item->polygon_count == 1 ? "" : "s");
    if (m->kind == MISS_PIXEL) printf("; it owns %u pixel%s", m->item_pixels, m->item_pixels == 1 ? "" : "s");
    printf("\n");
}

static void print_zones(const scene *s, uint32_t item)
{
    int count = 0;
    for (uint32_t z = 0; z < s->zone_count; ++z)
        for (uint32_t i = 0; i < s->zones[z].item_count; ++i) {
            if (s->zone_items[s->zones[z].first_item + i] != item) continue;
            printf("%s'%s'", count++ ? ", " : "zones: ", s->zones[z].name);
            break;
        }
    if (count) printf("\n");
}

static void print_why(const char *why)
{
    printf("why:\n");
    while (*why) {
        const size_t length = strcspn(why, "\n");
        printf("  %.*s\n", (int)length, why);
        why += length + (why[length] == '\n');
    }
}

static void print_miss(const app *a, const arguments *q, const camera_path *path, const first_miss *m)
{
    const camera *c = &path->cameras[m->view];
    printf("first miss: view %u of %u, pixel %u %u of %ux%u from the top left%s\n", m->view, path->count, m->x_px, m->y_px, q->size.width_px,
           q->size.height_px, m->kind == MISS_PIXEL ? "" : " (the middle of what is translucent, and owns no pixel)");
    printf("eye: %.17g %.17g %.17g\n", c->eye[0], c->eye[1], c->eye[2]);
    print_item(a->scene, m);
    print_zones(a->scene, m->item);
    printf("in this view: %llu pixels of %llu items missed, %s\n", (unsigned long long)m->pixels, (unsigned long long)m->items,
           m->broken == m->items ? "all promised" : m->broken ? "some of them promised" : "by chains that promise nothing here");
    if (m->repeats == MISS_REPEATS && m->from == m->view) printf("history: none is needed\n");
    else if (m->repeats == MISS_REPEATS) printf("history: from view %u on\n", m->from);
    print_why(m->why);
    printf("picture: %s\n", q->out);
    print_again(q, m);
}

static result hunt(app *a, const arguments *q, const camera_path *path, uint32_t *found)
{
    chain_book book = {0};
    bench_strategy_request strategy = {0};
    first_miss miss;
    if (q->from >= path->count) return report_error(&a->report, NULL, 0, "--from %u: the path has %u views, counted from 0", q->from, path->count);
    result done = chain_book_open(a, &q->zones, &book);
    if (done == RESULT_OK) done = chain_book_strategy(&book, q->culler, &strategy);
    chain_book_close(&book);
    if (done != RESULT_OK) return done;
    const bench_request bench = {.scene = a->scene, .path = path, .strategies = &strategy, .strategy_count = 1, .doors = app_doors_of(&q->doors),
                                 .plugins = a->plugins, .services = &a->services, .repeat = 1, .query_latency = q->latency,
                                 .width_px = q->size.width_px, .height_px = q->size.height_px, .truth = BENCH_TRUTH};
    done = first_miss_find(&bench, q->from, &a->report, &miss);
    if (done != RESULT_OK) return done;
    *found = miss.kind != MISS_NONE;
    if (*found) done = png_write(q->out, miss.rgba, q->size.width_px, q->size.height_px, &a->report);
    if (*found && done == RESULT_OK) print_miss(a, q, path, &miss);
    if (!*found) printf("no miss: all that owns a pixel was drawn, in %u views of %ux%u\n", miss.views_looked_at, q->size.width_px, q->size.height_px);
    if (!*found && miss.views_blind == miss.views_looked_at)
        report_warning(&a->report, NULL, 0, "no view of this path sees anything; that nothing is missed says nothing");
    first_miss_free(&bench, &miss);
    return done;
}

int command_first_miss(int argc, char **argv)
{
    static const struct argp parser = {options, parse, "SCENE",
                                       "Finds the first pixel of a path whose owner a culler does not draw: view, item, reason, picture, and the command "
                                       "that shows it again. Exit codes: 0 nothing is missed, 1 something is.",
                                       NULL, NULL, NULL};
    arguments q = {.size = {1280, 720}, .out = "first-miss.png"};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    app a;
    camera_path path = {0};
    uint32_t found = 0;
    const import_options import = {.doors = app_doors_import(q.doors)};
    result done = app_open(&a, &q.plugins);
    if (done == RESULT_OK) done = file_can_write(q.out, &a.report);
    if (done == RESULT_OK) done = chains_check(&a, &q.culler, 1, &q.zones);
    if (done == RESULT_OK) done = import_scene(q.scene, &import, a.memory, &a.report, &a.scene);
    if (done == RESULT_OK) done = camera_path_load(q.views, a.scene, (double)q.size.width_px / q.size.height_px, a.memory, &a.report, &path);
    if (done == RESULT_OK) done = hunt(&a, &q, &path, &found);
    camera_path_free(&path, a.memory);
    app_close(&a);
    return done == RESULT_OK && found ? EXIT_CHECK_FAILED : app_exit_code(done);
}
