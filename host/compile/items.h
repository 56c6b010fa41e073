// What the files of the last stage share: the builder that is filled, vertices rounded once, triangles of loops.
// SPDX-License-Identifier: MIT
// Invariant: a vertex of the mesh is rounded in one place, to the scene's own step; whoever uses it has the same point.
#ifndef PORTCULLIS_HOST_COMPILE_ITEMS_H
#define PORTCULLIS_HOST_COMPILE_ITEMS_H

#include "compile.h"
#include "brush_polygons.h"
#include "plane_polygon.h"
#include "plane_table.h"

#define ITEM_UNITS_PER_METRE 32.0 // of a map

typedef struct item_job {
    const compile_input *in;
    const compiled_zones *zones;
    const allocator *memory;
    report *report;
    scene_builder *builder;
    uint32_t *material_of; // of the input's, in the builder
    uint32_t *mover_of;    // by entity; SCENE_NONE
    uint32_t *door_of;     // by entity; SCENE_NONE
    brush_bodies bodies;   // of brush entities, from items_entities on
    buffer points, triangles, counts, loop; // builder_vertex, uint32_t (twice), uint32_t: of one item
} item_job;

// Unit normal and offset in metres, inside where dot + offset >= 0.
void item_plane(const item_job *j, plane_ref ref, double out[4]);
int item_exact_plane(const item_job *j, plane_ref ref, cull_exact_plane *out); // 0: over 63 bits
void item_texcoord(const compile_face *face, const double metres[3], float out[2]);
// 1 when the polygon's loop goes straight on at that place: the next vertex lies on the plane of the edge before, exactly.
int item_goes_straight(const item_job *j, const compile_polygon *p, uint32_t place);
const char *item_key(const compile_entity *e, const char *name); // the last one counts; NULL: it has none
int item_object_name(const item_job *j, uint32_t entity, char *out, size_t size); // its length

// Brush entities as items and movers, bodies, places, lights (items_entities.c).
result items_entities(item_job *j);
// Meshes of misc_model entities (items_models.c).
result items_models(item_job *j);
// The camera path "starts" of a map's player starts (items_starts.c).
result items_starts(item_job *j);
// Marks the builder's materials that worldspawn's "_normal_maps" lists; all are in it (items_normal_maps.c).
void items_normal_maps(item_job *j);
// Zones by hulls, portals with their doors; behind items_entities (items_zones.c).
result items_zones(item_job *j);
// Portals between automatic rooms, coplanar neighbours joined (items_joined.c).
result items_joined_portals(const item_job *j);

// ---- The doors that close a portal (items_doors.c) ----

typedef struct portal_piece_of_door { plane_polygon shape; uint32_t door; } portal_piece_of_door; // in portal_pieces.edges; door: or SCENE_NONE
typedef struct portal_pieces { buffer pieces, edges; } portal_pieces; // portal_piece_of_door, polygon_edge: of one portal
// The whole portal as one piece, or a piece for each leaf that hides its part, where leaves hide all of it. Both buffers are emptied before.
result portal_pieces_make(const item_job *j, const compiled_portal *portal, portal_pieces *out);

// ---- Vertices rounded to the step that the scene will have (items_round.c) ----

typedef struct rounded_mesh {
    const allocator *memory;
    int32_t (*points)[3];  // of the mesh's vertices, steps of the scene from its origin
    uint32_t *same_as;     // by vertex: the least vertex that is rounded to the same point
    uint32_t vertex_count;
} rounded_mesh;
// All vertices and portals are in the builder.
result rounded_mesh_make(const item_job *j, rounded_mesh *out);
void rounded_mesh_free(rounded_mesh *m); // of zeros is fine

// ---- Which zones list a wall (items_listing.c) ----

#define WALLS_SEVERAL (SCENE_NONE - 1)
typedef struct wall_lists {
    const item_job *job;
    const rounded_mesh *rounded;
    uint32_t *zone_of;    // by vertex: of its walls; SCENE_NONE: it has none, WALLS_SEVERAL
    buffer zones, joined; // of vertices with several, sorted; of portals' vertices, sorted
    buffer found;         // uint32_t: of one wall
} wall_lists;
result wall_lists_make(const item_job *j, const rounded_mesh *rounded, wall_lists *out);
void wall_lists_free(wall_lists *l); // of zeros is fine
result wall_lists_tell(wall_lists *l, uint32_t polygon); // of the item that was added last
// 1: each zone that it touches lists it: a liquid's surface is not cut where portals part it.
int item_zones_by_box(const item_job *j, uint32_t polygon);

// ---- Triangles of one loop (items_triangulate.c) ----

typedef struct loop_corner {
    uint32_t vertex;      // of the mesh, see rounded_mesh.same_as
    uint32_t place;       // in the polygon's loop
    uint32_t sides[2];    // of the convex polygon that it lies on: before and after; the same: inside of a side
    uint32_t before, after;
    double width;         // of its ear, square steps; at most 0: turned over or flat when rounded
} loop_corner;

typedef struct loop_triangulator {
    const item_job *job;
    const compile_mesh *mesh;
    const rounded_mesh *rounded;
    buffer corners; // loop_corner
    buffer counts;  // uint32_t: corners left on each side
} loop_triangulator;

loop_triangulator loop_triangulator_make(const item_job *j, const rounded_mesh *rounded);
void loop_triangulator_free(loop_triangulator *t);
// Places in the polygon's loop: its true corners, in order, to `loop`; three a triangle to `triangles`. Both are emptied before.
result loop_triangulate(loop_triangulator *t, const compile_polygon *p, buffer *loop, buffer *triangles);

// ---- Triangles that are flat when rounded (items_flat.c) ----

typedef struct wall_triangle {
    uint32_t vertices[3], corners[3]; // of the mesh; in the builder
    uint32_t polygon;                 // SCENE_NONE: gone
} wall_triangle;
// Of all walls. is_closed, by polygon: 1 where a triangle went to another polygon, which then closes it.
result items_mend_flat(item_job *j, const rounded_mesh *rounded, const uint32_t *first_vertex, buffer *walls, uint8_t *is_closed);

// ---- The checks (items_check.c): of the mesh and the scene, by other means than made them ----

typedef struct check_input {
    const item_job *job;
    const rounded_mesh *rounded;
    const uint32_t *triangles; // 3 vertices of the mesh each, of the polygons that are items, liquids left out
    size_t triangle_count;
    const uint8_t *is_item;    // by polygon of the mesh
} check_input;
// Of walls and brushes that move, in the finished scene; a mesh beside them may have such as its file has them.
uint32_t items_flat_triangles(const item_job *j, const scene *s);
result items_check(const check_input *c, compile_checks *out); // adds open edges, T-junctions, degenerate triangles

#endif
