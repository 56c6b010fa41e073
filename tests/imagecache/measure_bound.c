// Not a test: how tight the bounds of plugins/imagecache are, and how far an eye may move, by hand:
//     measure_bound [CASES] [SEED]
// Ratios are bound over the true maximum, found on a grid over the box (so a little too large where the grid is coarse).
// SPDX-License-Identifier: MIT
#include "bound_baselines.h"

#include "tests/common/random.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SIDE = 17, POINTS = 6 * SIDE * SIDE };

typedef enum form { FORM_QUAD, FORM_INSIDE, FORM_TURNED, FORM_WITHIN, FORM_PAGE, FORM_CORNERS, FORM_CENTRE, FORM_DEPTH, FORMS } form;
static const char *const names[FORMS] = {"quad, this view", "quad, this view, node inside", "quad, any view", "quad, eye anywhere within",
                                         "the page's formula, any view", "8 corners (baseline)", "centre alignment", "kept depth"};

typedef struct ratios {
    double *values, worst_violation;
    uint32_t count, unbounded, violations;
} ratios;

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void add(ratios *to, double bound, double truth)
{
    // Only what matters to a tolerance: below a hundredth of a pixel the rounding terms stand alone, above 16 no picture is kept.
    if (!(truth > 0.1 && truth < 16)) return;
    if (!(bound < INFINITY)) {
        to->unbounded++;
        return;
    }
    if (truth > bound * (1 + 1e-4)) { // the baselines leave rounding out
        to->violations++;
        if (truth / bound > to->worst_violation) to->worst_violation = truth / bound;
    }
    to->values[to->count++] = bound / truth;
}

// Over all ways to look and all eyes within `distance`: section "the eye anywhere near" of bound.c, one point at a time.
static double within_tangent(const bound_case *c, double distance, const double point[3])
{
    double x[3], q[3];
    const case_image image = image_of(&c->quad, c->capture.eye, point);
    for (int k = 0; k < 3; k++) {
        x[k] = point[k] - c->capture.eye[k];
        q[k] = (double)image.point[k] - c->capture.eye[k];
    }
    const double near = sqrt(bound_dot(x, x)), far = sqrt(bound_dot(q, q)), r2 = distance * distance;
    return distance * fabs(near - far) / sqrt((near * near - r2) * (far * far - r2));
}

static void measure_quad(const bound_case *c, ratios to[FORMS])
{
    uint32_t outside = 0;
    double here = 0, turned = 0, within = 0, deep = 0, moved[3], point[3];
    bound_subtract(c->view.eye, c->capture.eye, moved);
    const double distance = sqrt(bound_dot(moved, moved)), step = c->capture.distance / 64;
    for (uint32_t i = 0; i < POINTS; i++) {
        case_grid_point(&c->box, i, SIDE, point);
        const double off = shown_off_px(c, point);
        if (off < 0) outside++;
        here = fmax(here, off);
        turned = fmax(turned, bound_pixels(shown_off_tangent(c, c->view.eye, point), &c->view.optics));
        within = fmax(within, bound_pixels(within_tangent(c, distance, point), &c->view.optics));
        deep = fmax(deep, fmax(deep_off_px(c, point, step / 2), deep_off_px(c, point, -step / 2)));
    }
    add(&to[FORM_QUAD], bound_quad_px(&c->capture, &c->view), here);
    if (outside == 0) add(&to[FORM_INSIDE], bound_quad_px(&c->capture, &c->view), here);
    add(&to[FORM_TURNED], bound_turned_px(&c->capture, c->view.eye, &c->view.optics), turned);
    add(&to[FORM_WITHIN], bound_within_px(&c->capture, distance, &c->view.optics), within);
    add(&to[FORM_PAGE], baseline_page_px(&c->capture, c->view.eye, &c->view.optics), turned);
    add(&to[FORM_CORNERS], baseline_corners_px(c), turned);
    add(&to[FORM_DEPTH], bound_depth_px(&c->capture, &c->view, step), deep);
}

static void measure_centre(const bound_case *c, ratios *to)
{
    quad taken, shown;
    quad_request request = {.box = c->box, .optics = c->taken.optics, .magnification = 1, .most_texels = 1u << 20};
    double most = 0, point[3];
    for (int k = 0; k < 3; k++) request.eye[k] = c->capture.eye[k];
    if (quad_aligned_of(&request, &c->taken, &taken) != QUAD_OK) return;
    shown = quad_aligned_shown(&taken, &c->view);
    for (uint32_t i = 0; i < POINTS; i++) {
        case_grid_point(&c->box, i, SIDE, point);
        most = fmax(most, aligned_off_px(c, &taken, &shown, point));
    }
    add(to, bound_centre_px(&c->capture, &c->taken, &c->view), most);
}

static void print_ratios(form which, ratios *r)
{
    if (r->count == 0) return;
    qsort(r->values, r->count, sizeof *r->values, ascending);
    printf("%-30s %8u  p10 %.3f  median %.3f  p90 %.3f  violations %u (%.1f%%, worst %.2f)  unbounded %u\n", names[which], r->count,
           r->values[r->count / 10], r->values[r->count / 2], r->values[(uint64_t)r->count * 9 / 10], r->violations,
           100.0 * r->violations / r->count, r->worst_violation, r->unbounded);
}

static double now_ns(void) // CPU time: the machine may be busy
{
    return (double)clock() * (1e9 / CLOCKS_PER_SEC);
}

static void print_times(uint64_t seed)
{
    enum { CASES = 256, ROUNDS = 400 };
    static bound_case cases[CASES];
    double sum = 0, ns[5];
    for (uint32_t i = 0; i < CASES; i++) cases[i] = case_random(&seed, MOTION_ANY);
    for (int which = 0; which < 5; which++) {
        const double start = now_ns();
        for (int round = 0; round < ROUNDS; round++) {
            for (uint32_t i = 0; i < CASES; i++) {
                const bound_case *c = &cases[i];
                if (which == 0) sum += bound_quad_px(&c->capture, &c->view);
                if (which == 1) sum += bound_turned_px(&c->capture, c->view.eye, &c->view.optics);
                if (which == 2) sum += bound_reach_of_eye(&c->capture, 1, &c->view.optics);
                if (which == 3) sum += bound_centre_px(&c->capture, &c->taken, &c->view);
                if (which == 4) sum += bound_capture_of(c->taken.eye, &c->box).distance;
            }
        }
        ns[which] = (now_ns() - start) / (CASES * ROUNDS);
    }
    printf("ns a node: this view %.0f, any view %.0f, reach of the eye %.0f, centre %.0f, preparing %.0f%s\n", ns[0], ns[1], ns[2], ns[3],
           ns[4], sum > 0 ? "" : " ");
}

// The table of section 1.10: a cell of 10 x 8 x 10 m, 1280 px, 60 degrees wide, 1 px, 1.5 m/s at 60 Hz.
static void print_moves(void)
{
    const double wide = tan(3.14159265358979 / 6), tall = wide * 720 / 1280;
    const bound_optics places[3] = {{640 / wide, sqrt(1 + wide * wide + tall * tall)}, {640 / wide, sqrt(1 + wide * wide)}, {640 / wide, 1}};
    const cull_box box = {{-5, -4, -5}, {5, 4, 5}};
    printf("allowed move for 1 px, cell 10x8x10 m, 1280x720, 60 degrees wide; any direction of motion, any heading\n");
    printf("distance  to the corners  frames  to the sides  frames  in the middle  frames  the page's formula, to the sides\n");
    for (double distance = 20; distance <= 320; distance *= 2) {
        const double eye[3] = {distance, 0, 0};
        const bound_capture capture = bound_capture_of(eye, &box);
        double low = 0, high = distance / 2;
        for (int i = 0; i < 60; i++) {
            const double try = (low + high) / 2, at[3] = {distance, 0, try};
            if (baseline_page_px(&capture, at, &places[1]) <= 1) low = try;
            else high = try;
        }
        printf("%6.0f m", distance);
        for (int i = 0; i < 3; i++) {
            const double reach = bound_reach_of_eye(&capture, 1, &places[i]);
            printf(" %12.3f m %7.0f", reach, bound_frames(reach, 0.025));
        }
        printf(" %10.3f m\n", low);
    }
}

int main(int argc, char **argv)
{
    const uint32_t cases = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 4000;
    uint64_t state = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
    ratios all[FORMS] = {{0}};
    for (int i = 0; i < FORMS; i++) all[i].values = calloc(cases, sizeof(double));
    for (uint32_t i = 0; i < cases; i++) {
        const bound_case any = case_random(&state, MOTION_ANY), near = case_random(&state, MOTION_CENTRE);
        measure_quad(&any, all);
        measure_centre(&near, &all[FORM_CENTRE]);
    }
    printf("bound / true maximum, %u cases, those of 0.1 to 16 px\n", cases);
    for (form i = 0; i < FORMS; i++) {
        print_ratios(i, &all[i]);
        free(all[i].values);
    }
    print_moves();
    print_times(state);
    return 0;
}
