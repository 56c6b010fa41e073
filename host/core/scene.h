// The scene in memory: flat arrays that an importer fills through a scene_builder, constant afterwards.
// SPDX-License-Identifier: MIT
// Invariant: positions are float, relative to the scene's double origin (whole.origin), multiples of one power-of-two
// step; items stand in file order, the movers' items behind all others; an item's place in `items` is its global id.
// Zone origins are multiples of 1 m like the scene's, so a vertex is the same world point, bit for bit, in each zone.
#ifndef PORTCULLIS_HOST_SCENE_H
#define PORTCULLIS_HOST_SCENE_H

#include "memory.h"
#include "report.h"
#include "view.h"

#include <portcullis/culler.h>

enum { // scene_material.flags
    MATERIAL_TRANSLUCENT = 1u << 0, // liquids: two-sided, leave no depth
    MATERIAL_CUT_OUT = 1u << 1,     // alpha-tested
    MATERIAL_SKY = 1u << 2,
    MATERIAL_NORMAL_MAP = 1u << 3, // its vertices have tangents
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

#define SCENE_NONE UINT32_MAX // no zone, door, mover ...

typedef struct scene_mover { // item scene.item_count + its place in scene.movers; its geometry is its pose at rest
    const char *name;
    double open_offset[3];         // from shut to open, metres; already applied to the geometry when its door is open at rest
    double pivot[3];               // world: what it turns about
    double axes[9];                // rows, orthonormal: turn_deg is about the columns, which are x, y, z but in a turned include
    uint32_t first_key, key_count; // its path, in scene.keys, by time; 0: it stays
    uint32_t door;                 // that moves it, or SCENE_NONE
    uint32_t loops;                // 1: behind the last key comes the first; 0: it stays there
} scene_mover;
typedef struct scene_key { double time_s, offset[3], turn_deg[3]; } scene_key; // from rest; turned about x, then y, then z

// Where a mover is: world' = rotation (world at rest - pivot) + pivot + offset. rotation: rows, orthonormal.
typedef struct scene_pose { double rotation[9], pivot[3], offset[3]; } scene_pose;

typedef enum door_state { DOORS_OPEN, DOORS_SHUT } door_state;
typedef struct scene_door {
    const char *name;
    door_state at_rest; // as the geometry of its mover stands
    uint32_t mover;     // or SCENE_NONE: nothing to see
} scene_door;

// A convex body, world: inside where normal . p <= distance for its planes. A zone is the union of its hulls, less the
// inside of the zones that lie in it. An item touches a hull from 1 step outside of it on, and is held 2 steps inside.
typedef struct scene_hull {
    uint32_t zone, first_plane, plane_count; // in scene.hull_planes
    double min[3], max[3];
} scene_hull;

enum { // scene_zone.flags
    ZONE_EVERYWHERE = 1u << 0, // no hulls: all that no other zone takes (the outside, or the one zone of a plain scene)
    ZONE_STRAY = 1u << 1,      // made up for items that no zone touches: looked at in every view, joined to nothing
};
typedef struct scene_zone {
    const char *name;
    const char *chain; // that its file names; NULL: none
    double origin[3];  // a multiple of 1 m
    uint32_t flags;
    uint32_t parent;                     // the zone that it lies in, or SCENE_NONE
    uint32_t first_hull, hull_count;     // in scene.hulls
    uint32_t first_item, item_count;     // in scene.zone_items: global ids of what never moves, ascending
    uint32_t first_portal, portal_count; // in scene.zone_portals: 2 * portal + side
} scene_zone;

typedef struct scene_portal {
    const char *name;
    uint32_t zones[2];                  // sides 0 and 1
    uint32_t first_point, point_count;  // in scene.portal_points, counterclockwise seen from zones[0]
    uint32_t door;                      // that closes it, or SCENE_NONE: always open
    double plane[4];                    // normal . p + offset, unit normal, positive in zones[0]
} scene_portal;

typedef enum light_kind { LIGHT_POINT, LIGHT_SUN } light_kind;
typedef struct scene_light {
    const char *name;
    light_kind kind;
    double position[3], direction[3], reach; // reach: metres, of a point light
    float colour[3];
} scene_light;

typedef struct scene_camera_path { const char *name; uint32_t first_camera, camera_count; } scene_camera_path;

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

// A culler's index of one zone, kept in a scene file: lent at build where all of its key agrees, see bake.h.
typedef struct scene_bake {
    const char *id, *version; // of the culler's descriptor
    uint64_t options_hash, zone_hash;
    const void *bytes;        // 64-byte aligned
    uint64_t size;
    uint32_t zone;
} scene_bake;

typedef struct scene_extent {
    double origin[3]; // a multiple of 1 m
    cull_box box;     // of everything, movers too, relative to the origin
    float radius;     // largest absolute coordinate, portals too
} scene_extent;

typedef struct scene {
    arena memory;
    const char *path;
    uint64_t hash; // XXH3 of the arrays below, the same for the same geometry
    scene_extent whole;
    double step; // metres: every coordinate relative to the origin is a multiple of it

    cull_vec3 *positions;       // position_count
    uint32_t *normals;          // 3 x snorm8 in the low bytes, 0: flat shading
    float *texcoords;           // 2 a vertex; NULL when no material needs them: no holes, no normal map
    // One for each vertex whose material has a normal map, in the vertices' order: scene_tangent_unpack. NULL: no such material.
    uint32_t *tangents;
    uint16_t *vertex_materials; // 1 a vertex
    uint32_t *indices;          // index_count, counterclockwise from the front
    uint32_t *polygon_first_triangle; // polygon_count + 1
    scene_item *items;          // item_count + mover_count
    cull_boxes boxes;           // of all of them, padded
    cull_wall *walls;           // item_count; NULL without walls
    uint32_t *wall_vertices;
    cull_plane *planes;
    cull_exact_plane *exact_planes;  // plane_count, in grid steps from the scene's origin; NULL: not compiled
    double grid_steps_per_metre;     // of exact_planes; 0 without them
    scene_material *materials;
    scene_object *objects;
    scene_mover *movers;
    scene_place *places;
    scene_solid *solids;
    scene_solid_plane *solid_planes;

    scene_zone *zones;
    scene_hull *hulls;               // of a zone together, zones in order
    scene_solid_plane *hull_planes;
    uint32_t *zone_items;            // zone_item_count
    uint8_t *listings;               // per item that never moves: zones that list it, at most 255
    scene_portal *portals;
    double (*portal_points)[3];      // world, on the scene's step
    uint32_t *zone_portals;          // 2 a portal
    scene_door *doors;
    scene_key *keys;
    scene_light *lights;
    scene_camera_path *paths;
    camera *cameras;                 // of all paths
    uint32_t zone_count, hull_count, hull_plane_count, zone_item_count, portal_count, portal_point_count;
    uint32_t door_count, key_count, light_count, path_count, camera_count;
    uint32_t stray_items;            // that no zone touched

    scene_bake *bakes;
    uint32_t bake_count;
    void *file;                      // of a scene file: the arrays lie in it; else NULL
    size_t file_bytes;

    uint32_t tangent_count;
    uint32_t position_count, index_count, polygon_count, item_count, mover_count;
    uint32_t wall_vertex_count, plane_count, material_count, object_count, place_count;
    uint32_t solid_count, solid_plane_count;
    uint32_t is_map; // the auto views start at its places
    uint32_t flat_triangles; // of zero area after rounding, counted, kept
} scene;

void scene_free(scene *s, const allocator *memory); // NULL is fine
double scene_radius_m(const scene *s);               // half the diagonal of the scene's box
// Takes away all that moves, doors' leaves too: the world alone, as other compilers' figures have it. Its doors stay, without leaves.
void scene_movers_drop(scene *s);
// Where the mover is at a time of its path, its door in that state.
void scene_pose_at(const scene *s, uint32_t mover, double time_s, door_state door, scene_pose *out);
// Holds the mover in that pose, world; for whole poses (no turn) as tight as the geometry.
void scene_pose_box(const scene *s, uint32_t mover, const scene_pose *pose, double min[3], double max[3]);
// A unit vector along u at a right angle to the normal, 10 bits a component from the lowest on, and in the top 2 bits which
// way round the texture lies: binormal = turn * cross(normal, tangent).
void scene_tangent_unpack(uint32_t packed, double tangent[3], int *turn);
// Largest of normal . p - distance over the planes of the hull: below 0 inside. A distance where it is a face that is near.
double scene_hull_height(const scene *s, uint32_t hull, const double p[3]);

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
    const cull_exact_plane *exact;     // walls: the same exactly, in steps of scene_builder_grid from the world's origin; NULL: none
} builder_item;

// [one thread] Functions below report nothing themselves but for out-of-memory in the result.
result scene_builder_open(const allocator *memory, scene_builder **out);
void scene_builder_close(scene_builder *b); // NULL is fine
result scene_builder_material(scene_builder *b, const char *name, size_t length, uint32_t flags, uint32_t *out); // found again by name
result scene_builder_material_colour(scene_builder *b, uint32_t material, uint32_t colour);
uint32_t scene_builder_material_count(const scene_builder *b);
const scene_material *scene_builder_material_at(const scene_builder *b, uint32_t material); // lent until the next one is added
void scene_builder_material_mark(scene_builder *b, uint32_t material); // it has a normal map; before scene_builder_finish
result scene_builder_object(scene_builder *b, const char *name, size_t length, uint32_t *out); // a new one each call
result scene_builder_vertices(scene_builder *b, const builder_vertex *vertices, size_t count, uint32_t material, uint32_t *out_first);
result scene_builder_item(scene_builder *b, const builder_item *item);        // static; RESULT_BAD_INPUT: an index is out of range
// The static item added last is listed in just these zones, not in each that its box touches: who traced it to its zone
// knows better. BAD_INPUT: no such zone, one twice, none, no item yet, or said twice of it.
result scene_builder_item_zones(scene_builder *b, const uint32_t *zones, uint32_t count);
result scene_builder_mover(scene_builder *b, const char *name, const double open_offset[3], const builder_item *item);
result scene_builder_place(scene_builder *b, const scene_place *place);
result scene_builder_solid(scene_builder *b, solid_kind kind, const scene_solid_plane *planes, uint32_t plane_count,
                           const double min[3], const double max[3]);
// Takes the body out of the structure's solids so far; they become convex pieces. Of an empty body: nothing.
result scene_builder_solid_subtract(scene_builder *b, const scene_solid_plane *planes, uint32_t plane_count);
// Steps a metre of the items' exact planes: a whole number above 0. Walls then share a plane where these are equal, number
// for number. The scene gets them where every wall has one, no transform is on and all fit 63 bits about its origin.
void scene_builder_grid(scene_builder *b, double steps_per_metre);
// From now on everything goes through this: world = matrix * p (rows of 3 x 4, a turn, one scale above 0, and a move).
typedef struct builder_transform { double rows[3][4]; } builder_transform;
result scene_builder_transform(scene_builder *b, const builder_transform *t); // BAD_INPUT: not such a matrix
void scene_builder_transform_end(scene_builder *b);                           // back to no transform

// ---- Zones. A builder without any makes one, "all", everywhere. ----
typedef struct builder_hull { const scene_solid_plane *planes; uint32_t plane_count; } builder_hull;
typedef struct builder_zone {
    const char *name, *chain;  // chain may be NULL
    const builder_hull *hulls; // none: everywhere
    uint32_t hull_count, parent;
} builder_zone;
typedef struct builder_portal {
    const char *name;
    const double (*points)[3];
    uint32_t point_count, zones[2], door;
    const double *normal; // towards zones[0]; NULL: found from the zones' hulls
} builder_portal;
typedef struct builder_path { const scene_key *keys; const double *pivot; uint32_t key_count, loops; } builder_path; // pivot NULL: its middle
// Functions that check give NULL or what is wrong, a constant text that goes on after "the portal "/"the zone ". In
// RESULT_BAD_INPUT cases *fault is that text.
result scene_builder_zone(scene_builder *b, const builder_zone *z, uint32_t *out, const char **fault);
result scene_builder_portal(scene_builder *b, const builder_portal *p, uint32_t *out, const char **fault);
// mover: the last mover added so far is `scene_builder_mover_count() - 1`; SCENE_NONE: none.
// BAD_INPUT: no such mover, it has a door, or shut or open it lies beyond 1e9 m.
result scene_builder_door(scene_builder *b, const char *name, door_state at_rest, uint32_t mover, uint32_t *out);
uint32_t scene_builder_mover_count(const scene_builder *b);
// BAD_INPUT: times don't rise, not finite, leads beyond 1e9 m.
result scene_builder_mover_path(scene_builder *b, uint32_t mover, const builder_path *p);
result scene_builder_light(scene_builder *b, const scene_light *l);
result scene_builder_camera_path(scene_builder *b, const char *name, const camera *cameras, uint32_t count);

void scene_builder_map(scene_builder *b); // the scene is a map: auto views start at its places
// ---- Copies and measures ----
// All that `from` collected once more, through b's transform. from: no transform, zones, portals, paths or lights of its own.
// BAD_INPUT: it has, or goes beyond what a scene holds; then b is only good to be closed.
result scene_builder_append(scene_builder *b, const scene_builder *from);
uint64_t scene_builder_size(const scene_builder *b); // the most of: triangles, vertices, objects, solids' planes, places
uint32_t scene_builder_item_count(const scene_builder *b); // movers too
typedef struct builder_bounds { double low[3], high[3]; size_t vertices_seen, portal_points_seen; } builder_bounds;
builder_bounds builder_bounds_none(void);
void builder_bounds_more(const scene_builder *b, builder_bounds *bounds); // takes in what came since the last time
// Metres that the point, through b's transform, lies outside of the zone's hulls; 0: inside, or the zone is everywhere.
double scene_builder_outside(const scene_builder *b, uint32_t zone, const double p[3]);

// Origin, rounding, boxes, hash. Refuses (with a line) a scene without polygons, too wide for 1 mm in float, or over
// 2^32 of anything.
result scene_builder_finish(scene_builder *b, const char *path, report *r, scene **out);

#endif
