// compare_compiled RAW.map COMPILED.pcs AUTO RANDOM [PREFIX]: what was compiled shows what the raw brushes show. AUTO
// automatic views of the raw map and RANDOM points in its air, each looking somewhere, at 640x360, twice: without liquids and,
// where it has any, with liquids as walls. At most 0.01% of pixels have another material where depths don't agree to 2^-20. With PREFIX the
// worst views go to PREFIX0.png ...: raw, compiled, and white where bad. Exit code 0: so; 1: not; 2: broken; 77: no OpenGL.
// SPDX-License-Identifier: MIT
#include "air_points.h"
#include "holes.h"
#include "pictures.h"

#include "host/import/import.h"
#include "host/import/views_random.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RAW, COMPILED, FILLED, SCENES };
enum { BATCH = 16, CHECKED_EVERY = 16, WORST = 6, KINDS_MOST = 4096, KINDS_TOLD = 12, NO_GL = 77 };
static const double NEAR_M = 1.0 / 256, CLEARANCE_M = 1.0 / 128, FOVY_DEG = 90; // the near plane's corner is 0.009 m off at 16:9
static const char *const liquid_ways[2] = {"left out", "as walls"};
static const uint64_t SEED = 0x7069637475726573;

typedef struct kind { uint32_t names[2]; pixel_verdict verdict; uint64_t pixels; } kind; // of pixels that differ

typedef struct view_score { uint32_t view; uint64_t differing; } view_score;

typedef struct run {
    scene *scenes[3], opaque[3]; // raw, compiled, raw with its holes filled
    picture_pair pair;
    renderer *g;
    camera *cameras;
    uint32_t count, skipped;
    picture *pictures[3]; // BATCH each
    id_picture scratch[3];
    uint32_t hole;        // its material in the third; UINT32_MAX: the map has none
    int has_liquids;
    kind kinds[KINDS_MOST];
    uint32_t kind_count;
    view_score *scores;   // by view
    picture_counts counts[2];
    report report;
} run;

// ---- Cameras ----

static result take_automatic(run *r, const air_points *air, uint32_t count)
{
    camera_path path = {0};
    char what[32];
    if (count == 0) return RESULT_OK;
    snprintf(what, sizeof what, "auto:%u", count);
    const result done = camera_path_load(what, r->scenes[0], (double)PICTURE_WIDTH / PICTURE_HEIGHT, allocator_heap(), &r->report, &path);
    for (uint32_t i = 0; i < path.count && done == RESULT_OK; ++i) {
        if (air_points_place(air, path.cameras[i].eye) == POINT_AIR) r->cameras[r->count++] = path.cameras[i];
        else r->skipped++;
    }
    if (done == RESULT_OK) camera_path_free(&path, allocator_heap());
    return done;
}

static void take_random(run *r, const air_points *air, uint32_t count)
{
    random_stream random = {SEED};
    const scene *s = r->scenes[0];
    const double low[3] = {(double)s->whole.box.min.x, (double)s->whole.box.min.y, (double)s->whole.box.min.z};
    const double high[3] = {(double)s->whole.box.max.x, (double)s->whole.box.max.y, (double)s->whole.box.max.z};
    for (uint32_t found = 0; found < count;) {
        camera c = {.up = {0, 1, 0}, .fovy_deg = FOVY_DEG, .aspect = (double)PICTURE_WIDTH / PICTURE_HEIGHT, .near_m = NEAR_M, .far_m = INFINITY};
        for (int k = 0; k < 3; ++k) c.eye[k] = s->whole.origin[k] + random_between(&random, low[k], high[k]);
        double length = 0;
        for (int k = 0; k < 3; ++k) c.forward[k] = random_between(&random, -1, 1), length += c.forward[k] * c.forward[k];
        if (!(length > 0.01 && length < 1) || fabs(c.forward[1]) > 0.99 * sqrt(length)) continue;
        if (air_points_place(air, c.eye) != POINT_AIR) continue;
        r->cameras[r->count++] = c;
        found++;
    }
}

// ---- Drawing ----

static result draw(run *r, int side, picture_liquids liquids, const camera *cameras, uint32_t count)
{
    if (side == FILLED && r->hole == UINT32_MAX) return RESULT_OK;
    const scene *s = liquids == LIQUIDS_AS_WALLS ? &r->opaque[side] : r->scenes[side];
    result done = renderer_upload(r->g, s, &r->report);
    for (uint32_t i = 0; i < count && done == RESULT_OK; ++i) {
        const id_request q = {.camera = &cameras[i]};
        picture *to = &r->pictures[side][i];
        done = renderer_id_picture(r->g, &q, &r->report, &r->scratch[side]);
        if (done == RESULT_OK) done = renderer_read_ids(r->g, to->triangles, to->depths, &r->report);
    }
    return done;
}

static void note(run *r, const uint32_t triangles[2], pixel_verdict verdict)
{
    uint32_t names[2], i = 0;
    for (int k = 0; k < 2; ++k)
        names[k] = triangles[k] ? r->pair.material_names[k][picture_material(r->scenes[k], triangles[k] - 1)] : UINT32_MAX;
    while (i < r->kind_count && (r->kinds[i].names[0] != names[0] || r->kinds[i].names[1] != names[1] || r->kinds[i].verdict != verdict)) i++;
    if (i == KINDS_MOST) return;
    if (i == r->kind_count) r->kinds[r->kind_count++] = (kind){{names[0], names[1]}, verdict, 0};
    r->kinds[i].pixels++;
}

// Through a hole one sees the inside of a solid: nothing that the two have to agree on.
static int is_hole(const run *r, uint32_t slot, uint32_t pixel)
{
    if (r->hole == UINT32_MAX) return 0;
    const uint32_t triangle = r->pictures[FILLED][slot].triangles[pixel];
    return triangle && picture_material(r->scenes[FILLED], triangle - 1) == r->hole;
}

static uint64_t compare_view(run *r, uint32_t slot, const camera *c, picture_counts *counts)
{
    const picture *raw = &r->pictures[RAW][slot], *compiled = &r->pictures[COMPILED][slot];
    uint64_t differing = 0;
    for (uint32_t i = 0; i < PICTURE_PIXELS; ++i) {
        pixel_verdict v = picture_pixel(&r->pair, c, raw, compiled, i);
        counts->pixels++;
        if (v == PIXEL_SAME) continue;
        if (is_hole(r, slot, i)) {
            counts->holes++;
            continue;
        }
        const pixel_place place = {compiled->triangles[i] - 1, i};
        if (v == PIXEL_COPLANAR && counts->coplanar % CHECKED_EVERY == 0) counts->wrong += !picture_has_both(&r->pair, c, &place);
        counts->differing++;
        counts->coplanar += v == PIXEL_COPLANAR;
        note(r, (const uint32_t[2]){raw->triangles[i], compiled->triangles[i]}, v);
        differing++;
    }
    return differing;
}

static result compare_all(run *r)
{
    result done = RESULT_OK;
    for (uint32_t first = 0; first < r->count && done == RESULT_OK; first += BATCH) {
        const uint32_t count = r->count - first < BATCH ? r->count - first : BATCH;
        for (int liquids = 0; liquids < 1 + r->has_liquids && done == RESULT_OK; ++liquids) {
            for (int side = 0; side < SCENES && done == RESULT_OK; ++side) done = draw(r, side, (picture_liquids)liquids, r->cameras + first, count);
            for (uint32_t i = 0; i < count && done == RESULT_OK; ++i)
                r->scores[first + i].differing += compare_view(r, i, &r->cameras[first + i], &r->counts[liquids]);
        }
    }
    return done;
}

// ---- Telling ----

static int compare_kinds(const void *a, const void *b)
{
    const uint64_t x = ((const kind *)a)->pixels, y = ((const kind *)b)->pixels;
    return (x < y) - (x > y);
}

static int compare_scores(const void *a, const void *b)
{
    const view_score *x = a, *y = b;
    if (x->differing != y->differing) return x->differing < y->differing ? 1 : -1;
    return x->view > y->view ? 1 : -1;
}

static const char *name_of(const run *r, uint32_t name)
{
    const uint32_t raw = r->scenes[0]->material_count;
    if (name == UINT32_MAX) return "(nothing)";
    return name < raw ? r->scenes[0]->materials[name].name : r->scenes[1]->materials[name - raw].name;
}

static int object_of(const scene *s, uint32_t triangle, const char **name)
{
    for (uint32_t i = 0; i < s->item_count + s->mover_count; ++i) {
        if (triangle * 3 < s->items[i].first_index || triangle * 3 >= s->items[i].first_index + s->items[i].index_count) continue;
        *name = s->objects[s->items[i].object].name;
        return (int)i;
    }
    return -1;
}

static void print_pixel(const run *r, const camera *c, uint32_t slot, uint32_t pixel)
{
    for (int side = 0; side < 2; ++side) {
        const uint32_t triangle = r->pictures[side][slot].triangles[pixel];
        double at[3] = {0}, distance = 0;
        const char *object = "";
        if (triangle == 0) {
            printf("    %s: nothing\n", side ? "compiled" : "raw");
            continue;
        }
        const int item = object_of(r->scenes[side], triangle - 1, &object);
        picture_point(r->scenes[side], &(pixel_place){triangle - 1, pixel}, c, at, &distance);
        printf("    %s: %s, item %d of %s, at %.4f %.4f %.4f (map units), %.6f m away\n", side ? "compiled" : "raw",
               r->scenes[side]->materials[picture_material(r->scenes[side], triangle - 1)].name, item, object, at[0] * 32, -at[2] * 32, at[1] * 32, distance);
    }
}

static void put_colour(const run *r, uint32_t side, uint32_t triangle, uint8_t *to)
{
    const scene *s = r->scenes[side];
    const uint32_t colour = triangle ? s->materials[picture_material(s, triangle - 1)].colour : 0xff000000u;
    for (int k = 0; k < 3; ++k) to[k] = (uint8_t)(colour >> (8 * k));
    to[3] = 255;
}

static void tell_view(const run *r, uint32_t which, picture_liquids liquids, const picture_counts *counts)
{
    const double *eye = r->cameras[r->scores[which].view].eye;
    printf("view %u, liquids %s: %" PRIu64 " bad, %" PRIu64 " coplanar; eye %.3f %.3f %.3f (map units)\n", r->scores[which].view, liquid_ways[liquids],
           counts->differing - counts->coplanar, counts->coplanar, eye[0] * 32, -eye[2] * 32, eye[1] * 32);
}

// Raw, compiled, and what differs, side by side; some of the pixels that differ in words.
static void paint(const run *r, const camera *c, uint64_t differing, uint8_t *rgba)
{
    uint64_t seen = 0;
    for (uint32_t i = 0; i < PICTURE_PIXELS; ++i) {
        pixel_verdict v = picture_pixel(&r->pair, c, &r->pictures[RAW][0], &r->pictures[COMPILED][0], i);
        if (is_hole(r, 0, i)) v = PIXEL_SAME;
        const uint32_t row = PICTURE_HEIGHT - 1 - i / PICTURE_WIDTH, column = i % PICTURE_WIDTH;
        uint8_t *line = rgba + (size_t)row * 3 * PICTURE_WIDTH * 4;
        for (uint32_t side = 0; side < 2; ++side) put_colour(r, side, r->pictures[side][0].triangles[i], line + 4 * (side * PICTURE_WIDTH + column));
        const uint8_t bad = v == PIXEL_BAD ? 255 : 0, mark[4] = {bad, bad, v == PIXEL_SAME ? 0 : 255, 255};
        memcpy(line + 4 * (2 * PICTURE_WIDTH + column), mark, 4);
        if (v != PIXEL_SAME && seen++ % (differing / 6 + 1) == 0) print_pixel(r, c, 0, i);
    }
}

static result show_worst(run *r, uint32_t which, picture_liquids liquids, const char *prefix)
{
    const camera *c = &r->cameras[r->scores[which].view];
    picture_counts counts = {0};
    char path[512];
    result done = RESULT_OK;
    for (int side = 0; side < SCENES && done == RESULT_OK; ++side) done = draw(r, side, liquids, c, 1);
    uint8_t *rgba = done == RESULT_OK ? calloc(3 * (size_t)PICTURE_PIXELS, 4) : NULL;
    if (!rgba) return done == RESULT_OK ? RESULT_NO_MEMORY : done;
    compare_view(r, 0, c, &counts);
    tell_view(r, which, liquids, &counts);
    paint(r, c, counts.differing, rgba);
    snprintf(path, sizeof path, "%s%u%s.png", prefix, which, liquids ? "w" : "");
    done = png_write(path, rgba, 3 * PICTURE_WIDTH, PICTURE_HEIGHT, &r->report);
    free(rgba);
    return done;
}

static double percent(uint64_t part, uint64_t of)
{
    return of ? 100.0 * (double)part / (double)of : 0;
}

static int tell_counts(const run *r, const char *file, picture_liquids liquids)
{
    const picture_counts *c = &r->counts[liquids];
    const uint64_t bad = c->differing - c->coplanar, wrong = c->wrong * CHECKED_EVERY;
    printf("%s: liquids %s: %u views (%u not in air), %" PRIu64 " pixels, %" PRIu64 " differ (%.5f%%), ", file, liquid_ways[liquids], r->count, r->skipped,
           c->pixels, c->differing, percent(c->differing, c->pixels));
    printf("of those %" PRIu64 " coplanar, %" PRIu64 " bad (%.5f%%); %" PRIu64 " seen through holes, %" PRIu64 " of another material than any raw face there\n",
           c->coplanar, bad, percent(bad, c->pixels), c->holes, wrong);
    return r->count > 0 && bad * 10000 <= c->pixels && wrong * 10000 <= c->pixels;
}

static int tell(run *r, const char *file)
{
    int good = 1;
    for (int i = 0; i < 1 + r->has_liquids; ++i) good &= tell_counts(r, file, (picture_liquids)i);
    qsort(r->kinds, r->kind_count, sizeof *r->kinds, compare_kinds);
    for (uint32_t i = 0; i < r->kind_count && i < KINDS_TOLD; ++i) {
        const kind *k = &r->kinds[i];
        printf("  %" PRIu64 " %s: raw %s, compiled %s\n", k->pixels, k->verdict == PIXEL_BAD ? "bad" : "coplanar", name_of(r, k->names[0]), name_of(r, k->names[1]));
    }
    return good;
}

// ---- All of it ----

static result open_all(run *r, char **arguments, uint32_t automatic, uint32_t random)
{
    const allocator *memory = allocator_heap();
    const import_options import = {.doors = DOORS_OPEN};
    const renderer_options options = {.target = RENDERER_HEADLESS, .width_px = PICTURE_WIDTH, .height_px = PICTURE_HEIGHT};
    result done = RESULT_OK;
    for (int i = 0; i < SCENES && done == RESULT_OK; ++i) {
        if (i == FILLED) done = holes_import(arguments[1], memory, &r->report, &r->scenes[i]);
        else done = import_scene(arguments[1 + i], &import, memory, &r->report, &r->scenes[i]);
        if (done == RESULT_OK) done = scene_opaque_make(r->scenes[i], &r->opaque[i]);
        if (done == RESULT_OK) done = id_picture_open(r->scenes[i], PICTURE_WIDTH, PICTURE_HEIGHT, memory, &r->scratch[i]);
        r->pictures[i] = calloc(BATCH, sizeof *r->pictures[i]);
        if (!r->pictures[i]) done = RESULT_NO_MEMORY;
    }
    r->cameras = calloc((size_t)automatic + random + 1, sizeof *r->cameras);
    r->scores = calloc((size_t)automatic + random + 1, sizeof *r->scores);
    if (done != RESULT_OK || !r->cameras || !r->scores) return done == RESULT_OK ? RESULT_NO_MEMORY : done;
    for (uint32_t i = 0; i < automatic + random; ++i) r->scores[i].view = i;
    r->hole = UINT32_MAX;
    for (uint32_t m = 0; m < r->scenes[FILLED]->material_count; ++m)
        if (strcmp(r->scenes[FILLED]->materials[m].name, HOLE_MATERIAL) == 0) r->hole = m;
    for (uint32_t m = 0; m < r->scenes[RAW]->material_count; ++m) r->has_liquids |= (r->scenes[RAW]->materials[m].flags & MATERIAL_TRANSLUCENT) != 0;
    done = picture_pair_open(r->scenes[0], r->scenes[1], &r->pair);
    air_points *air = done == RESULT_OK ? air_points_open(r->scenes[0], r->scenes[1], CLEARANCE_M) : NULL;
    if (!air) return RESULT_NO_MEMORY;
    done = take_automatic(r, air, automatic);
    if (done == RESULT_OK) take_random(r, air, random);
    air_points_close(air);
    return done == RESULT_OK ? renderer_open(&options, memory, &r->report, &r->g) : done;
}

static void close_all(run *r)
{
    renderer_close(r->g);
    picture_pair_free(&r->pair);
    for (int i = 0; i < SCENES; ++i) {
        id_picture_free(&r->scratch[i], allocator_heap());
        if (r->opaque[i].items) scene_opaque_free(&r->opaque[i]);
        scene_free(r->scenes[i], allocator_heap());
        free(r->pictures[i]);
    }
    free(r->cameras);
    free(r->scores);
}

int main(int count, char **arguments)
{
    static run r;
    if (count != 5 && count != 6) return 2;
    r.report = report_to_stderr();
    result done = open_all(&r, arguments, (uint32_t)strtoul(arguments[3], NULL, 10), (uint32_t)strtoul(arguments[4], NULL, 10));
    if (done == RESULT_OK) done = compare_all(&r);
    const int good = done == RESULT_OK ? tell(&r, arguments[1]) : 0;
    qsort(r.scores, r.count, sizeof *r.scores, compare_scores);
    for (uint32_t i = 0; count == 6 && i < WORST && i < r.count && done == RESULT_OK; ++i)
        for (int liquids = 0; liquids < 1 + r.has_liquids && done == RESULT_OK; ++liquids) done = show_worst(&r, i, (picture_liquids)liquids, arguments[5]);
    close_all(&r);
    if (done == RESULT_NO_GL) return NO_GL;
    return done != RESULT_OK ? 2 : good ? 0 : 1;
}
