// Placements: "at", "turn", "scale" of an entry as a transform; transforms one within the other.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMPORT_JSON_PLACEMENT_H
#define PORTCULLIS_IMPORT_JSON_PLACEMENT_H

#include "../core/scene.h"
#include "json_node.h"

#define PLACEMENT_KEYS "at", "turn", "scale"

builder_transform placement_none(void);
builder_transform placement_move(const double offset[3]);
// scale, then turned about x, then y, then z, then moved. Turns by quarters have no rounding.
result placement_read(const json_node *entry, builder_transform *out);
builder_transform placement_within(const builder_transform *outer, const builder_transform *inner); // outer * inner

#endif
