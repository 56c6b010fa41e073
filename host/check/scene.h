// Zones made for checks, as a host lends them, and what the oracle keeps of them for itself.
// SPDX-License-Identifier: MIT
// Invariant: each array that is lent ends at a page that no one may touch (boxes behind their padding).
#ifndef PORTCULLIS_HOST_CHECK_SCENE_H
#define PORTCULLIS_HOST_CHECK_SCENE_H

#include "lender.h"
#include "run.h"

typedef enum scene_kind {
    SCENE_SPREAD, // boxes of all sizes in a cube
    SCENE_CITY,   // houses of one-sided walls on whole metres, with exact planes
    SCENE_ROOM,   // a closed room with pillars, see-through panes in it
    SCENE_MESH,   // clusters of small triangles over a ground
    SCENE_PANES,  // thousands of flat quads round the middle, none behind another
    SCENE_GRID,   // cubes side by side: the eye stands in their planes
    SCENE_TINY,   // things far below a pixel, alone and before walls
    SCENE_FLAT,   // points, lines, flat boxes, triangles without area, duplicates
    SCENE_FAR,    // the spread one, 1000 km from the origin
    SCENE_ONE,    // one item
    SCENE_EMPTY,
    SCENE_KINDS
} scene_kind;
const char *made_scene_name(scene_kind kind);

typedef struct scene_triangle { double p[3][3]; uint32_t item; } scene_triangle;

enum { SCENE_ARRAYS = 24, SCENE_PORTALS_MOST = 4 };
typedef struct made_scene {
    cull_zone zone;
    scene_kind kind;
    double size; // the eye stays within about this of the middle
    double middle[3];
    fence arrays[SCENE_ARRAYS];
    uint32_t array_count;
    // The oracle's own:
    scene_triangle *triangles;
    uint32_t triangle_count;
    cull_box *boxes;
    uint32_t *flags, *first_triangle; // item_count, item_count + 1
    uint64_t hash; // of all that is lent
} made_scene;

// Aborts without memory: the check then says so.
void made_scene_make(check_run *r, scene_kind kind, made_scene *out);
void made_scene_portals(check_run *r, made_scene *s); // a few in the planes of its box
void made_scene_free(made_scene *s);
uint64_t made_scene_hash(const made_scene *s); // other than s->hash: somebody wrote into it
void made_scene_protect(const made_scene *s);  // nobody may write into it any more

#endif
