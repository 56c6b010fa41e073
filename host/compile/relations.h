// How brushes stand to each other, by exact predicates: made once, read by every later stage.
// SPDX-License-Identifier: MIT
// Invariant: bodies that share an inner point are never told APART or TOUCHING. TOUCHING: some face plane of one has the other
// wholly in front, with a corner on it; whether the bodies meet in that plane isn't asked. CONTAINS, INSIDE: borders may touch.
#ifndef PORTCULLIS_HOST_RELATIONS_H
#define PORTCULLIS_HOST_RELATIONS_H

#include "brush_polygons.h"

// Equal bodies: CONTAINS. Pairs of brushes without a body are not listed.
result relation_table_make(const plane_table *planes, const brush_bodies *bodies, const allocator *memory, relation_table *out);
void relation_table_free(relation_table *t, const brush_bodies *bodies, const allocator *memory); // of zeros is fine

#endif
