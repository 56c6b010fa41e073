// method=hiz never drops what leaves a pixel, against an oracle that casts rays in double, and drops nearly all that a rectangle test on an
// exact z-buffer drops.
// SPDX-License-Identifier: MIT
#include "hiz_stage.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { ITEMS_MOST = 4096, QUERIES = 16384 };

// ---- Scenes ----

typedef enum scene_kind { SCENE_STREET, SCENE_CLOUD, SCENE_BRICKS, SCENE_SHEETS, SCENE_KINDS } scene_kind;

static float between(uint64_t *seed, double low, double high)
{
    return (float)random_between(seed, low, high);
}

static cull_box box_at(float x, float y, float z, float w, float h, float d)
{
    const cull_box b = {{x, y, z}, {x + w, y + h, z + d}};
    return b;
}

// Houses along streets; a cloud; bricks that touch; sheets without thickness.
static void scene_make(scene_kind kind, uint64_t *seed, cull_box *boxes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const float x = between(seed, -60, 60), y = between(seed, -20, 20), z = between(seed, -60, 60);
        const float size = (float)pow(2, random_between(seed, -4, 4));
        switch (kind) {
        case SCENE_STREET:
            boxes[i] = i % 3 ? box_at(floorf(x / 20) * 20 + 3, 0, floorf(z / 20) * 20 + 3, between(seed, 4, 14), between(seed, 3, 30), between(seed, 4, 14))
                             : box_at(x, 0, z, 0.6f, 1.2f, 0.6f);
            break;
        case SCENE_CLOUD: boxes[i] = box_at(x, y, z, size, between(seed, 0.1, 8), between(seed, 0.1, 8)); break;
        case SCENE_BRICKS: boxes[i] = box_at(floorf(x / 4) * 4, floorf(y / 2) * 2, floorf(z / 4) * 4, 4, 2, 4); break;
        default: boxes[i] = box_at(x, y, z, i % 3 == 0 ? 0 : size * 3, i % 3 == 1 ? 0 : size * 3, i % 3 == 2 ? 0 : size * 3); break;
        }
    }
}

static void camera_make(uint64_t *seed, double aspect, camera *c)
{
    *c = (camera){.up = {0, 1, 0}, .fovy_deg = random_between(seed, 20, 110), .aspect = aspect, .near_m = pow(10, random_between(seed, -3, 0)), .far_m = HUGE_VAL};
    do random_direction(seed, c->forward);
    while (fabs(c->forward[1]) > 0.99);
    if (random_below(seed, 4) == 0) c->forward[1] = c->forward[0] = 0, c->forward[2] = 1; // along an axis
    for (int k = 0; k < 3; k++) c->eye[k] = random_between(seed, -40, 40);
    if (random_below(seed, 2)) c->eye[1] = random_between(seed, 1, 3);
}

// What comes to be tested as a mover: of all sizes and places, and what is no box at all.
static cull_box query_make(uint64_t *seed, uint32_t n)
{
    static const float odd[] = {NAN, INFINITY, -INFINITY, 1e30f, -1e30f, 3e38f, 1e18f};
    const double size = pow(10, random_between(seed, -3, 2.5));
    cull_box b = box_at(between(seed, -80, 80), between(seed, -30, 30), between(seed, -80, 80), (float)(size * random_unit(seed)),
                        (float)(size * random_unit(seed)), (float)(size * random_unit(seed)));
    if (n % 64 == 7) (&b.min.x)[random_below(seed, 3)] = odd[random_below(seed, 7)];
    if (n % 64 == 9) (&b.max.x)[random_below(seed, 3)] = odd[random_below(seed, 7)];
    if (n % 64 == 11) b.max = b.min;
    if (n % 64 == 13) b.max.x = b.min.x + 1e6f;
    return b;
}

typedef struct trial {
    cull_box boxes[ITEMS_MOST];
    cull_mover movers[QUERIES];
    uint8_t seen[ITEMS_MOST + QUERIES];
    hand_zone zone;
    camera camera;
    hiz_scene_view view;
    uint32_t count;
} trial;

static void trial_open(trial *t, scene_kind kind, uint64_t *seed, uint32_t count, uint32_t width_px, uint32_t height_px)
{
    t->count = count;
    scene_make(kind, seed, t->boxes, count);
    zone_of_boxes(t->boxes, count, &t->zone);
    camera_make(seed, (double)width_px / height_px, &t->camera);
    scene_view_make(&t->camera, width_px, height_px, &t->zone.zone, &t->view);
    for (uint32_t i = 0; i < QUERIES; i++) t->movers[i] = (cull_mover){query_make(seed, i), count + i, 0};
}

static void trial_close(trial *t)
{
    hand_zone_free(&t->zone);
}

// ---- No false cull ----

static int is_number(const cull_box *b)
{
    return isfinite(b->min.x + b->min.y + b->min.z) && isfinite(b->max.x + b->max.y + b->max.z);
}

static void items_check(const trial *t, const oracle_picture *p)
{
    const oracle_picture picture = *p;
    for (size_t i = 0; i < (size_t)picture.width_px * picture.height_px; i++)
        if (picture.owner[i] != UINT32_MAX && !t->seen[picture.owner[i]]) {
            // an equal box in front may own the pixel as well
            const double w = oracle_box(&t->view, &t->boxes[picture.owner[i]], (double)(i % picture.width_px) + 0.5, (double)(i / picture.width_px) + 0.5);
            int is_tie = 0;
            for (uint32_t k = 0; k < t->count && !is_tie; k++)
                is_tie = t->seen[k] && memcmp(&t->boxes[k], &t->boxes[picture.owner[i]], sizeof t->boxes[k]) == 0;
            if (!is_tie) fail_msg("item %u owns pixel %u at %g and was dropped", picture.owner[i], (unsigned)i, w);
        }
}

// Returns how many were judged hidden. seen: of the movers.
static uint32_t queries_check(const trial *t, const oracle_picture *p, const uint8_t *seen)
{
    const oracle_picture picture = *p;
    uint32_t hidden = 0;
    for (uint32_t i = 0; i < QUERIES; i++) {
        const cull_box *box = &t->movers[i].box;
        if (seen[i]) continue;
        hidden++;
        if (!is_number(box)) fail_msg("a box that is no number was dropped");
        if (oracle_shows(&picture, box)) {
            int r[4];
            double least;
            const int before = oracle_bounds(&t->view, box, r, &least);
            fail_msg("box %u was dropped: before %d, pixels %d..%d, %d..%d, w %g", i, before, r[0], r[2], r[1], r[3], least);
        }
    }
    return hidden;
}

// Returns how many boxes were judged hidden.
static uint32_t trial_check(trial *t, const hiz_stage *s)
{
    oracle_picture picture;
    stage_set(s, t->seen, t->count + QUERIES);
    oracle_open(&picture, &t->view, t->boxes, t->count, ORACLE_SNAPPED);
    items_check(t, &picture);
    const uint32_t hidden = queries_check(t, &picture, t->seen + t->count);
    oracle_close(&picture);
    return hidden;
}

static void nothing_that_leaves_a_pixel_is_dropped(void **state)
{
    static trial t;
    const uint64_t boxes_wanted = getenv("PORTCULLIS_LONG") ? 10000000 : 200000;
    static const char *const pixels[] = {"1", "2", "4"};
    uint64_t seed = 17, boxes = 0, hidden = 0;
    (void)state;
    for (uint32_t n = 0; boxes < boxes_wanted; n++) {
        static const uint32_t sizes[][2] = {{96, 56}, {61, 47}, {64, 64}, {131, 19}};
        hiz_stage s;
        const uint32_t *size = sizes[n % 4], count = 1 + random_below(&seed, n % 8 ? 80 : 300);
        trial_open(&t, (scene_kind)(n / 4 % SCENE_KINDS), &seed, count, size[0], size[1]);
        stage_open_pixels(&s, &t.zone.zone, n % 7 ? "on" : "off", "1", "auto", pixels[n % 3]);
        stage_run(&s, &t.view, t.movers, QUERIES);
        hidden += trial_check(&t, &s);
        boxes += count + QUERIES;
        stage_close(&s);
        trial_close(&t);
    }
    assert_true(hidden > boxes / 10); // and much of it is hidden: the test tests something
}

// The same boxes, each as six walls, or as twelve triangles that make one item.
static void what_walls_and_meshes_hide_is_hidden(void **state)
{
    static trial t;
    uint64_t seed = 91, hidden = 0;
    (void)state;
    for (uint32_t n = 0; n < 12; n++) {
        hand_zone walls;
        hiz_stage s;
        oracle_picture picture;
        const uint32_t count = 1 + random_below(&seed, 60), items = n % 2 ? 6 * count : count;
        trial_open(&t, (scene_kind)(n / 2 % SCENE_KINDS), &seed, count, 128, 72);
        hand_zone_open(&walls, 6 * count, 24 * count);
        for (uint32_t i = 0; i < count; i++) hand_zone_box(&walls, t.boxes[i], FACE_OUT, CULL_ITEM_TWO_SIDED);
        hand_zone_end(&walls);
        if (n % 2 == 0) { // six walls in a row are one item of triangles
            for (uint32_t i = 0; i < count; i++) {
                walls.items[i] = (cull_item){.first_index = 36 * i, .index_count = 36, .polygon_count = 6};
                const float values[6] = {t.boxes[i].min.x, t.boxes[i].min.y, t.boxes[i].min.z, t.boxes[i].max.x, t.boxes[i].max.y, t.boxes[i].max.z};
                for (int k = 0; k < 6; k++) walls.rows[k][i] = values[k];
            }
            walls.zone.item_count = count;
        }
        for (uint32_t i = 0; i < QUERIES; i++) t.movers[i].id = items + i;
        stage_open_pixels(&s, &walls.zone, "on", "1", "auto", n % 4 < 2 ? "1" : "2");
        stage_run(&s, &t.view, t.movers, QUERIES);
        stage_set(&s, t.seen, items + QUERIES);
        oracle_open(&picture, &t.view, t.boxes, count, ORACLE_SNAPPED);
        hidden += queries_check(&t, &picture, t.seen + items);
        if (n % 2 == 0) items_check(&t, &picture);
        oracle_close(&picture);
        stage_close(&s);
        hand_zone_free(&walls);
        trial_close(&t);
    }
    assert_true(hidden > QUERIES);
}

// ---- What is dropped ----

// Of what a rectangle test on the finished exact picture drops; both counts are added to.
static void share_add(const trial *t, uint32_t *by_exact, uint32_t *by_both)
{
    oracle_picture picture;
    oracle_open(&picture, &t->view, t->boxes, t->count, ORACLE_CENTRES);
    for (uint32_t i = 0; i < t->count; i++) {
        int r[4], is_open = 0;
        double least;
        if (!oracle_bounds(&t->view, &t->boxes[i], r, &least) || r[0] > r[2] || r[1] > r[3]) continue;
        for (int y = r[1]; y <= r[3]; y++)
            for (int x = r[0]; x <= r[2]; x++) is_open |= !(picture.nearest[(size_t)y * picture.width_px + (size_t)x] < least);
        *by_exact += !is_open;
        *by_both += !is_open && !t->seen[i];
    }
    oracle_close(&picture);
}

static void nearly_all_that_an_exact_buffer_hides_is_dropped(void **state)
{
    static trial t;
    uint32_t by_exact = 0, by_both = 0;
    uint64_t seed = 5;
    (void)state;
    for (uint32_t n = 0; n < 3; n++) {
        hiz_stage s;
        trial_open(&t, SCENE_STREET, &seed, 700, 800, 450);
        t.camera = (camera){.eye = {20 * floor(random_between(&seed, -2, 2)) + 1, 1.7, random_between(&seed, -50, 50)}, .forward = {0.3, 0, 1},
                            .up = {0, 1, 0}, .fovy_deg = 60, .aspect = 16.0 / 9, .near_m = 0.1, .far_m = HUGE_VAL};
        t.camera.forward[0] = random_between(&seed, -1, 1);
        scene_view_make(&t.camera, 800, 450, &t.zone.zone, &t.view);
        stage_open(&s, &t.zone.zone, "on", "1", "auto");
        stage_run(&s, &t.view, NULL, 0);
        stage_set(&s, t.seen, t.count);
        share_add(&t, &by_exact, &by_both);
        stage_close(&s);
        trial_close(&t);
    }
    assert_true(by_exact > 100);
    assert_true(by_both * 1000 >= by_exact * 995);
}

static void the_order_of_the_items_costs_nothing(void **state)
{
    static trial t;
    uint32_t before = 0, after = 0;
    uint64_t seed = 23;
    (void)state;
    for (uint32_t n = 0; n < 6; n++) {
        hiz_stage s;
        hand_zone shuffled;
        trial_open(&t, (scene_kind)(n % SCENE_KINDS), &seed, 1000, 320, 180);
        stage_open(&s, &t.zone.zone, "on", "1", "auto");
        stage_run(&s, &t.view, NULL, 0);
        stage_set(&s, t.seen, t.count);
        for (uint32_t i = 0; i < t.count; i++) before += t.seen[i];
        stage_close(&s);
        for (uint32_t i = t.count - 1; i > 0; i--) {
            const uint32_t k = random_below(&seed, i + 1);
            const cull_box swapped = t.boxes[i];
            t.boxes[i] = t.boxes[k];
            t.boxes[k] = swapped;
        }
        zone_of_boxes(t.boxes, t.count, &shuffled);
        stage_open(&s, &shuffled.zone, "on", "1", "auto");
        stage_run(&s, &t.view, NULL, 0);
        stage_set(&s, t.seen, t.count);
        for (uint32_t i = 0; i < t.count; i++) after += t.seen[i];
        stage_close(&s);
        hand_zone_free(&shuffled);
        trial_close(&t);
    }
    assert_true(abs((int)before - (int)after) * 1000 <= (int)before); // equal boxes and equal depths aside
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_that_leaves_a_pixel_is_dropped),
        cmocka_unit_test(what_walls_and_meshes_hide_is_hidden),
        cmocka_unit_test(nearly_all_that_an_exact_buffer_hides_is_dropped),
        cmocka_unit_test(the_order_of_the_items_costs_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
