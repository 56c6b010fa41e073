// Bytes of pictures up the quadtree: the picture of a node beside those of its four children, all taken from one eye. A level that merges halves them: from near the
// ground two rows of children show the same height twice. (Nearer than four of its sides the outline in perspective takes more: 0.56 at three.)
// SPDX-License-Identifier: MIT
#include "plugins/imagecache/quad.h"
#include "tests/common/test.h"

#include <math.h>

enum { HEADINGS = 24, DISTANCES = 6 };

// 60 degrees tall, 720 rows; four bytes a texel, as cullers ask for them (see shots.c).
static uint64_t bytes_of(const double eye[3], const cull_box *box)
{
    double away = 0;
    for (int k = 0; k < 3; k++) {
        const double d = ((double)(&box->min.x)[k] + (double)(&box->max.x)[k]) / 2 - eye[k];
        away += d * d;
    }
    quad_request q = {.eye = {eye[0], eye[1], eye[2]}, .box = *box, .optics = {623.54, 1.54}, .room = 0.05 * sqrt(away), .near_distance = 0.0625, .magnification = 1,
                      .place = QUAD_PLACE_MIDDLE, .most_texels = 2048};
    quad out;
    assert_int_equal(quad_of(&q, &out), QUAD_OK);
    return (uint64_t)out.width_px * out.height_px * 4;
}

typedef struct node { float side, tall; } node; // metres, of a child

typedef struct merged { uint64_t children, parent; } merged;

static merged merge(node n, double distance, double heading, double height)
{
    const double eye[3] = {distance * cos(heading), height, distance * sin(heading)};
    merged sum = {0, 0};
    for (int k = 0; k < 4; k++) {
        const float x = k & 1 ? 0 : -n.side, z = k & 2 ? 0 : -n.side;
        const cull_box child = {{x, 0, z}, {x + n.side, n.tall, z + n.side}};
        sum.children += bytes_of(eye, &child);
    }
    const cull_box parent = {{-n.side, 0, -n.side}, {n.side, n.tall, n.side}};
    sum.parent = bytes_of(eye, &parent);
    return sum;
}

// All round, from four of a parent's sides to 128.
static merged merge_all(node n, double height)
{
    merged sum = {0, 0};
    for (int d = 0; d < DISTANCES; d++)
        for (int h = 0; h < HEADINGS; h++) {
            const merged one = merge(n, (double)n.side * 8 * pow(2, d), h * 6.283185307179586 / HEADINGS, height);
            sum.children += one.children;
            sum.parent += one.parent;
        }
    return sum;
}

static double ratio(merged m)
{
    return (double)m.parent / (double)m.children;
}

static const node nodes[] = {{8, 3}, {8, 12}, {16, 5}, {16, 20}, {32, 6}, {32, 25}, {64, 10}, {64, 30}, {128, 12}, {128, 40}};
enum { NODES = sizeof nodes / sizeof *nodes };

static void a_level_merged_halves_picture_bytes(void **state)
{
    (void)state;
    static const double heights[] = {0.5, 1.7, 3};
    double most = 0;
    merged all = {0, 0};
    for (int h = 0; h < 3; h++)
        for (int n = 0; n < NODES; n++) {
            const merged m = merge_all(nodes[n], heights[h]);
            most = fmax(most, ratio(m));
            all.children += m.children;
            all.parent += m.parent;
        }
    print_message("a parent's picture to its children's, bytes: %.3f, at most %.3f\n", ratio(all), most);
    assert_true(ratio(all) <= 0.55);
    assert_true(most <= 0.55);
}

// From the air the ground itself is what is shown, and that is parted without loss: towards 1. Said, so that nobody expects else.
static void from_the_air_less_is_saved_the_steeper_it_looks(void **state)
{
    (void)state;
    double before = 0;
    for (int h = 0; h < 4; h++) {
        const double height = 1.7 + 60 * h, r = ratio(merge((node){32, 10}, 200, 0.7, height));
        print_message("32 m squares, 10 m tall, at 200 m from %.0f m up: %.3f\n", height, r);
        assert_true(r > before && r < 1.02);
        before = r;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_level_merged_halves_picture_bytes),
        cmocka_unit_test(from_the_air_less_is_saved_the_steeper_it_looks),
    };
    return cmocka_run_group_tests_name("image cache: bytes up the quadtree", tests, NULL, NULL);
}
