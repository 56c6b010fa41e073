// Zones made by hand for tests: walls, clusters, portals, as a host would hand them to a culler.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_HAND_ZONE_H
#define PORTCULLIS_TESTS_HAND_ZONE_H

#include <portcullis/culler.h>

enum { HAND_MOST = 40000, HAND_PORTALS_MOST = 16, HAND_PORTAL_POINTS_MOST = 16 };
typedef struct hand_zone { // positions in float, planes in double rounded to float; exact ones only where a test sets them
    cull_zone zone;        // its counts hold all along, its arrays from hand_zone_end on
    cull_item *items;
    cull_wall *walls;
    cull_vec3 *positions;
    uint32_t *wall_vertices, *indices; // a fan a wall
    cull_plane *planes;
    cull_exact_plane *exact; // zeros, beside planes
    float *rows[6];
    cull_portal portals[HAND_PORTALS_MOST];
    cull_vec3 portal_points[HAND_PORTALS_MOST][HAND_PORTAL_POINTS_MOST];
    uint32_t items_most, vertices_most;
} hand_zone;
// All of these abort without memory and where there is no room.
void hand_zone_open(hand_zone *z, uint32_t items_most, uint32_t vertices_most);
void hand_zone_init(hand_zone *z); // for HAND_MOST items of 8 vertices
// A wall, counterclockwise from its front; a plane of its own, of normal 0 where it has no area. Returns the item.
uint32_t hand_zone_wall(hand_zone *z, const cull_vec3 *points, uint32_t count, uint32_t flags);
uint32_t hand_zone_cluster(hand_zone *z, cull_box box); // an item that is no wall
void hand_zone_portal(hand_zone *z, const cull_vec3 *points, uint32_t count);
typedef enum hand_face { FACE_IN, FACE_OUT } hand_face; // where the walls of a box show their front
void hand_zone_box(hand_zone *z, cull_box box, hand_face face, uint32_t flags);
void hand_zone_end(hand_zone *z); // arrays, box, radius
void hand_zone_free(hand_zone *z);

#endif
