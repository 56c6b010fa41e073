// See fixture.h.
// SPDX-License-Identifier: MIT
#include "tests/flow/fixture.h"

#include "tests/common/random.h"
#include "tests/common/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const pose POSE_NONE = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};

pose pose_random(uint64_t *seed, double far_m)
{
    const double yaw = random_between(seed, 0, 6), pitch = random_between(seed, -1, 1), roll = random_between(seed, -1, 1);
    const double cy = cos(yaw), sy = sin(yaw), cp = cos(pitch), sp = sin(pitch), cr = cos(roll), sr = sin(roll);
    pose p = {{cy * cr + sy * sp * sr, sr * cp, -sy * cr + cy * sp * sr, -cy * sr + sy * sp * cr, cr * cp, sr * sy + cy * sp * cr, sy * cp,
               -sp, cy * cp}, {0}};
    for (int i = 0; i < 3; i++) p.move[i] = floor(random_between(seed, -far_m, far_m));
    return p;
}

static void turned(const pose *p, const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = p->turn[3 * i] * v[0] + p->turn[3 * i + 1] * v[1] + p->turn[3 * i + 2] * v[2];
}

static void placed(const pose *p, const double v[3], double out[3])
{
    turned(p, v, out);
    for (int i = 0; i < 3; i++) out[i] += p->move[i];
}

// ---- Building ----

void maze_begin(maze *m, const pose *p)
{
    memset(m, 0, sizeof *m);
    m->pose = *p;
    failing_allocator_init(&m->memory, 0);
    report_lines_init(&m->lines);
    uint32_t material, object;
    assert_int_equal(scene_builder_open(&m->memory.memory, &m->builder), RESULT_OK);
    assert_int_equal(scene_builder_material(m->builder, "m", 1, 0, &material), RESULT_OK);
    assert_int_equal(scene_builder_object(m->builder, "o", 1, &object), RESULT_OK);
}

void maze_piece(maze *m, const double at[3])
{
    builder_vertex vertices[3] = {0};
    for (int i = 0; i < 3; i++) {
        const double corner[3] = {at[0] + (i == 1) * 0.125, at[1] + (i == 2) * 0.125, at[2]};
        placed(&m->pose, corner, vertices[i].position);
    }
    uint32_t first;
    assert_int_equal(scene_builder_vertices(m->builder, vertices, 3, 0, &first), RESULT_OK);
    const uint32_t indices[3] = {first, first + 1, first + 2};
    const builder_item item = {.indices = indices, .index_count = 3, .polygon_count = 1};
    assert_int_equal(scene_builder_item(m->builder, &item), RESULT_OK);
}

static uint32_t zone_add(maze *m, const builder_hull *hulls, uint32_t count, uint32_t parent)
{
    char name[16];
    snprintf(name, sizeof name, "z%u", m->item_zone++);
    const builder_zone z = {.name = name, .hulls = hulls, .hull_count = count, .parent = parent};
    uint32_t zone;
    const char *fault = NULL;
    if (scene_builder_zone(m->builder, &z, &zone, &fault) != RESULT_OK) fail_msg("the zone %s %s", name, fault ? fault : "has no memory");
    return zone;
}

uint32_t maze_wedge(maze *m, const scene_solid_plane *planes, uint32_t count, const double inside[3])
{
    scene_solid_plane world[16];
    assert_true(count <= 16);
    for (uint32_t i = 0; i < count; i++) {
        turned(&m->pose, planes[i].normal, world[i].normal);
        world[i].distance = planes[i].distance;
        for (int k = 0; k < 3; k++) world[i].distance += world[i].normal[k] * m->pose.move[k];
    }
    maze_piece(m, inside);
    return zone_add(m, &(builder_hull){world, count}, 1, SCENE_NONE);
}

static void part_planes(const maze *m, const maze_part *p, scene_solid_plane planes[6])
{
    for (int i = 0; i < 6; i++) {
        const double sign = i < 3 ? 1 : -1;
        double normal[3] = {0, 0, 0};
        normal[i % 3] = sign;
        turned(&m->pose, normal, planes[i].normal);
        planes[i].distance = i < 3 ? p->high[i] : -p->low[i - 3];
        for (int k = 0; k < 3; k++) planes[i].distance += planes[i].normal[k] * m->pose.move[k];
    }
}

uint32_t maze_union(maze *m, const maze_part *parts, uint32_t count, uint32_t parent)
{
    scene_solid_plane planes[8][6];
    builder_hull hulls[8];
    assert_true(count <= 8);
    for (uint32_t i = 0; i < count; i++) {
        const double *low = parts[i].low, *high = parts[i].high;
        const double middle[3] = {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
        maze_piece(m, middle);
        part_planes(m, &parts[i], planes[i]);
        hulls[i] = (builder_hull){planes[i], 6};
    }
    return zone_add(m, hulls, count, parent);
}

uint32_t maze_box(maze *m, const double low[3], const double high[3], uint32_t parent)
{
    const maze_part part = {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
    return maze_union(m, &part, 1, parent);
}

uint32_t maze_everywhere(maze *m)
{
    return zone_add(m, NULL, 0, SCENE_NONE);
}

uint32_t maze_portal(maze *m, uint32_t a, uint32_t b, const double (*points)[3], uint32_t count)
{
    double world[16][3];
    assert_true(count <= 16);
    for (uint32_t i = 0; i < count; i++) placed(&m->pose, points[i], world[i]);
    const builder_portal p = {.name = "", .points = (const double(*)[3])world, .point_count = count, .zones = {a, b}, .door = SCENE_NONE};
    uint32_t portal;
    const char *fault = NULL;
    if (scene_builder_portal(m->builder, &p, &portal, &fault) != RESULT_OK) fail_msg("the portal %s", fault ? fault : "has no memory");
    return portal;
}

uint32_t maze_opening(maze *m, uint32_t a, uint32_t b, const opening *o)
{
    double points[4][3];
    for (int i = 0; i < 4; i++) {
        points[i][o->axis] = o->at;
        points[i][(o->axis + 1) % 3] = i == 1 || i == 2 ? o->high[0] : o->low[0];
        points[i][(o->axis + 2) % 3] = i >= 2 ? o->high[1] : o->low[1];
    }
    return maze_portal(m, a, b, (const double(*)[3])points, 4);
}

static void *host_alloc(const cull_host *h, size_t size, size_t align)
{
    (void)h;
    (void)align;
    return malloc(size);
}

static void host_free(const cull_host *h, void *memory, size_t size)
{
    (void)h;
    (void)size;
    free(memory);
}

static const cull_host test_host = {.abi = CULL_ABI, .alloc = host_alloc, .free = host_free};

void maze_end(maze *m)
{
    if (scene_builder_finish(m->builder, "maze", &m->lines.report, &m->scene) != RESULT_OK) fail_msg("the scene: %s", m->lines.lines[0]);
    scene_builder_close(m->builder);
    m->builder = NULL;
    const uint32_t zones = m->scene->zone_count;
    const allocator *memory = &m->memory.memory;
    assert_int_equal(graph_open(m->scene, memory, &m->graph), RESULT_OK);
    m->zones = calloc(zones, sizeof *m->zones);
    m->cullers = calloc(zones, sizeof *m->cullers);
    m->queries = calloc(zones, sizeof(cull_query *));
    m->open = malloc(m->scene->portal_count + 1);
    memset(m->open, 1, m->scene->portal_count + 1);
    for (uint32_t z = 0; z < zones; z++) {
        const cull_plugin *plugin = cull_entry.plugins[0];
        const char *const values[] = {plugin->descriptor->options[0].fallback};
        cull_built built = {0};
        assert_int_equal(zone_data_open(&(zone_data_request){m->scene, z, 0}, memory, &m->zones[z]), RESULT_OK);
        assert_int_equal(plugin->create(&test_host, values, &m->cullers[z]), CULL_OK);
        assert_int_equal(plugin->build(m->cullers[z], &m->zones[z].zone, NULL, &built), CULL_OK);
        assert_int_equal(plugin->open(m->cullers[z], &m->queries[z]), CULL_OK);
    }
    assert_int_equal(flow_open(&(flow_open_request){m->scene, m->graph, m->zones}, memory, &m->flow), RESULT_OK);
}

void maze_close(maze *m)
{
    flow_close(m->flow);
    for (uint32_t z = 0; m->scene && z < m->scene->zone_count; z++) {
        cull_entry.plugins[0]->close(m->queries[z]);
        cull_entry.plugins[0]->destroy(m->cullers[z]);
        zone_data_close(&m->zones[z]);
    }
    free(m->zones);
    free(m->cullers);
    free(m->queries);
    free(m->open);
    graph_close(m->graph);
    scene_free(m->scene, &m->memory.memory);
    assert_true(failing_allocator_is_clean(&m->memory));
}

// ---- Running ----

static cull_crossing narrow(void *user, uint32_t zone, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes,
                            uint32_t *plane_count)
{
    const maze *m = user;
    return cull_entry.plugins[0]->cross(m->queries[zone], view, in, portal, planes, plane_count);
}

static cull_crossing mixed(void *user, uint32_t zone, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes,
                           uint32_t *plane_count)
{
    return zone % 2 ? CULL_CROSS_SAME : narrow(user, zone, view, in, portal, planes, plane_count);
}

static int always(void *user, uint32_t zone)
{
    (void)user;
    (void)zone;
    return 1;
}

flow_crosser maze_crosser(maze *m, crosser_kind kind)
{
    return (flow_crosser){m, kind == CROSSER_FLOOD ? NULL : kind == CROSSER_MIXED ? mixed : narrow, NULL, kind == CROSSER_BY_ENTRY ? always : NULL};
}

camera maze_camera(const maze *m, const double eye[3], const double forward[3], double fovy_deg)
{
    camera c = {.fovy_deg = fovy_deg, .aspect = 4.0 / 3, .near_m = 0.05, .far_m = INFINITY};
    const double up[3] = {0.1, 1, 0.05};
    placed(&m->pose, eye, c.eye);
    turned(&m->pose, forward, c.forward);
    turned(&m->pose, up, c.up);
    return c;
}

void maze_run(maze *m, const camera *c, crosser_kind kind, flow_result *out)
{
    const flow_request q = {.camera = c, .frame = {320, 240, 0, 0, CULL_VIEW_MAIN}, .open = m->open, .crosser = maze_crosser(m, kind)};
    flow_run(m->flow, &q, out);
}

const flow_zone *maze_find(const flow_result *r, uint32_t zone)
{
    for (uint32_t i = 0; i < r->zone_count; i++)
        if (r->zones[i].zone == zone) return &r->zones[i];
    return NULL;
}
