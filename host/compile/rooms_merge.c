// Greedy merging of cells: first those between which portals are worth least. A portal is worth much between two rooms of many
// walls, for it hides those of one from the other; little where the opening is wide; and a flat interface needs few of them.
// SPDX-License-Identifier: MIT
// The rule began as the one in the design's page on indoor visibility; its exponents were measured on published levels.
#include "rooms_merge.h"

#include "rooms_joined.h"
#include "steady.h"

#include <math.h>
#include <string.h>

static const double WALLS_THAT_COUNT = 20; // walls at which what a room hides has grown by the root of two
static const double SHARE_THAT_COUNTS = 0.2; // of all air: from there on a room hides more and more, whatever its walls
static const double HALL_OPENNESS = 0.9; // but a hall cut by one plane stays one: halves of a cube are open to each other by 1.59

typedef struct room { double volume; uint32_t walls; } room;

typedef struct merging {
    const cell_set *cells;
    const room_limits *limits;
    room_map *map;
    room *rooms;     // by cell that stands for it
    uint32_t *above; // by cell: what it was merged into, itself if it stands
    link_set links;
    link_joiner joiner;
    buffer heap;     // candidate
    steady_centres centres; // of all faces
    double air;             // volume of all
} merging;

typedef struct candidate {
    int64_t score, area, places[STEADY_CENTRES]; // see steady.h
    uint32_t link, version;
} candidate;

// ---- Scores ----

static double openness(const merging *m, const room_link *l)
{
    const room *a = &m->rooms[l->rooms[0]], *b = &m->rooms[l->rooms[1]];
    const double volume = a->volume < b->volume ? a->volume : b->volume;
    if (!(volume > 0)) return INFINITY; // a sliver: gone first
    const double size = cbrt(volume), hidden = (1 + a->walls / WALLS_THAT_COUNT) * (1 + b->walls / WALLS_THAT_COUNT), planes = l->plane_count;
    const double wide = l->area / (size * size), large = planes > 1 || wide < HALL_OPENNESS ? (a->volume + b->volume) / m->air / SHARE_THAT_COUNTS : 0;
    return wide * (planes * sqrt(planes)) / sqrt(hidden) / (1 + large * large * (large * large));
}

static int comes_first(const candidate *a, const candidate *b)
{
    if (a->score != b->score) return a->score > b->score;
    if (a->area != b->area) return a->area > b->area;
    const int places = steady_places_compare(a->places, b->places);
    return places ? places < 0 : a->link < b->link;
}

// ---- The heap ----

static result heap_push(merging *m, uint32_t link)
{
    const room_link *l = link_at(&m->links, link);
    const double open = openness(m, l);
    candidate made = {.score = isinf(open) ? INT64_MAX : steady_log(open), .area = steady_log(l->area), .link = link, .version = l->version};
    double middle[3];
    for (int k = 0; k < 3; ++k) middle[k] = l->moment[k] / l->area;
    steady_places(&m->centres, middle, made.places);
    if (!buffer_append(&m->heap, &made, 1)) return RESULT_NO_MEMORY;
    candidate *c = m->heap.items;
    size_t at = m->heap.count - 1;
    for (; at > 0 && comes_first(&made, &c[(at - 1) / 2]); at = (at - 1) / 2) c[at] = c[(at - 1) / 2];
    c[at] = made;
    return RESULT_OK;
}

static candidate heap_pop(merging *m)
{
    candidate *c = m->heap.items;
    const candidate first = c[0], last = c[--m->heap.count];
    size_t at = 0;
    for (size_t below; (below = 2 * at + 1) < m->heap.count; at = below) {
        below += below + 1 < m->heap.count && comes_first(&c[below + 1], &c[below]);
        if (!comes_first(&c[below], &last)) break;
        c[at] = c[below];
    }
    c[at] = last;
    return first;
}

// ---- Merging ----

static result score_again(merging *m, uint32_t room)
{
    result r = RESULT_OK;
    for (uint32_t i = 0; i < links_of(&m->links, room)->count && r == RESULT_OK; ++i) {
        const uint32_t link = ((uint32_t *)links_of(&m->links, room)->items)[i];
        link_at(&m->links, link)->version++;
        r = heap_push(m, link);
    }
    return r;
}

static result join(merging *m, const room_link *l)
{
    const uint32_t first = l->rooms[0], second = l->rooms[1];
    const uint32_t kept = links_of(&m->links, first)->count >= links_of(&m->links, second)->count ? first : second;
    const uint32_t gone = kept == first ? second : first;
    m->above[gone] = kept;
    m->rooms[kept].volume += m->rooms[gone].volume;
    m->rooms[kept].walls += m->rooms[gone].walls;
    m->map->room_count--;
    const result r = links_join(&m->links, kept, gone);
    return r == RESULT_OK ? score_again(m, kept) : r;
}

static uint32_t room_of(merging *m, uint32_t cell)
{
    uint32_t at = cell;
    while (m->above[at] != at) at = m->above[at] = m->above[m->above[at]];
    return at;
}

static result is_enough(merging *m, const candidate *best, int *enough)
{
    const int few = m->limits->rooms ? m->map->room_count <= m->limits->rooms : best->score < steady_log(m->limits->openness);
    result r = RESULT_OK;
    *enough = few && m->links.plane_total <= m->limits->portals;
    if (*enough) r = links_portals(&m->links, &m->joiner, &m->map->portals);
    *enough = *enough && m->map->portals <= m->limits->portals;
    return r;
}

static result merge_all(merging *m)
{
    result r = RESULT_OK;
    while (m->heap.count > 0 && r == RESULT_OK) {
        const candidate best = heap_pop(m);
        const room_link l = *link_at(&m->links, best.link);
        if (l.version != best.version || l.is_gone) continue;
        int enough;
        r = is_enough(m, &best, &enough);
        if (r == RESULT_OK && enough) break;
        if (r == RESULT_OK) r = join(m, &l);
    }
    return r;
}

static link_face measure(const cell_set *cells, uint32_t number)
{
    const cell_face *f = (const cell_face *)cells->faces.items + number;
    const polygon_edge *edges = (polygon_edge *)cells->edges.items + f->shape.first;
    link_face out = {.face = number, .plane = f->shape.plane >> 1, .area = f->area};
    for (uint32_t i = 0; i < f->shape.count; ++i)
        for (int k = 0; k < 3; ++k) out.middle[k] += edges[i].start[k] / f->shape.count;
    return out;
}

static result links_take(merging *m)
{
    const cell_face *f = m->cells->faces.items;
    result r = RESULT_OK;
    for (uint32_t i = 0; i < m->cells->faces.count && r == RESULT_OK; ++i) {
        const link_face face = measure(m->cells, i);
        steady_centres_add(&m->centres, face.area, face.middle);
        r = links_add(&m->links, f[i].cells, &face);
    }
    for (uint32_t i = 0; i < link_count(&m->links) && r == RESULT_OK; ++i) r = heap_push(m, i);
    return r;
}

static void rooms_number(merging *m)
{
    uint32_t next = 0;
    for (uint32_t c = 0; c < m->map->cell_count; ++c) m->map->room_of[c] = UINT32_MAX;
    for (uint32_t c = 0; c < m->map->cell_count; ++c) { // by their first cell
        const uint32_t stands = room_of(m, c);
        if (m->map->room_of[stands] == UINT32_MAX) m->map->room_of[stands] = next++ | 0x80000000u;
        if (c != stands) m->map->room_of[c] = m->map->room_of[stands];
    }
    for (uint32_t c = 0; c < m->map->cell_count; ++c) m->map->room_of[c] &= 0x7fffffffu;
}

result rooms_merge(const cell_set *cells, const plane_table *planes, const room_limits *limits, const allocator *memory, room_map *out)
{
    const uint32_t count = (uint32_t)cells->cells.count;
    *out = (room_map){memory_alloc(memory, count, sizeof *out->room_of), count, count, 0};
    merging m = {.cells = cells,
                 .limits = limits,
                 .map = out,
                 .rooms = memory_alloc(memory, count, sizeof *m.rooms),
                 .above = memory_alloc(memory, count, sizeof *m.above),
                 .heap = buffer_make(memory, sizeof(candidate))};
    m.joiner = link_joiner_make(cells, planes, memory);
    result r = links_open(&m.links, count, (uint32_t)cells->faces.count, memory);
    if (!out->room_of || !m.rooms || !m.above) r = RESULT_NO_MEMORY;
    for (uint32_t c = 0; c < count && r == RESULT_OK; ++c) {
        const cell *from = (cell *)cells->cells.items + c;
        m.rooms[c] = (room){from->volume, from->walls};
        m.above[c] = c;
        m.air += from->volume;
    }
    if (r == RESULT_OK) r = links_take(&m);
    if (r == RESULT_OK) r = merge_all(&m);
    if (r == RESULT_OK) rooms_number(&m);
    link_joiner_free(&m.joiner);
    links_close(&m.links);
    buffer_free(&m.heap);
    memory_free(memory, m.rooms, count, sizeof *m.rooms);
    memory_free(memory, m.above, count, sizeof *m.above);
    return r;
}

void room_map_free(room_map *m, const allocator *memory)
{
    memory_free(memory, m->room_of, m->cell_count, sizeof *m->room_of);
}
