// A small reader of generated .obj files for tests: nothing of the importers is in it, so it can judge what they are fed.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TEST_OBJ_PROBE_H
#define PORTCULLIS_TEST_OBJ_PROBE_H

#include <stddef.h>
#include <stdint.h>

enum { PROBE_NAME_BYTES = 32, PROBE_CORNERS = 8 };

typedef struct probe_polygon {
    uint32_t corners[PROBE_CORNERS]; // place numbers: equal positions have equal numbers
    uint32_t corner_count;
    char object[PROBE_NAME_BYTES], material[PROBE_NAME_BYTES];
} probe_polygon;

typedef struct probe {
    double (*places)[3];
    probe_polygon *polygons;
    size_t place_count, polygon_count, object_count, triangle_count;
} probe;

// Which polygons a measure takes; name is the caller's.
typedef int (*probe_choice)(const probe_polygon *p, const char *name);

char *bytes_of_file(const char *path, size_t *size); // closing zero; NULL when it isn't there; free()
probe probe_read(const char *path);                  // asserts that all is well formed
void probe_free(probe *p);
double probe_volume(const probe *p, probe_choice takes, const char *name); // enclosed by the chosen polygons, seen sides outwards
size_t probe_open_edges(const probe *p, probe_choice takes, const char *name); // edges without exactly one opposite
size_t probe_parts(const probe *p, probe_choice takes, const char *name);  // connected by shared places
size_t probe_crossings(const probe *p, const double from[3], const double to[3]); // polygons that the segment passes

#endif
