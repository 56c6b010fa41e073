// Brushes as .map text, for tests.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_IMPORT_BRUSHES_H
#define PORTCULLIS_TESTS_IMPORT_BRUSHES_H

#include <stddef.h>

typedef struct map_text { // grows up to its room; more fails the test
    char text[65536];
    size_t size;
} map_text;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void map_add(map_text *m, const char *format, ...);

typedef struct point_set { double points[3][3]; } point_set; // of one face, clockwise from outside
// The six faces of a box: -x, +x, -y, +y, -z, +z.
void box_faces(const double min[3], const double max[3], point_set faces[6]);
void map_add_faces(map_text *m, const point_set *faces, int count, const char *texture);
void map_add_box(map_text *m, const double min[3], const double max[3], const char *texture);

#endif
