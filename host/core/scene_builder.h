// What a scene_builder holds between scene_build.c, which collects, and scene_finish.c, which makes the scene of it.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_SCENE_BUILDER_H
#define PORTCULLIS_HOST_SCENE_BUILDER_H

#include "scene.h"

enum { HULL_PLANES_MOST = 256, PORTAL_POINTS_MOST = 64 };

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

typedef struct builder_own_zone { uint32_t item, zone; } builder_own_zone;

// What builder_transform says, taken apart. world = scale * turn * p + move.
typedef struct builder_map {
    double turn[9], move[3], scale; // turn: rows, orthonormal
    uint32_t is_on;                 // 0: nothing is computed, bits stay
} builder_map;

typedef struct builder_gate { // a portal, checked, its points counterclockwise seen from zones[0]
    const char *name;
    uint32_t zones[2], first_point, point_count, door;
} builder_gate;

struct scene_builder {
    const allocator *memory;
    arena names;
    builder_map map;
    buffer positions;        // 3 doubles a vertex
    buffer normals;          // uint32_t
    buffer texcoords;        // 2 floats a vertex
    buffer vertex_materials; // uint16_t
    builder_stream statics, movers;
    buffer walls;         // builder_wall, one a static item
    buffer wall_vertices; // uint32_t
    buffer exact_planes;  // cull_exact_plane, one a static item once there is a grid; zeros of what is no wall
    buffer own_zones;     // builder_own_zone, by item: of static items that were given their zones
    buffer materials;     // scene_material
    buffer material_slots; // uint32_t: open addressing by name, material + 1
    buffer objects;       // scene_object
    buffer mover_list;    // scene_mover
    buffer places;        // scene_place
    buffer solids;        // scene_solid
    buffer solid_planes;  // scene_solid_plane
    buffer zones;         // scene_zone: name, chain, flags, parent, hulls
    buffer zone_slots;    // uint32_t: open addressing by name, zone + 1
    buffer hulls;         // scene_hull
    buffer hull_planes;   // scene_solid_plane
    buffer gates;         // builder_gate
    buffer gate_points;   // 3 doubles a point
    buffer doors;         // scene_door
    buffer keys;          // scene_key
    buffer lights;        // scene_light
    buffer paths;         // scene_camera_path
    buffer cameras;       // camera
    uint32_t is_map, wall_count;
    double grid_steps_per_metre; // of exact_planes; 0: no grid
    uint32_t inexact_walls;      // without an exact plane
    uint32_t everywhere; // the zone without hulls, or SCENE_NONE
};

void builder_point(const scene_builder *b, const double p[3], double out[3]);     // moved, turned, scaled; out may be p
void builder_direction(const scene_builder *b, const double v[3], double out[3]); // turned only
void builder_offset(const scene_builder *b, const double v[3], double out[3]);    // turned and scaled
// inside: normal . p <= distance, of any length of the normal
scene_solid_plane builder_plane(const scene_builder *b, const scene_solid_plane *plane);
double builder_scale(const scene_builder *b);
// Newell's: the middle of the points and the normal, of twice the area's length. From the first point, so that a polygon
// far away is measured like one near by.
void polygon_measure(const double (*points)[3], uint32_t count, double middle[3], double twice_area[3]);

#endif
