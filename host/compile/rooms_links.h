// What lies between rooms while they merge: one link a pair of neighbours, its faces, their area and planes.
// SPDX-License-Identifier: MIT
// Invariant: a pair of rooms has one link at most, and it stands in the lists of both.
#ifndef PORTCULLIS_HOST_ROOMS_LINKS_H
#define PORTCULLIS_HOST_ROOMS_LINKS_H

#include "../core/memory.h"
#include "../core/report.h"

typedef struct room_link {
    uint32_t rooms[2];
    uint32_t first_plane, plane_count; // in link_set.planes, ascending, each once
    uint32_t version;                  // rises when the link or one of its rooms changes
    uint32_t is_gone;
    uint32_t first_face, last_face;    // chained by link_set.next_face
    uint32_t portals;                  // that its faces join to; LINK_UNKNOWN: not asked yet
    double area, moment[3];            // moment: area times middle
} room_link;

#define LINK_UNKNOWN UINT32_MAX
#define LINK_NO_FACE UINT32_MAX
typedef struct link_face { uint32_t face, plane; double area, middle[3]; } link_face; // face: its number

typedef struct link_set {
    const allocator *memory;
    buffer links;         // room_link
    buffer planes;        // uint32_t
    buffer *of_room;      // uint32_t: links; of_room[i].count of them
    uint32_t *slots;      // link + 1 by pair of rooms; 0 empty, UINT32_MAX: one was here
    uint32_t *next_face;  // by face: of its link; LINK_NO_FACE
    uint32_t room_count, face_count, slot_count, slots_used;
    uint32_t plane_total; // planes of the links that are there: coplanar joining leaves no fewer portals
} link_set;

// To be closed also after a failure.
result links_open(link_set *s, uint32_t room_count, uint32_t face_count, const allocator *memory);
void links_close(link_set *s);
result links_add(link_set *s, const uint32_t rooms[2], const link_face *face);
// The links of `gone` become those of `kept`; the link between them goes.
result links_join(link_set *s, uint32_t kept, uint32_t gone);

static inline room_link *link_at(const link_set *s, uint32_t link)
{
    return (room_link *)s->links.items + link;
}
static inline uint32_t link_count(const link_set *s)
{
    return (uint32_t)s->links.count;
}
static inline const buffer *links_of(const link_set *s, uint32_t room)
{
    return &s->of_room[room];
}

#endif
