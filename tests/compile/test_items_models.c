// misc_model entities: meshes of files, placed, clustered, listed where they stand; and what is said of files that do not come.
// SPDX-License-Identifier: MIT
#include "items_fixture.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/scratch_folder.h"

#include <portcullis/box.h>

#include <stdio.h>
#include <string.h>

// A slab of 16 x 4 x 1 units, Y up, with one corner at its origin: no two of its turns look alike.
static const char slab_obj[] = "v 0 0 0\nv 16 0 0\nv 16 4 0\nv 0 4 0\nv 0 0 1\nv 16 0 1\nv 16 4 1\nv 0 4 1\n"
                               "usemtl stone\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

typedef struct placed { // two rooms with models in them, in a folder of their own
    scratch_folder folder;
    compiled c;
} placed;

static compile_input *read_map(placed *p, const char *models)
{
    static map_writer w;
    char path[512];
    compile_input *in = NULL;
    write_two_rooms(&w);
    write_text(&w, "%s", models);
    scratch_folder_make(&p->folder);
    scratch_folder_write(&p->folder, "slab.obj", slab_obj, sizeof slab_obj - 1);
    scratch_folder_name(&p->folder, "rooms.map", path, sizeof path);
    report_lines_init(&p->c.lines);
    assert_int_equal(compile_input_map(path, w.text, w.size, NULL, allocator_heap(), &p->c.lines.report, &in), RESULT_OK);
    return in;
}

static void place(placed *p, const char *models)
{
    take_zones(&p->c, read_map(p, models), PORTALS_DOORS);
    take_items(&p->c);
    expect_sound(&p->c);
}

static void put_away(placed *p)
{
    release(&p->c);
    scratch_folder_remove(&p->folder);
}

// Of the item's box, in the map's units and axes.
static void expect_box(const scene *s, uint32_t item, const double min[3], const double max[3])
{
    const cull_box b = cull_box_at(&s->boxes, item);
    const double *o = s->whole.origin;
    const double low[3] = {((double)b.min.x + o[0]) * 32, -((double)b.max.z + o[2]) * 32, ((double)b.min.y + o[1]) * 32};
    const double high[3] = {((double)b.max.x + o[0]) * 32, -((double)b.min.z + o[2]) * 32, ((double)b.max.y + o[1]) * 32};
    for (int k = 0; k < 3; ++k) {
        if (low[k] != min[k] || high[k] != max[k]) fail_msg("axis %d: %.9g to %.9g, not %g to %g", k, low[k], high[k], min[k], max[k]);
    }
}

static uint32_t model_item(const scene *s, uint32_t number)
{
    for (uint32_t i = 0; i < s->item_count; ++i)
        if (strcmp(s->materials[s->items[i].material].name, "stone") == 0 && number-- == 0) return i;
    fail_msg("no such model");
    return 0;
}

static void a_model_stands_at_its_origin_in_map_units(void **state)
{
    (void)state;
    static placed p;
    place(&p, "{\n\"classname\" \"misc_model\"\n\"model\" \"slab.obj\"\n\"origin\" \"64 96 32\"\n}\n");
    const scene *s = p.c.scene;
    const uint32_t item = model_item(s, 0);
    expect_box(s, item, (const double[3]){64, 95, 32}, (const double[3]){80, 96, 36}); // its z is the map's -y
    assert_int_equal(s->items[item].polygon_count, 6);
    assert_int_equal(s->items[item].index_count, 36);
    assert_int_equal(s->items[item].flags & CULL_ITEM_WALL, 0);
    assert_int_equal(s->listings[item], 1);
    put_away(&p);
}

static void models_turn_by_quarters_exactly_and_scale(void **state)
{
    (void)state;
    static const struct { const char *keys; double min[3], max[3]; } cases[] = {
        {"\"angle\" \"90\"", {0, 0, 0}, {1, 16, 4}},
        {"\"angles\" \"0 180 0\"", {-16, 0, 0}, {0, 1, 4}},
        {"\"angles\" \"90 0 0\"", {0, -1, -16}, {4, 0, 0}},              // nose down
        {"\"angles\" \"0 0 90\"", {0, -4, -1}, {16, 0, 0}},              // rolled
        {"\"angles\" \"0 10 0\"\n\"angle\" \"-90\"", {-1, -16, 0}, {0, 0, 4}}, // angle has the last word on yaw
        {"\"modelscale\" \"2.5\"", {0, -2.5, 0}, {40, 0, 10}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        static placed p;
        char text[256];
        double min[3], max[3];
        const double at[3] = {128, 128, 64};
        snprintf(text, sizeof text, "{\n\"classname\" \"misc_model\"\n\"model\" \"slab.obj\"\n\"origin\" \"128 128 64\"\n%s\n}\n", cases[i].keys);
        place(&p, text);
        for (int k = 0; k < 3; ++k) min[k] = at[k] + cases[i].min[k], max[k] = at[k] + cases[i].max[k];
        expect_box(p.c.scene, model_item(p.c.scene, 0), min, max);
        put_away(&p);
    }
}

static void a_model_in_a_doorway_is_listed_in_both_rooms_and_read_once(void **state)
{
    (void)state;
    static placed p;
    place(&p, "{\n\"classname\" \"misc_model\"\n\"model\" \"slab.obj\"\n\"origin\" \"256 128 16\"\n}\n"
              "{\n\"classname\" \"misc_model\"\n\"model\" \"slab.obj\"\n\"origin\" \"400 128 16\"\n}\n");
    const scene *s = p.c.scene;
    assert_int_equal(s->listings[model_item(s, 0)], 2);
    assert_int_equal(s->listings[model_item(s, 1)], 1);
    assert_int_equal(s->light_count, 1);
    put_away(&p);
}

static void walls_keep_their_exact_planes_beside_models(void **state)
{
    (void)state;
    static placed p;
    place(&p, "{\n\"classname\" \"misc_model\"\n\"model\" \"slab.obj\"\n\"angle\" \"33\"\n\"origin\" \"64 96 32\"\n}\n");
    const scene *s = p.c.scene;
    assert_non_null(s->exact_planes);
    for (uint32_t i = 0; i < s->item_count; ++i) assert_int_equal(s->walls[i].vertex_count != 0, (s->items[i].flags & CULL_ITEM_WALL) != 0);
    put_away(&p);
}

// A grid of cells x cells quads.
static void write_grid(const scratch_folder *f, int cells)
{
    static char text[1 << 16];
    int size = 0;
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x) size += snprintf(text + size, sizeof text - (size_t)size, "v %d 0 %d\n", x, y);
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x) {
            const int at = y * (cells + 1) + x + 1;
            size += snprintf(text + size, sizeof text - (size_t)size, "f %d %d %d %d\n", at, at + cells + 1, at + cells + 2, at + 1);
        }
    scratch_folder_write(f, "grid.obj", text, (size_t)size);
}

static void a_large_model_is_clustered(void **state)
{
    (void)state;
    static placed p;
    compile_input *in = read_map(&p, "{\n\"classname\" \"misc_model\"\n\"model\" \"grid.obj\"\n\"origin\" \"64 160 32\"\n\"modelscale\" \"2\"\n}\n");
    write_grid(&p.folder, 20); // 800 triangles
    take_zones(&p.c, in, PORTALS_DOORS);
    take_items(&p.c);
    const scene *s = p.c.scene;
    uint32_t clusters = 0, triangles = 0;
    for (uint32_t i = 0; i < s->item_count; ++i) {
        if (s->items[i].flags & CULL_ITEM_WALL) continue;
        assert_true(s->items[i].index_count <= 3 * 128);
        triangles += s->items[i].index_count / 3;
        ++clusters;
    }
    assert_int_equal(triangles, 800);
    assert_true(clusters >= 7 && clusters <= 14);
    put_away(&p);
}

static void faults_name_the_model_and_the_entitys_line(void **state)
{
    (void)state;
    static const struct { const char *keys, *line;
    } cases[] = {
        {"\"model\" \"gone.obj\"\n\"origin\" \"64 64 64\"", "gone.obj\" does not come: cannot open it"},
        {"\"model\" \"tree.md3\"\n\"origin\" \"64 64 64\"",
         "the model \"tree.md3\" is of no kind that is read here; its name must end in .obj, .ply, .off or .stl"},
        {"\"model\" \"rooms.map\"\n\"origin\" \"64 64 64\"", "the model \"rooms.map\" is of no kind"},
        {"\"origin\" \"64 64 64\"", "give the misc_model a key \"model\""},
        {"\"model\" \"slab.obj\"", "give the misc_model an \"origin\""},
        {"\"model\" \"slab.obj\"\n\"origin\" \"64 64 64\"\n\"modelscale\" \"0\"", "\"modelscale\" takes a number from 1e-6 on"},
        {"\"model\" \"slab.obj\"\n\"origin\" \"64 64 64\"\n\"modelscale\" \"nan\"", "\"modelscale\" takes 1 number"},
        {"\"model\" \"slab.obj\"\n\"origin\" \"64 64 64\"\n\"angles\" \"1 2\"", "\"angles\" takes 3 numbers"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        static placed p;
        char text[256], line[32];
        scene *made = NULL;
        compile_checks checks;
        snprintf(text, sizeof text, "{\n\"classname\" \"misc_model\"\n%s\n}\n", cases[i].keys);
        take_zones(&p.c, read_map(&p, text), PORTALS_DOORS);
        assert_int_equal(compile_items(p.c.in, p.c.zones, &p.c.lines.report, allocator_heap(), &made, &checks), RESULT_BAD_INPUT);
        assert_null(made);
        assert_true(report_lines_is_one_with(&p.c.lines, cases[i].line));
        snprintf(line, sizeof line, "rooms.map:%u: error: ", p.c.in->entities[p.c.in->entity_count - 1].line);
        assert_true(report_lines_is_one_with(&p.c.lines, line));
        put_away(&p);
    }
}

static void every_allocation_may_fail_with_models_and_normal_maps(void **state)
{
    (void)state;
    static placed p;
    static map_writer w;
    const char model[] = "{\n\"classname\" \"misc_model\"\n\"model\" \"slab.obj\"\n\"origin\" \"256 128 16\"\n}\n";
    compile_input *in = NULL;
    char path[512];
    compile_input_free(read_map(&p, model)); // makes the folder
    write_rooms_alone(&w, "\"_normal_maps\" \"wall stone\"\n");
    write_inhabitants(&w);
    write_text(&w, "%s%s", model, model);
    scratch_folder_name(&p.folder, "rooms.map", path, sizeof path);
    assert_int_equal(compile_input_map(path, w.text, w.size, NULL, allocator_heap(), &p.c.lines.report, &in), RESULT_OK);
    take_zones(&p.c, in, PORTALS_NONE);
    result done = RESULT_NO_MEMORY;
    for (uint64_t k = 1; done != RESULT_OK; ++k) {
        failing_allocator a;
        failing_allocator_init(&a, k);
        report_lines lines;
        report_lines_init(&lines);
        scene *made = NULL;
        compile_checks checks;
        done = compile_items(p.c.in, p.c.zones, &lines.report, &a.memory, &made, &checks);
        assert_int_equal(done, a.failures ? RESULT_NO_MEMORY : RESULT_OK);
        assert_int_equal(lines.report.errors, a.failures ? 1 : 0);
        scene_free(made, &a.memory);
        assert_true(failing_allocator_is_clean(&a));
    }
    put_away(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_model_stands_at_its_origin_in_map_units),
        cmocka_unit_test(models_turn_by_quarters_exactly_and_scale),
        cmocka_unit_test(a_model_in_a_doorway_is_listed_in_both_rooms_and_read_once),
        cmocka_unit_test(walls_keep_their_exact_planes_beside_models),
        cmocka_unit_test(a_large_model_is_clustered),
        cmocka_unit_test(faults_name_the_model_and_the_entitys_line),
        cmocka_unit_test(every_allocation_may_fail_with_models_and_normal_maps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
