// See pcs_fixture.h.
// SPDX-License-Identifier: MIT
#include "pcs_fixture.h"

#include <string.h>

static const char everything[] =
    "{\"portcullis\": 1,\n"
    "\"boxes\": [{\"name\": \"hall\", \"min\": [0, 0, 0], \"max\": [6, 3, 5], \"material\": \"plaster\", \"side\": \"in\", \"omit\": [\"+x\"]},\n"
    "  {\"name\": \"table\", \"min\": [2, 0.7, 2], \"max\": [3.5, 0.75, 3], \"material\": \"oak\"},\n"
    "  {\"name\": \"far\", \"min\": [40, 0, 0], \"max\": [41, 1, 1], \"material\": \"plaster\"}],\n"
    "\"walls\": [{\"points\": [[6, 0, 0], [6, 0, 2], [6, 3, 2], [6, 3, 0]], \"material\": \"plaster\"}],\n"
    "\"zones\": [{\"name\": \"hall\", \"box\": [[0, 0, 0], [6, 3, 5]], \"chain\": \"frustum\"}, {\"name\": \"yard\", \"box\": [[6, 0, 0], [20, 3, 5]]},\n"
    "  {\"name\": \"nook\", \"box\": [[1, 0, 1], [4, 2, 4]], \"in\": \"hall\"}],\n"
    "\"portals\": [{\"name\": \"gate\", \"zones\": [\"hall\", \"yard\"], \"points\": [[6, 0, 2], [6, 0, 3], [6, 2.1, 3], [6, 2.1, 2]], \"door\": \"sliding\"}],\n"
    "\"doors\": [{\"name\": \"sliding\", \"mover\": \"leaf\"}],\n"
    "\"movers\": [{\"name\": \"leaf\", \"box\": {\"min\": [5.95, 0, 2], \"max\": [6.05, 2.1, 3], \"material\": \"oak\"}, \"open\": [0, 0, 1]},\n"
    "  {\"name\": \"fan\", \"box\": {\"min\": [9, 2, 2], \"max\": [10, 2.1, 3], \"material\": \"oak\"}, \"loop\": true,\n"
    "   \"path\": [{\"time\": 0}, {\"time\": 2, \"at\": [0, 0.5, 0], \"turn\": [0, 90, 0]}]}],\n"
    "\"lights\": [{\"name\": \"lamp\", \"kind\": \"point\", \"at\": [3, 2, 2], \"colour\": [1, 0.5, 0.25], \"reach\": 8},\n"
    "  {\"name\": \"sun\", \"kind\": \"sun\", \"direction\": [0, -1, 0.5]}],\n"
    "\"paths\": [{\"name\": \"tour\", \"views\": [{\"eye\": [1, 1.5, 1], \"forward\": [1, 0, 0]}]}]\n}";

#define FACE(a, b, c, name) "( " a " ) ( " b " ) ( " c " ) " name " 0 0 0 1 1\n"
#define BOX(x0, y0, z0, x1, y1, z1, name)                                                                                    \
    "{\n" FACE(#x0 " 0 0", #x0 " 1 0", #x0 " 0 1", name) FACE(#x1 " 0 0", #x1 " 0 1", #x1 " 1 0", name)                      \
        FACE("0 " #y0 " 0", "0 " #y0 " 1", "1 " #y0 " 0", name) FACE("0 " #y1 " 0", "1 " #y1 " 0", "0 " #y1 " 1", name)      \
            FACE("0 0 " #z0, "1 0 " #z0, "0 1 " #z0, name) FACE("0 0 " #z1, "0 1 " #z1, "1 0 " #z1, name) "}\n"

static const char small_map[] =
    "{\n\"classname\" \"worldspawn\"\n" BOX(0, 0, 0, 64, 64, 64, "stone") BOX(128, 0, 0, 192, 64, 64, "*water") BOX(256, 0, 0, 320, 8, 64, "{grate")
    "}\n{\n\"classname\" \"func_door\"\n\"angle\" \"-1\"\n" BOX(64, 0, 0, 72, 64, 128, "wood")
    "}\n{ \"classname\" \"info_player_start\" \"origin\" \"100 10 10\" }\n{ \"classname\" \"monster_dog\" \"origin\" \"30 90 10\" }\n";

scene *everything_scene(void)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    if (import_json("everything.json", everything, sizeof everything - 1, &doors_open, NULL, allocator_heap(), &r, &s) != RESULT_OK) fail_msg("%s", h.text);
    return s;
}

scene *small_map_scene(void)
{
    return map_of(small_map, &doors_open);
}

void free_heap_scene(scene *s)
{
    scene_free(s, allocator_heap());
}

// ---- Comparing ----

static void assert_same_array(const char *name, const void *a, const void *b, size_t bytes)
{
    if ((a == NULL) != (b == NULL)) fail_msg("%s: one has it, one does not", name);
    if (a && bytes && memcmp(a, b, bytes) != 0) fail_msg("%s: other bytes", name);
}
#define SAME(field, count) assert_same_array(#field, a->field, b->field, (size_t)(count) * sizeof *a->field)
#define SAME_NUMBER(field) assert_memory_equal(&a->field, &b->field, sizeof a->field)

static void assert_same_text(const char *a, const char *b)
{
    assert_int_equal(a == NULL, b == NULL);
    if (a) assert_string_equal(a, b);
}

static void assert_counts_equal(const scene *a, const scene *b)
{
    const uint32_t x[] = {a->zone_count, a->hull_count, a->hull_plane_count, a->zone_item_count, a->portal_count, a->portal_point_count, a->door_count,
                          a->key_count, a->light_count, a->path_count, a->camera_count, a->stray_items, a->position_count, a->index_count,
                          a->polygon_count, a->item_count, a->mover_count, a->wall_vertex_count, a->plane_count, a->material_count, a->object_count,
                          a->place_count, a->solid_count, a->solid_plane_count, a->is_map, a->flat_triangles};
    const uint32_t y[] = {b->zone_count, b->hull_count, b->hull_plane_count, b->zone_item_count, b->portal_count, b->portal_point_count, b->door_count,
                          b->key_count, b->light_count, b->path_count, b->camera_count, b->stray_items, b->position_count, b->index_count,
                          b->polygon_count, b->item_count, b->mover_count, b->wall_vertex_count, b->plane_count, b->material_count, b->object_count,
                          b->place_count, b->solid_count, b->solid_plane_count, b->is_map, b->flat_triangles};
    for (size_t i = 0; i < sizeof x / sizeof *x; ++i) assert_int_equal(x[i], y[i]);
}

static void assert_arrays_equal(const scene *a, const scene *b)
{
    const size_t items = (size_t)a->item_count + a->mover_count;
    SAME(positions, a->position_count);
    SAME(normals, a->position_count);
    SAME(texcoords, 2 * (size_t)a->position_count);
    SAME(tangents, a->tangent_count);
    SAME(vertex_materials, a->position_count);
    SAME(indices, a->index_count);
    SAME(polygon_first_triangle, (size_t)a->polygon_count + 1);
    SAME(items, items);
    SAME(boxes.min_x, items + CULL_PADDING);
    SAME(boxes.min_y, items + CULL_PADDING);
    SAME(boxes.min_z, items + CULL_PADDING);
    SAME(boxes.max_x, items + CULL_PADDING);
    SAME(boxes.max_y, items + CULL_PADDING);
    SAME(boxes.max_z, items + CULL_PADDING);
    SAME(walls, a->item_count);
    SAME(wall_vertices, a->wall_vertex_count);
    SAME(planes, a->plane_count);
    SAME(exact_planes, a->plane_count);
    SAME(solid_planes, a->solid_plane_count);
    SAME(hull_planes, a->hull_plane_count);
    SAME(zone_items, a->zone_item_count);
    SAME(listings, a->item_count);
    SAME(portal_points, a->portal_point_count);
    SAME(zone_portals, 2 * (size_t)a->portal_count);
    SAME(keys, a->key_count);
    SAME(cameras, a->camera_count);
}

static void assert_groups_equal(const scene *a, const scene *b)
{
    for (uint32_t i = 0; i < a->material_count; ++i) {
        assert_same_text(a->materials[i].name, b->materials[i].name);
        SAME_NUMBER(materials[i].flags);
        SAME_NUMBER(materials[i].colour);
    }
    for (uint32_t i = 0; i < a->object_count; ++i) {
        assert_same_text(a->objects[i].name, b->objects[i].name);
        SAME_NUMBER(objects[i].first_item);
        SAME_NUMBER(objects[i].item_count);
    }
    for (uint32_t i = 0; i < a->place_count; ++i) {
        SAME_NUMBER(places[i].position);
        SAME_NUMBER(places[i].kind);
    }
    for (uint32_t i = 0; i < a->solid_count; ++i) {
        SAME_NUMBER(solids[i].first_plane);
        SAME_NUMBER(solids[i].plane_count);
        SAME_NUMBER(solids[i].kind);
        SAME_NUMBER(solids[i].min);
        SAME_NUMBER(solids[i].max);
    }
}

static void assert_moving_equal(const scene *a, const scene *b)
{
    for (uint32_t i = 0; i < a->mover_count; ++i) {
        assert_same_text(a->movers[i].name, b->movers[i].name);
        SAME_NUMBER(movers[i].open_offset);
        SAME_NUMBER(movers[i].pivot);
        SAME_NUMBER(movers[i].axes);
        SAME_NUMBER(movers[i].first_key);
        SAME_NUMBER(movers[i].key_count);
        SAME_NUMBER(movers[i].door);
        SAME_NUMBER(movers[i].loops);
    }
    for (uint32_t i = 0; i < a->door_count; ++i) {
        assert_same_text(a->doors[i].name, b->doors[i].name);
        SAME_NUMBER(doors[i].at_rest);
        SAME_NUMBER(doors[i].mover);
    }
    for (uint32_t i = 0; i < a->light_count; ++i) {
        assert_same_text(a->lights[i].name, b->lights[i].name);
        SAME_NUMBER(lights[i].kind);
        SAME_NUMBER(lights[i].position);
        SAME_NUMBER(lights[i].direction);
        SAME_NUMBER(lights[i].reach);
        SAME_NUMBER(lights[i].colour);
    }
    for (uint32_t i = 0; i < a->path_count; ++i) {
        assert_same_text(a->paths[i].name, b->paths[i].name);
        SAME_NUMBER(paths[i].first_camera);
        SAME_NUMBER(paths[i].camera_count);
    }
}

static void assert_zones_equal(const scene *a, const scene *b)
{
    for (uint32_t i = 0; i < a->zone_count; ++i) {
        assert_same_text(a->zones[i].name, b->zones[i].name);
        assert_same_text(a->zones[i].chain, b->zones[i].chain);
        SAME_NUMBER(zones[i].origin);
        SAME_NUMBER(zones[i].flags);
        SAME_NUMBER(zones[i].parent);
        SAME_NUMBER(zones[i].first_hull);
        SAME_NUMBER(zones[i].hull_count);
        SAME_NUMBER(zones[i].first_item);
        SAME_NUMBER(zones[i].item_count);
        SAME_NUMBER(zones[i].first_portal);
        SAME_NUMBER(zones[i].portal_count);
    }
    for (uint32_t i = 0; i < a->hull_count; ++i) {
        SAME_NUMBER(hulls[i].zone);
        SAME_NUMBER(hulls[i].first_plane);
        SAME_NUMBER(hulls[i].plane_count);
        SAME_NUMBER(hulls[i].min);
        SAME_NUMBER(hulls[i].max);
    }
    for (uint32_t i = 0; i < a->portal_count; ++i) {
        assert_same_text(a->portals[i].name, b->portals[i].name);
        SAME_NUMBER(portals[i].zones);
        SAME_NUMBER(portals[i].first_point);
        SAME_NUMBER(portals[i].point_count);
        SAME_NUMBER(portals[i].door);
        SAME_NUMBER(portals[i].plane);
    }
}

void assert_scenes_equal(const scene *a, const scene *b)
{
    SAME_NUMBER(hash);
    SAME_NUMBER(step);
    SAME_NUMBER(grid_steps_per_metre);
    SAME_NUMBER(whole.origin);
    SAME_NUMBER(whole.box);
    SAME_NUMBER(whole.radius);
    assert_counts_equal(a, b);
    assert_arrays_equal(a, b);
    assert_groups_equal(a, b);
    assert_moving_equal(a, b);
    assert_zones_equal(a, b);
}

// ---- Files ----

char *encoded(const pcs_request *q, size_t *out_size)
{
    heard h;
    report r = hear(&h);
    void *bytes = NULL;
    if (pcs_encode(q, "t.pcs", allocator_heap(), &r, &bytes, out_size) != RESULT_OK) fail_msg("%s", h.text);
    return bytes;
}

char *encoded_scene(const scene *s, size_t *out_size)
{
    return encoded(&(pcs_request){.scene = s}, out_size);
}

scene *opened(const void *bytes, size_t size)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    if (pcs_open("t.pcs", bytes, size, allocator_heap(), &r, &s) != RESULT_OK) fail_msg("%s", h.text);
    return s;
}

void sign(char *file, size_t size)
{
    pcs_header head;
    memcpy(&head, file, sizeof head);
    head.hash = pcs_hash(file, size);
    memcpy(file, &head, sizeof head);
}

static pcs_section row_of(const char *file, pcs_id id)
{
    pcs_section row;
    memcpy(&row, file + sizeof(pcs_header) + (size_t)id * sizeof row, sizeof row);
    return row;
}

char *section_of(char *file, pcs_id id)
{
    return file + row_of(file, id).offset;
}

uint64_t section_count(const char *file, pcs_id id)
{
    return row_of(file, id).count;
}
