// Scenes made from a seed: cities and swarms of boxes, grids of rooms, and the project's own demo scene with its path.
// SPDX-License-Identifier: MIT
// Invariant: kind, size and seed give the same bytes with every compiler and on every machine.
#ifndef PORTCULLIS_BENCH_GENERATE_H
#define PORTCULLIS_BENCH_GENERATE_H

#include "../host/core/memory.h"
#include "../host/core/report.h"

#define GENERATE_SIZE_OF_KIND UINT64_MAX // no size said: city and swarm 10,000 boxes, rooms 16 rooms
#define GENERATE_SEED_OF_KIND 1u         // the seed when none is said
#define GENERATE_KINDS "city, swarm, rooms, demo"

// kind  size is            writes             what
// city  boxes, 1..10^7     path, a .boxes     street grid; city N is the N boxes nearest the origin, a part of city N + 1
// swarm boxes, 1..10^7     path, a .boxes     small boxes spread evenly in a cube of 1,000 m; swarm N begins swarm N + 1
// rooms rooms, 1..100,000  path, an .obj      a closed grid of furnished rooms joined by doorways, one `o` a room
// demo  not to be said     path, an .obj, and the same name with .views: a museum in a street, and a walk through it
// [any thread] Bad kind, size or name: RESULT_BAD_INPUT with a line, nothing written.
result generate_scene(const char *kind, uint64_t size, uint64_t seed, const char *path, const allocator *memory, report *r);

#endif
