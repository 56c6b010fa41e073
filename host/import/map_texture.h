// What a map's texture name says of a face, and the texture coordinates of its points.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_MAP_TEXTURE_H
#define PORTCULLIS_HOST_MAP_TEXTURE_H

#include "map_text.h"

typedef enum texture_kind {
    TEXTURE_WALL,
    TEXTURE_TOOL,    // clip, skip, hint, trigger, ...: makes no polygon
    TEXTURE_LIQUID,  // *name
    TEXTURE_CUT_OUT, // {name
    TEXTURE_SKY,     // sky*
} texture_kind;

texture_kind texture_kind_of(map_word texture); // letter case and folders before the name are ignored
uint32_t texture_material_flags(texture_kind kind); // MATERIAL_*

// s = dot(axes[0], p) + shift[0] and t alike, in texels; p in the map's units.
typedef struct texture_map {
    double axes[2][3], shift[2];
} texture_map;
// normal: of the face, outward, any length.
texture_map texture_map_of(const map_face *face, const double normal[3]);

#endif
