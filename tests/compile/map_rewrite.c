// Maps rewritten: see map_rewrite.h.
// SPDX-License-Identifier: MIT
#include "tests/common/random.h"
#include "tests/common/test.h"

#include "map_rewrite.h"

#include "host/import/map_entity.h"
#include "host/import/map_texture.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct text_out {
    char *text;
    size_t size, room;
    const map_rewrite *by;
    uint64_t seed;
} text_out;

// ---- Turns ----

map_rewrite rewrite_scaled(int scale)
{
    return (map_rewrite){.name = "scaled", .turn = {{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}}, .scale = scale};
}

map_rewrite rewrite_turned(int number)
{
    static const int axes[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    map_rewrite r = {.name = number < 24 ? "turned" : "mirrored", .scale = 1};
    const int order = number / 4 % 6, odd = order >= 3;
    int signs[3] = {number & 1 ? -1 : 1, number & 2 ? -1 : 1, 1};
    signs[2] = signs[0] * signs[1] * (odd ? -1 : 1) * (number >= 24 ? -1 : 1);
    for (int k = 0; k < 3; ++k) r.turn[k][axes[order][k]] = signs[k];
    return r;
}

map_rewrite rewrite_slanted(int number)
{
    static const map_rewrite all[SLANTED_TURNS] = {
        {.name = "3-4-5 about z", .turn = {{3, -4, 0}, {4, 3, 0}, {0, 0, 5}}, .scale = 5},
        {.name = "3-4-5 about x", .turn = {{5, 0, 0}, {0, 3, -4}, {0, 4, 3}}, .scale = 5},
        {.name = "3-4-5 about y", .turn = {{3, 0, 4}, {0, 5, 0}, {-4, 0, 3}}, .scale = 5},
        {.name = "(1, 2, 2, 4)/25", .turn = {{-15, 0, 20}, {16, -15, 12}, {12, 20, 9}}, .scale = 25},
    };
    return all[number];
}

int rewrite_is_mirrored(const map_rewrite *r)
{
    int volume = 0;
    for (int k = 0; k < 3; ++k)
        volume += r->turn[0][k] * (r->turn[1][(k + 1) % 3] * r->turn[2][(k + 2) % 3] - r->turn[1][(k + 2) % 3] * r->turn[2][(k + 1) % 3]);
    return volume < 0;
}

// ---- Text ----

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void put(text_out *o, const char *format, ...)
{
    enum { LINE_MOST = 8192 };
    if (o->room - o->size < LINE_MOST) {
        o->room = 2 * o->room + LINE_MOST;
        o->text = realloc(o->text, o->room);
        assert_non_null(o->text);
    }
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(o->text + o->size, LINE_MOST, format, arguments);
    va_end(arguments);
    assert_true(length >= 0 && length < LINE_MOST);
    o->size += (size_t)length;
}

static void turned_point(const map_rewrite *by, const double p[3], double out[3])
{
    for (int k = 0; k < 3; ++k) {
        out[k] = 0;
        for (int j = 0; j < 3; ++j) out[k] += by->turn[k][j] * p[j]; // whole numbers and 1/256 of them: exact
        if (by->points == POINTS_ROUNDED) out[k] = nearbyint(out[k] * 256 / by->scale) / 256;
        out[k] += by->move[k];
    }
}

static void put_point(text_out *o, const double p[3], const char *between)
{
    double to[3];
    turned_point(o->by, p, to);
    put(o, "%s%.17g %.17g %.17g", between, to[0] + 0.0, to[1] + 0.0, to[2] + 0.0);
}

// a' . (turn p + move) + shift' = a . p + shift
static void put_axis(text_out *o, const double axis[3], double shift)
{
    const map_rewrite *by = o->by;
    const double divisor = by->points == POINTS_ROUNDED ? by->scale : (double)by->scale * by->scale;
    double to[3];
    for (int k = 0; k < 3; ++k) {
        to[k] = 0;
        for (int j = 0; j < 3; ++j) to[k] += by->turn[k][j] * axis[j];
        to[k] /= divisor;
    }
    for (int k = 0; k < 3; ++k) shift -= to[k] * by->move[k];
    put(o, " [ %.17g %.17g %.17g %.17g ]", to[0], to[1], to[2], shift);
}

static void put_face(text_out *o, const map_face *f)
{
    const int mirrored = rewrite_is_mirrored(o->by);
    double u[3], v[3], normal[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = f->points[2][k] - f->points[0][k];
        v[k] = f->points[1][k] - f->points[0][k];
    }
    for (int k = 0; k < 3; ++k) normal[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]; // clockwise: outward
    const texture_map map = texture_map_of(f, normal);
    for (int i = 0; i < 3; ++i) {
        put_point(o, f->points[mirrored && i ? 3 - i : i], i ? " ) ( " : "( ");
    }
    put(o, " ) %.*s", (int)f->texture.length, f->texture.text);
    for (int i = 0; i < 2; ++i) put_axis(o, map.axes[i], map.shift[i]);
    put(o, " 0 1 1\n");
}

// ---- Keys ----

static void put_angle(text_out *o, double degrees)
{
    static const double quarters[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    double from[3] = {0, 0, 0}, to[3];
    if (degrees < 0) from[2] = degrees == -1 ? 1 : -1;
    else if (fmod(degrees, 90) == 0) memcpy(from, quarters[(int)(degrees / 90) % 4], sizeof quarters[0]);
    else {
        from[0] = cos(degrees * (3.14159265358979323846 / 180));
        from[1] = sin(degrees * (3.14159265358979323846 / 180));
    }
    for (int k = 0; k < 3; ++k) to[k] = o->by->turn[k][0] * from[0] + o->by->turn[k][1] * from[1] + o->by->turn[k][2] * from[2];
    double turned = degrees; // a slanted way can't be said: only where the door opens to changes
    if (to[0] == 0 && to[1] == 0) turned = to[2] > 0 ? -1 : -2;
    else if (to[2] == 0) turned = fmod(atan2(to[1], to[0]) * (180 / 3.14159265358979323846) + 360, 360);
    put(o, "\"angle\" \"%.15g\"\n", turned);
}

static void put_keys(text_out *o, const map_entity *e)
{
    const map_key *keys = e->keys.items;
    for (size_t i = 0; i < e->keys.count; ++i) {
        double numbers[3];
        if (map_word_is(keys[i].key, "angle") && map_word_numbers(keys[i].value, numbers, 1)) put_angle(o, numbers[0]);
        else if (map_word_is(keys[i].key, "origin") && map_word_numbers(keys[i].value, numbers, 3)) {
            put_point(o, numbers, "\"origin\" \"");
            put(o, "\"\n");
        } else
            put(o, "\"%.*s\" \"%.*s\"\n", (int)keys[i].key.length, keys[i].key.text, (int)keys[i].value.length, keys[i].value.text);
    }
}

// ---- Order ----

static size_t *order_of(text_out *o, size_t first, size_t count, int is_shuffled)
{
    size_t *order = malloc((count + 1) * sizeof *order);
    assert_non_null(order);
    for (size_t i = 0; i < count; ++i) order[i] = i;
    for (size_t i = count; is_shuffled && i > first + 1; --i) {
        const size_t j = first + random_below(&o->seed, (uint32_t)(i - first)), swap = order[i - 1];
        order[i - 1] = order[j];
        order[j] = swap;
    }
    return order;
}

static void put_brush(text_out *o, const map_entity *e, const map_brush *b)
{
    size_t *order = order_of(o, 0, b->face_count, (o->by->shuffle & SHUFFLE_FACES) != 0);
    put(o, "{\n");
    for (size_t f = 0; f < b->face_count; ++f) put_face(o, (const map_face *)e->faces.items + b->first_face + order[f]);
    put(o, "}\n");
    free(order);
}

static void put_entity(text_out *o, const map_entity *e)
{
    size_t *order = order_of(o, 0, e->brushes.count, (o->by->shuffle & SHUFFLE_BRUSHES) != 0);
    put(o, "{\n");
    put_keys(o, e);
    for (size_t b = 0; b < e->brushes.count; ++b) put_brush(o, e, (const map_brush *)e->brushes.items + order[b]);
    put(o, "}\n");
    free(order);
}

static buffer read_entities(const char *text, size_t size)
{
    report quiet = {0};
    map_reader reader = {.path = "rewritten", .at = text, .end = text + size, .line = 1, .report = &quiet};
    buffer all = buffer_make(allocator_heap(), sizeof(map_entity));
    for (;;) {
        map_entity e = map_entity_make(allocator_heap());
        map_more more;
        assert_int_equal(map_reader_next(&reader, &e, &more), RESULT_OK);
        if (more == MAP_END) {
            map_entity_free(&e);
            return all;
        }
        assert_non_null(buffer_append(&all, &e, 1));
    }
}

char *map_rewritten(const char *text, size_t size, const map_rewrite *r, size_t *out_size)
{
    buffer entities = read_entities(text, size);
    map_entity *all = entities.items;
    text_out o = {.by = r, .seed = 4 + r->shuffle};
    size_t *order = order_of(&o, 1, entities.count, (r->shuffle & SHUFFLE_ENTITIES) != 0);
    for (size_t e = 0; e < entities.count; ++e) put_entity(&o, &all[order[e]]);
    for (size_t e = 0; e < entities.count; ++e) map_entity_free(&all[e]);
    free(order);
    buffer_free(&entities);
    *out_size = o.size;
    return o.text;
}
