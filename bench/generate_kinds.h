// The kinds behind generate_scene, one function each: see generate.h for what they make.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_GENERATE_KINDS_H
#define PORTCULLIS_BENCH_GENERATE_KINDS_H

#include "generate_text.h"

// The number of a place: tenths of a millimetre, so that files hold short exact decimals.
enum { CENTIMETRE = 100, METRE = 10000, PLACE_DECIMALS = 4 };

// Each adds its file to `out`. A failed allocation sets out->failed, now or before.
void generate_city(uint64_t boxes, uint64_t seed, const allocator *memory, text_file *out);
void generate_swarm(uint64_t boxes, uint64_t seed, text_file *out);
void generate_rooms(uint64_t rooms, uint64_t seed, const allocator *memory, text_file *out);
void generate_terrain(uint64_t tiles, uint64_t seed, const allocator *memory, text_file *out);
void generate_forest(uint64_t triangles, uint64_t seed, const allocator *memory, text_file *out);
void generate_demo(uint64_t seed, const allocator *memory, text_file *out);
void generate_demo_path(text_file *out);

#endif
