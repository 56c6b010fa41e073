// The checks themselves, each a function, in the files check_*.c.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_CHECK_CHECKS_H
#define PORTCULLIS_HOST_CHECK_CHECKS_H

#include "stand.h"

check_function check_entry, check_options, check_life, check_batch, check_bounds;            // check_life.c, check_options.c
check_function check_conservative, check_sampled, check_history, check_movers, check_storm;  // check_sight.c
check_function check_stateless, check_ordered, check_instances, check_parallel;              // check_answers.c
check_function check_quiet, check_constant, check_zone;                                      // check_step.c
check_function check_memory, check_leaks, check_nonsense, check_bake;                        // check_memory.c, check_nonsense.c, check_bake.c
check_function check_hierarchy, check_ray, check_explain, check_cross;                       // check_extensions.c, check_cross.c

// What most checks do: a scene, a culler on it, a sitting, an answer to write into.
typedef struct bench_seat {
    made_scene scene;
    stand stand;
    sitting sitting;
    sitting_answer answer;
} bench_seat;
typedef struct seat_request {
    scene_kind kind;
    const stand_values *values; // NULL: defaults
    sitting_lists lists;
    uint32_t mover_capacity;
    lender_tasks tasks;
} seat_request;
typedef enum seat_state { SEAT_GOOD, SEAT_REFUSED, SEAT_FAULTY } seat_state;
// REFUSED: the culler says that it cannot have this zone, which it may. FAULTY: r holds the message. Close it in any case but
// FAULTY, where the process is as good as over.
seat_state seat_open(check_run *r, const seat_request *q, bench_seat *out);
void seat_close(bench_seat *b);

// The culler with its defaults, then with each option that it wants measured at each value, one at a time. 0: no such variant.
int variant_make(const cull_plugin *p, uint32_t number, stand_values *out, char *name, size_t size, char *words, size_t words_size);

#endif
