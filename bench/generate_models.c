// Smooth models of the demo scene: surfaces of revolution with folds, rings, a knot, trees. See generate_models.h.
// SPDX-License-Identifier: MIT
#include "generate_models.h"

#include <math.h>

typedef struct profile_point { double radius, height; } profile_point;

// A profile turned round the y axis: Catmull-Rom through the points, with folds that fade towards the top.
typedef struct turned {
    const profile_point *points;
    uint32_t count;
    double scale;               // metres a unit
    double folds, fold_depth;   // whole folds round; depth as a part of the radius
    double fade;                // 0: folds stay, 1: gone at the top
    double twist, turn;         // turns from foot to top; turns of the whole
    double flatness;            // z radius as a part of x radius
} turned;

static double blend(double a, double b, double c, double d, double t)
{
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

static profile_point profile_at(const turned *s, double v)
{
    const double along = v * (s->count - 1);
    uint32_t i = (uint32_t)along;
    if (i > s->count - 2) i = s->count - 2;
    const double t = along - i;
    const profile_point *p = s->points, b = p[i], c = p[i + 1];
    const profile_point a = i ? p[i - 1] : b, d = i + 2 < s->count ? p[i + 2] : c;
    const double radius = blend(a.radius, b.radius, c.radius, d.radius, t);
    return (profile_point){radius > 0 ? radius : 0, blend(a.height, b.height, c.height, d.height, t)};
}

static spot turned_point(const void *shape, double u, double v)
{
    const turned *s = shape;
    const profile_point p = profile_at(s, v);
    const double stays = 1 - s->fade * v;
    const double fold = 1 + s->fold_depth * stays * stays * turn_cosine(s->folds * (u + s->twist * v));
    const double radius = p.radius * fold * s->scale;
    const double x = radius * turn_cosine(u), z = radius * turn_sine(u) * (s->flatness > 0 ? s->flatness : 1);
    const double c = turn_cosine(s->turn), n = turn_sine(s->turn);
    return (spot){x * c - z * n, p.height * s->scale, x * n + z * c};
}

static void turned_write(obj_writer *w, const turned *s, spot foot, uint32_t around, uint32_t rows)
{
    const surface shape = {.point = turned_point, .shape = s, .around = around, .along = rows * (s->count - 1)};
    obj_surface(w, &shape, foot);
}

#define COUNT_OF(points) ((uint32_t)(sizeof(points) / sizeof *(points)))

void model_column(obj_writer *w, spot foot, double height)
{
    static const profile_point points[] = {{0, 0}, {.1, 0}, {.1, .02}, {.085, .04}, {.07, .05}, {.065, .4}, {.058, .93}, {.06, .95},
                                           {.08, .97}, {.095, .98}, {.095, 1}, {0, 1}};
    const turned s = {.points = points, .count = COUNT_OF(points), .scale = height, .folds = 12, .fold_depth = .035};
    turned_write(w, &s, foot, 36, 1);
}

void model_figure(obj_writer *w, spot foot, double height, double turn)
{
    static const profile_point points[] = {{0, 0}, {.2, 0}, {.19, .05}, {.165, .2}, {.14, .36}, {.115, .5}, {.1, .58}, {.12, .66},
                                           {.135, .73}, {.14, .78}, {.1, .82}, {.043, .845}, {.04, .87}, {.062, .9}, {.07, .93}, {.062, .97},
                                           {.035, .993}, {0, 1}};
    const turned s = {.points = points, .count = COUNT_OF(points), .scale = height, .folds = 11, .fold_depth = .13, .fade = 1, .twist = .05,
                      .turn = turn, .flatness = .72};
    turned_write(w, &s, foot, 40, 2);
}

static void vase_write(obj_writer *w, spot foot, double height, uint32_t kind, uint32_t around, uint32_t rows)
{
    static const profile_point points[] = {{0, 0}, {.16, 0}, {.17, .03}, {.3, .2}, {.38, .42}, {.33, .62}, {.16, .78}, {.12, .86}, {.18, .97},
                                           {.2, 1}, {.17, .99}, {.1, .86}, {.12, .7}, {.28, .5}, {.26, .25}, {0, .1}};
    static const double folds[4] = {0, 5, 9, 24}, twists[4] = {0, .12, .25, 0}, depths[4] = {0, .09, .06, .02};
    const uint32_t k = kind % 4;
    const turned s = {.points = points, .count = COUNT_OF(points), .scale = height, .folds = folds[k], .fold_depth = depths[k],
                      .twist = twists[k]};
    turned_write(w, &s, foot, around, rows);
}

void model_vase(obj_writer *w, spot foot, double height, uint32_t kind)
{
    vase_write(w, foot, height, kind, 28, 2);
}

void model_pot(obj_writer *w, spot foot, double height, uint32_t kind)
{
    vase_write(w, foot, height, kind, 12, 1);
}

void model_lamp(obj_writer *w, spot foot, double height)
{
    static const profile_point points[] = {{0, 0}, {.035, 0}, {.03, .06}, {.014, .1}, {.01, .8}, {.016, .82}, {.045, .84}, {.06, .94}, {.02, .98},
                                           {0, 1}};
    const turned s = {.points = points, .count = COUNT_OF(points), .scale = height};
    turned_write(w, &s, foot, 10, 1);
}

// ---- Balls, also rough ones: crowns of trees ----

typedef struct rough_ball {
    double radius, roughness;
    double phases[4];
} rough_ball;

static spot ball_point(const void *shape, double u, double v)
{
    const rough_ball *b = shape;
    const double height = -turn_cosine(v / 2), ring = turn_sine(v / 2);
    double bumps = turn_sine(3 * u + b->phases[0]) * turn_sine(2 * v + b->phases[1]);
    bumps += turn_sine(5 * u + b->phases[2]) * turn_sine(3 * v + b->phases[3]) * 0.6 + turn_sine(2 * v + b->phases[1]) * 0.5;
    const double radius = b->radius * (1 + b->roughness * bumps * ring); // even at the poles, so that they stay one point
    return (spot){radius * ring * turn_cosine(u), radius * height, radius * ring * turn_sine(u)};
}

void model_ball(obj_writer *w, spot middle, double radius, uint32_t around)
{
    const rough_ball b = {.radius = radius};
    obj_surface(w, &(surface){.point = ball_point, .shape = &b, .around = around, .along = around / 2}, middle);
}

static void crown_write(obj_writer *w, spot middle, double radius, random_stream *r)
{
    rough_ball b = {.radius = radius, .roughness = 0.12};
    for (int i = 0; i < 4; ++i) b.phases[i] = random_unit(r);
    obj_surface(w, &(surface){.point = ball_point, .shape = &b, .around = 13, .along = 8}, middle);
}

void model_tree(obj_writer *w, spot foot, double height, random_stream *r)
{
    static const profile_point points[] = {{0, 0}, {.05, 0}, {.032, .06}, {.025, .3}, {.018, .6}, {0, .75}};
    const turned trunk = {.points = points, .count = COUNT_OF(points), .scale = height, .folds = 3, .fold_depth = .1, .twist = .1,
                          .turn = random_unit(r)};
    obj_material(w, "bark_wood");
    turned_write(w, &trunk, foot, 9, 1);
    obj_material(w, "leaves");
    const double turn = random_unit(r);
    for (int i = 0; i < 3; ++i) {
        const double angle = turn + i / 3.0, off = height * 0.13;
        const spot at = {foot.x + off * turn_cosine(angle), foot.y + height * (0.58 + 0.07 * i + 0.04 * random_unit(r)),
                         foot.z + off * turn_sine(angle)};
        crown_write(w, at, height * (0.19 + 0.04 * random_unit(r)), r);
    }
}

// ---- Trees of few triangles, for woods ----

typedef struct tier { double low_radius, high_radius, low, high; } tier;

static spot tier_point(const void *shape, double u, double v)
{
    const tier *t = shape;
    const double radius = t->low_radius * (1 - v) + t->high_radius * v;
    return (spot){radius * turn_cosine(u), t->low * (1 - v) + t->high * v, radius * turn_sine(u)};
}

static void tier_write(obj_writer *w, const tier *t, spot foot, uint32_t around)
{
    obj_surface(w, &(surface){.point = tier_point, .shape = t, .around = around, .along = 1}, foot);
}

static const double ROOT_M = 0.5; // in the ground, for it slopes

void model_conifer(obj_writer *w, spot foot, double height, random_stream *r)
{
    enum { TIERS = 5, AROUND = 11 };
    const double wide = height * (0.16 + 0.06 * random_unit(r));
    obj_material(w, "bark_wood");
    tier_write(w, &(tier){height * 0.025, height * 0.02, -ROOT_M, height * 0.3}, foot, 6);
    obj_material(w, "leaves_conifer");
    for (int i = 0; i < TIERS; ++i) {
        const double low = height * (0.15 + 0.15 * i), radius = wide * (1 - 0.16 * i);
        tier_write(w, &(tier){radius * 0.2, radius, low + height * 0.03, low}, foot, AROUND); // its underside
        tier_write(w, &(tier){radius, 0, low, low + height * 0.28}, foot, AROUND);
    }
}

void model_broadleaf(obj_writer *w, spot foot, double height, random_stream *r)
{
    obj_material(w, "bark_wood");
    tier_write(w, &(tier){height * 0.03, height * 0.015, -ROOT_M, height * 0.5}, foot, 6);
    obj_material(w, "leaves");
    const double turn = random_unit(r);
    for (int i = 0; i < 2; ++i) {
        const double off = height * 0.1, angle = turn + 0.5 * i;
        model_ball(w, (spot){foot.x + off * turn_cosine(angle), foot.y + height * (0.62 + 0.12 * i), foot.z + off * turn_sine(angle)},
                   height * (0.2 + 0.05 * random_unit(r)), 10);
    }
}

// ---- Rings ----

typedef struct torus { double radius, tube; } torus;

static spot torus_point(const void *shape, double u, double v) // in the x-y plane: standing
{
    const torus *t = shape;
    const double ring = t->radius + t->tube * turn_cosine(v);
    return (spot){ring * turn_cosine(u), ring * turn_sine(u), -t->tube * turn_sine(v)};
}

void model_ring(obj_writer *w, spot middle, double radius, double tube)
{
    const torus t = {radius, tube};
    obj_surface(w, &(surface){.point = torus_point, .shape = &t, .around = 40, .along = 20, .is_ring = 1}, middle);
}

typedef struct knot { double radius; } knot;

static spot trefoil(double turns, double radius)
{
    const double ring = radius * (2 + turn_cosine(3 * turns)) / 3;
    return (spot){ring * turn_cosine(2 * turns), ring * turn_sine(2 * turns), radius * turn_sine(3 * turns) / 2.4};
}

static spot unit_of(spot a)
{
    const double length = sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
    return (spot){a.x / length, a.y / length, a.z / length};
}

static spot cross_of(spot a, spot b)
{
    return (spot){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static spot knot_point(const void *shape, double u, double v) // u along the curve, v round the tube
{
    const knot *k = shape;
    const double step = 1.0 / 4096, tube = k->radius * 0.17;
    const spot a = trefoil(u - step, k->radius), b = trefoil(u, k->radius), c = trefoil(u + step, k->radius);
    const spot along = unit_of((spot){c.x - a.x, c.y - a.y, c.z - a.z});
    const spot inwards = unit_of((spot){a.x + c.x - 2 * b.x, a.y + c.y - 2 * b.y, a.z + c.z - 2 * b.z});
    const spot aside = cross_of(along, inwards), x = cross_of(aside, along);
    const double p = tube * turn_cosine(v), q = tube * turn_sine(v);
    return (spot){b.x + p * x.x + q * aside.x, b.y + p * x.y + q * aside.y, b.z + p * x.z + q * aside.z};
}

void model_knot(obj_writer *w, spot middle, double radius)
{
    const knot k = {radius};
    obj_surface(w, &(surface){.point = knot_point, .shape = &k, .around = 128, .along = 14, .is_ring = 1}, middle);
}
