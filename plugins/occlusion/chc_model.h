// How likely what was hidden stays hidden and what was seen stays seen: Mattausch, Bittner, Wimmer, "CHC++: Coherent Hierarchical
// Culling Revisited", 2008, section 4.2. Its fitted curve p(i) = 0.99 - 0.7 e^-i is where each viewer begins; what it then
// finds is counted and takes the curve's place. Counts alone: the same answers give the same numbers on every machine.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_CHC_MODEL_H
#define OCCLUSION_CHC_MODEL_H

#include <portcullis/box.h>

#include <math.h>

// Frames that a thing has been hidden: none told, 1, 2, 3, to 5, to 9, to 17, more. Then: its parent came into sight in this
// frame; a mover of which nothing is told; held for seen till now.
enum { KEEP_UNKNOWN, KEEP_SHORT, KEEP_LONGEST = 7, KEEP_OPENED, KEEP_MOVER, KEEP_HELD, KEEP_COUNT };
// How much larger the box round several is than they are, by surface.
enum { GROWTH_COUNT = 6, VERDICT_COUNT = 3 }; // verdicts: chc_picture.h
enum { SIGHT_COUNT = 8 }; // pixels of an item: below 4, 16, 64 ... 65,536, and more

typedef struct chc_ratio { uint32_t held, all; } chc_ratio;

typedef struct chc_model {
    chc_ratio keep[KEEP_COUNT];    // hidden again, of those tested
    chc_ratio joint[VERDICT_COUNT][GROWTH_COUNT]; // joint tests answered "hidden", and how many should be by their parts; in 1/1024
    chc_ratio mates;               // the same again, hidden again
    chc_ratio fresh;               // hidden at the end of a frame, of those found seen in it
    chc_ratio lost[SIGHT_COUNT];   // items found hidden, of frames that they were held for seen
} chc_model;

static inline void ratio_halve(chc_ratio *r)
{
    r->held /= 2;
    r->all /= 2;
}

static inline void ratio_count(chc_ratio *r, uint32_t held, uint32_t all)
{
    const uint32_t most = 1u << 22;
    r->held += held;
    r->all += all;
    if (r->all >= most) ratio_halve(r);
}

// weight: of the guess, as so many counts.
static inline float ratio_value(const chc_ratio *r, float guess, float weight)
{
    return ((float)r->held + guess * weight) / ((float)r->all + weight);
}

static inline uint32_t keep_bucket(uint32_t frames)
{
    uint32_t bucket = (uint32_t)KEEP_SHORT + (frames > 1) + (frames > 2);
    for (uint32_t f = 3; bucket >= 3 && frames > f && bucket < KEEP_LONGEST; f = 2 * f - 1) bucket++;
    return bucket;
}

static inline float model_keeps(const chc_model *m, uint32_t bucket)
{
    static const float fitted[KEEP_COUNT] = {0.29f, 0.7325f, 0.8953f, 0.9551f, 0.98f, 0.989f, 0.99f, 0.99f, 0.5f, 0.8f, 0.2f};
    return ratio_value(&m->keep[bucket], fitted[bucket], 8);
}

static inline uint32_t growth_bucket(float growth)
{
    static const float most[GROWTH_COUNT - 1] = {1.1f, 1.4f, 1.8f, 2.5f, 4};
    uint32_t bucket = 0;
    while (bucket < GROWTH_COUNT - 1 && !(growth <= most[bucket])) bucket++;
    return bucket;
}

static inline float model_joint(const chc_model *m, uint32_t hides, uint32_t bucket)
{
    static const float guess[VERDICT_COUNT][GROWTH_COUNT] = {{0.3f, 0.3f, 0.3f, 0.3f, 0.3f, 0.3f}, {0.9f, 0.85f, 0.8f, 0.8f, 0.8f, 0.8f}, {0.98f, 0.95f, 0.95f, 0.9f, 0.9f, 0.9f}};
    const float value = ratio_value(&m->joint[hides][bucket], guess[hides][bucket], 8 * 1024);
    return value < 1 ? value : 1;
}

static inline float model_mates(const chc_model *m)
{
    return ratio_value(&m->mates, 0.95f, 8);
}

static inline uint32_t sight_bucket(uint32_t pixels)
{
    uint32_t bucket = 0;
    while (bucket < SIGHT_COUNT - 1 && pixels >= 4) {
        pixels /= 4;
        bucket++;
    }
    return bucket;
}

static inline float model_fresh(const chc_model *m)
{
    return ratio_value(&m->fresh, 0.15f, 20);
}

// A frame, of an item with so many pixels.
static inline float model_loses(const chc_model *m, uint32_t bucket)
{
    return ratio_value(&m->lost[bucket], 0.05f, 20);
}

static inline float box_surface(const cull_box *b)
{
    const float x = b->max.x - b->min.x, y = b->max.y - b->min.y, z = b->max.z - b->min.z;
    return x * y + y * z + z * x;
}

// A number that differs for each pair, always the same.
static inline uint32_t chc_random(uint32_t a, uint32_t b)
{
    uint32_t x = a * 2654435761u ^ (b * 2246822519u + 0x9E3779B9u);
    x = (x ^ x >> 15) * 2246822519u;
    x = (x ^ x >> 13) * 3266489917u;
    return x ^ x >> 16;
}

#endif
