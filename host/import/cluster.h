// Clusters: the polygons of one object and material in spatially tight groups of at most 128 triangles.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMPORT_CLUSTER_H
#define PORTCULLIS_IMPORT_CLUSTER_H

#include "../core/memory.h"
#include "../core/report.h"

enum { CLUSTER_TRIANGLES_MOST = 128 };

typedef struct cluster_polygon {
    double min[3], max[3];
    uint32_t triangles;
} cluster_polygon;

// What is scattered is split further: a cluster's box shall not be mostly air. cluster_of[i] is 0 .. *out_count - 1, spatial neighbours near each other. A polygon is never split: one of more than
// 128 triangles is a cluster of its own. The same for a mesh moved by whole metres. Scratch stays in the arena.
result cluster_split(const cluster_polygon *polygons, uint32_t count, arena *scratch, uint32_t *cluster_of, uint32_t *out_count);

#endif
