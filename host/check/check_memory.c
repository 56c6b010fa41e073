// Checks of memory: each allocation failed in turn, and all of it given back.
// SPDX-License-Identifier: MIT
#define _GNU_SOURCE
#include "checks.h"

#include <malloc.h>
#include <string.h>

enum { FAILURES_MOST = 400, LIVES = 12 };

// What the C library's heap holds: a culler may use it at build, and must give it back too. 0 where it cannot say.
static size_t heap_bytes(void)
{
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
    const struct mallinfo2 m = mallinfo2();
    return m.uordblks + m.hblkhd;
#else
    return 0;
#endif
}

typedef struct life_end { cull_result result; uint64_t live_blocks, live_bytes, wrong_frees, calls, failures; } life_end;

// Create, build, open, step, close, destroy, as far as it gets; what of the host's memory is left then.
static life_end live_once(check_run *r, made_scene *s, uint64_t fail_at)
{
    static stand st;
    sitting seat = {0};
    stand_values values;
    stand_defaults(r->plugin, &values);
    const stand_request q = {.plugin = r->plugin, .values = &values, .scene = s, .fail_at = fail_at};
    life_end end = {.result = stand_open(&st, &q)};
    if (end.result == CULL_OK) {
        end.result = sitting_open(&seat, &st, LISTS_ROOMY);
        if (end.result == CULL_OK && seat.query) {
            made_view v;
            sitting_answer answer;
            answer_open(&answer, s);
            view_make(r, s, VIEW_FREE, &v);
            const sitting_frame f = {.view = &v};
            sitting_step(&seat, &f, &answer);
            answer_close(&answer);
        }
        sitting_close(&seat);
    }
    stand_close(&st);
    end.live_blocks = st.lender.live_blocks;
    end.live_bytes = st.lender.live_bytes;
    end.wrong_frees = st.lender.wrong_frees;
    end.calls = st.lender.calls;
    end.failures = st.lender.failures;
    lender_close(&st.lender);
    return end;
}

static check_verdict judge_end(check_run *r, const life_end *e)
{
    if (e->live_blocks)
        return run_fail(r, "it keeps %llu blocks, %llu bytes, of the host's memory", (unsigned long long)e->live_blocks, (unsigned long long)e->live_bytes);
    if (e->wrong_frees)
        return run_fail(r, "it frees what it was not given, or with another size than it asked for, %llu times", (unsigned long long)e->wrong_frees);
    return CHECK_PASS;
}

static check_verdict fail_each(check_run *r, scene_kind kind)
{
    made_scene s;
    made_scene_make(r, kind, &s);
    if (stand_role_of(r->plugin) == ROLE_CROSS) made_scene_portals(r, &s);
    run_at(r, "a whole life, scene %s", made_scene_name(kind));
    const life_end good = live_once(r, &s, 0);
    const uint64_t stride = good.calls / FAILURES_MOST + 1;
    for (uint64_t k = 1; good.result == CULL_OK && k <= good.calls; k += stride) {
        run_at(r, "allocation %llu of %llu, scene %s", (unsigned long long)k, (unsigned long long)good.calls, made_scene_name(kind));
        const life_end e = live_once(r, &s, k);
        if (e.failures && e.result != CULL_OK && e.result != CULL_ERR_MEMORY)
            return run_fail(r, "it says result %d where memory ran out, not CULL_ERR_MEMORY", (int)e.result);
        if (judge_end(r, &e) == CHECK_FAIL) return CHECK_FAIL;
    }
    made_scene_free(&s);
    return CHECK_PASS;
}

check_verdict check_memory(check_run *r)
{
    static const scene_kind kinds[] = {SCENE_ONE, SCENE_CITY, SCENE_MESH, SCENE_EMPTY};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
        if (fail_each(r, kinds[i]) == CHECK_FAIL) return CHECK_FAIL;
    return CHECK_PASS;
}

check_verdict check_leaks(check_run *r)
{
    static const scene_kind kinds[] = {SCENE_SPREAD, SCENE_ROOM};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i) {
        made_scene s;
        size_t before = 0;
        int grown = 0; // lives in a row that left the heap larger; one alone may be the heap's own keeping
        made_scene_make(r, kinds[i], &s);
        if (stand_role_of(r->plugin) == ROLE_CROSS) made_scene_portals(r, &s);
        for (int n = 0; n < LIVES; ++n) {
            run_at(r, "life %d on scene %s", n, made_scene_name(kinds[i]));
            const life_end e = live_once(r, &s, 0);
            if (judge_end(r, &e) == CHECK_FAIL) return CHECK_FAIL;
            const size_t after = heap_bytes();
            grown = after > before ? grown + 1 : 0;
            before = after;
        }
        if (grown >= LIVES / 2) return run_fail(r, "the C library's heap grows with every life");
        made_scene_free(&s);
    }
    return CHECK_PASS;
}
