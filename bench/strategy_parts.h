// What the files of a strategy share among themselves.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_STRATEGY_PARTS_H
#define PORTCULLIS_BENCH_STRATEGY_PARTS_H

#include "strategy.h"

// ---- strategy_chains.c: which chain each zone has ----
// A world with the first set; order and pictures of each zone. What it allocates strategy_close frees.
result chains_open(strategy *s, report *r);
void chains_close(strategy *s);
void chains_figures(strategy *s); // what the chains that stand tell now
// All zones to what they have in that view, with layout and slots. Does nothing where that is so already.
result chains_turn(strategy *s, uint32_t view, report *r);
result chains_tell_slots(strategy *s, report *r); // to layout and renderer; there must be a layout
result chains_tell_pieces(strategy *s, report *r); // of see-through items, to the layout

// ---- strategy_driver.c: the renderer behind the frame ----
frame_driver driver_of(strategy *s);

// ---- blame.c: whose fault a miss is ----
int blame_open(strategy *s); // 0: no memory
void blame_close(strategy *s);

// ---- strategy_set.c: the set D ----
void set_mark(strategy *s, const visible_set *set); // after a frame that marks
double set_write_ids(strategy *s, const visible_set *set); // into s->ids; returns the CPU time, ns

double thread_cpu_ns(void);

#endif
