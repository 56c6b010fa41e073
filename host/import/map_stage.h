// One entity's brushes as convex polygons and bodies, in the map's axes and units, before they enter the scene.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_MAP_STAGE_H
#define PORTCULLIS_HOST_MAP_STAGE_H

#include "map_brush.h"
#include "map_entity.h"
#include "map_texture.h"

typedef struct staged_point {
    double position[3]; // units
    float texcoord[2];  // texels / 64
} staged_point;

typedef struct staged_polygon { // counterclockwise from outside, ready to be fanned from its first point
    size_t first_point, point_count;
    double normal[3], distance; // unit; outside where dot > distance
    map_word texture;
    texture_kind kind;
} staged_polygon;

typedef struct staged_solid {
    size_t first_plane, plane_count; // in planes
    solid_kind kind;
    double min[3], max[3];
} staged_solid;

typedef struct staged_plane { double normal[3], distance; } staged_plane;

typedef struct map_stage {
    buffer polygons, points, solids, solid_planes;
    double min[3], max[3];    // of all brushes staged; min > max: none
    uint32_t polygons_dropped; // of no area, over all entities
    brush_body body;
    buffer planes; // brush_plane, of one brush
} map_stage;

map_stage map_stage_make(const allocator *memory);
void map_stage_free(map_stage *s);
void map_stage_clear(map_stage *s); // for the next entity
// Brushes of tool textures only leave nothing. An open brush is an error, an empty one a warning.
result map_stage_brush(map_stage *s, const map_entity *e, size_t brush, entity_body body, const map_reader *m);

#endif
