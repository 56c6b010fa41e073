// The text of a .map file: entities with their keys, brushes and faces, as written (Quake's axes and units).
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_MAP_TEXT_H
#define PORTCULLIS_HOST_MAP_TEXT_H

#include "../core/memory.h"
#include "../core/report.h"

#define MAP_COORDINATE_MOST 1048576.0 // units (32 km): no level is near it, and plane arithmetic keeps 2^-30 units there

typedef struct map_word { // in the file's text, not closed by a zero
    const char *text;
    size_t length;
} map_word;

typedef enum map_projection { MAP_STANDARD, MAP_VALVE } map_projection;

typedef struct map_face {
    double points[3][3]; // clockwise seen from outside the brush
    map_word decimals[3][3]; // the same numbers as written: what a double has rounded is rounded once too often for some
    map_word texture;
    map_projection projection;
    double axes[2][3]; // Valve: s and t
    double shift[2], rotation_deg, scale[2];
    size_t line;
} map_face;

typedef struct map_brush {
    size_t first_face, face_count; // in map_entity.faces
    size_t line;
} map_brush;

typedef struct map_key {
    map_word key, value;
    size_t line;
} map_key;

typedef struct map_entity {
    buffer keys, brushes, faces; // map_key, map_brush, map_face
    size_t line;
    uint32_t number; // place in the file
} map_entity;

typedef struct map_reader {
    const char *path, *at, *end;
    size_t line;
    uint32_t entities_read;
    report *report;
} map_reader;

map_entity map_entity_make(const allocator *memory);
void map_entity_free(map_entity *e);
// NULL when the entity has no such key. The last one counts where it stands twice.
const map_key *map_entity_key(const map_entity *e, const char *key);

typedef enum map_more { MAP_ENTITY, MAP_END } map_more;

// [one thread] The next entity into *e, whose buffers are used again; MAP_END behind the last. Faults are reported.
result map_reader_next(map_reader *m, map_entity *e, map_more *out);

// Exactly `count` numbers, space between, nothing else. 0 when the text is anything else.
int map_word_numbers(map_word word, double *numbers, int count);
int map_word_is(map_word word, const char *lower_case); // letter case is ignored
int map_word_starts(map_word word, const char *lower_case);

#endif
