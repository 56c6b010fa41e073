// The weld of the compiler's input: nearly equal planes and torn corners become one, everything meant stays; real maps.
// SPDX-License-Identifier: MIT
#include "input_fixture.h"

#include "tests/common/failing_allocator.h"
#include "weld_rooms.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Two boxes side by side whose tops are planes a rounding apart: the second's rises by `off` units over 64.
static void write_slope_box(map_writer *w, int x, const char *left_height, const char *right_height)
{
    write_text(w,
               "{\n( %d 0 0 ) ( %d 1 0 ) ( %d 0 1 ) a 0 0 0 1 1\n( %d 0 0 ) ( %d 0 1 ) ( %d 1 0 ) a 0 0 0 1 1\n"
               "( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) a 0 0 0 1 1\n( 0 64 0 ) ( 1 64 0 ) ( 0 64 1 ) a 0 0 0 1 1\n"
               "( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) a 0 0 0 1 1\n( %d 0 %s ) ( %d 64 %s ) ( %d 0 %s ) top 0 0 0 1 1\n}\n",
               x, x, x, x + 64, x + 64, x + 64, x, left_height, x, left_height, x + 64, right_height);
}

static plane_ref top_of(const compile_input *in, uint32_t brush)
{
    for (uint32_t f = 0; f < in->brushes[brush].face_count; ++f) {
        const compile_face *face = &in->faces[in->brushes[brush].first_face + f];
        if (face->material != COMPILE_NOTHING && strcmp(in->materials[face->material].name, "top") == 0) return face->plane;
    }
    return PLANE_NONE;
}

static compile_input *boxes_in_order(const char *const heights[][2], const int *order, int count)
{
    map_writer w = {.size = 0};
    open_entity(&w, "worldspawn");
    for (int i = 0; i < count; ++i) write_slope_box(&w, 64 * order[i], heights[order[i]][0], heights[order[i]][1]);
    close_entity(&w);
    return input_of(w.text, NULL);
}

static void two_nearly_equal_planes_become_the_simpler_one_and_it_is_listed(void **state)
{
    (void)state;
    static const char *const heights[2][2] = {{"16", "16"}, {"16", "16.01"}};
    static const int orders[2][2] = {{0, 1}, {1, 0}};
    for (int o = 0; o < 2; ++o) {
        compile_input *in = boxes_in_order(heights, orders[o], 2);
        assert_int_equal(top_of(in, 0), top_of(in, 1));
        assert_int_equal(in->weld_moves, 1);
        const weld_change *change = in->changes;
        assert_int_equal(change->kind, WELD_PLANE);
        assert_int_equal(change->brush, o == 0 ? 1 : 0);
        assert_int_equal(change->to, top_of(in, 0));
        assert_true(change->move > 0.01 && change->move < 0.0125 && in->max_move == change->move); // 0.01 is 3 steps of 1/256 then
        const cull_wide_plane flat = plane_table_get(in->planes, change->to);
        assert_true(flat.normal[0] == 0 && flat.normal[1] == 1 && flat.normal[2] == 0);
        assert_brushes_are_sound(in);
        compile_input_free(in);
    }
}

static void planes_farther_apart_than_the_weld_stay(void **state)
{
    (void)state;
    static const char *const heights[2][2] = {{"16", "16"}, {"16", "16.1"}};
    static const int order[2] = {0, 1};
    compile_input *in = boxes_in_order(heights, order, 2);
    assert_int_equal(in->weld_moves, 0);
    assert_int_not_equal(top_of(in, 0), top_of(in, 1));
    compile_input_free(in);
}

// Levels 0, 0.025, 0.05: each near the next, the ends are not. No chain may join all three.
static void a_chain_of_near_planes_does_not_drift(void **state)
{
    (void)state;
    static const char *const heights[3][2] = {{"16", "16"}, {"16.0234375", "16.0234375"}, {"16.046875", "16.046875"}};
    static const int orders[3][3] = {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}};
    for (int o = 0; o < 3; ++o) {
        compile_input *in = boxes_in_order(heights, orders[o], 3);
        plane_ref tops[3];
        for (int i = 0; i < 3; ++i) tops[orders[o][i]] = top_of(in, (uint32_t)i);
        assert_int_not_equal(tops[0], tops[2]);
        assert_int_equal(in->weld_moves, 1);
        assert_true(in->max_move <= 1.0 / 32);
        const cull_wide_plane p = plane_table_get(in->planes, tops[1]); // the order in the file changes nothing
        assert_true(cull_wide_to_int64(p.offset) == -16 * 256 || cull_wide_to_int64(p.offset) == -4108);
        assert_true(tops[1] == tops[0] || tops[1] == tops[2]);
        compile_input_free(in);
    }
}

static void a_thin_plate_is_not_welded_away(void **state)
{
    (void)state;
    static const double low[3] = {0, 0, 0}, high[3] = {64, 64, 0.015625}, table_low[3] = {0, 0, -16}, table_high[3] = {64, 64, 0};
    map_writer w = {.size = 0};
    open_entity(&w, "worldspawn");
    write_box(&w, table_low, table_high, "table");
    write_box(&w, low, high, "plate");
    close_entity(&w);
    compile_input *in = input_of(w.text, NULL);
    assert_int_equal(in->brush_count, 2);
    assert_int_equal(in->face_count, 12);
    assert_brushes_are_sound(in);
    compile_input_free(in);
}

#define TORN_PYRAMID                                                                                                   \
    "( 0 0 0 ) ( 64 0 0 ) ( 0 64 0 ) base 0 0 0 1 1\n( 0 0 0 ) ( 32 32 48.01 ) ( 64 0 0 ) a 0 0 0 1 1\n"                \
    "( 64 0 0 ) ( 32 32 48 ) ( 64 64 0 ) a 0 0 0 1 1\n( 64 64 0 ) ( 32.004 32 47.996 ) ( 0 64 0 ) a 0 0 0 1 1\n"       \
    "( 0 64 0 ) ( 32 32 48 ) ( 0 0 0 ) a 0 0 0 1 1\n"

// A pyramid whose four sides were rounded so that they miss their common apex.
static void a_torn_apex_becomes_one_point_again(void **state)
{
    (void)state;
    compile_input *in = input_of("{\n\"classname\" \"worldspawn\"\n{\n" TORN_PYRAMID "}\n}\n", NULL);
    assert_int_equal(in->face_count, 5);
    assert_true(in->weld_moves >= 1 && in->weld_moves <= 4);
    for (uint32_t i = 0; i < in->weld_moves; ++i) assert_int_equal(in->changes[i].kind, WELD_POINT);
    assert_true(in->max_move <= 1.0 / 32);
    const plane_ref sides[4] = {in->faces[1].plane, in->faces[2].plane, in->faces[3].plane, in->faces[4].plane};
    assert_int_equal(plane_table_side(in->planes, sides, sides[3]), 0); // all four meet in one point
    assert_brushes_are_sound(in);
    compile_input_free(in);
}

// Three walls as LibreQuake has them: the slope between the first two is 2 x + y = 112, but none of its points is on the grid,
// and so it misses the corner (592, -1072) of the third by less than a step, which leaves a way out of the map.
#define THREE_WALLS                                                                 \
    "{\n"                                                                           \
    "( 665.6 -1219.2 80 ) ( 601.6 -1091.2 80 ) ( 601.6 -1091.2 112 ) a 0 0 0 1 1\n" \
    "( 704 -960 80 ) ( 704 -960 112 ) ( 544 -1120 112 ) a 0 0 0 1 1\n"              \
    "( 608 -1248 80 ) ( 832 -1024 80 ) ( 704 -960 80 ) a 0 0 0 1 1\n"               \
    "( 704 -960 112 ) ( 832 -1024 112 ) ( 608 -1248 112 ) a 0 0 0 1 1\n"            \
    "( 832 -1024 80 ) ( 832 -1024 112 ) ( 704 -960 112 ) a 0 0 0 1 1\n"             \
    "( 608 -1248 112 ) ( 832 -1024 112 ) ( 832 -1024 80 ) a 0 0 0 1 1\n"            \
    "}\n{\n"                                                                        \
    "( 480 -1024 112 ) ( 480 -1248 112 ) ( 480 -1248 80 ) a 0 0 0 1 1\n"            \
    "( 448 -1200 112 ) ( 608 -1200 112 ) ( 608 -1200 80 ) a 0 0 0 1 1\n"            \
    "( 448 -1248 80 ) ( 608 -1248 80 ) ( 496 -1024 80 ) a 0 0 0 1 1\n"              \
    "( 496 -1024 112 ) ( 608 -1248 112 ) ( 448 -1248 112 ) a 0 0 0 1 1\n"           \
    "( 496 -1072 80 ) ( 496 -1072 112 ) ( 448 -1072 112 ) a 0 0 0 1 1\n"            \
    "( 553.6 -995.2 112 ) ( 553.6 -995.2 80 ) ( 665.6 -1219.2 80 ) a 0 0 0 1 1\n"   \
    "}\n{\n"                                                                        \
    "( 448 -864 224 ) ( 448 -1120 224 ) ( 448 -1120 112 ) a 0 0 0 1 1\n"            \
    "( 448 -1072 224 ) ( 544 -1072 224 ) ( 544 -1072 112 ) a 0 0 0 1 1\n"           \
    "( 704 -960 112 ) ( 704 -864 112 ) ( 448 -864 112 ) a 0 0 0 1 1\n"              \
    "( 704 -960 144 ) ( 448 -864 144 ) ( 704 -864 144 ) a 0 0 0 1 1\n"              \
    "( 704 -864 112 ) ( 704 -864 224 ) ( 448 -864 224 ) a 0 0 0 1 1\n"              \
    "( 544 -1120 224 ) ( 704 -960 224 ) ( 704 -960 112 ) a 0 0 0 1 1\n"             \
    "( 704 -960 224 ) ( 704 -864 224 ) ( 704 -864 112 ) a 0 0 0 1 1\n"              \
    "}\n"

static void a_slope_that_misses_a_corner_by_a_rounding_goes_through_it(void **state)
{
    (void)state;
    compile_input *in = input_of("{\n\"classname\" \"worldspawn\"\n" THREE_WALLS "}\n", NULL);
    assert_int_equal(in->brush_count, 3);
    assert_int_equal(in->weld_moves, 2);
    for (uint32_t i = 0; i < 2; ++i) {
        assert_int_equal(in->changes[i].kind, WELD_CORNER);
        assert_int_equal(in->changes[i].brush, i);
        const cull_wide_plane p = plane_table_get(in->planes, in->changes[i].to); // 2 x + y = 112 of the map
        assert_true(cull_magnitude(p.normal[0]) == 2 && p.normal[1] == 0 && cull_magnitude(p.normal[2]) == 1);
        assert_int_equal(cull_wide_to_int64(cull_wide_magnitude(p.offset)), 112 * 256);
    }
    assert_true(in->max_move > 0 && in->max_move < 1.0 / 256);
    assert_brushes_are_sound(in);
    compile_input_free(in);
}

static void every_allocation_of_the_weld_may_fail(void **state)
{
    (void)state;
    static const char *const heights[2][2] = {{"16", "16"}, {"16", "16.01"}};
    map_writer w = {.size = 0};
    open_entity(&w, "worldspawn");
    for (int i = 0; i < 2; ++i) write_slope_box(&w, 64 * i, heights[i][0], heights[i][1]);
    write_text(&w, "{\n" TORN_PYRAMID "}\n" THREE_WALLS);
    close_entity(&w);
    uint64_t fail_at = 1;
    for (int finished = 0; !finished; ++fail_at) {
        failing_allocator a;
        report_lines lines;
        failing_allocator_init(&a, fail_at);
        report_lines_init(&lines);
        compile_input *in = NULL;
        const result done = compile_input_map("t.map", w.text, w.size, NULL, &a.memory, &lines.report, &in);
        finished = a.failures == 0;
        assert_int_equal(done, finished ? RESULT_OK : RESULT_NO_MEMORY);
        assert_int_equal(lines.report.errors, !finished);
        if (finished) assert_true(in->weld_moves > 1);
        compile_input_free(in);
        assert_true(failing_allocator_is_clean(&a));
    }
    assert_true(fail_at > 30);
}

// ---- Real maps ----

static uint32_t brushes_in_text(const char *text) // lines that are a lone '{', less entities
{
    uint32_t depth = 0, brushes = 0;
    for (const char *at = text; *at; at = strchr(at, '\n') ? strchr(at, '\n') + 1 : at + strlen(at)) {
        if (*at == '{' && ++depth == 2) brushes++;
        if (*at == '}') depth--;
    }
    return brushes;
}

static compile_input *real_input(const char *name, const input_options *o, uint32_t *brushes)
{
    size_t size;
    char *text = real_map(name, &size);
    if (!text) return NULL;
    report_lines lines;
    report_lines_init(&lines);
    compile_input *in = NULL;
    assert_int_equal(compile_input_map(name, text, size, o, allocator_heap(), &lines.report, &in), RESULT_OK);
    *brushes = brushes_in_text(text);
    free(text);
    return in;
}

static void real_maps_come_in_whole(void **state)
{
    (void)state;
    static const uint32_t faces[REAL_MAPS] = {4196, 7278, 7681, 11638, 2504, 7926, 8326, 20903};
    uint32_t brushes, read = 0;
    for (int m = 0; m < REAL_MAPS; ++m) {
        compile_input *in = real_input(real_map_names[m], NULL, &brushes);
        if (!in) continue;
        read++;
        assert_int_equal(in->brush_count + in->brushes_dropped, brushes);
        assert_int_equal(in->face_count, faces[m]);
        assert_brushes_are_sound(in);
        assert_true(in->max_move <= 1.0 / 32);
        for (uint32_t c = 0; c < in->weld_moves; ++c) assert_true(in->changes[c].brush < in->brush_count && in->changes[c].from != in->changes[c].to);
        if (m < ID_MAPS) assert_int_equal(in->weld_moves, 0);
        printf("%s: %u brushes, %u faces, %u planes, %u points rounded, %u welded, farthest %.4f units\n", real_map_names[m], in->brush_count,
               in->face_count, plane_table_count(in->planes), in->points_rounded, in->weld_moves, in->max_move);
        compile_input_free(in);
    }
    if (read == 0) skip();
}

static void an_integer_map_is_the_same_on_any_grid(void **state)
{
    (void)state;
    static const input_options whole = {1, 0}, fine = {1024, 0};
    uint32_t brushes;
    compile_input *a = real_input(real_map_names[0], &whole, &brushes), *b = real_input(real_map_names[0], &fine, &brushes);
    if (!a || !b) skip();
    assert_int_equal(a->face_count, b->face_count);
    assert_int_equal(plane_table_count(a->planes), plane_table_count(b->planes));
    for (uint32_t f = 0; f < a->face_count; ++f) assert_int_equal(a->faces[f].plane, b->faces[f].plane);
    for (uint32_t i = 0; i < a->brush_count; ++i)
        for (int k = 0; k < 3; ++k) assert_int_equal((a->brushes[i].max[k] + (a->brushes[i].max[k] > 0)) * 1024 >= b->brushes[i].max[k], 1);
    compile_input_free(a);
    compile_input_free(b);
}

// ---- What must not matter ----

static uint64_t mix(uint64_t hash, uint64_t word)
{
    hash ^= word;
    hash *= 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 29;
}

// Of all faces' planes with their brush's box, whatever their order.
static uint64_t unordered_hash(const compile_input *in)
{
    uint64_t sum = 0;
    for (uint32_t b = 0; b < in->brush_count; ++b)
        for (uint32_t f = 0; f < in->brushes[b].face_count; ++f) {
            const cull_wide_plane p = plane_table_get(in->planes, in->faces[in->brushes[b].first_face + f].plane);
            uint64_t hash = mix(mix(1, p.offset.low), p.offset.high);
            for (int k = 0; k < 3; ++k) {
                hash = mix(hash, (uint64_t)p.normal[k]);
                hash = mix(hash, (uint64_t)in->brushes[b].min[k] * 31 + (uint64_t)in->brushes[b].max[k]);
            }
            sum += hash;
        }
    return sum;
}

enum { BRUSHES_MOST = 8192 };
typedef struct brush_span { const char *start, *end; } brush_span;

// The brushes of the first entity, last first; all else as it was.
static char *reversed(const char *text)
{
    brush_span *spans = calloc(BRUSHES_MOST, sizeof *spans);
    size_t count = 0;
    int depth = 0;
    const char *at = text;
    for (; *at; at = strchr(at, '\n') ? strchr(at, '\n') + 1 : at + strlen(at)) {
        if (*at == '{' && ++depth == 2) spans[count].start = at;
        if (*at != '}') continue;
        if (--depth == 1) spans[count++].end = at + 1;
        else break;
        assert_true(count < BRUSHES_MOST);
    }
    assert_true(count > 0);
    char *out = malloc(strlen(text) + count + 1), *to = out;
    to += sprintf(to, "%.*s", (int)(spans[0].start - text), text);
    for (size_t i = count; i-- > 0;) to += sprintf(to, "%.*s\n", (int)(spans[i].end - spans[i].start), spans[i].start);
    strcpy(to, at);
    free(spans);
    return out;
}

static compile_input *quiet_input(const char *text)
{
    report_lines lines;
    report_lines_init(&lines);
    compile_input *in = NULL;
    assert_int_equal(compile_input_map("t.map", text, strlen(text), NULL, allocator_heap(), &lines.report, &in), RESULT_OK);
    return in;
}

static void assert_order_does_not_matter(const char *text, uint32_t least_moves)
{
    char *other = reversed(text);
    compile_input *a = quiet_input(text), *b = quiet_input(other);
    assert_true(a->weld_moves >= least_moves);
    assert_int_equal(a->weld_moves, b->weld_moves);
    assert_true(a->max_move == b->max_move);
    assert_int_equal(a->face_count, b->face_count);
    assert_true(unordered_hash(a) == unordered_hash(b));
    free(other);
    compile_input_free(a);
    compile_input_free(b);
}

static void the_order_of_brushes_in_the_file_does_not_matter(void **state)
{
    (void)state;
    static const uint32_t least_moves[2] = {4, 100};
    for (uint64_t seed = 1; seed <= 5; ++seed) { // planes, corners: everything moves
        const rooms_options o = {seed, 7 * (double)seed, 0.0084};
        rooms_map m = rooms_write(&o);
        assert_order_does_not_matter(m.text, 100);
        free(m.text);
    }
    for (int m = 0; m < 2; ++m) {
        size_t size;
        char *text = real_map(real_map_names[REAL_MAPS - 2 + m], &size);
        if (!text) skip();
        assert_order_does_not_matter(text, least_moves[m]);
        free(text);
    }
}

static void every_compiler_reads_the_same_numbers(void **state)
{
    (void)state;
    static const uint64_t golden[REAL_MAPS] = {0x117f056245211ec7u, 0x459fcaa597ce5985u, 0xd47f397cef1a1d03u, 0x526b1a8658f2d839u,
                                               0x891e9f419a99da8bu, 0x08b80dc01874898bu, 0xb266ed6cfabbf114u, 0x90b59f6d50a70eceu};
    size_t size;
    uint32_t read = 0, wrong = 0;
    for (int m = 0; m < REAL_MAPS; ++m) {
        char *text = real_map(real_map_names[m], &size);
        if (!text) continue;
        read++;
        compile_input *in = quiet_input(text);
        const uint64_t hash = unordered_hash(in);
        wrong += hash != golden[m];
        if (hash != golden[m]) fprintf(stderr, "%s: 0x%016llx\n", real_map_names[m], (unsigned long long)hash);
        compile_input_free(in);
        free(text);
    }
    if (read == 0) skip();
    assert_int_equal(wrong, 0);
}

// (x, y, z) to (y + 1000, -x - 704, z + 304): a turn and whole units.
static char *turned(const char *text)
{
    char *out = malloc(2 * strlen(text) + 1), *to = out;
    for (const char *at = text; *at;) {
        double p[3];
        int length = 0;
        if (*at == '(' && sscanf(at, "( %lf %lf %lf )%n", &p[0], &p[1], &p[2], &length) == 3 && length) {
            to += sprintf(to, "( %.17g %.17g %.17g )", p[1] + 1000, -p[0] - 704, p[2] + 304);
            at += length;
        } else *to++ = *at++;
    }
    *to = 0;
    return out;
}

static void a_turned_and_moved_map_is_the_same_map_turned_and_moved(void **state)
{
    (void)state;
    for (int m = 0; m < ID_MAPS; ++m) {
        size_t size;
        char *text = real_map(real_map_names[m], &size);
        if (!text) skip();
        char *other = turned(text);
        compile_input *a = quiet_input(text), *b = quiet_input(other);
        assert_int_equal(a->brush_count, b->brush_count);
        assert_int_equal(a->face_count, b->face_count);
        assert_int_equal(b->weld_moves, 0);
        assert_int_equal(plane_table_count(a->planes), plane_table_count(b->planes));
        for (uint32_t i = 0; i < a->brush_count; ++i) { // scene: (x, y, z) to (1000 - z, y + 304, x + 704)
            const compile_brush *p = &a->brushes[i], *q = &b->brushes[i];
            assert_int_equal(p->face_count, q->face_count);
            assert_true(q->min[0] == 256000 - p->max[2] && q->max[0] == 256000 - p->min[2]);
            assert_true(q->min[1] == p->min[1] + 77824 && q->max[1] == p->max[1] + 77824);
            assert_true(q->min[2] == p->min[0] + 180224 && q->max[2] == p->max[0] + 180224);
        }
        free(text);
        free(other);
        compile_input_free(a);
        compile_input_free(b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_nearly_equal_planes_become_the_simpler_one_and_it_is_listed),
        cmocka_unit_test(planes_farther_apart_than_the_weld_stay),
        cmocka_unit_test(a_chain_of_near_planes_does_not_drift),
        cmocka_unit_test(a_thin_plate_is_not_welded_away),
        cmocka_unit_test(a_torn_apex_becomes_one_point_again),
        cmocka_unit_test(a_slope_that_misses_a_corner_by_a_rounding_goes_through_it),
        cmocka_unit_test(every_allocation_of_the_weld_may_fail),
        cmocka_unit_test(real_maps_come_in_whole),
        cmocka_unit_test(an_integer_map_is_the_same_on_any_grid),
        cmocka_unit_test(the_order_of_brushes_in_the_file_does_not_matter),
        cmocka_unit_test(every_compiler_reads_the_same_numbers),
        cmocka_unit_test(a_turned_and_moved_map_is_the_same_map_turned_and_moved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
