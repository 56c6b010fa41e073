// The header of a .ply file: format, elements and their properties.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMPORT_MESH_PLY_H
#define PORTCULLIS_IMPORT_MESH_PLY_H

#include "../core/memory.h"
#include "mesh_text.h"

typedef enum ply_format { PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN } ply_format;
typedef enum ply_type { PLY_INT8, PLY_UINT8, PLY_INT16, PLY_UINT16, PLY_INT32, PLY_UINT32, PLY_FLOAT32, PLY_FLOAT64 } ply_type;
typedef enum ply_role { PLY_SKIPPED, PLY_X, PLY_Y, PLY_Z, PLY_CORNERS } ply_role;

typedef struct ply_property {
    ply_role role;
    ply_type type; // of a list: of its items
    ply_type count_type;
    int is_list;
} ply_property;

typedef enum ply_element_kind { PLY_OTHER, PLY_VERTEX, PLY_FACE } ply_element_kind;
typedef struct ply_element {
    ply_element_kind kind;
    uint32_t first_property, property_count;
    uint64_t count;
} ply_element;

typedef struct ply_header {
    ply_format format;
    buffer elements;   // ply_element
    buffer properties; // ply_property
} ply_header;

static inline int ply_type_is_integer(ply_type type)
{
    return type < PLY_FLOAT32;
}

// Reads up to the data; t stands on its first byte. Free the two buffers whatever comes back.
result ply_header_read(mesh_text *t, ply_header *h);

#endif
