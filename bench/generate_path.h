// Camera paths of generated scenes: a smooth walk along a line of points, and a tour of random eyes.
// SPDX-License-Identifier: MIT
// Invariant: eyes are whole tenths of a millimetre, so an eye put on a portal's plane lies on it to the last bit.
#ifndef PORTCULLIS_BENCH_GENERATE_PATH_H
#define PORTCULLIS_BENCH_GENERATE_PATH_H

#include "generate_json.h"
#include "generate_random.h"

enum { PATH_VIEWS = 500 };

typedef struct path_line { buffer points; int failed; } path_line; // place

path_line path_open(const allocator *memory);
void path_free(path_line *l);
void path_to(path_line *l, place p);
double path_length(const path_line *l); // metres

// A path of `views` eyes at even distances along the line, corners rounded, looking ahead and swaying a little.
void path_write_walk(json_writer *j, const path_line *l, uint32_t views);

// Adds the points from where one way enters the room to where another leaves it, both in the middle of their holes and
// PLAN_OUTSIDE where the walk starts or ends in the room.
typedef void (*path_route)(path_line *l, const plan *p, uint32_t room, uint32_t from, uint32_t to);
typedef struct wander_request {
    const plan *plan;
    path_route route;
    uint64_t seed;
    uint32_t room;   // where it starts
    double length_m; // at least, but where there is no way out
} wander_request;
void path_wander(path_line *l, const wander_request *q); // through random holes, back only at a dead end

// PATH_VIEWS eyes in random rooms: at least 0.25 m from walls, some in holes, some of these on the portal's plane itself.
typedef struct tour_request {
    const plan *plan;
    uint64_t seed;
    int32_t low, high; // height of the eyes over the floor
} tour_request;
void path_write_tour(json_writer *j, const tour_request *q);
void path_write_eye(json_writer *j, place eye, random_stream *r); // one view with a random direction, for lists of one's own

#endif
