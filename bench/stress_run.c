// Stress: each changed scene once, each strategy over the path in it.
// SPDX-License-Identifier: MIT
// Invariant: what the host refuses is no failure of a culler, and ends neither the family nor the run; no memory and no OpenGL do.
#include "progress.h"
#include "strategy.h"
#include "stress_parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct look { // what one strategy did, view by view
    uint32_t *owners;        // views * pixels: item of the request's scene + 1, 0: nothing
    uint32_t *drawn, *zones; // views * words: bits of the request's scene
} look;

typedef struct stand { // a changed scene and its path
    const scene *s;
    const camera_path *path;
} stand;

typedef struct run {
    const stress_request *q;
    const bench_request *bench;
    const allocator *memory;
    report *r;
    renderer *g;
    look *homes, now; // homes: by strategy
    uint32_t item_words, zone_words;
    char *refused; // where the report below writes; NULL: nowhere
    report quiet;
    progress bar;
} run;

// The host's own words, without the file's name.
static void keep_line(void *user, report_level level, const char *text)
{
    run *b = user;
    static const char mark[] = "error: ";
    const char *what = strstr(text, mark);
    if (level == REPORT_ERROR && b->refused && !*b->refused) snprintf(b->refused, STRESS_REFUSED_BYTES, "%s", what ? what + sizeof mark - 1 : text);
}

static size_t pixels_of(const run *b)
{
    return (size_t)b->bench->width_px * b->bench->height_px;
}

static int open_look(const run *b, look *out)
{
    const size_t views = b->bench->path->count;
    out->owners = memory_alloc(b->memory, views * pixels_of(b), sizeof(uint32_t));
    out->drawn = memory_alloc(b->memory, views * b->item_words, sizeof(uint32_t));
    out->zones = memory_alloc(b->memory, views * b->zone_words, sizeof(uint32_t));
    return out->owners && out->drawn && out->zones;
}

static void close_look(const run *b, look *l)
{
    const size_t views = b->bench->path->count;
    memory_free(b->memory, l->owners, views * pixels_of(b), sizeof(uint32_t));
    memory_free(b->memory, l->drawn, views * b->item_words, sizeof(uint32_t));
    memory_free(b->memory, l->zones, views * b->zone_words, sizeof(uint32_t));
}

// ---- One view ----

static void set_bit(uint32_t *bits, uint32_t i)
{
    bits[i / 32] |= 1u << (i % 32);
}

static void note_owners(const run *b, const stand *at, const truth *t, uint32_t *owners)
{
    for (size_t i = 0; i < pixels_of(b); ++i) {
        const uint32_t triangle = t->picture.triangles[i];
        const int is_owned = triangle && triangle <= t->triangle_count;
        owners[i] = is_owned ? scene_rebuilt_from(b->bench->scene, at->s, t->polygon_item[t->triangle_polygon[triangle - 1]]) + 1 : 0;
    }
}

static uint64_t note_drawn(const run *b, const stand *at, const strategy *s, uint32_t *drawn)
{
    uint64_t count = 0;
    memset(drawn, 0, b->item_words * sizeof *drawn);
    for (uint32_t i = 0; i < at->s->item_count + at->s->mover_count; ++i) {
        if (!(s->drawn_bits[i / 32] >> (i % 32) & 1)) continue;
        set_bit(drawn, scene_rebuilt_from(b->bench->scene, at->s, i));
        count++;
    }
    return count;
}

static void note_zones(const run *b, const strategy *s, uint32_t *zones)
{
    const flow_result *flow = world_view_flow(s->view);
    memset(zones, 0, b->zone_words * sizeof *zones);
    for (uint32_t i = 0; i < flow->zone_count; ++i) set_bit(zones, flow->zones[i].zone);
}

static result look_at(run *b, const stand *at, strategy *s, truth *t, uint32_t v, stress_point *p)
{
    strategy_view out;
    const strategy_request request = {.view = v, .mode = RENDER_SHADED, .marks = MARK_DRAWN};
    result done = strategy_run_view(s, &request, b->r, &out);
    if (done == RESULT_OK) done = strategy_judge(s, v, b->r, t);
    if (done == RESULT_OK) done = truth_add_view(t, b->g, &at->path->cameras[v], b->r);
    if (done != RESULT_OK) return done;
    const view_misses m = strategy_misses(s, t, v);
    p->missed_pixels += m.pixels;
    p->missed_items += m.items;
    p->broken_items += m.broken;
    p->polygons_drawn += (double)strategy_count(s, &out.set).polygons / at->path->count;
    p->pixels += pixels_of(b);
    note_owners(b, at, t, b->now.owners + v * pixels_of(b));
    p->items_drawn += note_drawn(b, at, s, b->now.drawn + (size_t)v * b->item_words);
    note_zones(b, s, b->now.zones + (size_t)v * b->zone_words);
    return RESULT_OK;
}

// ---- One strategy in one scene ----

static result walk(run *b, const stand *at, const bench_strategy_request *chains, stress_point *p)
{
    strategy s = {0};
    truth t = {0};
    bench_request bench = *b->bench;
    bench.scene = at->s;
    bench.path = at->path;
    bench.strategies = chains;
    bench.strategy_count = bench.repeat = 1;
    bench.costs = BENCH_COSTS_FIXED; // measured ones would let what is drawn differ from run to run
    result done = strategy_open(&bench, chains, b->g, &b->quiet, &s);
    if (done == RESULT_OK) {
        renderer_query_latency(b->g, bench.query_latency);
        done = renderer_reserve(b->g, strategy_tests(&s), b->r);
    }
    const truth_request request = {at->s, bench.width_px, bench.height_px, s.walls};
    if (done == RESULT_OK) done = truth_open(&request, b->memory, b->r, &t);
    for (uint32_t v = 0; v < at->path->count && done == RESULT_OK; ++v) done = look_at(b, at, &s, &t, v, p);
    truth_close(&t);
    strategy_close(&s);
    renderer_forget_tests(b->g);
    renderer_forget_pictures(b->g);
    return done;
}

static uint64_t count_bits(const uint32_t *a, const uint32_t *b, size_t words)
{
    uint64_t count = 0;
    for (size_t i = 0; i < words; ++i) count += (uint64_t)__builtin_popcount(a[i] ^ b[i]);
    return count;
}

static void compare(const run *b, const look *home, stress_point *p)
{
    const size_t views = b->bench->path->count;
    for (size_t i = 0; i < views * pixels_of(b); ++i) p->pixels_differ += home->owners[i] != b->now.owners[i];
    p->drawn_differ = count_bits(home->drawn, b->now.drawn, views * b->item_words);
    p->zones_differ = count_bits(home->zones, b->now.zones, views * b->zone_words);
}

// ---- One magnitude ----

static result make_path(const run *b, const stress_family *f, double magnitude, const scene_change *c, camera_path *out, char *refused)
{
    *out = *b->bench->path;
    out->cameras = memory_alloc(b->memory, out->count, sizeof *out->cameras);
    if (!out->cameras) return report_no_memory(b->r, NULL);
    for (uint32_t v = 0; v < out->count; ++v) {
        out->cameras[v] = f ? stress_camera(f, magnitude, c, &b->bench->path->cameras[v]) : b->bench->path->cameras[v];
        const char *fault = camera_fault(&out->cameras[v]);
        if (fault && !*refused) snprintf(refused, STRESS_REFUSED_BYTES, "%s", fault);
    }
    return RESULT_OK;
}

// RESULT_OK and a text in `refused`: the host does not take it.
static result make_scene(run *b, const scene_change *c, scene **out, char *refused)
{
    b->refused = refused;
    const result done = scene_rebuild(b->bench->scene, c, b->memory, &b->quiet, out);
    b->refused = NULL;
    if (done == RESULT_NO_MEMORY) return report_no_memory(b->r, b->bench->scene->path);
    if (done == RESULT_OK && (*out)->zone_count != b->bench->scene->zone_count)
        snprintf(refused, STRESS_REFUSED_BYTES, "it has %u zones, not %u", (*out)->zone_count, b->bench->scene->zone_count);
    return RESULT_OK;
}

static stress_point *point_at(const stress_result *s, const stress_request *q, uint32_t k, uint32_t family, uint32_t magnitude)
{
    return &s->series[k * q->family_count + family].points[magnitude];
}

// Of all strategies; family and magnitude say where it goes.
typedef struct step { uint32_t family, magnitude; } step;

static result walk_all(run *b, const stand *at, const step *where, const stress_result *out)
{
    const stress_family *f = b->q->families[where->family];
    result done = renderer_upload(b->g, at->s, b->r);
    for (uint32_t k = 0; k < b->bench->strategy_count && done == RESULT_OK; ++k) {
        stress_point *p = point_at(out, b->q, k, where->family, where->magnitude);
        b->refused = p->refused;
        progress_tell(&b->bar, f->name);
        done = walk(b, at, &b->bench->strategies[k], p);
        b->refused = NULL;
        if (done == RESULT_BAD_INPUT && p->refused[0]) done = RESULT_OK;
        else if (done == RESULT_OK && f->compare == STRESS_SAME) compare(b, &b->homes[k], p);
    }
    return done;
}

static result run_step(run *b, const step *where, const stress_result *out)
{
    const stress_family *f = b->q->families[where->family];
    const double magnitude = f->magnitudes[where->magnitude];
    const scene_change c = stress_change(f, magnitude, b->bench->scene, b->q->seed);
    char refused[STRESS_REFUSED_BYTES] = "";
    scene *s = NULL;
    camera_path path;
    result done = make_path(b, f, magnitude, &c, &path, refused);
    if (done == RESULT_OK && !refused[0]) done = make_scene(b, &c, &s, refused);
    for (uint32_t k = 0; k < b->bench->strategy_count; ++k) {
        stress_point *p = point_at(out, b->q, k, where->family, where->magnitude);
        p->magnitude = magnitude;
        memcpy(p->refused, refused, sizeof refused);
        if (refused[0]) progress_tell(&b->bar, f->name);
    }
    if (done == RESULT_OK && !refused[0]) done = walk_all(b, &(stand){s, &path}, where, out);
    memory_free(b->memory, path.cameras, path.count, sizeof *path.cameras);
    scene_free(s, b->memory);
    return done;
}

// The scene as it is, made anew like all others: what they are compared with.
static result run_home(run *b, const stress_result *out)
{
    const scene_change c = stress_home();
    char refused[STRESS_REFUSED_BYTES] = "";
    scene *s = NULL;
    result done = make_scene(b, &c, &s, refused);
    if (done == RESULT_OK && refused[0]) done = report_error(b->r, b->bench->scene->path, 0, "cannot be made anew: %s", refused);
    if (done == RESULT_OK) done = renderer_upload(b->g, s, b->r);
    for (uint32_t k = 0; k < b->bench->strategy_count && done == RESULT_OK; ++k) {
        stress_point p = {0};
        b->refused = refused;
        progress_tell(&b->bar, "home");
        done = walk(b, &(stand){s, b->bench->path}, &b->bench->strategies[k], &p);
        b->refused = NULL;
        if (done == RESULT_BAD_INPUT && refused[0]) report_error(b->r, b->bench->scene->path, 0, "%s: %s", b->bench->strategies[k].name, refused);
        const look now = b->now;
        b->now = b->homes[k];
        b->homes[k] = now;
        for (uint32_t f = 0; f < b->q->family_count; ++f) out->series[k * b->q->family_count + f].home = p;
    }
    scene_free(s, b->memory);
    return done;
}

// ---- All ----

static uint64_t steps_of(const stress_request *q)
{
    uint64_t steps = 1;
    for (uint32_t f = 0; f < q->family_count; ++f) steps += q->families[f]->magnitude_count;
    return steps * q->bench->strategy_count;
}

static result run_all(run *b, const stress_result *out)
{
    const bench_request *bench = b->bench;
    const renderer_options of_gl = {.target = RENDERER_HEADLESS, .width_px = bench->width_px, .height_px = bench->height_px};
    int opened = open_look(b, &b->now);
    for (uint32_t k = 0; k < bench->strategy_count; ++k) opened &= open_look(b, &b->homes[k]);
    if (!opened) return report_no_memory(b->r, NULL);
    result done = renderer_open(&of_gl, b->memory, b->r, &b->g);
    b->bar = progress_start(steps_of(b->q));
    if (done == RESULT_OK) done = run_home(b, out);
    for (uint32_t f = 0; f < b->q->family_count; ++f)
        for (uint32_t m = 0; m < b->q->families[f]->magnitude_count && done == RESULT_OK; ++m) done = run_step(b, &(step){f, m}, out);
    progress_end(&b->bar);
    if (done == RESULT_OK && renderer_errors(b->g)) {
        report_error(b->r, NULL, 0, "%u OpenGL errors, told above; what was drawn is not to be trusted: try another driver", renderer_errors(b->g));
        done = RESULT_NO_GL;
    }
    renderer_close(b->g);
    return done;
}

static int open_result(const stress_request *q, const allocator *memory, stress_result *out)
{
    *out = (stress_result){.memory = memory, .series_count = q->bench->strategy_count * q->family_count};
    out->series = memory_alloc_zeroed(memory, out->series_count, sizeof *out->series);
    int opened = out->series != NULL;
    for (uint32_t i = 0; opened && i < out->series_count; ++i) {
        stress_series *s = &out->series[i];
        s->strategy = i / q->family_count;
        s->family = q->families[i % q->family_count];
        s->points = memory_alloc_zeroed(memory, s->family->magnitude_count, sizeof *s->points);
        opened = s->points != NULL;
    }
    return opened;
}

result stress_run(const stress_request *q, report *r, stress_result *out)
{
    const bench_request *bench = q->bench;
    run b = {.q = q, .bench = bench, .memory = bench->services->memory, .r = r};
    b.quiet = (report){.line = keep_line, .user = &b};
    b.item_words = (bench->scene->item_count + bench->scene->mover_count + 31) / 32;
    b.zone_words = (bench->scene->zone_count + 31) / 32;
    b.homes = memory_alloc_zeroed(b.memory, bench->strategy_count, sizeof *b.homes);
    result done = open_result(q, b.memory, out) && b.homes ? run_all(&b, out) : report_no_memory(r, NULL);
    for (uint32_t k = 0; b.homes && k < bench->strategy_count; ++k) close_look(&b, &b.homes[k]);
    close_look(&b, &b.now);
    memory_free(b.memory, b.homes, bench->strategy_count, sizeof *b.homes);
    if (done != RESULT_OK) stress_result_free(out);
    return done;
}

void stress_result_free(stress_result *s)
{
    for (uint32_t i = 0; s->series && i < s->series_count; ++i)
        if (s->series[i].points) memory_free(s->memory, s->series[i].points, s->series[i].family->magnitude_count, sizeof *s->series[i].points);
    memory_free(s->memory, s->series, s->series_count, sizeof *s->series);
    *s = (stress_result){0};
}

// ---- What it says ----

static void note_first(double *first, double magnitude, int happens)
{
    if (happens && isnan(*first)) *first = magnitude;
}

stress_firsts stress_first(const stress_series *s)
{
    stress_firsts f = {NAN, NAN, NAN, NAN, NAN};
    for (uint32_t i = 0; i < s->family->magnitude_count; ++i) {
        const stress_point *p = &s->points[i];
        note_first(&f.refused, p->magnitude, p->refused[0] != 0);
        note_first(&f.missed, p->magnitude, p->missed_pixels || p->missed_items);
        note_first(&f.pictures, p->magnitude, (double)p->pixels_differ > STRESS_PICTURES_MOST * (double)p->pixels);
        note_first(&f.drawn, p->magnitude, p->drawn_differ != 0);
        note_first(&f.zones, p->magnitude, p->zones_differ != 0);
    }
    return f;
}

uint32_t stress_failed(const stress_result *s)
{
    uint32_t failed = 0;
    for (uint32_t i = 0; i < s->series_count; ++i) {
        uint64_t broken = s->series[i].home.broken_items;
        for (uint32_t m = 0; m < s->series[i].family->magnitude_count; ++m) broken += s->series[i].points[m].broken_items;
        failed += broken != 0;
    }
    return failed;
}
