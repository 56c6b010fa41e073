// A host for tests of occlusion: see fake_host.h.
// SPDX-License-Identifier: MIT
#include "fake_host.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double FAR = 1e300, ASPECT = 16.0 / 9, TANGENT = 0.6, NEAR_M = 0.1;

static void *must_alloc(size_t size)
{
    void *memory = calloc(1, size + 64);
    if (!memory) abort();
    return memory;
}

// ---- Views ----

static cull_plane side_plane(const cull_view *view, const double normal[3])
{
    const cull_guard guard = {{view->eye_exact[0], view->eye_exact[1], view->eye_exact[2]}, {view->forward[0], view->forward[1], view->forward[2]},
                              view->pixel_tangent, view->reach, 1e4};
    double unit[3];
    const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int i = 0; i < 3; i++) unit[i] = normal[i] / length;
    return cull_guard_plane(&guard, unit, 0);
}

void fake_view_make(fake_view *v, cull_vec3 eye, double yaw, double pitch)
{
    const double f[3] = {sin(yaw) * cos(pitch), sin(pitch), cos(yaw) * cos(pitch)};
    const double right[3] = {-cos(yaw), 0, sin(yaw)};
    const double up[3] = {-sin(pitch) * sin(yaw), cos(pitch), -sin(pitch) * cos(yaw)};
    const double e[3] = {(double)eye.x, (double)eye.y, (double)eye.z}, wide = TANGENT * ASPECT;
    memset(v, 0, sizeof *v);
    cull_view *view = &v->view;
    const double rows[4][3] = {{right[0] / wide, right[1] / wide, right[2] / wide}, {up[0] / TANGENT, up[1] / TANGENT, up[2] / TANGENT}, {0, 0, 0}, {f[0], f[1], f[2]}};
    for (int r = 0; r < 4; r++) {
        for (int k = 0; k < 3; k++) view->clip_from_zone[4 * k + r] = (float)rows[r][k];
        view->clip_from_zone[12 + r] = r == 2 ? (float)NEAR_M : (float)-(rows[r][0] * e[0] + rows[r][1] * e[1] + rows[r][2] * e[2]);
    }
    for (int k = 0; k < 3; k++) {
        view->eye_exact[k] = e[k];
        view->forward[k] = f[k];
        view->eye[k] = (float)e[k];
    }
    view->eye_exact[3] = 1;
    view->eye[3] = 1;
    view->width_px = FAKE_WIDTH;
    view->height_px = FAKE_HEIGHT;
    view->pixel_tangent = 2 * TANGENT / FAKE_HEIGHT;
    view->reach = sqrt(1 + wide * wide + TANGENT * TANGENT);
    view->near_distance = (float)NEAR_M;
    view->pixels_per_tangent = (float)(1 / view->pixel_tangent);
    view->purpose = CULL_VIEW_MAIN;
    for (int side = 0; side < 4; side++) {
        const double sign = side % 2 ? -1 : 1, by = side < 2 ? wide : TANGENT, *across = side < 2 ? right : up;
        const double normal[3] = {f[0] * by + sign * across[0], f[1] * by + sign * across[1], f[2] * by + sign * across[2]};
        v->planes[0][side] = side_plane(view, normal);
    }
    v->volumes[0] = (cull_volume){v->planes[0], 4, 0};
    v->volume_count = 1;
    for (int p = 0; p < FAKE_PIXELS; p++) {
        const double x = ((p % FAKE_WIDTH + 0.5) / FAKE_WIDTH * 2 - 1) * wide, y = ((p / FAKE_WIDTH + 0.5) / FAKE_HEIGHT * 2 - 1) * TANGENT;
        for (int k = 0; k < 3; k++) v->rays[p][k] = f[k] + x * right[k] + y * up[k];
    }
}

void fake_view_halve(fake_view *v)
{
    const double yaw_right[3] = {-v->view.forward[2], 0, v->view.forward[0]}, left[3] = {-yaw_right[0], 0, -yaw_right[2]};
    memcpy(v->planes[1], v->planes[0], sizeof v->planes[0]);
    v->planes[0][4] = side_plane(&v->view, yaw_right);
    v->planes[1][4] = side_plane(&v->view, left);
    v->volumes[0] = (cull_volume){v->planes[0], 5, 0};
    v->volumes[1] = (cull_volume){v->planes[1], 5, 0};
    v->volume_count = 2;
}

// ---- Rays ----

// Where the ray enters the box, in steps of the view's forward; FAR: it misses. Within the box: 0.
static double enter_box(const cull_view *view, const double ray[3], cull_box box, double *leaves)
{
    const double low[3] = {(double)box.min.x, (double)box.min.y, (double)box.min.z}, high[3] = {(double)box.max.x, (double)box.max.y, (double)box.max.z};
    double from = 0, to = FAR;
    for (int k = 0; k < 3; k++) {
        const double e = view->eye_exact[k];
        if (ray[k] == 0) {
            if (e < low[k] || e > high[k]) return FAR;
            continue;
        }
        const double a = (low[k] - e) / ray[k], b = (high[k] - e) / ray[k];
        from = fmax(from, fmin(a, b));
        to = fmin(to, fmax(a, b));
    }
    *leaves = to;
    return from <= to ? from : FAR;
}

// What is drawn of a box: its surface; from within, its far side.
static double enter_surface(const cull_view *view, const double ray[3], cull_box box)
{
    double leaves;
    const double in = enter_box(view, ray, box, &leaves);
    return in >= NEAR_M ? in : leaves >= NEAR_M ? leaves : FAR;
}

static cull_box box_of(const fake_viewer *v, uint32_t i)
{
    const cull_zone *zone = &v->c->zone->zone;
    return i < zone->item_count ? cull_box_at(&zone->boxes, i) : v->movers[i - zone->item_count].box;
}

static void draw(fake_viewer *v, const fake_view *view, uint32_t i)
{
    const cull_box box = box_of(v, i);
    for (int p = 0; p < FAKE_PIXELS; p++) v->depth[p] = fmin(v->depth[p], enter_surface(&view->view, view->rays[p], box));
}

static uint32_t count_pixels(const fake_viewer *v, const fake_view *view, cull_box box)
{
    uint32_t pixels = 0;
    for (int p = 0; p < FAKE_PIXELS; p++) {
        double leaves;
        const double in = enter_box(&view->view, view->rays[p], box, &leaves);
        pixels += in < FAR && in <= v->depth[p] * (1 + 1e-6);
    }
    return pixels;
}

void fake_truth(const fake_viewer *v, const fake_view *view, uint8_t *visible)
{
    const uint32_t items = v->c->zone->zone.item_count, all = items + v->mover_count;
    memset(visible, 0, all);
    for (int p = 0; p < FAKE_PIXELS; p++) {
        double nearest = FAR;
        uint32_t owner = UINT32_MAX;
        for (uint32_t i = 0; i < all; i++) {
            const double in = i < items && !v->allowed[i] ? FAR : enter_surface(&view->view, view->rays[p], box_of(v, i));
            if (in >= nearest) continue;
            nearest = in;
            owner = i;
        }
        if (owner != UINT32_MAX) visible[owner] = 1;
    }
}

// ---- Cullers ----

// A root over leaves of eight items, as they come; boxes twice as large as need be.
static void lend(fake_culler *c)
{
    const cull_zone *zone = &c->zone->zone;
    const uint32_t leaves = (zone->item_count + 7) / 8;
    c->nodes = must_alloc((leaves + 1) * sizeof *c->nodes);
    c->nodes[0] = (cull_node){.box = zone->box, .first_child = 1, .child_count = leaves, .subtree = {0, zone->item_count}};
    for (uint32_t n = 0; n < leaves; n++) {
        const uint32_t left = zone->item_count - n * 8, count = left < 8 ? left : 8;
        cull_box box = cull_box_none();
        for (uint32_t i = 0; i < count; i++) box = cull_box_union(box, cull_box_at(&zone->boxes, n * 8 + i));
        c->nodes[n + 1] = (cull_node){.box = box, .first_item = n * 8, .item_count = count, .subtree = {n * 8, count}};
    }
    c->lent = (cull_hierarchy){.nodes = c->nodes, .node_count = leaves + 1, .depth = 2};
}

// "chc batch=off": the method, then other options; what is not named has its fallback.
static void options_fill(const cull_descriptor *d, const char *method, char words[64], const char *values[16])
{
    if (d->option_count > 16 || strlen(method) >= 64) abort();
    for (uint32_t i = 0; i < d->option_count; i++) values[i] = d->options[i].fallback;
    strcpy(words, method);
    values[0] = words;
    for (char *at = strchr(words, ' '); at; at = strchr(at, ' ')) {
        *at++ = 0;
        char *const value = strchr(at, '=');
        if (!value) abort();
        for (uint32_t i = 0; i < d->option_count; i++)
            if (strlen(d->options[i].key) == (size_t)(value - at) && memcmp(d->options[i].key, at, (size_t)(value - at)) == 0) values[i] = value + 1;
        at = value;
    }
}

cull_result fake_culler_open(fake_culler *c, const hand_zone *zone, const char *method, fake_chain chain, uint64_t fail_at)
{
    memset(c, 0, sizeof *c);
    c->plugin = plugin_named("occlusion");
    if (!c->plugin) abort();
    c->zone = zone;
    c->chain = chain;
    culler_host_init(&c->host, fail_at);
    char words[64];
    const char *values[16];
    options_fill(c->plugin->descriptor, method, words, values);
    cull_result result = c->plugin->create(&c->host.host, values, &c->culler);
    if (result != CULL_OK) return result;
    if (chain == CHAIN_LENT) lend(c);
    result = c->plugin->build(c->culler, &zone->zone, chain == CHAIN_LENT ? &c->lent : NULL, &c->built);
    if (result != CULL_OK) fake_culler_close(c);
    return result;
}

void fake_culler_close(fake_culler *c)
{
    c->plugin->destroy(c->culler);
    free(c->nodes);
    c->nodes = NULL;
    c->culler = NULL;
}

void fake_viewer_open(fake_viewer *v, fake_culler *c)
{
    const uint32_t all = c->zone->zone.item_count + FAKE_MOVERS_MOST;
    memset(v, 0, sizeof *v);
    v->c = c;
    if (c->plugin->open(c->culler, &v->query) != CULL_OK) abort();
    v->runs = must_alloc((c->built.max_runs + FAKE_MOVERS_MOST) * sizeof *v->runs);
    v->tests = must_alloc(c->built.max_tests * sizeof *v->tests);
    v->answers = must_alloc((c->built.max_tests * 2 + 1) * sizeof *v->answers);
    v->late = must_alloc(c->built.max_tests * 8 * sizeof *v->late);
    v->drawn = must_alloc(all);
    v->allowed = must_alloc(all);
    v->scratch = aligned_alloc(64, (c->built.scratch_size / 64 + 1) * 64);
    if (!v->scratch) abort();
    memset(v->allowed, 1, all);
    v->random = 7;
}

void fake_viewer_close(fake_viewer *v)
{
    v->c->plugin->close(v->query);
    free(v->runs);
    free(v->tests);
    free(v->answers);
    free(v->late);
    free(v->drawn);
    free(v->allowed);
    free(v->scratch);
}

// ---- Frames ----

typedef struct fake_step { cull_visit visit; cull_batch batch; uint32_t runs_before; } fake_step;

static uint32_t list_candidates(const fake_viewer *v, cull_run *out)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < v->c->zone->zone.item_count; i++)
        if (v->allowed[i]) out[count++] = (cull_run){i, 1};
    return count;
}

static const char *take_runs(fake_viewer *v, const fake_view *view, const fake_step *s)
{
    const uint32_t items = v->c->zone->zone.item_count;
    if (s->batch.run_count > v->c->built.max_runs + v->mover_count) return "more runs than told";
    for (uint32_t r = s->runs_before; r < s->batch.run_count; r++) {
        const cull_run run = s->batch.runs[r];
        if (run.count == 0) return "an empty run";
        for (uint32_t place = run.first; place < run.first + run.count; place++) {
            if (place >= items + v->mover_count) return "an item that is not there";
            const uint32_t item = v->c->chain == CHAIN_SELECT && place < items ? v->c->built.order[place] : place;
            if (v->drawn[item]) return "an item twice";
            if (item < items && !v->allowed[item]) return "an item that was no candidate";
            v->drawn[item] = 1;
            v->drawn_count++;
            draw(v, view, item);
        }
    }
    return NULL;
}

static void answer(fake_viewer *v, const fake_view *view, const fake_step *s, cull_progress progress, uint32_t *count)
{
    *count = 0;
    for (uint32_t i = 0; i < s->batch.test_count; i++) {
        const cull_answer a = {s->batch.tests[i].tag, count_pixels(v, view, s->batch.tests[i].box), 0};
        const int is_lost = v->how == ANSWERS_NONE || (v->how == ANSWERS_SOME_LOST && random_below(&v->random, 3) == 0);
        if (is_lost) continue;
        const int is_late = progress == CULL_DONE || (progress == CULL_MORE && v->late_steps);
        const uint32_t frame = progress == CULL_DONE ? v->frame + 1 + v->late_frames : v->frame, clock = progress == CULL_DONE ? 0 : v->clock + v->late_steps;
        if (!is_late) v->answers[(*count)++] = a;
        else if (v->late_count < v->c->built.max_tests * 8) v->late[v->late_count++] = (fake_late){a, v->frame, frame, clock};
    }
    for (uint32_t i = 0; v->how == ANSWERS_SHUFFLED && i < *count; i++) {
        const uint32_t other = random_below(&v->random, *count);
        const cull_answer swapped = v->answers[i];
        v->answers[i] = v->answers[other];
        v->answers[other] = swapped;
    }
}

static void hear_late(fake_viewer *v, cull_progress progress, uint32_t *count)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < v->late_count; i++) {
        const int is_ready = v->late[i].ready_frame <= v->frame && (v->late[i].ready_clock < v->clock || progress == CULL_WAIT);
        if (!is_ready || *count == v->c->built.max_tests * 2 + 1) {
            v->late[kept++] = v->late[i];
            continue;
        }
        cull_answer a = v->late[i].answer;
        a.age = v->frame - v->late[i].asked_frame;
        v->answers[(*count)++] = a;
    }
    v->late_count = kept;
}

const char *fake_frame_cut(fake_viewer *v, const fake_view *view, uint32_t flags, uint32_t steps_most)
{
    const fake_culler *c = v->c;
    const uint32_t items = c->zone->zone.item_count;
    cull_run *candidates = must_alloc(items * sizeof *candidates);
    cull_view told = view->view;
    fake_step s = {.visit = {.view = &told, .volumes = view->volumes, .volume_count = view->volume_count, .scratch = v->scratch,
                             .movers = v->movers, .mover_count = v->mover_count, .answers = v->answers, .clipped = v->clipped, .clipped_count = v->clipped_count,
                             .pictures = v->pictures, .picture_count = v->picture_count, .captures = v->captures, .capture_count = v->capture_count},
                   .batch = {.runs = v->runs, .tests = v->tests, .keep_pictures = v->keep_pictures, .keep_captures = v->keep_captures,
                             .keep_clipped = v->keep_clipped}};
    cull_progress progress = CULL_MORE;
    const char *fault = NULL;
    told.frame = ++v->frame;
    told.flags = flags;
    if (c->chain == CHAIN_CANDIDATES) {
        s.visit.candidates = candidates;
        s.visit.candidate_count = list_candidates(v, candidates);
    }
    memset(v->drawn, 0, items + FAKE_MOVERS_MOST);
    memset(v->keep_pictures, 1, sizeof v->keep_pictures);
    memset(v->keep_captures, 1, sizeof v->keep_captures);
    memset(v->keep_clipped, 1, sizeof v->keep_clipped);
    for (int p = 0; p < FAKE_PIXELS; p++) v->depth[p] = FAR;
    v->tests_asked = v->steps = v->drawn_count = v->waits = 0;
    hear_late(v, CULL_DONE, &s.visit.answer_count);
    while (progress != CULL_DONE && !fault && v->steps < steps_most) {
        s.visit.step = v->steps++;
        s.runs_before = s.batch.run_count;
        s.batch.test_count = 0;
        memset(v->scratch, 0xAA, c->built.scratch_size);
        progress = c->chain == CHAIN_SELECT ? c->plugin->select(v->query, &s.visit, &s.batch) : c->plugin->filter(v->query, &s.visit, &s.batch);
        v->tests_asked += s.batch.test_count;
        v->waits += progress == CULL_WAIT;
        v->clock++;
        fault = take_runs(v, view, &s);
        if (s.batch.test_count > c->built.max_tests) fault = "more tests than told";
        if (progress != CULL_DONE && v->steps >= c->built.max_steps) fault = "more steps than told";
        answer(v, view, &s, progress, &s.visit.answer_count);
        if (progress != CULL_DONE) hear_late(v, progress, &s.visit.answer_count);
    }
    free(candidates);
    return fault;
}

const char *fake_frame(fake_viewer *v, const fake_view *view, uint32_t flags)
{
    return fake_frame_cut(v, view, flags, UINT32_MAX);
}
