// For tests of pictures: a field of houses and wide grounds, and a walk through it.
// SPDX-License-Identifier: MIT
#ifndef TESTS_IMAGECACHE_SHOW_FIELD_H
#define TESTS_IMAGECACHE_SHOW_FIELD_H

#include "tests/imagecache/show_host.h"

enum { FIELD_ITEMS = 4000, FIELD_M = 800 };
#define FIELD_STEP_M 0.3

typedef struct field {
    cull_box *boxes;
    hand_zone zone;
    show_host host;
    show_session s;
} field;

cull_box *field_make(void); // FIELD_ITEMS; free it
void field_open(field *f, const show_values *values, double polygon_ns);
void field_close(field *f);

show_eye field_eye(uint32_t frame); // of a walk that turns
void field_look(field *f, show_eye eye, uint32_t frame, show_answers answers, cull_plane *planes, cull_view *view);
void field_point(uint64_t *r, cull_box b, double out[3]);

// Points of all pictures shown: none may be off by more than its picture says. Returns by how much the one most off is, and adds how many were in view.
double field_off_most(field *f, const cull_view *view, const cull_plane *planes, uint64_t *r, uint64_t *samples);

#endif
