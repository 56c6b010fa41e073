// Check of a crosser: a line from the eye, within the volume and through the portal, is within what it says of behind.
// SPDX-License-Identifier: MIT
#include "checks.h"

#include <math.h>
#include <string.h>

enum { VIEWS = 30, LINES = 60 };

// In double, on planes that were moved outward: a line inside stays inside.
static double height_of(const cull_plane *p, const double at[3])
{
    return (double)p->normal.x * at[0] + (double)p->normal.y * at[1] + (double)p->normal.z * at[2] + (double)p->offset;
}

static check_verdict one_line(check_run *r, const bench_seat *b, const made_view *v, uint32_t portal)
{
    const cull_portal *p = &b->scene.zone.portals[portal];
    const sitting_answer *a = &b->answer;
    double at[3] = {0, 0, 0}, sum = 0, weight[4], side = (double)p->plane.offset;
    for (int i = 0; i < 4; ++i) sum += weight[i] = run_between(r, 0.01, 1);
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) at[k] += weight[i] / sum * (double)(&p->points[i].x)[k];
    for (int k = 0; k < 3; ++k) side += (double)(&p->plane.normal.x)[k] * v->camera.eye[k];
    if (side <= 0 || !view_wants(v, at)) return CHECK_PASS; // seen from behind it leads nowhere
    if (a->crossings[portal] == CULL_CROSS_NONE)
        return run_fail(r, "it says that nothing is seen through portal %u, and a line from the eye passes", (unsigned)portal);
    const double on = run_between(r, 1, 4);
    double behind[3];
    for (int k = 0; k < 3; ++k) behind[k] = v->camera.eye[k] + on * (at[k] - v->camera.eye[k]);
    if (!view_wants(v, behind)) return CHECK_PASS; // beyond the far plane
    for (uint32_t i = 0; i < a->plane_counts[portal]; ++i)
        if (height_of(&a->planes[portal * CULL_MAX_PLANES + i], behind) < 0)
            return run_fail(r, "plane %u of what it says is behind portal %u cuts off a line from the eye through it", (unsigned)i, (unsigned)portal);
    return CHECK_PASS;
}

static check_verdict cross_views(check_run *r, bench_seat *b, const char *variant)
{
    for (uint32_t i = 0; i < VIEWS; ++i) {
        const view_how hows[] = {VIEW_FREE, VIEW_WIDE, VIEW_WINDOWS, VIEW_NARROW};
        made_view v;
        view_make(r, &b->scene, hows[i % 4], &v);
        v.volume_count = v.volume_count ? 1 : 0; // cross takes one
        run_at(r, "scene %s, view %u (%s), %s", made_scene_name(b->scene.kind), (unsigned)i, view_name(hows[i % 4]), variant);
        const sitting_frame f = {.view = &v};
        sitting_step(&b->sitting, &f, &b->answer);
        if (*b->answer.fault) return run_fail(r, "%s", b->answer.fault);
        for (uint32_t portal = 0; portal < b->scene.zone.portal_count; ++portal)
            for (int line = 0; line < LINES; ++line)
                if (one_line(r, b, &v, portal) == CHECK_FAIL) return CHECK_FAIL;
    }
    return CHECK_PASS;
}

check_verdict check_cross(check_run *r)
{
    static const scene_kind kinds[] = {SCENE_SPREAD, SCENE_CITY, SCENE_ROOM, SCENE_FAR};
    stand_values values;
    char name[128], words[512];
    if (stand_role_of(r->plugin) != ROLE_CROSS) return run_skip(r, "it crosses no portals");
    for (uint32_t n = 0; variant_make(r->plugin, n, &values, name, sizeof name, words, sizeof words); ++n)
        for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
            static bench_seat b;
            const seat_request q = {.kind = kinds[k], .values = &values};
            const seat_state state = seat_open(r, &q, &b);
            if (state == SEAT_FAULTY || (state == SEAT_GOOD && cross_views(r, &b, name) == CHECK_FAIL)) return CHECK_FAIL;
            seat_close(&b);
        }
    return CHECK_PASS;
}
