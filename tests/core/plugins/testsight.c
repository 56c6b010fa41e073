// The test culler `testsight`: a select that draws its whole zone, and tells what of a volume gets to a portal, well or badly.
// SPDX-License-Identifier: MIT
#define OPTION_COUNT 1
#define QUERY_FIELDS
#include "shell.h"

#include <math.h>

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    c->zone = zone;
    c->lent = lent;
    out->max_runs = 1;
    out->max_steps = 1;
    return CULL_OK;
}

static cull_progress pick(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    (void)visit;
    if (q->culler->zone->item_count) batch->runs[batch->run_count++] = (cull_run){0, q->culler->zone->item_count};
    return CULL_DONE;
}

// The volume itself, as often as there may be parts.
static cull_crossing copy(const cull_volume *in, uint32_t part, cull_plane *planes, uint32_t *plane_count)
{
    if (part == CULL_MAX_PARTS) return CULL_CROSS_NONE;
    if (in->plane_count) memcpy(planes, in->planes, in->plane_count * sizeof *planes);
    *plane_count = in->plane_count;
    return CULL_CROSS_NARROW;
}

static cull_crossing part(cull_query *q, const cull_view *view, const cull_volume *in, uint32_t portal, uint32_t number, cull_plane *planes,
                          uint32_t *plane_count)
{
    const char *tell = q->culler->values[0];
    (void)view;
    (void)portal;
    if (strcmp(tell, "all") == 0) return CULL_CROSS_SAME;
    if (strcmp(tell, "nothing") == 0) return CULL_CROSS_NONE;
    if (strcmp(tell, "copies") == 0) return copy(in, number, planes, plane_count);
    *plane_count = strcmp(tell, "planes") == 0 ? CULL_MAX_PLANES + 1 : 1;
    planes[0] = (cull_plane){{1, 0, 0}, strcmp(tell, "nan") == 0 ? NAN : -1e30f}; // nothing is inside
    return strcmp(tell, "odd") == 0 ? 17 : CULL_CROSS_NARROW;                     // "endless": it never ends
}

static const void *get_extension(const cull_culler *c, const char *id)
{
    static const cull_sight sight = {part}, empty = {NULL};
    if (strcmp(id, CULL_EXT_SIGHT) != 0) return NULL;
    return strcmp(c->values[0], "null") == 0 ? &empty : &sight;
}

static const cull_option options[OPTION_COUNT] = {
    {"tell", "all", NULL, "what it tells: all, nothing, copies; nonsense: odd, planes, nan, endless; null: no function"}};
static const cull_descriptor descriptor = {"testsight", "1", "draws the zone, tells what gets to its portals", options, OPTION_COUNT, 0};
static const cull_plugin plugin = {.descriptor = &descriptor, .create = shell_create, .destroy = shell_destroy, .build = build, .open = shell_open,
                                   .close = shell_close, .select = pick, .get_extension = get_extension};
static const cull_plugin *const plugins[] = {&plugin};
CULL_ENTRY = {CULL_ABI, 1, plugins};
