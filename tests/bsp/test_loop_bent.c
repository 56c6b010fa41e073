// Polygons that rounding to float has bent: told, and then no line of theirs cuts off what lies inside.
// SPDX-License-Identifier: MIT
#include "plugins/bsp/flow.h"
#include "plugins/bsp/loop_bent.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>

static const double MOST = 64 * 0x1p-22; // metres; as flow_index.c has it for a zone of 64 m

// An opening of a map turned by -71.3 degrees that lost a wall behind it: the last two corners are one step of float apart, so the edge
// between them leaves the plane by 7 degrees, and the eye sees it at a grazing angle.
static const cull_vec3 turned[5] = {{1.2297432f, -3.3732638f, 6.2163873f}, {1.4902709f, -3.5601273f, 7.1635976f}, {3.8379316f, -7.7237854f, 5.6964827f},
                                    {4.0469360f, -8.3696537f, 4.4558496f}, {4.0469360f, -8.3696537f, 4.4558487f}};

static void turned_normal(double out[3])
{
    double u[3], v[3], square = 0;
    u[0] = (double)turned[2].x - (double)turned[0].x, u[1] = (double)turned[2].y - (double)turned[0].y, u[2] = (double)turned[2].z - (double)turned[0].z;
    v[0] = (double)turned[3].x - (double)turned[1].x, v[1] = (double)turned[3].y - (double)turned[1].y, v[2] = (double)turned[3].z - (double)turned[1].z;
    for (int k = 0; k < 3; k++) out[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    for (int k = 0; k < 3; k++) square += out[k] * out[k];
    for (int k = 0; k < 3; k++) out[k] /= sqrt(square);
}

typedef struct polygon { cull_vec3 points[8]; uint32_t count; double normal[3]; } polygon;

// Corners on a circle, some of them all but one, rounded to float; turned anyhow.
static polygon polygon_random(uint64_t *seed)
{
    polygon p = {.count = 3 + random_below(seed, 6)};
    double u[3], v[3], middle[3], angle = 0;
    random_direction(seed, p.normal);
    do {
        random_direction(seed, v);
        for (int k = 0; k < 3; k++) u[k] = p.normal[(k + 1) % 3] * v[(k + 2) % 3] - p.normal[(k + 2) % 3] * v[(k + 1) % 3];
    } while ((u[0] * u[0] + u[1] * u[1]) + u[2] * u[2] < 0.01);
    const double length = sqrt((u[0] * u[0] + u[1] * u[1]) + u[2] * u[2]);
    for (int k = 0; k < 3; k++) u[k] /= length;
    for (int k = 0; k < 3; k++) v[k] = p.normal[(k + 1) % 3] * u[(k + 2) % 3] - p.normal[(k + 2) % 3] * u[(k + 1) % 3];
    for (int k = 0; k < 3; k++) middle[k] = random_between(seed, -20, 20);
    for (uint32_t i = 0; i < p.count; i++) {
        const double step = 6.2831853 / p.count;
        angle += random_below(seed, 3) ? step : pow(10, random_between(seed, -7, 0)) * step;
        double at[3];
        for (int k = 0; k < 3; k++) at[k] = middle[k] + 5 * (cos(angle) * u[k] + sin(angle) * v[k]);
        p.points[i] = (cull_vec3){(float)at[0], (float)at[1], (float)at[2]};
    }
    return p;
}

// The eye at e looks along -normal, so that everything lies before it.
static void shape_look(const polygon *p, const double e[3], flow_shape *out)
{
    const double *w = p->normal;
    double u[3] = {0, -w[2], w[1]}, v[3];
    if (u[1] * u[1] + u[2] * u[2] < 0.1) u[0] = w[2], u[1] = 0, u[2] = -w[0];
    const double length = sqrt((u[0] * u[0] + u[1] * u[1]) + u[2] * u[2]);
    for (int k = 0; k < 3; k++) u[k] /= length;
    for (int k = 0; k < 3; k++) v[k] = u[(k + 1) % 3] * -w[(k + 2) % 3] - u[(k + 2) % 3] * -w[(k + 1) % 3]; // up = right x forward
    for (uint32_t i = 0; i <= p->count; i++) {
        const cull_vec3 q = p->points[i < p->count ? i : 0];
        const double d[3] = {(double)q.x - e[0], (double)q.y - e[1], (double)q.z - e[2]};
        out->x[i] = (d[0] * u[0] + d[1] * u[1]) + d[2] * u[2];
        out->y[i] = (d[0] * v[0] + d[1] * v[1]) + d[2] * v[2];
        out->z[i] = -((d[0] * w[0] + d[1] * w[1]) + d[2] * w[2]);
    }
    out->count = p->count;
    out->is_bent = (uint32_t)loop_is_bent(p->points, p->count, p->normal, MOST);
}

// By how many metres the worst corner lies outside of a line.
static double outside_by(const flow_shape *s, double e_height)
{
    window_line lines[FLOW_POINTS + 2];
    double worst = 0;
    flow_shape_edges(s, (flow_margin){0, 0, 0}, lines);
    for (uint32_t i = 0; i < s->count; i++)
        for (uint32_t k = 0; k < s->count; k++) {
            const double size = sqrt((lines[i].a * lines[i].a + lines[i].b * lines[i].b) + lines[i].c * lines[i].c);
            const double at = (lines[i].a * s->x[k] + lines[i].b * s->y[k]) + lines[i].c * s->z[k];
            if (size > 1e-12 * e_height) worst = fmax(worst, -at / size);
        }
    return worst;
}

static void an_edge_as_short_as_the_rounding_is_told(void **state)
{
    (void)state;
    double normal[3];
    turned_normal(normal);
    assert_true(loop_is_bent(turned, 5, normal, MOST));
    assert_false(loop_is_bent(turned, 4, normal, MOST));
}

static void a_rectangle_whose_corners_float_holds_is_not_bent(void **state)
{
    (void)state;
    const cull_vec3 flat[4] = {{0, 0, 0}, {8, 0, 0}, {8, 0.001f, 0}, {0, 0.001f, 0}};
    assert_false(loop_is_bent(flat, 4, (const double[3]){0, 0, 1}, MOST));
    assert_true(loop_is_bent(flat, 4, (const double[3]){0, 0, -1}, MOST)); // seen from its back every corner is outside
}

static void no_line_of_any_edge_has_a_corner_outside_by_more_than_the_slack_allows(void **state)
{
    (void)state;
    uint64_t seed = 11;
    uint32_t bent = 0, straight = 0;
    for (int i = 0; i < 20000; i++) {
        const polygon p = polygon_random(&seed);
        const double corner[3] = {(double)p.points[0].x, (double)p.points[0].y, (double)p.points[0].z}, height = pow(10, random_between(&seed, -2, 1.5));
        double e[3], above = 0;
        for (int k = 0; k < 3; k++) e[k] = corner[k] + random_between(&seed, -30, 30);
        for (int k = 0; k < 3; k++) above += p.normal[k] * (e[k] - corner[k]);
        for (int k = 0; k < 3; k++) e[k] += (height - above) * p.normal[k];
        flow_shape s;
        shape_look(&p, e, &s);
        bent += s.is_bent;
        straight += !s.is_bent;
        assert_true(outside_by(&s, height) <= (s.is_bent ? 1e-9 : 2 * MOST));
    }
    assert_true(bent > 1000 && straight > 1000);
}

// The finding that named it: a corner before the eye lies a tenth outside, one behind the eye half of that inside.
static void a_bent_polygon_that_reaches_behind_the_eye_loses_nothing_between(void **state)
{
    (void)state;
    flow_shape s = {.x = {0, -0.1, 0.05, 1}, .y = {-1, -1, -1, -1}, .z = {3, 1, -1, 1}, .count = 4, .is_bent = 1};
    s.x[4] = s.x[0], s.y[4] = s.y[0], s.z[4] = s.z[0];
    window_line lines[FLOW_POINTS + 2];
    flow_shape_edges(&s, (flow_margin){0, 0, 0}, lines);
    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t k = 0; k < 4; k++)
            for (int step = 0; step <= 100; step++) { // from corner k to the next, where that lies before the eye
                const double t = step / 100.0, x = s.x[k] + t * (s.x[k + 1] - s.x[k]), y = s.y[k] + t * (s.y[k + 1] - s.y[k]), z = s.z[k] + t * (s.z[k + 1] - s.z[k]);
                if (z > 0.01) assert_true((lines[i].a * x + lines[i].b * y) + lines[i].c * z >= -1e-12);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_edge_as_short_as_the_rounding_is_told),
        cmocka_unit_test(a_rectangle_whose_corners_float_holds_is_not_bent),
        cmocka_unit_test(a_bent_polygon_that_reaches_behind_the_eye_loses_nothing_between),
        cmocka_unit_test(no_line_of_any_edge_has_a_corner_outside_by_more_than_the_slack_allows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
