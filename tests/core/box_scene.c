// Scenes for tests: see box_scene.h.
// SPDX-License-Identifier: MIT
#include "box_scene.h"

#include "tests/common/random.h"

#include <math.h>

result box_scene_add(scene_builder *b, const double min[3], const double max[3], const char *name)
{
    static const double shut[3] = {0, 0, 0};
    return box_scene_add_door(b, min, max, &(box_scene_door){name, shut});
}

result box_scene_add_door(scene_builder *b, const double min[3], const double max[3], const box_scene_door *door)
{
    static const uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    static const uint32_t polygon_triangles[6] = {2, 2, 2, 2, 2, 2};
    builder_vertex vertices[8] = {0};
    for (uint32_t v = 0; v < 8; ++v)
        for (uint32_t k = 0; k < 3; ++k) vertices[v].position[k] = v >> k & 1 ? max[k] : min[k];
    uint32_t first, indices[36], used = 0;
    const result done = scene_builder_vertices(b, vertices, 8, 0, &first);
    if (done != RESULT_OK) return done;
    for (uint32_t f = 0; f < 6; ++f)
        for (uint32_t t = 1; t < 3; ++t) {
            indices[used++] = first + faces[f][0];
            indices[used++] = first + faces[f][t];
            indices[used++] = first + faces[f][t + 1];
        }
    const builder_item item = {.indices = indices, .polygon_triangles = polygon_triangles, .index_count = 36, .polygon_count = 6, .flags = CULL_ITEM_BOX};
    return door->name ? scene_builder_mover(b, door->name, door->open_offset, &item) : scene_builder_item(b, &item);
}

static double on_grid(double metres)
{
    return floor(metres * 1024) / 1024;
}

static result add_random_box(scene_builder *b, const box_scene *s, uint64_t *state, const char *name)
{
    double min[3], max[3];
    for (int k = 0; k < 3; ++k) {
        min[k] = s->at[k] + on_grid(random_between(state, -BOX_SCENE_RADIUS_M, BOX_SCENE_RADIUS_M));
        max[k] = min[k] + on_grid(random_between(state, 0.25, 2));
    }
    return box_scene_add(b, min, max, name);
}

static result fill(scene_builder *b, const box_scene *s)
{
    uint64_t state = s->seed;
    uint32_t material, object;
    result done = scene_builder_material(b, "stone", 5, 0, &material);
    if (done == RESULT_OK) done = scene_builder_object(b, "boxes", 5, &object);
    for (uint32_t i = 0; i < s->items + s->movers && done == RESULT_OK; ++i)
        done = add_random_box(b, s, &state, i % 2 == 0 && i / 2 < s->movers ? "door" : NULL); // movers come between the others
    return done;
}

result box_scene_make(const box_scene *s, const allocator *memory, report *r, scene **out)
{
    scene_builder *b;
    result done = scene_builder_open(memory, &b);
    if (done != RESULT_OK) return done;
    done = fill(b, s);
    if (done == RESULT_OK) done = scene_builder_finish(b, "boxes", r, out);
    scene_builder_close(b);
    return done;
}

camera box_scene_camera(const box_scene *b, double yaw_deg)
{
    const double yaw = yaw_deg * 0.017453292519943295;
    return (camera){.eye = {b->at[0], b->at[1], b->at[2]}, .forward = {cos(yaw), 0, sin(yaw)}, .up = {0, 1, 0}, .fovy_deg = 60,
                    .aspect = 16.0 / 9, .near_m = 1.0 / 16, .far_m = INFINITY};
}
