// Automatic rooms: the air of each zone parted where it is narrow, by portals made of faces between convex cells.
// SPDX-License-Identifier: MIT
// Invariant: a portal made here has air on both sides and ends at walls or other portals; the zones are traced on it like on any other.
#ifndef PORTCULLIS_HOST_ROOMS_H
#define PORTCULLIS_HOST_ROOMS_H

#include "rooms_merge.h"
#include "zone_trace.h"

// Adds pieces to the set. t: traced with the pieces that the set has.
result rooms_portals(const compile_input *in, const zone_trace *t, const room_limits *limits, report *reports, portal_set *set);

#endif
