// Real levels, a city and a box city: the rules of the id picture and of the floor hold where geometry is not made for us.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "host/import/import.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDE = 640, HIGH = 360, VIEWS = 6 };

typedef struct walk { // item bits of one scene
    uint32_t *owners, *floor, *item_of;
    uint32_t words;
} walk;

static void set_bit(uint32_t *bits, uint32_t i)
{
    bits[i >> 5] |= 1u << (i & 31);
}

// Where a person may stand in a map: at its entities. Else round the scene, or amid it.
static camera look_from(const scene *s, uint32_t i)
{
    const double turn = 2.4 * i; // radians, about the golden angle
    camera c = {.forward = {sin(turn), 0.1 * (i % 3) - 0.1, -cos(turn)}, .up = {0, 1, 0}, .fovy_deg = 60, .aspect = (double)WIDE / HIGH, .near_m = 1.0 / 16, .far_m = INFINITY};
    if (s->place_count) {
        memcpy(c.eye, s->places[(uint64_t)i * s->place_count / VIEWS].position, sizeof c.eye);
        c.eye[1] += 0.7;
        return c;
    }
    const cull_box b = s->whole.box;
    const double centre[3] = {((double)b.min.x + b.max.x) / 2, ((double)b.min.y + b.max.y) / 2, ((double)b.min.z + b.max.z) / 2};
    const double away = i % 2 ? 0.2 : 1.2; // of the radius
    for (int k = 0; k < 3; ++k) c.eye[k] = s->whole.origin[k] + centre[k] - away * scene_radius_m(s) * (k == 1 ? -0.25 : c.forward[k]);
    return c;
}

static void check_view(bed *b, walk *w, const camera *c, uint32_t *owned)
{
    id_picture all = bed_ids(b, &(id_request){.camera = c}, WIDE, HIGH);
    assert_int_equal(renderer_floor(b->g, c, &b->r, w->floor), RESULT_OK);
    memset(w->owners, 0, w->words * sizeof *w->owners);
    for (uint32_t i = 0; i < WIDE * HIGH; ++i)
        if (all.triangles[i]) set_bit(w->owners, w->item_of[all.triangles[i] - 1]);
    for (uint32_t t = 0; t < b->s->index_count / 3; ++t)
        if (see_through_at(&all, t)) set_bit(w->owners, w->item_of[t]);
    for (uint32_t i = 0; i < w->words; ++i) {
        assert_int_equal(w->owners[i] & ~w->floor[i], 0);
        for (uint32_t k = 0; k < 32; ++k) *owned += w->owners[i] >> k & 1;
    }
    id_picture alone = bed_ids(b, &(id_request){.camera = c, .item_bits = w->owners}, WIDE, HIGH);
    assert_memory_equal(all.triangles, alone.triangles, sizeof(uint32_t) * WIDE * HIGH);
    assert_memory_equal(all.see_through, alone.see_through, sizeof(uint32_t) * all.see_through_words);
    id_picture_free(&all, allocator_heap());
    id_picture_free(&alone, allocator_heap());
}

// Every mover somewhere else: turned about its pivot, and moved by up to a metre.
static void move_all(bed *b)
{
    const uint32_t count = b->s->mover_count;
    scene_pose *poses = memory_alloc(allocator_heap(), count, sizeof *poses);
    uint32_t seed = 5;
    assert_non_null(poses);
    for (uint32_t i = 0; i < count; ++i) {
        const double turn = 6 * random_unit(&seed), x = cos(turn), y = sin(turn);
        poses[i] = (scene_pose){.rotation = {x, 0, y, 0, 1, 0, -y, 0, x}};
        memcpy(poses[i].pivot, b->s->movers[i].pivot, sizeof poses[i].pivot);
        for (int k = 0; k < 3; ++k) poses[i].offset[k] = 2 * random_unit(&seed) - 1;
    }
    renderer_poses(b->g, poses);
    memory_free(allocator_heap(), poses, count, sizeof *poses);
}

static void check_scene(bed *b, const char *name)
{
    const char *folder = getenv("PORTCULLIS_SCENES");
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder ? folder : "", name);
    FILE *file = folder ? fopen(path, "rb") : NULL;
    if (!file) {
        fprintf(stderr, "SKIPPED %s: not there; set PORTCULLIS_SCENES to the folder of scenes\n", name);
        skip();
    }
    fclose(file);
    assert_int_equal(import_scene(path, &(import_options){DOORS_OPEN}, &b->memory.memory, &b->r, &b->s), RESULT_OK);
    assert_int_equal(renderer_upload(b->g, b->s, &b->r), RESULT_OK);
    const uint32_t total = b->s->item_count + b->s->mover_count, triangles = b->s->index_count / 3;
    walk w = {.words = (total + 31) / 32};
    w.owners = memory_alloc(allocator_heap(), w.words, sizeof *w.owners);
    w.floor = memory_alloc(allocator_heap(), w.words, sizeof *w.floor);
    w.item_of = memory_alloc(allocator_heap(), triangles, sizeof *w.item_of);
    for (uint32_t i = 0; i < total; ++i)
        for (uint32_t t = b->s->items[i].first_index / 3; t < (b->s->items[i].first_index + b->s->items[i].index_count) / 3; ++t) w.item_of[t] = i;
    uint32_t owned = 0;
    for (uint32_t i = 0; i < VIEWS; ++i) {
        const camera c = look_from(b->s, i);
        check_view(b, &w, &c, &owned);
    }
    if (b->s->mover_count) move_all(b);
    for (uint32_t i = 0; i < VIEWS / 2 && b->s->mover_count; ++i) {
        const camera c = look_from(b->s, 2 * i);
        check_view(b, &w, &c, &owned);
    }
    assert_true(owned > VIEWS * 5);
    memory_free(allocator_heap(), w.owners, w.words, sizeof *w.owners);
    memory_free(allocator_heap(), w.floor, w.words, sizeof *w.floor);
    memory_free(allocator_heap(), w.item_of, triangles, sizeof *w.item_of);
}

static void truth_and_floor_hold_in_e1m1(void **state) { check_scene(*state, "quake/e1m1.map"); }
static void truth_and_floor_hold_in_e3m5(void **state) { check_scene(*state, "quake/e3m5.map"); }
static void truth_and_floor_hold_in_lqdm12(void **state) { check_scene(*state, "librequake/lqdm12.map"); }
static void truth_and_floor_hold_in_lq_e0m8(void **state) { check_scene(*state, "librequake/lq_e0m8.map"); }
static void truth_and_floor_hold_in_delft(void **state) { check_scene(*state, "city/delft.obj"); }
static void truth_and_floor_hold_round_the_bunny(void **state) { check_scene(*state, "models/stanford-bunny.obj"); }
static void truth_and_floor_hold_in_a_city_of_10000_boxes(void **state) { check_scene(*state, "boxes/city-10000.boxes"); }

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest real_scenes[] = {
        T(truth_and_floor_hold_in_e1m1),       T(truth_and_floor_hold_in_e3m5),  T(truth_and_floor_hold_in_lqdm12),
        T(truth_and_floor_hold_in_lq_e0m8),    T(truth_and_floor_hold_in_delft), T(truth_and_floor_hold_round_the_bunny),
        T(truth_and_floor_hold_in_a_city_of_10000_boxes),
    };
    return RUN_WITH_GL(real_scenes);
}
