// move_scene IN VIEWS OUT.pcs SCALE TURN_DEG X Y Z: a scene with zones put through one scale, one turn (about x by a third of the
// angle, y by all of it, z by half) and one move, and those views with it, as its path `moved`. Movers and lights stay behind.
// SPDX-License-Identifier: MIT
// Invariant: whatever is derived is derived anew, by the scene builder, from world points in double: as an importer would.
#include "host/compile/pcs_write.h"
#include "host/import/import.h"
#include "host/import/views.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct job {
    const allocator *memory;
    report report;
    scene *from;
    scene_builder *to;
    builder_transform place;
    double scale;
} job;

static const double PI = 3.14159265358979323846;

static void turn_about(double m[9], int axis, double degrees)
{
    const double c = cos(degrees * PI / 180), s = sin(degrees * PI / 180);
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (int k = 0; k < 3; k++) {
        const double u = m[3 * a + k], v = m[3 * b + k];
        m[3 * a + k] = c * u - s * v;
        m[3 * b + k] = s * u + c * v;
    }
}

static void place_make(job *j, char **numbers)
{
    double m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double degrees = strtod(numbers[1], NULL);
    turn_about(m, 0, degrees / 3);
    turn_about(m, 1, degrees);
    turn_about(m, 2, degrees / 2);
    j->scale = strtod(numbers[0], NULL);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) j->place.rows[i][k] = j->scale * m[3 * i + k];
        j->place.rows[i][3] = strtod(numbers[2 + i], NULL);
    }
}

static void point_move(const job *j, const double p[3], double w, double out[3])
{
    const double v[3] = {p[0], p[1], p[2]};
    for (int i = 0; i < 3; i++) out[i] = ((j->place.rows[i][0] * v[0] + j->place.rows[i][1] * v[1]) + j->place.rows[i][2] * v[2]) + w * j->place.rows[i][3];
}

static result zones_add(job *j)
{
    const scene *s = j->from;
    result done = RESULT_OK;
    for (uint32_t z = 0; z < s->zone_count && done == RESULT_OK; z++) {
        const scene_zone *zone = &s->zones[z];
        builder_hull *hulls = calloc(zone->hull_count + 1, sizeof *hulls);
        if (!hulls) return RESULT_NO_MEMORY;
        for (uint32_t h = 0; h < zone->hull_count; h++) {
            const scene_hull *hull = &s->hulls[zone->first_hull + h];
            hulls[h] = (builder_hull){s->hull_planes + hull->first_plane, hull->plane_count};
        }
        const builder_zone add = {zone->name, zone->chain, hulls, zone->hull_count, zone->parent};
        const char *fault = NULL;
        uint32_t number;
        done = scene_builder_zone(j->to, &add, &number, &fault);
        if (done != RESULT_OK) fprintf(stderr, "zone %s %s\n", zone->name, fault ? fault : "");
        free(hulls);
    }
    return done;
}

static result portals_add(job *j)
{
    const scene *s = j->from;
    result done = RESULT_OK;
    for (uint32_t p = 0; p < s->portal_count && done == RESULT_OK; p++) {
        const scene_portal *portal = &s->portals[p];
        const builder_portal add = {portal->name, (const double(*)[3])(s->portal_points + portal->first_point), portal->point_count,
                                    {portal->zones[0], portal->zones[1]}, SCENE_NONE, portal->plane};
        const char *fault = NULL;
        uint32_t number;
        done = scene_builder_portal(j->to, &add, &number, &fault);
        if (done != RESULT_OK) fprintf(stderr, "portal %s %s\n", portal->name, fault ? fault : "");
    }
    return done;
}

static result materials_add(job *j)
{
    const scene *s = j->from;
    result done = RESULT_OK;
    for (uint32_t m = 0; m < s->material_count && done == RESULT_OK; m++) {
        uint32_t number;
        done = scene_builder_material(j->to, s->materials[m].name, strlen(s->materials[m].name), s->materials[m].flags & ~(uint32_t)MATERIAL_NORMAL_MAP, &number);
        if (done == RESULT_OK && number != m) done = RESULT_BAD_INPUT;
    }
    for (uint32_t o = 0; o < s->object_count && done == RESULT_OK; o++) {
        uint32_t number;
        done = scene_builder_object(j->to, s->objects[o].name, strlen(s->objects[o].name), &number);
    }
    return done;
}

// Vertices of one item anew, all its indices' positions; walls by their loop.
static result item_add(job *j, uint32_t i, const uint32_t *zones, uint32_t zone_count)
{
    const scene *s = j->from;
    const scene_item *item = &s->items[i];
    uint32_t low = UINT32_MAX, high = 0;
    for (uint32_t k = 0; k < item->index_count; k++) {
        const uint32_t v = s->indices[item->first_index + k];
        low = v < low ? v : low;
        high = v > high ? v : high;
    }
    const cull_wall *wall = s->walls ? &s->walls[i] : NULL;
    const uint32_t loop_count = wall ? wall->vertex_count : 0;
    for (uint32_t k = 0; k < loop_count; k++) {
        const uint32_t v = s->wall_vertices[wall->first_vertex + k];
        low = v < low ? v : low;
        high = v > high ? v : high;
    }
    const uint32_t count = high - low + 1;
    builder_vertex *vertices = calloc(count, sizeof *vertices);
    uint32_t *numbers = calloc(item->index_count + loop_count + item->polygon_count, sizeof *numbers);
    if (!vertices || !numbers) {
        free(vertices);
        free(numbers);
        return RESULT_NO_MEMORY;
    }
    for (uint32_t v = 0; v < count; v++) {
        const cull_vec3 p = s->positions[low + v];
        vertices[v].position[0] = s->whole.origin[0] + (double)p.x;
        vertices[v].position[1] = s->whole.origin[1] + (double)p.y;
        vertices[v].position[2] = s->whole.origin[2] + (double)p.z;
    }
    uint32_t first;
    result done = scene_builder_vertices(j->to, vertices, count, item->material, &first);
    for (uint32_t k = 0; k < item->index_count; k++) numbers[k] = s->indices[item->first_index + k] - low + first;
    for (uint32_t k = 0; k < loop_count; k++) numbers[item->index_count + k] = s->wall_vertices[wall->first_vertex + k] - low + first;
    for (uint32_t k = 0; k < item->polygon_count; k++)
        numbers[item->index_count + loop_count + k] = s->polygon_first_triangle[item->first_polygon + k + 1] - s->polygon_first_triangle[item->first_polygon + k];
    builder_item add = {.indices = numbers, .polygon_triangles = numbers + item->index_count + loop_count, .index_count = item->index_count,
                        .polygon_count = item->polygon_count, .material = item->material, .object = item->object, .flags = item->flags};
    if (loop_count) {
        add.loop = numbers + item->index_count;
        add.loop_count = loop_count;
        const cull_plane plane = s->planes[wall->plane];
        const double normal[3] = {(double)plane.normal.x, (double)plane.normal.y, (double)plane.normal.z};
        double shift = 0;
        for (int k = 0; k < 3; k++) add.plane[k] = normal[k], shift += normal[k] * s->whole.origin[k];
        add.plane[3] = (double)plane.offset - shift;
    }
    if (done == RESULT_OK) done = scene_builder_item(j->to, &add);
    if (done == RESULT_OK && zone_count) done = scene_builder_item_zones(j->to, zones, zone_count);
    free(vertices);
    free(numbers);
    return done;
}

static result items_add(job *j)
{
    const scene *s = j->from;
    uint32_t *zones = calloc(s->zone_count, sizeof *zones), *next = calloc(s->zone_count, sizeof *next);
    result done = zones && next ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < s->item_count && done == RESULT_OK; i++) {
        uint32_t count = 0;
        for (uint32_t z = 0; z < s->zone_count; z++) // zone_items ascend
            if (next[z] < s->zones[z].item_count && s->zone_items[s->zones[z].first_item + next[z]] == i) {
                zones[count++] = z;
                next[z]++;
            }
        done = item_add(j, i, zones, count);
        if (done != RESULT_OK) fprintf(stderr, "item %u\n", i);
    }
    free(zones);
    free(next);
    return done;
}

static result views_add(job *j, const char *what)
{
    camera_path path;
    result done = camera_path_load(what, j->from, 16.0 / 9, j->memory, &j->report, &path);
    if (done != RESULT_OK) return done;
    for (uint32_t v = 0; v < path.count; v++) { // the builder's transform moves eyes and turns directions; distances it can't know of
        path.cameras[v].near_m *= j->scale;
        path.cameras[v].far_m *= j->scale;
        double moved[3];
        point_move(j, path.cameras[v].eye, 1, moved);
        memcpy(path.cameras[v].eye, moved, sizeof moved);
        point_move(j, path.cameras[v].forward, 0, path.cameras[v].forward);
        point_move(j, path.cameras[v].up, 0, path.cameras[v].up);
    }
    scene_builder_transform_end(j->to);
    done = scene_builder_camera_path(j->to, "moved", path.cameras, path.count);
    camera_path_free(&path, j->memory);
    return done;
}

static result run(job *j, char **words)
{
    const import_options options = {DOORS_OPEN};
    scene *out = NULL;
    result done = import_scene(words[1], &options, j->memory, &j->report, &j->from);
    if (done == RESULT_OK) done = scene_builder_open(j->memory, &j->to);
    if (done == RESULT_OK) done = scene_builder_transform(j->to, &j->place);
    if (done == RESULT_OK) done = materials_add(j);
    if (done == RESULT_OK) done = zones_add(j);
    if (done == RESULT_OK) done = portals_add(j);
    if (done == RESULT_OK) done = items_add(j);
    if (done == RESULT_OK) done = views_add(j, words[2]);
    if (done == RESULT_OK) done = scene_builder_finish(j->to, words[3], &j->report, &out);
    const pcs_request request = {.scene = out};
    if (done == RESULT_OK) done = pcs_write(&request, words[3], j->memory, &j->report);
    scene_free(out, j->memory);
    scene_builder_close(j->to);
    scene_free(j->from, j->memory);
    return done;
}

int main(int argc, char **argv)
{
    if (argc != 9) {
        fprintf(stderr, "usage: move_scene IN VIEWS OUT.pcs SCALE TURN_DEG X Y Z\n");
        return 2;
    }
    job j = {.memory = allocator_heap(), .report = report_to_stderr()};
    place_make(&j, argv + 4);
    return run(&j, argv) == RESULT_OK ? 0 : 1;
}
