// Writes a JSON scene (format 1): zones, portals, doors and their leaves from a plan; meshes, paths, and what else one adds.
// SPDX-License-Identifier: MIT
// Invariant: places are exact decimals of the grid that the geometry lies on, so a portal fills its hole to the last bit.
#ifndef PORTCULLIS_BENCH_GENERATE_JSON_H
#define PORTCULLIS_BENCH_GENERATE_JSON_H

#include "generate_plan.h"

typedef struct json_writer {
    text_file *out;
    int is_first; // of the list that is open: no comma yet
} json_writer;

void json_open(json_writer *j, text_file *out, const char *name);
void json_close(json_writer *j);
void json_list(json_writer *j, const char *key); // `"key": [`, from the top
void json_list_end(json_writer *j);
void json_item(json_writer *j); // a new line in the list
void json_mesh(json_writer *j, const char *file); // the list "meshes" of this one file
void json_place(text_file *out, place p);         // [x, y, z]
void json_numbered(text_file *out, const char *kind, uint32_t number); // "kind_number"; PLAN_OUTSIDE: "kind"
void json_box(text_file *out, const block *b, const char *material); // {"min": .., "max": .., "material": ..}

void json_zones(json_writer *j, const plan *p);
void json_portals(json_writer *j, const plan *p);
void json_doors(json_writer *j, const plan *p);
void json_leaves(json_writer *j, const plan *p); // movers, into an open list

#endif
