// A map's text turned, moved and reordered into another text, so that what compiles it reads a real file.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_MAP_REWRITE_H
#define PORTCULLIS_TESTS_MAP_REWRITE_H

#include <stddef.h>
#include <stdint.h>

typedef enum rewrite_points {
    POINTS_SCALED,  // p -> turn p + move, `scale` times as large and whole where the map was
    POINTS_ROUNDED, // p -> turn p / scale + move, as large as before, rounded to 1/256
} rewrite_points;

enum { SHUFFLE_BRUSHES = 1, SHUFFLE_FACES = 2, SHUFFLE_ENTITIES = 4 }; // entities: all but the world

typedef struct map_rewrite { // in the map's axes and units
    const char *name;
    int turn[3][3], scale; // turn is `scale` times a rotation or mirror
    int move[3];
    unsigned shuffle;
    rewrite_points points;
} map_rewrite;

map_rewrite rewrite_scaled(int scale);     // by 5 or 25: what a slanted turn is compared with
map_rewrite rewrite_turned(int number);    // 0 to 47: the 24 rotations by axes, then the mirrored ones
enum { SLANTED_TURNS = 4 };
map_rewrite rewrite_slanted(int number);   // 3-4-5 about each axis, then the quaternion (1, 2, 2, 4) over 25
int rewrite_is_mirrored(const map_rewrite *r);

// All faces come out as Valve 220 with axes that turn along; a door's angle turns where it can be said. The caller frees it.
char *map_rewritten(const char *text, size_t size, const map_rewrite *r, size_t *out_size);

#endif
