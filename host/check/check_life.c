// Checks of a whole life on every scene: that it ends, and that what it writes is sound and within bounds.
// SPDX-License-Identifier: MIT
#include "checks.h"

#include <string.h>

enum { VIEWS = 14 };

typedef enum life_strictness { LIFE_LENIENT, LIFE_STRICT } life_strictness;

static check_verdict live(check_run *r, const seat_request *q, life_strictness how)
{
    static bench_seat b;
    const seat_state state = seat_open(r, q, &b);
    if (state == SEAT_FAULTY) return CHECK_FAIL;
    for (uint32_t i = 0; state == SEAT_GOOD && i < VIEWS; ++i) {
        made_view v;
        view_make(r, &b.scene, (view_how)(i % VIEW_HOWS), &v);
        run_at(r, "scene %s, view %u (%s)", made_scene_name(q->kind), (unsigned)i, view_name((view_how)(i % VIEW_HOWS)));
        const sitting_frame f = {.view = &v};
        sitting_step(&b.sitting, &f, &b.answer);
        if (how == LIFE_STRICT && *b.answer.fault) return run_fail(r, "%s", b.answer.fault);
    }
    run_at(r, "close and destroy, scene %s", made_scene_name(q->kind));
    seat_close(&b);
    return state == SEAT_GOOD ? CHECK_PASS : CHECK_SKIP;
}

static check_verdict live_everywhere(check_run *r, sitting_lists lists, life_strictness how)
{
    uint32_t lived = 0;
    for (int kind = 0; kind < SCENE_KINDS; ++kind) {
        const seat_request q = {.kind = (scene_kind)kind, .lists = lists};
        const check_verdict verdict = live(r, &q, how);
        if (verdict == CHECK_FAIL) return verdict;
        lived += verdict == CHECK_PASS;
    }
    run_at(r, "all scenes");
    return lived ? CHECK_PASS : run_fail(r, "it refuses every zone");
}

check_verdict check_life(check_run *r)
{
    return live_everywhere(r, LISTS_ROOMY, LIFE_LENIENT);
}

check_verdict check_batch(check_run *r)
{
    const check_verdict verdict = live_everywhere(r, LISTS_ROOMY, LIFE_STRICT);
    if (verdict != CHECK_PASS) return verdict;
    stand_values values;
    char name[128], words[512];
    for (uint32_t v = 1; variant_make(r->plugin, v, &values, name, sizeof name, words, sizeof words); ++v) {
        const seat_request q = {.kind = (scene_kind)(run_below(r, SCENE_EMPTY)), .values = &values};
        const check_verdict got = live(r, &q, LIFE_STRICT);
        if (got != CHECK_FAIL) continue;
        run_at(r, "with %s", name);
        return run_fail(r, "%.400s", r->message);
    }
    return CHECK_PASS;
}

check_verdict check_bounds(check_run *r)
{
    return live_everywhere(r, LISTS_TIGHT, LIFE_LENIENT);
}
