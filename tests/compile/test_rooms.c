// Automatic rooms: where a map is parted, and by how much. See rooms_merge.c for the rule.
// SPDX-License-Identifier: MIT
#include "items_fixture.h"
#include "host/core/graph.h"
#include "tests/common/failing_allocator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void take_rooms(compiled *c, const char *text, const zone_options *options)
{
    compile_mesh *mesh = NULL;
    csg_counts counts;
    *c = (compiled){0};
    report_lines_init(&c->lines);
    assert_int_equal(compile_input_map("rooms.map", text, strlen(text), NULL, allocator_heap(), &c->lines.report, &c->in), RESULT_OK); // warnings are fine
    assert_int_equal(compile_csg(c->in, &c->lines.report, allocator_heap(), &mesh, &counts), RESULT_OK);
    assert_int_equal(compile_zones_with(c->in, mesh, options, &c->lines.report, allocator_heap(), &c->zones), RESULT_OK);
    take_items(c);
    expect_sound(c);
}

static void a_doorway_parts_two_rooms(void **state)
{
    (void)state;
    static map_writer w;
    write_rooms_alone(&w, "");
    write_inhabitants(&w);
    const zone_options options = zone_options_of(PORTALS_AUTO);
    compiled c;
    take_rooms(&c, w.text, &options);
    assert_in_range(c.scene->zone_count, 2, 3); // the doorway may be a room of its own
    assert_int_equal(c.scene->portal_count, c.scene->zone_count - 1);
    for (uint32_t i = 0; i < c.scene->portal_count; ++i) assert_int_equal(c.scene->portals[i].door, SCENE_NONE);
    release(&c);
}

static void no_more_rooms_than_asked_for(void **state)
{
    (void)state;
    static map_writer w;
    write_rooms_alone(&w, "");
    write_inhabitants(&w);
    zone_options options = zone_options_of(PORTALS_AUTO);
    compiled c;
    options.rooms.rooms = 1;
    take_rooms(&c, w.text, &options);
    assert_int_equal(c.scene->zone_count, 1);
    assert_int_equal(c.scene->portal_count, 0);
    release(&c);
    options = zone_options_of(PORTALS_AUTO);
    options.rooms.portals = 0;
    take_rooms(&c, w.text, &options);
    assert_int_equal(c.scene->zone_count, 1);
    release(&c);
}

static void a_door_stays_a_portal_of_its_own(void **state)
{
    (void)state;
    static map_writer w;
    write_two_rooms(&w);
    zone_options options = zone_options_of(PORTALS_AUTO);
    options.rooms.rooms = 1; // of what is not parted by doors
    compiled c;
    take_rooms(&c, w.text, &options);
    assert_int_equal(c.scene->zone_count, 2);
    assert_int_equal(c.scene->portal_count, 1);
    assert_int_equal(c.scene->portals[0].door, 0);
    release(&c);
}

static void a_door_is_given_up_where_no_portal_may_be(void **state)
{
    (void)state;
    static map_writer w;
    write_two_rooms(&w);
    zone_options options = zone_options_of(PORTALS_AUTO);
    options.rooms.portals = 0;
    compiled c;
    take_rooms(&c, w.text, &options);
    assert_int_equal(c.scene->zone_count, 1);
    assert_int_equal(c.scene->portal_count, 0);
    release(&c);
}

static void real_maps_are_parted_into_closed_rooms(void **state)
{
    (void)state;
    size_t size;
    char *text = real_map(real_map_names[0], &size);
    if (!text) skip();
    free(text);
    for (int i = 0; i < (getenv("PORTCULLIS_LONG") ? ID_MAPS : 1); ++i) {
        text = real_map(real_map_names[i], &size);
        const zone_options options = zone_options_of(PORTALS_AUTO);
        compiled c;
        take_rooms(&c, text, &options);
        print_message("%s: %u rooms, %u portals\n", real_map_names[i], c.scene->zone_count, c.scene->portal_count);
        assert_true(c.scene->zone_count > 8);
        assert_in_range(c.scene->portal_count, c.scene->zone_count / 2, 100);
        release(&c);
        free(text);
    }
}

// ---- e1m1, as the claims have it ----

// Of the cones from the origin over a loop, counterclockwise from the front.
static double cones_of(const compile_mesh *m, uint32_t first, uint32_t count)
{
    const double *a = m->vertices[m->loop[first]].position;
    double sum = 0;
    for (uint32_t i = 2; i < count; ++i) {
        const double *b = m->vertices[m->loop[first + i - 1]].position, *c = m->vertices[m->loop[first + i]].position;
        sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return sum / 6;
}

// The largest zone's share of the air. Walls and portals look into the zone in front of them: its outside is behind.
static double largest_share(const compiled *c)
{
    const compiled_zones *z = c->zones;
    double *volumes = calloc(z->zone_count, sizeof *volumes), all = 0, largest = 0;
    assert_non_null(volumes);
    for (uint32_t i = 0; i < z->mesh->polygon_count; ++i) {
        const compile_polygon *p = &z->mesh->polygons[i];
        if (z->polygon_zone[i] == UINT32_MAX || c->in->brushes[p->brush].role == BRUSH_LIQUID) continue;
        volumes[z->polygon_zone[i]] -= cones_of(z->mesh, p->first_vertex, p->vertex_count);
    }
    for (uint32_t i = 0; i < z->portal_count; ++i) {
        const double cones = cones_of(z->mesh, z->portals[i].first_vertex, z->portals[i].vertex_count);
        volumes[z->portals[i].zones[0]] -= cones;
        volumes[z->portals[i].zones[1]] += cones;
    }
    for (uint32_t i = 0; i < z->zone_count; ++i) {
        assert_true(volumes[i] > 0); // closed
        all += volumes[i];
        largest = fmax(largest, volumes[i]);
    }
    free(volumes);
    return largest / all;
}

typedef struct doorway { const char *name; double middle[3]; int axis; } doorway; // in the map's units and axes; axis: through it

// The doors that stand in a doorway; the others are bridges, floors that sink and stumps that rise, with air all round.
static const doorway e1m1_doors[] = {
    {"14 and 15", {232, 576, 64}, 0}, {"46 and 47", {129, 1800, -144}, 1}, {"139", {584, 2480, -55}, 0}, {"215", {824, 1880, -375}, 1}, {"234", {1096, 1023, -215}, 0},
};

static uint32_t zones_beside(const graph *g, const doorway *d, double off_units, uint32_t out[4])
{
    double map[3] = {d->middle[0], d->middle[1], d->middle[2]};
    map[d->axis] += off_units;
    const double at[3] = {map[0] / 32, map[2] / 32, -map[1] / 32};
    return graph_zones_at(g, at, 0, out, 4);
}

static void expect_parted(const graph *g, const doorway *d)
{
    static const double HALF_WAY = 64; // units: a portal at a jamb serves as well as one in the leaf
    uint32_t before[4], behind[4];
    const uint32_t n = zones_beside(g, d, -HALF_WAY, before), m = zones_beside(g, d, HALF_WAY, behind);
    if (n == 0 || m == 0) fail_msg("no zone beside door %s", d->name);
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t k = 0; k < m; ++k)
            if (before[i] == behind[k]) fail_msg("one zone on both sides of door %s", d->name);
}

static void e1m1_has_rooms_of_fair_size_and_a_portal_at_every_door(void **state)
{
    (void)state;
    size_t size;
    char *text = real_map("quake/e1m1.map", &size);
    if (!text) skip();
    const zone_options options = zone_options_of(PORTALS_AUTO);
    compiled c;
    graph *g = NULL;
    take_rooms(&c, text, &options);
    const double share = largest_share(&c);
    print_message("e1m1: %u rooms, %u portals, the largest room holds %.1f%% of the air\n", c.scene->zone_count, c.scene->portal_count, 100 * share);
    assert_in_range(c.scene->zone_count, 16, 150);
    assert_in_range(c.scene->portal_count, 16, 100); // those of doors among them
    assert_true(share <= 0.25);
    assert_int_equal(graph_open(c.scene, allocator_heap(), &g), RESULT_OK);
    for (size_t i = 0; i < sizeof e1m1_doors / sizeof *e1m1_doors; ++i) expect_parted(g, &e1m1_doors[i]);
    graph_close(g);
    release(&c);
    free(text);
}

static void portals_are_no_more_than_asked_for(void **state)
{
    (void)state;
    size_t size;
    char *text = real_map("quake/dm4.map", &size); // without doors: all its portals are between rooms
    if (!text) skip();
    for (uint32_t most = 10; most <= 160; most *= 4) {
        zone_options options = zone_options_of(PORTALS_AUTO);
        options.rooms.portals = most;
        compiled c;
        take_rooms(&c, text, &options);
        print_message("at most %u: %u portals, %u rooms\n", most, c.scene->portal_count, c.scene->zone_count);
        assert_in_range(c.scene->portal_count, most / 2, most);
        release(&c);
    }
    free(text);
}

// ---- Memory ----

static result part(const char *text, const allocator *memory, report *r)
{
    compile_input *in;
    compile_mesh *mesh;
    compiled_zones *zones;
    csg_counts counts;
    const zone_options options = zone_options_of(PORTALS_AUTO);
    result done = compile_input_map("rooms.map", text, strlen(text), NULL, memory, r, &in);
    if (done != RESULT_OK) return done;
    done = compile_csg(in, r, memory, &mesh, &counts);
    if (done == RESULT_OK) done = compile_zones_with(in, mesh, &options, r, memory, &zones);
    if (done == RESULT_OK) {
        scene *s = NULL;
        compile_checks checks;
        done = compile_items(in, zones, r, memory, &s, &checks);
        if (done == RESULT_OK) scene_free(s, memory);
        compiled_zones_free(zones);
    }
    compile_input_free(in);
    return done;
}

static void whichever_allocation_fails_all_is_given_back(void **state)
{
    (void)state;
    static map_writer w;
    write_rooms_alone(&w, "");
    write_inhabitants(&w);
    result done = RESULT_NO_MEMORY;
    for (uint64_t at = 1; done != RESULT_OK; ++at) {
        failing_allocator a;
        failing_allocator_init(&a, at);
        report_lines lines;
        report_lines_init(&lines);
        done = part(w.text, &a.memory, &lines.report);
        assert_true(done == RESULT_OK || done == RESULT_NO_MEMORY);
        assert_true(failing_allocator_is_clean(&a));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_doorway_parts_two_rooms),
        cmocka_unit_test(no_more_rooms_than_asked_for),
        cmocka_unit_test(a_door_stays_a_portal_of_its_own),
        cmocka_unit_test(a_door_is_given_up_where_no_portal_may_be),
        cmocka_unit_test(real_maps_are_parted_into_closed_rooms),
        cmocka_unit_test(e1m1_has_rooms_of_fair_size_and_a_portal_at_every_door),
        cmocka_unit_test(portals_are_no_more_than_asked_for),
        cmocka_unit_test(whichever_allocation_fails_all_is_given_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
