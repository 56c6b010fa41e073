// The plugin ABI, number 1, on LP64: the size and alignment of each struct, the place and size of each field, each enumerator.
// Written by freeze.py. Invariant: no line of it changes while CULL_ABI is 1; new extensions add lines.
// SPDX-License-Identifier: MIT
#include <portcullis/culler.h>

#if defined(__cplusplus)
#define HOLDS(condition, name) static_assert(condition, name)
#define ALIGN(type) alignof(type)
#else
#define HOLDS(condition, name) _Static_assert(condition, name)
#define ALIGN(type) _Alignof(type)
#endif
#define SIZE(type, bytes, align) HOLDS(sizeof(type) == (bytes) && ALIGN(type) == (align), "size of " #type)
#define AT(type, field, place, bytes) HOLDS(offsetof(type, field) == (place) && sizeof(((type *)0)->field) == (bytes), #type "." #field)
#define VALUE(name, number) HOLDS((name) == (number), #name)

#if defined(__LP64__)
SIZE(cull_result, 4, 4);
SIZE(cull_log_level, 4, 4);
SIZE(cull_purpose, 4, 4);
SIZE(cull_progress, 4, 4);
SIZE(cull_crossing, 4, 4);
SIZE(cull_promises, 4, 4);
SIZE(cull_figure_sort, 4, 4);
SIZE(cull_depth_order, 4, 4);

SIZE(cull_vec3, 12, 4);
AT(cull_vec3, x, 0, 4);
AT(cull_vec3, y, 4, 4);
AT(cull_vec3, z, 8, 4);

SIZE(cull_box, 24, 4);
AT(cull_box, min, 0, 12);
AT(cull_box, max, 12, 12);

SIZE(cull_plane, 16, 4);
AT(cull_plane, normal, 0, 12);
AT(cull_plane, offset, 12, 4);

SIZE(cull_run, 8, 4);
AT(cull_run, first, 0, 4);
AT(cull_run, count, 4, 4);

SIZE(cull_item, 24, 4);
AT(cull_item, first_index, 0, 4);
AT(cull_item, index_count, 4, 4);
AT(cull_item, polygon_count, 8, 4);
AT(cull_item, material, 12, 4);
AT(cull_item, flags, 16, 4);
AT(cull_item, reserved, 20, 4);

SIZE(cull_boxes, 48, 8);
AT(cull_boxes, min_x, 0, 8);
AT(cull_boxes, min_y, 8, 8);
AT(cull_boxes, min_z, 16, 8);
AT(cull_boxes, max_x, 24, 8);
AT(cull_boxes, max_y, 32, 8);
AT(cull_boxes, max_z, 40, 8);

SIZE(cull_wall, 16, 4);
AT(cull_wall, first_vertex, 0, 4);
AT(cull_wall, vertex_count, 4, 4);
AT(cull_wall, plane, 8, 4);
AT(cull_wall, reserved, 12, 4);

SIZE(cull_exact_plane, 32, 8);
AT(cull_exact_plane, normal, 0, 24);
AT(cull_exact_plane, offset, 24, 8);

SIZE(cull_portal, 32, 8);
AT(cull_portal, points, 0, 8);
AT(cull_portal, plane, 8, 16);
AT(cull_portal, point_count, 24, 4);
AT(cull_portal, reserved, 28, 4);

SIZE(cull_zone, 176, 8);
AT(cull_zone, items, 0, 8);
AT(cull_zone, boxes, 8, 48);
AT(cull_zone, positions, 56, 8);
AT(cull_zone, indices, 64, 8);
AT(cull_zone, walls, 72, 8);
AT(cull_zone, wall_vertices, 80, 8);
AT(cull_zone, planes, 88, 8);
AT(cull_zone, exact_planes, 96, 8);
AT(cull_zone, portals, 104, 8);
AT(cull_zone, grid_steps_per_metre, 112, 8);
AT(cull_zone, box, 120, 24);
AT(cull_zone, radius, 144, 4);
AT(cull_zone, item_count, 148, 4);
AT(cull_zone, position_count, 152, 4);
AT(cull_zone, index_count, 156, 4);
AT(cull_zone, wall_vertex_count, 160, 4);
AT(cull_zone, plane_count, 164, 4);
AT(cull_zone, portal_count, 168, 4);
AT(cull_zone, mover_capacity, 172, 4);

SIZE(cull_node, 48, 4);
AT(cull_node, box, 0, 24);
AT(cull_node, first_child, 24, 4);
AT(cull_node, child_count, 28, 4);
AT(cull_node, first_item, 32, 4);
AT(cull_node, item_count, 36, 4);
AT(cull_node, subtree, 40, 8);

SIZE(cull_hierarchy, 32, 8);
AT(cull_hierarchy, nodes, 0, 8);
AT(cull_hierarchy, items, 8, 8);
AT(cull_hierarchy, node_count, 16, 4);
AT(cull_hierarchy, item_count, 20, 4);
AT(cull_hierarchy, depth, 24, 4);
AT(cull_hierarchy, reserved, 28, 4);

SIZE(cull_view, 184, 8);
AT(cull_view, eye_exact, 0, 32);
AT(cull_view, forward, 32, 24);
AT(cull_view, pixel_tangent, 56, 8);
AT(cull_view, reach, 64, 8);
AT(cull_view, eye, 72, 16);
AT(cull_view, clip_from_zone, 88, 64);
AT(cull_view, pixels_per_tangent, 152, 4);
AT(cull_view, near_distance, 156, 4);
AT(cull_view, width_px, 160, 4);
AT(cull_view, height_px, 164, 4);
AT(cull_view, purpose, 168, 4);
AT(cull_view, frame, 172, 4);
AT(cull_view, flags, 176, 4);
AT(cull_view, reserved, 180, 4);

SIZE(cull_volume, 16, 8);
AT(cull_volume, planes, 0, 8);
AT(cull_volume, plane_count, 8, 4);
AT(cull_volume, entry, 12, 4);

SIZE(cull_mover, 32, 4);
AT(cull_mover, box, 0, 24);
AT(cull_mover, id, 24, 4);
AT(cull_mover, reserved, 28, 4);

SIZE(cull_answer, 12, 4);
AT(cull_answer, tag, 0, 4);
AT(cull_answer, pixels, 4, 4);
AT(cull_answer, age, 8, 4);

SIZE(cull_visit, 120, 8);
AT(cull_visit, view, 0, 8);
AT(cull_visit, volumes, 8, 8);
AT(cull_visit, candidates, 16, 8);
AT(cull_visit, pictures, 24, 8);
AT(cull_visit, captures, 32, 8);
AT(cull_visit, movers, 40, 8);
AT(cull_visit, answers, 48, 8);
AT(cull_visit, clipped, 56, 8);
AT(cull_visit, slots, 64, 8);
AT(cull_visit, scratch, 72, 8);
AT(cull_visit, volume_count, 80, 4);
AT(cull_visit, candidate_count, 84, 4);
AT(cull_visit, picture_count, 88, 4);
AT(cull_visit, capture_count, 92, 4);
AT(cull_visit, mover_count, 96, 4);
AT(cull_visit, answer_count, 100, 4);
AT(cull_visit, clipped_count, 104, 4);
AT(cull_visit, step, 108, 4);
AT(cull_visit, may_step, 112, 4);
AT(cull_visit, reserved, 116, 4);

SIZE(cull_test, 32, 4);
AT(cull_test, box, 0, 24);
AT(cull_test, tag, 24, 4);
AT(cull_test, reserved, 28, 4);

SIZE(cull_capture, 192, 8);
AT(cull_capture, runs, 0, 8);
AT(cull_capture, slots, 8, 8);
AT(cull_capture, clip_planes, 16, 64);
AT(cull_capture, box, 80, 24);
AT(cull_capture, corner, 104, 12);
AT(cull_capture, right, 116, 12);
AT(cull_capture, up, 128, 12);
AT(cull_capture, run_count, 140, 4);
AT(cull_capture, slot_count, 144, 4);
AT(cull_capture, clip_plane_count, 148, 4);
AT(cull_capture, slot, 152, 4);
AT(cull_capture, width_px, 156, 4);
AT(cull_capture, height_px, 160, 4);
AT(cull_capture, keep_depth, 164, 4);
AT(cull_capture, eye, 168, 12);
AT(cull_capture, eye_is_said, 180, 4);
AT(cull_capture, detail_m, 184, 4);
AT(cull_capture, reserved, 188, 4);

SIZE(cull_picture, 88, 8);
AT(cull_picture, runs, 0, 8);
AT(cull_picture, box, 8, 24);
AT(cull_picture, run_count, 32, 4);
AT(cull_picture, slot, 36, 4);
AT(cull_picture, error_px, 40, 4);
AT(cull_picture, place_is_said, 44, 4);
AT(cull_picture, corner, 48, 12);
AT(cull_picture, right, 60, 12);
AT(cull_picture, up, 72, 12);
AT(cull_picture, reserved, 84, 4);

SIZE(cull_clipped, 104, 8);
AT(cull_clipped, runs, 0, 8);
AT(cull_clipped, box, 8, 24);
AT(cull_clipped, planes, 32, 64);
AT(cull_clipped, run_count, 96, 4);
AT(cull_clipped, plane_count, 100, 4);

SIZE(cull_batch, 96, 8);
AT(cull_batch, runs, 0, 8);
AT(cull_batch, pictures, 8, 8);
AT(cull_batch, tests, 16, 8);
AT(cull_batch, captures, 24, 8);
AT(cull_batch, keep_pictures, 32, 8);
AT(cull_batch, keep_captures, 40, 8);
AT(cull_batch, run_count, 48, 4);
AT(cull_batch, picture_count, 52, 4);
AT(cull_batch, test_count, 56, 4);
AT(cull_batch, capture_count, 60, 4);
AT(cull_batch, nodes_visited, 64, 4);
AT(cull_batch, limits_hit, 68, 4);
AT(cull_batch, clipped, 72, 8);
AT(cull_batch, keep_clipped, 80, 8);
AT(cull_batch, clipped_count, 88, 4);
AT(cull_batch, reserved, 92, 4);

SIZE(cull_host, 56, 8);
AT(cull_host, abi, 0, 4);
AT(cull_host, reserved, 4, 4);
AT(cull_host, user, 8, 8);
AT(cull_host, alloc, 16, 8);
AT(cull_host, free, 24, 8);
AT(cull_host, log, 32, 8);
AT(cull_host, parallel_for, 40, 8);
AT(cull_host, get_extension, 48, 8);

SIZE(cull_built, 72, 8);
AT(cull_built, order, 0, 8);
AT(cull_built, scratch_size, 8, 8);
AT(cull_built, index_bytes, 16, 8);
AT(cull_built, promises, 24, 4);
AT(cull_built, max_runs, 28, 4);
AT(cull_built, max_steps, 32, 4);
AT(cull_built, max_tests, 36, 4);
AT(cull_built, max_captures, 40, 4);
AT(cull_built, max_pictures, 44, 4);
AT(cull_built, slot_count, 48, 4);
AT(cull_built, walks_hierarchy, 52, 4);
AT(cull_built, takes_movers, 56, 4);
AT(cull_built, max_clipped, 60, 4);
AT(cull_built, reserved, 64, 8);

SIZE(cull_option, 32, 8);
AT(cull_option, key, 0, 8);
AT(cull_option, fallback, 8, 8);
AT(cull_option, sweep, 16, 8);
AT(cull_option, help, 24, 8);

SIZE(cull_descriptor, 40, 8);
AT(cull_descriptor, id, 0, 8);
AT(cull_descriptor, version, 8, 8);
AT(cull_descriptor, summary, 16, 8);
AT(cull_descriptor, options, 24, 8);
AT(cull_descriptor, option_count, 32, 4);
AT(cull_descriptor, may_promise, 36, 4);

SIZE(cull_plugin, 80, 8);
AT(cull_plugin, descriptor, 0, 8);
AT(cull_plugin, create, 8, 8);
AT(cull_plugin, destroy, 16, 8);
AT(cull_plugin, build, 24, 8);
AT(cull_plugin, open, 32, 8);
AT(cull_plugin, close, 40, 8);
AT(cull_plugin, select, 48, 8);
AT(cull_plugin, filter, 56, 8);
AT(cull_plugin, cross, 64, 8);
AT(cull_plugin, get_extension, 72, 8);

SIZE(cull_bake, 8, 8);
AT(cull_bake, save, 0, 8);

SIZE(cull_blob, 16, 8);
AT(cull_blob, bytes, 0, 8);
AT(cull_blob, size, 8, 8);

SIZE(cull_level, 16, 8);
AT(cull_level, away_m, 0, 8);
AT(cull_level, polygons, 8, 8);

SIZE(cull_costs, 136, 8);
AT(cull_costs, polygon_ns, 0, 8);
AT(cull_costs, pixel_ns, 8, 8);
AT(cull_costs, picture_ns, 16, 8);
AT(cull_costs, picture_pixel_ns, 24, 8);
AT(cull_costs, picture_depth_pixel_ns, 32, 8);
AT(cull_costs, capture_ns, 40, 8);
AT(cull_costs, capture_pixel_ns, 48, 8);
AT(cull_costs, frame_ns, 56, 8);
AT(cull_costs, picture_bytes, 64, 8);
AT(cull_costs, pixel_bytes, 72, 4);
AT(cull_costs, depth_pixel_bytes, 76, 4);
AT(cull_costs, is_measured, 80, 4);
AT(cull_costs, level_count, 84, 4);
AT(cull_costs, levels, 88, 48);

SIZE(cull_explain, 8, 8);
AT(cull_explain, item, 0, 8);

SIZE(cull_ray, 16, 8);
AT(cull_ray, segment, 0, 8);
AT(cull_ray, box, 8, 8);

SIZE(cull_figure, 24, 8);
AT(cull_figure, name, 0, 8);
AT(cull_figure, value, 8, 8);
AT(cull_figure, sort, 16, 4);
AT(cull_figure, reserved, 20, 4);

SIZE(cull_figures, 16, 8);
AT(cull_figures, figures, 0, 8);
AT(cull_figures, count, 8, 4);
AT(cull_figures, reserved, 12, 4);

SIZE(cull_piece, 16, 4);
AT(cull_piece, item, 0, 4);
AT(cull_piece, first_point, 4, 4);
AT(cull_piece, point_count, 8, 4);
AT(cull_piece, reserved, 12, 4);

SIZE(cull_piece_request, 56, 8);
AT(cull_piece_request, eye, 0, 32);
AT(cull_piece_request, numbers, 32, 8);
AT(cull_piece_request, scratch, 40, 8);
AT(cull_piece_request, count, 48, 4);
AT(cull_piece_request, depth_order, 52, 4);

SIZE(cull_pieces, 40, 8);
AT(cull_pieces, pieces, 0, 8);
AT(cull_pieces, points, 8, 8);
AT(cull_pieces, scratch_size, 16, 8);
AT(cull_pieces, piece_count, 24, 4);
AT(cull_pieces, point_count, 28, 4);
AT(cull_pieces, order, 32, 8);

SIZE(cull_sight, 8, 8);
AT(cull_sight, part, 0, 8);

SIZE(cull_exports, 16, 8);
AT(cull_exports, abi, 0, 4);
AT(cull_exports, plugin_count, 4, 4);
AT(cull_exports, plugins, 8, 8);

VALUE(CULL_OK, 0);
VALUE(CULL_ERR_OPTION, -1);
VALUE(CULL_ERR_ZONE, -2);
VALUE(CULL_ERR_MEMORY, -3);
VALUE(CULL_ERR_BLOB, -4);
VALUE(CULL_LOG_INFO, 1);
VALUE(CULL_LOG_WARN, 2);
VALUE(CULL_LOG_ERROR, 3);
VALUE(CULL_ITEM_SEE_THROUGH, 1);
VALUE(CULL_ITEM_TWO_SIDED, 2);
VALUE(CULL_ITEM_CUT_OUT, 4);
VALUE(CULL_ITEM_WALL, 8);
VALUE(CULL_ITEM_BOX, 16);
VALUE(CULL_VIEW_MAIN, 1);
VALUE(CULL_VIEW_SHADOW, 2);
VALUE(CULL_VIEW_CUBE_FACE, 3);
VALUE(CULL_VIEW_CAPTURE, 4);
VALUE(CULL_VIEW_CUT, 1);
VALUE(CULL_DONE, 0);
VALUE(CULL_MORE, 1);
VALUE(CULL_WAIT, 2);
VALUE(CULL_CROSS_NONE, 0);
VALUE(CULL_CROSS_NARROW, 1);
VALUE(CULL_CROSS_SAME, 2);
VALUE(CULL_CONSERVATIVE, 1);
VALUE(CULL_SAMPLED, 2);
VALUE(CULL_STATELESS, 4);
VALUE(CULL_ORDERED, 8);
VALUE(CULL_FIGURE_SUM, 0);
VALUE(CULL_FIGURE_MAX, 1);
VALUE(CULL_FAR_FIRST, 1);
VALUE(CULL_NEAR_FIRST, 2);
VALUE(CULL_MAX_PLANES, 32);
VALUE(CULL_MAX_STEPS, 1000000);
VALUE(CULL_PADDING, 16);
VALUE(CULL_LEVELS_MOST, 3);
VALUE(CULL_MAX_PARTS, 16);
#endif
