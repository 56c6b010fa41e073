// Movers: see movers.h. Each zone has a chain of blocks of which only the first may be part full; each mover knows its
// block and place in every zone that it stands in, so that whatever leaves is replaced by the last of the first block.
// SPDX-License-Identifier: MIT
// Invariant: the pool has a block for every way that all movers can stand in as many zones as they may.
#include "movers.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

#define FARTHEST_M 1e9 // double still tells 0.1 micrometres apart there

enum { WORD_BITS = 64 };

typedef enum standing {
    STANDS_NOWHERE, // the number is not in use
    STANDS_IN_ZONES,
    STANDS_EVERYWHERE,
} standing;

typedef struct membership {
    uint32_t block, place;
} membership;

typedef struct world_box {
    double min[3], max[3];
} world_box;

struct movers {
    const scene *scene;
    const graph *graph;
    world_box *boxes;       // by mover
    uint8_t *standings;     // by mover: standing
    uint8_t *zone_counts;   // by mover
    uint32_t *zones;        // by mover, `most` each, ascending
    membership *members;    // as zones
    uint32_t *everywhere;   // counts.everywhere movers
    uint64_t *used;         // a bit a mover, and one more at least that is never set
    uint32_t *heads;        // by zone: its first block, or SCENE_NONE
    mover_block *blocks;
    uint32_t first_free;    // block
    uint32_t least_free;    // no word of `used` before this one has room
    uint32_t most;          // zones that a mover may stand in
    mover_counts counts;
    arena memory;
};

// ---- Boxes of a zone ----

static float float_below(float f)
{
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    if (f > 0) bits--;
    else if (f < 0) bits++;
    else bits = 0x80000001u;
    memcpy(&f, &bits, sizeof f);
    return f;
}

// The greatest float that is surely at or below world - origin, the difference taken exactly (Knuth's two-sum).
static float relative_below(double world, double origin)
{
    const double difference = world - origin, part = world - difference, whole = difference + part;
    const double error = (part - origin) + (world - whole);
    const float f = (float)difference;
    return (double)f > difference || ((double)f == difference && error < 0) ? float_below(f) : f;
}

static float relative_above(double world, double origin)
{
    return -relative_below(-world, -origin);
}

static void place_write(movers *m, uint32_t mover, uint32_t zone, membership at)
{
    m->counts.writes++;
    mover_block *b = &m->blocks[at.block];
    const world_box *box = &m->boxes[mover];
    const double *origin = m->scene->zones[zone].origin;
    b->min_x[at.place] = relative_below(box->min[0], origin[0]);
    b->min_y[at.place] = relative_below(box->min[1], origin[1]);
    b->min_z[at.place] = relative_below(box->min[2], origin[2]);
    b->max_x[at.place] = relative_above(box->max[0], origin[0]);
    b->max_y[at.place] = relative_above(box->max[1], origin[1]);
    b->max_z[at.place] = relative_above(box->max[2], origin[2]);
    b->mover[at.place] = mover;
}

static void place_copy(mover_block *to, uint32_t place, const mover_block *from, uint32_t last)
{
    to->min_x[place] = from->min_x[last];
    to->min_y[place] = from->min_y[last];
    to->min_z[place] = from->min_z[last];
    to->max_x[place] = from->max_x[last];
    to->max_y[place] = from->max_y[last];
    to->max_z[place] = from->max_z[last];
    to->mover[place] = from->mover[last];
}

// ---- Lists ----

// Lanes that no mover stands in are judged with the others and dropped after: what the memory held before may be denormal
// numbers, which cost a hundred times as much.
static void block_clear(mover_block *b)
{
    memset(b, 0, offsetof(mover_block, mover));
    b->count = 0;
}

static membership zone_enter(movers *m, uint32_t zone)
{
    uint32_t head = m->heads[zone];
    if (head == SCENE_NONE || m->blocks[head].count == MOVER_BLOCK) {
        const uint32_t block = m->first_free;
        assert(block != SCENE_NONE);
        m->first_free = m->blocks[block].next;
        block_clear(&m->blocks[block]);
        m->blocks[block].next = head;
        m->heads[zone] = head = block;
    }
    return (membership){head, m->blocks[head].count++};
}

static void zone_leave(movers *m, uint32_t zone, membership at)
{
    const uint32_t head = m->heads[zone];
    mover_block *b = &m->blocks[head];
    const uint32_t last = --b->count;
    if (at.block != head || at.place != last) {
        const uint32_t other = b->mover[last];
        const uint32_t *zones = m->zones + (size_t)other * m->most;
        uint32_t i = 0;
        while (zones[i] != zone) i++;
        m->members[(size_t)other * m->most + i] = at;
        place_copy(&m->blocks[at.block], at.place, b, last);
        m->counts.writes++;
    }
    if (b->count > 0) return;
    m->heads[zone] = b->next;
    b->next = m->first_free;
    m->first_free = head;
}

static void everywhere_enter(movers *m, uint32_t mover)
{
    m->standings[mover] = STANDS_EVERYWHERE;
    m->members[(size_t)mover * m->most].place = m->counts.everywhere;
    m->everywhere[m->counts.everywhere++] = mover;
}

static void everywhere_leave(movers *m, uint32_t mover)
{
    const uint32_t place = m->members[(size_t)mover * m->most].place, other = m->everywhere[--m->counts.everywhere];
    m->everywhere[place] = other;
    m->members[(size_t)other * m->most].place = place;
}

// ---- Standing ----

static int has_zone(const uint32_t *zones, uint32_t count, uint32_t zone)
{
    for (uint32_t i = 0; i < count; i++) {
        if (zones[i] == zone) return 1;
    }
    return 0;
}

// Leaves the zones that are not among the new ones; keeps its places in the others.
static void zones_leave(movers *m, uint32_t mover, const uint32_t *zones, uint32_t count)
{
    uint32_t *own = m->zones + (size_t)mover * m->most;
    membership *members = m->members + (size_t)mover * m->most;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < m->zone_counts[mover]; i++) {
        if (has_zone(zones, count, own[i])) {
            own[kept] = own[i];
            members[kept++] = members[i];
        } else {
            zone_leave(m, own[i], members[i]);
        }
    }
    m->zone_counts[mover] = (uint8_t)kept;
}

// The zones it stands in are among the new ones, and both ascend: filled from behind, so nothing is overwritten unread.
static void zones_enter(movers *m, uint32_t mover, const uint32_t *zones, uint32_t count)
{
    uint32_t *own = m->zones + (size_t)mover * m->most;
    membership *members = m->members + (size_t)mover * m->most;
    uint32_t kept = m->zone_counts[mover];
    for (uint32_t i = count; i-- > 0;) {
        members[i] = kept > 0 && own[kept - 1] == zones[i] ? members[--kept] : zone_enter(m, zones[i]);
        own[i] = zones[i];
        place_write(m, mover, own[i], members[i]);
    }
    m->zone_counts[mover] = (uint8_t)count;
    m->standings[mover] = STANDS_IN_ZONES;
}

static void mover_place(movers *m, uint32_t mover)
{
    uint32_t zones[MOVER_ZONES_MOST];
    const world_box *box = &m->boxes[mover];
    const uint32_t count = graph_few_zones_of_box(m->graph, box->min, box->max, zones, m->most);
    if (count > 0 && count <= m->most) zones_enter(m, mover, zones, count);
    else everywhere_enter(m, mover);
}

static int is_same(const movers *m, uint32_t mover, const uint32_t *zones, uint32_t count)
{
    const uint32_t *own = m->zones + (size_t)mover * m->most;
    return m->zone_counts[mover] == count && memcmp(own, zones, count * sizeof *own) == 0;
}

// The box is the new one already.
static void mover_replace(movers *m, uint32_t mover)
{
    uint32_t zones[MOVER_ZONES_MOST];
    const world_box *box = &m->boxes[mover];
    uint32_t count = graph_few_zones_of_box(m->graph, box->min, box->max, zones, m->most);
    if (count > m->most) count = 0; // everywhere
    const int was_everywhere = m->standings[mover] == STANDS_EVERYWHERE;
    if (was_everywhere && count == 0) return;
    if (!was_everywhere && is_same(m, mover, zones, count)) {
        const membership *members = m->members + (size_t)mover * m->most;
        for (uint32_t i = 0; i < count; i++) place_write(m, mover, zones[i], members[i]);
        return;
    }
    m->counts.relocations++;
    if (was_everywhere) everywhere_leave(m, mover);
    else zones_leave(m, mover, zones, count);
    if (count > 0) zones_enter(m, mover, zones, count);
    else everywhere_enter(m, mover);
}

// ---- What the caller does ----

// Written so that a NaN is none.
static int is_box(const double min[3], const double max[3])
{
    for (int k = 0; k < 3; k++) {
        if (!(min[k] >= -FARTHEST_M && min[k] <= max[k] && max[k] <= FARTHEST_M)) return 0;
    }
    return 1;
}

static world_box world_box_make(const double min[3], const double max[3])
{
    return (world_box){{min[0], min[1], min[2]}, {max[0], max[1], max[2]}};
}

static int is_in_use(const movers *m, uint32_t mover)
{
    return mover < m->counts.capacity && m->standings[mover] != STANDS_NOWHERE;
}

result movers_add(movers *m, uint32_t mover, const double min[3], const double max[3])
{
    if (mover >= m->counts.capacity || is_in_use(m, mover) || !is_box(min, max)) return RESULT_BAD_INPUT;
    m->boxes[mover] = world_box_make(min, max);
    m->zone_counts[mover] = 0;
    mover_place(m, mover);
    m->used[mover / WORD_BITS] |= (uint64_t)1 << mover % WORD_BITS;
    m->counts.live++;
    while (m->used[m->least_free] == UINT64_MAX) m->least_free++; // the last word is never full
    return RESULT_OK;
}

result movers_move(movers *m, uint32_t mover, const double min[3], const double max[3])
{
    if (!is_in_use(m, mover) || !is_box(min, max)) return RESULT_BAD_INPUT;
    m->boxes[mover] = world_box_make(min, max);
    m->counts.moves++;
    mover_replace(m, mover);
    return RESULT_OK;
}

result movers_remove(movers *m, uint32_t mover)
{
    if (!is_in_use(m, mover)) return RESULT_BAD_INPUT;
    if (m->standings[mover] == STANDS_EVERYWHERE) everywhere_leave(m, mover);
    else zones_leave(m, mover, NULL, 0);
    m->standings[mover] = STANDS_NOWHERE;
    m->used[mover / WORD_BITS] &= ~((uint64_t)1 << mover % WORD_BITS);
    m->counts.live--;
    if (mover / WORD_BITS < m->least_free) m->least_free = mover / WORD_BITS;
    return RESULT_OK;
}

uint32_t movers_free_number(const movers *m)
{
    if (m->counts.live == m->counts.capacity) return SCENE_NONE;
    uint64_t word = m->used[m->least_free];
    uint32_t number = m->least_free * WORD_BITS;
    for (; word & 1; word >>= 1) number++;
    return number;
}

// ---- Reading ----

const mover_block *movers_of_zone(const movers *m, uint32_t zone)
{
    return m->heads[zone] == SCENE_NONE ? NULL : &m->blocks[m->heads[zone]];
}

const mover_block *movers_next(const movers *m, const mover_block *b)
{
    return b->next == SCENE_NONE ? NULL : &m->blocks[b->next];
}

const uint32_t *movers_everywhere(const movers *m, uint32_t *count)
{
    *count = m->counts.everywhere;
    return m->everywhere;
}

uint32_t movers_zones(const movers *m, uint32_t mover, const uint32_t **zones)
{
    *zones = NULL;
    if (!is_in_use(m, mover) || m->standings[mover] == STANDS_EVERYWHERE) return 0;
    *zones = m->zones + (size_t)mover * m->most;
    return m->zone_counts[mover];
}

int movers_box(const movers *m, uint32_t mover, double min[3], double max[3])
{
    if (!is_in_use(m, mover)) return 0;
    memcpy(min, m->boxes[mover].min, sizeof m->boxes[mover].min);
    memcpy(max, m->boxes[mover].max, sizeof m->boxes[mover].max);
    return 1;
}

mover_counts movers_counts(const movers *m)
{
    return m->counts;
}

// ---- Opening ----

// Full blocks for every place that movers can take, and one part full for each zone that has any.
static size_t block_count(const movers *m)
{
    const size_t places = (size_t)m->counts.capacity * m->most;
    const size_t part_full = places < m->scene->zone_count ? places : m->scene->zone_count;
    return places / MOVER_BLOCK + part_full;
}

static int movers_reserve(movers *m, size_t blocks)
{
    const size_t capacity = m->counts.capacity, places = capacity * m->most;
    if (blocks >= SCENE_NONE) return 0;
    m->boxes = arena_push(&m->memory, capacity, sizeof *m->boxes);
    m->standings = arena_push(&m->memory, capacity, sizeof *m->standings);
    m->zone_counts = arena_push(&m->memory, capacity, sizeof *m->zone_counts);
    m->zones = arena_push(&m->memory, places, sizeof *m->zones);
    m->members = arena_push(&m->memory, places, sizeof *m->members);
    m->everywhere = arena_push(&m->memory, capacity, sizeof *m->everywhere);
    m->used = arena_push(&m->memory, capacity / WORD_BITS + 1, sizeof *m->used);
    m->heads = arena_push(&m->memory, m->scene->zone_count, sizeof *m->heads);
    m->blocks = arena_push(&m->memory, blocks, sizeof *m->blocks);
    return m->boxes && m->standings && m->zone_counts && m->zones && m->members && m->everywhere && m->used && m->heads && m->blocks;
}

result movers_open(const movers_request *q, const allocator *memory, movers **out)
{
    *out = NULL;
    movers *m = memory_alloc(memory, 1, sizeof *m);
    if (!m) return RESULT_NO_MEMORY;
    *m = (movers){.scene = q->scene, .graph = q->graph, .first_free = SCENE_NONE, .memory = arena_make(memory)};
    m->counts.capacity = q->capacity;
    m->most = q->scene->zone_count < MOVER_ZONES_MOST ? q->scene->zone_count : MOVER_ZONES_MOST;
    if (m->most == 0) m->most = 1;
    const size_t blocks = block_count(m);
    if (!movers_reserve(m, blocks)) {
        movers_close(m);
        return RESULT_NO_MEMORY;
    }
    memset(m->standings, STANDS_NOWHERE, q->capacity);
    memset(m->used, 0, (q->capacity / WORD_BITS + 1) * sizeof *m->used);
    for (uint32_t z = 0; z < q->scene->zone_count; z++) m->heads[z] = SCENE_NONE;
    for (size_t i = blocks; i-- > 0;) {
        m->blocks[i].next = m->first_free;
        m->first_free = (uint32_t)i;
    }
    *out = m;
    return RESULT_OK;
}

void movers_close(movers *m)
{
    if (!m) return;
    const allocator *memory = m->memory.memory;
    arena_free(&m->memory);
    memory_free(memory, m, 1, sizeof *m);
}
