// Nothing is seen through the air but walls of the zones that portals on the way lead to: random rays through compiled maps.
// PORTCULLIS_LONG=1: all maps, each parted in three ways.
// SPDX-License-Identifier: MIT
#include "items_fixture.h"
#include "sight_rays.h"

#include <stdlib.h>
#include <string.h>

typedef struct parted { portal_choice portals; uint32_t portals_most; } parted;

static void take_parted(compiled *c, const char *text, const parted *how)
{
    compile_mesh *mesh = NULL;
    csg_counts counts;
    zone_options options = zone_options_of(how->portals);
    *c = (compiled){0};
    report_lines_init(&c->lines);
    if (how->portals_most) options.rooms.portals = how->portals_most;
    assert_int_equal(compile_input_map("sight.map", text, strlen(text), NULL, allocator_heap(), &c->lines.report, &c->in), RESULT_OK);
    assert_int_equal(compile_csg(c->in, &c->lines.report, allocator_heap(), &mesh, &counts), RESULT_OK);
    assert_int_equal(compile_zones_with(c->in, mesh, &options, &c->lines.report, allocator_heap(), &c->zones), RESULT_OK);
    take_items(c);
}

static uint32_t cast_rays(const compiled *c, uint32_t count, uint32_t found[SIGHT_FAULTS])
{
    sight_ray last;
    sight_rays *r = sight_rays_open(c->scene);
    assert_non_null(r);
    const uint32_t bad = sight_rays_cast(r, count, found, &last);
    if (bad)
        print_message("from %.17g %.17g %.17g along %.17g %.17g %.17g\n", last.from[0], last.from[1], last.from[2], last.way[0], last.way[1], last.way[2]);
    sight_rays_close(r);
    return bad;
}

static void rays_meet_walls_of_the_zones_that_portals_lead_to(void **state)
{
    (void)state;
    static const parted ways[] = {{PORTALS_AUTO, 200}, {PORTALS_AUTO, 100}, {PORTALS_DOORS, 0}};
    const int is_long = getenv("PORTCULLIS_LONG") != NULL;
    static const char *const few[] = {"librequake/lqdm12.map", "librequake/lq_e0m8.map"};
    uint32_t bad = 0;
    for (int i = 0; i < (is_long ? REAL_MAPS : 2); ++i) {
        size_t size;
        const char *name = is_long ? real_map_names[i] : few[i];
        char *text = real_map(name, &size);
        if (!text) skip();
        for (int w = 0; w < (is_long ? 3 : 1); ++w) {
            compiled c;
            uint32_t found[SIGHT_FAULTS];
            take_parted(&c, text, &ways[w]);
            bad += cast_rays(&c, is_long ? 10000 : 4000, found);
            print_message("%s, portals %d %u: %u zones, %u portals; rays: %u good, %u from no zone, into the void %u, on a back %u, on a wall of no zone %u\n", name,
                          ways[w].portals, ways[w].portals_most, c.scene->zone_count, c.scene->portal_count, found[SIGHT_GOOD], found[SIGHT_NO_ZONE],
                          found[SIGHT_VOID], found[SIGHT_BACK], found[SIGHT_UNLISTED]);
            release(&c);
        }
        free(text);
    }
    assert_int_equal(bad, 0);
}

static void a_portal_that_leads_nowhere_is_noticed(void **state)
{
    (void)state;
    static map_writer w;
    write_rooms_alone(&w, "");
    write_inhabitants(&w);
    compiled c;
    uint32_t found[SIGHT_FAULTS];
    take_parted(&c, w.text, &(parted){PORTALS_AUTO, 0});
    assert_true(c.scene->portal_count > 0);
    assert_int_equal(cast_rays(&c, 400, found), 0);
    c.scene->portals[0].zones[1] = c.scene->portals[0].zones[0];
    assert_true(cast_rays(&c, 400, found) > 20);
    assert_true(found[SIGHT_UNLISTED] > 20);
    release(&c);
}

// ---- Sides without a material ----

enum { FACES_A_BOX = 6, PARTING_BOX = 6 }; // of write_rooms_alone: a wall between the rooms

static void name_face(char *text, int face, const char *name) // as long as the one that it has
{
    for (char *at = text; (at = strstr(at, ") wall ")) != NULL; at += 2)
        if (face-- == 0) memcpy(at + 2, name, 4);
    assert_true(face < 0);
}

static uint32_t items_of(const scene *s, const char *material)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->item_count; ++i) count += strcmp(s->materials[s->items[i].material].name, material) == 0;
    return count;
}

static void no_ray_gets_through_a_side_of_a_wall_that_has_no_material(void **state)
{
    (void)state;
    static map_writer w;
    for (int side = 0; side < FACES_A_BOX; ++side) {
        write_rooms_alone(&w, "");
        write_inhabitants(&w);
        name_face(w.text, FACES_A_BOX * PARTING_BOX + side, "skip");
        compiled c;
        uint32_t found[SIGHT_FAULTS];
        take_parted(&c, w.text, &(parted){PORTALS_AUTO, 0});
        expect_sound(&c);
        assert_int_equal(cast_rays(&c, 400, found), 0);
        assert_int_equal(items_of(c.scene, "wall"), c.scene->item_count);
        release(&c);
    }
}

static void a_side_without_a_material_shows_what_most_sides_of_its_brush_do(void **state)
{
    (void)state;
    static const char *const sides[][FACES_A_BOX] = {
        {"skip", "face", "skip", "face", "clip", "wall"}, // more of one
        {"skip", "wall", "skip", "clip", "hint", "face"}, // as many: the first by name
        {"skip", "{hol", "skip", "{hol", "{hol", "face"}, // none that is seen through
    };
    static map_writer w;
    for (size_t i = 0; i < sizeof sides / sizeof *sides; ++i) {
        write_rooms_alone(&w, "");
        write_inhabitants(&w);
        for (int side = FACES_A_BOX; side-- > 0;) name_face(w.text, FACES_A_BOX * PARTING_BOX + side, sides[i][side]);
        compiled c;
        take_parted(&c, w.text, &(parted){PORTALS_NONE, 0});
        expect_sound(&c);
        for (uint32_t k = 0; k < c.in->face_count; ++k) assert_int_not_equal(c.in->faces[k].material, COMPILE_NOTHING);
        const compile_face *first = &c.in->faces[c.in->brushes[PARTING_BOX].first_face];
        assert_string_equal(c.in->materials[first->material].name, "face");
        release(&c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_portal_that_leads_nowhere_is_noticed),
        cmocka_unit_test(no_ray_gets_through_a_side_of_a_wall_that_has_no_material),
        cmocka_unit_test(a_side_without_a_material_shows_what_most_sides_of_its_brush_do),
        cmocka_unit_test(rays_meet_walls_of_the_zones_that_portals_lead_to),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
