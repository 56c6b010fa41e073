// Brushes to the structure's surface: bodies, relations, CSG, weld, merge, in one call.
// SPDX-License-Identifier: MIT
#include "merge.h"
#include "mesh.h"
#include "relations.h"
#include "stages.h"
#include "vertex_weld.h"

typedef struct csg_run { // of zeros, all of it may be freed
    brush_bodies bodies;
    relation_table relations;
    brush_rank *rank;
    uint32_t *class_of;
    polygon_soup soup, merged;
    buffer vertices;
} csg_run;

static result run_stages(csg_run *run, const compile_input *in, report *r, const allocator *memory)
{
    result done = brush_bodies_make(in, 1u << BRUSH_STRUCTURE | 1u << BRUSH_LIQUID, r, memory, &run->bodies);
    if (done != RESULT_OK) return done;
    const map_field field = map_field_of(&run->bodies);
    done = relation_table_make(in->planes, &run->bodies, memory, &run->relations);
    if (done == RESULT_OK) compile_tell(&(compile_view){STAGE_RELATIONS, in, .bodies = &run->bodies, .relations = &run->relations});
    if (done == RESULT_OK) done = brush_ranks_make(in, &run->bodies, &field, memory, &run->rank);
    if (done == RESULT_OK) done = face_classes_make(in, memory, &run->class_of);
    const csg_stage stage = {in, &run->bodies, &run->relations, run->rank, &field};
    if (done == RESULT_OK) done = csg_surface(&stage, memory, &run->soup);
    if (done == RESULT_OK) compile_tell(&(compile_view){STAGE_CSG, in, .soup = &run->soup});
    if (done == RESULT_OK) done = vertex_weld(in->planes, &run->soup, memory, &run->vertices);
    if (done != RESULT_OK) return done;
    compile_tell(&(compile_view){STAGE_WELD, in, .soup = &run->soup, .vertices = run->vertices.items, .vertex_count = (uint32_t)run->vertices.count});
    const merge_input merge = {in, &field, run->class_of, &run->soup, run->vertices.items};
    return merge_polygons(&merge, memory, &run->merged);
}

static void free_run(csg_run *run, const compile_input *in, const allocator *memory)
{
    polygon_soup_free(&run->merged);
    polygon_soup_free(&run->soup);
    buffer_free(&run->vertices);
    memory_free(memory, run->rank, in->brush_count, sizeof *run->rank);
    memory_free(memory, run->class_of, in->face_count, sizeof *run->class_of);
    relation_table_free(&run->relations, &run->bodies, memory);
    brush_bodies_free(&run->bodies);
}

result compile_csg(const compile_input *in, report *r, const allocator *memory, compile_mesh **out, csg_counts *counts)
{
    *out = NULL;
    *counts = (csg_counts){0};
    csg_run run = {.vertices = buffer_make(memory, sizeof(compile_vertex))};
    result done = run_stages(&run, in, r, memory);
    if (done == RESULT_OK) done = compile_mesh_make(in, &run.merged, &run.vertices, memory, out);
    if (done == RESULT_OK)
        *counts = (csg_counts){(uint32_t)run.bodies.polygons.count, (uint32_t)run.soup.polygons.count, (uint32_t)run.merged.polygons.count};
    if (done == RESULT_OK) compile_tell(&(compile_view){STAGE_MERGE, in, .mesh = *out});
    free_run(&run, in, memory);
    return done == RESULT_NO_MEMORY ? report_no_memory(r, in->path) : done;
}
