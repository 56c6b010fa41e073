// Exact planes: from the builder to plugins, about each zone's own origin, and through a scene file.
// SPDX-License-Identifier: MIT
#include "pcs_fixture.h"

#include "host/core/exact_plane.h"
#include "host/core/zone_data.h"
#include "tests/common/random.h"

#include <math.h>
#include <string.h>

static const double GRID = 1024; // steps a metre

// A square in a plane across an axis, at whole steps, facing along the axis.
typedef struct square { int axis; int64_t at, low[2], size; } square;

static cull_exact_plane plane_of(const square *q)
{
    cull_exact_plane p = {{0, 0, 0}, -q->at};
    p.normal[q->axis] = 1;
    return p;
}

static void add_square(scene_builder *b, const square *q, const cull_exact_plane *exact)
{
    builder_vertex v[4] = {0};
    static const int corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    uint32_t first = 0;
    for (int i = 0; i < 4; ++i) {
        v[i].position[q->axis] = (double)q->at / GRID;
        for (int k = 0; k < 2; ++k) v[i].position[(q->axis + 1 + k) % 3] = (double)(q->low[k] + corners[i][k] * q->size) / GRID;
    }
    assert_int_equal(scene_builder_vertices(b, v, 4, 0, &first), RESULT_OK);
    const uint32_t triangles[6] = {first, first + 1, first + 2, first, first + 2, first + 3}, two = 2, loop[4] = {first, first + 1, first + 2, first + 3};
    builder_item item = {.indices = triangles, .polygon_triangles = &two, .loop = loop, .index_count = 6, .polygon_count = 1, .loop_count = 4,
                         .flags = CULL_ITEM_WALL, .exact = exact};
    item.plane[q->axis] = 1;
    item.plane[3] = -(double)q->at / GRID;
    assert_int_equal(scene_builder_item(b, &item), RESULT_OK);
}

static scene_builder *builder(double grid)
{
    scene_builder *b = NULL;
    uint32_t number = 0;
    assert_int_equal(scene_builder_open(allocator_heap(), &b), RESULT_OK);
    assert_int_equal(scene_builder_material(b, "m", 1, 0, &number), RESULT_OK);
    assert_int_equal(scene_builder_object(b, "o", 1, &number), RESULT_OK);
    if (grid > 0) scene_builder_grid(b, grid);
    return b;
}

static void add_room(scene_builder *b, const char *name, double low, double high)
{
    const scene_solid_plane planes[6] = {{{1, 0, 0}, high}, {{-1, 0, 0}, -low}, {{0, 1, 0}, 500}, {{0, -1, 0}, 500}, {{0, 0, 1}, 500}, {{0, 0, -1}, 500}};
    const builder_hull hull = {planes, 6};
    const char *fault = NULL;
    uint32_t zone = 0;
    assert_int_equal(scene_builder_zone(b, &(builder_zone){.name = name, .hulls = &hull, .hull_count = 1, .parent = SCENE_NONE}, &zone, &fault), RESULT_OK);
}

static scene *finished(scene_builder *b)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    if (scene_builder_finish(b, "t", &r, &s) != RESULT_OK) fail_msg("%s", h.text);
    scene_builder_close(b);
    return s;
}

static square random_square(uint64_t *seed)
{
    square q = {.axis = (int)random_below(seed, 3), .size = 1 + random_below(seed, 4096)};
    q.at = (int64_t)random_below(seed, 400000) - 200000;
    for (int k = 0; k < 2; ++k) q.low[k] = (int64_t)random_below(seed, 400000) - 200000;
    return q;
}

// Each wall's vertices lie in its exact plane, exactly; in integers.
static void assert_walls_lie_in_their_exact_planes(const cull_zone *z)
{
    assert_true(z->grid_steps_per_metre == GRID);
    for (uint32_t i = 0; i < z->item_count; ++i)
        for (uint32_t k = 0; k < z->walls[i].vertex_count; ++k) {
            const cull_vec3 p = z->positions[z->wall_vertices[z->walls[i].first_vertex + k]];
            const cull_exact_plane *e = &z->exact_planes[z->walls[i].plane];
            const double steps[3] = {(double)p.x * GRID, (double)p.y * GRID, (double)p.z * GRID};
            int64_t height = e->offset;
            for (int a = 0; a < 3; ++a) {
                assert_true(floor(steps[a]) == steps[a]);
                height += e->normal[a] * (int64_t)steps[a];
            }
            assert_int_equal(height, 0);
        }
}

static void each_zone_has_them_about_its_own_origin(void **state)
{
    (void)state;
    uint64_t seed = 31;
    scene_builder *b = builder(GRID);
    add_room(b, "left", -250, 0);
    add_room(b, "right", 0, 250);
    for (int i = 0; i < 500; ++i) {
        const square q = random_square(&seed);
        const cull_exact_plane exact = plane_of(&q);
        add_square(b, &q, &exact);
    }
    scene *s = finished(b);
    size_t size = 0;
    char *file = encoded_scene(s, &size);
    scene *back = opened(file, size);
    assert_non_null(s->exact_planes);
    assert_scenes_equal(s, back);
    for (uint32_t z = 0; z < back->zone_count; ++z) {
        zone_data data;
        assert_int_equal(zone_data_open(&(zone_data_request){back, z, 0}, allocator_heap(), &data), RESULT_OK);
        assert_true(data.zone.item_count > 100 && back->zones[z].origin[0] != back->whole.origin[0]);
        assert_walls_lie_in_their_exact_planes(&data.zone);
        zone_data_close(&data);
    }
    free_heap_scene(back);
    free_heap_scene(s);
    memory_free(allocator_heap(), file, size, 1);
}

// A grid step apart are two planes, however large the scene; and the same plane is one.
static void planes_are_shared_where_they_are_equal_exactly(void **state)
{
    (void)state;
    scene_builder *b = builder(GRID);
    const square far = {.axis = 0, .at = 8000000, .size = 1024}, squares[3] = {{.axis = 1, .at = 5, .size = 1024}, {.axis = 1, .at = 6, .size = 1024}, {.axis = 1, .at = 5, .size = 99}};
    cull_exact_plane exact = plane_of(&far);
    add_square(b, &far, &exact);
    for (int i = 0; i < 3; ++i) {
        exact = plane_of(&squares[i]);
        add_square(b, &squares[i], &exact);
    }
    scene *s = finished(b);
    assert_true(s->exact_planes && s->plane_count == 3);
    assert_int_equal(s->walls[1].plane, s->walls[3].plane);
    assert_int_not_equal(s->walls[1].plane, s->walls[2].plane);
    free_heap_scene(s);
}

typedef enum lacking { LACK_NOTHING, LACK_GRID, LACK_ONE, LACK_WHOLE_STEPS, LACK_BITS, LACK_PLACE } lacking;
static scene *scene_lacking(lacking what)
{
    scene_builder *b = builder(what == LACK_GRID ? 0 : what == LACK_WHOLE_STEPS ? GRID + 0.5 : GRID);
    const builder_transform aside = {{{1, 0, 0, 3}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    if (what == LACK_PLACE) assert_int_equal(scene_builder_transform(b, &aside), RESULT_OK);
    for (int i = 0; i < 3; ++i) {
        const square q = {.axis = i, .at = 9 + i, .low = {4096, 4096}, .size = 2048};
        cull_exact_plane exact = plane_of(&q);
        if (what == LACK_BITS) {
            exact.normal[i] = INT64_MAX / 2;
            exact.offset = -INT64_MAX;
        }
        add_square(b, &q, what == LACK_ONE && i == 1 ? NULL : &exact);
    }
    return finished(b);
}

static void a_scene_has_all_of_them_or_none(void **state)
{
    (void)state;
    for (lacking what = LACK_NOTHING; what <= LACK_PLACE; ++what) {
        scene *s = scene_lacking(what);
        assert_int_equal(s->exact_planes != NULL, what == LACK_NOTHING);
        assert_true(s->grid_steps_per_metre == (what == LACK_NOTHING ? GRID : 0));
        assert_int_equal(s->plane_count, 3);
        free_heap_scene(s);
    }
}

static void moving_a_plane_refuses_what_63_bits_do_not_hold(void **state)
{
    (void)state;
    const double none[3] = {0, 0, 0}, one[3] = {1, 0, 0}, far[3] = {1e18, 0, 0}, back[3] = {-1, 0, 0};
    const cull_exact_plane plain = {{3, -5, 7}, 11}, most = {{1, 0, 0}, INT64_MAX}, least = {{1, 0, 0}, -INT64_MAX}, steep = {{INT64_MAX / 2, 0, 0}, 0};
    cull_exact_plane out = {{1, 2, 3}, 4};
    assert_true(exact_plane_move(&plain, one, 256, &out));
    assert_true(out.normal[0] == 3 && out.normal[1] == -5 && out.normal[2] == 7 && out.offset == 11 + 3 * 256);
    assert_true(exact_plane_move(&most, none, 256, &out) && out.offset == INT64_MAX);
    assert_false(exact_plane_move(&most, one, 1, &out));
    assert_false(exact_plane_move(&least, back, 1, &out)); // INT64_MIN fits, its negative does not
    assert_false(exact_plane_move(&steep, one, 3, &out));
    assert_false(exact_plane_move(&plain, far, 1, &out));
    assert_false(exact_plane_move(&plain, one, 256.5, &out));
    assert_int_equal(out.offset, INT64_MAX); // untouched by what was refused
}

static void nonsense_about_them_is_refused(void **state)
{
    (void)state;
    scene *s = scene_lacking(LACK_NOTHING);
    size_t size = 0;
    char *file = encoded_scene(s, &size);
    static const struct { size_t at; int64_t value; const char *part; } lies[] = {
        {offsetof(cull_exact_plane, normal), 0, "faces another way"},
        {offsetof(cull_exact_plane, normal), -1, "faces another way"},
        {offsetof(cull_exact_plane, offset), 100, "lies elsewhere"},
    };
    for (size_t i = 0; i < sizeof lies / sizeof *lies; ++i) {
        heard h;
        report r = hear(&h);
        scene *back = NULL;
        cull_exact_plane kept;
        char *to = section_of(file, PCS_EXACT_PLANES);
        memcpy(&kept, to, sizeof kept);
        memcpy(to + lies[i].at, &lies[i].value, sizeof lies[i].value);
        sign(file, size);
        assert_int_equal(pcs_open("t.pcs", file, size, allocator_heap(), &r, &back), RESULT_BAD_INPUT);
        if (!strstr(h.text, lies[i].part)) fail_msg("%s", h.text);
        memcpy(to, &kept, sizeof kept);
    }
    free_heap_scene(s);
    memory_free(allocator_heap(), file, size, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_zone_has_them_about_its_own_origin),
        cmocka_unit_test(planes_are_shared_where_they_are_equal_exactly),
        cmocka_unit_test(a_scene_has_all_of_them_or_none),
        cmocka_unit_test(moving_a_plane_refuses_what_63_bits_do_not_hold),
        cmocka_unit_test(nonsense_about_them_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
