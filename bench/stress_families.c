// Stress: what each family does to scene and camera.
// SPDX-License-Identifier: MIT
#include "stress_parts.h"

#include <math.h>
#include <string.h>

static const double MOVES_M[] = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 9e8, 2e9};
static const double GROWTHS[] = {10, 100, 1e3, 1e4};
static const double SHRINKS[] = {0.1, 0.01, 1e-3, 1e-4};
static const double TURNS_DEG[] = {1e-6, 1e-3, 0.1, 1, 10, 45, 90, 137};
static const double JITTERS_ULP[] = {1, 2, 4, 8, 16, 32, 64};
static const double NEARS_M[] = {0.01, 1e-3, 1e-4, 1e-6, 1e-9, 1e-15, 1e-30, 1e-35};
static const double NEARS_OUT_M[] = {0.125, 0.25, 0.5, 1, 2, 4, 16, 64};
static const double FARS_M[] = {10, 100, 1e3, 1e4, 1e6, 1e9, 1e15, 1e30, INFINITY};
static const double NARROW_DEG[] = {30, 10, 5, 2, 1, 0.5};
static const double WIDE_DEG[] = {90, 120, 150, 160, 170, 175};
static const double COPIES[] = {2, 3, 4, 8};
// 1e-45 is the least of float, the last three go below the normal numbers of double.
static const double TINY_M[] = {1e-6, 1e-9, 1e-20, 1e-38, 1e-45, 1e-300, 1e-310, 4.9406564584124654e-324};
static const double SHIFTS_M[] = {4.9406564584124654e-324, 1e-310, 1e-300, 1e-45, 1e-38, 1e-20, 1e-15, 1e-12};

#define COUNTED(list) list, sizeof(list) / sizeof *(list)
static const stress_family families[] = {
    {"move", "m", STRESS_MOVE, STRESS_SAME, COUNTED(MOVES_M)},
    {"move-odd", "m", STRESS_MOVE_ODD, STRESS_SAME, COUNTED(MOVES_M)},
    {"grow", "times", STRESS_SCALE, STRESS_SAME, COUNTED(GROWTHS)},
    {"shrink", "times", STRESS_SCALE, STRESS_SAME, COUNTED(SHRINKS)},
    {"turn", "degrees", STRESS_TURN, STRESS_SAME, COUNTED(TURNS_DEG)},
    {"jitter", "ulp", STRESS_JITTER, STRESS_SAME, COUNTED(JITTERS_ULP)},
    {"near", "m", STRESS_NEAR, STRESS_OWN, COUNTED(NEARS_M)},
    {"near-out", "m", STRESS_NEAR, STRESS_OWN, COUNTED(NEARS_OUT_M)},
    {"far", "m", STRESS_FAR, STRESS_OWN, COUNTED(FARS_M)},
    {"narrow", "degrees", STRESS_FOV, STRESS_OWN, COUNTED(NARROW_DEG)},
    {"wide", "degrees", STRESS_FOV, STRESS_OWN, COUNTED(WIDE_DEG)},
    {"copies", "times", STRESS_COPIES, STRESS_SAME, COUNTED(COPIES)},
    {"tiny", "m", STRESS_TINY, STRESS_SAME, COUNTED(TINY_M)},
    {"eye", "m", STRESS_EYE, STRESS_SAME, COUNTED(SHIFTS_M)},
};

const stress_family *stress_families(uint32_t *out_count)
{
    *out_count = sizeof families / sizeof *families;
    return families;
}

scene_change stress_home(void)
{
    return (scene_change){.place = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}, .copies = 1};
}

static void turn_about(double m[3][4], int axis, double degrees)
{
    const double radians = degrees * 3.14159265358979323846 / 180, c = cos(radians), s = sin(radians);
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (int k = 0; k < 3; ++k) {
        const double u = m[a][k], v = m[b][k];
        m[a][k] = c * u - s * v;
        m[b][k] = s * u + c * v;
    }
}

scene_change stress_change(const stress_family *f, double magnitude, const scene *s, uint64_t seed)
{
    static const double whole[3] = {1, 0, -1}, odd[3] = {0.7310585786300049, 0.3141592653589793, -0.6065306597126334};
    scene_change c = stress_home();
    c.seed = seed;
    if (f->kind == STRESS_MOVE || f->kind == STRESS_MOVE_ODD)
        for (int k = 0; k < 3; ++k) c.place.rows[k][3] = magnitude * (f->kind == STRESS_MOVE ? whole[k] : odd[k]);
    if (f->kind == STRESS_SCALE)
        for (int k = 0; k < 3; ++k) c.place.rows[k][k] = magnitude;
    if (f->kind == STRESS_TURN) {
        turn_about(c.place.rows, 0, magnitude / 3);
        turn_about(c.place.rows, 1, magnitude);
        turn_about(c.place.rows, 2, magnitude / 2);
    }
    if (f->kind == STRESS_JITTER) c.jitter_m = magnitude * s->step;
    if (f->kind == STRESS_COPIES) c.copies = (uint32_t)magnitude;
    if (f->kind == STRESS_TINY) {
        c.tiny_count = 1;
        c.tiny_m = magnitude;
    }
    return c;
}

static void put_through(const builder_transform *t, const double p[3], double w, double out[3])
{
    for (int i = 0; i < 3; ++i) out[i] = ((t->rows[i][0] * p[0] + t->rows[i][1] * p[1]) + t->rows[i][2] * p[2]) + w * t->rows[i][3];
}

camera stress_camera(const stress_family *f, double magnitude, const scene_change *c, const camera *from)
{
    camera to = *from;
    put_through(&c->place, from->eye, 1, to.eye);
    put_through(&c->place, from->forward, 0, to.forward);
    put_through(&c->place, from->up, 0, to.up);
    if (f->kind == STRESS_SCALE) {
        to.near_m *= magnitude;
        to.far_m *= magnitude;
    }
    if (f->kind == STRESS_NEAR) {
        to.near_m = magnitude;
        to.far_m = INFINITY;
    }
    if (f->kind == STRESS_FAR) to.far_m = magnitude;
    if (f->kind == STRESS_FOV) to.fovy_deg = magnitude;
    if (f->kind == STRESS_EYE)
        for (int k = 0; k < 3; ++k) {
            to.eye[k] += magnitude;
            to.forward[k] += magnitude;
        }
    return to;
}
