// What the claims are shown on: a generated scene with its walk and tour, a world on it in a counting allocator, a view.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_CLAIMS_STAGE_H
#define PORTCULLIS_TESTS_CLAIMS_STAGE_H

#include "host/core/world.h"
#include "host/import/views.h"
#include "tests/common/failing_allocator.h"
#include "tests/common/report_lines.h"
#include "tests/common/scratch_folder.h"

enum { STAGE_CHAINS_MOST = 32 };
typedef struct stage_spec { const char *text; const chain_spec *spec; } stage_spec;

typedef struct stage {
    failing_allocator counted; // of the world, its cullers and views, nothing else
    report_lines lines;
    host_services services;
    arena texts;
    scene *scene;
    camera_path walk, tour;
    loader *plugins;
    world *world;
    world_view *view;
    stage_spec specs[STAGE_CHAINS_MOST]; // parsed so far
    uint32_t spec_count;
} stage;

typedef enum tier { TIER_SHORT, TIER_LONG } tier;
tier stage_tier(void); // TIER_LONG with PORTCULLIS_LONG in the environment

// size: GENERATE_SIZE_OF_KIND where the kind has none. No world yet.
void stage_make(stage *s, const char *kind, uint64_t size);
void stage_load(stage *s, const char *file); // a scene of a file; walk and tour may be missing: empty
const chain_spec *stage_chain(stage *s, const char *text); // lives as long as the stage
// "scene" as a chain: what the scene names for the zone, frustum where it names none, and octree+portal where it names what draws to know:
// that is judged by test_flagship.c.
const chain_spec *stage_chain_of(stage *s, const char *text, uint32_t zone);

typedef struct stage_world { const chain_spec *const *chains; uint32_t more_movers; } stage_world; // chains by zone
void stage_open(stage *s, const stage_world *q); // world and view
void stage_shut(stage *s);                       // both; asserts that nothing is left
void stage_free(stage *s);
frame_input stage_input(const camera *c, uint32_t frame); // 1280 by 720, no driver

#endif
