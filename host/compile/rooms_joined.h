// How many portals links come to when coplanar neighbours are joined as they are written, by the same hulls.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_ROOMS_JOINED_H
#define PORTCULLIS_HOST_ROOMS_JOINED_H

#define LINK_DOOR 0x80000000u // of a link's planes: a group of doors

#include "flat_hulls.h"
#include "rooms_cells.h"
#include "rooms_links.h"

typedef struct link_joiner {
    const cell_set *cells;
    const plane_table *planes;
    const cell_door *doors;
    const uint32_t *door_portals; // by group of doors: how many it makes
    flat_hulls hulls;
    buffer faces; // of one link
} link_joiner;

link_joiner link_joiner_make(const cell_set *cells, const cell_input *from, const uint32_t *door_portals, const allocator *memory);
// What a link counts as one plane: the face's, or its group of doors.
uint32_t link_plane_of(const cell_face *f, const cell_door *doors);

void link_joiner_free(link_joiner *j);
// Of all links that are there; only those that changed since they were asked are worked out.
result links_portals(link_set *s, link_joiner *j, uint32_t *total);

#endif
