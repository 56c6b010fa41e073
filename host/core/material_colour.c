// Material colours: see material_colour.h.
// SPDX-License-Identifier: MIT
#include "material_colour.h"

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

typedef struct stuff {
    const char *word;
    float hue_deg, saturation, value; // HSV
} stuff;

// The first word found decides. Lower case.
static const stuff stuffs[] = {
    {"lava", 18, 0.85f, 0.95f},   {"slime", 95, 0.65f, 0.50f}, {"blood", 0, 0.75f, 0.50f},  {"tele", 275, 0.30f, 0.75f},  {"water", 205, 0.50f, 0.65f},
    {"mwat", 205, 0.50f, 0.65f},  {"sky", 210, 0.35f, 0.90f},  {"plant", 110, 0.45f, 0.50f}, {"veget", 110, 0.45f, 0.50f}, {"tree", 115, 0.45f, 0.45f},
    {"leaf", 115, 0.45f, 0.50f},  {"leaves", 115, 0.45f, 0.5f}, {"grass", 95, 0.40f, 0.55f}, {"ground", 45, 0.28f, 0.60f}, {"earth", 35, 0.35f, 0.50f},
    {"dirt", 30, 0.35f, 0.48f},   {"sand", 45, 0.30f, 0.80f},  {"road", 220, 0.04f, 0.42f}, {"land", 60, 0.22f, 0.62f},   {"building", 22, 0.22f, 0.74f},
    {"roof", 12, 0.40f, 0.55f},   {"brick", 14, 0.38f, 0.58f}, {"bric", 14, 0.38f, 0.58f},  {"wood", 30, 0.42f, 0.52f},   {"wiz", 40, 0.25f, 0.55f},
    {"glass", 195, 0.25f, 0.80f}, {"metal", 215, 0.08f, 0.58f}, {"comp", 200, 0.12f, 0.55f}, {"tech", 205, 0.12f, 0.58f},  {"conc", 50, 0.06f, 0.66f},
    {"stone", 40, 0.12f, 0.62f},  {"rock", 32, 0.18f, 0.52f},  {"marble", 50, 0.05f, 0.82f}, {"light", 50, 0.25f, 0.98f},  {"lite", 50, 0.25f, 0.98f},
    {"floor", 32, 0.20f, 0.55f},  {"ceil", 45, 0.06f, 0.80f},  {"wall", 38, 0.16f, 0.74f},  {"door", 26, 0.36f, 0.50f},   {"bridge", 30, 0.15f, 0.60f},
};

static void lower_case(const char *name, size_t length, char out[64])
{
    const size_t most = length < 63 ? length : 63;
    for (size_t i = 0; i < most; ++i) out[i] = name[i] >= 'A' && name[i] <= 'Z' ? (char)(name[i] + 32) : name[i];
    out[most] = 0;
}

static uint32_t colour_of_hsv(double hue, double saturation, double value)
{
    uint32_t colour = 0xff000000u;
    for (int channel = 0; channel < 3; ++channel) {
        const double k = fmod(5 - 2 * channel + hue / 60, 6); // the closed form of the conversion
        const double ramp = fmax(0, fmin(1, fmin(k, 4 - k)));
        colour |= (uint32_t)(255 * (value - value * saturation * ramp)) << (8 * channel);
    }
    return colour;
}

uint32_t material_colour(const char *name, size_t length)
{
    char lower[64];
    lower_case(name, length, lower);
    const uint64_t hash = XXH3_64bits(name, length);
    const double a = (double)(hash & 0xff) / 255, b = (double)(hash >> 8 & 0xff) / 255, c = (double)(hash >> 16 & 0xff) / 255;
    for (size_t i = 0; i < sizeof stuffs / sizeof *stuffs; ++i) {
        if (!strstr(lower, stuffs[i].word)) continue;
        const double value = fmin(1, stuffs[i].value * (0.88 + 0.24 * b));
        return colour_of_hsv(stuffs[i].hue_deg + 16 * a, fmin(1, stuffs[i].saturation * (0.7 + 0.6 * c)), value);
    }
    return colour_of_hsv(360 * a, 0.06 + 0.22 * c, 0.5 + 0.35 * b);
}
