// Boxes, cylinders and cones that add and subtract, upright and turned, on a lattice and off it: the compiled surface encloses
// exactly the volume that an oracle of rational numbers finds. PORTCULLIS_LONG=1: 300 bodies a scene instead of 40.
// SPDX-License-Identifier: MIT
#include "tests/common/test.h"

#include "csg_fixture.h"
#include "host/import/import.h"
#include "volume_oracle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BODY_BYTES = 320, SHORT = 40, LONG = 300 };

// ---- Scenes as text ----

typedef struct text_writer { char *text; size_t size, room; } text_writer;

static void put(text_writer *w, const char *text)
{
    const size_t length = strlen(text);
    assert_true(w->size + length < w->room);
    memcpy(w->text + w->size, text, length + 1);
    w->size += length;
}

static uint64_t next_random(uint64_t *seed) // splitmix64
{
    uint64_t z = *seed += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static double between(uint64_t *seed, double low, double high)
{
    return low + (high - low) * (double)(next_random(seed) >> 11) / 9007199254740992.0;
}

static double lattice(uint64_t *seed, double low, double high) // quarters of a metre: faces that meet and coincide
{
    return floor(between(seed, low, high) * 4) / 4;
}

static void put_shape(text_writer *w, uint64_t *seed, double reach)
{
    char shape[BODY_BYTES];
    double at[3], angle[3];
    const unsigned segments = 3 + (unsigned)(next_random(seed) % 14), kind = (unsigned)(next_random(seed) % 3);
    for (int k = 0; k < 3; ++k) at[k] = lattice(seed, -reach, reach);
    const double size = lattice(seed, 1, 4), height = lattice(seed, 1, 6), depth = lattice(seed, 0.25, 4);
    for (int k = 0; k < 3; ++k) angle[k] = between(seed, 0, 360);
    if (kind == 0)
        snprintf(shape, sizeof shape, "\"box\": {\"min\": [%g, %g, %g], \"max\": [%g, %g, %g]}", -size, -height / 2, -size, size, height / 2, depth);
    else
        snprintf(shape, sizeof shape, "\"%s\": {\"base\": [0, %g, 0], \"%s\": [0, %g, 0], \"radius\": %g, \"segments\": %u}", kind == 1 ? "cylinder" : "cone",
                 -height / 2, kind == 1 ? "top" : "apex", height / 2, size, segments);
    put(w, shape);
    snprintf(shape, sizeof shape, ", \"at\": [%g, %g, %g]", at[0], at[1], at[2]);
    put(w, shape);
    const unsigned turn = (unsigned)(next_random(seed) % 3);
    if (turn == 1) snprintf(shape, sizeof shape, ", \"turn\": [%g, %g, 0]", 90 * floor(angle[0] / 90), 90 * floor(angle[1] / 90));
    if (turn == 2) snprintf(shape, sizeof shape, ", \"turn\": [%.17g, %.17g, %.17g]", angle[0], angle[1], angle[2]);
    if (turn) put(w, shape);
}

static compile_input *random_scene(uint64_t seed, uint32_t bodies, double reach)
{
    text_writer w = {malloc(bodies * BODY_BYTES + 64), 0, bodies * BODY_BYTES + 64};
    assert_non_null(w.text);
    put(&w, "{\"portcullis\": 1, \"brushes\": [\n");
    for (uint32_t i = 0; i < bodies; ++i) {
        put(&w, next_random(&seed) % 3 == 0 && i ? "{\"operation\": \"subtract\", " : "{");
        put_shape(&w, &seed, reach);
        put(&w, i + 1 < bodies ? "},\n" : "}\n");
    }
    put(&w, "]}\n");
    report r = report_to_stderr();
    compile_input *in = NULL;
    assert_int_equal(compile_input_json("t.json", w.text, w.size, NULL, NULL, allocator_heap(), &r, &in), RESULT_OK);
    assert_int_equal(in->brush_count, bodies);
    free(w.text);
    return in;
}

// ---- Bodies for the oracle ----

static void set_wide(mpz_t to, cull_wide v)
{
    const int negative = cull_wide_sign(v) < 0;
    if (negative) v = cull_wide_negate(v);
    mpz_set_ui(to, v.high);
    mpz_mul_2exp(to, to, 64);
    mpz_add_ui(to, to, v.low);
    if (negative) mpz_neg(to, to);
}

static void take_plane(const cull_wide_plane *from, oracle_plane *to)
{
    for (int k = 0; k < 3; ++k) {
        mpz_init_set_si(to->normal[k], from->normal[k]);
        to->rough[k] = mpz_get_d(to->normal[k]);
    }
    mpz_init(to->offset);
    set_wide(to->offset, from->offset);
    to->rough[3] = mpz_get_d(to->offset);
}

typedef struct oracle_scene { oracle_body *bodies; oracle_plane *planes; uint32_t body_count, plane_count; } oracle_scene;

static oracle_scene bodies_of(const compile_input *in)
{
    oracle_scene s = {calloc(in->brush_count + 1, sizeof *s.bodies), calloc(in->face_count + 1, sizeof *s.planes), in->brush_count, in->face_count};
    assert_true(s.bodies && s.planes);
    for (uint32_t f = 0; f < in->face_count; ++f) {
        const cull_wide_plane plane = plane_table_get(in->planes, in->faces[f].plane);
        take_plane(&plane, &s.planes[f]);
    }
    for (uint32_t b = 0; b < in->brush_count; ++b) {
        const compile_brush *from = &in->brushes[b];
        s.bodies[b] = (oracle_body){.planes = s.planes + from->first_face, .plane_count = from->face_count, .kind = from->kind == BRUSH_ADD ? ORACLE_ADD : ORACLE_SUBTRACT};
        for (int k = 0; k < 3; ++k) {
            s.bodies[b].min[k] = from->min[k] - 1.0;
            s.bodies[b].max[k] = from->max[k] + 1.0;
        }
    }
    return s;
}

static void drop_bodies(oracle_scene *s)
{
    for (uint32_t i = 0; i < s->plane_count; ++i) mpz_clears(s->planes[i].normal[0], s->planes[i].normal[1], s->planes[i].normal[2], s->planes[i].offset, NULL);
    free(s->planes);
    free(s->bodies);
}

// ---- The same volume ----

static void assert_volume_is_the_oracles(uint64_t seed, uint32_t bodies, double reach)
{
    compile_input *in = random_scene(seed, bodies, reach);
    csg_counts counts;
    compile_mesh *mesh = surface_of(in, &counts);
    mpq_t volume, area[3], expected;
    mpq_inits(volume, area[0], area[1], area[2], expected, NULL);
    mesh_measures(in, mesh, volume, area);
    for (int k = 0; k < 3; ++k) assert_int_equal(mpq_sgn(area[k]), 0); // closed
    oracle_scene s = bodies_of(in);
    const uint64_t cells = oracle_volume(s.bodies, s.body_count, expected);
    print_message("%u bodies, seed %llu: %u polygons, %llu cells, %.17g cubic steps\n", bodies, (unsigned long long)seed, mesh->polygon_count,
                  (unsigned long long)cells, mpq_get_d(expected) / 6);
    assert_true(mpq_sgn(expected) > 0 && mpq_equal(volume, expected));
    drop_bodies(&s);
    mpq_clears(volume, area[0], area[1], area[2], expected, NULL);
    compile_mesh_free(mesh);
    compile_input_free(in);
}

static void random_bodies_enclose_the_oracles_volume(void **state)
{
    (void)state;
    const char *is_long = getenv("PORTCULLIS_LONG");
    const uint32_t bodies = is_long && *is_long ? LONG : SHORT;
    const double reach = 4 * cbrt(bodies / 20.0); // every body meets a good dozen others
    for (uint64_t seed = 1; seed <= 3; ++seed) assert_volume_is_the_oracles(seed, bodies, reach);
}

static void a_dense_heap_encloses_the_oracles_volume(void **state)
{
    (void)state;
    for (uint64_t seed = 11; seed <= 13; ++seed) assert_volume_is_the_oracles(seed, 16, 2);
}

// ---- In the order of the file ----

static double volume_and_free(compile_input *in) // steps; whole ones below 2^53
{
    csg_counts counts;
    compile_mesh *mesh = surface_of(in, &counts);
    mpq_t volume, area[3];
    mpq_inits(volume, area[0], area[1], area[2], NULL);
    mesh_measures(in, mesh, volume, area);
    const double steps = mpq_get_d(volume) / 6;
    mpq_clears(volume, area[0], area[1], area[2], NULL);
    compile_mesh_free(mesh);
    compile_input_free(in);
    return steps;
}

static double volume_of_json(const char *brushes) // cubic metres
{
    char text[1024];
    report r = report_to_stderr();
    compile_input *in = NULL;
    const int size = snprintf(text, sizeof text, "{\"portcullis\": 1, \"brushes\": [%s]}", brushes);
    assert_int_equal(compile_input_json("t.json", text, (size_t)size, NULL, NULL, allocator_heap(), &r, &in), RESULT_OK);
    return volume_and_free(in) / (8192.0 * 8192 * 8192);
}

static double volume_of_map(const char *text) // cubic units
{
    report r = report_to_stderr();
    compile_input *in = NULL;
    assert_int_equal(compile_input_map("t.map", text, strlen(text), NULL, allocator_heap(), &r, &in), RESULT_OK);
    return volume_and_free(in) / (256.0 * 256 * 256);
}

static void brushes_of_a_json_scene_add_and_subtract_in_order(void **state)
{
    (void)state;
#define BIG "{\"box\": {\"min\": [0,0,0], \"max\": [4,4,4]}}"
#define HOLE "{\"operation\": \"subtract\", \"box\": {\"min\": [1,1,1], \"max\": [3,3,3]}}"
#define CORE "{\"operation\": \"add\", \"box\": {\"min\": [1,1,1], \"max\": [2,2,2]}}"
    assert_true(volume_of_json(BIG "," HOLE "," CORE) == 64 - 8 + 1);
    assert_true(volume_of_json(BIG "," CORE "," HOLE) == 64 - 8);
    assert_true(volume_of_json(HOLE "," BIG "," CORE) == 64);
    assert_true(volume_of_json(CORE "," HOLE) == 0);
}

static void entities_of_a_map_add_and_subtract_in_order(void **state)
{
    (void)state;
#define FACE(a, b, c) "( " a " ) ( " b " ) ( " c " ) wall 0 0 0 1 1\n"
#define CUBE(l, h)                                                                                                                         \
    "{\n" FACE(l " 0 0", l " 1 0", l " 0 1") FACE(h " 0 0", h " 0 1", h " 1 0") FACE("0 " l " 0", "0 " l " 1", "1 " l " 0")                  \
        FACE("0 " h " 0", "1 " h " 0", "0 " h " 1") FACE("0 0 " l, "1 0 " l, "0 1 " l) FACE("0 0 " h, "0 1 " h, "1 0 " h) "}\n"
#define ENTITY(name, cube) "{\n\"classname\" \"" name "\"\n" cube "}\n"
    static const char world[] = ENTITY("worldspawn", CUBE("0", "64"));
    char text[4096];
    snprintf(text, sizeof text, "%s" ENTITY("csg_subtract", CUBE("16", "48")) ENTITY("csg_add", CUBE("16", "32")), world);
    assert_true(volume_of_map(text) == 262144 - 32768 + 4096);
    snprintf(text, sizeof text, "%s" ENTITY("csg_add", CUBE("16", "32")) ENTITY("csg_subtract", CUBE("16", "48")), world);
    assert_true(volume_of_map(text) == 262144 - 32768);
    snprintf(text, sizeof text, ENTITY("csg_subtract", CUBE("16", "48")) "%s", world);
    assert_true(volume_of_map(text) == 262144);
}

// ---- The oracle itself ----

static void the_oracle_knows_volumes_that_are_known(void **state)
{
    (void)state;
    scene_draft d = draft_make();
    draft_box(&d, BRUSH_ADD, (const int32_t[3]){0, 0, 0}, (const int32_t[3]){10, 10, 10}, 0);
    draft_box(&d, BRUSH_SUBTRACT, (const int32_t[3]){2, 2, 2}, (const int32_t[3]){8, 8, 8}, 0);
    draft_box(&d, BRUSH_ADD, (const int32_t[3]){4, 4, 4}, (const int32_t[3]){20, 6, 6}, 0);
    const compile_input in = draft_input(&d);
    oracle_scene s = bodies_of(&in);
    mpq_t six;
    mpq_init(six);
    oracle_volume(s.bodies, s.body_count, six);
    assert_int_equal(mpq_cmp_ui(six, 6 * (1000 - 216 + (8 - 4) * 4 + (20 - 10) * 4), 1), 0);
    mpq_clear(six);
    drop_bodies(&s);
    draft_free(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_oracle_knows_volumes_that_are_known),
        cmocka_unit_test(brushes_of_a_json_scene_add_and_subtract_in_order),
        cmocka_unit_test(entities_of_a_map_add_and_subtract_in_order),
        cmocka_unit_test(a_dense_heap_encloses_the_oracles_volume),
        cmocka_unit_test(random_bodies_enclose_the_oracles_volume),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
