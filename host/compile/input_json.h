// Brushes of a JSON scene on their way into the compiler's input.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_INPUT_JSON_H
#define PORTCULLIS_HOST_INPUT_JSON_H

#include "../import/json_scene.h"
#include "input.h"
#include "input_primitive.h"

enum { BRUSH_PLANES_MOST = 256 };

typedef enum brush_operation { OPERATION_ADD, OPERATION_SUBTRACT, OPERATION_PORTAL } brush_operation;

typedef struct json_brush { // of one entry of "brushes"
    const char *name, *material; // name NULL: none
    brush_operation operation;
    double texture_scale, texture_offset[2]; // metres a repetition; repetitions
    uint32_t door;                           // in the builder; SCENE_NONE
    int is_open;                             // half spaces alone: to be bounded
} json_brush;

// Checks all keys and makes the planes. `solid` is made here, to be freed also after a failure.
result json_brush_read(const json_entry *e, double steps_per_metre, json_brush *out, primitive *solid);

typedef struct json_input {
    input_draft draft;
    json_scene *scene;
    json_item_lines lines;
    buffer doors;          // uint32_t: portal_doors
    buffer faces;          // compile_face: of one brush
    double low[3], high[3]; // of all bounded brushes, steps
    uint32_t run;         // entity that nameless brushes go to; UINT32_MAX: a new one
} json_input;

// Two passes over "brushes": what the half spaces are bounded by, then all of them (input_json_brushes.c).
result json_brushes_read(json_input *j);
result json_entity_add(json_input *j, const compile_entity *like, uint32_t door, uint32_t *out);

#endif
