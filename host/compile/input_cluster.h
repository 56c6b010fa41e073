// Planes meant to be one, told by the faces that lie on them.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_COMPILE_INPUT_CLUSTER_H
#define PORTCULLIS_HOST_COMPILE_INPUT_CLUSTER_H

#include "input.h"

typedef struct near_pair {
    uint32_t a, b; // planes, not references; a < b
    double apart;  // steps, the most that any two brushes have
} near_pair;

// to: by plane number, the plane that it is to become; PLANE_NONE: it stays. Planes that none of the faces had may be new.
// pairs: of planes that touch and are near, each once.
result plane_clusters_find(input_draft *d, const near_pair *pairs, size_t count, buffer *to);

#endif
