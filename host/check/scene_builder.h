// Items added one by one, then laid out as a host does.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_CHECK_SCENE_BUILDER_H
#define PORTCULLIS_HOST_CHECK_SCENE_BUILDER_H

#include "scene.h"

enum { BUILDER_ITEMS_MOST = 8192, BUILDER_POINTS_MOST = 65536 };
typedef struct scene_builder {
    cull_item items[BUILDER_ITEMS_MOST];
    cull_box boxes[BUILDER_ITEMS_MOST];
    cull_wall walls[BUILDER_ITEMS_MOST];
    cull_plane planes[BUILDER_ITEMS_MOST];
    cull_exact_plane exact[BUILDER_ITEMS_MOST];
    cull_vec3 positions[BUILDER_POINTS_MOST];
    uint32_t wall_vertices[BUILDER_POINTS_MOST], indices[3 * BUILDER_POINTS_MOST];
    uint32_t item_count, wall_count, position_count, wall_vertex_count, index_count;
    int is_exact; // walls stand on whole metres, along axes
} scene_builder;

scene_builder *builder_open(void);
// All of them leave out what there is no room for.
void builder_box(scene_builder *b, cull_box box);                                            // its surface is its box
void builder_wall(scene_builder *b, const cull_vec3 *points, uint32_t count, uint32_t flags); // counterclockwise from its front
void builder_triangles(scene_builder *b, const cull_vec3 *points, uint32_t triangles, uint32_t flags);
typedef enum builder_face { FACE_IN, FACE_OUT } builder_face; // where the walls of a box show their front
void builder_walls(scene_builder *b, cull_box box, builder_face face, uint32_t flags);
void builder_end(scene_builder *b, made_scene *out); // frees the builder

#endif
