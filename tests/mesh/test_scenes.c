// Real meshes: nothing lost, clusters sound, and delft the same wherever it stands.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// An oracle of its own for plain files: v and f only, faces as fans.
typedef struct plain {
    uint32_t faces, triangles; // triangles: with area
    double area;
} plain;

static double fan_area(const double (*p)[3], uint32_t a, uint32_t b, uint32_t c)
{
    double u[3], v[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = p[b][k] - p[a][k];
        v[k] = p[c][k] - p[a][k];
    }
    const double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
    return sqrt(x * x + y * y + z * z) / 2;
}

static plain read_plain(const char *text)
{
    plain out = {0};
    uint32_t count = 0, capacity = 1 << 20, corners[64];
    double(*p)[3] = malloc(capacity * sizeof *p);
    assert_non_null(p);
    for (const char *line = text; line; line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL) {
        if (line[0] == 'v' && line[1] == ' ') {
            assert_true(count < capacity);
            assert_int_equal(sscanf(line, "v %lf %lf %lf", &p[count][0], &p[count][1], &p[count][2]), 3);
            count++;
        }
        if (line[0] != 'f' || line[1] != ' ') continue;
        uint32_t n = 0;
        for (const char *at = line + 1; *at == ' ' && n < 64;) {
            char *end;
            corners[n] = (uint32_t)strtoul(at, &end, 10) - 1;
            n += end != at;
            for (at = end; *at && *at != ' ' && *at != '\n' && *at != '\r'; ++at) {}
        }
        out.faces++;
        for (uint32_t i = 1; i + 1 < n; ++i) {
            const double area = fan_area((const double(*)[3])p, corners[0], corners[i], corners[i + 1]);
            out.area += area;
            out.triangles += area > 0;
        }
    }
    free(p);
    return out;
}

static scene *import_text(const char *text, size_t size)
{
    report quiet = {0};
    scene *s = NULL;
    assert_int_equal(import_obj("scene.obj", text, size, allocator_heap(), &quiet, &s), RESULT_OK);
    assert_clusters_are_sound(s);
    return s;
}

static void every_model_comes_in_whole(void **state)
{
    static const char *const names[] = {"models/stanford-bunny.obj", "models/spot.obj", "models/fandisk.obj", "models/teapot.obj",
                                        "models/cow.obj", "models/suzanne.obj"};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        size_t size;
        char *text = scene_file(names[i], &size);
        const plain expected = read_plain(text);
        scene *s = import_text(text, size);
        assert_int_equal(s->index_count / 3, expected.triangles);
        assert_true(s->polygon_count <= expected.faces);
        const double folds = expected.triangles > expected.faces ? 1e-2 : 1e-6; // bent quads fold along either diagonal
        assert_true(fabs(scene_area(s) - expected.area) < folds * expected.area);
        assert_true(s->item_count < 2 * (s->index_count / 3 / 128 + 1));
        remove_scene(s);
        free(text);
    }
}

static void delft_has_its_570_objects_and_all_its_triangles(void **state)
{
    size_t size;
    (void)state;
    char *text = scene_file("city/delft.obj", &size);
    const plain expected = read_plain(text);
    scene *s = import_text(text, size);
    assert_int_equal(s->object_count, 570);
    assert_int_equal(s->polygon_count, 36267);
    assert_int_equal(expected.triangles, 36267); // none of its faces is without area
    assert_int_equal(s->index_count, 3 * 36267);
    assert_true(fabs(scene_area(s) - expected.area) < 1e-6 * expected.area);
    for (uint32_t o = 0; o < s->object_count; ++o) {
        assert_true(s->objects[o].item_count >= 1);
        for (uint32_t i = 0; i < s->objects[o].item_count; ++i) assert_int_equal(s->items[s->objects[o].first_item + i].object, o);
    }
    remove_scene(s);
    free(text);
}

static char *move_text(const char *text, const double move[3], size_t *size)
{
    const size_t room = 3 * strlen(text) + 1024;
    char *moved = malloc(room), *at = moved;
    assert_non_null(moved);
    for (const char *line = text; *line;) {
        const char *next = strchr(line, '\n');
        next = next ? next + 1 : line + strlen(line);
        double p[3];
        if (line[0] == 'v' && line[1] == ' ' && sscanf(line, "v %lf %lf %lf", &p[0], &p[1], &p[2]) == 3)
            at += snprintf(at, room - (size_t)(at - moved), "v %.3f %.3f %.3f\n", p[0] + move[0], p[1] + move[1], p[2] + move[2]);
        else {
            memcpy(at, line, (size_t)(next - line));
            at += next - line;
        }
        line = next;
    }
    *at = 0;
    *size = (size_t)(at - moved);
    return moved;
}

static void delft_moved_by_kilometres_is_the_same_scene(void **state)
{
    static const double move[3] = {85000, 0, 446000};
    size_t size, moved_size;
    (void)state;
    char *text = scene_file("city/delft.obj", &size);
    char *moved_text = move_text(text, move, &moved_size);
    scene *here = import_text(text, size), *there = import_text(moved_text, moved_size);
    assert_int_equal(there->object_count, 570);
    assert_int_equal(there->item_count, here->item_count);
    for (uint32_t i = 0; i < here->item_count; ++i) {
        assert_int_equal(there->items[i].index_count, here->items[i].index_count);
        assert_int_equal(there->items[i].polygon_count, here->items[i].polygon_count);
        assert_int_equal(there->items[i].object, here->items[i].object);
        assert_int_equal(there->items[i].flags, here->items[i].flags);
    }
    for (int k = 0; k < 3; ++k) assert_true(there->whole.origin[k] - here->whole.origin[k] == move[k]);
    for (uint32_t i = 0; i < here->index_count; ++i) { // relative to the origins, each corner is the same to the bit
        const cull_vec3 a = here->positions[here->indices[i]], b = there->positions[there->indices[i]];
        assert_memory_equal(&a, &b, sizeof a);
    }
    remove_scene(here);
    remove_scene(there);
    free(text);
    free(moved_text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_model_comes_in_whole),
        cmocka_unit_test(delft_has_its_570_objects_and_all_its_triangles),
        cmocka_unit_test(delft_moved_by_kilometres_is_the_same_scene),
    };
    return cmocka_run_group_tests_name("scenes", tests, NULL, NULL);
}
