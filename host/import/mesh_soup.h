// What a mesh file says, as it says it: positions, polygons, groups, materials. Every mesh reader fills one of these.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMPORT_MESH_SOUP_H
#define PORTCULLIS_IMPORT_MESH_SOUP_H

#include "reader.h"

enum { POLYGON_CORNERS_MOST = 65535 };
#define SOUP_NO_TEXCOORD UINT32_MAX

typedef struct soup_corner { uint32_t position, texcoord; } soup_corner;
typedef struct soup_polygon { uint32_t first_corner, corner_count, material; } soup_polygon;
typedef struct soup_name { const char *text; size_t length; } soup_name; // in the file's bytes, or constant
typedef struct soup_object { // its polygons: first_polygon up to the next one's
    soup_name name;
    uint32_t first_polygon;
} soup_object;

// The largest index that a file used of one kind, and where: ranges are known at the end only.
typedef struct soup_largest {
    uint64_t index; // from 0
    size_t line;
    int is_used;
} soup_largest;

typedef struct mesh_soup {
    buffer positions; // 3 doubles
    buffer texcoords; // 2 floats
    buffer corners;   // soup_corner
    buffer polygons;  // soup_polygon
    buffer objects;   // soup_object, the first with first_polygon 0
    buffer materials; // soup_name; 0 is "default"
} mesh_soup;

mesh_soup soup_make(const allocator *memory);
void soup_free(mesh_soup *s);
void soup_use(soup_largest *l, uint64_t index, size_t line);
// The polygon of the corners from first_corner on. RESULT_BAD_INPUT, unreported, when there are over 2^32 of anything.
result soup_polygon_end(mesh_soup *s, size_t first_corner, uint32_t material);
soup_name soup_file_stem(const char *path); // "dir/bunny.obj": "bunny"

// Drops polygons without area, repairs, triangulates, clusters, adds to the job's builder; reports everything. Indices must
// be in range.
result mesh_scene_into(const mesh_soup *soup, const reader_job *j);

#endif
