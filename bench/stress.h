// Stress: a scene and path moved, scaled, turned, jittered, doubled, looked at with extreme cameras; each culler against the
// truth of the changed scene, and both against the scene as it is. Where the host refuses, that is the stated limit.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_STRESS_H
#define PORTCULLIS_BENCH_STRESS_H

#include "bench.h"

typedef enum stress_kind {
    STRESS_MOVE,     // metres, whole ones, along (1, 0, -1)
    STRESS_MOVE_ODD, // metres, by numbers that are no multiple of anything
    STRESS_SCALE,
    STRESS_TURN,     // degrees, about all three axes
    STRESS_JITTER,   // float's ulps at the scene's greatest coordinate
    STRESS_NEAR,     // metres
    STRESS_FAR,
    STRESS_FOV,      // degrees
    STRESS_COPIES,   // times that each item stands there
    STRESS_TINY,     // metres: sides of a triangle added at a corner of each item
    STRESS_EYE,      // metres and parts of a direction: the eye moved, the direction bent
} stress_kind;

// SAME: pictures and drawn items are compared with those of the scene as it is. OWN: there is nothing to compare with.
typedef enum stress_compare { STRESS_SAME, STRESS_OWN } stress_compare;

typedef struct stress_family {
    const char *name, *unit;
    stress_kind kind;
    stress_compare compare;
    const double *magnitudes; // ever more extreme
    uint32_t magnitude_count;
} stress_family;

const stress_family *stress_families(uint32_t *out_count);

enum { STRESS_REFUSED_BYTES = 192 };

// What one strategy did at one magnitude: sums over the path.
typedef struct stress_point {
    double magnitude;
    char refused[STRESS_REFUSED_BYTES]; // by the host, in its words; then all else is 0
    uint64_t missed_pixels, missed_items, broken_items;
    uint64_t pixels, pixels_differ;     // pixels whose owner is another item than in the scene as it is
    uint64_t items_drawn, drawn_differ; // of the scene's items: drawn in one and not in the other; both where several copies are
    uint64_t zones_differ;              // reached in one and not in the other
    double polygons_drawn;              // a view
} stress_point;

typedef struct stress_series {
    const stress_family *family;
    uint32_t strategy;    // of the request
    stress_point home;    // the scene as it is, made anew: what points are compared with
    stress_point *points; // family->magnitude_count
} stress_series;

typedef struct stress_request {
    const bench_request *bench;           // scene, path, strategies; its repeat is 1
    const stress_family *const *families; // family_count
    uint32_t family_count;
    uint64_t seed;
} stress_request;

typedef struct stress_result {
    stress_series *series; // strategy_count * family_count, a strategy's together
    uint32_t series_count;
    const allocator *memory;
} stress_result;

// [main] One renderer, one changed scene at a time. Free with stress_result_free.
result stress_run(const stress_request *q, report *r, stress_result *out);
void stress_result_free(stress_result *s);

// Magnitudes at which it first happens, NAN: at none.
typedef struct stress_firsts { double missed, pictures, drawn, zones, refused; } stress_firsts;
static const double STRESS_PICTURES_MOST = 1e-4; // of the pixels may have another owner: what rounding does at edges
stress_firsts stress_first(const stress_series *s);
uint32_t stress_failed(const stress_result *s); // series in which a chain broke a promise

// ---- For people and programs; free with memory_free(memory, bytes, size + 1, 1) ----
result stress_table(const stress_request *q, const stress_result *s, bench_text *out);
result stress_json(const stress_request *q, const stress_result *s, const bench_labels *labels, bench_text *out);
// A panel a family: share of missed pixels, and of pixels with another owner, against magnitude.
result stress_svg(const stress_request *q, const stress_result *s, const bench_labels *labels, bench_text *out);

#endif
