// Scenes for tests of the tree, by seed.
// SPDX-License-Identifier: MIT
#ifndef TESTS_BSP_TREE_SCENES_H
#define TESTS_BSP_TREE_SCENES_H

#include "tree_fixture.h"

// A room with `boxes` boxes in it, all coordinates multiples of `unit` grid steps; boxes may cross each other. Not closed yet.
typedef struct box_scene { uint32_t boxes; int32_t unit, room; uint64_t seed; } box_scene; // room: half its width, in units
void scene_of_boxes(const box_scene *wish, hand_zone *out);
// Triangles and quads with any corners on the grid: they cross each other as they like.
void scene_of_polygons(uint32_t count, uint64_t seed, hand_zone *out);
// A column with `sides` walls that face outward, or inward: each plane has all others on one side.
void scene_of_column(uint32_t sides, hand_face faces, hand_zone *out);

// Builds, checks, and asserts that it went well.
void tree_of(const hand_zone *zone, bsp_wish wish, culler_host *host, bsp_tree *out);
void tree_end(culler_host *host, bsp_tree *tree); // frees and asserts that nothing is left
void assert_no_fault(const char *fault);

#endif
