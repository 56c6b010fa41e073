// The scene file, .pcs: one blob without pointers, little endian. A header, a table of sections, and the sections, each a
// flat array at the next multiple of 64 bytes, all of them in the order of the list below, the gaps zero.
// SPDX-License-Identifier: MIT
// Invariant: the counts alone fix every offset, so one scene has one file, the same bytes from every compiler. Any change
// of a record or of the list is a new version, and a version that is not known is refused.
#ifndef PORTCULLIS_IMPORT_PCS_H
#define PORTCULLIS_IMPORT_PCS_H

#include "../core/scene.h"

enum { PCS_VERSION = 2, PCS_ALIGN = 64 };
#define PCS_MAGIC "\x89PCS\r\n\x1a\n" // a copy as text, or of 7 bits, changes it
#define PCS_BYTES_MOST (UINT64_C(1) << 40)

typedef struct pcs_header {
    uint8_t magic[8];
    uint32_t version, section_count;
    uint64_t file_bytes;
    uint64_t hash; // of all bytes: pcs_hash
    uint64_t reserved[4];
} pcs_header;
typedef struct pcs_section {
    uint32_t id, item_bytes; // place in the list, size of one item
    uint64_t offset, count;
    uint64_t reserved;
} pcs_section;

// ---- Records: of what has names or padding in memory; names are places in PCS_TEXT, PCS_NO_TEXT where there is none ----

#define PCS_NO_TEXT UINT32_MAX
typedef struct pcs_scene {
    uint64_t hash;
    double step, grid_steps_per_metre, origin[3];
    float box[6], radius; // min, max
    uint32_t is_map, flat_triangles, stray_items;
} pcs_scene;
typedef struct pcs_material { uint32_t name, flags, colour; } pcs_material;
typedef struct pcs_object { uint32_t name, first_item, item_count; } pcs_object;
typedef struct pcs_mover {
    double open_offset[3], pivot[3], axes[9];
    uint32_t name, first_key, key_count, door, loops, reserved;
} pcs_mover;
typedef struct pcs_place { double position[3]; uint32_t kind, reserved; } pcs_place;
typedef struct pcs_solid { double min[3], max[3]; uint32_t first_plane, plane_count, kind, reserved; } pcs_solid;
typedef struct pcs_zone {
    double origin[3];
    uint32_t name, chain, flags, parent, first_hull, hull_count, first_item, item_count, first_portal, portal_count;
} pcs_zone;
typedef struct pcs_hull { double min[3], max[3]; uint32_t zone, first_plane, plane_count, reserved; } pcs_hull;
typedef struct pcs_portal { double plane[4]; uint32_t name, zones[2], first_point, point_count, door; } pcs_portal;
typedef struct pcs_door { uint32_t name, at_rest, mover; } pcs_door;
typedef struct pcs_light { double position[3], direction[3], reach; float colour[3]; uint32_t name, kind, reserved; } pcs_light;
typedef struct pcs_path { uint32_t name, first_camera, camera_count; } pcs_path;
typedef struct pcs_bake {
    uint64_t offset, size; // in PCS_BLOBS, a multiple of 64
    uint64_t options_hash, zone_hash;
    uint32_t zone, id, version, reserved;
} pcs_bake;
typedef struct pcs_point { double at[3]; } pcs_point;

// ---- The list: name, item, its size in bytes. Items other than pcs_* are used where they lie. ----

#define PCS_SECTIONS(X)                                                                                                       \
    X(SCENE, pcs_scene, 88)                                                                                                   \
    X(TEXT, char, 1)                                                                                                          \
    X(MATERIALS, pcs_material, 12)                                                                                            \
    X(OBJECTS, pcs_object, 12)                                                                                                \
    X(POSITIONS, cull_vec3, 12)                                                                                               \
    X(NORMALS, uint32_t, 4)                                                                                                   \
    X(TEXCOORDS, float, 4)                                                                                                    \
    X(TANGENTS, uint32_t, 4)                                                                                                  \
    X(VERTEX_MATERIALS, uint16_t, 2)                                                                                          \
    X(INDICES, uint32_t, 4)                                                                                                   \
    X(POLYGON_FIRST_TRIANGLE, uint32_t, 4)                                                                                    \
    X(ITEMS, scene_item, 28)                                                                                                  \
    X(MIN_X, float, 4)                                                                                                        \
    X(MIN_Y, float, 4)                                                                                                        \
    X(MIN_Z, float, 4)                                                                                                        \
    X(MAX_X, float, 4)                                                                                                        \
    X(MAX_Y, float, 4)                                                                                                        \
    X(MAX_Z, float, 4)                                                                                                        \
    X(WALLS, cull_wall, 16)                                                                                                   \
    X(WALL_VERTICES, uint32_t, 4)                                                                                             \
    X(PLANES, cull_plane, 16)                                                                                                 \
    X(EXACT_PLANES, cull_exact_plane, 32)                                                                                     \
    X(MOVERS, pcs_mover, 144)                                                                                                 \
    X(KEYS, scene_key, 56)                                                                                                    \
    X(PLACES, pcs_place, 32)                                                                                                  \
    X(SOLIDS, pcs_solid, 64)                                                                                                  \
    X(SOLID_PLANES, scene_solid_plane, 32)                                                                                    \
    X(ZONES, pcs_zone, 64)                                                                                                    \
    X(HULLS, pcs_hull, 64)                                                                                                    \
    X(HULL_PLANES, scene_solid_plane, 32)                                                                                     \
    X(ZONE_ITEMS, uint32_t, 4)                                                                                                \
    X(LISTINGS, uint8_t, 1)                                                                                                   \
    X(PORTALS, pcs_portal, 56)                                                                                                \
    X(PORTAL_POINTS, pcs_point, 24)                                                                                           \
    X(ZONE_PORTALS, uint32_t, 4)                                                                                              \
    X(DOORS, pcs_door, 12)                                                                                                    \
    X(LIGHTS, pcs_light, 80)                                                                                                  \
    X(PATHS, pcs_path, 12)                                                                                                    \
    X(CAMERAS, camera, 104)                                                                                                   \
    X(BAKES, pcs_bake, 48)                                                                                                    \
    X(BLOBS, char, 1)

typedef enum pcs_id {
#define PCS_ID(name, item, bytes) PCS_##name,
    PCS_SECTIONS(PCS_ID)
#undef PCS_ID
        PCS_SECTION_COUNT
} pcs_id;

// Items of the section; for the six of the boxes CULL_PADDING zeros come behind those of the scene.
typedef struct pcs_counts { uint64_t of[PCS_SECTION_COUNT]; } pcs_counts;

extern const uint32_t pcs_item_bytes[PCS_SECTION_COUNT];
extern const char *const pcs_section_names[PCS_SECTION_COUNT];
// Where the sections lie; returns the file's size, or 0: over PCS_BYTES_MOST or what this machine can address.
uint64_t pcs_lay_out(const pcs_counts *counts, uint64_t offsets[PCS_SECTION_COUNT]);
uint64_t pcs_hash(const void *file, uint64_t size); // XXH3 of everything, the field `hash` taken as 0

// [any thread] The bytes are copied. Any bytes whatever: a clear line or a scene that keeps every promise of scene.h.
result pcs_open(const char *path, const void *bytes, size_t size, const allocator *memory, report *r, scene **out);
// The whole file in one read, then used in place. It is not mapped: a file that is cut or written over while it is in
// use would undo the checks, or end the program.
result pcs_load(const char *path, const allocator *memory, report *r, scene **out);
// Checks all that scene.h promises of a scene; *fault: NULL, or what is wrong. RESULT_NO_MEMORY: not checked.
result pcs_check(const scene *s, const allocator *memory, const char **fault);

#endif
