// A world of a scene, with the plugins of the tests or the real ones, for tests of baked indices.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_BAKE_STAND_H
#define PORTCULLIS_TESTS_BAKE_STAND_H

#include "pcs_fixture.h"

#include "host/compile/bake_zones.h"
#include "host/core/world_parts.h"

typedef struct stand {
    heard heard;
    report report;
    host_services services;
    arena texts;
    loader *plugins;
    world *world;
} stand;

result stand_open(stand *t, const scene *s, const char *chain, uint32_t more_movers); // stand_close even after a failure
void stand_close(stand *t);

#endif
