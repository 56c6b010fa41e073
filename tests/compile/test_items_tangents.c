// Tangents: there where worldspawn lists a normal map and nowhere else, along u, upright on the face, their sign that of the
// texture's turn; and in the scene file.
// SPDX-License-Identifier: MIT
#include "items_fixture.h"
#include "host/compile/pcs_write.h"
#include "host/import/pcs.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double COMPONENT = 1.5 / 511; // of a unit vector's component: 10 bits, and the sums' rounding

static void compile_rooms(compiled *c, const char *keys)
{
    static map_writer w;
    static const double post[2][3] = {{300, 100, 0}, {332, 132, 64}};
    write_rooms_alone(&w, keys);
    open_entity(&w, "func_wall");
    write_box(&w, post[0], post[1], "brass");
    close_entity(&w);
    write_inhabitants(&w);
    take_zones(c, input_of(w.text, NULL), PORTALS_NONE);
    take_items(c);
}

static uint32_t vertices_of(const scene *s, const char *material)
{
    uint32_t count = 0;
    for (uint32_t v = 0; v < s->position_count; ++v) count += strcmp(s->materials[s->vertex_materials[v]].name, material) == 0;
    return count;
}

static void without_a_normal_map_there_are_no_tangents_and_no_texture_coordinates(void **state)
{
    (void)state;
    static compiled c;
    compile_rooms(&c, "");
    assert_null(c.scene->tangents);
    assert_null(c.scene->texcoords);
    assert_int_equal(c.scene->tangent_count, 0);
    release(&c);
}

static void only_listed_materials_have_tangents(void **state)
{
    (void)state;
    static const struct {
        const char *list;
        int wall, brass;
    } cases[] = {{"brass", 0, 1}, {"wal", 0, 0}, {"wal*", 1, 0}, {"  brass  wall ", 1, 1}, {"*", 1, 1}, {"w*ll", 0, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        static compiled c;
        char keys[64];
        snprintf(keys, sizeof keys, "\"_normal_maps\" \"%s\"\n", cases[i].list);
        compile_rooms(&c, keys);
        const scene *s = c.scene;
        const uint32_t expected = (cases[i].wall ? vertices_of(s, "wall") : 0) + (cases[i].brass ? vertices_of(s, "brass") : 0);
        assert_int_equal(s->tangent_count, expected);
        assert_int_equal(s->tangents != NULL, expected != 0);
        assert_int_equal(s->texcoords != NULL, expected != 0);
        release(&c);
    }
}

static uint32_t tangent_of(const scene *s, uint32_t vertex) // its place; all materials have a normal map
{
    assert_int_equal(s->tangent_count, s->position_count);
    return s->tangents[vertex];
}

static void subtract(cull_vec3 a, cull_vec3 b, double out[3])
{
    out[0] = (double)a.x - (double)b.x;
    out[1] = (double)a.y - (double)b.y;
    out[2] = (double)a.z - (double)b.z;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// A step along the tangent moves u up; v's way is that of the binormal, turn * cross(normal, tangent).
static void expect_frame(const scene *s, const uint32_t t[3])
{
    double e[2][3], normal[3], tangent[3], binormal[3], du[2], dv[2];
    for (int k = 0; k < 2; ++k) {
        subtract(s->positions[t[k + 1]], s->positions[t[0]], e[k]);
        du[k] = (double)s->texcoords[2 * t[k + 1]] - (double)s->texcoords[2 * t[0]];
        dv[k] = (double)s->texcoords[2 * t[k + 1] + 1] - (double)s->texcoords[2 * t[0] + 1];
    }
    for (int k = 0; k < 3; ++k) normal[k] = e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
    const double length = sqrt(dot(normal, normal));
    for (int k = 0; k < 3; ++k) normal[k] /= length;
    for (int c = 0; c < 3; ++c) {
        int turn;
        scene_tangent_unpack(tangent_of(s, t[c]), tangent, &turn);
        for (int k = 0; k < 3; ++k) binormal[k] = turn * (normal[(k + 1) % 3] * tangent[(k + 2) % 3] - normal[(k + 2) % 3] * tangent[(k + 1) % 3]);
        assert_true(turn == 1 || turn == -1);
        assert_true(fabs(dot(normal, tangent)) < 3 * COMPONENT);
        // Edges in the frame (tangent, binormal) are the texture's up to one scale each, for these textures are not sheared.
        for (int k = 0; k < 2; ++k) {
            const double size = sqrt(dot(e[k], e[k]));
            assert_true(fabs(dot(e[k], tangent) - 2 * du[k]) < 3 * COMPONENT * size); // 64 units of 1/32 m are 1
            assert_true(fabs(dot(e[k], binormal) - 2 * dv[k]) < 3 * COMPONENT * size);
        }
    }
}

static void walls_have_tangents_along_u_upright_on_the_face(void **state)
{
    (void)state;
    static compiled c;
    compile_rooms(&c, "\"_normal_maps\" \"*\"\n");
    const scene *s = c.scene;
    assert_true(s->index_count > 100);
    for (uint32_t i = 0; i < s->index_count; i += 3) expect_frame(s, s->indices + i);
    release(&c);
}

// Two quads side by side, the texture of the second the first one's mirrored: they share the vertices of the middle.
static scene *mirrored_scene(void)
{
    static const double x[] = {0, 1, 2};
    static const float u[] = {0, 1, 0};
    static const uint32_t indices[] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    builder_vertex v[6];
    scene_builder *b;
    scene *s = NULL;
    uint32_t material, object, first;
    report_lines lines;
    report_lines_init(&lines);
    for (int i = 0; i < 6; ++i)
        v[i] = (builder_vertex){.position = {x[i % 3], i / 3, 0}, .normal = {0, 0, 1}, .texcoord = {u[i % 3], (float)(i / 3)}};
    assert_int_equal(scene_builder_open(allocator_heap(), &b), RESULT_OK);
    assert_int_equal(scene_builder_material(b, "skin", 4, MATERIAL_NORMAL_MAP, &material), RESULT_OK);
    assert_int_equal(scene_builder_object(b, "body", 4, &object), RESULT_OK);
    assert_int_equal(scene_builder_vertices(b, v, 6, material, &first), RESULT_OK);
    const builder_item item = {.indices = indices, .index_count = 12, .polygon_count = 4, .material = material, .object = object};
    assert_int_equal(scene_builder_item(b, &item), RESULT_OK);
    assert_int_equal(scene_builder_finish(b, "mirrored", &lines.report, &s), RESULT_OK);
    scene_builder_close(b);
    return s;
}

static void mirrored_halves_have_vertices_apart_each_with_its_sign(void **state)
{
    (void)state;
    scene *s = mirrored_scene();
    assert_int_equal(s->position_count, 8);
    assert_int_equal(s->tangent_count, 8);
    for (uint32_t i = 0; i < 12; ++i) {
        double tangent[3];
        int turn;
        const int is_left = i < 6;
        scene_tangent_unpack(s->tangents[s->indices[i]], tangent, &turn);
        assert_int_equal(turn, is_left ? 1 : -1);
        assert_true(tangent[0] == (is_left ? 1 : -1) && tangent[1] == 0 && tangent[2] == 0);
    }
    const cull_vec3 *p = s->positions;
    for (uint32_t v = 6; v < 8; ++v) { // the twins stand where those of the middle do
        const uint32_t of = p[1].y == p[v].y ? 1 : 4;
        assert_memory_equal(&p[of], &p[v], sizeof *p);
    }
    scene_free(s, allocator_heap());
}

// ---- In the scene file ----

static void tangents_go_through_the_scene_file(void **state)
{
    (void)state;
    scene *s = mirrored_scene(), *back = NULL;
    report_lines lines;
    void *bytes;
    size_t size;
    report_lines_init(&lines);
    assert_int_equal(pcs_encode(&(pcs_request){.scene = s}, "t.pcs", allocator_heap(), &lines.report, &bytes, &size), RESULT_OK);
    assert_int_equal(pcs_open("t.pcs", bytes, size, allocator_heap(), &lines.report, &back), RESULT_OK);
    assert_int_equal(back->tangent_count, s->tangent_count);
    assert_memory_equal(back->tangents, s->tangents, s->tangent_count * sizeof *s->tangents);
    assert_int_equal(back->materials[0].flags, MATERIAL_NORMAL_MAP);
    memory_free(allocator_heap(), bytes, size, 1);
    scene_free(back, allocator_heap());
    scene_free(s, allocator_heap());
}

static void nonsense_in_place_of_tangents_is_refused(void **state)
{
    (void)state;
    static const char *const faults[] = {"tangents that are not those of its normal maps", "a tangent that is no unit vector",
                                         "a tangent that is no unit vector", "a normal map without texture coordinates"};
    for (int i = 0; i < 4; ++i) {
        scene *s = mirrored_scene();
        const char *fault = NULL;
        if (i == 0) s->tangent_count--;
        else if (i == 1) s->tangents[3] &= ~(3u << 30); // no sign
        else if (i == 2) s->tangents[3] = 1u << 30;      // no length
        else s->texcoords = NULL;
        assert_int_equal(pcs_check(s, allocator_heap(), &fault), RESULT_OK);
        assert_string_equal(fault, faults[i]);
        scene_free(s, allocator_heap());
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_a_normal_map_there_are_no_tangents_and_no_texture_coordinates),
        cmocka_unit_test(only_listed_materials_have_tangents),
        cmocka_unit_test(walls_have_tangents_along_u_upright_on_the_face),
        cmocka_unit_test(mirrored_halves_have_vertices_apart_each_with_its_sign),
        cmocka_unit_test(tangents_go_through_the_scene_file),
        cmocka_unit_test(nonsense_in_place_of_tangents_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
