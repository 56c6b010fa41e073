// The compiler's stages by name, and how a watcher is told of each as it ends: for dumps and times. A watcher changes nothing.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_COMPILE_STAGES_H
#define PORTCULLIS_HOST_COMPILE_STAGES_H

#include "compile.h"

typedef enum compile_stage {
    STAGE_INPUT,
    STAGE_RELATIONS,
    STAGE_CSG,
    STAGE_WELD,
    STAGE_MERGE,
    STAGE_PORTALS,
    STAGE_ZONES,
    STAGE_T_JUNCTIONS,
    STAGE_ITEMS, // triangulation, the checks, the scene
    STAGE_BAKE,
    STAGE_WRITE,
    STAGE_COUNT,
} compile_stage;
enum { STAGES_DUMPED = STAGE_BAKE }; // those before it have a dump

const char *compile_stage_name(compile_stage s);      // "t_junctions"
compile_stage compile_stage_of(const char *name);     // STAGE_COUNT: none of that name
void compile_stage_names(compile_stage end, char out[128]); // those before `end`, a blank between

// What a stage made; the rest is NULL. All of it is lent for the call.
struct compile_view {
    compile_stage stage;
    const compile_input *in;
    const struct brush_bodies *bodies; // RELATIONS
    const relation_table *relations;   // RELATIONS
    const struct polygon_soup *soup;   // CSG, WELD
    const compile_vertex *vertices;    // WELD
    uint32_t vertex_count;
    const compile_mesh *mesh;          // MERGE
    const struct portal_set *portals;  // PORTALS
    const struct zone_trace *trace;    // ZONES
    const struct zone_places *places;  // ZONES
    const compiled_zones *zones;       // ZONES: names only; T_JUNCTIONS
};

void compile_tell(const compile_view *made); // in->watch, if there is one

#endif
