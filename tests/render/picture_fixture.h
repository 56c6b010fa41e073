// What tests of pictures share: small square frames, captures of all that a camera sees, and pixels compared.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_RENDER_PICTURE_FIXTURE_H
#define PORTCULLIS_TESTS_RENDER_PICTURE_FIXTURE_H

#include "fixture.h"

enum { SIDE = 128, QUADS = 60, SLOTS = 65536 };

void drop_pixels(uint8_t *rgba);
frame_request request(const camera *c); // items, each in its colour, SIDE * SIDE
cull_vec3 in_zone(const bed *b, double x, double y, double z);
cull_plane plane_in_zone(const bed *b, double x, double y, double z, double offset); // x, y, z: a unit normal; offset in the world
// The whole picture of a camera at (x, y, z), through the square that it sees at a distance. Slot 7.
cull_capture whole_picture(const bed *b, const camera *c, double distance, const cull_run *runs, uint32_t run_count);
uint32_t pixels_that_differ(const uint8_t *a, const uint8_t *b); // by more than 8 steps of 255
void scene_with_slots(bed *b, const quad *quads, size_t count);
void random_scene(bed *b, uint32_t seed); // QUADS quads, 8 to 12 m away
// A frame: begun, what `draw` does, ended and read.
uint8_t *frame_of(bed *b, const frame_request *q, void (*draw)(bed *b, void *what), void *what);
// A frame of a capture, a picture and geometry, each if there is one.
uint8_t *frame_with(bed *b, const frame_request *q, const cull_capture *capture, const cull_picture *picture, const cull_run *more);

#endif
