// Pictures of glass drawn piece by piece, held against a truth that sorts the panes of each pixel by their depth.
// SPDX-License-Identifier: MIT
//
// The truth: rays through pixel centres against each pane, in double; each pane's colour as the renderer shades it alone, opaque;
// blended farthest first, half and half, rounded to 8 bits after each pane as the picture is. Here a pane's colour is rounded
// before it is blended: an error of e becomes e/2 + 1/4, and two roundings add 1 at most, so it is 1 level after one blend and
// 2 after any number (e/2 + 5/4 stays under 5/2).
// A pixel is left out where it turns within 1/64 pixel (the rasterizer snaps corners to 1/256, and corners of pieces are
// rounded to float) which panes cover it or which of two is nearer; those are counted, and few.
#include "fixture.h"

#include "host/render/render.h"

#include "../common/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDE = 240, HIGH = 180, PIXELS = WIDE * HIGH, LEVELS_MOST = 2 };
static const double SNAP_PX = 1.0 / 64;

typedef struct bed {
    report r;
    renderer *g;
    const pane_list *list;
    camera camera;
    uint8_t *colours; // by pane, of each pixel: 4 bytes; top row first
    uint8_t *background;
    uint64_t left_out;
} bed;

static camera camera_of(const double eye[3], const double at[3])
{
    camera c = {.eye = {eye[0], eye[1], eye[2]}, .up = {0, 1, 0.01}, .fovy_deg = 60, .aspect = (double)WIDE / HIGH, .near_m = 1.0 / 16, .far_m = INFINITY};
    for (int k = 0; k < 3; ++k) c.forward[k] = at[k] - eye[k];
    return c;
}

// ---- Rays ----

static void ray_of(const camera *c, double x_px, double y_px, double out[3])
{
    double right[3], up[3], back[3];
    camera_axes(c, right, up, back);
    const double tall = tan(c->fovy_deg * 0.017453292519943295 / 2), u = (2 * x_px / WIDE - 1) * tall * c->aspect, v = (1 - 2 * y_px / HIGH) * tall;
    for (int k = 0; k < 3; ++k) out[k] = u * right[k] + v * up[k] - back[k];
}

// Panes that cover the point of the picture, farthest first.
static uint32_t layers_at(const bed *b, double x_px, double y_px, uint32_t out[PANES_MOST])
{
    double along[3], depths[PANES_MOST];
    uint32_t count = 0;
    ray_of(&b->camera, x_px, y_px, along);
    for (uint32_t i = 0; i < b->list->count; ++i) {
        const double depth = pane_hit(&b->list->panes[i], b->camera.eye, along); // along the view: `along` is 1 there
        if (depth == INFINITY || depth < b->camera.near_m) continue;
        uint32_t at = count++;
        for (; at > 0 && depths[at - 1] < depth; --at) {
            depths[at] = depths[at - 1];
            out[at] = out[at - 1];
        }
        depths[at] = depth;
        out[at] = i;
    }
    return count;
}

// The same layers all round the pixel's centre.
static int is_settled(const bed *b, uint32_t x, uint32_t y, const uint32_t *layers, uint32_t count)
{
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            uint32_t there[PANES_MOST];
            if (!dx && !dy) continue;
            if (layers_at(b, x + 0.5 + dx * SNAP_PX, y + 0.5 + dy * SNAP_PX, there) != count || memcmp(there, layers, count * sizeof *layers) != 0) return 0;
        }
    return 1;
}

// ---- The renderer ----

typedef enum order_how { BY_PIECES, BY_DISTANCE } order_how;
typedef struct shown { scene *s; render_layout *l; } shown;

static shown show(bed *b, pane_materials materials, const zone_chain *chain, order_how how)
{
    shown out = {.s = panes_build(b->list, materials, allocator_heap())};
    uint32_t items[PANES_MOST];
    assert_int_equal(renderer_upload(b->g, out.s, &b->r), RESULT_OK);
    for (uint32_t i = 0; i < b->list->count; ++i) items[i] = chain ? zone_chain_item(chain, i) : i;
    assert_int_equal(render_layout_open(b->g, &(render_layout_zone){items, b->list->count}, 1, &b->r, &out.l), RESULT_OK);
    if (how == BY_PIECES) assert_int_equal(render_layout_pieces(out.l, &chain->lent, &b->r), RESULT_OK);
    return out;
}

static void show_no_more(shown *s)
{
    render_layout_close(s->l);
    scene_free(s->s, allocator_heap());
}

static void draw(bed *b, const shown *s, const cull_run *runs, uint32_t run_count, uint8_t *rgba)
{
    const frame_request q = {.camera = &b->camera, .width_px = WIDE, .height_px = HIGH, .mode = RENDER_SHADED};
    assert_int_equal(renderer_begin(b->g, &q, &b->r), RESULT_OK);
    if (run_count) renderer_draw(b->g, s->l, 0, runs, run_count);
    renderer_end(b->g);
    assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
}

static void draw_colours(bed *b)
{
    shown s = show(b, ALL_OPAQUE, NULL, BY_DISTANCE);
    draw(b, &s, NULL, 0, b->background);
    for (uint32_t i = 0; i < b->list->count; ++i) draw(b, &s, &(cull_run){i, 1}, 1, b->colours + (size_t)i * PIXELS * 4);
    show_no_more(&s);
}

// ---- One picture against the truth ----

typedef struct comparison { uint64_t wrong, deep, left_out; uint32_t worst; } comparison; // deep: pixels with two layers or more

// Levels that the pixel is off beyond what its blends allow.
static uint32_t pixel_error(const bed *b, uint32_t pixel, const uint32_t *layers, uint32_t count, const uint8_t *rgba)
{
    uint32_t worst = 0;
    for (uint32_t k = 0; k < 3; ++k) {
        double value = b->background[4 * pixel + k];
        for (uint32_t i = 0; i < count; ++i) value = floor((value + b->colours[((size_t)layers[i] * PIXELS + pixel) * 4 + k]) / 2 + 0.5);
        const double off = fabs(value - rgba[4 * pixel + k]), allowed = count < LEVELS_MOST ? count : LEVELS_MOST;
        if (off > allowed && off - allowed > worst) worst = (uint32_t)(off - allowed);
    }
    return worst;
}

static comparison compare(const bed *b, const uint8_t *rgba)
{
    comparison out = {0};
    for (uint32_t pixel = 0; pixel < PIXELS; ++pixel) {
        uint32_t layers[PANES_MOST];
        const uint32_t count = layers_at(b, pixel % WIDE + 0.5, pixel / WIDE + 0.5, layers);
        const uint32_t error = pixel_error(b, pixel, layers, count, rgba);
        out.deep += count >= 2;
        if (!error) continue;
        if (!is_settled(b, pixel % WIDE, pixel / WIDE, layers, count)) {
            out.left_out++;
            continue;
        }
        out.wrong++;
        out.worst = error > out.worst ? error : out.worst;
    }
    return out;
}

static comparison picture(bed *b, const zone_chain *chain, order_how how)
{
    uint8_t *rgba = malloc((size_t)PIXELS * 4);
    const cull_run all = {0, b->list->count};
    shown s = show(b, AS_THEY_ARE, chain, how);
    draw(b, &s, &all, 1, rgba);
    if (how == BY_PIECES) assert_int_equal(renderer_draw_calls(b->g), 2); // opaque (nothing, but asked for) and glass
    const comparison out = compare(b, rgba);
    show_no_more(&s);
    free(rgba);
    return out;
}

static void view_list(bed *b, const pane_list *l, camera c)
{
    b->list = l;
    b->camera = c;
    free(b->colours);
    b->colours = malloc((size_t)l->count * PIXELS * 4);
    assert_non_null(b->colours);
    draw_colours(b);
}

static void assert_true_picture(bed *b, const char *name, const char *chain)
{
    zone_chain t;
    scene *s = panes_build(b->list, AS_THEY_ARE, allocator_heap());
    zone_chain_open(s, 0, chain, &t);
    assert_non_null(t.lent);
    const comparison c = picture(b, &t, BY_PIECES);
    if (c.wrong || getenv("PIECES_VERBOSE"))
        fprintf(stderr, "%s, %s: %llu pixels off by up to %u levels too many, %llu left out, %llu with two panes or more, %u pieces\n", name, chain,
                (unsigned long long)c.wrong, c.worst, (unsigned long long)c.left_out, (unsigned long long)c.deep, t.lent->piece_count);
    assert_int_equal(c.wrong, 0);
    assert_true(c.left_out <= PIXELS / 500);
    b->left_out += c.left_out;
    zone_chain_close(&t);
    scene_free(s, allocator_heap());
}

// ---- Tests ----

static const double MIDDLE[3] = {0, 0, -4.5};

static void each_scene_has_the_colours_of_sorted_pixels(void **state)
{
    bed *b = *state;
    static const double eyes[][3] = {{0, 0, 0}, {3, 2, -1}, {-2.5, -1, -8}};
    for (uint32_t i = 0; i < pane_scene_count; ++i) {
        pane_list l = {.count = 0};
        pane_scenes[i].make(&l);
        for (uint32_t e = 0; e < sizeof eyes / sizeof *eyes; ++e) {
            view_list(b, &l, camera_of(eyes[e], MIDDLE));
            for (uint32_t w = 0; w < piece_chain_count; ++w) // all ways to split from each eye; the other ways to choose from the first
                if (w < 2 || e == 0) assert_true_picture(b, pane_scenes[i].name, piece_chains[w]);
        }
    }
}

static void from_inside_the_glass_too(void **state)
{
    bed *b = *state;
    static const double eyes[][3] = {{0.1, 0.05, -4.9}, {1.5, 0, -3.2}, {-1.3, 1.2, -5.5}};
    pane_list l = {.count = 0};
    panes_boxes(&l);
    for (uint32_t e = 0; e < sizeof eyes / sizeof *eyes; ++e) {
        view_list(b, &l, camera_of(eyes[e], (const double[3]){2, 0.3, -6}));
        for (uint32_t w = 0; w < 2; ++w) assert_true_picture(b, "inside boxes", piece_chains[w]);
    }
}

static void with_the_eye_in_the_plane_of_a_pane(void **state)
{
    bed *b = *state;
    pane_list l = {.count = 0};
    panes_random(&l, 20, 5);
    for (uint32_t i = 0; i < 6; ++i) {
        const pane *p = &l.panes[3 * i];
        double eye[3];
        for (int k = 0; k < 3; ++k) eye[k] = p->points[0][k] - 1.5 * (p->points[1][k] - p->points[0][k]) - 0.25 * (p->points[3][k] - p->points[0][k]);
        view_list(b, &l, camera_of(eye, MIDDLE));
        for (uint32_t w = 0; w < 2; ++w) assert_true_picture(b, "eye in a plane", piece_chains[w]);
    }
    const double boxed[3] = {1.6, 0.3, 1}; // in the plane of a side of the largest box, exactly
    pane_list boxes = {.count = 0};
    panes_boxes(&boxes);
    view_list(b, &boxes, camera_of(boxed, MIDDLE));
    for (uint32_t w = 0; w < 2; ++w) assert_true_picture(b, "eye in a box's plane", piece_chains[w]);
}

static void by_distance_alone_panes_over_each_other_come_out_wrong(void **state)
{
    bed *b = *state;
    for (uint32_t i = 0; i < pane_scene_count; ++i) {
        pane_list l = {.count = 0};
        pane_scenes[i].make(&l);
        view_list(b, &l, camera_of((const double[3]){0, 0, 0}, MIDDLE));
        const comparison c = picture(b, NULL, BY_DISTANCE);
        assert_true(c.wrong > c.deep / (i == 0 ? 5 : 40)); // the cyclic one first: a third of its overlaps
        assert_true(c.worst > 20);
    }
}

static void what_nothing_comes_between_is_drawn_whole_and_as_ever(void **state)
{
    bed *b = *state;
    pane_list l = {.count = 0};
    uint8_t *pieces = malloc((size_t)PIXELS * 4), *whole = malloc((size_t)PIXELS * 4);
    panes_sliced(&l);
    view_list(b, &l, camera_of((const double[3]){0, 0, 0}, MIDDLE));
    scene *s = panes_build(&l, AS_THEY_ARE, allocator_heap());
    zone_chain t;
    zone_chain_open(s, 0, piece_chains[0], &t);
    shown a = show(b, AS_THEY_ARE, &t, BY_PIECES);
    uint32_t place = 0;
    while (zone_chain_item(&t, place) != 0) ++place; // the large one
    draw(b, &a, &(cull_run){place, 1}, 1, pieces);
    show_no_more(&a);
    a = show(b, AS_THEY_ARE, &t, BY_DISTANCE);
    draw(b, &a, &(cull_run){place, 1}, 1, whole);
    show_no_more(&a);
    assert_memory_equal(pieces, whole, (size_t)PIXELS * 4);
    zone_chain_close(&t);
    scene_free(s, allocator_heap());
    free(pieces);
    free(whole);
}

static int setup(void **state)
{
    bed *b = calloc(1, sizeof *b);
    if (!b) return -1;
    b->r = report_to_stderr();
    b->background = malloc((size_t)PIXELS * 4);
    *state = b;
    return renderer_open(NULL, allocator_heap(), &b->r, &b->g) == RESULT_OK ? 0 : -1;
}

static int teardown(void **state)
{
    bed *b = *state;
    const uint32_t errors = renderer_errors(b->g);
    renderer_close(b->g);
    free(b->colours);
    free(b->background);
    free(b);
    return errors ? -1 : 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(each_scene_has_the_colours_of_sorted_pixels, setup, teardown),
        cmocka_unit_test_setup_teardown(from_inside_the_glass_too, setup, teardown),
        cmocka_unit_test_setup_teardown(with_the_eye_in_the_plane_of_a_pane, setup, teardown),
        cmocka_unit_test_setup_teardown(by_distance_alone_panes_over_each_other_come_out_wrong, setup, teardown),
        cmocka_unit_test_setup_teardown(what_nothing_comes_between_is_drawn_whole_and_as_ever, setup, teardown),
    };
    renderer *g = NULL;
    report r = report_to_stderr();
    if (renderer_open(NULL, allocator_heap(), &r, &g) == RESULT_NO_GL) {
        fprintf(stderr, "SKIPPED: no OpenGL 4.5 on this machine\n");
        return 77;
    }
    renderer_close(g);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
