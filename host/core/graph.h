// The zone graph at rest: which zones a point or a box touches. A binary tree of boxes over the zones' hulls.
// SPDX-License-Identifier: MIT
// Invariant: constant after open; a zone is never left out that the point or box touches, border included.
#ifndef PORTCULLIS_HOST_GRAPH_H
#define PORTCULLIS_HOST_GRAPH_H

#include "scene.h"

typedef struct graph graph;

result graph_open(const scene *s, const allocator *memory, graph **out); // the scene is borrowed
void graph_close(graph *g); // NULL is fine

// Zones that reach to `distance` metres or nearer of the point: a hull of the zone is that near, and no hull of a zone
// whose parent it is holds the point deeper than that. Zones everywhere too, never a stray zone. Each once, ascending; writes at most
// `capacity`, returns how many there are; of a point that is NaN, 0.
uint32_t graph_zones_at(const graph *g, const double p[3], double distance, uint32_t *zones, uint32_t capacity);
// Zones that the box touches: a hull that it is not outside of (by one of the hull's planes or its bounds), and no hull
// of a zone whose parent it is that holds the whole box in its inside. Borders count as touched. The margins are those by
// which scene_builder_finish lists items, see zone_seam.h: 1 step of the scene outward to touch, 2 steps inward to be held,
// more where a portal of the zone lies off its hulls by more. graph_zones_at reckons with such portals too.
// Of a box whose min is above its max, or of NaN: 0.
uint32_t graph_zones_of_box(const graph *g, const double min[3], const double max[3], uint32_t *zones, uint32_t capacity);
// The same, but ends when there are more than `capacity`, below 2^32 - 1: returns more than that then, and which zones it
// wrote is not said. What a box larger than the scene costs does not grow with the scene. Of NaN:
// every zone, so that a mover is never lost.
uint32_t graph_few_zones_of_box(const graph *g, const double min[3], const double max[3], uint32_t *zones, uint32_t capacity);
// Whether a hull of the zone is `distance` metres or nearer, by its planes: zone_height(...) <= distance, found without looking at
// all hulls where one of them is. Of a zone without hulls: 1.
int graph_zone_reaches(const graph *g, uint32_t zone, const double p[3], double distance);
// Nodes on the longest way down a tree: what a look-up can cost for each zone that it finds, whatever the scene.
uint32_t graph_depth(const graph *g);

#endif
