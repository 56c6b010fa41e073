// What of the lines of sight is drawn, by bits of each room. See rooms_sight.h.
// SPDX-License-Identifier: MIT
#include "rooms_sight.h"

#include <string.h>

static uint64_t *row(uint64_t *rows, const sight *s, uint32_t room)
{
    return rows + (size_t)room * s->words;
}

static const uint64_t *row_of(const uint64_t *rows, const sight *s, uint32_t room)
{
    return rows + (size_t)room * s->words;
}

static uint32_t bit_count(uint64_t x)
{
    x -= x >> 1 & UINT64_C(0x5555555555555555);
    x = (x & UINT64_C(0x3333333333333333)) + (x >> 2 & UINT64_C(0x3333333333333333));
    return (uint32_t)(((x + (x >> 4)) & UINT64_C(0x0f0f0f0f0f0f0f0f)) * UINT64_C(0x0101010101010101) >> 56);
}

static uint32_t lowest_bit(uint64_t x)
{
    return bit_count((x & (0 - x)) - 1);
}

static uint32_t *steps_of(const sight *s, uint32_t line, uint32_t *count)
{
    const sight_line *l = (const sight_line *)s->lines.items + line;
    *count = l->count;
    return (uint32_t *)s->steps.items + l->first;
}

// ---- One line ----

// From the eye on: 1 where the end is drawn.
static int reach(sight *s, const uint32_t *steps, uint32_t count, uint32_t line)
{
    const uint64_t bit = UINT64_C(1) << (line & 63);
    int on = 0;
    for (uint32_t i = 0; i < count; ++i) {
        uint64_t *at = &row(s->reached, s, steps[i] & ~SIGHT_GAP)[line >> 6];
        on = i == 0 || (on && !(steps[i] & SIGHT_GAP)) || (*at & bit) != 0;
        if (on) *at |= bit;
    }
    return on;
}

// From the end back.
static void lead(sight *s, const uint32_t *steps, uint32_t count, uint32_t line)
{
    const uint64_t bit = UINT64_C(1) << (line & 63);
    int on = 1;
    for (uint32_t i = count; i-- > 0;) {
        uint64_t *at = &row(s->leads, s, steps[i] & ~SIGHT_GAP)[line >> 6];
        on = on || (*at & bit) != 0;
        if (on) *at |= bit;
        on = on && !(steps[i] & SIGHT_GAP);
    }
}

static void settle(sight *s, uint32_t line)
{
    uint32_t count;
    const uint32_t *steps = steps_of(s, line, &count);
    if (reach(s, steps, count, line)) s->hidden[line >> 6] &= ~(UINT64_C(1) << (line & 63));
    else lead(s, steps, count, line);
}

static void settle_again(sight *s, uint32_t line)
{
    uint32_t count;
    const uint32_t *steps = steps_of(s, line, &count);
    for (uint32_t i = 0; i < count; ++i) {
        row(s->reached, s, steps[i] & ~SIGHT_GAP)[line >> 6] &= ~(UINT64_C(1) << (line & 63));
        row(s->leads, s, steps[i] & ~SIGHT_GAP)[line >> 6] &= ~(UINT64_C(1) << (line & 63));
    }
    settle(s, line);
}

// ---- All ----

static result rows_make(sight *s)
{
    uint64_t **rows[] = {&s->has, &s->reached, &s->leads};
    s->words = (uint32_t)((s->lines.count + 63) / 64);
    for (int i = 0; i < 3; ++i)
        if (!(*rows[i] = memory_alloc_zeroed(s->memory, (size_t)s->rooms * s->words, sizeof(uint64_t)))) return RESULT_NO_MEMORY;
    s->hidden = memory_alloc(s->memory, s->words, sizeof *s->hidden);
    if (!s->hidden) return RESULT_NO_MEMORY;
    if (s->words) memset(s->hidden, 255, s->words * sizeof *s->hidden);
    return RESULT_OK;
}

result sight_make(const cell_set *cells, const uint32_t *room_of, uint32_t rooms, const allocator *memory, sight *out)
{
    *out = (sight){.memory = memory, .steps = buffer_make(memory, sizeof(uint32_t)), .lines = buffer_make(memory, sizeof(sight_line)), .rooms = rooms};
    result r = sight_lines_take(cells, room_of, memory, out);
    if (r == RESULT_OK) r = rows_make(out);
    for (uint32_t i = 0; i < out->lines.count && r == RESULT_OK; ++i) {
        uint32_t count;
        const uint32_t *steps = steps_of(out, i, &count);
        for (uint32_t k = 0; k < count; ++k) row(out->has, out, steps[k] & ~SIGHT_GAP)[i >> 6] |= UINT64_C(1) << (i & 63);
        settle(out, i);
    }
    return r;
}

void sight_free(sight *s)
{
    uint64_t *const rows[] = {s->has, s->reached, s->leads};
    for (int i = 0; i < 3; ++i) memory_free(s->memory, rows[i], (size_t)s->rooms * s->words, sizeof(uint64_t));
    memory_free(s->memory, s->hidden, s->words, sizeof *s->hidden);
    buffer_free(&s->steps);
    buffer_free(&s->lines);
}

uint32_t sight_cost(const sight *s, uint32_t a, uint32_t b)
{
    const uint64_t *seen_a = row_of(s->reached, s, a), *seen_b = row_of(s->reached, s, b);
    const uint64_t *from_a = row_of(s->leads, s, a), *from_b = row_of(s->leads, s, b);
    uint32_t sum = 0;
    for (uint32_t i = 0; i < s->words; ++i) {
        const uint64_t drawn = s->hidden[i] & ((seen_a[i] & from_b[i]) | (seen_b[i] & from_a[i]));
        if (drawn) sum += bit_count(drawn);
    }
    return sum;
}

static void rename_steps(sight *s, uint32_t line, uint32_t kept, uint32_t gone)
{
    uint32_t count, *steps = steps_of(s, line, &count);
    for (uint32_t i = 0; i < count; ++i)
        if ((steps[i] & ~SIGHT_GAP) == gone) steps[i] = kept | (steps[i] & SIGHT_GAP);
}

// Lines through one of the two keep their bits; those through both may reach further.
void sight_join(sight *s, uint32_t kept, uint32_t gone)
{
    uint64_t *const rows[] = {s->has, s->reached, s->leads};
    for (uint32_t w = 0; w < s->words; ++w) {
        const uint64_t moved = row(s->has, s, gone)[w] & s->hidden[w];
        uint64_t both = moved & row(s->has, s, kept)[w];
        for (int i = 0; i < 3; ++i) row(rows[i], s, kept)[w] |= row(rows[i], s, gone)[w];
        for (uint64_t left = moved; left; left &= left - 1) rename_steps(s, w * 64 + lowest_bit(left), kept, gone);
        for (; both; both &= both - 1) settle_again(s, w * 64 + lowest_bit(both));
    }
}
