// Greedy merging of cells: first the most open to each other, by shape alone; and when few are left, those that keep the fewest lines of
// sight from reaching what is hidden, for the portals that they take.
// SPDX-License-Identifier: MIT
// The rule for what is open began as the one in the design's page on indoor visibility; its exponents were measured on published levels.
#include "rooms_merge.h"

#include "rooms_joined.h"
#include "rooms_sight.h"
#include "steady.h"

#include <math.h>
#include <string.h>

static const double WALLS_THAT_COUNT = 20; // walls at which what a room hides has grown by the root of two
static const double SHARE_THAT_COUNTS = 0.2; // of all air: from there on a room hides more and more, whatever its walls
static const double HALL_OPENNESS = 0.9; // but a hall cut by one plane stays one: halves of a cube are open to each other by 1.59

typedef struct room { double volume; uint32_t walls; } room;

typedef struct merging {
    const merge_input *in;
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

// ---- First, until few enough are left to look at each: the most open ----

static const uint32_t PLANES_A_PORTAL = 3; // that are left, of the portals that may be

static int is_door(const merging *m, const room_link *l)
{
    return (((const uint32_t *)m->links.planes.items)[l->first_plane + l->plane_count - 1] & LINK_DOOR) != 0; // ascending
}

static const double LEAVES_MOST = 3; // of a door side by side, with room round them

// An opening that a door stands in, though its portal alone would part nothing.
static int is_doorway(const merging *m, const room_link *l)
{
    const door_place *d = m->in->door_places;
    for (uint32_t i = 0; i < m->in->door_place_count; ++i) {
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            const double off = l->moment[k] / l->area - d[i].middle[k];
            square += off * off;
        }
        if (square < l->area / 4 && l->area < LEAVES_MOST * d[i].area) return 1;
    }
    return 0;
}

static result merge_open(merging *m)
{
    const uint64_t most = (uint64_t)m->limits->portals * PLANES_A_PORTAL;
    result r = RESULT_OK;
    while (m->heap.count > 0 && r == RESULT_OK) {
        const candidate best = heap_pop(m);
        const room_link l = *link_at(&m->links, best.link);
        if (l.version != best.version || l.is_gone || is_door(m, &l) || (best.score < INT64_MAX && is_doorway(m, &l))) continue;
        if (m->links.plane_total <= most && best.score < INT64_MAX) break; // but slivers go
        r = join(m, &l);
    }
    return r;
}

// ---- Then, those that hide least for the portals that they take ----

static const double DOORWAY_WORTH = 4;   // of what it hides: an opening that a leaf comes and goes in is where a player stops seeing
static const double DOOR_WORTH = 64;     // of one that a shut leaf closes whole: then it hides all, so it goes last
static const double LEAST_WORTH = 4;     // lines of sight that a portal has to part, of LINES_MOST

typedef struct by_sight {
    sight lines;
    uint32_t *number;  // by cell that stands for a room: that of the lines
    uint32_t *version; // by link: that its worth is of
    int64_t *worth;    // by link: steady
    uint32_t link_count;
} by_sight;

static uint32_t planes_shared(const merging *m, const room_link *a, const room_link *b)
{
    const uint32_t *p = (const uint32_t *)m->links.planes.items + a->first_plane, *q = (const uint32_t *)m->links.planes.items + b->first_plane;
    uint32_t both = 0;
    for (uint32_t i = 0, k = 0; i < a->plane_count && k < b->plane_count;) {
        both += p[i] == q[k];
        const int next = p[i] <= q[k];
        k += q[k] <= p[i];
        i += (uint32_t)next;
    }
    return both;
}

static uint32_t other_room(const room_link *l, uint32_t room)
{
    return l->rooms[0] == room ? l->rooms[1] : l->rooms[0];
}

// Portals that go when the two become one: between them, and where both have one to a third room in one plane.
static uint32_t portals_saved(const merging *m, const room_link *l)
{
    const buffer *first = links_of(&m->links, l->rooms[0]), *second = links_of(&m->links, l->rooms[1]);
    uint32_t saved = l->plane_count;
    for (size_t i = 0; i < first->count; ++i) {
        const room_link *a = link_at(&m->links, ((const uint32_t *)first->items)[i]);
        for (size_t k = 0; k < second->count; ++k) {
            const room_link *b = link_at(&m->links, ((const uint32_t *)second->items)[k]);
            if (a != b && other_room(a, l->rooms[0]) == other_room(b, l->rooms[1])) saved += planes_shared(m, a, b);
        }
    }
    return saved;
}

static int64_t worth_of(const merging *m, const by_sight *s, const room_link *l)
{
    const double open = openness(m, l), by_door = is_door(m, l) ? DOOR_WORTH : is_doorway(m, l) ? DOORWAY_WORTH : 1;
    if (isinf(open)) return INT64_MIN;
    const double hides = sight_cost(&s->lines, s->number[l->rooms[0]], s->number[l->rooms[1]]) + 1 / open;
    return steady_log(hides * by_door / portals_saved(m, l));
}

typedef struct place_key { int64_t area, places[STEADY_CENTRES]; } place_key;

static place_key place_of(const merging *m, const room_link *l)
{
    place_key out = {.area = steady_log(l->area)};
    double middle[3];
    for (int k = 0; k < 3; ++k) middle[k] = l->moment[k] / l->area;
    steady_places(&m->centres, middle, out.places);
    return out;
}

// Of two worth the same.
static int place_first(const merging *m, const room_link *a, const room_link *b)
{
    const place_key x = place_of(m, a), y = place_of(m, b);
    if (x.area != y.area) return x.area > y.area;
    return steady_places_compare(x.places, y.places) < 0;
}

// LINK_NO_FACE: none. Doors only while there are too many portals.
static uint32_t least_worth(merging *m, by_sight *s, int doors_too)
{
    uint32_t best = LINK_NO_FACE;
    for (uint32_t i = 0; i < s->link_count; ++i) {
        const room_link *l = link_at(&m->links, i);
        if (l->is_gone || (!doors_too && is_door(m, l))) continue;
        if (s->version[i] != l->version + 1) {
            s->worth[i] = worth_of(m, s, l);
            s->version[i] = l->version + 1;
        }
        if (best == LINK_NO_FACE || s->worth[i] < s->worth[best] || (s->worth[i] == s->worth[best] && place_first(m, l, link_at(&m->links, best)))) best = i;
    }
    return best;
}

static const uint32_t KEPT_BACK = 50; // of so many portals one: where portals cut each other, more pieces are left than were counted

static result too_many(merging *m, int *out)
{
    const uint32_t fixed = m->in->fixed_portals, most = m->limits->portals - m->limits->portals / KEPT_BACK;
    *out = fixed + m->links.plane_total > most && m->links.plane_total > 0;
    if (*out) return RESULT_OK;
    const result r = links_portals(&m->links, &m->joiner, &m->map->portals);
    *out = fixed + m->map->portals > most && m->map->portals > 0;
    return r;
}

static int is_enough(const merging *m, int64_t worth)
{
    return m->limits->rooms ? m->map->room_count <= m->limits->rooms : worth >= steady_log(LEAST_WORTH);
}

static result merge_least(merging *m, by_sight *s)
{
    result r = RESULT_OK;
    while (r == RESULT_OK) {
        int many;
        r = too_many(m, &many);
        const uint32_t best = r == RESULT_OK ? least_worth(m, s, many) : LINK_NO_FACE;
        if (best == LINK_NO_FACE || (!many && is_enough(m, s->worth[best]))) break;
        const room_link l = *link_at(&m->links, best);
        r = join(m, &l);
        const uint32_t kept = room_of(m, l.rooms[0]), gone = kept == l.rooms[0] ? l.rooms[1] : l.rooms[0];
        if (r == RESULT_OK) sight_join(&s->lines, s->number[kept], s->number[gone]);
    }
    return r;
}

static result merge_by_sight(merging *m, const allocator *memory)
{
    const uint32_t count = m->map->cell_count;
    uint32_t rooms = 0;
    by_sight s = {.number = memory_alloc(memory, count, sizeof *s.number), .link_count = link_count(&m->links)};
    s.version = memory_alloc_zeroed(memory, s.link_count, sizeof *s.version);
    s.worth = memory_alloc(memory, s.link_count, sizeof *s.worth);
    uint32_t *of_cell = memory_alloc(memory, count, sizeof *of_cell);
    result r = s.number && s.version && s.worth && of_cell ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t c = 0; c < count && r == RESULT_OK; ++c)
        if (room_of(m, c) == c) s.number[c] = rooms++;
    for (uint32_t c = 0; c < count && r == RESULT_OK; ++c) of_cell[c] = s.number[room_of(m, c)];
    if (r == RESULT_OK) {
        r = sight_make(m->cells, of_cell, rooms, memory, &s.lines);
        if (r == RESULT_OK) r = merge_least(m, &s);
        sight_free(&s.lines);
    }
    memory_free(memory, s.number, count, sizeof *s.number);
    memory_free(memory, s.version, s.link_count, sizeof *s.version);
    memory_free(memory, s.worth, s.link_count, sizeof *s.worth);
    memory_free(memory, of_cell, count, sizeof *of_cell);
    return r;
}

static link_face measure(const merging *m, uint32_t number)
{
    const cell_face *f = (const cell_face *)m->cells->faces.items + number;
    const polygon_edge *edges = (const polygon_edge *)m->cells->edges.items + f->shape.first;
    link_face out = {.face = number, .plane = link_plane_of(f, m->in->from->doors), .area = f->area};
    for (uint32_t i = 0; i < f->shape.count; ++i)
        for (int k = 0; k < 3; ++k) out.middle[k] += edges[i].start[k] / f->shape.count;
    return out;
}

static result links_take(merging *m)
{
    const cell_face *f = m->cells->faces.items;
    result r = RESULT_OK;
    for (uint32_t i = 0; i < m->cells->faces.count && r == RESULT_OK; ++i) {
        const link_face face = measure(m, i);
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

result rooms_merge(const merge_input *in, const allocator *memory, room_map *out)
{
    const cell_set *cells = in->cells;
    const uint32_t count = (uint32_t)cells->cells.count;
    *out = (room_map){memory_alloc(memory, count, sizeof *out->room_of), count, count, 0};
    merging m = {.in = in,
                 .cells = cells,
                 .limits = in->limits,
                 .map = out,
                 .rooms = memory_alloc(memory, count, sizeof *m.rooms),
                 .above = memory_alloc(memory, count, sizeof *m.above),
                 .heap = buffer_make(memory, sizeof(candidate))};
    m.joiner = link_joiner_make(cells, in->from, in->door_portals, memory);
    result r = links_open(&m.links, count, (uint32_t)cells->faces.count, memory);
    if (!out->room_of || !m.rooms || !m.above) r = RESULT_NO_MEMORY;
    for (uint32_t c = 0; c < count && r == RESULT_OK; ++c) {
        const cell *from = (cell *)cells->cells.items + c;
        m.rooms[c] = (room){from->volume, from->walls};
        m.above[c] = c;
        m.air += from->volume;
    }
    if (r == RESULT_OK) r = links_take(&m);
    if (r == RESULT_OK) r = merge_open(&m);
    if (r == RESULT_OK && count) r = merge_by_sight(&m, memory);
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
