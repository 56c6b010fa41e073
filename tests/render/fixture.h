// What the renderer's tests share: a renderer or a loud skip, small scenes of quads, a counting allocator.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_RENDER_FIXTURE_H
#define PORTCULLIS_TESTS_RENDER_FIXTURE_H

#include "host/render/render.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

// Counts live bytes; fails allocation number fail_at (1 is the first), 0: never.
typedef struct counting {
    allocator memory;
    size_t live_bytes;
    uint64_t calls, fail_at;
} counting;
void counting_init(counting *c); // c must not move afterwards

// cmocka's whole program: 77 when this machine has no GL, and at the end no GL error may stand.
typedef struct bed {
    counting memory;
    renderer *g;
    report r;
    scene *s;
    render_layout *l; // the scene's own order
} bed;
int run_with_gl(const char *name, const struct CMUnitTest *tests, size_t count);
#define RUN_WITH_GL(tests) run_with_gl(#tests, tests, sizeof(tests) / sizeof *(tests))
int bed_setup(void **state);    // a renderer, no scene
int bed_teardown(void **state); // no GL error, no live byte

typedef struct quad { // corners counterclockwise from the front
    double corners[4][3];
    const char *material;
    uint32_t material_flags, item_flags;
    uint32_t colour; // 0: the name's
    uint32_t is_mover;
} quad;

// An axis-parallel quad at z, facing +z, from (x0, y0) to (x1, y1).
quad quad_at(double z, double x0, double y0, double x1, double y1);
quad quad_reversed(quad q);
// Builds, uploads and lays out; offset is added to every corner.
void bed_scene(bed *b, const quad *quads, size_t count, const double offset[3]);
void bed_mesh(bed *b, const double (*positions)[3], uint32_t position_count, const uint32_t *indices, uint32_t index_count, uint32_t item_indices);

// side * side rooms of 4 x 4 m, 3 m high, from `corner` on along x and -z: a zone each, doorways between, closed outside.
enum { ROOM_SIDE_M = 4, ROOM_HIGH_M = 3 };
void bed_rooms(bed *b, uint32_t side, const double corner[3]);
// A layout of the scene's zones, each in the order of its list, or turned round.
typedef enum list_order { LIST_ORDER, LIST_REVERSED } list_order;
render_layout *bed_zone_layout(bed *b, list_order order);

camera camera_at(double x, double y, double z); // looks along -z, 90 degrees, square, near 1/16, no far plane
// Drawn, checked; free with id_picture_free(&p, allocator_heap()).
id_picture bed_ids(bed *b, const id_request *q, uint32_t width_px, uint32_t height_px);
uint32_t id_at(const id_picture *p, uint32_t x, uint32_t y); // y from the bottom
int see_through_at(const id_picture *p, uint32_t triangle);
uint32_t item_of_triangle(const scene *s, uint32_t triangle);

uint32_t random_next(uint32_t *state);             // 32 bits
double random_unit(uint32_t *state);               // [0, 1)

// A layout of one zone with all items; order NULL: as the scene stands.
result bed_layout(bed *b, const uint32_t *order, render_layout **out);
// Places of such a layout, movers behind the items.
void bed_draw(bed *b, const render_layout *l, const cull_run *runs, uint32_t run_count);
// Answers of zone 0 of the bed's layout.
uint32_t bed_collect(bed *b, collect how, uint32_t frame, cull_answer *answers, uint32_t capacity, uint32_t *stalled);

// A frame of these runs, top row first; free with memory_free(allocator_heap(), rgba, w * h, 4).
uint8_t *bed_frame(bed *b, const frame_request *q, const render_layout *l, const cull_run *runs, uint32_t run_count);

#endif
