// The real levels: every brush closes, every wall is flat, and rearranging a map rearranges nothing else.
// SPDX-License-Identifier: MIT
#include "brushes.h"
#include "host/import/map_brush.h"
#include "host/import/map_text.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double UNITS_REACH = 2097152, UNITS_ON_PLANE = 1.0 / 256; // what map_stage.c cuts with

static void real_maps_import_without_a_warning_and_flat(void **state)
{
    (void)state;
    for (int m = 0; m < 8; ++m) {
        size_t size;
        char *text = real_scene(real_maps[m], &size);
        if (!text) skip();
        heard h;
        report r = hear(&h);
        scene *s = NULL;
        assert_int_equal(import_map(real_maps[m], text, size, &doors_open, allocator_heap(), &r, &s), RESULT_OK);
        if (r.warnings) fail_msg("%s", h.text);
        assert_true(s->item_count > 2000);
        assert_int_equal(s->flat_triangles, 0);
        for (uint32_t i = 0; i < s->item_count; ++i) {
            const cull_wall *wall = &s->walls[i];
            const cull_plane *plane = &s->planes[wall->plane];
            assert_true(wall->vertex_count >= 3);
            for (uint32_t v = 0; v < wall->vertex_count; ++v) {
                const cull_vec3 p = s->positions[s->wall_vertices[wall->first_vertex + v]];
                const double off = (double)plane->normal.x * p.x + (double)plane->normal.y * p.y + (double)plane->normal.z * p.z + plane->offset;
                assert_true(fabs(off) < 1e-3);
            }
        }
        scene_free(s, allocator_heap());
        memory_free(allocator_heap(), text, size + 1, 1);
    }
}

// ---- Closed ----

typedef struct edge { double from[3], to[3]; } edge;

static int compare_edges(const void *a, const void *b)
{
    const edge *l = a, *r = b;
    for (int k = 0; k < 3; ++k)
        if (l->from[k] != r->from[k]) return l->from[k] < r->from[k] ? -1 : 1;
    for (int k = 0; k < 3; ++k)
        if (l->to[k] != r->to[k]) return l->to[k] < r->to[k] ? -1 : 1;
    return 0;
}

static size_t edges_of(const brush_body *body, edge *edges, size_t room)
{
    const brush_loop *loops = body->loops.items;
    const brush_vertex *vertices = body->vertices.items;
    size_t count = 0;
    for (size_t l = 0; l < body->loops.count; ++l) {
        const uint32_t *corners = (const uint32_t *)body->corners.items + loops[l].first;
        for (uint32_t i = 0; i < loops[l].count; ++i) {
            assert_true(count < room);
            memcpy(edges[count].from, vertices[corners[i]].position, sizeof edges->from);
            memcpy(edges[count++].to, vertices[corners[(i + 1) % loops[l].count]].position, sizeof edges->to);
        }
    }
    return count;
}

// Every directed edge once, and its reverse once.
static void expect_closed(const brush_body *body)
{
    edge edges[2048];
    const size_t count = edges_of(body, edges, sizeof edges / sizeof *edges);
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0; i < count; ++i) {
        edge reverse;
        memcpy(reverse.from, edges[i].to, sizeof reverse.from);
        memcpy(reverse.to, edges[i].from, sizeof reverse.to);
        assert_non_null(bsearch(&reverse, edges, count, sizeof *edges, compare_edges));
        if (i) assert_true(compare_edges(&edges[i - 1], &edges[i]) != 0);
    }
}

static void every_real_brush_is_closed(void **state)
{
    (void)state;
    size_t brushes = 0;
    for (int m = 0; m < 8; ++m) {
        size_t size;
        char *text = real_scene(real_maps[m], &size);
        if (!text) skip();
        heard h;
        report r = hear(&h);
        map_reader reader = {.path = real_maps[m], .at = text, .end = text + size, .line = 1, .report = &r};
        map_entity e = map_entity_make(allocator_heap());
        brush_body body = brush_body_make(allocator_heap());
        map_more more;
        while (map_reader_next(&reader, &e, &more) == RESULT_OK && more == MAP_ENTITY)
            for (size_t b = 0; b < e.brushes.count; ++b) {
                const map_brush *brush = (const map_brush *)e.brushes.items + b;
                brush_plane planes[256];
                assert_true(brush->face_count <= 256);
                for (size_t f = 0; f < brush->face_count; ++f)
                    assert_true(brush_plane_from_points(((const map_face *)e.faces.items)[brush->first_face + f].points, &planes[f]));
                assert_int_equal(brush_body_cut(&body, planes, (uint32_t)brush->face_count, UNITS_REACH, UNITS_ON_PLANE), BRUSH_SOUND);
                expect_closed(&body);
                ++brushes;
            }
        assert_int_equal(r.errors, 0);
        map_entity_free(&e);
        brush_body_free(&body);
        memory_free(allocator_heap(), text, size + 1, 1);
    }
    assert_true(brushes > 11000);
}

// ---- Rearranged ----

enum { BRUSHES = 60, FACES_MOST = 9, POINTS_MOST = 16 };

typedef struct polygon { double points[POINTS_MOST][3]; } polygon;

static uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 16;
}

// Boxes with up to three corners cut off by integer planes.
static int random_brush(uint32_t *seed, point_set faces[FACES_MOST])
{
    double min[3], max[3];
    for (int k = 0; k < 3; ++k) {
        min[k] = (double)(next_random(seed) % 512) - 256;
        max[k] = min[k] + 16 + next_random(seed) % 64;
    }
    box_faces(min, max, faces);
    int count = 6;
    for (int cut = 0; cut < 3; ++cut) {
        double p[3][3];
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) p[i][k] = cut & 1 ? max[k] : min[k];
        for (int i = 0; i < 3; ++i) p[i][i] += (cut & 1 ? -1.0 : 1.0) * (1 + next_random(seed) % 15);
        if (cut == 2) p[2][2] = max[2]; // a plane that is steep against the others
        memcpy(faces[count].points, p, sizeof p);
        if (cut & 1) { // clockwise seen from the corner that goes
            memcpy(faces[count].points[0], p[2], sizeof p[0]);
            memcpy(faces[count].points[2], p[0], sizeof p[0]);
        }
        ++count;
    }
    return count;
}

typedef enum arrangement { AS_MADE, REVERSED } arrangement;

static scene *random_scene(arrangement order, double shift)
{
    map_text *m = calloc(1, sizeof *m);
    assert_non_null(m);
    map_add(m, "{\n\"classname\" \"worldspawn\"\n");
    for (int b = 0; b < BRUSHES; ++b) {
        point_set faces[FACES_MOST];
        uint32_t seed = (uint32_t)(order == AS_MADE ? b : BRUSHES - 1 - b) * 977u + 13u;
        const int count = random_brush(&seed, faces);
        for (int f = 0; f < count; ++f)
            for (int i = 0; i < 9; ++i) faces[f].points[i / 3][i % 3] += shift * (1 + i % 3);
        if (order == REVERSED)
            for (int f = 0; f < count / 2; ++f) {
                const point_set swap = faces[f];
                faces[f] = faces[count - 1 - f];
                faces[count - 1 - f] = swap;
            }
        map_add_faces(m, faces, count, "stone");
    }
    map_add(m, "}\n");
    scene *s = map_of(m->text, &doors_open);
    free(m);
    return s;
}

static int compare_polygons(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(polygon));
}

// Each loop from its least point on, in units less the shift; sorted.
static polygon *polygons_of(const scene *s, double shift)
{
    polygon *all = calloc(s->item_count, sizeof *all);
    assert_non_null(all);
    for (uint32_t i = 0; i < s->item_count; ++i) {
        const cull_wall *wall = &s->walls[i];
        assert_true(wall->vertex_count <= POINTS_MOST);
        double points[POINTS_MOST][3];
        uint32_t least = 0;
        for (uint32_t v = 0; v < wall->vertex_count; ++v) {
            const cull_vec3 p = s->positions[s->wall_vertices[wall->first_vertex + v]];
            points[v][0] = (p.x + s->whole.origin[0]) * 32 - shift;
            points[v][1] = (p.y + s->whole.origin[1]) * 32 - shift * 3;
            points[v][2] = (p.z + s->whole.origin[2]) * 32 + shift * 2;
            for (int k = 0; k < 3; ++k) points[v][k] = nearbyint(points[v][k] * 4096) / 4096 + 0.0; // the scene's step differs
            if (memcmp(points[v], points[least], sizeof points[v]) < 0) least = v;
        }
        for (uint32_t v = 0; v < wall->vertex_count; ++v) memcpy(all[i].points[v], points[(least + v) % wall->vertex_count], sizeof points[v]);
    }
    qsort(all, s->item_count, sizeof *all, compare_polygons);
    return all;
}

static void expect_same_polygons(scene *a, scene *b, double shift)
{
    assert_int_equal(a->item_count, b->item_count);
    assert_true(a->item_count > BRUSHES * 6);
    polygon *pa = polygons_of(a, 0), *pb = polygons_of(b, shift);
    assert_memory_equal(pa, pb, a->item_count * sizeof *pa);
    free(pa);
    free(pb);
    scene_free(a, allocator_heap());
    scene_free(b, allocator_heap());
}

static void the_order_of_brushes_and_faces_changes_no_polygon(void **state)
{
    (void)state;
    expect_same_polygons(random_scene(AS_MADE, 0), random_scene(REVERSED, 0), 0);
}

static void moving_a_map_by_whole_units_moves_its_polygons(void **state)
{
    (void)state;
    expect_same_polygons(random_scene(AS_MADE, 0), random_scene(AS_MADE, 1024), 1024);
    expect_same_polygons(random_scene(AS_MADE, 0), random_scene(AS_MADE, -32 * 777), -32 * 777);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(real_maps_import_without_a_warning_and_flat),
        cmocka_unit_test(every_real_brush_is_closed),
        cmocka_unit_test(the_order_of_brushes_and_faces_changes_no_polygon),
        cmocka_unit_test(moving_a_map_by_whole_units_moves_its_polygons),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
