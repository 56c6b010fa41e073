// Pieces: what the select of a zone's chain lends, so that see-through items can be drawn in their exact order.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_PIECES_H
#define PORTCULLIS_HOST_PIECES_H

#include "chain.h"

// [main] As long as the chain; items are places in its order. NULL: the select has none, or tells nonsense (a warning says
// what), and see-through items are put in order by distance.
const cull_pieces *chain_pieces(const chain *c, report *r);

// What is wrong with pieces of a zone that lists item_count items; NULL: nothing. Reads all of it.
const char *pieces_fault(const cull_pieces *p, uint32_t item_count);

#endif
