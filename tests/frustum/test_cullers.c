// Tests of `none`, `brute` and `frustum`: every instruction set finds exactly the set of a scalar loop over the boxes.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ITEMS = 20000, MOST_VOLUMES = 6, KIND_COUNT = 5, ISA_COUNT = 3 };
static const char *const isas[ISA_COUNT] = {"plain", "avx2", "avx512"};

typedef enum boxes_kind { BOXES_SPREAD, BOXES_CLUSTERED, BOXES_GRID, BOXES_EQUAL, BOXES_ONE_GIANT } boxes_kind;

static cull_box *make_boxes(uint64_t *r, boxes_kind kind, uint32_t count)
{
    cull_box *boxes = calloc((size_t)count + 1, sizeof *boxes);
    assert_non_null(boxes);
    double middle[3] = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++) {
        if (kind == BOXES_CLUSTERED && i % 50 == 0)
            for (int k = 0; k < 3; k++) middle[k] = random_between(r, -90, 90);
        for (int k = 0; k < 3; k++) {
            double at = middle[k] + random_between(r, -1, 1) * (kind == BOXES_CLUSTERED ? 3 : 100);
            double size = random_unit(r) < 0.2 ? 0 : random_between(r, 0, 4);
            if (kind == BOXES_GRID) {
                at = floor(at / 10) * 10;
                size = 10;
            }
            if (kind == BOXES_EQUAL) at = size = 5;
            if (kind == BOXES_ONE_GIANT && i == count / 2) {
                at = -100;
                size = 200;
            }
            (&boxes[i].min.x)[k] = (float)at;
            (&boxes[i].max.x)[k] = (float)(at + size);
        }
    }
    return boxes;
}

typedef struct random_volumes {
    cull_plane planes[MOST_VOLUMES][CULL_MAX_PLANES];
    cull_volume volumes[MOST_VOLUMES];
    uint32_t count;
} random_volumes;

static void make_volumes(uint64_t *r, uint32_t count, random_volumes *out)
{
    out->count = count;
    for (uint32_t v = 0; v < count; v++) {
        uint32_t planes = (uint32_t)random_between(r, 0, 7);
        if (random_unit(r) < 0.1) planes = (uint32_t)random_between(r, 0, CULL_MAX_PLANES + 1);
        double middle[3];
        for (int i = 0; i < 3; i++) middle[i] = random_between(r, -100, 100);
        for (uint32_t k = 0; k < planes; k++) {
            double n[3];
            random_direction(r, n);
            if (random_unit(r) < 0.2) { // along an axis, maybe through box faces
                const int axis = (int)(random_unit(r) * 3);
                for (int i = 0; i < 3; i++) n[i] = i == axis ? (random_unit(r) < 0.5 ? -1 : 1) : 0;
            }
            double offset = random_unit(r) < 0.5 ? random_between(r, 0, 60) : random_between(r, -5, 20);
            for (int i = 0; i < 3; i++) offset -= n[i] * middle[i];
            if (random_unit(r) < 0.1) offset = rint(offset / 10) * 10;
            out->planes[v][k] = (cull_plane){{(float)n[0], (float)n[1], (float)n[2]}, (float)offset};
        }
        out->volumes[v] = (cull_volume){planes ? out->planes[v] : NULL, planes, 0};
    }
}

static uint32_t oracle(const cull_box *boxes, uint32_t count, const random_volumes *v, uint8_t *seen)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        seen[i] = 0;
        for (uint32_t k = 0; k < v->count; k++) seen[i] |= cull_volume_touches(&v->volumes[k], boxes[i]) ? 1 : 0;
        sum += seen[i];
    }
    return sum;
}

static const cull_plugin *frustum_or_skip(void)
{
    const cull_plugin *p = plugin_named("frustum");
    if (!p) {
        fprintf(stderr, "SKIPPED: the frustum library is not built\n");
        skip();
    }
    return p;
}

// Opens frustum and brute in each instruction set that this CPU has. Returns how many.
static uint32_t open_all(session *s, culler_host *h, const cull_plugin *frustum, const cull_zone *zone)
{
    uint32_t count = 0;
    for (int i = 0; i < ISA_COUNT; i++) {
        const char *values[2] = {"0", isas[i]};
        if (session_open(&s[count], h, frustum, zone, values) == CULL_OK) count++;
        if (session_open(&s[count], h, &builtin_brute, zone, &values[1]) == CULL_OK) count++;
    }
    assert_in_range(count, 2, 2 * ISA_COUNT);
    return count;
}

static const cull_view some_view = {.eye = {0, 0, 0, 1}, .width_px = 64, .height_px = 64, .purpose = CULL_VIEW_MAIN};

static void every_culler_and_instruction_set_finds_the_set_of_the_scalar_loop(void **state)
{
    (void)state;
    const cull_plugin *frustum = frustum_or_skip();
    static const uint32_t counts[] = {0, 1, 2, 15, 16, 17, 31, 33, 100, 255, 256, 257, 1000, 1023, 1025, 4096, 4097, MOST_ITEMS};
    static uint8_t expected[MOST_ITEMS], seen[MOST_ITEMS];
    uint64_t r = {21};
    uint64_t queries = 0, visible = 0;
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++)
        for (int kind = 0; kind < KIND_COUNT; kind++) {
            culler_host h;
            culler_host_init(&h, 0);
            cull_box *boxes = make_boxes(&r, (boxes_kind)kind, counts[c]);
            hand_zone zone;
            zone_of_boxes(boxes, counts[c], &zone);
            session s[2 * ISA_COUNT];
            const uint32_t session_count = open_all(s, &h, frustum, &zone.zone);
            for (int q = 0; q < (counts[c] > 5000 ? 40 : 100); q++) {
                static random_volumes v;
                make_volumes(&r, q % 3 ? 1 : (uint32_t)random_between(&r, 0, MOST_VOLUMES + 1), &v);
                visible += oracle(boxes, counts[c], &v, expected);
                for (uint32_t i = 0; i < session_count; i++) {
                    const uint64_t allocations = h.memory.calls;
                    session_select(&s[i], &some_view, v.volumes, v.count);
                    assert_true(h.memory.calls == allocations);
                    const char *wrong = session_set(&s[i], seen);
                    if (wrong) fail_msg("%s %u items, query %d, session %u: %s", s[i].plugin->descriptor->id, counts[c], q, i, wrong);
                    if (counts[c]) assert_memory_equal(seen, expected, counts[c]);
                    queries++;
                }
            }
            for (uint32_t i = 0; i < session_count; i++) session_close(&s[i]);
            assert_int_equal(h.memory.live_blocks, 0);
            assert_int_equal(h.memory.live_bytes, 0);
            hand_zone_free(&zone);
            free(boxes);
        }
    assert_true(queries > 10000 && visible > 100000);
}

static void permuted_boxes_give_the_same_set(void **state)
{
    (void)state;
    const cull_plugin *frustum = frustum_or_skip();
    enum { COUNT = 3000 };
    static uint8_t a[COUNT], b[COUNT];
    uint64_t r = {22};
    cull_box *boxes = make_boxes(&r, BOXES_SPREAD, COUNT), *shuffled = calloc(COUNT, sizeof *shuffled);
    uint32_t from[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) from[i] = i;
    for (uint32_t i = COUNT - 1; i > 0; i--) {
        const uint32_t j = (uint32_t)(random_bits(&r) % (i + 1)), swap = from[i];
        from[i] = from[j];
        from[j] = swap;
    }
    for (uint32_t i = 0; i < COUNT; i++) shuffled[i] = boxes[from[i]];
    culler_host h;
    culler_host_init(&h, 0);
    hand_zone za, zb;
    zone_of_boxes(boxes, COUNT, &za);
    zone_of_boxes(shuffled, COUNT, &zb);
    session sa, sb;
    const char *values[2] = {"0", "auto"};
    assert_int_equal(session_open(&sa, &h, frustum, &za.zone, values), CULL_OK);
    assert_int_equal(session_open(&sb, &h, frustum, &zb.zone, values), CULL_OK);
    for (int q = 0; q < 200; q++) {
        static random_volumes v;
        make_volumes(&r, 1 + (uint32_t)q % 3, &v);
        session_select(&sa, &some_view, v.volumes, v.count);
        session_select(&sb, &some_view, v.volumes, v.count);
        assert_null(session_set(&sa, a));
        assert_null(session_set(&sb, b));
        for (uint32_t i = 0; i < COUNT; i++) assert_int_equal(b[i], a[from[i]]);
    }
    session_close(&sa);
    session_close(&sb);
    hand_zone_free(&za);
    hand_zone_free(&zb);
    free(boxes);
    free(shuffled);
}

static void scaling_by_a_power_of_two_gives_the_same_set(void **state)
{
    (void)state;
    const cull_plugin *frustum = frustum_or_skip();
    enum { COUNT = 2000 };
    static uint8_t a[COUNT], b[COUNT];
    static const float scales[] = {0x1p-13f, 0.5f, 0x1p10f};
    uint64_t r = {23};
    cull_box *boxes = make_boxes(&r, BOXES_CLUSTERED, COUNT), *scaled = calloc(COUNT, sizeof *scaled);
    for (size_t k = 0; k < sizeof scales / sizeof scales[0]; k++) {
        for (uint32_t i = 0; i < COUNT; i++)
            for (int j = 0; j < 6; j++) (&scaled[i].min.x)[j] = (&boxes[i].min.x)[j] * scales[k];
        culler_host h;
        culler_host_init(&h, 0);
        hand_zone za, zb;
        zone_of_boxes(boxes, COUNT, &za);
        zone_of_boxes(scaled, COUNT, &zb);
        session sa, sb;
        const char *values[2] = {"0", "auto"};
        assert_int_equal(session_open(&sa, &h, frustum, &za.zone, values), CULL_OK);
        assert_int_equal(session_open(&sb, &h, frustum, &zb.zone, values), CULL_OK);
        for (int q = 0; q < 100; q++) {
            static random_volumes v;
            make_volumes(&r, 2, &v);
            session_select(&sa, &some_view, v.volumes, v.count);
            assert_null(session_set(&sa, a));
            for (uint32_t i = 0; i < v.count; i++)
                for (uint32_t p = 0; p < v.volumes[i].plane_count; p++) v.planes[i][p].offset *= scales[k];
            session_select(&sb, &some_view, v.volumes, v.count);
            assert_null(session_set(&sb, b));
            assert_memory_equal(a, b, COUNT);
        }
        session_close(&sa);
        session_close(&sb);
        hand_zone_free(&za);
        hand_zone_free(&zb);
    }
    free(boxes);
    free(scaled);
}

static void a_smaller_volume_gives_a_subset(void **state)
{
    (void)state;
    const cull_plugin *frustum = frustum_or_skip();
    enum { COUNT = 2000 };
    static uint8_t whole[COUNT], part[COUNT];
    uint64_t r = {24};
    cull_box *boxes = make_boxes(&r, BOXES_SPREAD, COUNT);
    culler_host h;
    culler_host_init(&h, 0);
    hand_zone zone;
    zone_of_boxes(boxes, COUNT, &zone);
    session s;
    const char *values[2] = {"0", "auto"};
    assert_int_equal(session_open(&s, &h, frustum, &zone.zone, values), CULL_OK);
    for (int q = 0; q < 300; q++) {
        static random_volumes v;
        make_volumes(&r, 1, &v);
        session_select(&s, &some_view, v.volumes, 1);
        assert_null(session_set(&s, whole));
        for (uint32_t p = 0; p < v.volumes[0].plane_count; p++) v.planes[0][p].offset -= 1;
        session_select(&s, &some_view, v.volumes, 1);
        assert_null(session_set(&s, part));
        for (uint32_t i = 0; i < COUNT; i++) assert_true(part[i] <= whole[i]);
    }
    session_close(&s);
    hand_zone_free(&zone);
    free(boxes);
}

static void none_draws_everything_in_one_run(void **state)
{
    (void)state;
    uint64_t r = {25};
    static const uint32_t counts[] = {0, 1, 777};
    for (int c = 0; c < 3; c++) {
        cull_box *boxes = make_boxes(&r, BOXES_SPREAD, counts[c]);
        culler_host h;
        culler_host_init(&h, 0);
        hand_zone zone;
        zone_of_boxes(boxes, counts[c], &zone);
        session s;
        assert_int_equal(session_open(&s, &h, &builtin_none, &zone.zone, NULL), CULL_OK);
        static random_volumes v;
        make_volumes(&r, 2, &v);
        session_select(&s, &some_view, v.volumes, v.count);
        assert_int_equal(s.run_count, counts[c] ? 1 : 0);
        if (counts[c]) assert_true(s.runs[0].first == 0 && s.runs[0].count == counts[c]);
        session_close(&s);
        assert_int_equal(h.memory.live_blocks, 0);
        hand_zone_free(&zone);
        free(boxes);
    }
}

static void bad_options_are_refused_with_the_legal_values(void **state)
{
    (void)state;
    const cull_plugin *frustum = frustum_or_skip();
    culler_host h;
    culler_host_init(&h, 0);
    hand_zone zone;
    zone_of_boxes(NULL, 0, &zone);
    session s;
    const char *bad_face[2] = {"2", "auto"}, *bad_isa[2] = {"0", "mmx"};
    assert_int_equal(session_open(&s, &h, frustum, &zone.zone, bad_face), CULL_ERR_OPTION);
    assert_non_null(strstr(h.last_line, "0 or 1"));
    assert_int_equal(session_open(&s, &h, frustum, &zone.zone, bad_isa), CULL_ERR_OPTION);
    assert_non_null(strstr(h.last_line, "avx512"));
    assert_int_equal(session_open(&s, &h, &builtin_brute, &zone.zone, &bad_isa[1]), CULL_ERR_OPTION);
    assert_non_null(strstr(h.last_line, "avx512"));
    assert_int_equal(h.memory.live_blocks, 0);
    hand_zone_free(&zone);
}

static void every_allocation_may_fail_and_nothing_is_lost(void **state)
{
    (void)state;
    const cull_plugin *plugins[3] = {&builtin_none, &builtin_brute, frustum_or_skip()};
    uint64_t r = {26};
    cull_box *boxes = make_boxes(&r, BOXES_SPREAD, 500);
    hand_zone zone;
    zone_of_boxes(boxes, 500, &zone);
    const char *values[3][2] = {{NULL, NULL}, {"auto", NULL}, {"1", "auto"}};
    for (int p = 0; p < 3; p++) {
        int failures = 0;
        for (uint64_t k = 1;; k++) {
            culler_host h;
            culler_host_init(&h, 0);
            h.memory.fail_at = k;
            session s;
            const cull_result result = session_open(&s, &h, plugins[p], &zone.zone, values[p]);
            if (result == CULL_OK) session_close(&s);
            assert_int_equal(h.memory.live_blocks, 0);
            assert_int_equal(h.memory.live_bytes, 0);
            if (result == CULL_OK) break;
            assert_int_equal(result, CULL_ERR_MEMORY);
            failures++;
        }
        assert_in_range(failures, 2, 20);
    }
    hand_zone_free(&zone);
    free(boxes);
}

// ---- Two viewers at once ----

typedef struct viewer_job {
    session s;
    const cull_box *boxes;
    uint32_t count;
    uint64_t seed, differences;
} viewer_job;

static void *viewer_thread(void *arg)
{
    viewer_job *job = arg;
    uint64_t r = {job->seed};
    uint8_t *seen = calloc(job->count, 1), *expected = calloc(job->count, 1);
    random_volumes *v = calloc(1, sizeof *v);
    for (int q = 0; q < 60 && seen && expected && v; q++) {
        make_volumes(&r, 1 + (uint32_t)q % 4, v);
        oracle(job->boxes, job->count, v, expected);
        session_select(&job->s, &some_view, v->volumes, v->count);
        job->differences += session_set(&job->s, seen) != NULL || memcmp(seen, expected, job->count) != 0;
    }
    free(seen);
    free(expected);
    free(v);
    return NULL;
}

static void two_viewers_of_one_index_agree_with_the_scalar_loop(void **state)
{
    (void)state;
    const cull_plugin *frustum = frustum_or_skip();
    enum { COUNT = 5000 };
    uint64_t r = {27};
    cull_box *boxes = make_boxes(&r, BOXES_SPREAD, COUNT);
    culler_host h;
    culler_host_init(&h, 0);
    hand_zone zone;
    zone_of_boxes(boxes, COUNT, &zone);
    const char *values[2] = {"0", "auto"};
    static viewer_job jobs[2];
    session owner;
    assert_int_equal(session_open(&owner, &h, frustum, &zone.zone, values), CULL_OK);
    pthread_t threads[2];
    for (int i = 0; i < 2; i++) {
        jobs[i] = (viewer_job){.s = owner, .boxes = boxes, .count = COUNT, .seed = 100 + (uint64_t)i};
        assert_int_equal(frustum->open(owner.culler, &jobs[i].s.query), CULL_OK);
        jobs[i].s.runs = calloc(owner.built.max_runs, sizeof(cull_run));
        jobs[i].s.scratch = aligned_alloc(64, (owner.built.scratch_size + 64) / 64 * 64);
    }
    for (int i = 0; i < 2; i++) assert_int_equal(pthread_create(&threads[i], NULL, viewer_thread, &jobs[i]), 0);
    for (int i = 0; i < 2; i++) assert_int_equal(pthread_join(threads[i], NULL), 0);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(jobs[i].differences, 0);
        frustum->close(jobs[i].s.query);
        free(jobs[i].s.runs);
        free(jobs[i].s.scratch);
    }
    session_close(&owner);
    assert_int_equal(h.memory.live_blocks, 0);
    hand_zone_free(&zone);
    free(boxes);
}

// ---- The library ----

static void the_library_exports_exactly_one_symbol(void **state)
{
    (void)state;
    (void)frustum_or_skip();
    char command[4200], line[512], found[512] = "";
    snprintf(command, sizeof command, "nm -D --defined-only '%s/frustum.culler.so'", getenv("PORTCULLIS_PLUGINS"));
    FILE *nm = popen(command, "r");
    assert_non_null(nm);
    int symbols = 0;
    while (fgets(line, sizeof line, nm)) {
        if (strstr(line, "__asan") || strstr(line, "__ubsan") || strstr(line, "__odr_asan") || strstr(line, "__tsan")) continue;
        symbols++;
        snprintf(found, sizeof found, "%s", line);
    }
    if (pclose(nm) != 0) {
        fprintf(stderr, "SKIPPED: nm is missing\n");
        skip();
    }
    assert_int_equal(symbols, 1);
    assert_non_null(strstr(found, " " CULL_ENTRY_SYMBOL));
}

static void explain_says_kept_exactly_of_items_that_are_kept(void **state)
{
    (void)state;
    const cull_plugin *frustum = frustum_or_skip();
    enum { COUNT = 300 };
    uint64_t r = {28};
    cull_box *boxes = make_boxes(&r, BOXES_SPREAD, COUNT);
    culler_host h;
    culler_host_init(&h, 0);
    hand_zone zone;
    zone_of_boxes(boxes, COUNT, &zone);
    session s;
    const char *values[2] = {"0", "auto"};
    assert_int_equal(session_open(&s, &h, frustum, &zone.zone, values), CULL_OK);
    const cull_explain *explain = frustum->get_extension(s.culler, CULL_EXT_EXPLAIN);
    assert_non_null(explain);
    assert_null(frustum->get_extension(s.culler, "cull.nothing/1"));
    for (int q = 0; q < 20; q++) {
        static random_volumes v;
        static uint8_t seen[COUNT];
        make_volumes(&r, 2, &v);
        session_select(&s, &some_view, v.volumes, v.count);
        assert_null(session_set(&s, seen));
        const cull_visit visit = {.view = &some_view, .volumes = v.volumes, .volume_count = v.count, .scratch = s.scratch};
        for (uint32_t place = 0; place < COUNT; place++) {
            char text[200], cut[8];
            const size_t length = explain->item(s.query, &visit, place, text, sizeof text);
            assert_int_equal(length, strlen(text));
            assert_int_equal(strncmp(text, "kept", 4) == 0, seen[s.built.order[place]]);
            assert_int_equal(explain->item(s.query, &visit, place, cut, sizeof cut), length);
            assert_int_equal(strlen(cut), 7);
        }
    }
    session_close(&s);
    hand_zone_free(&zone);
    free(boxes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_culler_and_instruction_set_finds_the_set_of_the_scalar_loop),
        cmocka_unit_test(permuted_boxes_give_the_same_set),
        cmocka_unit_test(scaling_by_a_power_of_two_gives_the_same_set),
        cmocka_unit_test(a_smaller_volume_gives_a_subset),
        cmocka_unit_test(none_draws_everything_in_one_run),
        cmocka_unit_test(bad_options_are_refused_with_the_legal_values),
        cmocka_unit_test(every_allocation_may_fail_and_nothing_is_lost),
        cmocka_unit_test(two_viewers_of_one_index_agree_with_the_scalar_loop),
        cmocka_unit_test(the_library_exports_exactly_one_symbol),
        cmocka_unit_test(explain_says_kept_exactly_of_items_that_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
