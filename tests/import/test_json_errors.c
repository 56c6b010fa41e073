// Bad JSON scenes: each fault with its whole line, which names file, line, column and key.
// SPDX-License-Identifier: MIT
#include "json_support.h"

#include <stdio.h>
#include <string.h>

#define HEAD "{\"portcullis\": 1,\n"
#define BOX "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,1]}]"
#define ROOMS "\"zones\": [{\"name\": \"a\", \"box\": [[0,0,0],[1,1,1]]}, {\"name\": \"b\", \"box\": [[1,0,0],[2,1,1]]}],\n"

static void expect(const char *text, const char *line)
{
    expect_json_error(text, NULL, line);
}

static void zones(const char *list, const char *line) // the list begins at line 3, column 11
{
    char text[1024];
    snprintf(text, sizeof text, HEAD BOX ",\n\"zones\": [%s]}", list);
    expect(text, line);
}

static void portal(const char *entry, const char *line) // the entry begins at line 4, column 13
{
    char text[1024];
    snprintf(text, sizeof text, HEAD BOX ",\n" ROOMS "\"portals\": [%s]}", entry);
    expect(text, line);
}

static void mover(const char *rest, const char *line) // the rest begins at line 4, column 1
{
    char text[1024];
    snprintf(text, sizeof text, HEAD BOX ",\n\"movers\": [{\"name\": \"m\", \"box\": {\"min\": [0,0,0], \"max\": [1,1,1]},\n%s}", rest);
    expect(text, line);
}

static void text_that_is_not_json_is_told_where_it_stops_being_so(void **state)
{
    (void)state;
    expect("{", "t.json:1:2: error: not JSON: string or '}' expected near end of file; correct it");
    expect(HEAD BOX ",}", "t.json:2:45: error: not JSON: string or '}' expected near '}'; correct it");
    expect(HEAD BOX "} more", "t.json:2:46: error: not JSON: end of file expected near 'more'; correct it");
    expect(HEAD "\"n\xc3\xbc\": tru}", "t.json:2:7: error: not JSON: invalid token near 'tru'; correct it"); // two bytes, one column
    expect(HEAD "\"name\": \"a\", \"name\": \"b\"}", "t.json:2:14: error: not JSON: duplicate object key near '\"name\"'; correct it");
    expect(HEAD "\"name\": \"\\u0000\"}", "t.json:2:9: error: a text holds \\u0000, which no name can; take it out");
}

static void the_format_is_asked_for_first(void **state)
{
    (void)state;
    expect("[]", "t.json:1:1: error: an array, where an object { } belongs");
    expect("{}", "t.json:1:1: error: 'portcullis' is missing; begin with {\"portcullis\": 1, ...} if this is a scene");
    expect("{\"portcullis\": 2}", "t.json:1:16: error: /portcullis: format 2; this reader knows format 1");
    expect("{\"portcullis\": \"1\"}", "t.json:1:16: error: /portcullis: a text, where a number belongs");
    expect("{\"portcullis\": 1}", "t.json: error: no polygon to draw; add \"meshes\", \"boxes\", \"walls\" or \"movers\"");
}

static void an_unknown_key_is_named_with_what_was_meant(void **state)
{
    (void)state;
    expect(HEAD "\"boxs\": []}", "t.json:2:1: error: /boxs: this key is unknown here; did you mean 'boxes'? Known: portcullis, name, include, meshes, boxes, "
                                 "walls, zones, portals, doors, movers, lights, paths, brushes, zone_info, starts, $schema");
    expect(HEAD "\"boxes\": [{\"min\": [0,0,0],\n \"max\": [1,1,1],\n \"texture\": 1}]}",
           "t.json:4:2: error: /boxes/0/texture: this key is unknown here; known: min, max, material, side, omit, name");
}

static void a_value_of_the_wrong_kind_or_length_is_told_at_its_place(void **state)
{
    (void)state;
    expect(HEAD "\"boxes\": {}}", "t.json:2:10: error: /boxes: an object, where an array [ ] belongs");
    expect(HEAD "\"boxes\": [3]}", "t.json:2:11: error: /boxes/0: a number, where an object { } belongs");
    expect(HEAD "\"boxes\": [{\"min\": [0,0]}]}", "t.json:2:11: error: /boxes/0: 'max' is missing; add it");
    expect(HEAD "\"boxes\": [{\"max\": [0,0,0],\n\"min\": [0,0]}]}", "t.json:3:8: error: /boxes/0/min: 2 values; write 3 numbers");
    expect(HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,\"2\"]}]}", "t.json:2:40: error: /boxes/0/max/2: a text, where a number belongs");
    expect(HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,-1]}]}",
           "t.json:2:11: error: /boxes/0: min is above max in z; write the three least coordinates as min");
    expect(HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,0,0]}]}",
           "t.json:2:11: error: /boxes/0: no face with an area; make it wider in two directions, omit less, or take it out");
    expect(HEAD "\"boxes\": [{\"min\": [0,0,0], \"max\": [1,1,1], \"side\": \"inside\"}]}", "t.json:2:52: error: /boxes/0/side: 'inside' is none of: out, in");
    expect(HEAD BOX ", \"walls\": [{\"points\": [[0,0,0],[1,0,0]]}]}", "t.json:2:67: error: /walls/0/points: 2 values; write at least 3");
}

static void a_wall_that_is_no_flat_convex_polygon_is_refused(void **state)
{
    (void)state;
    expect(HEAD "\"walls\": [{\"points\": [[0,0,0],[1,0,0],[2,0,0]]}]}",
           "t.json:2:22: error: /walls/0/points: the wall has no area: its points lie on a line, or its edges cross; give them in order around it");
    expect(HEAD "\"walls\": [{\"points\": [[0,0,0],[1,1,0],[1,0,0],[0,1,0]]}]}", // a bow-tie
           "t.json:2:22: error: /walls/0/points: the wall has no area: its points lie on a line, or its edges cross; give them in order around it");
    expect(HEAD "\"walls\": [{\"points\": [[0,0,0],[1,0,0],[1,1,0],[0,1,0.1]]}]}",
           "t.json:2:22: error: /walls/0/points: the wall is not flat; move its points into one plane, or split it into triangles");
    expect(HEAD "\"walls\": [{\"points\": [[0,0,0],[2,0,0],[0.5,0.5,0],[0,2,0]]}]}",
           "t.json:2:22: error: /walls/0/points: the wall is not convex; split it");
    expect(HEAD "\"walls\": [{\"points\": [[0,3,0],[2,-3,0],[-3,1,0],[3,1,0],[-2,-3,0]]}]}", // a star: turns one way only, twice round
           "t.json:2:22: error: /walls/0/points: the wall is not convex; split it");
    expect(HEAD "\"walls\": [{\"points\": [[0,0,0],[1,0,0],[1,0,0],[0,1,0]]}]}",
           "t.json:2:22: error: /walls/0/points: the wall has a point twice; drop one");
}

static void an_empty_zone_is_refused(void **state)
{
    (void)state;
    zones("{\"name\": \"a\", \"box\": [[0,0,0],[1,0,1]]}",
          "t.json:3:32: error: /zones/0/box: the zone is empty in y; write [[least x, y, z], [greatest x, y, z]]");
    zones("{\"name\": \"a\", \"hull\": [[0,0,0],[1,0,0],[0,1,0],[1,1,0]]}",
          "t.json:3:33: error: /zones/0/hull: the hull is flat; give points that are not all in one plane");
    zones("{\"name\": \"a\", \"hull\": [[0,0,0],[1,0,0],[2,0,0],[3,0,0]]}",
          "t.json:3:33: error: /zones/0/hull: the hull is flat; give points that are not all in one plane");
    zones("{\"name\": \"a\", \"hulls\": []}", "t.json:3:34: error: /zones/0/hulls: 0 values; write at least 1");
}

static void zones_that_overlap_are_warned_of(void **state)
{
    (void)state;
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    const char *text = HEAD BOX ", \"zones\": [{\"name\": \"a\", \"box\": [[0,0,0],[1,1,1]]}, {\"name\": \"b\", \"box\": [[0.5,0,0],[2,1,1]]}]}";
    assert_int_equal(import_json("t.json", text, strlen(text), &doors_open, NULL, allocator_heap(), &r, &s), RESULT_OK);
    assert_int_equal(r.warnings, 1);
    assert_string_equal(h.text, "t.json: warning: the zones \"a\" and \"b\" overlap by over 1 cm; give each its own space, or put one in the other");
    scene_free(s, allocator_heap());
}

static void a_zone_apart_from_the_one_it_lies_in_is_warned_of(void **state)
{
    (void)state;
    static const char text[] = HEAD BOX ",\n\"zones\": [{\"name\": \"a\", \"box\": [[0,0,0],[1,1,1]]}, {\"name\": \"b\", \"box\": [[3,0,0],[4,1,1]], \"in\": \"a\"}]}";
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    assert_int_equal(import_json("t.json", text, sizeof text - 1, &doors_open, NULL, allocator_heap(), &r, &s), RESULT_OK);
    assert_int_equal(r.warnings, 1);
    assert_string_equal(h.text, "t.json: warning: the zone \"b\" is said to lie in \"a\" but does not touch it; move it there, or take \"in\" out");
    scene_free(s, allocator_heap());
}

static void names_of_zones_are_unique_known_and_not_in_a_ring(void **state)
{
    (void)state;
    zones("{\"name\": \"a\", \"box\": [[0,0,0],[1,1,1]]}, {\"name\": \"a\"}",
          "t.json:3:61: error: /zones/1/name: there is a zone 'a' already; choose another name, or give one of two includes a \"name\"");
    zones("{\"box\": [[0,0,0],[1,1,1]]}", "t.json:3:11: error: /zones/0: 'name' is missing; add it");
    zones("{\"name\": \"/a\"}", "t.json:3:20: error: /zones/0/name: a name begins with '/'; take it off");
    zones("{\"name\": \"hall\"}, {\"name\": \"b\", \"box\": [[0,0,0],[1,1,1]], \"in\": \"hal\"}",
          "t.json:3:75: error: /zones/1/in: there is no zone 'hal'; did you mean 'hall'?");
    zones("{\"name\": \"a\", \"in\": \"b\"}, {\"name\": \"b\", \"box\": [[0,0,0],[1,1,1]], \"in\": \"a\"}",
          "t.json:3:31: error: /zones/0/in: the zone 'a' lies in itself by way of others, or over 64 deep; take one \"in\" out");
    zones("{\"name\": \"a\", \"box\": [[0,0,0],[1,1,1]], \"in\": \"a\"}",
          "t.json:3:57: error: /zones/0/in: the zone 'a' lies in itself; name another zone, or take \"in\" out");
    zones("{\"name\": \"a\"}, {\"name\": \"b\"}", "t.json:3:26: error: /zones/1: the zone is the second without a hull; one zone may be everywhere");
    zones("{\"name\": \"a\", \"chain\": \"frustum[\"}", "t.json:3:34: error: /zones/0/chain: chain 'frustum[', at character 9: an option's name is missing; "
                                                         "write it like octree[leaf=64]+occlusion");
}

static void a_portal_that_is_not_flat_is_refused(void **state)
{
    (void)state;
    portal("{\"zones\": [\"a\",\"b\"], \"points\": [[1,0,0],[1,0,1],[1,1,1],[1.01,1,0]]}",
           "t.json:4:13: error: /portals/0: the portal is not flat: a point lies over 1/2000 of its width off the plane of the others; correct it");
}

static void a_portal_that_is_not_convex_is_refused(void **state)
{
    (void)state;
    portal("{\"zones\": [\"a\",\"b\"], \"points\": [[1,0,0],[1,0,1],[1,0.2,0.2],[1,1,0]]}",
           "t.json:4:13: error: /portals/0: the portal is not convex; correct it");
}

static void a_portal_of_zero_area_is_refused(void **state)
{
    (void)state;
    portal("{\"zones\": [\"a\",\"b\"], \"points\": [[1,0,0],[1,0,1],[1,0,0.5]]}",
           "t.json:4:13: error: /portals/0: the portal has no area: its points lie on a line, or its edges cross; correct it");
    portal("{\"zones\": [\"a\",\"b\"], \"points\": [[1,0,0],[1,1,1],[1,0,1],[1,1,0]]}", // a bow-tie
           "t.json:4:13: error: /portals/0: the portal has no area: its points lie on a line, or its edges cross; correct it");
    portal("{\"zones\": [\"a\",\"b\"], \"points\": [[1,0,0],[1,0,1]]}", "t.json:4:44: error: /portals/0/points: 2 values; write at least 3");
}

static void a_portal_to_a_zone_that_does_not_exist_is_refused(void **state)
{
    (void)state;
    portal("{\"zones\": [\"a\",\"cellar\"], \"points\": [[1,0,0],[1,0,1],[1,1,1]]}",
           "t.json:4:28: error: /portals/0/zones/1: there is no zone 'cellar'; correct the name or add it");
    portal("{\"zones\": [\"a\"], \"points\": [[1,0,0],[1,0,1],[1,1,1]]}", "t.json:4:23: error: /portals/0/zones: 1 values; write at least 2");
}

static void a_portal_from_a_zone_to_itself_is_refused(void **state)
{
    (void)state;
    portal("{\"zones\": [\"a\",\"a\"], \"points\": [[1,0,0],[1,0,1],[1,1,1]]}",
           "t.json:4:23: error: /portals/0/zones: the portal joins the zone 'a' to itself; name two zones");
}

static void a_portal_away_from_its_zones_or_to_no_door_is_refused(void **state)
{
    (void)state;
    portal("{\"zones\": [\"a\",\"b\"], \"points\": [[5,0,0],[5,0,1],[5,1,1]]}",
           "t.json:4:45: error: /portals/0/points/0: the portal's point lies 4 m outside of its zone 'a'; move it there, or widen the zone");
    portal("{\"zones\": [\"a\",\"b\"], \"points\": [[1,0,0],[1,0,1],[1,1.25,1]]}",
           "t.json:4:61: error: /portals/0/points/2: the portal's point lies 0.25 m outside of its zone 'a'; move it there, or widen the zone");
    portal("{\"zones\": [\"a\",\"b\"], \"points\": [[1,0,0],[1,0,1],[1,1,1]], \"door\": \"front\"}",
           "t.json:4:79: error: /portals/0/door: there is no door 'front'; correct the name or add it");
}

static void a_mover_with_nan_is_refused_however_it_is_written(void **state)
{
    (void)state;
    mover("\"at\": [0, 1e999, 0]}]", "t.json:4:11: error: not JSON: real number overflow near '1e999'; correct it");
    mover("\"at\": [0, NaN, 0]}]", "t.json:4:11: error: not JSON: invalid token near 'NaN'; correct it");
    mover("\"at\": [0, \"NaN\", 0]}]", "t.json:4:11: error: /movers/0/at/1: a text, where a number belongs");
    mover("\"at\": [0, null, 0]}]", "t.json:4:11: error: /movers/0/at/1: null, where a number belongs");
    mover("\"at\": [0, 1e300, 0]}]", "t.json:4:11: error: /movers/0/at/1: 1e+300 is not within -1e+09 to 1e+09; correct it");
    mover("\"path\": [{\"time\": 0}, {\"time\": 1, \"at\": [0, null, 0]}]}]", "t.json:4:45: error: /movers/0/path/1/at/1: null, where a number belongs");
}

static void a_movers_shape_and_path_are_checked(void **state)
{
    (void)state;
    expect(HEAD BOX ", \"movers\": [{\"name\": \"m\"}]}", "t.json:2:57: error: /movers/0: the mover needs either \"file\" or \"box\"; write one of them");
    expect(HEAD BOX ", \"movers\": [{\"name\": \"m\", \"file\": \"m.json\"}]}",
           "t.json:2:79: error: /movers/0/file: a scene cannot move as one; name a mesh or a .map");
    mover("\"path\": [{\"time\": 1}, {\"time\": 1}]}]", "t.json:4:32: error: /movers/0/path/1/time: 1 s is not later than the key before it, 1 s; order the keys by time");
    mover("\"path\": []}]", "t.json:4:9: error: /movers/0/path: 0 values; write at least 1");
    mover("\"loop\": true}]", "t.json:4:9: error: /movers/0/loop: there is no \"path\" to go round; add one, or take this out");
    mover("\"scale\": 0}]", "t.json:4:10: error: /movers/0/scale: 0 is not within 1e-06 to 1e+06; correct it");
    mover("\"turn\": 90}]", "t.json:4:9: error: /movers/0/turn: a number, where an array of numbers belongs");
}

static void a_door_and_its_mover_belong_to_each_other_alone(void **state)
{
    (void)state;
    mover("\"open\": [1,0,0]}]", "t.json:4:9: error: /movers/0/open: no door has this mover; add {\"name\": ..., \"mover\": \"m\"} to \"doors\", or take it out");
    mover("\"note\": \"\"}], \"doors\": [{\"name\": \"d\", \"mover\": \"m\"}]",
          "t.json:3:12: error: /movers/0: a door has this mover; add \"open\": [dx, dy, dz], how far it moves from shut to open");
    mover("\"open\": [1,0,0]}],\n\"doors\": [{\"name\": \"d\", \"mover\": \"m\"}, {\"name\": \"e\", \"mover\": \"m\"}]",
          "t.json:5:63: error: /doors/1/mover: another door has the mover 'm' already; give each a mover of its own");
    mover("\"at\": [1,0,0]}],\n\"doors\": [{\"name\": \"d\", \"mover\": \"leaf\"}]", "t.json:5:34: error: /doors/0/mover: there is no mover 'leaf'; correct the name or add it");
    mover("\"at\": [1,0,0]}],\n\"doors\": [{\"name\": \"d\", \"open\": \"yes\"}]", "t.json:5:33: error: /doors/0/open: a text, where true or false belongs");
}

static void a_mover_that_leaves_the_world_is_refused(void **state)
{
    (void)state;
    static const char path[] = "t.json:3:12: error: /movers/0: the mover's path leads beyond 1e9 m; keep it nearer to the scene's origin";
    static const char leaf[] = "t.json:5:11: error: /doors/0: the door has a leaf that lies beyond 1e9 m, shut or open; keep it nearer to the scene's origin";
    mover("\"path\": [{\"time\": 0}, {\"time\": 1, \"at\": [0, 1e9, 0]}]}]", path);
    mover("\"pivot\": [-1e9, 0, 0], \"path\": [{\"time\": 0, \"turn\": [0, 180, 0]}]}]", path);
    mover("\"open\": [0, 0, 1e9]}],\n\"doors\": [{\"name\": \"d\", \"mover\": \"m\", \"open\": false}]", leaf);
}

static void a_portals_normal_is_three_numbers_off_its_plane(void **state)
{
    (void)state;
    portal("{\"zones\": [\"a\",\"b\"], \"points\": [[1,0,0],[1,0,1],[1,1,1]], \"normal\": [1,0]}",
           "t.json:4:81: error: /portals/0/normal: 2 values; write 3 numbers");
    portal("{\"zones\": [\"a\",\"b\"], \"points\": [[1,0,0],[1,0,1],[1,1,1]], \"normal\": [0,1,0]}",
           "t.json:4:13: error: /portals/0: the portal has a normal that lies in its plane; correct it");
}

static void lights_and_views_are_checked(void **state)
{
    (void)state;
    expect(HEAD BOX ",\n\"lights\": [{\"kind\": \"lamp\"}]}", "t.json:3:21: error: /lights/0/kind: 'lamp' is none of: point, sun");
    expect(HEAD BOX ",\n\"lights\": [{\"kind\": \"sun\"}]}", "t.json:3:12: error: /lights/0: 'direction' is missing; add it");
    expect(HEAD BOX ",\n\"paths\": [{\"name\": \"w\", \"views\": [{\"eye\": [0,0,0], \"forward\": [0,1,0]}]}]}",
           "t.json:3:35: error: /paths/0/views/0: up is parallel to forward; correct the view");
    expect(HEAD BOX ",\n\"paths\": [{\"name\": \"w\", \"views\": [{\"eye\": [0,0,0], \"forward\": [1,0,0], \"far\": \"none\"}]}]}",
           "t.json:3:79: error: /paths/0/views/0/far: far is a number of metres or \"inf\"; correct it");
    expect(HEAD BOX ",\n\"paths\": [{\"name\": \"w\"}]}", "t.json:3:11: error: /paths/0: the path needs either \"views\" or \"file\"; write one of them");
}

static void a_missing_file_is_told_where_it_is_named(void **state)
{
    (void)state;
    const memory_file files[] = {{"sub/a.json", HEAD "\"include\": [\n {\"file\": \"../b.obj\"}]}"}, {0}};
    expect_json_error(HEAD "\"include\": [{\"file\": \"sub/a.json\"}]}", files,
                      "sub/a.json:3:11: error: /include/0/file: b.obj: cannot open it: no such file in memory; check the name");
    expect(HEAD "\"meshes\": [{\"file\": \"x.obj\"}]}", "t.json:2:21: error: /meshes/0/file: x.obj: cannot open it: no such file in memory; check the name");
    expect(HEAD "\"include\": [{\"file\": \"x.txt\"}]}",
           "t.json:2:22: error: /include/0/file: unknown kind of scene; the name must end in .json, .map, .obj, .ply, .off, .stl or .boxes");
    expect(HEAD "\"meshes\": [{\"file\": \"x.json\"}]}", "t.json:2:21: error: /meshes/0/file: a scene is no mesh; put it under \"include\"");
}

static void a_fault_in_an_included_file_is_told_there(void **state)
{
    (void)state;
    const memory_file files[] = {{"b.boxes", "boxes 1\n0 0 0 1 1\n"}, {0}};
    expect_json_error(HEAD "\"include\": [{\"file\": \"b.boxes\"}]}", files, "b.boxes:2: error: not six decimal numbers; write minx miny minz maxx maxy maxz");
}

static void two_includes_without_a_name_clash(void **state)
{
    (void)state;
    const memory_file files[] = {{"r.json", HEAD BOX ", \"zones\": [\n{\"name\": \"r\", \"box\": [[0,0,0],[1,1,1]]}]}"}, {0}};
    expect_json_error(HEAD "\"include\": [{\"file\": \"r.json\"}, {\"file\": \"r.json\", \"at\": [5,0,0]}]}", files,
                      "r.json:3:10: error: /zones/0/name: there is a zone 'r' already; choose another name, or give one of two includes a \"name\"");
    expect_json_error(HEAD "\"include\": [{\"file\": \"r.json\", \"name\": \"/r\"}]}", files,
                      "t.json:2:40: error: /include/0/name: a name begins with '/'; take it off");
    expect_json_error(HEAD "\"include\": [{\"file\": \"r.obj\", \"name\": \"r\"}]}", files,
                      "t.json:2:39: error: /include/0/name: only a .json include has names to put this before; take it out");
}

static void cyclic_includes_show_their_chain(void **state)
{
    (void)state;
    const memory_file files[] = {{"t.json", HEAD "\"include\": [{\"file\": \"lib/a.json\"}]}"},
                                 {"lib/a.json", HEAD "\"include\": [{\"file\": \"./b.json\"}]}"},
                                 {"lib/b.json", HEAD "\"include\": [{\"file\": \"../lib//x/../a.json\"}]}"}, {0}};
    expect_json_error(files[0].text, files, "lib/b.json:2:22: error: /include/0/file: includes itself: t.json -> lib/a.json -> lib/b.json -> lib/a.json; take one of these out");
    expect(HEAD "\"include\": [{\"file\": \"t.json\"}]}", "t.json:2:22: error: /include/0/file: includes itself: t.json -> t.json; take one of these out");
}

// Every file includes one that is called otherwise: no cycle, but no end either.
static result read_endless(void *user, const char *path, const allocator *memory, report *r, char **out_text, size_t *out_size)
{
    unsigned *files = user;
    char text[128];
    (void)path, (void)r;
    *out_size = (size_t)snprintf(text, sizeof text, HEAD "\"include\": [{\"file\": \"%u.json\"}]}", ++*files);
    *out_text = memory_alloc(memory, *out_size + 1, 1);
    assert_non_null(*out_text);
    memcpy(*out_text, text, *out_size + 1);
    return RESULT_OK;
}

static void includes_go_64_deep_and_no_deeper(void **state)
{
    (void)state;
    unsigned files = 0;
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    const import_files endless = {read_endless, &files};
    const char *text = HEAD "\"include\": [{\"file\": \"0.json\"}]}";
    assert_int_equal(import_json("t.json", text, strlen(text), &doors_open, &endless, allocator_heap(), &r, &s), RESULT_BAD_INPUT);
    assert_int_equal(files, 63);
    assert_string_equal(h.text, "62.json:2:22: error: /include/0/file: included 64 deep; include fewer within each other");
}

static void includes_that_multiply_are_stopped(void **state)
{
    (void)state;
    memory_file files[20] = {{0}};
    char names[20][24], texts[20][256];
    for (int i = 0; i < 18; ++i) { // each includes the next twice: 2^18 files
        snprintf(names[i], sizeof names[i], "%d.json", i);
        snprintf(texts[i], sizeof texts[i], HEAD "\"include\": [{\"file\": \"%d.json\", \"name\": \"a\"}, {\"file\": \"%d.json\", \"name\": \"b\"}]}", i + 1, i + 1);
        files[i] = (memory_file){names[i], texts[i]};
    }
    files[18] = (memory_file){"18.json", HEAD BOX "}"};
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    const import_files from = memory_files(files);
    const char *text = HEAD "\"include\": [{\"file\": \"0.json\"}]}";
    assert_int_equal(import_json("t.json", text, strlen(text), &doors_open, &from, allocator_heap(), &r, &s), RESULT_BAD_INPUT);
    assert_int_equal(r.errors, 1);
    assert_non_null(strstr(h.text, "over 65536 files and copies in one scene; use fewer"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_that_is_not_json_is_told_where_it_stops_being_so),
        cmocka_unit_test(the_format_is_asked_for_first),
        cmocka_unit_test(an_unknown_key_is_named_with_what_was_meant),
        cmocka_unit_test(a_value_of_the_wrong_kind_or_length_is_told_at_its_place),
        cmocka_unit_test(a_wall_that_is_no_flat_convex_polygon_is_refused),
        cmocka_unit_test(an_empty_zone_is_refused),
        cmocka_unit_test(zones_that_overlap_are_warned_of),
        cmocka_unit_test(a_zone_apart_from_the_one_it_lies_in_is_warned_of),
        cmocka_unit_test(names_of_zones_are_unique_known_and_not_in_a_ring),
        cmocka_unit_test(a_portal_that_is_not_flat_is_refused),
        cmocka_unit_test(a_portal_that_is_not_convex_is_refused),
        cmocka_unit_test(a_portal_of_zero_area_is_refused),
        cmocka_unit_test(a_portal_to_a_zone_that_does_not_exist_is_refused),
        cmocka_unit_test(a_portal_from_a_zone_to_itself_is_refused),
        cmocka_unit_test(a_portal_away_from_its_zones_or_to_no_door_is_refused),
        cmocka_unit_test(a_mover_with_nan_is_refused_however_it_is_written),
        cmocka_unit_test(a_movers_shape_and_path_are_checked),
        cmocka_unit_test(a_door_and_its_mover_belong_to_each_other_alone),
        cmocka_unit_test(a_mover_that_leaves_the_world_is_refused),
        cmocka_unit_test(a_portals_normal_is_three_numbers_off_its_plane),
        cmocka_unit_test(lights_and_views_are_checked),
        cmocka_unit_test(a_missing_file_is_told_where_it_is_named),
        cmocka_unit_test(a_fault_in_an_included_file_is_told_there),
        cmocka_unit_test(two_includes_without_a_name_clash),
        cmocka_unit_test(cyclic_includes_show_their_chain),
        cmocka_unit_test(includes_go_64_deep_and_no_deeper),
        cmocka_unit_test(includes_that_multiply_are_stopped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
