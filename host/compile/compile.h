// The scene compiler's data: what its stages hand to each other. Brushes in, closed zones joined by portals out, as in the
// thesis restated in the design's sources (A1 to A10), every decision by an exact predicate on integer planes.
// SPDX-License-Identifier: MIT
// Invariant: coordinates are whole grid steps in scene axes (Y up), at most 2^24; a vertex is never a number but three
// planes that meet in it; nothing is rounded between the input and the scene.
#ifndef PORTCULLIS_HOST_COMPILE_H
#define PORTCULLIS_HOST_COMPILE_H

#include "../core/memory.h"
#include "../core/report.h"
#include "../core/scene.h"

#include <portcullis/exact.h>

enum { COMPILE_COORDINATE_BITS = 24 };

// ---- Planes: one table for everything; a reference is 2 * plane + flipped ----

typedef uint32_t plane_ref; // the side towards the normal (or against it, flipped) is the front
typedef struct plane_table plane_table; // see plane_table.h; canonical: normal and offset without a common divisor, first component that is not zero positive

// ---- Input (input.c ...): brushes on the grid, after plane and vertex weld ----

typedef enum brush_kind { BRUSH_ADD, BRUSH_SUBTRACT } brush_kind;
typedef enum brush_role {
    BRUSH_STRUCTURE, // worldspawn, func_group, func_detail*; sky too: solid
    BRUSH_LIQUID,    // open: its faces become see-through walls, nothing is cut
    BRUSH_ENTITY,    // of another brush entity, or of cut-outs alone: items or a mover, not structure
    BRUSH_PORTAL,    // zone_portal: its mid-plane of the thin axis
} brush_role;

typedef struct compile_face {
    plane_ref plane;         // front: outside the brush
    uint32_t material;       // in compile_input.materials; COMPILE_NOTHING: clip, skip, hint, trigger, origin: makes no polygon; such a side
                             // of a structure's brush has what most of its other, opaque ones have
    double texture[2][4];    // u, v = row . (x, y, z, 1), metres in scene axes
    uint32_t line;           // in the file, for messages
    uint32_t is_rounded;     // its points were not on the grid as written: the weld may lay its plane anew
} compile_face;
#define COMPILE_NOTHING UINT32_MAX

typedef struct compile_brush {
    uint32_t first_face, face_count, entity;
    brush_kind kind;
    brush_role role;
    int32_t min[3], max[3]; // grid steps, rounded outward
} compile_brush;

typedef struct compile_entity {
    const char *class_name, *name; // name: targetname, or NULL
    const char *const *keys;       // key, value, key, value ...
    uint32_t key_count;            // pairs
    uint32_t first_brush, brush_count;
    double origin[3];              // scene metres; of point entities
    uint32_t has_origin, line;
} compile_entity;

typedef struct compile_material { const char *name; uint32_t flags; } compile_material; // MATERIAL_*

typedef enum weld_kind { WELD_PLANE, WELD_POINT, WELD_CORNER, WELD_TURN } weld_kind;
typedef struct weld_change { // one face of one brush got another plane
    weld_kind kind;          // PLANE: shared with a near plane of another brush; POINT: two corners of the brush became one;
                             // CORNER: laid through a corner of another brush that it missed by a rounding
                             // TURN: the map was turned as a whole and rounded, see turned_frame.h; this is the plane before that
    uint32_t brush, line;    // line: of the face
    plane_ref from, to;
    double move;             // map units: the farthest that a corner of the brush went; TURN: that one of the face's written points
} weld_change;

typedef struct compile_view compile_view; // of a stage that ended, see stages.h
typedef struct compile_watch {
    void *user;
    void (*ended)(void *user, const compile_view *made);
} compile_watch;

typedef struct compile_input {
    arena memory;
    plane_table *planes;
    compile_brush *brushes;
    compile_face *faces;
    compile_entity *entities;
    compile_material *materials;
    uint32_t brush_count, face_count, entity_count, material_count;
    double steps_per_metre;        // grid * units per metre (32 for a map)
    uint32_t weld_moves;           // planes and points that the weld changed
    double max_move;               // the farthest, in map units; see weld_change.move
    weld_change *changes;          // weld_moves of them
    uint32_t points_rounded;       // face points that are not on the grid as written
    uint32_t brushes_dropped;      // empty ones and those of tool textures alone
    double max_rounding;           // map units: the farthest that the grid took a point of a JSON scene's primitive
    scene_builder *beside;         // what a JSON scene holds beside its brushes, owned; NULL: nothing. compile_items fills it up, so only once
    uint32_t *portal_doors;        // by entity: door in `beside` of its portal, or SCENE_NONE; NULL: none has
    const char *path;
    const compile_watch *watch;    // told of every stage behind this one; NULL, as it is made: nobody
} compile_input;

typedef struct input_options {
    double grid; // steps a unit, a whole number up to 65536; 0: 256
    double weld; // map units within which planes and corners are welded; 0: 1/32
} input_options;
// [any thread] o NULL: the defaults. text need not end in a zero. On failure one line is reported and *out stays untouched.
result compile_input_map(const char *path, const char *text, size_t size, const input_options *o, const allocator *memory, report *r, compile_input **out);
struct import_files; // of host/import/import.h; NULL: the disk
// The same of a JSON scene's brushes; all that stands beside them goes into `beside`.
result compile_input_json(const char *path, const char *text, size_t size, const input_options *o, const struct import_files *files,
                          const allocator *memory, report *r, compile_input **out);
// Reads the file, .map or .json by its ending.
result compile_input_open(const char *path, const input_options *o, const allocator *memory, report *r, compile_input **out);
void compile_input_free(compile_input *in); // NULL is fine

// ---- Relation table (relations.c) ----

typedef enum brush_relation { RELATION_APART, RELATION_TOUCHING, RELATION_CROSSING, RELATION_CONTAINS, RELATION_INSIDE } brush_relation;
typedef struct brush_pair { uint32_t a, b; brush_relation relation; } brush_pair; // a < b; relation of a to b; APART is not listed
typedef struct relation_table { brush_pair *pairs; uint32_t *first_of; uint32_t pair_count; } relation_table; // by a; first_of: brush_count + 1

// ---- Polygons (csg.c, weld.c, merge.c): of the structure's surface, front in the air ----

typedef struct compile_vertex {
    plane_ref planes[3]; // that meet in one point: the lexicographically least such triple of those known to pass through it
    double position[3];  // grid steps; within 2^-40 of its size of the exact point
} compile_vertex;

typedef struct compile_polygon {
    plane_ref plane;
    uint32_t first_vertex, vertex_count; // in compile_mesh.loop: a convex loop, counterclockwise from the front
    uint32_t material, brush, face;      // brush and face that made it
} compile_polygon;

typedef struct compile_mesh {
    arena memory;
    compile_vertex *vertices;
    uint32_t *loop;             // vertex numbers
    plane_ref *edge_planes;     // loop_count: a plane that holds the edge from loop[i] to the polygon's next vertex, not the
                                // polygon's own, its front outside the polygon (csg.c has them at hand; zones.c needs them). One point: one vertex
    compile_polygon *polygons;
    uint32_t vertex_count, loop_count, polygon_count;
} compile_mesh;

typedef struct csg_counts { uint32_t polygons_in, polygons_csg, polygons_merged; } csg_counts;
// relations .. merge: the stages in one call; each is a function of its own in its own file too.
result compile_csg(const compile_input *in, report *r, const allocator *memory, compile_mesh **out, csg_counts *counts);
void compile_mesh_free(compile_mesh *m); // NULL is fine

// ---- Portals and zones (portals.c, zones.c, islands.c): by edge tracing ----

typedef enum portal_choice { PORTALS_DOORS, PORTALS_NONE, PORTALS_AUTHORED, PORTALS_AUTO } portal_choice; // AUTO: doors, and rooms made
// When automatic rooms are apart enough.
typedef struct room_limits {
    uint32_t rooms;   // no more than these, but for what doors part; 0: what portals are worth decides, see rooms_merge.c
    uint32_t portals; // no more than these in all, as they stand in the scene: of rooms, of doors, and authored ones, which always stay
} room_limits;
typedef struct zone_options { portal_choice portals; room_limits rooms; } zone_options; // rooms: of PORTALS_AUTO
zone_options zone_options_of(portal_choice choice); // 100 portals

typedef struct compiled_portal {
    plane_ref plane;                     // front: zones[0]
    uint32_t first_vertex, vertex_count; // in zones' mesh.loop
    uint32_t zones[2], entity;           // entity that made it; COMPILE_NOTHING: between automatic rooms
} compiled_portal;

typedef struct compiled_zone {
    const char *name, *chain; // of a zone_info in it, or made from its number
    uint32_t entity_count;    // point entities that stand in it; 0: sealed
    uint32_t is_outside;      // of the leak: everything
} compiled_zone;

typedef struct compiled_zones {
    arena memory;
    compile_mesh *mesh;        // cut by portals, T-junctions repaired: loops hold every vertex that lies on them
    uint32_t *polygon_zone;    // mesh.polygon_count
    uint32_t (*seal_zones)[2]; // mesh.polygon_count: zones in front of a liquid that seals and behind it, UINT32_MAX: the void; both so of all else
    compiled_zone *zones;
    compiled_portal *portals;
    uint32_t zone_count, zones_sealed, portal_count, shells, leak, t_junctions_inserted;
    double (*leak_line)[3];    // from an entity to the void, scene metres
    uint32_t leak_line_count;
} compiled_zones;

result compile_zones_with(const compile_input *in, compile_mesh *mesh, const zone_options *options, report *r, const allocator *memory, compiled_zones **out); // takes the mesh
result compile_zones(const compile_input *in, compile_mesh *mesh, portal_choice choice, report *r, const allocator *memory, compiled_zones **out); // takes the mesh
void compiled_zones_free(compiled_zones *z); // NULL is fine

// ---- Items (items.c): triangulated, into a builder, and from there a scene ----

typedef struct compile_checks { uint32_t triangles, t_junctions_left, open_edges, degenerate_triangles, items; } compile_checks;
result compile_items(const compile_input *in, const compiled_zones *z, report *r, const allocator *memory, scene **out, compile_checks *checks);

#endif
