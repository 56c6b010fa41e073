// Check that views of no sense do no harm: no crash, no endless loop, nothing written that is not sound.
// SPDX-License-Identifier: MIT
#include "checks.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { VIEWS = 60 };

static float odd_float(check_run *r)
{
    const float odd[] = {NAN, INFINITY, -INFINITY, 0, -0.0f, FLT_MAX, -FLT_MAX, FLT_MIN, 1e-45f, 1, -1, 1e30f};
    return odd[run_below(r, sizeof odd / sizeof *odd)];
}

static void spoil_planes(check_run *r, made_view *v)
{
    for (uint32_t i = 0; i < v->volume_count; ++i) {
        const uint32_t count = v->volumes[i].plane_count;
        const uint32_t how = run_below(r, 4);
        for (uint32_t k = 0; k < count; ++k) {
            cull_plane *p = &v->planes[i][k];
            if (how == 0) (&p->normal.x)[run_below(r, 4)] = odd_float(r); // offset stands behind the normal
            if (how == 1) *p = (cull_plane){{-p->normal.x, -p->normal.y, -p->normal.z}, -p->offset};
            if (how == 2) *p = (cull_plane){{0, 0, 0}, odd_float(r)};
        }
    }
}

static void spoil_view(check_run *r, made_view *v)
{
    for (uint32_t n = 1 + run_below(r, 6); n-- > 0;) {
        const float odd = odd_float(r);
        switch (run_below(r, 9)) {
        case 0: v->view.eye[run_below(r, 3)] = odd; break;
        case 1: v->view.eye_exact[run_below(r, 3)] = (double)odd; break;
        case 2: v->view.forward[run_below(r, 3)] = (double)odd; break;
        case 3: v->view.clip_from_zone[run_below(r, 16)] = odd; break;
        case 4: v->view.pixel_tangent = (double)odd; break;
        case 5: v->view.reach = (double)odd; break;
        case 6: v->view.pixels_per_tangent = odd; break;
        case 7: v->view.near_distance = odd; break;
        default: v->view.width_px = v->view.height_px = run_below(r, 2) ? 0 : 1; break;
        }
    }
}

// The volumes are as many as can be, with as many planes as can be, or none.
static void crowd(check_run *r, made_view *v)
{
    if (run_below(r, 6) == 0) v->volume_count = 0;
    for (uint32_t i = 0; i < v->volume_count; ++i) {
        const uint32_t count = run_below(r, 2) ? 0 : v->volumes[i].plane_count ? CULL_MAX_PLANES : 0;
        for (uint32_t k = v->volumes[i].plane_count; k < count; ++k) v->planes[i][k] = v->planes[i][k % v->volumes[i].plane_count];
        v->volumes[i].plane_count = count;
    }
}

check_verdict check_nonsense(check_run *r)
{
    for (int kind = 0; kind < SCENE_KINDS; ++kind) {
        static bench_seat b;
        const seat_request q = {.kind = (scene_kind)kind};
        const seat_state state = seat_open(r, &q, &b);
        if (state == SEAT_FAULTY) return CHECK_FAIL;
        for (uint32_t i = 0; state == SEAT_GOOD && i < VIEWS; ++i) {
            made_view v;
            view_make(r, &b.scene, (view_how)(i % VIEW_HOWS), &v);
            if (i % 3 == 0) spoil_planes(r, &v);
            if (i % 3 == 1) crowd(r, &v);
            if (i % 3 != 1) spoil_view(r, &v);
            run_at(r, "scene %s, nonsense %u of kind %u", made_scene_name((scene_kind)kind), (unsigned)i, (unsigned)(i % 3));
            const sitting_frame f = {.view = &v};
            sitting_step(&b.sitting, &f, &b.answer);
            if (*b.answer.fault) return run_fail(r, "%s", b.answer.fault);
        }
        seat_close(&b);
    }
    return CHECK_PASS;
}
