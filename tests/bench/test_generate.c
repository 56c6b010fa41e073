// Generated scenes: exact sizes, same bytes from the same seed, closed surfaces, nested sets, refusals.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "bench/generate.h"
#include "host/core/memory.h"
#include "host/import/import.h"
#include "obj_probe.h"

#include <errno.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>
#include <cmocka.h>

#define COUNT_OF(items) (sizeof(items) / sizeof *(items))
#define CLOSE_ENOUGH 1e-6 // cubic metres: sums of some 10^5 products of exact decimals below 10^6

static const char folder[] = "generated"; // in the build tree, where CTest runs the tests

static int folder_make(void **state)
{
    (void)state;
    return mkdir(folder, 0700) == 0 || errno == EEXIST ? 0 : -1;
}

static int folder_remove(void **state)
{
    (void)state;
    return rmdir(folder);
}

typedef struct target { char name[64], views[64]; } target;

static target target_of(const char *name)
{
    target t;
    snprintf(t.name, sizeof t.name, "%s/%s", folder, name);
    snprintf(t.views, sizeof t.views, "%s/demo.views", folder);
    return t;
}

static void target_remove(const target *t)
{
    unlink(t->name);
    unlink(t->views);
}

static target made(const char *kind, uint64_t size, uint64_t seed)
{
    const target t = target_of(strcmp(kind, "demo") == 0 ? "demo.obj" : strcmp(kind, "rooms") == 0 ? "rooms.obj" : "some.boxes");
    report r = report_to_stderr();
    assert_int_equal(generate_scene(kind, size, seed, t.name, allocator_heap(), &r), RESULT_OK);
    return t;
}

static char *bytes_made(const char *kind, uint64_t size, uint64_t seed)
{
    const target t = made(kind, size, seed);
    size_t length = 0;
    char *bytes = bytes_of_file(t.name, &length);
    assert_non_null(bytes);
    assert_int_equal(strlen(bytes), length);
    target_remove(&t);
    return bytes;
}

static const struct { const char *kind; uint64_t size; } samples[] = {
    {"city", 500}, {"swarm", 500}, {"rooms", 12}, {"demo", GENERATE_SIZE_OF_KIND}};

static void the_same_seed_gives_the_same_bytes_and_another_one_others(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        char *first = bytes_made(samples[i].kind, samples[i].size, 7), *again = bytes_made(samples[i].kind, samples[i].size, 7);
        char *other = bytes_made(samples[i].kind, samples[i].size, 8);
        assert_string_equal(first, again);
        assert_string_not_equal(first, other);
        free(first);
        free(again);
        free(other);
    }
}

static void every_compiler_and_machine_gives_these_bytes(void **state)
{
    static const uint64_t golden[COUNT_OF(samples)] = {0x32e42f294079023e, 0x1d830de7dd2e8980, 0x64a08091bcdd3ca3, 0x27cfb74ff1923d47};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        char *bytes = bytes_made(samples[i].kind, samples[i].size, 1);
        const uint64_t hash = XXH3_64bits(bytes, strlen(bytes));
        if (hash != golden[i]) print_message("%s: 0x%016llx\n", samples[i].kind, (unsigned long long)hash);
        assert_true(hash == golden[i]);
        free(bytes);
    }
}

// ---- Boxes ----

typedef struct box_line { char words[96]; } box_line;

static int by_words(const void *left, const void *right)
{
    return strcmp(((const box_line *)left)->words, ((const box_line *)right)->words);
}

static box_line *boxes_made(const char *kind, size_t size)
{
    char *bytes = bytes_made(kind, size, 3), *rest = NULL;
    size_t said = 0, count = 0;
    box_line *lines = calloc(size, sizeof *lines);
    assert_non_null(lines);
    for (char *line = strtok_r(bytes, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        double b[6];
        if (!said) {
            assert_int_equal(sscanf(line, "boxes %zu", &said), 1);
            continue;
        }
        assert_int_equal(sscanf(line, "%lf %lf %lf %lf %lf %lf", &b[0], &b[1], &b[2], &b[3], &b[4], &b[5]), 6);
        for (int n = 0; n < 3; ++n) assert_true(b[n] < b[n + 3]);
        assert_true(count < size);
        snprintf(lines[count++].words, sizeof lines->words, "%s", line);
    }
    assert_int_equal(said, size);
    assert_int_equal(count, size);
    free(bytes);
    return lines;
}

static void a_city_or_swarm_has_as_many_proper_boxes_as_asked_for(void **state)
{
    static const size_t sizes[] = {1, 2, 27, 28, 29, 1000, 4567};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(sizes); ++i) {
        free(boxes_made("city", sizes[i]));
        free(boxes_made("swarm", sizes[i]));
    }
}

static void a_smaller_city_is_part_of_every_larger_one(void **state)
{
    static const size_t sizes[] = {1, 28, 111, 112, 113, 999, 5000};
    (void)state;
    for (size_t i = 0; i + 1 < COUNT_OF(sizes); ++i) {
        box_line *small = boxes_made("city", sizes[i]), *large = boxes_made("city", sizes[i + 1]);
        qsort(large, sizes[i + 1], sizeof *large, by_words);
        for (size_t k = 0; k < sizes[i]; ++k) assert_non_null(bsearch(&small[k], large, sizes[i + 1], sizeof *large, by_words));
        free(small);
        free(large);
    }
}

static void a_city_holds_the_boxes_nearest_the_origin_in_mixed_order(void **state)
{
    enum { SMALL = 400, LARGE = 3000 };
    (void)state;
    box_line *small = boxes_made("city", SMALL), *large = boxes_made("city", LARGE);
    double farthest = 0;
    size_t nearer = 0, ordered = 0;
    for (size_t i = 0; i < SMALL + LARGE; ++i) {
        double b[6];
        const char *words = i < SMALL ? small[i].words : large[i - SMALL].words;
        assert_int_equal(sscanf(words, "%lf %lf %lf %lf %lf %lf", &b[0], &b[1], &b[2], &b[3], &b[4], &b[5]), 6);
        const double distance = fmax(fabs(b[0] + b[3]), fabs(b[2] + b[5]));
        if (i < SMALL) {
            ordered += distance >= farthest;
            farthest = fmax(farthest, distance);
        } else nearer += distance < farthest;
    }
    assert_true(nearer <= SMALL - 1);
    assert_true(ordered < SMALL / 4); // sorted boxes would be a gift to trees
    free(small);
    free(large);
}

static void a_smaller_swarm_begins_every_larger_one(void **state)
{
    (void)state;
    box_line *small = boxes_made("swarm", 50), *large = boxes_made("swarm", 300);
    assert_memory_equal(small, large, 50 * sizeof *small);
    free(small);
    free(large);
}

// ---- Rooms ----

static int all(const probe_polygon *p, const char *name)
{
    (void)name;
    (void)p;
    return 1;
}

static int is_furniture(const probe_polygon *p, const char *name)
{
    (void)name;
    return strcmp(p->material, "furniture") == 0;
}

static int is_shell(const probe_polygon *p, const char *name)
{
    (void)name;
    return !is_furniture(p, NULL);
}

static void rooms_are_as_many_objects_as_asked_for_and_closed(void **state)
{
    static const uint64_t sizes[] = {1, 2, 3, 7, 16, 50};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(sizes); ++i) {
        const target t = made("rooms", sizes[i], 5);
        probe p = probe_read(t.name);
        assert_int_equal(p.object_count, sizes[i]);
        assert_int_equal(probe_open_edges(&p, all, NULL), 0);
        assert_int_equal(probe_parts(&p, is_shell, NULL), 1); // so every room can be reached from every other
        probe_free(&p);
        target_remove(&t);
    }
}

static void rooms_enclose_the_air_of_rooms_and_doorways_but_for_the_furniture(void **state)
{
    enum { ROOMS = 40 };
    (void)state;
    const target t = made("rooms", ROOMS, 11);
    probe p = probe_read(t.name);
    size_t frames = 0;
    for (size_t i = 0; i < p.polygon_count; ++i) frames += strcmp(p.polygons[i].material, "doorframe") == 0;
    assert_true(frames % 4 == 0 && frames / 4 >= ROOMS - 1);
    const double air = ROOMS * 8.0 * 8.0 * 3.0 + (double)(frames / 4) * 1.0 * 2.1 * 0.25; // seen from inside: negative
    assert_true(fabs(probe_volume(&p, is_shell, NULL) + air) < CLOSE_ENOUGH);
    const double furniture = probe_volume(&p, is_furniture, NULL);
    assert_true(furniture > ROOMS && furniture < air / 3);
    probe_free(&p);
    target_remove(&t);
}

// ---- The demo scene ----

static int is_museum(const probe_polygon *p, const char *name)
{
    (void)name;
    static const char *const names[] = {"museum", "figures", "rings", "rotunda", "hall", "library", "vases"};
    for (size_t i = 0; i < COUNT_OF(names); ++i)
        if (strcmp(p->object, names[i]) == 0) return 1;
    return 0;
}

static int is_object(const probe_polygon *p, const char *name)
{
    return strcmp(p->object, name) == 0;
}

static void the_demo_has_the_size_that_a_first_look_can_bear(void **state)
{
    (void)state;
    const target t = made("demo", GENERATE_SIZE_OF_KIND, GENERATE_SEED_OF_KIND);
    size_t size = 0;
    char *bytes = bytes_of_file(t.name, &size);
    probe p = probe_read(t.name);
    assert_true(size < 6u << 20);
    assert_true(p.triangle_count >= 40000 && p.triangle_count <= 80000);
    free(bytes);
    probe_free(&p);
    target_remove(&t);
}

static void the_museum_and_its_exhibits_are_solid(void **state)
{
    static const char *const names[] = {"knot", "ring_0", "ball_1", "figure_0", "founder", "column_0", "column_7", "vase_0", "vase_4",
                                        "lamp_0", "tree_0", "pedestal_0", "bookcase_1", "car_3", "bench_0", "desk", "table", "parapet"};
    (void)state;
    const target t = made("demo", GENERATE_SIZE_OF_KIND, GENERATE_SEED_OF_KIND);
    probe p = probe_read(t.name);
    assert_int_equal(probe_open_edges(&p, is_museum, NULL), 0);
    assert_int_equal(probe_parts(&p, is_museum, NULL), 1);
    assert_true(probe_volume(&p, is_museum, NULL) > 0);
    for (size_t i = 0; i < COUNT_OF(names); ++i) {
        if (probe_open_edges(&p, is_object, names[i]) || probe_volume(&p, is_object, names[i]) <= 0) print_message("not solid: %s\n", names[i]);
        assert_int_equal(probe_open_edges(&p, is_object, names[i]), 0);
        assert_true(probe_volume(&p, is_object, names[i]) > 0);
    }
    probe_free(&p);
    target_remove(&t);
}

static void the_demo_walk_passes_through_no_surface(void **state)
{
    (void)state;
    const target t = made("demo", GENERATE_SIZE_OF_KIND, GENERATE_SEED_OF_KIND);
    probe p = probe_read(t.name);
    FILE *views = fopen(t.views, "r");
    assert_non_null(views);
    const double in_the_hall[3] = {0.5, 1, -6}, above_the_roof[3] = {0.5, 8, -6};
    assert_int_equal(probe_crossings(&p, in_the_hall, above_the_roof), 2); // ceiling and roof: the probe sees
    double eye[3], before[3], rest[10];
    int count = 0;
    while (fscanf(views, "%lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf", &eye[0], &eye[1], &eye[2], &rest[0], &rest[1], &rest[2],
                  &rest[3], &rest[4], &rest[5], &rest[6], &rest[7], &rest[8], &rest[9]) == 13) {
        assert_true(fabs(rest[0] * rest[0] + rest[1] * rest[1] + rest[2] * rest[2] - 1) < 1e-5);
        const size_t crossed = count ? probe_crossings(&p, before, eye) : 0;
        if (crossed) print_message("view %d comes through a surface\n", count);
        assert_int_equal(crossed, 0);
        memcpy(before, eye, sizeof before);
        count++;
    }
    assert_int_equal(count, 120);
    fclose(views);
    probe_free(&p);
    target_remove(&t);
}

// ---- What importers make of them ----

static void importers_read_them_and_find_the_boxes_and_rooms(void **state)
{
    static const struct { const char *kind; uint64_t size; uint32_t objects, items; } expected[] = {
        {"city", 300, 0, 300}, {"swarm", 200, 0, 200}, {"rooms", 9, 9, 0}, {"demo", GENERATE_SIZE_OF_KIND, 0, 0}};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(expected); ++i) {
        const target t = made(expected[i].kind, expected[i].size, 1);
        report r = report_to_stderr();
        scene *s = NULL;
        assert_int_equal(import_scene(t.name, &(import_options){DOORS_OPEN}, allocator_heap(), &r, &s), RESULT_OK);
        assert_int_equal(r.warnings, 0);
        if (expected[i].objects) assert_int_equal(s->object_count, expected[i].objects);
        if (expected[i].items) assert_int_equal(s->item_count, expected[i].items);
        assert_true(s->item_count > 0);
        scene_free(s, allocator_heap());
        target_remove(&t);
    }
}

// ---- Refusals ----

static void line_keep(void *user, report_level level, const char *words)
{
    (void)level;
    snprintf(user, 256, "%s", words);
}

static void wrong_wishes_are_refused_in_a_line_and_nothing_is_written(void **state)
{
    static const struct { const char *kind; uint64_t size; const char *file, *says; } wishes[] = {
        {"town", 5, "a.boxes", "city, swarm, rooms, maze, house, demo, flagship"}, {"city", 0, "a.boxes", "1 to 10000000 boxes"},
        {"city", 10000001, "a.boxes", "not 10000001"},      {"swarm", 0, "a.boxes", "--size"},
        {"rooms", 0, "a.obj", "rooms, not 0"},              {"rooms", 100001, "a.obj", "1 to 100000"},
        {"demo", 3, "demo.obj", "leave --size out"},        {"city", 5, "a.obj", ".boxes"},
        {"demo", GENERATE_SIZE_OF_KIND, ".obj", ".obj"},    {"rooms", 2, "a.boxes", ".obj"},
        {"city", 5, "none/a.boxes", "cannot write"},        {"demo", GENERATE_SIZE_OF_KIND, "none/demo.obj", "cannot write"}};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(wishes); ++i) {
        char said[256] = "";
        report r = {.line = line_keep, .user = said};
        target t = target_of(wishes[i].file);
        if (wishes[i].file[0] == '.') snprintf(t.name, sizeof t.name, "%s", wishes[i].file);
        assert_int_equal(generate_scene(wishes[i].kind, wishes[i].size, 1, t.name, allocator_heap(), &r), RESULT_BAD_INPUT);
        assert_int_equal(r.errors, 1);
        assert_non_null(strstr(said, wishes[i].says));
        assert_int_not_equal(access(t.name, F_OK), 0);
        assert_int_not_equal(access(t.views, F_OK), 0);
    }
}

static void a_walk_that_cannot_be_written_takes_its_scene_along(void **state)
{
    (void)state;
    char said[256] = "", taken[80];
    report r = {.line = line_keep, .user = said};
    const target t = target_of("demo.obj");
    snprintf(taken, sizeof taken, "%s/here", t.views); // a folder that isn't empty has the walk's name
    assert_int_equal(mkdir(t.views, 0700), 0);
    assert_int_equal(mkdir(taken, 0700), 0);
    assert_int_equal(generate_scene("demo", GENERATE_SIZE_OF_KIND, 1, t.name, allocator_heap(), &r), RESULT_BAD_INPUT);
    assert_int_not_equal(access(t.name, F_OK), 0);
    rmdir(taken);
    rmdir(t.views);
}

typedef struct failing_heap { uint32_t left; long blocks; } failing_heap;

static void *failing_alloc(void *user, size_t size, size_t align)
{
    failing_heap *h = user;
    if (h->left == 0) return NULL;
    h->left--;
    void *block = allocator_heap()->alloc(NULL, size, align);
    h->blocks += block != NULL;
    return block;
}

static void failing_free(void *user, void *block, size_t size)
{
    if (block) ((failing_heap *)user)->blocks--;
    allocator_heap()->free(NULL, block, size);
}

static void whichever_allocation_fails_nothing_is_written_or_lost(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        const target t = target_of(i < 2 ? "some.boxes" : "demo.obj");
        result done = RESULT_NO_MEMORY;
        uint32_t allowed = 0;
        for (; done == RESULT_NO_MEMORY && allowed < 200; ++allowed) {
            failing_heap h = {.left = allowed};
            const allocator memory = {failing_alloc, failing_free, &h};
            report r = {0};
            done = generate_scene(samples[i].kind, samples[i].size, 1, t.name, &memory, &r);
            assert_int_equal(h.blocks, 0);
            assert_int_equal(access(t.name, F_OK) == 0, done == RESULT_OK);
        }
        assert_int_equal(done, RESULT_OK);
        assert_true(allowed > 1);
        target_remove(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_seed_gives_the_same_bytes_and_another_one_others),
        cmocka_unit_test(every_compiler_and_machine_gives_these_bytes),
        cmocka_unit_test(a_city_or_swarm_has_as_many_proper_boxes_as_asked_for),
        cmocka_unit_test(a_smaller_city_is_part_of_every_larger_one),
        cmocka_unit_test(a_city_holds_the_boxes_nearest_the_origin_in_mixed_order),
        cmocka_unit_test(a_smaller_swarm_begins_every_larger_one),
        cmocka_unit_test(rooms_are_as_many_objects_as_asked_for_and_closed),
        cmocka_unit_test(rooms_enclose_the_air_of_rooms_and_doorways_but_for_the_furniture),
        cmocka_unit_test(the_demo_has_the_size_that_a_first_look_can_bear),
        cmocka_unit_test(the_museum_and_its_exhibits_are_solid),
        cmocka_unit_test(the_demo_walk_passes_through_no_surface),
        cmocka_unit_test(importers_read_them_and_find_the_boxes_and_rooms),
        cmocka_unit_test(wrong_wishes_are_refused_in_a_line_and_nothing_is_written),
        cmocka_unit_test(a_walk_that_cannot_be_written_takes_its_scene_along),
        cmocka_unit_test(whichever_allocation_fails_nothing_is_written_or_lost),
    };
    return cmocka_run_group_tests_name("generate", tests, folder_make, folder_remove);
}
