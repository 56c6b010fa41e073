// The oracle of the flow: straight rays from the eye through open portals, zone by zone, with nothing of the flow's own in it.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_FLOW_ORACLE_H
#define PORTCULLIS_TESTS_FLOW_ORACLE_H

#include "host/core/flow.h"

typedef struct oracle_request {
    const scene *scene;
    const uint8_t *open; // by portal
    const camera *camera;
    const flow_result *result;
    uint32_t rays;
    uint64_t seed;
} oracle_request;

typedef struct oracle_answer {
    uint64_t points;  // looked at: each on a line from the eye that nothing stops
    uint64_t behind;  // of them, behind two portals or more
    uint64_t missed;  // in no volume of their zone that may have come in their way, or their zone was not reached
    uint32_t zone;    // of the first that was missed
    uint32_t portals; // on the way to it
    double at[3];
} oracle_answer;

oracle_answer oracle_ask(const oracle_request *q);

#endif
