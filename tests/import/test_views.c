// Camera paths: files there and back, faults, and the automatic views against a brute-force search for room.
// SPDX-License-Identifier: MIT
#include "brushes.h"
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double CLEARANCE = 0.125, ASPECT = 16.0 / 9;

// ---- Files ----

static void expect_error(const char *text, const char *line)
{
    heard h;
    report r = hear(&h);
    camera_path path = {0};
    assert_int_equal(camera_path_parse("t.views", text, strlen(text), allocator_heap(), &r, &path), RESULT_BAD_INPUT);
    assert_int_equal(r.errors, 1);
    assert_string_equal(h.text, line);
    assert_null(path.cameras);
}

static void views_are_read_with_comments_and_named_after_their_file(void **state)
{
    (void)state;
    const char *text = "# a path\n\n0 1.7 -120 0 0 1 0 1 0 60 1.777778 0.1 10000\r\n 1 2 3 -1 0 0 0 1 0 90 1 0.5 inf # the last\n";
    heard h;
    report r = hear(&h);
    camera_path path;
    assert_int_equal(camera_path_parse("some/where/city.views", text, strlen(text), allocator_heap(), &r, &path), RESULT_OK);
    assert_int_equal(path.count, 2);
    assert_string_equal(path.name, "city");
    assert_true(path.cameras[0].eye[2] == -120 && path.cameras[0].forward[2] == 1 && path.cameras[0].up[1] == 1);
    assert_true(path.cameras[0].fovy_deg == 60 && path.cameras[0].aspect == 1.777778 && path.cameras[0].near_m == 0.1 && path.cameras[0].far_m == 10000);
    assert_true(isinf(path.cameras[1].far_m));
    camera_path_free(&path, allocator_heap());
}

static void what_is_no_view_is_refused_with_its_line(void **state)
{
    (void)state;
    expect_error("", "t.views: error: no view in it; write 13 numbers a line");
    expect_error("# only a comment\n", "t.views: error: no view in it; write 13 numbers a line");
    expect_error("0 0 0 0 0 1 0 1 0 60 1 0.1\n",
                 "t.views:1: error: number 13 of 13 is missing or no decimal number; write eye(3) dir(3) up(3) fovy_deg aspect near far");
    expect_error("0 0 0 0 0 1 0 1 0 60 1 0.1 10\n0 0 nan 0 0 1 0 1 0 60 1 0.1 10\n",
                 "t.views:2: error: number 3 of 13 is missing or no decimal number; write eye(3) dir(3) up(3) fovy_deg aspect near far");
    expect_error("0 0 0 0 0 1 0 1 0 60 1 0.1 10 7\n", "t.views:1: error: more than 13 numbers; write one view a line");
    expect_error("\n0 0 0 0 0 0 0 1 0 60 1 0.1 10\n", "t.views:2: error: forward is zero; correct the view");
}

static scene *real_map_with(const char *name, const import_options *doors)
{
    size_t size;
    char *text = real_scene(name, &size);
    if (!text) skip();
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    const int is_map = strstr(name, ".map") != NULL;
    const result done = is_map ? import_map(name, text, size, doors, allocator_heap(), &r, &s) : import_boxes(name, text, size, allocator_heap(), &r, &s);
    assert_int_equal(done, RESULT_OK);
    memory_free(allocator_heap(), text, size + 1, 1);
    return s;
}

static scene *real_map(const char *name)
{
    return real_map_with(name, &doors_open);
}

static camera_path automatic(const char *what, const scene *s)
{
    heard h;
    report r = hear(&h);
    camera_path path;
    if (camera_path_load(what, s, ASPECT, allocator_heap(), &r, &path) != RESULT_OK) fail_msg("%s", h.text);
    assert_string_equal(path.name, what);
    return path;
}

static void a_path_written_reads_back_bit_for_bit(void **state)
{
    (void)state;
    scene *s = real_map("librequake/lq_e3m4.map");
    camera_path first = automatic("auto:100", s), again;
    char *text;
    size_t size;
    heard h;
    report r = hear(&h);
    assert_int_equal(camera_path_text(&first, allocator_heap(), &text, &size), RESULT_OK);
    assert_int_equal(camera_path_parse("again.views", text, size, allocator_heap(), &r, &again), RESULT_OK);
    assert_int_equal(again.count, 100);
    assert_memory_equal(again.cameras, first.cameras, 100 * sizeof *first.cameras);
    memory_free(allocator_heap(), text, size + 1, 1);
    camera_path_free(&first, allocator_heap());
    camera_path_free(&again, allocator_heap());
    scene_free(s, allocator_heap());
}

// ---- Room, by brute force ----

// The nearest point of a convex body by Dykstra's alternating projections: slow, and unlike anything in the product.
static double distance_to_solid(const scene *s, const scene_solid *solid, const double p[3])
{
    enum { ROUNDS = 400, PLANES_MOST = 64 };
    static double steps[PLANES_MOST][3];
    const scene_solid_plane *planes = s->solid_planes + solid->first_plane;
    double x[3], far_away = 0;
    for (int k = 0; k < 3; ++k) far_away = fmax(far_away, fmax(solid->min[k] - p[k], p[k] - solid->max[k]));
    if (far_away > 1) return far_away;
    assert_true(solid->plane_count <= PLANES_MOST);
    memset(steps, 0, sizeof steps);
    memcpy(x, p, sizeof x);
    for (int round = 0; round < ROUNDS; ++round)
        for (uint32_t i = 0; i < solid->plane_count; ++i) {
            double y[3], out = -planes[i].distance;
            for (int k = 0; k < 3; ++k) {
                y[k] = x[k] + steps[i][k];
                out += planes[i].normal[k] * y[k];
            }
            for (int k = 0; k < 3; ++k) {
                x[k] = y[k] - fmax(out, 0) * planes[i].normal[k];
                steps[i][k] = y[k] - x[k];
            }
        }
    return sqrt((x[0] - p[0]) * (x[0] - p[0]) + (x[1] - p[1]) * (x[1] - p[1]) + (x[2] - p[2]) * (x[2] - p[2]));
}

static double room_at(const scene *s, const double p[3])
{
    double least = 1;
    for (uint32_t i = 0; i < s->solid_count; ++i) {
        const double distance = distance_to_solid(s, &s->solids[i], p);
        if (s->solids[i].kind == SOLID_LIQUID && distance > 0) continue; // only its inside is no room
        least = fmin(least, distance);
    }
    for (uint32_t i = 0; i < s->item_count; ++i) {
        if (!(s->items[i].flags & CULL_ITEM_BOX)) continue;
        double sum = 0;
        const double min[3] = {s->boxes.min_x[i], s->boxes.min_y[i], s->boxes.min_z[i]}, max[3] = {s->boxes.max_x[i], s->boxes.max_y[i], s->boxes.max_z[i]};
        for (int k = 0; k < 3; ++k) {
            const double out = fmax(0, fmax(min[k] - (p[k] - s->whole.origin[k]), p[k] - s->whole.origin[k] - max[k]));
            sum += out * out;
        }
        least = fmin(least, sqrt(sum));
    }
    return least;
}

static int are_near(const double a[3], const double b[3])
{
    return fabs(a[0] - b[0]) < 1e-9 && fabs(a[1] - b[1]) < 1e-9 && fabs(a[2] - b[2]) < 1e-9;
}

static int is_at_a_place(const scene *s, const double eye[3])
{
    for (uint32_t i = 0; i < s->place_count; ++i) {
        const double *at = s->places[i].position, lift = s->places[i].kind == PLACE_OTHER ? 0 : 0.7;
        const double lifted[3] = {at[0], at[1] + lift, at[2]};
        if (are_near(lifted, eye)) return 1;
    }
    return 0;
}

static void automatic_views_stand_in_air_with_room_around_them(void **state)
{
    (void)state;
    for (int m = 0; m < 8; ++m) {
        scene *s = real_map(real_maps[m]);
        camera_path path = automatic("auto:60", s);
        assert_int_equal(path.count, 60);
        for (uint32_t i = 0; i < path.count; ++i) {
            const camera *c = &path.cameras[i];
            assert_null(camera_fault(c));
            assert_true(is_at_a_place(s, c->eye));
            assert_true(room_at(s, c->eye) > CLEARANCE - 1e-3);
            const double level = sqrt(c->forward[0] * c->forward[0] + c->forward[2] * c->forward[2]);
            assert_true(fabs(atan2(c->forward[1], level)) <= 25.0001 * 3.14159265358979 / 180);
            assert_true(c->fovy_deg == 60 && c->aspect == ASPECT && c->near_m == 0.0625 && c->far_m >= 4 * scene_radius_m(s));
        }
        camera_path_free(&path, allocator_heap());
        scene_free(s, allocator_heap());
    }
}

// Of the places that an automatic view may take, none is left out: by the same brute force.
static void every_place_with_room_is_used(void **state)
{
    (void)state;
    scene *s = real_map("librequake/lqdm12.map");
    camera_path path = automatic("auto:400", s);
    uint32_t good = 0, used = 0;
    for (uint32_t i = 0; i < s->place_count; ++i) {
        double eye[3];
        memcpy(eye, s->places[i].position, sizeof eye);
        if (s->places[i].kind != PLACE_OTHER) eye[1] += 0.7;
        if (room_at(s, eye) < CLEARANCE + 1e-3) continue;
        ++good;
        for (uint32_t v = 0; v < path.count; ++v)
            if (are_near(path.cameras[v].eye, eye)) {
                ++used;
                break;
            }
    }
    assert_true(good > 50);
    assert_int_equal(used, good);
    camera_path_free(&path, allocator_heap());
    scene_free(s, allocator_heap());
}

static void the_same_scene_gives_the_same_views(void **state)
{
    (void)state;
    static const char *const whats[] = {"auto:50", "auto:walk:200", "auto:street:20", "auto:roofs:20", "auto:turn:20"};
    for (int w = 0; w < 2; ++w) {
        scene *a = real_map("quake/dm4.map"), *b = real_map("quake/dm4.map");
        camera_path pa = automatic(whats[w], a), pb = automatic(whats[w], b);
        assert_memory_equal(pa.cameras, pb.cameras, pa.count * sizeof *pa.cameras);
        camera_path_free(&pa, allocator_heap());
        camera_path_free(&pb, allocator_heap());
        scene_free(a, allocator_heap());
        scene_free(b, allocator_heap());
    }
}

static void yaw_is_spread_all_around(void **state)
{
    (void)state;
    scene *s = real_map("boxes/city-1000.boxes");
    camera_path path = automatic("auto:800", s);
    uint32_t sectors[8] = {0};
    for (uint32_t i = 0; i < path.count; ++i) {
        const double yaw = atan2(path.cameras[i].forward[2], path.cameras[i].forward[0]);
        sectors[(int)((yaw + 3.14159265358979324) / 6.2831853072 * 8) % 8]++;
    }
    for (int k = 0; k < 8; ++k) assert_true(sectors[k] > 60 && sectors[k] < 140); // 100 expected, 10 one sigma
    camera_path_free(&path, allocator_heap());
    scene_free(s, allocator_heap());
}

static void views_of_boxes_stand_outside_of_them(void **state)
{
    (void)state;
    scene *s = real_map("boxes/city-1000.boxes");
    camera_path path = automatic("auto:300", s);
    for (uint32_t i = 0; i < path.count; ++i) assert_true(room_at(s, path.cameras[i].eye) >= CLEARANCE - 1e-9);
    camera_path_free(&path, allocator_heap());
    scene_free(s, allocator_heap());
}

// ---- Walks ----

static void expect_walk(const char *scene_name)
{
    enum { FRAMES = 500 };
    scene *s = real_map(scene_name);
    camera_path path = automatic("auto:walk:500", s);
    assert_int_equal(path.count, FRAMES);
    double widest = 0;
    for (uint32_t i = 0; i < FRAMES; ++i) {
        const camera *c = &path.cameras[i];
        assert_null(camera_fault(c));
        if (i % 4 == 0) assert_true(room_at(s, c->eye) > CLEARANCE - 1e-3);
        const double level = sqrt(c->forward[0] * c->forward[0] + c->forward[2] * c->forward[2]);
        assert_true(fabs(atan2(c->forward[1], level)) <= 15.0001 * 3.14159265358979 / 180);
        if (i == 0) continue;
        double step = 0, turn = 0, way = 0;
        for (int k = 0; k < 3; ++k) {
            const double d = c->eye[k] - c[-1].eye[k], w = c->eye[k] - path.cameras[0].eye[k];
            step += d * d;
            way += w * w;
            turn += c->forward[k] * c[-1].forward[k];
        }
        assert_true(fabs(sqrt(step) - 0.3) < 1e-9);
        assert_true(turn > cos(8 * 3.14159265358979 / 180)); // the view never jerks
        widest = fmax(widest, sqrt(way));
    }
    assert_true(widest > 10);
    camera_path_free(&path, allocator_heap());
    scene_free(s, allocator_heap());
}

static void a_walk_keeps_its_pace_and_its_distance_in_maps(void **state)
{
    (void)state;
    for (int m = 0; m < 8; ++m) expect_walk(real_maps[m]);
}

static void a_walk_keeps_its_pace_and_its_distance_among_boxes(void **state)
{
    (void)state;
    expect_walk("boxes/city-1000.boxes");
}

// Between boxes: 1.7 m over the ground that they stand on, at one pace.
static void a_street_is_walked_on_the_ground(void **state)
{
    (void)state;
    scene *s = real_map("boxes/city-1000.boxes");
    camera_path path = automatic("auto:street:100", s);
    for (uint32_t i = 0; i < path.count; ++i) {
        const double *eye = path.cameras[i].eye, *last = path.cameras[i ? i - 1 : 0].eye;
        assert_true(fabs(eye[1] - 1.7) < 1e-9);
        assert_true(room_at(s, eye) > 0.5 - 1e-6);
        assert_true(hypot(eye[0] - last[0], eye[2] - last[2]) < 2.4 + 1e-9);
    }
    camera_path_free(&path, allocator_heap());
    scene_free(s, allocator_heap());
}

// In a car: 1.2 m over the ground, a metre a view, wide turns, and nowhere nearer to a wall than 0.75 m.
static void a_drive_keeps_its_pace_and_its_distance(void **state)
{
    (void)state;
    scene *s = real_map("boxes/city-1000.boxes");
    camera_path path = automatic("auto:drive:500", s);
    double widest = 0;
    for (uint32_t i = 0; i < path.count; ++i) {
        const camera *c = &path.cameras[i], *last = &path.cameras[i ? i - 1 : 0];
        assert_null(camera_fault(c));
        assert_true(fabs(c->eye[1] - 1.2) < 1e-9);
        assert_true(room_at(s, c->eye) > 0.75 - 1e-6);
        widest = fmax(widest, hypot(c->eye[0] - path.cameras[0].eye[0], c->eye[2] - path.cameras[0].eye[2]));
        if (i == 0) continue;
        assert_true(fabs(hypot(c->eye[0] - last->eye[0], c->eye[2] - last->eye[2]) - 1) < 1e-9);
        double turn = 0;
        for (int k = 0; k < 3; ++k) turn += c->forward[k] * last->forward[k];
        assert_true(turn > cos(4 * 3.14159265358979 / 180));
    }
    assert_true(widest > 50);
    camera_path_free(&path, allocator_heap());
    scene_free(s, allocator_heap());
}

static void expect_no_street(const scene *s)
{
    heard h;
    report r = hear(&h);
    camera_path path = {0};
    assert_int_equal(camera_path_load("auto:street:20", s, ASPECT, allocator_heap(), &r, &path), RESULT_BAD_INPUT);
    assert_non_null(strstr(h.text, "room to walk; use auto:walk:20"));
    assert_null(path.cameras);
    r = hear(&h);
    assert_int_equal(camera_path_load("auto:drive:20", s, ASPECT, allocator_heap(), &r, &path), RESULT_BAD_INPUT);
    assert_non_null(strstr(h.text, "room to drive; use auto:walk:20"));
    assert_null(path.cameras);
}

// Walls that hang in the air, and rooms under a ceiling: no walk beside or over them is one in a street.
static void a_street_is_refused_where_there_is_no_ground_under_the_sky(void **state)
{
    (void)state;
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    char text[4096];
    int size = 0;
    for (int i = 0; i < 6; ++i)
        for (int k = 0; k < 3; ++k)
            size += snprintf(text + size, sizeof text - (size_t)size, "v %d %d %d\n", 20 * i, 20 + 5 * i + (k == 1 ? 2 : 0), k == 2 ? 2 : 0);
    for (int i = 0; i < 6; ++i) size += snprintf(text + size, sizeof text - (size_t)size, "f %d %d %d\n", 3 * i + 1, 3 * i + 3, 3 * i + 2);
    assert_int_equal(import_obj("t.obj", text, (size_t)size, allocator_heap(), &r, &s), RESULT_OK);
    expect_no_street(s);
    scene_free(s, allocator_heap());
    s = real_map("quake/e1m1.map");
    expect_no_street(s);
    scene_free(s, allocator_heap());
}

static void a_flight_is_over_all_roofs_near_it(void **state)
{
    (void)state;
    scene *s = real_map("boxes/city-1000.boxes");
    camera_path path = automatic("auto:roofs:100", s);
    for (uint32_t i = 0; i < path.count; ++i) {
        assert_true(room_at(s, path.cameras[i].eye) > 0.5);
        assert_true(path.cameras[i].forward[1] < 0);
    }
    camera_path_free(&path, allocator_heap());
    scene_free(s, allocator_heap());
}

static void one_who_spins_turns_by_as_much_each_frame(void **state)
{
    (void)state;
    scene *s = real_map("boxes/city-1000.boxes");
    camera_path path = automatic("auto:turn:60", s);
    for (uint32_t i = 1; i < path.count; ++i) {
        const double *a = path.cameras[i - 1].forward, *b = path.cameras[i].forward, along = a[0] * b[0] + a[2] * b[2];
        assert_true(fabs(along / (hypot(a[0], a[2]) * hypot(b[0], b[2])) - cos(15 * 3.14159265358979 / 180)) < 1e-9);
        assert_true(room_at(s, path.cameras[i].eye) > CLEARANCE - 1e-3);
    }
    camera_path_free(&path, allocator_heap());
    scene_free(s, allocator_heap());
}

static void a_scene_without_any_room_has_a_walk_beside_it(void **state)
{
    (void)state;
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    const char *text = "boxes 1\n-1 -1 -1 1 1 1\n";
    assert_int_equal(import_boxes("t.boxes", text, strlen(text), allocator_heap(), &r, &s), RESULT_OK);
    static const char *const whats[] = {"auto:20", "auto:walk:300"};
    for (int w = 0; w < 2; ++w) {
        camera_path path = automatic(whats[w], s);
        for (uint32_t i = 0; i < path.count; ++i) {
            assert_null(camera_fault(&path.cameras[i]));
            assert_true(room_at(s, path.cameras[i].eye) > 0.05);
        }
        camera_path_free(&path, allocator_heap());
    }
    scene_free(s, allocator_heap());
}

static void doors_change_no_view(void **state)
{
    (void)state;
    static const char *const names[] = {"quake/e1m1.map", "librequake/lq_e0m8.map", "librequake/lqdm12.map"};
    static const char *const whats[] = {"auto:20", "auto:walk:20", "auto:walk:300"};
    for (int m = 0; m < 3; ++m) {
        scene *scenes[2] = {real_map_with(names[m], &doors_open), real_map_with(names[m], &doors_shut)};
        for (int w = 0; w < 3; ++w) {
            char *texts[2];
            size_t sizes[2];
            for (int d = 0; d < 2; ++d) {
                camera_path path = automatic(whats[w], scenes[d]);
                assert_int_equal(camera_path_text(&path, allocator_heap(), &texts[d], &sizes[d]), RESULT_OK);
                camera_path_free(&path, allocator_heap());
            }
            assert_string_equal(texts[0], texts[1]);
            for (int d = 0; d < 2; ++d) memory_free(allocator_heap(), texts[d], sizes[d] + 1, 1);
        }
        for (int d = 0; d < 2; ++d) scene_free(scenes[d], allocator_heap());
    }
}

// ---- Scenes that leave no room, or are smaller than an eye ----

// Planes of the view's volume that the item's box lies outside of, near among them: 0 where it touches the volume.
static int planes_missed(const scene *s, const camera *c, uint32_t item)
{
    double right[3], up[3], back[3], planes[6][4];
    camera_axes(c, right, up, back);
    const double tall = tan(c->fovy_deg * 3.14159265358979 / 360), wide = tall * c->aspect;
    for (int k = 0; k < 3; ++k) {
        planes[0][k] = right[k] - wide * back[k];
        planes[1][k] = -right[k] - wide * back[k];
        planes[2][k] = up[k] - tall * back[k];
        planes[3][k] = -up[k] - tall * back[k];
        planes[4][k] = -back[k];
        planes[5][k] = back[k];
    }
    const double offsets[6] = {0, 0, 0, 0, -c->near_m, c->far_m};
    const double min[3] = {s->boxes.min_x[item], s->boxes.min_y[item], s->boxes.min_z[item]};
    const double max[3] = {s->boxes.max_x[item], s->boxes.max_y[item], s->boxes.max_z[item]};
    int missed = 0;
    for (int p = 0; p < 6; ++p) {
        double farthest = offsets[p];
        for (int k = 0; k < 3; ++k) {
            const double eye = c->eye[k] - s->whole.origin[k];
            farthest += fmax(planes[p][k] * (min[k] - eye), planes[p][k] * (max[k] - eye));
        }
        missed += farthest < 0;
    }
    return missed;
}

static void expect_views_that_see(scene *s)
{
    camera_path path = automatic("auto:20", s);
    int seeing = 0;
    for (uint32_t v = 0; v < path.count; ++v) {
        const camera *c = &path.cameras[v];
        assert_null(camera_fault(c));
        const double level = sqrt(c->forward[0] * c->forward[0] + c->forward[2] * c->forward[2]);
        assert_true(fabs(atan2(c->forward[1], level)) <= 25.0001 * 3.14159265358979 / 180);
        int sees = 0;
        for (uint32_t i = 0; i < s->item_count + s->mover_count; ++i) sees |= planes_missed(s, c, i) == 0;
        seeing += sees;
    }
    if (seeing < 5) fail_msg("%d of 20 views see something", seeing);
    camera_path_free(&path, allocator_heap());
    scene_free(s, allocator_heap());
}

static scene *scene_from(const char *name, const char *text)
{
    heard h;
    report r = hear(&h);
    scene *s = NULL;
    const int is_obj = strstr(name, ".obj") != NULL;
    const result done = is_obj ? import_obj(name, text, strlen(text), allocator_heap(), &r, &s) : import_boxes(name, text, strlen(text), allocator_heap(), &r, &s);
    if (done != RESULT_OK) fail_msg("%s", h.text);
    return s;
}

static void flat_scenes_are_seen(void **state)
{
    (void)state;
    static const struct { const char *name, *text; } cases[] = {
        {"floor.obj", "v 0 0 0\nv 4 0 0\nv 0 0 4\nf 1 3 2\n"},
        {"wall.obj", "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 1 5 0\nv 0 3 0\nf 1 2 3 4 5\n"},
        {"side.obj", "v 7 0 0\nv 7 0 400\nv 7 300 0\nf 1 2 3\n"},
        {"tilted.obj", "v 0 0 0\nv 4 1 0\nv 0 2 4\nf 1 2 3\n"},
        {"sheet.boxes", "boxes 2\n-8 0 -8 -1 0 8\n1 0 -8 8 0 8\n"},
        {"slab.boxes", "boxes 1\n-8 0 -8 8 0.1 8\n"},
        {"pane.boxes", "boxes 1\n3 0 -8 3 5 8\n"},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) expect_views_that_see(scene_from(cases[c].name, cases[c].text));
}

static void a_map_of_one_brush_is_seen_and_its_lack_of_room_noted(void **state)
{
    (void)state;
    static const double low[3] = {0, 0, 0}, highs[3][3] = {{64, 64, 64}, {8, 8, 8}, {4096, 4096, 16}};
    for (int m = 0; m < 3; ++m) {
        map_text text = {0};
        map_add(&text, "{\n\"classname\" \"worldspawn\"\n");
        map_add_box(&text, low, highs[m], "stone");
        map_add(&text, "}\n");
        scene *s = map_of(text.text, &doors_open);
        heard h;
        report r = hear(&h);
        camera_path path;
        assert_int_equal(camera_path_load("auto:20", s, ASPECT, allocator_heap(), &r, &path), RESULT_OK);
        assert_true(h.notes > 0);
        for (uint32_t v = 0; v < path.count; ++v) assert_true(room_at(s, path.cameras[v].eye) > 0);
        camera_path_free(&path, allocator_heap());
        expect_views_that_see(s);
    }
}

static void a_model_of_a_millimetre_is_not_swallowed_by_near(void **state)
{
    (void)state;
    static const double sizes_m[] = {1e-6, 1e-3, 0.1, 0.99};
    for (int n = 0; n < 4; ++n)
        for (int f = 0; f < 2; ++f) {
            char text[256];
            if (f == 0) snprintf(text, sizeof text, "v 0 0 0\nv %g 0 0\nv 0 %g 0\nv 0 0 %g\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n", sizes_m[n], sizes_m[n], sizes_m[n]);
            else snprintf(text, sizeof text, "boxes 1\n0 0 0 %g %g %g\n", sizes_m[n], sizes_m[n], sizes_m[n]);
            scene *s = scene_from(f == 0 ? "tiny.obj" : "tiny.boxes", text);
            camera_path path = automatic("auto:1", s);
            assert_true(path.cameras[0].near_m == 0.0625);
            camera_path_free(&path, allocator_heap());
            expect_views_that_see(s);
        }
}

static void counts_that_make_no_path_are_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {"auto:", "auto:0", "auto:-3", "auto:ten", "auto:100001", "auto:99999999999999999999", "auto:walk:", "auto:walk:0", "auto:drive:", "auto:drive:0", "auto:5x"};
    scene *s = real_map("boxes/city-1000.boxes");
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
        heard h;
        report r = hear(&h);
        camera_path path = {0};
        assert_int_equal(camera_path_load(wrong[i], s, ASPECT, allocator_heap(), &r, &path), RESULT_BAD_INPUT);
        assert_non_null(strstr(h.text, "write auto:N, auto:walk:N"));
        assert_null(path.cameras);
    }
    scene_free(s, allocator_heap());
}

static void a_byte_order_mark_is_skipped(void **state)
{
    (void)state;
    static const char text[] = "\xef\xbb\xbf" "0 0 0 0 0 -1 0 1 0 60 1 0.1 100\n";
    report r = {0};
    camera_path path;
    assert_int_equal(camera_path_parse("t.views", text, sizeof text - 1, allocator_heap(), &r, &path), RESULT_OK);
    assert_int_equal(path.count, 1);
    camera_path_free(&path, allocator_heap());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_are_read_with_comments_and_named_after_their_file),
        cmocka_unit_test(what_is_no_view_is_refused_with_its_line),
        cmocka_unit_test(a_path_written_reads_back_bit_for_bit),
        cmocka_unit_test(automatic_views_stand_in_air_with_room_around_them),
        cmocka_unit_test(every_place_with_room_is_used),
        cmocka_unit_test(the_same_scene_gives_the_same_views),
        cmocka_unit_test(yaw_is_spread_all_around),
        cmocka_unit_test(views_of_boxes_stand_outside_of_them),
        cmocka_unit_test(a_walk_keeps_its_pace_and_its_distance_in_maps),
        cmocka_unit_test(a_walk_keeps_its_pace_and_its_distance_among_boxes),
        cmocka_unit_test(a_street_is_walked_on_the_ground),
        cmocka_unit_test(a_drive_keeps_its_pace_and_its_distance),
        cmocka_unit_test(a_street_is_refused_where_there_is_no_ground_under_the_sky),
        cmocka_unit_test(a_flight_is_over_all_roofs_near_it),
        cmocka_unit_test(one_who_spins_turns_by_as_much_each_frame),
        cmocka_unit_test(a_scene_without_any_room_has_a_walk_beside_it),
        cmocka_unit_test(doors_change_no_view),
        cmocka_unit_test(flat_scenes_are_seen),
        cmocka_unit_test(a_map_of_one_brush_is_seen_and_its_lack_of_room_noted),
        cmocka_unit_test(a_byte_order_mark_is_skipped),
        cmocka_unit_test(a_model_of_a_millimetre_is_not_swallowed_by_near),
        cmocka_unit_test(counts_that_make_no_path_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
