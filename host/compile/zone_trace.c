// The stages of one tracing, in order, and back.
// SPDX-License-Identifier: MIT
#include "zone_trace.h"

result zone_trace_make(const trace_input *from, const allocator *memory, zone_trace *out)
{
    *out = (zone_trace){.s = surface_make(from->in->planes, memory), .stages = 1};
    result r = surface_load(&out->s, from->in, from->mesh, from->seals);
    if (r == RESULT_OK) r = portal_cut(&out->s, from->portals);
    if (r == RESULT_OK) r = touch_cut(&out->s);
    if (r == RESULT_OK) r = line_set_make(&out->s, memory, &out->lines);
    if (r == RESULT_OK) out->stages = 2;
    if (r == RESULT_OK) r = shell_set_make(&out->lines, memory, &out->shells);
    if (r == RESULT_OK && out->stages == 2) out->stages = 3;
    if (r == RESULT_OK) r = ray_space_make(&out->s, &out->shells, memory, &out->rays);
    if (r == RESULT_OK) out->stages = 4;
    if (r == RESULT_OK) r = region_set_make(&out->rays, memory, &out->regions);
    if (r == RESULT_OK) out->stages = 5;
    if (r != RESULT_OK) zone_trace_free(out);
    return r;
}

void zone_trace_free(zone_trace *t)
{
    if (t->stages > 4) region_set_free(&t->regions);
    if (t->stages > 3) ray_space_free(&t->rays);
    if (t->stages > 2) shell_set_free(&t->shells);
    if (t->stages > 1) line_set_free(&t->lines);
    if (t->stages > 0) surface_free(&t->s);
    t->stages = 0;
}

uint32_t zone_trace_region(const zone_trace *t, uint32_t face)
{
    const uint32_t shell = t->shells.shell_of[face];
    return shell == SHELL_NONE ? REGION_VOID : t->regions.region_of[shell];
}
