// portcullis render: one view, culled and drawn, to a PNG; several cullers side by side.
// SPDX-License-Identifier: MIT
#include "../../bench/images.h"
#include "../core/file.h"
#include "chains.h"

#include <argp.h>
#include <stdio.h>
#include <string.h>

enum { KEY_VIEWS = 256, KEY_VIEW, KEY_CULLER, KEY_ZONE, KEY_MODE, KEY_SCISSOR, KEY_COUNTS, KEY_DOORS, KEY_SIZE, KEY_PLUGIN };
enum { CULLERS_MOST = 8 };

typedef struct arguments {
    const char *scene, *views, *out;
    const char *cullers[CULLERS_MOST];
    uint32_t culler_count;
    picture_request picture;
    app_size size;
    doors_choice doors;
    zone_options zones;
    app_plugin_files plugins;
} arguments;

static const struct argp_option options[] = {
    {"views", KEY_VIEWS, APP_VIEWS, 0, "the camera path; needed", 0},
    {"view", KEY_VIEW, "I", 0, "which of its views, from 0 (default 0)", 0},
    {"culler", KEY_CULLER, "CHAIN|scene", 0, "what culls (default none: all of each zone that is reached); scene: what the scene file names; may stand several times: pictures side by side", 0},
    {"zone", KEY_ZONE, "NAME=CHAIN", 0, "these zones take this chain; NAME may be a pattern such as cellar*; may stand several times", 0},
    {"mode", KEY_MODE, "shaded|items|zones|depth|overdraw|error", 0, "default shaded; error: missed pixels in magenta", 0},
    {"scissor", KEY_SCISSOR, NULL, 0, "cut what a zone draws to the rectangle that it is seen through", 0},
    {"counts", KEY_COUNTS, NULL, 0, "write the culler and how many polygons it drew into the picture", 0},
    {"doors", KEY_DOORS, "open|shut|scene", 0, "how doors stand (default open; scene: as its file says)", 0},
    {"size", KEY_SIZE, "WxH", 0, "of the picture (default 1280x720)", 0},
    {"plugin", KEY_PLUGIN, "FILE", 0, "look at this library first", 0},
    {"output", 'o', "FILE.png", 0, "where to; needed", 0},
    {0},
};

static int parse_mode(const char *text, picture_request *out)
{
    static const char *const names[] = {"shaded", "items", "zones", "depth", "overdraw"};
    static const render_mode modes[] = {RENDER_SHADED, RENDER_ITEMS, RENDER_ZONES, RENDER_DEPTH, RENDER_OVERDRAW};
    if (strcmp(text, "error") == 0) {
        out->kind = PICTURE_ERROR;
        return 1;
    }
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        if (strcmp(text, names[i]) == 0) {
            out->mode = modes[i];
            return 1;
        }
    return 0;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case KEY_VIEWS: a->views = text; break;
    case KEY_CULLER:
        if (a->culler_count == CULLERS_MOST) argp_error(state, "at most %d pictures side by side", CULLERS_MOST);
        a->cullers[a->culler_count++] = text;
        break;
    case 'o': a->out = text; break;
    case KEY_PLUGIN:
        if (a->plugins.count < APP_PLUGINS_MOST) a->plugins.files[a->plugins.count++] = text;
        break;
    case KEY_VIEW:
        if (!parse_count(text, 0, UINT32_MAX - 1, &a->picture.view)) argp_error(state, "--view takes a number from 0, not '%s'", text);
        break;
    case KEY_MODE:
        if (!parse_mode(text, &a->picture)) argp_error(state, "--mode takes shaded, items, zones, depth, overdraw or error, not '%s'", text);
        break;
    case KEY_ZONE:
        if (a->zones.count == ZONE_OPTIONS_MOST) argp_error(state, "too many of one option");
        a->zones.texts[a->zones.count++] = text;
        break;
    case KEY_COUNTS: a->picture.caption = CAPTION_COUNTS; break;
    case KEY_SCISSOR: a->picture.scissor = SCISSOR_ZONES; break;
    case KEY_DOORS:
        if (!app_doors_parse(text, &a->doors)) argp_error(state, "--doors takes open, shut or scene, not '%s'", text);
        break;
    case KEY_SIZE:
        if (!parse_size(text, &a->size)) argp_error(state, "--size takes WxH of 1 to 8192, not '%s'", text);
        break;
    case ARGP_KEY_ARG:
        if (a->scene) argp_error(state, "one SCENE, not also '%s'", text);
        a->scene = text;
        break;
    case ARGP_KEY_END:
        if (!a->scene || !a->views || !a->out) argp_error(state, "SCENE, --views and -o are needed");
        if (!a->culler_count) a->cullers[a->culler_count++] = "none";
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

// One strategy's picture, into rgba of the bench's size.
static result draw_one(app *a, const picture_request *picture, const bench_request *bench, renderer *g, uint8_t *rgba)
{
    strategy s = {0};
    truth t = {0};
    uint64_t missed = 0;
    result done = strategy_open(bench, bench->strategies, g, &a->report, &s);
    const truth_request request = {a->scene, bench->width_px, bench->height_px, s.walls};
    if (done == RESULT_OK && picture->kind == PICTURE_ERROR) done = truth_open(&request, a->memory, &a->report, &t);
    if (done == RESULT_OK) done = picture_of(&s, &t, picture, &a->report, rgba, &missed);
    if (done == RESULT_OK) done = app_check_gl(a, g);
    if (done == RESULT_OK && picture->kind == PICTURE_ERROR) report_note(&a->report, "%llu missed pixels", (unsigned long long)missed);
    truth_close(&t);
    strategy_close(&s);
    return done;
}

// All strategies' pictures in a row, to the file.
static result draw_row(app *a, const arguments *q, const bench_request *bench, renderer *g)
{
    const size_t row_bytes = (size_t)q->size.width_px * 4, bytes = row_bytes * q->size.height_px, count = q->culler_count;
    uint8_t *one = memory_alloc(a->memory, bytes, 1), *all = memory_alloc(a->memory, bytes * count, 1);
    result done = one && all ? renderer_upload(g, a->scene, &a->report) : report_no_memory(&a->report, NULL);
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) {
        bench_request single = *bench;
        single.strategies = bench->strategies + i;
        single.strategy_count = 1;
        done = draw_one(a, &q->picture, &single, g, one);
        for (size_t y = 0; y < q->size.height_px && done == RESULT_OK; ++y) memcpy(all + (y * count + i) * row_bytes, one + y * row_bytes, row_bytes);
    }
    if (done == RESULT_OK) done = png_write(q->out, all, q->size.width_px * q->culler_count, q->size.height_px, &a->report);
    memory_free(a->memory, one, bytes, 1);
    memory_free(a->memory, all, bytes * count, 1);
    return done;
}

static result run_render(app *a, const arguments *q, const camera_path *path)
{
    if (q->picture.view >= path->count)
        return report_error(&a->report, NULL, 0, "--view %u: the path has %u views, counted from 0", q->picture.view, path->count);
    chain_book book = {0};
    bench_strategy_request strategies[CULLERS_MOST] = {0};
    result done = chain_book_open(a, &q->zones, &book);
    for (uint32_t i = 0; i < q->culler_count && done == RESULT_OK; ++i) done = chain_book_strategy(&book, q->cullers[i], &strategies[i]);
    chain_book_close(&book);
    if (done != RESULT_OK) return done;
    const bench_request bench = {.scene = a->scene, .path = path, .strategies = strategies, .strategy_count = q->culler_count, .doors = app_doors_of(&q->doors),
                                 .plugins = a->plugins, .services = &a->services, .repeat = 1,
                                 .width_px = q->size.width_px, .height_px = q->size.height_px, .truth = BENCH_NO_TRUTH};
    const renderer_options options_of_gl = {.target = RENDERER_HEADLESS, .width_px = q->size.width_px, .height_px = q->size.height_px};
    renderer *g = NULL;
    done = renderer_open(&options_of_gl, a->memory, &a->report, &g);
    if (done == RESULT_OK) done = draw_row(a, q, &bench, g);
    renderer_close(g);
    return done;
}

int command_render(int argc, char **argv)
{
    static const struct argp parser = {options, parse, "SCENE", "Draws one view of a scene to a PNG file.", NULL, NULL, NULL};
    arguments q = {.size = {1280, 720}, .picture = {.mode = RENDER_SHADED}};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    app a;
    camera_path path = {0};
    const import_options import = {.doors = app_doors_import(q.doors)};
    result done = app_open(&a, &q.plugins);
    if (done == RESULT_OK) done = file_can_write(q.out, &a.report);
    if (done == RESULT_OK) done = chains_check(&a, q.cullers, q.culler_count, &q.zones);
    if (done == RESULT_OK) done = import_scene(q.scene, &import, a.memory, &a.report, &a.scene);
    if (done == RESULT_OK) done = camera_path_load(q.views, a.scene, (double)q.size.width_px / q.size.height_px, a.memory, &a.report, &path);
    if (done == RESULT_OK) done = run_render(&a, &q, &path);
    camera_path_free(&path, a.memory);
    app_close(&a);
    return app_exit_code(done);
}
