// What a ray meets first: every triangle of a scene in a tree of boxes, in double, with no culler's help.
// SPDX-License-Identifier: MIT
// Invariant: an answer is given only where it is sure. A ray that passes an edge of a triangle within GRAZING of its way there, or within
// the rounding of positions to float, GRAZES from there on, and nothing behind that place is said to be seen: through the cracks
// between rounded polygons rays see what no picture shows.
#ifndef PORTCULLIS_TESTS_CLAIMS_TEST_RAYS_ORACLE_H
#define PORTCULLIS_TESTS_CLAIMS_TEST_RAYS_ORACLE_H

#include "host/core/scene.h"

#define RAYS_GRAZING (1.0 / 1048576)  // of the distance: the same share by which the host widens boxes
#define RAYS_ROUNDING (1.0 / 4194304) // of the largest coordinate: 4 roundings to float's 2^-24
#define RAYS_START_M (1.0 / 1024)     // what is nearer than that to the eye is not looked at

enum { RAYS_BOTH_SIDES, RAYS_FRONTS, RAYS_FIXED, RAYS_SIDES }; // FRONTS: one-sided walls hide and are seen from their front only; FIXED: no movers

typedef struct ray_oracle ray_oracle;
typedef struct ray {
    double from[3], along[3];
} ray; // world; along: a unit vector
typedef enum ray_end { RAY_ESCAPES, RAY_HITS, RAY_GRAZES } ray_end;
typedef struct ray_hit {
    ray_end end;
    uint32_t item;    // global id; movers behind the items
    uint32_t is_back; // 1: of an opaque face; among closed bodies the ray then started inside one
    double distance;
    uint32_t enters; // 1: nearer than RAYS_START_M, where nothing else is looked at, it goes in through the front of an opaque face
    uint32_t veil;   // an item that hides nothing, surely met before; SCENE_NONE: none
} ray_hit;

// Movers as at time 0 with doors open. Copies what it needs of the scene.
ray_oracle *ray_oracle_open(const scene *s);
void ray_oracle_close(ray_oracle *o);
void ray_oracle_cast(const ray_oracle *o, const ray *r, ray_hit out[RAYS_SIDES]);

#endif
