// See fixture.h.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void *count_alloc(void *user, size_t size, size_t align)
{
    counting *c = user;
    const allocator *heap = allocator_heap();
    if (++c->calls == c->fail_at) return NULL;
    void *memory = heap->alloc(heap->user, size, align);
    if (memory) c->live_bytes += size;
    return memory;
}

static void count_free(void *user, void *memory, size_t size)
{
    counting *c = user;
    const allocator *heap = allocator_heap();
    if (memory) c->live_bytes -= size;
    heap->free(heap->user, memory, size);
}

void counting_init(counting *c)
{
    *c = (counting){.memory = {count_alloc, count_free, c}};
}

int run_with_gl(const char *name, const struct CMUnitTest *tests, size_t count)
{
    renderer *g = NULL;
    report r = report_to_stderr();
    if (renderer_open(NULL, allocator_heap(), &r, &g) == RESULT_NO_GL) {
        fprintf(stderr, "SKIPPED %s: no OpenGL 4.5 on this machine\n", name);
        return 77;
    }
    renderer_close(g);
    return _cmocka_run_group_tests(name, tests, count, NULL, NULL);
}

int bed_setup(void **state)
{
    bed *b = memory_alloc_zeroed(allocator_heap(), 1, sizeof *b);
    if (!b) return -1;
    counting_init(&b->memory);
    b->r = report_to_stderr();
    *state = b;
    return renderer_open(NULL, &b->memory.memory, &b->r, &b->g) == RESULT_OK ? 0 : -1;
}

static void drop_scene(bed *b)
{
    render_layout_close(b->l);
    b->l = NULL;
    scene_free(b->s, &b->memory.memory);
    b->s = NULL;
}

int bed_teardown(void **state)
{
    bed *b = *state;
    const uint32_t errors = renderer_errors(b->g);
    drop_scene(b);
    renderer_close(b->g);
    const size_t live = b->memory.live_bytes;
    memory_free(allocator_heap(), b, 1, sizeof *b);
    if (errors) fprintf(stderr, "%u GL errors\n", errors);
    if (live) fprintf(stderr, "%zu bytes still live\n", live);
    return errors || live ? -1 : 0;
}

quad quad_at(double z, double x0, double y0, double x1, double y1)
{
    return (quad){.corners = {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}, .material = "grey"};
}

quad quad_reversed(quad q)
{
    quad turned = q;
    for (int i = 0; i < 4; ++i) memcpy(turned.corners[i], q.corners[3 - i], sizeof q.corners[i]);
    return turned;
}

static void add_quad(scene_builder *b, const quad *q, uint32_t object, const double offset[3])
{
    static const float texcoords[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    static const double still[3] = {0, 0, 0};
    uint32_t material, first;
    builder_vertex vertices[4] = {0};
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 3; ++k) vertices[i].position[k] = q->corners[i][k] + (offset ? offset[k] : 0);
        memcpy(vertices[i].texcoord, texcoords[i], sizeof texcoords[i]);
    }
    assert_int_equal(scene_builder_material(b, q->material, strlen(q->material), q->material_flags, &material), RESULT_OK);
    if (q->colour) assert_int_equal(scene_builder_material_colour(b, material, q->colour), RESULT_OK);
    assert_int_equal(scene_builder_vertices(b, vertices, 4, material, &first), RESULT_OK);
    const uint32_t indices[6] = {first, first + 1, first + 2, first, first + 2, first + 3};
    const builder_item item = {.indices = indices, .index_count = 6, .polygon_count = 2, .material = material, .object = object, .flags = q->item_flags};
    if (q->is_mover) assert_int_equal(scene_builder_mover(b, "mover", still, &item), RESULT_OK);
    else assert_int_equal(scene_builder_item(b, &item), RESULT_OK);
}

static void show_scene(bed *b, scene_builder *builder)
{
    assert_int_equal(scene_builder_finish(builder, "test", &b->r, &b->s), RESULT_OK);
    scene_builder_close(builder);
    assert_int_equal(renderer_upload(b->g, b->s, &b->r), RESULT_OK);
    assert_int_equal(bed_layout(b, NULL, &b->l), RESULT_OK);
}

void bed_scene(bed *b, const quad *quads, size_t count, const double offset[3])
{
    scene_builder *builder = NULL;
    uint32_t object;
    drop_scene(b);
    assert_int_equal(scene_builder_open(&b->memory.memory, &builder), RESULT_OK);
    assert_int_equal(scene_builder_object(builder, "all", 3, &object), RESULT_OK);
    for (size_t i = 0; i < count; ++i) add_quad(builder, &quads[i], object, offset);
    show_scene(b, builder);
}

void bed_mesh(bed *b, const double (*positions)[3], uint32_t position_count, const uint32_t *indices, uint32_t index_count, uint32_t item_indices)
{
    scene_builder *builder = NULL;
    uint32_t object, material, first = 0;
    drop_scene(b);
    assert_int_equal(scene_builder_open(&b->memory.memory, &builder), RESULT_OK);
    assert_int_equal(scene_builder_object(builder, "all", 3, &object), RESULT_OK);
    assert_int_equal(scene_builder_material(builder, "grey", 4, 0, &material), RESULT_OK);
    for (uint32_t i = 0; i < position_count; ++i) {
        builder_vertex v = {0};
        uint32_t number;
        memcpy(v.position, positions[i], sizeof v.position);
        assert_int_equal(scene_builder_vertices(builder, &v, 1, material, &number), RESULT_OK);
        if (i == 0) first = number;
    }
    assert_int_equal(first, 0); // so that the mesh's own numbers serve
    for (uint32_t i = 0; i < index_count; i += item_indices) {
        const uint32_t count = index_count - i < item_indices ? index_count - i : item_indices;
        const builder_item item = {.indices = indices + i, .index_count = count, .polygon_count = count / 3, .material = material, .object = object};
        assert_int_equal(scene_builder_item(builder, &item), RESULT_OK);
    }
    show_scene(b, builder);
}

// ---- Rooms ----

static void put_quad(scene_builder *b, const double a[3], const double u[3], const double v[3], const double corner[3])
{
    quad q = {.material = "grey"};
    for (int k = 0; k < 3; ++k) {
        q.corners[0][k] = a[k];
        q.corners[1][k] = a[k] + u[k];
        q.corners[2][k] = a[k] + u[k] + v[k];
        q.corners[3][k] = a[k] + v[k];
    }
    add_quad(b, &q, 0, corner);
}

// A wall from a, along u; with a doorway, or whole.
static void put_wall(scene_builder *b, const double a[3], const double u[3], const double corner[3], int has_door)
{
    static const double up[3] = {0, ROOM_HIGH_M, 0}, over[3] = {0, 1, 0};
    double part[3], from[3];
    if (!has_door) {
        put_quad(b, a, u, up, corner);
        return;
    }
    for (int k = 0; k < 3; ++k) part[k] = u[k] * 0.375;
    put_quad(b, a, part, up, corner);
    for (int k = 0; k < 3; ++k) from[k] = a[k] + u[k] * 0.625;
    put_quad(b, from, part, up, corner);
    for (int k = 0; k < 3; ++k) {
        from[k] = a[k] + part[k] + (k == 1 ? 2 : 0);
        part[k] = u[k] * 0.25;
    }
    put_quad(b, from, part, over, corner);
}

static void put_room(scene_builder *b, uint32_t x, uint32_t z, uint32_t side, const double corner[3])
{
    static const double along_x[3] = {ROOM_SIDE_M, 0, 0}, along_z[3] = {0, 0, -ROOM_SIDE_M};
    const double low[3] = {(double)x * ROOM_SIDE_M, 0, -(double)z * ROOM_SIDE_M};
    const double ceiling[3] = {low[0], ROOM_HIGH_M, low[2]}, right[3] = {low[0] + ROOM_SIDE_M, 0, low[2]}, back[3] = {low[0], 0, low[2] - ROOM_SIDE_M};
    put_quad(b, low, along_x, along_z, corner);
    put_quad(b, ceiling, along_z, along_x, corner);
    put_wall(b, low, along_x, corner, z > 0);
    put_wall(b, low, along_z, corner, x > 0);
    if (x + 1 == side) put_wall(b, right, along_z, corner, 0);
    if (z + 1 == side) put_wall(b, back, along_x, corner, 0);
}

static void put_zone(scene_builder *b, uint32_t x, uint32_t z, const double corner[3])
{
    const double low[3] = {corner[0] + (double)x * ROOM_SIDE_M, corner[1], corner[2] - (double)(z + 1) * ROOM_SIDE_M};
    const double high[3] = {low[0] + ROOM_SIDE_M, low[1] + ROOM_HIGH_M, low[2] + ROOM_SIDE_M};
    scene_solid_plane planes[6] = {0};
    for (int k = 0; k < 3; ++k) {
        planes[2 * k].normal[k] = 1;
        planes[2 * k].distance = high[k];
        planes[2 * k + 1].normal[k] = -1;
        planes[2 * k + 1].distance = -low[k];
    }
    const builder_hull hull = {planes, 6};
    const char *fault = NULL;
    char name[32];
    uint32_t zone;
    snprintf(name, sizeof name, "room %u %u", x, z);
    assert_int_equal(scene_builder_zone(b, &(builder_zone){.name = name, .hulls = &hull, .hull_count = 1, .parent = SCENE_NONE}, &zone, &fault), RESULT_OK);
}

void bed_rooms(bed *b, uint32_t side, const double corner[3])
{
    scene_builder *builder = NULL;
    uint32_t object;
    drop_scene(b);
    assert_int_equal(scene_builder_open(&b->memory.memory, &builder), RESULT_OK);
    assert_int_equal(scene_builder_object(builder, "all", 3, &object), RESULT_OK);
    for (uint32_t i = 0; i < side * side; ++i) put_room(builder, i % side, i / side, side, corner);
    for (uint32_t i = 0; i < side * side; ++i) put_zone(builder, i % side, i / side, corner);
    show_scene(b, builder);
}

render_layout *bed_zone_layout(bed *b, list_order order)
{
    const scene *s = b->s;
    render_layout *l = NULL;
    render_layout_zone *zones = memory_alloc(allocator_heap(), s->zone_count, sizeof *zones);
    uint32_t *items = memory_alloc(allocator_heap(), s->zone_item_count, sizeof *items);
    assert_true(zones && items);
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        const uint32_t first = s->zones[z].first_item, count = s->zones[z].item_count;
        for (uint32_t i = 0; i < count; ++i) items[first + i] = s->zone_items[first + (order == LIST_ORDER ? i : count - 1 - i)];
        zones[z] = (render_layout_zone){items + first, count};
    }
    assert_int_equal(render_layout_open(b->g, zones, s->zone_count, &b->r, &l), RESULT_OK);
    memory_free(allocator_heap(), zones, s->zone_count, sizeof *zones);
    memory_free(allocator_heap(), items, s->zone_item_count, sizeof *items);
    return l;
}

camera camera_at(double x, double y, double z)
{
    return (camera){.eye = {x, y, z}, .forward = {0, 0, -1}, .up = {0, 1, 0}, .fovy_deg = 90, .aspect = 1, .near_m = 1.0 / 16, .far_m = INFINITY};
}

id_picture bed_ids(bed *b, const id_request *q, uint32_t width_px, uint32_t height_px)
{
    id_picture p = {0};
    assert_int_equal(id_picture_open(b->s, width_px, height_px, allocator_heap(), &p), RESULT_OK);
    assert_int_equal(renderer_id_picture(b->g, q, &b->r, &p), RESULT_OK);
    return p;
}

uint32_t id_at(const id_picture *p, uint32_t x, uint32_t y)
{
    return p->triangles[y * p->width_px + x];
}

int see_through_at(const id_picture *p, uint32_t triangle)
{
    return (int)(p->see_through[triangle >> 5] >> (triangle & 31) & 1);
}

uint32_t item_of_triangle(const scene *s, uint32_t triangle)
{
    uint32_t i = 0;
    while (s->items[i].first_index + s->items[i].index_count <= 3 * triangle) ++i;
    return i;
}

uint32_t random_next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state ^ *state >> 15;
}

double random_unit(uint32_t *state)
{
    return random_next(state) / 4294967296.0;
}

result bed_layout(bed *b, const uint32_t *order, render_layout **out)
{
    const uint32_t count = b->s->item_count;
    uint32_t *items = memory_alloc(allocator_heap(), count, sizeof *items);
    assert_non_null(items);
    for (uint32_t i = 0; i < count; ++i) items[i] = order ? order[i] : i;
    const result done = render_layout_open(b->g, &(render_layout_zone){items, count}, 1, &b->r, out);
    memory_free(allocator_heap(), items, count, sizeof *items);
    return done;
}

void bed_draw(bed *b, const render_layout *l, const cull_run *runs, uint32_t run_count)
{
    const uint32_t still = b->s->item_count;
    for (uint32_t i = 0; i < run_count; ++i) {
        const uint32_t end = runs[i].first + runs[i].count, end_still = end < still ? end : still;
        if (runs[i].first < end_still) renderer_draw(b->g, l, 0, &(cull_run){runs[i].first, end_still - runs[i].first}, 1);
        for (uint32_t place = runs[i].first > still ? runs[i].first : still; place < end; ++place)
            renderer_draw_movers(b->g, l, &(uint32_t){place - still}, 1);
    }
}

uint32_t bed_collect(bed *b, collect how, uint32_t frame, cull_answer *answers, uint32_t capacity, uint32_t *stalled)
{
    return renderer_collect(b->g, &(collect_request){b->l, 0, frame, how}, answers, capacity, stalled);
}

uint8_t *bed_frame(bed *b, const frame_request *q, const render_layout *l, const cull_run *runs, uint32_t run_count)
{
    uint8_t *rgba = memory_alloc(allocator_heap(), (size_t)q->width_px * q->height_px, 4);
    assert_non_null(rgba);
    assert_int_equal(renderer_begin(b->g, q, &b->r), RESULT_OK);
    bed_draw(b, l, runs, run_count);
    renderer_end(b->g);
    assert_int_equal(renderer_read(b->g, rgba, &b->r), RESULT_OK);
    return rgba;
}
