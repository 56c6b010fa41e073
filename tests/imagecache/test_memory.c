// Memory of pictures: a host that keeps each picture until another takes its slot never holds more than memory_mib, whatever is shown, changed, or dropped by a filter.
// SPDX-License-Identifier: MIT
#include "tests/imagecache/show_field.h"

#include <stdlib.h>
#include <string.h>

typedef struct memory { // of a host
    uint64_t *bytes, sum, most; // by slot; all; the most that there were
    uint32_t taken, evicted, dropped, emptied;
} memory;

typedef enum trouble { TROUBLE_NONE, TROUBLE_CHANGES, TROUBLE_DROPS, TROUBLE_ALL } trouble; // bits

static memory memory_open(const field *f)
{
    memory m = {.bytes = calloc(f->s.base.built.slot_count, sizeof *m.bytes)};
    assert_non_null(m.bytes);
    return m;
}

static int is_shown(const field *f, uint32_t slot)
{
    for (uint32_t i = 0; i < f->s.batch.picture_count; i++)
        if (f->s.batch.pictures[i].slot == slot) return 1;
    return 0;
}

// In the batch's order. A filter drops the captures of what it hides.
static void carry_out(memory *m, field *f, trouble t, uint64_t *r)
{
    for (uint32_t i = 0; i < f->s.batch.capture_count; i++) {
        const cull_capture *c = &f->s.batch.captures[i];
        if ((t & TROUBLE_DROPS) && is_shown(f, c->slot) && random_below(r, 3) == 0) {
            f->s.slots[c->slot] = 0;
            m->dropped++;
            continue;
        }
        m->sum -= m->bytes[c->slot];
        m->bytes[c->slot] = (uint64_t)c->width_px * c->height_px * (c->keep_depth ? f->host.costs.depth_pixel_bytes : f->host.costs.pixel_bytes);
        m->sum += m->bytes[c->slot];
        m->most = m->sum > m->most ? m->sum : m->most;
        m->taken++;
        m->evicted += c->run_count == 0;
    }
}

// A change empties slots; the memory behind them stays until they are taken anew.
static void change(memory *m, field *f, uint64_t *r)
{
    for (uint32_t i = 0; i < f->s.base.built.slot_count; i++) {
        if (!f->s.slots[i] || random_below(r, 20) != 0) continue;
        f->s.slots[i] = 0;
        m->emptied++;
    }
}

static memory walk(const char *mib, trouble t, const char *budget)
{
    const show_values values = {.level = "6", .walk = "rings", .order = "rings", .show = "quad", .tree = "off", .tolerance = "1", .hidden = "shown", .budget = budget, .memory_mib = mib};
    const uint64_t most = (uint64_t)atoi(mib) << 20;
    uint64_t r = 6401;
    field f;
    field_open(&f, &values, 20000);
    memory m = memory_open(&f);
    for (uint32_t frame = 1; frame < 260; frame++) {
        cull_plane planes[4];
        cull_view view;
        show_eye eye = field_eye(frame);
        eye.heading += frame * 0.05; // all round: more than there is room for
        field_look(&f, eye, frame, ANSWERS_SEEN, planes, &view);
        carry_out(&m, &f, t, &r);
        if (m.sum > most) fail_msg("frame %u: %llu bytes of %llu", frame, (unsigned long long)m.sum, (unsigned long long)most);
        if ((t & TROUBLE_CHANGES) && frame % 5 == 0) change(&m, &f, &r);
    }
    assert_true(m.most <= most);
    field_close(&f);
    free(m.bytes);
    m.bytes = NULL;
    return m;
}

static void never_more_than_the_cap_is_held_and_the_oldest_goes(void **state)
{
    (void)state;
    const memory small = walk("16", TROUBLE_NONE, "bounded"), large = walk("256", TROUBLE_NONE, "bounded");
    print_message("pictures without a cap: %.2f MiB; of 16 MiB: %.2f held, %u taken, %u evicted\n", (double)large.most / (1 << 20), (double)small.most / (1 << 20), small.taken, small.evicted);
    assert_true(large.most > 16u << 20); // the cap was in the way
    assert_true(small.most > 8u << 20 && small.evicted > 20 && small.taken - small.evicted > 100);
    assert_int_equal(large.evicted, 0);
}

static void nor_where_slots_are_emptied_and_captures_dropped(void **state)
{
    (void)state;
    static const char *const budgets[] = {"bounded", "steady"};
    for (int t = TROUBLE_CHANGES; t <= TROUBLE_ALL; t++)
        for (int b = 0; b < 2; b++) {
            const memory m = walk("16", (trouble)t, budgets[b]);
            assert_true(m.evicted > 20);
            assert_true(!(t & TROUBLE_CHANGES) == !m.emptied && !(t & TROUBLE_DROPS) == !m.dropped);
        }
}

// Both cullers of a host that allows less than the option.
static void what_the_host_allows_counts_where_it_is_less(void **state)
{
    (void)state;
    const show_values values = {.level = "6", .walk = "rings", .order = "rings", .show = "quad", .tree = "off", .tolerance = "1", .hidden = "shown", .budget = "bounded", .memory_mib = "256"};
    uint64_t r = 6402;
    field f;
    field_open(&f, &values, 20000);
    f.host.costs.picture_bytes = 16u << 20;
    memory m = memory_open(&f);
    for (uint32_t frame = 1; frame < 120; frame++) {
        cull_plane planes[4];
        cull_view view;
        show_eye eye = field_eye(frame);
        eye.heading += frame * 0.05;
        field_look(&f, eye, frame, ANSWERS_SEEN, planes, &view);
        carry_out(&m, &f, TROUBLE_NONE, &r);
        assert_true(m.sum <= 16u << 20);
    }
    assert_true(m.evicted > 0);
    field_close(&f);
    free(m.bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(never_more_than_the_cap_is_held_and_the_oldest_goes),
        cmocka_unit_test(nor_where_slots_are_emptied_and_captures_dropped),
        cmocka_unit_test(what_the_host_allows_counts_where_it_is_less),
    };
    return cmocka_run_group_tests_name("image cache: memory", tests, NULL, NULL);
}
