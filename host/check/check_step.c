// Checks of what a step does besides its answer: what it calls, and what it writes to.
// SPDX-License-Identifier: MIT
#include "checks.h"
#include "process.h"
#include "trap.h"

#include <string.h>

enum { VIEWS = 8 };
static const scene_kind kinds[] = {SCENE_SPREAD, SCENE_CITY, SCENE_PANES};

typedef struct quiet_hooks { const trap *trap; lender *lender; } quiet_hooks;

static void quiet_begins(void *user)
{
    const quiet_hooks *q = user;
    q->lender->is_in_step = 1;
    trap_set(q->trap);
}

static void quiet_ends(void *user)
{
    const quiet_hooks *q = user;
    trap_clear(q->trap);
    q->lender->is_in_step = 0;
}

static void kernel_ends(void *user)
{
    (void)user;
    process_pass_now();
}

static void kernel_begins(void *user)
{
    const int *is_set = user;
    if (!*is_set) *(int *)user = trap_kernel() ? 1 : -1;
}

static check_verdict step_views(check_run *r, bench_seat *b, const sitting_hooks *hooks)
{
    for (uint32_t i = 0; i < VIEWS; ++i) {
        made_view v;
        view_make(r, &b->scene, (view_how)(i % VIEW_HOWS), &v);
        run_at(r, "scene %s, view %u", made_scene_name(b->scene.kind), (unsigned)i);
        const sitting_frame f = {.view = &v, .hooks = hooks};
        sitting_step(&b->sitting, &f, &b->answer);
        if (b->stand.lender.calls_in_step) return run_fail(r, "it asked the host for memory in a step, or gave some back");
    }
    return CHECK_PASS;
}

// One step, the last of this process: the kernel's rule cannot be lifted, so it ends behind the step.
static check_verdict last_step(check_run *r, bench_seat *b)
{
    made_view v;
    int is_set = 0;
    const sitting_hooks hooks = {kernel_begins, kernel_ends, &is_set};
    view_make(r, &b->scene, VIEW_FREE, &v);
    run_at(r, "scene %s, by the kernel", made_scene_name(b->scene.kind));
    const sitting_frame f = {.view = &v, .hooks = &hooks};
    sitting_step(&b->sitting, &f, &b->answer);
    return CHECK_PASS;
}

check_verdict check_quiet(check_run *r)
{
    static bench_seat b;
    static trap t;
    if (r->file && !trap_find(&t, r->plugin)) return run_skip(r, "its table of imported functions cannot be read here");
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i) {
        const seat_request q = {.kind = kinds[i]};
        const seat_state state = seat_open(r, &q, &b);
        if (state == SEAT_FAULTY) return CHECK_FAIL;
        if (state == SEAT_REFUSED) continue;
        const quiet_hooks quiet = {&t, &b.stand.lender};
        const sitting_hooks hooks = {quiet_begins, quiet_ends, (void *)(uintptr_t)&quiet};
        if (step_views(r, &b, &hooks) == CHECK_FAIL) return CHECK_FAIL;
        if (i + 1 < sizeof kinds / sizeof *kinds) seat_close(&b);
        else return last_step(r, &b);
    }
    return run_skip(r, "it refuses the scenes for this");
}

// ---- What it writes to ----

typedef enum seal_what { SEAL_INDEX, SEAL_ZONE } seal_what;

static check_verdict sealed(check_run *r, scene_kind kind, seal_what what)
{
    static bench_seat b;
    static trap t;
    const seat_request q = {.kind = kind};
    const seat_state state = seat_open(r, &q, &b);
    if (state == SEAT_FAULTY) return CHECK_FAIL;
    if (state == SEAT_REFUSED) return CHECK_SKIP;
    sitting_close(&b.sitting);
    if (what == SEAL_INDEX) lender_seal(&b.stand.lender); // before the query: its memory is not the index's
    if (sitting_open(&b.sitting, &b.stand, LISTS_ROOMY) != CULL_OK) return run_fail(r, "it opens no second query");
    if (what == SEAL_INDEX && r->file && trap_find(&t, r->plugin)) trap_seal_data(&t);
    if (what == SEAL_ZONE) made_scene_protect(&b.scene);
    if (step_views(r, &b, NULL) == CHECK_FAIL) return CHECK_FAIL;
    run_at(r, "close and destroy, scene %s", made_scene_name(kind));
    trap_release_data(&t);
    const int is_same = what != SEAL_ZONE || made_scene_hash(&b.scene) == b.scene.hash;
    if (!is_same) return run_fail(r, "it changed the zone that it was lent");
    seat_close(&b);
    return CHECK_PASS;
}

check_verdict check_constant(check_run *r)
{
    check_verdict verdict = CHECK_SKIP;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i) {
        const check_verdict got = sealed(r, kinds[i], SEAL_INDEX);
        if (got == CHECK_FAIL) return got;
        if (got == CHECK_PASS) verdict = got;
    }
    return verdict == CHECK_PASS ? verdict : run_skip(r, "it refuses the scenes for this");
}

check_verdict check_zone(check_run *r)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
        if (sealed(r, kinds[i], SEAL_ZONE) == CHECK_FAIL) return CHECK_FAIL;
    return CHECK_PASS;
}
