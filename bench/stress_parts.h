// What the files of the stress test share among themselves.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_STRESS_PARTS_H
#define PORTCULLIS_BENCH_STRESS_PARTS_H

#include "stress.h"
#include "stress_scene.h"

// ---- stress_families.c ----
scene_change stress_home(void); // the scene as it is
scene_change stress_change(const stress_family *f, double magnitude, const scene *s, uint64_t seed);
// The camera in the changed scene. Its faults are camera_fault's to tell.
camera stress_camera(const stress_family *f, double magnitude, const scene_change *c, const camera *from);

#endif
