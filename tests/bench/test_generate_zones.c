// Generated scenes with zones: what the importer makes of them, closed zones, portals on their borders, paths in the air.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "bench/generate.h"
#include "host/import/import.h"
#include "obj_probe.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/random.h"
#include "tests/common/report_lines.h"

#include <errno.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>
#include <cmocka.h>

#define COUNT_OF(items) (sizeof(items) / sizeof *(items))
#define ON_BORDER_M 1e-9 // metres: borders lie on eighths of a metre, which are exact; this is for distances along a ray

static const char folder[] = "generated_zones";
static const char json_name[] = "generated_zones/scene.json", obj_name[] = "generated_zones/scene.obj";

static const struct sample {
    const char *kind;
    uint64_t size;
    uint32_t zones;
    uint64_t json_hash, obj_hash;
} samples[] = {
    {"rooms", 12, 12, 0x55916df206c21779, 0x64a08091bcdd3ca3},
    {"rooms", 1, 1, 0x8403f06b75e5ae22, 0x869e96242a02e25b},
    {"maze", 10, 10, 0x9bddf10d1af9c44f, 0x63f0e37657055d8b},
    {"maze", 60, 60, 0x7346d182bc9dd484, 0x615ad0c0a21e23c2},
    {"house", GENERATE_SIZE_OF_KIND, 12, 0x3aa611c34e52a38b, 0xe8d41ad89d4e9401},
    {"flagship", GENERATE_SIZE_OF_KIND, 69, 0x18742559b1425f6b, 0x9a404b13b65ae7e1},
};

static int folder_make(void **state)
{
    (void)state;
    return mkdir(folder, 0700) == 0 || errno == EEXIST ? 0 : -1;
}

static void files_remove(void)
{
    unlink(json_name);
    unlink(obj_name);
}

static int folder_remove(void **state)
{
    (void)state;
    files_remove();
    return rmdir(folder);
}

static void make(const char *kind, uint64_t size, uint64_t seed)
{
    report r = report_to_stderr();
    assert_int_equal(generate_scene(kind, size, seed, json_name, allocator_heap(), &r), RESULT_OK);
}

static scene *imported(const char *kind, uint64_t size, uint64_t seed)
{
    report r = report_to_stderr();
    scene *s = NULL;
    make(kind, size, seed);
    assert_int_equal(import_scene(json_name, &(import_options){DOORS_OPEN}, allocator_heap(), &r, &s), RESULT_OK);
    assert_int_equal(r.warnings, 0);
    return s;
}

static uint64_t hash_of(const char *path)
{
    size_t size = 0;
    char *bytes = bytes_of_file(path, &size);
    assert_non_null(bytes);
    const uint64_t hash = XXH3_64bits(bytes, size);
    free(bytes);
    return hash;
}

static const scene_camera_path *path_named(const scene *s, const char *name)
{
    for (uint32_t i = 0; i < s->path_count; ++i)
        if (strcmp(s->paths[i].name, name) == 0) return &s->paths[i];
    fail_msg("no path %s", name);
    return NULL;
}

static double height_in_zone(const scene *s, uint32_t zone, const double p[3]) // below 0 inside
{
    double least = INFINITY;
    const scene_zone *z = &s->zones[zone];
    for (uint32_t i = 0; i < z->hull_count; ++i) least = fmin(least, scene_hull_height(s, z->first_hull + i, p));
    return least;
}

// ---- Bytes ----

static void every_compiler_and_machine_gives_these_bytes(void **state)
{
    (void)state;
    int wrong = 0;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        make(samples[i].kind, samples[i].size, 1);
        const uint64_t json = hash_of(json_name), obj = hash_of(obj_name);
        if (json == samples[i].json_hash && obj == samples[i].obj_hash) continue;
        print_message("%s %llu: 0x%016llx, 0x%016llx\n", samples[i].kind, (unsigned long long)samples[i].size, (unsigned long long)json,
                      (unsigned long long)obj);
        wrong++;
    }
    assert_int_equal(wrong, 0);
}

static void another_seed_gives_another_scene(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        make(samples[i].kind, samples[i].size, 7);
        const uint64_t json = hash_of(json_name), obj = hash_of(obj_name);
        make(samples[i].kind, samples[i].size, 8);
        assert_true(json != hash_of(json_name));
        assert_true(obj != hash_of(obj_name));
    }
}

static void rooms_have_the_same_walls_with_and_without_zones(void **state)
{
    (void)state;
    make("rooms", 20, 4);
    const uint64_t with = hash_of(obj_name);
    report r = report_to_stderr();
    assert_int_equal(generate_scene("rooms", 20, 4, obj_name, allocator_heap(), &r), RESULT_OK);
    assert_true(with == hash_of(obj_name));
}

// ---- Zones and portals ----

static void the_importer_reads_them_without_a_warning_and_finds_the_zones(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        scene *s = imported(samples[i].kind, samples[i].size, 2);
        assert_int_equal(s->zone_count, samples[i].zones);
        assert_int_equal(s->stray_items, 0);
        assert_true(path_named(s, "walk")->camera_count >= 500);
        assert_true(path_named(s, "tour")->camera_count >= 500);
        for (uint32_t k = 0; k < s->zone_count; ++k) assert_true(s->zones[k].item_count > 0);
        scene_free(s, allocator_heap());
    }
}

static uint32_t root_of(const uint32_t *roots, uint32_t zone)
{
    while (roots[zone] != zone) zone = roots[zone];
    return zone;
}

static void every_zone_can_be_reached_from_every_other(void **state)
{
    (void)state;
    static const struct { const char *kind; uint64_t size; } mazes[] = {
        {"rooms", 50}, {"maze", 10}, {"maze", 11}, {"maze", 333}, {"maze", 1500}, {"house", GENERATE_SIZE_OF_KIND}, {"flagship", GENERATE_SIZE_OF_KIND}};
    for (size_t i = 0; i < COUNT_OF(mazes); ++i)
        for (uint64_t seed = 1; seed < 4; ++seed) {
            scene *s = imported(mazes[i].kind, mazes[i].size, seed);
            uint32_t *roots = calloc(s->zone_count, sizeof *roots), parts = s->zone_count;
            assert_non_null(roots);
            for (uint32_t k = 0; k < s->zone_count; ++k) roots[k] = k;
            for (uint32_t k = 0; k < s->portal_count; ++k) {
                const uint32_t a = root_of(roots, s->portals[k].zones[0]), b = root_of(roots, s->portals[k].zones[1]);
                parts -= a != b;
                roots[a] = b;
            }
            assert_int_equal(parts, 1);
            free(roots);
            scene_free(s, allocator_heap());
        }
}

static int lies_in(const scene *s, uint32_t zone, uint32_t other)
{
    while (zone != other && zone != SCENE_NONE) zone = s->zones[zone].parent;
    return zone == other;
}

static void every_portal_lies_on_the_borders_of_both_its_zones(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        scene *s = imported(samples[i].kind, samples[i].size, 3);
        for (uint32_t k = 0; k < s->portal_count; ++k) {
            const scene_portal *p = &s->portals[k];
            for (uint32_t n = 0; n < 2; ++n) {
                if (lies_in(s, p->zones[1 - n], p->zones[n])) continue; // of the two that which lies in the other has a border there
                for (uint32_t c = 0; c < p->point_count; ++c)
                    assert_true(fabs(height_in_zone(s, p->zones[n], s->portal_points[p->first_point + c])) < ON_BORDER_M);
            }
        }
        scene_free(s, allocator_heap());
    }
}

static void no_two_zones_overlap_but_one_in_another(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        scene *s = imported(samples[i].kind, samples[i].size, 3);
        for (uint32_t a = 0; a < s->hull_count; ++a)
            for (uint32_t b = 0; b < a; ++b) {
                if (lies_in(s, s->hulls[a].zone, s->hulls[b].zone) || lies_in(s, s->hulls[b].zone, s->hulls[a].zone)) continue;
                double common = INFINITY; // on the axis where they share least
                for (int n = 0; n < 3; ++n)
                    common = fmin(common, fmin(s->hulls[a].max[n], s->hulls[b].max[n]) - fmax(s->hulls[a].min[n], s->hulls[b].min[n]));
                assert_true(common < ON_BORDER_M);
            }
        scene_free(s, allocator_heap());
    }
}

static void chains_are_mixed_and_some_doors_are_shut(void **state)
{
    (void)state;
    static const char *const names[3] = {"frustum", "none", "brute"};
    for (size_t i = 2; i < COUNT_OF(samples); ++i) {
        if (strcmp(samples[i].kind, "flagship") == 0) continue; // has what suits each zone
        scene *s = imported(samples[i].kind, samples[i].size, 1);
        uint32_t named[3] = {0}, unnamed = 0, shut = 0;
        for (uint32_t k = 0; k < s->zone_count; ++k) {
            if (!s->zones[k].chain) unnamed++;
            for (int n = 0; n < 3; ++n) named[n] += s->zones[k].chain && strcmp(s->zones[k].chain, names[n]) == 0;
        }
        for (uint32_t k = 0; k < s->door_count; ++k) shut += s->doors[k].at_rest == DOORS_SHUT;
        assert_int_equal(named[0] + named[1] + named[2] + unnamed, s->zone_count);
        assert_true(named[0] && named[1] && named[2] && unnamed);
        assert_true(s->door_count > 0);
        if (s->zones[0].flags & ZONE_EVERYWHERE) assert_true(shut > 0);
        scene_free(s, allocator_heap());
    }
}

static void the_flagship_is_managed_by_four_strategies_and_has_a_cellar_of_eleven_zones(void **state)
{
    (void)state;
    static const char *const names[4] = {"imagecache+portal", "octree+portal+occlusion[method=hiz]", "bsp+portal", "frustum+portal"};
    scene *s = imported("flagship", GENERATE_SIZE_OF_KIND, 1);
    uint32_t named[4] = {0}, below = 0, shut = 0;
    for (uint32_t k = 0; k < s->zone_count; ++k) {
        const scene_zone *z = &s->zones[k];
        assert_non_null(z->chain);
        for (int n = 0; n < 4; ++n) named[n] += strcmp(z->chain, names[n]) == 0;
        below += z->parent != SCENE_NONE && z->parent != 0 && s->hulls[z->first_hull].min[1] < -3;
    }
    for (uint32_t k = 0; k < s->door_count; ++k) shut += s->doors[k].at_rest == DOORS_SHUT;
    assert_int_equal(named[0] + named[1] + named[2] + named[3], s->zone_count);
    assert_int_equal(named[0], 1);
    assert_int_equal(named[1], 1);
    assert_true(named[2] > 30 && named[3] > 10);
    assert_int_equal(below, 11);
    assert_true(shut > 0);
    scene_free(s, allocator_heap());
}

// ---- Closed zones: what leaves a zone meets a surface or a portal on its way ----

typedef struct ray { double from[3], along[3]; } ray;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int n = 0; n < 3; ++n) out[n] = a[(n + 1) % 3] * b[(n + 2) % 3] - a[(n + 2) % 3] * b[(n + 1) % 3];
}

// Möller and Trumbore (1997); INFINITY: passes by.
static double triangle_distance(const ray *r, double corners[3][3])
{
    double u[3], v[3], p[3], t[3], q[3];
    for (int n = 0; n < 3; ++n) {
        u[n] = corners[1][n] - corners[0][n];
        v[n] = corners[2][n] - corners[0][n];
        t[n] = r->from[n] - corners[0][n];
    }
    cross(r->along, v, p);
    cross(t, u, q);
    const double area = dot(u, p);
    if (area == 0) return INFINITY;
    const double a = dot(t, p) / area, b = dot(r->along, q) / area, distance = dot(v, q) / area;
    return a < 0 || b < 0 || a + b > 1 || distance < 0 ? INFINITY : distance;
}

static double item_distance(const scene *s, uint32_t item, const ray *r)
{
    double least = INFINITY;
    const scene_item *it = &s->items[item];
    for (uint32_t i = 0; i < it->index_count; i += 3) {
        double corners[3][3];
        for (int k = 0; k < 3; ++k) {
            const cull_vec3 p = s->positions[s->indices[it->first_index + i + (uint32_t)k]];
            corners[k][0] = p.x + s->whole.origin[0];
            corners[k][1] = p.y + s->whole.origin[1];
            corners[k][2] = p.z + s->whole.origin[2];
        }
        least = fmin(least, triangle_distance(r, corners));
    }
    return least;
}

static double portal_distance(const scene *s, const scene_portal *p, const ray *r)
{
    double least = INFINITY;
    for (uint32_t i = 1; i + 1 < p->point_count; ++i) {
        double corners[3][3];
        const uint32_t at[3] = {0, i, i + 1};
        for (int k = 0; k < 3; ++k) memcpy(corners[k], s->portal_points[p->first_point + at[k]], sizeof corners[k]);
        least = fmin(least, triangle_distance(r, corners));
    }
    return least;
}

static double border_distance(const scene_hull *h, const ray *r, double widened)
{
    double least = INFINITY;
    for (int n = 0; n < 3; ++n)
        if (r->along[n] != 0) least = fmin(least, ((r->along[n] > 0 ? h->max[n] + widened : h->min[n] - widened) - r->from[n]) / r->along[n]);
    return least;
}

static int is_stopped(const scene *s, uint32_t zone, const ray *r)
{
    const scene_zone *z = &s->zones[zone];
    const double border = border_distance(&s->hulls[z->first_hull], r, 0), portals = border_distance(&s->hulls[z->first_hull], r, ON_BORDER_M);
    for (uint32_t i = 0; i < z->portal_count; ++i)
        if (portal_distance(s, &s->portals[s->zone_portals[z->first_portal + i] / 2], r) <= portals) return 1;
    for (uint32_t i = 0; i < z->item_count; ++i)
        if (item_distance(s, s->zone_items[z->first_item + i], r) <= border) return 1;
    return 0;
}

static size_t rays_lost_from(const scene *s, uint32_t zone, const double eye[3], uint64_t *random)
{
    enum { RAYS = 40 };
    size_t lost = 0;
    for (int i = 0; i < RAYS; ++i) {
        ray r = {.from = {eye[0], eye[1], eye[2]}};
        for (int n = 0; n < 3; ++n) r.along[n] = random_between(random, -1, 1);
        lost += !is_stopped(s, zone, &r);
    }
    return lost;
}

static int is_in_a_deeper_zone(const scene *s, uint32_t zone, const double eye[3])
{
    for (uint32_t other = 0; other < s->zone_count; ++other)
        if (s->zones[other].parent == zone && height_in_zone(s, other, eye) < ON_BORDER_M) return 1;
    return 0;
}

static size_t rays_lost(const scene *s, uint32_t *zones_tried)
{
    const scene_camera_path *tour = path_named(s, "tour");
    uint8_t *tried = calloc(s->zone_count, 1);
    uint64_t random = 5;
    size_t lost = 0;
    assert_non_null(tried);
    *zones_tried = 0;
    for (uint32_t i = 0; i < tour->camera_count; ++i)
        for (uint32_t zone = 0; zone < s->zone_count; ++zone) {
            const double *eye = s->cameras[tour->first_camera + i].eye;
            if (s->zones[zone].hull_count == 0 || height_in_zone(s, zone, eye) > -ON_BORDER_M || is_in_a_deeper_zone(s, zone, eye)) continue;
            const size_t here = rays_lost_from(s, zone, eye, &random);
            if (here) print_message("%zu rays leave %s from %g %g %g\n", here, s->zones[zone].name, eye[0], eye[1], eye[2]);
            lost += here;
            *zones_tried += !tried[zone];
            tried[zone] = 1;
        }
    free(tried);
    return lost;
}

static void zones_are_closed_but_at_their_portals(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        scene *s = imported(samples[i].kind, samples[i].size, 3);
        uint32_t tried;
        assert_int_equal(rays_lost(s, &tried), 0);
        assert_true(tried * 10 >= s->zone_count * 9);
        scene_free(s, allocator_heap());
    }
}

static void a_zone_without_its_portals_is_seen_to_be_open(void **state) // the check above sees
{
    (void)state;
    scene *s = imported("maze", 10, 3);
    uint32_t tried;
    for (uint32_t i = 0; i < s->zone_count; ++i) s->zones[i].portal_count = 0;
    assert_true(rays_lost(s, &tried) > 100);
    scene_free(s, allocator_heap());
}

static int is_no_land_and_no_step(const probe_polygon *p, const char *name)
{
    (void)name;
    return strcmp(p->object, "land") != 0 && strncmp(p->object, "stairs", 6) != 0 && strncmp(p->object, "spine", 5) != 0; // steps touch
}

static void shells_meet_without_gaps_and_joints(void **state)
{
    (void)state;
    static const uint64_t sizes[2] = {12, 40};
    for (size_t i = 0; i < COUNT_OF(sizes); ++i) { // no edge is open: shells, frames and furniture are closed together
        make("rooms", sizes[i], 6);
        probe p = probe_read(obj_name);
        assert_int_equal(probe_open_edges(&p, is_no_land_and_no_step, NULL), 0);
        probe_free(&p);
    }
    make("house", GENERATE_SIZE_OF_KIND, 6);
    probe p = probe_read(obj_name);
    size_t rim = 0; // the foot of the facade, one rectangle in pieces, stands in the ground
    for (size_t i = 0; i < p.polygon_count; ++i) {
        const probe_polygon *q = &p.polygons[i];
        for (uint32_t k = 0; k < q->corner_count; ++k)
            rim += strcmp(q->object, "house_0") == 0 && p.places[q->corners[k]][1] == -0.3 &&
                   p.places[q->corners[(k + 1) % q->corner_count]][1] == -0.3;
    }
    assert_true(rim > 4);
    assert_int_equal(probe_open_edges(&p, is_no_land_and_no_step, NULL), rim);
    probe_free(&p);
}

// ---- Paths ----

static void walks_go_through_holes_and_never_through_a_surface(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        scene *s = imported(samples[i].kind, samples[i].size, GENERATE_SEED_OF_KIND);
        const scene_camera_path *walk = path_named(s, "walk");
        const camera *c = &s->cameras[walk->first_camera];
        probe p = probe_read(obj_name);
        size_t crossed = 0;
        for (uint32_t k = 1; k < walk->camera_count; ++k) {
            const size_t here = probe_crossings(&p, c[k - 1].eye, c[k].eye);
            double step = 0;
            for (int n = 0; n < 3; ++n) step += (c[k].eye[n] - c[k - 1].eye[n]) * (c[k].eye[n] - c[k - 1].eye[n]);
            if (here) print_message("%s: view %u comes through %zu surfaces\n", samples[i].kind, k, here);
            assert_true(step < 0.5 * 0.5); // smooth
            crossed += here;
        }
        assert_int_equal(crossed, 0);
        probe_free(&p);
        scene_free(s, allocator_heap());
    }
}

static void tours_visit_holes_and_the_planes_of_portals(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        if (samples[i].size == 1) continue; // one room has no holes
        scene *s = imported(samples[i].kind, samples[i].size, 1);
        const scene_camera_path *tour = path_named(s, "tour");
        uint32_t on_plane = 0;
        for (uint32_t k = 0; k < tour->camera_count; ++k)
            for (uint32_t n = 0; n < s->portal_count; ++n) {
                const scene_portal *p = &s->portals[n];
                const double *eye = s->cameras[tour->first_camera + k].eye;
                if (height_in_zone(s, p->zones[0], eye) == 0 && fabs(dot(p->plane, eye) + p->plane[3]) == 0) {
                    on_plane++;
                    break;
                }
            }
        if (on_plane < 15) print_message("%s: %u eyes on planes\n", samples[i].kind, on_plane);
        assert_true(on_plane >= 15);
        scene_free(s, allocator_heap());
    }
}

static void movers_of_the_flagship_come_back_to_where_they_start(void **state)
{
    (void)state;
    scene *s = imported("flagship", GENERATE_SIZE_OF_KIND, 1);
    uint32_t moving = 0;
    for (uint32_t i = 0; i < s->mover_count; ++i) {
        const scene_mover *m = &s->movers[i];
        if (m->key_count == 0) continue;
        const scene_key *first = &s->keys[m->first_key], *last = &s->keys[m->first_key + m->key_count - 1];
        for (int n = 0; n < 3; ++n) assert_true(fabs(first->offset[n] - last->offset[n]) < 1e-9);
        assert_int_equal(m->loops, 1);
        moving++;
    }
    assert_true(moving >= 25);
    assert_true(s->polygon_count >= 20000 && s->polygon_count <= 60000);
    scene_free(s, allocator_heap());
}

// ---- Refusals and faults ----

static void wrong_wishes_are_refused_in_a_line_and_nothing_is_written(void **state)
{
    static const struct { const char *kind; uint64_t size; const char *file, *says; } wishes[] = {
        {"maze", 9, "scene.json", "10 to 100000 rooms, not 9"},
        {"maze", 100001, "scene.json", "not 100001"},
        {"maze", 10, "scene.obj", ".json"},
        {"rooms", 0, "scene.json", "1 to 100000"},
        {"rooms", 4, "scene.map", ".json"},
        {"house", 3, "scene.json", "leave --size out"},
        {"flagship", 3, "scene.json", "150 to 2000 metres"},
        {"flagship", GENERATE_SIZE_OF_KIND, "scene.obj", ".json"},
        {"house", GENERATE_SIZE_OF_KIND, "none/scene.json", "cannot write"},
    };
    (void)state;
    files_remove();
    for (size_t i = 0; i < COUNT_OF(wishes); ++i) {
        report_lines lines;
        report_lines_init(&lines);
        char path[64];
        snprintf(path, sizeof path, "%s/%s", folder, wishes[i].file);
        assert_int_equal(generate_scene(wishes[i].kind, wishes[i].size, 1, path, allocator_heap(), &lines.report), RESULT_BAD_INPUT);
        assert_true(report_lines_is_one_with(&lines, wishes[i].says));
        assert_int_not_equal(access(json_name, F_OK), 0);
        assert_int_not_equal(access(obj_name, F_OK), 0);
    }
}

static void a_scene_that_cannot_be_written_takes_its_geometry_along(void **state)
{
    (void)state;
    char taken[80];
    files_remove();
    snprintf(taken, sizeof taken, "%s/here", json_name); // a folder that isn't empty has the scene's name
    assert_int_equal(mkdir(json_name, 0700), 0);
    assert_int_equal(mkdir(taken, 0700), 0);
    report_lines lines;
    report_lines_init(&lines);
    assert_int_equal(generate_scene("maze", 10, 1, json_name, allocator_heap(), &lines.report), RESULT_BAD_INPUT);
    assert_int_not_equal(access(obj_name, F_OK), 0);
    rmdir(taken);
    rmdir(json_name);
}

static void whichever_allocation_fails_nothing_is_written_or_lost(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(samples); ++i) {
        if (strcmp(samples[i].kind, "flagship") == 0) continue; // the same code as the house, and larger
        files_remove();
        uint64_t k = 1;
        for (result done = RESULT_NO_MEMORY; done == RESULT_NO_MEMORY; ++k) {
            failing_allocator a;
            report r = {0};
            failing_allocator_init(&a, k);
            done = generate_scene(samples[i].kind, samples[i].size, 1, json_name, &a.memory, &r);
            assert_int_equal(failing_allocator_is_clean(&a), 1);
            assert_int_equal(access(json_name, F_OK) == 0, done == RESULT_OK);
            assert_int_equal(access(obj_name, F_OK) == 0, done == RESULT_OK);
        }
        assert_true(k > 10);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_compiler_and_machine_gives_these_bytes),
        cmocka_unit_test(another_seed_gives_another_scene),
        cmocka_unit_test(rooms_have_the_same_walls_with_and_without_zones),
        cmocka_unit_test(the_importer_reads_them_without_a_warning_and_finds_the_zones),
        cmocka_unit_test(every_zone_can_be_reached_from_every_other),
        cmocka_unit_test(every_portal_lies_on_the_borders_of_both_its_zones),
        cmocka_unit_test(no_two_zones_overlap_but_one_in_another),
        cmocka_unit_test(chains_are_mixed_and_some_doors_are_shut),
        cmocka_unit_test(the_flagship_is_managed_by_four_strategies_and_has_a_cellar_of_eleven_zones),
        cmocka_unit_test(zones_are_closed_but_at_their_portals),
        cmocka_unit_test(a_zone_without_its_portals_is_seen_to_be_open),
        cmocka_unit_test(shells_meet_without_gaps_and_joints),
        cmocka_unit_test(walks_go_through_holes_and_never_through_a_surface),
        cmocka_unit_test(tours_visit_holes_and_the_planes_of_portals),
        cmocka_unit_test(movers_of_the_flagship_come_back_to_where_they_start),
        cmocka_unit_test(wrong_wishes_are_refused_in_a_line_and_nothing_is_written),
        cmocka_unit_test(a_scene_that_cannot_be_written_takes_its_geometry_along),
        cmocka_unit_test(whichever_allocation_fails_nothing_is_written_or_lost),
    };
    return cmocka_run_group_tests_name("generate_zones", tests, folder_make, folder_remove);
}
