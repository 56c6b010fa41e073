// Scenes with zones: a plan, geometry in an .obj, a walk, and what else goes into the JSON scene that names them.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_GENERATE_ZONED_H
#define PORTCULLIS_BENCH_GENERATE_ZONED_H

#include "generate_path.h"

typedef struct zoned_scene zoned_scene;
typedef void (*zoned_extra)(const zoned_scene *z, json_writer *j); // adds items to an open list, or nothing

struct zoned_scene {
    const allocator *memory;
    uint64_t size, seed;
    plan plan;
    text_file geometry; // .obj
    path_line walk;
    uint32_t walk_views;         // 0: PATH_VIEWS
    int32_t tour_low, tour_high; // eyes over the floor
    zoned_extra movers, lights, paths; // NULL: none
};

// One function a kind: fills plan, geometry, walk, heights of the tour. A failed allocation sets a `failed` of one of them.
void zoned_rooms(zoned_scene *z);
void zoned_maze(zoned_scene *z);
void zoned_house(zoned_scene *z);
void zoned_flagship(zoned_scene *z);

typedef struct zoned_request {
    const char *kind;
    void (*fill)(zoned_scene *z);
    uint64_t size, seed;
    const char *json_path, *obj_path; // both or none are written
} zoned_request;
result zoned_write(const zoned_request *q, const allocator *memory, report *r);

#endif
