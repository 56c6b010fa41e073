// What leaves a zone through its portals, part by part, against rays that walk from room to room; and what a viewer's memory of it keeps.
// SPDX-License-Identifier: MIT
#include "flow_views.h"
#include "plugins/bsp/sight.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const bsp_cells ways[] = {BSP_CELLS_RECT, BSP_CELLS_HULL, BSP_CELLS_EXACT};
enum { WAYS = 3, PORTALS_MOST = 6 };

// ---- Grids, eyes, viewers ----

static void grid_of(uint64_t seed, grid_cells *g)
{
    uint64_t random = seed;
    grid_wish w = {.seed = seed, .open = random_between(&random, 0.3, 0.6), .shut = random_between(&random, 0, 0.2), .one_way = 0.05, .scale = 1,
                   .has_foreign = 1};
    for (int k = 0; k < 3; k++) w.size[k] = 2 + random_below(&random, 5);
    for (int k = 0; k < 3 && seed % 2; k++) {
        w.turn[k] = random_between(&random, -3, 3);
        w.move[k] = random_between(&random, -20, 20);
    }
    grid_make(&w, g);
}

typedef enum eye_place { EYE_ANYWHERE, EYE_ON_PLANES, EYE_IN_FOREIGN, EYE_PLACES } eye_place;

static void room_at(const grid_cells *g, uint32_t room, uint32_t at[3])
{
    at[0] = room % g->size[0];
    at[1] = room / g->size[0] % g->size[1];
    at[2] = room / g->size[0] / g->size[1];
}

static flow_aim aim_of(const grid_cells *g, eye_place place, uint64_t *random)
{
    static const double spans[3][2] = {{1.03, 0.58}, {1, 1}, {3, 2}};
    flow_aim a = {.near_distance = 0.001};
    uint32_t room[3];
    room_at(g, g->foreign, room);
    for (int k = 0; k < 3; k++) {
        a.eye[k] = random_between(random, g->places[k][0] + 0.01, g->places[k][g->size[k]] - 0.01);
        if (place == EYE_IN_FOREIGN) a.eye[k] = random_between(random, g->places[k][room[k]] + 0.01, g->places[k][room[k] + 1] - 0.01);
        if (place == EYE_ON_PLANES && g->size[k] > 1 && random_bits(random) & 1) a.eye[k] = g->places[k][1 + random_below(random, g->size[k] - 1)];
        const double towards = (g->places[k][room[k]] + g->places[k][room[k] + 1]) / 2 - a.eye[k];
        a.forward[k] = random_between(random, -1, 1) + (place == EYE_IN_FOREIGN ? 0 : towards); // where portals are
    }
    if (a.forward[0] * a.forward[0] + a.forward[1] * a.forward[1] + a.forward[2] * a.forward[2] < 0.01) a.forward[0] = 1;
    memcpy(a.tangents, spans[random_below(random, 3)], sizeof a.tangents);
    return a;
}

static void sight_make(const grid_cells *g, bsp_cells how, bsp_sight *out)
{
    const bsp_flow_request q = {.cells = &g->data, .index = &g->index, .zone = &g->zone, .how = how, .backface = 1, .exits = BSP_EXITS_KEPT};
    assert_int_equal(sight_open(grid_host(), &q, g->item_count, out), CULL_OK);
    memset(out->flow.scratch, 0xa5, out->scratch_bytes); // undefined content
}

// ---- Answers ----

typedef struct part { cull_plane planes[CULL_MAX_PLANES]; uint32_t count; } part;
typedef struct answer { part parts[CULL_MAX_PARTS]; uint32_t count, is_all; } answer; // is_all: SAME

static void expect_sound(const part *p)
{
    assert_in_range(p->count, 1, CULL_MAX_PLANES);
    for (uint32_t i = 0; i < p->count; i++) {
        const cull_vec3 n = p->planes[i].normal;
        const double square = (double)n.x * (double)n.x + (double)n.y * (double)n.y + (double)n.z * (double)n.z;
        assert_true(fabs(square - 1) < 1e-5 && isfinite(p->planes[i].offset));
    }
}

static void ask(bsp_sight *s, const cull_view *view, const cull_volume *in, uint32_t portal, answer *out)
{
    memset(out, 0, sizeof *out);
    for (;;) {
        part p;
        memset(&p, 0, sizeof p);
        const sight_question q = {view, in, portal, out->count};
        const cull_crossing seen = sight_part(s, &q, p.planes, &p.count);
        if (seen == CULL_CROSS_NONE) return;
        out->is_all = seen == CULL_CROSS_SAME;
        if (out->is_all) return;
        assert_int_equal(seen, CULL_CROSS_NARROW);
        assert_true(out->count < CULL_MAX_PARTS);
        expect_sound(&p);
        out->parts[out->count++] = p;
    }
}

static int holds(const answer *a, const double at[3])
{
    for (uint32_t i = 0; i < a->count; i++) {
        uint32_t k = 0;
        for (; k < a->parts[i].count; k++) {
            const cull_plane p = a->parts[i].planes[k];
            if ((double)p.normal.x * at[0] + (double)p.normal.y * at[1] + (double)p.normal.z * at[2] + (double)p.offset < 0) break;
        }
        if (k == a->parts[i].count) return 1;
    }
    return (int)a->is_all;
}

// ---- Rays ----

// Where the ray goes from room a to room b, posed.
static void step_point(const grid_cells *g, const flow_view *v, const double way[3], uint32_t a, uint32_t b, double out[3])
{
    uint32_t from[3], to[3];
    double at[3], t = 0;
    room_at(g, a, from);
    room_at(g, b, to);
    for (int k = 0; k < 3; k++)
        if (from[k] != to[k]) t = (g->places[k][from[k] > to[k] ? from[k] : to[k]] - v->eye_unposed[k]) / way[k];
    for (int k = 0; k < 3; k++) at[k] = v->eye_unposed[k] + t * way[k];
    grid_pose(g, at, out);
}

static uint32_t portal_of(const grid_cells *g, uint32_t room)
{
    uint32_t p = 0;
    while (p < g->zone.portal_count && g->data.stands[p].cell != room) p++;
    assert_true(p < g->zone.portal_count);
    return p;
}

typedef struct tally { uint32_t left, shut, parts, all; } tally; // rays that left; portals that nothing leaves through

static void rays_check(const grid_cells *g, const flow_view *v, const answer *answers, uint64_t seed, tally *sum)
{
    for (uint32_t i = 0; i < 300; i++) {
        grid_trace t;
        double way[3], at[3];
        flow_view_ray(g, v, random_between(&seed, -1, 1), random_between(&seed, -1, 1), way);
        (void)grid_trace_ray(g, v->eye_unposed, way, 1e-9, &t);
        for (uint32_t k = 0; k + 1 < t.room_count; k++) {
            if (t.rooms[k + 1] != g->foreign) continue;
            step_point(g, v, way, t.rooms[k], g->foreign, at);
            const uint32_t portal = portal_of(g, t.rooms[k]);
            if (!holds(&answers[portal], at)) fail_msg("ray %u leaves through portal %u outside of its %u parts", i, portal, answers[portal].count);
            sum->left++;
        }
    }
}

static void expect_rays_in_parts(eye_place place, tally *sum)
{
    for (uint64_t n = 1; n <= 24; n++) {
        uint64_t random = 31 * n + (uint64_t)place;
        grid_cells g;
        grid_of(n, &g);
        for (uint32_t i = 0; i < 12; i++) {
            const flow_aim aim = aim_of(&g, place, &random);
            flow_view v;
            flow_view_make(&g, &aim, &v);
            for (int k = 0; k < WAYS; k++) {
                static answer answers[PORTALS_MOST];
                bsp_sight s;
                sight_make(&g, ways[k], &s);
                for (uint32_t p = 0; p < g.zone.portal_count; p++) {
                    ask(&s, &v.view, &v.volume, p, &answers[p]);
                    sum->shut += answers[p].count == 0 && !answers[p].is_all;
                    sum->parts += answers[p].count;
                    sum->all += answers[p].is_all;
                }
                rays_check(&g, &v, answers, random + 9, sum);
                sight_close(grid_host(), &s);
            }
        }
        grid_free(&g);
    }
    printf("%u rays left, %u portals shut, %u parts, %u whole\n", sum->left, sum->shut, sum->parts, sum->all);
}

static void every_ray_that_leaves_through_a_portal_lies_in_a_part_of_it(void **state)
{
    (void)state;
    tally sum = {0};
    expect_rays_in_parts(EYE_ANYWHERE, &sum);
    assert_true(sum.left > 10000 && sum.shut > 500 && sum.all < sum.parts / 10); // and it says something
}

static void every_ray_that_leaves_lies_in_a_part_for_eyes_on_planes_and_edges(void **state)
{
    (void)state;
    tally sum = {0};
    expect_rays_in_parts(EYE_ON_PLANES, &sum);
    assert_true(sum.left > 10000);
}

static void every_ray_that_leaves_lies_in_a_part_for_eyes_in_the_zone_behind(void **state)
{
    (void)state;
    tally sum = {0};
    expect_rays_in_parts(EYE_IN_FOREIGN, &sum); // a convex room: nothing comes back into it
    assert_int_equal(sum.left, 0);
    assert_true(sum.shut > 500);
}

// ---- What is kept ----

// The picture's part left and right of a line.
static void halves_of(const grid_cells *g, const flow_view *v, double tangent, cull_plane left[5], cull_plane right[5])
{
    cull_guard guard = {.pixel_tangent = v->view.pixel_tangent, .reach = v->view.reach, .radius = (double)g->zone.radius};
    memcpy(guard.eye, v->view.eye_exact, sizeof guard.eye);
    memcpy(guard.forward, v->view.forward, sizeof guard.forward);
    const double inverse = 1 / sqrt(1 + tangent * tangent);
    double n[3], m[3];
    for (int k = 0; k < 3; k++) {
        n[k] = (tangent * v->view.forward[k] - v->right[k]) * inverse;
        m[k] = -n[k];
    }
    memcpy(left, v->planes, 4 * sizeof *left);
    memcpy(right, v->planes, 4 * sizeof *right);
    left[4] = cull_guard_plane(&guard, n, 0);
    right[4] = cull_guard_plane(&guard, m, 0);
}

typedef struct scenery { grid_cells g; flow_view v; cull_plane planes[2][5]; cull_volume volumes[3]; uint64_t random; } scenery;

static void scenery_make(scenery *s, uint64_t seed)
{
    s->random = seed;
    grid_of(seed, &s->g);
    const flow_aim aim = aim_of(&s->g, EYE_ANYWHERE, &s->random);
    flow_view_make(&s->g, &aim, &s->v);
    halves_of(&s->g, &s->v, 0.1, s->planes[0], s->planes[1]);
    s->volumes[0] = s->v.volume;
    for (int i = 0; i < 2; i++) s->volumes[1 + i] = (cull_volume){s->planes[i], 5, 0};
}

static void ask_all(bsp_sight *s, const scenery *from, uint32_t volume, answer *out)
{
    for (uint32_t p = 0; p < from->g.zone.portal_count; p++) ask(s, &from->v.view, &from->volumes[volume], p, &out[p]);
}

static void ask_afresh(const scenery *from, bsp_cells how, uint32_t volume, answer *out)
{
    bsp_sight s;
    sight_make(&from->g, how, &s);
    ask_all(&s, from, volume, out);
    sight_close(grid_host(), &s);
}

static void answers_are_the_same_in_any_order_twice_and_after_other_volumes(void **state)
{
    (void)state;
    static scenery from;
    static answer fresh[3][PORTALS_MOST], a;
    for (uint64_t n = 1; n <= 30; n++) {
        scenery_make(&from, n);
        const bsp_cells how = ways[n % WAYS];
        bsp_sight s;
        for (uint32_t v = 0; v < 3; v++) ask_afresh(&from, how, v, fresh[v]);
        sight_make(&from.g, how, &s);
        for (uint32_t i = 0; i < 60; i++) {
            const uint32_t v = random_below(&from.random, 3), p = random_below(&from.random, from.g.zone.portal_count);
            ask(&s, &from.v.view, &from.volumes[v], p, &a);
            assert_memory_equal(&a, &fresh[v][p], sizeof a);
        }
        sight_close(grid_host(), &s);
        grid_free(&from.g);
    }
}

static void expect_selects_alike(bsp_sight *asked, const scenery *from, bsp_cells how, const cull_visit *visit)
{
    bsp_flow_figures figures, others;
    bsp_sight fresh;
    sight_make(&from->g, how, &fresh);
    const int done = sight_select(&fresh, visit, &figures);
    assert_int_equal(sight_select(asked, visit, &others), done);
    if (done) assert_memory_equal(asked->flow.drawn, fresh.flow.drawn, from->g.item_count);
    memset(asked->flow.drawn, 0, from->g.item_count); // as the walk does
    sight_close(grid_host(), &fresh);
}

static void what_is_selected_is_the_same_with_and_without_questions(void **state)
{
    (void)state;
    static scenery from;
    static answer a;
    for (uint64_t n = 1; n <= 60; n++) {
        scenery_make(&from, n);
        const bsp_cells how = ways[n % WAYS];
        bsp_sight s;
        sight_make(&from.g, how, &s);
        for (uint32_t round = 0; round < 4; round++) {
            const uint32_t first = random_below(&from.random, 3), count = 1 + random_below(&from.random, 3 - first);
            const cull_visit visit = {.view = &from.v.view, .volumes = from.volumes + first, .volume_count = count};
            for (uint32_t i = random_below(&from.random, 5); i > 0; i--) // some of volumes that gave way
                ask(&s, &from.v.view, &from.volumes[random_below(&from.random, 3)], random_below(&from.random, from.g.zone.portal_count), &a);
            expect_selects_alike(&s, &from, how, &visit);
            expect_selects_alike(&s, &from, how, &visit); // again, as explain does
        }
        sight_close(grid_host(), &s);
        grid_free(&from.g);
    }
}

static void questions_count_once_with_the_select_behind_them(void **state)
{
    (void)state;
    static scenery from;
    static answer a;
    bsp_flow_figures figures, others;
    bsp_sight s, fresh;
    scenery_make(&from, 5);
    const cull_visit visit = {.view = &from.v.view, .volumes = from.volumes + 1, .volume_count = 2};
    sight_make(&from.g, BSP_CELLS_EXACT, &s);
    sight_make(&from.g, BSP_CELLS_EXACT, &fresh);
    assert_int_equal(sight_select(&fresh, &visit, &figures), 1);
    ask(&s, &from.v.view, &from.volumes[2], 0, &a);
    assert_int_equal(sight_select(&s, &visit, &others), 1);
    assert_true(figures.cells_visited > 0);
    assert_memory_equal(&figures, &others, sizeof figures);
    assert_int_equal(sight_select(&s, &visit, &others), 1);
    assert_memory_equal(&figures, &others, sizeof figures);
    sight_close(grid_host(), &fresh);
    sight_close(grid_host(), &s);
    grid_free(&from.g);
}

typedef enum change { CHANGE_FRAME, CHANGE_EYE, CHANGE_FORWARD, CHANGE_ROLL, CHANGE_REACH, CHANGE_COUNT } change;

// The same volumes, so that nothing but the view says that they are others.
static void view_change(cull_view *view, change what, const flow_view *v)
{
    const double *right = what == CHANGE_ROLL ? v->up : v->right;
    for (int k = 0; k < 3; k++) view->clip_from_zone[4 * k] = (float)right[k];
    if (what == CHANGE_FRAME) view->frame++;
    if (what == CHANGE_EYE) view->eye_exact[1] += 0.03125;
    if (what == CHANGE_FORWARD)
        for (int k = 0; k < 3; k++) view->forward[k] = -view->forward[k];
    if (what == CHANGE_REACH) view->reach *= 1.25;
}

static void another_view_is_not_mistaken_for_the_last_whatever_its_frame_number(void **state)
{
    (void)state;
    static scenery from;
    static answer fresh[PORTALS_MOST], a[PORTALS_MOST];
    for (uint32_t n = 1; n <= 20; n++)
        for (int what = 0; what < CHANGE_COUNT; what++) {
            scenery_make(&from, n);
            const bsp_cells how = ways[n % WAYS];
            bsp_sight s;
            view_change(&from.v.view, CHANGE_COUNT, &from.v);
            sight_make(&from.g, how, &s);
            ask_all(&s, &from, n % 3, a);
            view_change(&from.v.view, (change)what, &from.v);
            ask_afresh(&from, how, n % 3, fresh);
            ask_all(&s, &from, n % 3, a);
            assert_memory_equal(a, fresh, from.g.zone.portal_count * sizeof *a);
            const cull_visit visit = {.view = &from.v.view, .volumes = from.volumes + n % 3, .volume_count = 1};
            expect_selects_alike(&s, &from, how, &visit);
            sight_close(grid_host(), &s);
            grid_free(&from.g);
        }
}

static void more_volumes_than_are_kept_are_run_again(void **state)
{
    (void)state;
    enum { MANY = SIGHT_VOLUMES + 9 };
    static scenery from;
    static answer a, b;
    static cull_plane planes[MANY][2][5];
    cull_volume volumes[MANY];
    bsp_sight s, fresh;
    scenery_make(&from, 3);
    sight_make(&from.g, BSP_CELLS_EXACT, &s);
    for (uint32_t i = 0; i < MANY; i++) {
        halves_of(&from.g, &from.v, -1 + i * (2.0 / MANY), planes[i][0], planes[i][1]);
        volumes[i] = (cull_volume){planes[i][0], 5, 0};
    }
    for (uint32_t i = 0; i < 2 * MANY; i++) {
        sight_make(&from.g, BSP_CELLS_EXACT, &fresh);
        ask(&s, &from.v.view, &volumes[i % MANY], i % from.g.zone.portal_count, &a);
        ask(&fresh, &from.v.view, &volumes[i % MANY], i % from.g.zone.portal_count, &b);
        assert_memory_equal(&a, &b, sizeof a);
        sight_close(grid_host(), &fresh);
    }
    expect_selects_alike(&s, &from, BSP_CELLS_EXACT, &(cull_visit){.view = &from.v.view, .volumes = volumes, .volume_count = MANY});
    expect_selects_alike(&s, &from, BSP_CELLS_EXACT, &(cull_visit){.view = &from.v.view, .volumes = volumes, .volume_count = 2});
    sight_close(grid_host(), &s);
    grid_free(&from.g);
}

// ---- Edges ----

static void a_portal_that_no_cell_knows_of_passes_everything(void **state)
{
    (void)state;
    static scenery from;
    static answer a;
    bsp_sight s;
    scenery_make(&from, 4);
    sight_make(&from.g, BSP_CELLS_EXACT, &s);
    for (uint32_t i = 0; i <= from.g.zone.portal_count; i++) from.g.data.portal_offsets[i] = 0;
    for (uint32_t p = 0; p < from.g.zone.portal_count; p++) {
        ask(&s, &from.v.view, &from.v.volume, p, &a);
        assert_true(a.is_all && a.count == 0);
    }
    sight_close(grid_host(), &s);
    grid_free(&from.g);
}

static void a_view_without_an_eye_at_a_point_passes_everything(void **state)
{
    (void)state;
    static scenery from;
    static answer a;
    bsp_sight s;
    scenery_make(&from, 4);
    sight_make(&from.g, BSP_CELLS_EXACT, &s);
    ask(&s, &from.v.view, &from.v.volume, 0, &a);
    from.v.view.eye[3] = 0;
    ask(&s, &from.v.view, &from.v.volume, 0, &a);
    assert_true(a.is_all && a.count == 0);
    sight_close(grid_host(), &s);
    grid_free(&from.g);
}

// 28 planes far behind the eye stay, so there is room for a rectangle's sides; with 31 there is none.
static void parts_of_a_volume_of_many_planes_fit_or_all_passes(void **state)
{
    (void)state;
    static scenery from;
    static answer a;
    cull_plane planes[CULL_MAX_PLANES];
    uint32_t narrow = 0, all = 0;
    for (uint64_t n = 1; n <= 20; n++)
        for (uint32_t count = 20; count <= CULL_MAX_PLANES; count += 4) {
            bsp_sight s;
            scenery_make(&from, n);
            const cull_view *view = &from.v.view;
            for (uint32_t i = 0; i < count; i++) {
                const double *f = view->forward, behind = f[0] * view->eye_exact[0] + f[1] * view->eye_exact[1] + f[2] * view->eye_exact[2];
                planes[i] = (cull_plane){{(float)f[0], (float)f[1], (float)f[2]}, (float)(10 + i - behind)};
            }
            sight_make(&from.g, BSP_CELLS_EXACT, &s);
            for (uint32_t p = 0; p < from.g.zone.portal_count; p++) {
                ask(&s, view, &(cull_volume){planes, count, 0}, p, &a);
                narrow += a.count;
                all += a.is_all;
                if (count == CULL_MAX_PLANES) assert_int_equal(a.count, 0);
            }
            sight_close(grid_host(), &s);
            grid_free(&from.g);
        }
    assert_true(narrow > 0 && all > 0);
}

// ---- Memory ----

typedef struct counting_host { cull_host host; uint32_t left, held; } counting_host; // left: allocations before one fails

static void *counting_alloc(const cull_host *host, size_t size, size_t align)
{
    counting_host *h = host->user;
    if (h->left-- == 0) return NULL;
    h->held++;
    return grid_host()->alloc(grid_host(), size, align);
}

static void counting_free(const cull_host *host, void *memory, size_t size)
{
    counting_host *h = host->user;
    h->held--;
    grid_host()->free(grid_host(), memory, size);
}

static void an_allocation_that_fails_leaves_nothing_behind_and_no_step_allocates(void **state)
{
    (void)state;
    static scenery from;
    static answer a;
    counting_host h = {.host = {.abi = CULL_ABI, .alloc = counting_alloc, .free = counting_free}};
    bsp_sight s;
    h.host.user = &h;
    scenery_make(&from, 2);
    const bsp_flow_request q = {.cells = &from.g.data, .index = &from.g.index, .zone = &from.g.zone, .how = BSP_CELLS_EXACT, .exits = BSP_EXITS_KEPT};
    uint32_t fails = 0;
    for (;; fails++) {
        h.left = fails;
        if (sight_open(&h.host, &q, from.g.item_count, &s) == CULL_OK) break;
        assert_int_equal(h.held, 0);
    }
    assert_int_equal(fails, h.held);
    assert_true(fails > 0);
    h.left = 0;
    ask(&s, &from.v.view, &from.v.volume, 0, &a);
    assert_int_equal(h.left, 0);
    sight_close(&h.host, &s);
    assert_int_equal(h.held, 0);
    grid_free(&from.g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_ray_that_leaves_through_a_portal_lies_in_a_part_of_it),
        cmocka_unit_test(every_ray_that_leaves_lies_in_a_part_for_eyes_on_planes_and_edges),
        cmocka_unit_test(every_ray_that_leaves_lies_in_a_part_for_eyes_in_the_zone_behind),
        cmocka_unit_test(answers_are_the_same_in_any_order_twice_and_after_other_volumes),
        cmocka_unit_test(what_is_selected_is_the_same_with_and_without_questions),
        cmocka_unit_test(questions_count_once_with_the_select_behind_them),
        cmocka_unit_test(another_view_is_not_mistaken_for_the_last_whatever_its_frame_number),
        cmocka_unit_test(more_volumes_than_are_kept_are_run_again),
        cmocka_unit_test(a_portal_that_no_cell_knows_of_passes_everything),
        cmocka_unit_test(a_view_without_an_eye_at_a_point_passes_everything),
        cmocka_unit_test(parts_of_a_volume_of_many_planes_fit_or_all_passes),
        cmocka_unit_test(an_allocation_that_fails_leaves_nothing_behind_and_no_step_allocates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
