// The order of a tree's pieces, held against rays: whatever pieces a ray meets stand in the order of their depths.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "../common/failing_allocator.h"
#include "../common/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { EYES = 60, RAYS = 120 };
static const double EDGE_M = 1e-5;  // hits nearer than this to a piece's edge are not looked at: there rounding decides
static const double DEPTH_M = 1e-5; // two hits nearer than this are one: vertices are floats, a few metres from the origin

typedef struct ordered { // of one eye
    uint32_t *numbers;
    void *scratch;
    uint32_t count;
} ordered;

static ordered order_all(const zone_chain *t, const double eye[4], cull_depth_order depth_order)
{
    const cull_pieces *p = t->lent;
    ordered o = {malloc((p->piece_count + 1) * sizeof(uint32_t)), aligned_alloc(64, p->scratch_size + 64), p->piece_count};
    assert_non_null(o.numbers);
    assert_non_null(o.scratch);
    memset(o.scratch, 0xa5, p->scratch_size);
    for (uint32_t i = 0; i < o.count; ++i) o.numbers[i] = i;
    const cull_piece_request q = {{eye[0], eye[1], eye[2], eye[3]}, o.numbers, o.scratch, o.count, depth_order};
    p->order(p, &q);
    return o;
}

static void ordered_free(ordered *o)
{
    free(o->numbers);
    free(o->scratch);
}

static void assert_permutation(const ordered *o)
{
    uint8_t *seen = calloc(o->count + 1, 1);
    for (uint32_t i = 0; i < o->count; ++i) {
        assert_true(o->numbers[i] < o->count);
        assert_false(seen[o->numbers[i]]++);
    }
    free(seen);
}

// Where the ray meets the piece well inside; INFINITY: it does not.
static double hit(const cull_pieces *p, uint32_t number, const double from[3], const double along[3])
{
    const cull_piece *piece = &p->pieces[number];
    const double(*at)[3] = p->points + piece->first_point;
    double n[3] = {0}, size = 0, facing = 0, height = 0, point[3];
    for (uint32_t i = 2; i < piece->point_count; ++i)
        for (int k = 0; k < 3; ++k) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            n[k] += (at[i - 1][a] - at[0][a]) * (at[i][b] - at[0][b]) - (at[i - 1][b] - at[0][b]) * (at[i][a] - at[0][a]);
        }
    for (int k = 0; k < 3; ++k) size += n[k] * n[k];
    size = sqrt(size);
    if (!(size > 1e-9)) return INFINITY;
    for (int k = 0; k < 3; ++k) {
        n[k] /= size;
        facing += n[k] * along[k];
        height += n[k] * (at[0][k] - from[k]);
    }
    const double t = height / facing;
    if (fabs(facing) < 1e-3 || t < 1e-4) return INFINITY;
    for (int k = 0; k < 3; ++k) point[k] = from[k] + t * along[k];
    for (uint32_t i = 0; i < piece->point_count; ++i) {
        const double *a = at[i], *b = at[(i + 1) % piece->point_count];
        double inside = 0, edge = 0;
        for (int k = 0; k < 3; ++k) {
            const int u = (k + 1) % 3, v = (k + 2) % 3;
            inside += n[k] * ((b[u] - a[u]) * (point[v] - a[v]) - (b[v] - a[v]) * (point[u] - a[u]));
            edge += (b[k] - a[k]) * (b[k] - a[k]);
        }
        if (inside < EDGE_M * sqrt(edge)) return INFINITY;
    }
    return t;
}

// Returns the pairs of hits that came in order.
static uint32_t follow_ray(const zone_chain *t, const ordered *o, const double from[3], const double along[3])
{
    double last = INFINITY;
    uint32_t pairs = 0;
    for (uint32_t i = 0; i < o->count; ++i) {
        const double depth = hit(t->lent, o->numbers[i], from, along);
        if (depth == INFINITY) continue;
        assert_true(depth <= last + DEPTH_M);
        pairs += last != INFINITY;
        last = depth;
    }
    return pairs;
}

// Anywhere in the scene's box and a little beyond; every third in the plane of a piece, or at a corner of one.
static void random_eye(const zone_chain *t, uint64_t *seed, double out[4])
{
    const cull_pieces *p = t->lent;
    const cull_box *box = &t->zone.zone.box;
    const double low[3] = {box->min.x, box->min.y, box->min.z}, high[3] = {box->max.x, box->max.y, box->max.z};
    for (int k = 0; k < 3; ++k) out[k] = random_between(seed, low[k] - 2, high[k] + 2);
    out[3] = 1;
    if (random_below(seed, 3)) return;
    const cull_piece *piece = &p->pieces[random_below(seed, p->piece_count)];
    const double(*at)[3] = p->points + piece->first_point;
    const double a = random_below(seed, 2) ? random_between(seed, -2, 2) : 0, b = a == 0 ? 0 : random_between(seed, -2, 2);
    for (int k = 0; k < 3; ++k) out[k] = at[0][k] + a * (at[1][k] - at[0][k]) + b * (at[2][k] - at[0][k]);
}

static void random_point(const zone_chain *t, uint64_t *seed, double out[3])
{
    const cull_box *box = &t->zone.zone.box;
    const double low[3] = {box->min.x, box->min.y, box->min.z}, high[3] = {box->max.x, box->max.y, box->max.z};
    for (int k = 0; k < 3; ++k) out[k] = random_between(seed, low[k], high[k]);
}

static uint32_t follow_eye(const zone_chain *t, const ordered *o, const double eye[4], uint64_t *seed)
{
    uint32_t pairs = 0;
    for (int i = 0; i < RAYS; ++i) {
        double at[3], along[3], size = 0;
        random_point(t, seed, at);
        for (int k = 0; k < 3; ++k) {
            along[k] = at[k] - eye[k];
            size += along[k] * along[k];
        }
        for (int k = 0; k < 3; ++k) along[k] /= sqrt(size);
        pairs += follow_ray(t, o, eye, along);
    }
    return pairs;
}

typedef void check(const zone_chain *t, uint64_t seed);

static void each_tree(check *run)
{
    for (uint32_t s = 0; s < pane_scene_count; ++s) {
        pane_list l = {.count = 0};
        pane_scenes[s].make(&l);
        scene *made = panes_build(&l, AS_THEY_ARE, allocator_heap());
        for (uint32_t w = 0; w < piece_chain_count; ++w) {
            zone_chain t;
            zone_chain_open(made, 0, piece_chains[w], &t);
            assert_non_null(t.lent);
            run(&t, 1000 * s + w);
            zone_chain_close(&t);
        }
        scene_free(made, allocator_heap());
    }
}

static void check_far_first(const zone_chain *t, uint64_t seed)
{
    uint32_t pairs = 0;
    for (int i = 0; i < EYES; ++i) {
        double eye[4];
        random_eye(t, &seed, eye);
        ordered o = order_all(t, eye, CULL_FAR_FIRST);
        assert_permutation(&o);
        pairs += follow_eye(t, &o, eye, &seed);
        ordered_free(&o);
    }
    assert_true(pairs > 100);
}

static void far_first_a_ray_meets_what_comes_later_nearer(void **state)
{
    (void)state;
    each_tree(check_far_first);
}

static void check_near_first(const zone_chain *t, uint64_t seed)
{
    for (int i = 0; i < EYES / 4; ++i) {
        double eye[4];
        random_eye(t, &seed, eye);
        ordered o = order_all(t, eye, CULL_NEAR_FIRST);
        assert_permutation(&o);
        for (uint32_t k = 0; k < o.count / 2; ++k) { // far first, if it is right
            const uint32_t kept = o.numbers[k];
            o.numbers[k] = o.numbers[o.count - 1 - k];
            o.numbers[o.count - 1 - k] = kept;
        }
        follow_eye(t, &o, eye, &seed);
        ordered_free(&o);
    }
}

static void near_first_is_the_other_way_round(void **state)
{
    (void)state;
    each_tree(check_near_first);
}

static void check_direction(const zone_chain *t, uint64_t seed)
{
    for (int i = 0; i < EYES / 4; ++i) {
        double eye[4] = {0};
        random_direction(&seed, eye);
        ordered o = order_all(t, eye, CULL_FAR_FIRST);
        assert_permutation(&o);
        for (int k = 0; k < RAYS; ++k) {
            const double along[3] = {-eye[0], -eye[1], -eye[2]};
            double from[3];
            random_point(t, &seed, from);
            for (int c = 0; c < 3; ++c) from[c] += 50 * eye[c];
            follow_ray(t, &o, from, along);
        }
        ordered_free(&o);
    }
}

static void an_eye_without_end_sees_the_order_along_its_direction(void **state)
{
    (void)state;
    each_tree(check_direction);
}

static void check_subset(const zone_chain *t, uint64_t seed)
{
    const cull_pieces *p = t->lent;
    for (int i = 0; i < EYES / 4; ++i) {
        double eye[4];
        random_eye(t, &seed, eye);
        ordered all = order_all(t, eye, CULL_FAR_FIRST), some = order_all(t, eye, CULL_NEAR_FIRST);
        uint8_t *chosen = calloc(p->piece_count, 1);
        uint32_t count = 0;
        for (uint32_t k = 0; k < p->piece_count; ++k) chosen[k] = (uint8_t)random_below(&seed, 2);
        for (uint32_t k = 0; k < p->piece_count; ++k) // in the order of another question
            if (chosen[some.numbers[k]]) some.numbers[count++] = some.numbers[k];
        const cull_piece_request q = {{eye[0], eye[1], eye[2], eye[3]}, some.numbers, some.scratch, count, CULL_FAR_FIRST};
        p->order(p, &q);
        uint32_t next = 0;
        for (uint32_t k = 0; k < p->piece_count; ++k)
            if (chosen[all.numbers[k]]) assert_int_equal(some.numbers[next++], all.numbers[k]);
        assert_int_equal(next, count);
        free(chosen);
        ordered_free(&all);
        ordered_free(&some);
    }
}

static void a_part_of_the_pieces_keeps_the_order_of_all_however_it_is_asked_for(void **state)
{
    (void)state;
    each_tree(check_subset);
}

static void check_cover(const zone_chain *t, uint64_t seed)
{
    (void)seed;
    const cull_pieces *p = t->lent;
    const cull_zone *zone = &t->zone.zone;
    double *areas = calloc(zone->item_count, sizeof *areas);
    for (uint32_t i = 0; i < p->piece_count; ++i) {
        const double(*at)[3] = p->points + p->pieces[i].first_point;
        double n[3] = {0};
        for (uint32_t c = 2; c < p->pieces[i].point_count; ++c)
            for (int k = 0; k < 3; ++k) {
                const int a = (k + 1) % 3, b = (k + 2) % 3;
                n[k] += (at[c - 1][a] - at[0][a]) * (at[c][b] - at[0][b]) - (at[c - 1][b] - at[0][b]) * (at[c][a] - at[0][a]);
            }
        areas[p->pieces[i].item] += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    }
    for (uint32_t place = 0; place < zone->item_count; ++place) {
        const cull_item *item = &zone->items[zone_chain_item(t, place)];
        double area = 0;
        for (uint32_t k = item->first_index; k < item->first_index + item->index_count; k += 3) {
            const cull_vec3 a = zone->positions[zone->indices[k]], b = zone->positions[zone->indices[k + 1]], c = zone->positions[zone->indices[k + 2]];
            const double u[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z}, v[3] = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z};
            area += sqrt(pow(u[1] * v[2] - u[2] * v[1], 2) + pow(u[2] * v[0] - u[0] * v[2], 2) + pow(u[0] * v[1] - u[1] * v[0], 2));
        }
        assert_true(fabs(areas[place] - area) < 1e-5 * area);
    }
    free(areas);
}

static void the_pieces_of_an_item_cover_it_once(void **state)
{
    (void)state;
    each_tree(check_cover);
}

static void only_trees_that_split_lend_pieces(void **state)
{
    (void)state;
    pane_list l = {.count = 0};
    panes_boxes(&l);
    scene *s = panes_build(&l, AS_THEY_ARE, allocator_heap());
    static const char *const others[] = {"bsp", "bsp[split=0]", "brute", "none"};
    for (uint32_t i = 0; i < sizeof others / sizeof *others; ++i) {
        zone_chain t;
        zone_chain_open(s, 0, others[i], &t);
        assert_null(t.lent);
        zone_chain_close(&t);
    }
    scene_free(s, allocator_heap());
}

static void without_memory_nothing_is_left(void **state)
{
    (void)state;
    pane_list l = {.count = 0};
    panes_crossing(&l);
    scene *s = panes_build(&l, AS_THEY_ARE, allocator_heap());
    zone_chain t;
    zone_chain_open(s, 0, piece_chains[0], &t); // for its loader and spec
    result made = RESULT_NO_MEMORY;
    for (uint64_t at = 1; made != RESULT_OK; ++at) {
        failing_allocator failing;
        report quiet = {0};
        host_services services;
        chain *c = NULL;
        failing_allocator_init(&failing, at);
        host_services_fill(&services, &failing.memory, &quiet);
        made = chain_build(&(chain_request){&t.spec, &t.zone, t.plugins, &services, NULL}, &quiet, &c);
        assert_true(made == RESULT_OK || made == RESULT_NO_MEMORY);
        if (made == RESULT_OK) chain_close(c);
        assert_true(failing_allocator_is_clean(&failing));
        assert_true(at < 10000);
    }
    zone_chain_close(&t);
    scene_free(s, allocator_heap());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(far_first_a_ray_meets_what_comes_later_nearer),
        cmocka_unit_test(near_first_is_the_other_way_round),
        cmocka_unit_test(an_eye_without_end_sees_the_order_along_its_direction),
        cmocka_unit_test(a_part_of_the_pieces_keeps_the_order_of_all_however_it_is_asked_for),
        cmocka_unit_test(the_pieces_of_an_item_cover_it_once),
        cmocka_unit_test(only_trees_that_split_lend_pieces),
        cmocka_unit_test(without_memory_nothing_is_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
