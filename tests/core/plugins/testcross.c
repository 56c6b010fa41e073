// The test cullers `testcross` and `testcross-too`: crossers and nothing else, two in one library, for the rules of chains.
// SPDX-License-Identifier: MIT
#define OPTION_COUNT 1
#define QUERY_FIELDS
#include "shell.h"

#include <math.h>

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    c->zone = zone;
    c->lent = lent;
    out->max_steps = 1;
    return CULL_OK;
}

static cull_crossing cross(cull_query *q, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes, uint32_t *plane_count)
{
    const char *fault = q->culler->values[0];
    (void)view;
    (void)in;
    (void)portal;
    *plane_count = 1;
    planes[0] = (cull_plane){{1, 0, 0}, -1e30f}; // nothing is inside
    if (strcmp(fault, "odd") == 0) return 17;
    if (strcmp(fault, "endless") == 0) *plane_count = UINT32_MAX;
    if (strcmp(fault, "nan") == 0) planes[0].offset = NAN;
    return strcmp(fault, "none") == 0 ? CULL_CROSS_SAME : CULL_CROSS_NARROW;
}

static const void *get_extension(const cull_culler *c, const char *id)
{
    (void)c;
    (void)id;
    return NULL;
}

static const cull_option options[OPTION_COUNT] = {{"fault", "none", NULL, "what it does wrong: odd, endless, nan"}};
static const cull_descriptor one = {"testcross", "1", "passes every volume", options, OPTION_COUNT, 0};
static const cull_descriptor two = {"testcross-too", "1", "passes every volume", options, OPTION_COUNT, 0};
#define CROSSER(d) {.descriptor = d, .create = shell_create, .destroy = shell_destroy, .build = build, .open = shell_open, .close = shell_close, .cross = cross, .get_extension = get_extension}
static const cull_plugin plugin_one = CROSSER(&one), plugin_two = CROSSER(&two);
static const cull_plugin *const plugins[] = {&plugin_one, &plugin_two};
CULL_ENTRY = {CULL_ABI, 2, plugins};
