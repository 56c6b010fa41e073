// Scene files that are damaged, cut, or made up with the right hash: refused with one line, or sound; never a crash.
// SPDX-License-Identifier: MIT
#define _XOPEN_SOURCE 700
#include "pcs_fixture.h"

#include "host/core/zone_data.h"
#include "tests/common/scratch_folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct small_file { char *bytes, *copy; size_t size; } small_file;

static int make_files(void **state)
{
    small_file *files = calloc(2, sizeof *files);
    scene *scenes[2] = {everything_scene(), small_map_scene()};
    for (int i = 0; i < 2; ++i) {
        files[i].bytes = encoded_scene(scenes[i], &files[i].size);
        files[i].copy = malloc(files[i].size);
        memcpy(files[i].copy, files[i].bytes, files[i].size);
        free_heap_scene(scenes[i]);
    }
    *state = files;
    return 0;
}

static int drop_files(void **state)
{
    small_file *files = *state;
    for (int i = 0; i < 2; ++i) {
        memory_free(allocator_heap(), files[i].bytes, files[i].size, 1);
        free(files[i].copy);
    }
    free(files);
    return 0;
}

static void expect_refused(const void *bytes, size_t size, const char *part)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    if (pcs_open("t.pcs", bytes, size, allocator_heap(), &r, &s) != RESULT_BAD_INPUT) fail_msg("it opened; expected '%s'", part);
    assert_null(s);
    assert_int_equal(r.errors, 1);
    assert_memory_equal(h.text, "t.pcs: error: ", 14);
    if (!strstr(h.text, part)) fail_msg("expected '%s' in: %s", part, h.text);
}

static void every_byte_flipped_is_refused(void **state)
{
    const small_file *files = *state;
    for (int i = 0; i < 2; ++i)
        for (size_t at = 0; at < files[i].size; ++at)
            for (int bit = 0; bit < 8; bit += 7) {
                files[i].copy[at] = (char)(files[i].copy[at] ^ (1 << bit));
                expect_refused(files[i].copy, files[i].size, "");
                files[i].copy[at] = files[i].bytes[at];
            }
}

static void every_other_length_is_refused(void **state)
{
    const small_file *f = *state;
    char *longer = calloc(1, f->size + 256);
    memcpy(longer, f->bytes, f->size);
    for (size_t size = 0; size < f->size + 256; ++size)
        if (size != f->size) expect_refused(longer, size, size < sizeof(pcs_header) ? "too few" : "cut or added to");
    free(longer);
}

static void every_other_length_with_the_right_hash_and_size_is_refused(void **state)
{
    const small_file *f = *state;
    char *file = calloc(1, f->size + 256);
    for (size_t size = sizeof(pcs_header); size < f->size + 256; ++size) {
        if (size == f->size) continue;
        memset(file, 0, f->size + 256);
        memcpy(file, f->bytes, size < f->size ? size : f->size);
        pcs_header *head = (pcs_header *)(void *)file;
        head->file_bytes = size;
        sign(file, size);
        expect_refused(file, size, "is damaged");
    }
    free(file);
}

// What opens can be used: zones with all that plugins are lent.
static void open_and_use(const small_file *f)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    const result done = pcs_open("t.pcs", f->copy, f->size, allocator_heap(), &r, &s);
    assert_int_equal(r.errors, done != RESULT_OK);
    if (done != RESULT_OK) return;
    const char *fault = "";
    assert_int_equal(pcs_check(s, allocator_heap(), &fault), RESULT_OK);
    assert_null(fault);
    for (uint32_t z = 0; z < s->zone_count; ++z) {
        zone_data data = {0};
        assert_int_equal(zone_data_open(&(zone_data_request){s, z, 4}, allocator_heap(), &data), RESULT_OK);
        zone_data_close(&data);
    }
    free_heap_scene(s);
}

static void every_byte_changed_under_the_right_hash_is_refused_or_sound(void **state)
{
    const small_file *files = *state;
    static const unsigned char changes[] = {0x01, 0x80, 0xff};
    for (int i = 0; i < 2; ++i)
        for (size_t at = 0; at < files[i].size; ++at)
            for (size_t c = 0; c < sizeof changes; ++c) {
                files[i].copy[at] = (char)(files[i].copy[at] ^ (char)changes[c]);
                sign(files[i].copy, files[i].size);
                open_and_use(&files[i]);
                files[i].copy[at] = files[i].bytes[at];
                memcpy(files[i].copy, files[i].bytes, sizeof(pcs_header));
            }
}

// ---- Nonsense by name ----

typedef struct lie { // bytes of a section, written over
    pcs_id section;
    size_t at;
    double as_double;
    uint32_t as_number;
    enum { NUMBER, DOUBLE, FLOAT, BYTE } kind;
    const char *part;
} lie;

#define AT(type, place, field) ((place) * sizeof(type) + offsetof(type, field))
static const lie lies[] = {
    {PCS_SCENE, AT(pcs_scene, 0, step), 0.003, 0, DOUBLE, "no power of two"},
    {PCS_SCENE, AT(pcs_scene, 0, step), NAN, 0, DOUBLE, "no power of two"},
    {PCS_SCENE, AT(pcs_scene, 0, origin), 0.5, 0, DOUBLE, "not whole metres"},
    {PCS_SCENE, AT(pcs_scene, 0, radius), 9, 0, FLOAT, "largest coordinate"},
    {PCS_SCENE, AT(pcs_scene, 0, box), 9, 0, FLOAT, "a box of everything"},
    {PCS_SCENE, AT(pcs_scene, 0, is_map), 0, 2, NUMBER, "neither a map"},
    {PCS_SCENE, AT(pcs_scene, 0, grid_steps_per_metre), 256, 0, DOUBLE, "a grid without"},
    {PCS_TEXT, 5, 0, 'x', BYTE, NULL},
    {PCS_MATERIALS, AT(pcs_material, 0, name), 0, 1u << 30, NUMBER, "outside of the texts"},
    {PCS_MATERIALS, AT(pcs_material, 0, flags), 0, 64, NUMBER, "a material with flags"},
    {PCS_OBJECTS, AT(pcs_object, 0, item_count), 0, 1u << 31, NUMBER, "an object of items"},
    {PCS_POSITIONS, 4, NAN, 0, FLOAT, "not on the scene's step"},
    {PCS_POSITIONS, 4, 1e30, 0, FLOAT, "not on the scene's step"},
    {PCS_POSITIONS, 4, 0.7, 0, FLOAT, "not on the scene's step"},
    {PCS_POSITIONS, 4, -20, 0, FLOAT, "a box that is not its item's"},
    {PCS_NORMALS, 3, 0, 1, BYTE, "over three bytes"},
    {PCS_VERTEX_MATERIALS, 1, 0, 200, BYTE, "a vertex of a material"},
    {PCS_INDICES, 8, 0, UINT32_MAX, NUMBER, "a triangle of a vertex"},
    {PCS_POLYGON_FIRST_TRIANGLE, 0, 0, 1, NUMBER, "whose polygons are not its triangles"},
    {PCS_ITEMS, AT(scene_item, 1, first_index), 0, 3, NUMBER, "triangles do not follow"},
    {PCS_ITEMS, AT(scene_item, 0, index_count), 0, UINT32_MAX - 3, NUMBER, "triangles do not follow"},
    {PCS_ITEMS, AT(scene_item, 0, polygon_count), 0, 0, NUMBER, "polygons do not follow"},
    {PCS_ITEMS, AT(scene_item, 0, material), 0, 77, NUMBER, "an item of a material"},
    {PCS_ITEMS, AT(scene_item, 0, flags), 0, 1u << 5, NUMBER, "an item with flags"},
    {PCS_MIN_X, 0, -100, 0, FLOAT, "a box that is not its item's"},
    {PCS_WALLS, AT(cull_wall, 0, first_vertex), 0, 7, NUMBER, "walls whose vertices"},
    {PCS_MOVERS, AT(pcs_mover, 0, axes), 3, 0, DOUBLE, "axes are no turn"},
    {PCS_MOVERS, AT(pcs_mover, 0, pivot), INFINITY, 0, DOUBLE, "not finite"},
    {PCS_MOVERS, AT(pcs_mover, 0, door), 0, 5, NUMBER, "whose door does not move it"},
    {PCS_MOVERS, AT(pcs_mover, 1, key_count), 0, 3, NUMBER, "a path that is not there"},
    {PCS_MOVERS, AT(pcs_mover, 0, key_count), 0, 1, NUMBER, "share a path"},
    {PCS_MOVERS, AT(pcs_mover, 0, reserved), 0, 1, NUMBER, "bits that this version"},
    {PCS_MOVERS, AT(pcs_mover, 0, open_offset), 1e10, 0, DOUBLE, "opens beyond"},
    {PCS_KEYS, AT(scene_key, 1, offset), -1e300, 0, DOUBLE, "leads beyond"},
    {PCS_KEYS, AT(scene_key, 1, time_s), 0, 0, DOUBLE, "times do not rise"},
    {PCS_ZONES, AT(pcs_zone, 0, origin), 4, 0, DOUBLE, "a zone whose origin"},
    {PCS_ZONES, AT(pcs_zone, 2, parent), 0, 2, NUMBER, "in itself"},
    {PCS_ZONES, AT(pcs_zone, 0, flags), 0, 1, NUMBER, "everywhere, with a hull"},
    {PCS_ZONES, AT(pcs_zone, 0, flags), 0, 9, NUMBER, "a zone with flags"},
    {PCS_ZONES, AT(pcs_zone, 1, first_item), 0, 0, NUMBER, "zones whose items"},
    {PCS_ZONES, AT(pcs_zone, 0, item_count), 0, 0, NUMBER, "a zone whose origin"},
    {PCS_ZONES, AT(pcs_zone, 0, hull_count), 0, 0, NUMBER, "hulls"},
    {PCS_HULLS, AT(pcs_hull, 0, min), -1, 0, DOUBLE, "a hull whose box"},
    {PCS_HULLS, AT(pcs_hull, 0, zone), 0, 1, NUMBER, "hulls whose planes"},
    {PCS_HULL_PLANES, AT(scene_solid_plane, 0, normal), 2, 0, DOUBLE, "a hull's plane"},
    {PCS_ZONE_ITEMS, 0, 0, 1000, NUMBER, "whose items do not rise"},
    {PCS_LISTINGS, 0, 0, 9, BYTE, "fewer or more zones"},
    {PCS_PORTALS, AT(pcs_portal, 0, plane), 0.5, 0, DOUBLE, "a portal whose plane"},
    {PCS_PORTALS, AT(pcs_portal, 0, zones), 0, 1, NUMBER, "does not join two zones"},
    {PCS_PORTALS, AT(pcs_portal, 0, zones), 0, 50, NUMBER, "does not join two zones"},
    {PCS_PORTALS, AT(pcs_portal, 0, point_count), 0, 2, NUMBER, "under 3"},
    {PCS_PORTALS, AT(pcs_portal, 0, door), 0, 2, NUMBER, "a door that is not there"},
    {PCS_PORTAL_POINTS, 0, 0.1, 0, DOUBLE, "a portal's point"},
    {PCS_PORTAL_POINTS, 0, NAN, 0, DOUBLE, "a portal's point"},
    {PCS_ZONE_PORTALS, 0, 0, 1, NUMBER, "not its own"},
    {PCS_DOORS, AT(pcs_door, 0, at_rest), 0, 2, NUMBER, "neither open nor shut"},
    {PCS_DOORS, AT(pcs_door, 0, mover), 0, 1, NUMBER, "whose door does not move it"},
    {PCS_LIGHTS, AT(pcs_light, 0, kind), 0, 2, NUMBER, "a light of no known kind"},
    {PCS_LIGHTS, AT(pcs_light, 0, reach), NAN, 0, DOUBLE, "a light with a number"},
    {PCS_PATHS, AT(pcs_path, 0, camera_count), 0, 2, NUMBER, "camera paths"},
    {PCS_CAMERAS, AT(camera, 0, fovy_deg), 0, 0, DOUBLE, "a camera that sees nothing"},
};
static const lie map_lies[] = {
    {PCS_TEXCOORDS, 0, NAN, 0, FLOAT, "a texture coordinate"},
    {PCS_PLACES, AT(pcs_place, 0, kind), 0, 3, NUMBER, "a place of no known kind"},
    {PCS_PLACES, AT(pcs_place, 1, position), NAN, 0, DOUBLE, "a place that is nowhere"},
    {PCS_SOLIDS, AT(pcs_solid, 0, first_plane), 0, 1, NUMBER, "solids whose planes"},
    {PCS_SOLIDS, AT(pcs_solid, 0, min), 1e6, 0, DOUBLE, "inside out"},
    {PCS_SOLIDS, AT(pcs_solid, 0, kind), 0, 3, NUMBER, "a solid of no known kind"},
    {PCS_SOLID_PLANES, 0, 2, 0, DOUBLE, "a solid's plane"},
    {PCS_WALL_VERTICES, 0, 0, 12345, NUMBER, "a wall of a vertex"},
    {PCS_WALL_VERTICES, 0, 0, 50, NUMBER, "off its plane"},
    {PCS_PLANES, 0, 2, 0, FLOAT, "a wall's plane"},
    {PCS_WALLS, AT(cull_wall, 0, plane), 0, 900, NUMBER, "a plane that is not there"},
    {PCS_WALLS, AT(cull_wall, 0, reserved), 0, 1, NUMBER, "walls whose vertices"},
};

static void tell(const small_file *f, const lie *l)
{
    memcpy(f->copy, f->bytes, f->size);
    const float as_float = (float)l->as_double;
    const unsigned char as_byte = (unsigned char)l->as_number;
    char *to = section_of(f->copy, l->section) + l->at;
    assert_true(l->at < section_count(f->copy, l->section) * pcs_item_bytes[l->section]);
    if (l->kind == NUMBER) memcpy(to, &l->as_number, sizeof l->as_number);
    if (l->kind == DOUBLE) memcpy(to, &l->as_double, sizeof l->as_double);
    if (l->kind == FLOAT) memcpy(to, &as_float, sizeof as_float);
    if (l->kind == BYTE) *to = (char)as_byte;
    sign(f->copy, f->size);
    if (l->part) expect_refused(f->copy, f->size, l->part);
    else open_and_use(f);
    memcpy(f->copy, f->bytes, f->size);
}

static void each_lie_is_named(void **state)
{
    const small_file *files = *state;
    for (size_t i = 0; i < sizeof lies / sizeof *lies; ++i) tell(&files[0], &lies[i]);
    for (size_t i = 0; i < sizeof map_lies / sizeof *map_lies; ++i) tell(&files[1], &map_lies[i]);
}

static void other_versions_and_other_files_are_told_apart(void **state)
{
    const small_file *f = *state;
    memcpy(f->copy, f->bytes, f->size);
    f->copy[offsetof(pcs_header, version)]++;
    sign(f->copy, f->size);
    expect_refused(f->copy, f->size, "is of version 3, and version 2 is read here; compile it again");
    memcpy(f->copy, f->bytes, f->size);
    f->copy[offsetof(pcs_header, section_count)]++;
    sign(f->copy, f->size);
    expect_refused(f->copy, f->size, "a header that version 2 does not have");
    memcpy(f->copy, f->bytes, f->size);
    f->copy[0] = '{';
    expect_refused(f->copy, f->size, "is no compiled scene");
    memcpy(f->copy, f->bytes, f->size);
    f->copy[f->size - 1] ^= 1;
    expect_refused(f->copy, f->size, "do not give the hash");
    memcpy(f->copy, f->bytes, f->size);
}

// In the table: counts that wrap, that lie, and that are only too large for the file.
static void counts_that_overflow_are_refused(void **state)
{
    const small_file *f = *state;
    static const uint64_t counts[] = {UINT64_MAX, UINT64_MAX / 2, UINT64_C(1) << 61, UINT64_C(1) << 40, (UINT64_C(1) << 40) + 1, UINT64_C(1) << 32, UINT32_MAX, 100000};
    for (int id = 0; id < PCS_SECTION_COUNT; ++id)
        for (size_t c = 0; c < sizeof counts / sizeof *counts; ++c) {
            memcpy(f->copy, f->bytes, f->size);
            memcpy(f->copy + sizeof(pcs_header) + (size_t)id * sizeof(pcs_section) + offsetof(pcs_section, count), &counts[c], sizeof *counts);
            sign(f->copy, f->size);
            expect_refused(f->copy, f->size, "its sections do not fill it");
        }
    memcpy(f->copy, f->bytes, f->size);
}

static void what_no_machine_addresses_has_no_layout(void **state)
{
    (void)state;
    uint64_t offsets[PCS_SECTION_COUNT];
    pcs_counts counts = {{0}};
    const uint64_t empty = pcs_lay_out(&counts, offsets);
    assert_true(empty > 0 && empty % PCS_ALIGN == 0 && offsets[0] % PCS_ALIGN == 0);
    counts.of[PCS_BLOBS] = PCS_BYTES_MOST - empty;
    assert_true(pcs_lay_out(&counts, offsets) == PCS_BYTES_MOST);
    counts.of[PCS_BLOBS]++;
    assert_true(pcs_lay_out(&counts, offsets) == 0);
    counts.of[PCS_BLOBS] = 0;
    counts.of[PCS_CAMERAS] = UINT64_MAX / 8;
    assert_true(pcs_lay_out(&counts, offsets) == 0);
}

// Of holes only, so that no disk need hold it; refused by its size, before any memory is asked for.
static void a_file_over_a_tebibyte_is_refused(void **state)
{
    (void)state;
    scratch_folder folder;
    char path[512];
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    scratch_folder_make(&folder);
    scratch_folder_write(&folder, "huge.pcs", PCS_MAGIC, 8);
    scratch_folder_name(&folder, "huge.pcs", path, sizeof path);
    if (truncate(path, ((off_t)1 << 40) + 1) == 0) {
        assert_int_equal(import_scene(path, &doors_open, allocator_heap(), &r, &s), RESULT_BAD_INPUT);
        assert_non_null(strstr(h.text, "larger than 1024 GiB"));
    } else {
        fprintf(stderr, "SKIPPED: the file system holds no file of a tebibyte\n");
    }
    scratch_folder_remove(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_byte_flipped_is_refused),
        cmocka_unit_test(every_other_length_is_refused),
        cmocka_unit_test(every_other_length_with_the_right_hash_and_size_is_refused),
        cmocka_unit_test(every_byte_changed_under_the_right_hash_is_refused_or_sound),
        cmocka_unit_test(each_lie_is_named),
        cmocka_unit_test(counts_that_overflow_are_refused),
        cmocka_unit_test(what_no_machine_addresses_has_no_layout),
        cmocka_unit_test(a_file_over_a_tebibyte_is_refused),
        cmocka_unit_test(other_versions_and_other_files_are_told_apart),
    };
    return cmocka_run_group_tests(tests, make_files, drop_files);
}
