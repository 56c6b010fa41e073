// Scenes made from a seed: cities and swarms of boxes, rooms, mazes and houses with zones, the project's own scenes.
// SPDX-License-Identifier: MIT
// Invariant: kind, size and seed give the same bytes with every compiler and on every machine.
#ifndef PORTCULLIS_BENCH_GENERATE_H
#define PORTCULLIS_BENCH_GENERATE_H

#include "../host/core/memory.h"
#include "../host/core/report.h"

#define GENERATE_SIZE_OF_KIND UINT64_MAX // no size said: city and swarm 10,000 boxes, rooms 16 rooms, maze 100, terrain 1,024 tiles, flagship 150 m, forest
                                         // 100,000 triangles
#define GENERATE_SEED_OF_KIND 1u         // the seed when none is said
#define GENERATE_KINDS "city, swarm, rooms, maze, house, demo, flagship, terrain, forest"

// kind     size is            writes             what
// city     boxes, 1..10^7     path, a .boxes     street grid; city N is the N boxes nearest the origin, a part of city N + 1
// swarm    boxes, 1..10^7     path, a .boxes     small boxes spread evenly in a cube of 1,000 m; swarm N begins swarm N + 1
// rooms    rooms, 1..100,000  path, an .obj      a closed grid of furnished rooms joined by doorways, one `o` a room
// rooms    rooms, 1..100,000  path, a .json      the same with a zone a room, a portal a doorway, a door in each third
// maze     rooms, 10..100,000 path, a .json      rooms of many sizes, corridors, two levels joined by stair shafts; chains mixed
// house    not to be said     path, a .json      a furnished house of eleven rooms on open ground
// demo     not to be said     path, an .obj, and the same name with .views: a museum in a street, and a walk through it
// flagship metres, 150..2,000 path, a .json      a street of six houses one can enter, a cellar of eleven zones, hills and, from 150 m on, woods; movers
// terrain  tiles, 1..65,536   path, an .obj      hills: a grid of heights, tiles of 48 m, one `o` a tile of 128 triangles
// forest   triangles, 1,000..2*10^7 path, an .obj roads, houses and woods over rolling ground, blocks of 64 m round the origin, the last cut short; no more
//                                                than asked for, at most 600 fewer
// A .json has its geometry beside it, the same name with .obj, and the camera paths "walk" and "tour" of 500 views and more.
// [any thread] Bad kind, size or name: RESULT_BAD_INPUT with a line, nothing written.
result generate_scene(const char *kind, uint64_t size, uint64_t seed, const char *path, const allocator *memory, report *r);

#endif
