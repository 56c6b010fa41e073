// Maps through the compiler up to a scene: see items_fixture.h.
// SPDX-License-Identifier: MIT
#include "items_fixture.h"

void take_zones(compiled *c, compile_input *in, portal_choice portals)
{
    compile_mesh *mesh = NULL;
    csg_counts counts;
    *c = (compiled){.in = in};
    report_lines_init(&c->lines);
    assert_int_equal(compile_csg(in, &c->lines.report, allocator_heap(), &mesh, &counts), RESULT_OK);
    assert_int_equal(compile_zones(in, mesh, portals, &c->lines.report, allocator_heap(), &c->zones), RESULT_OK);
}

void take_items(compiled *c)
{
    assert_int_equal(compile_items(c->in, c->zones, &c->lines.report, allocator_heap(), &c->scene, &c->checks), RESULT_OK);
}

void release(compiled *c)
{
    scene_free(c->scene, allocator_heap());
    compiled_zones_free(c->zones);
    compile_input_free(c->in);
}

void write_rooms_alone(map_writer *w, const char *worldspawn_keys)
{
    static const double boxes[][2][3] = {{{-16, -16, -16}, {544, 272, 0}}, {{-16, -16, 128}, {544, 272, 144}}, {{-16, -16, 0}, {544, 0, 128}},
                                         {{-16, 256, 0}, {544, 272, 128}}, {{-16, 0, 0}, {0, 256, 128}},       {{528, 0, 0}, {544, 256, 128}},
                                         {{256, 0, 0}, {272, 96, 128}},    {{256, 160, 0}, {272, 256, 128}},   {{256, 96, 96}, {272, 160, 128}}};
    w->size = 0;
    open_entity(w, "worldspawn");
    write_text(w, "%s", worldspawn_keys);
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; ++i) write_box(w, boxes[i][0], boxes[i][1], "wall");
    close_entity(w);
}

void write_inhabitants(map_writer *w)
{
    open_entity(w, "info_player_start");
    write_text(w, "\"origin\" \"64 64 32\"\n");
    close_entity(w);
    open_entity(w, "light");
    write_text(w, "\"origin\" \"400 64 64\"\n\"light\" \"160\"\n");
    close_entity(w);
}

void write_two_rooms(map_writer *w)
{
    static const double door[2][3] = {{256, 96, 0}, {272, 160, 96}};
    write_rooms_alone(w, "");
    open_entity(w, "func_door");
    write_text(w, "\"angle\" \"-1\"\n");
    write_box(w, door[0], door[1], "gate");
    close_entity(w);
    write_inhabitants(w);
}

void expect_sound(const compiled *c)
{
    assert_int_equal(c->checks.open_edges, 0);
    assert_int_equal(c->checks.t_junctions_left, 0);
    assert_int_equal(c->checks.degenerate_triangles, 0);
    assert_int_equal(c->scene->item_count + c->scene->mover_count, c->checks.items);
    assert_int_equal(c->scene->stray_items, 0);
}
