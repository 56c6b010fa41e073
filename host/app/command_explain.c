// portcullis explain: why one item was drawn or not in one view, and on wish what of it is to be seen.
// SPDX-License-Identifier: MIT
#include "../../bench/strategy.h"
#include "chains.h"

#include <argp.h>
#include <stdio.h>

enum { KEY_VIEWS = 256, KEY_VIEW, KEY_ITEM, KEY_CULLER, KEY_ZONE, KEY_DOORS, KEY_SIZE, KEY_TRUTH, KEY_PLUGIN };

typedef struct arguments {
    const char *scene, *views, *culler;
    uint32_t view, item;
    uint32_t has_item, with_truth;
    app_size size;
    doors_choice doors;
    zone_options zones;
    app_plugin_files plugins;
} arguments;

static const struct argp_option options[] = {
    {"views", KEY_VIEWS, APP_VIEWS, 0, "the camera path; needed", 0},
    {"view", KEY_VIEW, "I", 0, "which of its views, from 0 (default 0)", 0},
    {"item", KEY_ITEM, "N", 0, "global id: place in the scene file, from 0, movers behind all others; needed", 0},
    {"culler", KEY_CULLER, "CHAIN|scene", 0, "what culls (default scene: what the scene file names, frustum where it names none)", 0},
    {"zone", KEY_ZONE, "NAME=CHAIN", 0, "these zones take this chain; NAME may be a pattern such as cellar*; may stand several times", 0},
    {"doors", KEY_DOORS, "open|shut|scene", 0, "how doors stand (default open; scene: as its file says)", 0},
    {"size", KEY_SIZE, "WxH", 0, "of the picture (default 1280x720)", 0},
    {"truth", KEY_TRUTH, NULL, 0, "also draw the view with everything, and tell how many pixels the item owns", 0},
    {"plugin", KEY_PLUGIN, "FILE", 0, "look at this library first; may stand several times", 0},
    {0},
};

static void parse_numbers(int key, const char *text, struct argp_state *state)
{
    arguments *a = state->input;
    if (key == KEY_VIEW && !parse_count(text, 0, UINT32_MAX - 1, &a->view)) argp_error(state, "--view takes a number from 0, not '%s'", text);
    if (key == KEY_ITEM && !parse_count(text, 0, UINT32_MAX - 1, &a->item)) argp_error(state, "--item takes a number from 0, not '%s'", text);
    if (key == KEY_SIZE && !parse_size(text, &a->size)) argp_error(state, "--size takes WxH of 1 to 8192, not '%s'", text);
    if (key == KEY_DOORS && !app_doors_parse(text, &a->doors)) argp_error(state, "--doors takes open, shut or scene, not '%s'", text);
    a->has_item |= key == KEY_ITEM;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case KEY_VIEWS: a->views = text; break;
    case KEY_CULLER: a->culler = text; break;
    case KEY_TRUTH: a->with_truth = 1; break;
    case KEY_ZONE:
        if (a->zones.count == ZONE_OPTIONS_MOST) argp_error(state, "too many of one option");
        a->zones.texts[a->zones.count++] = text;
        break;
    case KEY_PLUGIN:
        if (a->plugins.count == APP_PLUGINS_MOST) argp_error(state, "too many of one option");
        a->plugins.files[a->plugins.count++] = text;
        break;
    case KEY_VIEW:
    case KEY_ITEM:
    case KEY_SIZE:
    case KEY_DOORS: parse_numbers(key, text, state); break;
    case ARGP_KEY_ARG:
        if (a->scene) argp_error(state, "one SCENE, not also '%s'", text);
        a->scene = text;
        break;
    case ARGP_KEY_END:
        if (!a->scene || !a->views || !a->has_item) argp_error(state, "SCENE, --views and --item are needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

// ---- One view ----

static result print_explanation(app *a, strategy *s, const arguments *q)
{
    const frame_input input = strategy_input(s, q->view);
    const explain_request request = {&input, q->item};
    const size_t size = world_explain(s->view, &request, NULL, 0) + 1;
    char *text = memory_alloc(a->memory, size, 1);
    if (!text) return report_no_memory(&a->report, NULL);
    world_explain(s->view, &request, text, size);
    printf("%s%s", text, size > 1 && text[size - 2] == '\n' ? "" : "\n");
    memory_free(a->memory, text, size, 1);
    return RESULT_OK;
}

static void print_truth(const strategy *s, const arguments *q, const truth *t)
{
    const truth_view *v = t->views.items;
    const truth_item *items = t->items.items, *found = NULL;
    for (uint32_t i = 0; i < v->count; ++i)
        if (items[v->first + i].item == q->item) found = &items[v->first + i];
    const char *judged = t->walls == WALLS_BOTH_SIDES ? "" : ", of walls that face the eye";
    const char *missed = found && !(s->drawn_bits[q->item / 32] >> (q->item % 32) & 1) ? ": missed" : "";
    const char *plural = found && found->polygons == 1 ? "" : "s";
    if (!found) printf("truth: owns no pixel of %ux%u%s\n", q->size.width_px, q->size.height_px, judged);
    else if (found->pixels)
        printf("truth: owns %u pixel%s of %ux%u, by %u polygon%s%s%s\n", found->pixels, found->pixels == 1 ? "" : "s", q->size.width_px,
               q->size.height_px, found->polygons, plural, judged, missed);
    else printf("truth: is seen and leaves no depth, by %u polygon%s%s%s\n", found->polygons, plural, judged, missed);
}

static result tell_truth(app *a, strategy *s, const arguments *q)
{
    truth t = {0};
    const truth_request request = {a->scene, q->size.width_px, q->size.height_px, s->walls};
    result done = truth_open(&request, a->memory, &a->report, &t);
    if (done != RESULT_OK) return done;
    done = strategy_judge(s, q->view, &a->report, &t);
    if (done == RESULT_OK) done = truth_add_view(&t, s->g, &s->q->path->cameras[q->view], &a->report); // movers stand where the view had them
    if (done == RESULT_OK) print_truth(s, q, &t);
    truth_close(&t);
    return done;
}

static result explain(app *a, const arguments *q, const bench_request *bench)
{
    strategy s = {0};
    renderer *g = NULL;
    strategy_view view;
    const renderer_options of_gl = {.target = RENDERER_HEADLESS, .width_px = q->size.width_px, .height_px = q->size.height_px};
    result done = strategy_open(bench, bench->strategies, NULL, &a->report, &s);
    const int draws = done == RESULT_OK && (q->with_truth || s.uses_renderer);
    if (draws) done = renderer_open(&of_gl, a->memory, &a->report, &g);
    if (draws && done == RESULT_OK) done = renderer_upload(g, a->scene, &a->report);
    if (draws && done == RESULT_OK) done = strategy_attach(&s, g, &a->report);
    const strategy_request request = {.view = q->view, .mode = RENDER_SHADED, .marks = MARK_DRAWN};
    if (done == RESULT_OK) done = strategy_run_view(&s, &request, &a->report, &view);
    if (done == RESULT_OK) done = app_check_gl(a, g); // tests that fail say seen
    if (done == RESULT_OK) done = print_explanation(a, &s, q);
    if (done == RESULT_OK && q->with_truth) done = tell_truth(a, &s, q);
    if (done == RESULT_OK) done = app_check_gl(a, g);
    strategy_close(&s);
    renderer_close(g);
    return done;
}

static result run_explain(app *a, const arguments *q, const camera_path *path)
{
    const uint32_t items = a->scene->item_count + a->scene->mover_count;
    if (q->view >= path->count) return report_error(&a->report, NULL, 0, "--view %u: the path has %u views, counted from 0", q->view, path->count);
    if (q->item >= items)
        return report_error(&a->report, NULL, 0, "--item %u: the scene has %u items and %u movers behind them, counted from 0", q->item,
                            a->scene->item_count, a->scene->mover_count);
    chain_book book = {0};
    bench_strategy_request strategy = {0};
    result done = chain_book_open(a, &q->zones, &book);
    if (done == RESULT_OK) done = chain_book_strategy(&book, q->culler, &strategy);
    chain_book_close(&book);
    const bench_request bench = {.scene = a->scene, .path = path, .strategies = &strategy, .strategy_count = 1, .doors = app_doors_of(&q->doors),
                                 .plugins = a->plugins, .services = &a->services, .repeat = 1, .width_px = q->size.width_px,
                                 .height_px = q->size.height_px, .truth = BENCH_NO_TRUTH};
    return done == RESULT_OK ? explain(a, q, &bench) : done;
}

int command_explain(int argc, char **argv)
{
    static const struct argp parser = {options,
                                       parse,
                                       "SCENE",
                                       "Tells why an item or mover was drawn or not in one view: zones and portals on the way, door, "
                                       "plane, culler or limit.",
                                       NULL,
                                       NULL,
                                       NULL};
    arguments q = {.size = {1280, 720}};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    app a;
    camera_path path = {0};
    const import_options import = {.doors = app_doors_import(q.doors)};
    result done = app_open(&a, &q.plugins);
    if (done == RESULT_OK) done = chains_check(&a, &q.culler, 1, &q.zones);
    if (done == RESULT_OK) done = import_scene(q.scene, &import, a.memory, &a.report, &a.scene);
    if (done == RESULT_OK) done = camera_path_load(q.views, a.scene, (double)q.size.width_px / q.size.height_px, a.memory, &a.report, &path);
    if (done == RESULT_OK) done = run_explain(&a, &q, &path);
    camera_path_free(&path, a.memory);
    app_close(&a);
    return app_exit_code(done);
}
