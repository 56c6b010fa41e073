// Stages are told as they end, and the files for map editors.
// SPDX-License-Identifier: MIT
#include "host/compile/csg.h"
#include "host/compile/editor_files.h"
#include "host/compile/stages.h"
#include "host/compile/zone_trace.h"
#include "items_fixture.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/scratch_folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct told {
    compile_stage stages[STAGE_COUNT];
    uint32_t count, polygons_csg, polygons_merged, shells, portals;
} told;

static void hear_stage(void *user, const compile_view *v)
{
    told *t = user;
    assert_true(t->count < STAGE_COUNT);
    t->stages[t->count++] = v->stage;
    assert_non_null(v->in);
    if (v->stage == STAGE_RELATIONS) assert_true(v->relations->pair_count > 0 && v->bodies->polygons.count > 0);
    if (v->stage == STAGE_CSG) t->polygons_csg = (uint32_t)v->soup->polygons.count;
    if (v->stage == STAGE_WELD) assert_true(v->vertex_count > 0 && v->soup->polygons.count == t->polygons_csg);
    if (v->stage == STAGE_MERGE) t->polygons_merged = v->mesh->polygon_count;
    if (v->stage == STAGE_PORTALS) assert_int_equal(v->portals->pieces.count, 1);
    if (v->stage == STAGE_ZONES) t->shells = v->trace->shells.shell_count;
    if (v->stage == STAGE_T_JUNCTIONS) t->portals = v->zones->portal_count;
}

static compile_input *two_rooms(void)
{
    map_writer *w = calloc(1, sizeof *w);
    write_two_rooms(w);
    compile_input *in = input_of(w->text, NULL);
    free(w);
    return in;
}

static void each_stage_is_told_once_in_order_with_what_it_made(void **state)
{
    (void)state;
    static const compile_stage order[] = {STAGE_RELATIONS, STAGE_CSG, STAGE_WELD, STAGE_MERGE, STAGE_PORTALS, STAGE_ZONES, STAGE_T_JUNCTIONS};
    told t = {.count = 0};
    const compile_watch watch = {&t, hear_stage};
    compile_input *in = two_rooms();
    in->watch = &watch;
    compiled c;
    take_zones(&c, in, PORTALS_DOORS);
    assert_int_equal(t.count, sizeof order / sizeof *order);
    for (uint32_t i = 0; i < t.count; ++i) assert_int_equal(t.stages[i], order[i]);
    assert_true(t.polygons_merged > 0 && t.polygons_merged <= t.polygons_csg);
    assert_int_equal(t.shells, c.zones->shells);
    assert_int_equal(t.portals, c.zones->portal_count);
    release(&c);
}

static void names_of_stages_are_told_apart(void **state)
{
    (void)state;
    char names[128];
    compile_stage_names(STAGE_COUNT, names);
    assert_string_equal(names, "input relations csg weld merge portals zones t_junctions items bake write");
    for (int s = 0; s < STAGE_COUNT; ++s) assert_int_equal(compile_stage_of(compile_stage_name((compile_stage)s)), s);
    assert_int_equal(compile_stage_of("soup"), STAGE_COUNT);
    assert_int_equal(compile_stage_of(""), STAGE_COUNT);
}

// ---- Files for map editors ----

static size_t read_text(const char *path, char *out, size_t size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t got = fread(out, 1, size - 1, file);
    fclose(file);
    out[got] = 0;
    return got;
}

static void the_doors_portal_stands_in_the_prt_with_its_true_corners_alone(void **state)
{
    (void)state;
    scratch_folder folder;
    char path[300], text[1024];
    compiled c;
    scratch_folder_make(&folder);
    scratch_folder_name(&folder, "rooms.prt", path, sizeof path);
    take_zones(&c, two_rooms(), PORTALS_DOORS);
    assert_int_equal(c.zones->portal_count, 1);
    assert_int_equal(editor_prt_write(c.in, c.zones, path, allocator_heap(), &c.lines.report), RESULT_OK);
    read_text(path, text, sizeof text);
    assert_memory_equal(text, "PRT1\n2\n1\n4 ", 11);
    static const char *const corners[] = {"(264 96 0 ) ", "(264 96 96 ) ", "(264 160 0 ) ", "(264 160 96 ) "}; // map units, Z up
    for (int i = 0; i < 4; ++i) assert_non_null(strstr(text, corners[i]));
    size_t length = strlen("PRT1\n2\n1\n4 0 1 \n");
    for (int i = 0; i < 4; ++i) length += strlen(corners[i]);
    assert_int_equal(strlen(text), length);
    release(&c);
    scratch_folder_remove(&folder);
}

static void without_memory_no_editor_file_is_left(void **state)
{
    (void)state;
    scratch_folder folder;
    char path[300];
    compiled c;
    scratch_folder_make(&folder);
    scratch_folder_name(&folder, "rooms.prt", path, sizeof path);
    take_zones(&c, two_rooms(), PORTALS_DOORS);
    failing_allocator a;
    failing_allocator_init(&a, 1);
    report silent = {0};
    assert_int_equal(editor_prt_write(c.in, c.zones, path, &a.memory, &silent), RESULT_NO_MEMORY);
    assert_true(failing_allocator_is_clean(&a));
    c.zones->leak = 1; // its line is empty, so that nothing is asked for
    assert_int_equal(editor_pts_write(c.zones, path, allocator_heap(), &silent), RESULT_OK);
    c.zones->leak = 0;
    assert_int_equal(scratch_folder_count(&folder), 1);
    assert_int_equal(editor_pts_write(c.zones, path, allocator_heap(), &silent), RESULT_OK); // empty: an old one, removed
    assert_int_equal(scratch_folder_count(&folder), 0);
    assert_int_equal(editor_pts_write(c.zones, path, allocator_heap(), &silent), RESULT_OK); // nothing to remove
    assert_int_equal(scratch_folder_count(&folder), 0);
    release(&c);
    scratch_folder_remove(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_stage_is_told_once_in_order_with_what_it_made),
        cmocka_unit_test(names_of_stages_are_told_apart),
        cmocka_unit_test(the_doors_portal_stands_in_the_prt_with_its_true_corners_alone),
        cmocka_unit_test(without_memory_no_editor_file_is_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
