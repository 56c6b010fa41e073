// How a layout takes pieces: nothing is drawn twice or left out, nonsense and exhausted memory go back to the order by distance,
// zones stand in the order of the portals between them.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "host/core/pieces.h"
#include "host/render/render.h"

#include "../common/failing_allocator.h"
#include "../common/report_lines.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDE = 640, HIGH = 480, PIXELS = WIDE * HIGH, BYTES = 4 * PIXELS };

typedef struct bed {
    failing_allocator memory;
    report_lines lines;
    renderer *g;
    camera camera;
    render_scissor scissor;
    uint8_t *pictures[2];
} bed;

static camera looking(double x, double y, double z)
{
    return (camera){.eye = {x, y, z}, .forward = {-x, -y, -4.5 - z}, .up = {0, 1, 0.01}, .fovy_deg = 60, .aspect = (double)WIDE / HIGH,
                    .near_m = 1.0 / 16, .far_m = INFINITY};
}

typedef struct shown { scene *s; render_layout *l; zone_chain tree; uint32_t order[PANES_MOST]; } shown;

static void show_list(bed *b, const pane_list *l, shown *out)
{
    *out = (shown){.s = panes_build(l, AS_THEY_ARE, allocator_heap())};
    zone_chain_open(out->s, 0, piece_chains[0], &out->tree);
    for (uint32_t i = 0; i < out->s->item_count; ++i) out->order[i] = zone_chain_item(&out->tree, i);
    assert_int_equal(renderer_upload(b->g, out->s, &b->lines.report), RESULT_OK);
    assert_int_equal(render_layout_open(b->g, &(render_layout_zone){out->order, out->s->item_count}, 1, &b->lines.report, &out->l), RESULT_OK);
}

static void show_no_more(shown *s)
{
    render_layout_close(s->l);
    zone_chain_close(&s->tree);
    scene_free(s->s, allocator_heap());
}

static result take_pieces(bed *b, const shown *s, const cull_pieces *pieces)
{
    return render_layout_pieces(s->l, &pieces, &b->lines.report);
}

static void draw(bed *b, const shown *s, render_mode mode, uint8_t *rgba)
{
    static const float most[4] = {-0.45f, -0.6f, 0.3f, 0.55f};
    const frame_request q = {.camera = &b->camera, .width_px = WIDE, .height_px = HIGH, .mode = mode, .scissor = b->scissor};
    assert_int_equal(renderer_begin(b->g, &q, &b->lines.report), RESULT_OK);
    renderer_zone_rectangle(b->g, 0, most);
    renderer_draw(b->g, s->l, 0, &(cull_run){0, s->s->item_count}, 1);
    for (uint32_t i = 0; i < s->s->mover_count; ++i) renderer_draw_movers(b->g, s->l, &i, 1);
    renderer_end(b->g);
    assert_int_equal(renderer_read(b->g, rgba, &b->lines.report), RESULT_OK);
}

static uint32_t pixels_apart(const uint8_t *a, const uint8_t *b)
{
    uint32_t count = 0;
    for (size_t i = 0; i < PIXELS; ++i) count += memcmp(a + 4 * i, b + 4 * i, 3) != 0;
    return count;
}

// ---- Tests ----

// Pixels from the point to the nearest side of a pane, as seen.
static double to_sides_px(const bed *b, const pane_list *l, double x_px, double y_px)
{
    double right[3], up[3], back[3], nearest = INFINITY;
    const double half = tan(b->camera.fovy_deg * 0.017453292519943295 / 2);
    camera_axes(&b->camera, right, up, back);
    for (uint32_t side = 0; side < 4 * l->count; ++side) {
        double at[2][3] = {{0}}, px[2][2];
        for (uint32_t end = 0; end < 2; ++end) {
            const double *p = l->panes[side / 4].points[(side + end) % 4];
            for (int k = 0; k < 3; ++k) {
                at[end][0] += (p[k] - b->camera.eye[k]) * right[k];
                at[end][1] += (p[k] - b->camera.eye[k]) * up[k];
                at[end][2] -= (p[k] - b->camera.eye[k]) * back[k];
            }
            px[end][0] = (at[end][0] / at[end][2] / half / b->camera.aspect + 1) * WIDE / 2 - x_px;
            px[end][1] = (1 - at[end][1] / at[end][2] / half) * HIGH / 2 - y_px;
        }
        const double dx = px[1][0] - px[0][0], dy = px[1][1] - px[0][1];
        const double t = -(px[0][0] * dx + px[0][1] * dy) / (dx * dx + dy * dy);
        if (at[0][2] > 0 && at[1][2] > 0 && t >= 0 && t <= 1) nearest = fmin(nearest, fabs(px[0][0] * dy - px[0][1] * dx) / hypot(dx, dy));
    }
    return nearest;
}

// Those that differ lie at sides of panes: cuts end there in corners that are rounded to float and to 1/256 pixel.
static uint32_t assert_apart_at_sides_only(const bed *b, const pane_list *l)
{
    uint32_t apart = 0;
    for (size_t i = 0; i < PIXELS; ++i) {
        if (memcmp(b->pictures[0] + 4 * i, b->pictures[1] + 4 * i, 3) == 0) continue;
        assert_true(to_sides_px(b, l, (double)(i % WIDE) + 0.5, (double)(i / WIDE) + 0.5) < 1.0 / 256);
        apart++;
    }
    return apart;
}

static void each_pixel_of_a_pane_is_in_one_of_its_pieces(void **state)
{
    bed *b = *state;
    static const double eyes[][3] = {{0, 0, 0}, {2.5, 1, -2}, {-2, -1.5, -7}};
    uint32_t apart = 0;
    for (uint32_t i = 0; i < pane_scene_count; ++i) {
        pane_list l = {.count = 0};
        shown s;
        pane_scenes[i].make(&l);
        show_list(b, &l, &s);
        for (uint32_t e = 0; e < 3; ++e) {
            b->camera = looking(eyes[e][0], eyes[e][1], eyes[e][2]);
            assert_int_equal(take_pieces(b, &s, NULL), RESULT_OK);
            draw(b, &s, RENDER_OVERDRAW, b->pictures[0]); // layers counted: no order shows
            assert_int_equal(take_pieces(b, &s, s.tree.lent), RESULT_OK);
            draw(b, &s, RENDER_OVERDRAW, b->pictures[1]);
            apart += assert_apart_at_sides_only(b, &l);
        }
        show_no_more(&s);
    }
    if (getenv("PIECES_VERBOSE")) fprintf(stderr, "%u pixels of %u have other layers\n", apart, 3 * pane_scene_count * PIXELS);
    assert_true(apart <= 3 * pane_scene_count * PIXELS / 10000);
}

static void assert_by_distance(bed *b, const shown *s)
{
    draw(b, s, RENDER_SHADED, b->pictures[1]);
    assert_int_equal(pixels_apart(b->pictures[0], b->pictures[1]), 0);
}

static void draw_by_distance(bed *b, const pane_list *l, shown *s)
{
    show_list(b, l, s);
    b->camera = looking(0.3, 0.2, 0);
    draw(b, s, RENDER_SHADED, b->pictures[0]);
    assert_int_equal(take_pieces(b, s, s->tree.lent), RESULT_OK);
    draw(b, s, RENDER_SHADED, b->pictures[1]);
    assert_true(pixels_apart(b->pictures[0], b->pictures[1]) > PIXELS / 200); // it can be told
}

static void pieces_given_back_leave_the_picture_by_distance(void **state)
{
    bed *b = *state;
    pane_list l = {.count = 0};
    shown s;
    panes_cyclic(&l);
    draw_by_distance(b, &l, &s);
    assert_int_equal(take_pieces(b, &s, NULL), RESULT_OK);
    assert_by_distance(b, &s);
    assert_int_equal(take_pieces(b, &s, s.tree.lent), RESULT_OK);
    assert_int_equal(render_layout_reorder(s.l, 0, s.order, &b->lines.report), RESULT_OK); // another chain's order: its pieces are forgotten
    assert_by_distance(b, &s);
    show_no_more(&s);
}

static void a_scene_that_is_opaque_takes_no_pieces(void **state)
{
    bed *b = *state;
    pane_list l = {.count = 0};
    shown s;
    panes_cyclic(&l);
    for (uint32_t i = 0; i < l.count; ++i) l.panes[i].kind = PANE_OPAQUE;
    show_list(b, &l, &s);
    const uint64_t calls = b->memory.calls;
    assert_int_equal(take_pieces(b, &s, s.tree.lent), RESULT_OK);
    assert_int_equal(b->memory.calls, calls);
    show_no_more(&s);
}

// Panes across the view, one behind the other, so that their distances are right too; every third a wall, a cluster, a mover. Two
// that cross stand beside them, out of sight, and their planes cut the walls among them.
static void stack(pane_list *l)
{
    static const pane_kind kinds[3] = {PANE_GLASS, PANE_CLUSTER, PANE_MOVER};
    for (int i = 0; i < 9; ++i) {
        const double middle[3] = {0.3 * sin(i), 0.2 * cos(i), -2.0 - 0.5 * i}, u[3] = {1.2 + 0.1 * i, 0.2, 0}, v[3] = {0.1, 0.9 + 0.1 * i, 0};
        panes_add(l, kinds[i % 3], middle, u, v);
    }
    panes_add(l, PANE_GLASS, (const double[3]){-4.2, 0, -4}, (const double[3]){0.5, 0, 0.8}, (const double[3]){0, 1, 0});
    panes_add(l, PANE_GLASS, (const double[3]){-4.2, 0, -4}, (const double[3]){0.5, 0, -0.8}, (const double[3]){0, 1, 0});
}

static void what_has_no_pieces_stands_between_them_by_its_distance(void **state)
{
    bed *b = *state;
    static const render_mode modes[3] = {RENDER_SHADED, RENDER_ITEMS, RENDER_OVERDRAW};
    pane_list l = {.count = 0};
    shown s;
    stack(&l);
    show_list(b, &l, &s);
    assert_int_equal(s.s->mover_count, 3);
    b->camera = looking(0, 0, 0);
    for (int cut = 0; cut < 2; ++cut) {
        b->scissor = cut ? SCISSOR_ZONES : SCISSOR_NONE;
        for (int m = 0; m < 3; ++m) {
            assert_int_equal(take_pieces(b, &s, NULL), RESULT_OK);
            draw(b, &s, modes[m], b->pictures[0]);
            assert_int_equal(take_pieces(b, &s, s.tree.lent), RESULT_OK);
            draw(b, &s, modes[m], b->pictures[1]);
            assert_true(assert_apart_at_sides_only(b, &l) < PIXELS / 1000);
        }
    }
    show_no_more(&s);
}

// ---- Cullers that lie ----

typedef struct liar { cull_pieces lent; const cull_pieces *true_ones; uint32_t how; } liar;

static void lie(const cull_pieces *p, const cull_piece_request *q)
{
    const liar *l = (const liar *)(const void *)p;
    l->true_ones->order(l->true_ones, q);
    if (l->how == 0) q->numbers[0] = q->numbers[q->count - 1];
    if (l->how == 1) q->numbers[q->count / 2] = p->piece_count;
    if (l->how == 2) q->numbers[0] = UINT32_MAX;
}

static void an_order_that_is_no_permutation_is_told_and_not_used(void **state)
{
    bed *b = *state;
    for (uint32_t how = 0; how < 3; ++how) {
        pane_list l = {.count = 0};
        shown s;
        panes_random(&l, 12, 3);
        draw_by_distance(b, &l, &s);
        liar bad = {*s.tree.lent, s.tree.lent, how};
        bad.lent.order = lie;
        assert_int_equal(take_pieces(b, &s, &bad.lent), RESULT_OK);
        b->lines.count = 0;
        assert_by_distance(b, &s);
        assert_by_distance(b, &s);
        assert_int_equal(b->lines.count, 1);
        show_no_more(&s);
    }
}

static void pieces_that_do_not_cover_their_item_are_told_and_not_used(void **state)
{
    bed *b = *state;
    pane_list l = {.count = 0};
    shown s;
    panes_cyclic(&l);
    draw_by_distance(b, &l, &s);
    cull_pieces lent = *s.tree.lent;
    cull_piece *pieces = malloc((lent.piece_count + 3) * sizeof *pieces);
    memcpy(pieces, lent.pieces, lent.piece_count * sizeof *pieces);
    for (uint32_t i = 0; i < lent.piece_count; ++i) pieces[i] = lent.pieces[0]; // one piece for all, again and again
    lent.pieces = pieces;
    b->lines.count = 0;
    assert_int_equal(take_pieces(b, &s, &lent), RESULT_OK);
    assert_int_equal(b->lines.count, 1);
    assert_by_distance(b, &s);
    show_no_more(&s);
    free(pieces);
}

static void pieces_with_wrong_numbers_are_found(void **state)
{
    (void)state;
    const double points[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, bad[3][3] = {{0, 0, 0}, {1, NAN, 0}, {0, 1, 0}};
    const cull_piece good = {0, 0, 3, 0}, other_item = {1, 0, 3, 0}, two = {0, 0, 2, 0}, beyond = {0, 1, 3, 0}, wraps = {0, 2, UINT32_MAX, 0};
    const cull_piece *wrong[] = {&other_item, &two, &beyond, &wraps};
    cull_pieces p = {.pieces = &good, .points = points, .piece_count = 1, .point_count = 3, .order = lie};
    assert_null(pieces_fault(&p, 1));
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
        p.pieces = wrong[i];
        assert_non_null(pieces_fault(&p, 1));
    }
    p.pieces = &good;
    p.points = bad;
    assert_non_null(pieces_fault(&p, 1));
    p.points = NULL;
    assert_non_null(pieces_fault(&p, 1));
    p = (cull_pieces){.pieces = &good, .points = points, .piece_count = 1, .point_count = 3};
    assert_non_null(pieces_fault(&p, 1));
}

static void without_memory_panes_go_by_distance_and_nothing_is_lost(void **state)
{
    bed *b = *state;
    pane_list l = {.count = 0};
    shown s;
    panes_cyclic(&l);
    draw_by_distance(b, &l, &s);
    assert_int_equal(take_pieces(b, &s, NULL), RESULT_OK);
    result done = RESULT_NO_MEMORY;
    uint64_t failed = 0;
    for (; done != RESULT_OK; ++failed) {
        assert_true(failed < 200);
        const uint64_t live = b->memory.live_bytes;
        b->memory.fail_at = b->memory.calls + failed + 1;
        done = take_pieces(b, &s, s.tree.lent);
        b->memory.fail_at = 0;
        if (done == RESULT_OK) break;
        assert_int_equal(done, RESULT_NO_MEMORY);
        assert_int_equal(b->memory.live_bytes, live);
        if (failed % 8 == 0) assert_by_distance(b, &s);
    }
    assert_true(failed > 10);
    show_no_more(&s);
}

static void a_frame_takes_no_memory(void **state)
{
    bed *b = *state;
    pane_list l = {.count = 0};
    shown s;
    panes_random(&l, 40, 2);
    draw_by_distance(b, &l, &s);
    const uint64_t calls = b->memory.calls;
    draw(b, &s, RENDER_SHADED, b->pictures[1]);
    assert_int_equal(b->memory.calls, calls);
    show_no_more(&s);
}

static int setup(void **state)
{
    bed *b = calloc(1, sizeof *b);
    if (!b) return -1;
    failing_allocator_init(&b->memory, 0);
    report_lines_init(&b->lines);
    for (int i = 0; i < 2; ++i) b->pictures[i] = malloc(BYTES);
    *state = b;
    return renderer_open(NULL, &b->memory.memory, &b->lines.report, &b->g) == RESULT_OK ? 0 : -1;
}

static int teardown(void **state)
{
    bed *b = *state;
    const uint32_t errors = renderer_errors(b->g);
    renderer_close(b->g);
    const int is_clean = failing_allocator_is_clean(&b->memory);
    for (int i = 0; i < 2; ++i) free(b->pictures[i]);
    free(b);
    return errors || !is_clean ? -1 : 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(each_pixel_of_a_pane_is_in_one_of_its_pieces, setup, teardown),
        cmocka_unit_test_setup_teardown(what_has_no_pieces_stands_between_them_by_its_distance, setup, teardown),
        cmocka_unit_test_setup_teardown(pieces_given_back_leave_the_picture_by_distance, setup, teardown),
        cmocka_unit_test_setup_teardown(a_scene_that_is_opaque_takes_no_pieces, setup, teardown),
        cmocka_unit_test_setup_teardown(an_order_that_is_no_permutation_is_told_and_not_used, setup, teardown),
        cmocka_unit_test_setup_teardown(pieces_that_do_not_cover_their_item_are_told_and_not_used, setup, teardown),
        cmocka_unit_test(pieces_with_wrong_numbers_are_found),
        cmocka_unit_test_setup_teardown(without_memory_panes_go_by_distance_and_nothing_is_lost, setup, teardown),
        cmocka_unit_test_setup_teardown(a_frame_takes_no_memory, setup, teardown),
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
