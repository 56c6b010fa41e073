// Check of baked indices: saved within its size, loaded it answers as the built one, damaged it is refused or does no harm.
// SPDX-License-Identifier: MIT
#include "checks.h"

#include <stdlib.h>
#include <string.h>

enum { VIEWS = 7, DAMAGES = 60 };

typedef struct baked { unsigned char *bytes; uint64_t size; } baked;

static check_verdict save(check_run *r, const bench_seat *b, const cull_bake *bake, baked *out)
{
    run_at(r, "save, scene %s", made_scene_name(b->scene.kind));
    if (!bake->save) return run_fail(r, "its cull.bake/1 has no save");
    out->size = bake->save(b->stand.culler, NULL, 0);
    if (out->size == 0 || out->size > (uint64_t)1 << 30) return run_fail(r, "it says that its index takes %llu bytes", (unsigned long long)out->size);
    fence room = fence_open((size_t)out->size, 64, 0, "memory behind the blob that it saves to");
    if (!room.memory) return run_skip(r, "no memory for the check itself");
    memset(room.memory, 0x5a, room.size);
    const uint64_t again = bake->save(b->stand.culler, room.memory, out->size);
    if (again != out->size) return run_fail(r, "it says %llu bytes, then %llu", (unsigned long long)out->size, (unsigned long long)again);
    out->bytes = malloc(room.size);
    if (!out->bytes) return run_skip(r, "no memory for the check itself");
    memcpy(out->bytes, room.memory, room.size);
    fence_close(&room);
    return CHECK_PASS;
}

// Built from the blob: what its steps give, against the fresh build's where `wanted`, else only that they are sound.
static check_verdict load(check_run *r, made_scene *s, const baked *blob, made_view views[VIEWS], const sitting_answer *wanted)
{
    static stand st;
    stand_values values;
    sitting seat;
    check_verdict verdict = CHECK_PASS;
    fence room = fence_open((size_t)blob->size, 64, 0, "memory behind the baked index that it was lent");
    if (!room.memory) return run_skip(r, "no memory for the check itself");
    if (blob->size) memcpy(room.memory, blob->bytes, (size_t)blob->size);
    stand_defaults(r->plugin, &values);
    const stand_request q = {.plugin = r->plugin, .values = &values, .scene = s, .blob = {room.memory, blob->size}};
    const cull_result built = stand_open(&st, &q);
    if (st.fault) return run_fail(r, "built from the blob: %s", st.fault);
    if (built != CULL_OK && wanted) return run_fail(r, "it refuses the index that it saved (result %d)", (int)built);
    if (built != CULL_OK && built != CULL_ERR_BLOB && built != CULL_ERR_MEMORY)
        return run_fail(r, "it refuses a damaged index with result %d, not CULL_ERR_BLOB", (int)built);
    if (built == CULL_OK && sitting_open(&seat, &st, LISTS_TIGHT) != CULL_OK) return run_fail(r, "it opens no query on a loaded index");
    sitting_answer answer;
    answer_open(&answer, s);
    for (uint32_t i = 0; built == CULL_OK && i < VIEWS && verdict == CHECK_PASS; ++i) {
        const sitting_frame f = {.view = &views[i]};
        sitting_step(&seat, &f, &answer);
        if (*answer.fault) verdict = run_fail(r, "with the index loaded, view %u: %s", (unsigned)i, answer.fault);
        else if (wanted && !answers_equal(&answer, &wanted[i]))
            verdict = run_fail(r, "view %u has another answer from the loaded index than from the built one", (unsigned)i);
    }
    answer_close(&answer);
    if (built == CULL_OK) sitting_close(&seat);
    stand_close(&st);
    if (verdict == CHECK_PASS && st.lender.live_blocks) verdict = run_fail(r, "it keeps the host's memory after an index that it was lent");
    lender_close(&st.lender);
    fence_close(&room);
    return verdict;
}

static check_verdict damage(check_run *r, made_scene *s, const baked *good, made_view views[VIEWS])
{
    for (uint32_t i = 0; i < DAMAGES; ++i) {
        baked bad = {malloc((size_t)good->size + 1), good->size};
        check_verdict verdict;
        if (!bad.bytes) return run_skip(r, "no memory for the check itself");
        memcpy(bad.bytes, good->bytes, (size_t)good->size);
        const uint32_t at = run_below(r, (uint32_t)good->size);
        if (i % 3 == 0) bad.bytes[at] ^= (unsigned char)(1u << run_below(r, 8));
        else if (i % 3 == 1) bad.size = at;
        else
            for (uint32_t k = at; k < good->size && k < at + 16; ++k) bad.bytes[k] = (unsigned char)run_bits(r);
        if (i == 2)
            for (uint32_t k = 0; k < good->size; ++k) bad.bytes[k] = (unsigned char)run_bits(r); // nothing of it is left
        run_at(r, "scene %s, damage %u: %s at byte %u of %u", made_scene_name(s->kind), (unsigned)i,
               i % 3 == 0 ? "a bit" : i % 3 == 1 ? "cut" : "bytes", (unsigned)at, (unsigned)good->size);
        verdict = load(r, s, &bad, views, NULL);
        free(bad.bytes);
        if (verdict == CHECK_FAIL) return verdict;
    }
    return CHECK_PASS;
}

check_verdict check_bake(check_run *r)
{
    static const scene_kind kinds[] = {SCENE_SPREAD, SCENE_CITY, SCENE_ROOM, SCENE_ONE};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
        static bench_seat b;
        static made_view views[VIEWS];
        sitting_answer wanted[VIEWS];
        baked good = {0};
        const seat_request q = {.kind = kinds[k]};
        const seat_state state = seat_open(r, &q, &b);
        if (state == SEAT_FAULTY) return CHECK_FAIL;
        if (state == SEAT_REFUSED) continue;
        const cull_bake *bake = r->plugin->get_extension(b.stand.culler, CULL_EXT_BAKE);
        if (!bake) return run_skip(r, "it has no cull.bake/1");
        if (save(r, &b, bake, &good) != CHECK_PASS) return CHECK_FAIL;
        for (uint32_t i = 0; i < VIEWS; ++i) {
            view_make(r, &b.scene, (view_how)(i % VIEW_HOWS), &views[i]);
            const sitting_frame f = {.view = &views[i]};
            answer_open(&wanted[i], &b.scene);
            sitting_step(&b.sitting, &f, &wanted[i]);
        }
        run_at(r, "load, scene %s", made_scene_name(kinds[k]));
        if (load(r, &b.scene, &good, views, wanted) == CHECK_FAIL || damage(r, &b.scene, &good, views) == CHECK_FAIL) return CHECK_FAIL;
        for (uint32_t i = 0; i < VIEWS; ++i) answer_close(&wanted[i]);
        free(good.bytes);
        seat_close(&b);
    }
    return CHECK_PASS;
}
