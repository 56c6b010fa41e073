// Textures of maps: see map_texture.h. The Standard projection is that of Quake's qbsp: the axis plane nearest to the
// face's normal, turned and scaled within it.
// SPDX-License-Identifier: MIT
#include "map_texture.h"

#include "../core/scene.h"

#include <math.h>
#include <string.h>

static const double SCALE_LEAST = 1e-6; // texels a unit; below it (0 is common in old files) Quake takes 1

static map_word base_name(map_word texture)
{
    for (size_t i = texture.length; i-- > 0;)
        if (texture.text[i] == '/' || texture.text[i] == '\\') return (map_word){texture.text + i + 1, texture.length - i - 1};
    return texture;
}

static int is_tool(map_word name)
{
    static const char *const tools[] = {"clip", "skip", "hint", "hintskip", "trigger", "origin", "nodraw", "null", "caulk"};
    for (size_t i = 0; i < sizeof tools / sizeof *tools; ++i)
        if (map_word_is(name, tools[i])) return 1;
    // *waterskip, *lavaskip, *slimeskip: liquids without a surface
    return name.length > 4 && name.text[0] == '*' && map_word_is((map_word){name.text + name.length - 4, 4}, "skip");
}

texture_kind texture_kind_of(map_word texture)
{
    const map_word name = base_name(texture);
    if (is_tool(name)) return TEXTURE_TOOL;
    if (map_word_starts(name, "*")) return TEXTURE_LIQUID;
    if (map_word_starts(name, "{")) return TEXTURE_CUT_OUT;
    if (map_word_starts(name, "sky")) return TEXTURE_SKY;
    return TEXTURE_WALL;
}

uint32_t texture_material_flags(texture_kind kind)
{
    switch (kind) {
    case TEXTURE_LIQUID: return MATERIAL_TRANSLUCENT;
    case TEXTURE_CUT_OUT: return MATERIAL_CUT_OUT;
    case TEXTURE_SKY: return MATERIAL_SKY;
    case TEXTURE_WALL:
    case TEXTURE_TOOL: break;
    }
    return 0;
}

static double scale_of(double scale)
{
    return fabs(scale) < SCALE_LEAST ? 1 : scale;
}

// Quarter turns are exact, as in Quake.
static void sine_cosine(double degrees, double *sine, double *cosine)
{
    static const double quarters[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    const double turn = fmod(degrees, 360), quarter = floor(turn / 90);
    if (quarter * 90 == turn) {
        const int i = ((int)quarter + 4) % 4;
        *sine = quarters[i][0];
        *cosine = quarters[i][1];
        return;
    }
    const double radians = turn * (3.14159265358979323846 / 180);
    *sine = sin(radians);
    *cosine = cos(radians);
}

static texture_map standard_map(const map_face *face, const double normal[3])
{
    static const double bases[6][3][3] = {
        {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}}, // floor, ceiling
        {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}},  {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, // west, east
        {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},  {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}, // south, north
    };
    int nearest = 0;
    double most = 0;
    for (int i = 0; i < 6; ++i) {
        const double along = normal[0] * bases[i][0][0] + normal[1] * bases[i][0][1] + normal[2] * bases[i][0][2];
        if (along <= most) continue;
        most = along;
        nearest = i;
    }
    double sine, cosine;
    sine_cosine(face->rotation_deg, &sine, &cosine);
    const double *s = bases[nearest][1], *t = bases[nearest][2];
    const int s_axis = s[0] != 0 ? 0 : 1, t_axis = t[1] != 0 ? 1 : 2; // the axes that the projection keeps
    texture_map map = {.shift = {face->shift[0], face->shift[1]}};
    const double *const from[2] = {s, t};
    for (int i = 0; i < 2; ++i) {
        const double *axis = from[i];
        map.axes[i][s_axis] = (cosine * axis[s_axis] - sine * axis[t_axis]) / scale_of(face->scale[i]);
        map.axes[i][t_axis] = (sine * axis[s_axis] + cosine * axis[t_axis]) / scale_of(face->scale[i]);
    }
    return map;
}

texture_map texture_map_of(const map_face *face, const double normal[3])
{
    if (face->projection == MAP_STANDARD) return standard_map(face, normal);
    texture_map map = {.shift = {face->shift[0], face->shift[1]}};
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 3; ++k) map.axes[i][k] = face->axes[i][k] / scale_of(face->scale[i]);
    return map;
}
