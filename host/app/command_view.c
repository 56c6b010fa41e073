// portcullis view: flies through a scene in a window, with every zone's culler to be changed while it runs.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "../core/file.h"
#include "../import/views.h"
#include "chains.h"
#include "explore.h"

#include <argp.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { KEY_VIEWS = 256, KEY_VIEW, KEY_CULLER, KEY_DOORS, KEY_SIZE, KEY_PLUGIN, KEY_KEYS, KEY_FRAMES, KEY_FRAME_MS };
static const double SCRIPT_STEP_S = 1.0 / 30, STEP_MOST_S = 0.25;

typedef struct arguments {
    const char *scene, *views, *out, *keys;
    const char *cullers[EXPLORE_CHAINS_MOST];
    uint32_t culler_count;
    uint32_t view, frames; // frames 0: until the window is closed
    double frame_ms;
    app_size size;
    doors_choice doors;
    app_plugin_files plugins;
} arguments;

static const struct argp_option options[] = {
    {"views", KEY_VIEWS, "FILE|auto:N|path:NAME", 0, "where to start (default auto:1)", 0},
    {"view", KEY_VIEW, "I", 0, "at which of its views, from 0 (default 0)", 0},
    {"culler", KEY_CULLER, "CHAIN", 0, "of zones whose file names none (default frustum); given several times, C goes through them", 0},
    {"doors", KEY_DOORS, "open|shut|scene", 0, "how doors stand at first (default scene: as its file says)", 0},
    {"size", KEY_SIZE, "WxH", 0, "of the window (default 1280x720)", 0},
    {"frame-ms", KEY_FRAME_MS, "X", 0, "cullers are told that a frame may take so long (default 0: nobody says)", 0},
    {"plugin", KEY_PLUGIN, "FILE", 0, "look at this library first", 0},
    {"keys", KEY_KEYS, "TEXT", 0, "press these keys, one a frame, '.' none; the window ends behind the last unless --frames says more", 0},
    {"frames", KEY_FRAMES, "N", 0, "end after so many frames", 0},
    {"output", 'o', "FILE.png", 0, "pictures that P takes (default portcullis.png); with --frames or --keys one at the end too", 0},
    {0},
};

static error_t parse(int key, char *text, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case KEY_VIEWS: a->views = text; break;
    case KEY_CULLER:
        if (a->culler_count == EXPLORE_CHAINS_MOST) argp_error(state, "too many of one option");
        a->cullers[a->culler_count++] = text;
        break;
    case KEY_KEYS: a->keys = text; break;
    case 'o': a->out = text; break;
    case KEY_PLUGIN:
        if (a->plugins.count < APP_PLUGINS_MOST) a->plugins.files[a->plugins.count++] = text;
        break;
    case KEY_VIEW:
        if (!parse_count(text, 0, UINT32_MAX - 1, &a->view)) argp_error(state, "--view takes a number from 0, not '%s'", text);
        break;
    case KEY_FRAMES:
        if (!parse_count(text, 1, 1000000, &a->frames)) argp_error(state, "--frames takes a number from 1 to 1,000,000, not '%s'", text);
        break;
    case KEY_FRAME_MS:
        if (!parse_ms(text, &a->frame_ms)) argp_error(state, "--frame-ms takes 0 to 100000 milliseconds, not '%s'", text);
        break;
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
        if (!a->scene) argp_error(state, "SCENE is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

// ---- Opening ----

// What C goes through: the cullers that were named, where several were, or else all that can stand first.
static result list_chains(explore *e, const arguments *q)
{
    uint32_t count = 0;
    app *a = e->a;
    result done = RESULT_OK;
    for (uint32_t i = 0; q->culler_count > 1 && i < q->culler_count && done == RESULT_OK; ++i)
        done = chain_parse(q->cullers[i], &a->texts, &a->report, &e->chains[e->chain_count++]);
    if (done != RESULT_OK || q->culler_count > 1) return done;
    done = loader_scan(a->plugins, &a->report);
    const loaded_plugin *plugins = loader_plugins(a->plugins, &count);
    for (uint32_t i = 0; i < count && done == RESULT_OK && e->chain_count < EXPLORE_CHAINS_MOST; ++i)
        if (plugins[i].plugin->select)
            done = chain_parse(plugins[i].plugin->descriptor->id, &a->texts, &a->report, &e->chains[e->chain_count++]);
    return done;
}

static result open_world(explore *e, const char *culler)
{
    const scene *s = e->a->scene;
    const chain_spec **chains = arena_push(&e->a->texts, s->zone_count, sizeof *chains);
    chain_spec *specs = arena_push(&e->a->texts, (size_t)s->zone_count + 1, sizeof *specs);
    if (!chains || !specs) return report_no_memory(&e->a->report, s->path);
    result done = chain_parse(culler, &e->a->texts, &e->a->report, &specs[s->zone_count]);
    for (uint32_t z = 0; z < s->zone_count && done == RESULT_OK; ++z) {
        chains[z] = s->zones[z].chain ? &specs[z] : &specs[s->zone_count];
        if (s->zones[z].chain) done = chain_parse(s->zones[z].chain, &e->a->texts, &e->a->report, &specs[z]);
    }
    e->own = chains;
    const world_request q = {.scene = s, .plugins = e->a->plugins, .services = &e->a->services, .chains = chains, .chain = &specs[s->zone_count]};
    if (done == RESULT_OK) done = world_open(&q, &e->a->report, &e->w);
    return done == RESULT_OK ? world_view_open(e->w, VIEWER_CHECK_BOUNDS, &e->a->report, &e->v) : done;
}

static result open_layout(explore *e)
{
    const scene *s = e->a->scene;
    size_t total = 0;
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        total += s->zones[z].item_count;
        e->order_count = s->zones[z].item_count > e->order_count ? s->zones[z].item_count : e->order_count;
    }
    uint32_t *orders = memory_alloc(e->a->memory, total, sizeof *orders);
    render_layout_zone *zones = memory_alloc(e->a->memory, s->zone_count, sizeof *zones);
    e->order = memory_alloc(e->a->memory, e->order_count, sizeof *e->order);
    e->zone_chain = memory_alloc_zeroed(e->a->memory, s->zone_count, sizeof *e->zone_chain);
    result done = orders && zones && e->order && e->zone_chain ? RESULT_OK : report_no_memory(&e->a->report, s->path);
    size_t at = 0;
    for (uint32_t z = 0; z < s->zone_count && done == RESULT_OK; ++z) {
        world_order(e->w, z, orders + at);
        zones[z] = (render_layout_zone){orders + at, s->zones[z].item_count};
        at += s->zones[z].item_count;
    }
    if (done == RESULT_OK) done = render_layout_open(e->g, zones, s->zone_count, &e->a->report, &e->layout);
    memory_free(e->a->memory, orders, total, sizeof *orders);
    memory_free(e->a->memory, zones, s->zone_count, sizeof *zones);
    return done == RESULT_OK ? explore_reserve(e) : done;
}

static void explore_close(explore *e)
{
    render_layout_close(e->layout);
    world_view_close(e->v);
    world_close(e->w);
    renderer_close(e->g);
    memory_free(e->a->memory, e->order, e->order_count, sizeof *e->order);
    if (e->zone_chain) memory_free(e->a->memory, e->zone_chain, e->a->scene->zone_count, sizeof *e->zone_chain);
    scissor_close(&e->rectangles);
    buffer_free(&e->lines);
    buffer_free(&e->faces);
}

static void set_doors(explore *e, doors_choice choice)
{
    const door_state *state = app_doors_of(&choice);
    for (uint32_t d = 0; state && d < e->a->scene->door_count; ++d) world_set_door(e->w, d, *state);
}

static result explore_open(explore *e, const arguments *q)
{
    const renderer_options o = {.target = RENDERER_WINDOW, .width_px = q->size.width_px, .height_px = q->size.height_px, .title = "Portcullis"};
    result done = list_chains(e, q);
    if (done == RESULT_OK) done = open_world(e, q->culler_count ? q->cullers[0] : "frustum");
    if (done == RESULT_OK) set_doors(e, q->doors);
    if (done == RESULT_OK) done = renderer_open(&o, e->a->memory, &e->a->report, &e->g);
    if (done == RESULT_OK) done = renderer_upload(e->g, e->a->scene, &e->a->report);
    if (done == RESULT_OK && scissor_open(e->a->scene, e->a->memory, &e->rectangles) != RESULT_OK) done = report_no_memory(&e->a->report, NULL);
    return done == RESULT_OK ? open_layout(e) : done;
}

// ---- Running ----

static result take_picture(explore *e, const char *file)
{
    const size_t bytes = (size_t)e->width_px * e->height_px * 4;
    uint8_t *rgba = memory_alloc(e->a->memory, bytes, 1);
    result done = rgba ? renderer_read(e->g, rgba, &e->a->report) : report_no_memory(&e->a->report, NULL);
    if (done == RESULT_OK) done = png_write(file, rgba, e->width_px, e->height_px, &e->a->report);
    memory_free(e->a->memory, rgba, bytes, 1);
    if (done == RESULT_OK) snprintf(e->message, sizeof e->message, "written to %.200s", file);
    e->wants_picture = 0;
    return done;
}

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static result run(explore *e, const arguments *q)
{
    const size_t script = q->keys ? strlen(q->keys) : 0;
    const uint32_t most = q->frames ? q->frames : (uint32_t)script;
    double last = now_s();
    for (uint32_t frame = 0; !e->is_over && renderer_window_is_open(e->g) && (!most || frame < most); ++frame) {
        const double now = now_s(), passed = most ? SCRIPT_STEP_S : now - last < STEP_MOST_S ? now - last : STEP_MOST_S;
        const char key = frame < script ? q->keys[frame] : '.';
        last = now;
        explore_poll(e, passed);
        explore_move(e, key, passed);
        explore_press(e, key);
        if (e->failure != RESULT_OK) return e->failure;
        if (!e->time_stands) e->time_s += passed;
        const result drawn = explore_draw(e);
        if (drawn != RESULT_OK) return drawn;
        if (frame == 0 && renderer_errors(e->g)) break; // such a picture is none
        if (e->wants_picture) take_picture(e, q->out);
        renderer_present(e->g);
    }
    const result checked = app_check_gl(e->a, e->g);
    return checked == RESULT_OK && most ? take_picture(e, q->out) : checked;
}

int command_view(int argc, char **argv)
{
    static const struct argp parser = {options, parse, "SCENE", "Flies through a scene in a window. H tells the keys.", NULL, NULL, NULL};
    arguments q = {.views = "auto:1", .out = "portcullis.png", .size = {1280, 720}, .doors = DOORS_OF_SCENE};
    if (argp_parse(&parser, argc, argv, 0, NULL, &q) != 0) return EXIT_USAGE;
    app a;
    camera_path path = {0};
    const import_options import = {.doors = app_doors_import(q.doors)};
    result done = app_open(&a, &q.plugins);
    if (done == RESULT_OK) done = chains_check(&a, q.cullers, q.culler_count, &(zone_options){0});
    if (done == RESULT_OK) done = import_scene(q.scene, &import, a.memory, &a.report, &a.scene);
    if (done == RESULT_OK) done = camera_path_load(q.views, a.scene, (double)q.size.width_px / q.size.height_px, a.memory, &a.report, &path);
    if (done == RESULT_OK && q.view >= path.count)
        done = report_error(&a.report, NULL, 0, "--view %u: the path has %u views, counted from 0", q.view, path.count);
    if (done == RESULT_OK) {
        explore e = {.a = &a,
                     .fly = path.cameras[q.view],
                     .speed_m_s = 3,
                     .frame_ms = q.frame_ms,
                     .width_px = q.size.width_px,
                     .height_px = q.size.height_px,
                     .shows_help = !q.keys && !q.frames};
        e.lines = buffer_make(a.memory, sizeof(overlay_vertex));
        e.faces = buffer_make(a.memory, sizeof(overlay_vertex));
        done = explore_open(&e, &q);
        if (done == RESULT_OK) done = run(&e, &q);
        explore_close(&e);
    }
    camera_path_free(&path, a.memory);
    app_close(&a);
    return app_exit_code(done);
}
