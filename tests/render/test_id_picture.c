// The id picture: who owns each pixel, against rays cast in double and against itself drawn otherwise.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <math.h>
#include <string.h>

enum { SIDE = 64 };

static id_picture ids_of(bed *b, const id_request *q)
{
    return bed_ids(b, q, SIDE, SIDE);
}

static void drop(id_picture *p)
{
    id_picture_free(p, allocator_heap());
}

static void a_quad_covers_exactly_the_pixels_whose_centres_lie_in_it(void **state)
{
    bed *b = *state;
    const quad q = quad_at(-10, -5, -2.5, 5, 5); // columns 16 to 47, rows 24 to 47
    bed_scene(b, &q, 1, NULL);
    const camera c = camera_at(0, 0, 0);
    id_picture p = ids_of(b, &(id_request){.camera = &c});
    for (uint32_t y = 0; y < SIDE; ++y)
        for (uint32_t x = 0; x < SIDE; ++x) assert_int_equal(id_at(&p, x, y) != 0, x >= 16 && x < 48 && y >= 24 && y < 48);
    assert_int_equal(id_at(&p, 47, 24), 1); // the first triangle has the lower right corner
    assert_int_equal(id_at(&p, 16, 47), 2);
    drop(&p);
}

static void the_nearer_quad_wins_whatever_its_id(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    for (int swap = 0; swap < 2; ++swap) {
        const quad quads[] = {quad_at(swap ? -5 : -6, -20, -20, 20, 20), quad_at(swap ? -6 : -5, -20, -20, 20, 20)};
        bed_scene(b, quads, 2, NULL);
        id_picture p = ids_of(b, &(id_request){.camera = &c});
        for (uint32_t i = 0; i < SIDE * SIDE; ++i) assert_int_equal((p.triangles[i] - 1) / 2, swap ? 0 : 1);
        drop(&p);
    }
}

static void equal_depth_goes_to_the_lower_id(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const quad quads[] = {quad_at(-5, -20, -20, 0, 20), quad_at(-5, -20, -20, 20, 20), quad_at(-5, -20, -20, 20, 20)};
    bed_scene(b, quads, 3, NULL);
    id_picture p = ids_of(b, &(id_request){.camera = &c});
    for (uint32_t y = 0; y < SIDE; ++y)
        for (uint32_t x = 0; x < SIDE; ++x) assert_int_equal((id_at(&p, x, y) - 1) / 2, x < SIDE / 2 ? 0 : 1);
    drop(&p);
    const uint32_t last_two = 6;
    p = ids_of(b, &(id_request){.camera = &c, .item_bits = &last_two});
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) assert_int_equal((p.triangles[i] - 1) / 2, 1);
    drop(&p);
}

static void a_mover_comes_last_and_keeps_its_own_triangles(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    quad quads[] = {quad_at(-5, -20, -20, 20, 20), quad_at(-5, -20, -20, 0, 20), quad_at(-4, 0, 0, 20, 20)};
    quads[0].is_mover = 1; // equal depth: loses although it was given first
    bed_scene(b, quads, 3, NULL);
    id_picture p = ids_of(b, &(id_request){.camera = &c});
    assert_int_equal(b->s->item_count, 2);
    assert_int_equal(item_of_triangle(b->s, id_at(&p, 5, 5) - 1), 0);
    assert_int_equal(item_of_triangle(b->s, id_at(&p, 60, 60) - 1), 1);
    assert_int_equal(item_of_triangle(b->s, id_at(&p, 60, 5) - 1), 2);
    const uint32_t mover = 4;
    drop(&p);
    p = ids_of(b, &(id_request){.camera = &c, .item_bits = &mover});
    assert_int_equal(item_of_triangle(b->s, id_at(&p, 5, 5) - 1), 2);
    drop(&p);
}

// ---- A mesh of random triangles that share vertices, against rays ----

enum { MESH_VERTICES = 90, MESH_TRIANGLES = 400 };

static void random_mesh(bed *b, uint32_t seed, uint32_t item_indices)
{
    static double positions[MESH_VERTICES][3];
    static uint32_t indices[3 * MESH_TRIANGLES];
    for (int i = 0; i < MESH_VERTICES; ++i)
        for (int k = 0; k < 3; ++k) positions[i][k] = 20 * random_unit(&seed) - 10;
    for (uint32_t t = 0; t < MESH_TRIANGLES; ++t)
        for (uint32_t k = 0; k < 3; ++k) {
            uint32_t v;
            do v = random_next(&seed) % MESH_VERTICES;
            while ((k > 0 && v == indices[3 * t]) || (k > 1 && v == indices[3 * t + 1]));
            indices[3 * t + k] = v;
        }
    bed_mesh(b, (const double(*)[3])positions, MESH_VERTICES, indices, 3 * MESH_TRIANGLES, item_indices);
}

typedef struct ray_hit {
    uint32_t triangle; // + 1
    double depth, next_depth; // along the view's axis; of the nearest two
    double edge_px; // how near the ray passes to an edge of a triangle that could own the pixel
} ray_hit;

// Pixel-space edge functions of the projected triangle; nearer than the near plane is not looked at.
static void cast_at(const scene *s, const camera *c, double px, double py, ray_hit *hit)
{
    *hit = (ray_hit){.depth = INFINITY, .next_depth = INFINITY, .edge_px = INFINITY};
    const double ray[3] = {(px / (SIDE / 2.0) - 1), (py / (SIDE / 2.0) - 1), -1};
    for (uint32_t t = 0; t < s->index_count / 3; ++t) {
        double p[3][3], side[3], edge = INFINITY;
        for (int i = 0; i < 3; ++i) {
            const cull_vec3 v = s->positions[s->indices[3 * t + (uint32_t)i]];
            p[i][0] = s->whole.origin[0] + v.x - c->eye[0];
            p[i][1] = s->whole.origin[1] + v.y - c->eye[1];
            p[i][2] = s->whole.origin[2] + v.z - c->eye[2];
        }
        int positive = 0;
        for (int i = 0; i < 3; ++i) { // which side of the plane through the eye and the edge
            const double *a = p[i], *d = p[(i + 1) % 3];
            const double n[3] = {a[1] * d[2] - a[2] * d[1], a[2] * d[0] - a[0] * d[2], a[0] * d[1] - a[1] * d[0]};
            side[i] = n[0] * ray[0] + n[1] * ray[1] + n[2] * ray[2];
            positive += side[i] > 0;
            edge = fmin(edge, fabs(side[i]) / hypot(n[0], n[1]) * (SIDE / 2.0));
        }
        const double u[3] = {p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2]};
        const double w[3] = {p[2][0] - p[0][0], p[2][1] - p[0][1], p[2][2] - p[0][2]};
        const double n[3] = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
        const double along = (n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2]) / (n[0] * ray[0] + n[1] * ray[1] + n[2] * ray[2]);
        if (along > 0) hit->edge_px = fmin(hit->edge_px, edge);
        if ((positive != 0 && positive != 3) || !(along >= c->near_m)) continue;
        if (along < hit->depth) {
            hit->next_depth = hit->depth;
            hit->depth = along;
            hit->triangle = t + 1;
        } else hit->next_depth = fmin(hit->next_depth, along);
    }
}

static void owners_are_those_that_rays_find(void **state)
{
    bed *b = *state;
    uint32_t sure = 0, owned = 0;
    random_mesh(b, 11, 3);
    for (int eye = 0; eye < 3; ++eye) {
        const camera c = camera_at(eye - 1, 0.3 * eye, eye == 2 ? 3 : 12); // the last stands amid the triangles
        id_picture p = ids_of(b, &(id_request){.camera = &c});
        for (uint32_t y = 0; y < SIDE; ++y)
            for (uint32_t x = 0; x < SIDE; ++x) {
                ray_hit hit;
                cast_at(b->s, &c, x + 0.5, y + 0.5, &hit);
                if (hit.edge_px < 1.0 / 128 || hit.next_depth < hit.depth * (1 + 1e-3) || fabs(hit.depth - c.near_m) < 1e-3) continue;
                assert_int_equal(id_at(&p, x, y), hit.triangle);
                sure++;
                owned += hit.triangle != 0;
            }
        drop(&p);
    }
    assert_true(sure > 3 * SIDE * SIDE / 3); // many edges cross, yet most pixels are beyond doubt
    assert_true(owned > sure / 2);
}

// At the height of the eye, lying.
static quad quad_edge_on(double near_z, double far_z)
{
    quad q = quad_at(0, 0, 0, 0, 0);
    const double corners[4][3] = {{-2, 0, near_z}, {2, 0, near_z}, {2, 0, far_z}, {-2, 0, far_z}};
    memcpy(q.corners, corners, sizeof corners);
    return q;
}

static int shows(const id_picture *p, size_t pixel, uint32_t triangles)
{
    return p->triangles[pixel] - 1 < triangles;
}

// A step whose top lies in the eye's plane: the raster rounds it to a sliver, whose depth runs away from the plane that it has.
static void a_wall_seen_edge_on_keeps_within_its_corners_depths(void **state)
{
    enum { VIEWS = 12, WIDE = 1280, TALL = 720, STEP = 6 }; // STEP: triangles
    bed *b = *state;
    const quad quads[] = {
        quad_at(-3, -2, -2, 2, 0), quad_edge_on(-3, -5), quad_at(-5, -2, 0, 2, 2), // a riser, the step, the next riser above
        quad_at(-6, -20, -20, 20, 20),                                             // nearer than where the sliver's plane gets to
    };
    uint32_t seed = 5;
    bed_scene(b, quads, sizeof quads / sizeof *quads, NULL);
    for (int i = 0; i < VIEWS; ++i) {
        camera c = camera_at(random_unit(&seed) - 0.5, 0, random_unit(&seed) - 0.5);
        for (int k = 0; k < 3; ++k) c.forward[k] += random_unit(&seed) - 0.5;
        c.up[0] += 4 * (random_unit(&seed) - 0.5);
        c.fovy_deg = 20;
        c.aspect = (double)WIDE / TALL;
        id_picture p = bed_ids(b, &(id_request){.camera = &c}, WIDE, TALL);
        for (size_t k = WIDE; k < (size_t)WIDE * (TALL - 1); ++k) // no pixel of what is behind amid the step's
            if (!shows(&p, k, STEP)) assert_false(shows(&p, k - 1, STEP) && shows(&p, k + 1, STEP) && shows(&p, k - WIDE, STEP) && shows(&p, k + WIDE, STEP));
        drop(&p);
    }
}

static void the_visible_items_drawn_alone_give_the_same_picture(void **state)
{
    bed *b = *state;
    uint32_t bits[MESH_TRIANGLES / 32 + 1];
    const camera c = camera_at(0, 0, 12);
    for (uint32_t seed = 1; seed <= 10; ++seed) {
        const faces which = seed % 2 ? FACES_ALL : FACES_FRONT;
        random_mesh(b, seed, 6);
        id_picture all = ids_of(b, &(id_request){.camera = &c, .faces = which});
        memset(bits, 0, sizeof bits);
        for (uint32_t i = 0; i < SIDE * SIDE; ++i)
            if (all.triangles[i]) bits[(all.triangles[i] - 1) / 2 >> 5] |= 1u << ((all.triangles[i] - 1) / 2 & 31);
        id_picture alone = ids_of(b, &(id_request){.camera = &c, .item_bits = bits, .faces = which});
        assert_memory_equal(all.triangles, alone.triangles, sizeof(uint32_t) * SIDE * SIDE);
        drop(&all);
        drop(&alone);
    }
}

static void an_item_left_out_shows_what_is_behind(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const quad quads[] = {quad_at(-5, -20, -20, 20, 20), quad_at(-6, -20, -20, 20, 20), quad_at(-4, -20, -20, 20, 20)};
    bed_scene(b, quads, 3, NULL);
    const uint32_t bits[] = {3, 2, 0};
    const uint32_t owner[] = {0, 1, UINT32_MAX};
    for (int i = 0; i < 3; ++i) {
        id_picture p = ids_of(b, &(id_request){.camera = &c, .item_bits = &bits[i]});
        for (uint32_t k = 0; k < SIDE * SIDE; ++k) assert_int_equal(p.triangles[k] ? (p.triangles[k] - 1) / 2 : UINT32_MAX, owner[i]);
        drop(&p);
    }
}

// ---- Materials ----

static quad water_at(double z, double x0, double y0, double x1, double y1)
{
    quad q = quad_at(z, x0, y0, x1, y1);
    q.material = "*water";
    q.material_flags = MATERIAL_TRANSLUCENT;
    return q;
}

static void a_translucent_quad_hides_nothing_and_is_reported_only_where_it_is_seen(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const quad quads[] = {water_at(-4, -20, -20, 20, 20), quad_at(-5, -20, -20, 20, 20), water_at(-6, -20, -20, 20, 20),
                          quad_reversed(water_at(-3, -1, -1, 1, 1)), water_at(-5, -20, -20, 20, 20)};
    bed_scene(b, quads, 5, NULL);
    id_picture p = ids_of(b, &(id_request){.camera = &c, .faces = FACES_FRONT});
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) assert_int_equal((p.triangles[i] - 1) / 2, 1);
    const int reported[] = {1, 1, 0, 0, 0, 0, 1, 1, 0, 0}; // behind the wall no; at the wall's own depth no; from behind yes
    for (uint32_t t = 0; t < 10; ++t) assert_int_equal(see_through_at(&p, t), reported[t]);
    drop(&p);
    const uint32_t first_two = 3;
    p = ids_of(b, &(id_request){.camera = &c, .item_bits = &first_two});
    assert_true(see_through_at(&p, 0) && !see_through_at(&p, 6)); // what is not asked for is not reported
    drop(&p);
}

static void a_translucent_part_of_a_mover_is_reported_too(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    quad quads[] = {quad_at(-5, -20, -20, 20, 20), water_at(-4, -20, -20, 20, 20)};
    quads[1].is_mover = 1;
    bed_scene(b, quads, 2, NULL);
    id_picture p = ids_of(b, &(id_request){.camera = &c});
    assert_true(see_through_at(&p, 2) && see_through_at(&p, 3));
    assert_int_equal((id_at(&p, 9, 9) - 1) / 2, 0);
    drop(&p);
}

static void holes_of_a_cut_out_show_what_is_behind(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    quad quads[] = {quad_at(-5, -5, -5, 5, 5), quad_at(-6, -20, -20, 20, 20)}; // texture once over the picture
    quads[0].material = "{fence";
    quads[0].material_flags = MATERIAL_CUT_OUT;
    bed_scene(b, quads, 2, NULL);
    id_picture p = ids_of(b, &(id_request){.camera = &c});
    for (uint32_t y = 0; y < SIDE; ++y)
        for (uint32_t x = 0; x < SIDE; ++x) { // four meshes of 16 pixels, of which the first 4 are bar
            const int hole = x % 16 >= 4 && y % 16 >= 4;
            assert_int_equal((id_at(&p, x, y) - 1) / 2, hole ? 1 : 0);
        }
    drop(&p);
}

static void front_faces_only_drops_back_faces_unless_two_sided(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    quad quads[] = {quad_reversed(quad_at(-4, -20, -20, 20, 20)), quad_at(-5, -20, -20, 20, 20), quad_reversed(quad_at(-3, -20, -20, 0, 20))};
    for (int two_sided = 0; two_sided < 2; ++two_sided) {
        quads[2].item_flags = two_sided ? CULL_ITEM_TWO_SIDED : 0;
        bed_scene(b, quads, 3, NULL);
        id_picture p = ids_of(b, &(id_request){.camera = &c, .faces = FACES_FRONT});
        assert_int_equal((id_at(&p, 40, 30) - 1) / 2, 1);
        assert_int_equal((id_at(&p, 10, 30) - 1) / 2, two_sided ? 2 : 1);
        drop(&p);
        p = ids_of(b, &(id_request){.camera = &c, .faces = FACES_ALL});
        assert_int_equal((id_at(&p, 40, 30) - 1) / 2, 0);
        assert_int_equal((id_at(&p, 10, 30) - 1) / 2, 2);
        drop(&p);
    }
}

static void a_triangle_with_two_kinds_of_corners_is_refused(void **state)
{
    bed *b = *state;
    scene_builder *builder = NULL;
    scene *s = NULL;
    uint32_t object, materials[2], first;
    b->r.line = NULL;
    assert_int_equal(scene_builder_open(&b->memory.memory, &builder), RESULT_OK);
    assert_int_equal(scene_builder_object(builder, "all", 3, &object), RESULT_OK);
    assert_int_equal(scene_builder_material(builder, "a", 1, 0, &materials[0]), RESULT_OK);
    assert_int_equal(scene_builder_material(builder, "*b", 2, MATERIAL_TRANSLUCENT, &materials[1]), RESULT_OK);
    for (int i = 0; i < 3; ++i) {
        const builder_vertex v = {.position = {i == 1, i == 2, 0}};
        assert_int_equal(scene_builder_vertices(builder, &v, 1, materials[i == 2], &first), RESULT_OK);
    }
    const uint32_t indices[3] = {0, 1, 2};
    const builder_item item = {.indices = indices, .index_count = 3, .polygon_count = 1, .material = materials[0], .object = object};
    assert_int_equal(scene_builder_item(builder, &item), RESULT_OK);
    assert_int_equal(scene_builder_finish(builder, "test", &b->r, &s), RESULT_OK);
    scene_builder_close(builder);
    assert_int_equal(renderer_upload(b->g, s, &b->r), RESULT_BAD_INPUT);
    scene_free(s, &b->memory.memory);
}

// ---- Numbers ----

static void a_scene_moved_far_away_with_its_eye_gives_the_same_picture(void **state)
{
    bed *b = *state;
    static const double far[3] = {85000, 0, 446000};
    enum { WIDE = 256, QUADS = 300 };
    static quad quads[QUADS];
    uint32_t seed = 5, differ = 0;
    for (int i = 0; i < QUADS; ++i) {
        const double x = 40 * random_unit(&seed) - 20, y = 40 * random_unit(&seed) - 20, z = -30 * random_unit(&seed) - 1;
        quads[i] = quad_at(z, x, y, x + 4 * random_unit(&seed) + 0.1, y + 4 * random_unit(&seed) + 0.1);
        quads[i].corners[2][2] -= random_unit(&seed); // not all parallel to the picture
        quads[i].corners[3][2] = quads[i].corners[2][2];
    }
    const camera here = camera_at(0.123, 0.456, 0.789);
    const camera there = camera_at(0.123 + far[0], 0.456 + far[1], 0.789 + far[2]);
    bed_scene(b, quads, QUADS, NULL);
    id_picture p = bed_ids(b, &(id_request){.camera = &here}, WIDE, WIDE);
    bed_scene(b, quads, QUADS, far);
    id_picture q = bed_ids(b, &(id_request){.camera = &there}, WIDE, WIDE);
    for (uint32_t i = 0; i < WIDE * WIDE; ++i) differ += p.triangles[i] != q.triangles[i];
    assert_in_range(differ, 0, WIDE * WIDE / 10000);
    drop(&p);
    drop(&q);
}

static void a_centimetre_at_a_kilometre_is_told_apart(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const quad quads[] = {quad_at(-1000.01, -2000, -2000, 2000, 2000), quad_at(-1000, -2000, -2000, 2000, 2000)};
    bed_scene(b, quads, 2, NULL);
    id_picture p = ids_of(b, &(id_request){.camera = &c});
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) assert_int_equal((p.triangles[i] - 1) / 2, 1);
    drop(&p);
}

static void what_lies_beyond_the_far_plane_or_before_the_near_plane_is_not_drawn(void **state)
{
    bed *b = *state;
    camera c = camera_at(0, 0, 0);
    const quad quads[] = {quad_at(-0.5, -9, -9, 9, 9), quad_at(-5, -9, -9, 9, 9), quad_at(-50, -99, -99, 99, 99)};
    bed_scene(b, quads, 3, NULL);
    c.near_m = 1;
    c.far_m = 10;
    id_picture p = ids_of(b, &(id_request){.camera = &c});
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) assert_int_equal((p.triangles[i] - 1) / 2, 1);
    drop(&p);
    const uint32_t others = 5;
    p = ids_of(b, &(id_request){.camera = &c, .item_bits = &others});
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) assert_int_equal(p.triangles[i], 0);
    drop(&p);
}

static void jitter_moves_the_picture_by_parts_of_a_pixel(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 0);
    const quad q = quad_at(-32, -8, -8, 8, 8); // a metre a pixel there: columns and rows 24 to 39
    bed_scene(b, &q, 1, NULL);
    static const double jitters[][2] = {{0.4, 0}, {0.6, 0}, {-0.4, -0.6}, {0, 3}};
    static const int moved[][2] = {{0, 0}, {1, 0}, {0, -1}, {0, 3}};
    for (int k = 0; k < 4; ++k) {
        id_picture p = ids_of(b, &(id_request){.camera = &c, .jitter_px = {jitters[k][0], jitters[k][1]}});
        for (int y = 0; y < SIDE; ++y)
            for (int x = 0; x < SIDE; ++x) {
                const int in = x - moved[k][0] >= 24 && x - moved[k][0] < 40 && y - moved[k][1] >= 24 && y - moved[k][1] < 40;
                assert_int_equal(id_at(&p, (uint32_t)x, (uint32_t)y) != 0, in);
            }
        drop(&p);
    }
}

static void every_size_gives_its_own_picture_again(void **state)
{
    bed *b = *state;
    const camera c = camera_at(0, 0, 12);
    random_mesh(b, 3, 3);
    id_picture first = ids_of(b, &(id_request){.camera = &c});
    for (uint32_t side = 1; side < 400; side += 57) { // more sizes than are kept
        id_picture p = bed_ids(b, &(id_request){.camera = &c}, side, side + 1);
        drop(&p);
    }
    id_picture again = ids_of(b, &(id_request){.camera = &c});
    assert_memory_equal(first.triangles, again.triangles, sizeof(uint32_t) * SIDE * SIDE);
    drop(&first);
    drop(&again);
}

static void a_useless_camera_or_size_is_refused_with_a_line(void **state)
{
    bed *b = *state;
    camera c = camera_at(0, 0, 0);
    const quad q = quad_at(-5, -1, -1, 1, 1);
    bed_scene(b, &q, 1, NULL);
    id_picture p = ids_of(b, &(id_request){.camera = &c}), huge;
    b->r.line = NULL;
    c.fovy_deg = 0;
    assert_int_equal(renderer_id_picture(b->g, &(id_request){.camera = &c}, &b->r, &p), RESULT_BAD_INPUT);
    assert_int_equal(b->r.errors, 1);
    assert_int_equal(id_picture_open(b->s, 0, 5, allocator_heap(), &huge), RESULT_BAD_INPUT);
    assert_int_equal(id_picture_open(b->s, 1u << 31, 1u << 31, allocator_heap(), &huge), RESULT_BAD_INPUT);
    drop(&p);
    c = camera_at(0, 0, 0);
    assert_int_equal(id_picture_open(b->s, 32768, 1, allocator_heap(), &huge), RESULT_OK); // no driver here draws that wide
    assert_int_equal(renderer_id_picture(b->g, &(id_request){.camera = &c}, &b->r, &huge), RESULT_NO_GL);
    assert_int_equal(b->r.errors, 2);
    drop(&huge);
}

int main(void)
{
#define T(f) cmocka_unit_test_setup_teardown(f, bed_setup, bed_teardown)
    const struct CMUnitTest id_picture[] = {
        T(a_quad_covers_exactly_the_pixels_whose_centres_lie_in_it),
        T(the_nearer_quad_wins_whatever_its_id),
        T(equal_depth_goes_to_the_lower_id),
        T(a_mover_comes_last_and_keeps_its_own_triangles),
        T(owners_are_those_that_rays_find),
        T(a_wall_seen_edge_on_keeps_within_its_corners_depths),
        T(the_visible_items_drawn_alone_give_the_same_picture),
        T(an_item_left_out_shows_what_is_behind),
        T(a_translucent_quad_hides_nothing_and_is_reported_only_where_it_is_seen),
        T(a_translucent_part_of_a_mover_is_reported_too),
        T(holes_of_a_cut_out_show_what_is_behind),
        T(front_faces_only_drops_back_faces_unless_two_sided),
        T(a_triangle_with_two_kinds_of_corners_is_refused),
        T(a_scene_moved_far_away_with_its_eye_gives_the_same_picture),
        T(a_centimetre_at_a_kilometre_is_told_apart),
        T(what_lies_beyond_the_far_plane_or_before_the_near_plane_is_not_drawn),
        T(jitter_moves_the_picture_by_parts_of_a_pixel),
        T(every_size_gives_its_own_picture_again),
        T(a_useless_camera_or_size_is_refused_with_a_line),
    };
    return RUN_WITH_GL(id_picture);
}
