// Views of lights: six faces of a cube and spots go through portals by the code of any view, and lose nothing that a straight
// line from the light reaches.
// SPDX-License-Identifier: MIT
// The oracle: points of items' boxes, and a line from the light that passes from room to room by holes only. It knows nothing of
// flow, volumes and cullers.
#include "site.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <string.h>

static const site_grid rooms = {.wide = 5, .deep = 4, .items = 700, .movers = 0, .seed = 43, .at = {-8, 0, -8}};
enum { ROOM_M = 4, ROOM_HIGH_M = 3, LIGHTS = 12, POINTS = 12, FACES = 6 };

static const char *const chains[] = {"frustum+portal", "frustum[backface=1]+portal[clip=octagon]", "frustum+portal[clip=rect]",
                                     "frustum+portal[clip=planes]", "frustum+portal[clip=flood]", "brute+portal"};
enum { CHAINS = sizeof chains / sizeof *chains };

static const double axes[FACES][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

// Whether a hole is round the point where the line leaves a room.
static int has_hole(const scene *s, const double at[3])
{
    for (uint32_t p = 0; p < s->portal_count; p++) {
        const double(*points)[3] = (const double(*)[3]) & s->portal_points[s->portals[p].first_point];
        int is_in = 1;
        for (int k = 0; k < 3; k++) {
            double low = points[0][k], high = points[0][k];
            for (uint32_t i = 1; i < s->portals[p].point_count; i++) {
                low = fmin(low, points[i][k]);
                high = fmax(high, points[i][k]);
            }
            is_in &= at[k] >= low - 1e-9 && at[k] <= high + 1e-9;
        }
        if (is_in) return 1;
    }
    return 0;
}

// Nothing but air on the straight way between two points of the grid.
static int is_clear(const scene *s, const double from[3], const double to[3])
{
    for (int axis = 0; axis < 3; axis += 2) {
        const double step = to[axis] - from[axis], first = ceil((fmin(from[axis], to[axis]) - rooms.at[axis]) / ROOM_M);
        for (double wall = first * ROOM_M + rooms.at[axis]; wall < fmax(from[axis], to[axis]); wall += ROOM_M) {
            double at[3];
            for (int k = 0; k < 3; k++) at[k] = from[k] + (wall - from[axis]) / step * (to[k] - from[k]);
            at[axis] = wall;
            if (!has_hole(s, at)) return 0;
        }
    }
    return 1;
}

static int is_in_grid(const double p[3])
{
    const double high[3] = {ROOM_M * (double)rooms.wide, ROOM_HIGH_M, ROOM_M * (double)rooms.deep};
    for (int k = 0; k < 3; k++)
        if (p[k] < rooms.at[k] || p[k] > rooms.at[k] + high[k]) return 0;
    return 1;
}

static int is_in_picture(const camera *c, const double p[3])
{
    double right[3], up[3], back[3], at[3] = {0, 0, 0};
    camera_axes(c, right, up, back);
    for (int k = 0; k < 3; k++) {
        at[0] += right[k] * (p[k] - c->eye[k]);
        at[1] += up[k] * (p[k] - c->eye[k]);
        at[2] -= back[k] * (p[k] - c->eye[k]);
    }
    const double tall = tan(c->fovy_deg * (3.14159265358979323846 / 360)) * at[2];
    return at[2] >= c->near_m && at[2] <= c->far_m && fabs(at[1]) <= tall && fabs(at[0]) <= tall * c->aspect;
}

static void random_point(const scene *s, uint32_t item, uint64_t *seed, double out[3])
{
    const cull_box b = cull_box_at(&s->boxes, item);
    for (int k = 0; k < 3; k++) {
        const double low = (double)(&b.min.x)[k], high = (double)(&b.max.x)[k];
        out[k] = s->whole.origin[k] + random_between(seed, low, high);
    }
}

typedef struct lit { uint64_t points, elsewhere; } lit; // elsewhere: in another room than the light's

// Every item of which the camera sees a point is in the set.
static void assert_lit(const site *s, const camera *c, const site_sight *sight, uint64_t *seed, lit *sum)
{
    for (uint32_t i = 0; i < s->scene->item_count; i++)
        for (int n = 0; n < POINTS; n++) {
            double p[3];
            random_point(s->scene, i, seed, p);
            if (!is_in_grid(p) || !is_in_picture(c, p) || !is_clear(s->scene, c->eye, p)) continue;
            sum->points++;
            for (int k = 0; k < 3; k += 2)
                if (floor((p[k] - rooms.at[k]) / ROOM_M) != floor((c->eye[k] - rooms.at[k]) / ROOM_M)) {
                    sum->elsewhere++;
                    break;
                }
            if (!sight->items[i]) fail_msg("item %u is not in the set, but %g %g %g is lit from %g %g %g", i, p[0], p[1], p[2], c->eye[0], c->eye[1], c->eye[2]);
        }
}

static world_view *open_rooms(site *s, const char *chain)
{
    world_view *v = NULL;
    site_begin(s, 0);
    assert_int_equal(site_make_grid(s, &rooms), RESULT_OK);
    if (site_open(s, &(site_world){chain, NULL, 0}) != RESULT_OK) fail_msg("%s", report_lines_only(&s->lines));
    assert_int_equal(world_view_open(s->world, VIEWER_CHECK_ALL, &s->lines.report, &v), RESULT_OK);
    return v;
}

// A light, now and then in a hole or on its edge.
static void light_place(const scene *s, uint64_t *seed, double eye[3])
{
    const camera c = site_random_camera(seed, &rooms);
    memcpy(eye, c.eye, sizeof c.eye);
    if (random_below(seed, 4)) return;
    const scene_portal *p = &s->portals[random_below(seed, s->portal_count)];
    const double(*points)[3] = (const double(*)[3]) & s->portal_points[p->first_point];
    const double share = random_below(seed, 2) ? 0 : random_between(seed, 0, 1);
    for (int k = 0; k < 3; k++) eye[k] = points[0][k] + share * (points[2][k] - points[0][k]);
}

static void six_faces_of_a_cube_through_portals_lose_nothing_that_the_light_reaches(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    for (int n = 0; n < CHAINS; n++) {
        uint64_t seed = 3;
        lit sum = {0, 0};
        world_view *v = open_rooms(&s, chains[n]);
        for (uint32_t light = 0; light < LIGHTS; light++) {
            double eye[3];
            light_place(s.scene, &seed, eye);
            for (uint32_t f = 0; f < FACES; f++) {
                camera c = site_camera(eye, axes[f]);
                c.fovy_deg = 90;
                c.aspect = 1;
                if (f == 2 || f == 3) c.up[0] = 1, c.up[1] = 0;
                frame_input q = site_input(&c, light * FACES + f + 1);
                q.frame.width_px = q.frame.height_px = 256;
                q.frame.purpose = CULL_VIEW_CUBE_FACE;
                site_look(&s, v, &q, &sight);
                assert_lit(&s, &c, &sight, &seed, &sum);
            }
        }
        assert_true(sum.points > 5000 && sum.elsewhere > 900);
        site_close(&s);
    }
}

static void a_spot_through_portals_loses_nothing_that_the_light_reaches(void **state)
{
    (void)state;
    static site s;
    static site_sight sight;
    for (int n = 0; n < CHAINS; n++) {
        uint64_t seed = 5;
        lit sum = {0, 0};
        world_view *v = open_rooms(&s, chains[n]);
        for (uint32_t light = 0; light < 6 * LIGHTS; light++) {
            camera c = site_random_camera(&seed, &rooms);
            light_place(s.scene, &seed, c.eye);
            c.fovy_deg = random_between(&seed, 10, 150);
            c.aspect = 1;
            c.far_m = random_between(&seed, 3, 15);
            frame_input q = site_input(&c, light + 1);
            q.frame.width_px = q.frame.height_px = 512;
            q.frame.purpose = CULL_VIEW_SHADOW;
            site_look(&s, v, &q, &sight);
            assert_lit(&s, &c, &sight, &seed, &sum);
        }
        assert_true(sum.points > 4000 && sum.elsewhere > 500);
        site_close(&s);
    }
}

// What a face sees depends on its camera, not on what it is for: the main view of the same camera has the same set.
static void the_purpose_of_a_view_changes_nothing_of_its_set(void **state)
{
    (void)state;
    static site s;
    static site_sight sight, other;
    static const cull_purpose purposes[] = {CULL_VIEW_SHADOW, CULL_VIEW_CUBE_FACE, CULL_VIEW_CAPTURE};
    uint64_t seed = 9;
    world_view *v = open_rooms(&s, chains[0]);
    for (uint32_t frame = 1; frame <= 200; frame++) {
        const camera c = site_random_camera(&seed, &rooms);
        frame_input q = site_input(&c, frame);
        site_look(&s, v, &q, &sight);
        q.frame.purpose = purposes[frame % 3];
        site_look(&s, v, &q, &other);
        assert_memory_equal(sight.items, other.items, sizeof sight.items);
    }
    site_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(six_faces_of_a_cube_through_portals_lose_nothing_that_the_light_reaches),
        cmocka_unit_test(a_spot_through_portals_loses_nothing_that_the_light_reaches),
        cmocka_unit_test(the_purpose_of_a_view_changes_nothing_of_its_set),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
