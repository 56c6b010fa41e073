// Which panes are drawn whole: rays meet what later groups hold nearer, and only knots are groups of several.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "host/render/whole_order.h"

#include "../common/failing_allocator.h"
#include "../common/random.h"

#include <math.h>
#include <stdlib.h>

enum { EYES = 100, RAYS = 300 };
static const double DEPTH_M = 1e-5; // corners are floats, a few metres from the origin

typedef struct bed {
    pane_list l;
    scene *s;
    whole_order w;
    uint32_t rows[PANES_MOST], out[PANES_MOST], ends[PANES_MOST], groups;
} bed;

static void open_bed(bed *b)
{
    b->s = panes_build(&b->l, AS_THEY_ARE, allocator_heap());
    for (uint32_t i = 0; i < b->l.count; ++i) b->rows[i] = i;
    assert_int_equal(whole_order_open(&(whole_request){b->s, b->rows, b->l.count}, allocator_heap(), &b->w), RESULT_OK);
}

static void close_bed(bed *b)
{
    whole_order_close(&b->w, allocator_heap());
    scene_free(b->s, allocator_heap());
}

// From the world's origin; the order wants it from the scene's.
static void look(bed *b, const double eye[3])
{
    double at[3];
    for (int k = 0; k < 3; ++k) at[k] = eye[k] - b->s->whole.origin[k];
    b->groups = whole_order_run(&b->w, &(whole_picture){at, b->rows, b->l.count}, b->out, b->ends);
}

static void assert_groups_hold_all(const bed *b)
{
    uint32_t seen[PANES_MOST] = {0};
    assert_true(b->groups > 0 && b->groups <= b->l.count);
    assert_int_equal(b->ends[b->groups - 1], b->l.count);
    for (uint32_t g = 1; g < b->groups; ++g) assert_true(b->ends[g] > b->ends[g - 1]);
    for (uint32_t i = 0; i < b->l.count; ++i) assert_int_equal(seen[b->out[i]]++, 0);
}

// Hits of earlier groups lie behind those of later ones. Returns the pairs of groups looked at.
static uint32_t follow(const bed *b, const double eye[3], const double along[3])
{
    double nearest = INFINITY; // of the groups so far
    uint32_t pairs = 0;
    for (uint32_t g = 0, first = 0; g < b->groups; first = b->ends[g++]) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = first; i < b->ends[g]; ++i) {
            const double depth = pane_hit(&b->l.panes[b->out[i]], eye, along);
            if (depth == INFINITY) continue;
            low = fmin(low, depth);
            high = fmax(high, depth);
        }
        if (low == INFINITY) continue;
        assert_true(high <= nearest + DEPTH_M);
        pairs += nearest != INFINITY;
        nearest = low;
    }
    return pairs;
}

static uint32_t follow_eyes(bed *b, uint64_t seed)
{
    uint32_t pairs = 0;
    for (int e = 0; e < EYES; ++e) {
        double eye[3] = {random_between(&seed, -4, 4), random_between(&seed, -4, 4), random_between(&seed, -9, 1)};
        const pane *p = &b->l.panes[random_below(&seed, b->l.count)];
        const double a = random_between(&seed, -2, 2), c = random_between(&seed, -2, 2);
        for (int k = 0; k < 3 && e % 4 == 0; ++k) // in the plane of a pane
            eye[k] = p->points[0][k] + a * (p->points[1][k] - p->points[0][k]) + c * (p->points[3][k] - p->points[0][k]);
        look(b, eye);
        assert_groups_hold_all(b);
        for (int i = 0; i < RAYS; ++i) {
            const double along[3] = {random_between(&seed, -3, 3) - eye[0], random_between(&seed, -3, 3) - eye[1], random_between(&seed, -7, -3) - eye[2]};
            pairs += follow(b, eye, along);
        }
    }
    return pairs;
}

static void a_ray_meets_later_groups_nearer(void **state)
{
    (void)state;
    static bed b;
    uint32_t pairs = 0;
    for (uint32_t i = 0; i < pane_scene_count; ++i) {
        b.l.count = 0;
        pane_scenes[i].make(&b.l);
        open_bed(&b);
        pairs += follow_eyes(&b, i);
        close_bed(&b);
    }
    for (uint64_t seed = 1; seed < 40; ++seed) { // few, so that many stand free of each other
        b.l.count = 0;
        panes_random(&b.l, 4, seed);
        open_bed(&b);
        pairs += follow_eyes(&b, seed);
        close_bed(&b);
    }
    assert_true(pairs > 10000);
}

static void boxes_in_boxes_are_all_drawn_whole(void **state)
{
    (void)state;
    static bed b;
    uint64_t seed = 3;
    b.l.count = 0;
    for (int i = 0; i < 4; ++i) {
        const double half = 2 - 0.4 * i;
        panes_add_box(&b.l, (const double[3]){-half, -half, -5 - half}, (const double[3]){half, half, -5 + half});
    }
    open_bed(&b);
    for (int e = 0; e < EYES; ++e) {
        const double eye[3] = {random_between(&seed, -4, 4), random_between(&seed, -4, 4), random_between(&seed, -9, 1)};
        look(&b, eye);
        assert_int_equal(b.groups, b.l.count);
    }
    close_bed(&b);
}

static void panes_each_over_the_next_are_one_knot(void **state)
{
    (void)state;
    static bed b;
    b.l.count = 0;
    panes_cyclic(&b.l);
    open_bed(&b);
    look(&b, (const double[3]){0, 0, 0});
    assert_int_equal(b.groups, 1);
    close_bed(&b);
}

static void panes_in_a_row_are_none(void **state)
{
    (void)state;
    static bed b;
    b.l.count = 0;
    for (int i = 0; i < 5; ++i) panes_add(&b.l, PANE_GLASS, (const double[3]){0.1 * i, 0, -3.0 - i}, (const double[3]){2, 0.1, 0}, (const double[3]){0, 1, 0.05});
    open_bed(&b);
    look(&b, (const double[3]){0, 0, 0});
    assert_int_equal(b.groups, 5);
    for (uint32_t i = 0; i < 5; ++i) assert_int_equal(b.out[i], 4 - i);
    look(&b, (const double[3]){0, 0, -20});
    for (uint32_t i = 0; i < 5; ++i) assert_int_equal(b.out[i], i);
    close_bed(&b);
}

static void too_many_have_no_rows_and_no_memory_leaves_nothing(void **state)
{
    (void)state;
    static bed b;
    static uint32_t many[WHOLE_ROWS_MOST + 1];
    whole_order w;
    result made = RESULT_NO_MEMORY;
    b.l.count = 0;
    panes_crossing(&b.l);
    open_bed(&b);
    assert_int_equal(whole_order_open(&(whole_request){b.s, many, WHOLE_ROWS_MOST + 1}, allocator_heap(), &w), RESULT_OK);
    assert_int_equal(w.rows, 0);
    whole_order_close(&w, allocator_heap());
    for (uint64_t at = 1; made != RESULT_OK; ++at) {
        failing_allocator failing;
        failing_allocator_init(&failing, at);
        made = whole_order_open(&(whole_request){b.s, b.rows, b.l.count}, &failing.memory, &w);
        assert_true(made == RESULT_OK || made == RESULT_NO_MEMORY);
        if (made == RESULT_OK) whole_order_close(&w, &failing.memory);
        assert_true(failing_allocator_is_clean(&failing));
    }
    close_bed(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ray_meets_later_groups_nearer),
        cmocka_unit_test(boxes_in_boxes_are_all_drawn_whole),
        cmocka_unit_test(panes_each_over_the_next_are_one_knot),
        cmocka_unit_test(panes_in_a_row_are_none),
        cmocka_unit_test(too_many_have_no_rows_and_no_memory_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
