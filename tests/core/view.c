// Tests of what a view tells a culler that derives planes of its own: with it and plane.h it gets the host's planes.
// SPDX-License-Identifier: MIT
#include "host/core/view.h"
#include "tests/common/random.h"
#include "tests/common/test.h"

#include <portcullis/plane.h>

#include <math.h>
#include <string.h>

static camera random_camera(uint64_t *random, const double origin[3])
{
    camera c = {.up = {0, 1, 0}, .fovy_deg = random_between(random, 20, 120), .aspect = random_between(random, 0.5, 3), .near_m = 0.0625,
                .far_m = random_between(random, 50, 200)};
    for (int i = 0; i < 3; ++i) {
        c.eye[i] = origin[i] + random_between(random, -50, 50);
        c.forward[i] = random_between(random, -1, 1);
    }
    c.forward[0] += c.forward[0] < 0 ? -0.25 : 0.25;
    return c;
}

// One side of the picture as a culler would make it from the view alone.
static cull_plane side_plane(const cull_view *view, double radius, const double axis[3], double tangent)
{
    cull_guard guard = {.pixel_tangent = view->pixel_tangent, .reach = view->reach, .radius = radius};
    double normal[3];
    for (int i = 0; i < 3; ++i) {
        guard.eye[i] = view->eye_exact[i];
        guard.forward[i] = view->forward[i];
        normal[i] = (axis[i] + tangent * view->forward[i]) * (1 / sqrt(1 + tangent * tangent));
    }
    return cull_guard_plane(&guard, normal, 0);
}

static int volume_has(const view_volume *volume, cull_plane plane)
{
    for (uint32_t i = 0; i < volume->plane_count; ++i)
        if (memcmp(&volume->planes[i], &plane, sizeof plane) == 0) return 1;
    return 0;
}

static void a_culler_derives_the_host_s_planes_from_the_view(void **state)
{
    (void)state;
    static const double origin[3] = {4096.5, -17, 1e6};
    const cull_box box = {{-100, -100, -100}, {100, 100, 100}};
    uint64_t random = 3;
    for (uint32_t n = 0; n < 200; ++n) {
        const camera c = random_camera(&random, origin);
        const view_frame f = {.width_px = 640, .height_px = 360, .frame = n, .purpose = CULL_VIEW_MAIN};
        cull_view view;
        view_volume volume;
        double right[3], up[3], back[3];
        assert_null(camera_fault(&c));
        view_derive(&c, &f, origin, &box, &view, &volume);
        camera_axes(&c, right, up, back);
        const double tall = tan(c.fovy_deg * (3.14159265358979323846 / 360)), wide = tall * c.aspect;
        const uint32_t sides = volume.plane_count;
        assert_true(sides >= 4);
        for (int sign = -1; sign <= 1; sign += 2) {
            double axis[2][3];
            for (int i = 0; i < 3; ++i) {
                axis[0][i] = sign * right[i];
                axis[1][i] = sign * up[i];
            }
            assert_true(volume_has(&volume, side_plane(&view, (double)cull_box_radius(box), axis[0], wide)));
            assert_true(volume_has(&volume, side_plane(&view, (double)cull_box_radius(box), axis[1], tall)));
        }
    }
}

static void the_exact_eye_and_direction_are_the_camera_s(void **state)
{
    (void)state;
    static const double origin[3] = {1e6, 2e6, -3e6};
    const cull_box box = {{-100, -100, -100}, {100, 100, 100}};
    uint64_t random = 4;
    for (uint32_t n = 0; n < 200; ++n) {
        const camera c = random_camera(&random, origin);
        const view_frame f = {.width_px = 640, .height_px = 360, .frame = n, .purpose = CULL_VIEW_MAIN};
        cull_view view;
        view_volume volume;
        view_derive(&c, &f, origin, &box, &view, &volume);
        double length = 0;
        for (int i = 0; i < 3; ++i) {
            assert_true(view.eye_exact[i] == c.eye[i] - origin[i]);
            assert_true(view.eye[i] == (float)view.eye_exact[i]);
            length += view.forward[i] * view.forward[i];
        }
        assert_true(view.eye_exact[3] == 1);
        assert_true(fabs(length - 1) < 1e-12); // rounding of a few double operations
        const double tall = tan(c.fovy_deg * (3.14159265358979323846 / 360)), wide = tall * c.aspect;
        assert_true(view.pixel_tangent == fmax(2 * tall / 360, 2 * wide / 640));
        assert_true(view.reach > sqrt(1 + tall * tall + wide * wide)); // and a pixel more on each side
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_culler_derives_the_host_s_planes_from_the_view),
        cmocka_unit_test(the_exact_eye_and_direction_are_the_camera_s),
    };
    return cmocka_run_group_tests_name("core view", tests, NULL, NULL);
}
