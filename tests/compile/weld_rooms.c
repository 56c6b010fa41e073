// See weld_rooms.h. Walls, floors and posts abut and never overlap, so that a gap anywhere is a leak or joins two rooms.
// SPDX-License-Identifier: MIT
#include "tests/common/test.h"

#include "weld_rooms.h"

#include "tests/common/random.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ACROSS_MOST = 4, CELL = 256, HALF_WALL = 8, HEIGHT = 192, SLAB = 16 };

typedef struct rooms {
    const rooms_options *o;
    uint64_t seed;
    double cosine, sine;
    char *text;
    size_t size, room;
} rooms;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void put(rooms *r, const char *format, ...)
{
    if (r->room - r->size < 512) {
        r->room = 2 * r->room + 4096;
        r->text = realloc(r->text, r->room);
        assert_non_null(r->text);
    }
    va_list arguments;
    va_start(arguments, format);
    r->size += (size_t)vsnprintf(r->text + r->size, r->room - r->size, format, arguments);
    va_end(arguments);
}

static double moved(uint64_t *seed, double most)
{
    return most * ((double)random_below(seed, 2000001) / 1000000 - 1);
}

static void put_point(rooms *r, const double p[3])
{
    const double x = p[0] * r->cosine - p[1] * r->sine, y = p[0] * r->sine + p[1] * r->cosine;
    const double by[3] = {moved(&r->seed, r->o->jitter), moved(&r->seed, r->o->jitter), moved(&r->seed, r->o->jitter)};
    put(r, "( %.10g %.10g %.10g ) ", x + by[0], y + by[1], p[2] + by[2]);
}

static void put_face(rooms *r, const double *a, const double *b, const double *c) // counterclockwise from outside
{
    put_point(r, b);
    put_point(r, a);
    put_point(r, c);
    put(r, "wall 0 0 0 1 1\n");
}

// Corners: low x, y, z bits of their number.
static void put_box(rooms *r, const double low[3], const double high[3])
{
    static const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    double corner[8][3];
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) corner[i][k] = i >> k & 1 ? high[k] : low[k];
    put(r, "{\n");
    for (int f = 0; f < 6; ++f) {
        const int start = (int)random_below(&r->seed, 4); // any three of the four
        put_face(r, corner[faces[f][start]], corner[faces[f][(start + 1) % 4]], corner[faces[f][(start + 2) % 4]]);
    }
    put(r, "}\n");
}

static void put_ramp(rooms *r, const double low[3], const double high[3]) // rises with x
{
    static const int faces[5][3] = {{0, 2, 3}, {1, 3, 7}, {0, 1, 5}, {2, 7, 3}, {0, 5, 7}};
    double corner[8][3];
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) corner[i][k] = i >> k & 1 ? high[k] : low[k];
    put(r, "{\n");
    for (int f = 0; f < 5; ++f) put_face(r, corner[faces[f][0]], corner[faces[f][1]], corner[faces[f][2]]);
    put(r, "}\n");
}

static void box(rooms *r, double x0, double y0, double z0, double x1, double y1, double z1)
{
    const double low[3] = {x0, y0, z0}, high[3] = {x1, y1, z1};
    put_box(r, low, high);
}

static void slab(rooms *r, int i, int j, const int across[2], double z)
{
    const double x0 = CELL * i - (i == 0 ? HALF_WALL : 0), x1 = CELL * (i + 1) + (i + 1 == across[0] ? HALF_WALL : 0);
    const double y0 = CELL * j - (j == 0 ? HALF_WALL : 0), y1 = CELL * (j + 1) + (j + 1 == across[1] ? HALF_WALL : 0);
    const double cut = CELL * i + 16 * (2 + (int)random_below(&r->seed, 12)); // two tiles
    box(r, x0, y0, z, cut, y1, z + SLAB);
    box(r, cut, y0, z, x1, y1, z + SLAB);
}

// From low to high along one axis at a place on the other.
static void wall(rooms *r, int along_y, double at, double low, double high, int is_open)
{
    const double cuts[4] = {low, low + 64, low + 128, high};
    for (int part = 0; part < (is_open ? 3 : 1); ++part) {
        const double from = is_open ? cuts[part] : low, to = is_open ? cuts[part + 1] : high, bottom = is_open && part == 1 ? 112 : 0;
        if (along_y) box(r, at - HALF_WALL, from, bottom, at + HALF_WALL, to, HEIGHT);
        else box(r, from, at - HALF_WALL, bottom, to, at + HALF_WALL, HEIGHT);
    }
}

static uint32_t root_of(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

static void walls(rooms *r, const int across[2], uint32_t *parent)
{
    for (int along_y = 0; along_y < 2; ++along_y)
        for (int i = 0; i <= across[!along_y]; ++i)
            for (int j = 0; j < across[along_y]; ++j) {
                const int is_open = i > 0 && i < across[!along_y] && random_below(&r->seed, 2);
                wall(r, along_y, CELL * i, CELL * j + HALF_WALL, CELL * (j + 1) - HALF_WALL, is_open);
                const int x = along_y ? i : j, y = along_y ? j : i;
                const uint32_t here = (uint32_t)(y * ACROSS_MOST + x), before = (uint32_t)(along_y ? here - 1 : here - ACROSS_MOST);
                if (is_open) parent[root_of(parent, here)] = root_of(parent, before);
            }
}

rooms_map rooms_write(const rooms_options *o)
{
    const double turn = o->turn_deg * 3.14159265358979323846 / 180;
    rooms r = {.o = o, .seed = o->seed, .cosine = cos(turn), .sine = sin(turn)};
    const int across[2] = {2 + (int)random_below(&r.seed, ACROSS_MOST - 1), 2 + (int)random_below(&r.seed, ACROSS_MOST - 1)};
    uint32_t parent[ACROSS_MOST * ACROSS_MOST];
    for (uint32_t i = 0; i < ACROSS_MOST * ACROSS_MOST; ++i) parent[i] = i;
    put(&r, "{\n\"classname\" \"worldspawn\"\n");
    for (int i = 0; i < across[0]; ++i)
        for (int j = 0; j < across[1]; ++j) {
            slab(&r, i, j, across, -SLAB);
            slab(&r, i, j, across, HEIGHT);
        }
    walls(&r, across, parent);
    for (int i = 0; i <= across[0]; ++i)
        for (int j = 0; j <= across[1]; ++j) box(&r, CELL * i - HALF_WALL, CELL * j - HALF_WALL, 0, CELL * i + HALF_WALL, CELL * j + HALF_WALL, HEIGHT);
    for (int i = 0; i < across[0]; ++i) { // against the wall of a row of rooms
        const double low[3] = {CELL * i + 152, HALF_WALL, 0}, high[3] = {CELL * (i + 1) - HALF_WALL, 72, 48};
        put_ramp(&r, low, high);
    }
    put(&r, "}\n");
    rooms_map out = {.rooms = (uint32_t)(across[0] * across[1])};
    for (int i = 0; i < across[0]; ++i)
        for (int j = 0; j < across[1]; ++j) {
            const double x = CELL * i + 120, y = CELL * j + 152;
            put(&r, "{\n\"classname\" \"light\"\n\"origin\" \"%.6f %.6f 80\"\n}\n", x * r.cosine - y * r.sine, x * r.sine + y * r.cosine);
            const uint32_t here = (uint32_t)(j * ACROSS_MOST + i);
            out.zones += root_of(parent, here) == here;
        }
    out.text = r.text;
    out.size = r.size;
    return out;
}

char *map_jittered(const char *text, double jitter, uint64_t seed, size_t *out_size)
{
    char *out = malloc(4 * strlen(text) + 1), *to = out;
    assert_non_null(out);
    for (const char *at = text; *at;) {
        double p[3];
        int length = 0;
        if (*at == '(' && sscanf(at, "( %lf %lf %lf )%n", &p[0], &p[1], &p[2], &length) == 3 && length) {
            to += sprintf(to, "( %.12g %.12g %.12g )", p[0] + moved(&seed, jitter), p[1] + moved(&seed, jitter), p[2] + moved(&seed, jitter));
            at += length;
        } else *to++ = *at++;
    }
    *to = 0;
    *out_size = (size_t)(to - out);
    return out;
}
