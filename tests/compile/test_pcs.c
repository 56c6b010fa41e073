// Scene files: what goes in comes out, all bits of it, from every importer; the bytes are the same each time.
// SPDX-License-Identifier: MIT
#include "pcs_fixture.h"

#include "host/core/file.h"
#include "tests/common/random.h"
#include "tests/common/scratch_folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void goes_round(const scene *s)
{
    size_t size = 0, size_again = 0;
    char *bytes = encoded_scene(s, &size);
    scene *back = opened(bytes, size);
    assert_scenes_equal(s, back);
    char *again = encoded_scene(back, &size_again);
    assert_int_equal(size, size_again);
    assert_memory_equal(bytes, again, size);
    memory_free(allocator_heap(), bytes, size, 1);
    memory_free(allocator_heap(), again, size_again, 1);
    free_heap_scene(back);
}

static void a_scene_of_everything_goes_round(void **state)
{
    (void)state;
    scene *s = everything_scene();
    assert_true(s->zone_count == 4 && s->stray_items > 0 && s->portal_count && s->door_count && s->mover_count == 2 && s->key_count == 2);
    assert_true(s->light_count == 2 && s->path_count == 1 && s->camera_count == 1 && s->walls && s->zones[0].chain && s->material_count);
    goes_round(s);
    free_heap_scene(s);
}

static void a_small_map_goes_round(void **state)
{
    (void)state;
    scene *s = small_map_scene();
    assert_true(s->texcoords && s->places && s->place_count == 2 && s->solid_count >= 3 && s->is_map && s->door_count == 1 && s->walls);
    goes_round(s);
    free_heap_scene(s);
}

static void real_scenes_go_round(void **state)
{
    (void)state;
    static const char *const others[] = {"models/cow.obj", "models/suzanne.obj", "city/delft.obj", "boxes/city-10000.boxes", NULL};
    const char *folder = getenv("PORTCULLIS_SCENES");
    uint32_t seen = 0;
    for (int i = 0; i < 8 || others[i - 8]; ++i) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", folder ? folder : ".", i < 8 ? real_maps[i] : others[i - 8]);
        heard h;
        report r = hear(&h);
        scene *s = NULL;
        if (import_scene(path, &doors_open, allocator_heap(), &r, &s) != RESULT_OK) {
            fprintf(stderr, "SKIPPED: %s\n", h.text);
            continue;
        }
        goes_round(s);
        free_heap_scene(s);
        ++seen;
    }
    if (!seen) skip();
}

// As flat as its reader wants it, which is 7 cm at this size.
static void a_wall_of_18_km_goes_round(void **state)
{
    (void)state;
    scene *s = json_of("{\"portcullis\": 1, \"walls\": [{\"points\": [[-9000, 0, -9000], [-9000, 0.05, 9000], [9000, 0, 9000], [9000, 0.05, -9000]]}]}", NULL);
    goes_round(s);
    free_heap_scene(s);
}

// ---- Whatever a builder takes ----

static void add_triangle(scene_builder *b, const double at[3], double size)
{
    builder_vertex v[3] = {0};
    uint32_t first = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) v[i].position[k] = at[k] + (i == k ? size : 0);
    assert_int_equal(scene_builder_vertices(b, v, 3, 0, &first), RESULT_OK);
    const uint32_t triangle[3] = {first, first + 1, first + 2};
    assert_int_equal(scene_builder_item(b, &(builder_item){.indices = triangle, .index_count = 3, .polygon_count = 1}), RESULT_OK);
}

static void add_half(scene_builder *b, const char *name, double side, double size)
{
    const double low = side < 0 ? -size : 0, high = side < 0 ? 0 : size;
    const scene_solid_plane planes[6] = {{{1, 0, 0}, high}, {{-1, 0, 0}, -low}, {{0, 1, 0}, size}, {{0, -1, 0}, size}, {{0, 0, 1}, size}, {{0, 0, -1}, size}};
    const builder_hull hull = {planes, 6};
    const char *fault = NULL;
    uint32_t zone = 0;
    assert_int_equal(scene_builder_zone(b, &(builder_zone){.name = name, .hulls = &hull, .hull_count = 1, .parent = SCENE_NONE}, &zone, &fault), RESULT_OK);
}

// Two halves of a cube of 2 `size`, a bent, dented many-sided portal of `width` between them, all of it turned and moved.
typedef struct halves { double size, width, far; uint64_t seed; } halves;
static result two_halves(const halves *q, scene **out)
{
    uint64_t seed = q->seed;
    scene_builder *b = NULL;
    uint32_t number = 0;
    const char *fault = NULL;
    double points[12][3];
    const double turn = random_between(&seed, 0, 6.28), c = cos(turn), n = sin(turn);
    const builder_transform placed = {{{c, 0, n, random_between(&seed, -q->far, q->far)}, {0, 1, 0, random_between(&seed, -q->far, q->far)}, {-n, 0, c, 0.25}}};
    const uint32_t count = 3 + random_below(&seed, 10);
    for (uint32_t i = 0; i < count; ++i) {
        const double angle = 6.283185307179586 * i / count, reach = q->width * random_between(&seed, 0.999, 1);
        points[i][0] = q->width * random_between(&seed, -1e-3, 1e-3) * (i % 2);
        points[i][1] = reach * cos(angle);
        points[i][2] = reach * sin(angle);
    }
    assert_int_equal(scene_builder_open(allocator_heap(), &b), RESULT_OK);
    assert_int_equal(scene_builder_material(b, "m", 1, 0, &number), RESULT_OK);
    assert_int_equal(scene_builder_object(b, "o", 1, &number), RESULT_OK);
    assert_int_equal(scene_builder_transform(b, &placed), RESULT_OK);
    add_half(b, "below", -1, q->size);
    add_half(b, "above", 1, q->size);
    const double at[2][3] = {{-q->size / 2, 0, 0}, {q->size / 2, 0, 0}};
    for (int i = 0; i < 2; ++i) add_triangle(b, at[i], q->size / 8);
    const builder_portal portal = {.name = "p", .points = (const double(*)[3])points, .point_count = count, .zones = {0, 1}, .door = SCENE_NONE};
    result done = scene_builder_portal(b, &portal, &number, &fault);
    report silent = {0};
    if (done == RESULT_OK) done = scene_builder_finish(b, "t", &silent, out);
    scene_builder_close(b);
    return done;
}

static void whatever_a_builder_takes_can_be_kept(void **state)
{
    (void)state;
    static const double sizes[] = {1e-3, 0.1, 4, 100, 8000}, widths[] = {1e-3, 0.05, 0.9}, fars[] = {0, 10, 1e5, 9e8};
    uint32_t taken = 0, tried = 0;
    for (int s = 0; s < 5; ++s)
        for (int w = 0; w < 3; ++w)
            for (int f = 0; f < 4; ++f)
                for (uint64_t seed = 1; seed <= 12; ++seed) {
                    scene *made = NULL;
                    ++tried;
                    if (two_halves(&(halves){sizes[s], widths[w] * sizes[s], fars[f], seed}, &made) != RESULT_OK) continue;
                    goes_round(made);
                    free_heap_scene(made);
                    ++taken;
                }
    assert_true(taken > tried / 3);
}

static void a_file_opens_by_its_ending_and_is_the_scene(void **state)
{
    (void)state;
    scratch_folder folder;
    char path[512];
    heard h;
    report r = hear(&h);
    scene *s = everything_scene(), *back = NULL;
    scratch_folder_make(&folder);
    scratch_folder_name(&folder, "Two.PCS", path, sizeof path);
    assert_int_equal(pcs_write(&(pcs_request){.scene = s}, path, allocator_heap(), &r), RESULT_OK);
    assert_int_equal(scratch_folder_count(&folder), 1);
    assert_int_equal(import_scene(path, &doors_open, allocator_heap(), &r, &back), RESULT_OK);
    assert_scenes_equal(s, back);
    assert_string_equal(back->path, path);
    free_heap_scene(back);
    free_heap_scene(s);
    scratch_folder_remove(&folder);
}

static void nothing_is_left_where_the_file_cannot_be_written(void **state)
{
    (void)state;
    scratch_folder folder;
    char path[512];
    heard h;
    report r = hear(&h);
    scene *s = everything_scene();
    scratch_folder_make(&folder);
    scratch_folder_name(&folder, "no/such.pcs", path, sizeof path);
    assert_int_equal(pcs_write(&(pcs_request){.scene = s}, path, allocator_heap(), &r), RESULT_BAD_INPUT);
    assert_int_equal(r.errors, 1);
    assert_int_equal(scratch_folder_count(&folder), 0);
    free_heap_scene(s);
    scratch_folder_remove(&folder);
}

// The same from every compiler and at every optimization: the numbers stand here.
static void the_bytes_are_the_same_everywhere(void **state)
{
    (void)state;
    scene *scenes[] = {everything_scene(), small_map_scene()};
    static const uint64_t golden[] = {UINT64_C(0xe7cd9cd12b9cda27), UINT64_C(0x4beac72ee7b56b8f)};
    for (int i = 0; i < 2; ++i) {
        size_t size = 0;
        char *bytes = encoded_scene(scenes[i], &size);
        const uint64_t hash = pcs_hash(bytes, size);
        if (hash != golden[i]) fail_msg("file %d has the hash 0x%016llx", i, (unsigned long long)hash);
        memory_free(allocator_heap(), bytes, size, 1);
        free_heap_scene(scenes[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scene_of_everything_goes_round),
        cmocka_unit_test(a_small_map_goes_round),
        cmocka_unit_test(real_scenes_go_round),
        cmocka_unit_test(a_wall_of_18_km_goes_round),
        cmocka_unit_test(whatever_a_builder_takes_can_be_kept),
        cmocka_unit_test(a_file_opens_by_its_ending_and_is_the_scene),
        cmocka_unit_test(nothing_is_left_where_the_file_cannot_be_written),
        cmocka_unit_test(the_bytes_are_the_same_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
