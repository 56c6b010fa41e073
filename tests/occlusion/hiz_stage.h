// A stage for tests of method=hiz: a zone, a picture of any size, what hiz answers, and an exact oracle that casts rays in double.
// SPDX-License-Identifier: MIT
#ifndef TESTS_OCCLUSION_HIZ_STAGE_H
#define TESTS_OCCLUSION_HIZ_STAGE_H

#include "plugins/occlusion/hiz.h"
#include "tests/common/culler_host.h"
#include "tests/common/hand_zone.h"
#include "tests/common/random.h"
#include "tests/frustum/fixture.h"

// What hiz says about a zone, built with some options.
typedef struct hiz_stage {
    culler_host host;
    hiz h;
    uint8_t *scratch;
    size_t scratch_size;
    cull_run *runs;
    uint32_t run_count, limits_hit, item_count;
} hiz_stage;
void stage_open(hiz_stage *s, const cull_zone *zone, const char *prune, const char *threads, const char *isa); // aborts without memory
void stage_open_pixels(hiz_stage *s, const cull_zone *zone, const char *prune, const char *threads, const char *isa, const char *pixels);
void stage_close(hiz_stage *s);

typedef struct hiz_scene_view {
    cull_view view;
    view_volume sides;
    cull_volume volume;
    double eye[3], forward[3], right[3], up[3], near_m; // right and up of the length that the picture's edge has at distance 1
} hiz_scene_view;
void scene_view_make(const camera *c, uint32_t width_px, uint32_t height_px, const cull_zone *zone, hiz_scene_view *out);

// Fills s->runs; movers: room for as many runs as items and movers.
void stage_run(hiz_stage *s, const hiz_scene_view *v, const cull_mover *movers, uint32_t mover_count);
void stage_set(const hiz_stage *s, uint8_t *seen, uint32_t count); // by item, then mover

// ---- The oracle ----

typedef struct oracle_picture { // of boxes
    const hiz_scene_view *v;
    double *nearest, *farthest; // by pixel: w of what is seen, at the centre; the greatest over what snapping may make of the sample
    uint32_t *owner;            // UINT32_MAX: nothing
    uint32_t width_px, height_px;
} oracle_picture;
typedef enum oracle_samples { ORACLE_CENTRES = 1, ORACLE_SNAPPED = 5 } oracle_samples; // centres alone are drawn five times as fast
void oracle_open(oracle_picture *p, const hiz_scene_view *v, const cull_box *boxes, uint32_t count, oracle_samples samples);
void oracle_close(oracle_picture *p);
// How far along the axis the ray through pixel coordinates x, y meets the box's surface behind the near plane; HUGE_VAL: never.
double oracle_box(const hiz_scene_view *v, const cull_box *box, double x, double y);
// Pixels x0 .. x1, y0 .. y1 whose centres may lie in the box's outline, and its least w. 0: part of it is not before the near plane.
int oracle_bounds(const hiz_scene_view *v, const cull_box *box, int out[4], double *least);
// The box would leave a pixel, however vertices are snapped.
int oracle_shows(const oracle_picture *p, const cull_box *box);

#endif
