// The parts of the demo scene: metres, Y up, the street along x from z = 0 to 12, the museum's door at x = 0, z = 0.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_GENERATE_DEMO_H
#define PORTCULLIS_BENCH_GENERATE_DEMO_H

#include "generate_obj.h"
#include "generate_random.h"

void demo_museum(obj_writer *w, random_stream *r); // x -15 .. 15, z -22 .. 0
void demo_street(obj_writer *w, random_stream *r); // everything else

#endif
