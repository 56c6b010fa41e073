// The parts of the flagship scene: a street along x between six houses, hills beyond; what moves in it.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_GENERATE_FLAGSHIP_H
#define PORTCULLIS_BENCH_GENERATE_FLAGSHIP_H

#include "generate_house.h"

enum { FLAGSHIP_HOUSES = 6, FLAGSHIP_CELLAR_HOUSE = 0, FLAGSHIP_LAMPS = 8 };

const house_site *flagship_house(uint32_t number);
local_place flagship_lamp(uint32_t number); // its foot, world, centimetres
void flagship_movers(const zoned_scene *z, json_writer *j); // a cart, walkers, a lift

#endif
