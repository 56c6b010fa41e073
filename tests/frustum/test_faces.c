// Tests of frustum[backface=1]: only walls whose every triangle shows its back to the eye are dropped. The oracle is in
// long double, from the vertices that are drawn.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WALLS = 1500, OTHERS = 200, ITEMS = WALLS + OTHERS };

typedef struct wall_zone {
    hand_zone z;
    cull_vec3 positions[4 * ITEMS];
    uint32_t indices[6 * ITEMS], loops[4 * ITEMS];
    cull_wall walls[ITEMS];
    cull_plane planes[ITEMS];
} wall_zone;

// Quads whose vertices are rounded to `grid` metres, as a scene's are; the last items are no walls or two-sided.
static wall_zone *make_walls(uint64_t *r, double grid)
{
    wall_zone *w = calloc(1, sizeof *w);
    cull_box *boxes = calloc(ITEMS, sizeof *boxes);
    assert_true(w && boxes);
    for (uint32_t i = 0; i < ITEMS; i++) {
        double n[3], u[3], v[3], c[3], length = 0;
        random_direction(r, n);
        random_direction(r, u);
        for (int k = 0; k < 3; k++) c[k] = random_between(r, -50, 50);
        for (int k = 0; k < 3; k++) v[k] = n[(k + 1) % 3] * u[(k + 2) % 3] - n[(k + 2) % 3] * u[(k + 1) % 3];
        for (int k = 0; k < 3; k++) length += v[k] * v[k];
        for (int k = 0; k < 3; k++) v[k] /= sqrt(length);
        for (int k = 0; k < 3; k++) u[k] = v[(k + 1) % 3] * n[(k + 2) % 3] - v[(k + 2) % 3] * n[(k + 1) % 3]; // u x v = n
        const double wide = random_between(r, 0.01, 8), high = random_unit(r) < 0.1 ? 0.01 : random_between(r, 0.1, 8);
        cull_box box = cull_box_none();
        for (uint32_t k = 0; k < 4; k++) {
            const double a = (k == 1 || k == 2 ? 1 : -1) * wide, b = (k >= 2 ? 1 : -1) * high;
            cull_vec3 *p = &w->positions[4 * i + k];
            for (int j = 0; j < 3; j++) (&p->x)[j] = (float)(rint((c[j] + a * u[j] + b * v[j]) / grid) * grid);
            w->loops[4 * i + k] = 4 * i + k;
            box = cull_box_with_point(box, *p);
        }
        boxes[i] = box;
        const uint32_t fan[6] = {0, 1, 2, 0, 2, 3};
        for (int k = 0; k < 6; k++) w->indices[6 * i + (uint32_t)k] = 4 * i + fan[k];
        w->walls[i] = (cull_wall){4 * i, 4, i, 0};
        double offset = 0;
        for (int k = 0; k < 3; k++) offset -= n[k] * c[k];
        w->planes[i] = (cull_plane){{(float)n[0], (float)n[1], (float)n[2]}, (float)offset};
    }
    zone_of_boxes(boxes, ITEMS, &w->z);
    free(boxes);
    for (uint32_t i = 0; i < ITEMS; i++) {
        uint32_t flags = CULL_ITEM_WALL;
        if (i >= WALLS) flags = i % 2 ? 0 : CULL_ITEM_WALL | CULL_ITEM_TWO_SIDED;
        if (!(flags & CULL_ITEM_WALL)) w->walls[i] = (cull_wall){0, 0, 0, 0};
        w->z.items[i] = (cull_item){.first_index = 6 * i, .index_count = 6, .polygon_count = 1, .flags = flags};
    }
    cull_zone *z = &w->z.zone;
    z->positions = w->positions;
    z->indices = w->indices;
    z->walls = w->walls;
    z->wall_vertices = w->loops;
    z->planes = w->planes;
    z->position_count = z->wall_vertex_count = 4 * ITEMS;
    z->index_count = 6 * ITEMS;
    z->plane_count = ITEMS;
    return w;
}

// > 0: the eye sees the triangle's front.
static long double front(const wall_zone *w, const uint32_t *t, const double eye[4])
{
    long double p[3][3];
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++) p[k][j] = (long double)(&w->positions[t[k]].x)[j];
    long double u[3], v[3], height = 0;
    for (int j = 0; j < 3; j++) {
        u[j] = p[1][j] - p[0][j];
        v[j] = p[2][j] - p[0][j];
    }
    for (int j = 0; j < 3; j++)
        height += (u[(j + 1) % 3] * v[(j + 2) % 3] - u[(j + 2) % 3] * v[(j + 1) % 3]) * (eye[j] - eye[3] * p[0][j]);
    return height;
}

static int shows_a_front(const wall_zone *w, uint32_t item, const double eye[4])
{
    return front(w, w->indices + 6 * item, eye) > 0 || front(w, w->indices + 6 * item + 3, eye) > 0;
}

typedef struct tally { uint64_t backs, dropped, lost; } tally;

static void check_view(const wall_zone *w, session *s, const double eye[4], tally *t)
{
    static uint8_t seen[ITEMS];
    const cull_view view = {.eye = {(float)eye[0], (float)eye[1], (float)eye[2], (float)eye[3]}};
    const cull_volume everything = {NULL, 0, 0};
    session_select(s, &view, &everything, 1);
    assert_null(session_set(s, seen));
    for (uint32_t i = 0; i < ITEMS; i++) {
        const int may_go = i < WALLS && !shows_a_front(w, i, eye);
        t->backs += (uint64_t)may_go;
        t->dropped += !seen[i];
        t->lost += !seen[i] && !may_go;
    }
}

static void only_walls_that_show_no_front_are_dropped(void **state)
{
    (void)state;
    const cull_plugin *frustum = plugin_named("frustum");
    if (!frustum) {
        fprintf(stderr, "SKIPPED: the frustum library is not built\n");
        skip();
    }
    uint64_t r = {31};
    static const char *const isas[] = {"plain", "avx2", "avx512"};
    for (int g = 0; g < 3; g++) {
        wall_zone *w = make_walls(&r, (const double[]){0x1p-18, 0x1p-10, 0x1p-5}[g]);
        for (int i = 0; i < 3; i++) {
            culler_host h;
            culler_host_init(&h, 0);
            session s;
            const char *values[2] = {"1", isas[i]};
            if (session_open(&s, &h, frustum, &w->z.zone, values) != CULL_OK) continue;
            tally t = {0, 0, 0};
            for (int q = 0; q < 60; q++) {
                double eye[4] = {random_between(&r, -60, 60), random_between(&r, -60, 60), random_between(&r, -60, 60), 1};
                if (q % 4 == 1) // on a wall's plane, as near as doubles come
                    for (int j = 0; j < 3; j++) eye[j] = (double)(&w->positions[4 * q].x)[j] * 3 - (double)(&w->positions[4 * q + 1].x)[j] * 2;
                if (q % 4 == 2) { // a direction
                    random_direction(&r, eye);
                    eye[3] = 0;
                }
                if (q % 4 == 3) // far outside
                    for (int j = 0; j < 3; j++) eye[j] *= 300;
                check_view(w, &s, eye, &t);
            }
            assert_int_equal(t.lost, 0);
            assert_true(t.dropped * 10 > t.backs * (g < 2 ? 9 : 5)); // and nearly all of them are
            session_close(&s);
            assert_int_equal(h.memory.live_blocks, 0);
        }
        hand_zone_free(&w->z);
        free(w);
    }
}

static void every_instruction_set_drops_the_same_walls(void **state)
{
    (void)state;
    const cull_plugin *frustum = plugin_named("frustum");
    if (!frustum) {
        fprintf(stderr, "SKIPPED: the frustum library is not built\n");
        skip();
    }
    uint64_t r = {32};
    wall_zone *w = make_walls(&r, 0x1p-10);
    culler_host h;
    culler_host_init(&h, 0);
    session s[3];
    const char *isas[] = {"plain", "avx2", "avx512"};
    int count = 0;
    for (int i = 0; i < 3; i++) {
        const char *values[2] = {"1", isas[i]};
        if (session_open(&s[count], &h, frustum, &w->z.zone, values) == CULL_OK) count++;
    }
    for (int q = 0; q < 200; q++) {
        double n[3], eye[3];
        static uint8_t first[ITEMS], other[ITEMS];
        random_direction(&r, n);
        for (int j = 0; j < 3; j++) eye[j] = random_between(&r, -60, 60);
        const cull_plane planes[2] = {{{(float)n[0], (float)n[1], (float)n[2]}, 5}, {{(float)-n[1], (float)n[0], 0}, 20}};
        const cull_volume volumes[2] = {{planes, 1, 0}, {planes + 1, 1, 0}};
        const cull_view view = {.eye = {(float)eye[0], (float)eye[1], (float)eye[2], 1}};
        for (int i = 0; i < count; i++) {
            session_select(&s[i], &view, volumes, 1 + (uint32_t)q % 2);
            assert_null(session_set(&s[i], i ? other : first));
            if (i) assert_memory_equal(first, other, ITEMS);
        }
    }
    for (int i = 0; i < count; i++) session_close(&s[i]);
    hand_zone_free(&w->z);
    free(w);
}

enum { VOLUMES_MOST = 20, VOLUME_PLANES = 4 };

static void random_volumes(uint64_t *r, cull_volume *volumes, cull_plane (*planes)[VOLUME_PLANES])
{
    for (uint32_t v = 0; v < VOLUMES_MOST; v++) {
        for (uint32_t k = 0; k < VOLUME_PLANES; k++) {
            double n[3];
            random_direction(r, n);
            planes[v][k] = (cull_plane){{(float)n[0], (float)n[1], (float)n[2]}, (float)random_between(r, -20, 25)};
        }
        volumes[v] = (cull_volume){planes[v], VOLUME_PLANES, 0};
    }
}

// With more volumes than one pass takes they are walked one after the other: the same set either way, and what the faces
// and each volume alone would leave.
static void volumes_and_faces_in_one_pass_leave_what_each_leaves_alone(void **state)
{
    (void)state;
    const cull_plugin *frustum = plugin_named("frustum");
    if (!frustum) {
        fprintf(stderr, "SKIPPED: the frustum library is not built\n");
        skip();
    }
    uint64_t r = {33};
    static const char *const isas[] = {"plain", "avx2", "avx512"};
    static const uint32_t counts[] = {1, 16, 17, 250, 256, 257, ITEMS}; // one block, two levels, three
    static const uint32_t volume_counts[] = {0, 1, 2, 5, 16, 17, VOLUMES_MOST};
    static cull_plane planes[VOLUMES_MOST][VOLUME_PLANES];
    cull_volume volumes[VOLUMES_MOST];
    const cull_volume everything = {NULL, 0, 0};
    wall_zone *w = make_walls(&r, 0x1p-10);
    uint64_t kept = 0, dropped = 0;
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
        for (int isa = 0; isa < 3; isa++) {
            culler_host h;
            culler_host_init(&h, 0);
            session s;
            const char *values[2] = {"1", isas[isa]};
            w->z.zone.item_count = counts[c];
            if (session_open(&s, &h, frustum, &w->z.zone, values) != CULL_OK) continue;
            for (int q = 0; q < 12; q++) {
                static uint8_t faces[ITEMS], one[ITEMS], wanted[ITEMS], seen[ITEMS];
                const cull_view view = {.eye = {(float)random_between(&r, -60, 60), (float)random_between(&r, -60, 60), (float)random_between(&r, -60, 60), 1}};
                random_volumes(&r, volumes, planes);
                session_select(&s, &view, &everything, 1);
                assert_null(session_set(&s, faces));
                for (size_t n = 0; n < sizeof volume_counts / sizeof *volume_counts; n++) {
                    memset(wanted, 0, sizeof wanted);
                    for (uint32_t v = 0; v < volume_counts[n]; v++) {
                        session_select(&s, &view, &volumes[v], 1);
                        assert_null(session_set(&s, one));
                        for (uint32_t i = 0; i < counts[c]; i++) {
                            const cull_box box = cull_box_at(&w->z.zone.boxes, i);
                            assert_int_equal(one[i], faces[i] && cull_volume_touches(&volumes[v], box));
                            wanted[i] |= one[i];
                        }
                    }
                    session_select(&s, &view, volumes, volume_counts[n]);
                    assert_null(session_set(&s, seen));
                    assert_memory_equal(seen, wanted, counts[c]);
                    for (uint32_t i = 0; i < counts[c]; i++) {
                        kept += seen[i];
                        dropped += !seen[i];
                    }
                }
            }
            session_close(&s);
            assert_int_equal(h.memory.live_blocks, 0);
        }
    assert_true(kept > 50000 && dropped > 50000);
    hand_zone_free(&w->z);
    free(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_walls_that_show_no_front_are_dropped),
        cmocka_unit_test(every_instruction_set_drops_the_same_walls),
        cmocka_unit_test(volumes_and_faces_in_one_pass_leave_what_each_leaves_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
