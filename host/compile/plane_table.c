// Planes of a compilation: see plane_table.h. An open hash table over arrays; nothing is ever taken out.
// SPDX-License-Identifier: MIT
#include "plane_table.h"

#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

enum { SLOTS_AT_FIRST = 1024 };

plane_table *plane_table_make(const allocator *memory)
{
    plane_table *t = memory_alloc(memory, 1, sizeof *t);
    if (!t) return NULL;
    t->planes = buffer_make(memory, sizeof(cull_wide_plane));
    t->rows = buffer_make(memory, sizeof(cull_row));
    t->slots = buffer_make(memory, sizeof(uint32_t));
    return t;
}

void plane_table_free(plane_table *t)
{
    if (!t) return;
    const allocator *memory = t->planes.memory;
    buffer_free(&t->planes);
    buffer_free(&t->rows);
    buffer_free(&t->slots);
    memory_free(memory, t, 1, sizeof *t);
}

static size_t slot_of(const plane_table *t, const cull_wide_plane *plane)
{
    const uint64_t words[5] = {(uint64_t)plane->normal[0], (uint64_t)plane->normal[1], (uint64_t)plane->normal[2], plane->offset.low, plane->offset.high};
    const uint32_t *slots = t->slots.items;
    const size_t mask = t->slots.count - 1;
    size_t at = XXH3_64bits(words, sizeof words) & mask;
    while (slots[at] && !cull_wide_plane_equal(plane_table_canonical(t, 2 * (slots[at] - 1)), plane)) at = (at + 1) & mask;
    return at;
}

static int grow_slots(plane_table *t)
{
    if (t->slots.count > 2 * (t->planes.count + 1)) return 1;
    const size_t size = t->slots.count ? t->slots.count * 2 : SLOTS_AT_FIRST;
    buffer bigger = buffer_make(t->slots.memory, sizeof(uint32_t));
    uint32_t *slots = buffer_push(&bigger, size);
    if (!slots) return 0;
    memset(slots, 0, size * sizeof *slots);
    buffer_free(&t->slots);
    t->slots = bigger;
    for (uint32_t i = 0; i < t->planes.count; ++i) slots[slot_of(t, plane_table_canonical(t, 2 * i))] = i + 1;
    return 1;
}

static int is_flipped(const cull_wide_plane *p)
{
    for (int i = 0; i < 3; ++i)
        if (p->normal[i] != 0) return p->normal[i] < 0;
    return 0;
}

plane_ref plane_table_add(plane_table *t, const cull_wide_plane *plane)
{
    cull_wide_plane canonical = cull_wide_plane_reduced(*plane);
    const uint32_t flipped = is_flipped(&canonical) ? 1 : 0;
    if (flipped) canonical = cull_wide_plane_flipped(canonical);
    if (t->planes.count >= UINT32_MAX / 2 - 1 || !grow_slots(t)) return PLANE_NONE;
    const size_t at = slot_of(t, &canonical);
    uint32_t *slots = t->slots.items;
    if (!slots[at]) {
        const cull_row row = cull_row_of(&canonical);
        if (!buffer_append(&t->rows, &row, 1)) return PLANE_NONE;
        if (!buffer_append(&t->planes, &canonical, 1)) {
            t->rows.count--;
            return PLANE_NONE;
        }
        slots[at] = (uint32_t)t->planes.count;
    }
    return 2 * (slots[at] - 1) + flipped;
}

// ---- Decisions ----

static int normals_sign(const plane_table *t, plane_ref a, plane_ref b, plane_ref c) // of the canonical planes
{
    const cull_wide_plane *const planes[3] = {plane_table_canonical(t, a), plane_table_canonical(t, b), plane_table_canonical(t, c)};
    const cull_row *const rows[3] = {plane_table_row(t, a), plane_table_row(t, b), plane_table_row(t, c)};
    cull_tier tier;
    return cull_normals_sign_of_rows(planes, rows, &tier);
}

int plane_table_normals_sign(const plane_table *t, plane_ref a, plane_ref b, plane_ref c)
{
    return normals_sign(t, a, b, c) * plane_ref_sign(a) * plane_ref_sign(b) * plane_ref_sign(c);
}

int plane_table_side(const plane_table *t, const plane_ref meet[3], plane_ref of)
{
    const plane_ref all[4] = {meet[0], meet[1], meet[2], of};
    const cull_wide_plane *planes[4];
    const cull_row *rows[4];
    for (int i = 0; i < 4; ++i) {
        if (i < 3 && all[i] >> 1 == of >> 1) return 0;
        planes[i] = plane_table_canonical(t, all[i]);
        rows[i] = plane_table_row(t, all[i]);
    }
    cull_tier tier;
    const int d = cull_four_sign_of_rows(planes, rows, &tier);
    return d ? d * normals_sign(t, meet[0], meet[1], meet[2]) * plane_ref_sign(of) : 0;
}

int plane_table_order_along(const plane_table *t, plane_ref a, plane_ref b, plane_ref c, plane_ref d)
{
    const plane_ref meet[3] = {a, b, c};
    const int height = plane_table_side(t, meet, d);
    return height ? height * plane_table_normals_sign(t, a, b, d) : 0;
}

int plane_table_position(const plane_table *t, const plane_ref meet[3], double out[3])
{
    const cull_wide_plane *const planes[3] = {plane_table_canonical(t, meet[0]), plane_table_canonical(t, meet[1]), plane_table_canonical(t, meet[2])};
    const cull_row *const rows[3] = {plane_table_row(t, meet[0]), plane_table_row(t, meet[1]), plane_table_row(t, meet[2])};
    return cull_meet_position_of_rows(planes, rows, out);
}

int plane_table_side_at(const plane_table *t, const plane_ref meet[3], const double position[3], plane_ref of)
{
    for (int i = 0; i < 3; ++i)
        if (meet[i] >> 1 == of >> 1) return 0;
    const int side = cull_side_of_position(plane_table_row(t, of), position);
    return side ? side * plane_ref_sign(of) : plane_table_side(t, meet, of);
}

int plane_table_side_of_point(const plane_table *t, const int32_t p[3], plane_ref of)
{
    return cull_side_of_point(plane_table_canonical(t, of), p) * plane_ref_sign(of);
}
