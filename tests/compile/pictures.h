// Pictures of materials of two scenes that must show the same: a map's raw brushes and what was compiled from them.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_COMPILE_PICTURES_H
#define PORTCULLIS_TESTS_COMPILE_PICTURES_H

#include "host/core/scene.h"
#include "host/import/views.h"
#include "host/render/render.h"

enum { PICTURE_WIDTH = 640, PICTURE_HEIGHT = 360, PICTURE_PIXELS = PICTURE_WIDTH * PICTURE_HEIGHT };

// Liquids are no part of a picture of owners, so each view is drawn twice: without them, and with them as walls.
typedef enum picture_liquids { LIQUIDS_LEFT_OUT, LIQUIDS_AS_WALLS } picture_liquids;

typedef struct picture {
    uint32_t triangles[PICTURE_PIXELS]; // global triangle + 1, 0: nothing
    float depths[PICTURE_PIXELS];       // reversed z
} picture;

typedef struct picture_counts {
    uint64_t pixels, differing; // by material's name
    uint64_t coplanar;          // of those: depths agree to 2^-20
    uint64_t wrong;             // of a sample of the coplanar: the raw scene has no face of that material there
    uint64_t holes;             // not among them: would differ, but are seen through a face that makes nothing
} picture_counts;

typedef struct picture_pair { // reads one scene's material numbers as the other's
    const scene *scenes[2];
    uint32_t *material_names[2]; // by material: the same number for the same name in both
} picture_pair;

typedef enum pixel_verdict { PIXEL_SAME, PIXEL_COPLANAR, PIXEL_BAD } pixel_verdict;
typedef struct pixel_place { uint32_t triangle, pixel; } pixel_place; // global triangle

result picture_pair_open(const scene *raw, const scene *compiled, picture_pair *out); // RESULT_NO_MEMORY
void picture_pair_free(picture_pair *p);
uint32_t picture_material(const scene *s, uint32_t triangle); // of the global triangle
pixel_verdict picture_pixel(const picture_pair *p, const camera *c, const picture *raw, const picture *compiled, uint32_t pixel);

// A copy that shares all but materials and items, its liquids walls that are seen from both sides. To be freed with
// scene_opaque_free before the scene itself.
result scene_opaque_make(const scene *s, scene *out);
void scene_opaque_free(scene *s);

// World point of the pixel's middle on the plane of the triangle, metres. 0: it is seen edge on.
int picture_point(const scene *s, const pixel_place *at, const camera *c, double out[3], double *distance);
// Whether the raw scene has a face of the compiled one's material in that place too: then the two may well differ.
int picture_has_both(const picture_pair *p, const camera *c, const pixel_place *compiled);

#endif
