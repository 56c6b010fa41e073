// The scene in memory: flat arrays that an importer fills through a scene_builder, constant afterwards.
// SPDX-License-Identifier: MIT
// Invariant: positions are float, relative to the zone's double origin, multiples of one power-of-two step; items stand
// in file order, the movers' items behind all others; an item's place in `items` is its global id.
#ifndef PORTCULLIS_HOST_SCENE_H
#define PORTCULLIS_HOST_SCENE_H

#include "memory.h"
#include "report.h"

#include <portcullis/culler.h>

enum { // scene_material.flags
    MATERIAL_TRANSLUCENT = 1u << 0, // liquids: two-sided, leave no depth
    MATERIAL_CUT_OUT = 1u << 1,     // alpha-tested
    MATERIAL_SKY = 1u << 2,
};

typedef struct scene_material {
    const char *name;
    uint32_t flags;
    uint32_t colour; // 0xAABBGGRR, made from the name where the file says none
} scene_material;

typedef struct scene_object { // an `o` or `g` group, a brush entity
    const char *name;
    uint32_t first_item, item_count;
} scene_object;

typedef struct scene_item {
    uint32_t first_index, index_count; // triangles in scene.indices, ascending and without gaps over the items
    uint32_t first_polygon, polygon_count;
    uint32_t material; // of the first polygon; a mover's vertices may have several
    uint32_t object;
    uint32_t flags; // CULL_ITEM_*
} scene_item;

typedef struct scene_mover { // item scene.item_count + its place in scene.movers
    const char *name;
    double open_offset[3]; // from shut to open, metres; already applied to the geometry when doors are open
} scene_mover;

typedef enum place_kind { PLACE_PLAYER, PLACE_MONSTER, PLACE_OTHER } place_kind;
typedef struct scene_place { // a point entity
    double position[3];      // world
    place_kind kind;
} scene_place;

typedef enum solid_kind {
    SOLID_STRUCTURE, // world brushes, boxes
    SOLID_ENTITY,    // other brush entities
    SOLID_LIQUID,
} solid_kind;
typedef struct scene_solid { // convex body: inside where normal . p <= distance for all its planes, world, unit normals
    uint32_t first_plane, plane_count;
    solid_kind kind;
    double min[3], max[3];
} scene_solid;
typedef struct scene_solid_plane { double normal[3], distance; } scene_solid_plane;

typedef struct scene_zone {
    const char *name;
    double origin[3];
    cull_box box; // of everything, movers too, relative to the origin
    float radius; // largest absolute coordinate
} scene_zone;

typedef struct scene {
    arena memory;
    const char *path;
    uint64_t hash; // XXH3 of the arrays below, the same for the same geometry
    scene_zone zone;
    double step; // metres: every coordinate relative to the origin is a multiple of it

    cull_vec3 *positions;       // position_count
    uint32_t *normals;          // 3 x snorm8 in the low bytes, 0: flat shading
    float *texcoords;           // 2 a vertex; NULL when no material needs them
    uint16_t *vertex_materials; // 1 a vertex
    uint32_t *indices;          // index_count, counterclockwise from the front
    uint32_t *polygon_first_triangle; // polygon_count + 1
    scene_item *items;          // item_count + mover_count
    cull_boxes boxes;           // of all of them, padded
    cull_wall *walls;           // item_count; NULL without walls
    uint32_t *wall_vertices;
    cull_plane *planes;
    scene_material *materials;
    scene_object *objects;
    scene_mover *movers;
    scene_place *places;
    scene_solid *solids;
    scene_solid_plane *solid_planes;

    uint32_t position_count, index_count, polygon_count, item_count, mover_count;
    uint32_t wall_vertex_count, plane_count, material_count, object_count, place_count;
    uint32_t solid_count, solid_plane_count;
    uint32_t is_map; // the auto views start at its places
    uint32_t flat_triangles; // of zero area after rounding, counted, kept
} scene;

void scene_free(scene *s, const allocator *memory); // NULL is fine
double scene_radius_m(const scene *s);               // half the diagonal of the zone's box

// ---- Building ----

typedef struct scene_builder scene_builder;

typedef struct builder_vertex {
    double position[3]; // world, metres, Y up
    float normal[3];    // zero: flat
    float texcoord[2];
} builder_vertex;

typedef struct builder_item {
    const uint32_t *indices;           // triangles, vertex numbers as scene_builder_vertices gave them
    const uint32_t *polygon_triangles; // triangles of each polygon; NULL: one each
    const uint32_t *loop;              // wall polygons: the loop, counterclockwise from the front; else NULL
    uint32_t index_count, polygon_count, loop_count;
    uint32_t material, object, flags;  // CULL_ITEM_*; SEE_THROUGH, CUT_OUT, TWO_SIDED follow from the material too
    double plane[4];                   // walls: unit normal, offset: inside dot + offset >= 0
} builder_item;

// [one thread] Functions below report nothing themselves but for out-of-memory in the result.
result scene_builder_open(const allocator *memory, scene_builder **out);
void scene_builder_close(scene_builder *b); // NULL is fine
result scene_builder_material(scene_builder *b, const char *name, size_t length, uint32_t flags, uint32_t *out); // found again by name
result scene_builder_material_colour(scene_builder *b, uint32_t material, uint32_t colour);
result scene_builder_object(scene_builder *b, const char *name, size_t length, uint32_t *out); // a new one each call
result scene_builder_vertices(scene_builder *b, const builder_vertex *vertices, size_t count, uint32_t material, uint32_t *out_first);
result scene_builder_item(scene_builder *b, const builder_item *item);        // static; RESULT_BAD_INPUT: an index is out of range
result scene_builder_mover(scene_builder *b, const char *name, const double open_offset[3], const builder_item *item);
result scene_builder_place(scene_builder *b, const scene_place *place);
result scene_builder_solid(scene_builder *b, solid_kind kind, const scene_solid_plane *planes, uint32_t plane_count,
                           const double min[3], const double max[3]);
void scene_builder_map(scene_builder *b); // the scene is a map: auto views start at its places
// Origin, rounding, boxes, hash. Refuses (with a line) a scene without polygons, too wide for 1 mm in float, or over
// 2^32 of anything.
result scene_builder_finish(scene_builder *b, const char *path, report *r, scene **out);

#endif
