// Lines of sight through the air, from places in cells to places on walls that something hides: what rooms are worth is how many of
// these walls they keep from being drawn. A line's end is drawn when it is reached from room to room through openings on the line,
// whatever solid lies between two openings of one room: so portals are culled.
// SPDX-License-Identifier: MIT
// Invariant: places are chosen by own seeded numbers and by sizes, which a moved or turned map shares.
#ifndef PORTCULLIS_HOST_ROOMS_SIGHT_H
#define PORTCULLIS_HOST_ROOMS_SIGHT_H

#include "rooms_cells.h"

typedef struct sight_line { uint32_t first, count; } sight_line; // in sight.steps
#define SIGHT_GAP 0x80000000u                                    // of a step: solid lies before it

typedef struct sight {
    const allocator *memory;
    buffer steps;      // uint32_t: the room that the line runs through
    buffer lines;      // sight_line
    uint64_t *has;     // by room, a bit a line: it runs through it
    uint64_t *reached; // by room: it is seen into along the line
    uint64_t *leads;   // by room: from there the line's end is seen
    uint64_t *hidden;  // the end is not drawn
    uint32_t words, rooms; // words: of a room's bits
} sight;

// room_of: by cell. To be freed also after a failure.
result sight_make(const cell_set *cells, const uint32_t *room_of, uint32_t rooms, const allocator *memory, sight *out);
void sight_free(sight *s);
// How many ends more are drawn if the two are one room.
uint32_t sight_cost(const sight *s, uint32_t a, uint32_t b);
void sight_join(sight *s, uint32_t kept, uint32_t gone);

// rooms_sight_lines.c: steps and lines. RESULT_NO_MEMORY or fine.
result sight_lines_take(const cell_set *cells, const uint32_t *room_of, const allocator *memory, sight *out);

#endif
