// Triangles that rounding lays onto one line: what lies beside them closes the surface instead.
// SPDX-License-Identifier: MIT
#include "items_fixture.h"

#include "tests/common/failing_allocator.h"

// Two slivers a few steps thick, in a map so wide that a step of the scene is larger: a corner of theirs comes to lie on the
// edge that it stood beside.
static void write_slivers(map_writer *w)
{
    static const double far[2][2][3] = {{{-60000, -60000, -60000}, {-59984, -59984, -59984}}, {{59984, 59984, 59984}, {60000, 60000, 60000}}};
    w->size = 0;
    open_entity(w, "worldspawn");
    for (int i = 0; i < 2; ++i) write_box(w, far[i][0], far[i][1], "wall");
    write_text(w, "{\n"
                  "( 0.16015625 0.15625 -0.01171875 ) ( 0.0859375 0.11328125 -0.0078125 ) ( 0.05859375 0.11328125 -0.0234375 ) a 0 0 0 1 1\n"
                  "( -0.03515625 0.0546875 -0.0234375 ) ( 0.05859375 0.11328125 -0.0234375 ) ( 0.0859375 0.11328125 -0.0078125 ) a 0 0 0 1 1\n"
                  "( -0.03515625 0.0546875 -0.0234375 ) ( 0.16015625 0.15625 -0.01171875 ) ( 0.05859375 0.11328125 -0.0234375 ) a 0 0 0 1 1\n"
                  "( -0.03515625 0.0546875 -0.0234375 ) ( 0.0859375 0.11328125 -0.0078125 ) ( 0.16015625 0.15625 -0.01171875 ) a 0 0 0 1 1\n"
                  "}\n{\n"
                  "( -0.06640625 0.16015625 -0.1015625 ) ( -0.0234375 0.0546875 -0.0234375 ) ( -0.05078125 0.1484375 -0.078125 ) a 0 0 0 1 1\n"
                  "( -0.0234375 0.04296875 -0.00390625 ) ( -0.05078125 0.1484375 -0.078125 ) ( -0.0234375 0.0546875 -0.0234375 ) a 0 0 0 1 1\n"
                  "( -0.0234375 0.04296875 -0.00390625 ) ( -0.06640625 0.16015625 -0.1015625 ) ( -0.05078125 0.1484375 -0.078125 ) a 0 0 0 1 1\n"
                  "( -0.0234375 0.04296875 -0.00390625 ) ( -0.0234375 0.0546875 -0.0234375 ) ( -0.06640625 0.16015625 -0.1015625 ) a 0 0 0 1 1\n"
                  "}\n");
    close_entity(w);
    open_entity(w, "info_player_start");
    write_text(w, "\"origin\" \"0 0 100\"\n");
    close_entity(w);
}

static uint32_t flat_polygons(const compiled *c) // that have lost all their triangles, or their neighbours have gained by them
{
    uint32_t seen = 0;
    for (uint32_t p = 0; p < c->zones->mesh->polygon_count; ++p) seen += c->zones->polygon_zone[p] != UINT32_MAX;
    return seen - c->scene->item_count;
}

static void a_flat_triangle_goes_into_its_neighbour_and_nothing_opens(void **state)
{
    (void)state;
    static map_writer w;
    write_slivers(&w);
    compiled c;
    take_zones(&c, input_of(w.text, NULL), PORTALS_NONE);
    take_items(&c);
    assert_true(flat_polygons(&c) > 0);
    expect_sound(&c);
    release(&c);
}

static void every_allocation_of_the_mending_may_fail(void **state)
{
    (void)state;
    static map_writer w;
    write_slivers(&w);
    compiled c;
    take_zones(&c, input_of(w.text, NULL), PORTALS_NONE);
    result done = RESULT_NO_MEMORY;
    for (uint64_t k = 1; done != RESULT_OK; ++k) {
        failing_allocator a;
        failing_allocator_init(&a, k);
        report_lines lines;
        report_lines_init(&lines);
        scene *made = NULL;
        compile_checks checks;
        done = compile_items(c.in, c.zones, &lines.report, &a.memory, &made, &checks);
        assert_int_equal(done, a.failures ? RESULT_NO_MEMORY : RESULT_OK);
        scene_free(made, &a.memory);
        assert_true(failing_allocator_is_clean(&a));
    }
    release(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_triangle_goes_into_its_neighbour_and_nothing_opens),
        cmocka_unit_test(every_allocation_of_the_mending_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
