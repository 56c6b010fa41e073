// What a scene_builder holds between scene_build.c, which collects, and scene_finish.c, which makes the scene of it.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_SCENE_BUILDER_H
#define PORTCULLIS_HOST_SCENE_BUILDER_H

#include "scene.h"

// Items of one kind, static or movers, with what belongs to them; joined at the end.
typedef struct builder_stream {
    buffer items;             // scene_item, first_index and first_polygon within the stream
    buffer indices;           // uint32_t
    buffer polygon_triangles; // uint32_t, triangles of each polygon
} builder_stream;

typedef struct builder_wall { // of a static item, in order
    uint32_t first_vertex, vertex_count;
    double plane[4];
} builder_wall;

struct scene_builder {
    const allocator *memory;
    arena names;
    buffer positions;        // 3 doubles a vertex
    buffer normals;          // uint32_t
    buffer texcoords;        // 2 floats a vertex
    buffer vertex_materials; // uint16_t
    builder_stream statics, movers;
    buffer walls;         // builder_wall, one a static item
    buffer wall_vertices; // uint32_t
    buffer materials;     // scene_material
    buffer material_slots; // uint32_t: open addressing by name, material + 1
    buffer objects;       // scene_object
    buffer mover_list;    // scene_mover
    buffer places;        // scene_place
    buffer solids;        // scene_solid
    buffer solid_planes;  // scene_solid_plane
    uint32_t is_map, wall_count;
};

#endif
