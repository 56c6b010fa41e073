// Bad maps through the whole compiler, and compiled scene files damaged: a clear error or a clean refusal, never a crash or
// a wrong load. Maps that fuzzing has found stand at the end.
// SPDX-License-Identifier: MIT
#include "host/import/pcs.h"
#include "input_fixture.h"
#include "whole_fixture.h"

#include <stdlib.h>
#include <string.h>

static void write_room(map_writer *w)
{
    static const double boxes[][2][3] = {{{-16, -16, -16}, {144, 144, 0}}, {{-16, -16, 128}, {144, 144, 144}}, {{-16, -16, 0}, {0, 144, 128}},
                                         {{128, -16, 0}, {144, 144, 128}}, {{0, -16, 0}, {128, 0, 128}},       {{0, 128, 0}, {128, 144, 128}}};
    w->size = 0;
    open_entity(w, "worldspawn");
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; ++i) write_box(w, boxes[i][0], boxes[i][1], "wall");
    close_entity(w);
    open_entity(w, "info_player_start");
    write_text(w, "\"origin\" \"64 64 32\"\n");
    close_entity(w);
}

static result compile_text(const char *text, size_t size, report *r, whole *out)
{
    return whole_compile(&(whole_map){text, size, 0, PORTALS_DOORS}, r, allocator_heap(), out);
}

// ---- Maps ----

static void expect_error(const map_writer *w, const char *part)
{
    report_lines lines;
    report_lines_init(&lines);
    whole made;
    assert_int_equal(compile_text(w->text, w->size, &lines.report, &made), RESULT_BAD_INPUT);
    assert_null(made.scene);
    assert_int_equal(lines.report.errors, 1);
    assert_true(lines.count > 0);
    if (!strstr(lines.lines[lines.count - 1], part)) fail_msg("expected '%s' in: %s", part, lines.lines[lines.count - 1]);
    whole_free(&made, allocator_heap());
}

static void an_empty_result_is_refused(void **state)
{
    (void)state;
    static const double box[2][3] = {{0, 0, 0}, {64, 64, 64}}, larger[2][3] = {{-8, -8, -8}, {72, 72, 72}};
    static const char *const classes[] = {"csg_subtract", "zone_portal", "info_player_start"};
    static const char part[] = "no polygon to draw; the scene is empty or holds tool surfaces only";
    map_writer *w = calloc(1, sizeof *w);
    for (size_t i = 0; i < sizeof classes / sizeof *classes; ++i) { // nothing that is solid
        w->size = 0;
        open_entity(w, classes[i]);
        if (i < 2) write_box(w, box[0], box[1], "wall");
        close_entity(w);
        expect_error(w, part);
    }
    w->size = 0;
    open_entity(w, "worldspawn"); // solid, but nothing of it is drawn
    write_box(w, box[0], box[1], "clip");
    close_entity(w);
    expect_error(w, part);
    w->size = 0;
    open_entity(w, "worldspawn"); // taken away again, all of it
    write_box(w, box[0], box[1], "wall");
    close_entity(w);
    open_entity(w, "csg_subtract");
    write_box(w, larger[0], larger[1], "wall");
    close_entity(w);
    expect_error(w, part);
    free(w);
}

static void a_map_cut_anywhere_compiles_or_is_refused(void **state)
{
    (void)state;
    map_writer *w = calloc(1, sizeof *w);
    write_room(w);
    uint32_t refused = 0;
    for (size_t size = 0; size <= w->size; ++size) {
        char *part = malloc(size + 1); // so that reading past the end is seen
        memcpy(part, w->text, size);
        report silent = {0};
        whole made;
        const result done = compile_text(part, size, &silent, &made);
        assert_int_equal(done != RESULT_OK, silent.errors == 1);
        assert_int_equal(done == RESULT_OK, made.scene != NULL);
        refused += done != RESULT_OK;
        whole_free(&made, allocator_heap());
        free(part);
    }
    assert_true(refused > w->size - 100 && refused < w->size);
    free(w);
}

static void a_leak_without_an_entity_is_none_and_all_is_sealed(void **state)
{
    (void)state;
    map_writer *w = calloc(1, sizeof *w);
    write_room(w);
    char *entity = strstr(w->text, "{\n\"classname\" \"info_player_start\"");
    assert_non_null(entity);
    report silent = {0};
    whole made;
    assert_int_equal(compile_text(w->text, (size_t)(entity - w->text), &silent, &made), RESULT_OK);
    assert_int_equal(made.zones->leak, 0);
    assert_int_equal(made.zones->zones_sealed, made.zones->zone_count);
    whole_free(&made, allocator_heap());
    free(w);
}

// ---- Files ----

typedef struct file { char *bytes; size_t size; } file;

static file compiled_room(void)
{
    map_writer *w = calloc(1, sizeof *w);
    write_room(w);
    report silent = {0};
    whole made;
    void *bytes = NULL;
    assert_int_equal(compile_text(w->text, w->size, &silent, &made), RESULT_OK);
    const size_t size = whole_encode(&made, allocator_heap(), &bytes);
    assert_true(size > 0);
    whole_free(&made, allocator_heap());
    free(w);
    return (file){bytes, size};
}

static void expect_refused(const char *bytes, size_t size)
{
    report_lines lines;
    report_lines_init(&lines);
    scene *s = NULL;
    assert_int_equal(pcs_open("t.pcs", bytes, size, allocator_heap(), &lines.report, &s), RESULT_BAD_INPUT);
    assert_null(s);
    assert_true(report_lines_is_one_with(&lines, "t.pcs: error: "));
}

static void any_byte_flipped_of_a_compiled_file_is_refused(void **state)
{
    (void)state;
    const file f = compiled_room();
    for (size_t at = 0; at < f.size; ++at)
        for (int kind = 0; kind < 2; ++kind) { // all bits, one bit
            const char mask = (char)(kind ? 1 << at % 8 : 0xff);
            f.bytes[at] = (char)(f.bytes[at] ^ mask);
            expect_refused(f.bytes, f.size);
            f.bytes[at] = (char)(f.bytes[at] ^ mask);
        }
    memory_free(allocator_heap(), f.bytes, f.size, 1);
}

static void any_other_length_of_a_compiled_file_is_refused(void **state)
{
    (void)state;
    const file f = compiled_room();
    char *longer = calloc(1, f.size + 128);
    memcpy(longer, f.bytes, f.size);
    for (size_t size = 0; size < f.size + 128; ++size)
        if (size != f.size) expect_refused(longer, size);
    free(longer);
    memory_free(allocator_heap(), f.bytes, f.size, 1);
}

// ---- Found by fuzzing ----

typedef struct slanted_box {
    const char *class_name, *texture;
    int min[3], max[3], face, by; // face: -x, +x, -y, ...; a corner of it is moved inward by as many units
} slanted_box;

static void write_slanted(map_writer *w, const slanted_box *b)
{
    static const int order[6][3] = {{0, 2, 4}, {1, 5, 3}, {0, 4, 1}, {2, 3, 6}, {0, 1, 2}, {4, 6, 5}}; // corners: bit k set, the far side along axis k
    open_entity(w, b->class_name);
    write_text(w, "{\n");
    for (int f = 0; f < 6; ++f) {
        for (int i = 0; i < 3; ++i) {
            int p[3];
            for (int k = 0; k < 3; ++k) p[k] = order[f][i] >> k & 1 ? b->max[k] : b->min[k];
            if (i == 2 && f == b->face) p[f / 2] += f % 2 ? -b->by : b->by;
            write_text(w, "( %d %d %d ) ", p[0], p[1], p[2]);
        }
        write_text(w, "%s 0 0 0 1 1\n", b->texture);
    }
    write_text(w, "}\n");
    close_entity(w);
}

// Water that holds back the void in the very plane of a door's portal: two surfaces in one place.
static void a_portal_in_the_plane_of_a_seal_gives_way(void **state)
{
    (void)state;
    map_writer *w = calloc(1, sizeof *w);
    static const slanted_box boxes[] = {{"worldspawn", "wall", {0, 8, 8}, {120, 120, 120}, 0, 0},
                                        {"csg_subtract", "wall", {0, 56, 24}, {112, 112, 112}, 1, 1},
                                        {"func_group", "*water", {40, 8, 16}, {88, 64, 88}, 5, 1},
                                        {"func_door", "sky", {72, 40, 24}, {104, 120, 120}, 0, 0},
                                        {"func_group", "*water", {32, 40, 96}, {120, 96, 112}, 0, 0}};
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; ++i) write_slanted(w, &boxes[i]);
    static const char *const places[] = {"16 16 16", "64 64 64", "100 20 100"};
    for (int i = 0; i < 3; ++i) {
        open_entity(w, "light");
        write_text(w, "\"origin\" \"%s\"\n", places[i]);
        close_entity(w);
    }
    report_lines lines;
    report_lines_init(&lines);
    whole made;
    if (compile_text(w->text, w->size, &lines.report, &made) != RESULT_OK) fail_msg("%s", lines.lines[0]);
    for (uint32_t i = 0; i < lines.count; ++i) assert_null(strstr(lines.lines[i], "please report"));
    assert_int_equal(made.checks.open_edges, 0);
    whole_free(&made, allocator_heap());
    free(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_result_is_refused),
        cmocka_unit_test(a_map_cut_anywhere_compiles_or_is_refused),
        cmocka_unit_test(a_leak_without_an_entity_is_none_and_all_is_sealed),
        cmocka_unit_test(any_byte_flipped_of_a_compiled_file_is_refused),
        cmocka_unit_test(any_other_length_of_a_compiled_file_is_refused),
        cmocka_unit_test(a_portal_in_the_plane_of_a_seal_gives_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
