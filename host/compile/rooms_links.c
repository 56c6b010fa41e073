// Links by pair of rooms in an open hash table, and in a list for each room. See rooms_links.h.
// SPDX-License-Identifier: MIT
#include "rooms_links.h"

#include <string.h>

#define SLOT_LEFT UINT32_MAX
enum { SLOTS_LEAST = 64 };

// ---- By pair ----

static uint64_t pair_hash(uint32_t a, uint32_t b)
{
    uint64_t h = ((uint64_t)(a < b ? a : b) << 32 | (a < b ? b : a)) * UINT64_C(0x9e3779b97f4a7c15);
    return h ^ h >> 29;
}

static int is_pair(const room_link *l, uint32_t a, uint32_t b)
{
    return (l->rooms[0] == a && l->rooms[1] == b) || (l->rooms[0] == b && l->rooms[1] == a);
}

// The slot of the pair, or the empty one where it ends.
static uint32_t *slot_find(const link_set *s, uint32_t a, uint32_t b)
{
    const uint32_t mask = s->slot_count - 1;
    uint32_t at = (uint32_t)pair_hash(a, b) & mask;
    for (;; at = (at + 1) & mask) {
        uint32_t *slot = &s->slots[at];
        if (*slot == 0 || (*slot != SLOT_LEFT && is_pair(link_at(s, *slot - 1), a, b))) return slot;
    }
}

static result slots_grow(link_set *s)
{
    if (s->slot_count && (uint64_t)s->slots_used * 2 < s->slot_count) return RESULT_OK;
    const uint32_t old = s->slot_count, count = old ? 2 * old : SLOTS_LEAST;
    uint32_t *before = s->slots, *slots = memory_alloc_zeroed(s->memory, count, sizeof *slots);
    if (!slots) return RESULT_NO_MEMORY;
    s->slots = slots;
    s->slot_count = count;
    s->slots_used = 0;
    for (uint32_t i = 0; i < old; ++i) {
        if (before[i] == 0 || before[i] == SLOT_LEFT) continue;
        const room_link *l = link_at(s, before[i] - 1);
        *slot_find(s, l->rooms[0], l->rooms[1]) = before[i];
        s->slots_used++;
    }
    memory_free(s->memory, before, old, sizeof *before);
    return RESULT_OK;
}

// ---- Planes ----

static int plane_add(link_set *s, room_link *l, uint32_t plane)
{
    uint32_t *at = (uint32_t *)s->planes.items + l->first_plane, i = 0;
    while (i < l->plane_count && at[i] < plane) ++i;
    if (i < l->plane_count && at[i] == plane) return 1;
    if (l->first_plane + l->plane_count != s->planes.count) { // not the last: it moves to the end to grow
        const uint32_t first = (uint32_t)s->planes.count;
        if (!buffer_push(&s->planes, l->plane_count)) return 0;
        memcpy((uint32_t *)s->planes.items + first, (uint32_t *)s->planes.items + l->first_plane, l->plane_count * sizeof *at);
        l->first_plane = first;
    }
    if (!buffer_push(&s->planes, 1)) return 0;
    at = (uint32_t *)s->planes.items + l->first_plane;
    memmove(at + i + 1, at + i, (l->plane_count - i) * sizeof *at);
    at[i] = plane;
    l->plane_count++;
    s->plane_total++;
    return 1;
}

// ---- Links ----

result links_open(link_set *s, uint32_t room_count, uint32_t face_count, const allocator *memory)
{
    *s = (link_set){.memory = memory, .links = buffer_make(memory, sizeof(room_link)), .planes = buffer_make(memory, sizeof(uint32_t)), .room_count = room_count, .face_count = face_count};
    s->of_room = memory_alloc(memory, room_count, sizeof *s->of_room);
    s->next_face = memory_alloc(memory, face_count, sizeof *s->next_face);
    for (uint32_t i = 0; i < room_count && s->of_room; ++i) s->of_room[i] = buffer_make(memory, sizeof(uint32_t));
    return s->of_room && s->next_face ? RESULT_OK : RESULT_NO_MEMORY;
}

void links_close(link_set *s)
{
    for (uint32_t i = 0; i < s->room_count && s->of_room; ++i) buffer_free(&s->of_room[i]);
    memory_free(s->memory, s->of_room, s->room_count, sizeof *s->of_room);
    memory_free(s->memory, s->next_face, s->face_count, sizeof *s->next_face);
    memory_free(s->memory, s->slots, s->slot_count, sizeof *s->slots);
    buffer_free(&s->links);
    buffer_free(&s->planes);
}

// Chains two lists of faces: those of the second behind those of the first.
static void faces_chain(link_set *s, room_link *to, uint32_t first, uint32_t last)
{
    if (to->first_face == LINK_NO_FACE) to->first_face = first;
    else s->next_face[to->last_face] = first;
    to->last_face = last;
    to->portals = LINK_UNKNOWN;
}

result links_add(link_set *s, const uint32_t rooms[2], const link_face *face)
{
    if (slots_grow(s) != RESULT_OK) return RESULT_NO_MEMORY;
    uint32_t *slot = slot_find(s, rooms[0], rooms[1]);
    if (*slot == 0) {
        const uint32_t link = link_count(s);
        const room_link made = {.rooms = {rooms[0], rooms[1]}, .first_plane = (uint32_t)s->planes.count, .first_face = LINK_NO_FACE};
        if (!buffer_append(&s->links, &made, 1) || !buffer_append(&s->of_room[rooms[0]], &link, 1) || !buffer_append(&s->of_room[rooms[1]], &link, 1))
            return RESULT_NO_MEMORY;
        *slot = link + 1;
        s->slots_used++;
    }
    room_link *l = link_at(s, *slot - 1);
    l->area += face->area;
    for (int k = 0; k < 3; ++k) l->moment[k] += face->area * face->middle[k];
    s->next_face[face->face] = LINK_NO_FACE;
    faces_chain(s, l, face->face, face->face);
    return plane_add(s, l, face->plane) ? RESULT_OK : RESULT_NO_MEMORY;
}

static void list_drop(buffer *list, uint32_t link)
{
    uint32_t *all = list->items;
    for (size_t i = 0; i < list->count; ++i) {
        if (all[i] != link) continue;
        memmove(all + i, all + i + 1, (list->count - i - 1) * sizeof *all);
        list->count--;
        return;
    }
}

static void link_drop(link_set *s, uint32_t link, uint32_t *slot)
{
    room_link *l = link_at(s, link);
    *slot = SLOT_LEFT;
    s->plane_total -= l->plane_count;
    l->is_gone = 1;
    l->version++;
    list_drop(&s->of_room[l->rooms[0]], link);
    list_drop(&s->of_room[l->rooms[1]], link);
}

// `kept` has a link to the same room: that one takes it in.
static result link_fold(link_set *s, uint32_t link, uint32_t into)
{
    const room_link from = *link_at(s, link);
    room_link *to = link_at(s, into);
    to->area += from.area;
    faces_chain(s, to, from.first_face, from.last_face);
    for (int k = 0; k < 3; ++k) to->moment[k] += from.moment[k];
    for (uint32_t i = 0; i < from.plane_count; ++i) {
        const uint32_t plane = ((uint32_t *)s->planes.items)[from.first_plane + i];
        if (!plane_add(s, to, plane)) return RESULT_NO_MEMORY;
    }
    return RESULT_OK;
}

static result link_move(link_set *s, uint32_t link, uint32_t kept, uint32_t gone)
{
    const room_link l = *link_at(s, link);
    const uint32_t other = l.rooms[0] == gone ? l.rooms[1] : l.rooms[0];
    uint32_t *own = slot_find(s, gone, other);
    if (other == kept) {
        link_drop(s, link, own);
        return RESULT_OK;
    }
    uint32_t *slot = slot_find(s, kept, other);
    if (*slot != 0) {
        const uint32_t into = *slot - 1;
        link_drop(s, link, own);
        return link_fold(s, link, into);
    }
    *own = SLOT_LEFT;
    room_link *moved = link_at(s, link);
    moved->rooms[moved->rooms[0] == gone ? 0 : 1] = kept;
    list_drop(&s->of_room[gone], link);
    if (!buffer_append(&s->of_room[kept], &link, 1)) return RESULT_NO_MEMORY;
    *slot_find(s, kept, other) = link + 1;
    s->slots_used++;
    return slots_grow(s);
}

result links_join(link_set *s, uint32_t kept, uint32_t gone)
{
    result r = RESULT_OK;
    while (s->of_room[gone].count > 0 && r == RESULT_OK) {
        const uint32_t link = ((uint32_t *)s->of_room[gone].items)[s->of_room[gone].count - 1];
        r = link_move(s, link, kept, gone);
    }
    return r;
}
