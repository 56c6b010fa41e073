// LDR-FLIP, how different two pictures look when they alternate on a screen: Andersson, Nilsson, Akenine-Moller, Oskarsson,
// Astrom, Fairchild, "FLIP: A Difference Evaluator for Alternating Images", HPG 2020. Same bits from every compiler.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_FLIP_H
#define PORTCULLIS_BENCH_FLIP_H

#include "../host/core/memory.h"

// A screen 0.7 m wide with 3,840 pixels, 0.7 m from the eye, as in the paper: 67.02 pixels per degree of visual angle.
#define FLIP_PIXELS_PER_DEGREE (3840 * 3.14159265358979323846 / 180)

typedef struct flip flip; // filters and scratch for one size of pictures
typedef struct flip_request {
    uint32_t width_px, height_px;
    double pixels_per_degree; // 1 to 400
} flip_request;

// [any thread, one call at a time per flip] NULL: no memory, or a request out of range.
flip *flip_open(const flip_request *q, const allocator *memory);
void flip_close(flip *f); // NULL is fine

// Pictures of width * height * 4 bytes, sRGB; alpha is not looked at. map: width * height differences in 0 .. 1, NULL: not wanted.
// Returns their mean. Exactly 0 where the pictures are equal as far as the filters reach (10 pixels at 67 per degree).
typedef struct flip_pair { const uint8_t *reference, *test; } flip_pair;
double flip_compare(flip *f, const flip_pair *pair, float *map);

// While calls come with one number, other than 0, they have one reference: what was filtered of it is kept, and each
// further picture takes two thirds of the time. 0, as it starts: nothing is kept, and what was kept of a number stays.
void flip_keep_reference(flip *f, uint64_t number);

// A map as a picture for people: black over purple and orange to pale yellow; pixels * 4 bytes.
void flip_heat(const float *map, size_t pixels, uint8_t *rgba);

#endif
