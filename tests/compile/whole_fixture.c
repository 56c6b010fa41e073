// The whole compiler in one call: see whole_fixture.h.
// SPDX-License-Identifier: MIT
#include "whole_fixture.h"

#include "host/compile/pcs_write.h"

result whole_compile(const whole_map *m, report *r, const allocator *memory, whole *out)
{
    const input_options options = {m->grid, 0};
    compile_mesh *mesh = NULL;
    *out = (whole){0};
    result done = compile_input_map("t.map", m->text, m->size, &options, memory, r, &out->in);
    if (done == RESULT_OK) done = compile_csg(out->in, r, memory, &mesh, &out->counts);
    if (done == RESULT_OK) done = compile_zones(out->in, mesh, m->portals, r, memory, &out->zones);
    return done == RESULT_OK ? compile_items(out->in, out->zones, r, memory, &out->scene, &out->checks) : done;
}

void whole_free(whole *w, const allocator *memory)
{
    scene_free(w->scene, memory);
    compiled_zones_free(w->zones); // holds the mesh
    compile_input_free(w->in);
}

size_t whole_encode(const whole *w, const allocator *memory, void **out_bytes)
{
    report silent = {0};
    size_t size = 0;
    return pcs_encode(&(pcs_request){.scene = w->scene}, "t.pcs", memory, &silent, out_bytes, &size) == RESULT_OK ? size : 0;
}
