// Which doors close a compiled portal: those whose shut leaves hide it, each its own part of it.
// SPDX-License-Identifier: MIT
#include "items_fixture.h"
#include "tests/common/failing_allocator.h"

typedef struct leaf { double min[3], max[3]; } leaf;

static void write_door(map_writer *w, const leaf *leaves, size_t count, const char *texture)
{
    open_entity(w, "func_door");
    write_text(w, "\"angle\" \"-1\"\n");
    for (size_t i = 0; i < count; ++i) write_box(w, leaves[i].min, leaves[i].max, texture);
    close_entity(w);
}

static void finish(map_writer *w, compiled *c)
{
    write_inhabitants(w);
    take_zones(c, input_of(w->text, NULL), PORTALS_DOORS);
    take_items(c);
    assert_int_equal(c->scene->zone_count, 2);
}

static void one_door_of(const leaf *leaves, size_t count, const char *texture, compiled *c)
{
    static map_writer w;
    write_rooms_alone(&w, "");
    write_door(&w, leaves, count, texture);
    finish(&w, c);
}

// Square metres of the portals that this door closes; SCENE_NONE: that nothing closes.
static double closed_area(const scene *s, uint32_t door)
{
    double area = 0;
    for (uint32_t p = 0; p < s->portal_count; ++p) {
        if (s->portals[p].door != door) continue;
        const double(*at)[3] = (const double(*)[3])s->portal_points + s->portals[p].first_point;
        for (uint32_t i = 0; i < s->portals[p].point_count; ++i) { // all of them stand upright across x
            const double *a = at[i], *b = at[(i + 1) % s->portals[p].point_count];
            area += (a[1] * b[2] - a[2] * b[1]) / 2;
        }
    }
    return area < 0 ? -area : area;
}

static void a_leaf_that_fills_its_opening_closes_the_portal(void **state)
{
    (void)state;
    static compiled c;
    const leaf full = {{260, 96, 0}, {268, 160, 96}};
    one_door_of(&full, 1, "gate", &c);
    assert_int_equal(c.scene->portal_count, 1);
    assert_int_equal(c.scene->portals[0].door, 0);
    assert_string_equal(c.scene->portals[0].name, "portal 0");
    release(&c);
}

static void a_leaf_of_several_brushes_closes_one_portal(void **state)
{
    (void)state;
    static compiled c;
    const leaf parts[3] = {{{260, 96, 0}, {268, 160, 32}}, {{256, 96, 32}, {272, 128, 96}}, {{260, 120, 32}, {268, 160, 96}}};
    one_door_of(parts, 3, "gate", &c);
    assert_int_equal(c.scene->portal_count, 1);
    assert_int_equal(c.scene->portals[0].door, 0);
    release(&c);
}

static void a_leaf_with_a_keyhole_never_closes_its_portal(void **state)
{
    (void)state;
    static compiled c;
    const leaf frame[4] = {
        {{260, 96, 0}, {268, 160, 40}}, {{260, 96, 48}, {268, 160, 96}}, {{260, 96, 40}, {268, 124, 48}}, {{260, 132, 40}, {268, 160, 48}}};
    one_door_of(frame, 4, "gate", &c);
    assert_int_equal(c.scene->door_count, 1);
    assert_int_equal(c.scene->portal_count, 1);
    assert_int_equal(c.scene->portals[0].door, SCENE_NONE);
    release(&c);
}

static void a_leaf_that_one_sees_through_never_closes_its_portal(void **state)
{
    (void)state;
    static const char *const textures[] = {"*water", "{fence"};
    for (int i = 0; i < 2; ++i) {
        static compiled c;
        const leaf full = {{256, 96, 0}, {272, 160, 96}};
        one_door_of(&full, 1, textures[i], &c);
        assert_int_equal(c.scene->portal_count, 1);
        assert_int_equal(c.scene->portals[0].door, SCENE_NONE);
        release(&c);
    }
}

// Each face has a texture of its own: -x, +x, -y, +y, -z, +z.
static void write_box_of(map_writer *w, const leaf *b, const char *const textures[6])
{
    const double *l = b->min, *h = b->max;
    const double p[6][3][3] = {
        {{l[0], l[1], l[2]}, {l[0], l[1] + 1, l[2]}, {l[0], l[1], l[2] + 1}}, {{h[0], h[1], h[2]}, {h[0], h[1], h[2] + 1}, {h[0], h[1] + 1, h[2]}},
        {{l[0], l[1], l[2]}, {l[0], l[1], l[2] + 1}, {l[0] + 1, l[1], l[2]}}, {{h[0], h[1], h[2]}, {h[0] + 1, h[1], h[2]}, {h[0], h[1], h[2] + 1}},
        {{l[0], l[1], l[2]}, {l[0] + 1, l[1], l[2]}, {l[0], l[1] + 1, l[2]}}, {{h[0], h[1], h[2]}, {h[0], h[1] + 1, h[2]}, {h[0] + 1, h[1], h[2]}}};
    write_text(w, "{\n");
    for (int f = 0; f < 6; ++f) {
        for (int i = 0; i < 3; ++i) write_text(w, "( %g %g %g ) ", p[f][i][0], p[f][i][1], p[f][i][2]);
        write_text(w, "%s 0 0 0 1 1\n", textures[f]);
    }
    write_text(w, "}\n");
}

static uint32_t door_of_leaf(const leaf *b, const char *const textures[6])
{
    static map_writer w;
    static compiled c;
    write_rooms_alone(&w, "");
    open_entity(&w, "func_door");
    write_text(&w, "\"angle\" \"-1\"\n");
    write_box_of(&w, b, textures);
    close_entity(&w);
    finish(&w, &c);
    assert_int_equal(c.scene->portal_count, 1);
    const uint32_t door = c.scene->portals[0].door;
    release(&c);
    return door;
}

static void sides_without_a_texture_do_no_harm_against_the_frame(void **state)
{
    (void)state;
    static const char *const sides[6] = {"gate", "gate", "skip", "skip", "skip", "skip"},
                             *const back[6] = {"gate", "skip", "skip", "skip", "skip", "skip"}, *const both[6] = {"skip", "skip", "gate",
                                                                                                                  "gate", "gate", "gate"};
    const leaf in_wall = {{260, 96, 0}, {268, 160, 96}}, sticks_out = {{250, 96, 0}, {268, 160, 96}};
    assert_int_equal(door_of_leaf(&in_wall, sides), 0);
    assert_int_equal(door_of_leaf(&in_wall, back), 0);              // its front is before all
    assert_int_equal(door_of_leaf(&in_wall, both), SCENE_NONE);     // a hole
    assert_int_equal(door_of_leaf(&sticks_out, sides), SCENE_NONE); // seen into by one side, out of by another
}

static void two_leaves_close_their_own_halves(void **state)
{
    (void)state;
    static map_writer w;
    static compiled c;
    const leaf leaves[2] = {{{256, 96, 0}, {272, 112, 96}}, {{256, 112, 0}, {272, 160, 96}}};
    write_rooms_alone(&w, "");
    write_door(&w, &leaves[0], 1, "gate");
    write_door(&w, &leaves[1], 1, "gate");
    finish(&w, &c);
    const scene *s = c.scene;
    assert_int_equal(c.zones->portal_count, 1);
    assert_int_equal(s->portal_count, 2);
    assert_true(closed_area(s, 0) == 0.5 * 3);
    assert_true(closed_area(s, 1) == 1.5 * 3);
    for (int p = 0; p < 2; ++p) assert_memory_equal(s->portals[p].zones, s->portals[0].zones, sizeof s->portals[0].zones);
    release(&c);
}

static void two_leaves_with_a_gap_leave_the_whole_portal_open(void **state)
{
    (void)state;
    static map_writer w;
    static compiled c;
    const leaf leaves[2] = {{{256, 96, 0}, {272, 128, 96}}, {{256, 128, 0}, {272, 160, 90}}};
    write_rooms_alone(&w, "");
    write_door(&w, &leaves[0], 1, "gate");
    write_door(&w, &leaves[1], 1, "gate");
    finish(&w, &c);
    assert_int_equal(c.scene->portal_count, 1);
    assert_true(closed_area(c.scene, SCENE_NONE) == 2 * 3);
    release(&c);
}

static void every_allocation_of_two_leaves_may_fail(void **state)
{
    (void)state;
    static map_writer w;
    static compiled c;
    const leaf leaves[2] = {{{256, 96, 0}, {272, 112, 96}}, {{256, 112, 0}, {272, 160, 96}}};
    write_rooms_alone(&w, "");
    write_door(&w, &leaves[0], 1, "gate");
    write_door(&w, &leaves[1], 1, "gate");
    write_inhabitants(&w);
    take_zones(&c, input_of(w.text, NULL), PORTALS_DOORS);
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
        assert_int_equal(lines.count, a.failures ? 1 : 0);
        scene_free(made, &a.memory);
        assert_true(failing_allocator_is_clean(&a));
    }
    release(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_leaf_that_fills_its_opening_closes_the_portal),
        cmocka_unit_test(a_leaf_of_several_brushes_closes_one_portal),
        cmocka_unit_test(a_leaf_with_a_keyhole_never_closes_its_portal),
        cmocka_unit_test(a_leaf_that_one_sees_through_never_closes_its_portal),
        cmocka_unit_test(sides_without_a_texture_do_no_harm_against_the_frame),
        cmocka_unit_test(two_leaves_close_their_own_halves),
        cmocka_unit_test(two_leaves_with_a_gap_leave_the_whole_portal_open),
        cmocka_unit_test(every_allocation_of_two_leaves_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
